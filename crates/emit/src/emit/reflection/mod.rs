//! [`Reflection`]: everything that a host needs to know about a program, under its GLSL names.
//!
//! *In:* a linked [`Program`] and the [`Conventions`] of its emission. *Out:* a value that serializes to the JSON of
//! `glisten reflect --format json` (its schema is `docs/reflection.schema.json`), a table for people, and the answer
//! to "what is this name?". *Holds:* keys are only ever added; rows are in the order of the [`Interface`].

mod arrays;
mod find;
mod places;
mod table;
mod wgsl;

pub use arrays::{StructArray, StructMember};
pub use find::{Found, Match, find};
pub use places::{
    GlslTarget, HlslBuffer, HlslTarget, HlslTexture, MslBuffer, MslTarget, MslTexture, PointSprites, Targets,
    Visibility,
};
pub use table::table;
pub use wgsl::{WgslTexture, WgslVariable};

use super::merge::entry_point;
use crate::target::{ClipZ, Conventions, SpirvEnv, WindowOrigin};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{MatrixLayout, Sampling, ScalarValue, Stage, Storage, Type, Types, Value};
use glisten_front::link::{Interface, Program, SamplerSlot, SlotBinding, UniformLeaf};
use places::Places;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Everything that a host needs to know about a program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reflection {
    /// The name of each stage's entry point.
    pub entry_points: EntryPoints,
    /// Vertex inputs.
    pub attributes: Vec<Attribute>,
    /// Varyings, split into scalars and vectors.
    pub varyings: Vec<Varying>,
    /// Fragment outputs.
    pub outputs: Vec<Output>,
    /// The block of the loose uniforms, if there are any.
    pub loose_block: Option<LooseBlock>,
    /// Uniform blocks.
    pub blocks: Vec<Block>,
    /// Uniforms, loose and in blocks.
    pub uniforms: Vec<Uniform>,
    /// Samplers, one row per element of an array.
    pub samplers: Vec<Sampler>,
    /// The conventions of the emitted code.
    pub conventions: ReflectedConventions,
    /// The names and versions of the targets.
    #[serde(default)]
    pub targets: Targets,
    /// Arrays of structs, each once.
    #[serde(default)]
    pub struct_arrays: Vec<StructArray>,
    /// The files of each stage, by its name; empty if the program does not come from files.
    #[serde(default)]
    pub files: BTreeMap<String, StageFiles>,
    /// The program that wrote it: `glisten 0.1.0`.
    #[serde(default)]
    pub generator: String,
}

/// The files of a stage, without folders.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StageFiles {
    /// The sources.
    pub sources: Vec<String>,
    /// The emitted files, by the word of the target: `wgsl`, `spirv`, `msl`, `hlsl`, `glsl`.
    pub outputs: BTreeMap<String, String>,
}

/// An array of more structs than this has no rows in [`Reflection::uniforms`] after [`Reflection::compact`].
pub const MOST_STRUCTS: u32 = 64;

impl Reflection {
    /// Drops the rows of elements of arrays of more than [`MOST_STRUCTS`] structs: [`Reflection::struct_arrays`] has
    /// them once.
    pub fn compact(&mut self) {
        let large = self.struct_arrays.iter().filter(|array| array.array_size > MOST_STRUCTS);
        let large: Vec<String> = large.map(|array| format!("{}[", array.name)).collect();
        self.uniforms.retain(|row| !large.iter().any(|prefix| row.name.starts_with(prefix)));
    }
}

impl StructArray {
    /// Whether its elements have no rows of their own.
    fn is_compact(&self, reflection: &Reflection) -> bool {
        let prefix = format!("{}[", self.name);
        !reflection.uniforms.iter().any(|row| row.name.starts_with(&prefix))
    }
}

