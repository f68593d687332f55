//! The mesh of a unit sphere.

use super::shaders::lit::Vertex;
use std::f32::consts::PI;

/// Triangles of a sphere, counterclockwise from outside.
pub(crate) fn sphere(segments: u32, rings: u32) -> Vec<Vertex> {
    let vertex = |segment: u32, ring: u32| {
        let (around, down) = (2.0 * PI * segment as f32 / segments as f32, PI * ring as f32 / rings as f32);
        let place = [down.sin() * around.sin(), down.cos(), down.sin() * around.cos()];
        Vertex { position: place, normal: place }
    };
    let mut vertices = Vec::new();
    for (segment, ring) in (0..segments).flat_map(|segment| (0..rings).map(move |ring| (segment, ring))) {
        let corners = [(0, 0), (0, 1), (1, 1), (1, 0)].map(|(s, r)| vertex(segment + s, ring + r));
        vertices.extend([0, 1, 2, 0, 2, 3].map(|corner: usize| corners[corner]));
    }
    vertices
}
