//! `[[scene]]`: the meshes, materials, lights and the camera of a glTF file as draws of a scene.
//!
//! *In:* the table: `gltf`, which camera, whether its lights, a transform, keys of materials and draws that take precedence. *Out:*
//! [`Imported`]: tables of draws, lights and a camera as if the scene had them. *Holds:* what the file says has the span of its name
//! in the scene, what the scene says has its own, so that every error has a place. *Not done here:* reading these tables.

mod text;

use super::Loader;
use super::lights::Light;
use super::matrices::load_transform;
use crate::geometry::{Contents, Framing, Model, ModelCamera, gltf_contents, gltf_draw, is_blended, is_gltf, passes};
use crate::tables::{Node, NumberValue, Reader};
use glam::{DMat4, DVec3};
use glisten_front::diagnostic::codes::scenes::{MODEL_SIMPLIFIED, SCENE_BAD_ASSET, SCENE_WRONG_VALUE};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use std::ops::Range;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

const KEYS: &[&str] = &["gltf", "camera", "lights", "refraction", "transform", "material", "materials", "draw"];

/// The most draws of a file.
const MAX_DRAWS: usize = 1024;

/// Whether a scene leaves its camera and its lights to files.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wants {
    pub(super) camera: bool,
    pub(super) lights: bool,
    /// Whether it says what light comes from all around, which a thick body bends.
    pub(super) surrounded: bool,
}

/// A file as the text of a scene, and what takes precedence over it.
pub(super) struct Written<'t, 'i> {
    text: String,
    /// The range of the file's name in the scene.
    place: Range<usize>,
    /// The name of each draw's material.
    names: Vec<String>,
    transform: Option<&'t Node<'i>>,
    material: Option<&'t Node<'i>>,
    materials: Option<&'t DeTable<'i>>,
    draw: Option<&'t DeTable<'i>>,
}

/// A file as tables of a scene.
pub(super) struct Imported<'i> {
    pub(super) draws: Vec<Node<'i>>,
    pub(super) lights: Vec<Light>,
    pub(super) camera: Option<DeTable<'i>>,
}

/// A table of the scene, and what its file has.
struct Source<'t, 'i> {
    table: &'t DeTable<'i>,
    /// The file as the scene names it, and where.
    name: String,
    place: Range<usize>,
    path: String,
    model: Arc<Model>,
    contents: Contents,
    transform: DMat4,
}

/// The files of a scene; `None` (reported) if one of them cannot be taken.
pub(super) fn write<'t, 'i>(
    loader: &mut Loader<'_>,
    scene: &'t DeTable<'i>,
    wants: Wants,
) -> Option<Vec<Written<'t, 'i>>> {
    let Some(node) = scene.get("scene") else { return Some(Vec::new()) };
    let Some(nodes) = node.get_ref().as_array() else {
        loader.reader.wrong_type(node, "scene", "a list of tables, each headed `[[scene]]`");
        return None;
    };
    let sources: Vec<Option<Source<'t, 'i>>> =
        nodes.iter().map(|node| source(loader, node, wants.surrounded)).collect();
    let sources: Vec<Source<'t, 'i>> = sources.into_iter().collect::<Option<_>>()?;
    // What is placed, of all files: cameras see all of it.
    let points: Vec<DVec3> = sources.iter().flat_map(Source::points).collect();
    let first = sources.iter().position(|source| source.model.nothing.is_none());
    let has_lamps = |source: &Source<'_, '_>| !source.contents.lamps.is_empty() && takes_lights(source.table);
    let portrait = wants.lights && !sources.iter().any(has_lamps);
    let mut wants_camera = wants.camera;
    let mut written = Vec::new();
    for (index, source) in sources.iter().enumerate() {
        let camera = choose_camera(&mut loader.reader, source)?;
        let camera = camera.filter(|_| wants_camera);
        wants_camera &= camera.is_none();
        written.push((source, camera, Some(index) == first));
    }
    // Without any camera, one frames the first file with meshes.
    let frames = wants_camera;
    let written = written.into_iter().map(|(source, camera, leads)| {
        write_one(loader, source, (camera, &points), (leads && portrait, leads && frames))
    });
    written.collect()
}

