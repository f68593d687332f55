//! Vertices: the attributes of a program as structs.
//!
//! *In:* the attributes that the vertex stage reads. *Out:* [`Vertices`]: the structs `Vertex` and `Instance`, without gaps, with
//! the place of each attribute.

use super::names::{field, fresh};
use super::structs::{assertions, derives};
use super::types::{Element, Shape};
use super::{Choices, documentation};
use glisten_front::hir::{ArraySize, MatrixLayout, Scalar, Stage, Type, TypeId, Types};
use glisten_front::link::{Attribute, Program};
use glisten_front::source::{SourceMap, Span};
use std::fmt::Write;

/// The structs of a program's vertices.
#[derive(Debug, Default)]
pub(super) struct Vertices {
    /// Those that have attributes: per vertex, then per instance.
    pub(super) structs: Vec<VertexStruct>,
}

/// A struct of attributes in one buffer.
#[derive(Debug)]
pub(super) struct VertexStruct {
    /// `Vertex`, `Instance`
    pub(super) name: &'static str,
    /// In bytes.
    pub(super) stride: u32,
    fields: Vec<VertexField>,
    /// One for each location.
    pub(super) places: Vec<Place>,
}

/// An attribute.
#[derive(Debug)]
struct VertexField {
    name: String,
    doc: String,
    offset: u32,
    ty: String,
}

/// The place of a location in a vertex.
#[derive(Debug)]
pub(super) struct Place {
    pub(super) location: u32,
    pub(super) offset: u32,
    /// WebGPU's word: `float32x3`.
    pub(super) format: String,
}

impl Vertices {
    /// The vertices of a program; `instanced` names the attributes of `Instance`.
    pub(super) fn of(program: &Program, sources: &SourceMap, instanced: &[String]) -> Self {
        let all = || program.interface.attributes.iter().filter(|one| one.active);
        let is_instanced = |one: &&Attribute| instanced.contains(&one.name);
        let make = |name, attributes: Vec<&Attribute>| VertexStruct::of(name, &attributes, program, sources);
        let structs = [
            make("Vertex", all().filter(|one| !is_instanced(one)).collect()),
            make("Instance", all().filter(is_instanced).collect()),
        ];
        Self { structs: structs.into_iter().filter(|one| !one.fields.is_empty()).collect() }
    }

    pub(super) fn text(&self, choices: &Choices) -> String {
        self.structs.iter().map(|one| one.text(choices)).collect()
    }
}

impl VertexStruct {
    fn of(name: &'static str, attributes: &[&Attribute], program: &Program, sources: &SourceMap) -> Self {
        let mut made = Self { name, stride: 0, fields: Vec::new(), places: Vec::new() };
        for attribute in attributes {
            let Some((element, count)) = element_of(&program.types, attribute.ty) else { continue };
            let (columns, rows) = match element.shape {
                Shape::Scalar => (1, 1),
                Shape::Vector(size) => (1, u32::from(size)),
                Shape::Matrix(columns, rows, _) => (u32::from(columns), u32::from(rows)),
            };
            let global = program.stage(Stage::Vertex).and_then(|shader| shader.globals.get(attribute.global.index()));
            let span = global.map_or_else(Span::default, |global| global.span);
            let written = Element { scalar: stored(element.scalar), ..element }.written();
            made.fields.push(VertexField {
                name: fresh(field(&attribute.name), |name| made.fields.iter().any(|known| known.name == name)),
                doc: documentation(
                    &format!("`{}`, at location {}.", attribute.name, attribute.location),
                    sources,
                    span,
                ),
                offset: made.stride,
                ty: count.map_or(written.clone(), |count| format!("[{written}; {count}]")),
            });
            for index in 0..columns * count.unwrap_or(1) {
                let (location, offset) = (attribute.location + index, made.stride + 4 * rows * index);
                made.places.push(Place { location, offset, format: format(element.scalar, rows) });
            }
            made.stride += 4 * rows * columns * count.unwrap_or(1);
        }
        made
    }

    fn text(&self, choices: &Choices) -> String {
        let Self { name, stride, fields, places } = self;
        let mut text =
            format!("/// The attributes of {}.\n", if *name == "Vertex" { "a vertex" } else { "an instance" });
        text.push_str(derives(choices));
        let _ = writeln!(text, "pub struct {name} {{");
        for VertexField { name, doc, ty, .. } in fields {
            let _ = writeln!(text, "{doc}pub {name}: {ty},");
        }
        let _ = writeln!(
            text,
            "}}\n\nimpl {name} {{\n/// The bytes from one to the next.\npub const STRIDE: u64 = {stride};"
        );
        text.push_str("/// The location, the offset in bytes and the format in WebGPU's words, of each attribute.\n");
        let list: Vec<String> = places
            .iter()
            .map(|Place { location, offset, format }| format!("({location}, {offset}, \"{format}\")"))
            .collect();
        let _ = writeln!(
            text,
            "pub const PLACES: [(u32, u64, &'static str); {}] = [{}];\n}}\n",
            list.len(),
            list.join(", ")
        );
        let _ = writeln!(text, "impl Bytes for {name} {{\nfn put(&self, bytes: &mut Vec<u8>) {{");
        for field in fields {
            let _ = writeln!(text, "self.{}.put(bytes);", field.name);
        }
        text.push_str("}\n}\n\n");
        text.push_str(&assertions(name, *stride, fields.iter().map(|field| (field.name.as_str(), field.offset))));
        text
    }
}

/// The scalar in a vertex buffer.
fn stored(scalar: Scalar) -> Scalar {
    if scalar == Scalar::Bool { Scalar::Uint } else { scalar }
}

/// The element of an attribute, and how many there are if it is an array.
fn element_of(types: &Types, ty: TypeId) -> Option<(Element, Option<u32>)> {
    let of = |ty| Element::of(types, ty, MatrixLayout::ColumnMajor);
    match types.get(ty) {
        Type::Array(element, ArraySize::Sized(count)) => Some((of(element)?, Some(count))),
        _ => Some((of(ty)?, None)),
    }
}

/// The format of a location in WebGPU's words.
fn format(scalar: Scalar, rows: u32) -> String {
    let kind = match scalar {
        Scalar::Float => "float32",
        Scalar::Int => "sint32",
        Scalar::Uint | Scalar::Bool => "uint32",
    };
    if rows == 1 { kind.into() } else { format!("{kind}x{rows}") }
}
