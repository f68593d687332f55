//! Linking and reflection: locations, layouts, names, the JSON schema.

use crate::support::{compiler, conforms, root, shaders_under};
use glisten_emit::reflection::{Found, find, table};
use glisten_emit::{Conventions, GlslVersion, Reflection, WindowOrigin, reflect};
use glisten_front::hir::Stage;
use glisten_front::{Compilation, Compiler, Options, Source};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

fn source(stage: Stage, text: &str) -> Source {
    let versioned = format!("#version 150\n{text}");
    Source { name: format!("test.{}", stage.name()), text: versioned.into(), stage }
}

fn compile_with(options: Options, vertex: &str, fragment: &str) -> Compilation {
    Compiler::new(options).compile(&[source(Stage::Vertex, vertex), source(Stage::Fragment, fragment)])
}

fn reflection(vertex: &str, fragment: &str) -> Reflection {
    let compilation = compile_with(Options::default(), vertex, fragment);
    let messages: Vec<_> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("no program: {messages:?}"));
    reflect(&program, &Conventions::default())
}

const POSITION: &str = "void main() { gl_Position = vec4(0.0); }";

/// Two programs for the reflection tests.
fn programs() -> BTreeMap<String, Vec<Source>> {
    let mut programs: BTreeMap<String, Vec<Source>> = BTreeMap::new();
    for folder in ["fixtures/programs", "fixtures/lower"] {
        for shader in shaders_under(folder) {
            let stem = Path::new(&shader.name).with_extension("").to_string_lossy().into_owned();
            let source = Source { name: shader.name, text: shader.text.into(), stage: shader.stage };
            programs.entry(stem).or_default().push(source);
        }
    }
    programs
}

#[test]
fn reflections_conform_to_the_schema_and_read_back() {
    let schema = std::fs::read_to_string(root().join("docs/reflection.schema.json")).expect("the schema is there");
    let schema: Value = serde_json::from_str(&schema).expect("the schema is JSON");
    let mut checked = 0;
    for (stem, sources) in programs() {
        let Some(program) = compiler().compile(&sources).program else { continue };
        let origins = [WindowOrigin::UpperLeft, WindowOrigin::LowerLeft].into_iter();
        let origins = origins.map(|window_origin| Conventions { window_origin, ..Conventions::default() });
        let versions = GlslVersion::ALL.into_iter();
        let versions = versions.map(|glsl_version| Conventions { glsl_version, ..Conventions::default() });
        for conventions in origins.chain(versions) {
            let reflection = reflect(&program, &conventions);
            let json = serde_json::to_value(&reflection).expect("a reflection is JSON");
            assert_eq!(conforms(&json, &schema, &stem), Vec::<String>::new());
            assert_eq!(serde_json::from_value::<Reflection>(json).expect("it reads back"), reflection);
            assert!(table(&reflection).contains("conventions"), "{stem}");
        }
        checked += 1;
    }
    assert!(checked >= 7, "only {checked} programs were reflected");
    let broken = serde_json::json!({ "attributes": [{ "name": 1 }], "extra": null });
    assert!(conforms(&broken, &schema, "broken").len() > 3, "the check itself finds nothing");
}

#[test]
fn the_seeds_triangle_has_its_attributes_where_they_were_bound() {
    let text = |name: &str| std::fs::read_to_string(root().join("fixtures/programs").join(name)).expect("a fixture");
    let sources = [("triangle.vert", Stage::Vertex), ("triangle.frag", Stage::Fragment)].map(|(name, stage)| Source {
        name: name.into(),
        text: text(name).into(),
        stage,
    });
    for (pv, cv) in [(0, 1), (1, 0), (7, 0)] {
        let options = Options { attribute_locations: vec![("pv".into(), pv)], ..Options::default() };
        let program = Compiler::new(options).compile(&sources).program.expect("the triangle links");
        let reflection = reflect(&program, &Conventions::default());
        let places: Vec<_> = reflection.attributes.iter().map(|row| (row.name.as_str(), row.location)).collect();
        assert_eq!(places, [("pv", pv), ("cv", cv)]);
        // The seed document calls glGetUniformLocation for it.
        let Found::Known(found) = find(&program, &reflection, "cv") else { panic!("`cv` is there") };
        assert!(found[0].description.contains("is an attribute"), "{found:?}");
        assert_eq!(found[0].row["location"], cv, "{found:?}");
        let Found::Unknown { nearest } = find(&program, &reflection, "mcc") else { panic!("`mcc` is not there") };
        assert_eq!(nearest.as_deref(), Some("mc"));
    }
}

