//! A scene for a program that comes without one: a sphere, a camera, and values by names and types.
//!
//! *In:* a linked program and the names of its files. *Out:* the text of a scene. *Holds:* the same program gives the same scene; a
//! number comes from the name of its variable, nothing from chance.

use glam::{DMat4, DVec3};
use glisten::Program;
use glisten_front::hir::{SamplerDim, SamplerType, Scalar, Type, TypeId, Types};
use glisten_front::link::{Attribute, UniformLeaf};
use glisten_scene::values::LeafShape;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// The width and height of the picture.
pub(crate) const SIDE: u32 = 32;
/// The squares of the sphere around and along.
const SQUARES: [u32; 2] = [8, 6];
/// Numbers that a line spells out; a longer array stays 0.
const MOST: usize = 4096;
/// The width and height of a flat texture: so many that neighbors hardly differ, and the weights of linear filters matter little.
const TEXELS: usize = 128;
/// The width and height of other textures.
const FEW_TEXELS: usize = 16;

/// The scene of a program.
pub(crate) fn scene(program: &Program, files: &[(&str, String)]) -> String {
    let mut text = format!("[framebuffer]\nwidth = {SIDE}\nheight = {SIDE}\n");
    let outputs = &program.interface.outputs;
    match outputs.first().and_then(|output| scalar_of(&program.types, output.ty)) {
        Some(Scalar::Int) => text.push_str("format = \"rgba32sint\"\n"),
        Some(Scalar::Uint) => text.push_str("format = \"rgba32uint\"\n"),
        Some(Scalar::Float | Scalar::Bool) | None => {}
    }
    let attachments = outputs.iter().map(|output| output.location + 1).max().unwrap_or(1);
    let _ = writeln!(text, "attachments = {attachments}");
    if program.interface.uniforms.iter().any(|leaf| leaf.name.starts_with("gl_")) {
        text.push_str("[camera]\neye = [0, 0, 3]\n");
    }
    text.push_str("[[draw]]\nprimitive = \"triangles\"\ndepth_test = true\n");
    for (stage, file) in files {
        let _ = writeln!(text, "{stage} = {}", quoted(file));
    }
    attributes(&mut text, program);
    uniforms(&mut text, program);
    textures(&mut text, program);
    text
}

fn quoted(text: &str) -> String {
    serde_json::to_string(text).expect("a text is always JSON")
}

fn scalar_of(types: &Types, mut ty: TypeId) -> Option<Scalar> {
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    types.scalar_of(ty)
}

/// A number from 0 to 1 that belongs to a name (FNV-1a).
fn chance(name: &str, index: usize) -> f64 {
    let mut hash = 0x811c_9dc5_u32;
    for byte in name.bytes().chain(index.to_le_bytes()) {
        hash = (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193);
    }
    f64::from(hash >> 8) / f64::from(1_u32 << 24)
}

/// Whether a name has one of these words.
fn has(name: &str, words: &[&str]) -> bool {
    let name = name.to_ascii_lowercase();
    words.iter().any(|word| name.contains(word))
}

/// A vertex: the longitude and latitude, from 0 to 1.
type Place = [f64; 2];

/// The vertices of the sphere, three for each triangle.
fn sphere() -> Vec<Place> {
    let [around, along] = SQUARES;
    let place = |x: u32, y: u32| [f64::from(x) / f64::from(around), f64::from(y) / f64::from(along)];
    let square = |x: u32, y: u32| {
        [place(x, y), place(x + 1, y), place(x + 1, y + 1), place(x, y), place(x + 1, y + 1), place(x, y + 1)]
    };
    (0..along).flat_map(|y| (0..around).map(move |x| (x, y))).flat_map(|(x, y)| square(x, y)).collect()
}

/// The unit vector of a vertex.
fn direction([u, v]: Place) -> DVec3 {
    let (longitude, latitude) = (u * TAU, (v - 0.5) * PI);
    DVec3::new(latitude.cos() * longitude.sin(), latitude.sin(), latitude.cos() * longitude.cos())
}

