//! Names of texture lookup functions that extensions of 1.10 to 1.30 and of ES 1.00 add: EXT_gpu_shader4,
//! EXT_texture_array, ARB_shader_texture_lod, EXT_shader_texture_lod.
//!
//! They share the identities of the functions that 1.30 has in their place.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::language::Extensions;

const fn from(section: &'static str, extensions: Extensions) -> Row {
    Row { deprecated: true, ..Row::base(section, 110) }
        .with(Effect::Texture, false)
        .available(Availability::extension(extensions))
}

const SHADER4: Row = from("EXT_gpu_shader4", Extensions::GPU_SHADER4);
const ARRAY: Row = from("EXT_texture_array", Extensions::TEXTURE_ARRAY.union(Extensions::GPU_SHADER4));
const LOD: Row = from("ARB_shader_texture_lod", Extensions::SHADER_TEXTURE_LOD);
const EXTLOD: Row = from("EXT_shader_texture_lod", Extensions::SHADER_TEXTURE_LOD);

pub(super) static ROWS: &[Row] = rows! {
    ARRAY Texture: gvec4 texture1DArray(gsampler1DArray sampler, vec2 coord, optional bias);
    ARRAY Texture: gvec4 texture2DArray(gsampler2DArray sampler, vec3 coord, optional bias);
    ARRAY TextureLod: gvec4 texture1DArrayLod(gsampler1DArray sampler, vec2 coord, float lod);
    ARRAY TextureLod: gvec4 texture2DArrayLod(gsampler2DArray sampler, vec3 coord, float lod);
    ARRAY Texture: vec4 shadow1DArray(sampler1DArrayShadow sampler, vec3 coord, optional bias);
    ARRAY Texture: vec4 shadow2DArray(sampler2DArrayShadow sampler, vec4 coord);
    ARRAY TextureLod: vec4 shadow1DArrayLod(sampler1DArrayShadow sampler, vec3 coord, float lod);
    SHADER4 Texture: vec4 shadowCube(samplerCubeShadow sampler, vec4 coord, optional bias);

    SHADER4 TexelFetch: gvec4 texelFetch1D(gsampler1D sampler, int coord, int lod);
    SHADER4 TexelFetch: gvec4 texelFetch2D(gsampler2D sampler, ivec2 coord, int lod);
    SHADER4 TexelFetch: gvec4 texelFetch3D(gsampler3D sampler, ivec3 coord, int lod);
    SHADER4 TexelFetch: gvec4 texelFetch2DRect(gsampler2DRect sampler, ivec2 coord);
    SHADER4 TexelFetch: gvec4 texelFetch1DArray(gsampler1DArray sampler, ivec2 coord, int lod);
    SHADER4 TexelFetch: gvec4 texelFetch2DArray(gsampler2DArray sampler, ivec3 coord, int lod);
    SHADER4 TexelFetch: gvec4 texelFetchBuffer(gsamplerBuffer sampler, int coord);
    SHADER4 TextureSize: int textureSize1D(gsampler1D sampler, int lod);
    SHADER4 TextureSize: ivec2 textureSize2D(gsampler2D sampler, int lod);
    SHADER4 TextureSize: ivec3 textureSize3D(gsampler3D sampler, int lod);
    SHADER4 TextureSize: ivec2 textureSizeCube(gsamplerCube sampler, int lod);
    SHADER4 TextureSize: ivec2 textureSize1DArray(gsampler1DArray sampler, int lod);
    SHADER4 TextureSize: ivec3 textureSize2DArray(gsampler2DArray sampler, int lod);
    SHADER4 TextureSize: int textureSizeBuffer(gsamplerBuffer sampler);
    SHADER4 TextureGrad: gvec4 texture1DGrad(gsampler1D sampler, float coord, float ddx, float ddy);
    SHADER4 TextureGrad: gvec4 texture2DGrad(gsampler2D sampler, vec2 coord, vec2 ddx, vec2 ddy);
    SHADER4 TextureProjGrad: gvec4 texture2DProjGrad(gsampler2D sampler, vec3 coord, vec2 ddx, vec2 ddy);
    SHADER4 TextureProjGrad: gvec4 texture2DProjGrad(gsampler2D sampler, vec4 coord, vec2 ddx, vec2 ddy);
    SHADER4 TextureGrad: gvec4 texture3DGrad(gsampler3D sampler, vec3 coord, vec3 ddx, vec3 ddy);
    SHADER4 TextureGrad: gvec4 textureCubeGrad(gsamplerCube sampler, vec3 coord, vec3 ddx, vec3 ddy);
    SHADER4 TextureGrad: gvec4 texture1DArrayGrad(gsampler1DArray sampler, vec2 coord, float ddx, float ddy);
    SHADER4 TextureGrad: gvec4 texture2DArrayGrad(gsampler2DArray sampler, vec3 coord, vec2 ddx, vec2 ddy);
    SHADER4 TextureOffset: gvec4 texture1DOffset(gsampler1D sampler, float coord, int offset, optional bias);
    SHADER4 TextureOffset: gvec4 texture2DOffset(gsampler2D sampler, vec2 coord, ivec2 offset, optional bias);
    SHADER4 TextureOffset: gvec4 texture3DOffset(gsampler3D sampler, vec3 coord, ivec3 offset, optional bias);
    SHADER4 TextureProjOffset: gvec4 texture2DProjOffset(gsampler2D sampler, vec3 coord, ivec2 offset, optional bias);
    SHADER4 TextureProjOffset: gvec4 texture2DProjOffset(gsampler2D sampler, vec4 coord, ivec2 offset, optional bias);
    SHADER4 TextureLodOffset: gvec4 texture2DLodOffset(gsampler2D sampler, vec2 coord, float lod, ivec2 offset);
    SHADER4 TextureOffset: gvec4 texture2DArrayOffset(gsampler2DArray sampler, vec3 coord, ivec2 offset, optional bias);
    SHADER4 TexelFetchOffset: gvec4 texelFetch2DOffset(gsampler2D sampler, ivec2 coord, int lod, ivec2 offset);

    LOD TextureGrad: vec4 texture1DGradARB(sampler1D sampler, float P, float dPdx, float dPdy);
    LOD TextureProjGrad: vec4 texture1DProjGradARB(sampler1D sampler, vec2 P, float dPdx, float dPdy);
    LOD TextureProjGrad: vec4 texture1DProjGradARB(sampler1D sampler, vec4 P, float dPdx, float dPdy);
    LOD TextureGrad: vec4 texture2DGradARB(sampler2D sampler, vec2 P, vec2 dPdx, vec2 dPdy);
    LOD TextureProjGrad: vec4 texture2DProjGradARB(sampler2D sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    LOD TextureProjGrad: vec4 texture2DProjGradARB(sampler2D sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    LOD TextureGrad: vec4 texture3DGradARB(sampler3D sampler, vec3 P, vec3 dPdx, vec3 dPdy);
    LOD TextureProjGrad: vec4 texture3DProjGradARB(sampler3D sampler, vec4 P, vec3 dPdx, vec3 dPdy);
    LOD TextureGrad: vec4 textureCubeGradARB(samplerCube sampler, vec3 P, vec3 dPdx, vec3 dPdy);
    LOD TextureGrad: vec4 shadow1DGradARB(sampler1DShadow sampler, vec3 P, float dPdx, float dPdy);
    LOD TextureProjGrad: vec4 shadow1DProjGradARB(sampler1DShadow sampler, vec4 P, float dPdx, float dPdy);
    LOD TextureGrad: vec4 shadow2DGradARB(sampler2DShadow sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    LOD TextureProjGrad: vec4 shadow2DProjGradARB(sampler2DShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    LOD TextureGrad: vec4 texture2DRectGradARB(sampler2DRect sampler, vec2 P, vec2 dPdx, vec2 dPdy);
    LOD TextureProjGrad: vec4 texture2DRectProjGradARB(sampler2DRect sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    LOD TextureProjGrad: vec4 texture2DRectProjGradARB(sampler2DRect sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    LOD TextureGrad: vec4 shadow2DRectGradARB(sampler2DRectShadow sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    LOD TextureProjGrad: vec4 shadow2DRectProjGradARB(sampler2DRectShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy);

    EXTLOD TextureLod: vec4 texture2DLodEXT(sampler2D sampler, vec2 coord, float lod);
    EXTLOD TextureProjLod: vec4 texture2DProjLodEXT(sampler2D sampler, vec3 coord, float lod);
    EXTLOD TextureProjLod: vec4 texture2DProjLodEXT(sampler2D sampler, vec4 coord, float lod);
    EXTLOD TextureLod: vec4 textureCubeLodEXT(samplerCube sampler, vec3 coord, float lod);
    EXTLOD TextureGrad: vec4 texture2DGradEXT(sampler2D sampler, vec2 P, vec2 dPdx, vec2 dPdy);
    EXTLOD TextureProjGrad: vec4 texture2DProjGradEXT(sampler2D sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    EXTLOD TextureProjGrad: vec4 texture2DProjGradEXT(sampler2D sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    EXTLOD TextureGrad: vec4 textureCubeGradEXT(samplerCube sampler, vec3 P, vec3 dPdx, vec3 dPdy);
};
