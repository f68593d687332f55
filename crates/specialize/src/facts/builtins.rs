//! Built-in functions (§8) on facts.
//!
//! *In:* the facts of the arguments. *Out:* those of the result; empty where nothing is known. Textures are not among
//! them: what they hold is the scene's.

use super::operators::equal_one;
use super::{Call, Fact, Facts, Range, What, at, exact, vectors};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{BinaryOp, Scalar, ScalarValue, Type, UnaryOp};

/// The facts of a call's result.
pub(crate) fn builtin(call: &Call<'_>) -> Facts {
    let len = call.types.flat_len(call.ty) as usize;
    let each = |f: &dyn Fn(&[Fact; 3]) -> Fact| -> Facts {
        (0..len).map(|index| f(&[call.operand(0, index), call.operand(1, index), call.operand(2, index)])).collect()
    };
    match call.function {
        F::Abs | F::Sign | F::Floor | F::Ceil | F::Trunc | F::Fract | F::Round | F::RoundEven => {
            each(&|[x, ..]| one(call.function, call.scalar(), *x))
        }
        F::Min | F::Max => each(&|[x, y, _]| extremum(call.function == F::Min, call.scalar(), *x, *y)),
        F::Clamp => each(&|[x, low, high]| {
            let above = extremum(false, call.scalar(), *x, *low);
            extremum(true, call.scalar(), above, *high)
        }),
        F::Step => each(&|[edge, x, _]| step(*edge, *x)),
        F::Mix => each(&|operands| mix(call, operands)),
        F::Smoothstep => each(&|operands| ranged(operands, Range::between(0.0, 1.0 + 1e-5))),
        F::Sqrt | F::Inversesqrt | F::Exp | F::Exp2 | F::Log | F::Log2 | F::Sin | F::Cos | F::Radians | F::Degrees => {
            each(&|[x, ..]| function(call.function, *x))
        }
        F::Asin | F::Acos | F::Atan => each(&|operands| angle(call, operands)),
        F::Pow => each(&|[x, y, _]| pow(*x, *y)),
        F::Mod => each(&|[x, y, _]| modulo(*x, *y)),
        // Rounded once or twice: both lie in the range.
        F::Fma => each(&|operands| fma(operands)),
        F::Dot => Facts::from_elem(vectors::dot(call), 1),
        F::Length | F::Distance => Facts::from_elem(vectors::length(call), 1),
        F::Normalize => vectors::normalize(call, len),
        F::Cross => vectors::cross(call),
        F::Reflect => vectors::reflect(call),
        F::Refract => vectors::refract(call),
        F::Faceforward => vectors::faceforward(call),
        F::MatrixCompMult => each(&|[x, y, _]| product(*x, *y)),
        F::OuterProduct => outer_product(call),
        F::Transpose => transpose(call),
        F::Isnan | F::Isinf => each(&|[x, ..]| {
            let range = x.range();
            let sure = if call.function == F::Isnan { !range.nan } else { range.is_bounded() };
            Fact::result(if sure { truth(false) } else { What::Any }, &[*x])
        }),
        F::LessThan => each(&|[x, y, _]| compared(BinaryOp::Less, call.scalar(), *x, *y)),
        F::LessThanEqual => each(&|[x, y, _]| compared(BinaryOp::LessEqual, call.scalar(), *x, *y)),
        F::GreaterThan => each(&|[x, y, _]| compared(BinaryOp::Greater, call.scalar(), *x, *y)),
        F::GreaterThanEqual => each(&|[x, y, _]| compared(BinaryOp::GreaterEqual, call.scalar(), *x, *y)),
        F::Equal | F::NotEqual => each(&|[x, y, _]| {
            let equal = equal_one(call.scalar(), *x, *y).map(|equal| equal == (call.function == F::Equal));
            Fact::result(equal.map_or(What::Any, truth), &[*x, *y])
        }),
        F::Not => super::unary(UnaryOp::Not, call.all(0)),
        F::Any | F::All => Facts::from_elem(quantified(call.function == F::All, call.all(0)), 1),
        // Of any other, nothing is known.
        _ => constant_alone(call, len),
    }
}

