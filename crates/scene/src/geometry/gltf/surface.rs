//! The materials of a glTF file, for the standard program with `GLISTEN_SURFACE`.
//!
//! *In:* the metallic-roughness model, with the extensions for emission, index of refraction, specular color, layers, no light.
//! *Out:* a [`Surface`]. *Holds:* what other extensions and textures would change is a remark.

use super::layers::{self, Setting};
use super::maps::{self, Map};
use super::numbers::{number, triple};
use gltf::json::material::{AlphaMode, Material};
use gltf::json::validation::Checked;
use gltf::json::{Root, Value};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Surface {
    pub(crate) name: String,
    pub(crate) base_color: [f64; 3],
    pub(crate) alpha: f64,
    pub(crate) covering: Covering,
    pub(crate) metallic: f64,
    pub(crate) roughness: f64,
    pub(crate) emission: [f64; 3],
    /// The light that its parts without metal mirror at normal incidence.
    pub(crate) dielectric: [f64; 3],
    /// Whether no light changes it.
    pub(crate) is_unlit: bool,
    pub(crate) is_two_sided: bool,
    pub(crate) normal_scale: f64,
    pub(crate) occlusion_strength: f64,
    pub(crate) maps: Vec<Map>,
    /// The settings that extensions add.
    pub(crate) layers: Vec<Setting>,
}

/// How a surface covers what is behind it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Covering {
    Opaque,
    /// Where its alpha is at least this.
    Mask(f64),
    Blend,
}

impl Surface {
    /// Whether an extension adds a setting.
    pub(super) fn has(&self, wanted: &str) -> bool {
        self.layers.iter().any(|(key, _)| *key == wanted)
    }
}

impl Default for Surface {
    /// A material without any key (§3.9.6).
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 3],
            alpha: 1.0,
            covering: Covering::Opaque,
            metallic: 1.0,
            roughness: 1.0,
            emission: [0.0; 3],
            dielectric: [0.04; 3],
            is_unlit: false,
            is_two_sided: false,
            normal_scale: 1.0,
            occlusion_strength: 1.0,
            maps: Vec::new(),
            layers: Vec::new(),
        }
    }
}

/// The surface of a material.
///
/// # Errors
/// A sentence about one of its numbers.
pub(super) fn of(
    root: &Root,
    (material, surrounded): (&Material, bool),
    name: &str,
    remarks: &mut Vec<String>,
) -> Result<Surface, String> {
    let extension = |key: &str| material.extensions.as_ref().and_then(|all| all.others.get(key));
    let given = &material.pbr_metallic_roughness;
    let [r, g, b, alpha] = finite(given.base_color_factor.0)?;
    let none = Value::Null;
    let strength = extension("KHR_materials_emissive_strength").unwrap_or(&none);
    let strength = number(strength, "emissiveStrength", 1.0)?;
    let mut surface = Surface {
        name: name.to_owned(),
        base_color: [r, g, b],
        alpha,
        covering: covering(material)?,
        metallic: part(given.metallic_factor.0)?,
        roughness: part(given.roughness_factor.0)?,
        emission: finite(material.emissive_factor.0)?.map(|channel| channel * strength),
        dielectric: dielectric(extension("KHR_materials_ior"), extension("KHR_materials_specular"))?,
        layers: layers::of(material, surrounded)?,
        is_unlit: material.extensions.as_ref().is_some_and(|all| all.unlit.is_some()),
        is_two_sided: material.double_sided,
        ..Surface::default()
    };
    if surface.emission.iter().any(|channel| !(*channel as f32).is_finite()) {
        return Err("its emission is not finite".to_owned());
    }
    if material.extensions.as_ref().is_some_and(|all| all.pbr_specular_glossiness.is_some()) {
        remarks.push(format!(
            "`{name}` is by KHR_materials_pbrSpecularGlossiness, and is drawn by its metal and roughness instead"
        ));
    }
    if surface.has("refraction") {
        remarks.push(format!("`{name}` shows the environment through itself, bent as by a ball, and nothing else"));
    } else if surface.has("transmission") {
        if layers::is_thick(material)? {
            remarks.push(format!(
                "light passes straight through `{name}`: it refracts nothing, as the scene has no `[environment]`"
            ));
        }
        if surface.roughness > 0.0 {
            remarks.push(format!("what is behind `{name}` is not blurred by its roughness"));
        }
    }
    surface.maps = maps::of(root, material, name, remarks)?;
    if let Some(normal) = &material.normal_texture {
        [surface.normal_scale] = finite([normal.scale])?;
    }
    if let Some(occlusion) = &material.occlusion_texture {
        surface.occlusion_strength = part(occlusion.strength.0)?;
    }
    Ok(surface)
}

fn covering(material: &Material) -> Result<Covering, String> {
    Ok(match material.alpha_mode {
        Checked::Valid(AlphaMode::Mask) => {
            let cutoff = material.alpha_cutoff.as_ref().map_or(0.5, |cutoff| cutoff.0);
            let [cutoff] = finite([cutoff])?;
            Covering::Mask(cutoff)
        }
        Checked::Valid(AlphaMode::Blend) => Covering::Blend,
        _ => Covering::Opaque,
    })
}

/// The light at normal incidence that a dielectric mirrors: by its index of refraction, times a color. Its strength is a layer.
fn dielectric(ior: Option<&Value>, specular: Option<&Value>) -> Result<[f64; 3], String> {
    let ior = ior.map_or(Ok(1.5), |table| number(table, "ior", 1.5))?;
    let none = Value::Null;
    let specular = specular.unwrap_or(&none);
    let color = triple(specular, "specularColorFactor", [1.0; 3])?;
    // 0 is for a surface that mirrors everything (KHR_materials_ior).
    let mirrored = if ior > 0.0 { ((ior - 1.0) / (ior + 1.0)).powi(2) } else { 1.0 };
    Ok(color.map(|channel| (mirrored * channel.max(0.0)).min(1.0)))
}

fn finite<const N: usize>(numbers: [f32; N]) -> Result<[f64; N], String> {
    if numbers.iter().all(|number| number.is_finite()) {
        return Ok(numbers.map(f64::from));
    }
    Err("it has numbers that are not finite".to_owned())
}

fn part(number: f32) -> Result<f64, String> {
    finite([number]).map(|[number]| number.clamp(0.0, 1.0))
}
