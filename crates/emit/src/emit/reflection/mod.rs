//! [`Reflection`]: all that a host needs to know of a program, in the names of its GLSL.
//!
//! *In:* a linked [`Program`] and the [`Conventions`] of its emission. *Out:* a value that serializes to the JSON of
//! `glisten reflect --format json` (its schema is `docs/reflection.schema.json`), a table for people, and the answer to
//! "what is this name?". *Holds:* keys are only ever added; rows stand in the order of the [`Interface`].

mod find;
mod table;

pub use find::{Found, find};
pub use table::table;

use crate::target::{ClipZ, Conventions, SpirvEnv, WindowOrigin};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{MatrixLayout, ScalarValue, Stage, Storage, Type, Types, Value};
use glisten_front::link::{Interface, Program, SamplerSlot, SlotBinding, UniformLeaf};
use serde::{Deserialize, Serialize};

/// What a host needs to know of a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reflection {
    /// The name of each stage's entry point.
    pub entry_points: EntryPoints,
    /// Vertex inputs.
    pub attributes: Vec<Attribute>,
    /// What the rasterizer interpolates.
    pub varyings: Vec<Varying>,
    /// Fragment outputs.
    pub outputs: Vec<Output>,
    /// The block that holds the loose uniforms, if there are any.
    pub loose_block: Option<LooseBlock>,
    /// Uniform blocks.
    pub blocks: Vec<Block>,
    /// Uniforms, loose and in blocks.
    pub uniforms: Vec<Uniform>,
    /// Samplers, one row an element of an array.
    pub samplers: Vec<Sampler>,
    /// How the program was emitted.
    pub conventions: ReflectedConventions,
}

/// Names of entry points.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EntryPoints {
    /// Of the vertex stage.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub vertex: Option<String>,
    /// Of the geometry stage, which no target has.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub geometry: Option<String>,
    /// Of the fragment stage.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub fragment: Option<String>,
}

/// A vertex input.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Attribute {
    /// The GLSL name.
    pub name: String,
    /// The GLSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// The first location.
    pub location: u32,
    /// How many locations: a matrix takes one a column, an array one an element (or its columns).
    pub columns: u32,
    /// Whether the vertex stage reads it.
    pub active: bool,
}

/// A scalar or vector that the rasterizer interpolates.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Varying {
    /// The GLSL path.
    pub name: String,
    /// The GLSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// The location.
    pub location: u32,
    /// The first of the location's four components.
    pub component: u32,
    /// `smooth`, `noperspective` or `flat`.
    pub interpolation: String,
    /// `centroid`
    pub centroid: bool,
    /// Whether the fragment stage reads it.
    pub active: bool,
}

/// A fragment output.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Output {
    /// The GLSL name.
    pub name: String,
    /// The GLSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// The first color number; an array takes one an element.
    pub location: u32,
    /// 1 for the second source of dual-source blending, else 0.
    pub index: u32,
}

/// A bind group and a binding in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Slot {
    /// The group.
    pub group: u32,
    /// The binding, dense from 0 in its group.
    pub binding: u32,
}

impl From<SlotBinding> for Slot {
    fn from(slot: SlotBinding) -> Self {
        Self { group: slot.group, binding: slot.binding }
    }
}

/// The uniform buffer that holds the loose uniforms.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LooseBlock {
    /// The group.
    pub group: u32,
    /// The binding.
    pub binding: u32,
    /// Bytes, a multiple of 16.
    pub size: u32,
}

