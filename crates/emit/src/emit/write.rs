//! Runs naga's writers, with every option set explicitly.
//!
//! *Holds:* naga's writers run inside `catch_unwind`, since they panic on some modules that its validator accepts.

use super::inline::inline_loads;
use super::lines::SourceLines;
use super::nesting::{is_nested, too_deep};
use crate::target::{Conventions, Target};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::{general, targets};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span};
use naga::back::{glsl, hlsl, msl, spv, wgsl};
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// The output of a writer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Emitted {
    /// WGSL, MSL, HLSL, GLSL.
    Text(String),
    /// SPIR-V.
    Words(Vec<u32>),
}

impl Emitted {
    /// The contents of the file: UTF-8, or little-endian words.
    pub fn into_bytes(self) -> Vec<u8> {
        match self {
            Self::Text(text) => text.into_bytes(),
            Self::Words(words) => words.into_iter().flat_map(u32::to_le_bytes).collect(),
        }
    }
}

/// Writes one stage of a program for a target.
///
/// # Errors
/// What the target cannot represent, and internal errors.
pub fn emit(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
) -> Result<Emitted, Vec<Diagnostic>> {
    emit_with_sources(program, stage, target, conventions, None)
}

/// Like [`emit`], with the texts that source lines in SPIR-V refer to ([`Conventions::debug_lines`]).
///
/// # Errors
/// The same as those of [`emit`].
pub fn emit_with_sources(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Emitted, Vec<Diagnostic>> {
    let module = crate::lower::lower(program, stage, target, conventions)?;
    // naga's validator and writers recurse over nested blocks, which the parser bounds at 256.
    const NESTING: u32 = 512;
    let deep = program.stage(stage).is_some_and(|shader| shader.expr_depth > 32) || is_nested(&module, 24);
    if target == Target::Wgsl
        && let Some(found) = too_deep(&module)
    {
        return Err(vec![found]);
    }
    let write = || {
        let info = validate(&module)?;
        write(module, &info, stage, target, conventions, sources)
    };
    glisten_front::stack::with_stack(if deep { NESTING } else { 0 }, move || {
        catch_unwind(AssertUnwindSafe(write)).unwrap_or_else(|_| {
            Err(vec![internal_error(Span::default(), format!("the writer of {} panicked", target.name()))])
        })
    })
}

fn internal_error(span: Span, message: String) -> Diagnostic {
    Diagnostic::new(&general::INTERNAL, span, message)
}

/// Runs naga's validator. Its error becomes an internal error at the position in the GLSL text.
fn validate(module: &naga::Module) -> Result<ModuleInfo, Vec<Diagnostic>> {
    Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module).map_err(|error| {
        let place = error.spans().find_map(|(span, _)| span.to_range());
        let span = place.map_or(Span::default(), |range| Span::new(range.start as u32, range.end as u32));
        let message = without_handles(&chain(error.as_inner()));
        vec![internal_error(span, format!("the lowered program is not valid: {message}"))]
    })
}

/// An error and its causes in one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}

/// A message of naga without its handles (`Expression [12]`, `[3]`), which mean nothing to a user.
fn without_handles(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(open) = rest.find('[') {
        let digits = rest[open + 1..].bytes().take_while(u8::is_ascii_digit).count();
        let close = open + 1 + digits;
        if digits > 0 && rest[close..].starts_with(']') {
            shown.push_str(rest[..open].trim_end());
            rest = &rest[close + 1..];
        } else {
            shown.push_str(&rest[..=open]);
            rest = &rest[open + 1..];
        }
    }
    shown.push_str(rest);
    shown
}

