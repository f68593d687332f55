//! Shadow maps: `map = { depths = { camera = { eye = [0, 5, 0] } }, width = 512, height = 512 }`.
//!
//! *In:* a camera, and the meshes of the scene's draws. *Out:* texels (d, d - 1/2, (d - 1/2)^2, 1) of the depth d that the camera sees
//! at the texel's center, 1 where there is nothing; and the matrix that leads there from world space, for a uniform. *Holds:* all of it
//! is computed in f64 and rounded once; a texel has the depth that OpenGL's rasterizer would store. *Not done here:* what a vertex
//! shader moves, and instances.

use super::Loader;
use super::matrices::View;
use super::mesh::Mesh;
use super::mipmaps::chain;
use crate::model::{Draw, Primitive, Texels, Texture, TextureLevel};
use crate::tables::{NumberValue, Reader};
use glam::{DMat3, DMat4, DVec3, DVec4};
use glisten_front::diagnostic::codes::scenes::{SCENE_WRONG_KIND, SCENE_WRONG_SIZE, SCENE_WRONG_VALUE};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_front::source::Span;
use std::ops::Range;
use std::sync::Arc;
use toml::de::DeTable;

const KEYS: &[&str] = &["camera", "draws", "matrix"];
/// The width and the height, unless the scene gives them, and at most.
const SIDE: u32 = 512;
const MAX_SIDE: u32 = 4096;

/// A map that a draw asks for.
#[derive(Clone, Debug)]
pub(super) struct DepthMap {
    /// The sampler.
    pub(super) name: String,
    /// The uniform that gets the matrix from world space to the map, with its place in the scene.
    pub(super) matrix: Option<(String, Span)>,
    to_clip: DMat4,
    /// The numbers of the draws that it shows, or all.
    draws: Option<Vec<(usize, Span)>>,
}

/// A mesh in world space.
#[derive(Debug)]
pub(super) struct Caster {
    positions: Vec<DVec3>,
    indices: Vec<u32>,
}

/// A texture that waits for the meshes of all draws.
#[derive(Debug)]
pub(super) struct Waiting {
    draw: usize,
    slot: usize,
    map: DepthMap,
}

impl Waiting {
    pub(super) fn new(draw: usize, slot: usize, map: &DepthMap) -> Self {
        Self { draw, slot, map: map.clone() }
    }
}

/// The maps of a draw.
pub(super) fn load_maps(reader: &mut Reader, draw: &DeTable<'_>) -> Vec<DepthMap> {
    let Some(textures) = draw.get("textures").and_then(|node| node.get_ref().as_table()) else { return Vec::new() };
    let mut maps = Vec::new();
    for (name, node) in textures {
        let Some(texture) = node.get_ref().as_table() else { continue };
        if texture.contains_key("depths") {
            maps.extend(load_map(reader, texture, name.get_ref()));
        }
    }
    maps
}

fn load_map(reader: &mut Reader, texture: &DeTable<'_>, name: &str) -> Option<DepthMap> {
    let table = reader.table_at(texture, "depths")?;
    reader.check_keys(table, "a map of depths", KEYS);
    let camera = camera(reader, table)?;
    let to_clip = View::of_camera(reader, camera, side(texture, "width") / side(texture, "height"));
    let matrix = table.get("matrix").and_then(|node| {
        let span = reader.span_of(node);
        reader.text(node, "matrix").map(|name| (name.to_owned(), span))
    });
    let draws = numbers(reader, table);
    Some(DepthMap { name: name.to_owned(), matrix, to_clip, draws })
}

/// The table of the camera, which a map needs.
fn camera<'t, 'i>(reader: &mut Reader, table: &'t DeTable<'i>) -> Option<&'t DeTable<'i>> {
    if !table.contains_key("camera") {
        let span = table.iter().next().map_or_else(Span::default, |(key, _)| reader.span_of(key));
        reader.error(&SCENE_WRONG_VALUE, span, "a map of depths has a `camera`".into(), "add `camera = { eye = .. }`");
    }
    reader.table_at(table, "camera")
}

