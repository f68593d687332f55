//! Functions that ask for texels and levels without filtering: gathers (GLSL 4.00 §8.9.3), the level of detail (GLSL 4.00
//! §8.9.1) and the number of levels (GLSL 4.30 §8.9.1), with the extensions that bring them to older versions.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::builtin::Stages;
use crate::language::{Extensions, NEVER, Since};

const SHADER5: Extensions = Extensions::GPU_SHADER5;
const GATHERS: Extensions = Extensions::TEXTURE_GATHER.union(SHADER5);

const fn from(section: &'static str, desktop: u16, es: u16, extensions: Extensions) -> Row {
    let availability = Availability::from(Since::new(desktop, es)).or(extensions);
    Row::base(section, desktop).with(Effect::Texture, false).available(availability)
}

const GATHER: Row = from("GLSL 4.00 §8.9.3", 400, 310, GATHERS);
const GATHER5: Row = from("GLSL 4.00 §8.9.3", 400, 310, SHADER5);
const OFFSETS: Row = from("GLSL 4.00 §8.9.3", 400, 320, SHADER5);
const RECT: Row = from("GLSL 4.00 §8.9.3", 400, NEVER, SHADER5);
const LOD: Row = {
    let row = from("GLSL 4.00 §8.9.1", 400, NEVER, Extensions::TEXTURE_QUERY_LOD);
    Row { availability: row.availability.stages(Stages::FRAGMENT), ..row }
};
const OLDLOD: Row = {
    let row = from("ARB_texture_query_lod", 110, NEVER, Extensions::empty());
    let availability = Availability::extension(Extensions::TEXTURE_QUERY_LOD).stages(Stages::FRAGMENT);
    Row { deprecated: true, availability, ..row }
};
const LEVELS: Row = from("GLSL 4.30 §8.9.1", 430, NEVER, Extensions::TEXTURE_QUERY_LEVELS);

