//! What a built-in function demands of its arguments, and which hand on what is demanded of their results.
//!
//! *In:* a function with the facts of its arguments. *Out:* a [`Demand`] for each. *Holds:* the classes and operations of the
//! table are matched without a wildcard, so a new row does not compile until it is judged here; what cannot be judged keeps its
//! arguments.
//!
//! | function | what a driver may do with a literal | so |
//! | --- | --- | --- |
//! | `dot`, `cross`, `outerProduct`, `fma` and so on | what it does with products and sums | as of these |
//! | `fma(x, a, 0.0)` | write a product, and join it with others | no 0 |
//! | `fma(x, 1.0, y)` | write a sum, in which `x` and `y` may cancel | no 1 unless one is finite |
//! | `mix(a, b, c)` | drop `a` or `b` | kept unless both are finite |
//! | `pow(x, c)` | write products, roots or 1 | kept unless `x` >= 0 and `c` > 0 |
//! | `min`, `max`, `clamp` | saturate, which turns a NaN to 0 | kept where another argument may be NaN |
//! | `clamp` | refuse limits that are the wrong way round | kept unless they are in order |
//! | `normalize(v)`, `reflect` | drop what a component of 0 is multiplied with | no 0 unless the rest is finite |
//! | `smoothstep`, `mod`, lookups with a divisor | divide by it at once | kept unless that is defined |
//! | `bitfieldExtract` and so on | refuse what is out of range | kept unless it is known to be in range |

#![deny(
    clippy::wildcard_enum_match_arm,
    reason = "what is added to the language does not pass until it is judged here"
)]

use super::Demand;
use super::operands::{Operands, Own, has_reciprocal, keep_unless, product, quotient, sum, whole, zero_unless};
use crate::facts::{Fact, Range, at};
use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::operations::{
    Binary, BitFunction, Class, Composite, MatrixFunction, Numbers, Ternary, TextureForm, Unary,
};
use glisten_front::hir::{BinaryOp, Scalar, ScalarValue};
use smallvec::smallvec;

/// The demands of a function on its arguments.
pub(super) fn own(function: BuiltinFunction, operands: &Operands<'_>) -> Own {
    let mut demands: Own = smallvec![Demand::NONE; operands.len()];
    let own = of_class(function.class(), operands);
    demands.iter_mut().zip(own).for_each(|(slot, demand)| *slot = demand);
    demands
}

/// Whether it is made of products and sums, of which a driver that finds a 0 may give a 0 of either sign.
pub(super) fn loses_signs(class: Class) -> bool {
    match class {
        Class::Ternary(op) => matches!(op, Ternary::Mix | Ternary::Fma),
        Class::Numbers(op) => op == Numbers::Mix,
        Class::Composite(op) => matches!(op, Composite::Dot | Composite::Cross | Composite::Reflect),
        Class::Matrix(op) => matches!(op, MatrixFunction::ComponentProduct | MatrixFunction::OuterProduct),
        Class::Binary(_)
        | Class::Unary(_)
        | Class::Bits(_)
        | Class::Texture(_)
        | Class::Derivative(_)
        | Class::Noise(_)
        | Class::Modf
        | Class::Relation(_)
        | Class::Boolean(_)
        | Class::Test(_)
        | Class::BitCast(_)
        | Class::Packing(_)
        | Class::Composed
        | Class::Emission(_) => false,
    }
}

/// One demand for all.
fn each(demand: Demand) -> Own {
    smallvec![demand; 4]
}

fn of_class(class: Class, operands: &Operands<'_>) -> Own {
    match class {
        Class::Binary(op) => binary(op, operands),
        Class::Ternary(op) => ternary(op, operands),
        Class::Numbers(op) => numbers(op, operands),
        Class::Composite(op) => composite(op, operands),
        Class::Matrix(MatrixFunction::ComponentProduct) => pairs(operands, |a, b| product(a, b, false)),
        Class::Matrix(MatrixFunction::OuterProduct) => all_pairs(operands),
        Class::Bits(op) => bits(op, operands),
        Class::Texture(form) => lookup(form, operands),
        // What is known of the one argument is known of the result, or a driver computes it by its own rules: see
        // `is_constant_without_value`.
        Class::Unary(_)
        | Class::Matrix(MatrixFunction::Transpose)
        | Class::Derivative(_)
        | Class::Noise(_)
        | Class::Modf => each(Demand::NONE),
        // No float comes out of them, or none that is computed.
        Class::Relation(_) | Class::Boolean(_) | Class::Test(_) | Class::BitCast(_) | Class::Packing(_) => {
            each(Demand::NONE)
        }
        // Nobody writes these in a typed program, or they have no arguments.
        Class::Composed | Class::Emission(_) => each(Demand::KEEP),
    }
}

/// The demands of all components of two arguments.
fn pairs(operands: &Operands<'_>, judge: impl Fn(Fact, Fact) -> [Demand; 2]) -> Own {
    let mut demands: Own = smallvec![Demand::NONE; 2];
    for index in 0..operands.components() {
        let [x, y] = judge(operands.fact(0, index), operands.fact(1, index));
        demands[0] = demands[0].and(x);
        demands[1] = demands[1].and(y);
    }
    demands
}

