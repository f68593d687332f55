//! The lights of `shader_lib/ltc.glsl` against integration: rays in the directions that the model reflects, and those that meet the light.
//!
//! *In:* how many rays, and how many lights of each shape for each range of eyes. *Out:* for each shape and roughness, how far the module's
//! reflection is from the integral, as a part of what the whole sky would give; and how much of the whole sky the bent cosine has. *Holds:* the module is called in f64, with the tables as scenes have them; the
//! integrals use the true shapes, round and not with corners.

use super::ggx::{Ggx, V, add, cross, dot, scale, spread, unit};
use glisten::evaluate::Evaluator;
use glisten::library::Embedded;
use glisten::scene::{MemoryFiles, load};
use glisten::{Compiler, Options, Precision};
use glisten_verify::scene::Texture;
use std::fmt;
use std::sync::Arc;

/// The functions that are called: the reflection of a white mirror, and of a white diffuse surface, for each shape.
const CALLS: &str = "#include <glisten/ltc.glsl>
mat3 bent(sampler2D m, vec3 V, float r) { return ltcMatrix(m, vec3(0.0, 0.0, 1.0), V, r); }
float all(sampler2D a, vec3 V, float r) { return ltcAlbedo(a, vec3(0.0, 0.0, 1.0), V, r, vec3(1.0)).x; }
vec2 rectangle(sampler2D m, sampler2D a, vec3 V, float r, vec3 c, vec3 x, vec3 y)
{ return vec2(ltcRectangle(bent(m, V, r), c, x, y) * all(a, V, r), ltcRectangle(mat3(1.0), c, x, y)); }
vec2 disk(sampler2D m, sampler2D a, vec3 V, float r, vec3 c, vec3 x, vec3 y)
{ return vec2(ltcDisk(bent(m, V, r), c, x, y) * all(a, V, r), ltcDisk(mat3(1.0), c, x, y)); }
vec2 sphere(sampler2D m, sampler2D a, vec3 V, float r, vec3 c, vec3 x, vec3 y)
{ return vec2(ltcSphere(bent(m, V, r), c, length(y)) * all(a, V, r), ltcSphere(mat3(1.0), c, length(y))); }
vec2 tube(sampler2D m, sampler2D a, vec3 V, float r, vec3 c, vec3 x, vec3 y)
{
    float radius = length(y);
    return vec2(ltcTube(bent(m, V, r), c - x, c + x, radius) * all(a, V, r), ltcTube(mat3(1.0), c - x, c + x, radius));
}
vec2 thick_tube(sampler2D m, sampler2D a, vec3 V, float r, vec3 c, vec3 x, vec3 y) { return tube(m, a, V, r, c, x, y); }
vec2 close_tube(sampler2D m, sampler2D a, vec3 V, float r, vec3 c, vec3 x, vec3 y) { return tube(m, a, V, r, c, x, y); }
vec2 sky(sampler2D m, sampler2D a, vec3 V, float r)
{ return vec2(ltcRectangle(bent(m, V, r), vec3(0.0, 0.0, 1.0), vec3(1e6, 0.0, 0.0), vec3(0.0, 1e6, 0.0)), 1.0); }
";

/// A shape of lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    name: &'static str,
    /// The longest second axis, as a part of the distance of the middle: round lights stay in front of the surface.
    widest: f64,
    /// Whether a ray from the origin meets the light with this middle and these two axes.
    meets: fn(V, V, V, V) -> bool,
}

/// The ranges of N.V, from the steepest eyes to those near the surface.
pub(crate) const EYES: [[f64; 2]; 3] = [[0.5, 1.0], [0.15, 0.5], [0.02, 0.15]];

const SHAPES: &[Shape] = &[
    Shape {
        name: "rectangle",
        widest: 2.0,
        meets: |ray, c, x, y| place(ray, c, x, y).is_some_and(|[s, t]| s.abs() <= 1.0 && t.abs() <= 1.0),
    },
    Shape {
        name: "disk",
        widest: 2.0,
        meets: |ray, c, x, y| place(ray, c, x, y).is_some_and(|[s, t]| s * s + t * t <= 1.0),
    },
    Shape {
        name: "sphere",
        widest: 0.65,
        meets: |ray, c, _, y| dot(c, ray) > 0.0 && dot(c, c) - dot(c, ray).powi(2) <= dot(y, y),
    },
    Shape { name: "tube", widest: 0.1, meets: |ray, c, x, y| meets_tube(ray, c, x, dot(y, y).sqrt()) },
    Shape { name: "thick_tube", widest: 0.65, meets: |ray, c, x, y| meets_tube(ray, c, x, dot(y, y).sqrt()) },
    Shape { name: "close_tube", widest: 0.9, meets: |ray, c, x, y| meets_tube(ray, c, x, dot(y, y).sqrt()) },
];

