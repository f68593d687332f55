//! `glisten upgrade` end to end: old programs become programs of 1.50, 3.30 and ES 3.00 that compile, with their comments.

use crate::cli::{Folder, code, err, out};
use crate::support::root;
use std::fs;
use std::process::{Command, Output};

const BASE: &str = "fixtures/upgrade";

fn here(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_glisten")).args(arguments).current_dir(root()).output().expect("the program runs")
}

#[test]
fn old_programs_become_new_ones_that_compile() {
    for (to, version) in [
        ("150", "#version 150"),
        ("330", "#version 330 core"),
        ("450", "#version 450 core"),
        ("460", "#version 460 core"),
        ("300es", "#version 300 es"),
    ] {
        let folder = Folder::new(&[]);
        let into = folder.path("new").to_string_lossy().into_owned();
        let files = [format!("{BASE}/lit.vert"), format!("{BASE}/lit.frag")];
        let output = here(&["upgrade", &files[0], &files[1], "--to", to, "-o", &into]);
        assert_eq!(code(&output), 0, "{to}: {}", err(&output));
        assert!(err(&output).contains("`gl_Vertex` is `vertex`"), "{}", err(&output));
        for name in ["lit.vert", "lit.frag"] {
            let text = fs::read_to_string(folder.path(&format!("new/{name}"))).expect("it was written");
            assert!(text.starts_with(version), "{text}");
            assert!(!text.contains("varying") && !text.contains("gl_Frag") && !text.contains("texture2D"), "{text}");
            let old = fs::read_to_string(root().join(BASE).join(name)).expect("readable");
            for comment in old.lines().filter_map(|line| Some(&line[line.find("//")?..])) {
                assert!(text.contains(comment), "{comment} is not in {text}");
            }
        }
        let checked = folder.run(&["lint", "new", "--deny", "warnings"]);
        assert_eq!(code(&checked), 0, "{to}: {}", out(&checked));
        assert!(err(&checked).contains("2 files, 1 program"), "{}", err(&checked));
    }
}

