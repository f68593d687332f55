//! `glisten play` where texts and files are at stake: line endings, bytes, conflicts, several pages, what lies outside of the folders.

use crate::play::{FRAGMENT, Play, SCENE, VERTEX, browser, folder, untried};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;

fn write(folder: &Path, name: &str, bytes: impl AsRef<[u8]>) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().expect("a folder")).expect("it can be made");
    fs::write(path, bytes).expect("it can be written");
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).expect("it is there")
}

/// A scene like that of the folder under another name.
fn copy(folder: &Path, name: &str) {
    write(folder, &format!("shaders/{name}.toml"), SCENE.replace("\"a.", &format!("\"{name}.")));
    write(folder, &format!("shaders/{name}.vert"), VERTEX);
    write(folder, &format!("shaders/{name}.frag"), FRAGMENT);
}

fn look(scene: &str, texts: Value) -> Value {
    json!({ "ask": "look", "scene": scene, "texts": texts })
}

/// Whether each file of an answer may be changed.
fn writable(answer: &Value) -> Vec<(&str, bool)> {
    let files = answer["ok"]["files"].as_array().expect("a list").iter();
    files.map(|file| (file["name"].as_str().unwrap_or_default(), file["is_writable"] == json!(true))).collect()
}

#[test]
fn a_refused_save_tells_the_text_on_disk() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders"]);
    let save = |was: Value| play.post("/api/save", &json!({ "name": "shaders/a.frag", "text": "new", "was": was }));
    let refused = save(json!("another"));
    assert_eq!((refused.status, &refused.json()["disk"]), (409, &json!(FRAGMENT)));
    assert_eq!(save(refused.json()["disk"].clone()).status, 200);
    assert_eq!(read(folder.path(), "shaders/a.frag"), "new");
}

#[test]
fn bytes_that_are_not_utf8_stay() {
    let folder = folder();
    let bytes = [b"// caf\xe9\n", FRAGMENT.replace("#version 150\n", "").as_bytes()].concat();
    let bytes = [b"#version 150\n", &*bytes].concat();
    write(folder.path(), "shaders/a.frag", &bytes);
    let play = Play::start(folder.path(), &["shaders"]);
    let answer = play.ask(&look("shaders/a.toml", json!({})));
    let expected = [("shaders/a.toml", true), ("shaders/a.vert", true), ("shaders/a.frag", false)];
    assert_eq!(writable(&answer), expected);
    assert_eq!(answer["ok"]["files"][2]["fixed"], json!("its bytes are not UTF-8"));
    let was = String::from_utf8_lossy(&bytes);
    let saved = play.post("/api/save", &json!({ "name": "shaders/a.frag", "text": "new", "was": was }));
    assert_eq!(saved.status, 422, "{}", saved.body);
    assert_eq!(fs::read(folder.path().join("shaders/a.frag")).expect("it is there"), bytes);
}

#[cfg(unix)]
#[test]
fn saved_and_formatted_files_keep_their_modes() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    let path = folder.path().join("shaders/a.frag");
    let mode = || fs::metadata(&path).expect("it is there").permissions().mode() & 0o777;
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).expect("it can be set");
    let play = Play::start(folder.path(), &["shaders"]);
    let text = FRAGMENT.replace("= vec4", "=vec4");
    let job = json!({ "name": "shaders/a.frag", "text": text, "was": FRAGMENT });
    assert_eq!((play.post("/api/save", &job).status, mode()), (200, 0o640));
    fs::set_permissions(&path, fs::Permissions::from_mode(0o600)).expect("it can be set");
    let formatted = Command::new(env!("CARGO_BIN_EXE_glisten")).arg("fmt").arg(&path).output().expect("it runs");
    assert!(formatted.status.success());
    assert!(read(folder.path(), "shaders/a.frag").contains("color = vec4("), "it is rewritten");
    assert_eq!(mode(), 0o600);
}

