//! Lowers matrix operations by columns, and the matrix functions (§8.5).

use super::Try;
use super::function::Ctx;
use glisten_front::hir::{Type, TypeId};
use naga::{BinaryOperator, Expression, Handle, MathFunction, UnaryOperator};

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

    /// `inverse` by cofactors, for targets that have no such function.
    pub(super) fn inverse(&mut self, matrix: Handle<Expression>, ty: TypeId) -> Try<Handle<Expression>> {
        let (column, columns) = self.columns(matrix, ty)?;
        match columns.as_slice() {
            [a, b] => self.inverse2(*a, *b, column, ty),
            [a, b, c] => self.inverse3([*a, *b, *c], ty),
            [a, b, c, d] => self.inverse4([*a, *b, *c, *d], ty),
            _ => Err(self.internal_error("a square matrix was expected")),
        }
    }

    fn inverse2(
        &mut self,
        a: Handle<Expression>,
        b: Handle<Expression>,
        column: TypeId,
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let part = |ctx: &mut Self, base, index| ctx.add(Expression::AccessIndex { base, index });
        let (ax, ay, bx, by) = (part(self, a, 0), part(self, a, 1), part(self, b, 0), part(self, b, 1));
        let (left, right) = (self.times(ax, by), self.times(bx, ay));
        let determinant = self.op(BinaryOperator::Subtract, left, right);
        let (down, up) = (self.negative(ay), self.negative(bx));
        let column = self.low.value_type(column)?;
        let first = self.add(Expression::Compose { ty: column, components: vec![by, down] });
        let second = self.add(Expression::Compose { ty: column, components: vec![up, ax] });
        let factor = self.reciprocal(determinant);
        let components = [first, second].map(|column| self.times(column, factor)).to_vec();
        let ty = self.low.value_type(ty)?;
        Ok(self.add(Expression::Compose { ty, components }))
    }

    fn inverse3(&mut self, [a, b, c]: [Handle<Expression>; 3], ty: TypeId) -> Try<Handle<Expression>> {
        let rows = [self.cross(b, c), self.cross(c, a), self.cross(a, b)];
        let determinant = self.math2(MathFunction::Dot, a, rows[0]);
        let factor = self.reciprocal(determinant);
        let components = rows.map(|row| self.times(row, factor)).to_vec();
        let ty = self.low.value_type(ty)?;
        let rows = self.add(Expression::Compose { ty, components });
        Ok(self.transpose(rows))
    }

    /// By cross products of the columns' first three components (Lengyel, Foundations of Game Engine Development 1,
    /// 1.7.5).
    fn inverse4(&mut self, columns: [Handle<Expression>; 4], ty: TypeId) -> Try<Handle<Expression>> {
        let xyz = glisten_front::hir::Swizzle { len: 3, components: [0, 1, 2, 0] };
        let [x, y, z, w] = columns.map(|base| self.add(Expression::AccessIndex { base, index: 3 }));
        let [a, b, c, d] = columns.map(|column| self.swizzled(column, xyz));
        let (s, t) = (self.cross(a, b), self.cross(c, d));
        let (u, v) = (self.difference_of_products(a, y, b, x), self.difference_of_products(c, w, d, z));
        let (sv, tu) = (self.math2(MathFunction::Dot, s, v), self.math2(MathFunction::Dot, t, u));
        let determinant = self.op(BinaryOperator::Add, sv, tu);
        let factor = self.reciprocal(determinant);
        let [s, t, u, v] = [s, t, u, v].map(|part| self.times(part, factor));
        let (bv, va, du, uc) = (self.cross(b, v), self.cross(v, a), self.cross(d, u), self.cross(u, c));
        let [ty_, tx, sw, sz] = [(t, y), (t, x), (s, w), (s, z)].map(|(vector, factor)| self.times(vector, factor));
        let spatial = [
            self.op(BinaryOperator::Add, bv, ty_),
            self.op(BinaryOperator::Subtract, va, tx),
            self.op(BinaryOperator::Add, du, sw),
            self.op(BinaryOperator::Subtract, uc, sz),
        ];
        let last = [(b, t), (a, t), (d, s), (c, s)].map(|(one, other)| self.math2(MathFunction::Dot, one, other));
        let last = [self.negative(last[0]), last[1], self.negative(last[2]), last[3]];
        let row = self.low.value_type(TypeId::VEC4)?;
        let mut components = Vec::new();
        for (xyz, w) in spatial.into_iter().zip(last) {
            components.push(self.add(Expression::Compose { ty: row, components: vec![xyz, w] }));
        }
        let ty = self.low.value_type(ty)?;
        let rows = self.add(Expression::Compose { ty, components });
        Ok(self.transpose(rows))
    }

    fn cross(&mut self, a: Handle<Expression>, b: Handle<Expression>) -> Handle<Expression> {
        self.math2(MathFunction::Cross, a, b)
    }

    fn times(&mut self, a: Handle<Expression>, b: Handle<Expression>) -> Handle<Expression> {
        self.op(BinaryOperator::Multiply, a, b)
    }

    fn reciprocal(&mut self, value: Handle<Expression>) -> Handle<Expression> {
        let one = self.float(1.0);
        self.op(BinaryOperator::Divide, one, value)
    }

    fn negative(&mut self, expr: Handle<Expression>) -> Handle<Expression> {
        self.add(Expression::Unary { op: UnaryOperator::Negate, expr })
    }

    /// `a * x - b * y`
    fn difference_of_products(
        &mut self,
        a: Handle<Expression>,
        x: Handle<Expression>,
        b: Handle<Expression>,
        y: Handle<Expression>,
    ) -> Handle<Expression> {
        let (left, right) = (self.times(a, x), self.times(b, y));
        self.op(BinaryOperator::Subtract, left, right)
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
