//! The noise of derivatives' arguments: how far apart the errors of one register may be in two lanes of a quad.
//!
//! *In:* the definitions of registers. *Out:* for a register that is a varying, or linear in varyings with uniforms and
//! constants as factors, a register with its *noise*: the part of its error that is not common to the fragments of a
//! primitive. Both fragments of a derivative lie on one plane, so an error of the plane itself cancels.
//!
//! *Holds:* the pipeline gives the noise of varyings; each operation adds its own rounding. The noise is computed only for
//! arguments of derivatives. *Not done here:* functions, products of varyings, variables that a branch assigns to.

use super::super::code::Port;
use super::super::inst::{Class, Float2, Inst, Operand};
use super::Compiler;
use super::emit::Emitter;
use super::facts::Definition;

/// Longer chains of operations are not followed.
const MAX_DEPTH: u32 = 24;

/// The noise of an operand.
#[derive(Clone, Copy)]
enum Noise {
    /// None: the same number in all lanes.
    Zero,
    In(Operand),
}

impl Emitter {
    /// Remembers what a register is computed from.
    pub(super) fn define(&mut self, register: Operand, definition: Definition) {
        if register.is_reg() {
            self.definitions.insert(register, definition);
        }
    }
}

impl Compiler<'_> {
    /// The register with the noise of an operand, if that is linear in varyings.
    pub(super) fn noise(&mut self, operand: Operand) -> Option<Operand> {
        match self.noise_of(operand, 0)? {
            Noise::Zero => None,
            Noise::In(register) => Some(register),
        }
    }

    fn noise_of(&mut self, operand: Operand, depth: u32) -> Option<Noise> {
        if operand.is_scalar() {
            // The result of an operation has an error of its own, which its uses share only if they are the same.
            return (!operand.is_preamble()).then_some(Noise::Zero);
        }
        if let Some(known) = self.emit.noises.get(&operand) {
            return Some(Noise::In(*known));
        }
        if depth > MAX_DEPTH || self.emit.is_home(Class::Float, operand) {
            return None;
        }
        let found = match self.emit.definitions.get(&operand).copied() {
            Some(Definition::Same(of)) => return self.noise_of(of, depth + 1),
            Some(Definition::Of(op, a, b)) => self.noise_of_operation(operand, (op, a, b), depth + 1)?,
            None => self.noise_of_input(operand)?,
        };
        self.emit.noises.insert(operand, found);
        Some(Noise::In(found))
    }

    fn noise_of_operation(
        &mut self,
        result: Operand,
        (op, a, b): (Float2, Operand, Operand),
        depth: u32,
    ) -> Option<Operand> {
        let one = self.emit.float(1.0);
        let pairs = match (op, self.noise_of(a, depth)?, self.noise_of(b, depth)?) {
            (Float2::Add | Float2::Sub, Noise::In(a), Noise::In(b)) => vec![a, one, b, one],
            (Float2::Add | Float2::Sub, Noise::In(only), Noise::Zero)
            | (Float2::Add | Float2::Sub, Noise::Zero, Noise::In(only)) => vec![only, one],
            (Float2::Mul, Noise::In(noise), Noise::Zero) => vec![noise, b],
            (Float2::Mul, Noise::Zero, Noise::In(noise)) => vec![noise, a],
            (Float2::Div, Noise::In(noise), Noise::Zero) => {
                let factor = self.float2(Float2::Div, one, b);
                vec![noise, factor]
            }
            _ => return None,
        };
        let list = self.emit.list(Class::Float, &pairs, false);
        let divides = op == Float2::Div;
        Some(self.emit.pure(Class::Float, &[result], |dst| Inst::Noise { dst, of: result, divides, list }))
    }

    /// The pipeline fills the register in.
    fn noise_of_input(&mut self, operand: Operand) -> Option<Operand> {
        let port = self.inputs.iter().find(|port| port.class == Class::Float && port.register == operand.number())?;
        let is_varying = self.shader.globals.get(port.global.index()).is_some_and(|global| global.builtin.is_none());
        if !is_varying {
            return None;
        }
        let port = *port;
        let register = self.emit.temp(Class::Float);
        self.noises.push(Port { register: register.number(), ..port });
        Some(register)
    }
}