/// Where a ray meets a plane, by its axes.
fn place(ray: V, center: V, x: V, y: V) -> Option<[f64; 2]> {
    let normal = cross(x, y);
    let by = dot(center, normal) / dot(ray, normal);
    (by.is_finite() && by > 0.0).then(|| {
        let at = add(scale(by, ray), scale(-1.0, center));
        [dot(at, x) / dot(x, x), dot(at, y) / dot(y, y)]
    })
}

/// A cylinder, closed by disks.
fn meets_tube(ray: V, center: V, x: V, radius: f64) -> bool {
    let (half, axis) = (dot(x, x).sqrt(), unit(x));
    let flat = |v: V| add(v, scale(-dot(v, axis), axis));
    let (r, c) = (flat(ray), flat(center));
    let (a, b) = (dot(r, r), dot(r, c));
    let root = b * b - a * (dot(c, c) - radius * radius);
    let within = |by: f64| by > 0.0 && (by * dot(ray, axis) - dot(center, axis)).abs() <= half;
    let side = root >= 0.0 && [-1.0, 1.0].into_iter().any(|sign| within((b + sign * root.sqrt()) / a));
    side || [-half, half].into_iter().any(|end| {
        let by = (dot(center, axis) + end) / dot(ray, axis);
        let off = add(scale(by, r), scale(-1.0, c));
        by.is_finite() && by > 0.0 && dot(off, off) <= radius * radius
    })
}

/// The errors of a shape at a roughness.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Row {
    pub(crate) shape: &'static str,
    pub(crate) roughness: f64,
    /// The mean and the largest difference of the reflection by `ggx`, for each of the [`EYES`].
    pub(crate) mirrored: [[f64; 2]; EYES.len()],
    /// Those of a diffuse surface, for all of them.
    pub(crate) diffuse: [f64; 2],
}

impl fmt::Display for Row {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { shape, roughness, mirrored, diffuse: [even, worst] } = self;
        write!(f, "| {} | {roughness} |", shape.replace('_', " "))?;
        for [mean, most] in mirrored {
            write!(f, " {mean:.4} | {most:.3} |")?;
        }
        write!(f, " {even:.4} | {worst:.4} |")
    }
}

