//! Makes the model of the gallery's scene `chess`: glTF 2.0, binary.
//!
//! ```sh
//! cargo run -p glisten-studies --bin chess -- shader_lib/scenes/chess.glb
//! ```
//!
//! A board with textures of color, roughness and normals, and pieces turned on a lathe: brass, ivory under lacquer, ebony. Normals are
//! signed bytes (`KHR_mesh_quantization`), the lights those of `KHR_lights_punctual`. There are no tangents: whoever reads the file
//! computes them.

#![expect(clippy::print_stderr, reason = "a program for the terminal")]

use glisten_scene::picture::{Effort, png_rgb};
use serde_json::{Value, json};
use std::f64::consts::TAU;
use std::process::ExitCode;

/// The points of a profile: radius and height.
type Profile = &'static [[f64; 2]];

static PAWN: Profile = &[
    [0.0, 0.0],
    [0.36, 0.0],
    [0.38, 0.05],
    [0.36, 0.12],
    [0.28, 0.17],
    [0.2, 0.26],
    [0.13, 0.45],
    [0.105, 0.6],
    [0.115, 0.66],
    [0.19, 0.69],
    [0.19, 0.725],
    [0.12, 0.75],
    [0.175, 0.82],
    [0.2, 0.9],
    [0.175, 0.99],
    [0.1, 1.055],
    [0.0, 1.08],
];
static KING: Profile = &[
    [0.0, 0.0],
    [0.46, 0.0],
    [0.48, 0.06],
    [0.46, 0.15],
    [0.37, 0.21],
    [0.27, 0.33],
    [0.18, 0.6],
    [0.14, 0.95],
    [0.145, 1.12],
    [0.25, 1.17],
    [0.255, 1.215],
    [0.17, 1.25],
    [0.2, 1.32],
    [0.27, 1.6],
    [0.3, 1.66],
    [0.26, 1.7],
    [0.12, 1.78],
    [0.06, 1.82],
    [0.085, 1.88],
    [0.095, 1.93],
    [0.06, 1.99],
    [0.0, 2.01],
];

const SEGMENTS: usize = 28;

/// The parts of the file besides its JSON.
#[derive(Default)]
struct Data {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Data {
    fn view(&mut self, bytes: &[u8], stride: Option<usize>) -> usize {
        let mut view = json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()});
        if let Some(stride) = stride {
            view["byteStride"] = json!(stride);
        }
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, view: usize, count: usize, (component, ty): (u32, &str), more: Value) -> usize {
        let mut accessor = json!({"bufferView": view, "componentType": component, "count": count, "type": ty});
        if let (Some(all), Value::Object(more)) = (accessor.as_object_mut(), more) {
            all.extend(more);
        }
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    fn floats(&mut self, rows: &[Vec<f64>], ty: &str, has_bounds: bool) -> usize {
        let bytes: Vec<u8> = rows.iter().flatten().flat_map(|value| (*value as f32).to_le_bytes()).collect();
        let view = self.view(&bytes, None);
        let width = rows.first().map_or(0, Vec::len);
        let bound = |fold: fn(f32, f32) -> f32, first: f32| -> Vec<f32> {
            (0..width).map(|axis| rows.iter().map(|row| row[axis] as f32).fold(first, fold)).collect()
        };
        let bounds = json!({"min": bound(f32::min, f32::INFINITY), "max": bound(f32::max, f32::NEG_INFINITY)});
        self.accessor(view, rows.len(), (5126, ty), if has_bounds { bounds } else { json!({}) })
    }

    fn normals(&mut self, rows: &[[f64; 3]]) -> usize {
        let byte = |value: f64| (value * 127.0).round() as i8 as u8;
        let bytes: Vec<u8> = rows.iter().flat_map(|[x, y, z]| [byte(*x), byte(*y), byte(*z), 0]).collect();
        let view = self.view(&bytes, Some(4));
        self.accessor(view, rows.len(), (5120, "VEC3"), json!({"normalized": true}))
    }

    fn indices(&mut self, rows: &[usize]) -> usize {
        let bytes: Vec<u8> = rows.iter().flat_map(|row| (*row as u16).to_le_bytes()).collect();
        let view = self.view(&bytes, None);
        self.accessor(view, rows.len(), (5123, "SCALAR"), json!({}))
    }

    /// A picture of `side` by `side` pixels.
    fn picture(&mut self, side: u32, color: impl Fn(u32, u32) -> [u8; 3]) -> Result<usize, String> {
        let pixels: Vec<[u8; 3]> = (0..side * side).map(|k| color(k % side, k / side)).collect();
        let png = png_rgb(side, side, &pixels, Effort::Best).map_err(|error| error.to_string())?;
        Ok(self.view(&png, None))
    }
}

