//! [`search`]: looks for inputs with which f32 arithmetic does the most harm.
//!
//! *In:* a scene, and the ranges that it states. *Out:* the worst scene that was found, and how its inputs differ.
//! Each [`Trial`] is an input with the values to try: stiff and extreme ones, chosen by the name, type and value of a
//! uniform or attribute, or evenly from a stated range. The search is a coordinate descent: one trial after another takes the
//! value with the largest error, until a round changes nothing.
//!
//! *Holds:* the result depends on the scene alone. At most [`MOST_DRAWINGS`] pictures are drawn, fewer for large ones.

use super::sweep::{Parameter, Sweep};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Scalar;
use glisten_reference::stability::pictures_of;
use glisten_scene::values::LeafShape;
use glisten_scene::{AttributeData, AttributeValues, Scene};
use serde::Serialize;
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write;

/// The number of pictures that a search draws at most.
pub const MOST_DRAWINGS: usize = 400;

/// The number of pixels that all of them have at most, but for the first forty.
const MOST_PIXELS: usize = 4 << 20;

/// The number of rounds at most.
const ROUNDS: usize = 3;

/// The number of values tried of a stated range.
const FROM_RANGE: usize = 9;

/// The numbers of a 4 by 4 matrix.
const MATRIX: u32 = 16;

/// A change of one input.
#[derive(Clone, Debug)]
enum Change {
    /// Values of scalars of uniforms.
    Uniform(Vec<(Parameter, f64)>),
    /// A change of the data of an attribute: the draw, the attribute, and what happens to it.
    Attribute(usize, usize, Distortion),
}

/// A change of the data of an attribute.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Distortion {
    /// All numbers are multiplied.
    Scaled(f32),
    /// Places are this far away.
    Far(f32),
    /// Every third vertex has the value 0.
    ZeroAtThird,
    /// Every second vertex of three moves to the first, but for a millionth of the distance: triangles become slivers.
    Collapsed,
}

/// An input, and the values to try.
#[derive(Clone, Debug)]
pub struct Trial {
    name: String,
    choices: Vec<(String, Change)>,
}

/// An input of the worst scene that differs from the scene's own.
#[derive(Clone, Debug, Serialize)]
pub struct Changed {
    /// The uniform or attribute.
    pub name: String,
    /// Its value, or what happened to its data.
    pub value: String,
}

/// The result of a search.
#[derive(Clone, Debug, Serialize)]
pub struct Worst {
    /// The inputs that differ.
    pub changed: Vec<Changed>,
    /// The largest finite difference of a channel, divided by the color if that is above 1.
    pub max_abs: f64,
    /// That difference with the scene's own inputs.
    pub max_abs_before: f64,
    /// The number of pixels that are not finite in f32.
    pub non_finite_pixels: u64,
    /// The number of pictures that were drawn.
    pub drawings: usize,
    /// The number of inputs that were varied.
    pub inputs: usize,
    /// The worst scene.
    #[serde(skip)]
    pub scene: Scene,
}

/// Looks for the worst inputs. `progress` is called before each picture with the number of those drawn and the limit; `false`
/// ends the search with what it has.
///
/// # Errors
/// The errors of drawing with the scene's own inputs. Inputs with which a picture cannot be drawn are passed over.
pub fn search(
    scene: &Scene,
    ranges: &[Sweep],
    progress: &mut dyn FnMut(usize, usize) -> bool,
) -> Result<Worst, Vec<Diagnostic>> {
    let trials = trials(scene, ranges);
    let pixels = scene.framebuffer.width as usize * scene.framebuffer.height as usize;
    let most = (MOST_PIXELS / pixels.max(1)).clamp(40, MOST_DRAWINGS);
    let before = badness(scene)?;
    let mut taken: Vec<Option<usize>> = vec![None; trials.len()];
    let mut worst = before;
    let mut drawings = 1;
    'rounds: for _ in 0..ROUNDS {
        let mut moved = false;
        for trial in 0..trials.len() {
            for choice in 0..trials[trial].choices.len() {
                if drawings >= most || taken[trial] == Some(choice) {
                    continue;
                }
                if !progress(drawings, most) {
                    break 'rounds;
                }
                drawings += 1;
                let mut tried = taken.clone();
                tried[trial] = Some(choice);
                let Ok(found) = badness(&applied(scene, &trials, &tried)) else { continue };
                if is_worse(found, worst) {
                    (worst, taken, moved) = (found, tried, true);
                }
            }
        }
        if !moved {
            break;
        }
    }
    // What is not needed is taken back.
    for trial in 0..trials.len() {
        let mut tried = taken.clone();
        if tried[trial].take().is_some()
            && progress(drawings, most)
            && let Ok(found) = badness(&applied(scene, &trials, &tried))
            && found.0 >= worst.0
            && found.1 >= 0.99 * worst.1
        {
            (worst, taken) = (found, tried);
        }
    }
    let names = trials.iter().zip(&taken).filter_map(|(trial, taken)| {
        let (value, _) = trial.choices.get((*taken)?)?;
        Some(Changed { name: trial.name.clone(), value: value.clone() })
    });
    Ok(Worst {
        changed: names.collect(),
        max_abs: worst.1,
        max_abs_before: before.1,
        non_finite_pixels: worst.0,
        drawings,
        inputs: trials.len(),
        scene: applied(scene, &trials, &taken),
    })
}