/// A comparison of two components.
fn compared(op: BinaryOp, scalar: Scalar, x: Fact, y: Fact) -> Fact {
    at(&super::binary(op, scalar, 1, &[x], &[y]), 0)
}

fn truth(value: bool) -> What {
    What::Value(ScalarValue::Bool(value))
}

/// Nothing is known but whether all arguments are constant.
fn constant_alone(call: &Call<'_>, len: usize) -> Facts {
    let operands: Facts = call.arguments.iter().flat_map(|(facts, _)| facts.iter().copied()).collect();
    let complete = call.arguments.iter().all(|(facts, _)| !facts.is_empty());
    if !complete || len > 16 {
        return Facts::new();
    }
    let derivative = matches!(call.function.class(), glisten_front::builtin::operations::Class::Derivative(_));
    let fact = Fact::result(What::Any, &operands);
    Facts::from_elem(Fact { constant: fact.constant && !derivative, ..fact }, len)
}

fn known(fact: Fact) -> Option<f32> {
    match fact.what {
        What::Value(ScalarValue::Float(value)) if exact::is_plain(value) => Some(value),
        _ => None,
    }
}

/// The result of a function whose result lies in a range whenever its arguments are finite.
fn ranged(operands: &[Fact; 3], range: Range) -> Fact {
    let finite = operands.iter().all(|operand| operand.range().is_finite());
    Fact::result(What::Float(Range { nan: !finite, ..range }), operands)
}

fn one(function: F, scalar: Scalar, x: Fact) -> Fact {
    let what = match (x.what, scalar) {
        (What::Value(ScalarValue::Int(value)), _) => match function {
            F::Abs if value > i32::MIN => What::Value(ScalarValue::Int(value.abs())),
            F::Sign => What::Value(ScalarValue::Int(value.signum())),
            _ => What::Any,
        },
        (_, Scalar::Float) => float_one(function, x),
        (_, Scalar::Int) if function == F::Sign => What::Int(-1, 1),
        (What::Int(low, high), _) if function == F::Abs && low > i32::MIN => {
            let least = if low <= 0 && high >= 0 { 0 } else { low.abs().min(high.abs()) };
            What::Int(least, low.abs().max(high.abs()))
        }
        _ => What::Any,
    };
    Fact::result(what, &[x])
}

fn float_one(function: F, x: Fact) -> What {
    let value = known(x).and_then(|x| {
        Some(match function {
            F::Abs => x.abs(),
            F::Sign if x == 0.0 => 0.0,
            F::Sign => x.signum(),
            F::Floor => x.floor(),
            F::Ceil => x.ceil(),
            F::Trunc => x.trunc(),
            F::Fract => x - x.floor(),
            // A half may go either way.
            F::Round | F::RoundEven if (x - x.trunc()).abs() != 0.5 => x.round(),
            _ => return None,
        })
    });
    // What rounds to -0 may be 0 elsewhere.
    if let Some(value) = value.filter(|value| exact::is_plain(*value) && !(*value == 0.0 && value.is_sign_negative())) {
        return What::Value(ScalarValue::Float(value));
    }
    let range = x.range();
    if let Some(value) = decided(function, range) {
        return What::Value(ScalarValue::Float(value));
    }
    What::Float(match function {
        F::Abs => range.abs(),
        F::Sign => Range { nan: range.nan, ..Range::between(-1.0, 1.0) },
        F::Floor => range.growing(f64::floor, 0.0, 0.0),
        F::Ceil => range.growing(f64::ceil, 0.0, 0.0),
        F::Trunc => range.growing(f64::trunc, 0.0, 0.0),
        F::Fract => Range { nan: !range.is_finite(), ..Range::between(0.0, 1.0) },
        F::Round | F::RoundEven => {
            Range { low: range.low.floor(), high: range.high.ceil(), nan: range.nan, negative_zero: true }
        }
        _ => Range::ANY,
    })
}

