//! Arguments that several commands share.

use crate::arguments::stages::StageArg;
use crate::exit::Failure;
use crate::variants::axes::define;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use glisten_emit::{ClipZ, Conventions, FloatWidth, GlslVersion, SpirvEnv, WindowOrigin};
use glisten_front::builtin::constants::{MAX_DRAW_BUFFERS, MAX_VERTEX_ATTRIBS};
use glisten_front::compiler::Options;
use glisten_front::diagnostic::{Key, Level, Levels, Severity, codes, did_you_mean};
use glisten_front::link::FixedState;
use glisten_sources::engines::{self, Style};
use glisten_sources::parse_version;
use glisten_verify::specialize::{Contract, Math};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// The format of a result. `table` is another name for `human`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ResultFormat {
    /// Text for people
    #[default]
    #[value(alias = "table")]
    Human,
    /// JSON
    Json,
}

/// A format of diagnostics.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum DiagnosticFormat {
    /// Excerpts with carets.
    #[default]
    Human,
    /// One JSON array.
    Json,
    /// SARIF 2.1.0.
    Sarif,
    /// Workflow commands of GitHub Actions.
    Github,
    /// A code quality report of GitLab.
    Gitlab,
    /// JUnit's XML: a test for each finding.
    Junit,
}

/// How to read sources.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Sources")]
pub(crate) struct SourceArgs {
    /// Define a macro before the first line (without a value: 1)
    #[arg(short = 'D', value_name = "NAME[=VALUE]", value_parser = define)]
    pub(crate) defines: Vec<(String, String)>,
    /// Search this folder for included files
    #[arg(short = 'I', value_name = "DIR")]
    pub(crate) include_dirs: Vec<PathBuf>,
    /// Read this text before each source, after its #version line (repeatable)
    #[arg(long = "prelude", value_name = "FILE")]
    pub(crate) preludes: Vec<PathBuf>,
    /// The version of sources without a #version line, such as `330`, `150 core`, `300 es`
    #[arg(long, value_name = "VERSION", value_parser = parse_version)]
    pub(crate) assume_version: Option<String>,
    /// How sources name the files that they include
    #[arg(long, value_name = "STYLE", value_parser = style_words())]
    pub(crate) include_style: Option<Style>,
    /// Complete the sources as this engine does
    #[arg(long, value_name = "ENGINE", value_parser = PossibleValuesParser::new(engines::names()))]
    pub(crate) engine: Option<String>,
    /// Report an error for what the specification forbids and every driver accepts
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Which files are which stage, and which form a program.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Programs")]
pub(crate) struct ProgramArgs {
    /// The stage of standard input, and of files whose name does not say (for a single file, always)
    #[arg(long, value_enum)]
    pub(crate) stage: Option<StageArg>,
    /// Files that form one program (repeatable)
    #[arg(long = "program", value_name = "A.vert,B.frag")]
    pub(crate) programs: Vec<String>,
}

impl SourceArgs {
    /// A macro with two values is a mistake of the command line.
    ///
    /// # Errors
    /// There is one.
    pub(crate) fn refuse_two_values(&self) -> Result<(), Failure> {
        let mut values: BTreeMap<&str, &str> = BTreeMap::new();
        for (name, value) in &self.defines {
            if let Some(other) = values.insert(name, value).filter(|other| other != value) {
                let message = format!("`-D {name}={value}`: the macro has another value, `{other}`, by another -D");
                return Err(Failure::usage(message).help("leave one of them out"));
            }
        }
        Ok(())
    }

    /// The options of the compiler.
    pub(crate) fn options(&self, bindings: &BindingArgs) -> Options {
        Options {
            defines: self.defines.clone(),
            strict: self.strict,
            attribute_locations: bindings.attributes.clone(),
            frag_data_locations: bindings.frag_data.clone(),
            fixed: bindings.fixed.state(),
            ..Options::default()
        }
    }
}

/// The levels and the format of diagnostics.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Diagnostics")]
pub(crate) struct LevelArgs {
    /// Drop warnings with this code, or of this group of rules
    #[arg(long, value_name = "CODE|GROUP", value_delimiter = ',')]
    allow: Vec<String>,
    /// Report diagnostics with this code, or of this group, as warnings
    #[arg(long, value_name = "CODE|GROUP", value_delimiter = ',')]
    warn: Vec<String>,
    /// Report diagnostics with this code, or of this group, as errors; `warnings` means all warnings
    #[arg(long, value_name = "CODE|GROUP|warnings", value_delimiter = ',')]
    deny: Vec<String>,
    /// The format of diagnostics
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t)]
    pub(crate) diagnostics: DiagnosticFormat,
}