/// A uniform block.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// The block's name.
    pub name: String,
    /// The instance name.
    pub instance: Option<String>,
    /// The size of an array of blocks, whose elements take consecutive bindings.
    pub array_size: Option<u32>,
    /// The group.
    pub group: u32,
    /// The binding of the (first) block.
    pub binding: u32,
    /// Bytes of one element, a multiple of 16.
    pub size: u32,
    /// `layout(binding = n)` of the text.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A scalar, vector, matrix, or array of those.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uniform {
    /// The path as a host names it: `light[1].position`, `Block.member`, `Block[1].member`.
    pub name: String,
    /// The GLSL type of one element.
    #[serde(rename = "type")]
    pub ty: String,
    /// How many elements, if it is an array.
    pub array_size: Option<u32>,
    /// The block's name; none for a loose uniform.
    pub block: Option<String>,
    /// The group of the buffer.
    pub group: u32,
    /// The binding of the buffer.
    pub binding: u32,
    /// Bytes from the start of the buffer.
    pub offset: u32,
    /// Bytes from element to element.
    pub array_stride: Option<u32>,
    /// Bytes from column to column, in `row_major` from row to row.
    pub matrix_stride: Option<u32>,
    /// Whether a matrix stands row by row.
    pub row_major: bool,
    /// The initializer's numbers or booleans, elements in order, matrices by columns; a number that JSON lacks is null.
    pub default: Option<Vec<serde_json::Value>>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// A texture with its sampler.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sampler {
    /// The path as a host names it: `tex`, `tex[1]`, `material.albedo`.
    pub name: String,
    /// The GLSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// The size of the array that it is an element of.
    pub array_size: Option<u32>,
    /// Where the texture stands.
    pub texture: Slot,
    /// Where the sampler stands; the same as `texture` where the kind has none (integer, buffer, multisample).
    pub sampler: Slot,
    /// The view of the texture, as WebGPU names it: `2d`, `2d-array`, `3d`, `cube`.
    #[serde(default)]
    pub view_dimension: String,
    /// What is read, as WebGPU names it: `float`, `unfilterable-float`, `depth`, `sint`, `uint`.
    #[serde(default)]
    pub sample_type: String,
    /// Whether the texture is multisampled.
    #[serde(default)]
    pub multisampled: bool,
    /// The kind of sampler, as WebGPU names it: `filtering`, `comparison`; none where there is no sampler.
    #[serde(default)]
    pub sampler_type: Option<String>,
    /// How many texels a row has of the 2D texture that stands for a buffer texture; none for other kinds.
    #[serde(default)]
    pub row_width: Option<u32>,
    /// Where the host writes the number of texels of a buffer texture, an `int`; none if the program does not ask for it.
    #[serde(default)]
    pub texel_count: Option<HiddenSlot>,
    /// `layout(binding = n)` of the text: the texture unit.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
}

/// How the program was emitted.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReflectedConventions {
    /// `zero-to-one`, `minus-one-to-one`
    pub clip_z: String,
    /// `upper-left`, `lower-left`
    pub window_origin: String,
    /// `as-declared`, or `inverted` where the vertex stage flips.
    pub front_face: String,
    /// Where the host writes the framebuffer's height in pixels, a `float`; none if the program need not know it.
    pub framebuffer_height: Option<HiddenSlot>,
    /// `first`: WGSL and Vulkan take a `flat` varying from the first vertex, OpenGL from the last, so that the host
    /// rotates its indices.
    pub provoking_vertex: String,
    /// `webgpu`, `vulkan`
    pub spirv_env: String,
    /// How many clip distances are in effect.
    pub clip_distances: u32,
    /// Whether the program sets the size of points.
    pub point_size: bool,
}

/// Four bytes in the loose uniforms' block that no uniform of the program's stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HiddenSlot {
    /// The group.
    pub group: u32,
    /// The binding.
    pub binding: u32,
    /// Bytes from the start of the block.
    pub offset: u32,
}

/// What a host needs to know of a program emitted under these conventions.
pub fn reflect(program: &Program, conventions: &Conventions) -> Reflection {
    let Program { types, interface, .. } = program;
    let name = |ty| types.name(ty);
    Reflection {
        entry_points: entry_points(program),
        attributes: interface
            .attributes
            .iter()
            .map(|row| Attribute {
                name: row.name.clone(),
                ty: name(row.ty),
                location: row.location,
                columns: row.columns,
                active: row.active,
            })
            .collect(),
        varyings: interface
            .varyings
            .iter()
            .map(|row| Varying {
                name: row.name.clone(),
                ty: name(row.ty),
                location: row.location,
                component: row.component,
                interpolation: row.interpolation.name().into(),
                centroid: row.centroid,
                active: row.active,
            })
            .collect(),
        outputs: interface
            .outputs
            .iter()
            .map(|row| Output { name: row.name.clone(), ty: name(row.ty), location: row.location, index: row.index })
            .collect(),
        loose_block: interface.loose.map(|(slot, size)| LooseBlock { group: slot.group, binding: slot.binding, size }),
        blocks: interface.blocks.iter().map(block).collect(),
        uniforms: interface.uniforms.iter().map(|leaf| uniform(types, interface, leaf)).collect(),
        samplers: interface.samplers.iter().map(|slot| sampler(types, interface, slot)).collect(),
        conventions: reflected_conventions(program, conventions),
    }
}

fn entry_points(program: &Program) -> EntryPoints {
    let of = |stage| program.stage(stage).filter(|shader| shader.main.is_some()).map(|_| "main".to_owned());
    EntryPoints { vertex: of(Stage::Vertex), geometry: of(Stage::Geometry), fragment: of(Stage::Fragment) }
}

fn block(row: &glisten_front::link::Block) -> Block {
    Block {
        name: row.name.clone(),
        instance: row.instance.clone(),
        array_size: row.array_size,
        group: row.slot.group,
        binding: row.slot.binding,
        size: row.size,
        unit: row.unit,
        active: row.active,
    }
}

