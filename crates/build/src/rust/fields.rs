//! [`Struct`]: a struct in the layout of a buffer, with its fields.

use super::types::Element;

/// A struct in the layout of a buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Struct {
    pub(super) name: String,
    pub(super) doc: String,
    /// In bytes.
    pub(super) size: u32,
    pub(super) fields: Vec<Field>,
}

/// A field of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Field {
    pub(super) name: String,
    pub(super) doc: String,
    /// In bytes, from the start of the struct.
    pub(super) offset: u32,
    pub(super) ty: FieldType,
    /// The initial value, if it is not zero.
    pub(super) initial: Option<String>,
}

/// The type of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum FieldType {
    Element(Element),
    Elements(Element, u32),
    Struct(String, u32),
    Structs(String, u32, u32),
    /// Words that mean nothing.
    Padding(u32),
}

impl FieldType {
    /// The type in Rust.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Element(element) => element.stored(),
            Self::Elements(element, count) => format!("[{}; {count}]", element.stored_in_array()),
            Self::Struct(name, _) => name.clone(),
            Self::Structs(name, count, _) => format!("[{name}; {count}]"),
            Self::Padding(words) => format!("[u32; {words}]"),
        }
    }

    /// The bytes that it takes.
    pub(super) fn size(&self) -> u32 {
        match self {
            Self::Element(element) => element.size(),
            Self::Elements(element, count) => element.stride() * count,
            Self::Struct(_, size) => *size,
            Self::Structs(_, count, size) => count * size,
            Self::Padding(words) => 4 * words,
        }
    }
}
