//! The algebra of expressions under fast math.
//!
//! *In:* a settled stage. *Out:* the same stage with cheaper expressions. *Holds:* operands are neither dropped nor
//! duplicated, so calls in them are made as often as before and in the same order, unless they have no effects.
//!
//! | expression | becomes |
//! | --- | --- |
//! | `x / c` | `x * (1 / c)` |
//! | `(x * a) * b`, `(x + a) - b` and their like | one operation with one constant |
//! | `D * v` of a constant diagonal matrix | `v`, or `v` times the diagonal |
//! | `A * (B * v)` of constant matrices | `(A * B) * v` |
//! | `(A * B) * v` of others | `A * (B * v)` |
//! | `pow(x, n)` of a whole n | products, or `sqrt`, `inversesqrt` |
//! | `1.0 / sqrt(x)` | `inversesqrt(x)` |
//! | `x * -1.0`, `0.0 - x`, `-(-x)`, `a + -b`, `normalize(normalize(x))` | the shorter form |

use super::powers::Powers;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::fold;
use glisten_front::hir::{
    BinaryOp, ConstructKind, Expr, ExprId, ExprKind, Scalar, ScalarValue, Shader, Storage, Type, TypeId, Types,
    UnaryOp, Value, VarRef,
};
use glisten_front::source::Span;

/// An expression is rewritten at most so often before its parent is looked at.
const ROUNDS: usize = 4;

/// Rewrites all expressions of a stage.
pub(crate) fn simplify(types: &Types, shader: &mut Shader) {
    let n_given = shader.exprs.len();
    let mut algebra = Algebra { types, shader, powers: Powers::default() };
    // Operands precede what they are operands of.
    for index in 0..n_given {
        for _ in 0..ROUNDS {
            let Some(expr) = algebra.shader.exprs.get(index).cloned() else { break };
            let Some(kind) = algebra.rewritten(&expr) else { break };
            if let Some(expr) = algebra.shader.exprs.get_mut(index) {
                expr.kind = kind;
            }
        }
    }
}

struct Algebra<'a> {
    types: &'a Types,
    shader: &'a mut Shader,
    powers: Powers,
}

/// `sign * x + constant`
struct Sum {
    negative: bool,
    x: ExprId,
    constant: Value,
}

fn number(value: f32) -> Value {
    Value { ty: TypeId::FLOAT, scalars: vec![ScalarValue::Float(value)] }
}