/// The one value that a function has over a range, where it is not 0: a 0 may have either sign.
fn decided(function: F, range: Range) -> Option<f32> {
    let (low, high) = match function {
        F::Sign => (range.low.signum(), range.high.signum()),
        F::Floor => (range.low.floor(), range.high.floor()),
        F::Ceil => (range.low.ceil(), range.high.ceil()),
        F::Trunc => (range.low.trunc(), range.high.trunc()),
        _ => return None,
    };
    let has_zero = range.low <= 0.0 && range.high >= 0.0;
    let value = low as f32;
    let is_one = low == high && low != 0.0 && f64::from(value) == low && exact::is_plain(value);
    (is_one && !range.nan && !has_zero).then_some(value)
}

fn extremum(least: bool, scalar: Scalar, x: Fact, y: Fact) -> Fact {
    let what = match scalar {
        Scalar::Float => match (known(x), known(y)) {
            // Of 0 and -0 either may come back.
            (Some(a), Some(b)) if a != b || a.to_bits() == b.to_bits() => {
                What::Value(ScalarValue::Float(if least { a.min(b) } else { a.max(b) }))
            }
            _ => point(if least { x.range().min(y.range()) } else { x.range().max(y.range()) }),
        },
        Scalar::Int | Scalar::Uint => {
            let (a, b) = (x.integers(scalar), y.integers(scalar));
            let (low, high) = if least { (a.0.min(b.0), a.1.min(b.1)) } else { (a.0.max(b.0), a.1.max(b.1)) };
            match scalar {
                Scalar::Int if low == high => What::Value(ScalarValue::Int(low as i32)),
                Scalar::Int => What::Int(low as i32, high as i32),
                _ if low == high => What::Value(ScalarValue::Uint(low as u32)),
                _ => What::Uint(low as u32, high as u32),
            }
        }
        Scalar::Bool => What::Any,
    };
    // A value that only one operand leaves open depends on that one as well.
    Fact::result(what, &[x, y])
}

/// A range of one number other than 0, which may have either sign, is that number.
fn point(range: Range) -> What {
    let value = range.low as f32;
    let is_one = range.low == range.high && range.low != 0.0 && !range.nan && f64::from(value) == range.low;
    if is_one && exact::is_plain(value) { What::Value(ScalarValue::Float(value)) } else { What::Float(range) }
}

fn step(edge: Fact, x: Fact) -> Fact {
    // A target may compare the other way round, which a NaN tells.
    let sure = !x.range().nan && !edge.range().nan;
    let what = match x.range().less(edge.range()).filter(|_| sure) {
        Some(below) => What::Value(ScalarValue::Float(if below { 0.0 } else { 1.0 })),
        None => What::Float(Range { negative_zero: false, ..Range::between(0.0, 1.0) }),
    };
    Fact::result(what, &[edge, x])
}

fn mix(call: &Call<'_>, [x, y, a]: &[Fact; 3]) -> Fact {
    let boolean = call.arguments.get(2).and_then(|(_, ty)| call.types.scalar_of(*ty)) == Some(Scalar::Bool);
    if boolean {
        return match a.truth() {
            Some(true) => Fact { constant: y.constant && a.constant, bound: y.bound || a.bound, ..y.apart() },
            Some(false) => Fact { constant: x.constant && a.constant, bound: x.bound || a.bound, ..x.apart() },
            None => Fact { constant: false, ..x.join(*y).apart() },
        };
    }
    let (from, to, weight) = (x.range(), y.range(), a.range());
    if weight.low >= 0.0 && weight.high <= 1.0 && from.is_finite() && to.is_finite() {
        return Fact::result(What::Float(between(from, to, weight.nan)), &[*x, *y, *a]);
    }
    let rest = Range::point(1.0).sub(weight);
    let sum = from.mul(rest).add(to.mul(weight));
    let other = from.add(to.sub(from).mul(weight));
    Fact::result(What::Float(sum.join(other)), &[*x, *y, *a])
}

