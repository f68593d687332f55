//! [`Model`]: what a file of meshes has.
//!
//! *In:* a path and its bytes. *Out:* parts with their materials, and the camera if the file has one. *Holds:* the first bytes say the
//! format, not the name.

use super::normals::Normals;
use super::{Geometry, MAX_TRIANGLES, Soup, gltf, obj};
use crate::files::{FileSource, Noting};
use glam::{DMat4, DVec3};
use std::collections::BTreeSet;

/// The meshes of a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Model {
    pub(crate) parts: Vec<Part>,
    /// The looks that parts refer to.
    pub(crate) looks: Vec<Look>,
    /// The `mtllib` files of an OBJ, as it names them.
    pub(crate) libraries: Vec<String>,
    /// The first camera of the file's scene.
    pub(crate) camera: Option<ModelCamera>,
    /// Sentences on whatever was left out.
    pub(crate) remarks: Vec<String>,
    /// Why there are no parts, if there are none: a scene may take its lights and cameras alone.
    pub(crate) nothing: Option<&'static str>,
}

/// Why a model cannot be read.
#[derive(Clone, Debug)]
pub(crate) struct ModelError {
    /// A sentence about the file, which it does not name.
    pub(crate) sentence: String,
    /// Whether a file that it names cannot be read, rather than its own content.
    pub(crate) is_unread: bool,
}

/// Triangles of one material.
#[derive(Clone, Debug, Default)]
pub(crate) struct Part {
    pub(crate) look: usize,
    pub(crate) soup: Soup,
}

/// A material, in terms of the standard program.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Look {
    pub(crate) name: String,
    pub(crate) diffuse: [f64; 3],
    pub(crate) specular: [f64; 3],
    pub(crate) emission: [f64; 3],
    pub(crate) shininess: f64,
    /// How metallic and how rough it is, if the file says so. Then `diffuse` is its base color, and its highlights follow from it.
    pub(crate) metal: Option<[f64; 2]>,
    /// Its picture of colors.
    pub(crate) texture: Option<TextureSource>,
}

/// The place of an image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum TextureSource {
    /// A file, relative to the one that names it.
    File(String),
    /// An image inside of the model's file, by its number.
    Embedded(u32),
}

impl Look {
    /// Gray, with a slight gloss.
    pub(crate) fn plain(name: &str) -> Self {
        Self {
            name: name.to_owned(),
            diffuse: [0.55; 3],
            specular: [0.15; 3],
            emission: [0.0; 3],
            shininess: 40.0,
            metal: None,
            texture: None,
        }
    }
}

/// A camera of a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ModelCamera {
    pub(crate) eye: DVec3,
    pub(crate) forward: DVec3,
    pub(crate) up: DVec3,
    pub(crate) projection: Projection,
    pub(crate) near: f64,
    pub(crate) far: Option<f64>,
}

/// Its projection.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Projection {
    /// The vertical angle in degrees.
    Perspective(f64),
    /// Half the height of the view.
    Orthographic(f64),
}

impl ModelCamera {
    /// A camera that looks along -z of a node.
    pub(super) fn of_node(node: DMat4, projection: Projection, near: f64, far: Option<f64>) -> Self {
        Self {
            eye: node.transform_point3(DVec3::ZERO),
            forward: node.transform_vector3(DVec3::NEG_Z).normalize_or(DVec3::NEG_Z),
            up: node.transform_vector3(DVec3::Y).normalize_or(DVec3::Y),
            projection,
            near,
            far,
        }
    }
}

/// A part as a geometry.
pub(crate) struct Seen {
    pub(crate) geometry: Geometry,
    /// Whether the file has normals for all of it.
    pub(crate) has_normals: bool,
    /// Whether the file has texture coordinates for all of it.
    pub(crate) has_texcoords: bool,
}

impl Model {
    /// Reads a file.
    ///
    /// # Errors
    /// A sentence about the file, which it does not name, with the line if the format has lines.
    pub(crate) fn read(path: &str, bytes: &[u8], files: &dyn FileSource) -> Result<Self, ModelError> {
        let files = Noting::new(files);
        let read = Self::parse(path, bytes, &files);
        read.map_err(|sentence| ModelError { sentence, is_unread: files.has_failed() })
    }

