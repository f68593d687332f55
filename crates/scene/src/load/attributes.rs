//! Loads `[draw.attributes]` and the attributes of a mesh as [`AttributeData`].

use super::mesh::{Mesh, Named};
use super::missing::{Missing, global_span};
use super::names::ATTRIBUTE_KINDS;
use crate::fixed::current_attribute;
use crate::model::{AttributeData, AttributeValues};
use crate::roles::AttributeRole;
use crate::tables::{Node, Number, NumberValue, Reader, report_unknown_name};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{
    MESH_NARROWED, SCENE_BAD_ASSET, SCENE_MISSING_KEY, SCENE_WRONG_KIND, SCENE_WRONG_SIZE,
};
use glisten_front::hir::{Scalar, Type, TypeId, Types};
use glisten_front::link::{Attribute, Program};
use glisten_front::source::Span;
use toml::de::DeTable;

const KEYS: &[&str] = &["size", "values", "divisor", "kind"];
/// The largest number of components of a vertex in the data, more than any declared type has.
const MAX_SIZE: i64 = 1024;

/// The data of each attribute of the program, in the program's order. `reaching` says which of them can reach an output; `None`
/// for the mesh's inner option is a mesh that could not be loaded, which has been reported.
pub(super) fn load_attributes(
    reader: &mut Reader,
    draw: &DeTable<'_>,
    program: &Program,
    mesh: Option<Option<&Mesh>>,
    (place, reaching, instances): (Span, &dyn Fn() -> Vec<bool>, u32),
) -> Vec<Option<AttributeData>> {
    let attributes = &program.interface.attributes;
    let names: Vec<&str> = attributes.iter().map(|attribute| attribute.name.as_str()).collect();
    let is_named = |name: &str| attributes.iter().position(|attribute| attribute.name == name);
    let mut data: Vec<Option<AttributeData>> = vec![None; attributes.len()];
    let mut given = vec![false; attributes.len()];
    let mut set = |reader: &mut Reader,
                   name: &str,
                   span: Span,
                   load: &mut dyn FnMut(&mut Reader, &Attribute) -> Option<AttributeData>| {
        // The attribute that a misspelled name is most similar to counts as given.
        let index = is_named(name);
        let meant = index.or_else(|| report_unknown_name(reader, span, "attribute", name, &names).and_then(is_named));
        let loaded = index.and_then(|index| load(reader, &attributes[index]));
        if let Some(meant) = meant {
            given[meant] = true;
            data[meant] = loaded.or(data[meant].take());
        }
    };
    let loaded = mesh.flatten();
    for Named { role, attribute, span } in loaded.map_or(&[][..], |mesh| &mesh.named) {
        set(reader, attribute, *span, &mut |reader, attribute| {
            mesh_data(reader, program, attribute, (loaded?, *role, *span))
        });
    }
    if let Some(table) = reader.table_at(draw, "attributes") {
        for (name, node) in table {
            let span = reader.span_of(name);
            set(reader, name.get_ref(), span, &mut |reader, attribute| {
                load_attribute(reader, &program.types, attribute, node)
            });
        }
    }
    let mut handed_out = Vec::new();
    for (index, role) in loaded.map_or_else(Vec::new, |mesh| mesh.implied(program, &given)) {
        if let (Some(mesh), Some(attribute)) = (loaded, attributes.get(index)) {
            handed_out.push(role);
            given[index] = true;
            data[index] = mesh_data(reader, program, attribute, (mesh, role, mesh.span));
        }
    }
    for ((attribute, given), data) in attributes.iter().zip(&mut given).zip(&mut data) {
        if !*given && let Some(current) = current_attribute(&attribute.name) {
            let (size, values) = (current.len() as u32, AttributeValues::Float(current));
            // One row for all instances.
            (*given, *data) = (true, Some(AttributeData { size, divisor: u32::MAX, values }));
        }
    }
    let missing = attributes.iter().zip(given).filter(|(attribute, given)| attribute.active && !given);
    let missing: Vec<&Attribute> = missing.map(|(attribute, _)| attribute).collect();
    // What a mesh lacks that could not be loaded is not known.
    if !missing.is_empty() && mesh != Some(None) {
        let span = draw.get("attributes").map_or(place, |node| reader.span(node.span()));
        let reaching: Vec<&str> =
            names.iter().zip(reaching()).filter_map(|(name, reaches)| reaches.then_some(*name)).collect();
        let per_vertex = data.iter().flatten().find(|data| data.divisor == 0);
        let rows = per_vertex.map(|data| data.values.len() as u32 / data.size.max(1));
        let missing = Missing { program, attributes: missing, mesh: loaded, handed_out, rows, instances, span };
        missing.report(reader, draw, &reaching);
    }
    data
}

/// The largest number of components per vertex that the declared type takes.
fn components(types: &Types, ty: TypeId) -> u32 {
    types.flat_len(ty)
}

/// The scalar type of a type, also through arrays.
pub(super) fn scalar_of(types: &Types, mut ty: TypeId) -> Scalar {
    while let Type::Array(element, _) = types.get(ty) {
        ty = element;
    }
    types.scalar_of(ty).unwrap_or(Scalar::Float)
}

