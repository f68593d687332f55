//! Compares a formula of interpolation with what is drawn in single triangles of a mesh.

use super::Used;
use super::facts::{Vertex, uniform, vertices};
use super::points::{alone, same};
use super::sample::Sample;
use super::tex::{Definition, Value};
use glam::{DVec2, DVec3};
use glisten::scene::Scene;
use glisten_reference::{RenderOptions, render};
use glisten_verify::scene::Draw;

/// A fragment shader that shows the coordinates that reach it.
pub(super) const COORDINATES: &str = "#version 150\n#ifndef INTERPOLATION\n#define INTERPOLATION smooth\n#endif\n\
    INTERPOLATION in vec2 st;\nout vec4 color;\nvoid main() { color = vec4(st, 0.0, 1.0); }\n";

/// How many triangles are drawn.
const TRIANGLES: usize = 24;

/// A fragment of a triangle: its coordinates (105) in window space.
struct Fragment<'a> {
    corners: [&'a Vertex; 3],
    colors: [[f64; 3]; 3],
    uv: DVec2,
}

impl Fragment<'_> {
    fn symbol(&self, name: &str) -> Option<Value> {
        if let Some((letter, corner)) = name.split_once('_')
            && let Some(corner) = corner.parse::<usize>().ok().filter(|corner| *corner < 3)
        {
            let vertex = self.corners[corner];
            return match letter {
                "w" => Some(Value::Number(vertex.clip.w)),
                "C" => Some(Value::Vector(self.colors[corner])),
                "N" => Some(Value::Vector(vertex.normal.to_array())),
                "P" => Some(Value::Vector(vertex.place.to_array())),
                _ => None,
            };
        }
        match name {
            "u" => Some(Value::Number(self.uv.x)),
            "v" => Some(Value::Number(self.uv.y)),
            _ => None,
        }
    }
}

/// The coordinates of a point in a triangle (105).
fn coordinates(point: DVec2, corners: [DVec2; 3]) -> DVec2 {
    let (u, v, p) = (corners[1] - corners[0], corners[2] - corners[0], point - corners[0]);
    DVec2::new(p.perp_dot(v), u.perp_dot(p)) / u.perp_dot(v)
}

/// The color that a vertex hands on: what the documents say of the scene's lights, or the attribute.
fn at_vertex(draw: &Draw, vertex: &Vertex) -> Result<[f64; 3], String> {
    if uniform(draw, "material.diffuse").is_none() {
        return Ok(vertex.attribute.to_array());
    }
    Sample::new(draw, (&[], &Used::default()), (vertex.place, vertex.normal), &|_| None).color()
}

/// Compares a fragment with the color that is drawn.
type Comparison<'a> = &'a mut dyn FnMut(&Scene, &Fragment<'_>, &[f64; 4]) -> Result<(), String>;

/// Draws some triangles one by one and calls `compare` for fragments inside; returns how many there were.
fn each_fragment(scene: &Scene, draw: usize, compare: Comparison<'_>) -> Result<usize, String> {
    let mut scene = alone(scene, draw);
    let all = vertices(&scene.draws[0]);
    let count = scene.draws[0].vertex_count;
    let indices = scene.draws[0].indices.clone().unwrap_or_else(|| (0..count).collect());
    let triangles: Vec<&[u32]> = indices.chunks_exact(3).collect();
    let (width, height) = (scene.framebuffer.width, scene.framebuffer.height);
    let mut samples = 0;
    for triangle in triangles.iter().step_by(triangles.len().div_ceil(TRIANGLES)) {
        let corners: [&Vertex; 3] = std::array::from_fn(|corner| &all[triangle[corner] as usize]);
        let window = corners.map(|corner| DVec2::from(corner.window(f64::from(width), f64::from(height))));
        let area = (window[1] - window[0]).perp_dot(window[2] - window[0]);
        // A triangle that is seen from the front, and of which no vertex is behind the eye.
        if area < 20.0 || corners.iter().any(|corner| corner.clip.w <= 0.0) {
            continue;
        }
        let mut colors = [[0.0; 3]; 3];
        for (color, corner) in colors.iter_mut().zip(corners) {
            *color = at_vertex(&scene.draws[0], corner)?;
        }
        let one = &mut scene.draws[0];
        (one.indices, one.vertex_count) = (Some(triangle.to_vec()), 3);
        let picture = render(&scene, &RenderOptions::default()).map_err(|errors| errors[0].message.clone())?;
        for (pixel, covered) in picture.covered.iter().enumerate().filter(|(pixel, _)| pixel % 3 == 0) {
            if *covered && !picture.near_edge[pixel] {
                let (x, row) = (pixel % width as usize, pixel / width as usize);
                let center = DVec2::new(x as f64 + 0.5, f64::from(height) - row as f64 - 0.5);
                let fragment = Fragment { corners, colors, uv: coordinates(center, window) };
                compare(&scene, &fragment, &picture.attachments[0][pixel])?;
                samples += 1;
            }
        }
    }
    Ok(samples)
}

/// The color of a fragment. Where a normal is printed, it is shaded there; else the color of the vertices is `C`.
pub(super) fn compare_colors(scene: &Scene, draw: usize, printed: &[Definition], used: &Used) -> Result<usize, String> {
    let shaded = printed.iter().any(|definition| definition.name == "N");
    each_fragment(scene, draw, &mut |scene, fragment, color| {
        let draw = &scene.draws[0];
        let more = |name: &str| fragment.symbol(name);
        let sample = Sample::new(draw, (printed, used), (DVec3::ZERO, DVec3::Z), &more);
        let wanted = if shaded && uniform(draw, "material.diffuse").is_some() {
            let place = point(&sample, "P")?;
            let normal = point(&sample, "N")?;
            Sample::new(draw, (&without(printed), used), (place, normal), &more).color()?
        } else {
            point(&sample, "C")?.to_array()
        };
        same(&color[..3], &wanted, &format!("(u, v) = {}", fragment.uv))
    })
}

/// The definitions of colors: those of the point itself have been evaluated.
fn without(printed: &[Definition]) -> Vec<Definition> {
    printed.iter().filter(|definition| !["N", "P", "M"].contains(&definition.name.as_str())).cloned().collect()
}

fn point(sample: &Sample<'_>, name: &str) -> Result<DVec3, String> {
    match super::tex::Values::symbol(sample, name)? {
        Value::Vector(vector) => Ok(DVec3::from_array(vector)),
        Value::Number(_) => Err(format!("`{name}` is a number")),
    }
}

/// The texture coordinates that reach a fragment.
pub(super) fn compare_coordinates(
    scene: &Scene,
    draw: usize,
    printed: &[Definition],
    used: &Used,
) -> Result<usize, String> {
    each_fragment(scene, draw, &mut |scene, fragment, color| {
        let attributes = fragment.corners.map(|corner| corner.attribute.to_array());
        let fragment = Fragment { colors: attributes, ..*fragment };
        let more = |name: &str| fragment.symbol(name);
        let sample = Sample::new(&scene.draws[0], (printed, used), (DVec3::ZERO, DVec3::Z), &more);
        same(&color[..2], &point(&sample, "C")?.to_array()[..2], &format!("(u, v) = {}", fragment.uv))
    })
}
