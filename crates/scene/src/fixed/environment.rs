//! Texture environments (OpenGL 2.1 §3.8.13, tables 3.22 and 3.23) as statements of GLSL.
//!
//! *In:* a unit. *Out:* the statements that change `color` by the unit's texture. *Holds:* textures are RGBA.

use super::pipeline::{EnvironmentMode, GlslDialect, TextureTarget, TextureUnit};

/// The name of the sampler type, of the lookup in 1.20 and of the coordinate's components.
fn words(target: TextureTarget) -> (&'static str, &'static str, &'static str) {
    match target {
        TextureTarget::D1 => ("sampler1D", "texture1DProj", ""),
        TextureTarget::D2 => ("sampler2D", "texture2DProj", ""),
        TextureTarget::D3 => ("sampler3D", "texture3DProj", ""),
        TextureTarget::Cube => ("samplerCube", "textureCube", ".stp"),
    }
}

/// The declaration of the sampler of unit `index`.
pub(super) fn declaration(index: usize, unit: TextureUnit) -> String {
    format!("uniform {} texture{index};\n", words(unit.target).0)
}

/// The statement that looks up the texel of unit `index`.
pub(super) fn fetch(dialect: GlslDialect, index: usize, unit: TextureUnit) -> String {
    let (_, old, components) = words(unit.target);
    let lookup = match (dialect, unit.target) {
        (GlslDialect::V120, _) => old,
        (GlslDialect::V150, TextureTarget::Cube) => "texture",
        (GlslDialect::V150, _) => "textureProj",
    };
    format!("    vec4 texel{index} = {lookup}(texture{index}, gl_TexCoord[{index}]{components});\n")
}

/// The statements of unit `index`, after its texel.
pub(super) fn statements(index: usize, unit: TextureUnit) -> String {
    let texel = format!("texel{index}");
    let change = match unit.mode {
        EnvironmentMode::Modulate => format!("    color *= {texel};\n"),
        EnvironmentMode::Replace => format!("    color = {texel};\n"),
        EnvironmentMode::Decal => format!("    color.rgb = mix(color.rgb, {texel}.rgb, {texel}.a);\n"),
        EnvironmentMode::Blend => format!(
            "    color.rgb = mix(color.rgb, gl_TextureEnvColor[{index}].rgb, {texel}.rgb);\n    color.a *= {texel}.a;\n"
        ),
        EnvironmentMode::Add => format!("    color.rgb += {texel}.rgb;\n    color.a *= {texel}.a;\n"),
        EnvironmentMode::Combine => unit.combine.statements(index),
    };
    // Each unit's result is clamped, as colors are numbers in [0, 1].
    let clamp = if unit.mode == EnvironmentMode::Add { "    color = clamp(color, 0.0, 1.0);\n" } else { "" };
    format!("{change}{clamp}")
}
