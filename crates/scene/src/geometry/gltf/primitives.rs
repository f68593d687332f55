//! The triangles of a glTF mesh, in world space.
//!
//! *In:* a mesh, the matrix of its node, perhaps a skin. *Out:* a [`Part`] for each material. *Holds:* a skin replaces the node's matrix
//! (§3.7.3.3); a mirrored mesh keeps its outside.

use super::super::MAX_TRIANGLES;
use super::super::model::Part;
use super::super::soup::{Corner, Soup};
use super::accessor::{self, Numbers};
use super::buffers::Buffers;
use super::instances;
use super::maps;
use super::nodes::Nodes;
use glam::{DMat3, DMat4, DVec3};
use gltf::json::mesh::{Mesh, Mode, Primitive, Semantic};
use gltf::json::scene::Node;
use gltf::json::skin::Skin;
use gltf::json::validation::Checked;
use gltf::json::{Index, Root};

/// The most vertices of a file: those of triangles that share none.
const MAX_VERTICES: usize = 3 * MAX_TRIANGLES;

/// Collects the triangles of all meshes.
pub(super) struct Builder<'a> {
    root: &'a Root,
    buffers: Buffers<'a>,
    parts: Vec<Part>,
    n_triangles: usize,
    n_vertices: usize,
    n_skipped: usize,
}

impl<'a> Builder<'a> {
    pub(super) fn new(root: &'a Root, buffers: Buffers<'a>) -> Self {
        Self { root, buffers, parts: Vec::new(), n_triangles: 0, n_vertices: 0, n_skipped: 0 }
    }

    /// The parts, and what was left out.
    pub(super) fn finish(self) -> (Vec<Part>, Vec<String>) {
        let skipped = match self.n_skipped {
            0 => None,
            n => Some(format!("{n} of its primitives are points or lines, which are left out")),
        };
        (self.parts, skipped.into_iter().collect())
    }

    /// The matrices of the copies of a node's mesh to its node.
    pub(super) fn copies(&mut self, node: &Node) -> Result<Vec<DMat4>, String> {
        instances::of(self.root, &mut self.buffers, node)
    }

    /// Adds the primitives of a mesh.
    pub(super) fn mesh(
        &mut self,
        mesh: Index<Mesh>,
        skin: Option<Index<Skin>>,
        world: DMat4,
        nodes: &Nodes,
    ) -> Result<(), String> {
        let root = self.root;
        let number = mesh.value();
        let mesh = root.get(mesh).ok_or_else(|| format!("there is no mesh {number}"))?;
        let joints = match skin {
            Some(skin) => {
                let found = root.get(skin).ok_or_else(|| format!("there is no skin {}", skin.value()))?;
                self.joints(found, nodes)?
            }
            None => Vec::new(),
        };
        for primitive in &mesh.primitives {
            self.primitive(primitive, world, &joints).map_err(|error| format!("mesh {number}: {error}"))?;
        }
        Ok(())
    }

    /// The matrix of each joint from the mesh in its bind pose to world space.
    fn joints(&mut self, skin: &Skin, nodes: &Nodes) -> Result<Vec<DMat4>, String> {
        let inverse: Vec<DMat4> = match skin.inverse_bind_matrices {
            Some(matrices) => {
                let matrices = accessor::read(self.root, &mut self.buffers, matrices)?;
                matrices.rows([0.0; 16]).iter().map(DMat4::from_cols_array).collect()
            }
            None => Vec::new(),
        };
        let joint = |(index, node): (usize, &Index<_>)| {
            nodes.world(node.value()) * inverse.get(index).copied().unwrap_or(DMat4::IDENTITY)
        };
        Ok(skin.joints.iter().enumerate().map(joint).collect())
    }

    fn numbers(&mut self, primitive: &Primitive, semantic: Semantic) -> Result<Option<Numbers>, String> {
        let Some(index) = primitive.attributes.get(&Checked::Valid(semantic)) else { return Ok(None) };
        accessor::read(self.root, &mut self.buffers, *index).map(Some)
    }

