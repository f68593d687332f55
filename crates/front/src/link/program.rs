//! [`Program`] and its [`Interface`]: what was linked, and where each thing stands.

use crate::hir::{ArraySize, GlobalId, Interpolation, MatrixLayout, Shader, Stage, Type, TypeId, Types, Value};

/// A linked program.
#[derive(Clone, Debug)]
pub struct Program {
    /// The name that its outputs take: the stem of the first file.
    pub name: String,
    /// All types of all stages.
    pub types: Types,
    /// The stages in the order of the pipeline, at most one of each; a lone stage is a program, too.
    pub stages: Vec<Shader>,
    /// What they have in common with each other and with the outside.
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

    /// Whether an output is bound to a color number.
    pub fn writes_color(&self, number: u32) -> bool {
        self.interface.outputs.iter().any(|output| {
            let elements = match self.types.get(output.ty) {
                Type::Array(_, ArraySize::Sized(size)) => size,
                _ => 1,
            };
            (output.location..output.location.saturating_add(elements)).contains(&number)
        })
    }
}

/// A block in [`Interface::blocks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BlockIndex(pub u32);

/// A uniform in [`Interface::roots`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RootIndex(pub u32);

/// Everything at the borders of the stages.
#[derive(Clone, Debug, Default)]
pub struct Interface {
    /// Vertex inputs, in the order of their declarations. Built-in ones are not among them.
    pub attributes: Vec<Attribute>,
    /// What the rasteriser interpolates, cut into scalars and vectors, in the order of their locations.
    pub varyings: Vec<Varying>,
    /// The elements of `gl_ClipDistance` that the fragment stage reads: varyings that no host names.
    pub clip_distances: Vec<Varying>,
    /// Fragment outputs, `gl_FragColor` and `gl_FragData` included.
    pub outputs: Vec<Output>,
    /// Uniform blocks with their places; the loose uniforms' block is not among them.
    pub blocks: Vec<Block>,
    /// The place of the block that holds all loose uniforms, and its size in bytes (a multiple of 16).
    pub loose: Option<(SlotBinding, u32)>,
    /// The offset in the loose block of a hidden `float`, the framebuffer's height in pixels: there if the fragment stage
    /// reads `gl_FragCoord` with its origin at the lower left. Only `--window-origin upper-left` fills it.
    pub framebuffer_height: Option<u32>,
    /// Uniform variables and blocks as declared, samplers left out.
    pub roots: Vec<UniformRoot>,
    /// The same cut into scalars, vectors, matrices and arrays of those, as hosts name them.
    pub uniforms: Vec<UniformLeaf>,
    /// Samplers, one row an element of an array.
    pub samplers: Vec<SamplerSlot>,
}

/// A vertex attribute.
#[derive(Clone, Debug)]
pub struct Attribute {
    /// The GLSL name.
    pub name: String,
    /// The declared type; matrices and arrays take one location a column and element.
    pub ty: TypeId,
    /// The variable in the vertex stage.
    pub global: GlobalId,
    /// The first location.
    pub location: u32,
    /// How many locations.
    pub columns: u32,
    /// Whether the stage reads it.
    pub active: bool,
}

/// One end of a varying: a part of a variable's flat layout ([`Types::flat_len`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VaryingEnd {
    /// The variable.
    pub global: GlobalId,
    /// The first of the scalars in the variable's flat layout; the varying's type tells how many follow.
    pub flat_offset: u32,
}

/// A scalar or vector that the rasteriser interpolates.
#[derive(Clone, Debug)]
pub struct Varying {
    /// The path in GLSL: `vc`, `tangent[2]` (column of a matrix or element), `v.color`, `Block.member`.
    pub name: String,
    /// A scalar or vector of `float`, `int` or `uint`.
    pub ty: TypeId,
    /// The location.
    pub location: u32,
    /// The first of the location's four components.
    pub component: u32,
    /// As the fragment stage has it.
    pub interpolation: Interpolation,
    /// `centroid`
    pub centroid: bool,
    /// Whether the fragment stage reads it.
    pub active: bool,
    /// The output of the stage before the rasteriser, if that writes it.
    pub from: Option<VaryingEnd>,
    /// The input of the fragment stage.
    pub to: Option<VaryingEnd>,
}