impl LevelArgs {
    /// The levels, if all codes are known and no code has two levels.
    pub(crate) fn levels(&self) -> Result<Levels, Failure> {
        let mut levels = Levels::default();
        let lists = [
            (Level::Allow, "--allow", &self.allow),
            (Level::Warn, "--warn", &self.warn),
            (Level::Deny, "--deny", &self.deny),
        ];
        for (level, flag, keys) in lists {
            for key in keys {
                set_level(&mut levels, level, key).map_err(|(message, help)| {
                    let failure = Failure::usage(format!("{flag}: {message}"));
                    if let Some(help) = help { failure.help(help) } else { failure }
                })?;
            }
        }
        Ok(levels)
    }
}

/// The word for all warnings.
const WARNINGS: &str = "warnings";

/// Sets the level of one code or group, or of all `warnings`. On failure, returns the message and a suggestion.
pub(crate) fn set_level(levels: &mut Levels, level: Level, key: &str) -> Result<(), (String, Option<String>)> {
    if key == WARNINGS {
        if level == Level::Deny {
            levels.deny_warnings();
            return Ok(());
        }
        return Err(("`warnings` as a whole can only be denied".to_owned(), None));
    }
    let Some(found) = Key::find(key) else {
        return Err((
            format!("there is no code or group `{key}`"),
            nearest_level(level, key).map(|near| format!("did you mean `{near}`?")),
        ));
    };
    let named = match found {
        Key::Code(code) => format!("{code} ({})", code.name),
        Key::Group(group) => format!("the group `{}`", group.name()),
    };
    if matches!(found, Key::Code(code) if code.severity == Severity::Error) {
        return Err((format!("{named} is an error, which no level changes"), None));
    }
    if levels.given(found).is_some_and(|given| given != level) {
        return Err((format!("{named} has another level already"), None));
    }
    levels.set_key(found, level);
    Ok(())
}

/// The word that is most similar to `key` among those that may have a level.
fn nearest_level(level: Level, key: &str) -> Option<&'static str> {
    let warnings = did_you_mean(key, [WARNINGS]).filter(|_| level == Level::Deny);
    warnings.or_else(|| nearest_code(key))
}

/// The identifier or name of the code that is most similar to `key`.
pub(crate) fn nearest_code(key: &str) -> Option<&'static str> {
    let letters = did_you_mean(&key.to_ascii_uppercase(), codes::all().map(|code| code.id));
    did_you_mean(key, Key::words()).or(letters).or_else(|| {
        // A part of a name: `undeclared` for `undeclared-identifier`.
        let lower = key.to_ascii_lowercase();
        codes::all().map(|code| code.name).find(|name| lower.len() >= 3 && name.contains(lower.as_str()))
    })
}

/// Locations by name, as set by `glBindAttribLocation` and `glBindFragDataLocation`.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Bindings")]
pub(crate) struct BindingArgs {
    /// Bind a vertex attribute to a location (glBindAttribLocation)
    #[arg(long = "bind-attrib", value_name = "NAME=LOCATION", value_parser = parse_attribute)]
    attributes: Vec<(String, u32)>,
    /// Bind a fragment output to a color number (glBindFragDataLocation)
    #[arg(long = "bind-frag-data", value_name = "NAME=COLOR_NUMBER", value_parser = parse_frag_data)]
    frag_data: Vec<(String, u32)>,
    #[command(flatten)]
    fixed: FixedArgs,
}

/// The state of the fixed-function pipeline that a program is compiled for.
#[derive(Args, Clone, Debug, Default)]
#[command(next_help_heading = "Fixed function")]
struct FixedArgs {
    /// Back faces get gl_BackColor as gl_Color (GL_VERTEX_PROGRAM_TWO_SIDE)
    #[arg(long)]
    two_side: bool,
    /// How many clip planes clip by gl_ClipVertex
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = clap::value_parser!(u32).range(0..=8))]
    clip_planes: u32,
    /// Keep gl_FrontColor and its like beyond [0, 1] (glClampColor)
    #[arg(long)]
    unclamped_colors: bool,
}

impl FixedArgs {
    fn state(&self) -> FixedState {
        let Self { two_side, clip_planes, unclamped_colors } = *self;
        FixedState { two_side, clip_planes, unclamped_colors, ..FixedState::default() }
    }
}

