//! Compiles `shaders/wave`, which includes a lighting model of the library, to WGSL, and writes the offsets of its
//! uniforms as Rust constants.
//!
//! An error in a shader stops the build with the same excerpt as in `glisten lint`.

use glisten::diagnostic::write::human;
use glisten::emit::{Conventions, Emitted, Target, emit, reflect};
use glisten::library::Embedded;
use glisten::{Compiler, Options, Source, Stage};
use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets OUT_DIR"));
    let sources = [source("shaders/wave.vert", Stage::Vertex), source("shaders/wave.frag", Stage::Fragment)];
    let compilation = Compiler::new(Options::default()).with_includes(Embedded).compile(&sources);
    let Some(program) = &compilation.program else {
        panic!("\n{}", human(&compilation.sources, &compilation.diagnostics, false));
    };
    let conventions = Conventions::default();
    for (stage, name) in [(Stage::Vertex, "wave.vert.wgsl"), (Stage::Fragment, "wave.frag.wgsl")] {
        match emit(program, stage, Target::Wgsl, &conventions) {
            Ok(Emitted::Text(text)) => fs::write(out.join(name), text).expect("OUT_DIR can be written"),
            Ok(Emitted::Words(_)) => unreachable!("WGSL is text"),
            Err(errors) => panic!("\n{}", human(&compilation.sources, &errors, false)),
        }
    }
    let constants: String = reflect(program, &conventions)
        .uniforms
        .iter()
        .map(|uniform| format!("pub const {}: usize = {};\n", uniform.name.to_uppercase(), uniform.offset))
        .collect();
    fs::write(out.join("offsets.rs"), constants).expect("OUT_DIR can be written");
}

fn source(path: &str, stage: Stage) -> Source {
    println!("cargo::rerun-if-changed={path}");
    let text = fs::read_to_string(Path::new(path)).unwrap_or_else(|error| panic!("{path}: {error}"));
    Source { name: path.to_owned(), text: text.into(), stage }
}
