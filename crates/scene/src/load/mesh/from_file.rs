//! Meshes from files: `file`, `material`, `normals`, `crease`.
//!
//! *In:* the table of a mesh. *Out:* a [`Geometry`]. *Holds:* a file is read once for all draws of a scene.

use super::super::Loader;
use crate::geometry::{Geometry, Model, Normals};
use crate::tables::{Node, NumberValue};
use glisten_front::diagnostic::codes::scenes::{SCENE_BAD_ASSET, SCENE_FILE_UNREADABLE, SCENE_WRONG_VALUE};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::source::Span;
use std::sync::Arc;
use toml::de::DeTable;

pub(super) const FILE_KEYS: &[&str] = &["file", "material", "normals", "crease"];

/// Where normals come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Origin {
    File,
    Smooth,
    Flat,
}

const ORIGINS: &[(&str, Origin)] = &[("file", Origin::File), ("smooth", Origin::Smooth), ("flat", Origin::Flat)];

/// The mesh of a file, and the file's path.
pub(super) fn load(loader: &mut Loader<'_>, table: &DeTable<'_>, node: &Node<'_>) -> Option<(Geometry, String)> {
    let span = loader.reader.span_of(node);
    let name = loader.reader.text(node, "file")?.to_owned();
    let (path, model) = loader.model(&name, span)?;
    if let Some(nothing) = model.nothing {
        let message = format!("`{path}`: {nothing}");
        loader.reader.error(&SCENE_BAD_ASSET, span, message, "not a mesh that can be read");
        return None;
    }
    let look = match table.get("material") {
        Some(node) => Some(find_look(loader, node, &path, &model)?),
        None => None,
    };
    let origin = table.get("normals").map(|node| loader.reader.choice(node, "normals", ORIGINS));
    let crease = loader.reader.real(table, "crease", Normals::CREASE);
    if let Some((key, node)) = table.get_key_value("crease") {
        if !(0.0..=180.0).contains(&crease) {
            let span = loader.reader.span_of(node);
            loader.reader.wrong_value(span, "`crease` is an angle of 0 to 180 degrees", "out of range");
            return None;
        }
        if origin == Some(Some(Origin::Flat)) {
            let span = loader.reader.span_of(key);
            loader.reader.wrong_value(span, "flat normals have no `crease`", "changes nothing");
        }
    }
    let normals = match origin {
        Some(origin) => origin?,
        None => Origin::File,
    };
    let normals = match normals {
        Origin::File => Normals { from_file: true, ..Normals::smooth(crease) },
        Origin::Smooth => Normals::smooth(crease),
        Origin::Flat => Normals::FLAT,
    };
    let seen = model.geometry(look, normals);
    if seen.geometry.indices.is_empty() {
        let message = format!("`{path}`: all of its triangles are without area");
        loader.reader.error(&SCENE_BAD_ASSET, span, message, "nothing to draw");
        return None;
    }
    if let (Some(Some(Origin::File)), false, Some(node)) = (origin, seen.has_normals, table.get("normals")) {
        let place = loader.reader.span_of(node);
        let message = format!("`{path}` does not have normals for all of its faces");
        let diagnostic = Diagnostic::new(&SCENE_BAD_ASSET, place, message).here("asked for here");
        loader.reader.report(diagnostic.help("write `\"smooth\"`: they are computed then"));
        return None;
    }
    Some((seen.geometry, format!("`{path}`")))
}

/// The number of a material by its name, or by its place in the file, from 0.
fn find_look(loader: &mut Loader<'_>, node: &Node<'_>, path: &str, model: &Model) -> Option<usize> {
    let span = loader.reader.span_of(node);
    let used = model.used();
    if let Some(name) = node.get_ref().as_str() {
        let named = |look: &&usize| model.looks.get(**look).is_some_and(|known| known.name == name);
        if let Some(look) = used.iter().find(named) {
            return Some(*look);
        }
        let names: Vec<&str> = used.iter().filter_map(|look| Some(model.looks.get(*look)?.name.as_str())).collect();
        let near = did_you_mean(name, names.iter().copied()).map(|near| format!("did you mean `{near}`?"));
        let all = || (names.len() <= 12).then(|| format!("its materials are `{}`", names.join("`, `")));
        let message = format!("`{path}` has no triangles of a material `{name}`");
        let diagnostic = Diagnostic::new(&SCENE_WRONG_VALUE, span, message).here("no such material");
        loader.reader.report(diagnostic.maybe_help(near.or_else(all)));
        return None;
    }
    let numbers = loader.reader.numbers(node, "material")?;
    let number = match numbers.as_slice() {
        [number] => match number.value {
            NumberValue::Int(value, _) => usize::try_from(value).ok(),
            NumberValue::Bool(_) | NumberValue::Float(_) => None,
        },
        _ => None,
    };
    let found = number.filter(|number| used.contains(number));
    if found.is_none() {
        let message = format!("`{path}` has no triangles of a material of this number");
        loader.reader.wrong_value(span, message, "a name, or a number from 0");
    }
    found
}

impl Loader<'_> {
    /// The meshes of a file that the scene names at `span`, and its path.
    pub(in super::super) fn model(&mut self, name: &str, span: Span) -> Option<(String, Arc<Model>)> {
        let path = crate::files::relative_to(self.path, name);
        if let Some(known) = self.models.get(&path) {
            return Some((path, Arc::clone(known.as_ref()?)));
        }
        let read = self.bytes(name, span).map(|(path, bytes)| Model::read(&path, &bytes, self.files));
        let model = match read {
            Some(Ok(model)) => Some(Arc::new(model)),
            Some(Err(error)) => {
                let code = if error.is_unread { &SCENE_FILE_UNREADABLE } else { &SCENE_BAD_ASSET };
                let message = format!("`{path}`: {}", error.sentence);
                self.reader.error(code, span, message, "not a mesh that can be read");
                None
            }
            None => None,
        };
        self.models.insert(path.clone(), model.clone());
        Some((path, model?))
    }
}