/// The expectations of the host of the emitted code.
#[derive(Args, Clone, Debug)]
#[command(next_help_heading = "Conventions")]
pub(crate) struct ConventionArgs {
    /// The range of clip-space z to which the target clips
    #[arg(long, value_enum, default_value_t)]
    clip_z: ClipZArg,
    /// The position of row 0 of the framebuffer (lower-left flips y in the vertex stage)
    #[arg(long, value_enum, default_value_t)]
    window_origin: WindowOriginArg,
    /// Whether SPIR-V is for y up (as wgpu provides) or for a plain Vulkan viewport
    #[arg(long, value_enum, default_value_t)]
    spirv_env: SpirvEnvArg,
    /// How many clip distances are enabled (default: all that are written)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(0..=8))]
    clip_distances: Option<u32>,
    /// Draw points as quads in WGSL and HLSL, whose points are one pixel wide (the reflection says how)
    #[arg(long)]
    point_sprites: bool,
    /// The version of emitted GLSL: OpenGL 3.3, OpenGL 4.5, WebGL 2, Vulkan
    #[arg(long, value_enum, value_name = "VERSION", default_value_t)]
    glsl_version: GlslVersionArg,
    /// Enable gl_PointSize; without it, points are one pixel wide
    #[arg(long)]
    program_point_size: bool,
    /// The width of floats: f16 in the fragment stage (WGSL, SPIR-V, MSL, HLSL), f64 in both stages (SPIR-V)
    #[arg(long, value_enum, value_name = "TYPE", default_value_t)]
    floats: FloatsArg,
}

