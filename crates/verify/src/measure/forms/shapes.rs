//! Closed forms of noise, distances from shapes, and fog.

use super::{Form, InputKind, forms, norm};
use crate::measure::vector::{V, dot, sub};
use crate::measure::{Answer, Args};

/// PCG's output for a state one step after `x`: Jarzynski and Olano, listing of pcg.
fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

fn of_cell([x, y, z]: [i64; 3]) -> u32 {
    let nested = hash((y as u32).wrapping_add(hash(z as u32)));
    hash((x as u32).wrapping_add(nested))
}

fn unit(hash: u32) -> f64 {
    f64::from(hash >> 8) / 16_777_216.0
}

/// Perlin's fade of 2002.
fn fade(t: f64) -> f64 {
    6.0 * t.powi(5) - 15.0 * t.powi(4) + 10.0 * t.powi(3)
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + t * (b - a)
}

/// The coordinates within the range that the module has.
fn place(p: V) -> V {
    p.map(|x| x.clamp(-4_194_304.0, 4_194_304.0))
}

/// The blend of a function of the eight corners, along x, then y, then z.
fn corners(p: V, at: impl Fn([i64; 3], V) -> f64) -> f64 {
    let p = place(p);
    let low = p.map(f64::floor);
    let inside = sub(p, low);
    let corner = |i: i64, j: i64, k: i64| {
        let step = [i, j, k];
        let cell = std::array::from_fn(|axis| low[axis] as i64 + step[axis]);
        at(cell, sub(inside, step.map(|x| x as f64)))
    };
    let [x, y, z] = inside.map(fade);
    let row = |j, k| lerp(corner(0, j, k), corner(1, j, k), x);
    let face = |k| lerp(row(0, k), row(1, k), y);
    lerp(face(0), face(1), z)
}

/// The twelve edges of a cube, and four of them again, in Perlin's order.
const EDGES: [V; 16] = [
    [1.0, 1.0, 0.0],
    [-1.0, 1.0, 0.0],
    [1.0, -1.0, 0.0],
    [-1.0, -1.0, 0.0],
    [1.0, 0.0, 1.0],
    [-1.0, 0.0, 1.0],
    [1.0, 0.0, -1.0],
    [-1.0, 0.0, -1.0],
    [0.0, 1.0, 1.0],
    [0.0, -1.0, 1.0],
    [0.0, 1.0, -1.0],
    [0.0, -1.0, -1.0],
    [1.0, 1.0, 0.0],
    [0.0, -1.0, 1.0],
    [-1.0, 1.0, 0.0],
    [0.0, -1.0, -1.0],
];

fn gradient(p: V) -> f64 {
    corners(p, |cell, d| dot(EDGES[(of_cell(cell) >> 28) as usize], d))
}

/// Gustavson's sum over all corners of the lattice whose kernel reaches the place.
fn simplex(x: f64, y: f64) -> f64 {
    let [x, y, _] = place([x, y, 0.0]);
    let (skew, back) = ((3.0f64.sqrt() - 1.0) / 2.0, (3.0 - 3.0f64.sqrt()) / 6.0);
    let (column, row) = ((x + (x + y) * skew).floor() as i64, (y + (x + y) * skew).floor() as i64);
    let root = 2.0f64.sqrt();
    let directions =
        [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0], [root, 0.0], [-root, 0.0], [0.0, root], [0.0, -root]];
    let mut sum = 0.0;
    for i in column - 1..=column + 2 {
        for j in row - 1..=row + 2 {
            let unskewed = (i + j) as f64 * back;
            let (dx, dy) = (x - (i as f64 - unskewed), y - (j as f64 - unskewed));
            let t = (0.5 - dx * dx - dy * dy).max(0.0);
            let [gx, gy] = directions[(of_cell([i, j, 0]) >> 29) as usize];
            sum += t.powi(4) * (gx * dx + gy * dy);
        }
    }
    (70.0 * sum).clamp(-1.0, 1.0)
}

/// The nearest of the points in the cell of a place and in all cells up to two away: that of its own cell is nearer than 2.
fn worley(p: V) -> f64 {
    let p = place(p);
    let low = p.map(f64::floor);
    let mut nearest = f64::INFINITY;
    for step in 0..125 {
        let to = [step % 5 - 2, step / 5 % 5 - 2, step / 25 - 2];
        let cell = std::array::from_fn(|axis| low[axis] as i64 + to[axis]);
        let first = of_cell(cell);
        let second = hash(first);
        let random = [unit(first), unit(second), unit(hash(second))];
        let point: V = std::array::from_fn(|axis| cell[axis] as f64 + random[axis]);
        nearest = nearest.min(norm(sub(p, point)));
    }
    nearest
}

fn one(value: f64, condition: f64) -> Option<Answer> {
    Some(Answer::new([value], value.abs().max(1.0)).conditioned(condition))
}

fn whole(value: u32) -> Option<Answer> {
    Some(Answer::relative([f64::from(value)]))
}

/// The distance from a box, by the region of its surroundings.
fn boxed(q: &[f64]) -> f64 {
    let outside = q.iter().map(|x| x.max(0.0).powi(2)).sum::<f64>().sqrt();
    if outside > 0.0 { outside } else { q.iter().fold(f64::NEG_INFINITY, |most: f64, x| most.max(*x)) }
}

