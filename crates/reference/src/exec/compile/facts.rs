//! Facts about registers that later instructions use: what a register is computed from.
//!
//! *In:* nothing. *Out:* the types of what the [emitter](super::emit) remembers.

use super::super::inst::{Float1, Float2, Operand};
use smallvec::SmallVec;

/// The definition of a register whose noise is known by that of its operands.
#[derive(Clone, Debug)]
pub(super) enum Definition {
    /// An operation.
    Of(Float2, Operand, Operand),
    /// A copy, or the negative.
    Same(Operand),
    /// `sqrt`, `inversesqrt`.
    Root(Float1, Operand),
    /// A sum of the products of pairs.
    Products(SmallVec<[Operand; 8]>),
    /// The length of a vector.
    Length(SmallVec<[Operand; 4]>),
    /// A component of a normalized vector.
    Normalized(SmallVec<[Operand; 4]>, usize),
}

/// The terms of a longer chain are not followed.
pub(super) const MAX_TERMS: usize = 4;

/// A sum or a product, without the order of its operations.
#[derive(Clone, Debug)]
pub(super) struct Chain {
    pub(super) sum: bool,
    pub(super) terms: SmallVec<[Operand; MAX_TERMS]>,
    /// The combination of all constants.
    pub(super) constant: f64,
    pub(super) constants: u32,
    /// Earlier results of the chain, each with the combination of all constants since.
    pub(super) prefixes: SmallVec<[(Operand, f64); MAX_TERMS]>,
    /// The number of stores before the chain, if one of its terms is a variable's home.
    pub(super) stores: Option<u32>,
}
