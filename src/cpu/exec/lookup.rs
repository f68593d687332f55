//! Texture instructions.

use super::inst::TextureCall;
use super::machine::Machine;
use crate::cpu::domain::Domain;
use crate::hir::Stage;

impl<D: Domain> Machine<D> {
    pub(super) fn texture(&mut self, call: &TextureCall, stage: Stage) -> u64 {
        let _ = (call, stage);
        0
    }
}
