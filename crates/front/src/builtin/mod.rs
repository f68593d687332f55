//! The built-in names of the language as tables: functions (GLSL 1.50 §8), variables and constants (§7).
//!
//! *In:* nothing. *Out:* the identities [`BuiltinFunction`] and [`BuiltinVariable`], which every phase matches
//! without a wildcard; tables with the versions, profiles, stages and types in which each exists; and the definition
//! of each operation ([`operations`]).

mod availability;
pub mod constants;
pub mod fixed;
pub mod functions;
mod ids;
mod markdown;
pub mod operations;
pub mod sentences;
pub mod variables;

pub use availability::{Availability, Stages};
pub use ids::BuiltinVariable;
pub use markdown::{operations_markdown, precision_markdown};
pub use operations::BuiltinFunction;