impl ConventionArgs {
    /// The conventions.
    pub(crate) fn conventions(&self, debug_lines: bool) -> Conventions {
        Conventions {
            clip_z: match self.clip_z {
                ClipZArg::ZeroToOne => ClipZ::ZeroToOne,
                ClipZArg::MinusOneToOne => ClipZ::MinusOneToOne,
            },
            window_origin: match self.window_origin {
                WindowOriginArg::UpperLeft => WindowOrigin::UpperLeft,
                WindowOriginArg::LowerLeft => WindowOrigin::LowerLeft,
            },
            spirv_env: match self.spirv_env {
                SpirvEnvArg::Webgpu => SpirvEnv::Webgpu,
                SpirvEnvArg::Vulkan => SpirvEnv::Vulkan,
            },
            clip_distances: self.clip_distances,
            program_point_size: self.program_point_size,
            point_sprites: self.point_sprites,
            glsl_version: match self.glsl_version {
                GlslVersionArg::Desktop330 => GlslVersion::Desktop330,
                GlslVersionArg::Desktop450 => GlslVersion::Desktop450,
                GlslVersionArg::Es300 => GlslVersion::Es300,
                GlslVersionArg::Vulkan => GlslVersion::Vulkan,
            },
            debug_lines,
            floats: match self.floats {
                FloatsArg::F16 => FloatWidth::Half,
                FloatsArg::F32 => FloatWidth::Single,
                FloatsArg::F64 => FloatWidth::Double,
            },
            ..Conventions::default()
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum FloatsArg {
    /// 16 bits, with numbers up to 65,504
    F16,
    /// 32 bits, as in OpenGL
    #[default]
    F32,
    /// 64 bits
    F64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ClipZArg {
    /// 0 to w: WebGPU, Vulkan, Metal, Direct3D
    #[default]
    ZeroToOne,
    /// -w to w: OpenGL
    MinusOneToOne,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum WindowOriginArg {
    /// No flip: upright on the screen
    #[default]
    UpperLeft,
    /// Flipped, so that a render target contains OpenGL's rows
    LowerLeft,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum SpirvEnvArg {
    /// y up in normalized device coordinates
    #[default]
    Webgpu,
    /// y down: a positive viewport
    Vulkan,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum GlslVersionArg {
    /// OpenGL 3.3
    #[default]
    #[value(name = "330")]
    Desktop330,
    /// OpenGL 4.5
    #[value(name = "450")]
    Desktop450,
    /// OpenGL ES 3.0 and WebGL 2
    #[value(name = "300es", alias = "300-es")]
    Es300,
    /// Vulkan: 4.50 with sets, bindings, locations, and a block for the loose uniforms
    #[value(name = "vulkan")]
    Vulkan,
}

/// Reads the name of an include style.
fn style_words() -> impl TypedValueParser<Value = Style> {
    let names = engines::STYLES.iter().map(|row| row.name);
    PossibleValuesParser::new(names).try_map(|name| Style::named(&name).ok_or("no such style"))
}

/// The arguments of `glBindAttribLocation` (OpenGL 3.2 §2.11.3).
fn parse_attribute(text: &str) -> Result<(String, u32), String> {
    within(parse_binding(text)?, MAX_VERTEX_ATTRIBS, "a location", "glBindAttribLocation")
}

/// The arguments of `glBindFragDataLocation` (OpenGL 3.2 §3.9.2).
fn parse_frag_data(text: &str) -> Result<(String, u32), String> {
    within(parse_binding(text)?, MAX_DRAW_BUFFERS, "a color number", "glBindFragDataLocation")
}

/// The binding, unless OpenGL has an error for it.
fn within(binding: (String, u32), limit: u32, what: &str, call: &str) -> Result<(String, u32), String> {
    let (name, number) = &binding;
    if name.starts_with("gl_") {
        return Err(format!("`{name}` is built in and cannot be bound (GL_INVALID_OPERATION of {call})"));
    }
    if *number >= limit {
        return Err(format!("{number} is not {what}: they are 0 to {} (GL_INVALID_VALUE of {call})", limit - 1));
    }
    Ok(binding)
}

fn parse_binding(text: &str) -> Result<(String, u32), String> {
    let (name, number) = text.split_once('=').ok_or("write NAME=NUMBER")?;
    if name.is_empty() {
        return Err("the name is missing".to_owned());
    }
    let number = number.parse().map_err(|_| format!("`{number}` is not a non-negative integer"))?;
    Ok((name.to_owned(), number))
}

#[cfg(test)]
mod tests {
    use super::parse_binding;
    use crate::variants::axes::define;
    use glisten_sources::parse_version;

    #[test]
    fn versions() {
        for (text, version) in [("330", "330"), ("150 core", "150 core"), ("300es", "300 es"), ("#version 110", "110")]
        {
            assert_eq!(parse_version(text).as_deref(), Ok(version));
        }
        assert!(parse_version("").is_err() && parse_version("150 Core").is_err() && parse_version("15").is_err());
    }

    #[test]
    fn defines_and_bindings() {
        assert_eq!(define("A"), Ok(("A".into(), "1".into())));
        assert_eq!(define("A=b=c"), Ok(("A".into(), "b=c".into())));
        assert_eq!(define("A="), Ok(("A".into(), String::new())));
        assert!(define("1A").is_err() && define("").is_err() && define("A=\n#x").is_err());
        assert_eq!(parse_binding("pv=0"), Ok(("pv".into(), 0)));
        assert!(parse_binding("pv").is_err() && parse_binding("=1").is_err() && parse_binding("pv=-1").is_err());
    }
}

/// The changes that `specialize` may make to a picture.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct ContractArgs {
    /// Take every number to be finite: where that holds, the picture stays the same bit for bit; print what differs
    #[arg(long)]
    finite_math: bool,
    /// Allow algebra that changes rounding, infinities and NaN, and print the error that it makes
    #[arg(long)]
    fast_math: bool,
    /// Move what is affine in varyings to the vertex stage where that pays, and print the error that it makes
    #[arg(long)]
    move_to_vertex: bool,
}

impl ContractArgs {
    /// The contract.
    pub(crate) fn contract(self) -> Contract {
        Contract { math: math(self.finite_math, self.fast_math), move_to_vertex: self.move_to_vertex }
    }
}

/// The changes that `--specialize` may make to a picture.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct WithContractArgs {
    /// With --specialize, take every number to be finite
    #[arg(long, requires = "specialize")]
    finite_math: bool,
    /// With --specialize, allow algebra that changes rounding, infinities and NaN
    #[arg(long, requires = "specialize")]
    fast_math: bool,
    /// With --specialize, move what is affine in varyings to the vertex stage where that pays
    #[arg(long, requires = "specialize")]
    move_to_vertex: bool,
}

impl WithContractArgs {
    /// The contract.
    pub(crate) fn contract(self) -> Contract {
        Contract { math: math(self.finite_math, self.fast_math), move_to_vertex: self.move_to_vertex }
    }
}

/// The furthest of the contracts about numbers that are asked for.
fn math(finite: bool, fast: bool) -> Math {
    match (finite, fast) {
        (_, true) => Math::Fast,
        (true, false) => Math::Finite,
        (false, false) => Math::Exact,
    }
}