/// A side of the map. What is wrong with it is reported with the texture.
fn side(texture: &DeTable<'_>, key: &str) -> f64 {
    let given = texture.get(key).and_then(|node| node.get_ref().as_integer()?.as_str().parse::<u32>().ok());
    f64::from(given.unwrap_or(SIDE).clamp(1, MAX_SIDE))
}

/// The numbers under `draws`.
fn numbers(reader: &mut Reader, table: &DeTable<'_>) -> Option<Vec<(usize, Span)>> {
    let node = table.get("draws")?;
    let numbers = reader.numbers(node, "draws")?;
    let mut list = Vec::new();
    for number in numbers {
        match number.value {
            NumberValue::Int(value, _) if value >= 0 => list.push((value as usize, number.span)),
            _ => reader.wrong_value(number.span, "a draw has a number from 0 on", "not that"),
        }
    }
    Some(list)
}

impl DepthMap {
    /// The matrix from world space to the map: texture coordinates, and the depth that it has.
    pub(super) fn to_map(&self) -> Vec<f32> {
        let half = DMat4::from_translation(DVec3::splat(0.5)) * DMat4::from_scale(DVec3::splat(0.5));
        (half * self.to_clip).to_cols_array().map(|number| number as f32).to_vec()
    }
}

impl Caster {
    /// The triangles of a draw in their place.
    pub(super) fn new(mesh: &Mesh, model: DMat4, primitive: Primitive) -> Self {
        let positions = mesh.geometry.positions.iter().map(|p| model.transform_point3(DVec3::from(*p))).collect();
        let indices = match primitive {
            Primitive::Triangles => mesh.geometry.indices.clone(),
            Primitive::TrianglesAdjacency => mesh.geometry.indices.iter().step_by(2).copied().collect(),
            _ => Vec::new(),
        };
        Self { positions, indices }
    }

    fn triangles(&self) -> impl Iterator<Item = [DVec3; 3]> {
        self.indices.chunks_exact(3).filter_map(|triangle| {
            let corner = |at: usize| self.positions.get(*triangle.get(at)? as usize).copied();
            Some([corner(0)?, corner(1)?, corner(2)?])
        })
    }
}

/// The levels that a texture has until all meshes are known: without texels, two for a texture with mipmaps.
pub(super) fn blank(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    name: &str,
    kind: SamplerType,
    mipmaps: bool,
) -> Option<Vec<TextureLevel>> {
    if kind.dim != SamplerDim::D2 || kind.arrayed || kind.texel != Scalar::Float {
        let span = table.get("depths").map_or_else(Span::default, |node| loader.reader.span_of(node));
        let message = format!("`{name}` is a {}: a map of depths is a 2D texture of floats", kind.name());
        loader.reader.error(&SCENE_WRONG_KIND, span, message, "not for this sampler");
        return None;
    }
    let [width, height] = ["width", "height"].map(|key| loader.reader.count(table, key, SIDE, 1..=MAX_SIDE));
    let level = TextureLevel { width, height, depth: 1, texels: Texels::Float(Vec::new()) };
    Some(vec![level; if mipmaps { 2 } else { 1 }])
}