fn segment(a: &Args<'_>) -> Option<Answer> {
    let ([px, py], [ax, ay], [bx, by], radius) = (a.v2(), a.v2(), a.v2(), a.f());
    let (dx, dy) = (bx - ax, by - ay);
    let square = dx * dx + dy * dy;
    if square < 1e-12 {
        return None;
    }
    let along = ((px - ax) * dx + (py - ay) * dy) / square;
    let distance = match along {
        t if t <= 0.0 => (px - ax).hypot(py - ay),
        t if t >= 1.0 => (px - bx).hypot(py - by),
        _ => ((px - ax) * dy - (py - ay) * dx).abs() / square.sqrt(),
    };
    one(distance - radius, 32.0 + 16.0 / square.sqrt())
}

fn mean(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { -(-x).exp_m1() / x }
}

fn ground_fog(a: &Args<'_>) -> Option<Answer> {
    let (height, [_, up, _], r, density, falloff) = (a.f(), a.d(), a.f(), a.f(), a.f());
    let x = falloff * r * up;
    // Rounding moves the ends of the ray.
    let exponents = x.abs() + (falloff * height).abs();
    let depth = density * (-falloff * height).exp() * r * mean(x);
    let value = (-depth).exp();
    one(value, 8.0 + value * depth * (16.0 + 4.0 * exponents))
}

pub(super) static FORMS: &[Form] = forms! {
    "noise" "noiseHash(uint)" [Cell] |a| whole(hash(a.f() as u32));
    "noise" "noiseHash(ivec3)" [Cell3] |a| whole(of_cell(a.v().map(|x| x as i64)));
    "noise" "noiseUnit(uint)" [Cell] |a| one(unit(a.f() as u32), 1.0);
    "noise" "noisePlace(vec3)" [Place] |a| Some(Answer::relative(a.v()));
    "noise" "noiseValue(vec3)" [Place] |a| one(corners(a.v(), |cell, _| unit(of_cell(cell))), 8.0);
    "noise" "noiseGradient(vec3)" [Place] |a| one(gradient(a.v()), 16.0);
    "noise" "noiseSimplex(vec2)" [Place2] |a| one(simplex(a.f(), a.f()), 256.0);
    "noise" "noiseWorley(vec3)" [Place] |a| one(worley(a.v()), 8.0);
    "noise" "noiseFractal(vec3,int)" [Place, Octaves] |a| {
        let (p, octaves) = (a.v(), (a.f() as i32).clamp(1, 16));
        let octave = |i: i32| gradient(p.map(|x| x * 2.0f64.powi(i))) / 2.0f64.powi(i);
        one((0..octaves).map(octave).sum(), 32.0)
    };
    "sdf" "sdfCircle(vec2,float)" [Two, Gain] |a| {
        let [x, y] = a.v2();
        one(x.hypot(y) - a.f(), 4.0)
    };
    "sdf" "sdfBox(vec2,vec2)" [Two, Gain, Gain] |a| {
        let (p, b) = (a.v2(), a.v2());
        one(boxed(&[p[0].abs() - b[0], p[1].abs() - b[1]]), 4.0)
    };
    "sdf" "sdfBox(vec3,vec3)" [Point, Color] |a| {
        let (p, b) = (a.v(), a.v());
        one(boxed(&sub(p.map(f64::abs), b)), 4.0)
    };
    "sdf" "sdfSegment(vec2,vec2,vec2,float)" [Two, Two, Two, Gain] segment;
    "sdf" "sdfTorus(vec3,float,float)" [Point, Gain, Gain] |a| {
        let ([x, y, z], radius) = (a.v(), a.f());
        one((x.hypot(z) - radius).hypot(y) - a.f(), 8.0)
    };
    "sdf" "sdfBlend(float,float,float)" [Signed, Signed, Gain] |a| {
        let (x, y, k) = (a.f(), a.f(), a.f());
        let h = (k - (x - y).abs()).max(0.0);
        one(x.min(y) - if k > 0.0 { h * h / (4.0 * k) } else { 0.0 }, 8.0)
    };
    "sdf" "sdfCoverage(float,float)" [Signed, Unit] |a| {
        let (d, width) = (a.f(), a.f());
        if width == 0.0 { return Some(Answer::new([if d < 0.0 { 1.0 } else { 0.0 }], 1.0).jumping(d.abs())); }
        one((0.5 - d / width).clamp(0.0, 1.0), 4.0)
    };
    "fog" "fogMean(float)" [Stops] |a| {
        let x = a.f();
        Some(Answer::relative([mean(x)]).conditioned(8.0 + 2.0 * x.abs()))
    };
    "fog" "fogFactor(float,float)" [White, Unit] |a| {
        let depth = a.f() * a.f();
        one((-depth).exp(), 4.0 + depth * (-depth).exp())
    };
    "fog" "fogFactorSquared(float,float)" [White, Unit] |a| {
        let depth = (a.f() * a.f()).powi(2);
        one((-depth).exp(), 4.0 + 4.0 * depth * (-depth).exp())
    };
    "fog" "fogFactor(float,vec3,float,float,float)" [White, Direction, White, Gain, Gain] ground_fog;
};
