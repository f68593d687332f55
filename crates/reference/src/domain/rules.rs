//! The errors that a conforming GPU may add: the rules of operations, and those of the pipeline around them.
//!
//! *In:* nothing. *Out:* the rules of operations from the front end's table, by name; and [`PIPELINE`] and [`OWN`],
//! the others in order.
//!
//! *Holds:* [`PIPELINE`] contains rules of Vulkan and OpenGL, [`OWN`] glisten's own rules where neither defines one,
//! each with its measurement. If a rule of an operation changes, the envelope changes, or the crate does not compile:
//! see the assertions below. Known violations by drivers are not rules: see [`faults`](super::faults).

pub use glisten_front::builtin::operations::precision::*;

/// The values that a step of the pipeline may yield besides the exact one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowance {
    /// A number of ULPs of f32 to either side.
    OfUlps(f64),
    /// An absolute error to either side.
    OfSize(f64),
    /// 0, for numbers of smaller size.
    ZeroBelow(f64),
    /// Infinity, for numbers of larger size.
    InfiniteAbove(f64),
    /// The nearest multiple of `1 / n`; from a half, either one. The exact number is not stored.
    Steps(f64),
    /// The nearest multiple of `1 / n`.
    StepsOrExact(f64),
    /// A lower and an upper number to add.
    Between(f64, f64),
}

/// A rule of the pipeline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The name of the rule in the code that evaluates it.
    pub name: &'static str,
    /// The operation.
    pub operation: &'static str,
    /// The error.
    pub allowance: Allowance,
    /// The source of the rule; for glisten's own rules, the measurement.
    pub source: &'static str,
}

macro_rules! steps {
    ($list:ident: $list_doc:literal; $($name:ident = $operation:literal, $allowance:expr, $source:literal;)*) => {
        $(#[doc = $operation] pub const $name: Step =
            Step { name: stringify!($name), operation: $operation, allowance: $allowance, source: $source };)*
        #[doc = $list_doc]
        pub static $list: &[Step] = &[$($name),*];
    };
}

use Allowance::{Between, InfiniteAbove, OfSize, OfUlps, Steps, StepsOrExact, ZeroBelow};

steps! { PIPELINE: "The rows of the specifications.";
    FLUSH_TO_ZERO = "subnormal operands and results", ZeroBelow(1.175_494_350_822_287_5e-38),
        "Vulkan: Precision and Operation: any subnormal may be flushed to zero";
    OVERFLOW = "results beyond the largest f32", InfiniteAbove(f32::MAX as f64), "Vulkan: ULP";
    CUBE_LEVEL = "level of detail of a cube texture, from derivatives", Between(-0.5, 1.0),
        "OpenGL 3.2 3.8.11: the scale factor is between the longer step over the square root of two, and the sum of both";
    BLEND_8_BITS = "source, factors and products of blending in 8 bits", StepsOrExact(255.0),
        "OpenGL 3.2 4.1.7: as many bits as the attachment has";
    STORE_8_BITS = "storing in 8 bits", Steps(255.0), "OpenGL 3.2 2.1.5";
}

steps! { OWN: "Rules where no specification speaks. `cargo test --test it -- envelope::measured --nocapture` prints the measurements again.";
    VARYING = "interpolation of varyings, depth", OfUlps(2.0),
        "of the largest term of a plane equation from the window's corner: its slope times the distance, and the value; measured: up to 12 % of that";
    SLOPE = "difference of a varying between fragments of a quad", OfUlps(0.5),
        "for each fragment, of the value and of the terms of the plane there: its value at the window's corner, and its slope times the distance; besides, the error of the slope; measured: up to 35 % of that";
    SNAPPING = "vertices that varyings are interpolated between, in pixels", OfSize(0.0),
        "where they are computed to be, not where they are snapped for coverage; measured: 1e-4 pixel, 1/512 of snapping would be 2e-3";
    POINT_VARYING = "varyings of points", OfUlps(2.0),
        "if w is not 1: the vertex's value times 1/w and w; measured: 1 ULP";
    POINT_COORD = "gl_PointCoord", OfSize(4.768_371_582_031_25e-7), "four ULP of 1; measured: within 1 ULP";
    TEXEL_COORDINATE = "coordinate in texels", OfUlps(1.0),
        "the coordinate times the size, rounded once; a lookup may read every texel that the interval touches";
    CUBE_COORDINATE = "coordinate on a face of a cube", OfUlps(4.0), "ULP of 1: a division, a sum and a product";
    COMPARED_DEPTH = "texel of a shadow comparison", OfUlps(1.0), "it and the reference are rounded to f32 before the comparison";
    FILTER_SUM = "sum of linear filtering", OfUlps(4.0), "measured: within 1 ULP";
    STORE_SLACK = "rounding to 8 bits", OfSize(1.0e-6), "a conversion through 255 x + 0.5 in f32; measured: 2e-8 from the half";
}

/// The formulas that kernels of this crate evaluate in a faster way than operation by operation. A rule that inherits
/// from another formula is evaluated by that one.
pub(crate) mod kernels {
    use glisten_front::builtin::operations::{Binary, Formula, Unary};

