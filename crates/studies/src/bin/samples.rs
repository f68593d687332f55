//! Draws models by a GPU and by the reference, and tells how far the pictures are apart.
//!
//! ```sh
//! cargo run --release -p glisten-studies --bin samples -- FILE.glb|FILE.gltf...
//! ```
//!
//! A row of Markdown for each model: how many draws it has, the layers of its materials, how many notes say what is not drawn, how many
//! pixels it covers away from edges, and of these the mean difference between the pictures in 8-bit colors, and the part that differs by
//! more than one step. A model is drawn as `glisten render MODEL` does it, on the first software adapter of Vulkan.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that prints a table")]

use glisten::library::Embedded;
use glisten::scene::{DiskFiles, Scene, load};
use glisten::{Compiler, Gpu, Picture, Precision, RenderOptions, render};
use glisten_gpu::Via;
use glisten_scene::picture::byte;
use glisten_verify::scene::Draw;
use std::collections::BTreeSet;
use std::path::Path;
use std::process::ExitCode;

/// Names of a material's program, and the layers that have them.
static LAYERS: &[(&str, &str)] = &[
    ("finish.sheen", "sheen"),
    ("finish.anisotropy", "anisotropy"),
    ("finish.film", "iridescence"),
    ("clearcoat_map", "coat by textures"),
    ("clearcoat_normal_map", "normals of the coat"),
    ("dielectric_map", "specular by textures"),
    ("finish.transmission", "transmission"),
    ("places.decal.s", "transforms of textures"),
    ("normal_map", "normals"),
];

fn main() -> ExitCode {
    let models: Vec<String> = std::env::args().skip(1).collect();
    let gpu = match Gpu::new(Some("software")) {
        Ok(gpu) => gpu,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(3);
        }
    };
    println!("| model | draws | layers | notes | pixels | mean | more than a step |");
    println!("| --- | ---: | --- | ---: | ---: | ---: | ---: |");
    let mut code = ExitCode::SUCCESS;
    for model in &models {
        match row(model, &gpu) {
            Ok(row) => println!("{row}"),
            Err(error) => {
                eprintln!("{model}: {error}");
                code = ExitCode::FAILURE;
            }
        }
    }
    code
}

fn row(model: &str, gpu: &Gpu) -> Result<String, String> {
    let loaded = load(model, &DiskFiles, &Compiler::new(Default::default()).with_includes(Embedded));
    let notes = loaded.diagnostics.iter().filter(|found| found.code.id == "W0912").count();
    let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    let scene = loaded.scene.ok_or_else(|| messages.join("; "))?;
    let options = RenderOptions { precision: Precision::F32, ..RenderOptions::default() };
    let reference = render(&scene, &options).map_err(|error| format!("{error:?}"))?;
    let drawn = gpu.render(&scene, Via::Spirv).map_err(|error| error.to_string())?.picture;
    let (pixels, mean, more) = difference(&reference, &drawn);
    let name = Path::new(model).file_stem().unwrap_or_default().to_string_lossy();
    let layers = layers(&scene).into_iter().collect::<Vec<_>>().join(", ");
    Ok(format!(
        "| {name} | {} | {layers} | {notes} | {pixels} | {mean:.4} | {:.3} % |",
        scene.draws.len(),
        more * 100.0
    ))
}

fn layers(scene: &Scene) -> BTreeSet<&'static str> {
    let has = |draw: &Draw, name: &str| {
        let interface = &draw.program.interface;
        interface.uniforms.iter().any(|leaf| leaf.name == name)
            || interface.samplers.iter().any(|slot| slot.name == name)
    };
    let of_draw = |draw| LAYERS.iter().filter(move |(name, _)| has(draw, name)).map(|(_, layer)| *layer);
    scene.draws.iter().flat_map(of_draw).collect()
}

/// The pixels that both cover away from edges, the mean difference of their channels, and the part of them with a channel that is off by
/// more than one step of 8 bits.
fn difference(reference: &Picture, drawn: &Picture) -> (usize, f64, f64) {
    let (mut count, mut sum, mut more) = (0, 0.0, 0);
    let colors =
        reference.attachments.first().into_iter().flatten().zip(drawn.attachments.first().into_iter().flatten());
    let inside = reference.covered.iter().zip(&drawn.covered).zip(&reference.near_edge);
    for ((a, b), ((ours, theirs), edge)) in colors.zip(inside) {
        if !(*ours && *theirs) || *edge {
            continue;
        }
        let off: Vec<f64> = (0..3).map(|k| (f64::from(byte(a[k])) - f64::from(byte(b[k]))).abs()).collect();
        count += 1;
        sum += off.iter().sum::<f64>() / 3.0;
        more += usize::from(off.iter().any(|off| *off > 1.0));
    }
    let n = f64::from(u32::try_from(count.max(1)).unwrap_or(u32::MAX));
    (count, sum / n, f64::from(u32::try_from(more).unwrap_or(u32::MAX)) / n)
}
