//! The GPU compared with the CPU reference on scenes, and the message on a machine without a driver.
//! These tests need a Vulkan software adapter and fail loudly without one.

use crate::drawing::{complaint, from_disk, from_texts, gpu, reference, strict};
use crate::support::root;
use glisten::scene::Scene;
use glisten_gpu::{Gpu, Via};
use glisten_reference::Precision;
use std::path::PathBuf;
use std::process::Command;

fn scene_files() -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = std::fs::read_dir(root().join("fixtures/scenes"))
        .expect("the folder of scenes")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    files.sort();
    assert!(!files.is_empty(), "there are scenes");
    files
}

#[test]
fn the_textbook_programs_agree_with_the_reference_at_their_full_size() {
    let gpu = gpu();
    let complaints = scene_files().into_iter().filter_map(|path| {
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        complaint(&name, &gpu, &from_disk(&path), &strict())
    });
    let wrong: Vec<String> = complaints.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

const VERTEX: &str =
    "#version 150\nin vec4 pv;\nin vec4 cv;\nflat out vec4 vc;\nvoid main() { vc = cv; gl_Position = pv; }\n";
const FRAGMENT: &str = "#version 150\nflat in vec4 vc;\nout vec4 fc;\nvoid main() { fc = vc; }\n";

/// A flat triangle, or two from a strip or fan, whose vertices are red, green, blue and white, starting at vertex
/// `first`.
fn flat_scene(primitive: &str, vertices: usize, first: usize) -> Scene {
    let corners = [[-0.9, -0.9], [0.9, -0.9], [0.0, 0.9], [0.9, 0.8]];
    let colors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
    let list = |rows: Vec<Vec<f64>>| format!("{:?}", rows.concat());
    let turn = |index: usize| (index + first) % vertices;
    let positions = list((0..vertices).map(|index| corners[turn(index)].to_vec()).collect());
    let tints = list((0..vertices).map(|index| colors[turn(index)].to_vec()).collect());
    let text = format!(
        "[framebuffer]\nwidth = 32\nheight = 32\n[[draw]]\nvertex = \"f.vert\"\nfragment = \"f.frag\"\n\
         primitive = \"{primitive}\"\n[draw.attributes]\npv = {{ size = 2, values = {positions} }}\n\
         cv = {{ size = 3, values = {tints} }}\n"
    );
    from_texts([("f.toml", text.as_str()), ("f.vert", VERTEX), ("f.frag", FRAGMENT)])
}

#[test]
fn rotating_a_flat_triangle_changes_its_color_as_opengl_says() {
    let gpu = gpu();
    let center = 20 * 32 + 16;
    let colors = [[1.0, 0.0, 0.0, 1.0], [0.0, 1.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]];
    for first in 0..3 {
        let scene = flat_scene("triangles", 3, first);
        // The last vertex provokes: in the order 0 1 2 it is 2, in 1 2 0 it is 0, in 2 0 1 it is 1.
        let wanted = colors[(first + 2) % 3];
        let pictures = [
            gpu.render(&scene, Via::Spirv).expect("it draws").picture,
            gpu.render(&scene, Via::Wgsl).expect("it draws").picture,
            reference(&scene, Precision::Envelope),
        ];
        for picture in &pictures {
            assert_eq!(picture.attachments[0][center], wanted, "begun at vertex {first}");
        }
    }
}

#[test]
fn strips_and_fans_provoke_by_their_last_vertex_on_both_backends() {
    let gpu = gpu();
    for primitive in ["triangle_strip", "triangle_fan", "line_strip", "line_loop"] {
        let scene = flat_scene(primitive, 4, 0);
        let reference = reference(&scene, Precision::Envelope);
        let picture = gpu.render(&scene, Via::Spirv).expect("it draws").picture;
        let both = |index: &usize| picture.covered[*index] && reference.covered[*index];
        let differing: Vec<usize> = (0..picture.covered.len())
            .filter(both)
            .filter(|&index| picture.attachments[0][index] != reference.attachments[0][index])
            .collect();
        // Where lines cross at a corner, the picture depends on which pixel is covered; nothing else may differ.
        assert!(differing.len() <= 4, "{primitive}: {differing:?}");
        assert!((0..picture.covered.len()).any(|index| both(&index)), "{primitive}: something is drawn");
    }
}

#[cfg(feature = "cli")]
#[test]
fn a_machine_without_a_driver_is_told_what_to_install() {
    let scene = root().join("fixtures/scenes/triangle.toml");
    let output = tempfile::tempdir().expect("a temporary folder");
    let run = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["render", "--backend", "gpu"])
        .arg(&scene)
        .arg("-o")
        .arg(output.path().join("out.npy"))
        // With these variables, Vulkan's loader finds no driver.
        .env("VK_ICD_FILENAMES", "/nonexistent.json")
        .env("VK_DRIVER_FILES", "/nonexistent.json")
        .output()
        .expect("the program runs");
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(3), "{told}");
    assert!(told.contains("apt-get install mesa-vulkan-drivers"), "{told}");
    assert!(!output.path().join("out.npy").exists());
}

#[test]
fn an_unknown_adapter_is_told_which_there_are() {
    let Err(error) = Gpu::new(Some("no such adapter")) else { panic!("there is no adapter of this name") };
    assert!(error.is_environment());
    let message = error.to_string();
    assert!(message.contains("no such adapter") && message.contains("llvmpipe"), "{message}");
}
