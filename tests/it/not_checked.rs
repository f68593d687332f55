//! A search never hides an error: each file that it finds is checked, or named with the reason why it is not.

use crate::cli::{Folder, code, codes, err, out};
use serde_json::{Value, json};

const TYPO: &[u8] = b"void main() { gl_FragColor = vec4(nope); }\n";
const LATER: &[u8] = b"out vec4 c;\nvoid main() { c = vec4(1.0); }\n";
const USER: &[u8] =
    b"#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"head.frag\"\nout vec4 c;\n\
    void main() { c = vec4(tone(0.5)); }\n";

/// The findings, the last object and the exit code of `lint --format json`.
fn lint(folder: &Folder, arguments: &[&str]) -> (Vec<Value>, Value, i32) {
    let output = folder.run(&[&["lint", "--format", "json"], arguments].concat());
    let mut all: Vec<Value> = serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {output:?}"));
    let scope = all.pop().expect("the last object");
    (all, scope, code(&output))
}

fn not_checked(scope: &Value) -> Vec<(&str, &str)> {
    let rows = scope["not_checked"].as_array().expect("a list");
    rows.iter().map(|row| (row["file"].as_str().expect("a file"), row["because"].as_str().expect("a reason"))).collect()
}

#[test]
fn an_error_in_a_file_without_a_version_is_found_in_every_format() {
    for (text, expected) in [
        (TYPO, "E0301"),
        (&b"void main() { gl_FragColor = vec4(1.0) }\n"[..], "E0202"),
        (b"uniform vec3 light\nvoid main() { gl_FragColor = vec4(light, 1.0); }\n", "E0202"),
        // The typo comes before what only a later version has.
        (b"void main() { vec4 c = vec4(1.0) vec4 d; gl_FragColor = texture(s, c.xy); }\n", "E0201"),
    ] {
        let folder = Folder::new(&[("p/a.frag", text), ("p/b.frag", b"void main() { gl_FragColor = vec4(1.0); }\n")]);
        let (found, scope, exit) = lint(&folder, &["p"]);
        assert_eq!((codes(&found).first().copied(), exit), (Some(expected), 1), "{found:#?}");
        assert_eq!((&scope["summary"]["files"], not_checked(&scope).len()), (&json!(2), 0), "{scope}");
        for arguments in [&["-q"][..], &["--format", "sarif"], &["--format", "github"], &["--assume-version", "110"]] {
            let output = folder.run(&[&["lint", "p"], arguments].concat());
            assert!(code(&output) == 1 && out(&output).contains(expected), "{arguments:?}: {}", out(&output));
        }
    }
}

#[test]
fn what_is_not_checked_is_told_in_every_format_and_can_be_denied() {
    let folder = Folder::new(&[
        ("a.frag", LATER),
        ("gl/es.frag", b"out mediump vec4 c;\nuniform double d;\nvoid main() { c = vec4(d); }\n"),
        ("gl/in.vert", b"layout(location = 0) in vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }\n"),
        ("user.frag", USER),
        ("head.frag", b"uniform float gain;\nfloat tone(float x) { return x * gain; }\nvec4 other = vec4(lost);\n"),
        ("head_fs.glsl", b"float unused(float x) { return x; }\n"),
        ("which.glsl", b"void main() {}\n"),
        ("blur.comp", b"#version 430\nvoid main() {}\n"),
        ("asm.vp", b"!!ARBvp1.0\nEND\n"),
    ]);
    let (found, scope, exit) = lint(&folder, &["."]);
    assert_eq!((codes(&found), exit), (vec!["E0301"], 1), "an error of the header is told once: {found:#?}");
    let rows = not_checked(&scope);
    let files: Vec<&str> = rows.iter().map(|(file, _)| *file).collect();
    let expected =
        ["a.frag", "asm.vp", "blur.comp", "gl/es.frag", "gl/in.vert", "head.frag", "head_fs.glsl", "which.glsl"];
    assert_eq!(files, expected, "{rows:?}");
    for (file, part) in [
        ("a.frag", "it has no `#version` line, and a global `in` or `out` is not in GLSL 1.10"),
        ("gl/es.frag", "a global `in` or `out` is not in GLSL 1.10"),
        ("gl/in.vert", "`location` in a layout is not in this version"),
        ("head_fs.glsl", "no `main`"),
        ("which.glsl", "does not tell its stage"),
        ("blur.comp", "compute"),
        ("asm.vp", "assembly"),
    ] {
        assert!(rows.iter().any(|(name, because)| *name == file && because.contains(part)), "{file}: {rows:?}");
    }
    let folder = Folder::new(&[("a.frag", LATER), ("b.frag", b"void main() { gl_FragColor = vec4(1.0); }\n")]);
    let (found, scope, exit) = lint(&folder, &["."]);
    let summary = json!({ "files": 1, "programs": 0, "errors": 0, "warnings": 0, "notes": 0, "not_checked": 1 });
    assert_eq!((found.len(), &scope["summary"], exit), (0, &summary, 0), "{scope}");
    for arguments in [&["."][..], &[".", "-q"], &[]] {
        let output = folder.run(&[&["lint"], arguments].concat());
        assert_eq!(code(&output), 0, "{}", err(&output));
        for part in ["note[W0002]: 1 file was not checked", "a.frag:1: it has no `#version` line", "--assume-version"] {
            assert!(err(&output).contains(part), "{arguments:?}, {part}: {}", err(&output));
        }
    }
    let sarif: Value = serde_json::from_str(&out(&folder.run(&["lint", "--format", "sarif"]))).expect("SARIF");
    let told = &sarif["runs"][0]["invocations"][0]["toolExecutionNotifications"];
    assert_eq!((told.as_array().map(Vec::len), &told[0]["level"]), (Some(1), &json!("note")), "{told}");
    assert!(told[0]["message"]["text"].as_str().is_some_and(|text| text.contains("#version")), "{told}");
    let github = out(&folder.run(&["lint", "--format", "github"]));
    assert!(github.starts_with("::notice file=a.frag,line=1,title=W0002 not-checked::not checked: it has"), "{github}");
    for (arguments, exit) in [
        (&["--deny", "not-checked"][..], 1),
        (&["--deny", "not-checked", "-q", "--format", "json"], 1),
        (&["--deny", "warnings"], 0),
        (&["--deny", "not-checked", "--assume-version", "150"], 0),
    ] {
        let output = folder.run(&[&["lint", "."], arguments].concat());
        assert_eq!(code(&output), exit, "{arguments:?}: {}", err(&output));
    }
}