fn write(
    mut module: naga::Module,
    info: &ModuleInfo,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Emitted, Vec<Diagnostic>> {
    let written = match target {
        Target::Spirv => write_spirv(&module, info, conventions, sources).map(Emitted::Words),
        Target::Wgsl => {
            inline_loads(&mut module);
            write_wgsl(&module, info, stage).map(Emitted::Text)
        }
        Target::Msl => {
            inline_loads(&mut module);
            write_msl(&module, info).map(Emitted::Text)
        }
        Target::Hlsl => write_hlsl(&module, info).map(Emitted::Text),
        Target::Glsl => write_glsl(&module, info, stage).map(Emitted::Text),
    };
    written.map_err(|message| {
        let message = format!("the writer of {} failed: {}", target.name(), without_handles(&message));
        match target {
            Target::Wgsl | Target::Spirv => vec![internal_error(Span::default(), message)],
            // For these three, naga's output is taken as it is, and its writers have gaps (for example `inverse` in
            // MSL and HLSL).
            Target::Msl | Target::Hlsl | Target::Glsl => {
                let diagnostic = Diagnostic::new(&targets::FEATURE_NOT_IN_TARGET, Span::default(), message);
                vec![diagnostic.help("compile for WGSL or SPIR-V, and translate that with a tool of the target")]
            }
        }
    })
}

fn write_wgsl(module: &naga::Module, info: &ModuleInfo, stage: Stage) -> Result<String, String> {
    let text = wgsl::write_string(module, info, wgsl::WriterFlags::empty()).map_err(|error| chain(&error))?;
    let text = super::names::restored(&text);
    // GLSL allows derivatives in any control flow (§8.8 calls them undefined in some). WGSL rejects them where it
    // cannot prove that control flow is uniform, unless a directive disables that. naga has the directive in its IR
    // but never writes it.
    if stage == Stage::Fragment && takes_derivatives(module) {
        return Ok(format!("diagnostic(off, derivative_uniformity);\n\n{text}"));
    }
    Ok(text)
}

/// Whether the module takes any derivatives, explicit or implicit.
fn takes_derivatives(module: &naga::Module) -> bool {
    let takes = |function: &naga::Function| {
        function.expressions.iter().any(|(_, expression)| match expression {
            naga::Expression::Derivative { .. } => true,
            naga::Expression::ImageSample { level, .. } => {
                matches!(level, naga::SampleLevel::Auto | naga::SampleLevel::Bias(_))
            }
            _ => false,
        })
    };
    module.functions.iter().any(|(_, function)| takes(function))
        || module.entry_points.iter().any(|entry| takes(&entry.function))
}

/// Indices out of bounds are undefined in GLSL (§4.1.9) and must not crash a host: they are clamped.
fn policies() -> BoundsCheckPolicies {
    BoundsCheckPolicies {
        index: BoundsCheckPolicy::Restrict,
        buffer: BoundsCheckPolicy::Restrict,
        image_load: BoundsCheckPolicy::Restrict,
        binding_array: BoundsCheckPolicy::Unchecked,
    }
}

fn write_spirv(
    module: &naga::Module,
    info: &ModuleInfo,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Vec<u32>, String> {
    // Not ADJUST_COORDINATE_SPACE, which flips y: the lowering has applied the conventions. Not CLAMP_FRAG_DEPTH:
    // OpenGL clamps in fixed function after the shader, and so does Vulkan. Not LABEL_VARYINGS: names of locations
    // have no meaning. FORCE_POINT_SIZE, since in Vulkan the size of a point is undefined if it is not written.
    let mut flags = spv::WriterFlags::FORCE_POINT_SIZE;
    let lines = sources.filter(|_| conventions.debug_lines).and_then(|sources| SourceLines::of(module, sources));
    if lines.is_some() {
        flags |= spv::WriterFlags::DEBUG;
    }
    let debug_info = lines.as_ref().map(|lines| spv::DebugInfo {
        source_code: &lines.text,
        file_name: lines.name(),
        language: spv::SourceLanguage::GLSL,
    });
    let options = spv::Options {
        // Vulkan 1.1 accepts up to 1.3.
        lang_version: (1, 3),
        flags,
        // A missing binding is an internal error, which must not be hidden.
        fake_missing_bindings: false,
        binding_map: own_bindings(module),
        // Vulkan's robust access keeps reads of uniform buffers inside them. An index clamped here would hide from
        // the driver that a loop over lights stays within the array, so the driver would not unroll the loop: in a
        // measurement, lavapipe took 1.6 times as long.
        bounds_check_policies: BoundsCheckPolicies { buffer: BoundsCheckPolicy::Unchecked, ..policies() },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        // This would add a pair of counters to every loop, against compilers that assume that loops end. GLSL does
        // not require it.
        force_loop_bounding: false,
        // This would add a function call for every `/` and `%`. §5.9 leaves division by zero undefined "without
        // termination".
        emit_int_div_checks: false,
        debug_info,
        ..spv::Options::default()
    };
    let words = spv::write_vec(module, info, &options, None).map_err(|error| chain(&error))?;
    Ok(match lines {
        Some(lines) => lines.led_back(&words),
        None => words,
    })
}

/// Gives every resource the binding that link has assigned.
fn own_bindings(module: &naga::Module) -> spv::BindingMap {
    let bindings = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    bindings
        .map(|own| {
            let info = spv::BindingInfo { descriptor_set: own.group, binding: own.binding, binding_array_size: None };
            (own, info)
        })
        .collect()
}

fn write_msl(module: &naga::Module, info: &ModuleInfo) -> Result<String, String> {
    let options = msl::Options {
        // The lowest version that has `primitive_id`.
        lang_version: (2, 3),
        fake_missing_bindings: true,
        bounds_check_policies: policies(),
        zero_initialize_workgroup_memory: false,
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions::default();
    msl::write_string(module, info, &options, &pipeline).map(|(text, _)| text).map_err(|error| chain(&error))
}

fn write_hlsl(module: &naga::Module, info: &ModuleInfo) -> Result<String, String> {
    let options = hlsl::Options {
        fake_missing_bindings: true,
        force_loop_bounding: false,
        restrict_indexing: true,
        ..hlsl::Options::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None).map_err(|error| chain(&error))?;
    Ok(text)
}

fn write_glsl(module: &naga::Module, info: &ModuleInfo, stage: Stage) -> Result<String, String> {
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        // Not ADJUST_COORDINATE_SPACE, for the reason above.
        writer_flags: glsl::WriterFlags::empty(),
        ..glsl::Options::default()
    };
    let shader_stage = if stage == Stage::Vertex { naga::ShaderStage::Vertex } else { naga::ShaderStage::Fragment };
    let pipeline = glsl::PipelineOptions { shader_stage, entry_point: "main".to_owned(), multiview: None };
    let mut text = String::new();
    let mut writer =
        glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies()).map_err(|error| chain(&error))?;
    writer.write().map_err(|error| chain(&error))?;
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::without_handles;

    #[test]
    fn handles_of_naga_are_not_shown() {
        assert_eq!(without_handles("Expression [12] is invalid"), "Expression is invalid");
        assert_eq!(without_handles("[3]: The array [f32; 4] of type [7]"), ": The array [f32; 4] of type");
        assert_eq!(without_handles("no handle [ here"), "no handle [ here");
    }
}
