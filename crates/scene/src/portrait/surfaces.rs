//! The draws of a portrait of a glTF file: its materials as a `[[scene]]` has them.
//!
//! *In:* a [`Model`] and the bytes of its file. *Out:* TOML. *Holds:* a texture that cannot be read is left out, with a remark. *Not done
//! here:* lights and cameras.

use super::looks::texture;
use crate::files::FileSource;
use crate::geometry::{Model, Surface, gltf_contents, gltf_draw, is_blended, passes};

/// Writes a draw for each material that triangles have; two for glass.
///
/// # Errors
/// A sentence about the file.
pub(super) fn write(
    text: &mut String,
    model: &Model,
    bytes: &[u8],
    (path, name, files): (&str, &str, &dyn FileSource),
    remarks: &mut Vec<String>,
) -> Result<(), String> {
    let contents = gltf_contents(bytes, false)?;
    remarks.extend(contents.remarks);
    let mut draws: Vec<(usize, Surface)> = Vec::new();
    for look in model.used() {
        let mut surface =
            contents.materials.get(look).cloned().ok_or_else(|| format!("there is no material {look}"))?;
        surface.maps.retain(|map| texture(&map.source, path, name, files, remarks).is_some());
        draws.push((look, surface));
    }
    // What can be seen through is drawn over the rest.
    draws.sort_by_key(|(_, surface)| is_blended(surface));
    for (look, surface) in &draws {
        let is_colored = model.parts.iter().filter(|part| part.look == *look).all(|part| !part.soup.colors.is_empty());
        for pass in passes(surface) {
            gltf_draw(text, name, *look, (surface, pass), is_colored);
        }
    }
    Ok(())
}
