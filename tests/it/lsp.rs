//! `glisten lsp`: the program itself, through messages over pipes.

use crate::cli::Folder;
use crate::editor::{Editor, applied, edited, labels, places};
use crate::support::root;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const COMMON: &str = "// The color of a light.\nvec3 light(float amount) {\n    return vec3(amount); // é𝄞\n}\n";
const VERTEX: &str = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"common.glsl\"\n\
    in vec3 position;\nout vec3 shade;\nuniform mat4 matrix;\nuniform Lights { vec4 direction; float amount[2]; } lights;\n\
    #define SCALE(x) ((x) * factor)\nconst float factor = 2;\n#if 0\nvec3 dead = shade;\n#endif\nvoid main() {\n\
    \x20   /* é𝄞 */ shade = light(SCALE(lights.amount[0]));\n    gl_Position = matrix * vec4(position, 1.0);\n}\n";
const FRAGMENT: &str = "#version 150\nin vec3 shade;\nout vec4 color;\nvoid main() { color = vec4(shade.xyz, 1.0); }\n";
const SCENE: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
    [draw.uniforms]\nmatrix = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n\"Lights.amount\" = [1.0, 2.0]\n";

fn program() -> Folder {
    Folder::new(&[
        ("common.glsl", COMMON.as_bytes()),
        ("a.vert", VERTEX.as_bytes()),
        ("a.frag", FRAGMENT.as_bytes()),
        ("a.toml", SCENE.as_bytes()),
    ])
}

#[test]
fn navigation_crosses_includes_macros_and_stages() {
    for encoding in ["utf-16", "utf-8"] {
        let folder = program();
        let mut editor = Editor::new(&folder, json!({ "general": { "positionEncodings": [encoding] } }));
        editor.open("a.vert", VERTEX);
        assert!(editor.diagnostics("a.vert").is_empty());
        let on = |editor: &Editor, word: &str| editor.on("a.vert", VERTEX, word);
        let there = on(&editor, "light(SCALE");
        assert_eq!(places(&editor.ask("textDocument/definition", there)), ["common.glsl:1:5"]);
        let there = on(&editor, "common.glsl");
        assert_eq!(places(&editor.ask("textDocument/definition", there)), ["common.glsl:0:0"]);
        let there = on(&editor, "shade;");
        assert_eq!(places(&editor.ask("textDocument/definition", there)), ["a.frag:1:8"], "the other side");
        let mut there = on(&editor, "shade = light");
        there["context"] = json!({ "includeDeclaration": true });
        let column = if encoding == "utf-8" { 17 } else { 14 };
        let expected = ["a.frag:1:8".into(), "a.frag:3:27".into(), format!("a.vert:13:{column}"), "a.vert:4:9".into()];
        assert_eq!(places(&editor.ask("textDocument/references", there)), expected);
        let mut there = on(&editor, "factor)");
        there["context"] = json!({ "includeDeclaration": false });
        assert_eq!(places(&editor.ask("textDocument/references", there)), ["a.vert:7:24"], "in the macro's body");
        let there = on(&editor, "SCALE(lights");
        let hover = editor.ask("textDocument/hover", there)["contents"]["value"].to_string();
        assert!(hover.contains("#define SCALE(x) ((x) * factor)"), "{hover}");
        for (word, parts) in [
            ("light(SCALE", &["vec3 light(float amount)", "The color of a light."][..]),
            ("amount[0]", &["Lights.amount", "offset 16"]),
            ("factor = 2", &["const float factor = 2.0"]),
            ("shade = light", &["out vec3 shade", "in vec3 shade", "varying location 0", "smooth"]),
            ("position, 1.0", &["attribute location 0"]),
            ("gl_Position", &["clip space"]),
        ] {
            let there = on(&editor, word);
            let hover = editor.ask("textDocument/hover", there)["contents"]["value"].to_string();
            for part in parts {
                assert!(hover.contains(part), "{word}: {part}: {hover}");
            }
        }
        let there = on(&editor, "light(SCALE");
        let item = editor.ask("textDocument/prepareCallHierarchy", there)[0].clone();
        let calls = editor.ask("callHierarchy/incomingCalls", json!({ "item": item }));
        assert_eq!(calls[0]["from"]["name"], "main", "{calls}");
        let calls = editor.ask("callHierarchy/outgoingCalls", json!({ "item": calls[0]["from"] }));
        assert_eq!(calls[0]["to"]["name"], "light", "{calls}");
        let uri = editor.uri("a.vert");
        let links = editor.ask("textDocument/documentLink", json!({ "textDocument": { "uri": uri } }));
        assert!(links[0]["target"].as_str().is_some_and(|target| target.ends_with("/common.glsl")), "{links}");
        editor.close();
    }
}