/// The data of a mesh for an attribute. `span` is where the scene hands it out.
fn mesh_data(
    reader: &mut Reader,
    program: &Program,
    attribute: &Attribute,
    (mesh, role, span): (&Mesh, AttributeRole, Span),
) -> Option<AttributeData> {
    let types = &program.types;
    let wanted = scalar_of(types, attribute.ty);
    if wanted != Scalar::Float {
        let message = format!("`{}` is {}, and a mesh brings floats", attribute.name, types.name(attribute.ty));
        reader.error(&SCENE_WRONG_KIND, span, message, "this attribute is not of floats");
        return None;
    }
    let Some((size, values)) = mesh.geometry.data(role) else {
        let message = format!("{} has no {}s", mesh.source(), role.name());
        reader.error(&SCENE_BAD_ASSET, span, message, "asked for here");
        return None;
    };
    let declared = components(types, attribute.ty);
    // Alpha and handedness are often left out; coordinates are not.
    let all_matter = !matches!(role, AttributeRole::Color | AttributeRole::Tangent);
    if size > declared && all_matter {
        let (name, ty) = (&attribute.name, types.name(attribute.ty));
        let message = format!("`{name}` is {ty} and takes {declared} of the mesh's {size} components");
        let diagnostic = Diagnostic::new(&MESH_NARROWED, span, message).here("the rest is dropped");
        let help = format!("declare it `vec{size}`, unless this is meant");
        reader.report(diagnostic.label(global_span(program, attribute), "declared here").help(help));
    }
    Some(narrowed(AttributeData { size, divisor: 0, values: AttributeValues::Float(values) }, declared))
}

/// The data without the components that the declared type does not have, as `glVertexAttribPointer` would drop them.
fn narrowed(data: AttributeData, declared: u32) -> AttributeData {
    fn first<T: Copy>(values: &[T], size: u32, declared: u32) -> Vec<T> {
        values.chunks(size as usize).flat_map(|row| row.iter().copied().take(declared as usize)).collect()
    }
    let size = data.size;
    if size <= declared {
        return data;
    }
    let values = match &data.values {
        AttributeValues::Float(values) => AttributeValues::Float(first(values, size, declared)),
        AttributeValues::Int(values) => AttributeValues::Int(first(values, size, declared)),
        AttributeValues::Uint(values) => AttributeValues::Uint(first(values, size, declared)),
    };
    AttributeData { size: declared, divisor: data.divisor, values }
}

fn load_attribute(reader: &mut Reader, types: &Types, attribute: &Attribute, node: &Node<'_>) -> Option<AttributeData> {
    let name = attribute.name.as_str();
    let table = reader.table(node, name)?;
    reader.check_keys(table, "an attribute", KEYS);
    let declared = components(types, attribute.ty);
    let wanted = scalar_of(types, attribute.ty);
    let kind = reader.choice_at(table, "kind", wanted, ATTRIBUTE_KINDS);
    if kind != wanted {
        let span = table.get("kind").map_or_else(Span::default, |node| reader.span(node.span()));
        let message = format!("`{name}` is declared {}, not {}", types.name(attribute.ty), kind.name());
        reader.error(&SCENE_WRONG_KIND, span, message, "contradicts the shader");
        return None;
    }
    let size = match table.get("size") {
        Some(node) => reader.integer(node, "size", 1..=MAX_SIZE)? as u32,
        None => declared.max(1),
    };
    let divisor = match table.get("divisor") {
        Some(node) => reader.integer(node, "divisor", 0..=i64::from(u32::MAX))? as u32,
        None => 0,
    };
    let Some(values_node) = table.get("values") else {
        if !reader.is_misspelled(table, "values") {
            let span = reader.span_of(node);
            reader.error(&SCENE_MISSING_KEY, span, format!("attribute `{name}` has no `values`"), "no data");
        }
        return None;
    };
    let numbers = reader.numbers(values_node, "values")?;
    if numbers.len() % size as usize != 0 {
        let span = reader.span_of(values_node);
        let message = format!("`{name}` has {} numbers, which is not a multiple of its size, {size}", numbers.len());
        reader.error(&SCENE_WRONG_SIZE, span, message, "a vertex is incomplete");
        return None;
    }
    let values = attribute_values(reader, name, wanted, &numbers)?;
    Some(narrowed(AttributeData { size, divisor, values }, declared.max(1)))
}

fn attribute_values(reader: &mut Reader, name: &str, scalar: Scalar, numbers: &[Number]) -> Option<AttributeValues> {
    let mut refuse = |number: &Number, wanted: &str| {
        let message = format!("`{name}` takes {wanted}");
        reader.error(&SCENE_WRONG_KIND, number.span, message, "expected another kind of number");
    };
    match scalar {
        Scalar::Float => {
            let mut values = Vec::with_capacity(numbers.len());
            for number in numbers {
                match number.value {
                    NumberValue::Float(value) | NumberValue::Int(_, value) => values.push(value),
                    NumberValue::Bool(_) => {
                        refuse(number, "numbers");
                        return None;
                    }
                }
            }
            Some(AttributeValues::Float(values))
        }
        Scalar::Int => integers(numbers, |number| refuse(number, "integers of 32 bits")).map(AttributeValues::Int),
        Scalar::Uint | Scalar::Bool => {
            integers(numbers, |number| refuse(number, "unsigned integers of 32 bits")).map(AttributeValues::Uint)
        }
    }
}

fn integers<T: TryFrom<i64>>(numbers: &[Number], mut refuse: impl FnMut(&Number)) -> Option<Vec<T>> {
    let mut values = Vec::with_capacity(numbers.len());
    for number in numbers {
        let value = match number.value {
            NumberValue::Int(value, _) => T::try_from(value).ok(),
            NumberValue::Float(_) | NumberValue::Bool(_) => None,
        };
        match value {
            Some(value) => values.push(value),
            None => {
                refuse(number);
                return None;
            }
        }
    }
    Some(values)
}
