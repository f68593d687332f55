//! The numbers that a scene begins with: of uniforms, by their [`Meaning`], and of attributes at the corners of a square.
//!
//! *In:* what a uniform or an attribute is called, and its type. *Out:* its numbers as TOML. *Holds:* the same program gives the same
//! numbers. A [`Taste`] other than the first one is tried where a picture is flat.

use super::choice::{Changed, Choice, Taste};
use super::meanings::{Meaning, meaning};
use super::reads::{Input, Reads};
use glisten_front::hir::{Scalar, Type};
use glisten_front::link::UniformLeaf;
use glisten_scene::roles::AttributeRole;
use glisten_scene::values::LeafShape;

/// The numbers of a uniform as TOML.
pub(super) fn uniform_text(reads: &Reads<'_>, leaf: &UniformLeaf, choice: &Choice) -> String {
    let types = &reads.program.types;
    let Some(shape) = LeafShape::of(types, leaf) else { return "[]".to_owned() };
    let (side, taste) = (choice.side, choice.taste);
    let changed = choice.changed.as_ref().filter(|(which, _)| which.has(leaf, types.get(leaf.ty)));
    let changed = changed.map(|(_, value)| *value);
    let mut numbers = Vec::with_capacity(shape.n_values());
    for element in 0..shape.elements {
        let row = match (changed, types.get(leaf.ty)) {
            (Some(value), _) => vec![value; shape.n_each()],
            (None, Type::Matrix(columns, rows)) => identity(usize::from(columns), usize::from(rows)),
            (None, ty) => vector(reads, leaf, ty, (element, shape), (side, taste)),
        };
        numbers.extend(row);
    }
    let texts: Vec<String> = numbers.into_iter().map(|number| text_of(number, shape.scalar)).collect();
    match (&texts[..], leaf.array_size) {
        ([one], None) => one.clone(),
        _ => format!("[{}]", texts.join(", ")),
    }
}

/// Numbers that uniforms may have instead where nothing is shown: all floats together, then of each uniform the first one, and so on.
pub(super) fn alternatives(reads: &Reads<'_>) -> Vec<(Changed, f64)> {
    let types = &reads.program.types;
    let is_free = |leaf: &&&UniformLeaf| !matches!(types.get(leaf.ty), Type::Matrix(..));
    let free: Vec<&&UniformLeaf> = reads.uniforms.iter().filter(is_free).collect();
    let of = |value: f64| free.iter().map(move |leaf| (Changed::One(leaf.name.clone()), value)).collect::<Vec<_>>();
    let has_floats = free.iter().any(|leaf| types.get(leaf.ty) == Type::Scalar(Scalar::Float));
    let together = ALTERNATIVES.into_iter().filter(|_| has_floats).map(|value| (Changed::Floats, value));
    together.chain(ALTERNATIVES.into_iter().flat_map(of)).collect()
}

/// Such a number may be a factor that darkens, a threshold that discards, a mode, a distance.
const ALTERNATIVES: [f64; 4] = [0.0, 1.0, 0.1, 10.0];

/// A number as TOML.
pub(super) fn text_of(number: f64, scalar: Scalar) -> String {
    match scalar {
        Scalar::Float => format!("{:?}", number as f32),
        Scalar::Bool => (number != 0.0).to_string(),
        Scalar::Int => format!("{}", number as i64),
        Scalar::Uint => format!("{}", number.max(0.0) as i64),
    }
}

/// The identity, by columns.
pub(super) fn identity(columns: usize, rows: usize) -> Vec<f64> {
    (0..columns * rows).map(|index| f64::from(u8::from(index / rows == index % rows))).collect()
}