#[test]
fn elements_of_arrays_have_their_offsets() {
    let fragment = "uniform float first; uniform vec4 w[4]; out vec4 c; void main() { c = w[2] * first; }";
    let options = Options::default();
    let program = compile_with(options, POSITION, fragment).program.expect("it links");
    let reflection = reflect(&program, &Conventions::default());
    let told = |name: &str| match find(&program, &reflection, name) {
        Found::Known(found) => found.into_iter().map(|one| one.description).collect::<Vec<_>>().join("\n"),
        Found::Unknown { .. } => "unknown".to_owned(),
    };
    let near = |name: &str| match find(&program, &reflection, name) {
        Found::Known(found) => panic!("{found:?}"),
        Found::Unknown { nearest } => nearest,
    };
    // Past the end, and with a block before it that has no instance.
    assert_eq!((near("w[4]").as_deref(), near("Block.first").as_deref()), (Some("w"), Some("first")));
    assert_eq!(told("w[2]"), "`w[2]` is an element of the uniform `w`: vec4 at group 0, binding 0, offset 48");
    assert_eq!(told("w[0]"), "`w` is a uniform: vec4[4] at group 0, binding 0, offset 16");
    assert_eq!([told("w[4]"), told("w[-1]"), told("first[0][1]")], ["unknown"; 3]);
}

#[test]
fn text_wins_over_a_binding_by_name_with_a_warning() {
    let vertex = "#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 3) in vec4 a;\n\
                  void main() { gl_Position = a; }";
    let options = Options { attribute_locations: vec![("a".into(), 5)], ..Options::default() };
    let compilation = compile_with(options, vertex, "out vec4 c; void main() { c = vec4(1.0); }");
    let codes: Vec<_> = compilation.diagnostics.iter().map(|found| found.code.id).collect();
    assert_eq!(codes, ["W0701"]);
    let program = compilation.program.expect("a warning is no error");
    assert_eq!(program.interface.attributes[0].location, 3);
}

#[test]
fn a_matrix_takes_a_location_a_column_and_later_ones_fill_the_gaps() {
    let vertex = "#extension GL_ARB_explicit_attrib_location : enable\nlayout(location = 2) in mat3 m; in vec4 a; in mat2 n; \
                  in float f; in vec4 idle; void main() { gl_Position = a + vec4(n * m[0].xy, f, m[1].x); }";
    let rows = reflection(vertex, "out vec4 c; void main() { c = vec4(1.0); }").attributes;
    let places: Vec<_> = rows.iter().map(|row| (row.name.as_str(), row.location, row.columns, row.active)).collect();
    let expected = [("m", 2, 3, true), ("a", 0, 1, true), ("n", 5, 2, true), ("f", 1, 1, true), ("idle", 7, 1, false)];
    assert_eq!(places, expected);
}

#[test]
fn loose_uniforms_stand_by_std140_in_one_block() {
    let fragment = "struct L { vec3 d; float k; }; uniform bool b; uniform vec3 v; uniform float f = 0.1; uniform mat2 m; \
                    uniform float a[2]; uniform L l[2]; out vec4 c; \
                    void main() { c = vec4(v, f) + vec4(m[0], a[1], l[1].k) * float(b); }";
    let reflection = reflection(POSITION, fragment);
    let rows: Vec<_> = reflection.uniforms.iter().map(|row| (row.name.as_str(), row.offset)).collect();
    let expected = [
        ("b", 0),
        ("v", 16),
        ("f", 28),
        ("m", 32),
        ("a", 64),
        ("l[0].d", 96),
        ("l[0].k", 108),
        ("l[1].d", 112),
        ("l[1].k", 124),
    ];
    assert_eq!(rows, expected);
    assert_eq!(reflection.loose_block.map(|block| (block.binding, block.size)), Some((0, 128)));
    assert_eq!(reflection.uniforms[2].default, Some(vec![serde_json::json!(0.1)]));
    assert_eq!(reflection.uniforms[4].array_stride, Some(16));
    assert_eq!(reflection.uniforms[3].matrix_stride, Some(16));
}

