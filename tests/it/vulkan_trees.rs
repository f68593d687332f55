//! `glisten upgrade --to vulkan` over trees: a file that several programs include is changed once, for all of them.
//!
//! The judge is `glslangValidator`. If it is missing, the test says so; if `CI` is set, it fails.

use crate::cli::{Folder, code, err};
use crate::vulkan::complaint;
use glisten_front::hir::Stage;
use std::fs;

const COMMON: &str = "// Everything that all programs have.\n#ifndef COMMON\n#define COMMON\n\n\
    uniform float scale; // of the model\n#ifdef FOG\n// The color far away.\nuniform vec4 fogColor;\n#else\nuniform vec3 dust;\n#endif\n\
    #define UNIFORM(type, name) uniform type name\nUNIFORM(vec3, tint);\nuniform sampler2D map;\n#define VARYING in\n\
    float scaled(float x) { return x * scale; }\n#endif\n";

const VERTEX: &str = "#version 150\n#include \"parts/common.glsl\"\nin vec4 p;\n// The camera.\nuniform mat4 mvp;\nout vec2 uv;\nout vec3 n;\n\
    void main() { uv = p.xy * scaled(2.0); n = p.yyy; gl_Position = mvp * p; }\n";

fn tree() -> Folder {
    let foggy = "#version 150\n#define FOG\n#include \"parts/common.glsl\"\nVARYING vec2 uv;\nin vec3 n;\nuniform float density;\nout vec4 color;\n\
        void main() { color = mix(texture(map, uv), fogColor, density) + vec4(tint * n, 0.0); }\n";
    let clear = "#version 150\n#include \"parts/common.glsl\"\nin vec3 n;\nin vec2 uv;\nout vec4 color;\n\
        void main() { color = texture(map, uv) * vec4(dust, 1.0) * n.x + gl_FragCoord.y; }\n";
    let clear_vertex = VERTEX.replace("out vec2 uv;\nout vec3 n;", "out vec3 n;\nout vec2 uv;");
    Folder::new(&[
        ("tree/foggy.vert", VERTEX.as_bytes()),
        ("tree/foggy.frag", foggy.as_bytes()),
        ("tree/clear.vert", clear_vertex.as_bytes()),
        ("tree/clear.frag", clear.as_bytes()),
        ("tree/parts/common.glsl", COMMON.as_bytes()),
    ])
}

fn read(folder: &Folder, name: &str) -> String {
    fs::read_to_string(folder.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

#[track_caller]
fn has(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "no `{part}` in:\n{text}");
    }
}

