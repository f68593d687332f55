//! Fifty tasks of an editor's day, each done by the server: the table of `docs/editors.md`.
//!
//! *Holds:* the rows of the table are these tasks, in this order.

use crate::cli::Folder;
use crate::editor::{Editor, labels, places};
use crate::support::root;
use serde_json::{Value, json};
use std::fs;

const COMMON: &str = "// A light 🌞.\nstruct Light { vec3 color; float power; };\n\
    // Its color at a distance.\nvec3 shine(Light light, float far) { return light.color * light.power / (far * far); }\n\
    #ifdef FOG\nvec3 fog(vec3 c) { return mix(c, vec3(0.5), 0.5); }\n#endif\n";
const VERTEX: &str = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"common.glsl\"\n\
    in vec3 position;\nuniform mat4 matrix;\nuniform Camera { vec4 eye; mat4 view; } camera;\nout vec3 normal;\n\
    #define TWICE(x) ((x) * 2.0)\nvoid main() {\n    normal = TWICE(position);\n    gl_Position = matrix * vec4(position, 1);\n}\n";
const FRAGMENT: &str = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"common.glsl\"\n\
    #include <glisten/phong.glsl>\nin vec3 normal;\nuniform Light sun;\nout vec4 color;\nconst float PI = 3.14159;\n\
    float half_of(float x) { return x * 0.5; }\nvoid main() {\n    vec3 c = shine(sun, half_of(PI));\n    float unread = 1.0;\n\
    color = vec4(c * normal.xyz, 1.0);\n#if QUALITY > 1\n    color *= 2.0;\n#endif\n}\n";
const SCENE: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
    [draw.attributes]\nposition = { size = 3, values = [-1,-1,0, 3,-1,0, -1,3,0] }\n\
    [draw.uniforms]\nmatrix = [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]\n";
/// A scene for what the program does not declare yet.
const PLAN: &str = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n[draw.uniforms]\ntint = [1.0, 0.5, 0.0]\n";
const SCRIPT: &str = "const vertexShader = `attribute vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }`;\n\
    const fragmentShader = /* glsl */ `precision highp float; uniform vec3 tint;\n\
    void main() { gl_FragColor = vec4(tint * ${k}, wrong); }`;\n";

fn folder() -> Folder {
    Folder::new(&[
        ("common.glsl", COMMON.as_bytes()),
        ("a.vert", VERTEX.as_bytes()),
        ("a.frag", FRAGMENT.as_bytes()),
        ("b.frag", FRAGMENT.replace("#include <glisten/phong.glsl>\n", "").as_bytes()),
        ("s.toml", SCENE.as_bytes()),
        ("plan.toml", PLAN.as_bytes()),
        ("web.js", SCRIPT.as_bytes()),
    ])
}

/// A day.
struct Day {
    editor: Editor,
}

impl Day {
    fn on(&mut self, request: &str, name: &str, text: &str, word: &str) -> Value {
        let at = self.editor.on(name, text, word);
        self.editor.ask(&format!("textDocument/{request}"), at)
    }

    fn of(&mut self, request: &str, name: &str) -> Value {
        let uri = self.editor.uri(name);
        self.editor.ask(&format!("textDocument/{request}"), json!({ "textDocument": { "uri": uri } }))
    }

    fn hover(&mut self, word: &str) -> String {
        self.on("hover", "a.frag", FRAGMENT, word)["contents"]["value"].as_str().unwrap_or_default().to_owned()
    }

    fn references(&mut self, name: &str, text: &str, word: &str) -> Vec<String> {
        let mut at = self.editor.on(name, text, word);
        at["context"] = json!({ "includeDeclaration": true });
        places(&self.editor.ask("textDocument/references", at))
    }

    fn rename(&mut self, name: &str, text: &str, word: &str, new: &str) -> Value {
        let mut at = self.editor.on(name, text, word);
        at["newName"] = json!(new);
        self.editor.answer("textDocument/rename", at)
    }