#[test]
fn the_configuration_gives_the_version_and_denies() {
    let folder = |text: &str| {
        Folder::new(&[
            ("a.frag", LATER),
            ("es/b.frag", b"precision mediump float;\nvoid main() { gl_FragColor = vec4(1.0); }\n"),
            ("glisten.toml", text.as_bytes()),
        ])
    };
    let versions = folder("[lint]\nassume_version = \"330\"\n[[source]]\nglob = \"es/**\"\nversion = \"100\"\n");
    let (found, scope, exit) = lint(&versions, &["."]);
    assert_eq!((codes(&found), &scope["summary"]["files"], exit), (vec![], &json!(2), 0), "{found:#?} {scope}");
    let (_, _, exit) = lint(&versions, &["a.frag", "--assume-version", "110"]);
    assert_eq!(exit, 1, "the command line takes precedence");
    let denied = folder("[lint]\ndeny = [\"not-checked\"]\n");
    assert_eq!(lint(&denied, &["."]).2, 1);
    let (found, _, exit) = lint(&folder("[lint]\nassume_version = \"33\"\n"), &["."]);
    assert_eq!((codes(&found), exit), (vec!["E0015", "W0116"], 1), "{found:#?}");
}

#[test]
fn a_header_is_checked_where_it_is_included() {
    let head = b"float tone(float x) { return x * LEVEL; }\n";
    let folder = Folder::new(&[("user.frag", USER), ("head.frag", head)]);
    // The error is in the header, and the file that includes it shows it.
    let (found, scope, exit) = lint(&folder, &["."]);
    assert_eq!((codes(&found), exit), (vec!["E0301"], 1), "{found:#?}");
    assert_eq!(found[0]["file"], "head.frag");
    assert_eq!(not_checked(&scope), [("head.frag", "`user.frag` includes it: it is checked there")]);
    // With the macro nothing is wrong, and a header without `main` is no finding.
    let (found, scope, exit) = lint(&folder, &[".", "-D", "LEVEL=2.0"]);
    assert_eq!((codes(&found), exit, &scope["summary"]["not_checked"]), (vec![], 0, &json!(0)), "{found:#?}");
    // A file that the command line names is checked on its own.
    let (found, _, exit) = lint(&folder, &[".", "head.frag", "-D", "LEVEL=2.0"]);
    assert_eq!((codes(&found), exit), (vec!["W0702"], 0), "{found:#?}");
    // Files that include each other do not vanish both.
    let ring = |other: &str| format!("#version 150\n#pragma once\n#include \"{other}\"\nvoid main() {{ nope; }}\n");
    let folder = Folder::new(&[("a.frag", ring("b.frag").as_bytes()), ("b.frag", ring("a.frag").as_bytes())]);
    let (found, _, exit) = lint(&folder, &["."]);
    assert!(exit == 1 && codes(&found).contains(&"E0301"), "{found:#?}");
}

#[test]
fn a_partner_of_another_version_stays() {
    let vertex = b"void main() { gl_Position = ftransform() * nope; }\n";
    let folder = Folder::new(&[("a.vert", vertex), ("a.frag", LATER)]);
    let (found, scope, exit) = lint(&folder, &["."]);
    assert_eq!((codes(&found), exit), (vec!["E0301"], 1), "{found:#?}");
    assert_eq!(not_checked(&scope).len(), 1, "{scope}");
}

