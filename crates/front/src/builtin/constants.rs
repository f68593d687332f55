//! The built-in constants (GLSL 1.50 §7.4), each with the smallest value that an implementation may have.

use super::Availability;
use crate::language::{Extensions, NEVER, Since, Version};

/// A `const int`.
#[derive(Clone, Copy, Debug)]
pub struct Constant {
    /// `gl_MaxVertexAttribs`
    pub name: &'static str,
    /// The smallest value that §7.4 allows, which is also glisten's.
    pub value: i32,
    /// The languages in which it exists.
    pub availability: Availability,
    /// The section that defines the value.
    pub section: &'static str,
}

/// A limit of OpenGL from a version on, which ES does not have.
const fn row(name: &'static str, value: i32, version: u16) -> Constant {
    Constant { name, value, availability: Availability::from(Since::new(version, NEVER)), section: "§7.4" }
}

/// A limit that ES has, too.
const fn also_es(constant: Constant) -> Constant {
    Constant { availability: constant.availability.es(100), ..constant }
}

const fn pack420(name: &'static str, value: i32) -> Constant {
    let availability = Availability::from(Since::new(420, 300)).or(Extensions::SHADING_LANGUAGE_420PACK);
    Constant { name, value, availability, section: "ARB_shading_language_420pack" }
}

/// A limit that 4.10 took over from ES.
const fn vectors(name: &'static str, value: i32) -> Constant {
    row(name, value, 410)
}

const fn es(constant: Constant) -> Constant {
    Constant { availability: constant.availability.es(100), section: "GLSL ES 1.00 §7.4", ..constant }
}

const fn es300(constant: Constant) -> Constant {
    Constant { availability: constant.availability.es(300), section: "GLSL ES 3.00 §7.3", ..constant }
}

/// A limit of a stage or a feature of later versions.
const fn later(name: &'static str, value: i32, desktop: u16, es: u16) -> Constant {
    Constant { name, value, availability: Availability::from(Since::new(desktop, es)), section: "GLSL 4.60 §7.3" }
}

/// A limit that versions from these on have no more.
const fn until(constant: Constant, gone: Since) -> Constant {
    Constant { availability: constant.availability.until(gone), ..constant }
}

const fn es320(constant: Constant) -> Constant {
    Constant { availability: constant.availability.es(320), ..constant }
}

const fn compatibility(constant: Constant) -> Constant {
    let availability = Availability { compatibility_only: true, ..constant.availability };
    Constant { availability, section: "§7.4.1", ..constant }
}

/// Vertex attribute locations.
pub const MAX_VERTEX_ATTRIBS: u32 = 16;
/// Components that the vertex stage may write.
pub const MAX_VERTEX_OUTPUT_COMPONENTS: u32 = 64;
/// Components that the geometry stage may read of each vertex.
pub const MAX_GEOMETRY_INPUT_COMPONENTS: u32 = 64;
/// Components that the geometry stage may write for each vertex.
pub const MAX_GEOMETRY_OUTPUT_COMPONENTS: u32 = 128;
/// Components that the fragment stage may read.
pub const MAX_FRAGMENT_INPUT_COMPONENTS: u32 = 128;
/// Components of loose uniforms in a stage.
pub const MAX_UNIFORM_COMPONENTS: u32 = 1024;
/// Samplers in a stage.
pub const MAX_TEXTURE_IMAGE_UNITS: u32 = 16;
/// Samplers in all stages together.
pub const MAX_COMBINED_TEXTURE_IMAGE_UNITS: u32 = 48;
/// Color outputs.
pub const MAX_DRAW_BUFFERS: u32 = 8;
/// Elements of `gl_ClipDistance`.
pub const MAX_CLIP_DISTANCES: u32 = 8;
/// `gl_MinProgramTexelOffset`
pub const MIN_PROGRAM_TEXEL_OFFSET: i32 = -8;
/// `gl_MaxProgramTexelOffset`
pub const MAX_PROGRAM_TEXEL_OFFSET: i32 = 7;
/// `invocations` of a geometry shader (OpenGL 4.0 table 6.46).
pub const MAX_GEOMETRY_SHADER_INVOCATIONS: u32 = 32;
/// `max_vertices` of a geometry shader.
pub const MAX_GEOMETRY_OUTPUT_VERTICES: u32 = 256;

