//! The writers: naga's, with every switch set on purpose.
//!
//! *Holds:* naga's writers are run behind `catch_unwind`, since they panic on some modules that its validator accepts.

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

/// What a writer gave.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Emitted {
    /// WGSL, MSL, HLSL, GLSL.
    Text(String),
    /// SPIR-V.
    Words(Vec<u32>),
}

impl Emitted {
    /// The bytes of the file: UTF-8, or little-endian words.
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
/// What the target cannot hold, and slips of glisten's own.
pub fn emit(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
) -> Result<Emitted, Vec<Diagnostic>> {
    emit_with_sources(program, stage, target, conventions, None)
}

/// The same, with the texts that source lines in SPIR-V are counted in ([`Conventions::debug_lines`]).
///
/// # Errors
/// As those of [`emit`].
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
        catch_unwind(AssertUnwindSafe(write))
            .unwrap_or_else(|_| Err(vec![slip(Span::default(), format!("the writer of {} panicked", target.name()))]))
    })
}

fn slip(span: Span, message: String) -> Diagnostic {
    Diagnostic::new(&general::INTERNAL, span, message)
}

/// naga's validation; its complaint becomes an internal error at the place in the GLSL text.
fn validate(module: &naga::Module) -> Result<ModuleInfo, Vec<Diagnostic>> {
    Validator::new(ValidationFlags::all(), Capabilities::all()).validate(module).map_err(|error| {
        let place = error.spans().find_map(|(span, _)| span.to_range());
        let span = place.map_or(Span::default(), |range| Span::new(range.start as u32, range.end as u32));
        let message = without_handles(&chain(error.as_inner()));
        vec![slip(span, format!("the lowered program is not valid: {message}"))]
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

/// naga's words without its handles (`Expression [12]`, `[3]`), which mean nothing to anybody else.
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
            Target::Wgsl | Target::Spirv => vec![slip(Span::default(), message)],
            // These three are what naga makes of them, and naga's writers have gaps (`inverse` in MSL and HLSL, say).
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
    // GLSL lets derivatives stand in any control flow (§8.8 calls them undefined in some); WGSL refuses what it cannot
    // prove uniform, unless it is told not to. naga has the directive in its IR and never writes it.
    if stage == Stage::Fragment && takes_derivatives(module) {
        return Ok(format!("diagnostic(off, derivative_uniformity);\n\n{text}"));
    }
    Ok(text)
}

/// Whether anything in the module takes derivatives, said or unsaid.
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

/// Indices outside of their bounds are undefined in GLSL (§4.1.9) and must not crash a host: they are moved inside.
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
    // Not ADJUST_COORDINATE_SPACE, which flips y: the lowering has done what the conventions say. Not CLAMP_FRAG_DEPTH:
    // OpenGL clamps in the fixed function behind the shader, and so does Vulkan. Not LABEL_VARYINGS: names of locations
    // have no meaning. FORCE_POINT_SIZE, since Vulkan leaves points undefined whose size is not written.
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
        // Vulkan 1.1 takes up to 1.3.
        lang_version: (1, 3),
        flags,
        // A binding that is missing is a slip, which must be seen.
        fake_missing_bindings: false,
        binding_map: own_bindings(module),
        // Vulkan's robust access keeps reads of uniform buffers inside of them. An index clamped here would hide from the
        // driver that a loop over lights goes at most to the end of the array, so that it is not unrolled: lavapipe was
        // seen to take 1.6 times as long.
        bounds_check_policies: BoundsCheckPolicies { buffer: BoundsCheckPolicy::Unchecked, ..policies() },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        // A pair of counters in every loop, against compilers that take endless loops for impossible. GLSL asks for none.
        force_loop_bounding: false,
        // A function call for every `/` and `%`. §5.9 leaves division by zero undefined "without termination".
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

/// Every resource at its own binding: link has assigned them.
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
        // The least that has `primitive_id`.
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
