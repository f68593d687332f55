//! Copies of a node's mesh, by the extension `EXT_mesh_gpu_instancing`.
//!
//! *In:* a node. *Out:* the matrix of each copy to the node's space; one of no effect for a node without the extension. *Holds:* there are
//! at most [`MAX_COPIES`]. *Not done here:* attributes of the extension besides the places.

use super::accessor::{self, Numbers};
use super::buffers::Buffers;
use glam::{DMat4, DQuat, DVec3};
use gltf::json::scene::Node;
use gltf::json::{Index, Root, Value};

/// The name of the extension.
pub(super) const EXTENSION: &str = "EXT_mesh_gpu_instancing";

/// The most copies of a mesh that a node has.
const MAX_COPIES: usize = 1 << 16;

/// The places of a node's copies.
///
/// # Errors
/// A sentence about the extension's accessors.
pub(super) fn of(root: &Root, buffers: &mut Buffers<'_>, node: &Node) -> Result<Vec<DMat4>, String> {
    let Some(extension) = node.extensions.as_ref().and_then(|all| all.others.get(EXTENSION)) else {
        return Ok(vec![DMat4::IDENTITY]);
    };
    let mut numbers = |key: &str| -> Result<Option<Numbers>, String> {
        let Some(given) = extension.get("attributes").and_then(|all| all.get(key)) else { return Ok(None) };
        let index = Value::as_u64(given).and_then(|index| u32::try_from(index).ok());
        let index = index.ok_or_else(|| format!("the {key} of its copies is no accessor"))?;
        accessor::read(root, buffers, Index::new(index)).map(Some)
    };
    let places = numbers("TRANSLATION")?.map(|given| given.rows([0.0; 3])).unwrap_or_default();
    let turns = numbers("ROTATION")?.map(|given| given.rows([0.0, 0.0, 0.0, 1.0])).unwrap_or_default();
    let sizes = numbers("SCALE")?.map(|given| given.rows([1.0; 3])).unwrap_or_default();
    let count = places.len().max(turns.len()).max(sizes.len());
    if count > MAX_COPIES {
        return Err(format!("it has {count} copies of its mesh, and at most {MAX_COPIES} are drawn"));
    }
    let copy = |at: usize| {
        let turn = turns.get(at).map_or(DQuat::IDENTITY, |turn| DQuat::from_array(*turn));
        let turn = if turn.length_squared() > 0.0 { turn.normalize() } else { DQuat::IDENTITY };
        let size = sizes.get(at).map_or(DVec3::ONE, |size| DVec3::from(*size));
        let place = places.get(at).map_or(DVec3::ZERO, |place| DVec3::from(*place));
        let matrix = DMat4::from_scale_rotation_translation(size, turn, place);
        if matrix.is_finite() { Ok(matrix) } else { Err(format!("copy {at} of its mesh is not at a finite place")) }
    };
    (0..count).map(copy).collect()
}
