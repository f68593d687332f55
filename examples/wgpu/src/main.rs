//! A host for wgpu without a window: it draws a lit sphere by the module that `build.rs` made, and compares the picture with
//! glisten's CPU reference.
//!
//! *In:* nothing. *Out:* `lit.ppm` in the folder that is given as an argument, and the largest difference. *Holds:* no number of
//! a binding, an offset or a location is in this file.

#![expect(clippy::print_stdout, reason = "a program prints")]

/// The shaders, as `glisten::build` wrote them.
mod shaders {
    include!(concat!(env!("OUT_DIR"), "/shaders.rs"));
}

mod draw;
mod mesh;

use glam::camera::rh::proj::opengl::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat3, Vec3};
use glisten::scene::DiskFiles;
use glisten::{Compiler, Options, Precision, RenderOptions};
use shaders::lit;
use std::error::Error;
use std::path::Path;

/// Pixels each way.
const SIZE: u32 = 128;
/// The largest difference from the reference that rounding in f32 explains; the picture has 8 bits.
const TOLERANCE: f64 = 1.01 / 255.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args().nth(1).unwrap_or_else(|| ".".into());
    let (uniforms, light) = uniforms();
    let picture = pollster::block_on(draw::draw(&mesh::sphere(128, 64), &uniforms, &light))?;
    let file = Path::new(&folder).join("lit.ppm");
    let rgb: Vec<u8> = picture.chunks_exact(4).flat_map(|pixel| pixel[..3].to_vec()).collect();
    std::fs::write(&file, [format!("P6 {SIZE} {SIZE} 255\n").as_bytes(), &rgb].concat())?;
    let (compared, largest) = compare(&picture)?;
    println!("wrote {}", file.display());
    println!("largest difference from the reference: {:.1}/255 over {compared} pixels", 255.0 * largest);
    if compared < 4000 || largest > TOLERANCE {
        return Err("the picture is not that of the reference".into());
    }
    Ok(())
}

/// The values of the uniforms: those of `lit.toml`.
fn uniforms() -> (lit::Uniforms, lit::Light) {
    let view = look_at_mat4(Vec3::new(0.0, 1.0, 3.0), Vec3::ZERO, Vec3::Y);
    // The program expects OpenGL's clip space; glisten's code converts it.
    let projection = perspective(40f32.to_radians(), 1.0, 1.0, 10.0);
    let mut uniforms = lit::Uniforms::new();
    uniforms.set_model_view_projection(projection * view).set_model_view(view).set_normal_matrix(Mat3::from_mat4(view));
    let mut light = lit::Light::new();
    light.set_toward(Vec3::new(0.6, 0.64, 0.48)).set_shininess(40.0).set_color([1.0, 0.95, 0.9]);
    (uniforms, light)
}

/// How many pixels both pictures cover away from edges, and their largest difference.
fn compare(picture: &[u8]) -> Result<(usize, f64), Box<dyn Error>> {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/lit.toml");
    let compiler = Compiler::new(Options::default()).with_includes(glisten::library::Embedded);
    let scene = glisten::scene::load(file, &DiskFiles, &compiler).scene.ok_or("the scene does not load")?;
    let options = RenderOptions { precision: Precision::F64, ..RenderOptions::default() };
    let reference = glisten::render(&scene, &options).map_err(|_| "the reference does not draw the scene")?;
    let (mut compared, mut largest) = (0, 0f64);
    for (index, (pixel, truth)) in picture.chunks_exact(4).zip(&reference.attachments[0]).enumerate() {
        if !reference.covered[index] || reference.near_edge[index] {
            continue;
        }
        compared += 1;
        for (byte, truth) in pixel.iter().take(3).zip(truth) {
            largest = largest.max((f64::from(*byte) / 255.0 - truth.clamp(0.0, 1.0)).abs());
        }
    }
    Ok((compared, largest))
}
