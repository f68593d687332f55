//! The words that piglit's shader_runner knows, so that a mistyped word is a mistake and not a skip.
//!
//! *In:* a word or a line of a test. *Out:* nothing if shader_runner knows it, or a failure with the most similar word.
//! *Not done here:* what this runner supports of it.

use super::words::{Line, Words};
use super::{TestResult, fail, skip};
use glisten_front::diagnostic::did_you_mean;

/// The sections, and two for words to people.
pub(super) const SECTIONS: &[&str] = &[
    "comment",
    "compute shader",
    "compute shader specializations",
    "compute shader spirv",
    "description",
    "elements",
    "fragment program",
    "fragment shader",
    "fragment shader specializations",
    "fragment shader spirv",
    "geometry layout",
    "geometry shader",
    "geometry shader specializations",
    "geometry shader spirv",
    "require",
    "shader include",
    "shader include paths",
    "tessellation control shader",
    "tessellation control shader specializations",
    "tessellation control shader spirv",
    "tessellation evaluation shader",
    "tessellation evaluation shader specializations",
    "tessellation evaluation shader spirv",
    "test",
    "vertex data",
    "vertex program",
    "vertex shader",
    "vertex shader passthrough",
    "vertex shader specializations",
    "vertex shader spirv",
];

/// How a requirement may begin, besides names of extensions and limits.
pub(super) const REQUIREMENTS: &[&str] =
    &["GL", "GLSL", "INT", "SEPARABLE", "SIZE", "SPIRV", "SSO", "depthbuffer", "ignore_missing_uniforms", "rlimit"];

/// How a name of an extension begins that a requirement may name without `GL_`.
const VENDORS: &[&str] = &["AMD_", "ARB_", "EXT_", "INTEL_", "KHR_", "MESA_", "NV_", "OES_"];

/// How a command may begin.
const COMMANDS: &[&str] = &[
    "active shader program",
    "active uniform",
    "atomic counter",
    "atomic counters",
    "blend barrier",
    "blend func",
    "blit",
    "block array index",
    "block binding",
    "block matrix stride",
    "block offset",
    "block row major",
    "calllist",
    "clear",
    "clear color",
    "clear depth",
    "clip plane",
    "color",
    "compute",
    "deletelist",
    "depthfunc",
    "disable",
    "draw arrays",
    "draw elements",
    "draw instanced rect",
    "draw rect",
    "enable",
    "endlist",
    "fb draw",
    "fb ms",
    "fb read",
    "fb tex",
    "fb winsys",
    "fbfetch barrier",
    "frontface ccw",
    "frontface cw",
    "frustum",
    "hint",
    "image texture",
    "light",
    "link error",
    "link success",
    "memory barrier",
    "multidraw arrays",
    "newlist",
    "ortho",
    "parameter env_fp",
    "parameter env_vp",
    "parameter local_fp",
    "parameter local_vp",
    "patch parameter",
    "polygon mode",
    "probe all rgb",
    "probe all rgba",
    "probe atomic counter",
    "probe depth",
    "probe rect rgb",
    "probe rect rgba",
    "probe rgb",
    "probe rgba",
    "probe ssbo",
    "probe warn all rgb",
    "probe warn all rgba",
    "probe xfb buffer",
    "program binary save restore",
    "provoking vertex",
    "relative probe rect rgb",
    "relative probe rect rgba",
    "relative probe rgb",
    "relative probe rgba",
    "resident image texture",
    "resident texture",
    "shade model",
    "ssbo",
    "subuniform",
    "texcoord",
    "texparameter",
    "texture checkerboard",
    "texture integer",
    "texture junk",
    "texture miptree",
    "texture quads",
    "texture rgbw",
    "texture shadow1D",
    "texture shadow1DArray",
    "texture shadow2D",
    "texture shadow2DArray",
    "texture shadowRect",
    "texture storage",
    "tolerance",
    "ubo array index",
    "uniform",
    "verify program_interface_query",
    "verify program_query",
    "verify query_object",
    "vertex attrib",
    "viewport indexed",
    "viewport swizzle",
    "xfb buffer object",
    "xfb draw arrays",
];

