//! The range of a float expression: bounds of its components, and whether they are known to be reached.
//!
//! *In:* an expression of a function. *Out:* a [`Range`]. *Holds:* a bound that is not known to be reached proves nothing about a
//! fault, so a rule asks for both: the bound, and that it is reached. What is unknown is unbounded and reaches nothing. The bounds
//! are those of exact arithmetic, except where the rounding of a product of unit vectors passes 1.
//! *Not done here:* conditions around the expression ([`Place::is_guarded`]).

use super::interval::Range;
use super::rate::{Rate, rate};
use super::subject::Place;
use crate::builtin::{BuiltinFunction as B, BuiltinVariable};
use crate::hir::{BinaryOp, ConstructKind, ExprId, ExprKind, Scalar, Type, UnaryOp, VarRef};

/// The largest that the product of two unit vectors can be after rounding.
const BEYOND_ONE: f64 = 1.0 + 1.0 / 4_194_304.0;

/// How deep expressions are followed.
const DEPTH: u32 = 48;

/// The range of a float expression; the components of a vector share one.
pub(super) fn range(place: &Place<'_>, id: ExprId) -> Range {
    walk(place, id, 0)
}

fn walk(place: &Place<'_>, id: ExprId, depth: u32) -> Range {
    if depth > DEPTH || !is_number(place, id) {
        return Range::UNKNOWN;
    }
    if let Some(known) = place.ranges.borrow().get(&id) {
        return *known;
    }
    let found = of(place, id, depth + 1);
    place.ranges.borrow_mut().insert(id, found);
    found
}

fn is_number(place: &Place<'_>, id: ExprId) -> bool {
    matches!(place.ty(id), Type::Scalar(scalar) | Type::Vector(scalar, _) if scalar != Scalar::Bool)
}

fn of(place: &Place<'_>, id: ExprId, depth: u32) -> Range {
    let inner = |id: ExprId| walk(place, id, depth);
    match place.kind(id) {
        ExprKind::Literal(_) => literal(place, id),
        ExprKind::Var(variable) => variable_range(place, id, *variable, depth),
        ExprKind::Swizzle(vector, _) => component(place, *vector, depth),
        ExprKind::Index(vector, _) if place.is_vector(*vector) => component(place, *vector, depth),
        ExprKind::Convert(value) => match place.ty(*value) {
            Type::Scalar(Scalar::Bool) | Type::Vector(Scalar::Bool, _) => Range::reached(0.0, 1.0),
            Type::Scalar(Scalar::Uint) | Type::Vector(Scalar::Uint, _) => Range { low: 0.0, ..inner(*value) },
            _ => inner(*value),
        },
        ExprKind::Construct(ConstructKind::Splat | ConstructKind::Compose, parts) => {
            parts.iter().map(|&part| inner(part)).reduce(Range::hull).unwrap_or(Range::UNKNOWN)
        }
        ExprKind::Unary(UnaryOp::Negate, value) => inner(*value).negated(),
        ExprKind::Binary(operator, a, b) => binary(place, *operator, (*a, *b), depth),
        ExprKind::Ternary(_, yes, no) => {
            let both = inner(*yes).hull(inner(*no));
            Range::within(both.low, both.high)
        }
        ExprKind::BuiltinCall(function, arguments) => call(place, *function, arguments, depth),
        _ => Range::UNKNOWN,
    }
}

fn literal(place: &Place<'_>, id: ExprId) -> Range {
    use crate::hir::ScalarValue::{Float, Int, Uint};
    match place.kind(id) {
        ExprKind::Literal(Float(value)) => Range::reached(f64::from(*value), f64::from(*value)),
        ExprKind::Literal(Int(value)) => Range::reached(f64::from(*value), f64::from(*value)),
        ExprKind::Literal(Uint(value)) => Range::reached(f64::from(*value), f64::from(*value)),
        _ => Range::UNKNOWN,
    }
}

fn variable_range(place: &Place<'_>, id: ExprId, variable: VarRef, depth: u32) -> Range {
    match variable {
        VarRef::Local(local) => match place.definition(local) {
            Some(value) => walk(place, value, depth),
            None => constant(place, id),
        },
        VarRef::Global(global) => match place.shader.global(global).builtin {
            Some(BuiltinVariable::FragCoord) => Range::within(0.0, f64::INFINITY),
            Some(BuiltinVariable::PointCoord) => Range::reached(0.0, 1.0),
            Some(BuiltinVariable::VertexId | BuiltinVariable::InstanceId) => Range::within(0.0, f64::INFINITY),
            _ => constant(place, id),
        },
    }
}

fn constant(place: &Place<'_>, id: ExprId) -> Range {
    let Some(numbers) = place.numbers(id).filter(|numbers| numbers.iter().all(|number| number.is_finite())) else {
        return Range::UNKNOWN;
    };
    let points = numbers.iter().map(|&number| Range::reached(f64::from(number), f64::from(number)));
    points.reduce(Range::hull).unwrap_or(Range::UNKNOWN)
}

/// One component of a vector. That of a unit vector takes every value from -1 to 1.
fn component(place: &Place<'_>, vector: ExprId, depth: u32) -> Range {
    if is_unit(place, vector) && rate(place, vector) == Rate::Invocation {
        return Range::reached(-1.0, 1.0);
    }
    let whole = walk(place, vector, depth);
    // Which component has the bound is not known, unless all have the same.
    if let ExprKind::Construct(ConstructKind::Compose, _) = place.kind(place.meaning(vector)) {
        return Range::within(whole.low, whole.high);
    }
    whole
}

