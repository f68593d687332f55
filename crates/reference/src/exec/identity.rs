//! The expressions of a stage's outputs as a number: two stages with equal numbers compute equal outputs.
//!
//! *In:* code without fused instructions, uniforms, and a number for each input. *Out:* a hash of the expressions of some
//! outputs ([`Code::expressions`]), or of all instructions ([`Code::text`]). *Holds:* the hash has the operations in order,
//! the bits of constants and uniforms, and the inputs. Spans, and the numbers of registers in expressions, do not matter.

use super::code::{Code, Inner, PoolSource, Section};
use super::inst::{Class, Inst, Operand, Use};
use glisten_front::hir::{GlobalId, ScalarValue};
use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// A hash that is the same in every run.
pub(crate) fn hashed(value: impl Hash) -> u64 {
    let mut hasher = FxHasher::default();
    value.hash(&mut hasher);
    hasher.finish()
}

/// The expressions of registers, floats and ints.
struct Expressions<'a> {
    pool: [Vec<u64>; 2],
    registers: [Vec<u64>; 2],
    section: &'a Section,
}

impl Code {
    /// A hash of all instructions and uniforms, given those of the inputs.
    pub(crate) fn text(&self, uniforms: &[Vec<ScalarValue>], input: impl Fn(GlobalId, u32) -> u64) -> u64 {
        let Inner { preamble, main, words, textures, inputs, outputs, .. } = &*self.inner;
        let sections = [preamble, main].map(|section| format!("{:?}{:?}", section.insts, section.lists));
        let inputs: Vec<u64> =
            inputs.iter().map(|port| hashed((input(port.global, port.flat), port.register))).collect();
        let rest = format!("{words:?}{textures:?}{outputs:?}{:?}", self.inner.splats);
        hashed((sections, inputs, rest, pools(&self.inner, uniforms)))
    }

    /// A hash of the expressions of these outputs, given those of the inputs. `None` if branches, loops or lookups are
    /// on the way.
    pub(crate) fn expressions(
        &self,
        wanted: &[(GlobalId, u32)],
        uniforms: &[Vec<ScalarValue>],
        input: impl Fn(GlobalId, u32) -> u64,
    ) -> Option<u64> {
        let inner: &Inner = &self.inner;
        let mut pool = pools(inner, uniforms);
        let [floats, ints] = inner.preamble_results;
        let registers = [vec![0; floats], vec![0; ints]];
        let mut before = Expressions { pool: pool.clone(), registers, section: &inner.preamble };
        before.run()?;
        pool.iter_mut().zip(before.registers).for_each(|(pool, results)| pool.extend(results));
        let [floats, ints] = inner.registers;
        let mut main = Expressions { pool, registers: [vec![0; floats], vec![0; ints]], section: &inner.main };
        for (class, register, from) in &inner.splats {
            let value = main.of(*class, *from);
            main.put(*class, *register, value);
        }
        for port in &inner.inputs {
            main.put(port.class, port.register, hashed((1_u8, input(port.global, port.flat))));
        }
        main.run()?;
        let of = |(global, flat): &(GlobalId, u32)| {
            let port = inner.outputs.iter().find(|port| (port.global, port.flat) == (*global, *flat))?;
            main.registers[port.class as usize].get(port.register).copied()
        };
        let found: Vec<Option<u64>> = wanted.iter().map(of).collect();
        Some(hashed(found))
    }
}

fn pools(inner: &Inner, uniforms: &[Vec<ScalarValue>]) -> [Vec<u64>; 2] {
    let of = |source: &PoolSource| match source {
        PoolSource::Constant(bits) => hashed((2_u8, bits)),
        PoolSource::Unwritten(_) => hashed((2_u8, &0_u32)),
        PoolSource::Uniform(root, flat) => {
            let value = uniforms.get(root.0 as usize).and_then(|values| values.get(*flat as usize));
            // The bits: a uniform may be a NaN.
            hashed(match value {
                Some(ScalarValue::Float(value)) => (3_u8, value.to_bits()),
                Some(ScalarValue::Int(value)) => (4, *value as u32),
                Some(ScalarValue::Uint(value)) => (5, *value),
                Some(ScalarValue::Bool(value)) => (6, u32::from(*value)),
                None => (7, 0),
            })
        }
    };
    [&inner.float_pool, &inner.int_pool].map(|pool| pool.iter().map(of).collect())
}

impl Expressions<'_> {
    fn of(&self, class: Class, operand: Operand) -> u64 {
        let file = if operand.is_reg() { &self.registers } else { &self.pool };
        file[class as usize].get(operand.number()).copied().unwrap_or(0)
    }

    fn put(&mut self, class: Class, register: usize, value: u64) {
        if let Some(slot) = self.registers[class as usize].get_mut(register) {
            *slot = value;
        }
    }

    /// Runs the section. `None` if it has an instruction that is not an expression.
    fn run(&mut self) -> Option<()> {
        self.section.insts.iter().try_for_each(|inst| self.step(*inst))
    }

    fn step(&mut self, inst: Inst) -> Option<()> {
        if let Inst::MoveFloat { dst, a } | Inst::StoreFloat { dst, a } = inst {
            let value = self.of(Class::Float, a);
            self.put(Class::Float, dst.number(), value);
            return Some(());
        }
        if let Inst::MoveInt { dst, a } | Inst::StoreInt { dst, a } = inst {
            let value = self.of(Class::Int, a);
            self.put(Class::Int, dst.number(), value);
            return Some(());
        }
        let operation = operation(&inst)?;
        let (mut reads, mut writes) = (vec![operation], Vec::new());
        let mut note = |class: Class, using: Use, operand: Operand| match using {
            Use::Read => reads.push(self.of(class, operand)),
            Use::Write => writes.push((class, operand.number())),
        };
        let mut copy = inst;
        copy.visit(&mut |class, using, operand| note(class, using, *operand));
        for (class, using, list) in inst.lists().into_iter().flatten() {
            self.section.list(list).iter().for_each(|operand| note(class, using, *operand));
        }
        for (number, (class, register)) in writes.into_iter().enumerate() {
            self.put(class, register, hashed((&reads, number)));
        }
        Some(())
    }
}

/// The operation of an instruction without its operands.
fn operation(inst: &Inst) -> Option<u64> {
    let name = match inst {
        Inst::Float1 { op, .. } => format!("{op:?}"),
        Inst::Float2 { op, .. } => format!("{op:?}"),
        Inst::Float3 { op, .. } => format!("{op:?}"),
        Inst::Compare { op, .. } => format!("compare {op:?}"),
        Inst::FloatToInt { op, .. } => format!("from float {op:?}"),
        Inst::IntToFloat { op, .. } => format!("to float {op:?}"),
        Inst::Int1 { op, .. } => format!("int {op:?}"),
        Inst::Int2 { op, .. } => format!("int {op:?}"),
        Inst::Composite { op, size, .. } => format!("{op:?} {size}"),
        Inst::MulAdd { .. } => "a b + c".to_owned(),
        Inst::SumOfProducts { .. } => "sum".to_owned(),
        Inst::SelectFloat { .. } | Inst::SelectInt { .. } => "select".to_owned(),
        _ => return None,
    };
    Some(hashed(name))
}
