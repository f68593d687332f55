//! Fast math: the algebra of real numbers, for callers that accept the error that it makes.
//!
//! | file | what it does |
//! | --- | --- |
//! | `facts` | knows more of results: folds what is not correctly rounded, and takes every number to be finite |
//! | `algebra` | rewrites expressions: joins constants, divides by none, applies matrices to vectors first |
//! | `powers` | writes powers with whole exponents as products |
//!
//! *Holds:* nothing here runs under [`Math::Exact`](crate::Math::Exact), and under [`Math::Finite`](crate::Math::Finite) only what takes numbers to
//! be finite. Effects, discards and
//! derivatives stay where they are, as without it: only the values of numbers may change, NaN and infinities included.

mod algebra;
mod facts;
mod powers;

pub(crate) use algebra::simplify;
pub(crate) use facts::{finite, improved};
