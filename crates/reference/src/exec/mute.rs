//! What the bound of a result comes from: the freedom that one expression's rule adds can be taken away.
//!
//! *In:* the code of a stage. *Out:* its operations, each with what mutes it; [`muted_run`](super::muted_run) then runs
//! the instructions so that they carry on what their operands bring and add nothing of their own.
//! *Holds:* what an instruction adds is what its rule gives where the operands are exactly their values; that much is
//! taken off both ends of each result. An input that is muted is exactly its value.

use super::code::{Code, Runs};
use super::inst::{Composite, Float1, Float2, Float3, Inst};
use glisten_front::hir::GlobalId;
use glisten_front::source::Span;

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

    /// Whether an instruction is muted.
    pub(super) fn holds(&self, runs: Runs, place: usize) -> bool {
        let places = match runs {
            Runs::Once => &self.preamble,
            Runs::Always => &self.main,
        };
        places.contains(&place)
    }

    /// The input that is muted.
    pub(super) fn only_input(&self) -> Option<GlobalId> {
        self.input
    }
}

/// How GLSL writes what an instruction does; `None` for what adds no freedom.
fn name(inst: &Inst) -> Option<&'static str> {
    Some(match inst {
        Inst::Float1 { op, .. } => match op {
            Float1::Neg | Float1::Abs | Float1::Sign | Float1::Floor | Float1::Ceil | Float1::Trunc => return None,
            Float1::Round => "round",
            Float1::Fract => "fract",
            Float1::Sqrt => "sqrt",
            Float1::Inversesqrt => "inversesqrt",
            Float1::Exp => "exp",
            Float1::Log => "log",
            Float1::Exp2 => "exp2",
            Float1::Log2 => "log2",
            Float1::Sin => "sin",
            Float1::Cos => "cos",
            Float1::Tan => "tan",
            Float1::Asin => "asin",
            Float1::Acos => "acos",
            Float1::Atan => "atan",
            Float1::Sinh => "sinh",
            Float1::Cosh => "cosh",
            Float1::Tanh => "tanh",
            Float1::Asinh => "asinh",
            Float1::Acosh => "acosh",
            Float1::Atanh => "atanh",
            Float1::Radians => "radians",
            Float1::Degrees => "degrees",
        },
        Inst::Float2 { op, .. } => match op {
            Float2::Add => "+",
            Float2::Sub => "-",
            Float2::Mul => "*",
            Float2::Div => "/",
            Float2::Mod => "mod",
            Float2::Pow => "pow",
            Float2::Atan2 => "atan",
            Float2::Min | Float2::Max | Float2::Step => return None,
        },
        Inst::MulAdd { .. } | Inst::SumOfProducts { .. } => "*",
        Inst::Float3 { op, .. } => match op {
            Float3::Mix => "mix",
            Float3::Smoothstep => "smoothstep",
            Float3::Clamp => return None,
        },
        Inst::IntToFloat { .. } => "float",
        Inst::Composite { op, .. } => match op {
            Composite::Length => "length",
            Composite::Distance => "distance",
            Composite::Dot => "dot",
            Composite::Cross => "cross",
            Composite::Normalize => "normalize",
            Composite::Faceforward => "faceforward",
            Composite::Reflect => "reflect",
            Composite::Refract => "refract",
            Composite::Determinant => "determinant",
            Composite::Inverse => "inverse",
        },
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
