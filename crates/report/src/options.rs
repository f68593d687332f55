//! The demands on a report: [`Options`], a [`Watcher`]; and the [`Error`]s for which there may be none.

use super::model::Machine;
use super::weights::Weights;
use glisten_front::diagnostic::{Diagnostic, Diagnostics};
use glisten_front::source::SourceMap;
use glisten_gpu::Via;
use glisten_verify::specialize::Contract;
use std::time::Duration;

/// Why a report could not be made.
#[derive(Debug)]
pub enum Error {
    /// The scene, or something that it names, has errors; the diagnostics belong to these sources.
    Scene {
        /// The texts.
        sources: Box<SourceMap>,
        /// The diagnostics.
        diagnostics: Diagnostics,
        /// Whether a file that it names cannot be read.
        io_error: bool,
    },
    /// The reference cannot draw a variant.
    Reference {
        /// The variant.
        way: String,
        /// The diagnostics.
        diagnostics: Vec<Diagnostic>,
    },
    /// The GPU cannot draw a variant.
    Gpu {
        /// The variant.
        way: String,
        /// The reason.
        error: glisten_gpu::Error,
    },
    /// The user ended it before a variant was drawn.
    Stopped,
}

/// Follows the progress of the work: the number of steps, then each step.
pub trait Watcher {
    /// Announces the number of steps, as far as it is known; the last announcement counts.
    fn steps(&mut self, count: usize);
    /// Announces a step.
    fn step(&mut self, what: &str);
    /// Whether the user wants an end. What is done then is the report.
    fn is_stopped(&self) -> bool {
        false
    }
}

/// Ignores progress.
impl Watcher for () {
    fn steps(&mut self, _count: usize) {}
    fn step(&mut self, _what: &str) {}
}

/// Which variants to compare.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ways {
    /// Those that the scene's file declares, or the scene alone.
    #[default]
    Declared,
    /// Those that are found by themselves as well.
    Auto,
}

/// The variants to compare, and how to measure them.
#[derive(Clone, Debug)]
pub struct Options {
    /// The form of the emitted code that the GPU runs.
    pub via: Via,
    /// Adds each variant with residual programs of this contract.
    pub specialized: Option<Contract>,
    /// Which variants to compare.
    pub ways: Ways,
    /// The weights of operations.
    pub weights: Weights,
    /// The limit of rounds; the scene's, or else the default, if there is none.
    pub rounds: Option<u32>,
    /// The limit of seconds for timing; the default if there is none.
    pub time: Option<Duration>,
    /// The machine.
    pub machine: Machine,
}
