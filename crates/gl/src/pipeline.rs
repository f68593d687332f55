//! Sets the switches of the driver's own fixed-function pipeline, for draws that name one stage (OpenGL 2.1 §2.11 to §2.14,
//! §3.8.13, §3.9, §3.10).
//!
//! *In:* the [`Pipeline`] from which glisten writes the other stage. *Out:* a context that draws by the driver's own, so that
//! the picture does not depend on what glisten wrote.

use super::api::Api;
use super::combine;
use super::old::Old;
use glisten_scene::fixed::{
    ColorMaterial, EnvironmentMode, FogMode, FogSource, NormalScaling, Pipeline, TexGen, TextureTarget, TextureUnit,
};

const LIGHTING: u32 = 0x0B50;
const LIGHT0: u32 = 0x4000;
const LIGHT_MODEL_LOCAL_VIEWER: u32 = 0x0B51;
const LIGHT_MODEL_TWO_SIDE: u32 = 0x0B52;
const LIGHT_MODEL_COLOR_CONTROL: u32 = 0x81F8;
const SINGLE_COLOR: u32 = 0x81F9;
const SEPARATE_SPECULAR_COLOR: u32 = 0x81FA;
const COLOR_MATERIAL: u32 = 0x0B57;
const NORMALIZE: u32 = 0x0BA1;
const RESCALE_NORMAL: u32 = 0x803A;
const COLOR_SUM: u32 = 0x8458;
const FOG: u32 = 0x0B60;
const FOG_MODE: u32 = 0x0B65;
const FOG_COORD_SRC: u32 = 0x8450;
const FOG_COORD: u32 = 0x8451;
const FRAGMENT_DEPTH: u32 = 0x8452;
const TEXTURE_ENV: u32 = 0x2300;
const TEXTURE_ENV_MODE: u32 = 0x2200;
const TEXTURE_GEN_MODE: u32 = 0x2500;
const TEXTURE_GEN_S: u32 = 0x0C60;
const S: u32 = 0x2000;
const TARGETS: [(TextureTarget, u32); 4] = [
    (TextureTarget::D1, glow::TEXTURE_1D),
    (TextureTarget::D2, glow::TEXTURE_2D),
    (TextureTarget::D3, glow::TEXTURE_3D),
    (TextureTarget::Cube, glow::TEXTURE_CUBE_MAP),
];

/// Sets all switches.
pub(super) fn set(api: &Api, old: &Old, pipeline: &Pipeline) {
    let switch = |what: u32, on: bool| if on { api.enable(what) } else { api.disable(what) };
    let model = |what: u32, value: u32| (old.light_model)(what, &[value as f32; 4]);
    switch(LIGHTING, pipeline.lighting);
    for (light, on) in (LIGHT0..).zip(pipeline.lights) {
        switch(light, on);
    }
    model(LIGHT_MODEL_LOCAL_VIEWER, pipeline.local_viewer.into());
    model(LIGHT_MODEL_TWO_SIDE, pipeline.two_side.into());
    let control = if pipeline.separate_specular { SEPARATE_SPECULAR_COLOR } else { SINGLE_COLOR };
    model(LIGHT_MODEL_COLOR_CONTROL, control);
    if let Some(material) = pipeline.color_material {
        (old.color_material)(glow::FRONT_AND_BACK, color_material(material));
    }
    switch(COLOR_MATERIAL, pipeline.color_material.is_some());
    switch(NORMALIZE, pipeline.normals == NormalScaling::Normalize);
    switch(RESCALE_NORMAL, pipeline.normals == NormalScaling::Rescale);
    switch(COLOR_SUM, pipeline.color_sum);
    switch(FOG, pipeline.fog.is_some());
    let mode = match pipeline.fog {
        Some(FogMode::Linear) => 0x2601,
        Some(FogMode::Exp) | None => 0x0800,
        Some(FogMode::Exp2) => 0x0801,
    };
    (old.fog)(FOG_MODE, &[mode as f32; 4]);
    let source = if pipeline.fog_source == FogSource::Depth { FRAGMENT_DEPTH } else { FOG_COORD };
    (old.fog)(FOG_COORD_SRC, &[source as f32; 4]);
    for (unit, state) in (glow::TEXTURE0..).zip(pipeline.units) {
        api.active_texture(unit);
        set_unit(old, &switch, state);
    }
    api.active_texture(glow::TEXTURE0);
}

fn color_material(material: ColorMaterial) -> u32 {
    match material {
        ColorMaterial::Ambient => 0x1200,
        ColorMaterial::Diffuse => 0x1201,
        ColorMaterial::Specular => 0x1202,
        ColorMaterial::Emission => 0x1600,
        ColorMaterial::AmbientAndDiffuse => 0x1602,
    }
}

fn set_unit(old: &Old, switch: &dyn Fn(u32, bool), unit: Option<TextureUnit>) {
    for (target, number) in TARGETS {
        switch(number, unit.is_some_and(|unit| unit.target == target));
    }
    let TextureUnit { mode, generate, combine, .. } = unit.unwrap_or_default();
    let mode: u32 = match mode {
        EnvironmentMode::Modulate => 0x2100,
        EnvironmentMode::Replace => 0x1E01,
        EnvironmentMode::Decal => 0x2101,
        EnvironmentMode::Blend => 0x0BE2,
        EnvironmentMode::Add => 0x0104,
        EnvironmentMode::Combine => 0x8570,
    };
    combine::set(old, &combine);
    (old.texture_environment)(TEXTURE_ENV, TEXTURE_ENV_MODE, &[mode as f32; 4]);
    let (kind, count): (u32, usize) = match generate {
        Some(TexGen::EyeLinear) => (0x2400, 4),
        Some(TexGen::ObjectLinear) => (0x2401, 4),
        Some(TexGen::SphereMap) => (0x2402, 2),
        Some(TexGen::NormalMap) => (0x8511, 3),
        Some(TexGen::ReflectionMap) => (0x8512, 3),
        None => (0x2400, 0),
    };
    for (index, (axis, enabled)) in (S..).zip(TEXTURE_GEN_S..).take(4).enumerate() {
        if index < count {
            (old.texture_generation)(axis, TEXTURE_GEN_MODE, &[kind as f32; 4]);
        }
        switch(enabled, index < count);
    }
}
