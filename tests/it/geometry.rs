//! Geometry shaders: the reference against a GPU that draws what the host emits, and against draws without the stage.

use crate::cli::{Folder, code, err};
use crate::drawing::{complaint, from_disk, from_texts, gpu, reference, strict};
use crate::support::{compiler, root};
use glisten::scene::{MemoryFiles, Scene, load};
use glisten_reference::Precision;
use glisten_scene::picture::Picture;

#[test]
fn the_scenes_with_geometry_shaders_agree_with_the_reference() {
    let gpu = gpu();
    let folder = root().join("fixtures/scenes/geometry");
    let entries = std::fs::read_dir(folder).expect("the folder of scenes");
    let mut files: Vec<_> = entries.map(|entry| entry.expect("an entry").path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    files.sort();
    assert!(files.len() >= 4);
    let complaints = files.into_iter().filter_map(|path| {
        let name = format!("geometry_{}", path.file_stem().unwrap_or_default().to_string_lossy());
        complaint(&name, &gpu, &from_disk(&path), &strict())
    });
    let wrong: Vec<String> = complaints.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const VERTEX: &str = "#version 150
in vec2 at;
flat out float shade;
smooth out vec2 place;
void main() { shade = float(gl_VertexID) / 16.0; place = at; gl_Position = vec4(at, 0.0, 1.0); }
";

const FRAGMENT: &str = "#version 150
flat in float shade;
smooth in vec2 place;
out vec4 fc;
void main() { fc = vec4(shade, place * 0.5 + 0.5, float(gl_PrimitiveID) / 16.0); }
";

/// A geometry shader that passes primitives on; `places` are the vertices that are not adjacent ones.
fn passing(input: &str, output: &str, places: &[u32]) -> String {
    let copies: Vec<String> = places
        .iter()
        .map(|place| {
            format!(
                "  shade = v[{place}].shade; place = v[{place}].place; gl_Position = gl_in[{place}].gl_Position;\n  \
                 gl_PrimitiveID = gl_PrimitiveIDIn; EmitVertex();\n"
            )
        })
        .collect();
    let count = places.len();
    format!(
        "#version 150\nlayout({input}) in;\nlayout({output}, max_vertices = {count}) out;\n\
         in V {{ flat float shade; vec2 place; }} v[];\nflat out float shade;\nsmooth out vec2 place;\n\
         void main() {{\n{}}}\n",
        copies.concat()
    )
}

const BLOCK_VERTEX: &str = "#version 150
in vec2 at;
out V { flat float shade; vec2 place; } v;
void main() { v.shade = float(gl_VertexID) / 16.0; v.place = at; gl_Position = vec4(at, 0.0, 1.0); }
";

/// The input and output primitives of a shader, and the vertices that it passes on.
type Layouts = (&'static str, &'static str, &'static [u32]);

const TRIANGLE: Layouts = ("triangles", "triangle_strip", &[0, 1, 2]);
const LINE: Layouts = ("lines", "line_strip", &[0, 1]);

/// Each primitive with the shader that passes it on.
const PRIMITIVES: [(&str, Layouts); 11] = [
    ("points", ("points", "points", &[0])),
    ("lines", LINE),
    ("line_strip", LINE),
    ("line_loop", LINE),
    ("triangles", TRIANGLE),
    ("triangle_strip", TRIANGLE),
    ("triangle_fan", TRIANGLE),
    ("lines_adjacency", ("lines_adjacency", "line_strip", &[1, 2])),
    ("line_strip_adjacency", ("lines_adjacency", "line_strip", &[1, 2])),
    ("triangles_adjacency", ("triangles_adjacency", "triangle_strip", &[0, 2, 4])),
    ("triangle_strip_adjacency", ("triangles_adjacency", "triangle_strip", &[0, 2, 4])),
];

/// Twelve vertices on a star, drawn with some keys, with a geometry shader or without.
fn star(keys: &str, geometry: Option<&str>) -> Scene {
    let corners = (0..12).map(|corner| {
        let radius = if corner % 2 == 0 { 0.9 } else { 0.35 };
        let angle = f64::from(corner) * 0.523;
        format!("{:.4}, {:.4}", radius * angle.cos(), radius * angle.sin())
    });
    let values = corners.collect::<Vec<String>>().join(", ");
    let stage = geometry.map_or("", |_| "geometry = \"a.geom\"\n");
    let text = format!(
        "[framebuffer]\nwidth = 48\nheight = 48\n[[draw]]\nvertex = \"a.vert\"\n{stage}fragment = \"a.frag\"\n{keys}\n\
         [draw.attributes]\nat = {{ size = 2, values = [{values}] }}\n"
    );
    let vertex = if geometry.is_some() { BLOCK_VERTEX } else { VERTEX };
    let files = [("a.toml", text.as_str()), ("a.vert", vertex), ("a.frag", FRAGMENT)];
    match geometry {
        Some(geometry) => from_texts([files[0], files[1], ("a.geom", geometry), files[2]]),
        None => from_texts(files),
    }
}

fn colors(picture: &Picture) -> &[[f64; 4]] {
    picture.attachments.first().map_or(&[], |attachment| attachment.as_slice())
}

#[test]
fn a_shader_that_passes_primitives_on_changes_nothing() {
    for (primitive, (input, output, places)) in PRIMITIVES {
        let shader = passing(input, output, places);
        for provoking in ["first", "last"] {
            for indices in ["", "indices = [3, 4, 5, 0, 1, 2, 6, 7, 8, 11, 10, 9]"] {
                let keys = format!("primitive = \"{primitive}\"\nprovoking = \"{provoking}\"\n{indices}");
                let with = reference(&star(&keys, Some(&shader)), Precision::F32);
                let without = reference(&star(&keys, None), Precision::F32);
                assert!(without.covered.contains(&true), "{primitive}");
                assert_eq!(colors(&with), colors(&without), "{primitive}, {provoking}, {indices}");
            }
        }
    }
}

#[test]
fn what_is_emitted_ends_where_the_language_says() {
    // An incomplete primitive, a primitive, one more vertex than there may be.
    let shader = "#version 150
layout(points) in;
layout(triangle_strip, max_vertices = 5) out;
in V { flat float shade; vec2 place; } v[];
flat out float shade;
smooth out vec2 place;
void emit(vec2 at) { shade = 1.0; place = at; gl_Position = vec4(at, 0.0, 1.0); gl_PrimitiveID = 3; EmitVertex(); }
void main() {
    if (gl_PrimitiveIDIn > 0) return;
    emit(vec2(-1.0, -1.0));
    emit(vec2(1.0, -1.0));
    EndPrimitive();
    EndPrimitive();
    emit(vec2(-1.0, -1.0));
    emit(vec2(1.0, -1.0));
    emit(vec2(-1.0, 0.0));
    emit(vec2(1.0, 1.0));
}
";
    let picture = reference(&star("primitive = \"points\"", Some(shader)), Precision::F64);
    let covered = picture.covered.iter().filter(|covered| **covered).count();
    // Half of the lower half of 48 x 48.
    assert!((550..=602).contains(&covered), "{covered}");
    assert!(colors(&picture).iter().zip(&picture.covered).all(|(color, covered)| !covered || color[3] == 3.0 / 16.0));
}

#[test]
fn a_primitive_that_the_shader_does_not_take_is_an_error() {
    let text = "[[draw]]\nvertex = \"a.vert\"\ngeometry = \"a.geom\"\nfragment = \"a.frag\"\nprimitive = \"lines\"\n\
                vertex_count = 3\n[draw.attributes]\nat = { size = 2, values = [0, 0, 1, 0, 0, 1] }\n";
    let shader = passing("triangles", "triangle_strip", &[0, 1, 2]);
    let files = [("a.toml", text), ("a.vert", BLOCK_VERTEX), ("a.geom", &shader), ("a.frag", FRAGMENT)];
    let loaded = load("a.toml", &MemoryFiles::new(files), &compiler());
    let found: Vec<_> = loaded.diagnostics.iter().filter(|found| found.is_error()).collect();
    assert_eq!(found.iter().map(|found| found.code.id).collect::<Vec<_>>(), ["E0912"]);
    assert!(found[0].help.as_deref().is_some_and(|help| help.contains("\"triangle_fan\"")), "{:?}", found[0].help);
}

#[test]
fn reports_and_stability_of_scenes_with_geometry_shaders() {
    let folder = Folder::new(&[]);
    let scene = root().join("fixtures/scenes/geometry/invocations.toml").to_string_lossy().into_owned();
    let report = folder.run(&["report", &scene, "--rounds", "3", "-o", "report"]);
    assert_eq!(code(&report), 0, "{}", err(&report));
    assert!(err(&report).contains("geometry stages ran on the host"), "{}", err(&report));
    let stability = folder.run(&["stability", &scene]);
    assert_eq!(code(&stability), 0, "{}", err(&stability));
}

#[test]
fn each_primitive_is_seen_by_each_invocation() {
    let vertex = "#version 400\nin vec2 at; void main() { gl_Position = vec4(at, 0.0, 1.0); }\n";
    let fragment =
        "#version 400\nflat in int from; out vec4 fc; void main() { fc = vec4(from, gl_PrimitiveID, 0.0, 1.0); }\n";
    let geometry = "#version 400\nlayout(points, invocations = 3) in;\nlayout(points, max_vertices = 1) out;\n\
                    flat out int from;\nvoid main() { from = gl_InvocationID; gl_PrimitiveID = gl_PrimitiveIDIn;\n\
                    gl_Position = gl_in[0].gl_Position + vec4(gl_InvocationID * 0.5, 0.0, 0.0, 0.0); EmitVertex(); }\n";
    let scene = "[framebuffer]\nwidth = 4\nheight = 2\n[[draw]]\nvertex = \"a.vert\"\ngeometry = \"a.geom\"\nfragment = \
                 \"a.frag\"\nprimitive = \"points\"\nattributes = { at = { size = 2, values = [-0.75, 0.5, -0.75, -0.5] } }\n";
    let files = [("a.toml", scene), ("a.vert", vertex), ("a.geom", geometry), ("a.frag", fragment)];
    let picture = reference(&from_texts(files), Precision::F64);
    let colors: Vec<[f64; 2]> = picture.attachments[0].iter().map(|color| [color[0], color[1]]).collect();
    let row = |id: f64| [[0.0, id], [1.0, id], [2.0, id], [0.0, 0.0]];
    assert_eq!(colors, [row(0.0), row(1.0)].concat());
}
