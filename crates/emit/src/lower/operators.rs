//! Lowers binary operators (§5.9), in terms of naga's operators.
//!
//! *Holds:* naga's `+ - / %` and comparisons require operands of one type, so a scalar operand is splatted to match a
//! vector. Matrices are processed by columns where naga has no operator for them. Shift distances are masked to five
//! bits (GLSL leaves larger ones undefined; WGSL rejects constant ones).

use super::Try;
use super::function::Ctx;
use glisten_front::hir::{BinaryOp, ExprId, Type, TypeId};
use naga::{BinaryOperator, Expression, Handle, RelationalFunction};

/// A value and its GLSL type.
pub(super) type Typed = (Handle<Expression>, TypeId);

impl Ctx<'_, '_> {
    /// Lowers a binary expression. A chain `a + b + c + ...` of thousands of operators recurses along its left
    /// operands, for which [`Shader::on_stack`](glisten_front::hir::Shader::on_stack) provides the stack.
    pub(super) fn binary(&mut self, op: BinaryOp, left: ExprId, right: ExprId) -> Try<Handle<Expression>> {
        let left = (self.value(left)?, self.shader.expr(left).ty);
        let right = (self.value(right)?, self.shader.expr(right).ty);
        self.binary_values(op, left, right)
    }

    /// Lowers the operation on values.
    pub(super) fn binary_values(&mut self, op: BinaryOp, left: Typed, right: Typed) -> Try<Handle<Expression>> {
        match op {
            BinaryOp::Add => self.arithmetic(BinaryOperator::Add, left, right),
            BinaryOp::Sub => self.arithmetic(BinaryOperator::Subtract, left, right),
            BinaryOp::Mul => self.arithmetic(BinaryOperator::Multiply, left, right),
            BinaryOp::Div => self.arithmetic(BinaryOperator::Divide, left, right),
            BinaryOp::Rem => self.arithmetic(BinaryOperator::Modulo, left, right),
            BinaryOp::MatMul => Ok(self.op(BinaryOperator::Multiply, left.0, right.0)),
            BinaryOp::Shl | BinaryOp::Shr => {
                if let Some(bits) = self.literal_count(right.0) {
                    let count = self.uint(bits & 31);
                    return self.shift(op, left, count, 1);
                }
                let size = self.size_of(right.1);
                let count = self.converted(right.0, right.1, TypeId::UINT);
                let mask = self.uint(31);
                let mask = self.splat(mask, size);
                let count = self.op(BinaryOperator::And, count, mask);
                self.shift(op, left, count, size)
            }
            BinaryOp::BitAnd => Ok(self.like_sized(BinaryOperator::And, left, right)),
            BinaryOp::BitXor => Ok(self.like_sized(BinaryOperator::ExclusiveOr, left, right)),
            BinaryOp::BitOr => Ok(self.like_sized(BinaryOperator::InclusiveOr, left, right)),
            BinaryOp::Less => Ok(self.op(BinaryOperator::Less, left.0, right.0)),
            BinaryOp::Greater => Ok(self.op(BinaryOperator::Greater, left.0, right.0)),
            BinaryOp::LessEqual => Ok(self.op(BinaryOperator::LessEqual, left.0, right.0)),
            BinaryOp::GreaterEqual => Ok(self.op(BinaryOperator::GreaterEqual, left.0, right.0)),
            BinaryOp::Equal => self.whole_equal(left.0, right.0, left.1, true),
            BinaryOp::NotEqual => self.whole_equal(left.0, right.0, left.1, false),
            BinaryOp::LogicalXor => Ok(self.op(BinaryOperator::NotEqual, left.0, right.0)),
        }
    }

    /// naga's binary operator.
    pub(super) fn op(
        &mut self,
        op: BinaryOperator,
        left: Handle<Expression>,
        right: Handle<Expression>,
    ) -> Handle<Expression> {
        self.add(Expression::Binary { op, left, right })
    }