#[test]
fn renames_reach_all_files_or_are_refused() {
    let folder = program();
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.vert", VERTEX);
    let mut rename = |word: &str, new: &str| {
        let mut there = editor.on("a.vert", VERTEX, word);
        there["newName"] = json!(new);
        editor.answer("textDocument/rename", there)
    };
    let done = edited(&folder, &rename("shade;", "tint")["result"]);
    assert_eq!(done["a.frag"], FRAGMENT.replace("shade", "tint"));
    assert_eq!(done["a.vert"], VERTEX.replace("shade", "tint"), "text that is left out, too");
    let done = edited(&folder, &rename("amount[2]", "strength")["result"]);
    assert_eq!(done["a.toml"], SCENE.replace("amount", "strength"));
    assert!(!done.contains_key("common.glsl"), "another `amount`");
    let done = edited(&folder, &rename("light(SCALE", "lamp")["result"]);
    assert_eq!(done["common.glsl"], COMMON.replace("light(", "lamp("));
    let done = edited(&folder, &rename("SCALE(x)", "TIMES")["result"]);
    assert_eq!(done["a.vert"], VERTEX.replace("SCALE", "TIMES"));
    for (word, new, reason) in [
        ("matrix;", "position", "would change what a name denotes"),
        ("matrix;", "float", "a word of the language"),
        ("matrix;", "gl_M", "reserved"),
        ("matrix;", "mix", "built in"),
        ("matrix;", "a b", "not an identifier"),
        ("gl_Position", "p", "a name of the language"),
        ("main", "start", "where a shader begins"),
    ] {
        let answer = rename(word, new);
        assert!(answer["error"]["message"].as_str().is_some_and(|text| text.contains(reason)), "{word}: {answer}");
    }
    editor.close();
}