fn binary(place: &Place<'_>, operator: BinaryOp, (a, b): (ExprId, ExprId), depth: u32) -> Range {
    let (left, right) = (walk(place, a, depth), walk(place, b, depth));
    match operator {
        BinaryOp::Add => left.plus(right),
        BinaryOp::Sub if place.same(a, b) => Range::reached(0.0, 0.0),
        BinaryOp::Sub => left.plus(right.negated()),
        BinaryOp::Mul if place.same(a, b) => {
            let size = left.abs();
            Range { low: size.low * size.low, high: size.high * size.high, ..size }
        }
        BinaryOp::Mul => left.times(right),
        BinaryOp::Div if right.is_point() && right.low != 0.0 => {
            let inverse = 1.0 / right.low;
            left.times(Range::reached(inverse, inverse))
        }
        BinaryOp::Div if left.low >= 0.0 && right.low >= 0.0 => Range::within(0.0, f64::INFINITY),
        _ => Range::UNKNOWN,
    }
}

/// The range of a built-in function.
fn call(place: &Place<'_>, function: B, arguments: &[ExprId], depth: u32) -> Range {
    let of = |index: usize| arguments.get(index).map_or(Range::UNKNOWN, |&argument| walk(place, argument, depth));
    let varies = || arguments.iter().any(|&argument| rate(place, argument) > Rate::Constant);
    match function {
        B::Sin | B::Cos if varies() => Range::reached(-1.0, 1.0),
        B::Sin | B::Cos => Range::within(-1.0, 1.0),
        B::Abs => of(0).abs(),
        B::Sign => Range::within(-1.0, 1.0),
        B::Fract if varies() => Range { reaches_high: false, ..Range::reached(0.0, 1.0) },
        B::Fract => Range::within(0.0, 1.0),
        B::Floor => of(0).under(f64::floor),
        B::Ceil => of(0).under(f64::ceil),
        B::Exp => of(0).under(f64::exp),
        B::Exp2 => of(0).under(f64::exp2),
        B::Sqrt => of(0).under(|value| value.max(0.0).sqrt()),
        B::Inversesqrt => Range::within(0.0, f64::INFINITY),
        B::Acos => Range::within(0.0, std::f64::consts::PI),
        B::Length | B::Distance => Range::within(0.0, f64::INFINITY),
        B::Pow => Range::within(0.0, f64::INFINITY),
        B::Max => of(0).at_least(of(1)),
        B::Min => of(0).at_most(of(1)),
        B::Clamp => of(0).at_least(of(1)).at_most(of(2)),
        B::Mix => {
            let both = of(0).hull(of(1));
            let weight = arguments.get(2).map_or(Range::UNKNOWN, |&weight| walk(place, weight, depth));
            if weight.low >= 0.0 && weight.high <= 1.0 { Range::within(both.low, both.high) } else { Range::UNKNOWN }
        }
        B::Step | B::Smoothstep if varies() => Range::reached(0.0, 1.0),
        B::Step | B::Smoothstep => Range::within(0.0, 1.0),
        B::Normalize => Range::within(-1.0, 1.0),
        B::Radians => of(0).times(Range::reached(std::f64::consts::PI / 180.0, std::f64::consts::PI / 180.0)),
        B::Dot => match arguments {
            [a, b] => dot(place, *a, *b, depth),
            _ => Range::UNKNOWN,
        },
        _ => Range::UNKNOWN,
    }
}

/// The range of a product of vectors: of a vector with itself, of directions, or of anything.
fn dot(place: &Place<'_>, a: ExprId, b: ExprId, depth: u32) -> Range {
    if place.same(place.meaning(a), place.meaning(b)) {
        return Range::within(0.0, if is_unit(place, a) { BEYOND_ONE } else { f64::INFINITY });
    }
    let (first, second) = (is_unit(place, a), is_unit(place, b));
    let differ = rate(place, a).max(rate(place, b)) == Rate::Invocation;
    if first && second {
        let bounds = Range::within(-BEYOND_ONE, BEYOND_ONE);
        return Range { reaches_low: differ, reaches_high: differ, ..bounds };
    }
    let (left, right) = (walk(place, a, depth), walk(place, b, depth));
    if left.low >= 0.0 && right.low >= 0.0 {
        return Range::within(0.0, f64::INFINITY);
    }
    // A direction meets other vectors on both sides.
    let both = differ && (first || second) && left.low < 0.0 && right.low < 0.0;
    Range { reaches_low: both, reaches_high: both, ..Range::UNKNOWN }
}

/// Whether a vector has the length 1 but for rounding.
pub(super) fn is_unit(place: &Place<'_>, id: ExprId) -> bool {
    let mut at = place.meaning(id);
    loop {
        match place.kind(at) {
            ExprKind::BuiltinCall(B::Normalize, _) => return true,
            ExprKind::BuiltinCall(B::Reflect, arguments) => {
                let both = arguments.iter().all(|&argument| {
                    matches!(place.kind(place.meaning(argument)), ExprKind::BuiltinCall(B::Normalize, _))
                        || matches!(place.kind(place.meaning(argument)), ExprKind::Unary(UnaryOp::Negate, inner)
                            if matches!(place.kind(place.meaning(*inner)), ExprKind::BuiltinCall(B::Normalize, _)))
                });
                return both;
            }
            ExprKind::Unary(UnaryOp::Negate, inner) => at = place.meaning(*inner),
            _ => {
                let numbers = place.numbers(at).filter(|_| place.is_vector(at));
                let square = numbers.map(|all| all.iter().map(|one| f64::from(*one).powi(2)).sum::<f64>());
                return square.is_some_and(|square| (square - 1.0).abs() < 1e-6);
            }
        }
    }
}
