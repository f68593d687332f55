//! Texture functions of arrays of cube maps (GLSL 4.00 §8.9, ARB_texture_cube_map_array).
//!
//! *Holds:* the layer is the fourth component of `P`, so that the reference of a comparison is a parameter of its own.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::builtin::Stages;
use crate::language::{Extensions, NEVER, Since};

const ARRAYS: Extensions = Extensions::TEXTURE_CUBE_MAP_ARRAY;

const fn from(section: &'static str, desktop: u16) -> Row {
    let es = if desktop == 400 { 320 } else { NEVER };
    let availability = Availability::from(Since::new(desktop, es)).or(ARRAYS);
    Row::base(section, desktop).with(Effect::Texture, false).available(availability)
}

const CUBES: Row = from("GLSL 4.00 §8.9.2", 400);
const SIZE: Row = from("GLSL 4.00 §8.9.1", 400);
const GATHER: Row = from("GLSL 4.00 §8.9.3", 400);
const LOD: Row = Row { availability: SIZE.availability.es(NEVER).stages(Stages::FRAGMENT), ..SIZE };
const LEVELS: Row = {
    let availability = Availability::from(Since::new(430, NEVER)).or(Extensions::TEXTURE_QUERY_LEVELS);
    Row { section: "GLSL 4.30 §8.9.1", ..SIZE }.available(availability)
};

pub(super) static ROWS: &[Row] = rows! {
    SIZE TextureSize: ivec3 textureSize(gsamplerCubeArray sampler, int lod);
    SIZE TextureSize: ivec3 textureSize(samplerCubeArrayShadow sampler, int lod);
    CUBES Texture: gvec4 texture(gsamplerCubeArray sampler, vec4 P, optional bias);
    CUBES Texture: float texture(samplerCubeArrayShadow sampler, vec4 P, float compare);
    CUBES TextureLod: gvec4 textureLod(gsamplerCubeArray sampler, vec4 P, float lod);
    CUBES TextureGrad: gvec4 textureGrad(gsamplerCubeArray sampler, vec4 P, vec3 dPdx, vec3 dPdy);
    GATHER TextureGather: gvec4 textureGather(gsamplerCubeArray sampler, vec4 P);
    GATHER TextureGather: gvec4 textureGather(gsamplerCubeArray sampler, vec4 P, int comp);
    GATHER TextureGather: vec4 textureGather(samplerCubeArrayShadow sampler, vec4 P, float refZ);
    LOD TextureQueryLod: vec2 textureQueryLod(gsamplerCubeArray sampler, vec3 P);
    LOD TextureQueryLod: vec2 textureQueryLod(samplerCubeArrayShadow sampler, vec3 P);
    LEVELS TextureQueryLevels: int textureQueryLevels(gsamplerCubeArray sampler);
    LEVELS TextureQueryLevels: int textureQueryLevels(samplerCubeArrayShadow sampler);
};