pub(super) static ROWS: &[Row] = rows! {
    GATHER TextureGather: gvec4 textureGather(gsampler2D sampler, vec2 P);
    GATHER5 TextureGather: gvec4 textureGather(gsampler2D sampler, vec2 P, int comp);
    GATHER TextureGather: gvec4 textureGather(gsampler2DArray sampler, vec3 P);
    GATHER5 TextureGather: gvec4 textureGather(gsampler2DArray sampler, vec3 P, int comp);
    GATHER TextureGather: gvec4 textureGather(gsamplerCube sampler, vec3 P);
    GATHER5 TextureGather: gvec4 textureGather(gsamplerCube sampler, vec3 P, int comp);
    RECT TextureGather: gvec4 textureGather(gsampler2DRect sampler, vec2 P);
    RECT TextureGather: gvec4 textureGather(gsampler2DRect sampler, vec2 P, int comp);
    GATHER5 TextureGather: vec4 textureGather(sampler2DShadow sampler, vec2 P, float refZ);
    GATHER5 TextureGather: vec4 textureGather(sampler2DArrayShadow sampler, vec3 P, float refZ);
    GATHER5 TextureGather: vec4 textureGather(samplerCubeShadow sampler, vec3 P, float refZ);
    RECT TextureGather: vec4 textureGather(sampler2DRectShadow sampler, vec2 P, float refZ);
    GATHER TextureGatherOffset: gvec4 textureGatherOffset(gsampler2D sampler, vec2 P, ivec2 offset);
    GATHER5 TextureGatherOffset: gvec4 textureGatherOffset(gsampler2D sampler, vec2 P, ivec2 offset, int comp);
    GATHER TextureGatherOffset: gvec4 textureGatherOffset(gsampler2DArray sampler, vec3 P, ivec2 offset);
    GATHER5 TextureGatherOffset: gvec4 textureGatherOffset(gsampler2DArray sampler, vec3 P, ivec2 offset, int comp);
    RECT TextureGatherOffset: gvec4 textureGatherOffset(gsampler2DRect sampler, vec2 P, ivec2 offset);
    RECT TextureGatherOffset: gvec4 textureGatherOffset(gsampler2DRect sampler, vec2 P, ivec2 offset, int comp);
    GATHER5 TextureGatherOffset: vec4 textureGatherOffset(sampler2DShadow sampler, vec2 P, float refZ, ivec2 offset);
    GATHER5 TextureGatherOffset: vec4 textureGatherOffset(sampler2DArrayShadow sampler, vec3 P, float refZ, ivec2 offset);
    RECT TextureGatherOffset: vec4 textureGatherOffset(sampler2DRectShadow sampler, vec2 P, float refZ, ivec2 offset);

    OFFSETS TextureGatherOffsets: gvec4 textureGatherOffsets(gsampler2D sampler, vec2 P, four_ivec2 offsets);
    OFFSETS TextureGatherOffsets: gvec4 textureGatherOffsets(gsampler2D sampler, vec2 P, four_ivec2 offsets, int comp);
    OFFSETS TextureGatherOffsets: gvec4 textureGatherOffsets(gsampler2DArray sampler, vec3 P, four_ivec2 offsets);
    OFFSETS TextureGatherOffsets: gvec4 textureGatherOffsets(gsampler2DArray sampler, vec3 P, four_ivec2 offsets, int comp);
    RECT TextureGatherOffsets: gvec4 textureGatherOffsets(gsampler2DRect sampler, vec2 P, four_ivec2 offsets);
    RECT TextureGatherOffsets: gvec4 textureGatherOffsets(gsampler2DRect sampler, vec2 P, four_ivec2 offsets, int comp);
    OFFSETS TextureGatherOffsets: vec4 textureGatherOffsets(sampler2DShadow sampler, vec2 P, float refZ, four_ivec2 offsets);
    OFFSETS TextureGatherOffsets: vec4 textureGatherOffsets(sampler2DArrayShadow sampler, vec3 P, float refZ, four_ivec2 offsets);
    RECT TextureGatherOffsets: vec4 textureGatherOffsets(sampler2DRectShadow sampler, vec2 P, float refZ, four_ivec2 offsets);

    LOD TextureQueryLod: vec2 textureQueryLod(gsampler1D sampler, float P);
    LOD TextureQueryLod: vec2 textureQueryLod(gsampler2D sampler, vec2 P);
    LOD TextureQueryLod: vec2 textureQueryLod(gsampler3D sampler, vec3 P);
    LOD TextureQueryLod: vec2 textureQueryLod(gsamplerCube sampler, vec3 P);
    LOD TextureQueryLod: vec2 textureQueryLod(gsampler1DArray sampler, float P);
    LOD TextureQueryLod: vec2 textureQueryLod(gsampler2DArray sampler, vec2 P);
    LOD TextureQueryLod: vec2 textureQueryLod(sampler1DShadow sampler, float P);
    LOD TextureQueryLod: vec2 textureQueryLod(sampler2DShadow sampler, vec2 P);
    LOD TextureQueryLod: vec2 textureQueryLod(samplerCubeShadow sampler, vec3 P);
    LOD TextureQueryLod: vec2 textureQueryLod(sampler1DArrayShadow sampler, float P);
    LOD TextureQueryLod: vec2 textureQueryLod(sampler2DArrayShadow sampler, vec2 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(gsampler1D sampler, float P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(gsampler2D sampler, vec2 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(gsampler3D sampler, vec3 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(gsamplerCube sampler, vec3 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(gsampler1DArray sampler, float P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(gsampler2DArray sampler, vec2 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(sampler1DShadow sampler, float P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(sampler2DShadow sampler, vec2 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(samplerCubeShadow sampler, vec3 P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(sampler1DArrayShadow sampler, float P);
    OLDLOD TextureQueryLod: vec2 textureQueryLOD(sampler2DArrayShadow sampler, vec2 P);

    LEVELS TextureQueryLevels: int textureQueryLevels(gsampler1D sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(gsampler2D sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(gsampler3D sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(gsamplerCube sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(gsampler1DArray sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(gsampler2DArray sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(sampler1DShadow sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(sampler2DShadow sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(samplerCubeShadow sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(sampler1DArrayShadow sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(sampler2DArrayShadow sampler);
};
