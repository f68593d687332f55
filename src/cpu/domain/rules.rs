//! How far a conforming f32 GPU may be from the exact result of one operation: one row each.
//!
//! The rows are those of Vulkan's table "Precision of core SPIR-V Instructions" and "Precision of GLSL.std.450
//! Instructions" (appendix A of the specification) for 32-bit floats; an operation that the table calls *inherited* is
//! computed by its formula out of bounded ones and has no row. WGSL's table agrees but where a row says so.
//! Where no specification speaks, the rule is glisten's own and says what it rests on.

/// An error that one operation may add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowance {
    /// So many ULPs of f32 at the exact result.
    Ulps(f64),
    /// `a + b |x|` ULPs of f32 at the exact result, `x` being the argument.
    UlpsWithArgument(f64, f64),
    /// So much, whatever the result.
    Absolute(f64),
    /// So many ULPs, and so much at least.
    UlpsOrAbsolute(f64, f64),
}

/// A row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// The operation.
    pub operation: &'static str,
    /// The error.
    pub allowance: Allowance,
    /// Where that stands.
    pub source: &'static str,
}

macro_rules! rules {
    ($($(#[$doc:meta])* $name:ident = $operation:literal, $allowance:expr, $source:literal;)*) => {
        $($(#[$doc])* pub const $name: Rule =
            Rule { operation: $operation, allowance: $allowance, source: $source };)*
        /// All rows.
        pub static ALL: &[Rule] = &[$($name),*];
    };
}

use Allowance::{Absolute, Ulps, UlpsOrAbsolute, UlpsWithArgument};

rules! {
    /// Vulkan says "correctly rounded", in either direction; contraction to a fused form is covered, too.
    ADD = "+, -", Ulps(1.0), "Vulkan, OpFAdd: correctly rounded (to one of the two neighbors); contraction allowed";
    /// Likewise.
    MUL = "*", Ulps(1.0), "Vulkan, OpFMul: correctly rounded (to one of the two neighbors)";
    /// For divisors of 2^-126 to 2^126.
    DIV = "/", Ulps(2.5), "Vulkan, OpFDiv: 2.5 ULP for |y| in [2^-126, 2^126]";
    /// Square roots are `1 / inversesqrt`.
    INVERSESQRT = "inversesqrt", Ulps(2.0), "Vulkan, InverseSqrt: 2 ULP";
    /// `exp` and `exp2`.
    EXP = "exp, exp2", UlpsWithArgument(3.0, 2.0), "Vulkan, Exp, Exp2: 3 + 2|x| ULP";
    /// Outside [0.5, 2].
    LOG = "log, log2", Ulps(3.0), "Vulkan, Log, Log2: 3 ULP outside [0.5, 2]";
    /// Inside it.
    LOG_NEAR_ONE = "log, log2 of [0.5, 2]", Absolute(4.76837158203125e-7), "Vulkan, Log, Log2: 2^-21 inside [0.5, 2]";
    /// In [-pi, pi]; beyond it grows with the rounding of the argument.
    SIN = "sin, cos", Absolute(4.8828125e-4), "Vulkan, Sin, Cos: 2^-11 inside [-pi, pi]";
    /// `atan` with one or two arguments.
    ATAN = "atan", Ulps(4096.0), "Vulkan, Atan, Atan2: 4096 ULP";
    /// A known driver fault covers more: Mesa 22.3's llvmpipe is 1.6e-4 (`acos`) and 3.9e-4 (`asin`) off.
    ASIN = "asin, acos", UlpsOrAbsolute(4096.0, 4.0e-4),
        "Vulkan: inherited from atan2 and sqrt; measured on Mesa 22.3.6 llvmpipe: 3.9e-4";
    /// Round-to-integer functions decide by the argument's own bound.
    CONVERT = "int to float", Ulps(1.0), "Vulkan, OpConvertSToF: correctly rounded";
    /// Weights of linear filters: `maxImageDimension` apart, eight bits of sub-texel precision.
    FILTER_WEIGHT = "weight of linear filtering", Absolute(3.90625e-3),
        "Vulkan, subTexelPrecisionBits: at least 4; Mesa 22.3.6 llvmpipe reports 8";
    /// A known driver fault covers more: a crude log2.
    LEVEL_OF_DETAIL = "level of detail from derivatives", Absolute(0.05),
        "Vulkan, mipmapPrecisionBits; measured on Mesa 22.3.6 llvmpipe: up to 0.043";
}

/// The least normal f32: what is smaller may be flushed to 0 before or after an operation.
pub const FLUSH: f64 = 1.175_494_350_822_287_5e-38;

/// One ULP of f32 at `x`: the distance of neighbors in its binade, at least that of the subnormals.
#[inline(always)]
pub fn ulp(x: f64) -> f64 {
    let exponent = (x.to_bits() >> 52) & 0x7ff;
    // 1023 - 126 is the exponent of the least normal f32; 23 bits stand behind the point.
    let clamped = if exponent < 897 { 897 } else { exponent };
    f64::from_bits((clamped - 23) << 52)
}

impl Allowance {
    /// The error at a result and an argument.
    #[inline(always)]
    pub fn at(self, result: f64, argument: f64) -> f64 {
        match self {
            Ulps(n) => n * ulp(result),
            UlpsWithArgument(a, b) => (a + b * argument.abs()) * ulp(result),
            Absolute(error) => error,
            UlpsOrAbsolute(n, least) => (n * ulp(result)).max(least),
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
    fn every_row_has_a_source() {
        for rule in ALL {
            assert!(!rule.source.is_empty() && rule.allowance.at(1.0, 1.0) > 0.0, "{}", rule.operation);
        }
    }
}
