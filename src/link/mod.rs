//! Stages into a program (GLSL 1.50 §4.3.4 to §4.3.9, OpenGL 3.2 §2.11).
//!
//! *In:* analysed shaders, bindings by name. *Out:* a [`Program`]: the stages with every interface matched and every
//! location, offset and binding assigned.
//!
//! *Holds:* the [`Interface`] is all that `lower`, `emit`, `cpu` and `gpu` know of the outside of a shader; none of them
//! assigns a place of its own.

mod program;

pub use program::{
    Attribute, Block, BlockIndex, Interface, Output, Program, RootIndex, SamplerSlot, SlotBinding, UniformLeaf,
    UniformRoot, Varying, VaryingEnd,
};
