//! The expected result of each built-in function, by independent formulas in numbers of 320 bits.
//!
//! *Holds:* the `match` over functions has no wildcard, so a new built-in function does not compile until it is named
//! here.

use super::big::Big;
use super::bits;
use super::matrix;
use astro_float_num::BigFloat;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{Scalar, Type};

/// An argument: its scalars, columns first.
pub(super) struct Argument {
    pub(super) ty: Type,
    pub(super) scalar: Scalar,
    pub(super) floats: Vec<f64>,
    pub(super) bits: Vec<u32>,
}

/// The expectation for a scalar of the result.
#[derive(Clone, Debug)]
pub(super) enum Want {
    /// The value, and the largest error of f64.
    Near(Big, f64),
    /// This number; all NaNs are equal.
    Exactly(f64),
    /// These bits of an `int`, `uint` or `bool`.
    Bits(u32),
    /// GLSL leaves the result undefined, or f64 cannot determine it.
    Anything,
}

const EPSILON: f64 = f64::EPSILON;

/// A value, with f64's error as a number of its roundings.
fn near(value: Big, roundings: f64) -> Want {
    let slack = value.approx().abs() * roundings * EPSILON;
    within(value, slack)
}

/// A sum that cancels. The absolute values of the terms add up to `terms`.
pub(super) fn near_sum(value: Big, terms: f64, roundings: f64) -> Want {
    within(value, terms * roundings * EPSILON)
}

fn within(value: Big, slack: f64) -> Want {
    match value.approx() {
        approx if approx.is_finite() => Want::Near(value, slack),
        approx => Want::Exactly(approx),
    }
}

/// Argument `index` as numbers. A scalar is combined with every component.
struct Floats<'a>(&'a [Argument]);

impl Floats<'_> {
    fn at(&self, argument: usize, component: usize) -> f64 {
        let floats = &self.0[argument].floats;
        if floats.len() == 1 { floats[0] } else { floats[component] }
    }
    fn big(&self, argument: usize, component: usize) -> Big {
        Big::of(self.at(argument, component))
    }
    fn vector(&self, argument: usize) -> Vec<Big> {
        self.0[argument].floats.iter().copied().map(Big::of).collect()
    }
}

