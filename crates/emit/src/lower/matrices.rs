//! Lowers matrix operations by columns, and the matrix functions (§8.5).

use super::Try;
use super::function::Ctx;
use glisten_front::hir::{Type, TypeId};
use naga::{BinaryOperator, Expression, Handle, MathFunction};

impl Ctx<'_, '_> {
    /// The columns of a matrix, and their type.
    pub(super) fn columns(&mut self, matrix: Handle<Expression>, ty: TypeId) -> Try<(TypeId, Vec<Handle<Expression>>)> {
        let Type::Matrix(columns, _) = self.low.types.get(ty) else {
            return Err(self.internal_error("a matrix was expected"));
        };
        let columns =
            (0..u32::from(columns)).map(|index| self.add(Expression::AccessIndex { base: matrix, index })).collect();
        Ok((self.low.element_type(ty), columns))
    }

    /// A matrix of the same type, whose columns are computed from those of `matrix`.
    pub(super) fn map_columns(
        &mut self,
        matrix: Handle<Expression>,
        ty: TypeId,
        mut map: impl FnMut(&mut Self, Handle<Expression>) -> Handle<Expression>,
    ) -> Try<Handle<Expression>> {
        let (_, columns) = self.columns(matrix, ty)?;
        let components = columns.into_iter().map(|column| map(self, column)).collect();
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// `transpose`
    pub(super) fn transpose(&mut self, matrix: Handle<Expression>) -> Handle<Expression> {
        self.math1(MathFunction::Transpose, matrix)
    }

    /// `matrixCompMult`
    pub(super) fn component_product(
        &mut self,
        left: Handle<Expression>,
        right: Handle<Expression>,
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let (_, rights) = self.columns(right, ty)?;
        let mut rights = rights.into_iter();
        self.map_columns(left, ty, |ctx, column| match rights.next() {
            Some(right) => ctx.op(BinaryOperator::Multiply, column, right),
            None => column,
        })
    }

    /// `outerProduct(c, r)`: column `i` is `c * r[i]`. naga has the function in its IR, but no text writer supports
    /// it.
    pub(super) fn outer_product(
        &mut self,
        column: Handle<Expression>,
        row: Handle<Expression>,
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let Type::Matrix(columns, _) = self.low.types.get(ty) else {
            return Err(self.internal_error("a matrix was expected"));
        };
        let mut components = Vec::new();
        for index in 0..u32::from(columns) {
            let factor = self.add(Expression::AccessIndex { base: row, index });
            components.push(self.op(BinaryOperator::Multiply, column, factor));
        }
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    /// naga's math function of one argument.
    pub(super) fn math1(&mut self, fun: MathFunction, arg: Handle<Expression>) -> Handle<Expression> {
        self.add(Expression::Math { fun, arg, arg1: None, arg2: None, arg3: None })
    }

    /// naga's math function of two arguments.
    pub(super) fn math2(
        &mut self,
        fun: MathFunction,
        arg: Handle<Expression>,
        arg1: Handle<Expression>,
    ) -> Handle<Expression> {
        self.add(Expression::Math { fun, arg, arg1: Some(arg1), arg2: None, arg3: None })
    }

    /// naga's math function of three arguments.
    pub(super) fn math3(
        &mut self,
        fun: MathFunction,
        arg: Handle<Expression>,
        arg1: Handle<Expression>,
        arg2: Handle<Expression>,
    ) -> Handle<Expression> {
        self.add(Expression::Math { fun, arg, arg1: Some(arg1), arg2: Some(arg2), arg3: None })
    }
}