    fn parse(path: &str, bytes: &[u8], files: &dyn FileSource) -> Result<Self, String> {
        let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        let model = if bytes.starts_with(b"glTF") || text.trim_ascii_start().starts_with(b"{") {
            gltf::read(path, text, files)?
        } else {
            refuse_other_formats(path, bytes)?;
            let read = obj::parse(&String::from_utf8_lossy(text));
            read.map_err(|error| if is_named_gltf(path) { no_gltf(text) } else { error })?
        };
        let triangles: usize = model.parts.iter().map(|part| part.soup.triangles.len()).sum();
        if triangles > MAX_TRIANGLES {
            return Err(format!("it has {triangles} triangles, and a mesh has at most {MAX_TRIANGLES}"));
        }
        Ok(model)
    }

    /// The triangles of one material, or of all, as one geometry.
    pub(crate) fn geometry(&self, look: Option<usize>, normals: Normals) -> Seen {
        let mut seen = Seen { geometry: Geometry::default(), has_normals: true, has_texcoords: true };
        for part in self.parts.iter().filter(|part| look.is_none_or(|look| part.look == look)) {
            let geometry = part.soup.geometry(normals);
            if !geometry.indices.is_empty() {
                seen.geometry.append(geometry);
            }
            seen.has_normals &= part.soup.has_normals();
            seen.has_texcoords &= part.soup.has_texcoords();
        }
        seen
    }

    /// The looks that triangles have, in order.
    pub(crate) fn used(&self) -> Vec<usize> {
        let used = self.parts.iter().filter(|part| !part.soup.triangles.is_empty()).map(|part| part.look);
        used.collect::<BTreeSet<usize>>().into_iter().collect()
    }

    /// Whether any triangle has this look.
    pub(crate) fn uses(&self, look: usize) -> bool {
        self.parts.iter().any(|part| part.look == look && !part.soup.triangles.is_empty())
    }
}

/// Whether the name is that of a glTF file.
fn is_named_gltf(path: &str) -> bool {
    let extension = path.rsplit_once('.').map_or("", |(_, extension)| extension);
    ["gltf", "glb"].iter().any(|known| extension.eq_ignore_ascii_case(known))
}

fn no_gltf(text: &[u8]) -> String {
    match text.trim_ascii() {
        [] => "it is no glTF 2.0: it is empty".to_owned(),
        _ => "it is no glTF 2.0: it begins neither with `{` nor with `glTF`".to_owned(),
    }
}

/// Whether the name is that of a model that a scene can be made of: OBJ or glTF.
pub fn is_model_file(path: &str) -> bool {
    let extension = path.rsplit_once('.').map_or("", |(_, extension)| extension);
    extension.eq_ignore_ascii_case("obj") || is_named_gltf(path)
}

/// The first bytes of other formats.
static OTHERS: &[(&[u8], &str)] = &[
    (b"ply\n", "PLY"),
    (b"ply\r", "PLY"),
    (b"solid ", "STL"),
    (b"Kaydara FBX", "FBX"),
    (b"; FBX", "FBX"),
    (b"BLENDER", "Blender's own format"),
    (b"<?xml", "XML, perhaps COLLADA"),
    (b"\x1f\x8b", "packed by gzip"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x89PNG", "a PNG picture"),
];

fn refuse_other_formats(path: &str, bytes: &[u8]) -> Result<(), String> {
    let known = OTHERS.iter().find(|(magic, _)| bytes.starts_with(magic)).map(|(_, name)| *name);
    let binary_stl = path.to_ascii_lowercase().ends_with(".stl").then_some("STL");
    if let Some(format) = known.or(binary_stl) {
        return Err(format!("it is {format}; meshes are read from Wavefront's OBJ and from glTF 2.0 (.gltf, .glb)"));
    }
    if bytes.contains(&0) {
        return Err("it is binary, and no glTF; meshes are read from Wavefront's OBJ and from glTF 2.0".to_owned());
    }
    Ok(())
}