fn attributes(text: &mut String, program: &Program) {
    let active: Vec<&Attribute> = program.interface.attributes.iter().filter(|attribute| attribute.active).collect();
    let sphere = sphere();
    if active.is_empty() {
        let _ = writeln!(text, "vertex_count = {}", sphere.len());
        return;
    }
    let named = |attribute: &&&Attribute| has(&attribute.name, &["pos", "vert", "gl_vertex", "point"]);
    let position = active.iter().find(named).or(active.first()).map(|attribute| attribute.location);
    text.push_str("[draw.attributes]\n");
    for attribute in active {
        let size = program.types.flat_len(attribute.ty) as usize;
        let integer = matches!(scalar_of(&program.types, attribute.ty), Some(Scalar::Int | Scalar::Uint));
        let is_position = Some(attribute.location) == position;
        let is_matrix = matches!(program.types.get(attribute.ty), Type::Matrix(..));
        let rows = sphere.iter().enumerate().flat_map(|(number, place)| {
            let row = match is_matrix {
                true => identity(size),
                // A sphere without depth would cover itself at one depth.
                false if is_position && size == 2 => flat(*place),
                false => row(&attribute.name, is_position, number, *place),
            };
            (0..size).map(move |index| row.get(index).copied().unwrap_or(f64::from(index == 3)))
        });
        let values: Vec<String> = rows.map(|value| if integer { whole(value) } else { decimal(value) }).collect();
        let _ = writeln!(text, "{} = {{ size = {size}, values = [{}] }}", quoted(&attribute.name), values.join(","));
    }
}

/// The vertex of a rectangle.
fn flat(place: Place) -> Vec<f64> {
    place.map(|part| 1.6 * part - 0.8).to_vec()
}

fn identity(size: usize) -> Vec<f64> {
    let side = (size as f64).sqrt() as usize;
    (0..size).map(|index| f64::from(side > 0 && index / side == index % side)).collect()
}

/// The numbers of an attribute at a vertex.
fn row(name: &str, is_position: bool, number: usize, place: Place) -> Vec<f64> {
    let unit = direction(place);
    if is_position {
        return (unit * 0.8).extend(1.0).to_array().to_vec();
    }
    if has(name, &["norm", "nrm"]) {
        return unit.to_array().to_vec();
    }
    if has(name, &["bitan", "binorm"]) {
        return vec![0.0, 1.0, 0.0];
    }
    if has(name, &["tan"]) {
        let tangent = DVec3::new(unit.z, 0.0, -unit.x);
        return tangent.try_normalize().unwrap_or(DVec3::X).extend(1.0).to_array().to_vec();
    }
    if has(name, &["tex", "uv", "coord"]) {
        return vec![place[0], place[1], 0.0, 1.0];
    }
    if has(name, &["weight"]) {
        return vec![1.0, 0.0, 0.0, 0.0];
    }
    if has(name, &["bone", "joint", "index", "indices", "id"]) {
        return vec![0.0; 4];
    }
    (0..4).map(|index| 0.2 + 0.6 * chance(name, number % 7 * 4 + index)).collect()
}

fn decimal(value: f64) -> String {
    format!("{:?}", value as f32)
}

fn whole(value: f64) -> String {
    format!("{}", value.abs() as i64)
}

fn uniforms(text: &mut String, program: &Program) {
    let interface = &program.interface;
    let keeps = |leaf: &UniformLeaf| {
        leaf.name.starts_with("gl_")
            || interface.roots.get(leaf.root.0 as usize).is_some_and(|root| root.default.is_some())
    };
    let projects = interface.uniforms.iter().any(|leaf| has(&leaf.name, PROJECTIONS));
    text.push_str("[draw.uniforms]\n");
    for leaf in interface.uniforms.iter().filter(|leaf| leaf.active && !keeps(leaf)) {
        let Some(shape) = LeafShape::of(&program.types, leaf) else { continue };
        if shape.n_values() > MOST {
            continue;
        }
        let element = |number: usize| match (shape.columns, shape.rows) {
            (columns @ 2.., rows) => matrix(&leaf.name, [columns, rows], projects),
            _ => (0..shape.n_each()).map(|index| number_of(&leaf.name, shape.scalar, number * 4 + index)).collect(),
        };
        let values = (0..shape.elements as usize).flat_map(element);
        let told: Vec<String> = values
            .map(|value| match shape.scalar {
                Scalar::Float => decimal(value),
                Scalar::Bool => (value > 0.5).to_string(),
                Scalar::Int | Scalar::Uint => whole(value),
            })
            .collect();
        let told =
            if told.len() == 1 && leaf.array_size.is_none() { told.concat() } else { format!("[{}]", told.join(",")) };
        let _ = writeln!(text, "{} = {told}", quoted(&leaf.name));
    }
}

/// Words in the names of matrices that project.
const PROJECTIONS: &[&str] = &["proj", "mvp", "wvp", "viewport_matrix", "modelviewp", "transform"];

/// A perspective of 45 degrees, from 0.1 to 100 (`gluPerspective`).
fn perspective() -> DMat4 {
    let (near, far, focal) = (0.1, 100.0, 1.0 / (PI / 8.0).tan());
    let (depth, offset) = ((far + near) / (near - far), 2.0 * far * near / (near - far));
    DMat4::from_cols_array(&[focal, 0.0, 0.0, 0.0, 0.0, focal, 0.0, 0.0, 0.0, 0.0, depth, -1.0, 0.0, 0.0, offset, 0.0])
}

