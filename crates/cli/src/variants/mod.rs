//! Variants of programs: sets of macros, as files state them.
//!
//! *In:* tables of TOML. *Out:* the values of macros and the conditions on them ([`stated`]), and all variants that these
//! allow ([`axes`]).

pub(crate) mod axes;
pub(crate) mod stated;

pub(crate) use axes::{Condition, Variant};
