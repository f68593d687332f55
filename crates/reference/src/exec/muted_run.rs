//! Runs in which one operation adds nothing to the envelopes.
//!
//! *In:* a machine with [`Muted`] operations. *Out:* the results of its instructions without the contribution of
//! their own rules.

use super::code::{Inner, Section};
use super::inst::{Class, Inst, Operand, Use};
use super::machine::Machine;
use super::mute::Muted;
use super::registers::{File, Register};
use crate::domain::{Domain, Element, Integer, Number};
use glisten_scene::picture::Interval;

/// Saved registers and numbers for all lanes, of one type.
struct Saved<T: Element> {
    registers: Vec<(usize, Register<T>)>,
    pool: Vec<(usize, T)>,
}

/// The operands of an instruction, of one class.
#[derive(Default)]
struct Operands {
    reads: Vec<Operand>,
    writes: Vec<Operand>,
}

impl<D: Domain> Machine<D> {
    /// Whether an instruction of a section is muted.
    pub(super) fn is_muted(&self, section: &Section, place: usize) -> bool {
        self.muted.as_ref().is_some_and(|muted| muted.holds(section.runs, place))
    }

    /// Makes a muted input exact.
    pub(super) fn mute_input(&mut self) {
        let Some(global) = self.muted.as_ref().and_then(Muted::only_input) else { return };
        for port in self.code.inner.inputs.iter().filter(|port| port.global == global && port.class == Class::Float) {
            if let Some(register) = self.registers.floats.get_mut(port.register) {
                register.spread().update(|_, number| exactly(number));
            }
        }
    }

    /// Runs an instruction and removes its own contribution from its results.
    pub(super) fn run_muted(&mut self, inst: &Inst, section: &Section, inner: &Inner, mask: u64) {
        let [floats, ints] = operands(inst, section, inner);
        let saved = make_exact(&mut self.registers.floats, &floats.reads, exactly);
        let saved_ints = make_exact(&mut self.registers.ints, &ints.reads, decided);
        self.run_plain(inst, section, inner, mask);
        let own = copies(&self.registers.floats, &floats.writes);
        let own_ints = copies(&self.registers.ints, &ints.writes);
        put_back(&mut self.registers.floats, saved);
        put_back(&mut self.registers.ints, saved_ints);
        self.run_plain(inst, section, inner, mask);
        subtract(&mut self.registers.floats, own, without);
        // An integer that is open although the operands are exact is one that the language leaves undefined.
        subtract(&mut self.registers.ints, own_ints, |int, own| if own.is_decided() { int } else { decided(int) });
    }

    fn run_plain(&mut self, inst: &Inst, section: &Section, inner: &Inner, mask: u64) {
        match inst {
            Inst::Texture { call } => {
                if let Some(call) = inner.textures.get(*call as usize) {
                    self.undecided |= self.texture(call, inner.stage, mask);
                }
            }
            _ => self.registers.compute_apart(inst, section),
        }
    }
}

/// The operands of an instruction: the floats, and the ints.
fn operands(inst: &Inst, section: &Section, inner: &Inner) -> [Operands; 2] {
    let mut found = [Operands::default(), Operands::default()];
    let mut note = |class: Class, using: Use, operand: Operand| {
        let [floats, ints] = &mut found;
        let of_class = if class == Class::Float { floats } else { ints };
        if using == Use::Read { &mut of_class.reads } else { &mut of_class.writes }.push(operand);
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
    found
}

/// Makes operands exact, and returns what they were.
fn make_exact<T: Element>(file: &mut File<T>, operands: &[Operand], exactly: impl Fn(T) -> T) -> Saved<T> {
    let mut saved = Saved { registers: Vec::new(), pool: Vec::new() };
    for operand in operands {
        let number = operand.number();
        if operand.is_reg() {
            if let Some(register) = file.get_mut(number) {
                saved.registers.push((number, register.clone()));
                register.change(&exactly);
            }
        } else if let Some(value) = file.pool.get_mut(number) {
            saved.pool.push((number, *value));
            *value = exactly(*value);
        }
    }
    saved
}

fn put_back<T: Element>(file: &mut File<T>, saved: Saved<T>) {
    // An operand that occurs twice was saved twice. The first copy is the original.
    for (number, old) in saved.registers.into_iter().rev() {
        if let Some(register) = file.get_mut(number) {
            *register = old;
        }
    }
    for (number, value) in saved.pool.into_iter().rev() {
        if let Some(slot) = file.pool.get_mut(number) {
            *slot = value;
        }
    }
}

fn copies<T: Element>(file: &File<T>, operands: &[Operand]) -> Vec<(usize, Register<T>)> {
    let copy = |operand: &Operand| Some((operand.number(), file.get(operand.number())?.clone()));
    operands.iter().filter_map(copy).collect()
}

/// Removes each result's own contribution.
fn subtract<T: Element>(file: &mut File<T>, own: Vec<(usize, Register<T>)>, without: impl Fn(T, T) -> T) {
    for (number, own) in own {
        if let Some(register) = file.get_mut(number) {
            let own = own.source();
            register.spread().update(|lane, number| without(number, own.at(lane)));
        }
    }
}

/// The most likely integer alone.
fn decided<I: Integer>(int: I) -> I {
    I::from_bits(int.bits())
}

fn exactly<N: Number>(number: N) -> N {
    N::integer_with_interval(number.value(), Interval::point(number.value()))
}

/// A number whose envelope is narrower by that of `own` around its value.
fn without<N: Number>(number: N, own: N) -> N {
    let (interval, own_interval) = (number.interval(), own.interval());
    let off = |distance: f64| if distance.is_finite() { distance.max(0.0) } else { f64::INFINITY };
    let (below, above) = (off(own.value() - own_interval.low), off(own_interval.high - own.value()));
    let value = number.value();
    let low = (interval.low + below).min(value);
    let high = (interval.high - above).max(value);
    let or_value = |end: f64| if end.is_nan() { value } else { end };
    N::integer_with_interval(
        value,
        Interval {
            low: or_value(low),
            high: or_value(high),
            may_be_nan: interval.may_be_nan && !own_interval.may_be_nan,
        },
    )
}