/// What lies between two numbers. Neither `x * (1 - a) + y * a` nor `x + (y - x) * a` of numbers that are not negative is negative: a rounded
/// difference takes no more away than there is.
fn between(from: Range, to: Range, nan: bool) -> Range {
    let hull = from.join(to);
    let slack = hull.magnitude() * 1e-6;
    let low = if hull.low >= 0.0 { (hull.low - slack).max(0.0) } else { hull.low - slack };
    let negative_zero = !(from.is_plus() && to.is_plus());
    Range { nan, negative_zero, ..Range::between(low, hull.high + slack) }
}

fn function(function: F, x: Fact) -> Fact {
    let range = x.range();
    // Of 0 and -0 the reference makes the same.
    if (range.low, range.high, range.nan) == (0.0, 0.0, false) {
        match function {
            F::Exp | F::Exp2 | F::Cos => return Fact::result(What::Value(ScalarValue::Float(1.0)), &[x]),
            F::Sin => return Fact::result(What::Float(range), &[x]),
            _ => {}
        }
    }
    let what = match function {
        F::Sqrt => range.growing(|x| if x < 0.0 { f64::NAN } else { x.sqrt() }, 8.0, 0.0).at_least(0.0),
        F::Inversesqrt if range.low > 0.0 => {
            let inverse = |x: f64| 1.0 / x.sqrt();
            Range::between(inverse(range.high) * (1.0 - 1e-6), inverse(range.low) * (1.0 + 1e-6))
        }
        F::Inversesqrt => Range { low: 0.0, ..Range::ANY },
        F::Exp => exponential(range, f64::exp),
        F::Exp2 => exponential(range, f64::exp2),
        F::Log => logarithm(range, f64::ln),
        F::Log2 => logarithm(range, f64::log2),
        F::Sin | F::Cos => Range { nan: !range.is_finite(), ..Range::between(-1.001, 1.001) },
        F::Radians => range.mul(Range::between(0.017_453_29, 0.017_453_3)),
        F::Degrees => range.mul(Range::between(57.295_7, 57.295_8)),
        _ => Range::ANY,
    };
    let what = Range { nan: what.nan || range.nan, ..what };
    // Only a root keeps the sign of a zero.
    Fact::result(What::Float(Range { negative_zero: what.negative_zero && what.has_zero(), ..what }), &[x])
}

fn exponential(x: Range, f: fn(f64) -> f64) -> Range {
    let slack = 16.0 + 8.0 * x.magnitude().min(1e6);
    Range { negative_zero: false, ..x.growing(f, slack, 0.0).at_least(0.0) }
}

fn logarithm(x: Range, f: fn(f64) -> f64) -> Range {
    let of_positive = |x: Range| x.growing(f, 16.0, 1e-6);
    if x.low <= 0.0 {
        let greatest = Range { low: x.high, nan: false, ..x };
        let high = if x.high > 0.0 { of_positive(greatest).high } else { f64::INFINITY };
        return Range { low: f64::NEG_INFINITY, high, nan: x.nan || x.low < 0.0, negative_zero: true };
    }
    of_positive(x)
}

fn angle(call: &Call<'_>, operands: &[Fact; 3]) -> Fact {
    // A little more than pi.
    let pi = std::f64::consts::PI + 1e-3;
    let [x, y, _] = operands;
    match call.function {
        F::Atan if call.arguments.len() == 2 => {
            let finite =
                x.range().is_finite() && y.range().is_finite() && !(x.range().has_zero() && y.range().has_zero());
            Fact::result(What::Float(Range { nan: !finite, ..Range::between(-pi, pi) }), &[*x, *y])
        }
        F::Atan => Fact::result(What::Float(Range { nan: x.range().nan, ..Range::between(-1.58, 1.58) }), &[*x]),
        F::Asin | F::Acos => {
            let range = x.range();
            let inside = !range.nan && range.low >= -1.0 && range.high <= 1.0;
            Fact::result(What::Float(Range { nan: !inside, ..Range::between(-pi, pi) }), &[*x])
        }
        _ => Fact::result(What::Any, operands),
    }
}

