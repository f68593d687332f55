//! `glisten lsp`: what an editor chooses, baselines, and messages that are none.

use crate::cli::{Folder, codes};
use crate::editor::{Editor, edited};
use serde_json::{Value, json};
use std::fs;
use std::io::{Read, Write};
use std::process::Stdio;

const HEADER: &str = "#ifdef FOG\nvec3 fog(vec3 c) { return c * FAR; }\n#endif\nvec3 plain(vec3 c) { return c; }\n";
const ONE: &str =
    "#version 150\n#include \"h.glsl\"\nout vec4 color;\nvoid main() { color = vec4(plain(vec3(1.0)), 1.0); }\n";
const TWO: &str = "#version 150\n#define FOG\n#define FAR 2.0\n#include \"h.glsl\"\nout vec4 color;\nvoid main() { color = vec4(fog(vec3(1.0)), 1.0); }\n";

fn run(editor: &mut Editor, command: &str, arguments: Value) -> Value {
    editor.answer("workspace/executeCommand", json!({ "command": command, "arguments": arguments }))
}

fn gray() -> Value {
    json!({ "textDocument": { "publishDiagnostics": { "tagSupport": { "valueSet": [1] } } },
        "workspace": { "codeLens": { "refreshSupport": true } } })
}

/// The lines that are gray.
fn gray_lines(found: &[Value]) -> Vec<u64> {
    let is_gray = |one: &&Value| one["message"].as_str().is_some_and(|text| text.contains("left out"));
    found.iter().filter(is_gray).filter_map(|one| one["range"]["start"]["line"].as_u64()).collect()
}

#[test]
fn an_editor_chooses_macros_and_includers() {
    let files = [("h.glsl", HEADER.as_bytes()), ("one.frag", ONE.as_bytes()), ("two.frag", TWO.as_bytes())];
    let folder = Folder::new(&files);
    let mut editor = Editor::new(&folder, gray());
    let header = editor.uri("h.glsl");
    editor.open("h.glsl", HEADER);
    assert_eq!(gray_lines(&editor.diagnostics("h.glsl")), [0], "the first includer");
    let all = run(&mut editor, "glisten.contexts", json!([header]))["result"].clone();
    assert_eq!(all, json!([editor.uri("one.frag"), editor.uri("two.frag")]));
    let two = editor.uri("two.frag");
    run(&mut editor, "glisten.context", json!([header, two]));
    assert!(
        editor.told.iter().any(|one| one["method"] == "workspace/codeLens/refresh") || {
            let _ = editor.ask("textDocument/codeLens", json!({ "textDocument": { "uri": header } }));
            editor.told.iter().any(|one| one["method"] == "workspace/codeLens/refresh")
        }
    );
    assert!(gray_lines(&editor.diagnostics("h.glsl")).is_empty(), "as the second one sees it");
    run(&mut editor, "glisten.context", json!([header, null]));
    assert_eq!(gray_lines(&editor.diagnostics("h.glsl")), [0]);
    let stranger = editor.uri("other.frag");
    assert_eq!(run(&mut editor, "glisten.context", json!([header, stranger]))["error"]["code"], -32803);
    // A macro from outside: its branch is read, and what is wrong in it is found.
    editor.open("one.frag", ONE);
    assert_eq!(run(&mut editor, "glisten.define", json!(["FOG", "1"]))["result"], json!({ "FOG": "1" }));
    let mut found = editor.diagnostics("h.glsl");
    while found.is_empty() || !gray_lines(&found).is_empty() {
        found = editor.diagnostics("h.glsl");
    }
    assert_eq!(found[0]["code"], "E0301", "{found:?}");
    assert_eq!(run(&mut editor, "glisten.define", json!(["FOG", null]))["result"], json!({}));
    for wrong in [json!([7]), json!(["1x", "1"]), json!(["A", []]), json!(["A", "1\n2"])] {
        assert!(run(&mut editor, "glisten.define", wrong.clone())["error"].is_object(), "{wrong}");
    }
    assert!(run(&mut editor, "glisten.nothing", json!([]))["error"].is_object());
    let uri = editor.uri("one.frag");
    assert!(run(&mut editor, "glisten.translation", json!([uri, "pascal"]))["error"].is_object());
    editor.close();
}