/// All constants.
pub static CONSTANTS: &[Constant] = &[
    also_es(row("gl_MaxVertexAttribs", MAX_VERTEX_ATTRIBS as i32, 110)),
    row("gl_MaxVertexUniformComponents", MAX_UNIFORM_COMPONENTS as i32, 110),
    until(row("gl_MaxVaryingFloats", 60, 110), Since::new(420, NEVER)),
    row("gl_MaxVaryingComponents", 60, 130),
    row("gl_MaxVertexOutputComponents", MAX_VERTEX_OUTPUT_COMPONENTS as i32, 150),
    es320(row("gl_MaxGeometryInputComponents", MAX_GEOMETRY_INPUT_COMPONENTS as i32, 150)),
    es320(row("gl_MaxGeometryOutputComponents", MAX_GEOMETRY_OUTPUT_COMPONENTS as i32, 150)),
    row("gl_MaxFragmentInputComponents", MAX_FRAGMENT_INPUT_COMPONENTS as i32, 150),
    also_es(row("gl_MaxVertexTextureImageUnits", MAX_TEXTURE_IMAGE_UNITS as i32, 110)),
    also_es(row("gl_MaxCombinedTextureImageUnits", MAX_COMBINED_TEXTURE_IMAGE_UNITS as i32, 110)),
    also_es(row("gl_MaxTextureImageUnits", MAX_TEXTURE_IMAGE_UNITS as i32, 110)),
    row("gl_MaxFragmentUniformComponents", MAX_UNIFORM_COMPONENTS as i32, 110),
    also_es(row("gl_MaxDrawBuffers", MAX_DRAW_BUFFERS as i32, 110)),
    row("gl_MaxClipDistances", MAX_CLIP_DISTANCES as i32, 130),
    es320(row("gl_MaxGeometryTextureImageUnits", MAX_TEXTURE_IMAGE_UNITS as i32, 150)),
    es320(row("gl_MaxGeometryOutputVertices", MAX_GEOMETRY_OUTPUT_VERTICES as i32, 150)),
    es320(row("gl_MaxGeometryTotalOutputComponents", 1024, 150)),
    es320(row("gl_MaxGeometryUniformComponents", MAX_UNIFORM_COMPONENTS as i32, 150)),
    row("gl_MaxGeometryVaryingComponents", 64, 150),
    es(vectors("gl_MaxVertexUniformVectors", 256)),
    es(vectors("gl_MaxFragmentUniformVectors", 256)),
    until(es(vectors("gl_MaxVaryingVectors", 15)), Since::new(NEVER, 300)),
    es300(row("gl_MaxVertexOutputVectors", 16, NEVER)),
    es300(row("gl_MaxFragmentInputVectors", 15, NEVER)),
    compatibility(row("gl_MaxLights", 8, 110)),
    compatibility(row("gl_MaxTextureUnits", 2, 110)),
    compatibility(row("gl_MaxTextureCoords", 8, 110)),
    compatibility(row("gl_MaxClipPlanes", 8, 110)),
    later("gl_MaxVertexImageUniforms", 0, 420, 310),
    later("gl_MaxVertexAtomicCounters", 0, 420, 310),
    later("gl_MaxVertexAtomicCounterBuffers", 0, 420, 310),
    later("gl_MaxTessPatchComponents", 120, 400, 320),
    later("gl_MaxPatchVertices", 32, 400, 320),
    later("gl_MaxTessGenLevel", 64, 400, 320),
    later("gl_MaxTessControlInputComponents", 128, 400, 320),
    later("gl_MaxTessControlOutputComponents", 128, 400, 320),
    later("gl_MaxTessControlTextureImageUnits", 16, 400, 320),
    later("gl_MaxTessControlUniformComponents", 1024, 400, 320),
    later("gl_MaxTessControlTotalOutputComponents", 4096, 400, 320),
    later("gl_MaxTessControlImageUniforms", 0, 420, 320),
    later("gl_MaxTessControlAtomicCounters", 0, 420, 320),
    later("gl_MaxTessControlAtomicCounterBuffers", 0, 420, 320),
    later("gl_MaxTessEvaluationInputComponents", 128, 400, 320),
    later("gl_MaxTessEvaluationOutputComponents", 128, 400, 320),
    later("gl_MaxTessEvaluationTextureImageUnits", 16, 400, 320),
    later("gl_MaxTessEvaluationUniformComponents", 1024, 400, 320),
    later("gl_MaxTessEvaluationImageUniforms", 0, 420, 320),
    later("gl_MaxTessEvaluationAtomicCounters", 0, 420, 320),
    later("gl_MaxTessEvaluationAtomicCounterBuffers", 0, 420, 320),
    later("gl_MaxGeometryImageUniforms", 0, 420, 320),
    later("gl_MaxGeometryAtomicCounters", 0, 420, 320),
    later("gl_MaxGeometryAtomicCounterBuffers", 0, 420, 320),
    later("gl_MaxFragmentImageUniforms", 8, 420, 310),
    later("gl_MaxFragmentAtomicCounters", 8, 420, 310),
    later("gl_MaxFragmentAtomicCounterBuffers", 1, 420, 310),
    later("gl_MaxImageUnits", 8, 420, 310),
    later("gl_MaxSamples", 4, 450, 320),
    later("gl_MaxImageSamples", 0, 420, NEVER),
    later("gl_MaxCullDistances", 8, 450, NEVER),
    later("gl_MaxViewports", 16, 410, NEVER),
    later("gl_MaxComputeImageUniforms", 8, 430, 310),
    later("gl_MaxComputeUniformComponents", 1024, 430, 310),
    later("gl_MaxComputeTextureImageUnits", 16, 430, 310),
    later("gl_MaxComputeAtomicCounters", 8, 430, 310),
    later("gl_MaxComputeAtomicCounterBuffers", 8, 430, 310),
    later("gl_MaxCombinedImageUniforms", 48, 420, 310),
    later("gl_MaxCombinedImageUnitsAndFragmentOutputs", 8, 420, NEVER),
    later("gl_MaxCombinedShaderOutputResources", 16, 430, 310),
    later("gl_MaxCombinedAtomicCounters", 8, 420, 310),
    later("gl_MaxCombinedAtomicCounterBuffers", 1, 420, 310),
    later("gl_MaxCombinedClipAndCullDistances", 8, 450, NEVER),
    later("gl_MaxAtomicCounterBindings", 1, 420, 310),
    later("gl_MaxAtomicCounterBufferSize", 32, 420, 310),
    later("gl_MaxTransformFeedbackBuffers", 4, 440, NEVER),
    later("gl_MaxTransformFeedbackInterleavedComponents", 64, 440, NEVER),
    pack420("gl_MinProgramTexelOffset", MIN_PROGRAM_TEXEL_OFFSET),
    pack420("gl_MaxProgramTexelOffset", MAX_PROGRAM_TEXEL_OFFSET),
];

