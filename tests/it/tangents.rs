//! Tangents of meshes by MikkTSpace: values in closed form, mirrored seams, texture coordinates that say nothing.

use crate::models::rows;
use crate::scenes::told;
use crate::support::compiler;
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use glisten::scene::{MemoryFiles, load};
use glisten_verify::scene::Draw;
use std::collections::BTreeMap;

/// A program that reads tangents, and one that does not.
const VERTEX: &str = "#version 150\nin vec3 position;\nin vec3 normal;\nin vec2 texcoord;\nin vec4 tangent;\nout vec3 v;\n\
    void main() { v = cross(normal, tangent.xyz) * tangent.w + vec3(texcoord, 0.0); gl_Position = vec4(position, 1.0); }\n";
const PLAIN: &str = "#version 150\nin vec3 position;\nin vec3 normal;\nin vec2 texcoord;\nout vec3 v;\n\
    void main() { v = normal + vec3(texcoord, 0.0); gl_Position = vec4(position, 1.0); }\n";
const FRAGMENT: &str = "#version 150\nin vec3 v;\nout vec4 c;\nvoid main() { c = vec4(v, 1.0); }\n";

fn drawn(file: &str, bytes: &[u8], vertex: &str) -> Draw {
    let scene = format!("[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nmesh = {{ file = \"{file}\" }}\n");
    let texts = [("a.toml", scene.as_bytes()), ("a.vert", vertex.as_bytes()), ("a.frag", FRAGMENT.as_bytes())];
    let all = texts.into_iter().chain([(file, bytes)]);
    let files = MemoryFiles(all.map(|(name, bytes)| (name.to_owned(), bytes.to_vec())).collect::<BTreeMap<_, _>>());
    let loaded = load("a.toml", &files, &compiler());
    assert!(loaded.diagnostics.is_empty(), "{:?}", told(&loaded));
    loaded.scene.expect("it loads").draws.remove(0)
}

/// Position, texture coordinate and tangent of each vertex.
fn vertices(draw: &Draw) -> Vec<[Vec<f32>; 3]> {
    let parts = rows(draw, "position").into_iter().zip(rows(draw, "texcoord")).zip(rows(draw, "tangent"));
    parts.map(|((position, texcoord), tangent)| [position, texcoord, tangent]).collect()
}

/// The tangents of the vertices at a place.
fn at(draw: &Draw, place: [f32; 3]) -> Vec<Vec<f32>> {
    vertices(draw).into_iter().filter(|[position, ..]| position[..] == place).map(|[_, _, tangent]| tangent).collect()
}

#[track_caller]
fn near(found: &[f32], wanted: [f64; 4]) {
    let error = found.iter().zip(wanted).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max);
    assert!(found.len() == 4 && error < 2e-6, "{found:?} {wanted:?}");
}

#[track_caller]
fn sound(draw: &Draw) {
    let dot = |a: &[f32], b: &[f32]| a.iter().zip(b).take(3).map(|(a, b)| a * b).sum::<f32>();
    for (normal, tangent) in rows(draw, "normal").iter().zip(rows(draw, "tangent")) {
        let square = dot(&tangent, &tangent);
        assert!((square - 1.0).abs() < 1e-6 && dot(normal, &tangent).abs() < 1e-6, "{normal:?} {tangent:?}");
        assert!(tangent[3].abs() == 1.0, "{tangent:?}");
    }
}

/// glTF 2.0 of one primitive, whose node has a scale of these factors. Rows: position, normal, texture coordinate with t upwards, and
/// a tangent if the file has them.
fn gltf(scale: &str, rows: &[[f32; 12]], has_tangents: bool, indices: &[u16]) -> String {
    let n = rows.len();
    let mut floats: Vec<f32> = rows.iter().flat_map(|row| row[..3].to_vec()).collect();
    floats.extend(rows.iter().flat_map(|row| row[3..6].to_vec()));
    floats.extend(rows.iter().flat_map(|row| [row[6], 1.0 - row[7]]));
    floats.extend(rows.iter().flat_map(|row| row[8..].to_vec()));
    let mut bytes: Vec<u8> = floats.iter().flat_map(|value| value.to_le_bytes()).collect();
    bytes.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
    let part = |index: usize, offset: usize, count: usize, component: u32, ty: &str| {
        let _ = index;
        format!(
            r#"{{"bufferView": 0, "byteOffset": {offset}, "componentType": {component}, "count": {count}, "type": "{ty}"}}"#
        )
    };
    let accessors = [
        part(0, 0, n, 5126, "VEC3"),
        part(1, 12 * n, n, 5126, "VEC3"),
        part(2, 24 * n, n, 5126, "VEC2"),
        part(3, 32 * n, n, 5126, "VEC4"),
        part(4, 48 * n, indices.len(), 5123, "SCALAR"),
    ];
    let tangent = if has_tangents { r#", "TANGENT": 3"# } else { "" };
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "scenes": [{{"nodes": [0]}}], "nodes": [{{"mesh": 0, "scale": {scale}}}],
"meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2{tangent}}}, "indices": 4}}]}}],
"accessors": [{}], "bufferViews": [{{"buffer": 0, "byteLength": {}}}],
"buffers": [{{"byteLength": {}, "uri": "data:application/octet-stream;base64,{}"}}]}}"#,
        accessors.join(", "),
        bytes.len(),
        bytes.len(),
        STANDARD.encode(&bytes)
    )
}

