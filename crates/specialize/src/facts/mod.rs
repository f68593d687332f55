//! [`Fact`]: what is known of a scalar while a program is specialized.
//!
//! *In:* what a scene fixes, and the facts of operands. *Out:* the fact of a result.
//! *Holds:* a [`What::Value`] is what the reference computes in f32, bit for bit: mostly what every conforming target computes
//! (see [`exact`]), else a value that the original's envelope has in it (see [`folded()`]). A range holds whatever a conforming
//! target may compute.

mod builtins;
mod call;
mod exact;
mod folded;
mod operators;
mod range;
mod vectors;

pub(crate) use builtins::builtin;
pub(crate) use call::Call;
pub(crate) use folded::{Operation, Values, by_reference, folded};
pub(crate) use operators::{binary, convert, mat_mul, unary};
pub(crate) use range::{GREATEST, Range};

use glisten_front::hir::{Scalar, ScalarValue};
use smallvec::SmallVec;

/// The knowledge of a scalar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fact {
    /// Its value, or where it is.
    pub(crate) what: What,
    /// Whether it depends on nothing but literals and what the scene fixes, so that a driver could compute it once.
    pub(crate) constant: bool,
    /// Whether what the scene fixes is part of it. Literals alone give a driver no freedom that it had not before.
    pub(crate) bound: bool,
    /// Whether it is a product with a constant, which a driver may join with another constant factor.
    pub(crate) scaled: bool,
    /// Whether one of these constants makes it larger.
    pub(crate) up: bool,
    /// How long the vector is at most that it is a component of, as long as the facts are those of a whole vector: a component that
    /// is taken out or put in has no such limit.
    pub(crate) norm: f32,
}

/// A value, or where one is.
#[derive(Clone, Copy, Debug)]
pub(crate) enum What {
    /// Exactly this.
    Value(ScalarValue),
    /// A `float` in a range.
    Float(Range),
    /// An `int` from one number to another, both included.
    Int(i32, i32),
    /// A `uint` from one number to another, both included.
    Uint(u32, u32),
    /// Nothing is known.
    Any,
}

impl PartialEq for What {
    /// By bits: 0 and -0 differ, and a NaN is itself.
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Value(a), Self::Value(b)) => a.is_same(*b),
            (Self::Float(a), Self::Float(b)) => a == b,
            (Self::Int(a, b), Self::Int(c, d)) => (a, b) == (c, d),
            (Self::Uint(a, b), Self::Uint(c, d)) => (a, b) == (c, d),
            (Self::Any, Self::Any) => true,
            _ => false,
        }
    }
}

/// The facts of a value, scalar by scalar in flat order; empty where nothing is known of it.
pub(crate) type Facts = SmallVec<[Fact; 4]>;

impl Fact {
    /// Nothing is known.
    pub(crate) const ANY: Self = Self::of(What::Any, false, false);

    /// A fact of what is no product.
    pub(crate) const fn of(what: What, constant: bool, bound: bool) -> Self {
        Self { what, constant, bound, scaled: false, up: false, norm: f32::INFINITY }
    }

    /// A literal.
    pub(crate) fn literal(value: ScalarValue) -> Self {
        Self::of(What::Value(value), true, false)
    }

    /// A value that the scene fixes.
    pub(crate) fn bound(value: ScalarValue) -> Self {
        Self::of(What::Value(value), true, true)
    }

    /// A `float` in a range, of which nothing else is known.
    pub(crate) fn in_range(range: Range) -> Self {
        Self::of(What::Float(range), false, false)
    }

    /// An `int` between two numbers, both included.
    pub(crate) fn int(low: i64, high: i64) -> Self {
        let limits = i64::from(i32::MIN)..=i64::from(i32::MAX);
        let what = if limits.contains(&low) && limits.contains(&high) {
            What::Int(low as i32, high as i32)
        } else {
            What::Any
        };
        Self::of(what, false, false)
    }

    /// The value, if there is only one.
    pub(crate) fn value(self) -> Option<ScalarValue> {
        match self.what {
            What::Value(value) => Some(value),
            What::Float(_) | What::Int(..) | What::Uint(..) | What::Any => None,
        }
    }

    /// Whether it is known to be true, or to be false.
    pub(crate) fn truth(self) -> Option<bool> {
        match self.what {
            What::Value(ScalarValue::Bool(value)) => Some(value),
            _ => None,
        }
    }

    /// Where a `float` is.
    pub(crate) fn range(self) -> Range {
        match self.what {
            What::Value(ScalarValue::Float(value)) => Range::point(value),
            What::Float(range) => range,
            _ => Range::ANY,
        }
    }

