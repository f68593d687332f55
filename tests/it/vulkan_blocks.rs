//! `glisten upgrade --to vulkan`: the block of the loose uniforms is where all that its members need is defined, and what else of a text
//! may be in several branches, in macros, or on lines that end otherwise.
//!
//! The judge is `glslangValidator`. If it is missing, the test says so; if `CI` is set, it fails.

use crate::cli::{Folder, code, err};
use crate::port::has;
use crate::vulkan::{complaint, rewritten_stage};
use glisten_front::hir::Stage;
use std::fs;

fn fragment(text: &str) -> String {
    rewritten_stage(text, Stage::Fragment)
}

/// The body of the block of a text.
fn block(text: &str) -> &str {
    let start = text.find("Uniforms {\n").unwrap_or_else(|| panic!("no block in:\n{text}")) + "Uniforms {\n".len();
    &text[start..start + text[start..].find("};").expect("it ends")]
}

const MAIN: &str = "out vec4 c;\nvoid main() { c = tint[1] * k; }\n";

#[test]
fn the_block_is_after_the_macros_that_it_needs() {
    for define in
        ["#define N 4\n", "#define M 4\n#define N M\n", "#ifndef N\n#define N 4\n#endif\n", "const int N = 2, M = 3;\n"]
    {
        let text = fragment(&format!("#version 330\nuniform float k;\n{define}uniform vec4 tint[N];\n{MAIN}"));
        has(&text, &[&format!("#version 330\n{define}").replace("330", "450"), "vec4 tint[N];\n};\n"]);
    }
    let text = fragment(
        "#version 330\nuniform float k;\n#define float4 vec4\nuniform float4 tint;\nout float4 c;\nvoid main() { c = tint * k; }\n",
    );
    has(
        &text,
        &["#define float4 vec4\nlayout(std140, set = 0, binding = 0) uniform Uniforms {\n", " float4 tint;\n};\n"],
    );
}

#[test]
fn a_type_is_spelled_out_where_its_words_mean_something_else() {
    // A function between them uses one of the uniforms.
    let text = fragment(
        "#version 330\nuniform float k;\nfloat f(float x) { return x * k; }\n#define N 4\nuniform vec4 tint[N];\n\
         out vec4 c;\nvoid main() { c = tint[1] * f(2.0); }\n",
    );
    has(block(&text), &[" vec4 tint[4];\n"]);
    // So does one by a macro.
    let text = fragment(
        "#version 330\n#define K k\nuniform float k;\nfloat f(float x) { return x * K; }\n#define N 4\nuniform vec4 tint[N];\n\
         out vec4 c;\nvoid main() { c = tint[1] * f(2.0); }\n",
    );
    has(block(&text), &[" vec4 tint[4];\n"]);
    // A macro that is defined again.
    let text = fragment(
        "#version 330\n#define N 4\nuniform vec4 tint[N];\n#undef N\n#define N 2\nuniform float w[N];\nout vec4 c;\n\
         void main() { c = tint[3] * w[1]; }\n",
    );
    has(block(&text), &[" vec4 tint[N];\n", " float w[2];\n"]);
    // Where the block is, the macro is there under the same condition.
    let text = fragment(
        "#version 330\n#define A\n#ifdef A\n#define float4 vec4\nuniform float4 tint;\n#endif\n#ifndef B\nuniform float k;\n#endif\n\
         out vec4 c;\nvoid main() { c = tint * k; }\n",
    );
    has(block(&text), &["#ifdef A\n", " float4 tint;\n", "#ifndef B\n"]);
}

#[test]
fn guards_of_files_are_no_conditions() {
    for (define, ty) in [("#define float4 vec4\n", "float4"), ("struct float4 { vec4 a; };\n", "float4")] {
        let (value, other) = if define.starts_with('#') { ("tint", "other") } else { ("tint.a", "other.a") };
        let text = fragment(&format!(
            "#version 330\n#ifndef G\n#define G\n{define}uniform {ty} tint;\n#endif\n#ifndef H\n#define H\nuniform {ty} other;\n#endif\n\
             out vec4 c;\nvoid main() {{ c = {value} * {other}; }}\n"
        ));
        assert_eq!(
            block(&text),
            "    layout(offset = 0) float4 tint;\n    layout(offset = 16) float4 other;\n",
            "{text}"
        );
        has(&text, &["#define G\n", "#ifndef H\n#define H\n#endif\n"]);
    }
}

