//! Shapes by name: grids of vertices mapped to a surface, with exact normals.

use crate::geometry::Geometry;
use crate::tables::Reader;
use std::f64::consts::TAU;
use toml::de::DeTable;

/// A shape that a scene may name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// `radius`, `segments` around the y axis, `rings` from pole to pole.
    Sphere,
    /// `radius` of the ring, `minor_radius` of the tube, `segments` around the axis, `rings` around the tube.
    Torus,
    /// A square of side `size` in the xy plane that faces +z.
    Quad,
    /// A square of side `size` in the xz plane that faces +y, `segments` by `rings` squares.
    Plane,
    /// Edges `size` long, flat normals.
    Cube,
    /// `radius`, `height`, around the y axis, without caps.
    Cylinder,
    /// `radius`, `height`, around the y axis, without its base.
    Cone,
    /// A tube of radius `tube` along a curve on the torus of `radius` and `minor_radius`. The curve goes `turns[0]`
    /// times around the axis and `turns[1]` times around the tube of the torus; `segments` along, `rings` around the
    /// tube.
    TorusKnot,
}

impl Shape {
    /// The keys of its sizes.
    pub(super) fn keys(self) -> &'static [&'static str] {
        match self {
            Self::Sphere => &["radius"],
            Self::Torus => &["radius", "minor_radius"],
            Self::Quad | Self::Plane | Self::Cube => &["size"],
            Self::Cylinder | Self::Cone => &["radius", "height"],
            Self::TorusKnot => &["radius", "minor_radius", "tube", "turns"],
        }
    }

    /// Segments and rings, if the scene does not say.
    pub(super) fn default_tessellation(self) -> [u32; 2] {
        match self {
            Self::Quad | Self::Plane | Self::Cube => [1, 1],
            Self::Sphere | Self::Torus => [64, 32],
            Self::Cylinder | Self::Cone => [64, 1],
            Self::TorusKnot => [192, 24],
        }
    }
}

/// The vertices and triangles of a shape.
pub(super) fn build(reader: &mut Reader, table: &DeTable<'_>, shape: Shape) -> Geometry {
    let radius = reader.real(table, "radius", 1.0);
    let minor_radius = reader.real(table, "minor_radius", radius / 2.0);
    let size = reader.real(table, "size", 2.0);
    let height = reader.real(table, "height", 2.0);
    let is_flat = matches!(shape, Shape::Quad | Shape::Plane | Shape::Cube);
    let [segments, rings] = shape.default_tessellation();
    let turns = reader.reals(table, "turns", [2.0, 3.0]);
    let tube = reader.real(table, "tube", radius / 5.0);
    let least = if is_flat { 1 } else { 3 };
    let segments = reader.count(table, "segments", segments, least..=4096);
    let rings = reader.count(table, "rings", rings, 1..=4096);
    let half = size / 2.0;
    match shape {
        Shape::Sphere => grid(segments, rings, |s, t| sphere(radius, s, t)),
        Shape::Torus => grid(segments, rings, |s, t| torus(radius, minor_radius, s, t)),
        Shape::Quad => {
            grid(segments, rings, |s, t| ([(s * 2.0 - 1.0) * half, (t * 2.0 - 1.0) * half, 0.0], [0.0, 0.0, 1.0]))
        }
        Shape::Plane => {
            grid(segments, rings, |s, t| ([(s * 2.0 - 1.0) * half, 0.0, (1.0 - t * 2.0) * half], [0.0, 1.0, 0.0]))
        }
        Shape::Cube => cube(segments, rings, half),
        Shape::Cylinder => grid(segments, rings, |s, t| frustum(radius, radius, height, s, t)),
        Shape::Cone => grid(segments, rings, |s, t| frustum(radius, 0.0, height, s, t)),
        Shape::TorusKnot => grid(segments, rings, |s, t| torus_knot([radius, minor_radius, tube], turns, s, t)),
    }
}