/// Those of products of every component with every other.
fn all_pairs(operands: &Operands<'_>) -> Own {
    let mut demands: Own = smallvec![Demand::NONE; 2];
    let known = |index: usize| -> &[Fact] {
        if operands.facts(index).is_empty() { &[Fact::ANY] } else { operands.facts(index) }
    };
    for a in known(0) {
        for b in known(1) {
            let [x, y] = product(*a, *b, false);
            demands[0] = demands[0].and(x);
            demands[1] = demands[1].and(y);
        }
    }
    demands
}

fn binary(op: Binary, operands: &Operands<'_>) -> Own {
    match op {
        Binary::Pow => pairs(operands, power),
        Binary::Mod => {
            let facts = operands.facts(1);
            let apart = !facts.is_empty() && facts.iter().all(|fact| !fact.range().has_zero());
            smallvec![zero_unless(operands.is_finite(1) && apart), keep_unless(apart && operands.is_finite(0))]
        }
        Binary::Min | Binary::Max => extremum(operands),
        // A comparison: what it gives is 0 or 1.
        Binary::Step => each(Demand::NONE),
        Binary::Add | Binary::Sub => pairs(operands, sum),
        Binary::Mul => pairs(operands, |a, b| product(a, b, false)),
        Binary::Div => pairs(operands, quotient),
        Binary::Atan2 => smallvec![zero_unless(operands.is_finite(1)), zero_unless(operands.is_finite(0))],
    }
}

fn ternary(op: Ternary, operands: &Operands<'_>) -> Own {
    match op {
        Ternary::Clamp => clamp(operands),
        Ternary::Mix => mix(operands),
        Ternary::Smoothstep => {
            let apart = (0..operands.components()).all(|index| {
                let width = operands.fact(1, index).range().sub(operands.fact(0, index).range());
                !width.has_zero() && width.is_finite()
            });
            let edges = keep_unless(apart && operands.is_finite(2));
            smallvec![edges, edges, Demand::NONE]
        }
        Ternary::Fma => fused(operands),
    }
}

fn numbers(op: Numbers, operands: &Operands<'_>) -> Own {
    match op {
        Numbers::Atan => binary(Binary::Atan2, operands),
        Numbers::Abs | Numbers::Sign => each(Demand::NONE),
        // Integers are compared, and nothing else.
        Numbers::Min | Numbers::Max | Numbers::Clamp if !operands.is_float(0) => each(Demand::NONE),
        Numbers::Min | Numbers::Max => extremum(operands),
        Numbers::Clamp => clamp(operands),
        // A selection computes nothing.
        Numbers::Mix if !operands.is_float(2) => each(Demand::NONE),
        Numbers::Mix => mix(operands),
    }
}

fn extremum(operands: &Operands<'_>) -> Own {
    smallvec![keep_unless(operands.has_no_nan(1)), keep_unless(operands.has_no_nan(0))]
}

fn clamp(operands: &Operands<'_>) -> Own {
    let [x, low, high] = [0, 1, 2].map(|index| operands.has_no_nan(index));
    // Limits the wrong way round are undefined (§8.3), and validators of WGSL refuse them as literals.
    let reversed = (0..operands.components())
        .any(|index| operands.fact(2, index).range().less(operands.fact(1, index).range()) == Some(true));
    let limits = keep_unless(x && !reversed);
    smallvec![keep_unless(low && high), limits, limits]
}

fn mix(operands: &Operands<'_>) -> Own {
    let [a, b, t] = [0, 1, 2].map(|index| operands.is_finite(index));
    smallvec![keep_unless(t), keep_unless(t), keep_unless(a && b)]
}

/// `a * b + c`
fn fused(operands: &Operands<'_>) -> Own {
    let mut demands: Own = smallvec![Demand::NONE; 3];
    for index in 0..operands.components() {
        let [a, b, c] = [0, 1, 2].map(|operand| operands.fact(operand, index));
        let factors = product(a, b, false);
        let of = crate::facts::binary(BinaryOp::Mul, Scalar::Float, 1, &[a], &[b]);
        let terms = sum(at(&of, 0), c);
        let product_is_finite = a.range().is_finite() && b.range().is_finite();
        let cancels = !product_is_finite && !c.range().is_finite();
        for (slot, (factor, own)) in demands.iter_mut().zip([(a, factors[0]), (b, factors[1])]) {
            let unit = factor.value().is_some_and(|value| matches!(value, ScalarValue::Float(1.0 | -1.0)));
            *slot = slot.and(own).and(terms[0]).and(keep_unless(!(unit && cancels)));
        }
        demands[2] = demands[2].and(terms[1]).and(Demand::NO_ZERO);
    }
    demands
}

