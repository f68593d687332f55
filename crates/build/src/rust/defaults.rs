//! Initial values of uniforms (GLSL 1.50, §4.3.5) as expressions in Rust.
//!
//! *In:* the value of an initializer, and a field. *Out:* the text of the field's value in memory. *Holds:* `None` where it is
//! zero anyway.

use super::fields::{FieldType, Struct};
use super::types::{Element, Shape};
use glisten_front::hir::{ScalarValue, Value};
use std::slice::Iter;

/// The value of a field whose scalars begin at `flat`.
pub(super) fn literal(ty: &FieldType, value: &Value, flat: u32, structs: &[Struct]) -> Option<String> {
    let mut scalars = value.scalars.get(flat as usize..)?.iter();
    field(ty, &mut scalars, structs)
}

fn field(ty: &FieldType, scalars: &mut Iter<'_, ScalarValue>, structs: &[Struct]) -> Option<String> {
    match ty {
        FieldType::Element(one) => element(*one, scalars, false),
        FieldType::Elements(one, count) => {
            let elements: Option<Vec<String>> = (0..*count).map(|_| element(*one, scalars, true)).collect();
            Some(format!("[{}]", elements?.join(", ")))
        }
        FieldType::Struct(name, _) => structure(name, scalars, structs),
        FieldType::Structs(name, count, _) => {
            let elements: Option<Vec<String>> = (0..*count).map(|_| structure(name, scalars, structs)).collect();
            Some(format!("[{}]", elements?.join(", ")))
        }
        FieldType::Padding(words) => Some(format!("[0; {words}]")),
    }
}

fn structure(name: &str, scalars: &mut Iter<'_, ScalarValue>, structs: &[Struct]) -> Option<String> {
    let known = structs.iter().find(|known| known.name == name)?;
    let mut fields = Vec::new();
    for one in &known.fields {
        fields.push(format!("{}: {}", one.name, field(&one.ty, scalars, structs)?));
    }
    Some(format!("{name} {{ {} }}", fields.join(", ")))
}

/// A scalar, vector or matrix in memory.
fn element(one: Element, scalars: &mut Iter<'_, ScalarValue>, in_array: bool) -> Option<String> {
    let mut values: Vec<String> = Vec::new();
    for _ in 0..one.scalars() {
        values.push(number(scalars.next()?));
    }
    let zero = || if one.stored_scalar() == "f32" { "0.0" } else { "0" }.to_owned();
    let four = |mut values: Vec<String>| {
        values.resize_with(4, zero);
        format!("[{}]", values.join(", "))
    };
    Some(match one.shape {
        Shape::Scalar if !in_array => values.swap_remove(0),
        Shape::Vector(_) if !in_array => format!("[{}]", values.join(", ")),
        Shape::Scalar | Shape::Vector(_) => four(values),
        Shape::Matrix(columns, rows, by_rows) => {
            let (columns, rows) = (usize::from(columns), usize::from(rows));
            let at = |column: usize, row: usize| values.get(column * rows + row).cloned().unwrap_or_else(zero);
            let vectors: Vec<String> = if by_rows {
                (0..rows).map(|row| four((0..columns).map(|column| at(column, row)).collect())).collect()
            } else {
                (0..columns).map(|column| four((0..rows).map(|row| at(column, row)).collect())).collect()
            };
            format!("[{}]", vectors.join(", "))
        }
    })
}

fn number(value: &ScalarValue) -> String {
    match *value {
        ScalarValue::Bool(value) => u32::from(value).to_string(),
        ScalarValue::Int(value) => value.to_string(),
        ScalarValue::Uint(value) => value.to_string(),
        ScalarValue::Float(value) if value.is_finite() => format!("{value:?}"),
        ScalarValue::Float(value) => format!("f32::from_bits({})", value.to_bits()),
    }
}
