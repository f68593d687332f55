//! Inputs for the value tests: random numbers from a fixed seed, including the edge cases of each kind.

use super::vector::{V, add, scale, unit};
use glisten_scene::random::SplitMix64;

/// The kind of values for a parameter, or for a few that belong together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// Any number that a float can represent, including 0.
    Any,
    /// Three such numbers.
    Any3,
    /// Four such numbers.
    Any4,
    /// 0 to 1, including the ends and their neighbors.
    Unit,
    /// -1.5 to 1.5.
    Signed,
    /// 1e-12 to 1, uniform in the logarithm: a distance from 1.
    Distance01,
    /// An exponent: 0, or 0.5 to 1e6, uniform in the logarithm.
    Exponent,
    /// The size of a table: 1 to 4096.
    Size,
    /// A unit vector, sometimes along an axis.
    Direction,
    /// Two unit vectors, mostly close to each other: 1e-6 to 2 radians.
    Near,
    /// Two unit vectors, the first mostly close to the opposite of the other.
    Opposed,
    /// A unit normal, and unit vectors towards the light and the eye, mostly close to the mirror direction.
    Lighting,
    /// A reflectance: three numbers from 0 to 1.
    Color,
    /// The intensity of a light: three numbers from 0 to 4.
    Intensity,
    /// 0 to 2.
    Gain,
    /// 0, or 0.01 to 0.5: half the extent of a ramp.
    Width,
    /// A distance: 2^-30 to 2^30, uniform in the logarithm.
    Distance,
    /// Weights of (96): sometimes 0, but never all of them.
    Weights,
    /// A point within 10 of the origin.
    Point,
    /// A vector of length 1e-6 to 1e6.
    Vector,
    /// The members of the library's `Light`.
    Light,
    /// The members of the library's `Material`.
    Material,
    /// Nine numbers from -2 to 2.
    Matrix3,
    /// Sixteen such numbers.
    Matrix4,
    /// A point in clip space with w from 0.1 to 10.
    Clip,
    /// Four numbers from -2 to 2.
    Four,
    /// Two numbers from -2 to 2.
    Two,
    /// Coordinates in a triangle: u, v >= 0, u + v <= 1.
    Barycentric,
    /// Three positive numbers, 1e-3 to 1e3.
    Depths,
    /// An end point of a segment: x within 2, z from 0.1 to 100.
    SegmentEnd,
    /// The width of a microfacet model: 1e-6 to 1, uniform in the logarithm.
    Alpha,
    /// A quotient of refractive indices: 0.3 to 3, mostly near 1.
    Index,
    /// The refractive indices of a metal by channel: 0.05 to 10.
    Metal,
    /// The thickness of a film in nanometers: 10 to 3000, uniform in the logarithm.
    Film,
    /// A unit normal and a unit tangent at right angles to it.
    Tangent,
    /// A color of a scene: three numbers from 1e-6 to 1e4, uniform in the logarithm, or 0.
    Bright,
    /// The channel that becomes white: 0.25 to 64.
    White,
    /// An exposure value: -16 to 24.
    Stops,
    /// A temperature: 1000 to 15000 K.
    Kelvin,
    /// A place in a window of 4096 by 4096 pixels.
    Pixel,
    /// A whole number below 2^24.
    Cell,
    /// Three whole numbers, -1000 to 1000.
    Cell3,
    /// A place within 64 of the origin.
    Place,
    /// A place in the plane within 64 of the origin.
    Place2,
    /// 1 to 6 octaves.
    Octaves,
    /// The inverse matrix of a linearly transformed cosine times a frame: nine numbers, by columns.
    Warp,
    /// Sixteen corners of which the first ones are a flat convex light, how many these are, and how they turn.
    Corners,
    /// The far ends of four cascades, growing.
    Ends,
    /// Nine coefficients of spherical harmonics for each channel, -2 to 2.
    Harmonics,
}

/// Random numbers from a fixed seed (splitmix64).
pub struct Random(SplitMix64);