#[test]
fn pages_of_one_server_keep_out_of_each_others_way() {
    let folder = folder();
    copy(folder.path(), "b");
    write(folder.path(), "shaders/b.toml", read(folder.path(), "shaders/b.toml").replace("0.25", "0.75"));
    let play = Play::start(folder.path(), &["shaders"]);
    let draw = |page: &str, scene: &str| {
        play.ask(&json!({ "ask": "draw", "scene": format!("shaders/{scene}.toml"), "page": page }))
    };
    let pixel = |page: &str| {
        let answer = play.ask(&json!({ "ask": "pixel", "scene": "", "page": page, "x": 3, "y": 4 }));
        answer["ok"]["reference"]["values"][0].as_str().unwrap_or_default().to_owned()
    };
    assert!(draw("one", "a")["ok"].is_object() && draw("two", "b")["ok"].is_object());
    assert_eq!((pixel("one"), pixel("two")), ("0.2500000".to_owned(), "0.7500000".to_owned()));
    assert_eq!(play.get("/api/changes?since=1&page=one").status, 200);
    // A page that is gone has no jobs.
    let forever = FRAGMENT.replace(
        "color =",
        "float s = shade;\n    for (int i = 0; i < 100000; ++i) s = sin(s + float(i));\n    color = s +",
    );
    let large = SCENE.replace("16", "1024");
    let texts = json!({ "shaders/a.frag": forever, "shaders/a.toml": large });
    let job = json!({ "ask": "draw", "scene": "shaders/a.toml", "page": "gone", "texts": texts });
    std::thread::scope(|scope| {
        let running = scope.spawn(|| play.post("/api/ask", &job).status);
        std::thread::sleep(std::time::Duration::from_millis(600));
        assert_eq!(play.post("/api/gone?page=gone", &json!({})).status, 200);
        assert_eq!(running.join().expect("it ends"), 409);
    });
    // A job of one page ends none of another.
    let endless =
        FRAGMENT.replace("color =", "for (int i = 0; i < 2000; ++i) gl_FragDepth = sin(float(i));\n    color =");
    let slow = SCENE.replace("16", "256");
    let job = |page: &str| json!({ "ask": "draw", "scene": "shaders/a.toml", "page": page, "texts": { "shaders/a.frag": endless, "shaders/a.toml": slow } });
    std::thread::scope(|scope| {
        let first = scope.spawn(|| play.post("/api/ask", &job("one")).status);
        let second = scope.spawn(|| play.post("/api/ask", &job("two")).status);
        assert_eq!((first.join().expect("it ends"), second.join().expect("it ends")), (200, 200));
    });
}

#[test]
fn texts_of_a_page_name_nothing_outside() {
    let folder = folder();
    write(folder.path(), "common/part.glsl", "#define SHADE shade\n");
    let including = FRAGMENT.replace("uniform", "#include \"../common/part.glsl\"\nuniform");
    write(folder.path(), "shaders/a.frag", &including);
    let play = Play::start(folder.path(), &["shaders"]);
    let asked = |scene: &str, texts: Value| play.post("/api/ask", &look(scene, texts));
    // Files on disk name it: it is shown, and cannot be changed. It stays so while texts change, those of a new scene, too.
    let part = ("common/part.glsl", false);
    let part_of =
        |answer: &Value| writable(answer).into_iter().find(|(name, _)| name.ends_with("part.glsl")) == Some(part);
    assert!(part_of(&asked("shaders/a.toml", json!({})).json()));
    let text = including.replace("0.5", "SHADE");
    assert!(part_of(&asked("shaders/a.toml", json!({ "shaders/a.frag": text })).json()));
    let made = play.post("/api/new-scene", &json!({ "files": ["shaders/a.frag", "shaders/a.vert"] })).json();
    assert_eq!(made["name"], json!("shaders/a-scene.toml"), "`a.toml` is there");
    assert!(part_of(&asked("shaders/a-scene.toml", json!({ "shaders/a-scene.toml": made["text"] })).json()));
    // What only the page's texts name is not.
    let secret = SCENE.replace("\"a.frag\"", "\"../secret.frag\"");
    for (name, text) in [
        ("shaders/a.toml", secret.clone()),
        ("shaders/evil.toml", secret.clone()),
        ("shaders/evil.toml", secret.replace("../secret.frag", "/etc/passwd")),
        ("shaders/a.frag", FRAGMENT.replace("uniform", "#include \"../secret.frag\"\nuniform")),
    ] {
        let scene = if name.ends_with("toml") { name } else { "shaders/a.toml" };
        for ask in ["look", "draw", "needs"] {
            let answer = play.post("/api/ask", &json!({ "ask": ask, "scene": scene, "texts": { name: text } }));
            assert_eq!(answer.status, 403, "{ask} {name}: {}", answer.body);
            assert!(!answer.body.contains("\"files\""), "{}", answer.body);
        }
    }
    // Nor do bounds that a page claims count.
    let claimed = json!({ "ask": "look", "scene": "shaders/a.toml", "texts": { "shaders/a.toml": secret }, "bounds": { "folders": ["/"] } });
    assert_eq!(play.post("/api/ask", &claimed).status, 403);
    // A scene that names it on disk shows it.
    write(folder.path(), "shaders/a.toml", &secret);
    assert_eq!(asked("shaders/a.toml", json!({})).status, 200);
}