/// The names of the entry points.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct EntryPoints {
    /// The entry point of the vertex stage.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub vertex: Option<String>,
    /// The entry point of the geometry stage, which no target has.
    #[serde(skip_serializing_if = "Option::is_none", default)]
    pub geometry: Option<String>,
    /// The entry point of the fragment stage.
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
    /// The number of locations: a matrix takes one per column, an array one per element (or per column of each).
    pub columns: u32,
    /// Whether the vertex stage reads it.
    pub active: bool,
    /// The format of one location, in WebGPU's terms: `float32x4`.
    #[serde(default)]
    pub format: String,
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
    /// `sample`: the fragment stage runs for each sample (GLSL 4.00 §4.3.4). Absent if not.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub sample: bool,
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
    /// The first color number; an array takes one per element.
    pub location: u32,
    /// 1 for the second source of dual-source blending, otherwise 0.
    pub index: u32,
}

/// A bind group and a binding in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Binding {
    /// The group.
    pub group: u32,
    /// The binding; in each group, bindings count from 0 without gaps.
    pub binding: u32,
}

impl From<SlotBinding> for Binding {
    fn from(slot: SlotBinding) -> Self {
        Self { group: slot.group, binding: slot.binding }
    }
}

/// The uniform buffer of the loose uniforms.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LooseBlock {
    /// The group.
    pub group: u32,
    /// The binding.
    pub binding: u32,
    /// The size in bytes, a multiple of 16.
    pub size: u32,
    /// The stages that see it.
    #[serde(default)]
    pub visibility: Visibility,
    /// Its variable in WGSL, if that was emitted.
    #[serde(default)]
    pub wgsl: Option<WgslVariable>,
    /// Its index in MSL.
    #[serde(default)]
    pub msl: MslBuffer,
    /// Its register in HLSL.
    #[serde(default)]
    pub hlsl: HlslBuffer,
}

/// A uniform block.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Block {
    /// The block's name.
    pub name: String,
    /// The instance name.
    pub instance: Option<String>,
    /// The size of an array of blocks; its elements have consecutive bindings.
    pub array_size: Option<u32>,
    /// The group.
    pub group: u32,
    /// The binding of the (first) block.
    pub binding: u32,
    /// The size of one element in bytes, a multiple of 16.
    pub size: u32,
    /// `layout(binding = n)` in the source.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
    /// The stages that see it.
    #[serde(default)]
    pub visibility: Visibility,
    /// The variable of the (first) block in WGSL, if that was emitted.
    #[serde(default)]
    pub wgsl: Option<WgslVariable>,
    /// The index of the (first) block in MSL.
    #[serde(default)]
    pub msl: MslBuffer,
    /// The register of the (first) block in HLSL.
    #[serde(default)]
    pub hlsl: HlslBuffer,
}

/// A scalar, vector, matrix, or array of those.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Uniform {
    /// The path that hosts use: `light[1].position`, `Block.member`, `Block[1].member`.
    pub name: String,
    /// The GLSL type of one element.
    #[serde(rename = "type")]
    pub ty: String,
    /// The number of elements, if it is an array.
    pub array_size: Option<u32>,
    /// The block's name; none for a loose uniform.
    pub block: Option<String>,
    /// The group of the buffer.
    pub group: u32,
    /// The binding of the buffer.
    pub binding: u32,
    /// The offset in bytes from the start of the buffer.
    pub offset: u32,
    /// The stride in bytes between elements.
    pub array_stride: Option<u32>,
    /// The stride in bytes between columns; in `row_major`, between rows.
    pub matrix_stride: Option<u32>,
    /// Whether a matrix is stored by rows.
    pub row_major: bool,
    /// The numbers or booleans of the initializer, elements in order, matrices by columns. A number that JSON cannot
    /// represent is null.
    pub default: Option<Vec<serde_json::Value>>,
    /// Whether a stage reads it.
    pub active: bool,
    /// The number of bytes from the first to the last, with the padding of an array's last element.
    #[serde(default)]
    pub size: u32,
    /// The type of its memory in WGSL.
    #[serde(default)]
    pub wgsl_type: String,
}

