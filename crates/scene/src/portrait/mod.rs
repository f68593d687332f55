//! [`portrait`]: the text of a scene that shows a model from the disk.
//!
//! *In:* the path of an OBJ or glTF file. *Out:* TOML: the standard program, a camera that frames the model, three lights, a draw for each
//! material. *Holds:* the scene loads without a diagnostic; what the file has and cannot be shown is a remark.

mod camera;
mod looks;
mod surfaces;

use crate::files::{FileError, FileSource};
use crate::geometry::{Framing, Model, ModelError, Normals, is_gltf};
use crate::toml_string::toml_string;
use looks::Shown;
use std::collections::BTreeSet;
use std::fmt::Write;

pub use crate::geometry::is_model_file;

/// The scene of a model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Portrait {
    /// The scene file's text.
    pub text: String,
    /// Sentences on whatever the model has and the scene does not show.
    pub remarks: Vec<String>,
}

/// Why there is no scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PortraitError {
    /// The model's file cannot be read.
    File(FileError),
    /// The file is no model; a sentence.
    Model(String),
    /// A file that the model names cannot be read; a sentence.
    Part(String),
}

impl From<ModelError> for PortraitError {
    fn from(error: ModelError) -> Self {
        if error.is_unread { Self::Part(error.sentence) } else { Self::Model(error.sentence) }
    }
}

/// The scene for the model at `path`, which the scene names as `name`.
///
/// # Errors
/// The file cannot be read, or is no model.
pub fn portrait(path: &str, name: &str, files: &dyn FileSource) -> Result<Portrait, PortraitError> {
    let bytes = files.read(path).map_err(PortraitError::File)?;
    let model = Model::read(path, &bytes, files)?;
    if let Some(nothing) = model.nothing {
        return Err(PortraitError::Model(nothing.to_owned()));
    }
    let framing =
        Framing::of(&model).ok_or_else(|| PortraitError::Model("all of its triangles are without area".to_owned()))?;
    let mut text = head(&model, name);
    camera::write(&framing, &mut text);
    let mut remarks = model.remarks.clone();
    if is_gltf(&bytes) {
        surfaces::write(&mut text, &model, &bytes, (path, name, files), &mut remarks).map_err(PortraitError::Model)?;
    } else {
        let shown = looks::shown(&model, path, name, files, &mut remarks);
        shown.iter().for_each(|shown| draw(&mut text, name, shown));
    }
    // What is left out of a texture that several materials have is said once.
    let mut said = BTreeSet::new();
    remarks.retain(|remark| said.insert(remark.clone()));
    Ok(Portrait { text, remarks })
}

/// The comment at the beginning, and the framebuffer.
fn head(model: &Model, name: &str) -> String {
    let triangles: usize = model.parts.iter().map(|part| part.soup.triangles.len()).sum();
    let seen = |has: fn(&crate::geometry::Soup) -> bool| model.parts.iter().all(|part| has(&part.soup));
    let mut notes = String::new();
    if !seen(crate::geometry::Soup::has_normals) {
        let _ = writeln!(
            notes,
            "# The file does not have normals for all faces: they are smooth up to an angle of {} degrees (`crease` of a mesh).",
            Normals::CREASE
        );
    }
    if !seen(crate::geometry::Soup::has_texcoords) {
        notes.push_str("# It does not have texture coordinates for all faces: they are (0, 0).\n");
    }
    let name = name.replace(['\n', '\r'], " ");
    format!(
        "# {name}: {triangles} triangles\n{notes}\n[framebuffer]\nwidth = 512\nheight = 512\n\
         clear = [0.03, 0.034, 0.042, 1.0]\nencode = \"srgb\"\n"
    )
}

fn draw(text: &mut String, name: &str, shown: &Shown) {
    let material = shown.material.as_ref().map_or_else(String::new, |material| format!(", material = {material}"));
    let _ = write!(
        text,
        "\n[[draw]]\nprogram = \"standard\"\ndepth_test = true\nmesh = {{ file = {}{material} }}\n\n[draw.material]\n",
        toml_string(name)
    );
    let look = &shown.look;
    let _ = match look.metal {
        Some([metallic, roughness]) => writeln!(
            text,
            "base_color = {}\nmetallic = {}\nroughness = {}",
            triple(look.diffuse, 1.0),
            number(metallic, 1.0),
            number(roughness, 1.0)
        ),
        None => writeln!(text, "diffuse = {}\nspecular = {}", triple(look.diffuse, 1.0), triple(look.specular, 1.0)),
    };
    if look.emission != [0.0; 3] {
        let _ = writeln!(text, "emission = {}", triple(look.emission, 1.0));
    }
    if look.metal.is_none() {
        let _ = writeln!(text, "shininess = {}", number(look.shininess, 1.0));
    }
    if let Some((file, image)) = &shown.texture {
        let image = image.map_or_else(String::new, |image| format!(", image = {image}"));
        let _ = writeln!(
            text,
            "decal = {{ file = {}{image}, decode = \"srgb\", filter = \"trilinear\", mipmaps = true }}",
            toml_string(file)
        );
    }
}

/// A number, rounded to what matters for things of a size.
fn number(value: f64, size: f64) -> String {
    let digits = (4.0 - size.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let rounded: f64 = format!("{value:.digits$}").parse().unwrap_or(value);
    format!("{:?}", rounded + 0.0)
}

fn triple(values: [f64; 3], size: f64) -> String {
    format!("[{}]", values.map(|value| number(value, size)).join(", "))
}