/// The expected scalars of the result; for `modf`, followed by those of the whole part. `None` if the function does
/// not depend only on its arguments.
pub(super) fn expected(function: F, arguments: &[Argument], count: usize) -> Option<Vec<Want>> {
    let a = Floats(arguments);
    let each = |f: &dyn Fn(usize) -> Want| Some((0..count).map(f).collect());
    let of_float = |f: fn(f64) -> Want| each(&|k| f(a.at(0, k)));
    let is_float = arguments.first().is_some_and(|argument| argument.scalar == Scalar::Float);
    match function {
        F::Radians => each(&|k| near(&(&a.big(0, k) * &Big::pi()) / &Big::of(180.0), 2.0)),
        F::Degrees => each(&|k| near(&(&a.big(0, k) * &Big::of(180.0)) / &Big::pi(), 2.0)),
        F::Sin => of_float(|x| near(Big::of(x).map(BigFloat::sin), 1.0)),
        F::Cos => of_float(|x| near(Big::of(x).map(BigFloat::cos), 1.0)),
        F::Tan => of_float(|x| near(Big::of(x).map(BigFloat::tan), 2.0)),
        F::Asin => of_float(|x| inside(x.abs() <= 1.0, || near(Big::of(x).map(BigFloat::asin), 1.0))),
        F::Acos => of_float(|x| inside(x.abs() <= 1.0, || near(Big::of(x).map(BigFloat::acos), 1.0))),
        F::Atan if arguments.len() == 2 => each(&|k| atan2(a.at(0, k), a.at(1, k))),
        F::Atan => of_float(|x| near(Big::of(x).map(BigFloat::atan), 1.0)),
        F::Sinh => of_float(|x| near(Big::of(x).map(BigFloat::sinh), 2.0)),
        F::Cosh => of_float(|x| near(Big::of(x).map(BigFloat::cosh), 2.0)),
        F::Tanh => of_float(|x| near(Big::of(x).map(BigFloat::tanh), 2.0)),
        F::Asinh => of_float(|x| near(Big::of(x).map(BigFloat::asinh), 4.0)),
        F::Acosh => of_float(|x| inside(x >= 1.0, || near(Big::of(x).map(BigFloat::acosh), 4.0))),
        F::Atanh => of_float(|x| match x.abs() {
            1.0 => Want::Exactly(x * f64::INFINITY),
            size => inside(size < 1.0, || near(Big::of(x).map(BigFloat::atanh), 4.0)),
        }),
        F::Pow => each(&|k| pow(a.at(0, k), a.at(1, k))),
        F::Exp => of_float(|x| near(Big::of(x).map(BigFloat::exp), 1.0)),
        F::Exp2 => of_float(|x| near(Big::of(2.0).pow(&Big::of(x)), 1.0)),
        F::Log => of_float(|x| logarithm(x, 1.0)),
        F::Log2 => of_float(|x| logarithm(x, 2.0)),
        F::Sqrt => of_float(|x| inside(x >= 0.0, || near(Big::of(x).sqrt(), 0.5))),
        F::Inversesqrt => of_float(|x| match x {
            0.0 => Want::Exactly(1.0 / x),
            _ => inside(x > 0.0, || near(&Big::of(1.0) / &Big::of(x).sqrt(), 2.0)),
        }),
        F::Abs if is_float => of_float(|x| Want::Exactly(if x < 0.0 { -x } else { x })),
        F::Sign if is_float => of_float(|x| Want::Exactly(f64::from(i8::from(x > 0.0) - i8::from(x < 0.0)))),
        F::Abs => each(&|k| Want::Bits(integer(arguments, 0, k, Scalar::Int).unsigned_abs() as u32)),
        F::Sign => each(&|k| Want::Bits(integer(arguments, 0, k, Scalar::Int).signum() as u32)),
        F::Floor => of_float(|x| Want::Exactly(Big::of(x).floor().approx())),
        F::Ceil => of_float(|x| Want::Exactly((-&(-&Big::of(x)).floor()).approx())),
        F::Trunc => of_float(|x| Want::Exactly(truncated(x))),
        F::Round | F::RoundEven => of_float(|x| Want::Exactly(to_even(x))),
        F::Fract => of_float(|x| near(&Big::of(x) - &Big::of(x).floor(), 1.0)),
        F::Mod => each(&|k| modulo(a.at(0, k), a.at(1, k))),
        F::Modf => {
            let rest = (0..count).map(|k| Want::Exactly(a.at(0, k) - truncated(a.at(0, k))));
            Some(rest.chain((0..count).map(|k| Want::Exactly(truncated(a.at(0, k))))).collect())
        }
        F::Min | F::Max | F::Clamp => each(&|k| extremum(function, arguments, k)),
        F::Min3 => each(&|k| sorted(arguments, k, 0)),
        F::Mid3 => each(&|k| sorted(arguments, k, 1)),
        F::Max3 => each(&|k| sorted(arguments, k, 2)),
        F::Mix if !is_float => each(&|k| Want::Bits(arguments[if arguments[2].bits[k] != 0 { 1 } else { 0 }].bits[k])),
        F::Mix => each(&|k| match arguments[2].scalar {
            Scalar::Bool => Want::Exactly(a.at(if arguments[2].bits[k] != 0 { 1 } else { 0 }, k)),
            _ => {
                let (x, y, t) = (a.big(0, k), a.big(1, k), a.big(2, k));
                let (from, to) = (&x * &(&Big::of(1.0) - &t), &y * &t);
                let terms = from.approx().abs() + to.approx().abs() + x.approx().abs();
                near_sum(&from + &to, terms, 3.0)
            }
        }),
        F::Step => each(&|k| Want::Exactly(if a.at(1, k) < a.at(0, k) { 0.0 } else { 1.0 })),
        F::Smoothstep => each(&|k| smoothstep(a.at(0, k), a.at(1, k), a.at(2, k))),
        F::Isnan | F::Isinf => each(&|_| Want::Bits(0)),
        F::Length if arguments[0].floats.len() == 1 => of_float(|x| Want::Exactly(x.abs())),
        F::Length => Some(vec![near(length(&a.vector(0)), 4.0)]),
        F::Distance => {
            let gap: Vec<Big> = a.vector(0).iter().zip(&a.vector(1)).map(|(x, y)| x - y).collect();
            Some(vec![near(length(&gap), 6.0)])
        }
        F::Dot => Some(vec![near_sum(dot(&a.vector(0), &a.vector(1)), dot_size(&a, 0, 1), 4.0)]),
        F::Cross => each(&|k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (plus, minus) = (&a.big(0, i) * &a.big(1, j), &a.big(0, j) * &a.big(1, i));
            near_sum(&plus - &minus, plus.approx().abs() + minus.approx().abs(), 2.0)
        }),
        F::Normalize => each(&|k| match length(&a.vector(0)) {
            length if length.is_zero() => Want::Anything,
            length => near(&a.big(0, k) / &length, 6.0),
        }),
        F::Faceforward => {
            let side = dot(&a.vector(2), &a.vector(1)).approx();
            let open = side.abs() <= dot_size(&a, 2, 1) * 4.0 * EPSILON && side != 0.0;
            let sign = if side < 0.0 { 1.0 } else { -1.0 };
            each(&|k| if open { Want::Anything } else { Want::Exactly(sign * a.at(0, k)) })
        }
        F::Reflect => each(&|k| {
            let part = &(&Big::of(2.0) * &dot(&a.vector(1), &a.vector(0))) * &a.big(1, k);
            let terms = a.at(0, k).abs() + 2.0 * dot_size(&a, 1, 0) * a.at(1, k).abs();
            near_sum(&a.big(0, k) - &part, terms, 6.0)
        }),
        F::Refract => each(&|k| refract(&a, k)),
        F::MatrixCompMult => each(&|k| near(&a.big(0, k) * &a.big(1, k), 0.5)),
        F::OuterProduct => each(&|k| {
            let rows = arguments[0].floats.len();
            near(&a.big(0, k % rows) * &a.big(1, k / rows), 0.5)
        }),
        F::Transpose => {
            let Type::Matrix(columns, rows) = arguments[0].ty else { return None };
            let (columns, rows) = (usize::from(columns), usize::from(rows));
            each(&|k| Want::Exactly(a.at(0, k % columns * rows + k / columns)))
        }
        F::Determinant => Some(vec![matrix::determinant(&arguments[0].floats)]),
        F::Inverse => Some(matrix::inverse(&arguments[0].floats)),
        F::LessThan | F::LessThanEqual | F::GreaterThan | F::GreaterThanEqual | F::Equal | F::NotEqual => {
            each(&|k| Want::Bits(u32::from(relation(function, arguments, k))))
        }
        F::Any => Some(vec![Want::Bits(u32::from(arguments[0].bits.contains(&1)))]),
        F::All => Some(vec![Want::Bits(u32::from(!arguments[0].bits.contains(&0)))]),
        F::Not => each(&|k| Want::Bits(1 - arguments[0].bits[k])),
        // §8.9 requires only the range -1 to 1; here it is 0.
        F::Noise1 | F::Noise2 | F::Noise3 | F::Noise4 => each(&|_| Want::Exactly(0.0)),
        // These read other lanes: `text::derivatives_are_differences_in_quads_with_y_up`.
        F::DFdx | F::DFdy | F::Fwidth => None,
        F::DFdxFine | F::DFdyFine | F::FwidthFine | F::DFdxCoarse | F::DFdyCoarse | F::FwidthCoarse => None,
        // `super::textures` and the scenes check these.
        F::TextureSize
        | F::Texture
        | F::TextureProj
        | F::TextureLod
        | F::TextureOffset
        | F::TexelFetch
        | F::TexelFetchOffset
        | F::TextureProjOffset
        | F::TextureLodOffset
        | F::TextureProjLod
        | F::TextureProjLodOffset
        | F::TextureGrad
        | F::TextureGradOffset
        | F::TextureProjGrad
        | F::TextureProjGradOffset
        | F::TextureGather
        | F::TextureGatherOffset
        | F::TextureGatherOffsets
        | F::TextureQueryLod
        | F::TextureQueryLevels => None,
        F::Fma => each(&|k| {
            let product = &a.big(0, k) * &a.big(1, k);
            let terms = product.approx().abs() + a.at(2, k).abs();
            near_sum(&product + &a.big(2, k), terms, 2.0)
        }),
        F::FloatBitsToInt | F::FloatBitsToUint => each(&|k| Want::Bits((a.at(0, k) as f32).to_bits())),
        F::IntBitsToFloat | F::UintBitsToFloat => {
            each(&|k| Want::Exactly(f64::from(f32::from_bits(arguments[0].bits[k]))))
        }
        F::BitfieldExtract | F::BitfieldInsert | F::BitfieldReverse | F::BitCount | F::FindLsb | F::FindMsb => {
            each(&|k| bits::expected(function, arguments, k))
        }
        F::UnpackHalf2x16 => each(&|k| Want::Exactly(bits::unpacked(function, arguments, k))),
        F::UnpackUnorm2x16 | F::UnpackSnorm2x16 | F::UnpackUnorm4x8 | F::UnpackSnorm4x8 => {
            each(&|k| near(Big::of(bits::unpacked(function, arguments, k)), 2.0))
        }
        // In f32, the product before the rounding may be the next number of a tie. The table of operations has tests.
        F::PackUnorm2x16 | F::PackSnorm2x16 | F::PackUnorm4x8 | F::PackSnorm4x8 | F::PackHalf2x16 => {
            each(&|_| Want::Anything)
        }
        // By powers of normal floats.
        F::Ldexp => each(&|k| match integer(arguments, 1, k, Scalar::Int) {
            exponent @ -100..=100 => near(&a.big(0, k) * &Big::of(2.0_f64.powi(exponent as i32)), 1.0),
            _ => Want::Anything,
        }),
        // These write an argument, or need names of the fixed-function pipeline.
        F::Frexp | F::UaddCarry | F::UsubBorrow | F::UmulExtended | F::ImulExtended | F::Ftransform => None,
        // Geometry stages are not supported.
        F::EmitVertex | F::EndPrimitive => None,
    }
}