/// A later use of a macro, and text behind a condition, count like any other.
#[test]
fn renames_capture_no_name_in_macros_or_behind_conditions() {
    let macros = "#version 150\n#define SCALE(x) ((x) * k)\nuniform float k;\nout vec4 color;\n\
        float g() { return SCALE(2.0); }\nvoid main() {\n    float x = 2.0;\n    color = vec4(SCALE(1.0), x, g(), 1.0);\n}\n";
    let conditions = "#version 150\n#define GAIN amount\nuniform float amount;\nuniform float bias;\nout vec4 color;\nvoid main() {\n    float x = 1.0;\n\
        #ifdef EXTRA\n    x += amount;\n#endif\n#ifdef MORE\n    float y = GAIN;\n#endif\n#ifdef LESS\n    x -= bias;\n#endif\n\
        \x20   color = vec4(x * GAIN * bias);\n}\nvoid other() {\n    float z = 1.0;\n}\n";
    let folder = Folder::new(&[("m.frag", macros.as_bytes()), ("c.frag", conditions.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("m.frag", macros);
    editor.open("c.frag", conditions);
    for (file, text, word, new, line) in [
        ("m.frag", macros, "x = 2.0", "k", Some(2)),
        ("m.frag", macros, "x = 2.0", "y", None),
        ("m.frag", macros, "k;", "y", None),
        ("c.frag", conditions, "x = 1.0", "amount", Some(9)),
        ("c.frag", conditions, "x = 1.0", "y", Some(12)),
        ("c.frag", conditions, "x = 1.0", "near", None),
        ("c.frag", conditions, "bias;", "x", Some(9)),
        ("c.frag", conditions, "bias;", "z", None),
        // The text behind a condition is in another function.
        ("c.frag", conditions, "z = 1.0", "amount", None),
    ] {
        let mut there = editor.on(file, text, word);
        there["newName"] = json!(new);
        let answer = editor.answer("textDocument/rename", there);
        let message = answer["error"]["message"].as_str();
        let expected = line.map(|line| format!("`{new}` would change what a name denotes: {file}:{line}"));
        assert_eq!(message.map(str::to_owned), expected, "{file} {word} {new}: {answer}");
    }
    editor.close();
}

#[test]
fn scalars_have_no_members_before_420() {
    let text = |version: &str| {
        format!(
            "#version {version}\nout vec4 color;\nfloat half_of(float a) {{ return a; }}\nvoid main() {{\n    half_of(1.0).\n}}\n"
        )
    };
    let folder = Folder::new(&[("a.frag", text("150").as_bytes()), ("b.frag", text("420").as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    for (file, text, offered) in [("a.frag", text("150"), &[][..]), ("b.frag", text("420"), &["x", "r", "s"])] {
        editor.open(file, &text);
        let mut there = editor.on(file, &text, "half_of(1.0).");
        let column = there["position"]["character"].as_u64().expect("a number") + 13;
        there["position"]["character"] = json!(column);
        let mut found = labels(&editor.ask("textDocument/completion", there));
        found.sort();
        let mut offered: Vec<String> = offered.iter().map(|one| (*one).to_owned()).collect();
        offered.sort();
        assert_eq!(found, offered, "{file}");
    }
    editor.close();
}

#[test]
fn a_range_is_formatted_alone() {
    let text = "#version 150\nout vec4 color;\nfloat  g( float a ){\n  float b=a ;\n    float c=b ;\n  return c ;\n}\nvoid main() { color = vec4(g(1.0)); }\n";
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", text);
    let uri = editor.uri("a.frag");
    for (first, last, new) in [
        (2, 3, text.replace("float  g( float a ){", "float g(float a) {")),
        (3, 4, text.replace("  float b=a ;", "    float b = a;")),
        (4, 6, text.replace("float c=b ;", "float c = b;").replace("  return c ;", "    return c;")),
        (7, 8, text.to_owned()),
    ] {
        let range = json!({ "start": { "line": first, "character": 0 }, "end": { "line": last, "character": 0 } });
        let options = json!({ "tabSize": 4, "insertSpaces": true });
        let ask = json!({ "textDocument": { "uri": uri }, "range": range, "options": options });
        let edits = editor.ask("textDocument/rangeFormatting", ask);
        assert_eq!(applied(text, edits.as_array().expect("a list"), false), new, "{first} to {last}");
    }
    editor.close();
}

#[test]
fn findings_are_those_of_lint_while_typing() {
    let folder = program();
    let broken = FRAGMENT.replace("in vec3 shade", "in vec4 shade").replace("shade.xyz, 1.0", "shade.xyz, undeclared");
    fs::write(folder.path("a.frag"), &broken).expect("written");
    let (lint, _) = folder.lint(&["."]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.vert", VERTEX);
    editor.open("a.frag", &broken);
    let found = editor.diagnostics("a.frag");
    let of = |list: &[Value], line: &str, code: &str| {
        let mut rows: Vec<(u64, String)> = list
            .iter()
            .map(|one| {
                let number = one.pointer(line).and_then(Value::as_u64).expect("a line");
                (number, one[code].as_str().expect("a code").to_owned())
            })
            .collect();
        rows.sort();
        rows
    };
    let lint: Vec<Value> = lint.into_iter().filter(|one| one["file"] == "a.frag").collect();
    let told: Vec<(u64, String)> =
        of(&found, "/range/start/line", "code").into_iter().map(|(a, b)| (a + 1, b)).collect();
    assert_eq!(told, of(&lint, "/line", "code"));
    assert!(found[0]["message"].as_str().expect("a text").starts_with(lint[0]["message"].as_str().expect("a text")));
    // A change of one stage changes the findings of the other.
    editor.change("a.frag", 2, json!([{ "text": FRAGMENT }]));
    // What both documents had before may be told once more.
    assert!((0..3).any(|_| editor.diagnostics("a.frag").is_empty()));
    let end = editor.at(VERTEX, "vec3 shade;");
    editor.change("a.vert", 2, json!([{ "range": { "start": end, "end": end }, "text": "flat " }]));
    let start = editor.at(VERTEX, "shade;");
    editor.change("a.vert", 3, json!([{ "range": { "start": start, "end": start }, "text": "un" }]));
    let uri = editor.uri("a.vert");
    let pulled = editor.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri } }));
    assert_eq!(pulled["kind"], "full");
    let id = pulled["resultId"].clone();
    let again =
        editor.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri }, "previousResultId": id }));
    assert_eq!(again["kind"], "unchanged");
    editor.close();
}