/// The pixels that are not finite, and the largest finite error.
fn badness(scene: &Scene) -> Result<(u64, f64), Vec<Diagnostic>> {
    let pair = pictures_of(scene)?;
    let colors = pair.exact.attachments.first().map_or(&[][..], Vec::as_slice);
    // The error of a large color counts by its size: a search would only find large colors otherwise.
    let relative =
        pair.errors.errors.iter().zip(colors).filter(|(error, _)| error.is_finite()).map(|(error, color)| {
            let size = color.iter().map(|channel| channel.abs()).filter(|size| size.is_finite()).fold(1.0, f64::max);
            error / size
        });
    Ok((pair.errors.not_finite(), relative.fold(0.0, f64::max)))
}

fn is_worse(a: (u64, f64), b: (u64, f64)) -> bool {
    a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).is_gt()
}

fn applied(scene: &Scene, trials: &[Trial], taken: &[Option<usize>]) -> Scene {
    let mut changed = scene.clone();
    for (trial, taken) in trials.iter().zip(taken) {
        if let Some((_, change)) = taken.and_then(|taken| trial.choices.get(taken)) {
            change.apply(&mut changed);
        }
    }
    changed
}

impl Change {
    fn apply(&self, scene: &mut Scene) {
        match self {
            Self::Uniform(values) => values.iter().for_each(|(parameter, value)| parameter.set(scene, *value)),
            Self::Attribute(draw, attribute, distortion) => {
                let data = scene.draws.get_mut(*draw).and_then(|draw| draw.attributes.get_mut(*attribute));
                let Some(Some(data)) = data else { return };
                match &mut data.values {
                    AttributeValues::Float(numbers) => distortion.apply(numbers, data.size.max(1) as usize),
                    AttributeValues::Int(numbers) => numbers.iter_mut().for_each(|number| {
                        *number = distortion.of_integer(f64::from(*number)) as i32;
                    }),
                    AttributeValues::Uint(numbers) => numbers.iter_mut().for_each(|number| {
                        *number = distortion.of_integer(f64::from(*number)) as u32;
                    }),
                }
            }
        }
    }
}

impl Distortion {
    fn apply(self, numbers: &mut [f32], size: usize) {
        match self {
            Self::Scaled(factor) => numbers.iter_mut().for_each(|number| *number *= factor),
            Self::Far(distance) => numbers.chunks_mut(size).for_each(|row| {
                // The last column of a matrix but for its last number is a place; the fourth number of a place is not one.
                let place =
                    if size == MATRIX as usize { MATRIX as usize - 4..MATRIX as usize - 1 } else { 0..size.min(3) };
                row.get_mut(place).into_iter().flatten().for_each(|number| *number += distance);
            }),
            Self::ZeroAtThird => numbers.chunks_mut(size).step_by(3).for_each(|row| row.fill(0.0)),
            Self::Collapsed => {
                for triangle in numbers.chunks_mut(3 * size) {
                    let (first, rest) = triangle.split_at_mut(size.min(triangle.len()));
                    for (first, second) in first.iter().zip(rest) {
                        *second = first + (*second - first) * 1e-6;
                    }
                }
            }
        }
    }

