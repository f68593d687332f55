//! `active uniform NAME PNAME VALUE`: what a host would learn about a uniform (OpenGL 3.2 §2.11.4).

use super::known::{self, PROPERTIES};
use super::words::Words;
use super::{TestResult, fail, uniforms};
use glisten_front::hir::{MatrixLayout, Scalar, Type, Types};
use glisten_front::link::{Program, UniformLeaf};

/// Compares the linked program with the expectation of the test.
pub(super) fn check(program: &Program, words: &mut Words<'_>) -> Result<(), TestResult> {
    let line = words.line;
    let (name, property, wanted) = (words.word()?, words.word()?, words.word()?);
    let Some((leaf, _)) = uniforms::find(program, name, 0) else {
        return fail(line, format_args!("there is no active uniform `{name}`"));
    };
    // Loose uniforms have no offset that a host could query.
    let is_loose = program.interface.roots.get(leaf.root.0 as usize).is_none_or(|root| root.block.is_none());
    let place = |value: u32| if is_loose { "-1".to_owned() } else { value.to_string() };
    let found = match property {
        "GL_UNIFORM_TYPE" => type_name(&program.types, leaf),
        "GL_UNIFORM_SIZE" => leaf.array_size.unwrap_or(1).to_string(),
        "GL_UNIFORM_OFFSET" => place(leaf.offset),
        "GL_UNIFORM_ARRAY_STRIDE" => place(leaf.array_stride.unwrap_or(0)),
        "GL_UNIFORM_MATRIX_STRIDE" => place(leaf.matrix_stride.unwrap_or(0)),
        "GL_UNIFORM_IS_ROW_MAJOR" => is_row_major(&program.types, leaf).to_string(),
        _ => return known::unsupported(line, property, "a property of uniforms", PROPERTIES),
    };
    if found == wanted { Ok(()) } else { fail(line, format_args!("{property} of `{name}` is {found}, not {wanted}")) }
}

fn is_row_major(types: &Types, leaf: &UniformLeaf) -> u32 {
    let is_matrix = matches!(types.get(leaf.ty), Type::Matrix(..));
    u32::from(is_matrix && leaf.matrix_layout == MatrixLayout::RowMajor)
}

/// The OpenGL enumerant of a type.
fn type_name(types: &Types, leaf: &UniformLeaf) -> String {
    let scalar = |scalar| match scalar {
        Scalar::Bool => "GL_BOOL",
        Scalar::Int => "GL_INT",
        Scalar::Uint => "GL_UNSIGNED_INT",
        Scalar::Float => "GL_FLOAT",
    };
    match types.get(leaf.ty) {
        Type::Scalar(kind) => scalar(kind).into(),
        Type::Vector(kind, size) => format!("{}_VEC{size}", scalar(kind)),
        Type::Matrix(columns, rows) if columns == rows => format!("GL_FLOAT_MAT{columns}"),
        Type::Matrix(columns, rows) => format!("GL_FLOAT_MAT{columns}x{rows}"),
        _ => types.name(leaf.ty),
    }
}