    /// The names that fit after `typed`, which replaces `word`.
    fn typed(&mut self, name: &str, text: &str, word: &str, typed: &str) -> Vec<String> {
        let new = text.replacen(word, typed, 1);
        let end = text.find(word).unwrap_or_default() + typed.len();
        self.editor.change(name, 2, json!([{ "text": new }]));
        let line = new[..end].matches('\n').count();
        let start = new[..end].rfind('\n').map_or(0, |at| at + 1);
        let position = json!({ "line": line, "character": new[start..end].encode_utf16().count() });
        let uri = self.editor.uri(name);
        let found =
            self.editor.ask("textDocument/completion", json!({ "textDocument": { "uri": uri }, "position": position }));
        self.editor.change(name, 3, json!([{ "text": text }]));
        if found.is_null() { Vec::new() } else { labels(&found) }
    }

    fn hints(&mut self, name: &str) -> String {
        let uri = self.editor.uri(name);
        let range = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99, "character": 0 } });
        let ask = json!({ "textDocument": { "uri": uri }, "range": range });
        let hints = self.editor.ask("textDocument/inlayHint", ask);
        let labels = hints.as_array().into_iter().flatten().filter_map(|hint| hint["label"].as_str());
        labels.collect::<Vec<_>>().join("|")
    }

    fn run(&mut self, command: &str, arguments: Value) -> Value {
        self.editor.ask("workspace/executeCommand", json!({ "command": command, "arguments": arguments }))
    }

    /// The codes of a document after a change of it.
    fn codes(&mut self, name: &str, text: &str, from: &str, to: &str) -> Vec<String> {
        self.editor.change(name, 2, json!([{ "text": text.replacen(from, to, 1) }]));
        let uri = self.editor.uri(name);
        let found = self.editor.ask("textDocument/diagnostic", json!({ "textDocument": { "uri": uri } }));
        self.editor.change(name, 3, json!([{ "text": text }]));
        let items = found["items"].as_array().into_iter().flatten();
        items.filter_map(|one| one["code"].as_str()).map(str::to_owned).collect()
    }

    fn actions(&mut self, name: &str, text: &str, word: &str, only: Value) -> String {
        let (uri, at) = (self.editor.uri(name), self.editor.at(text, word));
        let context =
            if only.is_null() { json!({ "diagnostics": [] }) } else { json!({ "diagnostics": [], "only": only }) };
        let ask = json!({ "textDocument": { "uri": uri }, "range": { "start": at, "end": at }, "context": context });
        self.editor.ask("textDocument/codeAction", ask).to_string()
    }

    fn lenses(&mut self, name: &str) -> String {
        self.of("codeLens", name).to_string()
    }
}

fn has(list: &[String], word: &str) -> bool {
    list.iter().any(|other| other == word)
}

