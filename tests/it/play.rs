//! `glisten play`: the address, who is refused, what the page asks for, saving, workers that hang or are outdated, the page as a
//! file.

use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::Duration;

pub(crate) const SCENE: &str = "[framebuffer]\nwidth = 16\nheight = 16\n\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\n\
    [draw.uniforms]\nshade = 0.25\n";
pub(crate) const VERTEX: &str = "#version 150\nvoid main()\n{\n    vec2 p = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);\n    \
    gl_Position = vec4(p, 0.0, 1.0);\n}\n";
pub(crate) const FRAGMENT: &str =
    "#version 150\nuniform float shade;\nout vec4 color;\nvoid main()\n{\n    color = vec4(shade, 0.5, 1.0, 1.0);\n}\n";

pub(crate) fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in [("shaders/a.toml", SCENE), ("shaders/a.vert", VERTEX), ("shaders/a.frag", FRAGMENT)] {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("it can be made");
        fs::write(path, text).expect("it can be written");
    }
    fs::write(folder.path().join("secret.frag"), "secret").expect("it can be written");
    folder
}

/// A running server.
pub(crate) struct Play {
    pub(crate) child: Child,
    port: u16,
    token: String,
}

impl Drop for Play {
    fn drop(&mut self) {
        // It may have ended on its own.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

pub(crate) struct Answer {
    pub(crate) status: u16,
    head: String,
    pub(crate) body: String,
}

impl Answer {
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|error| panic!("{error}: {}", self.body))
    }
}

impl Play {
    pub(crate) fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.current_dir(folder).arg("play").args(arguments).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().expect("the program starts");
        let mut line = String::new();
        let output = child.stdout.take().expect("it is piped");
        BufReader::new(output).read_line(&mut line).expect("there is a line");
        let address = line.trim().strip_prefix("http://127.0.0.1:").expect("the address comes first");
        let (port, token) = address.split_once("/?token=").expect("it has a token");
        Self { child, port: port.parse().expect("a port"), token: token.to_owned() }
    }

    /// Sends a request with these headers, and nothing else.
    fn send(&self, method: &str, path: &str, headers: &[(&str, &str)], body: &str) -> Answer {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        stream.set_read_timeout(Some(Duration::from_secs(90))).expect("it has a limit");
        let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let length = body.len();
        write!(stream, "{method} {path} HTTP/1.0\r\n{headers}Content-Length: {length}\r\n\r\n{body}")
            .expect("it listens");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("it answers");
        let (head, body) = text.split_once("\r\n\r\n").expect("it has a head");
        let status = head.split(' ').nth(1).and_then(|status| status.parse().ok()).expect("a status");
        Answer { status, head: head.to_owned(), body: body.to_owned() }
    }

    pub(crate) fn host(&self) -> String {
        format!("127.0.0.1:{}", self.port)
    }

    /// The address of the page.
    pub(crate) fn address(&self) -> String {
        format!("http://{}/?token={}", self.host(), self.token)
    }

    pub(crate) fn get(&self, path: &str) -> Answer {
        self.send("GET", path, &[("Host", &self.host()), ("X-Glisten-Token", &self.token)], "")
    }

    pub(crate) fn post(&self, path: &str, body: &Value) -> Answer {
        self.send("POST", path, &[("Host", &self.host()), ("X-Glisten-Token", &self.token)], &body.to_string())
    }

    pub(crate) fn ask(&self, job: &Value) -> Value {
        let answer = self.post("/api/ask", job);
        assert_eq!(answer.status, 200, "{}", answer.body);
        answer.json()
    }
}