    fn primitive(&mut self, primitive: &Primitive, world: DMat4, joints: &[DMat4]) -> Result<(), String> {
        let Checked::Valid(mode) = primitive.mode else { return Err("a primitive of an unknown mode".to_owned()) };
        if !matches!(mode, Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
            self.n_skipped += 1;
            return Ok(());
        }
        let look = primitive.material.map_or(self.root.materials.len(), |material| material.value());
        let Some(positions) = self.numbers(primitive, Semantic::Positions)? else {
            return Err(missing_positions(primitive));
        };
        let mut soup = Soup { positions: positions.rows([0.0; 3]), ..Soup::default() };
        let count = soup.positions.len();
        // Copies would let a small file have any number of them.
        self.n_vertices += count;
        if self.n_vertices > MAX_VERTICES {
            return Err(format!("the file has more than {MAX_VERTICES} vertices with all copies of its meshes"));
        }
        let of_count = |rows: Option<Numbers>| rows.filter(|rows| rows.values.len() == count * rows.width);
        let normals = of_count(self.numbers(primitive, Semantic::Normals)?);
        let tangents = of_count(self.numbers(primitive, Semantic::Tangents)?);
        let colors = of_count(self.numbers(primitive, Semantic::Colors(0))?);
        let (set, second) = self.root.materials.get(look).map_or((0, None), maps::sets);
        let texcoords = of_count(self.numbers(primitive, Semantic::TexCoords(set))?);
        let texcoords2 = match second {
            Some(second) => Some(of_count(self.numbers(primitive, Semantic::TexCoords(second))?)),
            None => None,
        };
        soup.normals = normals.map_or(Vec::new(), |normals| normals.rows([0.0; 3]));
        soup.tangents = tangents.map_or(Vec::new(), |tangents| tangents.rows([1.0, 0.0, 0.0, 1.0]));
        soup.colors = colors.map_or(Vec::new(), |colors| colors.rows([1.0; 4]));
        soup.texcoords = upright(texcoords);
        // Where a material has textures by a set that the primitive lacks, they show one texel.
        soup.texcoords2 = texcoords2.map_or(Vec::new(), upright);
        if second.is_some() && soup.texcoords2.is_empty() {
            soup.texcoords2 = vec![[0.0; 2]; count];
        }
        let mirrored = self.place(primitive, &mut soup, world, joints)?;
        let indices: Vec<u32> = match primitive.indices {
            Some(indices) => accessor::indices(self.root, &mut self.buffers, indices)?,
            None => (0..count as u32).collect(),
        };
        if let Some(past) = indices.iter().find(|index| **index as usize >= count) {
            return Err(format!("index {past} is past its {count} vertices"));
        }
        let has = (!soup.texcoords.is_empty(), !soup.normals.is_empty());
        let corner = |row: u32| Corner { position: row, texcoord: has.0.then_some(row), normal: has.1.then_some(row) };
        let turned = |[a, b, c]: [u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
        soup.triangles = triangles(mode, &indices).map(|triangle| turned(triangle).map(corner)).collect();
        self.n_triangles += soup.triangles.len();
        if self.n_triangles > MAX_TRIANGLES {
            return Err(format!("the file has more than {MAX_TRIANGLES} triangles, the most that a mesh has"));
        }
        if !soup.triangles.is_empty() {
            self.parts.push(Part { look, soup });
        }
        Ok(())
    }

    /// Moves the vertices to world space. Returns whether that mirrors them.
    fn place(
        &mut self,
        primitive: &Primitive,
        soup: &mut Soup,
        world: DMat4,
        joints: &[DMat4],
    ) -> Result<bool, String> {
        let rows = self.numbers(primitive, Semantic::Joints(0))?.zip(self.numbers(primitive, Semantic::Weights(0))?);
        let matrices: Vec<DMat4> = match rows {
            Some((numbers, weights)) if !joints.is_empty() => {
                let pairs = numbers.rows([0.0; 4]).into_iter().zip(weights.rows([0.0; 4]));
                pairs.map(|(numbers, weights)| blended(joints, numbers, weights)).collect()
            }
            _ => Vec::new(),
        };
        let of = |row: usize| matrices.get(row).copied().unwrap_or(world);
        for (row, position) in soup.positions.iter_mut().enumerate() {
            *position = of(row).transform_point3((*position).into()).to_array();
        }
        let linear = |row: usize| DMat3::from_mat4(of(row));
        for (row, normal) in soup.normals.iter_mut().enumerate() {
            let matrix = linear(row);
            // The cofactors are the inverse transpose times the determinant, and are defined without an inverse.
            let cofactors = DMat3::from_cols(
                matrix.y_axis.cross(matrix.z_axis),
                matrix.z_axis.cross(matrix.x_axis),
                matrix.x_axis.cross(matrix.y_axis),
            );
            *normal = (cofactors * DVec3::from(*normal) * matrix.determinant().signum()).to_array();
        }
        for (row, [x, y, z, w]) in soup.tangents.iter_mut().enumerate() {
            let matrix = linear(row);
            let tangent = matrix * DVec3::new(*x, *y, *z);
            [*x, *y, *z] = tangent.normalize_or_zero().to_array();
            // The cross product of what is mirrored points the other way.
            *w *= if matrix.determinant() < 0.0 { -1.0 } else { 1.0 };
        }
        if soup.positions.iter().flatten().any(|value| !(*value as f32).is_finite()) {
            return Err("its positions are not finite in world space".to_owned());
        }
        Ok(linear(0).determinant() < 0.0)
    }
}

/// Texture coordinates whose t grows upwards: the first row of an image is at t = 0 in glTF, and at the top of a picture here.
fn upright(rows: Option<Numbers>) -> Vec<[f64; 2]> {
    let rows = rows.map_or(Vec::new(), |rows| rows.rows([0.0; 2]));
    rows.into_iter().map(|[s, t]| [s, 1.0 - t]).collect()
}

fn blended(joints: &[DMat4], numbers: [f64; 4], weights: [f64; 4]) -> DMat4 {
    let total: f64 = weights.iter().sum();
    let pairs = numbers.into_iter().zip(weights);
    let sum = pairs.filter_map(|(joint, weight)| Some(*joints.get(joint as usize)? * weight));
    let sum = sum.fold(DMat4::ZERO, |sum, matrix| sum + matrix);
    if total > 0.0 { sum * (1.0 / total) } else { joints.first().copied().unwrap_or(DMat4::IDENTITY) }
}

/// The vertices of each triangle (§3.7.2.1).
fn triangles(mode: Mode, indices: &[u32]) -> Box<dyn Iterator<Item = [u32; 3]> + '_> {
    match mode {
        Mode::TriangleStrip => Box::new(indices.windows(3).enumerate().filter_map(|(k, window)| match *window {
            [a, b, c] => Some(if k % 2 == 0 { [a, b, c] } else { [a, c, b] }),
            _ => None,
        })),
        Mode::TriangleFan => {
            let first = indices.first().copied().unwrap_or(0);
            Box::new(indices.windows(2).skip(1).filter_map(move |pair| match *pair {
                [b, c] => Some([b, c, first]),
                _ => None,
            }))
        }
        _ => Box::new(indices.chunks_exact(3).filter_map(|triangle| triangle.try_into().ok())),
    }
}

fn missing_positions(primitive: &Primitive) -> String {
    if primitive.attributes.is_empty() {
        return "a primitive has no attributes; perhaps an extension that is not read compresses it".to_owned();
    }
    "a primitive has no POSITION".to_owned()
}