#[test]
fn a_scene_that_is_mended_opens_its_folders() {
    let folder = folder();
    let good = SCENE.replace("\"a.", "\"../shaders/a.");
    write(folder.path(), "scenes/s.toml", good.replace("[[draw]]", "[[draw]"));
    let play = Play::start(folder.path(), &["scenes/s.toml"]);
    assert_eq!(writable(&play.ask(&look("scenes/s.toml", json!({})))), [("scenes/s.toml", true)]);
    assert_eq!(play.get("/../shaders/a.frag").status, 403);
    write(folder.path(), "scenes/s.toml", &good);
    let answer = play.ask(&look("scenes/s.toml", json!({})));
    assert_eq!(writable(&answer).len(), 3);
    assert!(writable(&answer).iter().all(|(_, is_writable)| *is_writable), "{answer}");
    // What a page saves opens no others.
    write(folder.path(), "other/a.frag", FRAGMENT);
    let text = good.replace("../shaders/a.frag", "../other/a.frag");
    assert_eq!(play.post("/api/save", &json!({ "name": "scenes/s.toml", "text": text, "was": good })).status, 200);
    let other = play.ask(&look("scenes/s.toml", json!({})));
    assert_eq!(writable(&other).last(), Some(&("scenes/../other/a.frag", false)), "{other}");
    write(folder.path(), "scenes/s.toml", &good);
    let before = play.get("/api/changes?since=none").json();
    write(folder.path(), "shaders/a.frag", FRAGMENT.replace("0.5", "0.75"));
    assert_ne!(play.get(&format!("/api/changes?since={}", before["number"])).json(), before, "it is watched, too");
}