#[test]
fn configurations_count_and_are_watched() {
    let folder = program();
    let warns = FRAGMENT.replace("void main() {", "void main() { if (shade.x > 2.0) { return; color.x = 1.0; }");
    fs::write(folder.path("a.frag"), &warns).expect("written");
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &warns);
    let found = editor.diagnostics("a.frag");
    assert!(!found.is_empty());
    let codes: Vec<&str> = found.iter().filter_map(|one| one["code"].as_str()).collect();
    fs::write(folder.path("glisten.toml"), format!("[lint]\nallow = {codes:?}\n")).expect("written");
    let uri = editor.uri("glisten.toml");
    editor.tell("workspace/didChangeWatchedFiles", json!({ "changes": [{ "uri": uri, "type": 1 }] }));
    assert!(editor.diagnostics("a.frag").is_empty());
    // Without a word of the editor.
    std::thread::sleep(std::time::Duration::from_millis(2000));
    fs::write(folder.path("glisten.toml"), "[lint]\nallow = [\"nothing\"]\n").expect("written");
    assert!(!editor.diagnostics("a.frag").is_empty());
    assert_eq!(editor.diagnostics("glisten.toml").len(), 1, "a mistake in the configuration is told there");
    editor.close();
}

#[test]
fn completion_and_signatures_work_in_half_typed_text() {
    let folder = program();
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.vert", VERTEX);
    editor.open("a.frag", FRAGMENT);
    let mut version = 1;
    let mut typed = |editor: &mut Editor, text: &str, method: &str| {
        version += 1;
        let place = editor.at(text, "|");
        editor.change("a.vert", version, json!([{ "text": text.replacen('|', "", 1) }]));
        let uri = editor.uri("a.vert");
        editor.ask(method, json!({ "textDocument": { "uri": uri }, "position": place }))
    };
    let before = |line: &str| VERTEX.replace("    gl_Position", &format!("{line}\n    gl_Position"));
    let completion = "textDocument/completion";
    for (line, has, has_not) in [
        ("lights.|", &["direction", "amount"][..], &["light"][..]),
        ("vec3 a = position.|", &["x", "xyz", "rgb"], &["w", "mix"]),
        (
            "vec3 a = vec3(1.0, lights.amount[0] + pos|",
            &["position", "light", "factor", "SCALE", "mix", "gl_Position"],
            &["gl_FragCoord", "shade2"],
        ),
        ("for (int index = 0; index < 3; index++) { float inner = 1.0; in|", &["index", "inner", "int"], &[]),
        ("if (true) { float gone = 1.0; } go|", &["position"], &["gone"]),
        ("float a = 1.0\n lights.|", &["direction"], &[]),
        ("// lights.|", &[], &["direction"]),
    ] {
        let answer = typed(&mut editor, &before(line), completion);
        let found = if answer.is_null() { Vec::new() } else { labels(&answer) };
        for name in has {
            assert!(found.iter().any(|label| label == name), "{line}: {name}: {found:?}");
        }
        for name in has_not {
            assert!(!found.iter().any(|label| label == name), "{line}: {name}");
        }
    }
    for (text, name) in [
        (VERTEX.replace("common.glsl\"", "co|"), "common.glsl"),
        (VERTEX.replace("common.glsl\"", "|").replace('"', "<glisten/"), "phong.glsl"),
        (VERTEX.replace("#if 0", "#ifdef |"), "SCALE"),
        (VERTEX.replace("#if 0", "#|"), "ifndef"),
        (VERTEX.replace("in vec3 position;", "layout(|) in vec3 position;"), "location"),
    ] {
        assert!(labels(&typed(&mut editor, &text, completion)).iter().any(|label| label == name), "{name}");
    }
    let help = "textDocument/signatureHelp";
    let answer = typed(&mut editor, &before("vec3 a = mix(position, vec3(1.0, 2.0, 3.0), |"), help);
    assert_eq!((&answer["activeParameter"], answer["signatures"].as_array().map(Vec::len)), (&json!(2), Some(3)));
    let answer = typed(&mut editor, &before("vec3 a = light(|"), help);
    assert_eq!(answer["signatures"][0]["label"], "vec3 light(float amount)");
    // What passes from the other stage.
    editor.change("a.vert", 99, json!([{ "text": VERTEX }]));
    editor.change("a.frag", 2, json!([{ "text": FRAGMENT.replace("in vec3 shade;", "in ") }]));
    let uri = editor.uri("a.frag");
    let answer =
        editor.ask(completion, json!({ "textDocument": { "uri": uri }, "position": { "line": 1, "character": 3 } }));
    assert!(labels(&answer).iter().any(|label| label == "vec3 shade"), "{:?}", labels(&answer));
    editor.close();
}

