//! The part of the program that no graphics library concerns: a knot, a pattern, a camera, a file.

use glam::camera::rh::proj::opengl::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use std::error::Error;
use std::f32::consts::TAU;
use std::path::{Path, PathBuf};

/// Pixels each way.
pub const SIZE: u32 = 320;
/// Texels each way of the pattern.
pub const PATTERN: u32 = 64;
/// The color behind the knot.
pub const BACKGROUND: [f32; 4] = [0.03, 0.04, 0.07, 1.0];
/// The lamp, in the space of the eye.
pub const LAMP: [f32; 3] = [2.0, 3.0, 1.0];
/// The light from everywhere.
pub const AMBIENT: [f32; 3] = [0.10, 0.12, 0.18];
/// The exponent of the highlight.
pub const SHININESS: f32 = 60.0;

/// The corners of triangles: position, normal, texture coordinates.
pub type Corner = (Vec3, Vec3, [f32; 2]);

/// From the model to the eye.
pub fn view() -> Mat4 {
    look_at_mat4(Vec3::new(0.5, 2.0, 5.0), Vec3::ZERO, Vec3::Y)
}

/// OpenGL's projection, with depths from -1 to 1.
pub fn projection() -> Mat4 {
    perspective(40f32.to_radians(), 1.0, 0.1, 20.0)
}

/// A tube along a trefoil knot.
pub fn knot() -> Vec<Corner> {
    let path = |t: f32| {
        let (a, r) = (2.0 * t, 1.0 + 0.45 * (3.0 * t).cos());
        Vec3::new(r * a.cos(), r * a.sin(), 0.45 * (3.0 * t).sin())
    };
    let corner = |i: u32, j: u32| {
        let (t, s) = (TAU * i as f32 / 192.0, TAU * j as f32 / 24.0);
        let along = (path(t + 1e-2) - path(t - 1e-2)).normalize();
        let side = along.cross(path(t)).normalize();
        let normal = side * s.cos() + side.cross(along) * s.sin();
        (path(t) + 0.28 * normal, normal, [48.0 * i as f32 / 192.0, 6.0 * j as f32 / 24.0])
    };
    let faces = (0..192).flat_map(|i| (0..24).map(move |j| (i, j)));
    let corners =
        |(i, j): (u32, u32)| [(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)].map(|(x, y)| corner(i + x, j + y));
    faces.flat_map(corners).collect()
}

/// A checker of two colors, RGBA.
pub fn pattern() -> Vec<u8> {
    let half = PATTERN / 2;
    let texel = |i: u32| {
        let is_light = ((i % PATTERN < half) as u8) ^ ((i / PATTERN < half) as u8) == 1;
        if is_light { [232, 200, 140, 255] } else { [186, 72, 38, 255] }
    };
    (0..PATTERN * PATTERN).flat_map(texel).collect()
}

/// Writes pixels, RGBA with the top row first, into the folder that is given as an argument. Returns the file.
pub fn write(name: &str, pixels: &[u8]) -> Result<PathBuf, Box<dyn Error>> {
    let path = std::env::args_os().nth(1).map_or(PathBuf::new(), PathBuf::from).join(name);
    let mut encoder = png::Encoder::new(std::fs::File::create(&path)?, SIZE, SIZE);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(path)
}

/// How many pixels of a picture on disk differ by more than two steps of 8 bits: roundings at edges, if they are few.
pub fn differing(path: &Path, pixels: &[u8]) -> Result<usize, Box<dyn Error>> {
    let mut reader = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path)?)).read_info()?;
    let mut other = vec![0; pixels.len()];
    reader.next_frame(&mut other)?;
    let differs = |(a, b): &(&[u8], &[u8])| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2);
    Ok(pixels.chunks_exact(4).zip(other.chunks_exact(4)).filter(differs).count())
}
