//! The error of an f32 GPU in interpolation: the interval around equation (106).
//!
//! *In:* the values of a primitive's vertices. *Out:* for each fragment the f64 value, with the error that a GPU may
//! make. *Holds:* quantities of the primitive are computed once for it ([`Slack`]), those of one of its values once
//! for that ([`Plane`]); a fragment costs a few products.

use super::assembly::Corners;
use crate::domain::{Number, rules};
use crate::exec::LANES;
use crate::interpolate::{linear, weights};
use glisten_scene::picture::Interval;

/// An ULP of f32 at 1.
pub(super) const ULP: f64 = 1.0 / (1 << 23) as f64;

/// The error of an f32 GPU that evaluates plane equations `a + b x + c y` from the corner of the window. Each of its
/// roundings costs up to half an ULP of the largest term, and an error of a vertex moves the plane by its slope.
///
/// The terms are the slopes (sums of the absolute values of their parts) times the distance from the corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slack {
    /// The slopes in x for unit differences along the first and the second edge.
    pub(super) x: [f64; 2],
    /// The slopes in y for unit differences along the first and the second edge.
    pub(super) y: [f64; 2],
    /// The largest error of the vertices in x and y.
    off: [f64; 2],
    /// The position of the first vertex.
    pub(super) origin: [f64; 2],
}

impl Slack {
    /// The slack of a primitive with these vertex positions, each coordinate with its largest error.
    pub(super) fn new(corners: &Corners, places: [[(f64, f64); 2]; 3]) -> Self {
        let value = |corner: usize, axis: usize| places[corner][axis].0;
        let edge = |corner: usize| [0, 1].map(|axis| value(corner, axis) - value(0, axis));
        let (u, v) = (edge(1), edge(2));
        let (x, y) = match corners {
            Corners::Point(_) => ([0.0; 2], [0.0; 2]),
            Corners::Line(_) => {
                let squared = u[0] * u[0] + u[1] * u[1];
                ([u[0] / squared, 0.0], [u[1] / squared, 0.0])
            }
            Corners::Triangle(_) => {
                let determinant = u[0] * v[1] - v[0] * u[1];
                ([v[1] / determinant, -u[1] / determinant], [-v[0] / determinant, u[0] / determinant])
            }
        };
        let snapped = const { rules::SNAPPING.absolute() };
        let off = [0, 1].map(|axis| (0..3).map(|corner| places[corner][axis].1).fold(0.0, f64::max) + snapped);
        Self { x, y, off, origin: [value(0, 0), value(0, 1)] }
    }
}

/// A value over a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plane {
    pub(super) values: [f64; 3],
    /// The largest errors of the vertices' values.
    pub(super) errors: [f64; 3],
    /// The absolute slopes in x and y.
    pub(super) sizes: [f64; 2],
    /// The absolute position of the first vertex.
    origin: [f64; 2],
    /// The largest absolute value.
    largest: f64,
    /// How far the value moves with the errors of the vertices.
    pub(super) moved: f64,
}

impl Plane {
    pub(super) fn new<F: Number>(slack: &Slack, values: [F; 3]) -> Self {
        let plain = values.map(Number::value);
        let rise = [plain[1] - plain[0], plain[2] - plain[0]];
        let slope = |parts: [f64; 2]| parts[0] * rise[0] + parts[1] * rise[1];
        let size = |parts: [f64; 2]| (parts[0] * rise[0]).abs() + (parts[1] * rise[1]).abs();
        Self {
            values: plain,
            errors: values.map(Number::error),
            sizes: [size(slack.x), size(slack.y)],
            origin: slack.origin.map(f64::abs),
            largest: plain.iter().fold(0.0_f64, |most, value| most.max(value.abs())),
            moved: slope(slack.x).abs() * slack.off[0] + slope(slack.y).abs() * slack.off[1],
        }
    }

    /// Fills in the value at fragments, from the weights of the second and the third vertex, and x and y.
    #[inline(always)]
    pub(super) fn fill<F: Number>(&self, places: [&[f64]; 4], to: &mut [F]) {
        let [u, v, x, y] = places;
        let (mut values, mut errors) = ([0.0; LANES], [0.0; LANES]);
        let found = values.iter_mut().zip(&mut errors);
        for ((((found, u), v), x), y) in found.zip(u).zip(v).zip(x).zip(y) {
            (*found.0, *found.1) = self.at(weights(*u, *v), [*x, *y]);
        }
        // Two loops, because the compiler vectorizes only the first.
        for ((to, value), error) in to.iter_mut().zip(values).zip(errors) {
            // A vertex whose value may be anything may be NaN, too.
            *to = if error < f64::INFINITY {
                F::with_error(value, error)
            } else {
                F::with_interval(value, Interval::ALL)
            };
        }
    }

    /// The value at a fragment, and the largest error of a GPU.
    #[inline(always)]
    pub(super) fn at(&self, weights: [f64; 3], [x, y]: [f64; 2]) -> (f64, f64) {
        let value = linear(weights, self.values);
        let terms = self.sizes[0] * (x + self.origin[0]) + self.sizes[1] * (y + self.origin[1]);
        let sizes = weights.map(f64::abs);
        let moved = (sizes[0] + sizes[1] + sizes[2]) * self.moved;
        let carried = sizes[0] * self.errors[0] + sizes[1] * self.errors[1] + sizes[2] * self.errors[2];
        let rounded = const { rules::VARYING.ulps() } * ULP * (terms + self.largest) + rules::ulp(value);
        (value, carried + moved + rounded)
    }
}