/// NaN outside the domain.
fn inside(there: bool, value: impl FnOnce() -> Want) -> Want {
    if there { value() } else { Want::Exactly(f64::NAN) }
}

/// The logarithm to the base 2, or the natural one if `base` is 1.
fn logarithm(x: f64, base: f64) -> Want {
    if x == 0.0 {
        return Want::Exactly(f64::NEG_INFINITY);
    }
    inside(x > 0.0, || {
        let natural = Big::of(x).map(BigFloat::ln);
        near(if base == 1.0 { natural } else { &natural / &Big::of(base).map(BigFloat::ln) }, 1.0)
    })
}

fn pow(x: f64, y: f64) -> Want {
    match (x, y) {
        (0.0, _) if x.is_sign_negative() => Want::Anything,
        (_, 0.0) if x >= 0.0 => Want::Exactly(1.0),
        (0.0, _) => Want::Exactly(if y > 0.0 { 0.0 } else { f64::INFINITY }),
        _ => inside(x > 0.0, || near(Big::of(x).pow(&Big::of(y)), 1.0)),
    }
}

fn atan2(y: f64, x: f64) -> Want {
    if y == 0.0 || x == 0.0 {
        return Want::Exactly(y.atan2(x));
    }
    let angle = (&Big::of(y) / &Big::of(x)).map(BigFloat::atan);
    let turned = match (x < 0.0, y < 0.0) {
        (false, _) => angle,
        (true, false) => &angle + &Big::pi(),
        (true, true) => &angle - &Big::pi(),
    };
    near(turned, 1.0)
}