#[test]
fn documents_are_outlined_colored_folded_and_formatted() {
    let folder = program();
    let nested = json!({ "textDocument": { "documentSymbol": { "hierarchicalDocumentSymbolSupport": true } } });
    let mut editor = Editor::new(&folder, nested);
    editor.open("a.vert", VERTEX);
    let uri = editor.uri("a.vert");
    let document = json!({ "textDocument": { "uri": uri } });
    let names = |list: &Value| -> Vec<String> {
        list.as_array().expect("a list").iter().map(|one| one["name"].as_str().expect("a text").to_owned()).collect()
    };
    let symbols = editor.ask("textDocument/documentSymbol", document.clone());
    assert_eq!(names(&symbols), ["position", "shade", "matrix", "Lights", "SCALE", "factor", "main"]);
    assert_eq!(names(&symbols[3]["children"]), ["direction", "amount"]);
    let found = editor.ask("workspace/symbol", json!({ "query": "lgt" }));
    assert!(names(&found).iter().any(|name| name == "light"), "{found}");
    let folds = editor.ask("textDocument/foldingRange", document.clone());
    assert_eq!(folds.as_array().map(Vec::len), Some(2), "{folds}");
    let tokens = editor.ask("textDocument/semanticTokens/full", document.clone());
    let n_tokens = tokens["data"].as_array().expect("numbers").len() / 5;
    let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 3, "character": 0 } });
    let part =
        editor.ask("textDocument/semanticTokens/range", json!({ "textDocument": { "uri": uri }, "range": range }));
    let n_part = part["data"].as_array().expect("numbers").len() / 5;
    assert!(n_part > 4 && n_part < n_tokens, "{n_part} of {n_tokens}");
    let whole = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
    let hints = editor.ask("textDocument/inlayHint", json!({ "textDocument": { "uri": uri }, "range": whole }));
    let hints: Vec<&str> = hints.as_array().expect("a list").iter().filter_map(|hint| hint["label"].as_str()).collect();
    for label in ["location 0", "@16", "→ float"] {
        assert!(hints.contains(&label), "{label}: {hints:?}");
    }
    let position = editor.at(VERTEX, "position, 1.0");
    let grown =
        editor.ask("textDocument/selectionRange", json!({ "textDocument": { "uri": uri }, "positions": [position] }));
    let (mut at, mut depth) = (&grown[0], 0);
    while at.is_object() {
        (at, depth) = (&at["parent"], depth + 1);
    }
    assert!(depth > 6, "{grown}");
    // Formatting gives the text of `fmt`, by lines.
    let options = json!({ "tabSize": 8, "insertSpaces": false });
    let edits = editor.ask("textDocument/formatting", json!({ "textDocument": { "uri": uri }, "options": options }));
    let formatted = folder.run_with_input(&["fmt", "--stdin-filename", "a.vert", "-"], VERTEX);
    let edits = edits.as_array().expect("a list").clone();
    assert_eq!(applied(VERTEX, &edits, false), String::from_utf8_lossy(&formatted.stdout));
    let untouched = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 4, "character": 0 } });
    let ask = json!({ "textDocument": { "uri": uri }, "range": untouched, "options": options });
    assert_eq!(editor.ask("textDocument/rangeFormatting", ask), json!([]));
    editor.close();
}

/// A name is found in every program of a workspace, however many there are, and in headers of any extension.
#[test]
fn names_are_found_in_a_whole_workspace() {
    let program = |n: usize| format!("#version 150\nout vec4 color{n};\nvoid main() {{ color{n} = vec4(1.0); }}\n");
    let version = "#version 150\n#extension GL_ARB_shading_language_include : require\n";
    let user =
        format!("{version}#include \"noise.inc\"\nout vec4 color;\nvoid main() {{ color = vec4(grain(1.0)); }}\n");
    let mut files: Vec<(String, String)> = (0..500).map(|n| (format!("p{n:03}.frag"), program(n))).collect();
    files.push(("user.frag".into(), user));
    files.push(("noise.inc".into(), "float grain(float a) {\n    return fract(a * 7.0);\n}\n".into()));
    let files: Vec<(&str, &[u8])> = files.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    let folder = Folder::new(&files);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("p000.frag", &program(0));
    let mut find = |query: &str| {
        let found = editor.ask("workspace/symbol", json!({ "query": query }));
        let found: Vec<Value> =
            found.as_array().expect("a list").iter().map(|symbol| symbol["location"].clone()).collect();
        places(&Value::from(found))
    };
    assert_eq!(find("color499"), ["p499.frag:1:9"]);
    assert_eq!(find("grain"), ["noise.inc:0:6"]);
    assert_eq!(find("nowhere").len(), 0);
    assert_eq!(find("").len(), 400);
    editor.close();
}

