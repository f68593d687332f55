//! Lowers expressions (§5). Each is evaluated where GLSL evaluates it, left to right.

use super::function::Ctx;
use super::places::Place;
use super::{Try, internal};
use glisten_front::hir::{
    BinaryOp, ConstructKind, ExprId, ExprKind, IncDec, LogicalOp, Scalar, ScalarValue, Type, TypeId, UnaryOp,
};
use naga::{BinaryOperator, Expression, Handle, Statement, UnaryOperator};

/// The highest cost, in nodes, of an operand of `?:` that is evaluated even if it is not selected.
const SELECTED: u32 = 12;

impl Ctx<'_, '_> {
    /// The value of an expression.
    pub(super) fn value(&mut self, id: ExprId) -> Try<Handle<Expression>> {
        let expr = self.shader.expr(id);
        let outer = self.at(expr.span);
        let value = self.value_here(id);
        self.back_to(outer);
        value
    }

    fn value_here(&mut self, id: ExprId) -> Try<Handle<Expression>> {
        let expr = self.shader.expr(id);
        if self.is_operation(&expr.kind)
            && let Some(value) = self.low.evaluated(self.id, id)
        {
            // What a target would evaluate before the shader runs is evaluated here. Targets reject results that are
            // not finite, integers that overflow, and divisions by zero.
            return self.constant(&value);
        }
        match &expr.kind {
            ExprKind::Error => Err(internal(expr.span, "an expression with errors was handed on")),
            ExprKind::Literal(value) => Ok(self.scalar(*value)),
            ExprKind::Var(_) | ExprKind::Member(..) | ExprKind::Index(..) | ExprKind::Swizzle(..) => {
                let place = self.place(id)?;
                self.load_place(&place)
            }
            ExprKind::Convert(operand) => self.convert(*operand, expr.ty),
            ExprKind::Construct(kind, arguments) => self.construct(*kind, arguments, expr.ty),
            ExprKind::Unary(op, operand) => self.unary(*op, *operand),
            ExprKind::IncDec(kind, target) => self.inc_dec(*kind, *target),
            ExprKind::Binary(op, left, right) => self.binary(*op, *left, *right),
            ExprKind::Logical(op, left, right) => self.logical(*op, *left, *right),
            ExprKind::Ternary(condition, accept, reject) => self.ternary(*condition, *accept, *reject, expr.ty),
            ExprKind::Assign(op, target, value) => self.assign(*op, *target, *value),
            ExprKind::Comma(left, right) => {
                self.effect(*left)?;
                self.value(*right)
            }
            ExprKind::Call(function, arguments) => match self.user_call(*function, arguments)? {
                Some(value) => Ok(value),
                None => Err(internal(expr.span, "a function without a result has no value")),
            },
            ExprKind::BuiltinCall(function, arguments) => self.builtin(*function, arguments, expr.ty),
        }
    }

    /// Evaluates an expression for its effects; one without effects is not evaluated.
    pub(super) fn effect(&mut self, id: ExprId) -> Try<()> {
        if !self.low.facts.nature(id).effects {
            return Ok(());
        }
        let expr = self.shader.expr(id);
        let outer = self.at(expr.span);
        let done = self.effect_here(id);
        self.back_to(outer);
        done
    }

    fn effect_here(&mut self, id: ExprId) -> Try<()> {
        match &self.shader.expr(id).kind {
            ExprKind::Comma(left, right) => {
                self.effect(*left)?;
                self.effect(*right)
            }
            ExprKind::Logical(op, left, right) => {
                let condition = self.value(*left)?;
                let block = self.in_block(|ctx| ctx.effect(*right))?;
                let (accept, reject) = match op {
                    LogicalOp::And => (block, naga::Block::new()),
                    LogicalOp::Or => (naga::Block::new(), block),
                };
                self.branch(condition, accept, reject);
                Ok(())
            }
            ExprKind::Ternary(condition, accept, reject) => {
                let condition = self.value(*condition)?;
                let accept = self.in_block(|ctx| ctx.effect(*accept))?;
                let reject = self.in_block(|ctx| ctx.effect(*reject))?;
                self.branch(condition, accept, reject);
                Ok(())
            }
            ExprKind::Call(function, arguments) => self.user_call(*function, arguments).map(|_| ()),
            ExprKind::Convert(operand) | ExprKind::Unary(_, operand) | ExprKind::Swizzle(operand, _) => {
                self.effect(*operand)
            }
            _ => self.value(id).map(|_| ()),
        }
    }

