//! `[draw.mesh]`: vertex data of a named shape or from a file, assigned to attributes by role.
//!
//! *In:* `shape = "sphere"` and its sizes, or `file = "x.obj"`; `position`, `normal`, `texcoord` name the attributes.
//! *Out:* a [`Mesh`] of indexed triangles, counterclockwise as seen from outside. *Holds:* coordinates are computed
//! in f64 and rounded once to f32.

mod obj;
mod shapes;

use super::Loader;
use super::reader::Node;
use crate::model::{AttributeData, AttributeValues};
use glisten_front::diagnostic::codes::scenes::{SCENE_BAD_ASSET, SCENE_MISSING_KEY, SCENE_WRONG_VALUE};
use glisten_front::source::Span;
use shapes::Shape;
use toml::de::DeTable;

/// A mesh whose data is assigned to attributes.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mesh {
    pub(super) indices: Vec<u32>,
    pub(super) streams: Vec<Stream>,
    /// The roles that the mesh has data for and that no attribute gets.
    pub(super) unassigned: Vec<&'static str>,
}

/// The data of one attribute.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stream {
    /// The attribute's GLSL name.
    pub(super) attribute: String,
    /// The span of the name in the scene.
    pub(super) span: Span,
    /// Whether the name is implied by the convention of the library's programs.
    pub(super) implied: bool,
    pub(super) data: AttributeData,
}

/// Triangles with the data of their vertices.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Geometry {
    positions: Vec<[f64; 3]>,
    normals: Vec<[f64; 3]>,
    texcoords: Vec<[f64; 2]>,
    indices: Vec<u32>,
}

const KEYS: &[&str] = &[
    "shape",
    "file",
    "position",
    "normal",
    "texcoord",
    "radius",
    "minor_radius",
    "segments",
    "rings",
    "size",
    "height",
    "tube",
    "turns",
];

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

/// `conventional`: a role that the scene does not hand to an attribute goes to the one of the role's own name.
pub(super) fn load_mesh(loader: &mut Loader<'_>, node: &Node<'_>, conventional: bool) -> Option<Mesh> {
    let table = loader.reader.table(node, "mesh")?;
    let span = loader.reader.span_of(node);
    loader.reader.check_keys(table, "a mesh", KEYS);
    let geometry = match (table.get("shape"), table.get("file")) {
        (Some(shape), None) => {
            let shape = loader.reader.choice(shape, "shape", SHAPES)?;
            shapes::build(&mut loader.reader, table, shape)
        }
        (None, Some(file)) => load_file(loader, file)?,
        (Some(_), Some(_)) => {
            let message = "a mesh has a `shape` or a `file`, not both".into();
            loader.reader.error(&SCENE_WRONG_VALUE, span, message, "in this mesh");
            return None;
        }
        (None, None) => {
            let message = "a mesh has a `shape` or a `file`".into();
            loader.reader.error(&SCENE_MISSING_KEY, span, message, "neither is here");
            return None;
        }
    };
    let (streams, unassigned) = load_streams(loader, table, &geometry, conventional);
    Some(Mesh { streams, unassigned, indices: geometry.indices })
}

fn load_file(loader: &mut Loader<'_>, node: &Node<'_>) -> Option<Geometry> {
    let span = loader.reader.span_of(node);
    let name = loader.reader.text(node, "file")?.to_owned();
    let (path, bytes) = loader.bytes(&name, span)?;
    match obj::parse(&String::from_utf8_lossy(&bytes)) {
        Ok(geometry) => Some(geometry),
        Err(error) => {
            let message = format!("`{path}`: {error}");
            loader.reader.error(&SCENE_BAD_ASSET, span, message, "not a mesh in Wavefront's format");
            None
        }
    }
}

/// The attributes of the fixed-function pipeline, which get these roles wherever a program reads them.
const FIXED_ATTRIBUTES: &[(&str, &str)] =
    &[("position", "gl_Vertex"), ("normal", "gl_Normal"), ("texcoord", "gl_MultiTexCoord0")];

/// The data of each role that goes to an attribute, and the roles whose data goes to none.
fn load_streams(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    geometry: &Geometry,
    conventional: bool,
) -> (Vec<Stream>, Vec<&'static str>) {
    let three = |rows: &[[f64; 3]]| rows.iter().flatten().map(|&value| value as f32).collect::<Vec<f32>>();
    let texcoords: Vec<f32> = geometry.texcoords.iter().flatten().map(|&value| value as f32).collect();
    let roles = [
        ("position", 3, three(&geometry.positions)),
        ("normal", 3, three(&geometry.normals)),
        ("texcoord", 2, texcoords),
    ];
    let (mut streams, mut unassigned) = (Vec::new(), Vec::new());
    for (role, size, values) in roles {
        let complete = values.len() == geometry.positions.len() * size as usize;
        let Some(node) = table.get(role) else {
            if complete && let Some((_, attribute)) = FIXED_ATTRIBUTES.iter().find(|(known, _)| *known == role) {
                let data = AttributeData { size, divisor: 0, values: AttributeValues::Float(values.clone()) };
                let attribute = (*attribute).to_owned();
                streams.push(Stream { attribute, span: Span::default(), implied: true, data });
            }
            if conventional && complete {
                let data = AttributeData { size, divisor: 0, values: AttributeValues::Float(values) };
                streams.push(Stream { attribute: role.to_owned(), span: Span::default(), implied: true, data });
            } else if complete {
                unassigned.push(role);
            }
            continue;
        };
        let span = loader.reader.span_of(node);
        let Some(attribute) = loader.reader.text(node, role).map(str::to_owned) else { continue };
        if !complete {
            let message = format!("the mesh has no {role}s");
            loader.reader.error(&SCENE_BAD_ASSET, span, message, "asked for here");
            continue;
        }
        let data = AttributeData { size, divisor: 0, values: AttributeValues::Float(values) };
        streams.push(Stream { attribute, span, implied: false, data });
    }
    (streams, unassigned)
}