impl Random {
    /// Numbers that a seed determines.
    pub fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    fn next(&mut self) -> u64 {
        self.0.bits()
    }

    /// 0 to 1, excluding 1.
    pub(crate) fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// From `low` to `high`, excluding `high`.
    pub fn range(&mut self, low: f64, high: f64) -> f64 {
        low + self.unit() * (high - low)
    }

    /// Uniform in the logarithm.
    pub(crate) fn spread(&mut self, low: f64, high: f64) -> f64 {
        (self.range(low.ln(), high.ln())).exp()
    }

    /// An integer from 0 to `count` - 1; 0 if `count` is 0.
    pub fn below(&mut self, count: u64) -> u64 {
        self.next() % count.max(1)
    }

    /// Whether an event of probability 1 / `count` happens.
    pub fn once_in(&mut self, count: u64) -> bool {
        self.below(count) == 0
    }

    /// An element of the list; the default of its type if it is empty.
    pub fn pick<T: Copy + Default>(&mut self, list: &[T]) -> T {
        list.get(self.below(list.len() as u64) as usize).copied().unwrap_or_default()
    }

    /// A vector of length 1, one in 16 of which is along an axis.
    pub fn direction(&mut self) -> V {
        if self.once_in(16) {
            let mut axis = [0.0; 3];
            let place = self.below(3) as usize;
            axis.iter_mut().skip(place).take(1).for_each(|x| *x = if self.once_in(2) { -1.0 } else { 1.0 });
            return axis;
        }
        loop {
            let v = [self.range(-1.0, 1.0), self.range(-1.0, 1.0), self.range(-1.0, 1.0)];
            let square = super::vector::dot(v, v);
            if (0.01..=1.0).contains(&square) {
                return unit(v);
            }
        }
    }

    /// A direction about `radians` away from `a`.
    pub(crate) fn near(&mut self, a: V, radians: f64) -> V {
        unit(add(a, scale(radians, self.direction())))
    }

    /// A direction in the half space of `n`.
    fn above(&mut self, n: V) -> V {
        let a = self.direction();
        if super::vector::dot(a, n) < 0.0 { scale(-1.0, a) } else { a }
    }

    fn lighting(&mut self) -> [V; 3] {
        let n = self.direction();
        if self.once_in(8) {
            return [n, self.direction(), self.direction()];
        }
        let l = self.above(n);
        let mirror = super::vector::sub(scale(2.0 * super::vector::dot(n, l), n), l);
        let radians = self.spread(1e-5, 1.0);
        [n, l, self.near(mirror, radians)]
    }

    /// The numbers of a cosine's inverse matrix with a frame behind it.
    pub fn warp(&mut self, [a, b, c, d]: [f64; 4], to: &mut Vec<f64>) {
        let n = self.direction();
        let side = loop {
            let side = super::vector::cross(n, self.direction());
            if super::vector::norm(side) > 0.1 {
                break unit(side);
            }
        };
        let x = super::vector::cross(side, n);
        let rows = [add(scale(a, x), scale(b, n)), side, add(scale(c, x), scale(d, n))];
        to.extend((0..9).filter_map(|at: usize| rows.get(at % 3)?.get(at / 3).copied()));
    }

    /// Corners of an ellipse around a point, in order, and their number.
    pub fn corners(&mut self, center: V, size: f64, count: u64, to: &mut Vec<f64>) {
        let (x, y) = (scale(size, self.direction()), scale(size, self.direction()));
        for corner in 0..16 {
            let turn = (corner as f64 + self.range(0.0, 0.9)) / count as f64 * std::f64::consts::TAU;
            let place = add(center, add(scale(turn.cos(), x), scale(turn.sin(), y)));
            to.extend(place);
        }
        // A quarter more stays the same number of corners if it is moved by an ULP.
        to.push(count as f64 + 0.25);
        to.push(super::vector::dot(center, super::vector::cross(x, y)).signum());
    }

