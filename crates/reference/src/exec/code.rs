//! [`Code`]: the compiled form of a stage.

use super::inst::{Class, Inst, List, Operand, TextureCall};
use super::note::Note;
use glisten_front::hir::{GlobalId, Stage};
use glisten_front::link::RootIndex;
use glisten_front::source::Span;
use std::sync::Arc;

/// The instructions of one stage, for every domain. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Code {
    pub(super) inner: Arc<Inner>,
}

impl Code {
    /// The place of a `float` output of a geometry stage among the floats of an emitted vertex.
    pub fn emitted_float(&self, global: GlobalId, flat: u32) -> Option<usize> {
        self.inner.emitted[0].iter().position(|place| *place == (global, flat))
    }

    /// The place of an `int`, `uint` or `bool` output among the ints of an emitted vertex.
    pub fn emitted_int(&self, global: GlobalId, flat: u32) -> Option<usize> {
        self.inner.emitted[1].iter().position(|place| *place == (global, flat))
    }

    /// The number of floats and of ints of an emitted vertex.
    pub fn emitted_sizes(&self) -> [usize; 2] {
        [self.inner.emitted[0].len(), self.inner.emitted[1].len()]
    }

    /// Whether the first scalar of the inputs that the stage reads, of those asked for, is a `float`; `None` if it reads
    /// none of them.
    pub fn reads(&self, is_asked: impl Fn(GlobalId, u32) -> bool) -> Option<bool> {
        let port = self.inner.inputs.iter().find(|port| is_asked(port.global, port.flat))?;
        Some(port.class == Class::Float)
    }
}

/// The source of a number for all lanes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum PoolSource {
    /// The bits of an f32 or of an int.
    Constant(u32),
    /// A scalar in a root's flat layout.
    Uniform(RootIndex, u32),
    /// A scalar that was never written: a number of [`Inner::unwritten`].
    Unwritten(u32),
}

/// The purpose for which a stage is compiled. The numbers are the same.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Form {
    /// Speed.
    #[default]
    Fast,
    /// Each product and sum is an instruction of its own, so that an observer sees each.
    Unfused,
    /// Besides, an observer sees of `?:`, `&&` and `||` only the operands that are chosen, as a GPU executes them.
    Executed,
    /// Besides, what depends on uniforms runs in every invocation, as on a GPU; only constants are computed before.
    Counted,
    /// As [`Self::Executed`]; scalars that are read before anything was written to them may have any number.
    Guessed,
    /// Unfused; an observer is shown the value of each expression as [`Note`]s.
    Noted,
    /// As [`Self::Noted`], with the rewritten sums and products of [`Self::Fast`], which make envelopes narrower.
    NotedTight,
}

impl Form {
    /// Whether sums and products may be rewritten.
    pub(super) fn rewrites(self) -> bool {
        matches!(self, Self::Fast | Self::NotedTight)
    }

    /// Whether an operand is seen only where it is chosen.
    pub(super) fn chooses(self) -> bool {
        matches!(self, Self::Executed | Self::Counted | Self::Guessed)
    }

    /// Whether values are noted.
    pub(super) fn notes(self) -> bool {
        matches!(self, Self::Noted | Self::NotedTight)
    }
}

/// When a section runs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Runs {
    /// Once per machine: the preamble.
    Once,
    /// For each tile: `main`.
    #[default]
    Always,
}

/// Instructions with their operand lists.
#[derive(Clone, Debug, Default)]
pub(super) struct Section {
    pub(super) runs: Runs,
    pub(super) insts: Vec<Inst>,
    /// The expression or statement of each instruction.
    pub(super) spans: Vec<Span>,
    pub(super) lists: Vec<Operand>,
    /// For each instruction, whether no output depends on it; empty unless the form is [`Form::Counted`].
    pub(super) dead: Vec<bool>,
}

/// A scalar of an input or output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Port {
    pub(super) global: GlobalId,
    pub(super) flat: u32,
    pub(super) class: Class,
    pub(super) register: usize,
}

#[derive(Clone, Debug)]
pub(super) struct Inner {
    pub(super) stage: Stage,
    /// Runs once per machine. Register `k` contains result `k`, which then follows the sources in the pool.
    pub(super) preamble: Section,
    /// Runs once per tile.
    pub(super) main: Section,
    /// Labels and mask slots.
    pub(super) words: Vec<u32>,
    pub(super) textures: Vec<TextureCall>,
    pub(super) float_pool: Vec<PoolSource>,
    pub(super) int_pool: Vec<PoolSource>,
    /// The number of results of the preamble, floats and ints.
    pub(super) preamble_results: [usize; 2],
    /// The number of registers of `main`, floats and ints.
    pub(super) registers: [usize; 2],
    /// Registers that contain one number of the pool in all lanes.
    pub(super) splats: Vec<(Class, usize, Operand)>,
    pub(super) inputs: Vec<Port>,
    /// The registers with the noise of inputs.
    pub(super) noises: Vec<Port>,
    pub(super) outputs: Vec<Port>,
    /// The scalars of an emitted vertex, floats and ints.
    pub(super) emitted: [Vec<(GlobalId, u32)>; 2],
    /// The largest number of vertices that an invocation emits.
    pub(super) max_vertices: u32,
    pub(super) mask_slots: usize,
    /// The declarations of the variables that may be read before anything was written to them; empty unless the form is
    /// [`Form::Guessed`].
    pub(super) unwritten: Vec<Span>,
    /// The notes that [`Inst::Note`] refers to; empty unless the form has notes.
    pub(super) notes: Vec<Note>,
}

impl Section {
    /// Appends an instruction.
    pub(super) fn push(&mut self, inst: Inst, span: Span) {
        self.insts.push(inst);
        self.spans.push(span);
    }

    #[inline(always)]
    pub(super) fn list(&self, list: List) -> &[Operand] {
        self.lists.get(list.start as usize..(list.start + list.len) as usize).unwrap_or(&[])
    }
}

impl Inner {
    /// The ports that are filled in before a run.
    pub(super) fn given(&self) -> impl Iterator<Item = &Port> {
        self.inputs.iter().chain(&self.noises)
    }

    #[inline(always)]
    pub(super) fn words(&self, list: List) -> &[u32] {
        self.words.get(list.start as usize..(list.start + list.len) as usize).unwrap_or(&[])
    }
}