/// A fragment output.
#[derive(Clone, Debug)]
pub struct Output {
    /// The GLSL name.
    pub name: String,
    /// The declared type; an array takes one location an element.
    pub ty: TypeId,
    /// The variable in the fragment stage.
    pub global: GlobalId,
    /// The first colour number.
    pub location: u32,
    /// For dual-source blending: 0 or 1.
    pub index: u32,
}

/// A bind group and a binding in it. Bindings are dense from 0 in every group.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct SlotBinding {
    /// The group: 0 holds the loose uniforms and the blocks, 1 the textures and samplers.
    pub group: u32,
    /// The binding.
    pub binding: u32,
}

/// A uniform block.
#[derive(Clone, Debug)]
pub struct Block {
    /// The block's name, without the index of an array's element.
    pub name: String,
    /// The instance name.
    pub instance: Option<String>,
    /// The size of an array of blocks; its elements take consecutive bindings.
    pub array_size: Option<u32>,
    /// Its place (that of its first element).
    pub slot: SlotBinding,
    /// The size of one element in bytes, a multiple of 16.
    pub size: u32,
    /// The root that it is.
    pub root: RootIndex,
    /// `layout(binding = n)`: the buffer binding point, for the host to know; it never moves `slot`.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A uniform variable or block as it is declared.
#[derive(Clone, Debug)]
pub struct UniformRoot {
    /// The variable's name; for a block the block's name.
    pub name: String,
    /// Its type.
    pub ty: TypeId,
    /// The variable in each stage that declares it.
    pub globals: Vec<(Stage, GlobalId)>,
    /// The block it is; `None` for a loose uniform.
    pub block: Option<BlockIndex>,
    /// For a loose uniform: its offset in the loose block.
    pub offset: u32,
    /// Its initializer's value.
    pub default: Option<Value>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A scalar, vector, matrix, or array of those, inside a root.
#[derive(Clone, Debug)]
pub struct UniformLeaf {
    /// As hosts name it: `light[1].position`, `Block.member`, `Block[1].member`, `member` of a block without instance.
    pub name: String,
    /// The type of one element.
    pub ty: TypeId,
    /// How many elements, if it is an array.
    pub array_size: Option<u32>,
    /// The root it is part of.
    pub root: RootIndex,
    /// Which element of an array of blocks it is in, 0 elsewhere.
    pub block_element: u32,
    /// The first of its scalars in the root's flat layout; elements follow each other there without gaps.
    pub flat_offset: u32,
    /// The place of its block (for an element of an array of blocks, of that element).
    pub slot: SlotBinding,
    /// Bytes from the start of the block.
    pub offset: u32,
    /// Bytes from element to element.
    pub array_stride: Option<u32>,
    /// Bytes from column to column (from row to row in `row_major`).
    pub matrix_stride: Option<u32>,
    /// The order of a matrix.
    pub matrix_layout: MatrixLayout,
    /// Whether a stage reads the root.
    pub active: bool,
}

/// A sampler: where its texture and its sampler stand.
#[derive(Clone, Debug)]
pub struct SamplerSlot {
    /// As hosts name it: `tex`, `tex[1]`, `material.albedo`.
    pub name: String,
    /// The sampler type.
    pub ty: TypeId,
    /// The size of the array that it is an element of.
    pub array_size: Option<u32>,
    /// The variable in each stage that declares it.
    pub globals: Vec<(Stage, GlobalId)>,
    /// Its place in the variable's flat layout.
    pub flat_offset: u32,
    /// The texture.
    pub texture: SlotBinding,
    /// The sampler; the same as `texture` for kinds that are only fetched from (buffer, integer, multisample).
    pub sampler: SlotBinding,
    /// The offset in the loose block of a hidden `int`, the number of texels of a buffer texture: there if the program asks
    /// for the size of one. A texture stands for the buffer, and its own size is another.
    pub texel_count: Option<u32>,
    /// `layout(binding = n)`: the texture unit.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
}