/// The two tables, as a scene has them.
pub(crate) fn tables() -> Result<Vec<Arc<Texture>>, String> {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
    let fragment = "#version 150\nuniform sampler2D m;\nuniform sampler2D a;\nout vec4 c;\n\
        void main() { c = texture(m, vec2(0.5)) + texture(a, vec2(0.5)); }\n";
    let scene = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
        textures = { m = { pattern = \"ltc_matrix\" }, a = { pattern = \"ltc_albedo\" } }\n";
    let files = MemoryFiles::new([("a.toml", scene), ("a.vert", vertex), ("a.frag", fragment)]);
    let loaded = load("a.toml", &files, &Compiler::new(Options::default()));
    let told = || loaded.diagnostics.iter().map(|found| found.message.clone()).collect::<Vec<_>>().join("; ");
    let scene = loaded.scene.as_ref().ok_or_else(told)?;
    let draw = scene.draws.first().ok_or_else(told)?;
    let names = draw.program.interface.samplers.iter().map(|sampler| sampler.name.as_str());
    let mut named: Vec<_> = names.zip(&draw.textures).collect();
    // The matrices first.
    named.sort_by_key(|(name, _)| *name != "m");
    Ok(named.into_iter().filter_map(|(_, texture)| texture.clone()).collect())
}

/// A light for a number: for half of the numbers about where the eye's mirror direction goes, else somewhere above or across the horizon.
fn light(index: u32, eye: V, widest: f64) -> [V; 3] {
    let [a, b] = spread(7 * index + 1);
    let [c, d] = spread(11 * index + 5);
    let turn = |at: f64| std::f64::consts::TAU * at;
    let height = 1.1 * a - 0.1;
    let flat = (1.0 - height * height).max(0.0).sqrt();
    let anywhere = [flat * turn(b).cos(), flat * turn(b).sin(), height];
    let mirror = [-eye[0], -eye[1], eye[2]];
    let towards = if index.is_multiple_of(2) { anywhere } else { unit(add(mirror, scale(0.3, anywhere))) };
    let far = 1.0 + 3.0 * d;
    let center = scale(far, towards);
    let axis = unit([turn(c).cos(), turn(c).sin(), d - 0.5]);
    let x = unit(cross(axis, unit(add(center, [0.1, 0.2, 0.3]))));
    // From a tenth of the largest size to the largest.
    [center, scale(far * (0.2 + 1.8 * b), x), scale(far * widest * (0.1 + 0.9 * c), cross(unit(center), x))]
}

/// The errors of all shapes, by so many rays and for so many lights for each range of eyes.
///
/// # Errors
/// The module cannot be called.
pub(crate) fn rows(rays: u32, lights: u32) -> Result<Vec<Row>, String> {
    let tables = tables()?;
    let compiler = Compiler::new(Options::default()).with_includes(Embedded);
    let mut rows = Vec::new();
    for shape in SHAPES {
        let signature = format!("{}(sampler2D,sampler2D,vec3,float,vec3,vec3,vec3)", shape.name);
        let function = Evaluator::new(&compiler, CALLS, &signature, &[]).map_err(|error| error.to_string())?;
        for roughness in [0.2, 0.5, 0.9] {
            let mut row = Row { shape: shape.name, roughness, mirrored: [[0.0; 2]; EYES.len()], diffuse: [0.0; 2] };
            for (at, [low, high]) in EYES.into_iter().enumerate() {
                let mut inputs = Vec::new();
                let mut wanted = Vec::new();
                for index in 0..lights {
                    let ggx = Ggx::new(low + (high - low) * spread(index)[0], roughness * roughness);
                    let [c, x, y] = light(index, ggx.eye, shape.widest);
                    let numbers = [ggx.eye.as_slice(), &[roughness], &c, &x, &y].concat();
                    inputs.extend(numbers.into_iter().map(|number| number as f32));
                    wanted.push(integrals(ggx, |ray| (shape.meets)(ray, c, x, y), rays));
                }
                let found = function.reference(&inputs, &tables, Precision::F64).map_err(|error| error.to_string())?;
                for (found, wanted) in found.iter().zip(&wanted) {
                    let eyes = EYES.len() as f64;
                    for ([mean, most], channel, count) in [(&mut row.mirrored[at], 0, 1.0), (&mut row.diffuse, 1, eyes)]
                    {
                        let apart = (found[channel] - wanted[channel]).abs();
                        *mean += apart / (count * f64::from(lights));
                        *most = most.max(apart);
                    }
                }
            }
            rows.push(row);
        }
    }
    Ok(rows)
}

/// The cosines of the eye for which [`skies`] asks.
pub(crate) const SEEN: [f64; 5] = [1.0, 0.6, 0.3, 0.1, 0.02];

/// The part of a light all over the sky that the bent cosine has above the horizon, for each roughness at each of the cosines [`SEEN`].
///
/// # Errors
/// The module cannot be called.
pub(crate) fn skies() -> Result<Vec<(f64, Vec<f64>)>, String> {
    let tables = tables()?;
    let compiler = Compiler::new(Options::default()).with_includes(Embedded);
    let function = Evaluator::new(&compiler, CALLS, "sky(sampler2D,sampler2D,vec3,float)", &[]);
    let function = function.map_err(|error| error.to_string())?;
    let mut found = Vec::new();
    for roughness in [0.1, 0.25, 0.5, 0.75, 1.0] {
        let inputs: Vec<f32> = SEEN
            .into_iter()
            .flat_map(|cosine| [(1.0 - cosine * cosine).sqrt(), 0.0, cosine, roughness])
            .map(|number| number as f32)
            .collect();
        let parts = function.reference(&inputs, &tables, Precision::F64).map_err(|error| error.to_string())?;
        found.push((roughness, parts.iter().map(|part| part[0]).collect()));
    }
    Ok(found)
}

/// The light that a white mirror and a white diffuse surface reflect of a lamp.
fn integrals(ggx: Ggx, meets: impl Fn(V) -> bool, rays: u32) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for index in 0..rays {
        let point = spread(index);
        let sample = ggx.sample(point);
        if sample.weight > 0.0 && meets(sample.light) {
            sums[0] += sample.weight;
        }
        let (radius, angle) = (point[0].sqrt(), std::f64::consts::TAU * point[1]);
        let ray = [radius * angle.cos(), radius * angle.sin(), (1.0 - point[0]).max(0.0).sqrt()];
        sums[1] += f64::from(u32::from(meets(ray)));
    }
    sums.map(|sum| sum / f64::from(rays))
}
