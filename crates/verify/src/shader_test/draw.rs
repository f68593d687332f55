//! Turns draw commands of a test into draws of a scene.

use super::known;
use super::vertex_data::{Column, VertexData};
use super::words::Words;
use super::{TestResult, fail, skip};
use crate::scene::{AttributeData, AttributeValues, Primitive};
use glisten_front::hir::{Global, GlobalId, Scalar, Stage, Type, TypeId, Types};
use glisten_front::link::{Attribute, Program};

/// The vertices of a draw command.
#[derive(Clone, Debug)]
pub(super) struct Geometry {
    pub(super) primitive: Primitive,
    pub(super) count: u32,
    pub(super) indices: Option<Vec<u32>>,
    pub(super) instances: u32,
    pub(super) attributes: Vec<Option<AttributeData>>,
}

/// The attribute of a rectangle's corners, and that of its texture coordinates.
const VERTEX: &str = "piglit_vertex";
const TEXCOORD: &str = "piglit_texcoord";
/// The same attributes of the fixed-function pipeline.
const FIXED_VERTEX: &str = "gl_Vertex";
const FIXED_TEXCOORD: &str = "gl_MultiTexCoord0";
/// The largest number of instances of a draw.
const MOST_INSTANCES: u32 = 1 << 16;
/// The vertices of a draw, as in a scene.
const MOST_VERTICES: u32 = 1 << 22;

const MODES: &[(&str, Primitive)] = &[
    ("GL_POINTS", Primitive::Points),
    ("GL_LINES", Primitive::Lines),
    ("GL_LINE_STRIP", Primitive::LineStrip),
    ("GL_LINE_LOOP", Primitive::LineLoop),
    ("GL_TRIANGLES", Primitive::Triangles),
    ("GL_TRIANGLE_STRIP", Primitive::TriangleStrip),
    ("GL_TRIANGLE_FAN", Primitive::TriangleFan),
    ("GL_LINES_ADJACENCY", Primitive::LinesAdjacency),
    ("GL_LINE_STRIP_ADJACENCY", Primitive::LineStripAdjacency),
    ("GL_TRIANGLES_ADJACENCY", Primitive::TrianglesAdjacency),
    ("GL_TRIANGLE_STRIP_ADJACENCY", Primitive::TriangleStripAdjacency),
];

/// Parses what follows `draw`.
pub(super) fn parse(
    words: &mut Words<'_>,
    program: &Program,
    data: &VertexData,
    size: [u32; 2],
) -> Result<Geometry, TestResult> {
    let line = words.line;
    if words.eat("arrays") {
        return arrays(words, program, data);
    }
    let instanced = words.eat("instanced");
    if !words.eat("rect") {
        return skip(line, format_args!("`draw {}` is not supported", words.rest().join(" ")));
    }
    let textured = words.eat("tex");
    let ortho = words.eat("ortho");
    if words.eat("patch") {
        return skip(line, "patches are not supported");
    }
    let instances = if instanced { words.count()? } else { 1 };
    let mut corners: [f64; 4] = words.numbers()?;
    if ortho {
        // From pixels to normalized device coordinates.
        let scaled = |value: f64, side: u32| value * 2.0 / f64::from(side);
        let [x, y, width, height] = corners;
        corners = [scaled(x, size[0]) - 1.0, scaled(y, size[1]) - 1.0, scaled(width, size[0]), scaled(height, size[1])];
    }
    let mut columns = vec![rectangle(corner_attribute(program), corners)];
    if textured {
        let fixed = program.interface.attributes.iter().any(|attribute| attribute.name == FIXED_TEXCOORD);
        columns.push(rectangle(if fixed { FIXED_TEXCOORD } else { TEXCOORD }, words.numbers()?));
    }
    let data = VertexData { line, columns, rows: 4 };
    Ok(Geometry {
        primitive: Primitive::TriangleStrip,
        count: 4,
        indices: None,
        instances: instances.min(MOST_INSTANCES),
        attributes: attributes(program, &data),
    })
}

