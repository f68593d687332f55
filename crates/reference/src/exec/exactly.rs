//! [`Exactly`]: expressions whose f32 error is left out, so that an experiment shows what it does to the picture.
//!
//! *In:* the spans of expressions, and the part of their error. *Out:* results of their instructions without that part.
//! *Holds:* it changes only domains that follow the error ([`Number::corrected`](crate::domain::Number::corrected)). Copies and stores are not corrected:
//! they add nothing.

use super::code::{Code, Runs, Section};
use super::inst::Inst;
use super::observe::Kind;
use crate::domain::ErrorPart;
use glisten_front::source::Span;

/// The instructions to correct, and which part of their error.
#[derive(Clone, Debug)]
pub struct Exactly {
    preamble: Vec<bool>,
    main: Vec<bool>,
    pub(super) part: ErrorPart,
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

    pub(super) fn holds(&self, runs: Runs, place: usize) -> bool {
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