fn composite(op: Composite, operands: &Operands<'_>) -> Own {
    let finite = |index: usize| operands.is_finite(index);
    let moderate = |index: usize| operands.is_moderate(index);
    match op {
        // A sum of squares is NaN only where a component is.
        Composite::Length => each(Demand::NONE),
        Composite::Distance => pairs(operands, sum),
        Composite::Dot | Composite::Cross => smallvec![zero_unless(finite(1)), zero_unless(finite(0))],
        // A component of 0 is NaN where the length is 0, infinite or NaN.
        Composite::Normalize => {
            let terms: Vec<Range> = operands.facts(0).iter().map(|fact| fact.range().square()).collect();
            let square = Range::sum(&terms);
            smallvec![zero_unless(!terms.is_empty() && square.is_finite() && square.low > 1e-30)]
        }
        // The sign of `dot(reference, incident)` alone counts.
        Composite::Faceforward => smallvec![Demand::NONE, zero_unless(finite(2)), zero_unless(finite(1))],
        Composite::Reflect => {
            let both = moderate(0) && moderate(1);
            smallvec![zero_unless(both), zero_unless(both)]
        }
        Composite::Refract => each(keep_unless(moderate(0) && moderate(1) && moderate(2))),
        // What is left of products and quotients of some of the elements is not judged.
        Composite::Determinant | Composite::Inverse => each(Demand::KEEP),
    }
}

fn bits(op: BitFunction, operands: &Operands<'_>) -> Own {
    // The result is undefined unless the bits are among the 32.
    let range = |first: usize, count: usize| {
        let inside = (0..operands.components()).all(|index| {
            let (offset, bits) = (whole(operands.fact(first, index)), whole(operands.fact(count, index)));
            matches!((offset, bits), (Some(offset), Some(bits)) if offset >= 0 && bits >= 0 && offset + bits <= 32)
        });
        keep_unless(inside)
    };
    match op {
        BitFunction::Extract => smallvec![Demand::NONE, range(1, 2), range(1, 2)],
        BitFunction::Insert => smallvec![Demand::NONE, Demand::NONE, range(2, 3), range(2, 3)],
        BitFunction::Reverse | BitFunction::Count | BitFunction::Lowest | BitFunction::Highest => each(Demand::NONE),
    }
}

/// A lookup: where a coordinate is divided by its last component, as of a quotient.
fn lookup(form: TextureForm, operands: &Operands<'_>) -> Own {
    let mut demands = each(Demand::NONE);
    if form.projective {
        let coordinate = operands.facts(1);
        let divisor = coordinate.last().copied().unwrap_or(Fact::ANY);
        let range = divisor.range();
        let divides = if divisor.constant { keep_unless(has_reciprocal(range)) } else { Demand::NONE };
        demands[1] = divides.and(zero_unless(range.is_finite() && !range.has_zero()));
    }
    demands
}

fn power(x: Fact, y: Fact) -> [Demand; 2] {
    let base = x.range().low > 0.0 && (x.range().equal(Range::point(1.0)).is_some() || y.range().is_finite());
    let exponent = x.range().low >= 0.0 && y.range().low > 0.0;
    [keep_unless(base), keep_unless(exponent)]
}

/// Whether a function hands on what is demanded of its result: a driver may find the result, or join it with what it is used
/// in, although not all arguments are literals. The others are found only where an argument of each component is a literal.
pub(super) fn hands_on(function: BuiltinFunction) -> bool {
    match function.class() {
        Class::Unary(op) => match op {
            Unary::Abs | Unary::Sign | Unary::Neg => true,
            Unary::Radians
            | Unary::Degrees
            | Unary::Sin
            | Unary::Cos
            | Unary::Tan
            | Unary::Asin
            | Unary::Acos
            | Unary::Atan
            | Unary::Sinh
            | Unary::Cosh
            | Unary::Tanh
            | Unary::Asinh
            | Unary::Acosh
            | Unary::Atanh
            | Unary::Exp
            | Unary::Log
            | Unary::Exp2
            | Unary::Log2
            | Unary::Sqrt
            | Unary::Inversesqrt
            | Unary::Floor
            | Unary::Trunc
            | Unary::Round
            | Unary::Ceil
            | Unary::Fract => false,
        },
        Class::Binary(op) => match op {
            Binary::Min | Binary::Max | Binary::Mod | Binary::Mul | Binary::Div | Binary::Atan2 => true,
            Binary::Pow | Binary::Step | Binary::Add | Binary::Sub => false,
        },
        Class::Ternary(Ternary::Clamp | Ternary::Mix | Ternary::Smoothstep | Ternary::Fma) => true,
        Class::Numbers(_) | Class::Matrix(_) => true,
        Class::Composite(op) => match op {
            Composite::Length | Composite::Distance | Composite::Dot | Composite::Cross | Composite::Normalize => false,
            Composite::Faceforward
            | Composite::Reflect
            | Composite::Refract
            | Composite::Determinant
            | Composite::Inverse => true,
        },
        Class::BitCast(_)
        | Class::Bits(_)
        | Class::Packing(_)
        | Class::Modf
        | Class::Composed
        | Class::Derivative(_)
        | Class::Noise(_)
        | Class::Emission(_) => true,
        // A truth, or what only the texture knows.
        Class::Relation(_) | Class::Boolean(_) | Class::Test(_) | Class::Texture(_) => false,
    }
}
