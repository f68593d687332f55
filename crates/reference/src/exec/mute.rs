//! What the bound of a result comes from: the freedom that one expression's rule adds can be taken away.
//!
//! *In:* a machine and what to mute. *Out:* runs in which these instructions carry on what their operands bring and add
//! nothing of their own.
//! *Holds:* what an instruction adds is what its rule gives where the operands are exactly their values; that much is
//! taken off both ends of each result. An input that is muted is exactly its value.

use super::code::{Code, Inner, Section};
use super::inst::{Class, Float2, Inst, Operand, Use};
use super::machine::Machine;
use super::registers::Register;
use crate::domain::{Domain, Number};
use glisten_front::builtin::operations::Rule;
use glisten_front::hir::GlobalId;
use glisten_front::source::Span;
use glisten_scene::picture::Interval;

/// An operation of the text, and the instructions that it was made into.
#[derive(Clone, Debug)]
pub struct Operation {
    /// The expression.
    pub span: Span,
    /// How GLSL writes it.
    pub name: &'static str,
    muted: Muted,
}

/// What adds no freedom.
#[derive(Clone, Debug, Default)]
pub struct Muted {
    preamble: Vec<usize>,
    main: Vec<usize>,
    input: Option<GlobalId>,
}

impl Operation {
    /// Mutes the operation.
    pub fn muted(&self) -> Muted {
        self.muted.clone()
    }
}

impl Muted {
    /// Mutes an input.
    pub fn input(global: GlobalId) -> Self {
        Self { input: Some(global), ..Self::default() }
    }
}

/// The name, if the rule of an operation adds freedom of its own.
fn own_error(rule: &Rule, name: &'static str) -> Option<&'static str> {
    rule.adds_error().then_some(name)
}

/// How GLSL writes what an instruction does; `None` for what adds no freedom.
fn name(inst: &Inst) -> Option<&'static str> {
    Some(match inst {
        Inst::Float1 { op, .. } => own_error(op.rule(), op.name())?,
        Inst::Float2 { op, .. } => own_error(op.rule(), op.name())?,
        Inst::Float3 { op, .. } => own_error(op.rule(), op.name())?,
        Inst::Composite { op, .. } => op.name(),
        Inst::MulAdd { .. } | Inst::SumOfProducts { .. } => Float2::Mul.name(),
        Inst::IntToFloat { .. } => "float",
        Inst::Derivative { .. } => "derivative",
        Inst::Texture { .. } => "texture",
        _ => return None,
    })
}

impl Code {
    /// The operations of the stage that may add to a bound.
    pub fn operations(&self) -> Vec<Operation> {
        let mut list: Vec<Operation> = Vec::new();
        let sections = [(&self.inner.preamble, true), (&self.inner.main, false)];
        for (section, is_preamble) in sections {
            for (place, (inst, span)) in section.insts.iter().zip(&section.spans).enumerate() {
                let Some(name) = name(inst) else { continue };
                let known = list.iter().position(|operation| operation.span == *span && operation.name == name);
                let index = known.unwrap_or_else(|| {
                    list.push(Operation { span: *span, name, muted: Muted::default() });
                    list.len() - 1
                });
                if let Some(operation) = list.get_mut(index) {
                    if is_preamble { &mut operation.muted.preamble } else { &mut operation.muted.main }.push(place);
                }
            }
        }
        list
    }
}

/// Registers and numbers for all lanes as they were.
struct Saved<D: Domain> {
    registers: Vec<(usize, Register<D::Float>)>,
    pool: Vec<(usize, D::Float)>,
}

impl<D: Domain> Machine<D> {
    /// Whether an instruction of a section adds nothing of its own.
    pub(super) fn is_muted(&self, section: &Section, place: usize) -> bool {
        let Some(muted) = &self.muted else { return false };
        let is_preamble = std::ptr::eq(section, &raw const self.code.inner.preamble);
        if is_preamble { &muted.preamble } else { &muted.main }.contains(&place)
    }

