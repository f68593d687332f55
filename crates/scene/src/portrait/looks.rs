//! The materials of a portrait.
//!
//! *In:* a [`Model`]. *Out:* one [`Shown`] for each material that triangles have; one for all if they look alike. *Holds:* a picture that
//! cannot be read is left out, with a remark.

use crate::files::{FileSource, relative_to};
use crate::geometry::{Look, Model, TextureSource, gltf_image, parse_mtl};
use crate::picture::ImageFormat;
use crate::toml_string::toml_string;

/// A draw of a portrait.
pub(super) struct Shown {
    pub(super) look: Look,
    /// The value of the mesh's key `material`, unless it is all of the file.
    pub(super) material: Option<String>,
    /// The file with the colors, as the scene names it, and the number of an image in it.
    pub(super) texture: Option<(String, Option<u32>)>,
}

/// The draws of a model.
pub(super) fn shown(
    model: &Model,
    path: &str,
    name: &str,
    files: &dyn FileSource,
    remarks: &mut Vec<String>,
) -> Vec<Shown> {
    let libraries = libraries(model, path, files, remarks);
    let mut shown: Vec<Shown> = (0..model.looks.len())
        .filter(|look| model.uses(*look))
        .filter_map(|number| {
            let own = model.looks.get(number)?;
            let look = libraries.iter().find(|look| look.name == own.name).unwrap_or(own).clone();
            let texture = look.texture.as_ref().and_then(|source| texture(source, path, name, files, remarks));
            let is_unique = model.looks.iter().filter(|look| look.name == own.name).count() == 1;
            let material = if is_unique { toml_string(&own.name) } else { number.to_string() };
            Some(Shown { look, material: Some(material), texture })
        })
        .collect();
    for shown in shown.iter_mut().filter(|shown| shown.look.texture.is_some() && shown.texture.is_none()) {
        // What the picture would have colored.
        shown.look.diffuse = shown.look.diffuse.map(|color| color * 0.7);
    }
    let alike = |one: &Shown, other: &Shown| {
        Look { name: String::new(), ..one.look.clone() } == Look { name: String::new(), ..other.look.clone() }
            && one.texture == other.texture
    };
    if let [first, rest @ ..] = shown.as_mut_slice()
        && rest.iter().all(|other| alike(first, other))
    {
        first.material = None;
        shown.truncate(1);
    }
    shown
}

/// The materials of the libraries that an OBJ names.
fn libraries(model: &Model, path: &str, files: &dyn FileSource, remarks: &mut Vec<String>) -> Vec<Look> {
    let mut looks = Vec::new();
    for library in &model.libraries {
        let place = relative_to(path, &library.replace('\\', "/"));
        match files.read(&place).map(|bytes| parse_mtl(&String::from_utf8_lossy(&bytes))) {
            Ok(Ok(found)) => looks.extend(found),
            Ok(Err(error)) => remarks.push(format!("the materials of `{place}` are left out: {error}")),
            Err(error) => remarks.push(format!("the materials of `{place}` are left out: {error}")),
        }
    }
    looks
}

/// A texture that a scene can have.
pub(super) fn texture(
    source: &TextureSource,
    path: &str,
    name: &str,
    files: &dyn FileSource,
    remarks: &mut Vec<String>,
) -> Option<(String, Option<u32>)> {
    let (what, read, place) = match source {
        TextureSource::File(file) => {
            let read = files.read(&relative_to(path, file)).map_err(|error| error.to_string());
            (format!("the texture `{file}`"), read, (relative_to(name, file), None))
        }
        TextureSource::Embedded(number) => {
            let bytes = files.read(path).map_err(|error| error.to_string());
            let read = bytes.and_then(|bytes| gltf_image(path, &bytes, *number, files));
            (format!("the texture in image {number}"), read, (name.to_owned(), Some(*number)))
        }
    };
    match read {
        Ok(bytes) if ImageFormat::can_read(&bytes) => Some(place),
        Ok(_) => {
            remarks.push(format!("{what} is in a format that is not read, and is left out"));
            None
        }
        Err(error) => {
            remarks.push(format!("{what} is left out: {error}"));
            None
        }
    }
}
