//! Rows of inputs: the ends of ranges, numbers at which functions are undefined, equal vectors, and numbers by chance.
//!
//! *In:* inputs. *Out:* rows of numbers. *Holds:* what is stated about an input is kept; the rows are the same every time.

use super::inputs::{Input, InputKind, Inputs};
use crate::arguments::bounds::Bounds;
use glisten_front::hir::Scalar;
use glisten_scene::random::SplitMix64;

/// The values of inputs of which nothing is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Others {
    /// Anything.
    Any,
    /// Harmless: positive, and of the size of 1.
    Tame,
}

/// Numbers that are tried more often than others.
const SPECIAL: [f64; 6] = [0.0, 1.0, -1.0, 0.5, 2.0, -0.5];

/// The rows of a draw: its uniforms are the same in all of them.
pub(super) fn rows(inputs: &Inputs, others: Others, draw: usize, count: usize) -> Vec<Vec<f32>> {
    let mut random = SplitMix64::new(draw as u64 + 1);
    let uniforms: Vec<Vec<f32>> = inputs.all.iter().map(|input| value(input, others, draw, &[], &mut random)).collect();
    let mut rows = Vec::new();
    for number in 0..count {
        let mut vectors: Vec<(usize, Vec<f32>)> = Vec::new();
        let mut row = Vec::new();
        for (input, uniform) in inputs.all.iter().zip(&uniforms) {
            let value = match input.kind {
                InputKind::Uniform(_) => uniform.clone(),
                InputKind::Vertex { .. } => value(input, others, draw + number, &vectors, &mut random),
            };
            vectors.push((input.size(), value.clone()));
            row.extend(value);
        }
        rows.push(row);
    }
    rows
}

/// A value of an input. `known` are those of inputs before it.
fn value(
    input: &Input,
    others: Others,
    number: usize,
    known: &[(usize, Vec<f32>)],
    random: &mut SplitMix64,
) -> Vec<f32> {
    let (choice, by_chance) = (random.unit(), random.unit());
    let bounds = match (input.stated, others) {
        (Some(Bounds::Unit), _) => return direction(number, input.size(), random),
        (Some(Bounds::Within(range)), _) => Some(range),
        (None, Others::Tame) => return tame(input, random),
        (None, Others::Any) => None,
    };
    let fits = |value: f32| bounds.is_none_or(|[low, high]| (low as f32..=high as f32).contains(&value));
    // Two vectors may be the same, or opposite.
    let twin = known.iter().filter(|(size, _)| *size == input.size() && *size > 1).map(|(_, value)| value);
    let twins: Vec<&Vec<f32>> = twin.collect();
    if choice < 0.25 && !twins.is_empty() && input.scalar == Scalar::Float {
        let pick = (by_chance * twins.len() as f64) as usize;
        let sign = if random.unit() < 0.7 { 1.0 } else { -1.0 };
        let copied: Vec<f32> = twins.get(pick).map_or_else(Vec::new, |twin| twin.iter().map(|n| sign * n).collect());
        if copied.len() == input.size() && copied.iter().all(|value| fits(*value)) {
            return copied;
        }
    }
    if input.is_matrix() && bounds.is_none() {
        return matrix(input, by_chance, random);
    }
    let special = special(input, bounds, number, choice);
    (0..input.size())
        .map(|_| special.unwrap_or_else(|| by_range(input, bounds, by_chance, random)))
        .map(|number| whole(input, number) as f32)
        .collect()
}

/// A number that all components have.
fn special(input: &Input, bounds: Option<[f64; 2]>, number: usize, choice: f64) -> Option<f64> {
    if choice < 0.6 {
        return None;
    }
    match bounds {
        None if input.scalar == Scalar::Float => SPECIAL.get(number % SPECIAL.len()).copied(),
        None => None,
        Some([low, high]) => {
            let inside = SPECIAL.iter().copied().filter(|special| (low..=high).contains(special));
            let all: Vec<f64> = [low, high].into_iter().chain(inside).collect();
            all.get(number % all.len().max(1)).copied()
        }
    }
}

fn by_range(input: &Input, bounds: Option<[f64; 2]>, by_chance: f64, random: &mut SplitMix64) -> f64 {
    let [low, high] = bounds.unwrap_or(match input.scalar {
        Scalar::Float if by_chance < 0.3 => [-10.0, 10.0],
        Scalar::Float => [-1.0, 1.0],
        Scalar::Bool => [0.0, 1.0],
        Scalar::Int | Scalar::Uint => [0.0, 4.0],
    });
    low + random.unit() * (high - low)
}

fn whole(input: &Input, number: f64) -> f64 {
    match input.scalar {
        Scalar::Float => number,
        Scalar::Uint => number.round().max(0.0),
        Scalar::Int | Scalar::Bool => number.round(),
    }
}

/// A matrix near the unit matrix, or anything.
fn matrix(input: &Input, by_chance: f64, random: &mut SplitMix64) -> Vec<f32> {
    let near = by_chance < 0.7;
    let each = input.columns * input.rows;
    (0..input.size())
        .map(|index| {
            let (column, row) = (index % each / input.rows, index % input.rows);
            let unit = if near && column == row { 1.0 } else { 0.0 };
            (unit + (random.unit() - 0.5) * if near { 0.2 } else { 4.0 }) as f32
        })
        .collect()
}

/// A harmless value.
fn tame(input: &Input, random: &mut SplitMix64) -> Vec<f32> {
    if input.is_matrix() {
        return matrix(input, 0.0, random);
    }
    let number = |random: &mut SplitMix64| match input.scalar {
        Scalar::Float => (0.25 + 0.5 * random.unit()) as f32,
        Scalar::Bool => random.unit().round() as f32,
        Scalar::Int | Scalar::Uint => 1.0 + (2.0 * random.unit()).floor() as f32,
    };
    (0..input.size()).map(|_| number(random)).collect()
}

/// A direction: those of the axes, and by chance.
fn direction(number: usize, size: usize, random: &mut SplitMix64) -> Vec<f32> {
    if size > 0 && number.is_multiple_of(4) {
        let axis = number / 4 % (2 * size);
        let sign = if axis.is_multiple_of(2) { 1.0 } else { -1.0 };
        return (0..size).map(|index| if index == axis / 2 { sign } else { 0.0 }).collect();
    }
    let vector: Vec<f64> = (0..size).map(|_| 2.0 * random.unit() - 1.0).collect();
    let length = vector.iter().map(|part| part * part).sum::<f64>().sqrt().max(1e-6);
    vector.iter().map(|part| (part / length) as f32).collect()
}