impl Algebra<'_> {
    fn rewritten(&mut self, expr: &Expr) -> Option<ExprKind> {
        if self.types.scalar_of(expr.ty) != Some(Scalar::Float) {
            return None;
        }
        match &expr.kind {
            ExprKind::Binary(BinaryOp::Div, a, b) => self.quotient(*a, *b, expr),
            ExprKind::Assign(Some(BinaryOp::Div), target, divisor) => {
                let inverse = self.inverse(*divisor)?;
                Some(ExprKind::Assign(Some(BinaryOp::Mul), *target, inverse))
            }
            ExprKind::Binary(BinaryOp::Mul, ..) => self.product(expr),
            ExprKind::Binary(BinaryOp::Add | BinaryOp::Sub, ..) => self.sum(expr),
            ExprKind::Binary(BinaryOp::MatMul, a, b) => self.matrices(*a, *b, expr),
            ExprKind::Unary(UnaryOp::Negate, a) => match self.shader.expr(*a).kind {
                ExprKind::Unary(UnaryOp::Negate, inner) => Some(self.shader.expr(inner).kind.clone()),
                _ => None,
            },
            ExprKind::BuiltinCall(F::Pow, arguments) => {
                let [x, exponent] = arguments.as_slice() else { return None };
                let value = self.constant(*exponent)?;
                self.powers.power(self.types, self.shader, *x, &value, expr)
            }
            ExprKind::BuiltinCall(F::Normalize, arguments) => {
                let inner = self.shader.expr(*arguments.first()?).kind.clone();
                matches!(inner, ExprKind::BuiltinCall(F::Normalize, _)).then_some(inner)
            }
            _ => None,
        }
    }

    fn push(&mut self, kind: ExprKind, ty: TypeId, span: Span) -> ExprId {
        self.shader.push(kind, ty, span)
    }

    /// A value as an expression.
    fn literal(&mut self, value: &Value, span: Span) -> ExprId {
        let mut parts = Vec::with_capacity(value.scalars.len());
        for scalar in &value.scalars {
            parts.push(self.push(ExprKind::Literal(*scalar), TypeId::FLOAT, span));
        }
        match (self.types.get(value.ty), parts.first()) {
            (Type::Scalar(_), Some(first)) => *first,
            (Type::Vector(..), Some(first)) if value.scalars.iter().all(|one| Some(one) == value.scalars.first()) => {
                let first = *first;
                self.push(ExprKind::Construct(ConstructKind::Splat, vec![first]), value.ty, span)
            }
            _ => self.push(ExprKind::Construct(ConstructKind::Compose, parts), value.ty, span),
        }
    }

    /// The value of numbers, or of a constant with a name.
    fn constant(&self, id: ExprId) -> Option<Value> {
        let is_number = |id: ExprId| match self.shader.expr(id).kind {
            ExprKind::Literal(_) => true,
            ExprKind::Var(VarRef::Global(id)) => self.shader.global(id).storage == Storage::Const,
            ExprKind::Unary(UnaryOp::Negate, a) => matches!(self.shader.expr(a).kind, ExprKind::Literal(_)),
            _ => false,
        };
        let known = match &self.shader.expr(id).kind {
            ExprKind::Construct(_, list) => list.iter().all(|one| is_number(*one)),
            _ => is_number(id),
        };
        if !known || self.types.scalar_of(self.shader.expr(id).ty) != Some(Scalar::Float) {
            return None;
        }
        fold::evaluate(self.shader, self.types, id, &|_| None)
    }

    /// The operand that is open, and the value of the one that is known.
    fn split(&self, a: ExprId, b: ExprId) -> Option<(ExprId, Value)> {
        match (self.constant(a), self.constant(b)) {
            (None, Some(value)) => Some((a, value)),
            (Some(value), None) => Some((b, value)),
            _ => None,
        }
    }

    /// `a op b`, component by component, if that is finite and no subnormal.
    fn combined(&self, op: BinaryOp, a: &Value, b: &Value) -> Option<Value> {
        let (n_a, n_b) = (a.scalars.len(), b.scalars.len());
        if n_a != n_b && n_a != 1 && n_b != 1 {
            return None;
        }
        let one = |index: usize| {
            let [x, y] = [a, b].map(|value| value.scalars.get(if value.scalars.len() == 1 { 0 } else { index }));
            let (Some(ScalarValue::Float(x)), Some(ScalarValue::Float(y))) = (x, y) else { return None };
            let result = match op {
                BinaryOp::Add => x + y,
                BinaryOp::Sub => x - y,
                BinaryOp::Mul => x * y,
                _ => x / y,
            };
            (result.is_normal() || result == 0.0).then_some(ScalarValue::Float(result))
        };
        let scalars = (0..n_a.max(n_b)).map(one).collect::<Option<Vec<_>>>()?;
        Some(Value { ty: if n_a >= n_b { a.ty } else { b.ty }, scalars })
    }

    fn is_all(value: &Value, number: f32) -> bool {
        value.scalars.iter().all(|scalar| matches!(scalar, ScalarValue::Float(scalar) if *scalar == number))
    }

    /// `1 / c` of a constant.
    fn inverse(&mut self, divisor: ExprId) -> Option<ExprId> {
        let value = self.constant(divisor)?;
        let one = number(1.0);
        let inverse = self.combined(BinaryOp::Div, &one, &value)?;
        // The inverse of an infinity would be 0.
        if inverse.scalars.contains(&ScalarValue::Float(0.0)) {
            return None;
        }
        let span = self.shader.expr(divisor).span;
        Some(self.literal(&inverse, span))
    }

    fn quotient(&mut self, a: ExprId, b: ExprId, expr: &Expr) -> Option<ExprKind> {
        if let ExprKind::BuiltinCall(F::Sqrt, arguments) = &self.shader.expr(b).kind
            && expr.ty == self.shader.expr(b).ty
            && self.constant(a).is_some_and(|value| Self::is_all(&value, 1.0))
        {
            return Some(ExprKind::BuiltinCall(F::Inversesqrt, arguments.clone()));
        }
        let inverse = self.inverse(b)?;
        Some(ExprKind::Binary(BinaryOp::Mul, a, inverse))
    }

    fn product(&mut self, expr: &Expr) -> Option<ExprKind> {
        let ExprKind::Binary(_, a, b) = expr.kind else { return None };
        let (x, value) = self.split(a, b)?;
        if self.shader.expr(x).ty == expr.ty && Self::is_all(&value, -1.0) {
            return Some(ExprKind::Unary(UnaryOp::Negate, x));
        }
        let (x, value) = match self.shader.expr(x).kind {
            ExprKind::Binary(BinaryOp::Mul, a, b) => {
                let (inner, other) = self.split(a, b)?;
                (inner, self.combined(BinaryOp::Mul, &value, &other)?)
            }
            ExprKind::Unary(UnaryOp::Negate, inner) => {
                let minus = number(-1.0);
                (inner, self.combined(BinaryOp::Mul, &value, &minus)?)
            }
            _ => return None,
        };
        if self.shader.expr(x).ty == expr.ty && Self::is_all(&value, 1.0) {
            return Some(self.shader.expr(x).kind.clone());
        }
        let value = self.literal(&value, expr.span);
        Some(ExprKind::Binary(BinaryOp::Mul, x, value))
    }

    /// An addition or subtraction of a constant.
    fn as_sum(&self, id: ExprId) -> Option<Sum> {
        let ExprKind::Binary(op @ (BinaryOp::Add | BinaryOp::Sub), a, b) = self.shader.expr(id).kind else {
            return None;
        };
        self.as_sum_of(op, a, b)
    }

    fn sum(&mut self, expr: &Expr) -> Option<ExprKind> {
        let ExprKind::Binary(op, a, b) = expr.kind else { return None };
        let Some(outer) = self.as_sum_of(op, a, b) else { return self.without_sign(op, a, b) };
        if let Some(inner) = self.as_sum(outer.x) {
            let op = if outer.negative { BinaryOp::Sub } else { BinaryOp::Add };
            let constant = self.combined(op, &outer.constant, &inner.constant)?;
            let joined = Sum { negative: outer.negative != inner.negative, x: inner.x, constant };
            return self.written(&joined, expr);
        }
        let whole = self.shader.expr(outer.x).ty == expr.ty;
        if whole && outer.negative && Self::is_all(&outer.constant, 0.0) {
            return Some(ExprKind::Unary(UnaryOp::Negate, outer.x));
        }
        None
    }

    fn as_sum_of(&self, op: BinaryOp, a: ExprId, b: ExprId) -> Option<Sum> {
        let (x, constant) = self.split(a, b)?;
        let minus = number(-1.0);
        Some(match op {
            BinaryOp::Add => Sum { negative: false, x, constant },
            _ if x == a => Sum { negative: false, x, constant: self.combined(BinaryOp::Mul, &minus, &constant)? },
            _ => Sum { negative: true, x, constant },
        })
    }

    /// A sum as people write it: `x - 2.0`, not `x + -2.0`.
    fn written(&mut self, sum: &Sum, expr: &Expr) -> Option<ExprKind> {
        let whole = self.shader.expr(sum.x).ty == expr.ty;
        if whole && Self::is_all(&sum.constant, 0.0) {
            let kind = self.shader.expr(sum.x).kind.clone();
            return Some(if sum.negative { ExprKind::Unary(UnaryOp::Negate, sum.x) } else { kind });
        }
        let below = |scalar: &ScalarValue| matches!(scalar, ScalarValue::Float(value) if *value < 0.0);
        if !sum.negative && sum.constant.scalars.iter().all(below) {
            let minus = number(-1.0);
            let constant = self.combined(BinaryOp::Mul, &minus, &sum.constant)?;
            let constant = self.literal(&constant, expr.span);
            return Some(ExprKind::Binary(BinaryOp::Sub, sum.x, constant));
        }
        let constant = self.literal(&sum.constant, expr.span);
        Some(if sum.negative {
            ExprKind::Binary(BinaryOp::Sub, constant, sum.x)
        } else {
            ExprKind::Binary(BinaryOp::Add, sum.x, constant)
        })
    }

    /// `a + -b` is `a - b`, and `a - -b` is `a + b`.
    fn without_sign(&self, op: BinaryOp, a: ExprId, b: ExprId) -> Option<ExprKind> {
        let ExprKind::Unary(UnaryOp::Negate, inner) = self.shader.expr(b).kind else { return None };
        let op = if op == BinaryOp::Add { BinaryOp::Sub } else { BinaryOp::Add };
        Some(ExprKind::Binary(op, a, inner))
    }

    fn matrices(&mut self, a: ExprId, b: ExprId, expr: &Expr) -> Option<ExprKind> {
        for (matrix, other) in [(a, b), (b, a)] {
            let Some(diagonal) = self.diagonal(matrix).filter(|_| self.shader.expr(other).ty == expr.ty) else {
                continue;
            };
            if Self::is_all(&diagonal, 1.0) {
                return Some(self.shader.expr(other).kind.clone());
            }
            if !self.is_matrix(other) {
                let diagonal = self.literal(&diagonal, expr.span);
                return Some(ExprKind::Binary(BinaryOp::Mul, other, diagonal));
            }
        }
        // Two constants next to each other.
        if let Some((b, v)) = self.factors(b)
            && self.is_matrix(a)
            && self.is_matrix(b)
            && let Some(product) = self.constant_product(a, b)
        {
            return Some(ExprKind::Binary(BinaryOp::MatMul, product, v));
        }
        if let Some((v, a)) = self.factors(a)
            && self.is_matrix(a)
            && self.is_matrix(b)
            && let Some(product) = self.constant_product(a, b)
        {
            return Some(ExprKind::Binary(BinaryOp::MatMul, v, product));
        }
        // A vector goes through one matrix after the other.
        if let Some((a, m)) = self.factors(a)
            && self.is_matrix(a)
            && self.is_matrix(m)
            && !self.is_matrix(b)
        {
            let ty = self.shader.expr(m).ty;
            let Type::Matrix(_, rows) = self.types.get(ty) else { return None };
            let first =
                self.push(ExprKind::Binary(BinaryOp::MatMul, m, b), TypeId::vector(Scalar::Float, rows), expr.span);
            return Some(ExprKind::Binary(BinaryOp::MatMul, a, first));
        }
        None
    }

    /// The diagonal of a constant matrix without anything else, one number if all of it are the same.
    fn diagonal(&self, id: ExprId) -> Option<Value> {
        let Type::Matrix(columns, rows) = self.types.get(self.shader.expr(id).ty) else { return None };
        let value = self.constant(id).filter(|_| columns == rows)?;
        let size = usize::from(rows);
        let on_diagonal = |index: usize| index / size == index % size;
        let zero = |scalar: &ScalarValue| matches!(scalar, ScalarValue::Float(0.0));
        if value.scalars.iter().enumerate().any(|(index, scalar)| !on_diagonal(index) && !zero(scalar)) {
            return None;
        }
        let scalars: Vec<ScalarValue> = value.scalars.iter().step_by(size + 1).copied().collect();
        match scalars.first() {
            Some(first) if scalars.iter().all(|scalar| scalar == first) => {
                Some(Value { ty: TypeId::FLOAT, scalars: vec![*first] })
            }
            _ => Some(Value { ty: TypeId::vector(Scalar::Float, rows), scalars }),
        }
    }

    fn is_matrix(&self, id: ExprId) -> bool {
        matches!(self.types.get(self.shader.expr(id).ty), Type::Matrix(..))
    }

    fn factors(&self, id: ExprId) -> Option<(ExprId, ExprId)> {
        match self.shader.expr(id).kind {
            ExprKind::Binary(BinaryOp::MatMul, a, b) => Some((a, b)),
            _ => None,
        }
    }

    fn constant_product(&mut self, a: ExprId, b: ExprId) -> Option<ExprId> {
        self.constant(a)?;
        self.constant(b)?;
        let (a_ty, b_ty) = (self.shader.expr(a).ty, self.shader.expr(b).ty);
        let (Type::Matrix(_, rows), Type::Matrix(columns, _)) = (self.types.get(a_ty), self.types.get(b_ty)) else {
            return None;
        };
        let span = self.shader.expr(b).span;
        let product = self.push(ExprKind::Binary(BinaryOp::MatMul, a, b), TypeId::matrix(columns, rows), span);
        let value = fold::evaluate(self.shader, self.types, product, &|_| None)?;
        let finite = |scalar: &ScalarValue| matches!(scalar, ScalarValue::Float(value) if value.is_finite());
        if value.scalars.iter().all(finite) { Some(self.literal(&value, span)) } else { None }
    }
}
