//! Typed rules for the error that a conforming GPU may add to one operation.
//!
//! *In:* nothing. *Out:* a constant for each rule, and [`RULES`], all of them in order. *Holds:* these are the rows
//! of Vulkan's tables "Precision of core SPIR-V Instructions" and "Precision of GLSL.std.450 Instructions" for 32-bit
//! floats (appendix "Vulkan Environment for SPIR-V"), or those of WGSL's table "Accuracy of Built-in Functions" where
//! they allow more: a GPU conforms if it follows either. *Not done here:* the rules for the pipeline around the
//! shaders (the reference's `domain::rules`).

use super::Formula;
use super::formula::formula;
use std::f64::consts::PI;

/// The error that one operation may add.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precision {
    /// No error: the exact result of f32 numbers is an f32.
    Exact,
    /// One of the two f32 neighbors, or the number itself if it is an f32.
    Correct,
    /// A number of ULPs of f32 at the exact result.
    Ulps(f64),
    /// `fixed + slope |x|` ULPs of f32 at the exact result, where `x` is the argument.
    UlpsWithArgument {
        /// The part that does not depend on the argument.
        fixed: f64,
        /// The part for each unit of the argument.
        slope: f64,
    },
    /// ULPs, or in a range of arguments at least an absolute error.
    UlpsOrWithin {
        /// The ULPs of f32 at the exact result.
        ulps: f64,
        /// The absolute error.
        error: f64,
        /// The lower bound of the range.
        low: f64,
        /// The upper bound of the range.
        high: f64,
    },
    /// An absolute error.
    Absolute(f64),
    /// An absolute error. For larger angles, their rounding adds to it; for the largest, the result may be any value
    /// of the function.
    Angle {
        /// The absolute error.
        error: f64,
        /// The angle above which the argument is reduced, which loses one of its ULPs.
        reduced: f64,
        /// The angle from which a float has no fraction.
        lost: f64,
    },
    /// The error of the formula, computed by the rules of its operations, limited to the range of the function.
    Inherited(&'static Formula),
    /// The larger of the formula's error and an absolute error.
    InheritedOr(&'static Formula, f64),
    /// The nearest integer; from a half, either.
    EitherHalf,
    /// Exact; if one operand may be NaN, the other one or NaN.
    EitherOfNan,
    /// The difference along either row or either column of the quad.
    EitherDifference,
    /// Cofactors by rows and columns, divided by their sum for the inverse. No specification states a precision.
    Cofactors,
}

/// A rule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// The operations.
    pub operation: &'static str,
    /// The error.
    pub precision: Precision,
    /// The names of the arguments in the formula.
    pub arguments: &'static [&'static str],
    /// The source of the rule.
    pub source: &'static str,
}

impl Rule {
    /// The ULPs, for a rule with ULPs.
    #[inline(always)]
    pub const fn ulps(&self) -> f64 {
        match self.precision {
            Ulps(n) | UlpsOrWithin { ulps: n, .. } => n,
            UlpsWithArgument { fixed, .. } => fixed,
            _ => 0.0,
        }
    }

    /// The ULPs at an argument.
    #[inline(always)]
    pub const fn ulps_at(&self, argument: f64) -> f64 {
        match self.precision {
            UlpsWithArgument { fixed, slope } => fixed + slope * argument.abs(),
            _ => self.ulps(),
        }
    }

    /// The absolute error, for a rule with one.
    #[inline(always)]
    pub const fn absolute(&self) -> f64 {
        match self.precision {
            Absolute(error) | InheritedOr(_, error) | UlpsOrWithin { error, .. } | Angle { error, .. } => error,
            _ => 0.0,
        }
    }

    /// The range of arguments with a precision of its own; for angles, where they are reduced and where no fraction
    /// is left.
    pub const fn within(&self) -> (f64, f64) {
        match self.precision {
            UlpsOrWithin { low, high, .. } => (low, high),
            Angle { reduced, lost, .. } => (reduced, lost),
            _ => (f64::NEG_INFINITY, f64::INFINITY),
        }
    }

    /// The formula, for a rule with one.
    pub const fn formula(&self) -> Option<&'static Formula> {
        match self.precision {
            Inherited(formula) | InheritedOr(formula, _) => Some(formula),
            _ => None,
        }
    }

    /// Whether the result may differ from the exact one.
    pub const fn adds_error(&self) -> bool {
        !matches!(self.precision, Exact | EitherOfNan)
    }

    /// Whether the rule is inherited from this very formula. Then a kernel may evaluate it in a faster way.
    pub const fn inherits(&self, formula: &Formula) -> bool {
        match self.formula() {
            Some(own) => own.same(formula),
            None => false,
        }
    }
}