#[test]
fn fixes_are_actions() {
    let folder = program();
    let wrong = FRAGMENT.replace("shade.xyz", "shde.xyz");
    fs::write(folder.path("a.frag"), &wrong).expect("written");
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", &wrong);
    assert_eq!(editor.diagnostics("a.frag")[0]["code"], "E0301");
    let uri = editor.uri("a.frag");
    let range = json!({ "start": editor.at(&wrong, "shde"), "end": editor.at(&wrong, "shde") });
    let ask = json!({ "textDocument": { "uri": uri }, "range": range, "context": { "diagnostics": [] } });
    let actions = editor.ask("textDocument/codeAction", ask);
    let fix = actions.as_array().expect("a list").iter().find(|action| action["title"] == "write `shade`");
    let fix = fix.unwrap_or_else(|| panic!("{actions}"));
    assert_eq!((&fix["kind"], &fix["diagnostics"][0]["code"]), (&json!("quickfix"), &json!("E0301")));
    assert_eq!(edited(&folder, &fix["edit"])["a.frag"], FRAGMENT);
    editor.close();
}

#[test]
fn a_header_is_seen_in_its_includer() {
    let folder = program();
    let mut editor = Editor::new(&folder, json!({}));
    let wrong = COMMON.replace("vec3(amount)", "vec3(factr)");
    editor.open("common.glsl", &wrong);
    let found = editor.diagnostics("common.glsl");
    assert_eq!(found.len(), 1, "{found:?}");
    let there = editor.on("common.glsl", &wrong, "amount)");
    let hover = editor.ask("textDocument/hover", there);
    assert!(hover["contents"]["value"].to_string().contains("float amount"), "{hover}");
    let mut there = editor.on("common.glsl", &wrong, "light(");
    there["context"] = json!({ "includeDeclaration": true });
    assert_eq!(places(&editor.ask("textDocument/references", there)), ["a.vert:13:22", "common.glsl:1:5"]);
    editor.close();
}

/// A generator that is the same in every run (Steele, Lea, Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}

/// A document as an editor sees it.
fn state(editor: &mut Editor, name: &str) -> Vec<Value> {
    let uri = editor.uri(name);
    let document = json!({ "textDocument": { "uri": uri } });
    ["textDocument/diagnostic", "textDocument/documentSymbol", "textDocument/semanticTokens/full"]
        .map(|method| editor.ask(method, document.clone()))
        .to_vec()
}

#[test]
fn many_edits_leave_the_state_of_a_fresh_server() {
    const PIECES: &[&str] = &[
        "",
        "x",
        ";",
        "{",
        "}",
        "(",
        ")",
        "\n",
        "/*",
        "*/",
        "//",
        "#if 0\n",
        "#endif\n",
        "float a = 1.0;",
        ".",
        "é𝄞",
        "\\\n",
        "#define M(x) x\n",
        "M(",
        "in vec3 extra;\n",
        "shade",
        "struct S { float m; } s;",
        "\"",
    ];
    let folder = program();
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.vert", VERTEX);
    editor.open("a.frag", FRAGMENT);
    let mut random = Random(20_261_123);
    let mut text = VERTEX.to_owned();
    for version in 2..400 {
        if version % 40 == 0 {
            text = VERTEX.to_owned();
            editor.change("a.vert", version, json!([{ "text": text }]));
            continue;
        }
        let boundary = |text: &str, at: usize| (0..=at).rev().find(|&at| text.is_char_boundary(at)).unwrap_or(0);
        let start = boundary(&text, random.below(text.len() + 1));
        let end = boundary(&text, (start + random.below(12)).min(text.len())).max(start);
        let piece = PIECES[random.below(PIECES.len())];
        let position = |offset: usize| {
            let line = text[..offset].matches('\n').count();
            let from = text[..offset].rfind('\n').map_or(0, |end| end + 1);
            json!({ "line": line, "character": text[from..offset].encode_utf16().count() })
        };
        let range = json!({ "start": position(start), "end": position(end) });
        editor.change("a.vert", version, json!([{ "range": range, "text": piece }]));
        text.replace_range(start..end, piece);
        if version % 3 == 0 {
            let uri = editor.uri("a.vert");
            let at = json!({ "textDocument": { "uri": uri }, "position": { "line": 0, "character": 0 } });
            editor.ask("textDocument/hover", at.clone());
            editor.ask("textDocument/completion", at);
        }
        if version % 50 == 49 {
            let mut fresh = Editor::new(&folder, json!({}));
            fresh.open("a.vert", &text);
            fresh.open("a.frag", FRAGMENT);
            for name in ["a.vert", "a.frag"] {
                assert_eq!(state(&mut editor, name), state(&mut fresh, name), "{version}: {text}");
            }
            fresh.close();
        }
    }
    editor.close();
}