/// The numbers of one element of a uniform that is no matrix.
fn vector(
    reads: &Reads<'_>,
    leaf: &UniformLeaf,
    ty: Type,
    (element, shape): (u32, LeafShape),
    (side, taste): (u32, Taste),
) -> Vec<f64> {
    let size = shape.n_each();
    if let Some(value) = reads.parameters.get(&leaf.name) {
        return vec![*value; size];
    }
    let side = f64::from(side);
    let turn = match element_of(&leaf.name) {
        Some(outer) => f64::from(outer) + 0.3 * f64::from(element),
        None => f64::from(element),
    };
    let first = |row: [f64; 4]| row.into_iter().chain([0.0; 12]).take(size).collect::<Vec<f64>>();
    let color = |value: f64| first([value, value, value, if size == 4 { 1.0 } else { value }]);
    match meaning(&leaf.name, ty) {
        Meaning::Resolution if size == 4 => vec![side, side, 1.0 / side, 1.0 / side],
        Meaning::Resolution if size == 3 => vec![side, side, 1.0],
        Meaning::Resolution => vec![side; size],
        Meaning::Texel if size == 4 => vec![1.0 / side, 1.0 / side, side, side],
        Meaning::Texel => vec![1.0 / side; size],
        Meaning::Time => vec![[1.5, 7.0, 0.3][taste.0 % 3]; size],
        Meaning::Frame => vec![[60.0, 1.0, 0.0][taste.0 % 3]; size],
        Meaning::Mouse => first([0.6 * side, 0.4 * side, 0.0, 0.0]),
        Meaning::LightPosition => first(around([2.0, 3.0, 4.0], turn)),
        Meaning::LightDirection => first(turned(around([0.37, 0.56, 0.74], turn), taste)),
        Meaning::SpotDirection => first(turned(around([-0.37, -0.56, -0.74], turn), taste)),
        Meaning::Eye => first([0.0, 0.0, 3.0, 1.0]),
        Meaning::Up => first([0.0, 1.0, 0.0, 0.0]),
        Meaning::Right => first([1.0, 0.0, 0.0, 0.0]),
        Meaning::Forward => first([0.0, 0.0, -1.0, 0.0]),
        Meaning::Color(value) => color(value),
        Meaning::BaseColor => first(shuffled([0.8, 0.5, 0.3], turn + colors_before(reads, leaf))),
        Meaning::Power if size > 1 => color(1.0),
        Meaning::Power => vec![[1.0, 20.0, 5.0, 0.2][taste.0 % 4]],
        Meaning::Range(low, high) if size > 1 => match size {
            2 => vec![low, high],
            _ => first([low, (low + high) / 2.0, high, high]),
        },
        Meaning::Range(_, high) => vec![high],
        Meaning::FogColor => first([0.5, 0.6, 0.7, 1.0]),
        Meaning::Count => vec![count(reads, taste); size],
        Meaning::Samples => kernel(turn, size),
        Meaning::Weights => {
            vec![1.0 / f64::from(shape.elements.max(1)) / if shape.elements > 1 { 1.0 } else { 2.0 }; size]
        }
        Meaning::Value(value) => vec![value; size],
        Meaning::Switch(on) => vec![f64::from(u8::from(on == (taste.0 % 2 == 0))); size],
        Meaning::Rectangle if size == 4 => vec![0.1, 0.1, 0.9, 0.9],
        Meaning::Rectangle => unknown(shape, taste, element),
        Meaning::Plane => first([0.0, 1.0, 0.0, 0.0]),
        Meaning::Unknown => unknown(shape, taste, element),
    }
}

/// How many uniforms before this one are colors of surfaces, which are to differ.
fn colors_before(reads: &Reads<'_>, leaf: &UniformLeaf) -> f64 {
    let types = &reads.program.types;
    let is_color = |other: &&&UniformLeaf| meaning(&other.name, types.get(other.ty)) == Meaning::BaseColor;
    let before = reads.uniforms.iter().take_while(|other| other.name != leaf.name).filter(is_color);
    before.count() as f64
}

/// The values of names that say nothing. The vectors of an array differ, as two corners of a box do.
fn unknown(shape: LeafShape, taste: Taste, element: u32) -> Vec<f64> {
    let size = shape.n_each();
    let number = element as usize;
    match shape.scalar {
        Scalar::Float if size == 1 => vec![[0.5, 1.0, 0.1, 4.0][taste.0 % 4]],
        Scalar::Float => {
            let rows = [[0.8, 0.6, 0.4, 1.0], [1.0, 1.0, 1.0, 1.0], [0.1, 0.2, 0.3, 0.0], [4.0, 2.0, 3.0, 1.0]];
            let row = rows[taste.0 % 4];
            (0..size).map(|index| row[(index + number) % 4] + 0.5 * f64::from(element)).collect()
        }
        Scalar::Int | Scalar::Uint if size > 1 && shape.elements > 1 => {
            (0..size).map(|index| f64::from((index as u32 + 1) * 67 * (element + 1) % 256)).collect()
        }
        Scalar::Int | Scalar::Uint | Scalar::Bool => vec![[1.0, 0.0, 2.0, 4.0][taste.0 % 4]; size],
    }
}

/// A number of lights, samples or steps: as many as the smallest array has, at most 4.
fn count(reads: &Reads<'_>, taste: Taste) -> f64 {
    let arrays = reads.uniforms.iter().filter_map(|leaf| leaf.array_size);
    let sizes = arrays.chain(sizes_of_struct_arrays(reads)).filter(|size| *size > 1);
    f64::from(sizes.min().unwrap_or(4).min([4, 1, 16][taste.0 % 3]))
}

/// The sizes of the arrays of structs, as far as their elements are read: 2 if `light[1].color` is the last one.
fn sizes_of_struct_arrays(reads: &Reads<'_>) -> Vec<u32> {
    let mut sizes = std::collections::BTreeMap::<&str, u32>::new();
    for leaf in &reads.uniforms {
        let Some((array, _)) = leaf.name.split_once('[') else { continue };
        let Some(element) = element_of(&leaf.name) else { continue };
        let size = sizes.entry(array).or_default();
        *size = (*size).max(element.saturating_add(1));
    }
    sizes.into_values().collect()
}

