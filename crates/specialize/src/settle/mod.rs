//! Settling: what is known is written as a literal, unless a driver might then gain or lose a NaN or an infinity.
//!
//! *In:* a walked stage. *Out:* the stage with literals in place of what is known, and identities gone (`x * 1.0`).
//!
//! A driver may fold a literal more freely than a uniform: `x * 0.0` to 0, `mix(a, b, 1.0)` to `b`, `(x + a) + b` to
//! `x + (a + b)`. So each operation makes a [`Demand`] on its operands, and a known operand that a demand hits stays what
//! it was, down to the uniform, attribute or texture that it comes from; a variable hands the demand on to what is stored
//! in it. Literals of the source are literals in any case.

mod builtins;
mod cancels;
mod danger;
mod demands;
mod identities;
mod operands;
mod rewrite;
mod signs;

pub(super) use demands::Demands;
pub(super) use rewrite::{Settled, settle};
pub(super) use signs::{mark_looked_at, mark_signs};

use super::facts::{self, Fact};
use super::forward::Walked;
use glisten_front::hir::{ExprId, ScalarValue};

/// The values that must not become literals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Demand(u8);

impl Demand {
    /// Anything may.
    pub(super) const NONE: Self = Self(0);
    /// No 0.
    pub(super) const NO_ZERO: Self = Self(1);
    /// Nothing at all.
    pub(super) const KEEP: Self = Self(3);
    /// Nothing at all, and no operation is left out because of what is known.
    pub(super) const APART: Self = Self(7);

    /// Both.
    pub(super) fn and(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    /// Whether anything is demanded.
    pub(super) fn is_some(self) -> bool {
        self != Self::NONE
    }

    /// Whether operations stay that give an operand back.
    pub(super) fn is_apart(self) -> bool {
        self == Self::APART
    }

    /// Whether something is known of a value with these facts that a driver must not find.
    pub(super) fn concerns(self, facts: &[Fact]) -> bool {
        let point = |fact: &Fact| fact.value().is_some() || fact.range().low == fact.range().high;
        let zero = |fact: &Fact| fact.range().low == 0.0 && fact.range().high == 0.0;
        match self {
            Self::NONE => false,
            Self::NO_ZERO => facts.iter().any(|fact| fact.bound && zero(fact)),
            _ => facts.iter().any(|fact| fact.bound && point(fact)),
        }
    }

    /// Whether a value with these facts must stay what it was.
    pub(super) fn hits(self, facts: &[Fact]) -> bool {
        if !facts.iter().any(|fact| fact.bound) {
            return false;
        }
        match self {
            Self::NONE => false,
            Self::NO_ZERO => facts.iter().any(|fact| fact.is_zero()),
            _ => true,
        }
    }
}

impl Walked {
    /// Whether nobody sees the sign of an expression's zeros. Where nothing was found out, somebody does.
    fn is_unsigned(&self, id: ExprId) -> bool {
        self.signs.get(id.index()) == Some(&false)
    }

    /// Whether an operation sees the sign of an expression's zeros.
    fn is_looked_at(&self, id: ExprId) -> bool {
        self.looked_at.get(id.index()) == Some(&true)
    }

    /// The facts of an expression.
    pub(super) fn facts(&self, id: ExprId) -> &[Fact] {
        self.notes.get(id.index()).map_or(&[], |note| &note.facts)
    }

    /// The values of an expression that are all known, if nothing speaks against writing them instead of it.
    pub(super) fn literal(&self, id: ExprId, demand: Demand) -> Option<smallvec::SmallVec<[ScalarValue; 4]>> {
        let note = self.notes.get(id.index())?;
        let values = facts::values(&note.facts).or_else(|| self.values_without_signs(id))?;
        let plain = |value: &ScalarValue| match value {
            ScalarValue::Float(value) => value.is_normal() || *value == 0.0,
            ScalarValue::Bool(_) | ScalarValue::Int(_) | ScalarValue::Uint(_) => true,
        };
        (note.pure && note.basic && values.iter().all(plain) && !demand.hits(&note.facts)).then_some(values)
    }

    /// The values of an expression of whose zeros nobody sees the sign: each is 0.
    fn values_without_signs(&self, id: ExprId) -> Option<facts::Values> {
        if !self.is_unsigned(id) {
            return None;
        }
        let zero = |fact: &Fact| fact.is_zero().then_some(ScalarValue::Float(0.0));
        let facts = self.facts(id);
        if facts.is_empty() { None } else { facts.iter().map(|fact| fact.value().or_else(|| zero(fact))).collect() }
    }
}
