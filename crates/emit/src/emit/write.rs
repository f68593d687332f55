//! Runs naga's validator, then the writer of a target.
//!
//! *In:* a linked program, a target and its conventions. *Out:* [`Emitted`].
//!
//! *Holds:* naga's writers run inside `catch_unwind`, since they panic on some modules that its validator accepts.

use super::emitted::{Emitted, Traced};
use super::merge::{merged, name_entry_points};
use super::messages::{chain, without_handles};
use super::naga_repairs::nesting::is_nested;
use super::targets::{self, Job};
use super::wgsl::header;
use crate::target::{Conventions, FloatWidth, Slots, Target};
use crate::width::in_width;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general;
use glisten_front::diagnostic::codes::targets::FEATURE_NOT_IN_TARGET;
use glisten_front::hir::{FunctionId, Stage};
use glisten_front::link::Program;
use glisten_front::source::{SourceMap, Span};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};
use std::panic::{AssertUnwindSafe, catch_unwind};

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
    emit_traced(program, stage, target, conventions, None).map(|traced| traced.emitted)
}

/// Emits like [`emit`], with the comments of the sources and the texts that source lines in SPIR-V refer to
/// ([`Conventions::debug_lines`]), and tells which lines come from which places of the source.
///
/// # Errors
/// The same as those of [`emit`].
pub fn emit_traced(
    program: &Program,
    stage: Stage,
    target: Target,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Traced, Vec<Diagnostic>> {
    if target == Target::Glsl {
        width_of(stage, target, conventions)?;
        let emitted = targets::glsl::write(program, stage, conventions, sources)?;
        return Ok(with_header(Traced::of(emitted), program, &[stage], target, sources));
    }
    emit_stages(program, &[stage], target, conventions, sources, Extent::Stage)
}

/// Writes all stages of a program as one module, with the entry points `vs_main` and `fs_main`. What the stages share is in it
/// once.
///
/// # Errors
/// The same as those of [`emit`]; and SPIR-V and GLSL, which have one file for each stage
/// ([`Target::has_single_file`]).
pub fn emit_single_file(
    program: &Program,
    target: Target,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Emitted, Vec<Diagnostic>> {
    if !target.has_single_file() {
        let message = format!("{} has one file for each stage", target.name());
        let refused = Diagnostic::new(&FEATURE_NOT_IN_TARGET, Span::default(), message);
        return Err(vec![refused.help("choose WGSL, MSL or HLSL, or write one file for each stage")]);
    }
    let stages: Vec<Stage> = program.stages.iter().map(|shader| shader.stage).collect();
    emit_stages(program, &stages, target, conventions, sources, Extent::SingleFile).map(|traced| traced.emitted)
}

/// Writes functions of a stage in WGSL, with what they call and use and without an entry point, for hosts that write their own. The
/// `main` of the stage is empty.
///
/// # Errors
/// What WGSL cannot represent, functions that read what only an entry point gets among it; and internal errors.
pub fn emit_functions(
    program: &Program,
    stage: Stage,
    functions: &[FunctionId],
    conventions: &Conventions,
    sources: Option<&SourceMap>,
) -> Result<Emitted, Vec<Diagnostic>> {
    let traced = emit_stages(program, &[stage], Target::Wgsl, conventions, sources, Extent::Functions(functions));
    traced.map(|traced| traced.emitted)
}

/// How much of a program is in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Extent<'f> {
    /// A stage.
    Stage,
    /// All stages, with entry points of different names.
    SingleFile,
    /// Functions of a stage.
    Functions(&'f [FunctionId]),
}

/// Writes these stages as one module.
fn emit_stages(
    program: &Program,
    stages: &[Stage],
    target: Target,
    conventions: &Conventions,
    sources: Option<&SourceMap>,
    extent: Extent<'_>,
) -> Result<Traced, Vec<Diagnostic>> {
    let slots = Slots::of(&program.interface);
    let mut modules = Vec::with_capacity(stages.len());
    let mut deep = false;
    for &stage in stages {
        let floats = width_of(stage, target, conventions)?;
        let module = match extent {
            Extent::Functions(wanted) => crate::lower::lower_functions(program, stage, target, conventions, wanted)?,
            Extent::Stage | Extent::SingleFile => crate::lower::lower(program, stage, target, conventions)?,
        };
        deep |= program.stage(stage).is_some_and(|shader| shader.depth > 32) || is_nested(&module, 24);
        if let Some(found) = targets::limit(target, &module, &slots) {
            return Err(vec![found]);
        }
        modules.push((module, floats));
    }
    // naga's validator and writers recurse over nested blocks, which the parser bounds at 256. A level of a writer, a `switch` of HLSL, say,
    // takes as much stack as four of ours.
    const NESTING: u32 = 2048;
    // Some ten levels of them take more than a small thread has.
    const SHALLOW: u32 = 128;
    let write = || {
        let mut modules = modules.into_iter().map(|(module, floats)| valid(module, floats));
        let Some(first) = modules.next() else {
            return Err(vec![internal_error(Span::default(), "a program without stages".to_owned())]);
        };
        let (mut module, mut info) = first?;
        for next in modules {
            module = merged(module, next?.0);
            info = validate(&module)?;
        }
        let is_single = extent == Extent::SingleFile;
        if is_single {
            name_entry_points(&mut module);
        }
        let shaders: Vec<_> = program.stages.iter().filter(|shader| stages.contains(&shader.stage)).collect();
        let (info, slots, types) = (&info, &slots, &program.types);
        let job = Job { module, info, conventions, sources, slots, types, shaders, is_single };
        targets::write(target, job).map_err(|message| vec![failed(target, &message)])
    };
    let traced = glisten_front::stack::with_stack(if deep { NESTING } else { SHALLOW }, move || {
        catch_unwind(AssertUnwindSafe(write)).unwrap_or_else(|_| {
            Err(vec![internal_error(Span::default(), format!("the writer of {} panicked", target.name()))])
        })
    })?;
    Ok(with_header(traced, program, stages, target, sources))
}

/// A module with floats of a width, and what the validator knows of it.
fn valid(module: naga::Module, floats: FloatWidth) -> Result<(naga::Module, ModuleInfo), Vec<Diagnostic>> {
    let info = validate(&module)?;
    if floats == FloatWidth::Single {
        return Ok((module, info));
    }
    let module = in_width(&module, &info, floats)?;
    let info = validate(&module)?;
    Ok((module, info))
}

/// The width of floats in a stage.
fn width_of(stage: Stage, target: Target, conventions: &Conventions) -> Result<FloatWidth, Vec<Diagnostic>> {
    let refused = |what: &str| {
        let message = format!("{} has no {what}", target.name());
        Err(vec![Diagnostic::new(&FEATURE_NOT_IN_TARGET, Span::default(), message)])
    };
    match (conventions.floats, target) {
        (FloatWidth::Single, _) => Ok(FloatWidth::Single),
        (FloatWidth::Half, Target::Glsl) => refused("f16"),
        (FloatWidth::Double, Target::Spirv) => Ok(FloatWidth::Double),
        (FloatWidth::Double, _) => refused("f64"),
        (FloatWidth::Half, _) if stage == Stage::Fragment => Ok(FloatWidth::Half),
        (FloatWidth::Half, _) => Ok(FloatWidth::Single),
    }
}

/// Text with a header, if the sources are known.
fn with_header(
    traced: Traced,
    program: &Program,
    stages: &[Stage],
    target: Target,
    sources: Option<&SourceMap>,
) -> Traced {
    let (Emitted::Text(text), Some(sources)) = (&traced.emitted, sources) else { return traced };
    let shaders: Vec<_> = program.stages.iter().filter(|shader| stages.contains(&shader.stage)).collect();
    let Some(header) = header(&shaders, sources) else { return traced };
    match target {
        // In GLSL, `#version` comes first: some drivers do not accept a comment before it.
        Target::Glsl => Traced::of(Emitted::Text(match text.split_once('\n') {
            Some((version, rest)) => format!("{version}\n{header}{}", rest.trim_start_matches('\n')),
            None => header + text,
        })),
        Target::Wgsl | Target::Msl | Target::Hlsl | Target::Spirv => traced.behind(&header),
    }
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

/// The diagnostic for a failed writer. It depends on whether the target has gaps.
fn failed(target: Target, message: &str) -> Diagnostic {
    let message = format!("the writer of {} failed: {}", target.name(), without_handles(message));
    if targets::has_gaps(target) {
        let diagnostic = Diagnostic::new(&FEATURE_NOT_IN_TARGET, Span::default(), message);
        diagnostic.help("compile for WGSL or SPIR-V, and translate that with a tool of the target")
    } else {
        internal_error(Span::default(), message)
    }
}

#[cfg(test)]
mod tests {
    use super::emit_functions;
    use crate::{Conventions, Emitted};
    use glisten_front::diagnostic::Diagnostic;
    use glisten_front::{Compiler, Options, Source, Stage};

    /// All functions of a text but `main`.
    fn functions(body: &str) -> Result<String, Vec<Diagnostic>> {
        let text = format!("#version 150\n{body}\nvoid main() {{}}\n");
        let source = Source { name: "a.frag".to_owned(), text: text.into(), stage: Stage::Fragment };
        let program = Compiler::new(Options::default()).compile(&[source]).program.expect("it compiles");
        let shader = program.stage(Stage::Fragment).expect("it is there");
        let wanted: Vec<_> = shader.functions().map(|(id, _)| id).filter(|id| Some(*id) != shader.main).collect();
        emit_functions(&program, Stage::Fragment, &wanted, &Conventions::default(), None).map(|emitted| match emitted {
            Emitted::Text(text) => text,
            Emitted::Words(_) => String::new(),
        })
    }

    #[test]
    fn functions_alone_have_no_entry_point_and_what_nobody_reads() {
        let text = functions(
            "uniform float k;\nuniform vec3 unread;\nconst int N = 3;\nfloat once(float x) { return k * x; }\n\
             float twice(float x) { return once(once(x)); }",
        );
        let text = text.expect("WGSL has it");
        for part in ["fn once(x: f32) -> f32 {", "fn twice(", "const N: i32 = 3;", "unread: vec3<f32>,"] {
            assert!(text.contains(part), "{part} in {text}");
        }
        assert!(!text.contains("fn main") && !text.contains("@fragment"), "{text}");
        naga::front::wgsl::parse_str(&text).unwrap_or_else(|error| panic!("{}", error.emit_to_string(&text)));
    }

    #[test]
    fn functions_that_need_an_entry_point_are_refused() {
        for body in [
            "float row() { return gl_FragCoord.y; }",
            "in vec2 st;\nfloat along() { return st.x; }",
            "uniform float k;\nfloat twice = 2.0 * k;\nfloat f() { return twice; }",
            "out vec4 color;\nvoid write() { color = vec4(1.0); }",
        ] {
            let errors = functions(body).expect_err(body);
            assert!(errors.iter().any(|error| error.message.contains("without an entry point")), "{body}: {errors:?}");
        }
    }
}
