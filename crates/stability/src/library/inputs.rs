//! [`fill`]: stiff and extreme inputs for each kind of parameter.
//!
//! *In:* the kinds of a function's parameters. *Out:* numbers for one call: half of them ordinary, half at the places where
//! the models are stiff. *Holds:* the same numbers on every run; what the model demands (unit vectors, exponents from 0 on)
//! holds, and no number is subnormal, since GPUs take those for 0.

use glisten_verify::measure::vector::{V, add, cross, dot, scale, sub, unit};
use glisten_verify::measure::{InputKind, Random};

/// Distances from a stiff place, as angles or relative to 1.
static NEAR: &[f64] = &[0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];
static EXPONENTS: &[f64] = &[0.0, 1e-3, 0.5, 1.0, 2.0, 32.0, 128.0, 1e3, 1e4, 1e5, 1e6];
static DISTANCES: &[f64] =
    &[0.0, 1e-30, 1e-20, 1e-19, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12, 1e18, 1e19, 1e20, 1e30, 3e38];
static SIZES: &[f64] = &[0.0, 1e-37, 1e-30, 1e-20, 1e-10, 1e-3, 1.0, 1e3, 1e10, 1.8e19, 1e20, 1e30, 3e38];
static COLORS: &[f64] = &[0.0, 1e-30, 1e-6, 1e-3, 0.5, 1.0];
static INTENSITIES: &[f64] = &[0.0, 1e-6, 1.0, 4.0, 1e4];
static UNITS: &[f64] =
    &[0.0, 1e-30, 1e-7, 1e-3, 0.25, 0.5, 0.875, 1.0 - 1e-3, 1.0 - 1e-6, 1.0 - 1.0 / 16_777_216.0, 1.0];

/// Appends the numbers of a kind.
pub(super) fn fill(kind: InputKind, random: &mut Random, to: &mut Vec<f64>) {
    let start = to.len();
    if random.once_in(2) {
        random.fill(kind, to);
    } else {
        stiff(kind, random, to);
    }
    let is_whole = matches!(kind, InputKind::Cell | InputKind::Cell3 | InputKind::Octaves);
    let whole = match kind {
        InputKind::Light => 1,
        _ if is_whole => usize::MAX,
        _ => 0,
    };
    for number in to.iter_mut().skip(start).take(whole) {
        // Whole numbers stay the same if they are moved by an ULP.
        *number = number.trunc() + if *number < 0.0 { -0.25 } else { 0.25 };
    }
}