#[test]
fn strangers_get_403() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders"]);
    let (host, token) = (play.host(), play.token.as_str());
    let own = [("Host", host.as_str()), ("X-Glisten-Token", token)];
    let origin = format!("http://{host}");
    let page = play.send("GET", &format!("/?token={token}"), &[("Host", &host)], "");
    assert_eq!(page.status, 200);
    assert!(page.head.contains("text/html") && page.head.contains("Content-Security-Policy"), "{}", page.head);
    assert_eq!(play.send("GET", "/", &[own[0], own[1], ("Origin", &origin)], "").status, 200);
    for headers in [
        &[("Host", host.as_str())][..],
        &[("Host", &host), ("X-Glisten-Token", "0123456789abcdef0123456789abcdef")],
        &[("Host", "example.org"), own[1]],
        &[own[1]],
        &[own[0], own[1], ("Origin", "http://example.org")],
        &[own[0], own[1], ("Origin", "null")],
    ] {
        for (method, path) in [("GET", "/"), ("GET", "/shaders/a.frag"), ("GET", "/api/list"), ("POST", "/api/ask")] {
            assert_eq!(play.send(method, path, headers, "{}").status, 403, "{method} {path} {headers:?}");
        }
    }
    for path in [
        "/../secret.frag",
        "/%2e%2e/secret.frag",
        "/..%2fsecret.frag",
        "//etc/passwd",
        "/%2Fetc%2Fpasswd",
        "/a/../../secret.frag",
    ] {
        assert_eq!(play.get(path).status, 403, "{path}");
    }
    assert_eq!(play.get("/a.frag").body, FRAGMENT);
    for path in ["/b.frag", "/none/new.frag", "/api/nothing"] {
        assert_eq!(play.get(path).status, 404, "{path}");
    }
    for (path, body) in [
        ("/api/save", json!({ "name": "secret.frag", "text": "", "was": "secret" })),
        ("/api/save", json!({ "name": "shaders/../secret.frag", "text": "", "was": "secret" })),
        ("/api/ask", json!({ "ask": "look", "scene": "/etc/passwd" })),
        ("/api/ask", json!({ "ask": "look", "scene": "shaders/a.toml", "texts": { "secret.frag": "" } })),
        ("/api/new-scene", json!({ "files": ["secret.frag"] })),
        ("/api/new-scene", json!({ "files": ["shaders/a.frag"], "scene": "a.toml" })),
    ] {
        assert_eq!(play.post(path, &body).status, 403, "{path} {body}");
    }
    assert_eq!(fs::read_to_string(folder.path().join("secret.frag")).expect("it is there"), "secret");
}

#[test]
fn texts_of_the_page_count_instead_of_files() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders"]);
    let listed = play.get("/api/list").json();
    assert_eq!(listed["scenes"], json!(["shaders/a.toml"]));
    let looked = play.ask(&json!({ "ask": "look", "scene": "shaders/a.toml" }));
    let ok = &looked["ok"];
    let names: Vec<&str> =
        ok["files"].as_array().expect("a list").iter().filter_map(|file| file["name"].as_str()).collect();
    assert_eq!(names, ["shaders/a.toml", "shaders/a.vert", "shaders/a.frag"]);
    assert_eq!(ok["files"][0]["is_writable"], json!(true));
    assert_eq!(ok["controls"][0]["path"], json!(["draw", "0", "uniforms", "shade"]));
    let wgsl = ok["programs"][0]["stages"][1]["text"].as_str().expect("a text");
    assert!(wgsl.contains("@fragment"), "{wgsl}");
    let wrong = FRAGMENT.replace("shade,", "shado,");
    let looked = play.ask(&json!({ "ask": "look", "scene": "shaders/a.toml", "texts": { "shaders/a.frag": wrong } }));
    let found = &looked["ok"]["findings"][0];
    assert_eq!((&found["file"], &found["line"]), (&json!("shaders/a.frag"), &json!(6)), "{looked}");
    assert!(found["fixes"][0]["edits"][0]["text"] == json!("shade"), "{found}");
    let other = SCENE.replace("0.25", "1.0");
    let drawn = |texts: Value| {
        let job = json!({ "ask": "draw", "scene": "shaders/a.toml", "texts": texts });
        let drawn = play.ask(&job);
        assert_eq!(drawn["ok"]["width"], json!(16), "{drawn}");
        let pixel = play.ask(&json!({ "ask": "pixel", "scene": "", "x": 3, "y": 4 }));
        pixel["ok"]["reference"]["values"][0].as_str().expect("a number").to_owned()
    };
    assert_eq!(drawn(json!({})), "0.2500000");
    assert_eq!(drawn(json!({ "shaders/a.toml": other })), "1.0000000");
    assert_eq!(drawn(json!({})), "0.2500000", "a text counts for its own question");
    let leaves = json!({ "ask": "look", "scene": "shaders/a.toml", "target": "glsl", "leaves_out": true });
    let glsl = play.ask(&leaves)["ok"]["programs"][0]["stages"][1]["text"].to_string();
    assert!(!glsl.contains("shade") && glsl.contains("0.25"), "{glsl}");
}

