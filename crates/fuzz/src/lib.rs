//! Promises that must hold for any input, as functions.
//!
//! ```text
//!  bytes ──► Target::check ──► returns, or panics where a promise does not hold
//!                ▲
//!   crates/fuzz/corpus/TARGET/    inputs that once were wrong (`cargo test`)
//!   libFuzzer                     new inputs (`cargo run -p glisten-fuzz -- TARGET`)
//! ```
//!
//! *In:* bytes from anywhere. *Out:* nothing. *Holds:* no target reads or writes files, starts threads of its own, or asks for a GPU.
//! Each ends in time and memory that grow with the input: what takes longer than the runner's limit is a finding.
//! *Not done here:* making inputs; that is libFuzzer's work.

mod chance;
#[cfg(feature = "checks")]
pub mod checks;
pub mod faults;
pub mod fragments;
pub mod generate;
pub mod mutants;
pub mod record;
mod sections;
mod seeds;
#[cfg(feature = "checks")]
mod targets;
mod words;

pub use chance::Chance;
pub use sections::Sections;
pub use seeds::{Seed, seeds};
pub use words::dictionary;

/// A promise.
#[cfg(feature = "checks")]
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// Its name: `emit`.
    pub name: &'static str,
    /// A sentence: it holds for any input.
    pub promise: &'static str,
    /// Panics if the promise does not hold for this input.
    pub check: fn(&[u8]),
    /// The fixtures that fuzzing starts from.
    pub begins: seeds::Kind,
}

/// All targets.
#[cfg(feature = "checks")]
pub static TARGETS: &[Target] = targets::ALL;

/// The target of this name.
#[cfg(feature = "checks")]
pub fn target(name: &str) -> Option<&'static Target> {
    TARGETS.iter().find(|target| target.name == name)
}
