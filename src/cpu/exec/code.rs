//! [`Code`]: what a stage compiles to.

use super::compile;
use crate::diagnostic::Diagnostic;
use crate::hir::{GlobalId, Stage};
use crate::link::Program;
use std::sync::Arc;

/// The instructions of one stage, for every domain. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Code {
    pub(super) inner: Arc<Inner>,
}

#[derive(Debug, Default)]
pub(super) struct Inner {
    pub(super) inputs: Vec<(GlobalId, u32)>,
}

impl Code {
    /// Compiles a stage of a program.
    ///
    /// # Errors
    /// What the executor cannot run: a program without that stage or without `main`, multisample samplers, geometry
    /// stages, values of more than 2^20 scalars.
    pub fn compile(program: &Program, stage: Stage) -> Result<Self, Vec<Diagnostic>> {
        compile::compile(program, stage).map(|inner| Self { inner: Arc::new(inner) })
    }
}
