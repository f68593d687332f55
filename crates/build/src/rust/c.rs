//! The structs of uniform buffers as a header of C and C++.
//!
//! *In:* structs with offsets. *Out:* the header of a program. *Holds:* the header needs nothing but the standard library; the compiler
//! checks the size of each struct and the offset of each field. Names of types begin with the program's, so that the headers of several
//! programs fit into one file.

use super::fields::{Field, FieldType, Struct};
use super::layout::Layouts;
use super::names::{module_name, pascal};
use super::types::{Element, Shape};
use glisten_emit::{Conventions, reflect};
use glisten_front::hir::Scalar;
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use std::fmt::Write;

/// Words of C and C++ that name a field in GLSL 1.50 and in Rust.
const KEYWORDS: [&str; 26] = [
    "and",
    "auto",
    "bool",
    "catch",
    "char",
    "class",
    "compl",
    "delete",
    "explicit",
    "export",
    "friend",
    "mutable",
    "new",
    "not",
    "nullptr",
    "operator",
    "or",
    "private",
    "protected",
    "public",
    "register",
    "restrict",
    "signed",
    "throw",
    "wchar_t",
    "xor",
];

/// The header of a program.
pub(in super::super) fn header(
    name: &str,
    program: &Program,
    sources: &SourceMap,
    conventions: &Conventions,
) -> String {
    let layouts = Layouts::of(program, sources, &reflect(program, conventions));
    let guard = format!("GLISTEN_{}_H", module_name(name).to_uppercase());
    let mut text = format!("// Written by glisten {} from GLSL. Changes are lost.\n\n", env!("CARGO_PKG_VERSION"));
    let _ = write!(text, "#ifndef {guard}\n#define {guard}\n\n");
    text.push_str("#include <assert.h>\n#include <stddef.h>\n#include <stdint.h>\n\n");
    let prefix = pascal(name);
    layouts.structs.iter().for_each(|one| text.push_str(&structure(&prefix, one)));
    let _ = writeln!(text, "#endif // {guard}");
    text
}

fn structure(prefix: &str, one: &Struct) -> String {
    let name = format!("{prefix}{}", one.name);
    let mut text = format!("{}typedef struct {name} {{\n", comment(&one.doc, ""));
    let mut checks = format!("static_assert(sizeof({name}) == {}, \"the size of {name}\");\n", one.size);
    for field in &one.fields {
        let own = field_name(field);
        let _ = writeln!(text, "{}    {};", comment(about(field), "    "), declared(prefix, &own, &field.ty));
        let _ = writeln!(checks, "static_assert(offsetof({name}, {own}) == {}, \"{name}.{own}\");", field.offset);
    }
    let _ = write!(text, "}} {name};\n\n{checks}\n");
    text
}

fn field_name(field: &Field) -> String {
    if KEYWORDS.contains(&field.name.as_str()) { format!("{}_", field.name) } else { field.name.clone() }
}

/// The documentation of a field without its name, if that is the name in GLSL.
fn about(field: &Field) -> &str {
    let name = format!("/// `{}`\n", field.name);
    field.doc.strip_prefix(&name).map_or(field.doc.as_str(), |rest| rest.strip_prefix("///\n").unwrap_or(rest))
}

/// A field with its type.
fn declared(prefix: &str, name: &str, ty: &FieldType) -> String {
    match ty {
        FieldType::Element(element) => format!("{} {name}{}", scalar(*element), extent(*element)),
        FieldType::Elements(element, count) => match element.shape {
            Shape::Matrix(..) => format!("{} {name}[{count}]{}", scalar(*element), extent(*element)),
            Shape::Scalar | Shape::Vector(_) => format!("{} {name}[{count}][4]", scalar(*element)),
        },
        FieldType::Struct(own, _) => format!("{prefix}{own} {name}"),
        FieldType::Structs(own, count, _) => format!("{prefix}{own} {name}[{count}]"),
        FieldType::Padding(words) => format!("uint32_t {name}[{words}]"),
    }
}

fn scalar(element: Element) -> &'static str {
    match element.scalar {
        Scalar::Float => "float",
        Scalar::Int => "int32_t",
        Scalar::Uint | Scalar::Bool => "uint32_t",
    }
}

fn extent(element: Element) -> String {
    match element.shape {
        Shape::Scalar => String::new(),
        Shape::Vector(size) => format!("[{size}]"),
        Shape::Matrix(..) => format!("[{}][4]", element.vectors()),
    }
}

/// Documentation in Rust as comments of C: without escapes, and without a sign that goes on in the next line.
fn comment(doc: &str, indent: &str) -> String {
    let line = |line: &str| {
        let bare = line.strip_prefix("///").unwrap_or(line).trim();
        let text = unescaped(bare);
        format!("{indent}// {}", text.trim_end_matches('\\')).trim_end().to_owned() + "\n"
    };
    doc.lines().map(line).collect()
}

/// A line without the backslashes in front of signs.
fn unescaped(line: &str) -> String {
    let mut text = String::new();
    let mut letters = line.chars();
    while let Some(one) = letters.next() {
        text.extend(if one == '\\' { letters.next() } else { Some(one) });
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{comment, declared, unescaped};
    use crate::rust::fields::FieldType;
    use crate::rust::types::{Element, Shape};
    use glisten_front::hir::Scalar;

    #[test]
    fn fields_have_the_form_of_std140() {
        let element = |scalar, shape| Element { scalar, shape };
        let flag = element(Scalar::Bool, Shape::Scalar);
        let matrix = element(Scalar::Float, Shape::Matrix(3, 2, false));
        for (ty, text) in [
            (FieldType::Element(flag), "uint32_t a"),
            (FieldType::Element(element(Scalar::Int, Shape::Vector(3))), "int32_t a[3]"),
            (FieldType::Element(matrix), "float a[3][4]"),
            (FieldType::Elements(flag, 5), "uint32_t a[5][4]"),
            (FieldType::Elements(matrix, 5), "float a[5][3][4]"),
            (FieldType::Structs("Light".into(), 8, 96), "PLight a[8]"),
        ] {
            assert_eq!(declared("P", "a", &ty), text);
        }
    }

    #[test]
    fn comments_have_no_escapes_and_end_with_their_line() {
        assert_eq!(unescaped(r"s\_c of \[1\]"), "s_c of [1]");
        assert_eq!(comment("/// `a`\n///\n/// b \\\\\n", "  "), "  // `a`\n  //\n  // b\n");
    }
}
