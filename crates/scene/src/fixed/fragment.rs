//! The fragment stage of the fixed-function pipeline as GLSL: textures, color sum, fog (OpenGL 2.1 §3.8 to §3.10).
//!
//! *In:* a [`Pipeline`]. *Out:* the text.

use super::environment;
use super::pipeline::{FogMode, GlslDialect, Pipeline};

impl Pipeline {
    /// The fragment stage as GLSL. The texture of unit `n` is the sampler `textureN`.
    pub fn fragment(&self) -> String {
        write(self)
    }
}

fn write(pipeline: &Pipeline) -> String {
    let mut text = String::from(pipeline.version());
    text.push_str("// The fragment stage of OpenGL's fixed-function pipeline.\n");
    if pipeline.enabled_units().next().is_some() {
        text.push_str(&pipeline.texture_coordinate_declaration("in"));
    }
    for (index, unit) in pipeline.enabled_units() {
        text.push_str(&environment::declaration(index, unit));
    }
    if pipeline.dialect == GlslDialect::V150 {
        text.push_str("out vec4 fragment_color;\n");
    }
    text.push_str("\nvoid main()\n{\n    vec4 color = gl_Color;\n");
    let crossed = pipeline.enabled_units().any(|(_, unit)| unit.others().next().is_some());
    if crossed {
        text.push_str("\n    // The textures of all units\n");
        for (index, unit) in pipeline.enabled_units() {
            text.push_str(&environment::fetch(pipeline.dialect, index, unit));
        }
    }
    for (index, unit) in pipeline.enabled_units() {
        text.push_str(&format!("\n    // Texture unit {index}\n"));
        if !crossed {
            text.push_str(&environment::fetch(pipeline.dialect, index, unit));
        }
        text.push_str(&environment::statements(index, unit));
    }
    if pipeline.sums_colors() {
        text.push_str("\n    // Color sum\n    color.rgb = clamp(color.rgb + gl_SecondaryColor.rgb, 0.0, 1.0);\n");
    }
    if let Some(mode) = pipeline.fog {
        text.push_str("\n    // Fog\n");
        text.push_str(fog(mode));
    }
    let output = if pipeline.dialect == GlslDialect::V120 { "gl_FragColor" } else { "fragment_color" };
    text.push_str(&format!("    {output} = color;\n}}\n"));
    text
}

/// The statements of a fog mode (OpenGL 2.1 §3.10): f is how much of the color is left.
fn fog(mode: FogMode) -> &'static str {
    match mode {
        FogMode::Linear => {
            "    float f = clamp((gl_Fog.end - gl_FogFragCoord) * gl_Fog.scale, 0.0, 1.0);\n    color.rgb = \
             mix(gl_Fog.color.rgb, color.rgb, f);\n"
        }
        FogMode::Exp => {
            "    float f = clamp(exp(-gl_Fog.density * gl_FogFragCoord), 0.0, 1.0);\n    color.rgb = \
             mix(gl_Fog.color.rgb, color.rgb, f);\n"
        }
        FogMode::Exp2 => {
            "    float depth = gl_Fog.density * gl_FogFragCoord;\n    float f = clamp(exp(-depth * depth), 0.0, \
             1.0);\n    color.rgb = mix(gl_Fog.color.rgb, color.rgb, f);\n"
        }
    }
}
