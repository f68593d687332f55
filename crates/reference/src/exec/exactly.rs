//! [`Exactly`]: expressions whose f32 error is left out, so that an experiment shows what it does to the picture.
//!
//! *In:* the spans of expressions, and the part of their error. *Out:* results of their instructions without that part.
//! *Holds:* it changes only domains that follow the error ([`Number::corrected`]). Copies and stores are not corrected:
//! they add nothing.

use super::code::{Code, Runs, Section};
use super::inst::{Class, Inst, Use};
use super::machine::Machine;
use super::observe::Kind;
use crate::domain::{Domain, ErrorPart, Integer, Number};
use glisten_front::source::Span;

/// The instructions to correct, and which part of their error.
#[derive(Clone, Debug)]
pub struct Exactly {
    preamble: Vec<bool>,
    main: Vec<bool>,
    part: ErrorPart,
}

impl Exactly {
    /// Corrects the expressions of a stage that `chosen` accepts.
    pub fn new(code: &Code, part: ErrorPart, chosen: impl Fn(Span) -> bool) -> Self {
        let places = |section: &Section| {
            let each = section.insts.iter().zip(&section.spans);
            each.map(|(inst, span)| computes(inst) && chosen(*span)).collect()
        };
        Self { preamble: places(&code.inner.preamble), main: places(&code.inner.main), part }
    }

    fn holds(&self, runs: Runs, place: usize) -> bool {
        let places = match runs {
            Runs::Once => &self.preamble,
            Runs::Always => &self.main,
        };
        places.get(place).copied().unwrap_or(false)
    }
}

/// Whether an instruction has an f32 error of its own, or follows from numbers that have one.
fn computes(inst: &Inst) -> bool {
    Kind::of(inst).is_some() || matches!(inst, Inst::Compare { .. } | Inst::FloatToInt { .. } | Inst::Texture { .. })
}

impl<D: Domain> Machine<D> {
    /// Corrects the results of an instruction that has just run, if it is among the chosen ones.
    pub(super) fn correct(&mut self, inst: &Inst, section: &Section, place: usize) {
        let Some(exactly) = self.exactly.as_ref().filter(|exactly| exactly.holds(section.runs, place)) else { return };
        let part = exactly.part;
        let mut written = Vec::new();
        let mut copy = *inst;
        copy.visit(&mut |class, using, operand| {
            if using == Use::Write {
                written.push((class, *operand));
            }
        });
        for (class, _, list) in inst.lists().into_iter().flatten().filter(|(_, using, _)| *using == Use::Write) {
            written.extend(section.list(list).iter().map(|operand| (class, *operand)));
        }
        if let Inst::Texture { call } = inst
            && let Some(call) = self.code.inner.textures.get(*call as usize)
        {
            call.clone().visit(&mut |class, using, operand| {
                if using == Use::Write {
                    written.push((class, *operand));
                }
            });
        }
        for (class, operand) in written {
            match class {
                Class::Float => {
                    self.registers.floats.register(operand).change(|number| number.corrected(part));
                }
                Class::Int => self.registers.ints.register(operand).change(Integer::corrected),
            }
        }
    }
}