/// The attribute that receives a rectangle's corners: the one with that name, or else the one at location 0.
fn corner_attribute(program: &Program) -> &str {
    let attributes = &program.interface.attributes;
    if let Some(name) = [VERTEX, FIXED_VERTEX].into_iter().find(|name| attributes.iter().any(|row| row.name == *name)) {
        return name;
    }
    let first = attributes.iter().find(|attribute| attribute.location == 0 && attribute.name != TEXCOORD);
    first.map_or(VERTEX, |attribute| attribute.name.as_str())
}

/// The four corners of a rectangle as a triangle strip.
fn rectangle(attribute: &str, [x, y, width, height]: [f64; 4]) -> Column {
    let values = vec![x, y, x + width, y, x, y + height, x + width, y + height];
    Column { attribute: attribute.into(), element: 0, column: 0, size: 2, is_integer: false, values }
}

/// `draw arrays GL_TRIANGLES 0 3`, or `draw arrays instanced GL_TRIANGLES 0 3 2`.
fn arrays(words: &mut Words<'_>, program: &Program, data: &VertexData) -> Result<Geometry, TestResult> {
    let line = words.line;
    let instanced = words.eat("instanced");
    let mode = words.word()?;
    let (first, count) = (words.count()?, words.count()?);
    let instances = if instanced { words.count()? } else { 1 };
    if count > MOST_VERTICES {
        return fail(line, format_args!("a draw has at most {MOST_VERTICES} vertices, not {count}"));
    }
    if first.checked_add(count).is_none() {
        return fail(line, format_args!("there are no indices from {first} to {first} + {count}"));
    }
    if !data.columns.is_empty() && u64::from(first) + u64::from(count) > u64::from(data.rows) {
        return fail(line, format_args!("the draw goes beyond the {} rows of vertex data", data.rows));
    }
    let (primitive, indices) = match MODES.iter().find(|(name, _)| *name == mode) {
        Some((_, primitive)) => (*primitive, None),
        None if mode == "GL_QUADS" && !counts_primitives(program) => {
            // The last vertex of a quad is the provoking vertex of both its halves.
            let halves = (0..count / 4).flat_map(|quad| [0, 1, 3, 1, 2, 3].map(|corner| quad * 4 + corner));
            (Primitive::Triangles, Some(halves.collect::<Vec<u32>>()))
        }
        None if mode == "GL_QUAD_STRIP" && !counts_primitives(program) => {
            // The corners 2q, 2q + 1, 2q + 3, 2q + 2 are in order around the quad, and 2q + 3 provokes (OpenGL 3.0
            // §2.6.1).
            let quads = (count / 2).saturating_sub(1);
            let halves = (0..quads).flat_map(|quad| [2, 0, 3, 0, 1, 3].map(|corner| quad * 2 + corner));
            (Primitive::Triangles, Some(halves.collect::<Vec<u32>>()))
        }
        None if mode.starts_with("GL_QUAD") => {
            return skip(line, format_args!("`{mode}` becomes triangles, whose gl_PrimitiveID is not the quad's"));
        }
        None if known::MODES.contains(&mode) => return skip(line, format_args!("`{mode}` is not supported")),
        None => {
            let modes = MODES.iter().map(|row| row.0).chain(known::MODES.iter().copied());
            return known::mistake(line, mode, "a mode of drawing", modes);
        }
    };
    // `gl_VertexID` counts from `first`, which indices provide.
    let indices = match indices {
        Some(indices) => Some(indices.into_iter().map(|index| index + first).collect()),
        None if first > 0 => Some((first..first.saturating_add(count)).collect()),
        None => None,
    };
    Ok(Geometry {
        primitive,
        count: indices.as_ref().map_or(count, |indices: &Vec<u32>| indices.len() as u32),
        indices,
        instances: instances.min(MOST_INSTANCES),
        attributes: attributes(program, data),
    })
}