/// The numbers of a matrix by columns.
fn matrix(name: &str, [columns, rows]: [u32; 2], projects: bool) -> Vec<f64> {
    let turned = DMat4::from_rotation_y(0.6) * DMat4::from_rotation_x(0.3);
    let view = if projects { DMat4::from_translation(DVec3::new(0.0, 0.0, -3.0)) } else { DMat4::IDENTITY };
    let projection = perspective();
    let mut matrix = DMat4::IDENTITY;
    let is_normal = has(name, &["norm"]);
    if has(name, &["mvp", "wvp", "modelviewp", "transform"]) {
        matrix = projection * view * turned;
    } else if has(name, &["proj"]) {
        matrix = if has(name, &["view"]) { projection * view } else { projection };
        matrix = if has(name, &["model", "world"]) { matrix * turned } else { matrix };
    } else if has(name, &["view", "camera"]) && !is_normal {
        matrix = if has(name, &["model", "world"]) { view * turned } else { view };
    } else if !has(name, &["tex", "bone", "joint", "skin", "uv"]) {
        matrix = turned;
    }
    if has(name, &["inv"]) {
        matrix = matrix.inverse();
    }
    if has(name, &["transpose"]) {
        matrix = matrix.transpose();
    }
    let columns = (0..columns as usize).map(|column| matrix.col(column).to_array());
    columns.flat_map(|column| column.into_iter().take(rows as usize)).collect()
}

/// A number of a uniform.
fn number_of(name: &str, scalar: Scalar, index: usize) -> f64 {
    if scalar != Scalar::Float {
        return if has(name, &["count", "num", "samples", "iter", "steps", "size"]) {
            2.0
        } else {
            f64::from(index.is_multiple_of(2))
        };
    }
    static BY_NAME: &[(&[&str], f64)] = &[
        (&["texel", "pixelsize", "invres"], 1.0 / SIDE as f64),
        (&["resolution", "viewport", "viewwidth", "viewheight", "screensize", "size", "dimension"], SIDE as f64),
        (&["time"], 1.25),
        (&["near"], 0.1),
        (&["far"], 100.0),
        (&["shin", "power", "exponent"], 8.0),
    ];
    if has(name, &["near"]) && has(name, &["far"]) {
        // Both planes in one vector.
        return [0.1, 100.0][index % 2];
    }
    let known = BY_NAME.iter().find(|(words, _)| has(name, words)).map(|(_, value)| *value);
    let scale = if has(name, &["pos", "eye"]) { 3.0 } else { 0.8 };
    known.unwrap_or_else(|| 0.2 + scale * chance(name, index))
}

fn textures(text: &mut String, program: &Program) {
    text.push_str("[draw.textures]\n");
    for slot in program.interface.samplers.iter().filter(|slot| slot.active) {
        let Type::Sampler(kind) = program.types.get(slot.ty) else { continue };
        let (extent, texels, step) = extent(kind);
        let plain = kind.texel == Scalar::Float && !kind.shadow;
        let smooth = plain && !matches!(kind.dim, SamplerDim::Buffer | SamplerDim::Multisample);
        let filter = if smooth { ", filter = \"linear\"" } else { "" };
        let values = (0..texels).flat_map(|texel| (0..4).map(move |channel| (texel, channel)));
        let values = values.map(|(texel, channel)| {
            let (x, y) = ((texel % step) as f64, (texel / step) as f64);
            let wave = (TAU * (x + y * (1.0 + channel as f64)) / step as f64).sin();
            let base = 0.4 + 0.2 * chance(&slot.name, channel);
            if kind.texel == Scalar::Float { decimal(base + 0.2 * wave) } else { ((texel + channel) % 4).to_string() }
        });
        let values: Vec<String> = values.collect();
        let _ = writeln!(text, "{} = {{ {extent}{filter}, values = [{}] }}", quoted(&slot.name), values.join(","));
    }
}

/// The keys for a texture's size, the number of its texels, and how many make a row.
fn extent(kind: SamplerType) -> (String, usize, usize) {
    let flat = matches!(kind.dim, SamplerDim::D2 | SamplerDim::Rect) && !kind.arrayed && kind.texel == Scalar::Float;
    let side = if flat { TEXELS } else { FEW_TEXELS };
    let (size, texels) = match kind.dim {
        SamplerDim::D1 | SamplerDim::Buffer => (format!("width = {side}"), side),
        SamplerDim::D3 => (format!("width = {side}, height = {side}, depth = 2"), side * side * 2),
        SamplerDim::Cube => (format!("width = {side}"), side * side * 6),
        _ => (format!("width = {side}, height = {side}"), side * side),
    };
    match kind.arrayed {
        true => (format!("{size}, layers = 2"), texels * 2, side),
        false => (size, texels, side),
    }
}
