//! [`Program`] and its [`Interface`]: the result of a link, with all assigned locations, offsets and bindings.

use crate::builtin::BuiltinVariable;
use crate::hir::{
    ArraySize, GlobalId, Interpolation, MatrixLayout, Sampling, Shader, Stage, Type, TypeId, Types, Value,
};

/// A linked program.
#[derive(Clone, Debug)]
pub struct Program {
    /// The name for its output files: the stem of the first source file.
    pub name: String,
    /// All types of all stages.
    pub types: Types,
    /// The stages in pipeline order, at most one of each. A single stage is a program, too.
    pub stages: Vec<Shader>,
    /// The interfaces between the stages, and those to the host.
    pub interface: Interface,
}

impl Interface {
    /// Everything that is interpolated, `gl_ClipDistance` last.
    pub fn interpolated(&self) -> impl Iterator<Item = &Varying> {
        self.varyings.iter().chain(&self.clip_distances)
    }
}

impl Program {
    /// The shader of a stage.
    pub fn stage(&self, stage: Stage) -> Option<&Shader> {
        self.stages.iter().find(|shader| shader.stage == stage)
    }

    /// Whether an output is assigned to a color number. `gl_FragColor` is for all of them.
    pub fn writes_color(&self, number: u32) -> bool {
        let fragment = self.stage(Stage::Fragment);
        self.interface.outputs.iter().any(|output| {
            let global = fragment.and_then(|shader| shader.globals.get(output.global.index()));
            if global.is_some_and(|global| global.builtin == Some(BuiltinVariable::FragColor)) {
                return true;
            }
            let elements = match self.types.get(output.ty) {
                Type::Array(_, ArraySize::Sized(size)) => size,
                _ => 1,
            };
            (output.location..output.location.saturating_add(elements)).contains(&number)
        })
    }
}

/// The index of a block in [`Interface::blocks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BlockIndex(pub u32);

/// The index of a uniform in [`Interface::roots`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RootIndex(pub u32);

/// All interfaces of a program.
#[derive(Clone, Debug, Default, Hash)]
pub struct Interface {
    /// Vertex inputs, in order of declaration, without the built-in ones.
    pub attributes: Vec<Attribute>,
    /// The inputs of the geometry stage for each vertex; empty without one.
    pub geometry_inputs: Vec<GeometryInput>,
    /// Varyings, split into scalars and vectors, in order of location.
    pub varyings: Vec<Varying>,
    /// The elements of `gl_ClipDistance` that the fragment stage reads: varyings that no host names.
    pub clip_distances: Vec<Varying>,
    /// Fragment outputs, `gl_FragColor` and `gl_FragData` included.
    pub outputs: Vec<Output>,
    /// Uniform blocks with their bindings, without the block of the loose uniforms.
    pub blocks: Vec<Block>,
    /// The binding of the block that contains all loose uniforms, and its size in bytes (a multiple of 16).
    pub loose: Option<(SlotBinding, u32)>,
    /// The offset, in the loose block, of a hidden `float`: the framebuffer's height in pixels. It exists if the
    /// fragment stage reads `gl_FragCoord` with its origin at the lower left. Only `--window-origin upper-left` sets
    /// it.
    pub framebuffer_height: Option<u32>,
    /// Uniform variables and blocks as declared, without samplers.
    pub roots: Vec<UniformRoot>,
    /// The uniforms split into scalars, vectors, matrices and arrays of those, under the names that hosts use.
    pub uniforms: Vec<UniformLeaf>,
    /// Samplers, with one entry per element of an array.
    pub samplers: Vec<SamplerSlot>,
}

/// A vertex attribute.
#[derive(Clone, Debug, Hash)]
pub struct Attribute {
    /// The GLSL name.
    pub name: String,
    /// The declared type; a matrix takes one location per column, an array one per element.
    pub ty: TypeId,
    /// The variable in the vertex stage.
    pub global: GlobalId,
    /// The first location.
    pub location: u32,
    /// The number of locations.
    pub columns: u32,
    /// Whether the stage reads it.
    pub active: bool,
}

/// One end of a varying: a part of a variable's flat layout ([`Types::flat_len`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct VaryingEnd {
    /// The variable.
    pub global: GlobalId,
    /// The index of its first scalar in the variable's flat layout. The varying's type determines how many follow.
    pub flat_offset: u32,
}

/// An input of the geometry stage, or a member of `gl_in`, with the output of the vertex stage that it reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct GeometryInput {
    /// The output of the vertex stage.
    pub from: VaryingEnd,
    /// The input, which is an array of vertices: the place in the element of one vertex.
    pub to: VaryingEnd,
    /// The number of scalars.
    pub scalars: u32,
}