/// Whether a stage could tell that a quad is two triangles.
fn counts_primitives(program: &Program) -> bool {
    let counts = |(_, global): (GlobalId, &Global)| global.name == "gl_PrimitiveID";
    program.stages.iter().any(|shader| shader.stage == Stage::Geometry || shader.globals().any(counts))
}

/// The vertex data for a program: a column may name an attribute by its location. Fails if a column is of no attribute, or beyond the
/// columns and elements of it.
pub(super) fn for_program(program: &Program, mut data: VertexData) -> Result<VertexData, TestResult> {
    let attributes = &program.interface.attributes;
    let line = data.line;
    for Column { attribute: name, element, column, .. } in &mut data.columns {
        let location = name.parse().ok();
        let is_meant = |attribute: &&Attribute| attribute.name == *name || Some(attribute.location) == location;
        let Some(attribute) = attributes.iter().find(is_meant) else {
            let known = attributes.iter().map(|attribute| attribute.name.as_str());
            return known::mistake(line, name, "an attribute of the program", known);
        };
        name.clone_from(&attribute.name);
        let (_, _, columns) = shape(&program.types, attribute.ty).unwrap_or((Scalar::Float, 1, 1));
        if *column >= columns {
            return fail(line, format_args!("`{name}` has no column {column}"));
        }
        if u64::from(*element) * u64::from(columns) + u64::from(*column) >= u64::from(attribute.columns) {
            return fail(line, format_args!("`{name}` has no element {element}"));
        }
    }
    Ok(data)
}

/// The data of every attribute of a program; `None` where the table has no column for it.
fn attributes(program: &Program, data: &VertexData) -> Vec<Option<AttributeData>> {
    program.interface.attributes.iter().map(|attribute| attribute_data(&program.types, attribute, data)).collect()
}

fn attribute_data(types: &Types, attribute: &Attribute, data: &VertexData) -> Option<AttributeData> {
    let columns: Vec<&Column> = data.columns.iter().filter(|column| column.attribute == attribute.name).collect();
    let (scalar, height, per_element) = shape(types, attribute.ty)?;
    let first = columns.first()?;
    // A single column keeps its own size, so that missing components get their defaults; several columns are all
    // complete.
    let size = if attribute.columns == 1 { first.size.min(height) } else { attribute.columns * height };
    let mut values = Vec::new();
    for row in 0..data.rows as usize {
        for location in 0..attribute.columns {
            let column = columns.iter().find(|column| column.element * per_element + column.column == location);
            for component in 0..if attribute.columns == 1 { size } else { height } {
                let value = column
                    .filter(|column| component < column.size)
                    .and_then(|column| column.values.get(row * column.size as usize + component as usize));
                values.push(value.copied().unwrap_or(if component == 3 { 1.0 } else { 0.0 }));
            }
        }
    }
    let values = match scalar {
        Scalar::Float => AttributeValues::Float(values.into_iter().map(|value| value as f32).collect()),
        Scalar::Int => AttributeValues::Int(values.into_iter().map(|value| value as i64 as i32).collect()),
        Scalar::Uint | Scalar::Bool => {
            AttributeValues::Uint(values.into_iter().map(|value| value as i64 as u32).collect())
        }
    };
    Some(AttributeData { size, divisor: 0, values })
}

/// The scalar type, the number of components per location, and the number of locations per element of an array.
fn shape(types: &Types, ty: TypeId) -> Option<(Scalar, u32, u32)> {
    match types.get(ty) {
        Type::Scalar(scalar) => Some((scalar, 1, 1)),
        Type::Vector(scalar, size) => Some((scalar, u32::from(size), 1)),
        Type::Matrix(columns, rows) => Some((Scalar::Float, u32::from(rows), u32::from(columns))),
        Type::Array(element, _) => shape(types, element),
        Type::Error | Type::Void | Type::Sampler(_) | Type::Struct(_) => None,
    }
}