fn uniform(types: &Types, interface: &Interface, leaf: &UniformLeaf) -> Uniform {
    let root = interface.roots.get(leaf.root.0 as usize);
    let block = root.and_then(|root| root.block).and_then(|index| interface.blocks.get(index.0 as usize));
    let len = types.flat_len(leaf.ty).saturating_mul(leaf.array_size.unwrap_or(1));
    let default = root.and_then(|root| root.default.as_ref()).and_then(|value| numbers(value, leaf.flat_offset, len));
    Uniform {
        name: leaf.name.clone(),
        ty: types.name(leaf.ty),
        array_size: leaf.array_size,
        block: block.map(|block| block.name.clone()),
        group: leaf.slot.group,
        binding: leaf.slot.binding,
        offset: leaf.offset,
        array_stride: leaf.array_stride,
        matrix_stride: leaf.matrix_stride,
        row_major: leaf.matrix_layout == MatrixLayout::RowMajor,
        default,
        active: leaf.active,
    }
}

/// A part of a value's flat layout as JSON.
fn numbers(value: &Value, start: u32, len: u32) -> Option<Vec<serde_json::Value>> {
    let scalars = value.scalars.get(start as usize..start.checked_add(len)? as usize)?;
    let json = |scalar: &ScalarValue| match *scalar {
        ScalarValue::Bool(value) => value.into(),
        ScalarValue::Int(value) => value.into(),
        ScalarValue::Uint(value) => value.into(),
        ScalarValue::Float(value) => shortest(value),
    };
    Some(scalars.iter().map(json).collect())
}

/// The shortest decimal that rounds to the f32: 0.1 and not 0.10000000149011612.
fn shortest(value: f32) -> serde_json::Value {
    value.to_string().parse::<f64>().map_or(serde_json::Value::Null, serde_json::Value::from)
}

fn sampler(types: &Types, interface: &Interface, row: &SamplerSlot) -> Sampler {
    let shape = match types.get(row.ty) {
        Type::Sampler(ty) => crate::target::Shape::of(ty),
        _ => crate::target::Shape::default(),
    };
    Sampler {
        name: row.name.clone(),
        ty: types.name(row.ty),
        array_size: row.array_size,
        texture: row.texture.into(),
        sampler: row.sampler.into(),
        view_dimension: shape.view_dimension.into(),
        sample_type: shape.sample_type.into(),
        multisampled: shape.multisampled,
        sampler_type: shape.sampler_type.map(str::to_owned),
        row_width: shape.row_width,
        texel_count: row.texel_count.and_then(|offset| hidden(interface, offset)),
        unit: row.unit,
        active: row.active,
    }
}

fn hidden(interface: &Interface, offset: u32) -> Option<HiddenSlot> {
    interface.loose.map(|(slot, _)| HiddenSlot { group: slot.group, binding: slot.binding, offset })
}

fn reflected_conventions(program: &Program, conventions: &Conventions) -> ReflectedConventions {
    let upper_left = conventions.window_origin == WindowOrigin::UpperLeft;
    let height = program.interface.framebuffer_height.filter(|_| upper_left);
    ReflectedConventions {
        clip_z: match conventions.clip_z {
            ClipZ::ZeroToOne => "zero-to-one",
            ClipZ::MinusOneToOne => "minus-one-to-one",
        }
        .into(),
        window_origin: if upper_left { "upper-left" } else { "lower-left" }.into(),
        front_face: if upper_left { "as-declared" } else { "inverted" }.into(),
        framebuffer_height: height.and_then(|offset| hidden(&program.interface, offset)),
        provoking_vertex: "first".into(),
        spirv_env: match conventions.spirv_env {
            SpirvEnv::Webgpu => "webgpu",
            SpirvEnv::Vulkan => "vulkan",
        }
        .into(),
        clip_distances: clip_distances(program, conventions),
        point_size: conventions.program_point_size && writes(program, BuiltinVariable::PointSize).is_some(),
    }
}

/// The output of the vertex stage that is this built-in variable, if that is written.
fn writes(program: &Program, builtin: BuiltinVariable) -> Option<&glisten_front::hir::Global> {
    let globals = &program.stage(Stage::Vertex)?.globals;
    globals.iter().find(|global| global.builtin == Some(builtin) && global.storage == Storage::Out && global.written)
}

/// How many clip distances count: those that are written, at most as many as the conventions enable.
fn clip_distances(program: &Program, conventions: &Conventions) -> u32 {
    let Some(global) = writes(program, BuiltinVariable::ClipDistance) else { return 0 };
    let declared = match program.types.get(global.ty) {
        Type::Array(..) => program.types.flat_len(global.ty),
        _ => 0,
    };
    conventions.clip_distances.map_or(declared, |enabled| enabled.min(declared))
}