/// `exp2(y * log2(x))`
fn pow(x: Fact, y: Fact) -> Fact {
    let (base, exponent) = (x.range(), y.range());
    let what = match () {
        () if base.low < 0.0 || exponent.nan => Range::ANY,
        () if exponent.low > 0.0 && exponent.is_bounded() && base.high <= 1.0 => {
            // Near 1 a logarithm may miss by 2^-21.
            Range { negative_zero: false, ..Range::between(0.0, (exponent.high * 1e-6).exp2() * (1.0 + 1e-5)) }
        }
        () if exponent.low > 0.0 && exponent.is_bounded() => {
            let high = base.high.max(1.0).powf(exponent.high) * (1.0 + exponent.high * 1e-5 + 1e-3);
            let high = if high.is_finite() && high < super::GREATEST { high } else { f64::INFINITY };
            Range { negative_zero: false, ..Range::between(0.0, high) }
        }
        () => Range { low: 0.0, ..Range::ANY },
    };
    let nan = what.nan || base.nan;
    Fact::result(What::Float(Range { nan, ..what }), &[x, y])
}

fn modulo(x: Fact, y: Fact) -> Fact {
    let (dividend, divisor) = (x.range(), y.range());
    let finite = dividend.is_finite() && divisor.is_finite() && !divisor.has_zero();
    // A quotient that overflows makes anything of the difference.
    let what = if finite && dividend.div(divisor).is_finite() {
        let reach = divisor.magnitude() + dividend.magnitude() * 1e-6;
        Range::between(-reach, reach)
    } else {
        Range::ANY
    };
    Fact::result(What::Float(what), &[x, y])
}

/// `x * y + z`; what a fused sum rounds to 0 keeps its sign.
fn fma(operands: &[Fact; 3]) -> Fact {
    let [x, y, z] = operands.map(Fact::range);
    let product = x.mul(y);
    let sum = product.add(z);
    let negative_zero = sum.has_zero() && (product.negative_zero || z.negative_zero);
    Fact::result(What::Float(Range { negative_zero, ..sum }), operands)
}

fn product(x: Fact, y: Fact) -> Fact {
    at(&super::binary(BinaryOp::Mul, Scalar::Float, 1, &[x], &[y]), 0)
}

fn outer_product(call: &Call<'_>) -> Facts {
    let (column, row) = (call.all(0), call.all(1));
    row.iter().flat_map(|b| column.iter().map(move |a| product(*a, *b))).collect()
}

fn transpose(call: &Call<'_>) -> Facts {
    let Type::Matrix(columns, rows) = call.types.get(call.ty) else { return Facts::new() };
    let (columns, rows) = (usize::from(columns), usize::from(rows));
    let facts = call.all(0);
    (0..columns).flat_map(|column| (0..rows).map(move |row| at(facts, row * columns + column).apart())).collect()
}

fn quantified(all: bool, facts: &[Fact]) -> Fact {
    let decisive = facts.iter().find(|fact| fact.truth() == Some(!all));
    let open = facts.is_empty() || facts.iter().any(|fact| fact.truth().is_none());
    let what = match decisive {
        Some(_) => truth(!all),
        None if open => What::Any,
        None => truth(all),
    };
    let operands = if facts.is_empty() { &[Fact::ANY] } else { facts };
    Fact::result(what, operands)
}

#[cfg(test)]
mod tests {
    use super::{Call, Fact, Range, builtin};
    use crate::facts::{Facts, at};
    use glisten_front::builtin::BuiltinFunction as F;
    use glisten_front::hir::{TypeId, Types};

    /// Functions of one number and of two, by their formulas in f64.
    type OfOne = fn(f64) -> f64;
    type OfTwo = fn(f64, f64) -> f64;