    /// An integer after the change.
    fn of_integer(self, number: f64) -> f64 {
        match self {
            Self::Scaled(factor) => number * f64::from(factor),
            Self::Far(distance) => number + f64::from(distance),
            Self::ZeroAtThird | Self::Collapsed => number,
        }
    }

    fn describe(self) -> String {
        match self {
            Self::Far(distance) => format!("{distance:e} away"),
            Self::Scaled(factor) => format!("multiplied by {factor:e}"),
            Self::ZeroAtThird => "0 at every third vertex".to_owned(),
            Self::Collapsed => "triangles collapsed to slivers".to_owned(),
        }
    }
}

/// The inputs to vary: those that the scene states a range of, and all others by their names and values.
fn trials(scene: &Scene, ranges: &[Sweep]) -> Vec<Trial> {
    let mut list: Vec<Trial> = Vec::new();
    for range in ranges {
        let Ok(parameter) = Parameter::find(scene, &range.name) else { continue };
        let Ok(values) = parameter.values(&Sweep { count: FROM_RANGE, ..range.clone() }) else { continue };
        list.push(scalar(&parameter, &values));
    }
    let stated =
        |name: &str| ranges.iter().any(|range| range.name == name || range.name.starts_with(&format!("{name}.")));
    let mut known: Vec<String> = Vec::new();
    for draw in &scene.draws {
        for leaf in draw.program.interface.uniforms.iter().filter(|leaf| leaf.active) {
            let Some(shape) = LeafShape::of(&draw.program.types, leaf) else { continue };
            let elements = leaf.array_size.map_or(vec![leaf.name.clone()], |size| {
                (0..size.min(2)).map(|element| format!("{}[{element}]", leaf.name)).collect()
            });
            for name in elements {
                if known.contains(&name) || stated(&name) {
                    continue;
                }
                list.extend(match shape.scalar {
                    Scalar::Float if shape.columns == 1 => of_uniform(scene, &name, shape.rows),
                    Scalar::Float => of_matrix(scene, &name, (shape.columns as usize, shape.rows as usize)),
                    Scalar::Int | Scalar::Uint | Scalar::Bool => of_integer(scene, &name, shape),
                });
                known.push(name);
            }
        }
    }
    for (index, draw) in scene.draws.iter().enumerate() {
        for (place, attribute) in draw.program.interface.attributes.iter().enumerate().filter(|(_, it)| it.active) {
            let Some(Some(data)) = draw.attributes.get(place) else { continue };
            list.extend(of_attribute((index, place), &attribute.name, data));
        }
    }
    list
}

fn scalar(parameter: &Parameter, values: &[f64]) -> Trial {
    let choice = |value: &f64| (number(*value), Change::Uniform(vec![(parameter.clone(), *value)]));
    Trial { name: parameter.name().to_owned(), choices: values.iter().map(choice).collect() }
}

fn number(value: f64) -> String {
    format!("{}", value as f32)
}

/// Words in names of colors, which stay below 1.
const COLORS: &[&str] =
    &["col", "albedo", "ambient", "diffuse", "specular", "emission", "tint", "amb", "diff", "spec", "emi"];

/// Words in names, and the values that a scalar of that name may take.
const BY_NAME: &[(&[&str], &[f64])] = &[
    (&["shin", "expo", "power", "gloss", "sharp"], &[0.0, 0.01, 1.0, 32.0, 1000.0, 1e4]),
    (&["time", "clock", "second", "phase"], &[0.0, 1.0, 3600.0, 86_400.0, 1e6]),
    (&["angle", "rotation", "cone", "fov"], &[0.0, 1e-4, FRAC_PI_2, PI]),
    (&["dist", "radius", "range", "near", "far", "scale", "size"], &[1e-6, 1e-3, 1.0, 1e3, 1e6]),
    (
        &["color", "colour", "albedo", "ambient", "diffuse", "specular", "emission", "tint", "intensity"],
        &[0.0, 1e-3, 1.0],
    ),
    (&["rough", "metal", "alpha", "factor", "weight", "mix", "blend"], &[0.0, 1e-3, 0.5, 1.0]),
];

