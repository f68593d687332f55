//! [`Levels`]: how a simulated GPU computes levels of detail.
//!
//! *In:* steps in texels. *Out:* a level of detail. *Holds:* the scale factor is between the longest step along one axis of
//! the texture and the sum of these, as OpenGL 3.2 §3.8.11 lets it be.

use crate::domain::{Corner, FixedPoint, longest};

/// How the lengths of steps are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// By the root of the sum of squares.
    Root,
    /// By the longest step along an axis.
    LongestAxis,
    /// By the sum over the axes.
    Sum,
}

/// The choices of a GPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Levels {
    pub(super) measure: Measure,
    /// Whether the logarithm of a square is a straight line between powers of two, as llvmpipe computes it.
    pub(super) straight: bool,
    /// The steps of the fraction, after a bias is added; none if it is a float.
    pub(super) steps: Option<FixedPoint>,
    /// The row and the column whose steps count for a quad; none if each fragment has its own.
    pub(super) corner: Option<Corner>,
}

impl Levels {
    /// By the equations.
    pub(super) const EXACT: Self = Self { measure: Measure::Root, straight: false, steps: None, corner: None };
    /// Those of llvmpipe.
    pub(super) const LLVMPIPE: Self =
        Self { straight: true, corner: Some(Corner { lower: false, right: false }), ..Self::EXACT };

    /// The level of detail of two steps.
    pub(super) fn of(self, steps: [[f64; 3]; 2]) -> f64 {
        let exact = match self.measure {
            Measure::Root => longest(steps),
            Measure::LongestAxis => steps.iter().flatten().fold(0.0, |most: f64, step| most.max(step.abs())).log2(),
            Measure::Sum => {
                let sum = |step: [f64; 3]| step.iter().map(|change| change.abs()).sum::<f64>();
                sum(steps[0]).max(sum(steps[1])).log2()
            }
        };
        if self.straight { 0.5 * straight(2.0 * exact) } else { exact }
    }

    /// The level of detail with the steps that it has.
    pub(super) fn stepped(self, level: f64) -> f64 {
        match self.steps {
            Some(steps) if level.is_finite() => steps.nearest(level),
            _ => level,
        }
    }
}

/// The logarithm that is a straight line between powers of two, given the exact one.
fn straight(logarithm: f64) -> f64 {
    let whole = logarithm.floor();
    if logarithm.is_finite() { whole + (logarithm - whole).exp2() - 1.0 } else { logarithm }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_of_a_driver() {
        let steps = |length: f64| [[length, 0.0, 0.0], [0.0, length / 2.0, 0.0]];
        for (exact, measured) in [(0.25_f64, 0.2071), (0.4375, 0.4170), (1.0, 1.0), (-1.0, -1.0)] {
            assert!((Levels::LLVMPIPE.of(steps(exact.exp2())) - measured).abs() < 1e-4, "{exact}");
            assert!((Levels::EXACT.of(steps(exact.exp2())) - exact).abs() < 1e-12);
        }
        let slanted = [[3.0, 4.0, 0.0], [0.0; 3]];
        let of = |measure| Levels { measure, ..Levels::EXACT }.of(slanted);
        assert_eq!([of(Measure::Root), of(Measure::LongestAxis), of(Measure::Sum)], [5.0, 4.0, 7.0].map(f64::log2));
        let fixed = |down| Levels { steps: Some(FixedPoint { bits: 4, down }), ..Levels::EXACT };
        assert_eq!([0.05, 0.03, -0.01].map(|level| fixed(false).stepped(level)), [0.0625, 0.0, 0.0]);
        assert_eq!([0.05, 0.07, -0.01].map(|level| fixed(true).stepped(level)), [0.0, 0.0625, -0.0625]);
        assert_eq!(fixed(true).stepped(f64::NEG_INFINITY), f64::NEG_INFINITY);
        assert_eq!(Levels::LLVMPIPE.of([[0.0; 3]; 2]), f64::NEG_INFINITY);
    }
}