/// Fills the maps of a scene whose draws are complete. Equal ones are shared.
pub(super) fn fill(loader: &mut Loader<'_>, draws: &mut [Draw]) {
    let waiting = std::mem::take(&mut loader.waiting);
    let mut made: Vec<(DMat4, Vec<usize>, Texture, Arc<Texture>)> = Vec::new();
    for Waiting { draw, slot, map } in waiting {
        let Some(shown) = shown(loader, &map) else { continue };
        let Some(texture) = draws.get_mut(draw).and_then(|draw| draw.textures.get_mut(slot)?.as_mut()) else {
            continue;
        };
        let is_same = |(to_clip, casters, blank, _): &&(DMat4, Vec<usize>, Texture, Arc<Texture>)| {
            *to_clip == map.to_clip && *casters == shown && *blank == **texture
        };
        let known = made.iter().find(is_same).map(|(.., filled)| Arc::clone(filled));
        let filled = known.unwrap_or_else(|| {
            let casters = shown.iter().filter_map(|number| loader.casters.get(*number)?.as_ref());
            let filled = Arc::new(filled(texture, map.to_clip, casters));
            made.push((map.to_clip, shown, (**texture).clone(), Arc::clone(&filled)));
            filled
        });
        *texture = filled;
    }
}

/// The numbers of the draws that a map shows. Reports those that have no mesh.
fn shown(loader: &mut Loader<'_>, map: &DepthMap) -> Option<Vec<usize>> {
    let Some(numbers) = &map.draws else { return Some((0..loader.casters.len()).collect()) };
    for (number, span) in numbers {
        if loader.casters.get(*number).is_none_or(Option::is_none) {
            let message = format!("the scene has no draw {number} with a mesh");
            loader.reader.error(&SCENE_WRONG_SIZE, *span, message, "draws count from 0");
            return None;
        }
    }
    Some(numbers.iter().map(|(number, _)| *number).collect())
}

fn filled<'c>(blank: &Texture, to_clip: DMat4, casters: impl Iterator<Item = &'c Caster>) -> Texture {
    let Some(first) = blank.levels.first() else { return blank.clone() };
    let mut depths = Depths::new(first.width, first.height);
    casters.flat_map(Caster::triangles).for_each(|corners| depths.draw(corners.map(|p| to_clip * p.extend(1.0))));
    let level = TextureLevel { texels: Texels::Float(depths.texels()), ..*first };
    let levels = if blank.levels.len() > 1 { chain(level, blank.kind) } else { vec![level] };
    Texture { levels, ..blank.clone() }
}

/// A buffer of depths, 0 to 1.
struct Depths {
    width: u32,
    height: u32,
    depths: Vec<f64>,
}

impl Depths {
    fn new(width: u32, height: u32) -> Self {
        Self { width, height, depths: vec![1.0; width as usize * height as usize] }
    }

    /// Draws a triangle in clip space. It need not be cut where it reaches behind the camera: the inverse of its corners' matrix has
    /// what each corner counts for at a place, divided by w, and a place is inside where no corner counts less than 0.
    fn draw(&mut self, corners: [DVec4; 3]) {
        let [a, b, c] = corners.map(|corner| DVec3::new(corner.x, corner.y, corner.w));
        let matrix = DMat3::from_cols(a, b, c);
        // Seen from its edge, or not finite.
        if !matrix.determinant().is_normal() {
            return;
        }
        let inverse = matrix.inverse();
        let heights = DVec3::from(corners.map(|corner| corner.z));
        for row in self.range(corners, |corner| corner.y, self.height) {
            for column in self.range(corners, |corner| corner.x, self.width) {
                let place = [(column, self.width), (row, self.height)].map(|(at, of)| center(at, of));
                let counts = inverse * DVec3::new(place[0], place[1], 1.0);
                let depth = 0.5 + 0.5 * heights.dot(counts);
                let known = self.depths.get_mut((row * self.width + column) as usize);
                if let Some(known) = known.filter(|_| counts.min_element() >= 0.0 && (0.0..=1.0).contains(&depth)) {
                    *known = known.min(depth);
                }
            }
        }
    }

