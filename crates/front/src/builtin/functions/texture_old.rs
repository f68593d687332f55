//! Deprecated names of texture lookup functions (end of GLSL 1.50 §8.7, and ARB_texture_rectangle).
//!
//! They share the identities of the functions that replace them. The `shadow` names return a `vec4` where their
//! successors return the `float` d: (d, 0, 0, 1), since the core profile has no DEPTH_TEXTURE_MODE to change that.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::builtin::Stages;
use crate::language::{Extensions, NEVER, Since};

/// The core of 4.20 and ES 3.00 lack these names.
const GONE: Since = Since::new(420, 300);
const OLD: Row = Row { deprecated: true, ..Row::base("§8.7", 110).with(Effect::Texture, false) }
    .available(Availability::since(110).until(GONE));
/// Explicit levels: before 1.30 only in vertex shaders, unless ARB_shader_texture_lod allows them.
const LOD: Row = OLD.available(Availability::since(110).until(GONE).stages(Stages::VERTEX));
const LODF: Row = Row { section: "ARB_shader_texture_lod", ..OLD }.available(
    Availability::from(Since::new(130, NEVER))
        .until(GONE)
        .or(Extensions::SHADER_TEXTURE_LOD.union(Extensions::GPU_SHADER4))
        .stages(Stages::FRAGMENT.union(Stages::GEOMETRY)),
);
/// Samplers of integers, by EXT_gpu_shader4.
const INTEGER: Row =
    Row { section: "EXT_gpu_shader4", ..OLD }.available(Availability::extension(Extensions::GPU_SHADER4));
const RECT: Row = Row { deprecated: true, section: "ARB_texture_rectangle", ..Row::base("", 110) }
    .with(Effect::Texture, false)
    // Reserved words in the text of 1.10; drivers have them without the extension's line.
    .available(Availability::from(Since::new(110, NEVER)).until(GONE).or(Extensions::TEXTURE_RECTANGLE));

pub(super) static ROWS: &[Row] = rows! {
    OLD Texture: vec4 texture1D(sampler1D sampler, float coord, optional bias);
    OLD TextureProj: vec4 texture1DProj(sampler1D sampler, vec2 coord, optional bias);
    OLD TextureProj: vec4 texture1DProj(sampler1D sampler, vec4 coord, optional bias);
    LOD TextureLod: vec4 texture1DLod(sampler1D sampler, float coord, float lod);
    LODF TextureLod: vec4 texture1DLod(sampler1D sampler, float coord, float lod);
    LOD TextureProjLod: vec4 texture1DProjLod(sampler1D sampler, vec2 coord, float lod);
    LODF TextureProjLod: vec4 texture1DProjLod(sampler1D sampler, vec2 coord, float lod);
    LOD TextureProjLod: vec4 texture1DProjLod(sampler1D sampler, vec4 coord, float lod);
    LODF TextureProjLod: vec4 texture1DProjLod(sampler1D sampler, vec4 coord, float lod);
    OLD Texture: vec4 texture2D(sampler2D sampler, vec2 coord, optional bias);
    OLD TextureProj: vec4 texture2DProj(sampler2D sampler, vec3 coord, optional bias);
    OLD TextureProj: vec4 texture2DProj(sampler2D sampler, vec4 coord, optional bias);
    LOD TextureLod: vec4 texture2DLod(sampler2D sampler, vec2 coord, float lod);
    LODF TextureLod: vec4 texture2DLod(sampler2D sampler, vec2 coord, float lod);
    LOD TextureProjLod: vec4 texture2DProjLod(sampler2D sampler, vec3 coord, float lod);
    LODF TextureProjLod: vec4 texture2DProjLod(sampler2D sampler, vec3 coord, float lod);
    LOD TextureProjLod: vec4 texture2DProjLod(sampler2D sampler, vec4 coord, float lod);
    LODF TextureProjLod: vec4 texture2DProjLod(sampler2D sampler, vec4 coord, float lod);
    OLD Texture: vec4 texture3D(sampler3D sampler, vec3 coord, optional bias);
    OLD TextureProj: vec4 texture3DProj(sampler3D sampler, vec4 coord, optional bias);
    LOD TextureLod: vec4 texture3DLod(sampler3D sampler, vec3 coord, float lod);
    LODF TextureLod: vec4 texture3DLod(sampler3D sampler, vec3 coord, float lod);
    LOD TextureProjLod: vec4 texture3DProjLod(sampler3D sampler, vec4 coord, float lod);
    LODF TextureProjLod: vec4 texture3DProjLod(sampler3D sampler, vec4 coord, float lod);
    OLD Texture: vec4 textureCube(samplerCube sampler, vec3 coord, optional bias);
    LOD TextureLod: vec4 textureCubeLod(samplerCube sampler, vec3 coord, float lod);
    LODF TextureLod: vec4 textureCubeLod(samplerCube sampler, vec3 coord, float lod);
    OLD Texture: vec4 shadow1D(sampler1DShadow sampler, vec3 coord, optional bias);
    OLD Texture: vec4 shadow2D(sampler2DShadow sampler, vec3 coord, optional bias);
    OLD TextureProj: vec4 shadow1DProj(sampler1DShadow sampler, vec4 coord, optional bias);
    OLD TextureProj: vec4 shadow2DProj(sampler2DShadow sampler, vec4 coord, optional bias);
    LOD TextureLod: vec4 shadow1DLod(sampler1DShadow sampler, vec3 coord, float lod);
    LODF TextureLod: vec4 shadow1DLod(sampler1DShadow sampler, vec3 coord, float lod);
    LOD TextureLod: vec4 shadow2DLod(sampler2DShadow sampler, vec3 coord, float lod);
    LODF TextureLod: vec4 shadow2DLod(sampler2DShadow sampler, vec3 coord, float lod);
    LOD TextureProjLod: vec4 shadow1DProjLod(sampler1DShadow sampler, vec4 coord, float lod);
    LODF TextureProjLod: vec4 shadow1DProjLod(sampler1DShadow sampler, vec4 coord, float lod);
    LOD TextureProjLod: vec4 shadow2DProjLod(sampler2DShadow sampler, vec4 coord, float lod);
    LODF TextureProjLod: vec4 shadow2DProjLod(sampler2DShadow sampler, vec4 coord, float lod);

    INTEGER Texture: ivec4 texture1D(isampler1D sampler, float coord, optional bias);
    INTEGER Texture: uvec4 texture1D(usampler1D sampler, float coord, optional bias);
    INTEGER Texture: ivec4 texture2D(isampler2D sampler, vec2 coord, optional bias);
    INTEGER Texture: uvec4 texture2D(usampler2D sampler, vec2 coord, optional bias);
    INTEGER Texture: ivec4 texture3D(isampler3D sampler, vec3 coord, optional bias);
    INTEGER Texture: uvec4 texture3D(usampler3D sampler, vec3 coord, optional bias);
    INTEGER Texture: ivec4 textureCube(isamplerCube sampler, vec3 coord, optional bias);
    INTEGER Texture: uvec4 textureCube(usamplerCube sampler, vec3 coord, optional bias);

    RECT Texture: vec4 texture2DRect(sampler2DRect sampler, vec2 coord);
    RECT TextureProj: vec4 texture2DRectProj(sampler2DRect sampler, vec3 coord);
    RECT TextureProj: vec4 texture2DRectProj(sampler2DRect sampler, vec4 coord);
    RECT Texture: vec4 shadow2DRect(sampler2DRectShadow sampler, vec3 coord);
    RECT TextureProj: vec4 shadow2DRectProj(sampler2DRectShadow sampler, vec4 coord);
};
