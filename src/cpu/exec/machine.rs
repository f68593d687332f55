//! [`Machine`]: runs [`Code`] in a domain.

use super::code::Code;
use super::{LANES, Mask};
use crate::cpu::domain::Domain;
use crate::hir::{GlobalId, ScalarValue};
use crate::scene::Texture;
use std::sync::Arc;

/// How many times a run may go back to the head of a loop, all loops of all lanes together, before every loop is left
/// and [`Machine::budget_exceeded`] says so.
pub const LOOP_BUDGET: u32 = 1 << 20;

/// The registers of one thread for one draw. Reusable: run it tile after tile.
#[derive(Debug)]
pub struct Machine<D: Domain> {
    code: Code,
    floats: Vec<Box<[D::Float; LANES]>>,
    ints: Vec<Box<[D::Int; LANES]>>,
    discarded: Mask,
    undecided: Mask,
    budget_exceeded: bool,
}

impl<D: Domain> Machine<D> {
    /// A machine for the uniforms (of each root of the interface, flat) and textures (of each sampler slot) of a draw.
    /// What does not depend on the invocation is computed here, once.
    pub fn new(code: &Code, uniforms: &[Vec<ScalarValue>], textures: &[Option<Arc<Texture>>]) -> Self {
        let _ = (uniforms, textures);
        Self {
            code: code.clone(),
            floats: Vec::new(),
            ints: Vec::new(),
            discarded: Mask::NONE,
            undecided: Mask::NONE,
            budget_exceeded: false,
        }
    }

    /// The lanes of a `float` in an input's flat layout ([`Types::flat_len`](crate::hir::Types::flat_len)), to fill
    /// before a run; they keep their values between runs. `None` if the stage does not read it or it is no float.
    pub fn float_input(&mut self, global: GlobalId, flat: u32) -> Option<&mut [D::Float; LANES]> {
        let place = self.code.inner.inputs.iter().position(|input| *input == (global, flat))?;
        self.floats.get_mut(place).map(|lanes| &mut **lanes)
    }

    /// Likewise of an `int`, `uint` or `bool`.
    pub fn int_input(&mut self, global: GlobalId, flat: u32) -> Option<&mut [D::Int; LANES]> {
        let place = self.code.inner.inputs.iter().position(|input| *input == (global, flat))?;
        self.ints.get_mut(place).map(|lanes| &mut **lanes)
    }

    /// Runs `main` on the lanes of both masks. Helper lanes run for the derivatives of their quads; what they do has no
    /// other effect. The other lanes hold anything afterwards.
    pub fn run(&mut self, live: Mask, helpers: Mask) {
        let _ = (live, helpers);
    }

    /// The lanes of a `float` in an output's flat layout after a run; 0 where the shader wrote nothing. `None` if the
    /// stage never writes it or it is no float.
    pub fn float_output(&self, global: GlobalId, flat: u32) -> Option<&[D::Float; LANES]> {
        let _ = (global, flat);
        None
    }

    /// Likewise of an `int`, `uint` or `bool`.
    pub fn int_output(&self, global: GlobalId, flat: u32) -> Option<&[D::Int; LANES]> {
        let _ = (global, flat);
        None
    }

    /// The lanes that the last run discarded.
    pub fn discarded(&self) -> Mask {
        self.discarded
    }

    /// The lanes of the last run in which the domain could not tell which way a branch goes or which element an index
    /// means; they followed the value. Always empty in domains without bounds.
    pub fn undecided(&self) -> Mask {
        self.undecided
    }

    /// Whether any run since the machine was made went past [`LOOP_BUDGET`].
    pub fn budget_exceeded(&self) -> bool {
        self.budget_exceeded
    }
}