fn truncated(x: f64) -> f64 {
    let size = Big::of(x).abs().floor().approx();
    if x < 0.0 { -size } else { size }
}

fn to_even(x: f64) -> f64 {
    let below = Big::of(x).floor();
    let rest = (&Big::of(x) - &below).approx();
    let below = below.approx();
    let is_odd = (below / 2.0).fract() != 0.0;
    if rest > 0.5 || (rest == 0.5 && is_odd) { below + 1.0 } else { below }
}

fn modulo(x: f64, y: f64) -> Want {
    if y == 0.0 {
        return Want::Anything;
    }
    let (big_x, big_y) = (Big::of(x), Big::of(y));
    let quotient = &big_x / &big_y;
    let steps = quotient.floor();
    let rest = (&quotient - &steps).approx();
    let open = quotient.approx().abs().max(1.0) * EPSILON;
    if rest < open || rest > 1.0 - open {
        // In f64 the quotient may be on the other side of the whole number.
        return if rest == 0.0 && quotient.approx().abs() < 1e15 { Want::Exactly(0.0) } else { Want::Anything };
    }
    let value = &big_x - &(&big_y * &steps);
    near_sum(value, x.abs() + (&big_y * &steps).approx().abs(), 2.0)
}

fn smoothstep(low: f64, high: f64, x: f64) -> Want {
    if low >= high {
        return Want::Anything;
    }
    let t = &(&Big::of(x) - &Big::of(low)) / &(&Big::of(high) - &Big::of(low));
    match t.approx() {
        t if t <= 0.0 => Want::Exactly(0.0),
        t if t >= 1.0 => near(Big::of(1.0), 8.0),
        _ => near(&(&t * &t) * &(&Big::of(3.0) - &(&Big::of(2.0) * &t)), 12.0),
    }
}

/// An integer as its type defines it.
fn integer(arguments: &[Argument], argument: usize, component: usize, scalar: Scalar) -> i64 {
    let bits = &arguments[argument].bits;
    let bits = if bits.len() == 1 { bits[0] } else { bits[component] };
    if scalar == Scalar::Int { i64::from(bits as i32) } else { i64::from(bits) }
}

