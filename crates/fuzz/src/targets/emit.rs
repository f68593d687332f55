//! The writers of the targets, reflection, and what `-O` leaves out.

use super::front::compiled;
use super::no_internal_errors;
use crate::Sections;
use crate::sections::{extension, named};
use glisten_emit::{
    Conventions, Emitted, FloatWidth, GlslVersion, Target, WindowOrigin, emit as write, emit_single_file, reflect,
};
use glisten_front::{Diagnostic, Program, Source, Stage};
use glisten_specialize::optimize as optimized;

/// Conventions that differ in all that the writers look at.
fn conventions() -> [Conventions; 3] {
    let plain = Conventions::default();
    let half = Conventions { floats: FloatWidth::Half, window_origin: WindowOrigin::LowerLeft, ..plain };
    let vulkan = Conventions { glsl_version: GlslVersion::Vulkan, debug_lines: true, ..plain };
    [plain, half, vulkan]
}

/// The program of an input, if it is one.
fn program(input: &[u8]) -> Option<Program> {
    compiled(&Sections::of(&String::from_utf8_lossy(input)).shaders()).program
}

fn stages(program: &Program) -> impl Iterator<Item = Stage> {
    program.stages.iter().map(|shader| shader.stage)
}

/// Everything that can be written.
pub(super) fn check(input: &[u8]) {
    let Some(program) = program(input) else { return };
    for conventions in conventions() {
        reflect(&program, &conventions);
        for &target in Target::ALL {
            for stage in stages(&program) {
                told(write(&program, stage, target, &conventions));
            }
            told(emit_single_file(&program, target, &conventions, None));
        }
    }
}

/// A target may lack something; it says so, which is no error of glisten.
fn told<T>(result: Result<T, Vec<Diagnostic>>) -> Option<T> {
    match result {
        Ok(written) => Some(written),
        Err(diagnostics) => {
            assert!(!diagnostics.is_empty(), "a refusal without a reason");
            no_internal_errors(&diagnostics);
            None
        }
    }
}

/// GLSL of each version is read again, by the rules of its version.
pub(super) fn print(input: &[u8]) {
    // No GLSL that is written has a geometry stage.
    let Some(program) = program(input).filter(|program| program.stage(Stage::Geometry).is_none()) else { return };
    for glsl_version in [GlslVersion::Desktop330, GlslVersion::Desktop450, GlslVersion::Es300] {
        let conventions = Conventions { glsl_version, ..Conventions::default() };
        let mut sources = Vec::new();
        for stage in stages(&program) {
            let Some(written) = told(write(&program, stage, Target::Glsl, &conventions)) else { return };
            let Emitted::Text(text) = written else { return };
            sources.push(Source { name: format!("written.{}", extension(stage)), text: text.into(), stage });
        }
        accepted(&sources, "what was written is not accepted");
    }
}

/// The texts are a program.
pub(super) fn accepted(sources: &[Source], otherwise: &str) {
    let compilation = compiled(sources);
    let error = compilation.diagnostics.iter().find(|one| one.is_error());
    let message = error.map(|error| error.message.as_str()).unwrap_or_default();
    assert!(error.is_none(), "{otherwise}: {message}\n{}", named(sources));
}

/// The rest after `-O` is a program that the same host can use: it asks for nothing new, and each target takes it that took the whole.
pub(super) fn optimize(input: &[u8]) {
    let Some(program) = program(input) else { return };
    let left = optimized(&program);
    let conventions = Conventions::default();
    let names = |program: &Program| -> Vec<String> {
        program.interface.uniforms.iter().map(|uniform| uniform.name.clone()).collect()
    };
    let before = names(&program);
    let new = names(&left).into_iter().find(|name| !before.contains(name));
    assert!(new.is_none(), "`{new:?}` is a new uniform");
    for target in [Target::Wgsl, Target::Spirv] {
        for stage in stages(&program) {
            if told(write(&program, stage, target, &conventions)).is_some() {
                let after = told(write(&left, stage, target, &conventions));
                assert!(after.is_some(), "{} takes the program, and not what is left of it", target.name());
            }
        }
    }
}
