//! The roles of attributes and matrices, told by the names that programs give them.
//!
//! *In:* a name and a type of GLSL. *Out:* an [`AttributeRole`] or a [`MatrixRole`], or `None`. *Holds:* the tables have the names
//! that engines, frameworks and tutorials use. A name is compared by its words, so that `a_position`, `inPosition` and
//! `VertexPosition` are one row.

mod attributes;
mod matrices;
mod words;

pub use attributes::{AttributeRole, attribute_role, likely_attribute_role};
pub use matrices::{MatrixRole, is_plain_transform, matrix_role};
