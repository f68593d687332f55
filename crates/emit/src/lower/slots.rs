//! How globals, locals and outputs are represented in naga's IR.

use glisten_front::hir::{GlobalId, TypeId};
use glisten_front::link::VaryingEnd;
use naga::{Binding, Expression, Handle};

/// The handle of a type in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct HostId(pub(super) usize);

/// How a global is represented.
#[derive(Clone, Debug)]
pub(super) enum GlobalSlot {
    /// Not at all: this stage does not use it, or it is a sampler.
    Unused,
    /// A member of the block of the loose uniforms.
    Loose { variable: Handle<naga::GlobalVariable>, member: u32, host: HostId },
    /// A uniform block, or the elements of an array of them.
    Block { variables: Vec<Handle<naga::GlobalVariable>>, host: HostId, arrayed: bool },
    /// A variable of the module.
    Private(Handle<naga::GlobalVariable>),
    /// A constant of the module.
    Constant(Handle<naga::Constant>),
    /// A variable or argument of the entry point, the only function that uses it.
    Entry,
}

/// How a local is represented.
#[derive(Clone, Debug)]
pub(super) enum LocalSlot {
    /// Not represented yet.
    Unset,
    /// Through a pointer: a variable, or an `out` argument.
    Pointer(Handle<Expression>),
    /// A named value.
    Value(Handle<Expression>),
}

/// A texture and its sampler, as values of a function.
#[derive(Clone, Copy, Debug)]
pub(super) struct SamplerValue {
    /// The index in the flat layout of the variable that it belongs to.
    pub(super) flat: u32,
    pub(super) texture: Handle<Expression>,
    /// `None` for kinds that are only fetched from.
    pub(super) sampler: Option<Handle<Expression>>,
    /// The number of texels of a buffer texture, if the program queries that of any.
    pub(super) texel_count: Option<Handle<Expression>>,
}

/// A function of the shader after lowering.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lowered {
    pub(super) handle: Handle<naga::Function>,
}

/// A member of the result of an entry point.
#[derive(Clone, Debug)]
pub(super) struct OutputMember {
    pub(super) name: String,
    pub(super) ty: Handle<naga::Type>,
    pub(super) binding: Binding,
    pub(super) source: OutputSource,
}

/// Where the value of such a member comes from.
#[derive(Clone, Debug)]
pub(super) enum OutputSource {
    Position,
    /// The place in the point, where points are drawn as quads.
    PointCoord,
    /// The number of the point, where points are drawn as quads.
    PointNumber,
    /// A color that the stage does not write.
    Nothing,
    PointSize,
    ClipDistances(GlobalId, u32),
    /// The varyings at a location: each with its component and, if the stage writes it, its variable.
    Varyings(Vec<(u32, TypeId, Option<VaryingEnd>)>),
    /// A color: a variable, or an element of an array.
    Color {
        global: GlobalId,
        element: Option<u32>,
        ty: TypeId,
    },
    Depth(GlobalId),
}

/// A corner of a point that is drawn as a quad.
#[derive(Clone, Copy)]
pub(super) struct Corner {
    /// -1 or 1 along each axis of normalized device coordinates.
    pub(super) direction: Handle<Expression>,
    /// `gl_PointCoord`
    pub(super) coordinate: Handle<Expression>,
    /// `gl_PrimitiveID` of the point, if the fragment stage reads it.
    pub(super) number: Option<Handle<Expression>>,
}