/// A point of Catmull and Rom's curve through the profile and its derivative, at 0 to one less than the number of points.
fn curve(profile: Profile, at: f64) -> ([f64; 2], [f64; 2]) {
    let last = profile.len() - 1;
    let k = (at.floor() as usize).min(last - 1);
    let t = at - k as f64;
    let point = |offset: isize| profile[(k as isize + offset).clamp(0, last as isize) as usize];
    let [a, b, c, d] = [point(-1), point(0), point(1), point(2)];
    let part = |axis: usize| {
        let [a, b, c, d] = [a[axis], b[axis], c[axis], d[axis]];
        let [x, y, z] = [c - a, 2.0 * a - 5.0 * b + 4.0 * c - d, 3.0 * b - a - 3.0 * c + d];
        (b + 0.5 * t * (x + t * (y + t * z)), 0.5 * (x + t * (2.0 * y + 3.0 * t * z)))
    };
    let ((r, dr), (y, dy)) = (part(0), part(1));
    ([r.max(0.0), y], [dr, dy])
}

/// Attributes and indices of a profile that is turned about the y axis.
fn lathe(data: &mut Data, profile: Profile) -> Value {
    let rings = 2 * (profile.len() - 1);
    let (mut positions, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
    for ring in 0..=rings {
        let ([r, y], [dr, dy]) = curve(profile, ring as f64 / 2.0);
        let length = dr.hypot(dy).max(1e-9);
        for k in 0..SEGMENTS {
            let (sin, cos) = (TAU * k as f64 / SEGMENTS as f64).sin_cos();
            positions.push(vec![r * sin, y, r * cos]);
            normals.push([dy / length * sin, -dr / length, dy / length * cos]);
        }
    }
    for ring in 0..rings {
        for k in 0..SEGMENTS {
            let row = |ring: usize, k: usize| ring * SEGMENTS + k % SEGMENTS;
            let [a, b, c, d] = [row(ring, k), row(ring, k + 1), row(ring + 1, k + 1), row(ring + 1, k)];
            // The first and the last ring are points.
            if ring > 0 {
                indices.extend([a, b, c]);
            }
            if ring + 1 < rings {
                indices.extend([a, c, d]);
            }
        }
    }
    let (positions, normals) = (data.floats(&positions, "VEC3", true), data.normals(&normals));
    json!({"attributes": {"POSITION": positions, "NORMAL": normals}, "indices": data.indices(&indices)})
}

/// A square in the plane y, whose texture coordinates go from 0 to `repeats`.
fn square(data: &mut Data, half: f64, y: f64, repeats: f64) -> Value {
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let positions: Vec<Vec<f64>> = corners.iter().map(|[x, z]| vec![x * half, y, z * half]).collect();
    let texcoords: Vec<Vec<f64>> =
        corners.iter().map(|[x, z]| vec![(x + 1.0) / 2.0 * repeats, (z + 1.0) / 2.0 * repeats]).collect();
    let (positions, normals) = (data.floats(&positions, "VEC3", true), data.normals(&[[0.0, 1.0, 0.0]; 4]));
    let texcoords = data.floats(&texcoords, "VEC2", false);
    let attributes = json!({"POSITION": positions, "NORMAL": normals, "TEXCOORD_0": texcoords});
    json!({"attributes": attributes, "indices": data.indices(&[0, 1, 2, 0, 2, 3])})
}

/// The pictures of the board cover two by two squares.
fn pictures(data: &mut Data) -> Result<Value, String> {
    let is_dark = |x: u32, y: u32| (x + y) % 2 == 1;
    let color = data.picture(2, |x, y| if is_dark(x, y) { [92, 44, 26] } else { [222, 196, 150] })?;
    let rough = data.picture(2, |x, y| if is_dark(x, y) { [0, 110, 0] } else { [0, 150, 0] })?;
    // Each square has a bevel of two pixels: its slope is that of the border that is nearest.
    let bevel = |at: u32| match at % 16 {
        0 | 1 => -1.0,
        14 | 15 => 1.0,
        _ => 0.0_f64,
    };
    let normals = data.picture(32, |x, y| {
        let [a, b] = [0.9 * bevel(x), -0.9 * bevel(y)];
        let length = (a * a + b * b + 1.0).sqrt();
        [a, b, 1.0].map(|value| (127.5 + 127.5 * value / length).round() as u8)
    })?;
    Ok(json!([color, rough, normals].map(|view| json!({"bufferView": view, "mimeType": "image/png"}))))
}

fn materials() -> Value {
    json!([
        {
            "name": "board",
            "pbrMetallicRoughness": {
                "baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}, "metallicFactor": 0.0
            },
            "normalTexture": {"index": 2}
        },
        {"name": "table", "pbrMetallicRoughness": {"baseColorFactor": [0.02, 0.026, 0.032, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.55}},
        {"name": "brass", "pbrMetallicRoughness": {"baseColorFactor": [0.91, 0.68, 0.33, 1.0], "metallicFactor": 1.0, "roughnessFactor": 0.24}},
        {
            "name": "ivory",
            "pbrMetallicRoughness": {"baseColorFactor": [0.7, 0.6, 0.42, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.5},
            "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatRoughnessFactor": 0.15}}
        },
        {"name": "ebony", "pbrMetallicRoughness": {"baseColorFactor": [0.03, 0.022, 0.02, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.32}}
    ])
}

/// The rotation that turns -z to a direction.
fn towards([x, y, z]: [f64; 3]) -> Value {
    let length = (x * x + y * y + z * z).sqrt();
    // Half of the way: the axis is -z times the direction.
    let [a, b, w] = [y / length, -x / length, 1.0 - z / length];
    let size = (a * a + b * b + w * w).sqrt();
    json!([a / size, b / size, 0.0, w / size])
}

fn file() -> Result<Vec<u8>, String> {
    let mut data = Data::default();
    let images = pictures(&mut data)?;
    let shapes = [
        square(&mut data, 4.0, 0.0, 4.0),
        square(&mut data, 30.0, -0.15, 1.0),
        lathe(&mut data, PAWN),
        lathe(&mut data, KING),
    ];
    let mesh = |shape: usize, material: usize| {
        let mut primitive = shapes[shape].clone();
        primitive["material"] = json!(material);
        json!({"primitives": [primitive]})
    };
    let meshes = json!([mesh(0, 0), mesh(1, 1), mesh(3, 2), mesh(2, 3), mesh(2, 4), mesh(2, 2)]);
    let piece =
        |mesh: usize, column: f64, row: f64| json!({"mesh": mesh, "translation": [column - 3.5, 0.0, row - 3.5]});
    let light = |light: usize, place: [f64; 3], direction: [f64; 3]| {
        let extension = json!({"KHR_lights_punctual": {"light": light}});
        json!({"translation": place, "rotation": towards(direction), "extensions": extension})
    };
    let eye = [2.5, 3.1, 6.2];
    let nodes = vec![
        json!({"mesh": 0}),
        json!({"mesh": 1}),
        piece(2, 3.0, 3.0),
        piece(3, 2.0, 5.0),
        piece(3, 4.0, 5.0),
        piece(3, 1.0, 3.0),
        piece(4, 5.0, 3.0),
        piece(4, 4.0, 1.0),
        piece(4, 2.0, 1.0),
        piece(5, 5.0, 5.0),
        json!({"name": "front", "camera": 0, "translation": eye, "rotation": towards([-2.75, -2.45, -6.0])}),
        light(0, [-3.5, 5.5, 3.0], [3.2, -5.2, -2.9]),
        light(1, [0.0, 0.0, 0.0], [-0.75, -0.5, 0.6]),
    ];
    let lights = json!([
        {"type": "spot", "color": [1.0, 0.86, 0.68], "intensity": 200.0, "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.62}},
        {"type": "directional", "color": [0.55, 0.7, 1.0], "intensity": 1.6}
    ]);
    let texture = |source: usize, sampler: usize| json!({"source": source, "sampler": sampler});
    let all: Vec<usize> = (0..nodes.len()).collect();
    let root = json!({
        "asset": {"version": "2.0", "generator": "glisten, crates/studies/src/bin/chess.rs"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_mesh_quantization", "KHR_materials_clearcoat"],
        "extensionsRequired": ["KHR_mesh_quantization"],
        "extensions": {"KHR_lights_punctual": {"lights": lights}},
        "scene": 0,
        "scenes": [{"nodes": all}],
        "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.62, "znear": 0.5, "zfar": 60.0}}],
        "meshes": meshes,
        "materials": materials(),
        "textures": [texture(0, 0), texture(1, 0), texture(2, 1)],
        "samplers": [{"magFilter": 9728, "minFilter": 9728}, {"magFilter": 9729, "minFilter": 9987}],
        "images": images,
        "accessors": data.accessors,
        "bufferViews": data.views,
        "buffers": [{"byteLength": data.bytes.len()}]
    });
    Ok(binary(&root.to_string(), &data.bytes))
}

/// The container (glTF 2.0 §4.4).
fn binary(json: &str, bytes: &[u8]) -> Vec<u8> {
    let mut json = json.as_bytes().to_vec();
    json.resize(json.len().next_multiple_of(4), b' ');
    let total = 12 + 8 + json.len() + 8 + bytes.len();
    let number = |value: usize| (value as u32).to_le_bytes();
    [
        &b"glTF"[..],
        &number(2),
        &number(total),
        &number(json.len()),
        b"JSON",
        &json,
        &number(bytes.len()),
        b"BIN\0",
        bytes,
    ]
    .concat()
}

fn main() -> ExitCode {
    let Some(path) = std::env::args().nth(1) else {
        eprintln!("usage: chess FILE.glb");
        return ExitCode::from(2);
    };
    let written = file().and_then(|bytes| std::fs::write(&path, bytes).map_err(|error| format!("{path}: {error}")));
    match written {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