/// A texture and its sampler.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Sampler {
    /// The path that hosts use: `tex`, `tex[1]`, `material.albedo`.
    pub name: String,
    /// The GLSL type.
    #[serde(rename = "type")]
    pub ty: String,
    /// The size of the array that it belongs to, if it is an element.
    pub array_size: Option<u32>,
    /// The binding of the texture.
    pub texture: Binding,
    /// The binding of the sampler; the same as `texture` where the kind has none (integer, buffer, multisample).
    pub sampler: Binding,
    /// The view dimension, in WebGPU's terms: `2d`, `2d-array`, `3d`, `cube`.
    #[serde(default)]
    pub view_dimension: String,
    /// The sample type, in WebGPU's terms: `float`, `unfilterable-float`, `depth`, `sint`, `uint`.
    #[serde(default)]
    pub sample_type: String,
    /// Whether the texture is multisampled.
    #[serde(default)]
    pub multisampled: bool,
    /// The sampler type, in WebGPU's terms: `filtering`, `comparison`; none if there is no sampler.
    #[serde(default)]
    pub sampler_type: Option<String>,
    /// The number of texels in a row of the 2D texture that emulates a buffer texture; none for other kinds.
    #[serde(default)]
    pub row_width: Option<u32>,
    /// Where the host writes the number of texels of a buffer texture, an `int`; none if the program does not query
    /// it.
    #[serde(default)]
    pub texel_count: Option<HiddenSlot>,
    /// `layout(binding = n)` in the source: the texture unit.
    pub unit: Option<u32>,
    /// Whether a stage reads it.
    pub active: bool,
    /// The stages that see it.
    #[serde(default)]
    pub visibility: Visibility,
    /// Its variables in WGSL, if that was emitted.
    #[serde(default)]
    pub wgsl: Option<WgslTexture>,
    /// The indices in MSL.
    #[serde(default)]
    pub msl: MslTexture,
    /// The registers in HLSL.
    #[serde(default)]
    pub hlsl: HlslTexture,
}

/// The conventions of the emitted code.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ReflectedConventions {
    /// `zero-to-one`, `minus-one-to-one`
    pub clip_z: String,
    /// `upper-left`, `lower-left`
    pub window_origin: String,
    /// `as-declared`, or `inverted` if the vertex stage flips y.
    pub front_face: String,
    /// Where the host writes the framebuffer's height in pixels, a `float`; none if the program does not need it.
    pub framebuffer_height: Option<HiddenSlot>,
    /// `first`: WGSL and Vulkan take the value of a `flat` varying from the first vertex, OpenGL from the last, so
    /// the host must rotate its indices.
    pub provoking_vertex: String,
    /// `webgpu`, `vulkan`
    pub spirv_env: String,
    /// How many clip distances have an effect.
    pub clip_distances: u32,
    /// Whether the program sets the point size.
    pub point_size: bool,
    /// How points are drawn in WGSL and HLSL, if they are drawn as quads.
    #[serde(default)]
    pub point_sprites: Option<PointSprites>,
}

/// Four bytes in the block of the loose uniforms that are not a uniform of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct HiddenSlot {
    /// The group.
    pub group: u32,
    /// The binding.
    pub binding: u32,
    /// The offset in bytes from the start of the block.
    pub offset: u32,
}

/// The reflection of a program emitted under these conventions.
pub fn reflect(program: &Program, conventions: &Conventions) -> Reflection {
    let Program { types, interface, .. } = program;
    let places = Places::new(program, conventions);
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
                format: wgsl::vertex_format(types, row.ty),
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
                centroid: row.sampling == Sampling::Centroid,
                sample: row.sampling == Sampling::Sample,
                active: row.active,
            })
            .collect(),
        outputs: interface
            .outputs
            .iter()
            .map(|row| Output { name: row.name.clone(), ty: name(row.ty), location: row.location, index: row.index })
            .collect(),
        loose_block: interface.loose.map(|(slot, size)| loose_block(&places, slot, size)),
        blocks: interface.blocks.iter().map(|row| block(&places, interface, row)).collect(),
        uniforms: interface.uniforms.iter().map(|leaf| uniform(types, interface, leaf)).collect(),
        samplers: interface.samplers.iter().map(|slot| sampler(&places, types, interface, slot)).collect(),
        conventions: reflected_conventions(&places, program, conventions),
        targets: places.targets(),
        struct_arrays: arrays::arrays(program),
        files: BTreeMap::new(),
        generator: concat!("glisten ", env!("CARGO_PKG_VERSION")).to_owned(),
    }
}