#[cfg(unix)]
#[test]
fn names_that_are_not_utf8_are_checked() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let folder = Folder::new(&[("p/b.frag", b"void main() { gl_FragColor = vec4(1.0); }\n")]);
    let name = OsStr::from_bytes(b"caf\xe9.frag");
    std::fs::write(folder.path("p").join(name), TYPO).expect("written");
    let (found, scope, exit) = lint(&folder, &["p"]);
    assert_eq!((codes(&found), &scope["summary"]["files"], exit), (vec!["E0301"], &json!(2), 1));
    let named = std::process::Command::new(env!("CARGO_BIN_EXE_glisten"))
        .arg("lint")
        .arg(folder.path("p").join(name))
        .output()
        .expect("it runs");
    assert!(code(&named) == 1 && out(&named).contains("E0301"), "{named:?}");
}

/// A `.glsl` file with a `main` needs its stage, and each command says how to give it; a file with other words that contain "main" is a part.
#[test]
fn a_shader_whose_name_does_not_tell_its_stage_gets_a_way_out() {
    let part = b"float domain(float x) { return x; } // main() is elsewhere\n";
    let folder = Folder::new(&[
        ("p/which.glsl", b"void main() { gl_FragColor = vec4(1.0); }\n"),
        ("p/domain.glsl", part),
        ("p/toy.glsl", b"void mainImage(out vec4 c, in vec2 p) { c = vec4(1.0); }\n"),
    ]);
    let (_, scope, _) = lint(&folder, &["p"]);
    let files: Vec<&str> = not_checked(&scope).iter().map(|(file, _)| *file).collect();
    assert_eq!(files, ["p/toy.glsl", "p/which.glsl"], "{scope}");
    let remedy = "`stage = \"fragment\"` in a `[[source]]` table of glisten.toml";
    let shown = folder.run(&["lint", "p"]);
    assert!(format!("{}{}", out(&shown), err(&shown)).contains(remedy), "{shown:?}");
    for arguments in [
        &["compile", "p", "-o", "new"][..],
        &["upgrade", "p", "-o", "new"],
        &["port", "p", "--for", "vulkan", "-o", "new"],
    ] {
        let told = err(&folder.run(arguments));
        let is_told = told.contains("2 files were not taken: they have a `main`") && told.contains(remedy);
        assert!(is_told, "{arguments:?}: {told}");
    }
    let table = b"[[source]]\nglob = \"*.glsl\"\nstage = \"fragment\"\n";
    let folder = Folder::new(&[
        ("p/which.glsl", b"void main() { gl_FragColor = vec4(1.0); }\n"),
        ("p/domain.glsl", part),
        ("p/glisten.toml", table),
    ]);
    let ported = folder.run(&["port", "p", "--for", "vulkan", "-o", "new"]);
    assert!(code(&ported) == 0 && !err(&ported).contains("not taken"), "{}", err(&ported));
    let text = std::fs::read_to_string(folder.path("new/which.glsl")).expect("written");
    assert!(text.starts_with("#version 450"), "{text}");
}

/// The stage of the command line counts for what a search finds, too.
#[test]
fn a_stage_that_is_given_counts_for_the_files_of_a_folder() {
    let folder = Folder::new(&[("p/which.glsl", b"void main() { gl_FragColor = vec4(nope); }\n"), ("p/a.vert", LATER)]);
    let (found, scope, exit) = lint(&folder, &["p", "--stage", "fragment"]);
    assert_eq!((codes(&found), exit), (vec!["E0301"], 1), "{found:#?}");
    let files: Vec<&str> = not_checked(&scope).iter().map(|(file, _)| *file).collect();
    assert_eq!(files, ["p/a.vert"], "{scope}");
}

#[test]
fn macros_that_make_shaders_are_named_and_folders_of_strings_are_not_empty() {
    let script =
        b"const a = `#version 300 es\nprecision highp float;\nout vec4 c;\nvoid main() { c = vec4(nope); }`;\n";
    let folder = Folder::new(&[("a.js", &script[..]), ("s.h", b"#define GLSL(shader) \"#version 410\\n\" #shader\n")]);
    let (found, scope, _) = lint(&folder, &["--embedded", "."]);
    assert_eq!(codes(&found), ["E0301"], "{found:#?}");
    let rows = not_checked(&scope);
    assert!(matches!(rows.as_slice(), [(file, why)] if file.ends_with("s.h") && why.contains("by `#`")), "{rows:?}");
    assert!(!err(&folder.run(&["lint", "--embedded", "."])).contains("no shader was found"));
}

#[test]
fn stages_that_tessellation_keeps_apart_are_told_so() {
    let main = b"#version 150\nvoid main() {}\n";
    let folder = Folder::new(&[("p/a.vert", &main[..]), ("p/a.frag", main), ("p/a.tesc", main), ("p/a.tese", main)]);
    let told = err(&folder.run(&["compile", "p", "-o", "out"]));
    assert!(
        told.contains("would both write") && told.contains("tessellation stages, which glisten does not read"),
        "{told}"
    );
}
