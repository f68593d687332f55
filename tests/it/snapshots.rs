//! The results for the fixtures as reviewed snapshots: WGSL, reflection, rendered diagnostics.
//!
//! `cargo insta review` shows what changed.

use crate::support::compiler;
use glisten_emit::{Conventions, Emitted, Target, emit, reflect};
use glisten_front::diagnostic::write::human;
use glisten_front::hir::Stage;
use glisten_front::{Compilation, Source};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Compiles the program of a vertex shader and the fragment shader next to it.
fn compile(vertex: &Path) -> Compilation {
    let source = |path: &Path, stage| {
        let name = path.file_name().expect("a file").to_string_lossy().into_owned();
        Source { name, text: fs::read_to_string(path).expect("readable").into(), stage }
    };
    let sources = [source(vertex, Stage::Vertex), source(&vertex.with_extension("frag"), Stage::Fragment)];
    compiler().compile(&sources)
}

fn wgsl(compilation: &Compilation) -> String {
    let program = compilation.program.as_ref().expect("the fixture has no errors");
    let mut text = String::new();
    for shader in &program.stages {
        match emit(program, shader.stage, Target::Wgsl, &Conventions::default()) {
            Ok(Emitted::Text(stage)) => writeln!(text, "// {}\n{stage}", shader.stage.name()).expect("strings grow"),
            Ok(Emitted::Words(_)) => panic!("WGSL is text"),
            Err(errors) => panic!("{}", human(&compilation.sources, &errors, false)),
        }
    }
    text
}

#[test]
fn programs_to_wgsl() {
    insta::glob!("../../fixtures/programs", "*.vert", |path| {
        insta::assert_snapshot!("wgsl", wgsl(&compile(path)));
    });
}

/// The output of `spirv-dis` for each stage; `None` if the tool is missing, which is a failure in CI.
fn disassembled(compilation: &Compilation) -> Option<String> {
    let program = compilation.program.as_ref().expect("the fixture has no errors");
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut text = String::new();
    for shader in &program.stages {
        let emitted = emit(program, shader.stage, Target::Spirv, &Conventions::default());
        let words = folder.path().join("words.spv");
        fs::write(&words, emitted.expect("SPIR-V comes out").into_bytes()).expect("written");
        // The header names the version of naga and the bound of the ids, neither of which depends only on the
        // program.
        let Ok(output) = Command::new("spirv-dis").args(["--no-color", "--no-header"]).arg(&words).output() else {
            crate::emit::missing("spirv-dis", "Debian has it in the package spirv-tools");
            return None;
        };
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let stage = shader.stage.name();
        writeln!(text, "; {stage}\n{}", String::from_utf8_lossy(&output.stdout)).expect("strings grow");
    }
    Some(text)
}

#[test]
fn programs_to_spirv() {
    insta::glob!("../../fixtures/programs", "{flat,phong,triangle}.vert", |path| {
        if let Some(text) = disassembled(&compile(path)) {
            insta::assert_snapshot!("spirv", text);
        }
    });
}

/// Readable output for every construct that the lowering has to rewrite.
#[test]
fn rewritten_programs_to_wgsl() {
    insta::glob!("../../fixtures/lower", "{discard,host,parameters,statements,switches}.vert", |path| {
        insta::assert_snapshot!("wgsl_lower", wgsl(&compile(path)));
    });
}

#[test]
fn programs_to_reflections() {
    insta::glob!("../../fixtures/programs", "*.vert", |path| {
        let compilation = compile(path);
        let program = compilation.program.as_ref().expect("the fixture has no errors");
        insta::assert_json_snapshot!("reflection", reflect(program, &Conventions::default()));
    });
}

#[test]
fn mistakes_for_people() {
    insta::glob!("../../fixtures/readme", "*.vert", |path| {
        let compilation = compile(path);
        insta::assert_snapshot!("human", human(&compilation.sources, &compilation.diagnostics, false));
    });
}