#[test]
fn blocks_follow_the_loose_uniforms_and_arrays_take_a_binding_an_element() {
    let fragment = "uniform float u; layout(std140) uniform A { vec4 x; } a[2]; \
                    layout(std140, row_major) uniform B { mat2x3 m; vec4 y; }; out vec4 c; \
                    void main() { c = a[1].x + y + vec4(u) + vec4(m[0], 0.0); }";
    let reflection = reflection(POSITION, fragment);
    let blocks: Vec<_> = reflection.blocks.iter().map(|row| (row.name.as_str(), row.binding, row.size)).collect();
    assert_eq!(blocks, [("A", 1, 16), ("B", 3, 64)]);
    let rows: Vec<_> = reflection.uniforms.iter().map(|row| (row.name.as_str(), row.binding, row.offset)).collect();
    // Three rows of two components, sixteen bytes apart, before `y`.
    assert_eq!(rows, [("u", 0, 0), ("A[0].x", 1, 0), ("A[1].x", 2, 0), ("m", 3, 0), ("y", 3, 48)]);
    assert!(reflection.uniforms[3].row_major);
}

#[test]
fn samplers_have_dense_bindings_and_those_in_use_come_first() {
    let fragment = "struct M { sampler2D albedo; float k; }; uniform sampler2D idle; uniform isampler2D ids; \
                    uniform sampler2D t[2]; uniform M material; in vec2 p; out vec4 c; void main() { \
                    c = texture(t[1], p) + vec4(texelFetch(ids, ivec2(0), 0)) + texture(material.albedo, p) * material.k; }";
    let reflection = reflection("out vec2 p; void main() { p = vec2(0.0); gl_Position = vec4(0.0); }", fragment);
    let rows: Vec<_> = reflection
        .samplers
        .iter()
        .map(|row| (row.name.as_str(), row.texture.binding, row.sampler.binding, row.active))
        .collect();
    let expected = [
        ("ids", 0, 0, true),
        ("t[0]", 1, 2, true),
        ("t[1]", 3, 4, true),
        ("material.albedo", 5, 6, true),
        ("idle", 7, 8, false),
    ];
    assert_eq!(rows, expected);
    assert_eq!(reflection.uniforms.iter().map(|row| row.name.as_str()).collect::<Vec<_>>(), ["material.k"]);
}

#[test]
fn varyings_are_cut_up_and_share_locations_only_when_they_must() {
    let interface = "mat3 tangent; STORAGE vec4 extra[2]; STORAGE V { flat int id; vec2 uv; } v;";
    let declare = |storage: &str| format!("{storage} {}", interface.replace("STORAGE", storage));
    let vertex = format!(
        "{} void main() {{ tangent = mat3(1.0); extra[0] = extra[1] = vec4(0.0); v.id = 1; v.uv = vec2(0.0); gl_Position = vec4(0.0); }}",
        declare("out")
            .replace(" v;", " o;")
            .replace("out V { flat int id; vec2 uv; } o;", "out V { flat int id; vec2 uv; } v;")
    );
    let fragment =
        format!("{} out vec4 c; void main() {{ c = vec4(tangent[0], v.id) + extra[1] + v.uv.xyxy; }}", declare("in"));
    let rows = reflection(&vertex, &fragment).varyings;
    let places: Vec<_> = rows.iter().map(|row| (row.name.as_str(), row.location, row.interpolation.as_str())).collect();
    let expected = [
        ("tangent[0]", 0, "smooth"),
        ("tangent[1]", 1, "smooth"),
        ("tangent[2]", 2, "smooth"),
        ("extra[0]", 3, "smooth"),
        ("extra[1]", 4, "smooth"),
        ("V.id", 5, "flat"),
        ("V.uv", 6, "smooth"),
    ];
    assert_eq!(places, expected);
    let many = |storage: &str| format!("{storage} float f[30]; flat {storage} vec2 g;");
    let vertex = format!("{} void main() {{ f[0] = 1.0; g = vec2(0.0); gl_Position = vec4(0.0); }}", many("out"));
    let fragment = format!("{} out vec4 c; void main() {{ c = vec4(f[0], g, 1.0); }}", many("in"));
    let rows = reflection(&vertex, &fragment).varyings;
    let locations = rows.iter().map(|row| row.location).max();
    assert_eq!(locations, Some(8), "thirty floats take eight locations, the flat vector one of its own");
    let mut places: Vec<_> = rows.iter().map(|row| (row.location, row.component)).collect();
    places.dedup();
    assert_eq!(places.len(), 31, "no two share a component");
}

