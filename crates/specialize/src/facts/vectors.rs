//! Functions of whole vectors (§8.5) on facts.
//!
//! *In:* the facts of the arguments. *Out:* those of the result. *Holds:* beside the range of each component, the length of a vector
//! limits what a function makes of it: by the inequality of Cauchy and Schwarz, `dot` of two unit vectors is at most 1.

use super::operators::sum_of_products;
use super::{Call, Fact, Facts, GREATEST, Range, What, at, norm, unary};
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::UnaryOp;

/// What a result may be longer than the exact one, relative: far more than the rounding of a few operations.
const SLACK: f64 = 1e-5;

/// A range of what is not above a length.
fn within(range: Range, most: f64) -> Range {
    let most = most * (1.0 + SLACK);
    let (low, high) = (range.low.max(-most), range.high.min(most));
    if most <= GREATEST && low <= high { Range { low, high, ..range } } else { range }
}

/// Components that are at most that long together.
fn limited(facts: impl IntoIterator<Item = Fact>, most: f64) -> Facts {
    let norm = if most <= GREATEST / 2.0 { (most * (1.0 + SLACK)) as f32 } else { f32::INFINITY };
    let limit = |fact: Fact| match fact.what {
        What::Value(_) => Fact { norm, ..fact },
        _ => Fact { what: What::Float(within(fact.range(), most)), norm, ..fact },
    };
    facts.into_iter().map(limit).collect()
}

pub(super) fn dot(call: &Call<'_>) -> Fact {
    let pairs = call.pairs();
    let fact = sum_of_products(&pairs);
    if fact.value().is_some() {
        return fact;
    }
    let most = norm(call.all(0)) * norm(call.all(1));
    let range = if call.twice {
        let terms: Vec<Range> = pairs.iter().map(|(x, _)| x.range().square()).collect();
        Range { negative_zero: false, ..Range::sum(&terms) }
    } else {
        fact.range()
    };
    Fact { what: What::Float(within(range, most)), ..fact }
}

pub(super) fn length(call: &Call<'_>) -> Fact {
    let pairs = call.pairs();
    let distance = call.function == F::Distance;
    let terms: Vec<Range> = pairs
        .iter()
        .map(|(x, y)| if distance { x.range().sub(y.range()).square() } else { x.range().square() })
        .collect();
    let sum = Range::sum(&terms);
    let root = sum.growing(f64::sqrt, 16.0, 0.0).at_least(0.0);
    let most = if distance { norm(call.all(0)) + norm(call.all(1)) } else { norm(call.all(0)) };
    let operands: Facts = call.arguments.iter().flat_map(|(facts, _)| facts.iter().copied()).collect();
    let range = Range { nan: sum.nan, negative_zero: false, ..within(root, most) };
    Fact::result(What::Float(range), &operands)
}

pub(super) fn normalize(call: &Call<'_>, len: usize) -> Facts {
    let facts = call.all(0);
    let terms: Vec<Range> = (0..len).map(|index| at(facts, index).range().square()).collect();
    let square = Range::sum(&terms);
    let operands = if facts.is_empty() { &[Fact::ANY] } else { facts };
    if !square.is_finite() || square.low <= 1e-30 || square.high >= 1e30 {
        return Facts::from_elem(Fact::result(What::Float(Range::ANY), operands), len);
    }
    // A component keeps its sign.
    let length = Range::between(square.low.sqrt() * (1.0 - SLACK), square.high.sqrt() * (1.0 + SLACK));
    let unit = |index: usize| {
        let range = at(facts, index).range().div(length);
        Fact::result(What::Float(Range { nan: false, ..range }), operands)
    };
    limited((0..len).map(unit), 1.0)
}

pub(super) fn cross(call: &Call<'_>) -> Facts {
    let (a, b) = (call.all(0), call.all(1));
    let component = |i: usize, j: usize| {
        let fact = sum_of_products(&[(at(a, i), at(b, j)), (negated(at(a, j)), at(b, i))]);
        Fact { what: What::Float(Range { negative_zero: true, ..fact.range() }), ..fact }
    };
    limited([component(1, 2), component(2, 0), component(0, 1)], norm(a) * norm(b))
}

/// `i - 2.0 * dot(n, i) * n`: no longer than `i`, if `n` is no longer than 1.
pub(super) fn reflect(call: &Call<'_>) -> Facts {
    let (i, n) = (call.all(0), call.all(1));
    let twice = Range::point(2.0).mul(dot(call).range());
    let square = norm(n).powi(2);
    let operands = operands(call);
    let pairs = call.pairs();
    let component = |(i, n): &(Fact, Fact)| {
        let range = i.range().sub(twice.mul(n.range()));
        Fact::result(What::Float(Range { negative_zero: true, ..range }), &operands)
    };
    // |r|^2 = |i|^2 - 4 dot(n, i)^2 (1 - |n|^2)
    let most = norm(i) * (1.0 + (4.0 * square * (square - 1.0)).max(0.0)).sqrt();
    limited(pairs.iter().map(component), most)
}

/// 0, or `eta * i - (eta * dot(n, i) + sqrt(k)) * n` with `k = 1.0 - eta * eta * (1.0 - dot(n, i) * dot(n, i))`.
pub(super) fn refract(call: &Call<'_>) -> Facts {
    let (i, n) = (norm(call.all(0)), norm(call.all(1)));
    let eta = at(call.all(2), 0).range().magnitude();
    let along = eta * i * n;
    let most = eta * i + (along + (1.0 + along * along).sqrt() * (1.0 + SLACK)) * n;
    let operands = operands(call);
    // Beyond that, a square may overflow.
    let is_sure = most < 1e15 && operands.iter().all(|fact| fact.range().is_finite());
    let range = if is_sure { Range::between(-most, most) } else { Range::ANY };
    let fact = Fact::result(What::Float(range), &operands);
    let all = std::iter::repeat_n(fact, call.pairs().len());
    if is_sure { limited(all, most) } else { all.collect() }
}

/// `n` or `-n`.
pub(super) fn faceforward(call: &Call<'_>) -> Facts {
    let n = call.all(0);
    let operands = operands(call);
    let either = |fact: &Fact| Fact::result(fact.join(negated(*fact)).what, &operands);
    limited(n.iter().map(either), norm(n))
}

fn negated(fact: Fact) -> Fact {
    at(&unary(UnaryOp::Negate, &[fact]), 0)
}

/// The facts of all arguments; one of which nothing is known is among them where some are missing.
fn operands(call: &Call<'_>) -> Facts {
    let all = call.arguments.iter().flat_map(|(facts, _)| facts.iter().copied());
    let missing = call.arguments.iter().any(|(facts, _)| facts.is_empty());
    all.chain(missing.then_some(Fact::ANY)).collect()
}
