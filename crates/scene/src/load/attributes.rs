//! Loads `[draw.attributes]` and the attributes of a mesh as [`AttributeData`].

use super::mesh::{Mesh, Stream};
use super::names::ATTRIBUTE_KINDS;
use super::reader::{Node, Number, NumberValue, Reader, report_unknown_name};
use crate::fixed::current_attribute;
use crate::model::{AttributeData, AttributeValues};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{
    MESH_NARROWED, SCENE_MISSING_ATTRIBUTE, SCENE_MISSING_KEY, SCENE_UNSET_ATTRIBUTE, SCENE_WRONG_KIND,
    SCENE_WRONG_SIZE,
};
use glisten_front::hir::{Scalar, Type, TypeId, Types};
use glisten_front::link::{Attribute, Program};
use glisten_front::source::Span;
use toml::de::DeTable;

const KEYS: &[&str] = &["size", "values", "divisor", "kind"];
/// The largest number of components of a vertex in the data, more than any declared type has.
const MAX_SIZE: i64 = 1024;

/// The data of each attribute of the program, in the program's order. `reaching` says which of them can reach an output.
pub(super) fn load_attributes(
    reader: &mut Reader,
    draw: &DeTable<'_>,
    program: &Program,
    mesh: Option<&Mesh>,
    (place, reaching): (Span, &dyn Fn() -> Vec<bool>),
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
    for stream in mesh.map_or(&[][..], |mesh| &mesh.streams) {
        if stream.implied && !names.contains(&stream.attribute.as_str()) {
            continue;
        }
        set(reader, &stream.attribute, stream.span, &mut |reader, attribute| {
            check_mesh_stream(reader, program, attribute, stream)
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
    for ((attribute, given), data) in attributes.iter().zip(&mut given).zip(&mut data) {
        if !*given && let Some(current) = current_attribute(&attribute.name) {
            let (size, values) = (current.len() as u32, AttributeValues::Float(current));
            // One row for all instances.
            (*given, *data) = (true, Some(AttributeData { size, divisor: u32::MAX, values }));
        }
    }
    let missing = attributes.iter().zip(given).filter(|(attribute, given)| attribute.active && !given);
    let missing: Vec<&Attribute> = missing.map(|(attribute, _)| attribute).collect();
    if !missing.is_empty() {
        let span = draw.get("attributes").map_or(place, |node| reader.span(node.span()));
        let reaching: Vec<&str> =
            names.iter().zip(reaching()).filter_map(|(name, reaches)| reaches.then_some(*name)).collect();
        report_missing(reader, program, &missing, &reaching, mesh, span);
    }
    data
}

/// Reports attributes that the vertex shader reads and that have no data: an error for those that can reach the position
/// or an output, a warning for the others, which are (0, 0, 0, 1).
fn report_missing(
    reader: &mut Reader,
    program: &Program,
    missing: &[&Attribute],
    reaching: &[&str],
    mesh: Option<&Mesh>,
    span: Span,
) {
    let roles = mesh.map_or(&[][..], |mesh| &mesh.unassigned);
    for attribute in missing {
        let name = &attribute.name;
        let components = components(&program.types, attribute.ty);
        let data = format!("add `{name} = {{ size = {components}, values = [..] }}` under [draw.attributes]");
        let help = match roles {
            [] => data,
            [role, ..] => format!("add `{role} = \"{name}\"` to the mesh, which gives it its {role}s; or {data}"),
        };
        let diagnostic = if reaching.contains(&name.as_str()) {
            let message = format!("attribute `{name}` has no data: the vertex shader reads it");
            Diagnostic::new(&SCENE_MISSING_ATTRIBUTE, span, message)
        } else {
            let message =
                format!("attribute `{name}` has no data and is (0, 0, 0, 1): nothing that is drawn depends on it");
            Diagnostic::new(&SCENE_UNSET_ATTRIBUTE, span, message)
        };
        reader.report_missing(diagnostic.label(global_span(program, attribute), "declared here").help(help));
    }
}

fn global_span(program: &Program, attribute: &Attribute) -> Span {
    program
        .stages
        .first()
        .and_then(|shader| shader.globals.get(attribute.global.index()))
        .map_or_else(Span::default, |g| g.span)
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

fn check_mesh_stream(
    reader: &mut Reader,
    program: &Program,
    attribute: &Attribute,
    stream: &Stream,
) -> Option<AttributeData> {
    let (types, Stream { data, span, .. }) = (&program.types, stream);
    let wanted = scalar_of(types, attribute.ty);
    if wanted != Scalar::Float {
        let message = format!("`{}` is {}, and a mesh brings floats", attribute.name, types.name(attribute.ty));
        reader.error(&SCENE_WRONG_KIND, *span, message, "of another kind");
        return None;
    }
    let declared = components(types, attribute.ty);
    if data.size > declared && span.is_known() {
        let (name, ty) = (&attribute.name, types.name(attribute.ty));
        let message = format!("`{name}` is {ty} and takes {declared} of the mesh's {} components", data.size);
        let diagnostic = Diagnostic::new(&MESH_NARROWED, *span, message).here("the rest is dropped");
        let help = format!("declare it `vec{}`, unless this is meant", data.size);
        reader.report(diagnostic.label(global_span(program, attribute), "declared here").help(help));
    }
    Some(narrowed(data.clone(), declared))
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
    let divisor = reader.count(table, "divisor", 0, 0..=u32::MAX);
    let Some(values_node) = table.get("values") else {
        let span = reader.span_of(node);
        reader.error(&SCENE_MISSING_KEY, span, format!("attribute `{name}` has no `values`"), "no data");
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
        reader.error(&SCENE_WRONG_KIND, number.span, message, "of another kind");
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
