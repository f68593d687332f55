//! Evaluates constructors (§5.4) of constants, in the normal forms of [`ConstructKind`].

use super::{Operand, Scalars};
use crate::hir::{ConstructKind, ScalarValue, Type, TypeId, Types};

pub(super) fn construct(types: &Types, kind: ConstructKind, ty: TypeId, operands: &[Operand<'_>]) -> Option<Scalars> {
    let len = types.flat_len(ty) as usize;
    match kind {
        ConstructKind::Splat => Some(Scalars::from_elem(*operands.first()?.scalars.first()?, len)),
        ConstructKind::Compose => {
            let all = operands.iter().flat_map(|operand| operand.scalars.iter().copied());
            let scalars: Scalars = all.take(len).collect();
            (scalars.len() == len).then_some(scalars)
        }
        ConstructKind::Diagonal => {
            let Type::Matrix(columns, rows) = types.get(ty) else { return None };
            let value = *operands.first()?.scalars.first()?;
            Some(by_place(columns, rows, |column, row| Some(if column == row { value } else { float(0.0) }))?)
        }
        ConstructKind::Resize => {
            let (Type::Matrix(columns, rows), operand) = (types.get(ty), operands.first()?) else { return None };
            let Type::Matrix(from_columns, from_rows) = types.get(operand.ty) else { return None };
            by_place(columns, rows, |column, row| {
                if column < from_columns && row < from_rows {
                    operand.scalars.get(usize::from(column) * usize::from(from_rows) + usize::from(row)).copied()
                } else {
                    Some(float(if column == row { 1.0 } else { 0.0 }))
                }
            })
        }
        ConstructKind::Array | ConstructKind::Struct => {
            let scalars: Scalars = operands.iter().flat_map(|operand| operand.scalars.iter().copied()).collect();
            (scalars.len() == len).then_some(scalars)
        }
    }
}

fn float(value: f32) -> ScalarValue {
    ScalarValue::Float(value)
}

fn by_place(columns: u8, rows: u8, value: impl Fn(u8, u8) -> Option<ScalarValue>) -> Option<Scalars> {
    (0..columns)
        .flat_map(|column| (0..rows).map(move |row| (column, row)))
        .map(|(column, row)| value(column, row))
        .collect()
}