#[test]
fn the_height_of_the_framebuffer_has_a_place_when_it_is_needed() {
    let with = |layout: &str| {
        let fragment =
            format!("{layout} uniform vec3 u; out vec4 c; void main() {{ c = gl_FragCoord + vec4(u, 0.0); }}");
        reflection(POSITION, &fragment).conventions.framebuffer_height
    };
    assert_eq!(with("").map(|slot| slot.offset), Some(12));
    assert_eq!(with("layout(origin_upper_left) in vec4 gl_FragCoord;"), None);
}

#[test]
fn a_stage_may_consist_of_several_shaders() {
    let sources = [
        source(Stage::Vertex, POSITION),
        source(
            Stage::Fragment,
            "struct S { float k; }; uniform S s; float shade(S s); out vec4 c; void main() { c = vec4(shade(s)); }",
        ),
        source(
            Stage::Fragment,
            "struct S { float k; }; uniform S s; const float two = 2.0; float shade(S t) { return t.k * s.k * two; }",
        ),
    ];
    let compilation = compiler().compile(&sources);
    let messages: Vec<_> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
    let program = compilation.program.unwrap_or_else(|| panic!("{messages:?}"));
    let text = glisten_front::hir::print(&program.types, &program.stages[1]);
    assert_eq!(text.matches("struct S").count(), 1, "{text}");
    assert_eq!(text.matches("uniform S s;").count(), 1, "{text}");
    let again =
        compiler().compile(&[Source { name: "again.frag".into(), text: text.clone().into(), stage: Stage::Fragment }]);
    assert!(!again.diagnostics.has_errors(), "{text}");
}

#[test]
fn a_lone_shader_that_others_must_complete_is_no_error_and_no_program() {
    let compilation = compiler().compile(&[source(Stage::Fragment, "float f() { return 1.0; }")]);
    assert!(!compilation.diagnostics.has_errors());
    assert_eq!(compilation.diagnostics.len(), 1);
    assert!(compilation.program.is_none());
}

#[test]
fn blocks_at_two_locations_are_told_by_them() {
    let text = |place: u32, word: &str, rest: &str| {
        format!("#version 460\nlayout(location = {place}) {word} VS_OUT {{ vec3 world; }} b;\n{rest}")
    };
    let source = |stage: Stage, text: String| Source { name: format!("a.{}", stage.name()), text: text.into(), stage };
    let vertex = text(0, "out", "void main() { b.world = vec3(0.0); gl_Position = vec4(0.0); }\n");
    let fragment = text(1, "in", "out vec4 c; void main() { c = vec4(b.world, 1.0); }\n");
    let sources = [source(Stage::Vertex, vertex), source(Stage::Fragment, fragment)];
    let done = Compiler::new(Options::default()).compile(&sources);
    let found = done.diagnostics.iter().find(|found| found.code.id == "E0702").expect("they do not match");
    let labels: Vec<&str> = found.secondary.iter().map(|label| &*label.message).collect();
    assert_eq!(labels, ["the vertex stage has `VS_OUT` at location 0, not 1"]);
    assert_eq!(found.help.as_deref(), Some("write `layout(location = 0)` here, or leave both out"));
}