/// A grid of `columns` by `rows` squares over (s, t) in [0, 1]², two triangles each, counterclockwise if s points
/// right and t up.
fn grid(columns: u32, rows: u32, surface: impl Fn(f64, f64) -> ([f64; 3], [f64; 3])) -> Geometry {
    let mut geometry = Geometry::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let (s, t) = (f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            let (position, normal) = surface(s, t);
            geometry.positions.push(position);
            geometry.normals.push(normal);
            geometry.texcoords.push([s, t]);
        }
    }
    let stride = columns + 1;
    for row in 0..rows {
        for column in 0..columns {
            let corner = row * stride + column;
            geometry.indices.extend([corner, corner + 1, corner + stride + 1]);
            geometry.indices.extend([corner, corner + stride + 1, corner + stride]);
        }
    }
    geometry
}

/// The sine and cosine of `turns` full turns, exact at the quarters, so that seams and poles close.
fn circle(turns: f64) -> (f64, f64) {
    let quarters = turns * 4.0;
    if quarters == quarters.round() {
        return match quarters.rem_euclid(4.0) as u32 {
            0 => (0.0, 1.0),
            1 => (1.0, 0.0),
            2 => (0.0, -1.0),
            _ => (-1.0, 0.0),
        };
    }
    (turns * TAU).sin_cos()
}

/// t = 0 is the south pole; s = 0 faces +z, and s increases eastwards.
fn sphere(radius: f64, s: f64, t: f64) -> ([f64; 3], [f64; 3]) {
    let (sin_s, cos_s) = circle(s);
    let (sin_t, cos_t) = circle(t / 2.0);
    let normal = [sin_t * sin_s, -cos_t, sin_t * cos_s];
    (normal.map(|value| value * radius), normal)
}

fn torus(radius: f64, minor_radius: f64, s: f64, t: f64) -> ([f64; 3], [f64; 3]) {
    let (sin_s, cos_s) = circle(s);
    let (sin_t, cos_t) = circle(t);
    let normal = [cos_t * sin_s, sin_t, cos_t * cos_s];
    let from_axis = radius + minor_radius * cos_t;
    ([from_axis * sin_s, minor_radius * sin_t, from_axis * cos_s], normal)
}

/// The frame of the tube consists of the torus's normal, which is perpendicular to the curve like every normal of a
/// surface that contains it, and of the vector perpendicular to both. It closes where the curve does. The tube's
/// normal is exact for any frame.
fn torus_knot([radius, minor, tube]: [f64; 3], [around, through]: [f64; 2], s: f64, t: f64) -> ([f64; 3], [f64; 3]) {
    let (sin_a, cos_a) = circle(around * s);
    let (sin_b, cos_b) = circle(through * s);
    let from_axis = radius + minor * cos_b;
    let center = [from_axis * sin_a, minor * sin_b, from_axis * cos_a];
    // The curve's derivatives along the parallel and along the meridian of the torus, which are perpendicular.
    let (along, across) = (around * from_axis, through * minor);
    let speed = along.hypot(across);
    let parallel = [cos_a, 0.0, -sin_a];
    let meridian = [-sin_b * sin_a, cos_b, -sin_b * cos_a];
    let outward = [cos_b * sin_a, sin_b, cos_b * cos_a];
    let sideways: [f64; 3] = std::array::from_fn(|axis| (along * meridian[axis] - across * parallel[axis]) / speed);
    let (sin_t, cos_t) = circle(t);
    let normal: [f64; 3] = std::array::from_fn(|axis| cos_t * outward[axis] + sin_t * sideways[axis]);
    (std::array::from_fn(|axis| center[axis] + tube * normal[axis]), normal)
}

fn frustum(bottom: f64, top: f64, height: f64, s: f64, t: f64) -> ([f64; 3], [f64; 3]) {
    let (sin_s, cos_s) = circle(s);
    let radius = bottom + (top - bottom) * t;
    let slant = height.hypot(bottom - top);
    let (out, up) = (height / slant, (bottom - top) / slant);
    ([radius * sin_s, (t - 0.5) * height, radius * cos_s], [out * sin_s, up, out * cos_s])
}