impl Source<'_, '_> {
    /// The points of its meshes in the scene.
    fn points(&self) -> impl Iterator<Item = DVec3> + '_ {
        let points = self.model.parts.iter().flat_map(|part| &part.soup.positions);
        points.map(|point| self.transform.transform_point3((*point).into()))
    }
}

fn takes_lights(table: &DeTable<'_>) -> bool {
    table.get("lights").and_then(|node| node.get_ref().as_bool()).unwrap_or(true)
}

/// Reads the file of a table.
fn source<'t, 'i>(loader: &mut Loader<'_>, node: &'t Node<'i>, surrounded: bool) -> Option<Source<'t, 'i>> {
    let table = loader.reader.table(node, "scene")?;
    loader.reader.check_keys(table, "a scene of a file", KEYS);
    let Some(file) = table.get("gltf") else {
        if !loader.reader.is_misspelled(table, "gltf") {
            let span = loader.reader.span_of(node);
            loader.missing_key(
                span,
                "a `[[scene]]` names its glTF file",
                "add `gltf = \"..\"`, relative to the scene file",
            );
        }
        return None;
    };
    let span = loader.reader.span_of(file);
    let name = loader.reader.text(file, "gltf")?.to_owned();
    loader.reader.flag(table, "lights", true);
    let transform = match loader.reader.table_at(table, "transform") {
        Some(own) => load_transform(&mut loader.reader, own),
        None => DMat4::IDENTITY,
    };
    let (path, model) = loader.model(&name, span)?;
    let (_, bytes) = loader.bytes(&name, span)?;
    if !is_gltf(&bytes) {
        let message = format!("`{path}` is no glTF file: it has meshes, but no scene");
        let diagnostic = Diagnostic::new(&SCENE_BAD_ASSET, span, message).here("not glTF 2.0");
        loader.reader.report(diagnostic.help("draw it as a mesh: `mesh = { file = \"..\" }` in a `[[draw]]`"));
        return None;
    }
    let bends = loader.reader.flag(table, "refraction", true);
    let contents = match gltf_contents(&bytes, surrounded && bends) {
        Ok(contents) => contents,
        Err(error) => {
            loader.reader.error(&SCENE_BAD_ASSET, span, format!("`{path}`: {error}"), "not a scene that can be read");
            return None;
        }
    };
    if let Some(nothing) = model.nothing.filter(|_| contents.lamps.is_empty() && contents.cameras.is_empty()) {
        let message = format!("`{path}`: {nothing}, no lights and no cameras");
        loader.reader.error(&SCENE_BAD_ASSET, span, message, "not a scene that can be read");
        return None;
    }
    for remark in model.remarks.iter().chain(&contents.remarks) {
        let diagnostic = Diagnostic::new(&MODEL_SIMPLIFIED, span, format!("`{path}`: {remark}"));
        loader.reader.diagnostics.push_beside(diagnostic);
    }
    Some(Source { table, name, place: file.span(), path, model, contents, transform })
}

