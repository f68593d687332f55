//! `[draw.mesh]`: vertex data of a named shape or from a file, assigned to attributes by role.
//!
//! *In:* `shape = "sphere"` and its sizes, or `file = "x.obj"`; `position`, `normal`, `texcoord` and so on name the attributes.
//! *Out:* a [`Mesh`] of indexed triangles, counterclockwise as seen from outside. *Holds:* coordinates are computed
//! in f64 and rounded once to f32. A role that the scene does not hand to an attribute goes to the one whose name says it.

mod feed;
mod from_file;
mod shapes;

use super::Loader;
use crate::geometry::Geometry;
use crate::roles::AttributeRole;
use crate::tables::{Node, Reader, list};
pub(super) use feed::likely_roles;
use from_file::FILE_KEYS;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{SCENE_MISSING_KEY, SCENE_WRONG_VALUE};
use glisten_front::source::Span;
use shapes::Shape;
use toml::de::DeTable;

/// A mesh whose data is assigned to attributes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mesh {
    pub(super) geometry: Geometry,
    /// The attributes that the scene names.
    pub(super) named: Vec<Named>,
    /// Whether roles go to the attributes of their own names, by the convention of the library's programs.
    conventional: bool,
    /// Its name in messages: the path of the file, or the shape.
    source: String,
    /// The span of its table.
    pub(super) span: Span,
}

/// An attribute that the scene names for a role.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Named {
    pub(super) role: AttributeRole,
    /// The attribute's GLSL name.
    pub(super) attribute: String,
    /// The span of the name in the scene.
    pub(super) span: Span,
}

const ROLE_KEYS: &[&str] = &["position", "normal", "texcoord", "texcoord2", "color", "tangent", "bitangent"];
const SHAPE_KEYS: &[&str] =
    &["shape", "radius", "minor_radius", "segments", "rings", "size", "height", "tube", "turns"];
/// The keys of a shape that all shapes have.
const COMMON_KEYS: [&str; 3] = ["shape", "segments", "rings"];

const SHAPES: &[(&str, Shape)] = &[
    ("sphere", Shape::Sphere),
    ("torus", Shape::Torus),
    ("quad", Shape::Quad),
    ("plane", Shape::Plane),
    ("cube", Shape::Cube),
    ("cylinder", Shape::Cylinder),
    ("cone", Shape::Cone),
    ("torus_knot", Shape::TorusKnot),
];

/// The segments and rings that a mesh of this `shape` has if its table does not say; `None` if there is no such shape.
pub fn default_tessellation(shape: &str) -> Option<[u32; 2]> {
    SHAPES.iter().find(|(name, _)| *name == shape).map(|(_, shape)| shape.default_tessellation())
}

/// The names of the shapes that a mesh may have.
pub fn shape_names() -> impl Iterator<Item = &'static str> {
    SHAPES.iter().map(|(name, _)| *name)
}

/// `conventional`: roles go to the attributes of their own names.
pub(super) fn load_mesh(loader: &mut Loader<'_>, node: &Node<'_>, conventional: bool) -> Option<Mesh> {
    let table = loader.reader.table(node, "mesh")?;
    let span = loader.reader.span_of(node);
    loader.reader.check_keys(table, "a mesh", &[SHAPE_KEYS, FILE_KEYS, ROLE_KEYS].concat());
    let (geometry, source) = match (table.get("shape"), table.get("file")) {
        (Some(name), None) => {
            refuse_file_keys(&mut loader.reader, table);
            let shape = loader.reader.choice(name, "shape", SHAPES)?;
            refuse_keys_of_others(&mut loader.reader, table, shape);
            (shapes::build(&mut loader.reader, table, shape), "the shape".to_owned())
        }
        (None, Some(file)) => from_file::load(loader, table, file)?,
        (Some(_), Some(_)) => {
            let message = "a mesh has a `shape` or a `file`, not both".into();
            loader.reader.error(&SCENE_WRONG_VALUE, span, message, "in this mesh");
            return None;
        }
        (None, None) => {
            report_neither(&mut loader.reader, table, span);
            return None;
        }
    };
    let named = load_names(&mut loader.reader, table);
    Some(Mesh { geometry, named, conventional, source, span })
}

fn report_neither(reader: &mut Reader, table: &DeTable<'_>, span: Span) {
    if ["shape", "file"].iter().any(|key| reader.is_misspelled(table, key)) {
        return;
    }
    let diagnostic =
        Diagnostic::new(&SCENE_MISSING_KEY, span, "a mesh has a `shape` or a `file`").here("neither is here");
    reader.report(diagnostic.help("add `shape = \"sphere\"`, or `file = \"..\"` with an OBJ or glTF file"));
}

/// Reports keys that only a mesh from a file has.
fn refuse_file_keys(reader: &mut Reader, table: &DeTable<'_>) {
    for key in FILE_KEYS {
        if let Some((name, _)) = table.get_key_value(*key) {
            let span = reader.span_of(name);
            let message = format!("`{key}` is for a mesh from a `file`: a shape has its own");
            reader.error(&SCENE_WRONG_VALUE, span, message, "leave it out");
        }
    }
}

/// Reports sizes that another shape has.
fn refuse_keys_of_others(reader: &mut Reader, table: &DeTable<'_>, shape: Shape) {
    let name = SHAPES.iter().find(|(_, known)| *known == shape).map_or("shape", |(name, _)| name);
    for key in SHAPE_KEYS.iter().filter(|key| !COMMON_KEYS.contains(key) && !shape.keys().contains(key)) {
        if let Some((key_node, _)) = table.get_key_value(*key) {
            let span = reader.span_of(key_node);
            let sizes = list(shape.keys());
            let message = format!("a `{name}` has no `{key}`: its size is by {sizes}");
            reader.error(&SCENE_WRONG_VALUE, span, message, "leave it out");
        }
    }
}

fn load_names(reader: &mut Reader, table: &DeTable<'_>) -> Vec<Named> {
    let mut named = Vec::new();
    for role in AttributeRole::ALL {
        let Some(node) = table.get(role.name()) else { continue };
        let span = reader.span_of(node);
        if let Some(attribute) = reader.text(node, role.name()) {
            named.push(Named { role, attribute: attribute.to_owned(), span });
        }
    }
    named
}