/// The constant with a name in a language.
pub fn named(name: &str, version: Version, extensions: Extensions) -> Option<&'static Constant> {
    CONSTANTS.iter().find(|row| row.name == name && row.availability.in_language(version, extensions))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Profile;
    use crate::source::Span;

    #[test]
    fn version_profile_and_extension_decide() {
        let core = Version { number: 150, profile: Profile::Core, span: Span::default() };
        let compatibility = Version { profile: Profile::Compatibility, ..core };
        let value = |name, version, extensions| named(name, version, extensions).map(|row: &Constant| row.value);
        assert_eq!(value("gl_MaxDrawBuffers", core, Extensions::empty()), Some(8));
        assert_eq!(value("gl_MaxClipPlanes", core, Extensions::empty()), None);
        assert_eq!(value("gl_MaxClipPlanes", compatibility, Extensions::empty()), Some(8));
        assert_eq!(value("gl_MinProgramTexelOffset", core, Extensions::empty()), None);
        assert_eq!(value("gl_MinProgramTexelOffset", core, Extensions::SHADING_LANGUAGE_420PACK), Some(-8));
        // GLSL ES 1.00 §7.4 and 3.00 §7.3 have lists of their own; GLSL 4.20 §7.3.1.
        let es = |number| Version { number, profile: Profile::Es, span: Span::default() };
        let late = Version { number: 420, ..core };
        for (name, version, expected) in [
            ("gl_MaxLights", es(100), None),
            ("gl_MaxClipPlanes", es(300), None),
            ("gl_MaxVaryingFloats", es(100), None),
            ("gl_MaxVertexUniformComponents", es(310), None),
            ("gl_MaxClipDistances", es(300), None),
            ("gl_MaxVaryingVectors", es(100), Some(15)),
            ("gl_MaxVaryingVectors", es(300), None),
            ("gl_MaxVertexAttribs", es(100), Some(16)),
            ("gl_MaxDrawBuffers", es(320), Some(8)),
            ("gl_MaxGeometryOutputVertices", es(310), None),
            ("gl_MaxGeometryOutputVertices", es(320), Some(256)),
            ("gl_MaxVaryingFloats", core, Some(60)),
            ("gl_MaxVaryingFloats", late, None),
            ("gl_MaxVaryingFloats", Version { profile: Profile::Compatibility, ..late }, Some(60)),
        ] {
            assert_eq!(value(name, version, Extensions::empty()), expected, "{name} in {}", version.name());
        }
    }

    #[test]
    fn the_core_list_is_complete() {
        assert_eq!(CONSTANTS.iter().filter(|row| row.section == "§7.4").count(), 19);
    }
}