    /// `if`, inverted if only the second block has contents.
    pub(super) fn branch(&mut self, condition: Handle<Expression>, accept: naga::Block, reject: naga::Block) {
        if accept.is_empty() && reject.is_empty() {
            return;
        }
        if accept.is_empty() {
            let condition = self.not(condition);
            self.statement(Statement::If { condition, accept: reject, reject: accept });
        } else {
            self.statement(Statement::If { condition, accept, reject });
        }
    }

    /// `!` of a `bool`.
    pub(super) fn not(&mut self, expr: Handle<Expression>) -> Handle<Expression> {
        self.add(Expression::Unary { op: UnaryOperator::LogicalNot, expr })
    }

    /// `&&` and `||`. Evaluating the right operand needlessly matters only if it has effects; otherwise nobody can tell, because
    /// indices are kept in bounds.
    fn logical(&mut self, op: LogicalOp, left: ExprId, right: ExprId) -> Try<Handle<Expression>> {
        let left = self.value(left)?;
        if !self.low.facts.nature(right).effects {
            let right = self.value(right)?;
            let op = match op {
                LogicalOp::And => BinaryOperator::LogicalAnd,
                LogicalOp::Or => BinaryOperator::LogicalOr,
            };
            return Ok(self.add(Expression::Binary { op, left, right }));
        }
        let result = self.variable_of("condition", TypeId::BOOL)?;
        self.store(result, left);
        let block = self.in_block(|ctx| {
            let right = ctx.value(right)?;
            ctx.store(result, right);
            Ok(())
        })?;
        match op {
            LogicalOp::And => self.branch(left, block, naga::Block::new()),
            LogicalOp::Or => self.branch(left, naga::Block::new(), block),
        }
        Ok(self.load(result))
    }

    /// `?:`: a selection if both operands are cheap and without effects, otherwise a branch.
    fn ternary(&mut self, condition: ExprId, accept: ExprId, reject: ExprId, ty: TypeId) -> Try<Handle<Expression>> {
        let plain = |id| {
            let nature = self.low.facts.nature(id);
            !nature.effects && !nature.control && nature.cost <= SELECTED
        };
        let selectable = matches!(self.low.types.get(ty), Type::Scalar(_) | Type::Vector(..));
        let select = selectable && plain(accept) && plain(reject);
        let condition = self.value(condition)?;
        if select {
            let accept = self.value(accept)?;
            let reject = self.value(reject)?;
            return Ok(self.add(Expression::Select { condition, accept, reject }));
        }
        if !self.low.has_value(ty) {
            let accept = self.in_block(|ctx| ctx.effect(accept))?;
            let reject = self.in_block(|ctx| ctx.effect(reject))?;
            self.branch(condition, accept, reject);
            return Err(self.internal_error("an operand of `?:` has no value"));
        }
        self.chosen(condition, accept, reject, ty)
    }

    /// A chain `a ? b : c ? d : ..` as branches that write to one variable.
    fn chosen(
        &mut self,
        condition: Handle<Expression>,
        accept: ExprId,
        reject: ExprId,
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let result = self.variable_of("chosen", ty)?;
        let put = |ctx: &mut Self, id| {
            let value = ctx.value(id)?;
            ctx.store(result, value);
            Ok(())
        };
        let mut arms = Vec::new();
        let mut last = reject;
        while let ExprKind::Ternary(condition, accept, reject) = self.shader.expr(last).kind {
            arms.push((condition, accept));
            last = reject;
        }
        let accept = self.in_block(|ctx| put(ctx, accept))?;
        let reject = self.in_block(|ctx| {
            ctx.first_of(&arms, &|ctx, arm| ctx.value(arm.0), &|ctx, arm| put(ctx, arm.1), &|ctx| put(ctx, last))
        })?;
        self.statement(Statement::If { condition, accept, reject });
        Ok(self.load(result))
    }

    /// `a = b`, `a op= b`: evaluates the place `a`, then (for `op=`) its value, then `b` (§5.8).
    fn assign(&mut self, op: Option<BinaryOp>, target: ExprId, value: ExprId) -> Try<Handle<Expression>> {
        let place = self.place(target)?;
        let result = match op {
            None => self.value(value)?,
            Some(op) => {
                let left = self.load_place(&place)?;
                let right = self.value(value)?;
                let (left_ty, right_ty) = (self.shader.expr(target).ty, self.shader.expr(value).ty);
                self.binary_values(op, (left, left_ty), (right, right_ty))?
            }
        };
        self.store_place(&place, result)?;
        Ok(result)
    }