/// The camera that a table takes from its file; `None` inside for none.
fn choose_camera(reader: &mut Reader, source: &Source<'_, '_>) -> Option<Option<ModelCamera>> {
    let cameras = &source.contents.cameras;
    let Some(node) = source.table.get("camera") else {
        return Some(cameras.first().map(|(_, camera)| *camera));
    };
    let span = reader.span_of(node);
    let names: Vec<&str> = cameras.iter().map(|(name, _)| name.as_str()).collect();
    let found = match node.get_ref() {
        DeValue::Boolean(false) => return Some(None),
        DeValue::Boolean(true) => cameras.first(),
        DeValue::String(wanted) => cameras.iter().find(|(name, _)| name == wanted),
        _ => {
            let numbers = reader.numbers(node, "camera")?;
            let number = match numbers.as_slice() {
                [number] => match number.value {
                    NumberValue::Int(value, _) => usize::try_from(value).ok(),
                    NumberValue::Bool(_) | NumberValue::Float(_) => None,
                },
                _ => None,
            };
            number.and_then(|number| cameras.get(number))
        }
    };
    if let Some((_, camera)) = found {
        return Some(Some(*camera));
    }
    let wanted = node.get_ref().as_str().unwrap_or_default();
    let near = did_you_mean(wanted, names.iter().copied()).map(|near| format!("did you mean `{near}`?"));
    let all = || match names.as_slice() {
        [] => "the file has no cameras: leave this out, or write a `[camera]`".to_owned(),
        names => format!("its cameras are `{}`, from 0", names.join("`, `")),
    };
    let message = format!("`{}` has no such camera", source.path);
    let diagnostic = Diagnostic::new(&SCENE_WRONG_VALUE, span, message).here("a name, a number from 0, or `false`");
    reader.report(diagnostic.help(near.unwrap_or_else(all)));
    None
}

fn write_one<'t, 'i>(
    loader: &mut Loader<'_>,
    source: &Source<'t, 'i>,
    (camera, seen): (Option<ModelCamera>, &[DVec3]),
    (portrait, frames): (bool, bool),
) -> Option<Written<'t, 'i>> {
    let place = loader.reader.span(source.place.clone());
    let table = source.table;
    let used = source.model.used();
    if used.len() > MAX_DRAWS {
        let message = format!("`{}` has {} materials, and a scene draws at most {MAX_DRAWS}", source.path, used.len());
        loader.reader.error(&SCENE_BAD_ASSET, place, message, "too many");
        return None;
    }
    let mut text = String::new();
    let framing = if portrait || frames { Framing::of_points(&source.points().collect::<Vec<_>>()) } else { None };
    if let Some(camera) = camera {
        text::camera(&mut text, &camera, source.transform, seen);
    } else if let Some(framing) = framing.as_ref().filter(|_| frames) {
        text::framing(&mut text, framing);
    }
    if portrait && let Some(framing) = &framing {
        text::portrait_lights(&mut text, framing);
    }
    if takes_lights(table) {
        source.contents.lamps.iter().for_each(|lamp| text::lamp(&mut text, lamp, source.transform));
    }
    let mut draws = Vec::new();
    for look in used {
        let Some(surface) = source.contents.materials.get(look) else {
            let message = format!("`{}`: there is no material {look}", source.path);
            loader.reader.error(&SCENE_BAD_ASSET, place, message, "not a scene that can be read");
            return None;
        };
        let parts = || source.model.parts.iter().filter(|part| part.look == look);
        let is_colored = parts().all(|part| !part.soup.colors.is_empty());
        draws.push((look, surface, is_colored));
    }
    // What can be seen through is drawn over the rest.
    draws.sort_by_key(|(_, surface, _)| is_blended(surface));
    let mut names = Vec::new();
    for (look, surface, is_colored) in &draws {
        for pass in passes(surface) {
            gltf_draw(&mut text, &source.name, *look, (surface, pass), *is_colored);
            names.push(surface.name.clone());
        }
    }
    let materials = loader.reader.table_at(table, "materials");
    for (key, _) in materials.into_iter().flatten() {
        check_name(&mut loader.reader, source, key, &names)?;
    }
    let material = table.get("material");
    if let Some(node) = material {
        loader.reader.table(node, "material")?;
    }
    Some(Written {
        text,
        place: source.place.clone(),
        names,
        transform: table.get("transform"),
        material,
        materials,
        draw: loader.reader.table_at(table, "draw"),
    })
}