/// The values to try of a float uniform with this many components.
fn of_uniform(scene: &Scene, name: &str, components: u32) -> Option<Trial> {
    if components == 1 {
        let parameter = Parameter::find(scene, name).ok()?;
        let own = parameter.get(scene)?;
        let last = name.rsplit('.').next().unwrap_or(name).to_lowercase();
        let named = BY_NAME.iter().find(|(words, _)| words.iter().any(|word| last.contains(word)));
        let suggested = [0.0, own * 1e-3, own * 0.1, own * 10.0, own * 1e3];
        return Some(scalar(&parameter, named.map_or(&suggested[..], |(_, values)| values)));
    }
    let letters = ["x", "y", "z", "w"];
    let parameters: Vec<Parameter> = (letters.iter().take(components as usize))
        .map(|letter| Parameter::find(scene, &format!("{name}.{letter}")))
        .collect::<Result<_, _>>()
        .ok()?;
    let own: Vec<f64> = parameters.iter().map(|parameter| parameter.get(scene)).collect::<Option<_>>()?;
    let last = name.rsplit('.').next().unwrap_or(name).to_lowercase();
    let is_color = COLORS.iter().any(|word| last.contains(word));
    let mut choices = Vec::new();
    for vector in if is_color { vec![vec![0.0; own.len()], own.clone()] } else { vectors(&own) } {
        let mut text = String::from("[");
        for (index, value) in vector.iter().enumerate() {
            let _ = write!(text, "{}{}", if index == 0 { "" } else { ", " }, number(*value));
        }
        text.push(']');
        let values = parameters.iter().cloned().zip(vector).collect();
        choices.push((text, Change::Uniform(values)));
    }
    Some(Trial { name: name.to_owned(), choices })
}

/// Names of integers that count the iterations of a loop, or of things: large values would only take long.
const COUNTS: &[&str] =
    &["count", "num", "step", "iter", "sample", "octave", "level", "bounce", "pass", "tap", "max", "lights"];

/// The values to try of an integer or `bool` uniform: a count stays small, another number may be any that a host counts up to,
/// such as a frame's. Vectors are as a whole.
fn of_integer(scene: &Scene, name: &str, shape: LeafShape) -> Option<Trial> {
    let elements = shape.n_each();
    let parameters: Vec<Parameter> =
        (0..elements).map(|element| Parameter::element(scene, name, element)).collect::<Option<_>>()?;
    let own: Vec<f64> = parameters.iter().map(|parameter| parameter.get(scene)).collect::<Option<_>>()?;
    let largest = own.iter().copied().fold(0.0, f64::max);
    let last = name.rsplit('.').next().unwrap_or(name).to_lowercase();
    let is_count = last.len() == 1 || COUNTS.iter().any(|word| last.contains(word));
    let values: &[f64] = match shape.scalar {
        Scalar::Bool => &[0.0, 1.0],
        _ if is_count => &[0.0, 1.0, (2.0 * largest).min(256.0), (8.0 * largest).min(256.0)],
        Scalar::Int => &[0.0, 1.0, -1.0, 65_535.0, 16_777_217.0, 2_147_483_647.0],
        _ => &[0.0, 1.0, 65_535.0, 16_777_217.0, 4_294_967_295.0],
    };
    let choice = |value: &f64| {
        let all = parameters.iter().cloned().map(|parameter| (parameter, *value)).collect();
        (format!("{value}"), Change::Uniform(all))
    };
    Some(Trial { name: name.to_owned(), choices: values.iter().map(choice).collect() })
}