#[test]
fn a_file_that_many_programs_include_is_changed_once() {
    let folder = tree();
    let output = folder.run(&["upgrade", "tree", "--to", "vulkan", "-o", "new"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let common = read(&folder, "new/parts/common.glsl");
    has(
        &common,
        &[
            "// Everything that all programs have.\n#ifndef COMMON\n#define COMMON\n\nlayout(std140, set = 0, binding = 1) uniform CommonUniforms {\n",
            "    layout(offset = 0) float scale;  // of the model\n    // The color far away.\n    layout(offset = 16) vec4 fogColor;\n    \
             layout(offset = 32) vec3 dust;\n    layout(offset = 48) vec3 tint;\n};\n",
            "#define UNIFORM(type, name) uniform type name\nlayout(set = 1, binding = 0) uniform sampler2D map;\n",
        ],
    );
    assert!(!common.contains("UNIFORM(vec3"), "{common}");
    let foggy = read(&folder, "new/foggy.frag");
    has(&foggy, &["#define FOG\n#include \"parts/common.glsl\"\n", ") VARYING vec2 uv;", "float density;"]);
    for stem in ["foggy", "clear"] {
        let texts = [(Stage::Vertex, "vert"), (Stage::Fragment, "frag")]
            .map(|(stage, extension)| (stage, read(&folder, &format!("new/{stem}.{extension}"))));
        let said = complaint(&folder.path("new"), &texts);
        assert!(said.is_none(), "{said:?}\n{texts:#?}\n{common}");
    }
    // The same tree in place has the same texts.
    assert_eq!(code(&folder.run(&["upgrade", "-q", "tree", "--to", "vulkan", "--in-place"])), 0);
    assert_eq!(read(&folder, "tree/parts/common.glsl"), common);
    assert_eq!(read(&folder, "tree/foggy.frag"), foggy);
}

#[test]
fn a_varying_of_an_old_header_has_a_file_for_each_stage() {
    let folder = Folder::new(&[
        ("a.vert", b"#include \"both.glsl\"\nuniform mat4 m;\nvoid main() { uv = gl_Vertex.xy; gl_Position = m * gl_Vertex; }\n"),
        ("a.frag", b"#include \"both.glsl\"\nvoid main() { gl_FragColor = vec4(uv, 0.0, 1.0); }\n"),
        ("both.glsl", b"varying vec2 uv; // a place\n"),
    ]);
    for to in ["450", "vulkan"] {
        let output = folder.run(&["upgrade", "a.vert", "a.frag", "--to", to, "-o", to]);
        assert_eq!(code(&output), 0, "{}", err(&output));
        has(&read(&folder, &format!("{to}/a.vert")), &["#include \"both.vert.glsl\"\n"]);
        has(&read(&folder, &format!("{to}/a.frag")), &["#include \"both.frag.glsl\"\n"]);
        has(&read(&folder, &format!("{to}/both.vert.glsl")), &["out vec2 uv; // a place\n"]);
        has(&read(&folder, &format!("{to}/both.frag.glsl")), &["in vec2 uv; // a place\n"]);
    }
    let texts = [(Stage::Vertex, read(&folder, "vulkan/a.vert")), (Stage::Fragment, read(&folder, "vulkan/a.frag"))];
    let said = complaint(&folder.path("vulkan"), &texts);
    assert!(said.is_none(), "{said:?}\n{texts:#?}");
}

#[test]
fn the_extension_for_includes_has_the_name_that_glslang_takes() {
    let fragment = "#version 150\n#extension GL_ARB_shading_language_include : require\n#include \"tint.glsl\"\nout vec4 c;\n\
        void main() { c = tint(); }\n";
    let folder = Folder::new(&[("a.frag", fragment.as_bytes()), ("tint.glsl", b"vec4 tint() { return vec4(1.0); }\n")]);
    let output = folder.run(&["upgrade", "a.frag", "--to", "vulkan", "-o", "new"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let new = read(&folder, "new/a.frag");
    has(&new, &["#version 450\n#extension GL_GOOGLE_include_directive : require\n"]);
    assert_eq!(new.matches("#extension").count(), 1, "{new}");
    let said = complaint(&folder.path("."), &[(Stage::Fragment, new.clone())]);
    assert!(said.is_none(), "{said:?}\n{new}");
}

#[test]
fn what_a_false_condition_hides_changes_too() {
    let fragment = "#version 150\nuniform vec4 tint;\n#ifdef GLOW\nuniform float glow, halo[3]; // both\nuniform sampler2D light;\n#endif\n\
        #ifdef SKIN\nstruct Bone { mat4 m; };\nuniform Bone bones[4];\n#endif\nout vec4 c;\nvoid main() {\n    c = tint;\n#ifdef GLOW\n    c += glow * halo[1];\n#endif\n}\n";
    let folder = Folder::new(&[("a.frag", fragment.as_bytes())]);
    let output = folder.run(&["upgrade", "a.frag", "--to", "vulkan", "-o", "new"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let new = read(&folder, "new/a.frag");
    has(
        &new,
        &[
            "    layout(offset = 0) vec4 tint;\n#ifdef GLOW\n    layout(offset = 16) float glow;  // both\n    layout(offset = 32) float halo[3];\n#endif\n};\n",
            "layout(set = 1, binding = 0) uniform sampler2D light;",
            "uniform Bone bones[4];",
        ],
    );
    assert!(err(&output).contains("a.frag:9: no program sees this declaration"), "{}", err(&output));
    let lit = new.replace("#version 450\n", "#version 450\n#define GLOW\n");
    for text in [new, lit] {
        let said = complaint(&folder.path("new"), &[(Stage::Fragment, text.clone())]);
        assert!(said.is_none(), "{said:?}\n{text}");
    }
}

#[test]
fn an_included_file_is_never_lost() {
    let folder = Folder::new(&[
        ("b.frag", b"#version 150\n#include \"u.glsl\"\nout vec4 c;\nvoid main() { c = u; }\n"),
        ("u.glsl", b"uniform vec4 u;\n"),
        ("deep/c.frag", b"#version 150\n#include \"../u.glsl\"\nout vec4 c;\nvoid main() { c = u; }\n"),
        ("d.frag", b"#version 150\n#define U uniform vec4 u;\nU\nout vec4 c;\nvoid main() { c = u; }\n"),
    ]);
    // To standard output there is no place for it.
    let output = folder.run(&["upgrade", "b.frag", "--to", "vulkan"]);
    assert_eq!(code(&output), 2, "{}", err(&output));
    assert!(err(&output).contains("`u.glsl` changes, too"), "{}", err(&output));
    let output = folder.run(&["upgrade", "deep/c.frag", "--to", "vulkan", "-o", "new"]);
    assert_eq!(code(&output), 2, "{}", err(&output));
    assert!(err(&output).contains("name the folder"), "{}", err(&output));
    assert!(folder.names("new").is_empty());
    let output = folder.run(&["upgrade", "d.frag", "--to", "vulkan"]);
    assert_eq!(code(&output), 1, "{}", err(&output));
    assert!(err(&output).contains("`u` is declared inside of a macro of `d.frag`"), "{}", err(&output));
}