    fn inc_dec(&mut self, kind: IncDec, target: ExprId) -> Try<Handle<Expression>> {
        let ty = self.shader.expr(target).ty;
        let place = self.place(target)?;
        let before = self.load_place(&place)?;
        let (op, post) = match kind {
            IncDec::PreIncrement => (BinaryOp::Add, false),
            IncDec::PreDecrement => (BinaryOp::Sub, false),
            IncDec::PostIncrement => (BinaryOp::Add, true),
            IncDec::PostDecrement => (BinaryOp::Sub, true),
        };
        let scalar = self.low.types.scalar_of(ty).unwrap_or(Scalar::Int);
        let one = match scalar {
            Scalar::Float => ScalarValue::Float(1.0),
            Scalar::Uint => ScalarValue::Uint(1),
            Scalar::Int | Scalar::Bool => ScalarValue::Int(1),
        };
        let one = self.literal(one);
        let after = self.binary_values(op, (before, ty), (one, TypeId::vector(scalar, 1)))?;
        self.store_place(&place, after)?;
        Ok(if post { before } else { after })
    }

    fn unary(&mut self, op: UnaryOp, operand: ExprId) -> Try<Handle<Expression>> {
        let ty = self.shader.expr(operand).ty;
        let value = self.value(operand)?;
        if matches!(self.low.types.get(ty), Type::Matrix(..)) {
            return self.map_columns(value, ty, |ctx, column| {
                ctx.add(Expression::Unary { op: UnaryOperator::Negate, expr: column })
            });
        }
        let op = match op {
            UnaryOp::Negate if self.low.types.scalar_of(ty) == Some(Scalar::Uint) => {
                // WGSL has no unary `-` for unsigned integers.
                let zero = self.uint(0);
                return self.binary_values(BinaryOp::Sub, (zero, TypeId::UINT), (value, ty));
            }
            UnaryOp::Negate => UnaryOperator::Negate,
            UnaryOp::Not => UnaryOperator::LogicalNot,
            UnaryOp::BitNot => UnaryOperator::BitwiseNot,
        };
        Ok(self.add(Expression::Unary { op, expr: value }))
    }

    /// The component-wise conversion to the scalar type of `to` (§4.1.10, §5.4.1).
    fn convert(&mut self, operand: ExprId, to: TypeId) -> Try<Handle<Expression>> {
        let from = self.shader.expr(operand).ty;
        let value = self.value(operand)?;
        Ok(self.converted(value, from, to))
    }

    /// Converts a value component by component.
    pub(super) fn converted(&mut self, value: Handle<Expression>, from: TypeId, to: TypeId) -> Handle<Expression> {
        let (from, to) = (self.low.types.scalar_of(from), self.low.types.scalar_of(to));
        match to {
            Some(scalar) if from != to => {
                let naga::Scalar { kind, width } = super::types::naga_scalar(scalar);
                self.add(Expression::As { expr: value, kind, convert: Some(width) })
            }
            _ => value,
        }
    }

    /// The scalar splatted to a vector, or itself for size 1.
    pub(super) fn splat(&mut self, value: Handle<Expression>, size: u8) -> Handle<Expression> {
        if size <= 1 {
            return value;
        }
        self.add(Expression::Splat { size: super::types::vector_size(size), value })
    }

    /// The place of an l-value that a call writes to.
    pub(super) fn target(&mut self, id: ExprId) -> Try<Place> {
        let outer = self.at(self.shader.expr(id).span);
        let place = self.place(id);
        self.back_to(outer);
        place
    }
}

impl Ctx<'_, '_> {
    /// Whether the expression computes something new from its operands. A vector composed of vectors counts: naga's
    /// SPIR-V writer requires constant vectors component by component.
    fn is_operation(&self, kind: &ExprKind) -> bool {
        match kind {
            ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Logical(..)
            | ExprKind::Ternary(..)
            | ExprKind::Convert(_)
            | ExprKind::BuiltinCall(..) => true,
            ExprKind::Construct(ConstructKind::Compose | ConstructKind::Resize, arguments) => arguments
                .iter()
                .any(|argument| !matches!(self.low.types.get(self.shader.expr(*argument).ty), Type::Scalar(_))),
            _ => false,
        }
    }
}