/// The changes of a matrix: its place moves far away, its axes shrink and grow, two of them are nearly the same.
fn of_matrix(scene: &Scene, name: &str, (columns, rows): (usize, usize)) -> Option<Trial> {
    let parameters: Vec<Parameter> =
        (0..columns * rows).map(|element| Parameter::element(scene, name, element)).collect::<Option<_>>()?;
    let own: Vec<f64> = parameters.iter().map(|parameter| parameter.get(scene)).collect::<Option<_>>()?;
    let axes = if (columns, rows) == (4, 4) { 3 } else { columns };
    let place = |element: usize| (element / rows, element % rows);
    let is_axis = |element: usize| place(element).0 < axes && place(element).1 < 3;
    let is_place = |element: usize| columns == 4 && place(element).0 == 3 && place(element).1 < 3;
    let with = |new: &dyn Fn(usize, f64) -> f64| -> Vec<f64> {
        own.iter().enumerate().map(|(element, value)| new(element, *value)).collect()
    };
    let moved = |far: f64| with(&|element, value| if is_place(element) { value + far } else { value });
    let scaled = |factor: f64| with(&|element, value| if is_axis(element) { value * factor } else { value });
    // The second axis is the first one but for a millionth of it.
    let flat = with(&|element, value| match place(element) {
        (1, row) if is_axis(element) => own.get(row).map_or(value, |first| first + 1e-6 * value),
        _ => value,
    });
    let mut choices = vec![
        ("axes times 1e-3".to_owned(), scaled(1e-3)),
        ("axes times 1e3".to_owned(), scaled(1e3)),
        ("two axes nearly parallel".to_owned(), flat),
    ];
    if columns == 4 {
        choices.extend([("1e4 away".to_owned(), moved(1e4)), ("1e6 away".to_owned(), moved(1e6))]);
    }
    let change = |values: Vec<f64>| Change::Uniform(parameters.iter().cloned().zip(values).collect());
    let choices = choices.into_iter().map(|(words, values)| (words, change(values)));
    Some(Trial { name: name.to_owned(), choices: choices.collect() })
}

/// A direction stays a direction and turns to the axes, to grazing and against itself; a place moves to 0 and far away; a color
/// goes to black.
fn vectors(own: &[f64]) -> Vec<Vec<f64>> {
    // A fourth component of 0 or 1 says whether it is a direction or a place.
    let (own, fixed) = match own {
        [x, y, z, w] if *w == 0.0 || *w == 1.0 => (&[*x, *y, *z][..], &own[3..]),
        _ => (own, &[][..]),
    };
    of_direction_or_place(own).into_iter().map(|vector| [vector.as_slice(), fixed].concat()).collect()
}

fn of_direction_or_place(own: &[f64]) -> Vec<Vec<f64>> {
    let scaled = |factor: f64| own.iter().map(|value| value * factor).collect::<Vec<f64>>();
    let length = own.iter().map(|value| value * value).sum::<f64>().sqrt();
    let is_direction = (length - 1.0).abs() < 1e-3 && own.len() == 3;
    if !is_direction {
        return [0.0, 1e-20, 1e-3, 1e3, 1e6].map(scaled).to_vec();
    }
    let mut list = vec![scaled(-1.0)];
    for axis in 0..3 {
        for sign in [1.0, -1.0] {
            let unit =
                |grazing: f64| (0..3).map(|place| if place == axis { sign } else { grazing }).collect::<Vec<f64>>();
            list.extend([unit(0.0), unit(1e-4)]);
        }
    }
    list
}

/// The distortions of an attribute: those of directions shrink and vanish, places collapse. Data of instances move far away,
/// shrink and grow, whatever their names.
fn of_attribute((draw, attribute): (usize, usize), name: &str, data: &AttributeData) -> Option<Trial> {
    let lower = name.to_lowercase();
    let is_float = matches!(data.values, AttributeValues::Float(_));
    let is_instance = data.divisor > 0;
    let distortions: &[Distortion] = match () {
        () if is_float && (lower.contains("norm") || lower.contains("tangent")) => {
            &[Distortion::ZeroAtThird, Distortion::Scaled(1e-20), Distortion::Scaled(1e-39), Distortion::Scaled(1e20)]
        }
        () if is_float && is_instance && data.size == MATRIX => {
            &[Distortion::Far(1e4), Distortion::Far(1e6), Distortion::Scaled(1e-3), Distortion::Scaled(1e3)]
        }
        () if is_float && is_instance => &[
            Distortion::Far(1e4),
            Distortion::Far(1e6),
            Distortion::Scaled(0.0),
            Distortion::Scaled(1e-3),
            Distortion::Scaled(1e3),
        ],
        () if is_instance => &[Distortion::Scaled(0.0), Distortion::Scaled(1e3), Distortion::Scaled(1e6)],
        () if is_float && (lower.contains("pos") || lower.contains("vert") || lower == "pv") => {
            &[Distortion::Collapsed]
        }
        () => return None,
    };
    let choice = |distortion: &Distortion| (distortion.describe(), Change::Attribute(draw, attribute, *distortion));
    Some(Trial { name: name.to_owned(), choices: distortions.iter().map(choice).collect() })
}