#[test]
fn a_shader_alone_gets_a_vertex_shader_or_a_draft() {
    let folder = tempfile::tempdir().expect("a folder");
    let alone = "#version 150\nin vec2 place;\nout vec4 color;\nvoid main() { color = vec4(place, mix(0.1, 0.2, 0.5), 1.0); }\n";
    write(folder.path(), "a.frag", alone);
    write(folder.path(), "-x.frag", alone);
    write(folder.path(), "b.frag", alone.replace("mix", "mixx"));
    let play = Play::start(folder.path(), &["a.frag"]);
    let made = |file: &str, more: Value| {
        let mut wanted = json!({ "files": [file] });
        more.as_object().into_iter().flatten().for_each(|(key, value)| wanted[key] = value.clone());
        play.post("/api/new-scene", &wanted).json()
    };
    for (file, scene, vertex) in
        [("a.frag", "a.toml", "a_fullscreen.vert"), ("-x.frag", "-x.toml", "-x_fullscreen.vert")]
    {
        let made = made(file, json!({}));
        assert_eq!((&made["name"], &made["is_draft"]), (&json!(scene), &json!(false)), "{made:#}");
        let texts = json!({ scene: made["text"], vertex: made["others"][vertex] });
        let drawn = play.ask(&json!({ "ask": "draw", "scene": scene, "texts": texts }));
        assert_eq!((&drawn["ok"]["width"], &drawn["ok"]["is_empty"]), (&json!(256), &json!(false)), "{drawn}");
    }
    let draft = made("b.frag", json!({}));
    assert_eq!((&draft["is_draft"], &draft["others"]), (&json!(true), &json!({})), "{draft:#}");
    let looked = play.ask(&look("b.toml", json!({ "b.toml": draft["text"] })));
    let found = looked["ok"]["findings"].as_array().expect("a list");
    assert!(found.iter().any(|one| one["file"] == "b.frag" && one["fixes"][0].is_object()), "{looked:#}");
    // The texts of the page count.
    let mended = made("b.frag", json!({ "scene": "b.toml", "texts": { "b.frag": alone } }));
    assert_eq!(mended["is_draft"], json!(false), "{mended:#}");
    // Nothing is written, and a shader that is there is taken as it is.
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 3);
    let vertex =
        mended["others"]["b_fullscreen.vert"].as_str().expect("a text").replace("void main", "// own\nvoid main");
    write(folder.path(), "b_fullscreen.vert", vertex);
    assert_eq!(made("b.frag", json!({ "texts": { "b.frag": alone } }))["others"], json!({}));
    let outside = json!({ "files": ["a.frag"], "texts": { "a.frag": "#include \"/etc/passwd\"\n" } });
    assert_eq!(play.post("/api/new-scene", &outside).status, 403);
}

