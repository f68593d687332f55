//! Compares a formula with the color at the vertices of a draw, which is drawn as points.

use super::Used;
use super::facts::{Vertex, vector, vertices};
use super::sample::Sample;
use super::tex::Definition;
use glisten::scene::Scene;
use glisten_reference::{RenderOptions, render};
use glisten_verify::scene::{Cull, Draw, Primitive};
use std::collections::BTreeMap;

/// The error that a formula may have: both sides are computed in f64, the library's tables and powers by other ways.
pub(super) const TOLERANCE: f64 = 1e-6;

/// The scene with one draw, and without what hides parts of it.
pub(super) fn alone(scene: &Scene, draw: usize) -> Scene {
    let mut alone = scene.clone();
    alone.draws = vec![scene.draws[draw].clone()];
    let state = &mut alone.draws[0].state;
    (state.cull, state.depth_test) = (Cull::None, false);
    alone
}

/// How near to the rim of a pixel a point is snapped to one pixel or the next, in pixels.
pub(super) const RIM: f64 = 1.0 / 64.0;

/// The vertex that each pixel shows if all are drawn as points in their order. Points near the rim of a pixel may be
/// drawn there or in the next one, so neither counts.
fn by_pixel(scene: &Scene, vertices: &[Vertex]) -> BTreeMap<usize, Option<usize>> {
    let (width, height) = (scene.framebuffer.width, scene.framebuffer.height);
    let mut pixels = BTreeMap::new();
    for (index, vertex) in vertices.iter().enumerate() {
        let inside = vertex.clip.w > 0.0 && vertex.clip.z.abs() <= vertex.clip.w;
        let (x, y) = vertex.window(f64::from(width), f64::from(height));
        if !inside || !(0.0..f64::from(width)).contains(&x) || !(0.0..f64::from(height)).contains(&y) {
            continue;
        }
        let columns = [x - RIM, x + RIM].map(|x| x.floor() as i64);
        let rows = [y - RIM, y + RIM].map(|y| y.floor() as i64);
        let sure = columns[0] == columns[1] && rows[0] == rows[1];
        for (column, row) in columns.iter().flat_map(|column| rows.iter().map(move |row| (*column, *row))) {
            if (0..i64::from(width)).contains(&column) && (0..i64::from(height)).contains(&row) {
                let pixel = (i64::from(height) - 1 - row) * i64::from(width) + column;
                pixels.insert(pixel as usize, sure.then_some(index));
            }
        }
    }
    pixels
}

/// The draw's colors at its vertices, by the vertex's number.
fn colors(scene: &Scene, vertices: &[Vertex]) -> Result<BTreeMap<usize, [f64; 4]>, String> {
    let mut scene = scene.clone();
    let draw = &mut scene.draws[0];
    draw.state.primitive = Primitive::Points;
    (draw.indices, draw.vertex_count) = (None, vertices.len() as u32);
    let picture = render(&scene, &RenderOptions::default()).map_err(|errors| errors[0].message.clone())?;
    let pixels = by_pixel(&scene, vertices);
    let color = |(pixel, vertex): (usize, Option<usize>)| Some((vertex?, picture.attachments[0][pixel]));
    Ok(pixels.into_iter().filter_map(color).collect())
}

fn faces_the_eye(draw: &Draw, vertex: &Vertex) -> bool {
    vector(draw, "eye").is_none_or(|eye| vertex.normal.dot(eye - vertex.place) > 0.0)
}

/// Says where two colors differ.
pub(super) fn same(found: &[f64], wanted: &[f64], place: &str) -> Result<(), String> {
    let error = found.iter().zip(wanted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let size = wanted.iter().fold(1.0, |size: f64, channel| size.max(channel.abs()));
    if error <= TOLERANCE * size {
        return Ok(());
    }
    Err(format!("{place}: the picture has {found:.6?}, the formula gives {wanted:.6?}"))
}

/// Compares the colors of a draw; returns how many.
pub(super) fn compare(scene: &Scene, draw: usize, printed: &[Definition], used: &Used) -> Result<usize, String> {
    let scene = alone(scene, draw);
    let draw = &scene.draws[0];
    let vertices = vertices(draw);
    let mut samples = 0;
    for (index, color) in colors(&scene, &vertices)? {
        let vertex = &vertices[index];
        if !faces_the_eye(draw, vertex) {
            continue;
        }
        let sample = Sample::new(draw, (printed, used), (vertex.place, vertex.normal), &|_| None);
        same(&color[..3], &sample.color()?, &format!("vertex {index}"))?;
        samples += 1;
    }
    Ok(samples)
}