macro_rules! rules {
    ($($name:ident = $operation:literal ($($argument:literal),*), $precision:expr, $source:literal;)*) => {
        $(#[doc = $operation] pub const $name: Rule = Rule {
            operation: $operation,
            precision: $precision,
            arguments: &[$($argument),*],
            source: $source,
        };)*
        /// All rules of operations.
        pub static RULES: &[Rule] = &[$($name),*];
    };
}

use Precision::*;

/// `x` and `root`, the root of `1 - x x`, limited to 0 from below.
const ROOT: Formula = formula!((Sqrt (Max (- 1.0 (* x x)) 0.0)));
const SINH_OF_X: Formula = formula!((* (- (Exp x) (Exp (Neg x))) 0.5));
const COSH_OF_X: Formula = formula!((* (+ (Exp x) (Exp (Neg x))) 0.5));

rules! {
    ADD = "+, -" ("x", "y"), Correct, "Vulkan: OpFAdd, OpFSub";
    MUL = "*, matrixCompMult, outerProduct, ldexp" ("x", "y"), Correct, "Vulkan: OpFMul";
    DIV = "/" ("x", "y"), Ulps(2.5), "Vulkan: OpFDiv, for |y| in [2^-126, 2^126]; beyond, anything";
    EXACT = "-x, abs, sign, floor, ceil, trunc, step, clamp, transpose, frexp, intBitsToFloat, uintBitsToFloat" ("x"), Exact, "Vulkan: correctly rounded, and an f32";
    FRACT = "fract, modf" ("x"), Correct, "Vulkan: correctly rounded";
    ROUND = "round, roundEven" ("x"), EitherHalf, "GLSL 1.50 8.3";
    EXTREMUM = "min, max, min3, max3, mid3" ("x", "y"), EitherOfNan, "GLSL.std.450: FMin, FMax";
    INVERSESQRT = "inversesqrt" ("x"), Ulps(2.0), "Vulkan: InverseSqrt";
    SQRT = "sqrt" ("x"), Inherited(&formula!((/ 1.0 (Inversesqrt x)))), "Vulkan: Sqrt";
    EXP = "exp, exp2" ("x"), UlpsWithArgument { fixed: 3.0, slope: 2.0 }, "Vulkan: Exp, Exp2";
    LOG = "log, log2" ("x"), UlpsOrWithin { ulps: 3.0, error: 4.768_371_582_031_25e-7, low: 0.5, high: 2.0 },
        "Vulkan: Log, Log2: 2^-21 inside [0.5, 2]";
    POW = "pow" ("x", "y"), Inherited(&formula!((Exp2 (* y (Log2 x))))), "Vulkan: Pow";
    SIN = "sin, cos" ("x"), Angle { error: 4.882_812_5e-4, reduced: PI, lost: 8_388_608.0 },
        "Vulkan: Sin, Cos: 2^-11 inside [-pi, pi]; beyond it glisten's own rule: one ULP of the argument more, measured: 8e-8 up to 1e6; beyond 2^23 anything from -1 to 1";
    TAN = "tan" ("x"), Inherited(&formula!((/ (Sin x) (Cos x)))), "Vulkan: Tan";
    ATAN = "atan" ("y", "x"), Ulps(4096.0), "Vulkan: Atan, Atan2";
    ASIN = "asin" ("x"), InheritedOr(&Formula::Binary(super::Binary::Atan2, &formula!(x), &ROOT), 6.81e-5),
        "Vulkan: Asin; WGSL: asin";
    ACOS = "acos" ("x"), InheritedOr(&Formula::Binary(super::Binary::Atan2, &ROOT, &formula!(x)), 6.77e-5),
        "Vulkan: Acos; WGSL: acos";
    SINH = "sinh" ("x"), Inherited(&SINH_OF_X), "Vulkan: Sinh";
    COSH = "cosh" ("x"), Inherited(&COSH_OF_X), "Vulkan: Cosh";
    TANH = "tanh" ("x"), InheritedOr(&Formula::Binary(super::Binary::Div, &SINH_OF_X, &COSH_OF_X), 1.0e-5),
        "Vulkan: Tanh; WGSL: tanh";
    ASINH = "asinh" ("x"), Inherited(&formula!((Log (+ x (Sqrt (+ (* x x) 1.0)))))), "Vulkan: Asinh";
    ACOSH = "acosh" ("x"), Inherited(&formula!((Log (+ x (Sqrt (- (* x x) 1.0)))))), "Vulkan: Acosh";
    ATANH = "atanh" ("x"), Inherited(&formula!((* (Log (/ (+ 1.0 x) (- 1.0 x))) 0.5))), "Vulkan: Atanh";
    MOD = "mod" ("x", "y"), Inherited(&formula!((- x (* y (Floor (/ x y)))))), "Vulkan: OpFMod";
    MIX = "mix" ("x", "y", "a"), Inherited(&formula!((either (+ (* x (- 1.0 z)) (* y z)) (+ x (* (- y x) z))))),
        "Vulkan: FMix";
    FMA = "fma" ("a", "b", "c"), Inherited(&formula!((+ (* x y) z))), "Vulkan: Fma: as a * b + c, or rounded once";
    SMOOTHSTEP = "smoothstep" ("edge0", "edge1", "x"),
        Inherited(&formula!((with (* (* x x) (- 3.0 (* x 2.0))) (Min (Max (/ (- z x) (- y x)) 0.0) 1.0)))),
        "Vulkan: SmoothStep";
    RADIANS = "radians" ("degrees"), Inherited(&formula!((* x (number PI / 180.0)))), "Vulkan: Radians";
    DEGREES = "degrees" ("radians"), Inherited(&formula!((* x (number 180.0 / PI)))), "Vulkan: Degrees";
    DOT = "dot, matrix products" ("x", "y"), Inherited(&formula!((dot x y))), "Vulkan: OpDot: summed in any order";
    LENGTH = "length" ("x"), Inherited(&formula!((Sqrt (dot x x)))), "Vulkan: Length";
    DISTANCE = "distance" ("p0", "p1"), Inherited(&formula!((Sqrt (dot (- x y) (- x y))))), "Vulkan: Distance";
    NORMALIZE = "normalize" ("x"), Inherited(&formula!((either (* x (Inversesqrt (dot x x))) (/ x (Sqrt (dot x x)))))),
        "Vulkan: Normalize; WGSL: normalize";
    CROSS = "cross" ("x", "y"), Inherited(&formula!((- (* (next 1 x) (next 2 y)) (* (next 1 y) (next 2 x))))),
        "Vulkan: Cross";
    FACEFORWARD = "faceforward" ("N", "I", "Nref"), Inherited(&formula!((less (dot z y) 0.0 x (Neg x)))),
        "Vulkan: FaceForward";
    REFLECT = "reflect" ("I", "N"), Inherited(&formula!((- x (* (* (dot y x) 2.0) y)))), "Vulkan: Reflect";
    REFRACT = "refract" ("I", "N", "eta"), Inherited(&REFRACT_FORMULA), "Vulkan: Refract";
    INVERSE = "determinant, inverse" ("m"), Cofactors, "Vulkan: MatrixInverse: none stated";
    CONVERT = "int to float" ("x"), Correct, "Vulkan: conversions between types";
    DERIVATIVE = "dFdx, dFdy, fwidth, dFdxFine, dFdyFine, fwidthFine, dFdxCoarse, dFdyCoarse, fwidthCoarse" ("p"), EitherDifference, "Vulkan: OpDPdx: fine or coarse; GLSL 1.50 8.8";
}

/// `k = 1 - eta eta (1 - dot(N, I) dot(N, I))`
const REFRACT_K: Formula = formula!((- 1.0 (* (* z z) (- 1.0 (* (dot y x) (dot y x))))));
/// `0` for negative `k`, else `eta I - (eta dot(N, I) + sqrt(k)) N`
const REFRACT_FORMULA: Formula = Formula::IfLess(&[
    REFRACT_K,
    formula!(0.0),
    formula!(0.0),
    Formula::Binary(
        super::Binary::Sub,
        &formula!((* z x)),
        &Formula::Binary(
            super::Binary::Mul,
            &Formula::Binary(
                super::Binary::Add,
                &formula!((* z (dot y x))),
                &Formula::Unary(super::Unary::Sqrt, &Formula::Binary(super::Binary::Max, &REFRACT_K, &formula!(0.0))),
            ),
            &formula!(y),
        ),
    ),
]);
