//! The materials of a glTF file, in terms of the standard program.
//!
//! *In:* the metallic-roughness model, or the older model of specular and glossiness. *Out:* a [`Look`] for each material, and one for
//! triangles without. *Holds:* metal and roughness stay what they are, for the standard program's GGX. For the older model, the exponent
//! of the highlight is 2 / roughness⁴ - 2, with which Blinn's lobe is as wide as that of GGX.

use super::super::model::{Look, TextureSource};
use gltf::json::material::Material;
use gltf::json::texture::Texture;
use gltf::json::{Index, Root};
use percent_encoding::percent_decode_str;

/// The looks of all materials; the last one is for triangles without a material.
pub(super) fn of(root: &Root, remarks: &mut Vec<String>) -> Vec<Look> {
    let named = |(index, material): (usize, &Material)| {
        let name = material.name.clone().unwrap_or_else(|| format!("material {index}"));
        look(root, material, &name, remarks)
    };
    let mut looks: Vec<Look> = root.materials.iter().enumerate().map(named).collect();
    looks.push(Look::plain(""));
    looks
}

fn look(root: &Root, material: &Material, name: &str, remarks: &mut Vec<String>) -> Look {
    let extensions = material.extensions.as_ref();
    let mut look = Look::plain(name);
    look.emission = material.emissive_factor.0.map(f64::from);
    let texture = match extensions.and_then(|extensions| extensions.pbr_specular_glossiness.as_ref()) {
        Some(older) => {
            let [r, g, b, _] = older.diffuse_factor.0.map(f64::from);
            look.diffuse = [r, g, b];
            look.specular = older.specular_factor.0.map(|factor| f64::from(factor) * 0.5);
            look.shininess = exponent(1.0 - f64::from(older.glossiness_factor.0));
            older.diffuse_texture.as_ref()
        }
        None => {
            let given = &material.pbr_metallic_roughness;
            let [r, g, b, _] = given.base_color_factor.0.map(f64::from);
            let (metal, roughness) = (f64::from(given.metallic_factor.0), f64::from(given.roughness_factor.0));
            // A texture says which parts are metal.
            let metal = if given.metallic_roughness_texture.is_some() { metal * 0.5 } else { metal };
            look.diffuse = [r, g, b];
            look.metal = Some([metal.clamp(0.0, 1.0), roughness.clamp(0.0, 1.0)]);
            given.base_color_texture.as_ref()
        }
    };
    if extensions.is_some_and(|extensions| extensions.unlit.is_some()) {
        (look.emission, look.diffuse, look.specular, look.metal) = (look.diffuse, [0.0; 3], [0.0; 3], None);
    }
    look.texture = texture.and_then(|info| source(root, info.index, name, remarks));
    look
}

fn exponent(roughness: f64) -> f64 {
    (2.0 / roughness.max(0.1).powi(4) - 2.0).clamp(1.0, 512.0)
}

/// The number of the image of a texture that names none: an extension does.
const NO_SOURCE: u32 = u32::MAX;

/// Where the image of a texture is.
pub(super) fn source(
    root: &Root,
    index: Index<Texture>,
    name: &str,
    remarks: &mut Vec<String>,
) -> Option<TextureSource> {
    let number = index.value();
    let Some(texture) = root.get(index) else {
        remarks.push(format!("there is no texture {number}, which `{name}` names: it is left out"));
        return None;
    };
    let Some(image) = root.get(texture.source) else {
        remarks.push(match texture.source.value() as u32 {
            NO_SOURCE => {
                format!("the texture of `{name}` is in a format that is not read (KTX or WebP): it is left out")
            }
            image => format!("there is no image {image}, which the texture of `{name}` names: it is left out"),
        });
        return None;
    };
    match &image.uri {
        Some(uri) if !uri.starts_with("data:") => {
            Some(TextureSource::File(percent_decode_str(uri).decode_utf8_lossy().into_owned()))
        }
        _ => Some(TextureSource::Embedded(u32::try_from(texture.source.value()).ok()?)),
    }
}