#[test]
fn the_picture_of_a_scene_stays() {
    let folder = Folder::new(&[]);
    let into = folder.path("new").to_string_lossy().into_owned();
    let [vertex, fragment, scene] = ["plain.vert", "plain.frag", "plain.toml"].map(|name| format!("{BASE}/{name}"));
    let output = here(&["upgrade", &vertex, &fragment, "-o", &into, "--scene", &scene]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(err(&output).contains("the same to the bit"), "{}", err(&output));
    let missing = here(&["upgrade", &vertex, &fragment, "-o", &into, "--scene", "nowhere.toml"]);
    assert_eq!(code(&missing), 2, "{}", err(&missing));
}

#[test]
fn a_single_file_goes_to_standard_output_or_replaces_itself() {
    let es = format!("{BASE}/es.frag");
    let output = here(&["upgrade", &es, "--to", "300es"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(out(&output).contains("precision mediump float;\nout mediump vec4 fragColor;"), "{}", out(&output));
    let old = fs::read(root().join(&es)).expect("readable");
    let folder = Folder::new(&[
        ("a.frag", &old),
        ("lib.glsl", b"varying vec2 place;\n"),
        ("b.frag", b"#include \"lib.glsl\"\nvoid main() { gl_FragColor = vec4(place, 0.0, 1.0); }\n"),
    ]);
    assert_eq!(code(&folder.run(&["upgrade", "a.frag", "--in-place"])), 0);
    assert!(fs::read_to_string(folder.path("a.frag")).is_ok_and(|text| text.starts_with("#version 150\n")));
    let both = folder.run(&["upgrade", "a.frag", "b.frag"]);
    assert_eq!(code(&both), 2, "several files need a place");
    let including = folder.run(&["upgrade", "b.frag"]);
    assert_eq!(code(&including), 0, "{}", err(&including));
    assert!(
        out(&including).contains("#version 150\nout vec4 fragColor;\n#include \"lib.glsl\"\n"),
        "{}",
        out(&including)
    );
}

#[test]
fn what_cannot_be_upgraded_is_told_and_nothing_is_written() {
    let folder = Folder::new(&[
        ("clip.vert", b"void main() { gl_ClipVertex = gl_Vertex; gl_Position = ftransform(); }\n"),
        ("wrong.frag", b"void main() { gl_FragColor = missing; }\n"),
        ("new.frag", b"#version 330\nout vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
        ("es.frag", b"#version 300 es\nout mediump vec4 c;\nvoid main() { c = vec4(1.0); }\n"),
        ("part.frag", b"vec4 tone(vec4 c);\nvoid main() { gl_FragColor = tone(vec4(1.0)); }\n"),
        ("module.frag", b"vec4 tone(vec4 c) { return c; }\n"),
    ]);
    let es = folder.run(&["upgrade", "es.frag"]);
    assert!(err(&es).contains("newer than the target 1.50") && err(&es).contains("add `--to 300es`"), "{}", err(&es));
    assert_eq!(code(&folder.run(&["upgrade", "es.frag", "--to", "300es"])), 0);
    for (file, exit, told) in [
        ("clip.vert", 1, "gl_ClipVertex"),
        ("wrong.frag", 1, "missing"),
        ("new.frag", 1, "newer than the target 1.50"),
        ("part.frag", 1, "`tone` is called and only declared; if another fragment shader defines it, name all shaders"),
        ("module.frag", 1, "no source has a `main`"),
    ] {
        let output = folder.run(&["upgrade", file, "-o", "new"]);
        assert_eq!(code(&output), exit, "{file}: {}", err(&output));
        assert!(err(&output).contains(told), "{file}: {}", err(&output));
    }
    assert!(folder.names("new").is_empty());
}

#[test]
fn the_stages_of_one_file_become_files() {
    let folder = Folder::new(&[
        (
            "marked.glsl",
            b"#shader vertex\nattribute vec4 at;\nvarying vec2 uv;\nvoid main() { gl_Position = at; uv = at.xy; }\n\n\n\
              #shader fragment\nvarying vec2 uv;\nvoid main() { gl_FragColor = vec4(uv, 0.0, 1.0); }\n",
        ),
        (
            "chosen.glsl",
            b"#version 120\nvarying vec2 uv;\n#ifdef VERTEX\nvoid main() { gl_Position = gl_Vertex; uv = gl_Vertex.xy; }\n\
              #endif\n#ifdef FRAGMENT\nvoid main() { gl_FragColor = vec4(uv, 0.0, 1.0); }\n#endif\n",
        ),
    ]);
    for (file, stem) in [("marked.glsl", "marked"), ("chosen.glsl", "chosen")] {
        let output = folder.run(&["upgrade", file, "-o", "new"]);
        assert_eq!(code(&output), 0, "{file}: {}", err(&output));
        let [vertex, fragment] = ["vert", "frag"].map(|stage| format!("new/{stem}.{stage}"));
        let output = folder.run(&["compile", &vertex, &fragment, "--check"]);
        assert_eq!(code(&output), 0, "{file}: {}", err(&output));
        let text = fs::read_to_string(folder.path(&fragment)).expect("it was written");
        assert!(text.starts_with("#version 150") && text.contains("in vec2 uv;"), "{text}");
    }
    assert_eq!(code(&folder.run(&["upgrade", "marked.glsl", "--in-place"])), 2);
}

#[test]
fn words_that_the_new_version_reserves_get_other_names() {
    let old = "uniform float centroid; uniform vec4 row_major; struct S { float sample; };\nuniform S s;\n\
               void main() { gl_FragColor = row_major * centroid * s.sample; }\n";
    let core = "#version 150\nuniform float buffer; out vec4 shared_; void main() { shared_ = vec4(buffer); }\n";
    let folder = Folder::new(&[("a.frag", old.as_bytes()), ("b.frag", core.as_bytes())]);
    // `row_major` is a name again from 4.40 on.
    for (to, said) in [("150", "row_major_ * centroid_ * s.sample"), ("450", "row_major * centroid_ * s.sample_")] {
        let output = folder.run(&["upgrade", "a.frag", "--to", to]);
        assert_eq!(code(&output), 0, "{to}: {}", err(&output));
        assert!(out(&output).contains(said), "{}", out(&output));
    }
    let output = folder.run(&["upgrade", "b.frag", "--to", "450"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    assert!(out(&output).contains("uniform float buffer_;"), "{}", out(&output));
    let output = folder.run(&["upgrade", "b.frag", "--to", "150"]);
    assert!(out(&output).contains("uniform float buffer;"), "{}", out(&output));
}

/// In 1.30 and later, a variable may hide a function that old names of lookups become.
#[test]
fn variables_give_way_to_the_lookups_of_today() {
    let code_of = |version: &str| {
        format!(
            "#version {version}\nuniform sampler2D texture;\nin vec2 p;\nout vec4 o;\nvoid main() {{ o = texture2D(texture, p); }}\n"
        )
    };
    let folder = Folder::new(&[("a.frag", code_of("130").as_bytes()), ("b.frag", code_of("410 core").as_bytes())]);
    for (file, to) in [("a.frag", "150"), ("a.frag", "330"), ("a.frag", "vulkan"), ("b.frag", "450")] {
        let output = folder.run(&["upgrade", file, "--to", to]);
        assert_eq!(code(&output), 0, "{file} {to}: {}", err(&output));
        assert!(out(&output).contains("uniform sampler2D texture_;"), "{file} {to}: {}", out(&output));
        assert!(out(&output).contains("texture(texture_, p)"), "{file} {to}: {}", out(&output));
    }
}

/// From GLSL 4.20 on, only outputs are invariant.
#[test]
fn inputs_lose_their_invariance() {
    let old = "#version 410\n// a\nin C { invariant vec2 t; } i;\ninvariant in vec2 u; // u\nin vec2 v;\ninvariant v;\n\
        out vec4 color;\nvoid main() { color = vec4(i.t, u + v); }\n";
    let es = "#version 100\nprecision mediump float;\ninvariant varying vec2 a;\nvarying vec2 b;\ninvariant b;\n\
        void main() { gl_FragColor = vec4(a, b); }\n";
    let folder = Folder::new(&[("a.frag", old.as_bytes()), ("b.frag", es.as_bytes())]);
    for (file, to) in [("a.frag", "450"), ("a.frag", "vulkan"), ("b.frag", "460"), ("b.frag", "300es")] {
        let output = folder.run(&["upgrade", file, "--to", to]);
        assert_eq!(code(&output), 0, "{file} {to}: {}", err(&output));
        assert!(!out(&output).contains("invariant"), "{file} {to}: {}", out(&output));
    }
    assert!(out(&folder.run(&["upgrade", "a.frag", "--to", "450"])).contains("in vec2 u; // u\n"));
    let kept = folder.run(&["upgrade", "b.frag", "--to", "330"]);
    assert!(out(&kept).contains("invariant in vec2 a;"), "{}{}", out(&kept), err(&kept));
}

/// A backslash that ends a `//` comment joins no line before GLSL 4.20, and does so after it: the statement behind it stays one.
#[test]
fn comments_that_end_in_a_backslash_end_with_their_line() {
    let vertex = "#version 110\nattribute vec4 p;\nvoid main() { gl_Position = p; }\n";
    let fragment = "#version 110\nuniform vec4 c;\n// a macro \\\n#define HALF 0.5\nvoid main() {\n    vec4 d = c;\n    // half of it: a \\ b, or \\\n    \
        d *= HALF;\n    gl_FragColor = d; /* in here it does not count \\\n    */\n}\n";
    for to in ["150", "450", "460", "300es"] {
        let folder = Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())]);
        let output = folder.run(&["upgrade", "a.vert", "a.frag", "--to", to, "-o", "new"]);
        assert_eq!(code(&output), 0, "{to}: {}", err(&output));
        let compiled = folder.run(&["compile", "new/a.vert", "new/a.frag", "--target", "glsl", "-o", "glsl"]);
        assert_eq!(code(&compiled), 0, "{to}: {}", err(&compiled));
        let text = fs::read_to_string(folder.path("glsl/a.frag.glsl")).expect("it was written");
        assert!(text.contains("*= 0.5") || text.contains("* 0.5"), "{to}: {text}");
    }
}