    /// The number of components; 1 for everything but vectors.
    pub(super) fn size_of(&self, ty: TypeId) -> u8 {
        match self.low.types.get(ty) {
            Type::Vector(_, size) => size,
            _ => 1,
        }
    }

    /// Splats a scalar operand to the size of the other operand.
    fn like_sized(&mut self, op: BinaryOperator, left: Typed, right: Typed) -> Handle<Expression> {
        let (left_size, right_size) = (self.size_of(left.1), self.size_of(right.1));
        let mut values = (left.0, right.0);
        if left_size < right_size {
            values.0 = self.splat(left.0, right_size);
        } else if right_size < left_size {
            values.1 = self.splat(right.0, left_size);
        }
        self.op(op, values.0, values.1)
    }

    fn arithmetic(&mut self, op: BinaryOperator, left: Typed, right: Typed) -> Try<Handle<Expression>> {
        let is_matrix = |ty| matches!(self.low.types.get(ty), Type::Matrix(..));
        match (is_matrix(left.1), is_matrix(right.1)) {
            (false, false) if op == BinaryOperator::Multiply => Ok(self.op(op, left.0, right.0)),
            (false, false) => Ok(self.like_sized(op, left, right)),
            (true, true) if matches!(op, BinaryOperator::Add | BinaryOperator::Subtract) => {
                Ok(self.op(op, left.0, right.0))
            }
            (true, false) | (false, true) if op == BinaryOperator::Multiply => Ok(self.op(op, left.0, right.0)),
            (true, true) => {
                let (_, columns) = self.columns(right.0, right.1)?;
                let mut columns = columns.into_iter();
                self.map_columns(left.0, left.1, |ctx, column| match columns.next() {
                    Some(other) => ctx.op(op, column, other),
                    None => column,
                })
            }
            (true, false) => {
                let column_ty = self.low.element_type(left.1);
                self.map_columns(left.0, left.1, |ctx, column| ctx.like_sized(op, (column, column_ty), right))
            }
            (false, true) => {
                let column_ty = self.low.element_type(right.1);
                self.map_columns(right.0, right.1, |ctx, column| ctx.like_sized(op, left, (column, column_ty)))
            }
        }
    }

    fn shift(
        &mut self,
        op: BinaryOp,
        left: Typed,
        count: Handle<Expression>,
        count_size: u8,
    ) -> Try<Handle<Expression>> {
        let op = if op == BinaryOp::Shl { BinaryOperator::ShiftLeft } else { BinaryOperator::ShiftRight };
        let size = self.size_of(left.1);
        let count = if count_size < size { self.splat(count, size) } else { count };
        Ok(self.op(op, left.0, count))
    }

    /// `all` of a vector of `bool`, or the scalar itself.
    pub(super) fn all(&mut self, argument: Handle<Expression>, size: u8) -> Handle<Expression> {
        self.relational(RelationalFunction::All, argument, size)
    }

    /// `any` of a vector of `bool`, or the scalar itself.
    pub(super) fn any(&mut self, argument: Handle<Expression>, size: u8) -> Handle<Expression> {
        self.relational(RelationalFunction::Any, argument, size)
    }

    fn relational(&mut self, fun: RelationalFunction, argument: Handle<Expression>, size: u8) -> Handle<Expression> {
        if size <= 1 { argument } else { self.add(Expression::Relational { fun, argument }) }
    }

    /// `==` (or `!=`) of two scalars or vectors; the result is one `bool`.
    pub(super) fn vector_equal(
        &mut self,
        left: Handle<Expression>,
        right: Handle<Expression>,
        ty: TypeId,
        equal: bool,
    ) -> Handle<Expression> {
        let size = self.size_of(ty);
        if equal {
            let same = self.op(BinaryOperator::Equal, left, right);
            self.all(same, size)
        } else {
            let differ = self.op(BinaryOperator::NotEqual, left, right);
            self.any(differ, size)
        }
    }
}