/// The capabilities of OpenGL: what can be enabled.
pub(super) const CAPABILITIES: &[&str] = &[
    "GL_ALPHA_TEST",
    "GL_BLEND",
    "GL_CLIP_DISTANCE0",
    "GL_CLIP_PLANE0",
    "GL_COLOR_LOGIC_OP",
    "GL_COLOR_SUM",
    "GL_CULL_FACE",
    "GL_DEPTH_CLAMP",
    "GL_DEPTH_TEST",
    "GL_DITHER",
    "GL_FOG",
    "GL_FRAMEBUFFER_SRGB",
    "GL_LIGHTING",
    "GL_LINE_SMOOTH",
    "GL_LINE_STIPPLE",
    "GL_MULTISAMPLE",
    "GL_NORMALIZE",
    "GL_POINT_SMOOTH",
    "GL_POINT_SPRITE",
    "GL_POLYGON_OFFSET_FILL",
    "GL_POLYGON_OFFSET_LINE",
    "GL_POLYGON_OFFSET_POINT",
    "GL_POLYGON_SMOOTH",
    "GL_POLYGON_STIPPLE",
    "GL_PRIMITIVE_RESTART",
    "GL_PROGRAM_POINT_SIZE",
    "GL_RASTERIZER_DISCARD",
    "GL_SAMPLE_ALPHA_TO_COVERAGE",
    "GL_SAMPLE_ALPHA_TO_ONE",
    "GL_SAMPLE_COVERAGE",
    "GL_SAMPLE_MASK",
    "GL_SAMPLE_SHADING",
    "GL_SCISSOR_TEST",
    "GL_STENCIL_TEST",
    "GL_TEXTURE_1D",
    "GL_TEXTURE_2D",
    "GL_TEXTURE_3D",
    "GL_TEXTURE_CUBE_MAP",
    "GL_TEXTURE_CUBE_MAP_SEAMLESS",
    "GL_TEXTURE_RECTANGLE",
    "GL_VERTEX_PROGRAM_POINT_SIZE",
    "GL_VERTEX_PROGRAM_TWO_SIDE",
];

/// The modes of draws that this runner may lack.
pub(super) const MODES: &[&str] = &["GL_PATCHES", "GL_POLYGON", "GL_QUADS", "GL_QUAD_STRIP"];

/// The comparisons of OpenGL.
pub(super) const COMPARISONS: &[&str] =
    &["GL_ALWAYS", "GL_EQUAL", "GL_GEQUAL", "GL_GREATER", "GL_LEQUAL", "GL_LESS", "GL_NEVER", "GL_NOTEQUAL"];

/// The factors of blending of OpenGL.
pub(super) const FACTORS: &[&str] = &[
    "GL_CONSTANT_ALPHA",
    "GL_CONSTANT_COLOR",
    "GL_DST_ALPHA",
    "GL_DST_COLOR",
    "GL_ONE",
    "GL_ONE_MINUS_CONSTANT_ALPHA",
    "GL_ONE_MINUS_CONSTANT_COLOR",
    "GL_ONE_MINUS_DST_ALPHA",
    "GL_ONE_MINUS_DST_COLOR",
    "GL_ONE_MINUS_SRC1_ALPHA",
    "GL_ONE_MINUS_SRC1_COLOR",
    "GL_ONE_MINUS_SRC_ALPHA",
    "GL_ONE_MINUS_SRC_COLOR",
    "GL_SRC1_ALPHA",
    "GL_SRC1_COLOR",
    "GL_SRC_ALPHA",
    "GL_SRC_ALPHA_SATURATE",
    "GL_SRC_COLOR",
    "GL_ZERO",
];

/// The parameters of textures.
pub(super) const PARAMETERS: &[&str] = &[
    "base_level",
    "border_color",
    "compare_func",
    "depth_mode",
    "lod_bias",
    "mag",
    "max_level",
    "min",
    "swizzle_a",
    "swizzle_b",
    "swizzle_g",
    "swizzle_r",
    "wrap_r",
    "wrap_s",
    "wrap_t",
];

/// The wrap modes.
pub(super) const WRAPS: &[&str] =
    &["clamp", "clamp_to_border", "clamp_to_edge", "mirrored_repeat", "mirror_clamp_to_edge", "repeat"];

/// The properties of an active uniform that a host may ask for.
pub(super) const PROPERTIES: &[&str] = &[
    "GL_UNIFORM_ARRAY_STRIDE",
    "GL_UNIFORM_ATOMIC_COUNTER_BUFFER_INDEX",
    "GL_UNIFORM_BLOCK_INDEX",
    "GL_UNIFORM_IS_ROW_MAJOR",
    "GL_UNIFORM_MATRIX_STRIDE",
    "GL_UNIFORM_NAME_LENGTH",
    "GL_UNIFORM_OFFSET",
    "GL_UNIFORM_SIZE",
    "GL_UNIFORM_TYPE",
];

/// The types of numbers of vertex data.
pub(super) const DATA: &[&str] = &["byte", "double", "float", "half", "int", "short", "ubyte", "uint", "ushort"];

/// Skips what shader_runner knows, and fails otherwise, with the most similar known word.
pub(super) fn unsupported<T>(line: u32, name: &str, what: &str, known: &[&str]) -> Result<T, TestResult> {
    match known.contains(&name) {
        true => skip(line, format_args!("`{name}` is not supported")),
        false => mistake(line, name, what, known.iter().copied()),
    }
}

