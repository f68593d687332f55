//! Compiles products of matrices and vectors (§5.10), and the matrix functions of §8.5 that only move or multiply
//! components.

use super::super::inst::{Class, Float2, Inst, Operand};
use super::facts::Definition;
use super::{Compiler, Val};
use glisten_front::hir::{Type, TypeId};

impl Compiler<'_> {
    /// `a0 b0 + a1 b1 + ...`
    pub(super) fn sum_of_products(&mut self, pairs: &[Operand]) -> Operand {
        if let [a, b] = pairs {
            return self.float2(Float2::Mul, *a, *b);
        }
        if !self.emit.form.rewrites() {
            let products: Val = pairs.chunks_exact(2).map(|pair| self.float2(Float2::Mul, pair[0], pair[1])).collect();
            let sum = products.into_iter().reduce(|sum, product| self.float2(Float2::Add, sum, product));
            return sum.unwrap_or_else(|| self.emit.float(0.0));
        }
        let hoisted = pairs.iter().all(|operand| operand.is_scalar());
        let list = self.emit.list(Class::Float, pairs, hoisted);
        let reads: &[Operand] = if hoisted { &[] } else { &[Operand::reg(0)] };
        let sum = self.emit.pure(Class::Float, reads, |dst| Inst::SumOfProducts { dst, list });
        self.emit.define(sum, Definition::Products(pairs.iter().copied().collect()));
        sum
    }

    /// The linear algebra product.
    pub(super) fn mat_mul(&mut self, left: &[Operand], left_ty: TypeId, right: &[Operand], right_ty: TypeId) -> Val {
        // A vector on the left is a row, one on the right is a column.
        let (inner, rows) = match self.types.get(left_ty) {
            Type::Matrix(columns, rows) => (usize::from(columns), usize::from(rows)),
            _ => (left.len(), 1),
        };
        let columns = match self.types.get(right_ty) {
            Type::Matrix(columns, _) => usize::from(columns),
            _ => 1,
        };
        let mut result = Val::new();
        for column in 0..columns {
            for row in 0..rows {
                let pairs: Vec<Operand> = (0..inner)
                    .flat_map(|k| [left.get(k * rows + row).copied(), right.get(column * inner + k).copied()])
                    .flatten()
                    .collect();
                result.push(self.sum_of_products(&pairs));
            }
        }
        result
    }

    /// `outerProduct(column, row)`
    pub(super) fn outer_product(&mut self, column: &[Operand], row: &[Operand]) -> Val {
        let mut result = Val::new();
        for b in row {
            for a in column {
                result.push(self.float2(Float2::Mul, *a, *b));
            }
        }
        result
    }

    /// `transpose(m)` of a matrix of this type.
    pub(super) fn transpose(&self, value: &[Operand], ty: TypeId) -> Val {
        let Type::Matrix(columns, rows) = self.types.get(ty) else { return Val::from_slice(value) };
        let (columns, rows) = (usize::from(columns), usize::from(rows));
        (0..rows)
            .flat_map(|row| (0..columns).filter_map(move |column| value.get(column * rows + row).copied()))
            .collect()
    }
}
