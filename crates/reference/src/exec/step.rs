//! [`Step`]: a kind of thing that a stage executes, for those who count.
//!
//! *Holds:* names are those of the table of operations, and of [`Step::OTHERS`] for what that table does not have.

use glisten_front::builtin::operations::{Binary, Composite, Derivative, Ternary, Unary};

/// A kind of step with its size. What it costs is for others to say.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Step {
    /// The name: `+`, `pow`, `normalize`, `lookup`, `branch`, `fragment`.
    pub name: &'static str,
    /// The components of the result; of an invocation, the components of its outputs; of a lookup, 4.
    pub results: u32,
    /// The components of the first argument; of an invocation, the components of its inputs; of a lookup, the texels that
    /// it reads.
    pub argument: u32,
}

impl Step {
    /// The invocation of the vertex stage.
    pub const VERTEX: &str = "vertex";
    /// The invocation of the fragment stage.
    pub const FRAGMENT: &str = "fragment";
    /// A lookup in a texture.
    pub const LOOKUP: &str = "lookup";
    /// The steps that are not in the table of operations.
    pub const OTHERS: &[&str] = &[
        Self::VERTEX,
        Self::FRAGMENT,
        Self::LOOKUP,
        "negation",
        "comparison",
        "conversion",
        "selection",
        "branch",
        "index",
        "integer",
        "integer division",
    ];

    /// The names of all steps, sorted.
    pub fn names() -> Vec<&'static str> {
        let unary = Unary::ALL.iter().map(|op| name_of_unary(*op));
        let binary = Binary::ALL.iter().map(|op| op.name());
        let ternary = Ternary::ALL.iter().map(|op| op.name());
        let composite = Composite::ALL.iter().map(|op| op.name());
        let mut names: Vec<&str> = unary.chain(binary).chain(ternary).chain(composite).collect();
        names.extend(Derivative::ALL.iter().map(|op| op.name()));
        names.extend(Self::OTHERS);
        names.sort_unstable();
        names.dedup();
        names
    }

    pub(super) fn scalar(name: &'static str) -> Option<Self> {
        Some(Self { name, results: 1, argument: 1 })
    }
}

/// The name of an operation on one float.
pub(super) fn name_of_unary(op: Unary) -> &'static str {
    // `-` is the name of the subtraction.
    if op == Unary::Neg { "negation" } else { op.name() }
}