#[test]
fn a_pixel_is_followed_through_texts_of_the_page() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders"]);
    let text = FRAGMENT.replace("shade, 0.5", "shade * 3.0, 0.5");
    let trace = |x: u32| {
        play.ask(
            &json!({ "ask": "trace", "scene": "shaders/a.toml", "x": x, "y": 4, "texts": { "shaders/a.frag": text } }),
        )
    };
    let found = trace(3);
    let steps = found["ok"]["invocations"][0]["steps"].as_array().expect("a list");
    let product = steps.iter().find(|step| step["text"] == "shade * 3.0").expect("an expression of the new text");
    assert_eq!((&product["value"], &product["file"]), (&json!([0.75]), &json!("shaders/a.frag")));
    assert!(trace(16)["error"].as_str().is_some_and(|error| error.contains("16 by 16")));
    let outside = json!({ "ask": "trace", "scene": "secret.frag", "x": 0, "y": 0 });
    assert_eq!(play.post("/api/ask", &outside).status, 403);
}

#[test]
fn studies_are_those_of_the_commands() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders"]);
    let study = |ask: &str, text: &str| {
        play.ask(&json!({ "ask": ask, "scene": "shaders/a.toml", "texts": { "shaders/a.frag": text } }))["ok"].clone()
    };
    let needs = study("needs", FRAGMENT);
    let draw = &needs["draws"][0];
    assert_eq!(draw["left_out"][0]["because"], "it is 0.25", "{needs:#}");
    assert_eq!((&draw["left_out"][0]["file"], &draw["left_out"][0]["line"]), (&json!("shaders/a.frag"), &json!(2)));
    assert_eq!((&draw["before"]["uniform_bytes"], &draw["after"]["uniform_bytes"]), (&json!(16), &json!(0)));
    let stable = study("stability", FRAGMENT);
    assert_eq!((&stable["verdict"], &stable["causes"]), (&json!("stable"), &json!([])), "{stable:#}");
    let hurt = study("stability", &FRAGMENT.replace("shade, 0.5", "(shade + 1.0e8) - 1.0e8, 0.5"));
    assert_ne!(hurt["verdict"], "stable", "{hurt:#}");
    assert_eq!((&hurt["causes"][0]["line"], &hurt["width"]), (&json!(6), &json!(16)), "{hurt:#}");
    assert!(hurt["map"].as_str().is_some_and(|uri| uri.starts_with("data:image/png;base64,")));
    let report = study("variants", &FRAGMENT.replace("shade, 0.5", "pow(shade, 3.0), 0.5"));
    let ways = report["ways"].as_array().expect("a list");
    assert!(ways.len() > 2, "{report:#}");
    for way in ways {
        assert!(way["picture"].as_str().is_some_and(|uri| uri.starts_with("data:image/png;base64,")), "{way:#}");
        assert!(way["title"].is_string() && way["error"]["rmse"].is_number() && way["ratio"]["median"].is_number());
    }
    assert_eq!(ways[0]["title"], "as written");
}