    const X: Formula = Formula::Argument(0);
    const Y: Formula = Formula::Argument(1);
    const A: Formula = Formula::Argument(2);
    const ONE: Formula = Formula::Constant(1.0);

    /// `1.0 / inversesqrt(x)`
    pub(crate) const SQRT: Formula = Formula::Binary(Binary::Div, &ONE, &Formula::Unary(Unary::Inversesqrt, &X));
    /// `exp2(y * log2(x))`
    pub(crate) const POW: Formula =
        Formula::Unary(Unary::Exp2, &Formula::Binary(Binary::Mul, &Y, &Formula::Unary(Unary::Log2, &X)));
    /// `x * (1.0 - a) + y * a`, or `x + (y - x) * a`
    pub(crate) const MIX: Formula = Formula::Either(
        &Formula::Binary(
            Binary::Add,
            &Formula::Binary(Binary::Mul, &X, &Formula::Binary(Binary::Sub, &ONE, &A)),
            &Formula::Binary(Binary::Mul, &Y, &A),
        ),
        &Formula::Binary(Binary::Add, &X, &Formula::Binary(Binary::Mul, &Formula::Binary(Binary::Sub, &Y, &X), &A)),
    );
}

// The envelope's rounding and the executor's computations implement these rules, which have no number to read.
const _: () = {
    assert!(matches!(ADD.precision, Precision::Correct), "envelopes round sums outward to f32");
    assert!(matches!(MUL.precision, Precision::Correct), "envelopes round products outward to f32");
    assert!(matches!(FRACT.precision, Precision::Correct), "envelopes round fractions outward to f32");
    assert!(matches!(CONVERT.precision, Precision::Correct), "envelopes round conversions outward to f32");
    assert!(matches!(EXACT.precision, Precision::Exact), "selecting functions round nothing");
    assert!(matches!(DERIVATIVE.precision, Precision::EitherDifference), "the executor joins both differences");
    assert!(matches!(INVERSE.precision, Precision::Cofactors), "the executor computes cofactors");
};

/// The smallest normal f32. Smaller numbers may be flushed to 0 before or after an operation.
pub const FLUSH: f64 = FLUSH_TO_ZERO.limit();

/// One ULP of f32 at `x`: the distance between neighbors in its binade, at least that of the subnormals.
#[inline(always)]
pub fn ulp(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52) & 0x7ff;
    // 1023 - 126 is the exponent of the smallest normal f32, which has 23 fractional bits.
    let clamped = if exponent < 897 { 897 } else { exponent };
    f64::from_bits((clamped - 23) << 52)
}

/// Reads the number of a rule of one kind. A rule of another kind does not compile where it is read in a constant.
macro_rules! numbers {
    ($($(#[$doc:meta])* $name:ident: $($variant:ident)|+;)*) => {
        impl Step {
            $($(#[$doc])*
            #[inline(always)]
            pub const fn $name(&self) -> f64 {
                match self.allowance {
                    $(Allowance::$variant(number))|+ => number,
                    _ => panic!("the rule is of another kind"),
                }
            })*
        }
    };
}

numbers! {
    /// The number of ULPs.
    ulps: OfUlps;
    /// The absolute error.
    absolute: OfSize;
    /// The number from which on it applies.
    limit: ZeroBelow | InfiniteAbove;
    /// The number of steps between 0 and 1.
    steps: Steps | StepsOrExact;
}

impl Step {
    /// The lower and the upper number to add.
    pub const fn between(&self) -> (f64, f64) {
        match self.allowance {
            Between(low, high) => (low, high),
            _ => panic!("the rule is of another kind"),
        }
    }

    /// The allowed values in words.
    pub fn describe(&self) -> String {
        match self.allowance {
            OfUlps(n) => format!("{n} ULP"),
            OfSize(error) => format!("{error:e}"),
            ZeroBelow(limit) => format!("0, too, below 2^{}", limit.log2()),
            InfiniteAbove(limit) => format!("infinity, too, above {limit:.7e}"),
            Steps(n) => format!("the nearest multiple of 1/{n}; from a half, either"),
            StepsOrExact(n) => format!("rounded to a multiple of 1/{n}, or not"),
            Between(low, high) => format!("{low} to {high:+}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ulps_are_the_distances_of_f32_neighbors() {
        for x in [1.0f32, 1.5, 1.999_999_9, 2.0, 1e-20, 3.4e38, 0.0, 1e-40, f32::MIN_POSITIVE] {
            let next = f32::from_bits(x.to_bits() + 1);
            if next.is_finite() {
                assert_eq!(ulp(f64::from(x)), f64::from(next) - f64::from(x), "at {x}");
            }
        }
    }

    #[test]
    fn every_row_has_a_source_and_its_own_operation() {
        let all: Vec<&Step> = PIPELINE.iter().chain(OWN).collect();
        for (index, rule) in all.iter().enumerate() {
            assert!(!rule.source.is_empty(), "{}", rule.operation);
            assert!(all.iter().skip(index + 1).all(|other| other.operation != rule.operation), "{}", rule.operation);
        }
    }
}