impl Reflection {
    /// Names the entry points as [`emit_single_file`](crate::emit_single_file) does: `vs_main`, `fs_main`.
    pub fn name_single_file(&mut self) {
        for points in [&mut self.entry_points, &mut self.targets.msl.entry_points] {
            for (name, stage) in [(&mut points.vertex, Stage::Vertex), (&mut points.fragment, Stage::Fragment)] {
                if let Some(name) = name {
                    *name = entry_point(stage).to_owned();
                }
            }
        }
    }
}

fn entry_points(program: &Program) -> EntryPoints {
    let of = |stage| program.stage(stage).filter(|shader| shader.main.is_some()).map(|_| "main".to_owned());
    EntryPoints { vertex: of(Stage::Vertex), geometry: of(Stage::Geometry), fragment: of(Stage::Fragment) }
}

fn loose_block(places: &Places<'_>, slot: SlotBinding, size: u32) -> LooseBlock {
    let (msl, hlsl) = places.buffer(slot);
    LooseBlock {
        group: slot.group,
        binding: slot.binding,
        size,
        visibility: places.loose_visibility(),
        wgsl: None,
        msl,
        hlsl,
    }
}

fn block(places: &Places<'_>, interface: &Interface, row: &glisten_front::link::Block) -> Block {
    let (msl, hlsl) = places.buffer(row.slot);
    let root = interface.roots.get(row.root.0 as usize);
    Block {
        name: row.name.clone(),
        instance: row.instance.clone(),
        array_size: row.array_size,
        group: row.slot.group,
        binding: row.slot.binding,
        size: row.size,
        unit: row.unit,
        active: row.active,
        visibility: root.map_or_else(Vec::new, |root| places.visibility(&root.globals)),
        wgsl: None,
        msl,
        hlsl,
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
        size: arrays::size_of(types, leaf),
        wgsl_type: wgsl::memory_type(types, leaf),
    }
}

/// A part of a value in flat layout, as JSON.
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

fn sampler(places: &Places<'_>, types: &Types, interface: &Interface, row: &SamplerSlot) -> Sampler {
    let shape = match types.get(row.ty) {
        Type::Sampler(ty) => crate::target::Shape::of(ty),
        _ => crate::target::Shape::default(),
    };
    let (msl, hlsl) = places.texture(row.texture, row.sampler);
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
        visibility: places.visibility(&row.globals),
        wgsl: None,
        msl,
        hlsl,
    }
}

fn hidden(interface: &Interface, offset: u32) -> Option<HiddenSlot> {
    interface.loose.map(|(slot, _)| HiddenSlot { group: slot.group, binding: slot.binding, offset })
}

fn reflected_conventions(places: &Places<'_>, program: &Program, conventions: &Conventions) -> ReflectedConventions {
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
        point_sprites: places.point_sprites(),
    }
}

/// The output of the vertex stage that is this built-in variable, if the stage writes it.
fn writes(program: &Program, builtin: BuiltinVariable) -> Option<&glisten_front::hir::Global> {
    let globals = &program.stage(Stage::Vertex)?.globals;
    globals.iter().find(|global| global.builtin == Some(builtin) && global.storage == Storage::Out && global.written)
}

/// How many clip distances have an effect: those that are written, up to the number that the conventions enable.
fn clip_distances(program: &Program, conventions: &Conventions) -> u32 {
    let Some(global) = writes(program, BuiltinVariable::ClipDistance) else { return 0 };
    let declared = match program.types.get(global.ty) {
        Type::Array(..) => program.types.flat_len(global.ty),
        _ => 0,
    };
    conventions.clip_distances.map_or(declared, |enabled| enabled.min(declared))
}