#[test]
fn a_saved_file_is_written_unless_it_changed() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders/a.toml"]);
    let path = folder.path().join("shaders/a.frag");
    let new = FRAGMENT.replace("0.5", "0.75");
    let save = |was: &str| play.post("/api/save", &json!({ "name": "shaders/a.frag", "text": new, "was": was })).status;
    assert_eq!(save("another text"), 409);
    assert_eq!(fs::read_to_string(&path).expect("it is there"), FRAGMENT);
    let before = play.get("/api/changes?since=none").json();
    assert_eq!(save(FRAGMENT), 200);
    assert_eq!(fs::read_to_string(&path).expect("it is there"), new);
    let after = play.get(&format!("/api/changes?since={}", before["number"])).json();
    assert_ne!(before, after, "the page hears of it");
}

#[test]
fn shaders_without_a_scene_get_one() {
    let folder = folder();
    fs::remove_file(folder.path().join("shaders/a.toml")).expect("it is there");
    let play = Play::start(folder.path(), &["shaders"]);
    let listed = play.get("/api/list").json();
    assert_eq!(listed["programs"], json!([["shaders/a.frag", "shaders/a.vert"]]));
    let made = play.post("/api/new-scene", &json!({ "files": listed["programs"][0] })).json();
    let (name, text) = (made["name"].as_str().expect("a name"), made["text"].as_str().expect("a text"));
    assert!(text.contains("[[draw]]"), "{made}");
    let job = json!({ "ask": "draw", "scene": name, "texts": { name: text } });
    assert!(play.ask(&job)["ok"]["picture"].as_str().is_some_and(|uri| uri.starts_with("data:image/png")));
}

#[test]
fn the_newest_question_does_not_wait_for_one_without_end() {
    let folder = folder();
    let endless = FRAGMENT.replace(
        "color =",
        "float s = shade;\n    for (int i = 0; i < 100000; ++i) s = sin(s + float(i));\n    color = s +",
    );
    let scene = SCENE.replace("16", "1024");
    let play = Play::start(folder.path(), &["shaders", "--timeout", "50"]);
    let job = json!({
        "ask": "draw", "scene": "shaders/a.toml", "texts": { "shaders/a.frag": endless, "shaders/a.toml": scene },
    });
    std::thread::scope(|scope| {
        let older = scope.spawn(|| play.post("/api/ask", &job).status);
        std::thread::sleep(Duration::from_millis(600));
        let drawn = play.ask(&json!({ "ask": "draw", "scene": "shaders/a.toml" }));
        assert_eq!(drawn["ok"]["width"], json!(16), "{drawn}");
        assert_eq!(older.join().expect("it ends"), 409);
    });
}

