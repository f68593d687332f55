//! Texture lookup functions (GLSL 1.50 §8.7).
//!
//! Two errors of the 1.50 text are corrected as in later versions: the offsets of some `textureProjGradOffset` rows
//! are integers, and there is no `textureGradOffset` of a cube, since texel offsets do not apply to cube maps.

use super::{Availability, BuiltinFunction, Effect, Parameter, Row, matcher, rows};
use crate::language::Since;

const T130: Row = Row::base("§8.7", 130).with(Effect::Texture, false);
const T140: Row = Row::base("§8.7", 140).with(Effect::Texture, false);
const BUFFER: Row =
    Row::base("§8.7", 140).available(Availability::from(Since::new(140, 320))).with(Effect::Texture, false);
const MS: Row = Row::base("§8.7", 150).available(Availability::from(Since::new(150, 310))).with(Effect::Texture, false);
const MS_ARRAY: Row =
    Row::base("§8.7", 150).available(Availability::from(Since::new(150, 320))).with(Effect::Texture, false);
const T430: Row = Row::base("GLSL 4.30 §8.9.2", 430).with(Effect::Texture, false);

pub(super) static ROWS: &[Row] = rows! {
    T130 TextureSize: int textureSize(gsampler1D sampler, int lod);
    T130 TextureSize: ivec2 textureSize(gsampler2D sampler, int lod);
    T130 TextureSize: ivec3 textureSize(gsampler3D sampler, int lod);
    T130 TextureSize: ivec2 textureSize(gsamplerCube sampler, int lod);
    T130 TextureSize: int textureSize(sampler1DShadow sampler, int lod);
    T130 TextureSize: ivec2 textureSize(sampler2DShadow sampler, int lod);
    T130 TextureSize: ivec2 textureSize(samplerCubeShadow sampler, int lod);
    T140 TextureSize: ivec2 textureSize(gsampler2DRect sampler);
    T140 TextureSize: ivec2 textureSize(sampler2DRectShadow sampler);
    T130 TextureSize: ivec2 textureSize(gsampler1DArray sampler, int lod);
    T130 TextureSize: ivec3 textureSize(gsampler2DArray sampler, int lod);
    T130 TextureSize: ivec2 textureSize(sampler1DArrayShadow sampler, int lod);
    T130 TextureSize: ivec3 textureSize(sampler2DArrayShadow sampler, int lod);
    BUFFER TextureSize: int textureSize(gsamplerBuffer sampler);
    MS TextureSize: ivec2 textureSize(gsampler2DMS sampler);
    // 1.50 prints `ivec2` here, which contradicts its rule for arrays before the table. Later versions and all
    // drivers have `ivec3`.
    MS_ARRAY TextureSize: ivec3 textureSize(gsampler2DMSArray sampler);

    T130 Texture: gvec4 texture(gsampler1D sampler, float P, optional bias);
    T130 Texture: gvec4 texture(gsampler2D sampler, vec2 P, optional bias);
    T130 Texture: gvec4 texture(gsampler3D sampler, vec3 P, optional bias);
    T130 Texture: gvec4 texture(gsamplerCube sampler, vec3 P, optional bias);
    T130 Texture: float texture(sampler1DShadow sampler, vec3 P, optional bias);
    T130 Texture: float texture(sampler2DShadow sampler, vec3 P, optional bias);
    T130 Texture: float texture(samplerCubeShadow sampler, vec4 P, optional bias);
    T130 Texture: gvec4 texture(gsampler1DArray sampler, vec2 P, optional bias);
    T130 Texture: gvec4 texture(gsampler2DArray sampler, vec3 P, optional bias);
    T130 Texture: float texture(sampler1DArrayShadow sampler, vec3 P, optional bias);
    T130 Texture: float texture(sampler2DArrayShadow sampler, vec4 P);
    T140 Texture: gvec4 texture(gsampler2DRect sampler, vec2 P);
    T140 Texture: float texture(sampler2DRectShadow sampler, vec3 P);

    T130 TextureProj: gvec4 textureProj(gsampler1D sampler, vec2 P, optional bias);
    T130 TextureProj: gvec4 textureProj(gsampler1D sampler, vec4 P, optional bias);
    T130 TextureProj: gvec4 textureProj(gsampler2D sampler, vec3 P, optional bias);
    T130 TextureProj: gvec4 textureProj(gsampler2D sampler, vec4 P, optional bias);
    T130 TextureProj: gvec4 textureProj(gsampler3D sampler, vec4 P, optional bias);
    T130 TextureProj: float textureProj(sampler1DShadow sampler, vec4 P, optional bias);
    T130 TextureProj: float textureProj(sampler2DShadow sampler, vec4 P, optional bias);
    T140 TextureProj: gvec4 textureProj(gsampler2DRect sampler, vec3 P);
    T140 TextureProj: gvec4 textureProj(gsampler2DRect sampler, vec4 P);
    T140 TextureProj: float textureProj(sampler2DRectShadow sampler, vec4 P);

    T130 TextureLod: gvec4 textureLod(gsampler1D sampler, float P, float lod);
    T130 TextureLod: gvec4 textureLod(gsampler2D sampler, vec2 P, float lod);
    T130 TextureLod: gvec4 textureLod(gsampler3D sampler, vec3 P, float lod);
    T130 TextureLod: gvec4 textureLod(gsamplerCube sampler, vec3 P, float lod);
    T130 TextureLod: float textureLod(sampler1DShadow sampler, vec3 P, float lod);
    T130 TextureLod: float textureLod(sampler2DShadow sampler, vec3 P, float lod);
    T130 TextureLod: gvec4 textureLod(gsampler1DArray sampler, vec2 P, float lod);
    T130 TextureLod: gvec4 textureLod(gsampler2DArray sampler, vec3 P, float lod);
    T130 TextureLod: float textureLod(sampler1DArrayShadow sampler, vec3 P, float lod);

    T130 TextureOffset: gvec4 textureOffset(gsampler1D sampler, float P, int offset, optional bias);
    T130 TextureOffset: gvec4 textureOffset(gsampler2D sampler, vec2 P, ivec2 offset, optional bias);
    T130 TextureOffset: gvec4 textureOffset(gsampler3D sampler, vec3 P, ivec3 offset, optional bias);
    T140 TextureOffset: gvec4 textureOffset(gsampler2DRect sampler, vec2 P, ivec2 offset);
    T140 TextureOffset: float textureOffset(sampler2DRectShadow sampler, vec3 P, ivec2 offset);
    T130 TextureOffset: float textureOffset(sampler1DShadow sampler, vec3 P, int offset, optional bias);
    T130 TextureOffset: float textureOffset(sampler2DShadow sampler, vec3 P, ivec2 offset, optional bias);
    T130 TextureOffset: gvec4 textureOffset(gsampler1DArray sampler, vec2 P, int offset, optional bias);
    T130 TextureOffset: gvec4 textureOffset(gsampler2DArray sampler, vec3 P, ivec2 offset, optional bias);
    T130 TextureOffset: float textureOffset(sampler1DArrayShadow sampler, vec3 P, int offset, optional bias);
    T430 TextureOffset: float textureOffset(sampler2DArrayShadow sampler, vec4 P, ivec2 offset);

    T130 TexelFetch: gvec4 texelFetch(gsampler1D sampler, int P, int lod);
    T130 TexelFetch: gvec4 texelFetch(gsampler2D sampler, ivec2 P, int lod);
    T130 TexelFetch: gvec4 texelFetch(gsampler3D sampler, ivec3 P, int lod);
    T140 TexelFetch: gvec4 texelFetch(gsampler2DRect sampler, ivec2 P);
    T130 TexelFetch: gvec4 texelFetch(gsampler1DArray sampler, ivec2 P, int lod);
    T130 TexelFetch: gvec4 texelFetch(gsampler2DArray sampler, ivec3 P, int lod);
    BUFFER TexelFetch: gvec4 texelFetch(gsamplerBuffer sampler, int P);
    MS TexelFetch: gvec4 texelFetch(gsampler2DMS sampler, ivec2 P, int sample);
    MS_ARRAY TexelFetch: gvec4 texelFetch(gsampler2DMSArray sampler, ivec3 P, int sample);

    T130 TexelFetchOffset: gvec4 texelFetchOffset(gsampler1D sampler, int P, int lod, int offset);
    T130 TexelFetchOffset: gvec4 texelFetchOffset(gsampler2D sampler, ivec2 P, int lod, ivec2 offset);
    T130 TexelFetchOffset: gvec4 texelFetchOffset(gsampler3D sampler, ivec3 P, int lod, ivec3 offset);
    T140 TexelFetchOffset: gvec4 texelFetchOffset(gsampler2DRect sampler, ivec2 P, ivec2 offset);
    T130 TexelFetchOffset: gvec4 texelFetchOffset(gsampler1DArray sampler, ivec2 P, int lod, int offset);
    T130 TexelFetchOffset: gvec4 texelFetchOffset(gsampler2DArray sampler, ivec3 P, int lod, ivec2 offset);

    T130 TextureProjOffset: gvec4 textureProjOffset(gsampler1D sampler, vec2 P, int offset, optional bias);
    T130 TextureProjOffset: gvec4 textureProjOffset(gsampler1D sampler, vec4 P, int offset, optional bias);
    T130 TextureProjOffset: gvec4 textureProjOffset(gsampler2D sampler, vec3 P, ivec2 offset, optional bias);
    T130 TextureProjOffset: gvec4 textureProjOffset(gsampler2D sampler, vec4 P, ivec2 offset, optional bias);
    T130 TextureProjOffset: gvec4 textureProjOffset(gsampler3D sampler, vec4 P, ivec3 offset, optional bias);
    T140 TextureProjOffset: gvec4 textureProjOffset(gsampler2DRect sampler, vec3 P, ivec2 offset);
    T140 TextureProjOffset: gvec4 textureProjOffset(gsampler2DRect sampler, vec4 P, ivec2 offset);
    T140 TextureProjOffset: float textureProjOffset(sampler2DRectShadow sampler, vec4 P, ivec2 offset);
    T130 TextureProjOffset: float textureProjOffset(sampler1DShadow sampler, vec4 P, int offset, optional bias);
    T130 TextureProjOffset: float textureProjOffset(sampler2DShadow sampler, vec4 P, ivec2 offset, optional bias);

    T130 TextureLodOffset: gvec4 textureLodOffset(gsampler1D sampler, float P, float lod, int offset);
    T130 TextureLodOffset: gvec4 textureLodOffset(gsampler2D sampler, vec2 P, float lod, ivec2 offset);
    T130 TextureLodOffset: gvec4 textureLodOffset(gsampler3D sampler, vec3 P, float lod, ivec3 offset);
    T130 TextureLodOffset: float textureLodOffset(sampler1DShadow sampler, vec3 P, float lod, int offset);
    T130 TextureLodOffset: float textureLodOffset(sampler2DShadow sampler, vec3 P, float lod, ivec2 offset);
    T130 TextureLodOffset: gvec4 textureLodOffset(gsampler1DArray sampler, vec2 P, float lod, int offset);
    T130 TextureLodOffset: gvec4 textureLodOffset(gsampler2DArray sampler, vec3 P, float lod, ivec2 offset);
    T130 TextureLodOffset: float textureLodOffset(sampler1DArrayShadow sampler, vec3 P, float lod, int offset);

    T130 TextureProjLod: gvec4 textureProjLod(gsampler1D sampler, vec2 P, float lod);
    T130 TextureProjLod: gvec4 textureProjLod(gsampler1D sampler, vec4 P, float lod);
    T130 TextureProjLod: gvec4 textureProjLod(gsampler2D sampler, vec3 P, float lod);
    T130 TextureProjLod: gvec4 textureProjLod(gsampler2D sampler, vec4 P, float lod);
    T130 TextureProjLod: gvec4 textureProjLod(gsampler3D sampler, vec4 P, float lod);
    T130 TextureProjLod: float textureProjLod(sampler1DShadow sampler, vec4 P, float lod);
    T130 TextureProjLod: float textureProjLod(sampler2DShadow sampler, vec4 P, float lod);

    T130 TextureProjLodOffset: gvec4 textureProjLodOffset(gsampler1D sampler, vec2 P, float lod, int offset);
    T130 TextureProjLodOffset: gvec4 textureProjLodOffset(gsampler1D sampler, vec4 P, float lod, int offset);
    T130 TextureProjLodOffset: gvec4 textureProjLodOffset(gsampler2D sampler, vec3 P, float lod, ivec2 offset);
    T130 TextureProjLodOffset: gvec4 textureProjLodOffset(gsampler2D sampler, vec4 P, float lod, ivec2 offset);
    T130 TextureProjLodOffset: gvec4 textureProjLodOffset(gsampler3D sampler, vec4 P, float lod, ivec3 offset);
    T130 TextureProjLodOffset: float textureProjLodOffset(sampler1DShadow sampler, vec4 P, float lod, int offset);
    T130 TextureProjLodOffset: float textureProjLodOffset(sampler2DShadow sampler, vec4 P, float lod, ivec2 offset);

    T130 TextureGrad: gvec4 textureGrad(gsampler1D sampler, float P, float dPdx, float dPdy);
    T130 TextureGrad: gvec4 textureGrad(gsampler2D sampler, vec2 P, vec2 dPdx, vec2 dPdy);
    T130 TextureGrad: gvec4 textureGrad(gsampler3D sampler, vec3 P, vec3 dPdx, vec3 dPdy);
    T130 TextureGrad: gvec4 textureGrad(gsamplerCube sampler, vec3 P, vec3 dPdx, vec3 dPdy);
    T140 TextureGrad: gvec4 textureGrad(gsampler2DRect sampler, vec2 P, vec2 dPdx, vec2 dPdy);
    T140 TextureGrad: float textureGrad(sampler2DRectShadow sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    T130 TextureGrad: float textureGrad(sampler1DShadow sampler, vec3 P, float dPdx, float dPdy);
    T130 TextureGrad: float textureGrad(sampler2DShadow sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    T130 TextureGrad: float textureGrad(samplerCubeShadow sampler, vec4 P, vec3 dPdx, vec3 dPdy);
    T130 TextureGrad: gvec4 textureGrad(gsampler1DArray sampler, vec2 P, float dPdx, float dPdy);
    T130 TextureGrad: gvec4 textureGrad(gsampler2DArray sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    T130 TextureGrad: float textureGrad(sampler1DArrayShadow sampler, vec3 P, float dPdx, float dPdy);
    T130 TextureGrad: float textureGrad(sampler2DArrayShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy);

    T130 TextureGradOffset: gvec4 textureGradOffset(gsampler1D sampler, float P, float dPdx, float dPdy, int offset);
    T130 TextureGradOffset: gvec4 textureGradOffset(gsampler2D sampler, vec2 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T130 TextureGradOffset: gvec4 textureGradOffset(gsampler3D sampler, vec3 P, vec3 dPdx, vec3 dPdy, ivec3 offset);
    T140 TextureGradOffset: gvec4 textureGradOffset(gsampler2DRect sampler, vec2 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T140 TextureGradOffset: float textureGradOffset(sampler2DRectShadow sampler, vec3 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T130 TextureGradOffset: float textureGradOffset(sampler1DShadow sampler, vec3 P, float dPdx, float dPdy, int offset);
    T130 TextureGradOffset: float textureGradOffset(sampler2DShadow sampler, vec3 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T130 TextureGradOffset: gvec4 textureGradOffset(gsampler1DArray sampler, vec2 P, float dPdx, float dPdy, int offset);
    T130 TextureGradOffset: gvec4 textureGradOffset(gsampler2DArray sampler, vec3 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T130 TextureGradOffset: float textureGradOffset(sampler1DArrayShadow sampler, vec3 P, float dPdx, float dPdy, int offset);
    T130 TextureGradOffset: float textureGradOffset(sampler2DArrayShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy, ivec2 offset);

    T130 TextureProjGrad: gvec4 textureProjGrad(gsampler1D sampler, vec2 P, float dPdx, float dPdy);
    T130 TextureProjGrad: gvec4 textureProjGrad(gsampler1D sampler, vec4 P, float dPdx, float dPdy);
    T130 TextureProjGrad: gvec4 textureProjGrad(gsampler2D sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    T130 TextureProjGrad: gvec4 textureProjGrad(gsampler2D sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    T130 TextureProjGrad: gvec4 textureProjGrad(gsampler3D sampler, vec4 P, vec3 dPdx, vec3 dPdy);
    T140 TextureProjGrad: gvec4 textureProjGrad(gsampler2DRect sampler, vec3 P, vec2 dPdx, vec2 dPdy);
    T140 TextureProjGrad: gvec4 textureProjGrad(gsampler2DRect sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    T140 TextureProjGrad: float textureProjGrad(sampler2DRectShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy);
    T130 TextureProjGrad: float textureProjGrad(sampler1DShadow sampler, vec4 P, float dPdx, float dPdy);
    T130 TextureProjGrad: float textureProjGrad(sampler2DShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy);

    T130 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler1D sampler, vec2 P, float dPdx, float dPdy, int offset);
    T130 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler1D sampler, vec4 P, float dPdx, float dPdy, int offset);
    T130 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler2D sampler, vec3 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T130 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler2D sampler, vec4 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T140 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler2DRect sampler, vec3 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T140 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler2DRect sampler, vec4 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T140 TextureProjGradOffset: float textureProjGradOffset(sampler2DRectShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
    T130 TextureProjGradOffset: gvec4 textureProjGradOffset(gsampler3D sampler, vec4 P, vec3 dPdx, vec3 dPdy, ivec3 offset);
    T130 TextureProjGradOffset: float textureProjGradOffset(sampler1DShadow sampler, vec4 P, float dPdx, float dPdy, int offset);
    T130 TextureProjGradOffset: float textureProjGradOffset(sampler2DShadow sampler, vec4 P, vec2 dPdx, vec2 dPdy, ivec2 offset);
};
