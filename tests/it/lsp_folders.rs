//! `glisten lsp` where `glisten.toml` names search folders and preludes, renames of what several branches declare, and the pages of codes.

use crate::cli::{Folder, code};
use crate::editor::{Editor, applied, edited, places};
use serde_json::{Value, json};
use std::fs;

const CONFIGURATION: &str = "[[source]]\nincludes = [\"include\"]\n";
const HEADER: &str = "uniform float zed;\nfloat helper(float a) { return a; }\n";
const SHADER: &str = "#version 330\n#extension GL_GOOGLE_include_directive : enable\n#include <lib.glsl>\nout vec4 c;\n\
    void main() { c = vec4(helper(zed)); }\n";
const PLAIN: &str = "out vec4 c;\nvoid main() { c = vec4(helper(zed)); }\n";

fn rename(editor: &mut Editor, (file, text): (&str, &str), word: &str, new: &str) -> Value {
    let mut there = editor.on(file, text, word);
    there["newName"] = json!(new);
    editor.answer("textDocument/rename", there)
}

fn messages(found: &[Value]) -> Vec<String> {
    found.iter().map(|one| one["message"].as_str().unwrap_or_default().to_owned()).collect()
}

#[test]
fn files_of_a_search_folder_are_the_documents_of_the_editor() {
    for (configuration, arguments) in
        [(CONFIGURATION, &[][..]), ("", &["-I", "include"]), ("", &["-I", "./src/../include"])]
    {
        let folder = Folder::new(&[
            ("glisten.toml", configuration.as_bytes()),
            ("include/lib.glsl", HEADER.as_bytes()),
            ("src/z.frag", SHADER.as_bytes()),
        ]);
        let mut editor = Editor::with(&folder, json!({}), arguments);
        editor.open("src/z.frag", SHADER);
        let there = editor.on("src/z.frag", SHADER, "helper(zed)");
        assert_eq!(places(&editor.ask("textDocument/definition", there)), ["lib.glsl:1:6"]);
        let answer = rename(&mut editor, ("src/z.frag", SHADER), "helper(zed)", "aid");
        let changes = answer["result"]["changes"].as_object().unwrap_or_else(|| panic!("{answer}"));
        let text =
            |name: &str, text: &str| applied(text, changes[&editor.uri(name)].as_array().expect("a list"), false);
        assert_eq!(text("include/lib.glsl", HEADER), HEADER.replace("helper", "aid"));
        assert_eq!(text("src/z.frag", SHADER), SHADER.replace("helper", "aid"));
        // The header in the editor counts, saved or not.
        assert!(editor.diagnostics("src/z.frag").is_empty());
        editor.open("include/lib.glsl", &HEADER.replace("return a", "return nope"));
        assert_eq!(messages(&editor.diagnostics("include/lib.glsl")).len(), 1);
        editor.change("include/lib.glsl", 2, json!([{ "text": HEADER.replace("zed", "zod") }]));
        assert!(editor.diagnostics("src/z.frag").iter().any(|one| one["code"] == "E0301"));
        editor.close();
    }
}

#[test]
fn a_prelude_is_a_document_like_others() {
    let prelude = format!("#version 330\n{HEADER}");
    for (configuration, arguments) in
        [("[[source]]\nprelude = \"pre.glsl\"\n", &[][..]), ("", &["--prelude", "pre.glsl"])]
    {
        let folder = Folder::new(&[
            ("glisten.toml", configuration.as_bytes()),
            ("pre.glsl", prelude.as_bytes()),
            ("z.frag", PLAIN.as_bytes()),
        ]);
        let mut editor = Editor::with(&folder, json!({}), arguments);
        editor.open("z.frag", PLAIN);
        assert!(editor.diagnostics("z.frag").is_empty());
        let there = editor.on("z.frag", PLAIN, "helper(zed)");
        assert_eq!(places(&editor.ask("textDocument/definition", there)), ["pre.glsl:2:6"]);
        for (file, text, word) in [("z.frag", PLAIN, "zed)"), ("pre.glsl", &prelude, "zed;")] {
            editor.open("pre.glsl", &prelude);
            let mut there = editor.on(file, text, word);
            there["context"] = json!({ "includeDeclaration": true });
            let found = places(&editor.ask("textDocument/references", there));
            assert_eq!(found, ["pre.glsl:1:14", "z.frag:1:30"], "{file}");
            let done = edited(&folder, &rename(&mut editor, (file, text), word, "zod")["result"]);
            assert_eq!(done["pre.glsl"], prelude.replace("zed", "zod"));
            assert_eq!(done["z.frag"], PLAIN.replace("zed", "zod"));
        }
        // An edit counts at once, and so does the file once the document is closed.
        editor.told.clear();
        editor.change("pre.glsl", 2, json!([{ "text": prelude.replace("zed", "zod") }]));
        assert!(editor.diagnostics("z.frag").iter().any(|one| one["code"] == "E0301"));
        let document = json!({ "textDocument": { "uri": editor.uri("pre.glsl") } });
        editor.tell("textDocument/didClose", document);
        assert!(editor.diagnostics("z.frag").is_empty());
        editor.close();
    }
}

