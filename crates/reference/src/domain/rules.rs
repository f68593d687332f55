//! How far a conforming GPU may be from the exact result of one operation: a row each.
//!
//! *In:* nothing. *Out:* the rows by name, and [`SPECIFIED`] and [`OWN`], all of them in order.
//!
//! *Holds:* [`SPECIFIED`] are the rows of Vulkan's tables "Precision of core SPIR-V Instructions" and "Precision of
//! GLSL.std.450 Instructions" for 32-bit floats (appendix "Vulkan Environment for SPIR-V"), with those of WGSL's table
//! "Accuracy of Built-in Functions" where they allow more: a GPU is right by either. [`OWN`] are rules of glisten's own where
//! neither speaks, each with the measurement that it rests on. What a driver does wrong is no rule:
//! [`faults`](super::faults).

/// An error that one operation may add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowance {
    /// One of the two f32 neighbors; the number itself where it is an f32.
    Rounded,
    /// So many ULPs of f32 at the exact result.
    Ulps(f64),
    /// `a + b |x|` ULPs of f32 at the exact result, `x` being the argument.
    UlpsWithArgument(f64, f64),
    /// So much, whatever the result.
    Absolute(f64),
    /// What the formula gives, computed by the rows of its operations, limited to what the function itself can give.
    Inherited(&'static str),
    /// The worse of what the formula gives and so much.
    InheritedOr(&'static str, f64),
    /// The hull of what is said.
    Hull(&'static str),
}

/// A row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// The operation.
    pub operation: &'static str,
    /// The error.
    pub allowance: Allowance,
    /// Where that stands; of glisten's own rules what was measured.
    pub source: &'static str,
}

macro_rules! rules {
    ($list:ident: $list_doc:literal; $($name:ident = $operation:literal, $allowance:expr, $source:literal;)*) => {
        $(#[doc = $operation] pub const $name: Rule =
            Rule { operation: $operation, allowance: $allowance, source: $source };)*
        #[doc = $list_doc]
        pub static $list: &[Rule] = &[$($name),*];
    };
}

use Allowance::{Absolute, Hull, Inherited, InheritedOr, Rounded, Ulps, UlpsWithArgument};

rules! { SPECIFIED: "The rows of the specifications.";
    ADD = "+, -", Rounded, "Vulkan: OpFAdd, OpFSub";
    MUL = "*", Rounded, "Vulkan: OpFMul";
    DIV = "/", Ulps(2.5), "Vulkan: OpFDiv, for |y| in [2^-126, 2^126]; beyond, anything";
    CONTRACT = "a * b + c", Rounded, "Vulkan: Evaluation of Expressions: the product may be rounded or not";
    FLUSH_TO_ZERO = "subnormal operands and results", Hull("the number and 0"),
        "Vulkan: Precision and Operation: any subnormal may be flushed to zero";
    OVERFLOW = "results beyond the greatest f32", Hull("the greatest f32 and infinity"), "Vulkan: ULP";
    COMPARE = "<, <=, ==, !=, >=, >", Rounded, "Vulkan: OpFOrdLessThan and its like: correct result";
    EXACT = "abs, sign, floor, ceil, trunc, fract, modf, step, clamp", Rounded, "Vulkan: correctly rounded";
    ROUND = "round, roundEven", Hull("both neighbors of a half"), "GLSL 1.50 8.3";
    EXTREMUM = "min, max", Hull("either operand where one may be NaN"), "GLSL.std.450: FMin, FMax";
    INVERSESQRT = "inversesqrt", Ulps(2.0), "Vulkan: InverseSqrt";
    SQRT = "sqrt", Inherited("1.0 / inversesqrt(x)"), "Vulkan: Sqrt";
    EXP = "exp, exp2", UlpsWithArgument(3.0, 2.0), "Vulkan: Exp, Exp2";
    LOG = "log, log2", Ulps(3.0), "Vulkan: Log, Log2, outside [0.5, 2]";
    LOG_NEAR_ONE = "log, log2 of [0.5, 2]", Absolute(4.768_371_582_031_25e-7), "Vulkan: Log, Log2: 2^-21 inside [0.5, 2]";
    POW = "pow", Inherited("exp2(y * log2(x))"), "Vulkan: Pow";
    SIN = "sin, cos", Absolute(4.882_812_5e-4), "Vulkan: Sin, Cos: 2^-11 inside [-pi, pi]";
    TAN = "tan", Inherited("sin(x) / cos(x)"), "Vulkan: Tan";
    ATAN = "atan", Ulps(4096.0), "Vulkan: Atan, Atan2";
    ASIN = "asin", InheritedOr("atan2(x, sqrt(1.0 - x * x))", 6.81e-5), "Vulkan: Asin; WGSL: asin";
    ACOS = "acos", InheritedOr("atan2(sqrt(1.0 - x * x), x)", 6.77e-5), "Vulkan: Acos; WGSL: acos";
    SINH = "sinh", Inherited("(exp(x) - exp(-x)) * 0.5"), "Vulkan: Sinh";
    COSH = "cosh", Inherited("(exp(x) + exp(-x)) * 0.5"), "Vulkan: Cosh";
    TANH = "tanh", InheritedOr("sinh(x) / cosh(x)", 1.0e-5), "Vulkan: Tanh; WGSL: tanh";
    ASINH = "asinh", Inherited("log(x + sqrt(x * x + 1.0))"), "Vulkan: Asinh";
    ACOSH = "acosh", Inherited("log(x + sqrt(x * x - 1.0))"), "Vulkan: Acosh";
    ATANH = "atanh", Inherited("log((1.0 + x) / (1.0 - x)) * 0.5"), "Vulkan: Atanh";
    MOD = "mod", Inherited("x - y * floor(x / y)"), "Vulkan: OpFMod";
    MIX = "mix", Inherited("x * (1.0 - a) + y * a, or x + (y - x) * a"), "Vulkan: FMix";
    SMOOTHSTEP = "smoothstep", Inherited("t * t * (3.0 - 2.0 * t)"), "Vulkan: SmoothStep";
    RADIANS = "radians, degrees", Inherited("x * (pi / 180), x * (180 / pi)"), "Vulkan: Radians, Degrees";
    DOT = "dot, matrix products", Inherited("x0 * y0 + x1 * y1 + ..., summed in any order"), "Vulkan: OpDot";
    LENGTH = "length, distance", Inherited("sqrt(dot(x, x))"), "Vulkan: Length, Distance";
    NORMALIZE = "normalize", Inherited("x * inversesqrt(dot(x, x))"), "Vulkan: Normalize";
    CROSS = "cross", Inherited("x[i] * y[j] - x[j] * y[i]"), "Vulkan: Cross";
    FACEFORWARD = "faceforward", Inherited("dot(Nref, I) < 0.0 ? N : -N"), "Vulkan: FaceForward";
    REFLECT = "reflect", Inherited("x - 2.0 * dot(y, x) * y"), "Vulkan: Reflect";
    REFRACT = "refract", Inherited("eta * I - (eta * dot(N, I) + sqrt(k)) * N, 0 for k < 0"), "Vulkan: Refract";
    INVERSE = "determinant, inverse", Inherited("cofactors, and cofactors / determinant"), "Vulkan: MatrixInverse: none stated";
    CONVERT = "int to float", Rounded, "Vulkan: conversions between types";
    DERIVATIVE = "dFdx, dFdy, fwidth", Hull("both differences in the quad"), "Vulkan: OpDPdx: fine or coarse; GLSL 1.50 8.8";
    LEVEL_RANGE = "level of detail from derivatives", Hull("log2 of the longest of the steps along the axes, to log2 of their sum"),
        "OpenGL 3.2 3.8.11: conditions on the scale factor";
    BLEND_8_BITS = "blending in 8 bits", Hull("source, factors and products rounded to steps of 1/255 or not"),
        "OpenGL 3.2 4.1.7: as many bits as the attachment has";
    STORE_8_BITS = "storing in 8 bits", Hull("the steps of 1/255 on both sides of a half"), "OpenGL 3.2 2.1.5";
    STORE_HALF = "storing in 16-bit floats", Hull("both neighbors"), "OpenGL 3.2 2.1.2: no rounding is named";
}

rules! { OWN: "Rules where no specification speaks. `cargo test --test it -- envelope::measured --nocapture` prints the measurements again.";
    SIN_BEYOND_PI = "sin, cos beyond [-pi, pi]", Absolute(4.882_812_5e-4),
        "that of [-pi, pi], and one ULP of the argument for its reduction; measured: 8e-8 up to 1e6; beyond 2^23 anything from -1 to 1";
    VARYING = "interpolation of varyings, depth", Ulps(2.0),
        "of the largest term of a plane equation from the window's corner: its slope times the distance, and the value; measured: up to 12 % of that";
    SNAPPING = "vertices that varyings are interpolated between, in pixels", Absolute(0.0),
        "where they are computed to be, not where they are snapped for coverage; measured: 1e-4 pixel, 1/512 of snapping would be 2e-3";
    POINT_COORD = "gl_PointCoord", Absolute(4.768_371_582_031_25e-7), "four ULP of 1; measured: within 1 ULP";
    NEAREST = "nearest texel", Hull("every texel that the coordinate's interval touches"), "the coordinate times the size, rounded once";
    FILTER_WEIGHT = "weight of linear filtering", Absolute(3.906_25e-3),
        "eight bits, as Mesa 22.3.6's llvmpipe reports in subTexelPrecisionBits; measured: 6e-8 for float texels";
    FILTER_SUM = "sum of linear filtering", Ulps(4.0), "measured: within 1 ULP";
    STORE_SLACK = "rounding to 8 bits", Absolute(1.0e-6), "a conversion through 255 x + 0.5 in f32; measured: 2e-8 from the half";
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

impl Rule {
    /// The ULPs of a row that has them.
    #[inline(always)]
    pub const fn ulps(&self) -> f64 {
        match self.allowance {
            Ulps(n) | UlpsWithArgument(n, _) => n,
            _ => 0.0,
        }
    }

    /// The ULPs at an argument.
    #[inline(always)]
    pub fn ulps_at(&self, argument: f64) -> f64 {
        match self.allowance {
            UlpsWithArgument(a, b) => a + b * argument.abs(),
            _ => self.ulps(),
        }
    }

    /// The absolute error of a row that has one.
    #[inline(always)]
    pub const fn absolute(&self) -> f64 {
        match self.allowance {
            Absolute(error) | InheritedOr(_, error) => error,
            _ => 0.0,
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
        let all: Vec<&Rule> = SPECIFIED.iter().chain(OWN).collect();
        for (index, rule) in all.iter().enumerate() {
            assert!(!rule.source.is_empty(), "{}", rule.operation);
            assert!(all.iter().skip(index + 1).all(|other| other.operation != rule.operation), "{}", rule.operation);
        }
    }
}
