//! Loads `[draw.attributes]` and the attributes of a mesh as [`AttributeData`].

use super::mesh::Mesh;
use super::names::ATTRIBUTE_KINDS;
use super::reader::{Node, Number, NumberValue, Reader, report_unknown_name};
use crate::model::{AttributeData, AttributeValues};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::scenes::{
    SCENE_MISSING_ATTRIBUTE, SCENE_MISSING_KEY, SCENE_UNSET_ATTRIBUTE, SCENE_WRONG_KIND, SCENE_WRONG_SIZE,
};
use glisten_front::hir::{Scalar, Type, TypeId, Types};
use glisten_front::link::{Attribute, Program};
use glisten_front::source::Span;
use toml::de::DeTable;

const KEYS: &[&str] = &["size", "values", "divisor", "kind"];

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
    let mut data: Vec<Option<AttributeData>> = vec![None; attributes.len()];
    let mut given = vec![false; attributes.len()];
    let mut set = |reader: &mut Reader,
                   name: &str,
                   span: Span,
                   load: &mut dyn FnMut(&mut Reader, &Attribute) -> Option<AttributeData>| {
        match attributes.iter().position(|attribute| attribute.name == name) {
            Some(index) => {
                let loaded = load(reader, &attributes[index]);
                if let (Some(flag), Some(slot)) = (given.get_mut(index), data.get_mut(index)) {
                    *flag = true;
                    *slot = loaded;
                }
            }
            None => report_unknown_name(reader, span, "attribute", name, &names),
        }
    };
    for stream in mesh.map_or(&[][..], |mesh| &mesh.streams) {
        if stream.implied && !names.contains(&stream.attribute.as_str()) {
            continue;
        }
        set(reader, &stream.attribute, stream.span, &mut |reader, attribute| {
            check_mesh_stream(reader, &program.types, attribute, &stream.data, stream.span)
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
    let missing = |(attribute, given): (&Attribute, &bool)| attribute.active && !given;
    if attributes.iter().zip(&given).any(missing) {
        let reaching = reaching();
        for (index, (attribute, given)) in attributes.iter().zip(&given).enumerate() {
            match reaching.get(index) {
                _ if !missing((attribute, given)) => {}
                Some(false) => report_unset(reader, program, attribute, draw, place),
                _ => report_missing(reader, program, attribute, draw, place),
            }
        }
    }
    data
}

/// Reports an attribute without data on which no output depends.
fn report_unset(reader: &mut Reader, program: &Program, attribute: &Attribute, draw: &DeTable<'_>, place: Span) {
    let span = draw.get("attributes").map_or(place, |node| reader.span(node.span()));
    let message = format!("attribute `{}` has no data, and reaches no output", attribute.name);
    let declared = global_span(program, attribute);
    reader.report(Diagnostic::new(&SCENE_UNSET_ATTRIBUTE, span, message).label(declared, "declared here"));
}

fn report_missing(reader: &mut Reader, program: &Program, attribute: &Attribute, draw: &DeTable<'_>, place: Span) {
    let name = &attribute.name;
    let components = components(&program.types, attribute.ty);
    let span = draw.get("attributes").map_or(place, |node| reader.span(node.span()));
    let message = format!("attribute `{name}` has no data: the vertex shader reads it");
    let help = format!("add `{name} = {{ size = {components}, values = [...] }}` under [draw.attributes]");
    reader.report(
        Diagnostic::new(&SCENE_MISSING_ATTRIBUTE, span, message)
            .label(global_span(program, attribute), "declared here")
            .help(help),
    );
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
    types: &Types,
    attribute: &Attribute,
    data: &AttributeData,
    span: Span,
) -> Option<AttributeData> {
    let wanted = scalar_of(types, attribute.ty);
    if wanted != Scalar::Float {
        let message = format!("`{}` is {}, and a mesh brings floats", attribute.name, types.name(attribute.ty));
        reader.error(&SCENE_WRONG_KIND, span, message, "of another kind");
        return None;
    }
    let declared = components(types, attribute.ty);
    if data.size <= declared {
        return Some(data.clone());
    }
    // A `vec2` takes the first two of three components, as `glVertexAttribPointer` would.
    let AttributeValues::Float(values) = &data.values else { return Some(data.clone()) };
    let values =
        values.chunks(data.size as usize).flat_map(|row| row.iter().copied().take(declared as usize)).collect();
    Some(AttributeData { size: declared, divisor: data.divisor, values: AttributeValues::Float(values) })
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
        Some(node) => reader.integer(node, "size", 1..=i64::from(declared.max(1)))? as u32,
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
    Some(AttributeData { size, divisor, values })
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