/// Fails: `name` is no `what`. Says which of the known words may be meant.
pub(super) fn mistake<'a, T>(
    line: u32,
    name: &str,
    what: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Result<T, TestResult> {
    fail(line, format_args!("`{name}` is not {what}{}", meant(did_you_mean(name, known))))
}

fn meant(word: Option<&str>) -> String {
    word.map_or_else(String::new, |word| format!("; did you mean `{word}`?"))
}

/// Checks that shader_runner knows all commands, whether this runner supports them or not.
pub(super) fn check_commands(lines: &[Line]) -> Result<(), TestResult> {
    lines.iter().try_for_each(check_command)
}

fn check_command(line: &Line) -> Result<(), TestResult> {
    let words = Words::new(line.number, &line.text);
    if COMMANDS.iter().any(|phrase| words.clone().eat(phrase)) {
        return Ok(());
    }
    let words = words.rest();
    match similar_command(words) {
        Some((said, command)) => fail(line.number, format_args!("`{said}` is not a command{}", meant(Some(command)))),
        None => fail(line.number, format_args!("`{}` is not a command of shader_runner", line.text)),
    }
}

/// The most similar command to the beginning of a line, and that beginning.
fn similar_command(words: &[&str]) -> Option<(String, &'static str)> {
    let longest = COMMANDS.iter().map(|phrase| phrase.split(' ').count()).max().unwrap_or(1);
    let of_length = (1..=longest.min(words.len())).rev().map(|count| (count, Some(count)));
    // A space may be missing.
    let near = of_length.chain([(1, None)]).find_map(|(count, of_words)| {
        let said = words.get(..count)?.join(" ");
        let same_count = |phrase: &&&str| of_words.is_none_or(|count| phrase.split(' ').count() == count);
        let command = did_you_mean(&said, COMMANDS.iter().filter(same_count).copied())?;
        Some((said, command))
    });
    near.or_else(|| longer(words))
}

/// A command with letters behind it, such as `draw rectangle`.
fn longer(words: &[&str]) -> Option<(String, &'static str)> {
    let said = |phrase: &str| Some(words.get(..phrase.split(' ').count())?.join(" "));
    COMMANDS.iter().find_map(|phrase| said(phrase).filter(|said| said.starts_with(phrase)).map(|said| (said, *phrase)))
}

/// Fails for a requirement that shader_runner does not have, and skips for one that is not met: a name of OpenGL that is none of `known`,
/// of which one may be meant.
pub(super) fn requirement<'a, T>(
    line: &Line,
    word: &str,
    known: impl IntoIterator<Item = &'a str>,
) -> Result<T, TestResult> {
    let is_name = || ["GL_", "!GL_"].iter().chain(VENDORS).any(|prefix| word.starts_with(prefix));
    match is_name() || REQUIREMENTS.contains(&word) {
        true => skip(line.number, format_args!("requires {}{}", line.text, meant(did_you_mean(word, known)))),
        false => mistake(line.number, word, "a requirement", REQUIREMENTS.iter().copied()),
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    fn reason(text: &str) -> String {
        let line = Line { number: 4, text: text.into() };
        match check_command(&line) {
            Err(TestResult::Fail(reason)) => reason,
            other => panic!("{text}: {other:?}"),
        }
    }

    #[test]
    fn a_mistyped_command_has_the_one_that_is_meant() {
        for (text, expected) in [
            ("claer", "line 4: `claer` is not a command; did you mean `clear`?"),
            ("prob all rgba 0 1 0 1", "line 4: `prob all rgba` is not a command; did you mean `probe all rgba`?"),
            ("link succes", "line 4: `link succes` is not a command; did you mean `link success`?"),
            ("drawrect -1 -1 2 2", "line 4: `drawrect` is not a command; did you mean `draw rect`?"),
            ("draw rectt -1 -1 2 2", "line 4: `draw rectt` is not a command; did you mean `draw rect`?"),
            ("draw rectangle -1 -1 2 2", "line 4: `draw rectangle` is not a command; did you mean `draw rect`?"),
            ("paint it black", "line 4: `paint it black` is not a command of shader_runner"),
        ] {
            assert_eq!(reason(text), expected);
        }
    }

    #[test]
    fn what_is_not_supported_is_no_mistake() {
        for text in
            ["fb tex 2d 0", "ssbo 5 32", "relative probe rect rgba int (0, 0, 1, 1) (1, 2, 3, 4)", "compute 1 1 1"]
        {
            assert_eq!(check_command(&Line { number: 1, text: text.into() }), Ok(()), "{text}");
        }
    }

    #[test]
    fn tables_are_sorted() {
        for table in
            [SECTIONS, REQUIREMENTS, COMMANDS, CAPABILITIES, COMPARISONS, FACTORS, PARAMETERS, PROPERTIES, DATA]
        {
            assert!(table.is_sorted(), "{table:?}");
        }
    }
}
