//! Draws a scene in f32 and f64 side by side and shows the expressions that lose precision, as annotated excerpts.
//!
//! ```sh
//! cargo run --release --example stability -- fixtures/scenes/blinn_phong.toml [--all]
//! ```
//!
//! It shows the ten worst causes; with `--all`, every one.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "an example prints")]

use glisten::scene::{DiskFiles, load};
use glisten::stability::{SpanError, trace};
use glisten_front::diagnostic::write::human;
use glisten_front::{Compiler, Options};
use glisten_reference::RenderOptions;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let all = arguments.iter().any(|argument| argument == "--all");
    let Some(path) = arguments.iter().find(|argument| !argument.starts_with("--")) else {
        eprintln!("usage: stability SCENE [--all]");
        return ExitCode::from(2);
    };
    let loaded = load(path, &DiskFiles, &Compiler::new(Options::default()));
    let Some(scene) = &loaded.scene else {
        eprint!("{}", human(&loaded.sources, loaded.diagnostics.iter(), false));
        return ExitCode::FAILURE;
    };
    let trace = match trace(scene, &RenderOptions::default()) {
        Ok(trace) => trace,
        Err(found) => {
            eprint!("{}", human(&loaded.sources, &found, false));
            return ExitCode::FAILURE;
        }
    };
    let causes: Vec<&SpanError> = trace.spans.iter().filter(|span| span.is_cause()).collect();
    let shown: Vec<_> = causes.iter().take(if all { causes.len() } else { 10 }).map(|span| span.diagnostic()).collect();
    print!("{}", human(&loaded.sources, &shown, false));
    let (found, of) = (causes.len(), trace.spans.len());
    println!("{found} of {of} expressions lose precision; the outputs are up to {:.1e} off", trace.output_error);
    ExitCode::SUCCESS
}