#[test]
fn a_macro_that_decides_may_be_before_the_block() {
    let text = fragment(
        "#version 330\nuniform float k;\n#define TINTED 1\n#if TINTED\nuniform vec4 tint;\n#endif\nout vec4 c;\n\
         void main() { c = tint * k; }\n",
    );
    has(&text, &["#define TINTED 1\nlayout(std140", "#if TINTED\n    layout(offset = 16) vec4 tint;\n#endif\n};\n"]);
}

#[test]
fn what_an_included_file_defines_is_before_the_block() {
    let source = "#version 150\n#extension GL_ARB_shading_language_include : require\nuniform float k;\n#include \"size.glsl\"\n\
                  uniform vec4 tint[N];\nout vec4 c;\nvoid main() { c = tint[1] * k; }\n";
    let folder = Folder::new(&[("a.frag", source.as_bytes()), ("size.glsl", b"#define N 4\n")]);
    let output = folder.run(&["upgrade", "-q", "--to", "vulkan", "-o", "new", "a.frag"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let text = fs::read_to_string(folder.path("new/a.frag")).expect("written");
    has(&text, &["#include \"size.glsl\"\nlayout(std140", "vec4 tint[N];\n};\n"]);
}

#[test]
fn main_may_be_in_each_branch_of_a_condition() {
    let text = rewritten_stage(
        "#version 330\nin vec3 p;\n#ifdef A\nvoid main() { gl_Position = vec4(p, 2.0); }\n#else\nvoid main() { gl_Position = vec4(p, 1.0); }\n\
         #endif\n",
        Stage::Vertex,
    );
    assert_eq!(text.matches("void openglMain() {").count(), 2, "{text}");
    assert_eq!(text.matches("void main() {").count(), 1, "{text}");
}

#[test]
fn a_lone_geometry_stage_has_inputs() {
    let text = rewritten_stage(
        "#version 330\nlayout(points) in;\nlayout(points, max_vertices = 1) out;\nin vec3 tint[];\nin V { mat3 m; } v[];\nout vec3 color;\n\
         void main() {\n    for (int i = 0; i < 1; i++) {\n        gl_Position = gl_in[i].gl_Position;\n        color = v[i].m * tint[i];\n        \
         EmitVertex();\n    }\n}\n",
        Stage::Geometry,
    );
    has(&text, &[") in vec3 tint[];\n", ") in V { mat3 m; } v[];\n"]);
}

#[test]
fn a_declaration_may_follow_macros_that_declare() {
    let text = fragment(
        "#version 330\n#define U(t, n) uniform t n;\nU(float, a)\nU(vec3, b)\nout vec4 c;\nvoid main() { c = vec4(a * b, 1.0); }\n",
    );
    has(&text, &[" float a;\n", " vec3 b;\n", "layout(location = 0) out vec4 c;\n"]);
}

#[test]
fn lines_may_end_with_carriage_returns_alone() {
    let text = fragment("#version 330\r// old\runiform float a;\rout vec4 c;\rvoid main() { c = vec4(a); }\r");
    has(&text, &["// old\n", " float a;\n", "layout(location = 0) out vec4 c;\n"]);
}

#[test]
fn a_uniform_may_define_its_struct_with_samplers() {
    let source = "#version 330\nuniform struct L { vec4 a; sampler2D t; } s;\nout vec4 c;\n\
                  void main() { c = s.a * texture(s.t, vec2(0.0)); }\n";
    let folder = Folder::new(&[("a.frag", source.as_bytes())]);
    let output = folder.run(&["upgrade", "--to", "vulkan", "-o", "new", "a.frag"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    has(&err(&output), &["a.frag:2: `s.t` is `s_t`"]);
    let text = fs::read_to_string(folder.path("new/a.frag")).expect("written");
    has(&text, &[" L s;\n", "uniform sampler2D s_t;\n", "c = s.a * texture(s_t, vec2(0.0));"]);
    assert_eq!(complaint(&folder.path("new"), &[(Stage::Fragment, text.clone())]), None, "{text}");
}

#[test]
fn a_prelude_may_have_macros_with_names_of_keywords() {
    let folder = Folder::new(&[
        ("in/common.h", b"#define lowp\n"),
        ("in/one.frag", b"uniform lowp float a;\nvoid main() { gl_FragColor = vec4(a); }\n"),
        ("in/two.frag", b"uniform float b;\nvoid main() { gl_FragColor = vec4(b); }\n"),
    ]);
    let output = folder.run(&["port", "in", "--for", "vulkan", "--prelude", "in/common.h", "-o", "out"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
    let read = |name: &str| fs::read_to_string(folder.path(name)).expect("written");
    assert_eq!(read("out/common.h"), "#define lowp\n");
}
