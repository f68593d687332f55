//! Checks shaders and prints the diagnostics as SARIF, like a step of continuous integration.
//!
//! ```sh
//! cargo run --no-default-features --example lint_sarif -- a.vert a.frag > results.sarif
//! ```
//!
//! The library does no I/O: this program reads the files and prints the result.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use glisten_front::diagnostic::write::{findings, sarif};
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options, Source};
use std::process::ExitCode;

fn stage_of(name: &str) -> Option<Stage> {
    match name.rsplit_once('.')?.1 {
        "vert" => Some(Stage::Vertex),
        "geom" => Some(Stage::Geometry),
        "frag" => Some(Stage::Fragment),
        _ => None,
    }
}

fn main() -> ExitCode {
    let mut sources = Vec::new();
    for name in std::env::args().skip(1) {
        let Some(stage) = stage_of(&name) else {
            eprintln!("{name}: neither .vert nor .geom nor .frag");
            return ExitCode::from(2);
        };
        match std::fs::read_to_string(&name) {
            Ok(text) => sources.push(Source { name, text: text.into(), stage }),
            Err(error) => {
                eprintln!("{name}: {error}");
                return ExitCode::from(2);
            }
        }
    }
    let compilation = Compiler::new(Options::default()).compile(&sources);
    println!("{}", sarif(&findings(&compilation.sources, &compilation.diagnostics), None));
    ExitCode::from(u8::from(compilation.diagnostics.has_errors()))
}
