//! Triangles with the data of their vertices, and the files that have them: Wavefront OBJ with its MTL, glTF 2.0.
//!
//! *In:* the bytes of a file, and a [`FileSource`](crate::FileSource) for those that it names. *Out:* a [`Model`], whose parts
//! become a [`Geometry`] with complete normals and texture coordinates. *Holds:* coordinates are f64. What a file says is
//! checked: a wrong file gives a sentence, with a line where the format has lines.

mod adjacency;
mod framing;
mod gltf;
mod model;
mod mtl;
mod normals;
mod obj;
mod polygon;
mod soup;
mod tangents;

pub(crate) use framing::{DOME, Framing};
pub(crate) use gltf::{
    Contents, Lamp, LampKind, Surface, contents as gltf_contents, draw as gltf_draw, image as gltf_image, is_blended,
    is_gltf, passes,
};
pub use model::is_model_file;
pub(crate) use model::{Look, Model, ModelCamera, ModelError, Projection, TextureSource};
pub(crate) use mtl::parse as parse_mtl;
pub(crate) use normals::Normals;
pub(crate) use soup::Soup;

use crate::roles::AttributeRole;

/// The largest number of triangles of a mesh from a file, and of its vertices.
pub(crate) const MAX_TRIANGLES: usize = 1 << 22;

/// Indexed triangles. A list of vertex data has one row for each position, or none at all.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Geometry {
    pub(crate) positions: Vec<[f64; 3]>,
    pub(crate) normals: Vec<[f64; 3]>,
    pub(crate) texcoords: Vec<[f64; 2]>,
    /// A second set.
    pub(crate) texcoords2: Vec<[f64; 2]>,
    pub(crate) colors: Vec<[f64; 4]>,
    /// The direction of growing s, and the handedness of the bitangent.
    pub(crate) tangents: Vec<[f64; 4]>,
    pub(crate) indices: Vec<u32>,
}

impl Geometry {
    /// The numbers for a role and how many a vertex has; `None` if there are none. Tangents are
    /// those of the file, or what [`Geometry::complete_tangents`] has found.
    pub(crate) fn data(&self, role: AttributeRole) -> Option<(u32, Vec<f32>)> {
        let flat = |rows: &mut dyn Iterator<Item = f64>| rows.map(|value| value as f32).collect::<Vec<f32>>();
        let (size, values) = match role {
            AttributeRole::Position => (3, flat(&mut self.positions.iter().flatten().copied())),
            AttributeRole::Normal => (3, flat(&mut self.normals.iter().flatten().copied())),
            AttributeRole::Texcoord => (2, flat(&mut self.texcoords.iter().flatten().copied())),
            AttributeRole::Texcoord2 => (2, flat(&mut self.texcoords2.iter().flatten().copied())),
            AttributeRole::Color => (4, flat(&mut self.colors.iter().flatten().copied())),
            AttributeRole::Tangent => (4, flat(&mut self.tangents.iter().flatten().copied())),
            AttributeRole::Bitangent => (3, flat(&mut self.bitangents().iter().flatten().copied())),
        };
        (values.len() == self.positions.len() * size as usize && !values.is_empty()).then_some((size, values))
    }

    /// Appends another geometry. A list that one of the two lacks is dropped.
    pub(crate) fn append(&mut self, other: Self) {
        let first = self.positions.len() as u32;
        if first == 0 {
            *self = other;
            return;
        }
        let keep = |mine: bool, others: bool| mine && others;
        let texcoords2 = keep(!self.texcoords2.is_empty(), !other.texcoords2.is_empty());
        let colors = keep(!self.colors.is_empty(), !other.colors.is_empty());
        let tangents = keep(!self.tangents.is_empty(), !other.tangents.is_empty());
        self.positions.extend(other.positions);
        self.normals.extend(other.normals);
        self.texcoords.extend(other.texcoords);
        self.texcoords2.extend(other.texcoords2);
        self.colors.extend(other.colors);
        self.tangents.extend(other.tangents);
        if !texcoords2 {
            self.texcoords2.clear();
        }
        if !colors {
            self.colors.clear();
        }
        if !tangents {
            self.tangents.clear();
        }
        self.indices.extend(other.indices.into_iter().map(|index| index + first));
    }
}
