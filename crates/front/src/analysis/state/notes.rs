//! [`Notes`]: what each name of a text denotes, for programs that show a text to its author.
//!
//! *In:* one [`Note`] for each name, and the names in sight of a [`Probe`]. *Holds:* a name in the body of a macro is noted at each use
//! of the macro, with the span of that use.

use crate::hir::{FunctionId, GlobalId, LocalId, StructId, TypeId};
use crate::source::Span;
use crate::syntax::token::Symbol;

/// The thing that a name denotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Denoted {
    /// A global variable, or the instance of a block.
    Global(GlobalId),
    /// A local or a parameter of a function.
    Local(FunctionId, LocalId),
    /// A function.
    Function(FunctionId),
    /// A struct.
    Struct(StructId),
    /// A block, by its block name.
    Block(StructId),
    /// A member of a struct or of a block.
    Member(StructId, u32),
    /// A built-in function, variable or constant: the tables have it under the name.
    Builtin,
    /// Components of a vector of this type.
    Components(TypeId),
    /// The method `length` of a value of this type.
    Length(TypeId),
    /// Something whose declaration, at this place, is in error.
    Broken(Span),
}

/// The use of the thing at the place of the name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum NoteRole {
    /// It is declared.
    Declares,
    /// It is defined: the name of a function with a body.
    Defines,
    /// It is used.
    Uses,
}

/// A name and what it denotes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Note {
    /// The name.
    pub span: Span,
    /// The thing that it denotes.
    pub denoted: Denoted,
    /// The use of it.
    pub role: NoteRole,
}

/// A name that stands where its author wants to know what could stand there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Probe {
    /// The type of the value whose member the name would be.
    pub member_of: Option<TypeId>,
    /// The names in sight, in order of declaration, unless it would be a member.
    pub names: Vec<(Symbol, Denoted)>,
    /// The function around it.
    pub function: Option<FunctionId>,
}

/// The notes on one shader.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Notes {
    /// The names, in the order of the analysis.
    pub names: Vec<Note>,
    /// The names in scope that the probe has found.
    pub probe: Option<Probe>,
    /// The names at global scope at the end, in order of declaration.
    pub at_end: Vec<(Symbol, Denoted)>,
}

/// Takes notes.
#[derive(Debug, Default)]
pub(in crate::analysis) struct NoteTaker {
    /// The notes so far.
    pub(in crate::analysis) notes: Notes,
    /// The name that is the probe.
    pub(in crate::analysis) probe: Option<Symbol>,
}
