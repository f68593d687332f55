//! The noise of derivatives' arguments: how far apart the errors of one register may be in two lanes of a quad.
//!
//! *In:* the definitions of registers. *Out:* for a register that is a varying, or computed from varyings by sums, products,
//! quotients, roots, lengths and normalized vectors, a register with its *noise*: the part of its error that is not common to the
//! fragments of a quad. Both fragments of a derivative lie on one plane, so an error of the plane itself cancels.
//!
//! *Holds:* the pipeline gives the noise of varyings; each operation adds its own rounding. The noise is computed only for
//! arguments of derivatives. *Not done here:* other functions, whose own errors differ from fragment to fragment; variables that a branch assigns
//! to; what is computed of the noise of operands ([`noise`](super::super::noise)).

use super::super::code::Port;
use super::super::inst::{Class, Float1, Float2, Inst, Noisy, Operand};
use super::emit::Emitter;
use super::facts::Definition;
use super::{Compiler, Val};
use glisten_front::builtin::operations::Composite;

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
        // What was computed in a branch may be missing after it.
        if std::mem::replace(&mut self.emit.noises_at, self.emit.stores) != self.emit.stores {
            self.emit.noises.clear();
        }
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
        let depth = depth + 1;
        let found = match self.emit.definitions.get(&operand).cloned() {
            Some(Definition::Same(of)) => return self.noise_of(of, depth),
            Some(Definition::Of(op, a, b)) => self.noise_of_operation(operand, (op, a, b), depth)?,
            Some(Definition::Root(op, a)) => {
                let op = if op == Float1::Sqrt { Noisy::Root } else { Noisy::InverseRoot };
                self.noise_by(op, operand, &[a], depth)?
            }
            Some(Definition::Products(factors)) => self.noise_by(Noisy::Products, operand, &factors, depth)?,
            Some(Definition::Length(vector)) => {
                let square = self.square(&vector)?;
                self.noise_by(Noisy::Root, operand, &[square], depth)?
            }
            Some(Definition::Normalized(vector, component)) => {
                let square = self.square(&vector)?;
                let scale = self.float1(Float1::Inversesqrt, square);
                self.noise_by(Noisy::Products, operand, &[*vector.get(component)?, scale], depth)?
            }
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
            (Float2::Mul, Noise::In(_), Noise::In(_)) => return self.noise_by(Noisy::Products, result, &[a, b], depth),
            (Float2::Div, _, Noise::In(_)) => return self.noise_by(Noisy::Quotient, result, &[a, b], depth),
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

    /// The noise of what is computed from operands that change from one fragment to the next.
    fn noise_by(&mut self, op: Noisy, result: Operand, operands: &[Operand], depth: u32) -> Option<Operand> {
        let mut list = Vec::with_capacity(2 * operands.len());
        for operand in operands {
            let noise = match self.noise_of(*operand, depth)? {
                Noise::Zero => self.emit.float(0.0),
                Noise::In(register) => register,
            };
            list.extend([*operand, noise]);
        }
        let list = self.emit.list(Class::Float, &list, false);
        Some(self.emit.pure(Class::Float, &[result], |dst| Inst::NoiseOf { op, dst, of: result, list }))
    }

    /// The square of the length of a vector.
    fn square(&mut self, vector: &[Operand]) -> Option<Operand> {
        // The registers of variables may have changed since.
        if vector.iter().any(|operand| self.emit.is_home(Class::Float, *operand)) {
            return None;
        }
        let pairs: Vec<Operand> = vector.iter().flat_map(|operand| [*operand, *operand]).collect();
        Some(self.sum_of_products(&pairs))
    }

    /// Remembers what the results of a function of whole vectors are computed from.
    pub(super) fn define_composite(&mut self, op: Composite, values: &[Val], results: &[Operand]) {
        let first = values.first().map_or(&[][..], |value| value.as_slice());
        match (op, results) {
            (Composite::Length, [result]) => {
                self.emit.define(*result, Definition::Length(first.iter().copied().collect()));
            }
            (Composite::Dot, [result]) => {
                let second = values.get(1).map_or(&[][..], |value| value.as_slice());
                let pairs = first.iter().zip(second).flat_map(|(a, b)| [*a, *b]).collect();
                self.emit.define(*result, Definition::Products(pairs));
            }
            (Composite::Normalize, results) => {
                for (component, result) in results.iter().enumerate() {
                    self.emit.define(*result, Definition::Normalized(first.iter().copied().collect(), component));
                }
            }
            _ => {}
        }
    }

    /// The pipeline fills the register in.
    fn noise_of_input(&mut self, operand: Operand) -> Option<Operand> {
        let port = self.inputs.iter().find(|port| port.class == Class::Float && port.register == operand.number())?;
        let is_varying = self.shader.globals.get(port.global.index()).is_some_and(|global| global.builtin.is_none());
        if !is_varying {
            return None;
        }
        let port = *port;
        if let Some(known) = self.noises.iter().find(|noise| (noise.global, noise.flat) == (port.global, port.flat)) {
            return Some(Operand::reg(known.register as u32));
        }
        let register = self.emit.temp(Class::Float);
        self.noises.push(Port { register: register.number(), ..port });
        Some(register)
    }
}
