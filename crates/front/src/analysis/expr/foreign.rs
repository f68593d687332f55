//! Names that GLSL 1.50 does not have and people often try: those of other languages and of later versions.
//!
//! *In:* an unknown name. *Out:* what to write instead. *Not done here:* misspelled names.

use crate::diagnostic::{Advice, Applicability, Place};
use crate::language::{self, Extensions, NEVER, Since, Version};
use crate::syntax::NOT_YET;

/// Functions of HLSL, WGSL and similar languages, and their equivalent in GLSL.
#[rustfmt::skip]
static FUNCTIONS: &[(&str, &str)] = &[
    ("lerp", "write `mix(a, b, t)`"),
    ("saturate", "write `clamp(x, 0.0, 1.0)`"),
    ("frac", "write `fract(x)`"),
    ("mul", "write `a * b`"),
    ("rsqrt", "write `inversesqrt(x)`"),
    ("rcp", "write `1.0 / x`"),
    ("fmod", "write `mod(x, y)`, whose result has the sign of `y`"),
    ("atan2", "write `atan(y, x)`"),
    ("ddx", "write `dFdx(x)`"),
    ("ddy", "write `dFdy(x)`"),
    ("clip", "write `if (x < 0.0) discard;`"),
    ("sincos", "write `sin(x)` and `cos(x)`"),
    ("log10", "write `log(x) / log(10.0)`"),
    ("tex2D", "write `texture(s, p)`"),
    ("texCUBE", "write `texture(s, p)`"),
    ("tex2Dlod", "write `textureLod(s, p.xy, p.w)`"),
    ("textureSample", "write `texture(s, p)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("textureSampleLevel", "write `textureLod(s, p, level)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("textureSampleBias", "write `texture(s, p, bias)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("textureSampleGrad", "write `textureGrad(s, p, ddx, ddy)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("textureSampleCompare", "write `texture(s, vec3(p, reference))`, with a `sampler2DShadow`"),
    ("textureLoad", "write `texelFetch(s, ivec2(p), level)`, with a `sampler2D` in place of the texture"),
    ("textureDimensions", "write `textureSize(s, level)`, with a `sampler2D` in place of the texture"),
    ("printf", "a shader can only write to its outputs"),
];

/// Those that take the same arguments under another name.
#[rustfmt::skip]
static RENAMED: &[(&str, &str)] = &[
    ("lerp", "mix"), ("frac", "fract"), ("rsqrt", "inversesqrt"), ("fmod", "mod"), ("atan2", "atan"), ("ddx", "dFdx"),
    ("ddy", "dFdy"), ("tex2D", "texture"), ("texCUBE", "texture"),
];

/// The versions in which one `texture` takes all samplers.
const OVERLOADED_LOOKUPS: Since = Since::new(130, 300);

/// Lookups of HLSL and what versions without [`OVERLOADED_LOOKUPS`] have for them, with its arguments.
static EARLY_LOOKUPS: &[(&str, &str, &str)] = &[("tex2D", "texture2D", "s, p"), ("texCUBE", "textureCube", "s, p")];

/// Methods of textures in HLSL.
static METHODS: &[(&str, &str)] = &[
    ("Sample", "use `texture(s, p)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("SampleLevel", "use `textureLod(s, p, level)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("SampleBias", "use `texture(s, p, bias)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("SampleGrad", "use `textureGrad(s, p, ddx, ddy)`; declare one `sampler2D` instead of the texture and its sampler"),
    ("SampleCmp", "write `texture(s, vec3(p, reference))`, with a `sampler2DShadow`"),
    ("Load", "write `texelFetch(s, ivec2(p), level)`, with a `sampler2D` in place of the texture"),
    ("GetDimensions", "write `textureSize(s, level)`, with a `sampler2D` in place of the texture"),
];

/// Variables of Shadertoy, as declarations.
static SHADERTOY: &[(&str, &str)] = &[
    ("iTime", "uniform float iTime;"),
    ("iResolution", "uniform vec3 iResolution;"),
    ("iMouse", "uniform vec4 iMouse;"),
    ("iFrame", "uniform int iFrame;"),
    ("iTimeDelta", "uniform float iTimeDelta;"),
    ("iFrameRate", "uniform float iFrameRate;"),
    ("iSampleRate", "uniform float iSampleRate;"),
    ("iChannelTime", "uniform float iChannelTime[4];"),
    ("iChannelResolution", "uniform vec3 iChannelResolution[4];"),
    ("iDate", "uniform vec4 iDate;"),
    ("iChannel0", "uniform sampler2D iChannel0;"),
    ("iChannel1", "uniform sampler2D iChannel1;"),
    ("iChannel2", "uniform sampler2D iChannel2;"),
    ("iChannel3", "uniform sampler2D iChannel3;"),
];

/// Functions of later versions, with the first ones that have them.
#[rustfmt::skip]
static LATER: &[(&str, Since)] = &[
    ("interpolateAtCentroid", Since::new(400, 320)), ("interpolateAtSample", Since::new(400, 320)),
    ("interpolateAtOffset", Since::new(400, 320)),
    ("EmitStreamVertex", Since::new(400, NEVER)), ("EndStreamPrimitive", Since::new(400, NEVER)),
    ("packDouble2x32", Since::new(400, NEVER)), ("unpackDouble2x32", Since::new(400, NEVER)),
    ("anyInvocation", Since::new(460, NEVER)), ("allInvocations", Since::new(460, NEVER)),
    ("allInvocationsEqual", Since::new(460, NEVER)),
    ("atomicCounter", Since::new(420, 310)), ("imageLoad", Since::new(420, 310)), ("imageStore", Since::new(420, 310)),
    ("atomicAdd", Since::new(430, 310)), ("imageSize", Since::new(430, 310)), ("textureSamples", Since::new(450, NEVER)),
    ("barrier", Since::new(400, 310)), ("memoryBarrier", Since::new(420, 310)),
];

/// Built-in variables and constants of later versions, with the first ones that have them.
#[rustfmt::skip]
static LATER_VARIABLES: &[(&str, Since)] = &[
    ("gl_SamplePosition", Since::new(400, 320)), ("gl_SampleMask", Since::new(400, 320)),
    ("gl_NumSamples", Since::new(420, 320)), ("gl_ViewportIndex", Since::new(410, NEVER)),
    ("gl_CullDistance", Since::new(450, NEVER)), ("gl_HelperInvocation", Since::new(450, 310)),
    ("gl_DrawID", Since::new(460, NEVER)), ("gl_BaseVertex", Since::new(460, NEVER)),
    ("gl_BaseInstance", Since::new(460, NEVER)),
    ("gl_MaxComputeWorkGroupCount", Since::new(430, 310)), ("gl_MaxComputeWorkGroupSize", Since::new(430, 310)),
];

/// Whether a version has a variable that glisten does not support.
pub(in crate::analysis) fn is_unsupported_variable(name: &str, version: Version, extensions: Extensions) -> bool {
    let of_samples =
        (name.starts_with("gl_Sample") || name == "gl_NumSamples") && extensions.contains(Extensions::SAMPLE_SHADING);
    LATER_VARIABLES.iter().any(|row| row.0 == name && (version.reaches(row.1) || of_samples))
}

/// Why a function of later versions is not supported, and the way out.
pub(super) fn reason(name: &str) -> Option<(&'static str, &'static str)> {
    const WHY: &str = "naga, which writes the targets, has no functions that interpolate";
    let instead = match name {
        "interpolateAtCentroid" => "declare the input `centroid`",
        "interpolateAtSample" => "declare the input `sample`: the shader then runs for each sample",
        "interpolateAtOffset" => "add the derivatives times the offset: `v + dFdx(v) * offset.x + dFdy(v) * offset.y`",
        _ => return None,
    };
    Some((WHY, instead))
}

/// The replacement for a function that does not exist.
pub(super) fn function(name: &str, version: Version) -> Option<Advice> {
    if !version.reaches(OVERLOADED_LOOKUPS)
        && let Some((_, own, arguments)) = EARLY_LOOKUPS.iter().find(|row| row.0 == name)
    {
        let sentence = format!("write `{own}({arguments})`");
        return Some(Advice::new(Applicability::Unsafe, sentence, Place::Over, *own));
    }
    let renamed = RENAMED.iter().find(|row| row.0 == name);
    let foreign = FUNCTIONS.iter().find(|row| row.0 == name).map(|&(_, sentence)| match renamed {
        Some(&(_, other)) => Advice::new(Applicability::Unsafe, sentence, Place::Over, other),
        None => sentence.into(),
    });
    let ty = || {
        let ty = language::foreign::type_name(name)?;
        Some(Advice::new(Applicability::Unsafe, format!("write `{ty}(..)`"), Place::Over, ty))
    };
    foreign.or_else(ty).or_else(|| {
        let since = LATER.iter().find(|row| row.0 == name)?.1.desktop;
        Some(format!("`{name}` came with GLSL {}.{:02}; {NOT_YET}", since / 100, since % 100).into())
    })
}

/// Whether a version has a function that glisten does not support.
pub(super) fn is_unsupported(name: &str, version: Version, extensions: Extensions) -> bool {
    let of_shader5 = |since: Since| since.desktop == 400 && extensions.contains(Extensions::GPU_SHADER5);
    LATER.iter().any(|row| row.0 == name && (version.reaches(row.1) || of_shader5(row.1)))
}

/// The replacement for a method that does not exist.
pub(super) fn method(name: &str) -> Option<&'static str> {
    METHODS.iter().find(|row| row.0 == name).map(|row| row.1)
}

/// The beginning of the help for a variable of Shadertoy.
pub(in crate::analysis) const OF_SHADERTOY: &str = "Shadertoy declares it: ";

/// Variables of GLSL for Vulkan, and those of OpenGL in their place.
static OF_VULKAN: &[(&str, &str)] = &[("gl_VertexIndex", "gl_VertexID"), ("gl_InstanceIndex", "gl_InstanceID")];

/// The replacement for a variable of GLSL for Vulkan.
pub(super) fn of_vulkan(name: &str) -> Option<Advice> {
    let (_, own) = OF_VULKAN.iter().find(|row| row.0 == name)?;
    let sentence = format!("write `{own}`: `{name}` belongs to GLSL for Vulkan");
    Some(Advice::new(Applicability::Unsafe, sentence, Place::Over, *own))
}

/// The declaration of a variable that another environment provides.
pub(super) fn variable(name: &str) -> Option<String> {
    let declaration = SHADERTOY.iter().find(|row| row.0 == name)?.1;
    Some(format!("{OF_SHADERTOY}add `{declaration}`"))
}

/// The replacement for a type that does not exist.
pub(in crate::analysis) fn type_name(name: &str) -> Option<Advice> {
    language::foreign::type_name(name).map(|ty| Advice::write(Applicability::Unsafe, ty))
}
