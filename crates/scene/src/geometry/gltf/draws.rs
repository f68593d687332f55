//! A material of a glTF file as text of a scene.
//!
//! *In:* a [`Surface`]. *Out:* TOML: a `[[draw]]` with its material. *Holds:* every number reads as itself in f32, which is what scenes
//! have.

use super::super::model::TextureSource;
use super::maps::Map;
use super::surface::{Covering, Surface};
use crate::files::relative_to;
use crate::toml_string::toml_string;
use std::fmt::Write;

/// Whether a surface shows what is behind it.
pub(crate) fn is_blended(surface: &Surface) -> bool {
    surface.covering == Covering::Blend || is_glass(surface)
}

/// Whether what is behind a surface is seen through it. A body that bends light shows only what is all around.
fn is_glass(surface: &Surface) -> bool {
    !surface.is_unlit && surface.has("transmission") && !surface.has("refraction")
}

/// The values of `transmission_pass` of a surface's draws.
pub(crate) fn passes(surface: &Surface) -> &'static [&'static str] {
    if is_glass(surface) { &["through", "surface"] } else { &["all"] }
}

/// `[[draw]]` for the triangles of a material. Light passes through glass in two draws: the first one multiplies what is behind by the
/// glass' color, the second one adds what it mirrors.
pub(crate) fn draw(text: &mut String, file: &str, look: usize, (surface, pass): (&Surface, &str), is_colored: bool) {
    let cull = if surface.is_two_sided { "none" } else { "back" };
    let _ = writeln!(
        text,
        "\n[[draw]]\nprogram = \"standard\"\ndepth_test = true\ncull = \"{cull}\"\n\
         mesh = {{ file = {}, material = {look} }}",
        toml_string(file)
    );
    let blend = match pass {
        "through" => Some("multiply"),
        "surface" => Some("add"),
        _ => (surface.covering == Covering::Blend).then_some("alpha"),
    };
    if let Some(blend) = blend {
        let _ = writeln!(text, "blend = \"{blend}\"\ndepth_write = false");
    }
    let _ = writeln!(text, "\n[draw.material]\ntwo_sided = {}", surface.is_two_sided);
    let color = triple(surface.base_color);
    let _ = if surface.is_unlit {
        writeln!(
            text,
            "diffuse_model = \"none\"\nspecular_model = \"none\"\ndiffuse = [0.0, 0.0, 0.0]\n\
             specular = [0.0, 0.0, 0.0]\nemission = {color}"
        )
    } else {
        writeln!(
            text,
            "base_color = {color}\nmetallic = {:?}\nroughness = {:?}\ndielectric = {}\nemission = {}",
            surface.metallic as f32,
            surface.roughness as f32,
            triple(surface.dielectric),
            triple(surface.emission)
        )
    };
    let has = |key: &str| surface.maps.iter().any(|map| map.key == key);
    // How thin a film is at least matters where a texture says how thick it is.
    let matters = |key: &str| key != "iridescence_thinnest" || has("iridescence_thickness_map");
    for (key, values) in surface.layers.iter().filter(|(key, _)| !surface.is_unlit && matters(key)) {
        let values: Vec<f32> = values.iter().map(|value| *value as f32).collect();
        let _ = match values.as_slice() {
            [value] => writeln!(text, "{key} = {value:?}"),
            values => writeln!(text, "{key} = {values:?}"),
        };
    }
    if pass != "all" {
        let _ = writeln!(text, "transmission_pass = \"{pass}\"");
    }
    let _ = match surface.covering {
        Covering::Opaque => Ok(()),
        Covering::Mask(cutoff) => {
            writeln!(text, "alpha = {:?}\nalpha_cutoff = {:?}", surface.alpha as f32, cutoff as f32)
        }
        Covering::Blend => writeln!(text, "alpha = {:?}", surface.alpha as f32),
    };
    if is_colored {
        text.push_str("vertex_colors = true\n");
    }
    if surface.is_unlit {
        let base = surface.maps.iter().find(|map| map.key == BASE_COLOR);
        base.into_iter().for_each(|map| [BASE_COLOR, EMISSION].iter().for_each(|key| write_map(text, file, key, map)));
        return;
    }
    if has("occlusion_map") {
        let _ = writeln!(text, "occlusion_strength = {:?}", surface.occlusion_strength as f32);
    }
    if has("normal_map") {
        let _ = writeln!(text, "normal_scale = {:?}", surface.normal_scale as f32);
    }
    surface.maps.iter().for_each(|map| write_map(text, file, map.key, map));
}

const BASE_COLOR: &str = "decal";
const EMISSION: &str = "emission_map";

/// A texture of a material, in a file next to the glTF file or in it.
fn write_map(text: &mut String, file: &str, key: &str, map: &Map) {
    let (name, image) = match &map.source {
        TextureSource::File(name) => (relative_to(file, name), String::new()),
        TextureSource::Embedded(number) => (file.to_owned(), format!(", image = {number}")),
    };
    let filter = if map.is_nearest { "filter = \"nearest\"" } else { "filter = \"trilinear\", mipmaps = true" };
    let decode = if map.is_encoded { "srgb" } else { "linear" };
    let (name, wrap) = (toml_string(&name), map.wrap);
    let transform = map.transform.map_or_else(String::new, |transform| {
        let (scale, rotate, translate) = (transform.scale, transform.rotate, transform.translate);
        let set = if transform.is_second { ", set = 1" } else { "" };
        format!(", transform = {{ scale = {scale:?}, rotate = {rotate:?}, translate = {translate:?}{set} }}")
    });
    let _ = writeln!(
        text,
        "{key} = {{ file = {name}{image}, decode = \"{decode}\", wrap = \"{wrap}\", {filter}{transform} }}"
    );
}

fn triple(values: [f64; 3]) -> String {
    let [x, y, z] = values.map(|value| value as f32 + 0.0);
    format!("[{x:?}, {y:?}, {z:?}]")
}
