//! Shaders in the strings of other languages: `lint --embedded`, and the same findings in the editor.

use crate::cli::{Folder, codes, err, out};
use serde_json::Value;

const SCRIPT: &str = "import * as THREE from 'three'; // 🎨\nconst n = 3;\nexport const m = new THREE.ShaderMaterial({\n  /* 🚀 */ vertexShader: `\n\
    varying vec2 vUv;\nvoid main() { vUv = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }\n`,\n\
    fragmentShader: `\nvarying vec3 vUv;\nuniform vec3 tint;\nvoid main() { vec3 c = tint * ${n}; /* é */ c += wrong; gl_FragColor = vec4(c, ${ `}` }); }\n` });\n";
const RUST: &str = "fn f<'a>() {}\nconst VERT: &str = r#\"#version 150\nin vec3 p;\nout vec3 q;\nvoid main() { q = p; gl_Position = vec4(p, 1.0); }\n\"#;\n\
    const FRAG: &str = r#\"\n#version 150\nin vec4 q;\nout vec4 color;\nvoid main() { color = q; }\n\"#;\n";
const PYTHON: &str = "program = ctx.program(vertex_shader='''\n    #version 330\n    in vec2 v;\n    void main() { gl_Position = vec4(v, 0.0, 1.0) }\n''')\n";
const C: &str = "const char* fs = R\"glsl(\n#version 150\nout vec4 color;\nvoid main() { color = vec4(1.0); return 1; }\n)glsl\";\n";
const CLEAN: &str = "const noise = glsl`\nfloat noise(vec2 p) { return fract(sin(dot(p, seed))); }\n`;\n\
    const f = `precision highp float;\n${noise}\nuniform float ${name}, ${other}_x;\n#define N ${count}\n\
    void main() { float a[${size}]; gl_FragColor = vec4(noise(vec2(${x}.0)), ${y}, ${vec}); }`;\nconst s = sql`select void`;\n\
    const t = new THREE.ShaderMaterial({ defines: { N_TAPS: 4 }, fragmentShader: `\n#include <common>\n#include <packing>\n\
    void main() { gl_FragColor = packSomething(float(N_TAPS)); }` });\nconst u = glsl`precision highp float;\nvoid main() { gl_FragColor = vec4(N_TAPS); }`;\n";

fn places(findings: &[Value]) -> Vec<String> {
    let shown = |one: &Value| {
        let file = one["file"].as_str().unwrap_or("");
        format!("{file}:{}:{} {}", one["line"], one["column"], one["code"].as_str().unwrap_or(""))
    };
    findings.iter().filter(|one| one["code"].is_string()).map(shown).collect()
}

fn folder() -> Folder {
    Folder::new(&[
        ("app.ts", SCRIPT.as_bytes()),
        ("clean.js", CLEAN.as_bytes()),
        ("lib.rs", RUST.as_bytes()),
        ("m.cpp", C.as_bytes()),
        ("t.py", PYTHON.as_bytes()),
        ("binary.js", b"\0\0void glsl"),
    ])
}

#[test]
fn strings_of_all_languages_are_checked() {
    let folder = folder();
    let (found, code) = folder.lint(&["--embedded", "."]);
    assert_eq!(code, 1);
    let found = places(&found);
    let expected =
        ["app.ts:9:14 E0703", "app.ts:11:50 E0301", "lib.rs:9:9 E0703", "m.cpp:4:41 E0502", "t.py:4:50 E0202"];
    for expected in expected {
        assert!(found.iter().any(|one| one.starts_with(expected)), "{expected}: {found:#?}");
    }
    assert!(!found.iter().any(|one| one.starts_with("clean.js") || one.starts_with("binary.js")), "{found:#?}");
    let (found, code) = folder.lint(&["--embedded", "clean.js"]);
    assert_eq!((codes(&found).len(), code), (0, 0), "{found:?}");
}

#[test]
fn without_the_flag_they_are_left_alone() {
    let folder = folder();
    let output = folder.run(&["lint", "app.ts"]);
    assert!(err(&output).contains("--embedded"), "{}", err(&output));
    let output = folder.run(&["lint", "."]);
    assert_eq!(output.status.code(), Some(0), "{}", out(&output));
    assert!(err(&folder.run(&["lint", "--embedded", "missing.js"])).contains("there is no file"));
}

