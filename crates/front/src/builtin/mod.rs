//! What the language has built in, as tables: functions (GLSL 1.50 §8), variables and constants (§7).
//!
//! *In:* nothing. *Out:* the identities [`BuiltinFunction`] and [`BuiltinVariable`], which every phase matches without
//! a wildcard, the tables that say for which versions, profiles, stages and types each exists, and what each operation is
//! ([`operations`]).

mod availability;
pub mod constants;
pub mod functions;
mod ids;
pub mod operations;
pub mod variables;

pub use availability::{Availability, Stages};
pub use ids::BuiltinVariable;
pub use operations::BuiltinFunction;