#[test]
fn the_gpus_picture_is_judged() {
    let folder = folder();
    let play = Play::start(folder.path(), &["shaders"]);
    let judged = play.ask(&json!({ "ask": "judge", "scene": "shaders/a.toml" }));
    assert_eq!(judged["ok"]["verdict"], json!("holds"), "{judged}");
    for picture in ["reference", "driver", "difference", "evidence"] {
        assert!(judged["ok"][picture].as_str().is_some_and(|uri| uri.starts_with("data:image/png")), "{picture}");
    }
    let pixel = play.ask(&json!({ "ask": "pixel", "scene": "", "x": 0, "y": 0 }));
    assert_eq!(pixel["ok"]["driver"]["values"][1], json!("0.5000000"));
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it() {
    let folder = folder();
    let mut play = Play::start(folder.path(), &["shaders"]);
    play.ask(&json!({ "ask": "look", "scene": "shaders/a.toml" }));
    let number = play.child.id().to_string();
    assert!(Command::new("kill").args(["-INT", &number]).status().expect("kill runs").success());
    assert_eq!(play.child.wait().expect("it ends").code(), Some(130));
}

#[test]
fn a_page_is_exported_whole() {
    let folder = folder();
    let run = |arguments: &[&str]| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.current_dir(folder.path()).arg("play").args(arguments).output().expect("the program runs")
    };
    let made = run(&["--export", "page.html", "shaders/a.toml"]);
    assert_eq!(made.status.code(), Some(0), "{}", String::from_utf8_lossy(&made.stderr));
    let page = fs::read_to_string(folder.path().join("page.html")).expect("it is written");
    for part in ["data:image/png", "@fragment", "\"verdict\":\"holds\"", "uniform float shade", "msl-left-out"] {
        assert!(page.contains(part), "{part}");
    }
    for outside in ["https://", "url(http", "@import", "<link", "src=\"http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    let refused = run(&["--export", "page.html", "shaders"]);
    assert_eq!(refused.status.code(), Some(2));
    let again = run(&["--export", "again.html", "shaders/a.toml"]);
    assert_eq!(again.status.code(), Some(0));
    let again = fs::read_to_string(folder.path().join("again.html")).expect("it is written");
    assert!(again == page, "the same call writes the same page");
    let scene = fs::read(folder.path().join("shaders/a.toml")).expect("it is there");
    let refused = run(&["--export", "shaders/../shaders/a.toml", "shaders/a.toml"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("is one of the inputs"));
    assert_eq!(fs::read(folder.path().join("shaders/a.toml")).expect("it is there"), scene);
    fs::write(folder.path().join("shaders/a.frag"), "#version 150\nvoid main() { x }\n").expect("it can be written");
    let refused = run(&["--export", "other.html", "shaders/a.toml"]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(!folder.path().join("other.html").exists());
}

/// The exit code and the messages of `glisten play --export FILE --module`, and the page.
fn exported_alone(folder: &Path, module: &Path, start: &str, more: &[&str]) -> (Option<i32>, String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.current_dir(folder).args(["play", start, "--export", "alone.html", "--module"]).arg(module).args(more);
    let ran = command.output().expect("the program runs");
    let page = fs::read_to_string(folder.join("alone.html")).unwrap_or_default();
    (ran.status.code(), String::from_utf8_lossy(&ran.stderr).into_owned(), page)
}

/// The data that the script of a page starts with.
fn start_of(page: &str) -> Value {
    let data = page.split_once("id=\"start\">").and_then(|(_, rest)| rest.split_once("</script>"));
    serde_json::from_str(data.expect("the data").0).expect("JSON")
}

#[test]
fn a_page_with_a_module_holds_what_its_scenes_read() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let module = path("any.wasm");
    fs::write(&module, b"\0asm\x01\0\0\0").expect("it can be written");
    fs::write(path("shaders/broken.toml"), SCENE.replace("a.frag", "none.frag")).expect("it can be written");
    fs::write(path("shaders/part.glsl"), "#define SHADE shade\n").expect("it can be written");
    let included = FRAGMENT.replace("uniform", "#include \"part.glsl\"\nuniform").replace("vec4(shade", "vec4(SHADE");
    fs::write(path("shaders/a.frag"), included).expect("it can be written");
    let (code, said, page) = exported_alone(folder.path(), &module, "shaders", &["-DMORE=1", "-I", "shaders"]);
    assert_eq!(code, Some(0), "{said}");
    assert!(
        said.contains("warning: `shaders/broken.toml` is not in the page") && said.contains("with a scene"),
        "{said}"
    );
    let start = start_of(&page);
    assert_eq!(start["list"]["scenes"], json!(["shaders/a.toml"]));
    let files: Vec<&String> = start["files"].as_object().expect("files").keys().collect();
    assert_eq!(files, ["shaders/a.frag", "shaders/a.toml", "shaders/a.vert", "shaders/part.glsl"]);
    assert_eq!(start["request"], json!({ "defines": [["MORE", "1"]], "folders": ["shaders"], "options": [] }));
    let card = start["gallery"][0]["picture"].as_str().expect("a picture");
    assert!(card.starts_with("data:image/png;base64,"), "{card:.60}");
    assert!(!page.contains("secret"), "only what scenes read is in it");
    // What cannot be done is said, and nothing is written.
    fs::remove_file(path("alone.html")).expect("it is there");
    fs::write(path("text.wasm"), "module").expect("it can be written");
    for (module, start, more, expected, reason) in [
        ("text.wasm", "shaders", &[][..], 2, "is no WebAssembly module"),
        ("none.wasm", "shaders", &[], 2, "integrations/web/make page"),
        ("any.wasm", "shaders/broken.toml", &[], 1, "none.frag"),
        ("any.wasm", "shaders", &["--engine", "iris"], 2, "knows no `--engine`"),
    ] {
        let (code, said, page) = exported_alone(folder.path(), &path(module), start, more);
        assert!(
            code == Some(expected) && said.contains(reason) && page.is_empty(),
            "{module} {start}: {code:?} {said}"
        );
    }
    fs::write(path("shaders/glisten.toml"), "[[source]]\ndefines = [\"A=1\"]\n").expect("it can be written");
    let (code, said, _) = exported_alone(folder.path(), &module, "shaders/a.toml", &[]);
    assert!(code == Some(1) && said.contains("`[[source]]` tables"), "{said}");
}

/// The browser and the module that drives it, if both are installed: Debian's `chromium`, and
/// `npm install --prefix target/browser playwright-core`.
pub(crate) fn browser() -> Option<(String, String)> {
    let found = Command::new("which").arg("chromium").output().ok().filter(|found| found.status.success())?;
    let module = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/browser/node_modules/playwright-core/index.mjs");
    let browser = String::from_utf8_lossy(&found.stdout).trim().to_owned();
    module.is_file().then(|| (browser, module.to_string_lossy().into_owned()))
}

/// Says that there is no browser. The test harness does not capture this: what was not tried must be visible.
pub(crate) fn untried() {
    let message = "\nthe page is not tried: install `chromium`, and playwright-core in target/browser";
    writeln!(std::io::stderr(), "{message}").expect("standard error can be written to");
}

#[test]
fn the_page_works_in_a_browser() {
    let Some((browser, module)) = browser() else {
        untried();
        return;
    };
    let folder = folder();
    with_camera(folder.path());
    let scene = folder.path().join("shaders/a.toml");
    fs::copy(&scene, scene.with_file_name("b.toml")).expect("it can be written");
    let page = folder.path().join("page.html");
    let mut export = Command::new(env!("CARGO_BIN_EXE_glisten"));
    export.current_dir(folder.path()).args(["play", "--export", "page.html", "shaders/a.toml"]);
    assert!(export.status().expect("the program runs").success());
    let play = Play::start(folder.path(), &["shaders/a.toml"]);
    let address = format!("http://{}/?token={}", play.host(), play.token);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/it/play.mjs");
    let ran =
        Command::new("node").arg(script).arg(address).arg(page).args([browser, module]).output().expect("node runs");
    let errors = String::from_utf8_lossy(&ran.stderr);
    let seen: Value = serde_json::from_slice(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {errors}"));
    assert_eq!(seen["errors"], json!([]), "{seen:#}");
    assert_eq!(seen["files"].as_array().map(Vec::len), Some(3), "{seen:#}");
    for key in ["wgsl", "reflection", "mark", "fixed", "slider", "turned", "kept"] {
        assert_eq!(seen[key], json!(true), "{key}: {seen:#}");
    }
    assert_eq!(seen["drag"], json!(false), "a drag inspects nothing: {seen:#}");
    for (key, part) in [
        ("inspected", "2 fragments; color (1, 0.5, 1, 1)"),
        ("last", "out color"),
        ("back", "color.r = mix(color.r, 1.0, 0.5)"),
        ("emphasis", "color.r = mix(color.r, 1.0, 0.5)"),
        ("value", "float\n1"),
    ] {
        assert!(seen[key].as_str().is_some_and(|text| text.contains(part)), "{key}: {seen:#}");
    }
    assert!(seen["finding"].as_str().is_some_and(|text| text.contains("there is no function `mixx`")), "{seen:#}");
    assert_eq!((&seen["verdict"], &seen["pictures"]), (&json!("holds"), &json!(4)), "{seen:#}");
    assert_eq!(seen["width"], json!(360), "nothing is wider than a narrow window");
    assert_eq!(seen["exported"], json!({ "msl": true, "asked": [], "needless": 2, "stable": "stable" }));
    assert_eq!(
        seen["needs"],
        json!({ "crossed": "uniform float shade;", "file": "a.frag:2", "old": true }),
        "{seen:#}"
    );
    assert_eq!(seen["stability"], json!({ "verdict": "stable", "map": 1 }), "{seen:#}");
    let saved = fs::read_to_string(folder.path().join("shaders/a.toml")).expect("it is there");
    assert!(saved.contains("shade = 1.0") && !saved.contains("eye = [0.0, 0.0, 4.0]"), "{saved}");
    let saved = fs::read_to_string(folder.path().join("shaders/a.frag")).expect("it is there");
    assert!(saved.contains("color.r = mix(color.r, 1.0, 0.5);"), "{saved}");
}

/// The lessons of `docs/tutorial.md`, to the letter.
#[test]
fn the_lessons_of_the_tutorial_can_be_done_in_a_browser() {
    let Some((browser, module)) = browser() else {
        untried();
        return;
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["globe.vert", "globe.frag"] {
        fs::copy(root.join("fixtures/tutorial").join(name), folder.path().join(name)).expect("it can be copied");
    }
    let play = Play::start(folder.path(), &["."]);
    let address = format!("http://{}/?token={}", play.host(), play.token);
    let script = root.join("tests/it/lessons.mjs");
    let ran = Command::new("node").arg(script).arg(address).args([browser, module]).output().expect("node runs");
    let errors = String::from_utf8_lossy(&ran.stderr);
    let seen: Value = serde_json::from_slice(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {errors}"));
    assert_eq!(seen["errors"], json!([]), "{seen:#}");
    let page = fs::read_to_string(root.join("docs/tutorial.md")).expect("it is there");
    for (key, part) in [
        ("finding", "`colour` is not declared"),
        ("finding", "did you mean `color`?"),
        ("finding", "write `color`"),
        ("last", "out color"),
        ("step", "max(dot(normalize(normal), towardsLight), 0.0)"),
        ("verdict", "holds"),
    ] {
        assert!(seen[key].as_str().is_some_and(|text| text.contains(part)), "{key}: {seen:#}");
        let told = page.replace("\n   ", " ");
        assert!(told.contains(part), "the page does not tell `{part}`");
    }
    assert!(seen["value"].as_str().is_some_and(|text| text.starts_with("albedo: vec3")), "{seen:#}");
    assert_eq!((&seen["dot"], &seen["number"]), (&json!(true), &json!("-1")), "{seen:#}");
    let light = "    let light = 0.1 + 0.9 * max(dot(normalize(normal), uniforms.towardsLight), 0.0);";
    assert_eq!(seen["matched"]["wgsl"], json!([light]), "{seen:#}");
    assert_eq!(seen["matched"]["glsl"], json!(["    vec3 albedo = texture(surface, place).rgb;"]), "{seen:#}");
    assert_eq!(seen["crossed"], json!(["uniform vec3 towardsLight;"]), "{seen:#}");
    let reflection = seen["reflection"].as_str().unwrap_or_default();
    assert!(reflection.contains("group 1, binding 0; sampler: group 1, binding 1"), "{reflection}");
    assert!(!reflection.contains("undefined"), "{reflection}");
}

/// The scene of these tests with a cube that a camera looks at.
fn with_camera(folder: &Path) {
    let camera = "[camera]\neye = [0.0, 0.0, 4.0]\ntarget = [0.0, 0.0, 0.0]\n\n";
    let scene = SCENE.replace("[[draw]]", &format!("{camera}[[draw]]")).replace(
        "vertex_count = 3\n",
        "\n[draw.mesh]\nshape = \"cube\"\n\n[draw.matrices]\nmatrix = \"model_view_projection\"\n",
    );
    let vertex = "#version 150\nin vec3 position;\nuniform mat4 matrix;\nvoid main()\n{\n    gl_Position = matrix * vec4(position, 1.0);\n}\n";
    fs::write(folder.join("shaders/a.toml"), scene).expect("it can be written");
    fs::write(folder.join("shaders/a.vert"), vertex).expect("it can be written");
}

#[test]
fn the_page_computes_by_itself_in_a_browser() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let module = root.join("target/web/play.wasm.gz");
    let Some((browser, driver)) = browser().filter(|_| module.is_file()) else {
        let message =
            "\nthe page with a module is not tried: `integrations/web/make page` builds it; it needs chromium, too";
        writeln!(std::io::stderr(), "{message}").expect("standard error can be written to");
        return;
    };
    let folder = folder();
    with_camera(folder.path());
    let second = fs::read_to_string(folder.path().join("shaders/a.toml")).expect("it is there");
    fs::write(folder.path().join("shaders/b.toml"), second.replace("shade = 0.25", "shade = 0.75")).expect("written");
    let (code, said, _) = exported_alone(folder.path(), &module, "shaders", &[]);
    assert_eq!(code, Some(0), "{said}");
    let script = root.join("tests/it/play_alone.mjs");
    let page = folder.path().join("alone.html");
    let ran = Command::new("node").arg(script).arg(page).args([browser, driver]).output().expect("node runs");
    let errors = String::from_utf8_lossy(&ran.stderr);
    let seen: Value = serde_json::from_slice(&ran.stdout).unwrap_or_else(|error| panic!("{error}: {errors}"));
    assert_eq!((&seen["errors"], &seen["asked"]), (&json!([]), &json!([])), "{seen:#}");
    assert_eq!(seen["cards"], json!(2), "{seen:#}");
    assert_eq!(seen["files"].as_array().map(Vec::len), Some(3), "{seen:#}");
    for key in ["reflection", "fixed", "slider", "turned", "alive"] {
        assert_eq!(seen[key], json!(true), "{key}: {seen:#}");
    }
    if seen["byGpu"].is_null() {
        let message = "\nWebGPU is not tried: this browser has no adapter for it";
        writeln!(std::io::stderr(), "{message}").expect("standard error can be written to");
    } else {
        assert!(seen["byGpu"].as_str().is_some_and(|text| text.contains("by WebGPU")), "{seen:#}");
        assert_eq!((&seen["verdict"][0], &seen["faulty"][0]), (&json!("holds"), &json!("fails")), "{seen:#}");
        assert_eq!(seen["both"], json!(true), "{seen:#}");
    }
    assert_eq!((&seen["asked_first"], &seen["kept"]), (&json!(2), &json!(true)), "{seen:#}");
    assert_eq!(seen["linked"], json!({ "same": true, "text": true, "scene": "shaders/a.toml" }), "{seen:#}");
    assert!(seen["inspected"].as_str().is_some_and(|text| text.contains("fragment")), "{seen:#}");
    assert!(seen["milliseconds"].as_f64().is_some_and(|time| time < 5000.0), "{seen:#}");
    assert!(seen["width"].as_u64().is_some_and(|width| width <= 360), "no sideways scrolling: {seen:#}");
}
