//! The time of the executor for the Blinn-Phong sphere of the report, in nanoseconds per fragment and domain, and of
//! the whole draw (64 x 32 mesh, 512 x 512 pixels, shading and rasterization) in milliseconds.
//!
//! `cargo bench --no-default-features --features reference --bench exec`

use divan::Bencher;
use glisten::scene::{DiskFiles, FileError, FileSource, Scene};
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options};
use glisten_reference::domain::{Domain, Envelope, F32, F64, Number};
use glisten_reference::exec::{Code, LANES, Machine, Mask};
use glisten_reference::{Precision, RenderOptions};

fn main() {
    divan::main();
}

/// The report's sphere at the size of the goal, shaded with Blinn-Phong.
struct Sphere;

impl FileSource for Sphere {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let bytes = DiskFiles.read(path)?;
        if !path.ends_with("sphere.toml") {
            return Ok(bytes);
        }
        let text = String::from_utf8_lossy(&bytes)
            .replace("width = 256", "width = 512")
            .replace("height = 256", "height = 512")
            .replace("vertex = \"../programs/phong.vert\"", "vertex = \"../programs/blinn_phong.vert\"")
            .replace("fragment = \"../programs/phong.frag\"", "fragment = \"../programs/blinn_phong.frag\"")
            .replace("shape = \"sphere\"", "shape = \"sphere\"\nsegments = 64\nrings = 32");
        Ok(text.into_bytes())
    }
}

fn sphere() -> Scene {
    let loaded = glisten::scene::load("fixtures/scenes/sphere.toml", &Sphere, &Compiler::new(Options::default()));
    let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    loaded.scene.unwrap_or_else(|| panic!("{messages:?}"))
}

/// One tile of fragments: 64 invocations of the fragment stage.
#[divan::bench(types = [F64, F32, Envelope])]
fn tile<D: Domain>(bencher: Bencher<'_, '_>) {
    let scene = sphere();
    let draw = &scene.draws[0];
    let code = Code::compile(&draw.program, Stage::Fragment).expect("the executor runs it");
    let mut machine = Machine::<D>::new(&code, &draw.uniforms, &draw.textures);
    let shader = draw.program.stage(Stage::Fragment).expect("there is a fragment stage");
    for (id, global) in shader.globals() {
        for flat in 0..3 {
            if let Some(lanes) = machine.float_input(id, flat) {
                let base = if global.name == "ve" { [0.1, 0.2, -3.0] } else { [0.2, 0.3, 0.9] };
                (0..LANES)
                    .for_each(|lane| lanes.set(lane, D::Float::from_f64(base[flat as usize] + lane as f64 * 1e-3)));
            }
        }
    }
    bencher.counter(divan::counter::ItemsCount::new(LANES)).bench_local(|| machine.run(Mask::ALL, Mask::NONE));
}

/// The whole draw.
#[divan::bench(args = ["f64", "f32", "envelope"], sample_count = 20)]
fn draw(bencher: Bencher<'_, '_>, precision: &str) {
    let scene = sphere();
    let precision = match precision {
        "f64" => Precision::F64,
        "f32" => Precision::F32,
        _ => Precision::Envelope,
    };
    let options = RenderOptions { precision, mark_edges: false, ..RenderOptions::default() };
    bencher.bench_local(|| glisten_reference::render(&scene, &options));
}