#[test]
fn answers_of_older_texts_are_told_in_a_browser() {
    let Some((browser, module)) = browser() else {
        untried();
        return;
    };
    let folder = folder();
    let alone = tempfile::tempdir().expect("a folder");
    write(
        alone.path(),
        "a.frag",
        "#version 150\nout vec4 color;\nvoid main()\n{\n    color = vec4(mixx(0.1, 0.2, 0.3));\n}\n",
    );
    let play = Play::start(folder.path(), &["shaders"]);
    let shader = Play::start(alone.path(), &["a.frag"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/play_old.mjs");
    let mut drive = Command::new("node");
    drive
        .arg(script)
        .arg(play.address())
        .arg(folder.path().join("shaders"))
        .arg(shader.address())
        .args([browser, module]);
    let ran = drive.output().expect("node runs");
    let errors = String::from_utf8_lossy(&ran.stderr);
    let seen: Value = serde_json::from_slice(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {errors}"));
    assert_eq!(seen["errors"], json!([]), "{seen:#}");
    let draft = &seen["draft"];
    let found = draft["findings"].as_array().expect("a list");
    assert!(found.len() == 1 && found[0].as_str().is_some_and(|text| text.contains("`mixx`")), "{seen:#}");
    assert_eq!((&draft["files"], &draft["focus"]), (&json!(["a.toml •", "a.frag1"]), &json!("save")), "{seen:#}");
    let made = json!(["a.toml •", "a_fullscreen.vert •", "a.frag •"]);
    assert_eq!(draft["made"].as_array().map(Vec::len), made.as_array().map(Vec::len), "{seen:#}");
    for name in ["a.toml", "a_fullscreen.vert"] {
        assert!(alone.path().join(name).is_file(), "{name} is saved");
    }
    assert!(read(alone.path(), "a.frag").contains("vec4(mix("));
    assert_eq!(seen["focus"], json!(["step-last", "step-first"]), "{seen:#}");
    assert_eq!(seen["old"], json!({ "steps": 1, "marked": 0, "hints": 0, "matched": 0, "kept": 2 }), "{seen:#}");
    let said = "the text changed meanwhile: press the fix again";
    assert_eq!(seen["fix"], json!({ "said": said, "line": "float k = mixx(0.1, 0.2, 0.3);" }), "{seen:#}");
    assert_eq!((&seen["caps"], &seen["verdict"]), (&json!(true), &json!(0)), "{seen:#}");
    assert_eq!(seen["late"], "drawing …; this is the last picture", "{seen:#}");
    assert!(seen["room"].as_f64().is_some_and(|room| room > 200.0), "{seen:#}");
    assert_eq!((&seen["waits"], &seen["alive"]), (&json!(1), &json!("")), "{seen:#}");
    assert_eq!((&seen["gone"]["links"], &seen["gone"]["back"]), (&json!(1), &json!(true)), "{seen:#}");
    let said = seen["outside"][0].as_str().unwrap_or_default();
    assert!(said.ends_with("secret.frag` is in none of the folders of `glisten play`"), "{seen:#}");
    assert_eq!(seen["outside"][1], json!(0), "{seen:#}");
    assert!(seen["gone"]["said"].as_str().is_some_and(|text| text.contains("there is no such file")), "{seen:#}");
}

#[test]
fn a_shader_starts_with_a_new_scene() {
    let folder = folder();
    fs::remove_file(folder.path().join("shaders/a.toml")).expect("it is there");
    let play = Play::start(folder.path(), &["shaders/a.frag"]);
    let page = play.get("/").body;
    let data = page.split_once("id=\"start\">").and_then(|(_, rest)| rest.split_once("</script>"));
    let start: Value = serde_json::from_str(data.expect("the data").0).expect("JSON");
    assert_eq!((&start["scene"], &start["program"]), (&json!(null), &json!(["shaders/a.frag", "shaders/a.vert"])));
    assert_eq!(
        play.post("/api/new-scene", &json!({ "files": start["program"] })).json()["name"],
        json!("shaders/a.toml")
    );
    let mut export = Command::new(env!("CARGO_BIN_EXE_glisten"));
    let ran = export.current_dir(folder.path()).args(["play", "shaders/a.frag", "--export", "a.html"]).output();
    let ran = ran.expect("the program runs");
    let said = String::from_utf8_lossy(&ran.stderr);
    assert!(ran.status.code() == Some(2) && said.contains("glisten new-scene shaders/a.frag"), "{said}");
}

/// Line endings, places and numbers, as the page's script has them.
#[test]
fn texts_and_numbers_of_the_page() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let script = root.join("crates/cli/src/commands/play/page/texts.js");
    let Ok(ran) = Command::new("node").arg(root.join("tests/it/play_texts.mjs")).arg(script).output() else {
        untried();
        return;
    };
    let errors = String::from_utf8_lossy(&ran.stderr);
    let seen: Value = serde_json::from_slice(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {errors}"));
    let expected = json!({
        "plain": "a\nb\nc\n\nd",
        "places": [0, 2, 4, 6],
        "same": true,
        "restored": "a\r\nb\nnew\r\nc\r\n\rd",
        "unix": "a\nb\n",
        "moved": [[4, 5], [13, 15], null, null, [0, 1]],
        "typed": ["1e30", "0.00002", "1e-7", "5.0", "-0.5", "7.0", "5.0", "2.0", null, null, null, null],
        "whole": ["3", "1000", "2.5", "0"],
        "slid": ["0.3", "0.7525", "3e-9", "5e+29", "12.0", "0.0"],
        "kinds": ["true", "false", "3"],
    });
    assert_eq!(seen, expected, "{seen:#}");
}

#[test]
fn nothing_is_lost_in_a_browser() {
    let Some((browser, module)) = browser() else {
        untried();
        return;
    };
    let folder = folder();
    ["b", "crlf", "latin", "cfg", "lens"].into_iter().for_each(|name| copy(folder.path(), name));
    let at = |name: &str| format!("shaders/{name}");
    let crlf = |text: &str| text.replace('\n', "\r\n");
    let broken = FRAGMENT.replace("vec4(shade, 0.5", "vec4(mixx(shade, 0.0, 0.5), 0.5");
    for (name, text) in
        [("crlf.toml", &*SCENE.replace("\"a.", "\"crlf.")), ("crlf.vert", VERTEX), ("crlf.frag", &broken)]
    {
        write(folder.path(), &at(name), crlf(text));
    }
    write(folder.path(), "shaders/latin.frag", [FRAGMENT.as_bytes(), b"// caf\xe9\n"].concat());
    write(folder.path(), "shaders/b.toml", SCENE.replace("\"a.", "\"b.").replace("0.25", "0.75"));
    write(folder.path(), "shaders/cfg.toml", "name = \"mine\"\n");
    for (from, to) in [("lens.vert", "lens.glslv"), ("lens.frag", "lens.glslf")] {
        fs::rename(folder.path().join(at(from)), folder.path().join(at(to))).expect("it can be renamed");
    }
    fs::remove_file(folder.path().join("shaders/lens.toml")).expect("it is there");
    let play = Play::start(folder.path(), &["shaders"]);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/play_edits.mjs");
    let (shaders, process) = (folder.path().join("shaders"), play.child.id().to_string());
    let mut drive = Command::new("node");
    drive.arg(script).arg(play.address()).arg(shaders).args([process, browser, module]);
    let ran = drive.output().expect("node runs");
    let errors = String::from_utf8_lossy(&ran.stderr);
    let seen: Value = serde_json::from_slice(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {errors}"));
    assert_eq!(seen["errors"], json!([]), "{seen:#}");
    let drawn = seen["foreign"]["drawn"].as_str().unwrap_or_default();
    assert!(drawn.starts_with("Not drawn: there is no function"), "{seen:#}");
    assert_eq!((&seen["foreign"]["pictures"], &seen["foreign"]["state"]), (&json!(0), &json!("1 error")), "{seen:#}");
    let mended = crlf(&broken.replace("mixx", "mix"));
    let scene = crlf(&SCENE.replace("\"a.", "\"crlf.").replace("0.25", "1.0"));
    assert_eq!(seen["crlf"], json!({ "said": "saved", "frag": mended, "toml": scene }), "{seen:#}");
    let title = "shaders/latin.frag (cannot be changed here: its bytes are not UTF-8)";
    assert_eq!(seen["latin"], json!({ "title": title, "fixed": 1, "typed": true }), "{seen:#}");
    assert_eq!(seen["numbers"], json!(["1e30", "0.00002", "1e-7", "0.123456789", "5.0", "-0.5"]), "{seen:#}");
    let moved = json!({ "first": "# a comment of some length", "shade": "shade = 0.75", "typed": "shade = 0.755" });
    assert_eq!(seen["moved"], moved, "{seen:#}");
    assert_eq!((&seen["reload"], &seen["lost"]), (&json!(["beforeunload"]), &json!(["beforeunload"])), "{seen:#}");
    let focus = json!({ "file": "shaders/a.toml", "step": "2", "arrow": "3", "end": true });
    assert_eq!((&seen["focus"], &seen["stops"], &seen["named"]), (&focus, &json!(1), &json!(1)), "{seen:#}");
    let outside = json!({ "said": "Not inspected: the picture has no pixel 1e+300, 8", "old": 1 });
    assert_eq!(seen["outside"], outside, "{seen:#}");
    let conflict = seen["conflict"].as_str().unwrap_or_default();
    assert!(conflict.starts_with("shaders/a.frag: the file changed on disk meanwhile."), "{seen:#}");
    for key in ["overwritten", "taken", "refocused"] {
        assert_eq!(seen[key], json!(true), "{key}: {seen:#}");
    }
    assert_eq!(seen["programs"], json!(["shaders/lens.glslf, shaders/lens.glslv"]), "{seen:#}");
    assert_eq!(seen["made"], json!("shaders/cfg-scene.toml"), "{seen:#}");
    assert_eq!((&seen["pixels"], &seen["followed"]), (&json!(["0.2500000", "0.7500000"]), &json!(4)), "{seen:#}");
    assert_eq!(seen["listed"], json!(true), "the scene that is shown stays in the list: {seen:#}");
    assert!(seen["ended"].as_str().is_some_and(|said| said.contains("has ended")), "{seen:#}");
}