    /// Makes a muted input exact.
    pub(super) fn mute_input(&mut self) {
        let Some(global) = self.muted.as_ref().and_then(|muted| muted.input) else { return };
        for port in self.code.inner.inputs.iter().filter(|port| port.global == global && port.class == Class::Float) {
            if let Some(register) = self.registers.floats.get_mut(port.register) {
                register.spread().update(|_, number| exactly(number));
            }
        }
    }

    /// Runs an instruction and takes off its results what it adds itself.
    pub(super) fn run_muted(&mut self, inst: &Inst, section: &Section, inner: &Inner, mask: u64) {
        let (mut reads, mut writes) = (Vec::new(), Vec::new());
        let mut note = |class: Class, using: Use, operand: Operand| {
            if class == Class::Float {
                if using == Use::Read { &mut reads } else { &mut writes }.push(operand);
            }
        };
        let mut copy = *inst;
        copy.visit(&mut |class, using, operand| note(class, using, *operand));
        for (class, using, list) in inst.lists().into_iter().flatten() {
            section.list(list).iter().for_each(|operand| note(class, using, *operand));
        }
        if let Inst::Texture { call } = inst
            && let Some(call) = inner.textures.get(*call as usize)
        {
            call.clone().visit(&mut |class, using, operand| note(class, using, *operand));
        }
        let saved = self.make_exact(&reads);
        self.run_plain(inst, section, inner, mask);
        let own: Vec<Register<D::Float>> =
            writes.iter().filter_map(|operand| self.registers.floats.get(operand.number()).cloned()).collect();
        self.put_back(saved);
        self.run_plain(inst, section, inner, mask);
        for (operand, own) in writes.iter().zip(own) {
            if let Some(register) = self.registers.floats.get_mut(operand.number()) {
                let own = own.source();
                register.spread().update(|lane, number| without(number, own.at(lane)));
            }
        }
    }

    fn run_plain(&mut self, inst: &Inst, section: &Section, inner: &Inner, mask: u64) {
        match inst {
            Inst::Texture { call } => {
                if let Some(call) = inner.textures.get(*call as usize) {
                    self.undecided |= self.texture(call, inner.stage, mask);
                }
            }
            _ => self.registers.compute(inst, section),
        }
    }

    fn make_exact(&mut self, operands: &[Operand]) -> Saved<D> {
        let mut saved = Saved { registers: Vec::new(), pool: Vec::new() };
        for operand in operands {
            let number = operand.number();
            if operand.is_reg() {
                if let Some(register) = self.registers.floats.get_mut(number) {
                    saved.registers.push((number, register.clone()));
                    register.spread().update(|_, number| exactly(number));
                }
            } else if let Some(value) = self.registers.floats.pool.get_mut(number) {
                saved.pool.push((number, *value));
                *value = exactly(*value);
            }
        }
        saved
    }

    fn put_back(&mut self, saved: Saved<D>) {
        // An operand that stands twice was saved twice, the first time as it was.
        for (number, old) in saved.registers.into_iter().rev() {
            if let Some(register) = self.registers.floats.get_mut(number) {
                *register = old;
            }
        }
        for (number, value) in saved.pool.into_iter().rev() {
            if let Some(slot) = self.registers.floats.pool.get_mut(number) {
                *slot = value;
            }
        }
    }
}

fn exactly<N: Number>(number: N) -> N {
    N::whole(number.value(), Interval::point(number.value()))
}

/// A number without as much freedom as another has about its value.
fn without<N: Number>(number: N, own: N) -> N {
    let (range, own_range) = (number.range(), own.range());
    let off = |distance: f64| if distance.is_finite() { distance.max(0.0) } else { f64::INFINITY };
    let (below, above) = (off(own.value() - own_range.low), off(own_range.high - own.value()));
    let value = number.value();
    let low = (range.low + below).min(value);
    let high = (range.high - above).max(value);
    let or_value = |end: f64| if end.is_nan() { value } else { end };
    N::whole(
        value,
        Interval { low: or_value(low), high: or_value(high), may_be_nan: range.may_be_nan && !own_range.may_be_nan },
    )
}
