//! The cost of emission: lowering alone, and from GLSL text to WGSL text and to SPIR-V words, over the programs of
//! the fixtures. `cargo bench --bench emit`; figures are means per program (a vertex and a fragment shader).
//!
//! The goal is relative to libglslang 12, which takes about 575 us per shader from GLSL to SPIR-V on the machine that
//! the front end's benchmarks name: at most 0.6 of that, and 0.35 if possible.

use divan::{Bencher, black_box};
use glisten::{Compiler, Options, Source};
use glisten_emit::{Conventions, Target, emit};
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use std::fs;
use std::path::Path;

fn main() {
    divan::main();
}

/// The pairs of shaders in those folders of the fixtures that contain whole programs.
fn pairs() -> Vec<Vec<Source>> {
    let mut pairs = Vec::new();
    for folder in ["programs", "lower"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures").join(folder);
        let entries = fs::read_dir(folder).expect("the fixtures are there");
        let mut vertex: Vec<_> = entries.map(|entry| entry.expect("a folder entry").path()).collect();
        vertex.retain(|path| path.extension().is_some_and(|extension| extension == "vert"));
        vertex.sort();
        for path in vertex {
            let source = |extension, stage| {
                let path = path.with_extension(extension);
                let text = fs::read_to_string(&path).expect("a fixture can be read");
                Source { name: path.display().to_string(), text: text.into(), stage }
            };
            pairs.push(vec![source("vert", Stage::Vertex), source("frag", Stage::Fragment)]);
        }
    }
    pairs
}

fn programs() -> Vec<Program> {
    let compiler = Compiler::new(Options::default());
    pairs().iter().map(|pair| compiler.compile(pair).program.expect("the fixtures are programs")).collect()
}

fn all_stages(programs: &[Program], mut each: impl FnMut(&Program, Stage)) {
    for program in programs {
        for shader in &program.stages {
            each(program, shader.stage);
        }
    }
}

#[divan::bench]
fn lowering_alone(bencher: Bencher<'_, '_>) {
    let programs = programs();
    let conventions = Conventions::default();
    bencher.bench(|| {
        all_stages(&programs, |program, stage| {
            black_box(glisten_emit::lower_alone(program, stage, Target::Wgsl, &conventions).is_ok());
        });
    });
}

#[divan::bench(args = ["wgsl", "spirv"])]
fn emission(bencher: Bencher<'_, '_>, target: &str) {
    let target = if target == "wgsl" { Target::Wgsl } else { Target::Spirv };
    let programs = programs();
    let conventions = Conventions::default();
    bencher.bench(|| {
        all_stages(&programs, |program, stage| {
            black_box(emit(program, stage, target, &conventions).is_ok());
        });
    });
}

#[divan::bench]
fn glsl_text_to_wgsl_text(bencher: Bencher<'_, '_>) {
    let pairs = pairs();
    let compiler = Compiler::new(Options::default());
    let conventions = Conventions::default();
    bencher.bench(|| {
        for pair in &pairs {
            let program = compiler.compile(pair).program.expect("the fixtures are programs");
            all_stages(std::slice::from_ref(&program), |program, stage| {
                black_box(emit(program, stage, Target::Wgsl, &conventions).is_ok());
            });
        }
    });
}