/// A scalar or vector that the rasterizer interpolates.
#[derive(Clone, Debug, Hash)]
pub struct Varying {
    /// The path in GLSL: `vc`, `tangent[2]` (a column or an element), `v.color`, `Block.member`.
    pub name: String,
    /// A scalar or vector of `float`, `int` or `uint`.
    pub ty: TypeId,
    /// The location.
    pub location: u32,
    /// The first of the location's four components.
    pub component: u32,
    /// The interpolation, as the fragment stage declares it.
    pub interpolation: Interpolation,
    /// `centroid` or `sample`, as the fragment stage declares it.
    pub sampling: Sampling,
    /// Whether the fragment stage reads it.
    pub active: bool,
    /// The output of the stage before the rasterizer, if that stage writes it.
    pub from: Option<VaryingEnd>,
    /// The input of the fragment stage.
    pub to: Option<VaryingEnd>,
}

/// A fragment output.
#[derive(Clone, Debug, Hash)]
pub struct Output {
    /// The GLSL name.
    pub name: String,
    /// The declared type; an array takes one location per element.
    pub ty: TypeId,
    /// The variable in the fragment stage.
    pub global: GlobalId,
    /// The first color number.
    pub location: u32,
    /// For dual-source blending: 0 or 1.
    pub index: u32,
}

/// A bind group and a binding in it. In every group, bindings count from 0 without gaps.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SlotBinding {
    /// The group: 0 holds the loose uniforms and the blocks, 1 the textures and samplers.
    pub group: u32,
    /// The binding.
    pub binding: u32,
}

/// A uniform block.
#[derive(Clone, Debug, Hash)]
pub struct Block {
    /// The block's name, without an array index.
    pub name: String,
    /// The instance name.
    pub instance: Option<String>,
    /// The size of an array of blocks; its elements take consecutive bindings.
    pub array_size: Option<u32>,
    /// The binding (of the first element).
    pub slot: SlotBinding,
    /// The size of one element in bytes, a multiple of 16.
    pub size: u32,
    /// The root of the block.
    pub root: RootIndex,
    /// `layout(binding = n)`: the buffer binding point. It informs the host; it never affects `slot`.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A uniform variable or block as declared.
#[derive(Clone, Debug, Hash)]
pub struct UniformRoot {
    /// The variable's name; for a block, the block's name.
    pub name: String,
    /// The type.
    pub ty: TypeId,
    /// The variable in each stage that declares it.
    pub globals: Vec<(Stage, GlobalId)>,
    /// The block, if it is one; `None` for a loose uniform.
    pub block: Option<BlockIndex>,
    /// For a loose uniform: the offset in the loose block.
    pub offset: u32,
    /// The value of its initializer.
    pub default: Option<Value>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A scalar, vector, matrix, or array of those, in a root.
#[derive(Clone, Debug, Hash)]
pub struct UniformLeaf {
    /// The name that hosts use: `light[1].position`, `Block.member`, `Block[1].member`, `member` of a block without
    /// an instance name.
    pub name: String,
    /// The type of one element.
    pub ty: TypeId,
    /// The number of elements, if it is an array.
    pub array_size: Option<u32>,
    /// The root that it belongs to.
    pub root: RootIndex,
    /// The index of the element of an array of blocks that it is in; otherwise 0.
    pub block_element: u32,
    /// The index of its first scalar in the root's flat layout. There, elements follow each other without gaps.
    pub flat_offset: u32,
    /// The binding of its block (or of the element of an array of blocks).
    pub slot: SlotBinding,
    /// The offset in bytes from the start of the block.
    pub offset: u32,
    /// The stride in bytes between elements.
    pub array_stride: Option<u32>,
    /// The stride in bytes between columns (in `row_major`, rows).
    pub matrix_stride: Option<u32>,
    /// The matrix layout.
    pub matrix_layout: MatrixLayout,
    /// Whether a stage reads the root.
    pub active: bool,
}

/// A sampler, with the bindings of its texture and its sampler.
#[derive(Clone, Debug, Hash)]
pub struct SamplerSlot {
    /// The name that hosts use: `tex`, `tex[1]`, `material.albedo`.
    pub name: String,
    /// The sampler type.
    pub ty: TypeId,
    /// The size of the array that it belongs to, if it is an element.
    pub array_size: Option<u32>,
    /// The variable in each stage that declares it.
    pub globals: Vec<(Stage, GlobalId)>,
    /// The index in the variable's flat layout.
    pub flat_offset: u32,
    /// The binding of the texture.
    pub texture: SlotBinding,
    /// The binding of the sampler; equal to `texture` for kinds that are only fetched from (buffer, integer,
    /// multisample).
    pub sampler: SlotBinding,
    /// The offset, in the loose block, of a hidden `int`: the number of texels of a buffer texture. It exists if the
    /// program queries the size of one. A texture emulates the buffer, and its own size is a different one.
    pub texel_count: Option<u32>,
    /// `layout(binding = n)`: the texture unit.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
}