/// Appends numbers at a stiff place of the kind.
fn stiff(kind: InputKind, random: &mut Random, to: &mut Vec<f64>) {
    match kind {
        InputKind::Any => to.push(sized(random)),
        InputKind::Any3 => to.extend([sized(random), sized(random), sized(random)]),
        InputKind::Any4 => to.extend([sized(random), sized(random), sized(random), sized(random)]),
        InputKind::Unit => to.push(random.pick(UNITS)),
        InputKind::Signed => to.push(signed(random, UNITS)),
        InputKind::Distance01 => {
            to.push(random.pick(&[0.0, 1e-30, 1e-12, 1e-8, 1e-7, 1e-3, 0.125, 0.1250001, 0.5, 1.0]))
        }
        InputKind::Exponent => to.push(random.pick(EXPONENTS)),
        InputKind::Size => to.push(random.pick(&[1.0, 2.0, 3.0, 256.0, 4096.0])),
        InputKind::Direction => to.extend(axis(random)),
        InputKind::Near => to.extend(pair(random, 1.0)),
        InputKind::Opposed => to.extend(pair(random, -1.0)),
        InputKind::Lighting => to.extend(lighting(random).into_iter().flatten()),
        InputKind::Color => to.extend([random.pick(COLORS), random.pick(COLORS), random.pick(COLORS)]),
        InputKind::Intensity => {
            to.extend([random.pick(INTENSITIES), random.pick(INTENSITIES), random.pick(INTENSITIES)])
        }
        InputKind::Gain => to.push(random.pick(&[0.0, 1e-6, 1.0, 2.0])),
        InputKind::Width => to.push(random.pick(&[0.0, 1e-7, 1e-4, 0.01, 0.5])),
        InputKind::Distance => to.push(random.pick(DISTANCES)),
        InputKind::Weights => to.extend(weights(random)),
        InputKind::Point => to.extend(point(random, to)),
        InputKind::Vector => {
            let size = random.pick(SIZES);
            to.extend(scale(size, random.direction()));
        }
        InputKind::Light => light(random, to),
        InputKind::Material => material(random, to),
        InputKind::Matrix3 => matrix(random, 3, to),
        InputKind::Matrix4 => matrix(random, 4, to),
        InputKind::Clip => {
            let w = random.pick(&[1e-30, 1e-6, 1e-3, 1.0, 1e3, 1e6]);
            to.extend([random.range(-1.0, 1.0) * w, random.range(-1.0, 1.0) * w, random.range(-1.0, 1.0) * w, w]);
        }
        InputKind::Four => {
            to.extend([signed(random, COLORS), signed(random, COLORS), signed(random, COLORS), signed(random, COLORS)])
        }
        InputKind::Two => to.extend(triangle_corner(random, to)),
        InputKind::Barycentric => {
            to.extend(random.pick(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.5], [1e-7, 1e-7], [1.0 - 1e-6, 5e-7]]))
        }
        InputKind::Depths => {
            const DEPTHS: &[f64] = &[1e-30, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e30];
            to.extend([random.pick(DEPTHS), random.pick(DEPTHS), random.pick(DEPTHS)]);
        }
        InputKind::SegmentEnd => {
            let z = random.pick(&[1e-6, 1e-3, 1.0, 1e3, 1e6]);
            to.extend([random.range(-2.0, 2.0) * z, z]);
        }
        InputKind::Alpha => to.push(random.pick(&[1e-6, 1e-5, 1e-4, 1e-3, 0.01, 0.25, 0.999_999, 1.0])),
        InputKind::Index => {
            to.push(random.pick(&[1e-3, 0.5, 1.0 - 1e-4, 1.0 - 1e-6, 1.0, 1.0 + 1e-6, 1.0 + 1e-4, 1.5, 2.4, 1e3]))
        }
        InputKind::Metal => {
            const INDICES: &[f64] = &[1e-3, 0.05, 0.2, 1.0, 4.0, 10.0, 1e3];
            to.extend([random.pick(INDICES), random.pick(INDICES), random.pick(INDICES)]);
        }
        InputKind::Film => to.push(random.pick(&[0.0, 0.01, 0.02, 0.03, 1.0, 100.0, 400.0, 1200.0, 1e4, 1e6])),
        InputKind::Tangent => {
            let n = any_direction(random);
            to.extend(n);
            to.extend(across(random, n));
        }
        InputKind::Bright => {
            const BRIGHT: &[f64] = &[0.0, 1e-30, 1e-6, 1e-3, 0.08, 0.18, 0.76, 1.0, 16.0, 1e4, 1e10];
            to.extend([random.pick(BRIGHT), random.pick(BRIGHT), random.pick(BRIGHT)]);
        }
        InputKind::White => to.push(random.pick(&[0.25, 1.0, 4.0, 11.2, 1e4])),
        InputKind::Stops => to.push(random.pick(&[-64.0, -16.0, 0.0, 15.0, 64.0])),
        InputKind::Kelvin => to.push(random.pick(&[1000.0, 1900.0, 2856.0, 6504.0, 15000.0])),
        InputKind::Pixel => {
            const PLACES: &[f64] = &[0.0, 0.5, 7.5, 8.0, 4095.5, 65535.5];
            to.extend([random.pick(PLACES), random.pick(PLACES)]);
        }
        InputKind::Cell => to.push(random.pick(&[0.0, 1.0, 2.0, 65535.0, 16_777_215.0])),
        InputKind::Cell3 => {
            const CELLS: &[f64] = &[-1_048_576.0, -1.0, 0.0, 1.0, 1_048_575.0];
            to.extend([random.pick(CELLS), random.pick(CELLS), random.pick(CELLS)]);
        }
        InputKind::Place => to.extend([cell_place(random), cell_place(random), cell_place(random)]),
        InputKind::Place2 => to.extend([cell_place(random), cell_place(random)]),
        InputKind::Octaves => to.push(random.pick(&[1.0, 4.0, 6.0])),
        InputKind::Ends => {
            to.extend(random.pick(&[[1.0, 2.0, 3.0, 4.0], [0.25, 1.0, 11.2, 1e4], [1e-3, 1.0, 4.0, 1e6]]))
        }
        InputKind::Warp => {
            // The rows of smooth surfaces, and an eye at the horizon.
            let matrix = random.pick(&[
                [1.0, 0.0, 0.0, 1e-4],
                [0.6, 0.5, -1e-4, 1e-4],
                [0.01, 0.1, -1e-3, 1e-4],
                [1.0, 0.0, 0.0, 1.0],
            ]);
            random.warp(matrix, to);
        }
        InputKind::Corners => {
            let (size, count) = (random.pick(&[0.0, 1e-6, 1.0, 1e6, 1e20]), random.pick(&[3, 4, 16]));
            let center = scale(random.pick(&[0.0, 1e-6, 1.0]), any_direction(random));
            random.corners(center, size, count, to);
        }
        InputKind::Harmonics => (0..27).for_each(|_| to.push(signed(random, COLORS))),
    }
}

fn signed(random: &mut Random, sizes: &[f64]) -> f64 {
    let size = random.pick(sizes);
    if random.once_in(2) { -size } else { size }
}

/// A place at or next to the border of a cell, near the origin or far from it.
fn cell_place(random: &mut Random) -> f64 {
    let border = random.pick(&[-1000.0, -1.0, 0.0, 1.0, 7.0, 1000.0]);
    border + signed(random, &[0.0, 1e-6, 1e-3, 0.5])
}

fn sized(random: &mut Random) -> f64 {
    signed(random, SIZES)
}

fn axis(random: &mut Random) -> V {
    random.pick(&[
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [0.0, -1.0, 0.0],
        [-1.0, 0.0, 0.0],
    ])
}

