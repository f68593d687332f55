//! Finds the origin of an envelope: the contribution of one expression's rule can be removed.
//!
//! *In:* the code of a stage. *Out:* its operations, each with what mutes it. [`muted_run`](super::muted_run) then
//! runs the instructions so that they propagate the envelopes of their operands and add nothing. *Holds:* an
//! instruction's own contribution is the envelope that its rule yields for exact operands. It is removed from both
//! bounds of each result. A muted input is exact.

use super::code::{Code, Runs};
use super::inst::{Float2, FloatToInt, Inst};
use glisten_front::builtin::operations::Rule;
use glisten_front::hir::GlobalId;
use glisten_front::source::Span;

/// An operation of the text, with its instructions.
#[derive(Clone, Debug)]
pub struct Operation {
    /// The expression.
    pub span: Span,
    /// The operation as GLSL writes it.
    pub name: &'static str,
    muted: Muted,
}

/// The operation or input that adds nothing.
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

    /// Whether an instruction is muted.
    pub(super) fn holds(&self, runs: Runs, place: usize) -> bool {
        let places = match runs {
            Runs::Once => &self.preamble,
            Runs::Always => &self.main,
        };
        places.contains(&place)
    }

    /// The muted input.
    pub(super) fn only_input(&self) -> Option<GlobalId> {
        self.input
    }
}

/// The name, if the rule of an operation adds an error.
fn own_error(rule: &Rule, name: &'static str) -> Option<&'static str> {
    rule.adds_error().then_some(name)
}

/// The operation of an instruction as GLSL writes it; `None` if it adds nothing. Of integers, what the language may leave
/// undefined adds everything.
fn name(inst: &Inst) -> Option<&'static str> {
    Some(match inst {
        Inst::Float1 { op, .. } => own_error(op.rule(), op.name())?,
        Inst::Float2 { op, .. } => own_error(op.rule(), op.name())?,
        Inst::Float3 { op, .. } => own_error(op.rule(), op.name())?,
        Inst::Composite { op, .. } => op.name(),
        Inst::MulAdd { .. } | Inst::SumOfProducts { .. } => Float2::Mul.name(),
        Inst::IntToFloat { .. } => "float",
        Inst::FloatToInt { op: FloatToInt::Int, .. } => "int",
        Inst::FloatToInt { op: FloatToInt::Uint, .. } => "uint",
        Inst::Int2 { op, .. } => op.undefined_name()?,
        Inst::Derivative { .. } => "derivative",
        Inst::Texture { .. } => "texture",
        _ => return None,
    })
}

impl Code {
    /// The operations of the stage that may add to an envelope.
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
