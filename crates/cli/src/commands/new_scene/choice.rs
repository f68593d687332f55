//! [`Choice`]: the parts of a scene that trials choose.
//!
//! *In:* nothing. *Out:* values that the text of a scene follows. *Holds:* the same choice gives the same scene.

use super::forms::Form;
use glisten_front::hir::{Scalar, Type};
use glisten_front::link::UniformLeaf;

/// The numbers of a scene that are chosen.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Choice {
    pub(super) form: Form,
    pub(super) taste: Taste,
    /// The width and height of the window.
    pub(super) side: u32,
    /// Uniforms, and the number that they have in all components instead.
    pub(super) changed: Option<(Changed, f64)>,
}

/// Which of several values to take where a name says little.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Taste(pub(super) usize);

/// The uniforms that have another number.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Changed {
    One(String),
    /// All scalars that are floats, but the ends of ranges: equal ends divide by zero.
    Floats,
}

impl Changed {
    /// Whether a uniform is one of them.
    pub(super) fn has(&self, leaf: &UniformLeaf, ty: Type) -> bool {
        match self {
            Self::One(name) => *name == leaf.name,
            Self::Floats => ty == Type::Scalar(Scalar::Float) && !is_an_end(&leaf.name),
        }
    }
}

/// Whether a name says that it is one of the two ends of a range.
fn is_an_end(name: &str) -> bool {
    let name = name.rsplit('.').next().unwrap_or(name).to_lowercase();
    ["min", "max", "near", "far", "start", "end"].iter().any(|end| name.starts_with(end) || name.ends_with(end))
}
