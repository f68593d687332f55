//! The contents of a glTF file besides its triangles: materials, lights, cameras.
//!
//! *In:* the document. *Out:* [`Contents`]: materials by the metallic-roughness model with its extensions, the lights of
//! `KHR_lights_punctual` and the cameras in world space, in the order of a walk from the scene's roots. *Holds:* numbers are finite
//! as f32; whatever cannot be shown is a remark. *Not done here:* triangles, and the data of images.

use super::lamps::{Lamp, Lamps};
use super::nodes::Nodes;
use super::surface::{self, Surface};
use crate::geometry::model::ModelCamera;

/// The most lights of a file.
pub(crate) const MAX_LAMPS: usize = 64;

/// All that a scene takes from a file but its triangles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Contents {
    /// By the numbers of a model's looks: the last one is for triangles without a material.
    pub(crate) materials: Vec<Surface>,
    pub(crate) lamps: Vec<Lamp>,
    pub(crate) cameras: Vec<(String, ModelCamera)>,
    /// Sentences on whatever is left out.
    pub(crate) remarks: Vec<String>,
}

/// Reads the contents of a file. `surrounded` is whether a scene says what light comes from all around.
///
/// # Errors
/// A sentence about the file.
pub(crate) fn contents(bytes: &[u8], surrounded: bool) -> Result<Contents, String> {
    let (root, _) = super::document(bytes)?;
    super::check_extensions(&root)?;
    let nodes = Nodes::of(&root)?;
    let mut contents = Contents::default();
    let lamps = Lamps::of(&root)?;
    for &number in &nodes.order {
        let Some(node) = root.nodes.get(number) else { continue };
        let world = nodes.world(number);
        let remarks = &mut contents.remarks;
        if let Some(camera) = node.camera.and_then(|camera| super::model_camera(&root, camera, world, remarks)) {
            let own = node.camera.and_then(|camera| root.get(camera)?.name.clone());
            let name = own.or_else(|| node.name.clone()).unwrap_or_default();
            contents.cameras.push((name, camera));
        }
        let lamp = lamps.at(node, world).map_err(|error| format!("node {number}: {error}"))?;
        contents.lamps.extend(lamp);
        if contents.lamps.len() > MAX_LAMPS {
            return Err(format!("its scene has more than {MAX_LAMPS} lights, the most that a scene takes from a file"));
        }
    }
    for (number, material) in root.materials.iter().enumerate() {
        let name = material.name.clone().unwrap_or_else(|| format!("material {number}"));
        let read = surface::of(&root, (material, surrounded), &name, &mut contents.remarks);
        contents.materials.push(read.map_err(|error| format!("`{name}`: {error}"))?);
    }
    contents.materials.push(Surface::default());
    Ok(contents)
}

/// Whether the bytes are those of a glTF file, by how they begin.
pub(crate) fn is_gltf(bytes: &[u8]) -> bool {
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    bytes.starts_with(b"glTF") || text.trim_ascii_start().starts_with(b"{")
}
