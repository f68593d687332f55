//! Reads meshes in glTF 2.0, as JSON or binary.
//!
//! *In:* the bytes of the file, and a [`FileSource`] for its buffers. *Out:* a [`Model`]: the meshes of the file's scene in world space,
//! with skins in the pose that the nodes give them. *Holds:* every index and offset is checked; nodes are visited once, so that a
//! cycle ends. Points, lines, morph targets and animations are left out.

mod accessor;
mod buffers;
mod contents;
mod draws;
mod instances;
mod lamps;
mod layers;
mod looks;
mod maps;
mod nodes;
mod numbers;
mod primitives;
mod surface;

use super::model::{Model, ModelCamera, Projection};
use crate::files::FileSource;
use buffers::Buffers;
pub(crate) use contents::{Contents, contents, is_gltf};
pub(crate) use draws::{draw, is_blended, passes};
use glam::DMat4;
use gltf::json::{Index, Root, camera::Camera};
pub(crate) use lamps::{Lamp, LampKind};
use nodes::Nodes;
use primitives::Builder;
pub(crate) use surface::Surface;

/// Extensions that a file may require: they do not change where its triangles are.
static HARMLESS: &[&str] = &[
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    instances::EXTENSION,
    "KHR_texture_transform",
    "KHR_texture_basisu",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_xmp_json_ld",
];

/// Extensions that compress meshes.
static COMPRESSED: &[(&str, &str)] = &[
    ("KHR_draco_mesh_compression", "Draco"),
    ("EXT_meshopt_compression", "meshopt"),
    ("KHR_meshopt_compression", "meshopt"),
];

/// Reads a file; `path` is where it is, so that its buffers are found.
///
/// # Errors
/// A sentence about the file.
pub(super) fn read(path: &str, bytes: &[u8], files: &dyn FileSource) -> Result<Model, String> {
    let (root, blob) = document(bytes)?;
    check_extensions(&root)?;
    let buffers = Buffers::new(path, &root, blob, files);
    let nodes = Nodes::of(&root)?;
    let mut builder = Builder::new(&root, buffers);
    let (mut camera, mut left_out) = (None, Vec::from_iter(nodes.remark()));
    for &node in &nodes.order {
        let Some(found) = root.nodes.get(node) else { continue };
        let world = nodes.world(node);
        if let Some(mesh) = found.mesh {
            let named = |error: String| format!("node {node}: {error}");
            for copy in builder.copies(found).map_err(named)? {
                builder.mesh(mesh, found.skin, world * copy, &nodes).map_err(named)?;
            }
        }
        camera = camera.or_else(|| model_camera(&root, found.camera?, world, &mut left_out));
    }
    let (parts, mut remarks) = builder.finish();
    remarks.append(&mut left_out);
    let why = if root.meshes.is_empty() { "it has no meshes" } else { "its scene has no triangles" };
    let nothing = parts.is_empty().then_some(why);
    let looks = looks::of(&root, &mut remarks);
    Ok(Model { parts, looks, camera, remarks, nothing, ..Model::default() })
}

/// The image of a number in a file.
///
/// # Errors
/// A sentence about the file or the image.
pub(crate) fn image(path: &str, bytes: &[u8], number: u32, files: &dyn FileSource) -> Result<Vec<u8>, String> {
    let (root, blob) = document(bytes)?;
    let mut buffers = Buffers::new(path, &root, blob, files);
    let count = root.images.len();
    let image = root.images.get(number as usize);
    let image = image.ok_or_else(|| format!("it has {count} images, and none of number {number}"))?;
    match (&image.uri, image.buffer_view) {
        (Some(uri), _) => buffers.uri(uri),
        (None, Some(view)) => buffers.view(view).map(<[u8]>::to_vec),
        (None, None) => Err(format!("image {number} has no data")),
    }
    .map_err(|error| format!("image {number}: {error}"))
}

/// The JSON of a file, and the chunk of a binary one.
fn document(bytes: &[u8]) -> Result<(Root, Option<Vec<u8>>), String> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let malformed = |error: &dyn std::fmt::Display| format!("it is no glTF 2.0: {error}");
    let (json, blob) = if bytes.starts_with(b"glTF") {
        if bytes.len() < 20 {
            return Err("it is no glTF 2.0: the file ends in its header".to_owned());
        }
        let glb = gltf::Glb::from_slice(bytes).map_err(|error| malformed(&error))?;
        (glb.json.into_owned(), glb.bin.map(std::borrow::Cow::into_owned))
    } else {
        (bytes.to_vec(), None)
    };
    let root: Root = gltf::json::deserialize::from_slice(&json).map_err(|error| malformed(&error))?;
    if !root.asset.version.starts_with("2.") {
        return Err(format!("it is glTF {}, and version 2.0 is read", root.asset.version));
    }
    Ok((root, blob))
}

fn check_extensions(root: &Root) -> Result<(), String> {
    for name in &root.extensions_required {
        if let Some((_, method)) = COMPRESSED.iter().find(|(known, _)| known == name) {
            return Err(format!("its meshes are compressed by {method} ({name}): export it without compression"));
        }
        let harmless = HARMLESS.contains(&name.as_str()) || name.starts_with("KHR_materials_");
        if !harmless {
            return Err(format!("it requires the extension {name}, which is not read"));
        }
    }
    Ok(())
}

/// A camera in world space; a remark says why there is none.
fn model_camera(root: &Root, camera: Index<Camera>, world: DMat4, remarks: &mut Vec<String>) -> Option<ModelCamera> {
    let number = camera.value();
    let found = root.get(camera).ok_or_else(|| format!("there is no camera {number}, which a node names"));
    found
        .and_then(|camera| placed(camera, world).map_err(|why| format!("camera {number} is left out: {why}")))
        .map_err(|remark| remarks.push(remark))
        .ok()
}

fn placed(camera: &Camera, world: DMat4) -> Result<ModelCamera, &'static str> {
    let camera = match (&camera.perspective, &camera.orthographic) {
        (Some(given), _) => {
            let angle = f64::from(given.yfov).to_degrees();
            ModelCamera::of_node(world, Projection::Perspective(angle), given.znear.into(), given.zfar.map(f64::from))
        }
        (None, Some(given)) => {
            let half = Projection::Orthographic(given.ymag.into());
            ModelCamera::of_node(world, half, given.znear.into(), Some(given.zfar.into()))
        }
        (None, None) => return Err("it is neither perspective nor orthographic"),
    };
    let is_sound = match camera.projection {
        Projection::Perspective(angle) => angle > 1.0 && angle < 179.0 && camera.near > 0.0,
        Projection::Orthographic(half) => half > 0.0,
    };
    let sees = is_sound && camera.eye.is_finite() && camera.far.is_none_or(|far| far > camera.near);
    sees.then_some(camera).ok_or("its angle, its height or its planes leave it no view")
}