fn cube(columns: u32, rows: u32, half: f64) -> Geometry {
    // Right, up and normal of each face.
    const FACES: [[[f64; 3]; 3]; 6] = [
        [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]],
        [[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]],
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
    ];
    let mut geometry = Geometry::default();
    for [right, up, normal] in FACES {
        let face = grid(columns, rows, |s, t| {
            let (x, y) = (s * 2.0 - 1.0, t * 2.0 - 1.0);
            let position = std::array::from_fn(|axis| (right[axis] * x + up[axis] * y + normal[axis]) * half);
            (position, normal)
        });
        let first = geometry.positions.len() as u32;
        geometry.positions.extend(face.positions);
        geometry.normals.extend(face.normals);
        geometry.texcoords.extend(face.texcoords);
        geometry.indices.extend(face.indices.into_iter().map(|index| index + first));
    }
    geometry
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tables;
    use std::sync::Arc;

    fn table(text: &str) -> Geometry {
        let document = DeTable::parse(text).expect("the test writes TOML");
        let mut reader = Reader::new(&tables::SCENE, 0, Arc::default());
        let shape = match document.get_ref().get("shape").and_then(|node| node.get_ref().as_str()) {
            Some("torus") => Shape::Torus,
            Some("cube") => Shape::Cube,
            Some("cone") => Shape::Cone,
            Some("torus_knot") => Shape::TorusKnot,
            Some("plane") => Shape::Plane,
            _ => Shape::Sphere,
        };
        build(&mut reader, document.get_ref(), shape)
    }

    fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|axis| a[axis] - b[axis])
    }

    fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(x, y)| x * y).sum()
    }

    #[test]
    fn triangles_face_the_way_of_their_normals() {
        for shape in ["sphere", "torus", "cube", "cone", "plane", "torus_knot"] {
            let mesh = table(&format!("shape = \"{shape}\"\nsegments = 48\nrings = 12"));
            for corner in mesh.indices.chunks(3) {
                let [a, b, c] = [corner[0], corner[1], corner[2]].map(|index| index as usize);
                let p = &mesh.positions;
                let facing = dot(cross(sub(p[b], p[a]), sub(p[c], p[a])), mesh.normals[a]);
                assert!(facing > -1e-12, "{shape}: {facing}");
            }
        }
    }

    #[test]
    fn the_sphere_is_a_sphere_and_closes() {
        let mesh = table("shape = \"sphere\"\nradius = 2.0\nsegments = 16\nrings = 8");
        assert_eq!(mesh.positions.len(), 17 * 9);
        assert!(mesh.positions.iter().all(|p| (dot(*p, *p).sqrt() - 2.0).abs() < 4e-15));
        for row in mesh.positions.chunks(17) {
            assert_eq!(row[0], row[16]);
        }
    }

    #[test]
    fn the_knot_is_a_closed_tube_with_exact_normals() {
        let (segments, rings, tube) = (96, 12, 0.15);
        let mesh = table(&format!(
            "shape = \"torus_knot\"\nradius = 1.0\nminor_radius = 0.4\ntube = {tube}\nturns = [2, 3]\n\
             segments = {segments}\nrings = {rings}"
        ));
        let stride = segments + 1;
        let center = |column: usize| -> [f64; 3] {
            // Two opposite points of the tube.
            let (a, b) = (mesh.positions[column], mesh.positions[rings / 2 * stride + column]);
            std::array::from_fn(|axis| (a[axis] + b[axis]) / 2.0)
        };
        for row in mesh.positions.chunks(stride) {
            let gap = sub(row[0], row[segments]);
            assert!(dot(gap, gap).sqrt() < 1e-14, "{gap:?}");
        }
        for column in 1..segments {
            let middle = center(column);
            // The curve's direction by a central difference, accurate to the square of the step.
            let (before, after) = (center(column - 1), center(column + 1));
            let along = sub(after, before);
            for row in 0..=rings {
                let vertex = row * stride + column;
                let (position, normal) = (mesh.positions[vertex], mesh.normals[vertex]);
                assert!((dot(normal, normal) - 1.0).abs() < 1e-14);
                let spoke = sub(position, middle);
                assert!((dot(spoke, normal) - tube).abs() < 1e-14 && (dot(spoke, spoke).sqrt() - tube).abs() < 1e-14);
                assert!((dot(normal, along) / dot(along, along).sqrt()).abs() < 0.01, "at right angles to the curve");
            }
        }
    }
}