#[test]
fn pictures_are_drawn_or_refused() {
    let vertex = "#version 150\nin vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }\n";
    let fragment = "#version 150\nout vec4 color;\nvoid main() { color = vec4(1.0); }\n";
    let scene = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        [draw.attributes]\np = { size = 3, values = [-1,-1,0, 3,-1,0, -1,3,0] }\n";
    let files = [("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes()), ("s.toml", scene.as_bytes())];
    let folder = Folder::new(&files);
    let mut editor = Editor::new(&folder, json!({ "window": { "showDocument": { "support": true } } }));
    let uri = editor.uri("s.toml");
    let drawn = run(&mut editor, "glisten.picture", json!([uri]))["result"]["uri"].as_str().map(str::to_owned);
    let path = drawn.as_deref().and_then(|uri| uri.strip_prefix("file://")).expect("a file");
    assert!(fs::read(path).expect("a picture").starts_with(b"\x89PNG"));
    let asked = editor.told.iter().find(|one| one["method"] == "window/showDocument");
    assert_eq!(asked.map(|one| &one["params"]["uri"]), Some(&json!(drawn)));
    let missing = editor.uri("missing.toml");
    let refused = run(&mut editor, "glisten.picture", json!([missing]));
    assert!(refused["error"]["message"].as_str().is_some_and(|text| text.contains("missing.toml")), "{refused}");
    // The server ends though a picture is being drawn.
    let uri = editor.uri("s.toml");
    editor.send(&json!({ "jsonrpc": "2.0", "id": 900, "method": "workspace/executeCommand",
        "params": { "command": "glisten.picture", "arguments": [uri] } }));
    editor.close();
}

#[test]
fn a_baseline_counts_in_the_editor() {
    let text = "#version 150\nout vec4 color;\nvoid main() { float a = 1.0; color = vec4(1.0); }\n";
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    folder.run(&["lint", "a.frag", "--baseline", "known.json", "--update-baseline"]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", text);
    assert_eq!(editor.diagnostics("a.frag").len(), 1);
    editor.close();
    let mut editor = Editor::with(&folder, json!({}), &["--baseline", "known.json"]);
    editor.open("a.frag", text);
    assert_eq!(editor.diagnostics("a.frag").len(), 0);
    let more = text.replace("color =", "float b = 2.0; color =");
    editor.change("a.frag", 2, json!([{ "text": more }]));
    let found = editor.diagnostics("a.frag");
    assert!(found.iter().any(|one| one["message"].as_str().is_some_and(|text| text.contains("`b`"))), "{found:?}");
    editor.close();
}

/// Names in a baseline are from its own folder, wherever the server runs.
#[test]
fn a_configured_baseline_may_be_in_another_folder() {
    let text = "#version 150\nout vec4 color;\nvoid main() { float a = 1.0; color = vec4(1.0); }\n";
    for name in ["known.json", "out/known.json", "../known.json"] {
        let toml = format!("[lint]\nbaseline = \"{name}\"\n");
        let folder = Folder::new(&[
            ("p/glisten.toml", toml.as_bytes()),
            ("p/sub/a.frag", text.as_bytes()),
            ("p/out/.gitignore", b""),
        ]);
        let output = folder.run(&["lint", "p", "--update-baseline"]);
        assert_eq!(output.status.code(), Some(0), "{name}: {}", String::from_utf8_lossy(&output.stderr));
        let mut editor = Editor::new(&folder, json!({}));
        editor.open("p/sub/a.frag", text);
        assert_eq!(editor.diagnostics("p/sub/a.frag").len(), 0, "{name}");
        editor.close();
    }
}

/// An include may have any name and be outside of the folders that the editor watches, and a baseline is written by `lint`.
#[test]
fn what_an_editor_does_not_watch_is_seen() {
    let shader = "#version 150\n#include \"x.inc\"\n#include \"../h.glsl\"\nout vec4 color;\n\
                  void main() { float unused = 1.0; color = vec4(one() + two()); }\n";
    let one = "float one() { return 1.0; }\n";
    let two = "float two() { return 2.0; }\n";
    let toml = "[lint]\nbaseline = \"known.json\"\n";
    let folder = Folder::new(&[
        ("p/glisten.toml", toml.as_bytes()),
        ("p/a.frag", shader.as_bytes()),
        ("p/x.inc", one.as_bytes()),
        ("h.glsl", two.as_bytes()),
    ]);
    let watches = json!({ "workspace": { "didChangeWatchedFiles": { "dynamicRegistration": true } } });
    let mut editor = Editor::new(&folder, watches);
    // The workspace is the inner folder alone.
    let root = editor.uri("");
    let p = editor.uri("p");
    editor.tell(
        "workspace/didChangeWorkspaceFolders",
        json!({ "event": { "removed": [{ "uri": root, "name": "" }], "added": [{ "uri": p, "name": "p" }] } }),
    );
    editor.open("p/a.frag", shader);
    let all = editor.diagnostics("p/a.frag").len();
    assert!(all > 0, "at least the unused variable");
    let changed = |editor: &mut Editor, file: &str, text: &str, is_it: &dyn Fn(&[Value]) -> bool| {
        // It has been looked at once before.
        std::thread::sleep(std::time::Duration::from_secs(2));
        fs::write(folder.path(file), text).expect("written");
        while !is_it(&editor.diagnostics("p/a.frag")) {}
    };
    let is_as_before = |found: &[Value]| found.len() == all;
    let is_wrong = |found: &[Value]| found.iter().any(|one| one["severity"] == 1);
    changed(&mut editor, "p/x.inc", "", &is_wrong);
    changed(&mut editor, "p/x.inc", one, &is_as_before);
    changed(&mut editor, "h.glsl", "", &is_wrong);
    changed(&mut editor, "h.glsl", two, &is_as_before);
    std::thread::sleep(std::time::Duration::from_secs(2));
    let output = folder.run(&["lint", "p", "--update-baseline"]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    while !editor.diagnostics("p/a.frag").is_empty() {}
    editor.close();
}

#[test]
fn a_name_of_a_header_is_followed_into_all_programs() {
    let header = "float half_of(float x) { return x * 0.5; }\nfloat other(float x) { return x; }\n";
    let middle = "#include \"h.glsl\"\nfloat quarter_of(float x) { return half_of(half_of(x)); }\n";
    let user = "#version 150\n#include \"h.glsl\"\nout vec4 color;\nvoid main() { color = vec4(half_of(1.0)); }\n";
    let stranger = user.replace("half_of", "other");
    let through = user.replace("h.glsl", "m.glsl").replace("half_of", "quarter_of");
    let captured = user.replace("half_of(1.0)", "other(twice)").replace("out vec4", "float twice = 1.0;\nout vec4");
    let names: Vec<String> = (0..20).map(|n| format!("u{n}.frag")).collect();
    let mut files: Vec<(&str, &[u8])> = names.iter().map(|name| (name.as_str(), user.as_bytes())).collect();
    files.extend([("h.glsl", header.as_bytes()), ("m.glsl", middle.as_bytes()), ("s.frag", stranger.as_bytes())]);
    files.extend([("t.frag", through.as_bytes()), ("c.frag", captured.as_bytes())]);
    let folder = Folder::new(&files);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("h.glsl", header);
    let mut rename = |new: &str| {
        let mut at = editor.on("h.glsl", header, "half_of");
        at["newName"] = json!(new);
        editor.answer("textDocument/rename", at)
    };
    let done = rename("split");
    let changed: Vec<&String> = done["result"]["changes"].as_object().expect("changes").keys().collect();
    assert_eq!(changed.len(), 22, "twenty users, the header, and what includes it: {changed:?}");
    let refused = rename("twice");
    assert!(refused["error"]["message"].as_str().is_some_and(|text| text.contains("twice")), "{refused}");
    editor.close();
}

/// The comment is in front of all lines that a backslash joins, and in a host where both have such comments, or in the string.
#[test]
fn allowing_a_finding_leaves_the_text_valid() {
    let condition = "#version 150\n#define A 1\n#if defined(A) && \\\n   B > 1\n#endif\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n";
    let main = "out vec4 c; uniform float x;\nvoid main() { c = vec4(x); if (x == x) c.r = 1.0; }\n";
    let joined = format!("const char* fs = \"#version 150\\n\\\n{}\";\n", main.replace('\n', "\\n\\\n"));
    let long = format!("F = \"\"\"#version 150\n{main}\"\"\"\n");
    let short = format!("F = \"\"\"{}\"\"\"\n", format!("#version 150\n{main}").replace('\n', "\\n"));
    for (name, text, code, line) in [
        ("w.frag", condition, "W0102", Some(2)),
        ("q.c", &joined, "L0025", Some(0)),
        ("q.py", &long, "L0025", Some(2)),
        ("s.py", &short, "L0025", None),
    ] {
        let folder = Folder::new(&[(name, text.as_bytes())]);
        let mut editor = Editor::new(&folder, json!({}));
        editor.open(name, text);
        let end = text.matches('\n').count();
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": end, "character": 0 } });
        let ask =
            json!({ "textDocument": { "uri": editor.uri(name) }, "range": range, "context": { "diagnostics": [] } });
        let actions = editor.ask("textDocument/codeAction", ask);
        let title = format!("Allow {code} ");
        let mut all = actions.as_array().into_iter().flatten();
        let action = all.find(|action| action["title"].as_str().is_some_and(|one| one.starts_with(&title)));
        editor.close();
        let edits = action.map(|action| action["edit"].clone());
        let begins = |edits: &Value| {
            let changes = edits["changes"].as_object().expect("changes").values().next().expect("a file").clone();
            changes[0]["range"]["start"]["line"].as_u64()
        };
        assert_eq!(edits.as_ref().and_then(begins), line, "{name}: {actions}");
        let Some(edits) = edits else { continue };
        fs::write(folder.path(name), &edited(&folder, &edits)[name]).expect("written");
        let (found, exit) = folder.lint(&["--embedded", name]);
        assert!(exit == 0 && !codes(&found).contains(&code), "{name}: {found:?}");
    }
}

/// A scene names variables as keys and as values.
#[test]
fn a_scene_follows_a_name_wherever_it_has_it() {
    let vertex = "#version 150\nin vec3 pv, nv;\nuniform mat4 mc, toMap;\nout vec3 n;\n\
        void main() { n = nv; gl_Position = mc * vec4(pv, 1.0) + toMap[0]; }\n";
    let fragment = "#version 150\nin vec3 n;\nuniform float rough;\nuniform sampler2D map;\nout vec4 c;\n\
        void main() { c = texture(map, n.xy) * rough; }\n";
    let scene = "[framebuffer]\nwidth = 8\nheight = 8\n[stability.sweep]\nrough = \"0..1:3\"\n[stability.range]\n\"toMap[0].x\" = [0, 1]\n\
        [[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nuniforms.rough = 1\n\
        [draw.mesh]\nshape = \"sphere\"\nposition = \"pv\"\nnormal = 'nv'\n[draw.matrices]\nmc = \"model_view_projection\"\n\
        [draw.textures.map]\ndepths = { camera = { eye = [2, 6, 3], ortho = 4, near = 1, far = 12 }, matrix = \"toMap\" }\n";
    let files = [("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes()), ("s.toml", scene.as_bytes())];
    let folder = Folder::new(&files);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.vert", vertex);
    editor.open("a.frag", fragment);
    for (name, text, word) in [
        ("a.vert", vertex, "pv"),
        ("a.vert", vertex, "nv"),
        ("a.vert", vertex, "mc"),
        ("a.vert", vertex, "toMap"),
        ("a.frag", fragment, "rough"),
        ("a.frag", fragment, "map"),
    ] {
        let mut there = editor.on(name, text, word);
        there["newName"] = json!("other");
        let done = edited(&folder, &editor.ask("textDocument/rename", there));
        let expected = match word {
            "map" => scene.replace("textures.map", "textures.other"),
            _ => scene.replace(word, "other"),
        };
        assert_eq!(done.get("s.toml"), Some(&expected), "{word}");
    }
    editor.close();
}

/// The resident memory of a server in KiB.
#[cfg(target_os = "linux")]
fn memory(editor: &Editor) -> u64 {
    let status = fs::read_to_string(format!("/proc/{}/status", editor.child.id())).expect("a process");
    let line = status.lines().find(|line| line.starts_with("VmRSS")).expect("a figure");
    line.split_whitespace().nth(1).and_then(|figure| figure.parse().ok()).expect("a number")
}

#[cfg(target_os = "linux")]
#[test]
fn memory_stays_as_it_is_over_many_edits() {
    let function = |n: usize| format!("float f{n}(float x) {{ float y = x * {n}.0; return sin(y) + x; }}\n");
    let functions: String = (0..150).map(function).collect();
    let text = format!(
        "#version 150\nin float v;\nout vec4 color;\n{functions}void main() {{\n    color = vec4(f7(v));\n}}\n"
    );
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &text);
    let line = text.matches('\n').count() - 2;
    let mut first = 0;
    for n in 0..900_i64 {
        let (end, letter) = if n % 2 == 0 { (4, "q") } else { (5, "") };
        let range = json!({ "start": { "line": line, "character": 4 }, "end": { "line": line, "character": end } });
        editor.change("a.frag", n + 2, json!([{ "range": range, "text": letter }]));
        if n % 3 == 0 {
            let at = json!({ "textDocument": { "uri": editor.uri("a.frag") }, "position": { "line": line, "character": 5 } });
            editor.ask("textDocument/completion", at);
        }
        editor.told.clear();
        if n == 300 {
            first = memory(&editor);
        }
    }
    let last = memory(&editor);
    assert!(last < first + 6 * 1024, "{first} KiB after 300 edits, {last} KiB after 900");
    editor.close();
}

/// The output and the exit code of a server that is told these bytes.
fn told(bytes: &[u8]) -> (String, Option<i32>) {
    let folder = Folder::new(&[]);
    let mut child = folder.command(&["lsp"]).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().expect("it runs");
    child.stdin.take().expect("it is piped").write_all(bytes).expect("it reads");
    let mut output = String::new();
    child.stdout.take().expect("it is piped").read_to_string(&mut output).expect("it writes");
    (output, child.wait().expect("it ends").code())
}

#[test]
fn messages_that_are_none_are_passed_over() {
    let message = |text: &str| format!("Content-Length: {}\r\n\r\n{text}", text.len());
    let start = message("{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"initialize\",\"params\":{\"capabilities\":{}}}");
    let end = message("{\"jsonrpc\":\"2.0\",\"id\":2,\"method\":\"shutdown\"}")
        + &message("{\"jsonrpc\":\"2.0\",\"method\":\"exit\"}");
    let garbage = "garbage \u{1}\n\r\n\r\nContent-Length: x\r\n\r\nContent-Length: -1\r\n\r\nContent-Length: 99999999999999999999\r\n\r\n";
    let wrong =
        message("{") + &message("[]") + &message("null") + &message("{\"id\":3,\"method\":4}") + &message("\u{fffd}");
    let (output, code) = told(format!("{garbage}{wrong}{start}{garbage}{wrong}{end}").as_bytes());
    assert_eq!(code, Some(0), "{output}");
    for part in ["\"serverInfo\"", "-32700", "-32600", "\"id\":2"] {
        assert!(output.contains(part), "{part}: {output}");
    }
    // Codes of the protocol: the end without a shutdown is 1.
    assert_eq!(told(format!("{start}{}", message("{\"jsonrpc\":\"2.0\",\"method\":\"exit\"}")).as_bytes()).1, Some(1));
    assert_eq!(told(start.as_bytes()).1, Some(1));
    assert_eq!(told(b"").1, Some(1));
    let early = message("{\"jsonrpc\":\"2.0\",\"id\":1,\"method\":\"textDocument/hover\"}");
    assert!(told(early.as_bytes()).0.contains("-32002"));
    let mut half = start.into_bytes();
    half.extend(b"Content-Length: 100\r\n\r\n{\"half");
    let (output, code) = told(&half);
    assert!(code == Some(1) && output.contains("the input ends after 6 of 100 bytes of a message"), "{output}");
    // Headers that are none are told, to the editor and on standard error.
    for (bad, why) in [
        ("Content-Length: abc", "the length of a message is no number: `Content-Length: abc`"),
        ("Content-Length: 99999999999999", "a message has more than 256 MiB: `Content-Length: 99999999999999`"),
        ("garbage", "this is no header: `garbage`"),
    ] {
        let folder = Folder::new(&[]);
        let mut server = folder.command(&["lsp"]);
        server.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = server.spawn().expect("it runs");
        let text = format!("{bad}\r\n\r\n{{}}");
        child.stdin.take().expect("it is piped").write_all(text.as_bytes()).expect("it reads");
        let ended = child.wait_with_output().expect("it ends");
        let (output, said) = (String::from_utf8_lossy(&ended.stdout), String::from_utf8_lossy(&ended.stderr));
        assert_eq!(said, format!("glisten lsp: {why}\n"));
        assert!(output.contains("window/logMessage") && output.contains(why), "{output}");
    }
}

/// A finding on numerics is told with inputs, once the editor rests, and not before.
#[test]
fn findings_on_numerics_come_with_inputs() {
    let text = "#version 150\nin vec3 n; in vec3 l; uniform float k; out vec4 c;\n\
                void main() { c = vec4(pow(dot(normalize(n), normalize(l)), k)); }\n";
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", text);
    assert!(editor.diagnostics("a.frag").iter().all(|one| one["code"] != "L0028"), "an edit does not wait for runs");
    let found = editor.diagnostics("a.frag");
    let shown: Vec<&str> =
        found.iter().filter(|one| one["code"] == "L0028").filter_map(|one| one["message"].as_str()).collect();
    assert_eq!(shown.len(), 1, "{found:?}");
    assert!(shown[0].contains("the reference computes it so with `n`"), "{shown:?}");
    // The text in the editor counts, not that on the disk; a sound one has nothing to wait for.
    let sound =
        text.replace("pow(dot(normalize(n), normalize(l)), k)", "pow(max(dot(normalize(n), normalize(l)), 0.0), k)");
    editor.change("a.frag", 2, json!([{ "text": sound }]));
    assert!(editor.diagnostics("a.frag").is_empty());
    let root = text.replace("pow(dot(normalize(n), normalize(l)), k)", "acos(dot(normalize(n), normalize(l)))");
    editor.change("a.frag", 3, json!([{ "text": root }]));
    assert!(editor.diagnostics("a.frag").iter().all(|one| one["code"] != "L0030"));
    assert!(editor.diagnostics("a.frag").iter().any(|one| one["code"] == "L0030"));
    editor.close();
}
