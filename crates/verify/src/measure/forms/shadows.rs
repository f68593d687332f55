//! Closed forms of shadows from a map of depths, after Reeves, Salesin and Cook, and after Fernando.

use super::ltc::moved;
use super::today::spiral;
use super::{Form, InputKind, forms};
use crate::measure::{Answer, Args, TABLE, texel};
use std::cell::Cell;

/// The test table as a map, and how near the nearest of its comparisons came to a tie.
struct Map {
    tie: Cell<f64>,
}

/// A surface under a filter: a place, its slope, and the taps.
struct Surface {
    place: [f64; 3],
    slope: [f64; 2],
    count: f64,
    turn: f64,
}

impl Map {
    fn new() -> Self {
        Self { tie: Cell::new(f64::INFINITY) }
    }

    /// The part that blocks the light and the sum of its depths, linear between the texels of a row.
    fn blocked(&self, [x, _, depth]: [f64; 3]) -> [f64; 2] {
        let at = (x.clamp(0.0, 1.0) * TABLE as f64 - 0.5).clamp(0.0, (TABLE - 1) as f64);
        let t = at.fract();
        let mut sum = [0.0, 0.0];
        for (index, weight) in [(at as usize, 1.0 - t), (at as usize + 1, t)] {
            let found = f64::from(texel(index.min(TABLE - 1))[0]);
            self.tie.set(self.tie.get().min((found - depth).abs() / (1.0 + depth.abs())));
            if found < depth {
                sum = [sum[0] + weight, sum[1] + weight * found];
            }
        }
        sum
    }

    /// The mean of both over a disk.
    fn over(&self, surface: &Surface, radius: f64) -> [f64; 2] {
        let ([x, y, z], [u, v], n) = (surface.place, surface.slope, surface.count);
        let mut sum = [0.0, 0.0];
        for index in 0..n as usize {
            let [i, j] = spiral(index as f64, n, surface.turn).map(|s| s * radius.clamp(0.0, 1.0));
            let [part, depths] = self.blocked([x + i, y + j, z + u * i + v * j]);
            sum = [sum[0] + part / n, sum[1] + depths / n];
        }
        sum
    }

    /// Fernando's three steps; `width` is the radius of the filter for a depth that blocks.
    fn soft(&self, surface: &Surface, search: f64, width: impl Fn(f64) -> f64) -> f64 {
        let [part, depths] = self.over(surface, search);
        if part <= 0.0 {
            return 1.0;
        }
        let [blocked, _] = self.over(surface, width(depths / part));
        1.0 - blocked * (part * surface.count).min(1.0)
    }
}

fn place(a: &Args<'_>) -> Surface {
    Surface { place: a.v(), slope: a.v2(), count: 1.0, turn: 0.0 }
}

/// The taps of a surface.
fn taps(surface: Surface, a: &Args<'_>) -> Surface {
    Surface { count: a.f().round().clamp(1.0, 64.0), turn: a.f(), ..surface }
}

/// A value of a map with the distance from the next tie.
fn compared(a: &Args<'_>, value: impl Fn(&Map, &Args<'_>) -> f64) -> Option<Answer> {
    let map = Map::new();
    value(&map, &Args::of(a.numbers));
    let answer = moved(a, |a| value(&Map::new(), a))?;
    let condition = answer.condition + 2.0 * TABLE as f64;
    // The depth at a tap is a sum of three numbers.
    Some(answer.conditioned(condition).jumping(map.tie.get() / 8.0))
}

/// The distance along the axis of a perspective camera, from its matrix.
fn distance(depth: f64, near: f64, far: f64) -> f64 {
    let clip = 2.0 * depth - 1.0;
    2.0 * near * far / (far + near - clip * (far - near))
}

fn lamp(map: &Map, a: &Args<'_>) -> f64 {
    let (surface, near, far, size) = (place(a), a.f(), a.f(), a.f());
    let far = far.max(near);
    let surface = taps(surface, a);
    let r = distance(surface.place[2], near, far);
    let width = |b: f64| 0.5 * (r - b).max(0.0) * size / b / r;
    map.soft(&surface, width(near), |depth| width(distance(depth, near, far)))
}