/// The number at a place in the order of all arguments.
fn sorted(arguments: &[Argument], k: usize, place: usize) -> Want {
    let scalar = arguments[0].scalar;
    if scalar == Scalar::Float {
        let mut all: Vec<f64> = (0..arguments.len()).map(|index| Floats(arguments).at(index, k)).collect();
        all.sort_by(f64::total_cmp);
        return Want::Exactly(all[place]);
    }
    let mut all: Vec<i64> = (0..arguments.len()).map(|index| integer(arguments, index, k, scalar)).collect();
    all.sort_unstable();
    Want::Bits(all[place] as u32)
}

fn extremum(function: F, arguments: &[Argument], k: usize) -> Want {
    let scalar = arguments[0].scalar;
    if scalar == Scalar::Float {
        let a = Floats(arguments);
        let (x, y) = (a.at(0, k), a.at(1, k));
        let larger = if x > y { x } else { y };
        return Want::Exactly(match function {
            F::Min => {
                if x < y {
                    x
                } else {
                    y
                }
            }
            F::Max => larger,
            _ => {
                let most = a.at(2, k);
                if larger < most { larger } else { most }
            }
        });
    }
    let at = |argument| integer(arguments, argument, k, scalar);
    Want::Bits(match function {
        F::Min => at(0).min(at(1)),
        F::Max => at(0).max(at(1)),
        _ => at(0).max(at(1)).min(at(2)),
    } as u32)
}

fn relation(function: F, arguments: &[Argument], k: usize) -> bool {
    let scalar = arguments[0].scalar;
    let order = if scalar == Scalar::Float {
        arguments[0].floats[k].total_cmp(&arguments[1].floats[k])
    } else {
        integer(arguments, 0, k, scalar).cmp(&integer(arguments, 1, k, scalar))
    };
    let zeros = scalar == Scalar::Float && arguments[0].floats[k] == 0.0 && arguments[1].floats[k] == 0.0;
    let order = if zeros { std::cmp::Ordering::Equal } else { order };
    match function {
        F::LessThan => order.is_lt(),
        F::LessThanEqual => order.is_le(),
        F::GreaterThan => order.is_gt(),
        F::GreaterThanEqual => order.is_ge(),
        F::Equal => order.is_eq(),
        _ => order.is_ne(),
    }
}

fn dot(a: &[Big], b: &[Big]) -> Big {
    a.iter().zip(b).fold(Big::of(0.0), |sum, (a, b)| &sum + &(a * b))
}

/// The sum of the terms' absolute values.
fn dot_size(a: &Floats<'_>, first: usize, second: usize) -> f64 {
    a.0[first].floats.iter().zip(&a.0[second].floats).map(|(x, y)| (x * y).abs()).sum()
}

fn length(a: &[Big]) -> Big {
    dot(a, a).sqrt()
}

/// `eta I - (eta d + sqrt(k)) N` with `k = 1 - eta eta (1 - d d)`, `d = dot(N, I)` (§8.4).
fn refract(a: &Floats<'_>, component: usize) -> Want {
    let (eta, one) = (a.big(2, 0), Big::of(1.0));
    let d = dot(&a.vector(1), &a.vector(0));
    let squared = &eta * &eta;
    let k = &one - &(&squared * &(&one - &(&d * &d)));
    // The largest errors of f64's d and k.
    let d_off = 4.0 * EPSILON * dot_size(a, 1, 0);
    let (eta_size, d_size) = (eta.approx().abs(), d.approx().abs());
    let k_off = 8.0 * EPSILON * (1.0 + eta_size * eta_size * (1.0 + d_size * d_size))
        + eta_size * eta_size * (2.0 * d_size + d_off) * d_off;
    let at_k = k.approx();
    if at_k.abs() <= 2.0 * k_off || !k_off.is_finite() {
        return Want::Anything;
    }
    if k.is_negative() {
        return Want::Exactly(0.0);
    }
    let along = &(&eta * &d) + &k.sqrt();
    let along_off = eta_size * d_off + k_off / at_k.sqrt() + 4.0 * EPSILON * (eta_size * d_size + at_k.sqrt());
    let value = &(&eta * &a.big(0, component)) - &(&along * &a.big(1, component));
    let n = a.at(1, component).abs();
    let off = along_off * n + 4.0 * EPSILON * (eta_size * a.at(0, component).abs() + along.approx().abs() * n);
    within(value, off)
}
