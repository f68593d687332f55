//! The error of a varying that the fragments of a quad do not share.
//!
//! *In:* a primitive's [`Slack`] and the values of its vertices. *Out:* for each fragment a number, such that the errors of
//! two fragments of a quad differ by at most the sum of theirs. *Holds:* an error of the plane moves all of its fragments
//! by the same. What differs is the rounding at each fragment ([`rules::SLOPE`]), and the tilt of the plane: errors of the
//! vertices, over the size of the primitive.

use super::slack::{Plane, Slack, ULP};
use crate::domain::{Number, rules};
use crate::interpolate::linear;

/// A value over a primitive, with its slopes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tilted {
    plane: Plane,
    /// The change from one pixel to the next, in x and y.
    slopes: [f64; 2],
    /// The value at the window's corner.
    corner: f64,
    /// The largest error of the change from one pixel to the next.
    tilt: f64,
}

impl Tilted {
    pub(super) fn new<F: Number>(slack: &Slack, values: [F; 3]) -> Self {
        let plane = Plane::new(slack, values);
        let rise = [plane.values[1] - plane.values[0], plane.values[2] - plane.values[0]];
        let slopes = [slack.x, slack.y].map(|parts| parts[0] * rise[0] + parts[1] * rise[1]);
        let corner = plane.values[0] - slopes[0] * slack.origin[0] - slopes[1] * slack.origin[1];
        let carried =
            [plane.errors[0] + plane.errors[1], plane.errors[0] + plane.errors[2]].map(|e| e + 2.0 * plane.moved);
        let of_vertices = |parts: [f64; 2]| parts[0].abs() * carried[0] + parts[1].abs() * carried[1];
        let rounded = rules::VARYING.ulps() * ULP * (plane.sizes[0] + plane.sizes[1]);
        Self { plane, slopes, corner, tilt: of_vertices(slack.x) + of_vertices(slack.y) + rounded }
    }

    /// The rounding of the plane's equation at a fragment.
    fn rounding(&self, [x, y]: [f64; 2]) -> f64 {
        let terms = self.corner.abs() + self.slopes[0].abs() * x + self.slopes[1].abs() * y;
        rules::SLOPE.ulps() * ULP * terms
    }

    fn steepness(&self) -> f64 {
        self.slopes[0].abs() + self.slopes[1].abs()
    }

    /// The noise of a value that is linear in the window.
    pub(super) fn noise(&self, weights: [f64; 3], place: [f64; 2]) -> f64 {
        let value = linear(weights, self.plane.values);
        self.rounding(place) + rules::SLOPE.ulps() * rules::ulp(value) + self.tilt / 2.0
    }

    /// The noise of a quotient by the reciprocal of w: equation (108).
    pub(super) fn noise_over(&self, reciprocal: &Self, weights: [f64; 3], place: [f64; 2]) -> f64 {
        let (quotient, off) = self.plane.at(weights, place);
        let (inverse, inverse_off) = reciprocal.plane.at(weights, place);
        let w = 1.0 / inverse.abs();
        let value = (quotient * w).abs();
        let rounding = w * (self.rounding(place) + value * reciprocal.rounding(place));
        let own = 2.0 * rules::SLOPE.ulps() * rules::ulp(value);
        // What both fragments share is multiplied by a w, and by a value, that differ.
        let shared = w * (off + value * inverse_off);
        let change = w * reciprocal.steepness();
        let value_change = w * (self.steepness() + value * reciprocal.steepness());
        let tilt = w * (self.tilt + value * reciprocal.tilt) + 2.0 * shared * change + value_change * w * inverse_off;
        let noise = rounding + own + tilt / 2.0;
        if noise.is_finite() { noise } else { f64::INFINITY }
    }
}