fn sun(map: &Map, a: &Args<'_>) -> f64 {
    let (surface, size) = (place(a), a.f());
    let surface = taps(surface, a);
    let depth = surface.place[2];
    map.soft(&surface, size * depth, |b| size * (depth - b).max(0.0))
}

/// Cramer's rule.
fn slope(a: &Args<'_>) -> Option<Answer> {
    let (x, y) = (a.v(), a.v());
    let d = x[0] * y[1] - x[1] * y[0];
    let size = (x[0].hypot(x[1]) * y[0].hypot(y[1])).max(f64::MIN_POSITIVE);
    if d.abs() < 1e-4 * size {
        return None;
    }
    let found = [(x[2] * y[1] - y[2] * x[1]) / d, (y[2] * x[0] - x[2] * y[0]) / d];
    let steep = found[0].abs().max(found[1].abs()).max(1.0);
    let condition = 8.0 * (size / d.abs()).powi(2) * (1.0 + (x[2].abs() + y[2].abs()) / size.sqrt().min(1.0)) * steep;
    Some(Answer::new(found.map(|s| s.clamp(-16.0, 16.0)), 16.0).conditioned(condition))
}

pub(super) static FORMS: &[Form] = forms! {
    "shadow" "shadowBlocked(sampler2D,vec3)" [Color] |a| {
        let map = Map::new();
        let sum = map.blocked(a.v());
        Some(Answer::new(sum, 1.0).conditioned(2.0 * TABLE as f64).jumping(map.tie.get()))
    };
    "shadow" "shadowMoved(vec3,vec2,vec2)" [Color, Two, Two] |a| {
        let ([x, y, z], [u, v], [i, j]) = (a.v(), a.v2(), a.v2());
        Some(Answer::new([x + i, y + j, z + u * i + v * j], 8.0))
    };
    "shadow" "shadowSlope(vec3,vec3)" [Vector, Vector] slope;
    "shadow" "shadowPercentageCloser(sampler2D,vec3,vec2,float,int,float)" [Color, Two, Unit, Octaves, Signed]
        |a| compared(a, |map, a| {
            let (surface, radius) = (place(a), a.f());
            1.0 - map.over(&taps(surface, a), radius)[0]
        });
    "shadow" "shadowBlockers(sampler2D,vec3,vec2,float,int,float)" [Color, Two, Unit, Octaves, Signed] |a| {
        let (surface, radius) = (place(a), a.f());
        let map = Map::new();
        let [part, depths] = map.over(&taps(surface, a), radius);
        if part <= 0.0 { return Some(Answer::new([0.0, 0.0], 1.0).jumping(map.tie.get() / 8.0)); }
        // How a part moves by its weights, and the mean of a small part with it.
        let condition = 8.0 * TABLE as f64 * (1.0 + 0.1 / part);
        Some(Answer::new([depths / part, part], 1.0).conditioned(condition).jumping(map.tie.get() / 8.0))
    };
    "shadow" "shadowDistance(float,vec2)" [Unit, White, White] |a| {
        let (depth, near, far) = (a.f(), a.f(), a.f());
        let (far, d) = (far.max(near), 1.0 - depth);
        Some(Answer::relative([near * far / (d * far + depth * near)]).conditioned(4.0 + 4.0 * far / near))
    };
    "shadow" "shadowWithin(sampler2D,vec3,vec2,vec2,float,int,float)" [Color, Two, Unit, Unit, Unit, Octaves, Signed]
        |a| compared(a, |map, a| {
            let (surface, [_, part], radius) = (place(a), a.v2(), a.f());
            let surface = taps(surface, a);
            1.0 - map.over(&surface, radius)[0] * (part * surface.count).min(1.0)
        });
    "shadow" "shadowSoftLamp(sampler2D,vec3,vec2,vec2,float,int,float)" [Color, Two, White, White, Gain, Octaves, Signed]
        |a| compared(a, lamp);
    "shadow" "shadowSoftSun(sampler2D,vec3,vec2,float,int,float)" [Color, Two, Gain, Octaves, Signed]
        |a| compared(a, sun);
};
