//! A test suite of your own that draws your scenes on a GPU and lets glisten judge the pictures.
//!
//! `cargo run --example verify -- SCENE.toml...` verifies each scene on the first software adapter of Vulkan; without
//! arguments, a few of this repository's. It exits with 1 if a picture is wrong, and leaves the pictures in
//! `target/failures`. In a `#[test]` the last lines are `assert!(verification.holds(), "{verification}")`.

#![expect(clippy::print_stdout, reason = "an example prints")]

use glisten::scene::{DiskFiles, load};
use glisten::verify::{OnGpu, Options, Runner, verify};
use glisten::{Compiler, Gpu};
use std::path::Path;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn std::error::Error>> {
    let mut scenes: Vec<String> = std::env::args().skip(1).collect();
    if scenes.is_empty() {
        let own = ["triangle", "phong", "sphere"];
        scenes = own.map(|name| format!("{}/fixtures/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"))).to_vec();
    }
    let gpu = Gpu::new(Some("software"))?;
    let runners = OnGpu::both(&gpu);
    let runners = [&runners[0] as &dyn Runner, &runners[1]];
    let mut all_hold = true;
    for path in &scenes {
        let loaded = load(path, &DiskFiles, &Compiler::new(Default::default()));
        let Some(scene) = loaded.scene else {
            let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
            return Err(format!("{path}: {}", messages.join("; ")).into());
        };
        let name = Path::new(path).file_stem().unwrap_or_default();
        let folder = Path::new("target/failures").join(name);
        let options = Options { sources: Some(&loaded.sources), failures: Some(&folder), ..Options::default() };
        let verification = verify(&scene, &runners, &options)?;
        print!("{path}\n{verification}");
        all_hold &= verification.holds();
    }
    Ok(if all_hold { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
