//! The first steps of a new user, end to end: a scene to begin with, help, messages for words of other languages, names of
//! bindings.

use crate::cli::{Folder, code, codes, err, out};
use crate::first_hour::{FLAT, render, scene};
use serde_json::Value;
use std::fs;

#[test]
fn a_new_scene_loads_and_draws() {
    let vertex = "#version 150\nin vec4 position;\nin vec3 normal;\nin vec2 uv;\nin ivec2 cell;\nin mat2 turn;\nuniform mat4 mc;\n\
        uniform vec3 list[2];\nuniform int n = 3;\nuniform B { bool on; } b;\nout vec3 v;\nvoid main() {\n    v = normal * float(n + \
        cell.x) + vec3(turn * uv, 0.0) + list[1];\n    gl_Position = b.on ? mc * position : position;\n}\n";
    let fragment = "#version 150\nin vec3 v;\nuniform sampler2D t, many[2];\nuniform samplerCube cube;\nuniform sampler3D solid;\n\
        uniform isampler2DArray ids;\nuniform sampler2DShadow shadow;\nuniform samplerBuffer line;\nuniform sampler2DRect r;\nout vec4 c;\n\
        void main() {\n    c = texture(t, v.xy) + texture(many[1], v.xy) + texture(cube, v) + texture(solid, v) + vec4(texture(ids, \
        v)) + texture(shadow, v) + texelFetch(line, 0) + texture(r, v.xy);\n}\n";
    let folder = Folder::new(&[("src/a.vert", vertex.as_bytes()), ("src/a.frag", fragment.as_bytes())]);
    let output = folder.run(&["new-scene", "src/a.vert", "src/a.frag", "-o", "a.toml"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let text = fs::read_to_string(folder.path("a.toml")).expect("written");
    assert!(text.contains("vertex = \"src/a.vert\"") && text.contains("# mat4"), "{text}");
    let (exit, told) = render(&folder, &["--deny", "warnings"]);
    assert_eq!((exit, told.as_str()), (0, ""), "{text}");
    let again = folder.run(&["new-scene", "src/a.vert", "src/a.frag", "-o", "a.toml"]);
    assert_eq!(code(&again), 2, "a file that exists is kept");
    let full =
        "#version 150\nvoid main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }\n";
    let folder = scene(full, FLAT.1, "");
    let output = folder.run(&["new-scene", "a.vert", "a.frag"]);
    assert!(out(&output).contains("vertex_count = 3"), "{}", out(&output));
    fs::write(folder.path("a.toml"), &output.stdout).expect("written");
    assert_eq!(render(&folder, &["--deny", "warnings"]), (0, String::new()));
    fs::write(folder.path("a.frag"), "#version 150\nvoid main() { x; }\n").expect("written");
    let failed = folder.run(&["new-scene", "a.vert", "a.frag", "-o", "b.toml"]);
    assert!(code(&failed) == 1 && !folder.path("b.toml").exists(), "{}", err(&failed));
}

#[test]
fn shells_complete_commands_and_help_explains_them() {
    let folder = Folder::new(&[]);
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let output = folder.run(&["completions", shell]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        for word in ["new-scene", "bind-attrib", "verify"] {
            assert!(out(&output).contains(word), "{shell}: {word}");
        }
        for hidden in [" -0 ", "--worker", " worker", "The digit of"] {
            assert!(!out(&output).contains(hidden), "{shell}: {hidden}");
        }
    }
    assert_eq!(code(&folder.run(&["completions", "nonesuch"])), 2);
    let (help, flag) = (folder.run(&["help", "lint"]), folder.run(&["lint", "--help"]));
    assert_eq!((code(&help), out(&help)), (0, out(&flag)));
}

#[test]
fn other_dialects_are_recognized() {
    for (text, word) in [
        (
            "#version 150\nuniform sampler2D t;\nin vec2 p;\nout vec4 c;\nvoid main() { c = t.Sample(p); }\n",
            "texture(s, p)",
        ),
        ("#version 150\nout vec4 c;\nvoid main() { c = vec4(sin(iTime)); }\n", "uniform float iTime;"),
        (
            "#version 150\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(p, 0.0, 1.0); }\n",
            "add `--engine shadertoy`",
        ),
    ] {
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        assert!(
            out(&folder.run(&["lint", "a.frag"])).contains(word),
            "{word}: {}",
            out(&folder.run(&["lint", "a.frag"]))
        );
    }
}

#[test]
fn comments_for_glisten_need_no_blank_and_no_case() {
    for comment in [
        "// glisten: allow(L0010)",
        "//glisten:allow(L0010)",
        "// Glisten:allow( L0010 )",
        "/* glisten: allow(L0010) */",
    ] {
        let text = format!(
            "#version 150\nuniform sampler2D t;\nin vec2 p;\nout vec4 c;\nvoid main() {{\n    c = vec4(0.0);\n    if (p.x > 0.5)\n        c \
             = texture(t, p); {comment}\n}}\n"
        );
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        let (list, _) = folder.lint(&["a.frag"]);
        assert!(list.is_empty(), "{comment}: {list:#?}");
        let (list, _) = Folder::new(&[("a.frag", text.replace(comment, "").as_bytes())]).lint(&["a.frag"]);
        assert_eq!(codes(&list), ["L0010"]);
    }
}

#[test]
fn bindings_have_the_errors_of_opengl() {
    let folder = Folder::triangle();
    for (binding, word) in [
        (["--bind-attrib", "gl_Vertex=0"], "GL_INVALID_OPERATION"),
        (["--bind-attrib", "pv=16"], "GL_INVALID_VALUE"),
        (["--bind-frag-data", "gl_FragColor=0"], "GL_INVALID_OPERATION"),
        (["--bind-frag-data", "fc=8"], "GL_INVALID_VALUE"),
    ] {
        let output = folder.run(&[&["compile", "tri.vert", "tri.frag", "-o", "out"][..], &binding].concat());
        assert!(code(&output) == 2 && err(&output).contains(word), "{binding:?}: {}", err(&output));
    }
    // Names that are not there are legal, and a warning.
    for (binding, message, help) in [
        (
            ["--bind-attrib", "pw=3"],
            "a location is bound to `pw`, which is no attribute of the program",
            "did you mean `pv`?",
        ),
        (
            ["--bind-frag-data", "fd=1"],
            "a color number is bound to `fd`, which is no fragment output",
            "did you mean `fc`?",
        ),
        (["--bind-attrib", "pv[0]=1"], "a location is bound to `pv[0]`", "bind the whole array, `pv`"),
        (["--bind-attrib", "fc=1"], "a location is bound to `fc`", "this is an output of the fragment stage"),
    ] {
        let output = folder.run(&[&["compile", "tri.vert", "tri.frag", "-o", "out"][..], &binding].concat());
        let told = err(&output);
        assert!(
            code(&output) == 0 && told.contains("W0708") && told.contains(message) && told.contains(help),
            "{told}"
        );
        let output = folder.run(&[&["lint", "tri.vert", "tri.frag"][..], &binding].concat());
        assert!(String::from_utf8_lossy(&output.stdout).contains(message), "{binding:?}");
    }
    // One program of several has the name.
    let other = b"#version 150\nin vec4 place;\nvoid main() { gl_Position = place; }\n";
    let two = Folder::new(&[
        ("a.vert", other),
        ("b.vert", &String::from_utf8_lossy(other).replace("place", "pv").into_bytes()),
    ]);
    for (binding, warnings) in [("pv=3", 0), ("place=3", 0), ("nosuch=3", 1)] {
        let told = err(&two.run(&["compile", "a.vert", "b.vert", "--check", "--bind-attrib", binding]));
        assert_eq!(told.matches("W0708").count(), warnings, "{binding}: {told}");
    }
    let good = ["--bind-attrib", "pv=15", "--bind-frag-data", "fc=0"];
    let output = folder.run(&[&["compile", "tri.vert", "tri.frag", "-o", "out"][..], &good].concat());
    assert_eq!(code(&output), 0, "{}", err(&output));
}

#[test]
fn a_fragment_shader_alone_gets_a_vertex_shader() {
    let fragment = "#version 150\nin vec2 uv;\nflat in int mode;\nin vec4 tint;\nout vec4 c;\nvoid main() {\n    c = vec4(uv, tint.w, \
        float(mode) + 1.0);\n}\n";
    let folder = Folder::new(&[("wave.frag", fragment.as_bytes())]);
    let output = folder.run(&["new-scene", "wave.frag", "-o", "wave.toml"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let drawn = folder.run(&["render", "wave.toml", "-o", "wave.npy", "--backend", "cpu"]);
    assert_eq!((code(&drawn), err(&drawn).as_str()), (0, ""), "it loads and draws without a word");
    let linted = folder.run(&["lint", "wave_fullscreen.vert", "--deny", "warnings"]);
    assert_eq!(code(&linted), 0, "{}", out(&linted));
    assert_eq!(code(&folder.run(&["new-scene", "wave.frag"])), 2, "the vertex shader needs a place");
}

#[test]
fn manual_pages_are_written_for_every_command() {
    let folder = Folder::new(&[]);
    let output = folder.run(&["man", "-o", "pages"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let pages = folder.names("pages");
    for page in ["glisten.1", "glisten-lint.1", "glisten-stability.1", "glisten-new-scene.1"] {
        assert!(pages.iter().any(|name| name == page), "{page}: {pages:?}");
    }
    let text = fs::read_to_string(folder.path("pages/glisten-lint.1")).expect("it was written");
    assert!(text.contains(".TH glisten") && text.contains("\\-\\-deny"), "{text}");
}

#[test]
fn an_error_names_the_command_that_explains_it() {
    let folder = Folder::new(&[("a.frag", b"#version 150\nout vec4 c;\nvoid main() { c = vec4(x); }\n")]);
    let output = folder.run(&["lint", "a.frag"]);
    assert!(err(&output).contains("`glisten explain E0301` explains the first error"), "{}", err(&output));
    let quiet = folder.run(&["lint", "-q", "a.frag"]);
    assert_eq!(err(&quiet), "");
}

#[test]
fn words_of_other_languages_and_missing_macros_get_the_words_of_glsl() {
    let root = crate::support::root();
    let run = |name: &str| {
        let file = root.join("fixtures/invalid/names").join(name);
        out(&Folder::new(&[]).run(&["lint", "-q", &file.to_string_lossy()]))
    };
    let names = run("other_languages.frag");
    for help in ["did you mean `MAX_LIGHTS`?", "add `-D BONES=VALUE`", "write `vec3(..)`"] {
        assert!(names.contains(help), "{help}: {names}");
    }
    let casts = run("cast.frag");
    for help in ["`(float3x3)` is not a cast", "write `mat3(..)` around", "write `int(..)` around"] {
        assert!(casts.contains(help), "{help}: {casts}");
    }
}

#[test]
fn flat_varyings_of_a_program_are_one_finding() {
    let folder = crate::support::root().join("fixtures/lint/L0004");
    let file = |name: &str| folder.join(name).to_string_lossy().into_owned();
    let (findings, _) = Folder::new(&[]).lint(&[&file("bad_many.vert"), &file("bad_many.frag")]);
    let flat: Vec<&Value> = findings.iter().filter(|finding| finding["code"] == "L0004").collect();
    assert_eq!(flat.len(), 1, "{findings:?}");
    assert!(flat[0]["message"].as_str().is_some_and(|text| text.contains("`id` and 2 more varyings")), "{flat:?}");
}

#[test]
fn a_text_that_rejects_itself_is_one_error() {
    let text = "#version 150\n#ifndef QUALITY\n#error define QUALITY\n#endif\nout vec4 c;\nvoid main() { c = vec4(lost(QUALITY_STEPS), \
        missing.x, 1.0, nothing); }\n";
    let folder = Folder::new(&[("a.frag", text.as_bytes())]);
    let (findings, exit) = folder.lint(&["a.frag"]);
    let list: Vec<String> = findings.iter().filter_map(|finding| Some(finding["code"].as_str()?.to_owned())).collect();
    assert_eq!((exit, list), (1, vec!["E0118".to_owned()]), "{findings:?}");
}

#[test]
fn a_file_without_a_version_is_not_laid_at_what_it_includes() {
    let folder = Folder::new(&[
        ("a.frag", b"#include \"lib.glsl\"\nout vec4 c;\nvoid main() { c = vec4(twice(0.5)); }\n"),
        ("lib.glsl", b"float twice(float x) { return 2.0 * x; }\n"),
        ("ok.frag", b"#version 150\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
    ]);
    let (findings, _) = folder.lint(&["a.frag"]);
    let files: Vec<(&str, &str)> = findings
        .iter()
        .filter_map(|finding| Some((finding["code"].as_str()?, finding["file"].as_str()?)))
        .filter(|(code, _)| *code == "E0120")
        .collect();
    assert_eq!(files, [("E0120", "a.frag")], "{findings:?}");
    let searched = folder.run(&["lint", "."]);
    assert_eq!(code(&searched), 0, "a search counts it as another version: {}", out(&searched));
}

#[test]
fn a_fragment_shader_gets_a_triangle_whatever_its_inputs_are_called() {
    for (header, input) in [("#version 150", "in"), ("#version 100\nprecision mediump float;", "varying")] {
        let output = if input == "in" { "out vec4 c;" } else { "" };
        let color = if input == "in" { "c" } else { "gl_FragColor" };
        let text = format!(
            "{header}\n{input} vec2 uv;\n{input} vec3 corner;\n{output}\nvoid main() {{ {color} = vec4(uv, corner.x, 1.0); }}\n"
        );
        let folder = Folder::new(&[("a.frag", text.as_bytes())]);
        assert_eq!(code(&folder.run(&["new-scene", "a.frag", "-o", "a.toml"])), 0, "{header}");
        let output = folder.run(&["render", "a.toml", "--backend", "cpu", "-o", "a.npy"]);
        assert_eq!(code(&output), 0, "{header}: {}", err(&output));
        let bytes = fs::read(folder.path("a.npy")).expect("it was drawn");
        let last: Vec<f32> = bytes
            .chunks_exact(4)
            .rev()
            .take(4)
            .map(|four| f32::from_le_bytes([four[0], four[1], four[2], four[3]]))
            .collect();
        // The last pixel is at the lower right: (1, 0) nearly.
        assert!(last[3] > 0.9 && last[2] < 0.1 && last[1] > 0.9, "{header}: {last:?}");
    }
}