/// A direction, or an axis, whose numbers are exact.
fn any_direction(random: &mut Random) -> V {
    if random.once_in(2) { axis(random) } else { random.direction() }
}

/// A direction at right angles to `a`.
fn across(random: &mut Random, a: V) -> V {
    unit(cross(
        a,
        loop {
            let b = any_direction(random);
            if dot(a, b).abs() < 0.9 {
                break b;
            }
        },
    ))
}

/// `sign a`, turned by a small angle.
fn turned(random: &mut Random, a: V, sign: f64) -> V {
    let angle = random.pick(NEAR);
    let side = across(random, a);
    add(scale(sign * angle.cos(), a), scale(angle.sin(), side))
}

/// Two directions that are nearly equal or opposite, or at right angles.
fn pair(random: &mut Random, sign: f64) -> [f64; 6] {
    let a = any_direction(random);
    let b = if random.once_in(4) {
        let grazing = across(random, a);
        turned(random, grazing, 1.0)
    } else {
        turned(random, a, sign)
    };
    joined([a, b])
}

fn joined([a, b]: [V; 2]) -> [f64; 6] {
    [a[0], a[1], a[2], b[0], b[1], b[2]]
}

/// Normal, light and eye at the places where the models are stiff.
fn lighting(random: &mut Random) -> [V; 3] {
    let n = any_direction(random);
    let l = match random.below(4) {
        0 => turned(random, n, 1.0),
        1 => {
            let grazing = across(random, n);
            turned(random, grazing, 1.0)
        }
        2 => turned(random, n, -1.0),
        _ => any_direction(random),
    };
    let mirror = sub(scale(2.0 * dot(n, l), n), l);
    let v = match random.below(5) {
        0 => turned(random, l, 1.0),
        1 => turned(random, l, -1.0),
        2 => turned(random, mirror, 1.0),
        3 => turned(random, n, 1.0),
        _ => across(random, n),
    };
    [n, l, unit(v)]
}

fn weights(random: &mut Random) -> V {
    const WEIGHTS: &[f64] = &[0.0, 0.0, 1e-6, 0.01, 1.0, 1e6];
    let s = [random.pick(WEIGHTS), random.pick(WEIGHTS), random.pick(WEIGHTS)];
    if s == [0.0; 3] { [1.0, 0.0, 0.0] } else { s }
}

/// A point far away, or close to the point before it.
fn point(random: &mut Random, before: &[f64]) -> V {
    if random.once_in(2)
        && let Some(&[x, y, z]) = before.last_chunk()
    {
        let size = random.pick(&[0.0, 1e-6, 1e-3, 1.0]) * x.abs().max(y.abs()).max(z.abs()).max(1e-20);
        return add([x, y, z], scale(size, random.direction()));
    }
    let size = random.pick(&[0.0, 1e-20, 1e-6, 1.0, 1e4, 1e6, 1e18, 1e20]);
    scale(size, random.direction())
}

/// A corner of a triangle that may be far from the origin, thin or without area.
fn triangle_corner(random: &mut Random, before: &[f64]) -> [f64; 2] {
    match before {
        [x, y, ..] if random.once_in(2) => {
            let step = random.pick(&[0.0, 1e-4, 1e-2, 1.0]);
            [x + step * random.range(-1.0, 1.0), y + step * random.range(-1.0, 1.0)]
        }
        _ => [random.pick(&[-2.0, 0.0, 0.5, 1.0, 16.0]), random.pick(&[-2.0, 0.0, 0.5, 1.0, 16.0])],
    }
}

fn light(random: &mut Random, to: &mut Vec<f64>) {
    to.push(random.below(4) as f64);
    to.extend(point(random, &[]));
    let length = random.pick(&[1e-30, 1e-10, 1.0, 1e10, 1e30]);
    to.extend(scale(length, any_direction(random)));
    (0..3).for_each(|_| to.extend([random.pick(INTENSITIES), random.pick(INTENSITIES), random.pick(INTENSITIES)]));
    to.extend(weights(random));
    to.push(random.pick(EXPONENTS));
}

fn material(random: &mut Random, to: &mut Vec<f64>) {
    (0..3).for_each(|_| to.extend([random.pick(COLORS), random.pick(COLORS), random.pick(COLORS)]));
    to.push(random.pick(EXPONENTS));
    to.extend([random.pick(COLORS), random.pick(COLORS), random.pick(COLORS)]);
}

/// A rotation whose columns are stretched, flat or nearly so.
fn matrix(random: &mut Random, size: usize, to: &mut Vec<f64>) {
    let x = any_direction(random);
    let y = across(random, x);
    let columns = [x, y, cross(x, y)];
    const STRETCH: &[f64] = &[0.0, 1e-10, 1e-3, 1.0, 1e3, 1e10];
    for column in columns {
        to.extend(scale(random.pick(STRETCH), column));
        to.extend((3..size).map(|_| 0.0));
    }
    (3..size).for_each(|_| to.extend([random.range(-2.0, 2.0), random.range(-2.0, 2.0), random.range(-2.0, 2.0), 1.0]));
}
