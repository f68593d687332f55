//! Tells an observer which steps a machine executes.
//!
//! *In:* instructions as they run, of code in the counted form. *Out:* a [`Step`] for each that is an operation of the text.
//!
//! *Holds:* copies, masks and what no output depends on are not steps.

use super::code::{Inner, Section};
use super::inst::{Composite, Inst, Int2, Lookup, TextureCall};
use super::machine::Machine;
use super::step::{Step, name_of_unary};
use crate::domain::{Domain, Integer};
use glisten_front::hir::{SamplerDim, Stage};
use glisten_scene::Filter;

/// The step of an instruction, except for lookups.
fn step(inst: &Inst) -> Option<Step> {
    match *inst {
        Inst::Float1 { op, .. } => Step::scalar(name_of_unary(op)),
        Inst::Float2 { op, .. } => Step::scalar(op.name()),
        Inst::Float3 { op, .. } => Step::scalar(op.name()),
        Inst::Compare { .. } => Step::scalar("comparison"),
        Inst::FloatToInt { .. } | Inst::IntToFloat { .. } => Step::scalar("conversion"),
        Inst::SelectFloat { .. } | Inst::SelectInt { .. } => Step::scalar("selection"),
        Inst::Int2 { op: Int2::ClampIndex, .. } => None,
        Inst::Int2 { op, .. } if op.divides() => Step::scalar("integer division"),
        Inst::Int1 { .. } | Inst::Int2 { .. } => Step::scalar("integer"),
        Inst::Composite { op, size, results, .. } => {
            let size = u32::from(size);
            let argument = if matches!(op, Composite::Determinant | Composite::Inverse) { size * size } else { size };
            Some(Step { name: op.name(), results: results.len, argument })
        }
        Inst::Derivative { op, .. } => Step::scalar(op.name()),
        Inst::LoadFloat { .. }
        | Inst::LoadInt { .. }
        | Inst::StoreIndexedFloat { .. }
        | Inst::StoreIndexedInt { .. } => Step::scalar("index"),
        Inst::Arm { .. } | Inst::LoopTest { .. } | Inst::CaseMask { .. } => Step::scalar("branch"),
        _ => None,
    }
}

/// The texels that a lookup reads.
fn texels(call: &TextureCall, filter: Filter) -> u32 {
    let levels = u32::from(call.lookup != Lookup::Fetch && filter.blends_levels());
    if call.lookup == Lookup::Fetch || !filter.is_linear() {
        return 1 << levels;
    }
    let directions = match call.kind.dim {
        SamplerDim::D1 => 1,
        SamplerDim::D3 => 3,
        _ => 2,
    };
    1 << (directions + levels)
}

impl<D: Domain> Machine<D> {
    /// Tells the observer of an instruction that is about to run.
    pub(super) fn count(&mut self, inst: &Inst, (section, place): (&Section, usize), inner: &Inner, mask: u64) {
        if section.dead.get(place).copied().unwrap_or(false) {
            return;
        }
        let step = match inst {
            Inst::Texture { call } => inner.textures.get(*call as usize).and_then(|call| self.lookup_step(call, mask)),
            inst => step(inst),
        };
        let lanes = (mask & self.watched).count_ones();
        if let (Some(step), Some(observer)) = (step, &mut self.observer) {
            observer.count(step, lanes);
        }
    }

    /// A query of a texture's size looks nothing up.
    fn lookup_step(&self, call: &TextureCall, mask: u64) -> Option<Step> {
        if matches!(call.lookup, Lookup::Size | Lookup::Levels | Lookup::QueryLod) {
            return Step::scalar("integer");
        }
        let slot = self.registers.int(call.sampler).at(mask.trailing_zeros().min(63) as usize).bits();
        let texture = self.textures.get(slot as usize).and_then(Option::as_ref);
        let filter = texture.map_or(Filter::Nearest, |texture| texture.filter);
        Some(Step { name: Step::LOOKUP, results: 4, argument: texels(call, filter) })
    }

    /// Tells the observer of the invocations that are about to run.
    pub(super) fn count_invocations(&mut self, inner: &Inner) {
        let Some(observer) = &mut self.observer else { return };
        let name = if inner.stage == Stage::Fragment { Step::FRAGMENT } else { Step::VERTEX };
        let [results, argument] = [&inner.outputs, &inner.inputs].map(|ports| ports.len() as u32);
        observer.count(Step { name, results, argument }, self.watched.count_ones());
    }
}