    fn weights(&mut self) -> V {
        loop {
            let weight = |random: &mut Self| if random.once_in(3) { 0.0 } else { random.spread(1e-3, 10.0) };
            let s = [weight(self), weight(self), weight(self)];
            if s != [0.0; 3] {
                return s;
            }
        }
    }

    fn any(&mut self) -> f64 {
        if self.once_in(16) {
            return 0.0;
        }
        let size = self.spread(2e-38, 3.3e38);
        if self.once_in(2) { -size } else { size }
    }

    fn exponent(&mut self) -> f64 {
        if self.once_in(16) { 0.0 } else { self.spread(0.5, 1e6) }
    }

    fn light(&mut self, to: &mut Vec<f64>) {
        to.push(self.below(4) as f64);
        to.extend(self.range3(10.0));
        to.extend(scale(self.spread(1e-3, 1e3), self.direction()));
        (0..3).for_each(|_| to.extend(self.positive3(4.0)));
        to.extend([self.range(0.1, 1.0), self.range(0.0, 0.5), self.range(0.0, 0.1)]);
        to.push(self.spread(1.0, 100.0));
    }

    fn range3(&mut self, size: f64) -> V {
        [self.range(-size, size), self.range(-size, size), self.range(-size, size)]
    }

    fn positive3(&mut self, size: f64) -> V {
        [self.range(0.0, size), self.range(0.0, size), self.range(0.0, size)]
    }