#[test]
fn hostile_text_and_messages_end_nothing() {
    let folder = program();
    let mut editor = Editor::new(&folder, json!({}));
    let deep = format!("#version 150\nvoid main() {{ float a = {}1.0{}; }}\n", "(".repeat(20_000), ")".repeat(20_000));
    let wide = format!("#version 150\nvoid main() {{ float a = 1.0{}; }}\n", " + 1.0".repeat(20_000));
    let bomb: String = (0..40).map(|n| format!("#define A{} A{n} A{n}\n", n + 1)).collect();
    let bomb = format!("#version 150\n#define A0 x\n{bomb}void main() {{ A40; }}\n");
    let texts = [deep, wide, bomb, "\0\u{1}\u{2}".repeat(500), "#include \"x.frag\"\n".to_owned(), String::new()];
    for text in &texts {
        editor.open("x.frag", text);
        let uri = editor.uri("x.frag");
        let document = json!({ "uri": uri });
        let position = json!({ "line": 1, "character": 30 });
        let whole =
            json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 4_000_000_000_u32, "character": 9 } });
        for method in ["hover", "completion", "definition", "signatureHelp", "documentHighlight", "prepareRename"] {
            let at = json!({ "textDocument": document, "position": position });
            editor.answer(&format!("textDocument/{method}"), at);
        }
        for method in ["documentSymbol", "foldingRange", "semanticTokens/full", "documentLink", "diagnostic"] {
            editor.answer(&format!("textDocument/{method}"), json!({ "textDocument": document }));
        }
        editor.answer("textDocument/inlayHint", json!({ "textDocument": document, "range": whole }));
        editor.answer("textDocument/selectionRange", json!({ "textDocument": document, "positions": [position] }));
        editor.tell("textDocument/didClose", json!({ "textDocument": document }));
    }
    assert_eq!(editor.answer("no/such", json!({}))["error"]["code"], -32601);
    assert_eq!(editor.answer("textDocument/hover", json!({ "x": 1 }))["error"]["code"], -32602);
    editor.tell("textDocument/didChange", json!({ "nonsense": true }));
    let untitled = json!({ "uri": "untitled:Untitled-1.frag", "languageId": "glsl", "version": 1, "text": FRAGMENT });
    editor.tell("textDocument/didOpen", json!({ "textDocument": untitled }));
    let at =
        json!({ "textDocument": { "uri": "untitled:Untitled-1.frag" }, "position": { "line": 1, "character": 9 } });
    assert!(editor.ask("textDocument/hover", at)["contents"]["value"].to_string().contains("in vec3 shade"));
    let is_logged = |told: &Value| told["params"]["message"].to_string().contains("`textDocument/didChange` cannot be");
    assert!(editor.told.iter().any(is_logged), "an editor's log says what could not be read");
    editor.close();
}

#[test]
fn the_editors_of_the_page_are_those_of_the_integrations() {
    let page = fs::read_to_string(root().join("docs/editors.md")).expect("a page");
    for name in ["neovim.lua", "helix.toml", "emacs.el", "zed.json"] {
        let snippet = root().join("integrations/editors").join(name);
        assert!(Path::new(&snippet).is_file() && page.contains(name), "{name}");
    }
}