    /// The columns or the rows that a triangle can cover: all where it reaches behind the camera.
    fn range(&self, corners: [DVec4; 3], side: fn(DVec4) -> f64, count: u32) -> Range<u32> {
        if corners.iter().any(|corner| corner.w <= 0.0 || corner.w.is_nan()) {
            return 0..count;
        }
        let places = corners.map(|corner| (0.5 + 0.5 * side(corner) / corner.w) * f64::from(count));
        let low = places.into_iter().fold(f64::INFINITY, f64::min);
        let high = places.into_iter().fold(f64::NEG_INFINITY, f64::max);
        (low.floor().max(0.0) as u32).min(count)..(high.ceil().max(0.0) as u32).min(count)
    }

    fn texels(&self) -> Vec<[f32; 4]> {
        let texel = |depth: &f64| [*depth, depth - 0.5, (depth - 0.5).powi(2), 1.0].map(|number| number as f32);
        self.depths.iter().map(texel).collect()
    }
}

/// The place of a texel's center between -1 and 1.
fn center(at: u32, of: u32) -> f64 {
    (2.0 * f64::from(at) + 1.0) / f64::from(of) - 1.0
}

#[cfg(test)]
mod tests {
    use super::super::matrices::perspective;
    use super::*;

    fn corner(x: f64, y: f64, z: f64, w: f64) -> DVec4 {
        DVec4::new(x * w, y * w, z * w, w)
    }

    #[test]
    fn the_nearest_triangle_counts_at_every_center() {
        let mut depths = Depths::new(4, 4);
        depths.draw([corner(-1.0, -1.0, 0.5, 1.0), corner(3.0, -1.0, 0.5, 2.0), corner(-1.0, 3.0, 0.5, 1.0)]);
        depths.draw([corner(0.0, 0.0, 0.0, 1.0), corner(2.0, 0.0, 0.0, 1.0), corner(0.0, 2.0, 0.0, 3.0)]);
        let expected = |index: usize| if index % 4 >= 2 && index / 4 >= 2 { 0.5 } else { 0.75 };
        for (index, depth) in depths.depths.iter().enumerate() {
            assert!((depth - expected(index)).abs() < 1e-12, "{index}: {depth}");
        }
        assert_eq!(depths.texels()[15], [0.5, 0.0, 0.0, 1.0]);
    }

    /// A floor that goes on behind the camera, through which a ray of each texel is sent.
    #[test]
    fn what_reaches_behind_the_camera_needs_no_cut() {
        let (near, far) = (0.5, 20.0);
        let to_clip = perspective(1.0, 1.0, near, far);
        let floor = [DVec3::new(-90.0, -1.0, 30.0), DVec3::new(90.0, -1.0, 30.0), DVec3::new(0.0, -1.0, -60.0)];
        let mut depths = Depths::new(16, 16);
        depths.draw(floor.map(|p| to_clip * p.extend(1.0)));
        let half = 0.5f64.tan();
        for row in 0..16 {
            // The ray through the middle of the row meets the floor at this distance.
            let down = -center(row, 16) * half;
            let z = if down > 0.0 { 1.0 / down } else { f64::INFINITY };
            let expected = if (near..=far).contains(&z) { (far - near * far / z) / (far - near) } else { 1.0 };
            let found = depths.depths[(row * 16 + 8) as usize];
            assert!((found - expected).abs() < 1e-12, "{row}: {found} for {expected}");
        }
        assert!(depths.depths.iter().filter(|depth| **depth < 1.0).count() > 60);
    }

    #[test]
    fn a_triangle_without_area_and_one_that_is_not_finite_draw_nothing() {
        let mut depths = Depths::new(4, 4);
        depths.draw([corner(0.0, 0.0, 0.0, 1.0); 3]);
        depths.draw([corner(f64::NAN, 0.0, 0.0, 1.0), corner(1.0, 0.0, 0.0, 1.0), corner(0.0, 1.0, 0.0, 1.0)]);
        depths.draw([corner(f64::INFINITY, 0.0, 0.0, 1.0), corner(1.0, 0.0, 0.0, 1.0), corner(0.0, 1.0, 0.0, 1.0)]);
        assert!(depths.depths.iter().all(|depth| *depth == 1.0));
    }
}