    const FUNCTIONS: &[(F, OfOne)] = &[
        (F::Exp, f64::exp),
        (F::Exp2, f64::exp2),
        (F::Log, f64::ln),
        (F::Log2, f64::log2),
        (F::Sqrt, f64::sqrt),
        (F::Inversesqrt, |x| 1.0 / x.sqrt()),
        (F::Sin, f64::sin),
        (F::Cos, f64::cos),
        (F::Asin, f64::asin),
        (F::Acos, f64::acos),
        (F::Atan, f64::atan),
        (F::Abs, f64::abs),
        (F::Sign, |x| if x == 0.0 { 0.0 } else { x.signum() }),
        (F::Floor, f64::floor),
        (F::Ceil, f64::ceil),
        (F::Trunc, f64::trunc),
        (F::Fract, |x| x - x.floor()),
        (F::RoundEven, f64::round_ties_even),
        (F::Radians, f64::to_radians),
        (F::Degrees, f64::to_degrees),
        (F::Length, f64::abs),
    ];
    const PAIRS: &[(F, OfTwo)] = &[
        (F::Min, f64::min),
        (F::Max, f64::max),
        (F::Step, |edge, x| if x < edge { 0.0 } else { 1.0 }),
        (F::Pow, f64::powf),
        (F::Mod, |x, y| x - y * (x / y).floor()),
        (F::Atan, f64::atan2),
        (F::Distance, |x, y| (x - y).abs()),
        (F::Dot, |x, y| x * y),
    ];
    const ENDS: &[f64] =
        &[-1e30, -1000.0, -2.5, -1.0, -1e-6, 0.0, 1e-30, 1e-20, 0.1, 0.5, 0.99, 1.0, 1.5, 3.0, 88.0, 1e6, 1e30];

    fn range(function: F, arguments: &[Range]) -> Range {
        let arguments: Vec<(Facts, TypeId)> =
            arguments.iter().map(|range| (Facts::from_elem(Fact::in_range(*range), 1), TypeId::FLOAT)).collect();
        let call = Call { types: &Types::new(), function, arguments: &arguments, ty: TypeId::FLOAT, twice: false };
        at(&builtin(&call), 0).range()
    }

    /// All ranges between two of the ends, with numbers in them. All are numbers of f32.
    fn ranges() -> impl Iterator<Item = (Range, [f64; 5])> {
        let single = |value: f64| f64::from(value as f32);
        let ends = move || ENDS.iter().map(move |end| single(*end));
        let pairs = ends().enumerate().flat_map(move |(index, low)| ends().skip(index).map(move |high| (low, high)));
        pairs.map(move |(low, high)| {
            let within = [0.0, 0.25, 0.5, 0.75, 1.0].map(|share| single(low + (high - low) * share).clamp(low, high));
            (Range::between(low, high), within)
        })
    }

    /// Whether a result, rounded or not, is in a range. What vanishes or overflows in f32 is not judged in f64.
    fn has(range: Range, result: f64) -> bool {
        let single = f64::from(result as f32);
        let is_in = |value: f64| if value.is_nan() { range.nan } else { range.low <= value && value <= range.high };
        is_in(single) && (single == 0.0 || single.is_infinite() || is_in(result))
    }

    #[test]
    fn a_range_has_all_that_a_function_of_numbers_in_a_range_may_be() {
        let mut wrong = Vec::new();
        for (x, within) in ranges() {
            for (function, of) in FUNCTIONS {
                let result = range(*function, &[x]);
                let missed = within.iter().find(|x| !has(result, of(**x)));
                wrong.extend(missed.map(|missed| format!("{}({missed:e}) of {x:?}: {result:?}", function.name())));
            }
            for (y, others) in ranges().step_by(5) {
                for (function, of) in PAIRS {
                    let result = range(*function, &[x, y]);
                    let all = within.iter().flat_map(|x| others.iter().map(move |y| (*x, *y)));
                    let missed = all.into_iter().find(|(x, y)| !has(result, of(*x, *y)));
                    wrong.extend(
                        missed.map(|missed| format!("{}{missed:?} of {x:?}, {y:?}: {result:?}", function.name())),
                    );
                }
            }
        }
        assert!(wrong.is_empty(), "{} are wrong:\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
    }
}