/// The index of the element of an array that a name is in: 1 of `lights[1].color`.
fn element_of(name: &str) -> Option<u32> {
    name.split_once('[')?.1.split_once(']')?.0.parse().ok()
}

/// A place, turned about the y axis for each further element, with w = 1.
fn around([x, y, z]: [f64; 3], turn: f64) -> [f64; 4] {
    let (sin, cos) = (turn * 1.9).sin_cos();
    let round = |value: f64| (value * 100.0).round() / 100.0;
    [round(x * cos + z * sin), y, round(z * cos - x * sin), 1.0]
}

/// A direction, or for every other taste the opposite one, with w = 0.
fn turned([x, y, z, _]: [f64; 4], taste: Taste) -> [f64; 4] {
    let sign = if taste.0.is_multiple_of(2) { 1.0 } else { -1.0 };
    [sign * x, sign * y, sign * z, 0.0]
}

/// A color, with the channels of another order for each further element.
fn shuffled(color: [f64; 3], turn: f64) -> [f64; 4] {
    let channel = |index: usize| color[(index + turn as usize) % 3];
    [channel(0), channel(1), channel(2), 1.0]
}

/// A point of a kernel, by the golden angle, in the half of z > 0.
fn kernel(turn: f64, size: usize) -> Vec<f64> {
    let (sin, cos) = (turn * 2.399_963).sin_cos();
    let radius = (0.1 + 0.07 * turn).min(1.0);
    let round = |value: f64| (value * 1000.0).round() / 1000.0;
    [round(cos * radius), round(sin * radius), 0.5, 0.0].into_iter().chain([0.0; 12]).take(size).collect()
}

/// The corners of a square, in the order of a strip.
pub(super) const CORNERS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]];

/// A range of positions: the value at -1 and at 1.
pub(super) type Range = (f64, f64);

/// The numbers of an attribute at a corner.
pub(super) fn corner(reads: &Reads<'_>, input: &Input<'_>, number: usize, range: Range, choice: &Choice) -> Vec<f64> {
    let (side, taste) = (choice.side, choice.taste.0);
    let [x, y] = CORNERS[number % 4];
    let [s, t] = [(x + 1.0) / 2.0, (y + 1.0) / 2.0];
    let place = |value: f64| range.0 + (range.1 - range.0) * value;
    let small = input.name.to_ascii_lowercase();
    let has = |words: &[&str]| words.iter().any(|word| small.contains(word));
    let row = match (input.role, reads.program.types.get(input.ty)) {
        (_, Type::Matrix(columns, rows)) => return identity(usize::from(columns), usize::from(rows)),
        (Some(AttributeRole::Position), _) => [place(s), place(t), 0.0, 1.0],
        (Some(AttributeRole::Normal), _) => [0.0, 0.0, 1.0, 0.0],
        // Beyond the edge, too, where nothing else is shown.
        (Some(AttributeRole::Texcoord), _) if taste == 3 => [2.0 * s - 0.5, 2.0 * t - 0.5, 0.0, 1.0],
        (Some(AttributeRole::Texcoord | AttributeRole::Texcoord2), _) => [s, t, 0.0, 1.0],
        (Some(AttributeRole::Color), _) => COLORS[number % 4],
        (Some(AttributeRole::Tangent), _) => [1.0, 0.0, 0.0, 1.0],
        (Some(AttributeRole::Bitangent), _) => [0.0, 1.0, 0.0, 0.0],
        (None, _) if input.is_integer && has(&["uv2", "light"]) => [240.0; 4],
        (None, _) if input.is_integer && has(&["vertexid", "vertexindex"]) => [number as f64; 4],
        (None, _) if input.is_integer && taste > 0 => [number as f64; 4],
        (None, _) if input.is_integer => [0.0; 4],
        (None, _) if has(&["weight"]) => [1.0, 0.0, 0.0, 0.0],
        (None, _)
            if has(&["bone", "joint", "index", "indices", "offset", "translat", "instance", "velocity", "id"]) =>
        {
            [0.0; 4]
        }
        (None, _) if has(&["resolution", "screen", "viewport"]) => [f64::from(side); 4],
        (None, _) if has(&["size", "scale"]) => [1.0; 4],
        (None, _) if has(&["uv", "tex", "coord"]) => [s, t, 0.0, 1.0],
        // The corners of triangles, from which the distances to edges follow.
        (None, _) if taste == 2 || has(&["bary"]) => BARYCENTRIC[number % 3],
        (None, _) => [0.2 + 0.6 * s, 0.2 + 0.6 * t, 0.5, 1.0],
    };
    row.into_iter().chain(std::iter::repeat(0.0)).take(input.size).collect()
}

static BARYCENTRIC: [[f64; 4]; 3] = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]];
static COLORS: [[f64; 4]; 4] = [[1.0, 0.2, 0.2, 1.0], [0.2, 0.9, 0.2, 1.0], [0.2, 0.3, 1.0, 1.0], [1.0, 0.9, 0.2, 1.0]];