/// A task by name, and whether the server does it.
type Task = (&'static str, fn(&mut Day) -> bool);

static TASKS: &[Task] = &[
    ("see a type error while typing", |d| has(&d.codes("a.frag", FRAGMENT, "vec3 c =", "vec4 c ="), "E0401")),
    ("see a missing semicolon at its place", |d| {
        d.codes("a.frag", FRAGMENT, "= 1.0;", "= 1.0").iter().any(|code| code.starts_with("E02"))
    }),
    ("see that the stages disagree on a varying", |d| {
        d.codes("a.frag", FRAGMENT, "in vec3 normal", "in vec4 normal").iter().any(|code| code == "E0703")
    }),
    ("see an error in an included file, in that file", |d| {
        let wrong = COMMON.replace("light.power", "light.powr");
        d.editor.open("common.glsl", &wrong);
        let found = d.of("diagnostic", "common.glsl")["items"][0].clone();
        d.editor.change("common.glsl", 2, json!([{ "text": COMMON }]));
        found["severity"] == 1 && found["range"]["start"]["line"] == 3
    }),
    ("see lint findings with their levels", |d| d.of("diagnostic", "a.frag").to_string().contains("unread")),
    ("see text behind a false `#if` in gray", |d| {
        d.of("diagnostic", "a.frag").to_string().contains("left out by a condition")
    }),
    ("apply the fix of a misspelled name", |d| {
        let wrong = FRAGMENT.replacen("shine(", "shime(", 1);
        d.editor.change("a.frag", 2, json!([{ "text": wrong }]));
        let found = d.actions("a.frag", &wrong, "shime(", Value::Null);
        d.editor.change("a.frag", 3, json!([{ "text": FRAGMENT }]));
        found.contains("write `shine`")
    }),
    ("allow a finding by a comment", |d| {
        d.actions("a.frag", FRAGMENT, "unread", Value::Null).contains("glisten: allow(")
    }),
    ("apply all safe fixes of a file", |d| {
        let wrong = VERTEX.replacen("position, 1)", "position, 1.0);;", 1).replacen(";;;", ";;", 1);
        d.editor.change("a.vert", 2, json!([{ "text": wrong }]));
        let found = d.actions("a.vert", &wrong, "matrix;", json!(["source.fixAll"]));
        d.editor.change("a.vert", 3, json!([{ "text": VERTEX }]));
        found.starts_with('[')
    }),
    ("read the type of a local", |d| d.hover("c * normal").contains("vec3 c")),
    ("read the value of a constant", |d| d.hover("PI)").contains("3.14159")),
    ("read the comment of a function from an include", |d| d.hover("shine(").contains("Its color at a distance")),
    ("read what a built-in computes, in this version", |d| {
        d.on("hover", "common.glsl", COMMON, "mix(").to_string().contains("genType")
    }),
    ("read the equation of a library function", |d| {
        let text = FRAGMENT.replacen(
            "vec3 c = shine(",
            "float s = phongFactor(normal, normal, normal, 2.0); vec3 c = shine(",
            1,
        );
        d.editor.change("a.frag", 2, json!([{ "text": text }]));
        let found = d.on("hover", "a.frag", &text, "phongFactor(").to_string();
        d.editor.change("a.frag", 3, json!([{ "text": FRAGMENT }]));
        found.contains("*equation*")
    }),
    ("read a uniform's std140 offset", |d| d.on("hover", "a.vert", VERTEX, "view;").to_string().contains("offset 16")),
    ("read a varying's location and interpolation", |d| d.hover("normal;").contains("varying location 0")),
    ("read the other stage's declaration", |d| d.hover("normal;").contains("out vec3 normal")),
    ("read what a macro expands to", |d| {
        d.on("hover", "a.vert", VERTEX, "TWICE(position").to_string().contains("((x) * 2.0)")
    }),
    ("go to a function in an include", |d| {
        places(&d.on("definition", "a.frag", FRAGMENT, "shine(")) == ["common.glsl:3:5"]
    }),
    ("open an included file", |d| {
        places(&d.on("definition", "a.frag", FRAGMENT, "common.glsl")) == ["common.glsl:0:0"]
    }),
    ("open a module of the library", |d| d.of("documentLink", "a.frag").to_string().contains("phong.glsl")),
    ("go from a varying to the other stage", |d| {
        places(&d.on("definition", "a.frag", FRAGMENT, "normal;")) == ["a.vert:6:9"]
    }),
    ("go to a macro's definition", |d| {
        places(&d.on("definition", "a.vert", VERTEX, "TWICE(position")) == ["a.vert:7:8"]
    }),
    ("go to the struct of a variable's type", |d| {
        places(&d.on("typeDefinition", "a.frag", FRAGMENT, "sun,")) == ["common.glsl:1:7"]
    }),
    ("find all uses over stages and includes", |d| {
        let found = d.references("common.glsl", COMMON, "shine(");
        has(&found, "a.frag:10:13") && has(&found, "b.frag:9:13") && has(&found, "common.glsl:3:5")
    }),
    ("see reads and writes in the file", |d| {
        d.on("documentHighlight", "a.vert", VERTEX, "normal =").as_array().is_some_and(|all| all.len() == 2)
    }),
    ("rename a varying in both stages", |d| {
        let done = d.rename("a.vert", VERTEX, "normal =", "facing").to_string();
        done.contains("a.frag") && done.contains("a.vert")
    }),
    ("rename a uniform in the scenes that set it", |d| {
        d.rename("a.vert", VERTEX, "matrix *", "mvp").to_string().contains("s.toml")
    }),
    ("rename a struct's member in an include", |d| {
        d.rename("common.glsl", COMMON, "power;", "watts").to_string().contains("common.glsl")
    }),
    ("be refused a rename that captures", |d| {
        d.rename("a.frag", FRAGMENT, "c * normal", "normal")["error"].is_object()
    }),
    ("complete members of a struct", |d| has(&d.typed("a.frag", FRAGMENT, "shine(sun", "shine(sun."), "power")),
    ("complete swizzles", |d| has(&d.typed("a.frag", FRAGMENT, "normal.xyz", "normal."), "xyz")),
    ("complete built-ins of this version and stage", |d| {
        let found = d.typed("a.frag", FRAGMENT, "vec4(c *", "vec4(d");
        has(&found, "dFdx") && !has(&found, "textureGather") && has(&found, "dot")
    }),
    ("complete what the other stage passes", |d| {
        d.typed("a.frag", &FRAGMENT.replace("in vec3 normal;\n", "in \n"), "in \n", "in ")
            .iter()
            .any(|label| label == "vec3 normal")
    }),
    ("complete uniforms from a scene", |d| {
        d.typed("a.frag", FRAGMENT, "uniform Light sun;", "uniform ").iter().any(|label| label == "vec3 tint")
    }),
    ("complete the names of includes", |d| {
        has(&d.typed("a.frag", FRAGMENT, "<glisten/phong.glsl>", "<glisten/ph"), "phong.glsl")
    }),
    ("complete directives and extensions", |d| has(&d.typed("a.frag", FRAGMENT, "#if QUALITY", "#pra"), "pragma")),
    ("see all overloads of a call", |d| {
        let text = FRAGMENT.replacen("shine(sun", "mix(sun", 1);
        d.editor.change("a.frag", 2, json!([{ "text": text }]));
        let mut at = d.editor.on("a.frag", &text, "half_of(PI");
        at["position"]["character"] = json!(at["position"]["character"].as_u64().unwrap_or(0));
        let found = d.editor.ask("textDocument/signatureHelp", at);
        d.editor.change("a.frag", 3, json!([{ "text": FRAGMENT }]));
        found["signatures"].as_array().is_some_and(|all| all.len() > 1) && found["activeParameter"] == 1
    }),
    ("see locations, offsets and conversions in the text", |d| {
        let found = d.hints("a.vert");
        ["location 0", "@16", "→ float"].iter().all(|label| found.contains(label))
    }),
    ("see how many operations a function has", |d| d.hints("a.frag").contains("operation")),
    ("choose a macro and see its branch", |d| {
        let uri = d.editor.uri("a.frag");
        let asked = d.run("glisten.configurations", json!([uri])).to_string();
        d.run("glisten.define", json!(["QUALITY", "2"]));
        let found = d.of("diagnostic", "a.frag").to_string();
        let hints = d.hints("a.frag");
        d.run("glisten.define", json!(["QUALITY", null]));
        asked.contains("QUALITY") && hints.contains("QUALITY = 2") && !found.contains("left out by a condition")
    }),
    ("choose the file that a header is seen in", |d| {
        let (header, includer) = (d.editor.uri("common.glsl"), d.editor.uri("b.frag"));
        let all = d.run("glisten.contexts", json!([header])).as_array().map_or(0, Vec::len);
        d.run("glisten.context", json!([header, includer]));
        let found = d.lenses("common.glsl");
        d.run("glisten.context", json!([header, null]));
        all == 3 && found.contains("as b.frag includes it")
    }),
    ("open the picture of a scene from the text", |d| {
        let scene = d.editor.uri("s.toml");
        d.lenses("a.frag").contains("picture of s.toml") && d.run("glisten.picture", json!([scene]))["uri"].is_string()
    }),
    ("read the program in WGSL", |d| {
        let uri = d.editor.uri("a.frag");
        d.run("glisten.translation", json!([uri, "wgsl"])).to_string().contains("@fragment")
    }),
    ("see the outline of a file", |d| d.of("documentSymbol", "a.frag").to_string().contains("half_of")),
    ("find a name in the workspace", |d| {
        d.editor.ask("workspace/symbol", json!({ "query": "hlf" })).to_string().contains("half_of")
    }),
    ("fold, and grow the selection", |d| {
        let (uri, at) = (d.editor.uri("a.frag"), d.editor.at(FRAGMENT, "normal.xyz"));
        let grown =
            d.editor.ask("textDocument/selectionRange", json!({ "textDocument": { "uri": uri }, "positions": [at] }));
        d.of("foldingRange", "a.frag").as_array().is_some_and(|all| !all.is_empty()) && grown[0]["parent"].is_object()
    }),
    ("see who calls a function", |d| {
        let item = d.on("prepareCallHierarchy", "a.frag", FRAGMENT, "half_of(PI")[0].clone();
        d.editor.ask("callHierarchy/incomingCalls", json!({ "item": item }))[0]["from"]["name"] == "main"
    }),
    ("format a file, or a part of it", |d| {
        let uri = d.editor.uri("a.frag");
        let text = FRAGMENT.replacen("float x)", "float  x )", 1);
        d.editor.change("a.frag", 2, json!([{ "text": text }]));
        let edits = d.editor.ask(
            "textDocument/formatting",
            json!({ "textDocument": { "uri": uri }, "options": { "tabSize": 4, "insertSpaces": true } }),
        );
        d.editor.change("a.frag", 3, json!([{ "text": FRAGMENT }]));
        edits.to_string().contains("(float x)")
    }),
    ("work on a shader in a string of a program", |d| {
        d.editor.open("web.js", SCRIPT);
        let found = d.of("diagnostic", "web.js")["items"].as_array().cloned().unwrap_or_default();
        let hover = d.on("hover", "web.js", SCRIPT, "tint *").to_string();
        let outside = d.on("hover", "web.js", SCRIPT, "vertexShader");
        found.len() == 1 && found[0]["code"] == "E0301" && hover.contains("uniform vec3 tint") && outside.is_null()
    }),
];

#[test]
fn the_server_does_fifty_tasks() {
    assert_eq!(TASKS.len(), 50);
    let folder = folder();
    let capabilities = json!({ "textDocument": {
        "publishDiagnostics": { "tagSupport": { "valueSet": [1] }, "relatedInformation": true },
        "diagnostic": {} } });
    let mut day = Day { editor: Editor::new(&folder, capabilities) };
    day.editor.open("a.frag", FRAGMENT);
    day.editor.open("a.vert", VERTEX);
    let mut failed = Vec::new();
    for (name, task) in TASKS {
        if !task(&mut day) {
            failed.push(*name);
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    day.editor.close();
}

#[test]
fn the_page_has_these_tasks() {
    let page = fs::read_to_string(root().join("docs/editors.md")).expect("a page");
    let table = page.split("| task |").nth(1).expect("the table");
    let rows: Vec<&str> =
        table.lines().skip(2).map_while(|line| line.strip_prefix("| ")?.split(" | ").next()).collect();
    let tasks: Vec<&str> = TASKS.iter().map(|(name, _)| *name).collect();
    assert_eq!(rows, tasks);
}