/// A square whose texture coordinates are sheared: the tangent is the derivative of the position by s.
#[test]
fn the_tangent_of_a_plane_is_the_derivative_by_s() {
    // Position = s S + t T for these, which are not perpendicular; the normal is +y.
    let (s, t) = ([1.5, 0.0, 2.0], [0.25, 0.0, -1.0]);
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let mut text = String::from("vn 0 1 0\n");
    for [u, v] in corners {
        let p: Vec<f64> = (0..3).map(|axis| u * s[axis] + v * t[axis]).collect();
        text += &format!("v {} {} {}\nvt {u} {v}\n", p[0], p[1], p[2]);
    }
    let draw = drawn("a.obj", (text.clone() + "f 1/1/1 2/2/1 3/3/1 4/4/1\n").as_bytes(), VERTEX);
    let tangents = rows(&draw, "tangent");
    assert_eq!(tangents.len(), 4);
    // cross(+y, S) . T is positive: the texture is not mirrored.
    tangents.iter().for_each(|tangent| near(tangent, [0.6, 0.0, 0.8, 1.0]));
    // The same square with t the other way: mirrored.
    let mirrored = text.replace("vt 0 1", "vt 0 -1").replace("vt 1 1", "vt 1 -1");
    let draw = drawn("a.obj", (mirrored + "f 1/1/1 2/2/1 3/3/1 4/4/1\n").as_bytes(), VERTEX);
    rows(&draw, "tangent").iter().for_each(|tangent| near(tangent, [0.6, 0.0, 0.8, -1.0]));
}

/// Triangles around a vertex count by their angles there (Mikkelsen 2008, §3.3), not by their areas.
#[test]
fn triangles_count_by_their_angles() {
    // At (1, 0, 0): 45 degrees of the first, 90 of the second. At (0, 1, 0): 45 of both.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvt 1 2\nvn 0 0 1\n\
        f 1/1/1 2/2/1 3/3/1\nf 2/2/1 4/4/1 3/3/1\n";
    let draw = drawn("a.obj", text.as_bytes(), VERTEX);
    // The second: (1, 1, 0) is t by 2, and (-1, 1, 0) is s by -1 and t by 1; so s by 1 is (1, 1) / 2 - (-1, 1) = (1.5, -0.5).
    let (first, second) = ([1.0, 0.0], [1.5 / 2.5_f64.sqrt(), -0.5 / 2.5_f64.sqrt()]);
    let mean = |a: f64, b: f64| {
        let sum = [0, 1].map(|axis| a * first[axis] + b * second[axis]);
        let length = sum[0].hypot(sum[1]);
        [sum[0] / length, sum[1] / length, 0.0, 1.0]
    };
    for (place, [a, b]) in [
        ([0.0, 0.0, 0.0], [1.0, 0.0]),
        ([1.0, 0.0, 0.0], [1.0, 2.0]),
        ([0.0, 1.0, 0.0], [1.0, 1.0]),
        ([2.0, 1.0, 0.0], [0.0, 1.0]),
    ] {
        let found = at(&draw, place);
        assert_eq!(found.len(), 1, "{place:?}");
        near(&found[0], mean(a, b));
    }
}