/// Reports a name in `materials` that no drawn material has.
fn check_name(
    reader: &mut Reader,
    source: &Source<'_, '_>,
    key: &Spanned<std::borrow::Cow<'_, str>>,
    names: &[String],
) -> Option<()> {
    let name: &str = key.get_ref();
    if names.iter().any(|known| known == name) {
        return Some(());
    }
    let near = did_you_mean(name, names.iter().map(String::as_str)).map(|near| format!("did you mean `{near}`?"));
    let all = || (names.len() <= 12).then(|| format!("its materials are `{}`", names.join("`, `")));
    let message = format!("`{}` has no triangles of a material `{name}`", source.path);
    let diagnostic = Diagnostic::new(&SCENE_WRONG_VALUE, reader.span_of(key), message).here("no such material");
    reader.report(diagnostic.maybe_help(near.or_else(all)));
    None
}

/// The tables of a file.
pub(super) fn read<'i>(reader: &mut Reader, written: &'i Written<'_, 'i>) -> Imported<'i> {
    let mut imported = Imported { draws: Vec::new(), lights: Vec::new(), camera: None };
    let Ok(document) = DeTable::parse(&written.text) else {
        let message = "its names cannot be written into a scene".to_owned();
        let place = reader.span(written.place.clone());
        reader.error(&SCENE_BAD_ASSET, place, message, "not a scene that can be read");
        return imported;
    };
    let mut document = placed_table(document.into_inner(), &written.place);
    imported.camera = document.remove("camera").and_then(|node| match node.into_inner() {
        DeValue::Table(table) => Some(table),
        _ => None,
    });
    let mut list = |key: &str| match document.remove(key).map(Spanned::into_inner) {
        Some(DeValue::Array(list)) => list.into_iter().collect::<Vec<Node<'i>>>(),
        _ => Vec::new(),
    };
    imported.lights = list("light").iter().filter_map(|node| Light::load(reader, node)).collect();
    imported.draws = list("draw");
    for (node, name) in imported.draws.iter_mut().zip(&written.names) {
        let DeValue::Table(draw) = node.get_mut() else { continue };
        if let Some(transform) = written.transform {
            draw.insert(Spanned::new(transform.span(), "transform".into()), transform.clone());
        }
        let own = written.materials.and_then(|all| all.get(name.as_str()));
        if let Some(DeValue::Table(material)) = draw.get_mut("material").map(Spanned::get_mut) {
            for over in [written.material, own].into_iter().flatten().filter_map(|node| node.get_ref().as_table()) {
                merge(material, over);
            }
        }
        if let Some(over) = written.draw {
            merge(draw, over);
        }
    }
    imported
}

/// Replaces and adds the keys of a table; tables in it are merged.
fn merge<'i>(into: &mut DeTable<'i>, over: &DeTable<'i>) {
    for (key, value) in over {
        if let (Some(DeValue::Table(known)), DeValue::Table(more)) =
            (into.get_mut(key.get_ref().as_ref()).map(Spanned::get_mut), value.get_ref())
        {
            // A texture is replaced as a whole.
            if !known.contains_key("filter") {
                merge(known, more);
                continue;
            }
        }
        // The key's span is the scene's, too.
        into.remove(key.get_ref().as_ref());
        into.insert(key.clone(), value.clone());
    }
}

/// A table whose keys and values have the same place.
fn placed_table<'i>(table: DeTable<'i>, place: &Range<usize>) -> DeTable<'i> {
    let mut placed = DeTable::new();
    for (key, value) in table {
        placed.insert(Spanned::new(place.clone(), key.into_inner()), self::placed(value, place));
    }
    placed
}

fn placed<'i>(node: Node<'i>, place: &Range<usize>) -> Node<'i> {
    let value = match node.into_inner() {
        DeValue::Table(table) => DeValue::Table(placed_table(table, place)),
        DeValue::Array(mut list) => {
            for node in list.iter_mut() {
                let taken = std::mem::replace(node, Spanned::new(0..0, DeValue::Boolean(false)));
                *node = placed(taken, place);
            }
            DeValue::Array(list)
        }
        other => other,
    };
    Spanned::new(place.clone(), value)
}