    /// Where an `int` or `uint` is.
    pub(crate) fn integers(self, scalar: Scalar) -> (i64, i64) {
        match self.what {
            What::Value(ScalarValue::Int(value)) => (i64::from(value), i64::from(value)),
            What::Value(ScalarValue::Uint(value)) => (i64::from(value), i64::from(value)),
            What::Int(low, high) => (i64::from(low), i64::from(high)),
            What::Uint(low, high) => (i64::from(low), i64::from(high)),
            _ if scalar == Scalar::Uint => (0, i64::from(u32::MAX)),
            _ => (i64::from(i32::MIN), i64::from(i32::MAX)),
        }
    }

    /// The fact that holds whichever of two it is.
    pub(crate) fn join(self, other: Self) -> Self {
        let (bound, scaled, up) = (self.bound || other.bound, self.scaled || other.scaled, self.up || other.up);
        let norm = self.norm.max(other.norm);
        if self.what == other.what {
            return Self { what: self.what, constant: self.constant && other.constant, bound, scaled, up, norm };
        }
        let what = match (self.scalar(), other.scalar()) {
            (Some(Scalar::Float), Some(Scalar::Float)) => What::Float(self.range().join(other.range())),
            (Some(Scalar::Int), Some(Scalar::Int)) => {
                let (a, b) = (self.integers(Scalar::Int), other.integers(Scalar::Int));
                What::Int(a.0.min(b.0) as i32, a.1.max(b.1) as i32)
            }
            (Some(Scalar::Uint), Some(Scalar::Uint)) => {
                let (a, b) = (self.integers(Scalar::Uint), other.integers(Scalar::Uint));
                What::Uint(a.0.min(b.0) as u32, a.1.max(b.1) as u32)
            }
            _ => What::Any,
        };
        Self { what, constant: false, bound, scaled, up, norm }
    }

    fn scalar(self) -> Option<Scalar> {
        match self.what {
            What::Value(value) => Some(value.scalar()),
            What::Float(_) => Some(Scalar::Float),
            What::Int(..) => Some(Scalar::Int),
            What::Uint(..) => Some(Scalar::Uint),
            What::Any => None,
        }
    }

    /// Whether it is a `float` of 0, whose sign may be open.
    pub(crate) fn is_zero(self) -> bool {
        let range = self.range();
        let floats = matches!(self.what, What::Value(ScalarValue::Float(_)) | What::Float(_));
        floats && !range.nan && (range.low, range.high) == (0.0, 0.0)
    }

    /// The same, where -0 is 0.
    pub(crate) fn without_sign(self) -> Self {
        let what = match self.what {
            What::Value(ScalarValue::Float(0.0)) => What::Value(ScalarValue::Float(0.0)),
            What::Float(range) => What::Float(Range { negative_zero: false, ..range }),
            What::Any => What::Float(Range { negative_zero: false, ..Range::ANY }),
            what => what,
        };
        Self { what, ..self }
    }

    /// The same, of a component by itself.
    pub(crate) fn apart(self) -> Self {
        Self { norm: f32::INFINITY, ..self }
    }

    /// The result of an operation on these operands.
    fn result(what: What, operands: &[Self]) -> Self {
        let constant = operands.iter().all(|operand| operand.constant);
        Self::of(what, constant, operands.iter().any(|operand| operand.bound))
    }
}

/// The fact of a scalar among facts of which some may be missing.
pub(crate) fn at(facts: &[Fact], index: usize) -> Fact {
    facts.get(index).copied().unwrap_or(Fact::ANY)
}

/// The fact of a component, where a scalar next to a vector is every component.
pub(crate) fn spread(facts: &[Fact], index: usize) -> Fact {
    if facts.len() == 1 { at(facts, 0) } else { at(facts, index) }
}

/// All values, if all are known.
pub(crate) fn values(facts: &[Fact]) -> Option<Values> {
    if facts.is_empty() { None } else { facts.iter().map(|fact| fact.value()).collect() }
}

/// How long a vector with these facts is at most, but for NaN.
pub(crate) fn norm(facts: &[Fact]) -> f64 {
    if facts.is_empty() {
        return f64::INFINITY;
    }
    let known = facts.iter().map(|fact| f64::from(fact.norm)).fold(0.0, f64::max);
    let square: f64 = facts.iter().map(|fact| fact.range().magnitude().powi(2)).sum();
    known.min(square.sqrt())
}

/// The facts that hold whichever of two values it is.
pub(crate) fn join(a: &[Fact], b: &[Fact]) -> Facts {
    if a.len() != b.len() {
        return Facts::new();
    }
    a.iter().zip(b).map(|(a, b)| a.join(*b)).collect()
}