/// Two squares side by side whose texture is mirrored at x = 0, where they share position, normal and texture coordinate.
#[test]
fn a_mirrored_seam_is_split() {
    let seam = |draw: &Draw, sign: f64| {
        sound(draw);
        assert_eq!((rows(draw, "position").len(), draw.vertex_count), (8, 12));
        for place in [[0.0, -1.0, 0.0], [0.0, 1.0, 0.0]] {
            let mut found = at(draw, place);
            found.sort_by(|a, b| b[3].total_cmp(&a[3]));
            assert_eq!(found.len(), 2, "{found:?}");
            near(&found[0], [sign, 0.0, 0.0, 1.0]);
            near(&found[1], [-sign, 0.0, 0.0, -1.0]);
        }
        for [position, _, tangent] in vertices(draw) {
            let side = f64::from(position[0]) * sign;
            if side != 0.0 {
                near(&tangent, [-f64::from(position[0]), 0.0, 0.0, -side.signum()]);
            }
        }
    };
    let places = [[-1.0, -1.0], [0.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [0.0, 1.0], [1.0, 1.0]];
    let coordinates = [[0.0, 0.0], [1.0, 0.0], [0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [0.0, 1.0]];
    let mut text = String::from("vn 0 0 1\n");
    for ([x, y], [s, t]) in places.iter().zip(coordinates) {
        text += &format!("v {x} {y} 0\nvt {s} {t}\n");
    }
    text += "f 1/1/1 2/2/1 5/5/1 4/4/1\nf 2/2/1 3/3/1 6/6/1 5/5/1\n";
    seam(&drawn("a.obj", text.as_bytes(), VERTEX), 1.0);
    // Nothing is split for a program that reads no tangents.
    assert_eq!(rows(&drawn("a.obj", text.as_bytes(), PLAIN), "position").len(), 6);
    let row = |k: usize| {
        let ([x, y], [s, t]) = (places[k], coordinates[k]);
        [x, y, 0.0, 0.0, 0.0, 1.0, s, t, 0.0, 1.0, 0.0, 1.0]
    };
    let gltf_rows: Vec<[f32; 12]> = (0..6).map(row).collect();
    let indices = [0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4];
    let file = |scale: &str, own: bool| gltf(scale, &gltf_rows, own, &indices);
    seam(&drawn("a.gltf", file("[1, 1, 1]", false).as_bytes(), VERTEX), 1.0);
    // A node that mirrors: the same texture seen in a mirror.
    seam(&drawn("a.gltf", file("[-1, 1, 1]", false).as_bytes(), VERTEX), 1.0);
    // The tangents of a file stay, and turn their handedness in a mirror.
    let own = drawn("a.gltf", file("[1, 1, 1]", true).as_bytes(), VERTEX);
    assert!(rows(&own, "tangent").iter().all(|tangent| tangent[..] == [0.0, 1.0, 0.0, 1.0]));
    let mirrored = drawn("a.gltf", file("[-1, 1, 1]", true).as_bytes(), VERTEX);
    assert!(rows(&mirrored, "tangent").iter().all(|tangent| tangent[..] == [0.0, 1.0, 0.0, -1.0]));
}

#[test]
fn texture_coordinates_that_say_nothing_give_finite_tangents() {
    // All at one point; on a line; no triangle with an area next to it.
    for coordinates in ["vt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\n", "vt 0 0\nvt 0.5 0.5\nvt 1 1\n"] {
        let text = format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0.6 0 0.8\n{coordinates}f 1/1/1 2/2/1 3/3/1\n");
        let draw = drawn("a.obj", text.as_bytes(), VERTEX);
        sound(&draw);
    }
    // Without texture coordinates at all.
    sound(&drawn("a.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", VERTEX));
    // A triangle without an area in the texture takes what its neighbors have.
    let text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvt 0 1\nvt 1 0\nvn 0 0 1\n\
        f 1/1/1 2/2/1 3/3/1\nf 2/2/1 4/2/1 3/3/1\n";
    let draw = drawn("a.obj", text.as_bytes(), VERTEX);
    sound(&draw);
    for place in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
        at(&draw, place).iter().for_each(|tangent| near(tangent, [0.0, 1.0, 0.0, -1.0]));
    }
    // Positions whose squares are not finite in f32, and ones whose squares are 0.
    for size in ["1e30", "1e-30"] {
        let text =
            format!("v 0 0 0\nv {size} 0 0\nv 0 {size} 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n");
        let draw = drawn("a.obj", text.as_bytes(), VERTEX);
        sound(&draw);
        rows(&draw, "tangent").iter().for_each(|tangent| near(tangent, [1.0, 0.0, 0.0, 1.0]));
    }
}

/// A fan with more triangles than are compared with each other: each has its own direction.
#[test]
fn large_fans_are_bounded() {
    for sides in [400_usize, 3000] {
        let mut text = String::from("v 0 0 0\nvt 0.5 0.5\nvn 0 0 1\n");
        for k in 0..sides {
            let (y, x) = (k as f64 / sides as f64 * std::f64::consts::TAU).sin_cos();
            text += &format!("v {x} {y} 0\nvt {} {}\n", 0.5 + x / 2.0, 0.5 + y / 2.0);
        }
        for k in 0..sides {
            let (a, b) = (k + 2, (k + 1) % sides + 2);
            text += &format!("f 1/1/1 {a}/{a}/1 {b}/{b}/1\n");
        }
        let draw = drawn("a.obj", text.as_bytes(), VERTEX);
        sound(&draw);
        let worst = rows(&draw, "tangent").iter().map(|tangent| (tangent[0] - 1.0).abs()).fold(0.0, f32::max);
        // f32 loses digits in thin triangles.
        assert!(worst < 1e-4 && rows(&draw, "tangent").iter().all(|tangent| tangent[3] == 1.0), "{sides}: {worst}");
    }
}