/// A name that both branches of a condition declare is renamed in both; where a branch may mean another thing, the rename is refused.
#[test]
fn renames_keep_the_other_branch() {
    let head = "#version 330\nout vec4 c;\n";
    let cases = [
        (
            "void main() {\n#ifdef A\n  float k = 1.0;\n#else\n  float k = 2.0;\n#endif\n  c = vec4(k);\n}\n",
            "k);",
            true,
        ),
        (
            "#ifdef A\nfloat f(float k, float z)\n#else\nfloat f(float k)\n#endif\n{ return k; }\nvoid main() {\n#ifdef A\n  c = vec4(f(1.0, 2.0));\n\
            #else\n  c = vec4(f(1.0));\n#endif\n}\n",
            "k; }",
            true,
        ),
        (
            "void main() {\n#ifdef A\n  for (int k = 0; k < 2; k++)\n#else\n  for (int k = 0; k < 4; k++)\n#endif\n    c = vec4(k);\n}\n",
            "k);\n}",
            true,
        ),
        (
            "struct S {\n#ifdef A\n  vec4 k;\n#else\n  float k;\n#endif\n};\nuniform S s;\nvoid main() { c = vec4(s.k); }\n",
            "k);",
            true,
        ),
        (
            "float f(float x) { return x; }\nfloat k(vec2 x) { return x.x; }\nfloat k(float x) { return x; }\nvoid main() {\n\
            c = vec4(k(vec2(1.0)));\n#ifdef A\n  c += k(2.0);\n#endif\n}\n",
            "k(vec2(1",
            false,
        ),
        (
            "struct S { float k; }; struct U { float k; };\nuniform S s; uniform U u;\nvoid main() { c = vec4(s.k + u.k);\n\
            #ifdef A\n  c += s.k + u.k;\n#endif\n}\n",
            "k + u",
            false,
        ),
    ];
    for (body, word, is_possible) in cases {
        let text = format!("{head}{body}");
        let folder = Folder::new(&[("r.frag", text.as_bytes())]);
        let mut editor = Editor::new(&folder, json!({}));
        editor.open("r.frag", &text);
        let answer = rename(&mut editor, ("r.frag", &text), word, "other");
        if is_possible {
            let done = &edited(&folder, &answer["result"])["r.frag"];
            fs::write(folder.path("r.frag"), done).expect("written");
            for macros in [&[][..], &["-D", "A"]] {
                assert_eq!(code(&folder.run(&[&["lint", "r.frag"], macros].concat())), 0, "{done}");
            }
        } else {
            let message = answer["error"]["message"].as_str().unwrap_or_default();
            assert!(message.contains("would change what a name denotes: r.frag:"), "{answer}");
        }
        editor.close();
    }
}

#[test]
fn a_finding_leads_to_the_page_of_its_code() {
    let folder = Folder::new(&[("a.frag", b"#version 150\nvoid main() { x; }\n")]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", "#version 150\nvoid main() { x; }\n");
    let found = editor.diagnostics("a.frag");
    let page = found[0]["codeDescription"]["href"].as_str().and_then(|href| href.strip_prefix("file://"));
    let text = fs::read_to_string(page.expect("a file")).expect("it is there");
    assert!(text.starts_with("E0301 undeclared-identifier"), "{text}");
    editor.close();
}

/// A scene names a uniform in its draw, in its ranges and in the ways of its report.
#[test]
fn a_rename_reaches_all_of_a_scene() {
    let shader = "#version 150\nuniform vec3 tint;\nout vec4 c;\nvoid main() { c = vec4(tint, 1.0); }\n";
    let scene = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        uniforms = { tint = [1, 0, 0] }\n[stability.range]\ntint = \"0..1\"\n[[report.way]]\nname = \"x\"\n\
        set = { uniforms = { tint = [0, 1, 0] } }\n[[report.way]]\nname = \"y\"\nset.uniforms.\"tint\" = [0, 1, 1]\n";
    let folder = Folder::new(&[
        ("a.vert", b"#version 150\nvoid main() { gl_Position = vec4(0.0); }\n"),
        ("a.frag", shader.as_bytes()),
        ("a.toml", scene.as_bytes()),
    ]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("a.frag", shader);
    let done = edited(&folder, &rename(&mut editor, ("a.frag", shader), "tint;", "hue")["result"]);
    assert_eq!(done["a.toml"], scene.replace("tint", "hue"));
    editor.close();
}

/// The frontend sets the uniform that a pragma names.
#[test]
fn a_rename_reaches_the_pragma_of_a_parameter() {
    let text = "#version 330\n#pragma parameter gamma \"Gamma\" 2.2 1.0 3.0 0.1\nuniform float gamma;\nout vec4 c;\n\
        void main() { c = vec4(gamma); }\n";
    let folder = Folder::new(&[("r.frag", text.as_bytes())]);
    let mut editor = Editor::new(&folder, json!({}));
    editor.open("r.frag", text);
    let done = edited(&folder, &rename(&mut editor, ("r.frag", text), "gamma;", "power")["result"]);
    assert_eq!(done["r.frag"], text.replace("gamma", "power"));
    editor.close();
}
