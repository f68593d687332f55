//! The library of lighting models: its values, edge cases and properties, the article's register programs, every
//! target, and its command.

mod bodies;
#[cfg(feature = "cli")]
mod command;
mod energy;
mod evaluator;
#[cfg(feature = "cli")]
mod exports;
mod faults;
mod films;
mod furnace;
mod laws;
mod ltc;
mod occlusion;
mod papers;
#[cfg(feature = "cli")]
mod prefilter;
mod registers;
mod seeds;
mod shadows;
mod stiff;
mod sum;
mod targets;
mod values;

use crate::support::compiler;
use glisten::evaluate::Evaluator;
use glisten::library::Embedded;
use glisten_reference::Precision;

/// A function of a module, ready to be called.
fn function(module: &str, signature: &str, wraps: &[(usize, &str)]) -> Evaluator {
    let compiler = compiler().with_includes(Embedded);
    let text = format!("#include <glisten/{module}.glsl>");
    Evaluator::new(&compiler, &text, signature, wraps).unwrap_or_else(|error| panic!("{signature}: {error}"))
}

/// The results in f64 for each row.
fn call(function: &Evaluator, rows: &[f32]) -> Vec<Vec<f64>> {
    function.reference(rows, &[], Precision::F64).unwrap_or_else(|error| panic!("{error}"))
}
