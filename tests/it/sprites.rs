//! Points as quads in WGSL (`--point-sprites`): drawn through wgpu and judged against the reference, which draws points.

use crate::cli::{Folder, code, err, out};
use crate::drawing::{complaint, from_texts, gpu, strict};
use crate::emit::Collected;
use glisten::scene::Scene;
use glisten_emit::{Conventions, Target, WindowOrigin, emit};
use glisten_front::hir::Stage;
use serde_json::Value;

const VERTEX: &str = "#version 150\nin vec4 position; in float size; uniform float k; layout(std140) uniform B { vec4 tint; };\n\
    flat out int number; out vec4 shade;\n\
    void main() { number = gl_VertexID; shade = tint * float(gl_VertexID + 1) + float(gl_InstanceID);\n\
        gl_PointSize = size * k; gl_Position = position; }\n";
const FRAGMENT: &str = "#version 150\nflat in int number; in vec4 shade; out vec4 c;\n\
    void main() { c = vec4(gl_PointCoord, float(number) / 8.0 + shade.x, gl_FrontFacing ? 1.0 : 0.0); }\n";

/// A position (x, y, z, w) and a size.
type Point = ([f32; 4], f32);

/// A scene of points.
fn scene(points: &[Point], rest: &str) -> Scene {
    scene_with(points, rest, FRAGMENT)
}

fn scene_with(points: &[Point], rest: &str, fragment: &str) -> Scene {
    let positions: Vec<String> = points.iter().flat_map(|(at, _)| at.map(|value| format!("{value:?}"))).collect();
    let sizes: Vec<String> = points.iter().map(|(_, size)| format!("{size:?}")).collect();
    let text = format!(
        "[framebuffer]\nwidth = 48\nheight = 32\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \"points\"\n\
         program_point_size = true\n{rest}\n[draw.attributes]\n\
         position = {{ size = 4, values = [{}] }}\nsize = {{ size = 1, values = [{}] }}\n\
         [draw.uniforms]\nk = 1.0\n\"tint\" = [0.25, 0, 0, 0]\n",
        positions.join(", "),
        sizes.join(", ")
    );
    // With indices, the number of an instance is not that of a vertex.
    let vertex = if rest.contains("indices") { VERTEX.replace("gl_VertexID", "int(size)") } else { VERTEX.to_owned() };
    from_texts([("a.toml", text.as_str()), ("a.vert", &vertex), ("a.frag", fragment)])
}

#[test]
fn quads_draw_what_points_draw() {
    let gpu = gpu();
    let at = |x: f32, y: f32| [x, y, 0.25, 1.0];
    let rows: [(&str, Vec<Point>, &str); 7] = [
        ("sizes", vec![(at(-0.5, -0.5), 4.0), (at(0.3, 0.52), 9.0), (at(0.1, -0.2), 16.5), (at(0.8, 0.8), 0.25)], ""),
        ("largest", vec![(at(0.0, 0.0), 400.0)], ""),
        // Of a point whose center is outside, a GPU draws the part inside.
        (
            "border",
            vec![(at(0.97, 0.0), 12.0), (at(1.02, 0.4), 12.0), (at(0.0, -1.01), 9.0), (at(-0.98, 0.9), 7.0)],
            "",
        ),
        (
            "perspective",
            vec![([0.6, -0.4, 1.0, 2.0], 7.0), ([-3.0, 1.5, 1.0, 4.0], 10.0), ([0.1, 0.1, 0.0, -1.0], 9.0)],
            "",
        ),
        (
            "depth",
            vec![([0.0, 0.0, 2.0, 1.0], 9.0), (at(0.0, 0.0), 11.0), ([0.1, 0.1, -0.5, 1.0], 7.0)],
            "depth_test = true",
        ),
        ("indices", vec![(at(-0.5, 0.0), 5.0), (at(0.0, 0.0), 7.0), (at(0.5, 0.0), 9.0)], "indices = [2, 0, 2]"),
        // Points have no faces to cull.
        ("faces", vec![(at(0.0, 0.25), 8.0)], "cull = \"back\"\nfront_face = \"cw\""),
    ];
    let wrong: Vec<String> = rows
        .iter()
        .filter_map(|(name, points, rest)| complaint(&format!("sprites_{name}"), &gpu, &scene(points, rest), &strict()))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn a_point_has_the_number_of_its_primitive() {
    let gpu = gpu();
    let points = [([-0.5, 0.0, 0.0, 1.0], 5.0), ([0.0, 0.0, 0.0, 1.0], 7.0), ([0.5, 0.0, 0.0, 1.0], 9.0)];
    let fragment =
        "#version 150\nout vec4 c;\nvoid main() { c = vec4(float(gl_PrimitiveID) * 0.25, gl_PointCoord, 1.0); }\n";
    let wrong: Vec<String> = ["", "indices = [2, 0, 2, 1]"]
        .iter()
        .filter_map(|rest| complaint("sprites_number", &gpu, &scene_with(&points, rest, fragment), &strict()))
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn the_flag_is_named_where_it_helps_and_the_reflection_says_what_to_do() {
    let folder = Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", FRAGMENT.as_bytes())]);
    let compile = ["compile", "a.vert", "a.frag", "-o", "out", "--target", "wgsl", "--program-point-size"];
    let output = folder.run(&compile);
    assert_eq!(code(&output), 1);
    assert!(err(&output).contains("E0802") && err(&output).contains("--point-sprites"), "{}", err(&output));
    let output = folder.run(&[&compile[..], &["--point-sprites"]].concat());
    assert_eq!(code(&output), 0, "{}", err(&output));
    let json = std::fs::read_to_string(folder.path("out/a.json")).expect("it was written");
    let reflection: Value = serde_json::from_str(&json).expect("JSON");
    let sprites = &reflection["conventions"]["point_sprites"];
    // After the loose uniforms and the block.
    assert_eq!((&sprites["group"], &sprites["binding"], &sprites["vertices"]), (&0.into(), &2.into(), &4.into()));
    let text = std::fs::read_to_string(folder.path("out/a.vert.wgsl")).expect("it was written");
    assert!(text.contains("@group(0) @binding(2) var<uniform> point_sprites: PointSprites;"), "{text}");
    let output = folder.run(&["reflect", "a.vert", "a.frag", "--format", "json"]);
    let reflection: Value = serde_json::from_str(&out(&output)).expect("JSON");
    assert!(reflection["conventions"]["point_sprites"].is_null());
}

#[test]
fn quads_are_valid_in_every_convention() {
    let program = scene(&[([0.0; 4], 1.0)], "").draws[0].program.clone();
    let mut collected = Collected::new();
    for window_origin in [WindowOrigin::UpperLeft, WindowOrigin::LowerLeft] {
        for program_point_size in [false, true] {
            let conventions =
                Conventions { window_origin, program_point_size, point_sprites: true, ..Conventions::default() };
            for stage in [Stage::Vertex, Stage::Fragment] {
                let emitted = emit(&program, stage, Target::Wgsl, &conventions).expect("WGSL has quads");
                collected.add(&format!("sprites, {window_origin:?}"), emitted);
                emit(&program, stage, Target::Hlsl, &conventions).expect("HLSL has quads");
            }
        }
    }
    collected.validate();
}