    /// Appends the numbers of a kind, before rounding to f32.
    pub fn fill(&mut self, kind: InputKind, to: &mut Vec<f64>) {
        const NEAR_ONE: f64 = 1.0 - 1.0 / 16_777_216.0;
        match kind {
            InputKind::Any => to.push(self.any()),
            InputKind::Any3 => to.extend([self.any(), self.any(), self.any()]),
            InputKind::Any4 => to.extend([self.any(), self.any(), self.any(), self.any()]),
            InputKind::Unit if self.once_in(8) => to.push(self.pick(&[0.0, 1.0, NEAR_ONE, 0.5, 1e-30])),
            InputKind::Unit => to.push(self.unit()),
            InputKind::Signed => to.push(self.range(-1.5, 1.5)),
            InputKind::Distance01 => to.push(self.spread(1e-12, 1.0)),
            InputKind::Exponent => to.push(self.exponent()),
            InputKind::Size => to.push(self.spread(1.0, 4097.0).floor()),
            InputKind::Direction => to.extend(self.direction()),
            InputKind::Near => {
                let (a, radians) = (self.direction(), self.spread(1e-6, 2.0));
                to.extend(a);
                to.extend(self.near(a, radians));
            }
            InputKind::Opposed => {
                let (a, radians) = (self.direction(), self.spread(1e-6, 2.0));
                to.extend(a);
                to.extend(self.near(scale(-1.0, a), radians));
            }
            InputKind::Lighting => to.extend(self.lighting().into_iter().flatten()),
            InputKind::Color => to.extend(self.positive3(1.0)),
            InputKind::Intensity => to.extend(self.positive3(4.0)),
            InputKind::Gain => to.push(self.range(0.0, 2.0)),
            InputKind::Width if self.once_in(8) => to.push(0.0),
            InputKind::Width => to.push(self.range(0.01, 0.5)),
            InputKind::Distance => to.push(self.range(-30.0, 30.0).exp2()),
            InputKind::Weights => to.extend(self.weights()),
            InputKind::Point => to.extend(self.range3(10.0)),
            InputKind::Vector => to.extend(scale(self.spread(1e-6, 1e6), self.direction())),
            InputKind::Light => self.light(to),
            InputKind::Material => {
                (0..3).for_each(|_| to.extend(self.positive3(1.0)));
                to.push(self.spread(1.0, 1000.0));
                to.extend(self.positive3(1.0));
            }
            InputKind::Matrix3 => (0..3).for_each(|_| to.extend(self.range3(2.0))),
            InputKind::Matrix4 => (0..16).for_each(|_| to.push(self.range(-2.0, 2.0))),
            InputKind::Clip => {
                to.extend(self.range3(5.0));
                to.push(self.range(0.1, 10.0));
            }
            InputKind::Four => (0..4).for_each(|_| to.push(self.range(-2.0, 2.0))),
            InputKind::Two => (0..2).for_each(|_| to.push(self.range(-2.0, 2.0))),
            InputKind::Barycentric => {
                let (u, v) = (self.unit(), self.unit());
                to.extend(if u + v > 1.0 { [1.0 - u, 1.0 - v] } else { [u, v] });
            }
            InputKind::Depths => (0..3).for_each(|_| to.push(self.spread(1e-3, 1e3))),
            InputKind::SegmentEnd => to.extend([self.range(-2.0, 2.0), self.spread(0.1, 100.0)]),
            InputKind::Alpha => to.push(self.spread(1e-6, 1.0)),
            InputKind::Index => to.push((self.spread(1e-6, 1.0) * self.pick(&[1.0, -1.0])).exp()),
            InputKind::Metal => (0..3).for_each(|_| to.push(self.spread(0.05, 10.0))),
            InputKind::Film => to.push(self.spread(10.0, 3000.0)),
            InputKind::Tangent => {
                let n = self.direction();
                let across = super::vector::cross(n, self.direction());
                // Of the axes, one is at right angles to the normal.
                let fallback = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
                let least = fallback
                    .into_iter()
                    .min_by(|a, b| super::vector::dot(n, *a).abs().total_cmp(&super::vector::dot(n, *b).abs()));
                let usable = super::vector::norm(across) > 0.1;
                let t = if usable { across } else { super::vector::cross(n, least.unwrap_or_default()) };
                to.extend(n);
                to.extend(unit(t));
            }
            InputKind::Bright => (0..3).for_each(|_| {
                let number = if self.once_in(8) { 0.0 } else { self.spread(1e-6, 1e4) };
                to.push(number);
            }),
            InputKind::White => to.push(self.spread(0.25, 64.0)),
            InputKind::Stops => to.push(self.range(-16.0, 24.0)),
            InputKind::Kelvin => to.push(self.spread(1000.0, 15000.0)),
            InputKind::Pixel => to.extend([self.range(0.0, 4096.0), self.range(0.0, 4096.0)]),
            InputKind::Cell => to.push(self.range(0.0, 16_777_216.0).floor()),
            InputKind::Cell3 => (0..3).for_each(|_| to.push(self.range(-1000.0, 1000.0).floor())),
            InputKind::Place => to.extend(self.range3(64.0)),
            InputKind::Place2 => to.extend([self.range(-64.0, 64.0), self.range(-64.0, 64.0)]),
            InputKind::Octaves => to.push(self.range(1.0, 7.0).floor()),
            InputKind::Ends => {
                let mut end = 0.0;
                (0..4).for_each(|_| {
                    end += self.spread(1.0, 100.0);
                    to.push(end);
                });
            }
            InputKind::Warp => {
                let sharp = self.spread(1e-3, 1.0);
                let matrix = [self.range(0.2, 1.0), self.range(0.0, 0.5), self.range(-0.2, 0.0) * sharp, sharp];
                self.warp(matrix, to);
            }
            InputKind::Corners => {
                let (size, count) = (self.spread(1e-2, 1e2), 3 + self.below(14));
                let center = self.direction();
                self.corners(center, size, count, to);
            }
            InputKind::Harmonics => (0..27).for_each(|_| to.push(self.range(-2.0, 2.0))),
        }
    }
}

impl InputKind {
    /// How many parameters the kind fills, and whether they pass through `normalize` before the call, so that the
    /// reference computes with vectors that are unit vectors to its own precision.
    pub fn params(self) -> (usize, bool) {
        match self {
            Self::Direction => (1, true),
            Self::Near | Self::Opposed | Self::Tangent => (2, true),
            Self::Lighting => (3, true),
            Self::Corners => (3, false),
            _ => (1, false),
        }
    }
}