#[test]
fn findings_show_the_lines_of_the_host() {
    let folder = folder();
    let output = folder.run(&["lint", "--embedded", "app.ts"]);
    assert!(out(&output).contains("vec3 c = tint * ${n}; /* é */ c += wrong;"), "{}", out(&output));
}

#[test]
fn fixes_reach_into_strings() {
    let text = "const s = `precision highp float;\nuniform vec3 tint;\nvoid main() { gl_FragColor = vec4(tnt * ${k}, 1.0); }`;\n";
    let folder = Folder::new(&[("a.js", text.as_bytes())]);
    let output = folder.run(&["lint", "--embedded", "a.js", "--unsafe-fixes"]);
    let fixed = std::fs::read_to_string(folder.path("a.js")).expect("a file");
    assert_eq!(fixed, text.replace("tnt", "tint"), "{}", out(&output));
}

#[cfg(feature = "lsp")]
mod in_the_editor {
    use super::{CLEAN, SCRIPT, folder, places};
    use crate::editor::{Editor, applied, labels};
    use serde_json::json;

    #[test]
    fn requests_work_inside_of_strings() {
        let folder = folder();
        let mut editor = Editor::new(&folder, json!({}));
        editor.open("app.ts", SCRIPT);
        let mut told: Vec<String> = editor
            .diagnostics("app.ts")
            .iter()
            .map(|one| {
                let start = &one["range"]["start"];
                format!("{}:{} {}", start["line"], start["character"], one["code"].as_str().unwrap_or(""))
            })
            .collect();
        told.sort();
        let (lint, _) = folder.lint(&["--embedded", "app.ts"]);
        assert_eq!(told.len(), places(&lint).len(), "{told:?} {lint:?}");
        assert!(told.contains(&"10:49 E0301".to_owned()), "{told:?}");
        let there = editor.on("app.ts", SCRIPT, "tint * ");
        let hover = editor.ask("textDocument/hover", there.clone())["contents"]["value"].to_string();
        assert!(hover.contains("uniform vec3 tint"), "{hover}");
        let definition = editor.ask("textDocument/definition", there);
        assert_eq!(definition["range"]["start"], json!({ "line": 9, "character": 13 }), "{definition}");
        let outside = editor.on("app.ts", SCRIPT, "const n");
        for request in ["hover", "completion", "definition", "signatureHelp"] {
            assert!(editor.ask(&format!("textDocument/{request}"), outside.clone()).is_null(), "{request}");
        }
        // The rest of the text is not there yet.
        let half = SCRIPT.split("c += wrong").next().expect("a text").to_owned() + "c = vec3(c.";
        editor.change("app.ts", 2, json!([{ "text": format!("{half}`") }]));
        let mut there = editor.on("app.ts", &half, "c = vec3(c.");
        there["position"]["character"] = json!(there["position"]["character"].as_u64().expect("a number") + 11);
        let found = labels(&editor.ask("textDocument/completion", there));
        assert!(found.contains(&"xyz".to_owned()), "{found:?}");
        // Nothing is left in a file without shaders.
        editor.change("app.ts", 3, json!([{ "text": "const a = 1; // void" }]));
        while !editor.diagnostics("app.ts").is_empty() {}
        editor.close();
    }

    #[test]
    fn formatting_changes_the_shaders_alone() {
        let folder = folder();
        let mut editor = Editor::new(&folder, json!({}));
        editor.open("clean.js", CLEAN);
        let uri = editor.uri("clean.js");
        let ask = json!({ "textDocument": { "uri": uri }, "options": { "tabSize": 2, "insertSpaces": true } });
        let edits = editor.ask("textDocument/formatting", ask.clone());
        let new = applied(CLEAN, edits.as_array().expect("a list"), false);
        for kept in ["${noise}\n", "${name}, ${other}_x", "#define N ${count}", "vec2(${x}.0)", "sql`select void`"] {
            assert!(new.contains(kept), "{kept}: {new}");
        }
        assert!(new.contains("float a[${size}];\n"), "{new}");
        editor.change("clean.js", 2, json!([{ "text": new }]));
        assert_eq!(editor.ask("textDocument/formatting", ask), json!([]), "{new}");
        editor.close();
    }
}
