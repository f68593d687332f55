//! Structs of uniform buffers as Rust.
//!
//! *In:* structs with offsets. *Out:* their declarations, with values as GLSL initializes them, setters, bytes, and assertions of
//! the size and of each offset.

use super::Choices;
use super::fields::{Field, FieldType, Struct};
use super::layout::Layouts;
use super::names::fresh;
use super::types::{Element, Shape};
use glisten_front::hir::Scalar;
use std::fmt::Write;

/// All structs of a program.
pub(super) fn text(layouts: &Layouts, choices: &Choices) -> String {
    layouts.structs.iter().map(|one| structure(one, choices)).collect()
}

fn structure(one: &Struct, choices: &Choices) -> String {
    let Struct { name, doc, size, fields } = one;
    let mut text = doc.clone();
    text.push_str(derives(choices));
    let _ = writeln!(text, "pub struct {name} {{");
    for field in fields {
        let _ = writeln!(text, "{}pub {}: {},", field.doc, field.name, field.ty.text());
    }
    let _ = writeln!(text, "}}\n\nimpl {name} {{");
    let _ = writeln!(text, "/// The size in bytes.\npub const SIZE: u64 = {size};\n");
    text.push_str("/// The values of the initializers in GLSL, and zeros.\npub const fn new() -> Self {\nSelf {\n");
    for field in fields {
        let _ = writeln!(text, "{}: {},", field.name, initial(field));
    }
    text.push_str("}\n}\n");
    let mut setters: Vec<String> = Vec::new();
    for field in fields {
        let wanted = format!("set_{}", field.name.trim_matches('_'));
        let name = fresh(wanted, |name| setters.iter().any(|known| known == name));
        let setter = setter(field, &name, choices);
        if !setter.is_empty() {
            text.push_str(&setter);
            setters.push(name);
        }
    }
    let _ = writeln!(text, "}}\n\nimpl Default for {name} {{\nfn default() -> Self {{\nSelf::new()\n}}\n}}\n");
    let _ = writeln!(text, "impl Bytes for {name} {{\nfn put(&self, bytes: &mut Vec<u8>) {{");
    for field in fields {
        let _ = writeln!(text, "self.{}.put(bytes);", field.name);
    }
    text.push_str("}\n}\n\n");
    text.push_str(&assertions(name, *size, fields.iter().map(|field| (field.name.as_str(), field.offset))));
    text
}

/// The attributes of structs that go into buffers.
pub(super) fn derives(choices: &Choices) -> &'static str {
    if choices.bytemuck {
        "#[repr(C)]\n#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]\n"
    } else {
        "#[repr(C)]\n#[derive(Clone, Copy, Debug, PartialEq)]\n"
    }
}

/// Assertions that the struct has the layout of the buffer.
pub(super) fn assertions<'f>(name: &str, size: u32, fields: impl Iterator<Item = (&'f str, u32)>) -> String {
    let mut text = format!("const _: () = {{\nassert!(core::mem::size_of::<{name}>() == {size});\n");
    for (field, offset) in fields {
        let _ = writeln!(text, "assert!(core::mem::offset_of!({name}, {field}) == {offset});");
    }
    text.push_str("};\n\n");
    text
}

fn initial(field: &Field) -> String {
    if let Some(value) = &field.initial {
        return value.clone();
    }
    match &field.ty {
        FieldType::Element(element) => zeros(*element),
        FieldType::Elements(element, count) => match element.shape {
            Shape::Matrix(..) => format!("[{}; {count}]", zeros(*element)),
            _ => format!("[[{}; 4]; {count}]", zero(*element)),
        },
        FieldType::Struct(name, _) => format!("{name}::new()"),
        FieldType::Structs(name, count, _) => format!("[{name}::new(); {count}]"),
        FieldType::Padding(words) => format!("[0; {words}]"),
    }
}

fn zero(element: Element) -> &'static str {
    if element.scalar == Scalar::Float { "0.0" } else { "0" }
}

fn zeros(element: Element) -> String {
    match element.shape {
        Shape::Scalar => zero(element).into(),
        Shape::Vector(size) => format!("[{}; {size}]", zero(element)),
        Shape::Matrix(..) => format!("[[0.0; 4]; {}]", element.vectors()),
    }
}

/// A setter by values as people write them.
fn setter(field: &Field, setter: &str, choices: &Choices) -> String {
    let name = &field.name;
    let (parameter, value) = match &field.ty {
        FieldType::Element(element) => one(*element, choices),
        FieldType::Elements(element, count) => {
            let (own, converted) = in_array(*element);
            (format!("[{own}; {count}]"), format!("value.map(|value| {converted})"))
        }
        FieldType::Struct(..) | FieldType::Structs(..) | FieldType::Padding(_) => return String::new(),
    };
    let mut text = format!(
        "\n/// Sets {}.\n",
        field.doc.lines().next().map_or(name.as_str(), |doc| doc.trim_start_matches("/// "))
    );
    let _ = writeln!(text, "pub fn {setter}(&mut self, value: {parameter}) -> &mut Self {{");
    let _ = writeln!(text, "self.{name} = {value};\nself\n}}");
    text
}

/// The parameter of a setter, and its value in memory.
fn one(element: Element, choices: &Choices) -> (String, String) {
    let is_bool = element.scalar == Scalar::Bool;
    match element.shape {
        Shape::Scalar if is_bool => ("bool".into(), "u32::from(value)".into()),
        Shape::Scalar => (element.written(), "value".into()),
        Shape::Vector(_) if is_bool => (element.written(), "value.map(u32::from)".into()),
        Shape::Vector(_) => (format!("impl Into<{}>", element.written()), "value.into()".into()),
        Shape::Matrix(_, _, by_rows) => match element.glam().filter(|_| choices.glam) {
            Some(glam) => (glam, matrix("value.to_cols_array_2d()", by_rows)),
            None => (element.written(), matrix("value", by_rows)),
        },
    }
}

/// The element of an array as people write it, and its value in memory.
fn in_array(element: Element) -> (String, String) {
    let own = element.written();
    let zero = zero(element);
    let converted = match (element.shape, element.scalar == Scalar::Bool) {
        (Shape::Scalar, true) => "[u32::from(value), 0, 0, 0]".into(),
        (Shape::Scalar, false) => format!("[value, {zero}, {zero}, {zero}]"),
        (Shape::Vector(_), true) => "super::glisten_memory::padded([value.map(u32::from)])[0]".into(),
        (Shape::Vector(_), false) => "super::glisten_memory::padded([value])[0]".into(),
        (Shape::Matrix(_, _, by_rows), _) => matrix("value", by_rows),
    };
    (own, converted)
}

fn matrix(columns: &str, by_rows: bool) -> String {
    if by_rows {
        format!("super::glisten_memory::padded(super::glisten_memory::transposed({columns}))")
    } else {
        format!("super::glisten_memory::padded({columns})")
    }
}
