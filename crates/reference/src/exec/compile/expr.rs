//! Compiles expressions (§5).

use super::super::inst::{Class, Compare, Float1, Float2, FloatToInt, Inst, Int1, Int2, IntToFloat, Operand};
use super::effects::Assigned;
use super::facts::Definition;
use super::{Compiler, Scope, Val};
use glisten_front::diagnostic::codes;
use glisten_front::fold;
use glisten_front::hir::{
    BinaryOp, ConstructKind, Expr, ExprId, ExprKind, IncDec, LogicalOp, Scalar, Type, TypeId, UnaryOp,
};

impl Compiler<'_> {
    /// Evaluates an expression in the active lanes, without effects in inactive ones.
    pub(super) fn expr(&mut self, id: ExprId) -> Val {
        let shader = self.shader;
        let expr = shader.expr(id);
        let value = self.at(expr.span, |this| this.expr_of(expr, id));
        self.note_expr(expr, &value);
        value
    }

    fn expr_of(&mut self, expr: &Expr, id: ExprId) -> Val {
        match &expr.kind {
            ExprKind::Error => Val::new(),
            ExprKind::Literal(value) => Val::from_slice(&[self.literal(*value)]),
            ExprKind::Var(var) => match self.var_of(*var) {
                Some(var) => self.read_all(var),
                None => Val::new(),
            },
            ExprKind::Member(..) | ExprKind::Index(..) | ExprKind::Swizzle(..) => {
                let path = self.path(id);
                self.read_path(&path)
            }
            ExprKind::Convert(inner) => {
                let value = self.expr(*inner);
                self.convert(&value, self.ty(*inner), expr.ty)
            }
            ExprKind::Construct(kind, arguments) => self.construct(*kind, arguments, expr.ty),
            ExprKind::Unary(op, inner) => {
                // `-1.0` is a number like any other: nothing is executed for it.
                if let ExprKind::Literal(value) = self.shader.expr(*inner).kind
                    && let Some(value) = fold::unary(*op, value)
                {
                    return Val::from_slice(&[self.literal(value)]);
                }
                let value = self.expr(*inner);
                self.unary(*op, &value, expr.ty)
            }
            ExprKind::IncDec(op, place) => self.inc_dec(*op, *place),
            ExprKind::Binary(op, a, b) => self.binary_expr(*op, *a, *b, expr.ty),
            ExprKind::Logical(op, a, b) => self.logical(*op, *a, *b),
            ExprKind::Ternary(condition, yes, no) => self.ternary(*condition, *yes, *no, expr.ty),
            ExprKind::Assign(op, place, value) => self.assignment(*op, *place, *value),
            ExprKind::Comma(first, second) => {
                self.expr(*first);
                self.expr(*second)
            }
            ExprKind::Call(function, arguments) => self.call(*function, arguments, expr.span),
            ExprKind::BuiltinCall(function, arguments) => self.builtin_call(*function, arguments, expr.ty),
        }
    }

    /// The scalar of an expression that has one.
    pub(super) fn scalar(&mut self, id: ExprId) -> Operand {
        let value = self.expr(id);
        match value.first() {
            Some(operand) => *operand,
            None => self.emit.zero(Class::Int),
        }
    }

    /// Copies operands that a later store may change.
    pub(super) fn keep_all(&mut self, expr: ExprId, value: Val) -> Val {
        let classes = self.classes(self.ty(expr));
        value.iter().zip(classes.iter()).map(|(operand, class)| self.emit.keep(*class, *operand)).collect()
    }

    /// Evaluates from left to right, so that the effects of a later expression do not change an earlier one's value.
    pub(super) fn in_order(&mut self, exprs: &[ExprId]) -> Vec<Val> {
        let last_effect = exprs.iter().rposition(|expr| self.effects.has(*expr)).unwrap_or(0);
        let mut values = Vec::with_capacity(exprs.len());
        for (place, expr) in exprs.iter().enumerate() {
            let value = self.expr(*expr);
            values.push(if place < last_effect { self.keep_all(*expr, value) } else { value });
        }
        values
    }

    pub(super) fn float1(&mut self, op: Float1, a: Operand) -> Operand {
        let dst = self.emit.pure(Class::Float, &[a], |dst| Inst::Float1 { op, dst, a });
        match op {
            Float1::Neg => self.emit.define(dst, Definition::Same(a)),
            Float1::Sqrt | Float1::Inversesqrt => self.emit.define(dst, Definition::Root(op, a)),
            _ => {}
        }
        dst
    }
    pub(super) fn float2(&mut self, op: Float2, a: Operand, b: Operand) -> Operand {
        let dst = self.emit.pure(Class::Float, &[a, b], |dst| Inst::Float2 { op, dst, a, b });
        if matches!(op, Float2::Add | Float2::Sub | Float2::Mul | Float2::Div) {
            self.emit.define(dst, Definition::Of(op, a, b));
        }
        if op == Float2::Step {
            self.of_one_less(dst);
        }
        dst
    }
    pub(super) fn int1(&mut self, op: Int1, a: Operand) -> Operand {
        self.emit.pure(Class::Int, &[a], |dst| Inst::Int1 { op, dst, a })
    }
    pub(super) fn int2(&mut self, op: Int2, a: Operand, b: Operand) -> Operand {
        self.emit.pure(Class::Int, &[a, b], |dst| Inst::Int2 { op, dst, a, b })
    }
    pub(super) fn compare(&mut self, op: Compare, a: Operand, b: Operand) -> Operand {
        self.emit.pure(Class::Int, &[a, b], |dst| Inst::Compare { op, dst, a, b })
    }
    pub(super) fn select(&mut self, class: Class, c: Operand, a: Operand, b: Operand) -> Operand {
        self.emit.pure(class, &[c, a, b], |dst| match class {
            Class::Float => Inst::SelectFloat { dst, c, a, b },
            Class::Int => Inst::SelectInt { dst, c, a, b },
        })
    }

    pub(super) fn convert(&mut self, value: &[Operand], from: TypeId, to: TypeId) -> Val {
        let (Some(from), Some(to)) = (self.types.scalar_of(from), self.types.scalar_of(to)) else {
            return Val::from_slice(value);
        };
        value.iter().map(|operand| self.convert_scalar(*operand, from, to)).collect()
    }

    pub(super) fn convert_scalar(&mut self, a: Operand, from: Scalar, to: Scalar) -> Operand {
        use Scalar::{Bool, Float, Int, Uint};
        let float_to_int =
            |op: FloatToInt, this: &mut Self| this.emit.pure(Class::Int, &[a], |dst| Inst::FloatToInt { op, dst, a });
        match (from, to) {
            (Float, Float) | (Int | Uint | Bool, Int | Uint) | (Bool, Bool) => a,
            (Float, Int) => float_to_int(FloatToInt::Int, self),
            (Float, Uint) => float_to_int(FloatToInt::Uint, self),
            (Float, Bool) => float_to_int(FloatToInt::Bool, self),
            (Int | Uint, Bool) => self.int1(Int1::Bool, a),
            (Int | Bool, Float) => {
                let number = self.emit.pure(Class::Float, &[a], |dst| Inst::IntToFloat { op: IntToFloat::Int, dst, a });
                if from == Bool {
                    self.of_one_less(number);
                }
                number
            }
            (Uint, Float) => {
                self.emit.pure(Class::Float, &[a], |dst| Inst::IntToFloat { op: IntToFloat::Uint, dst, a })
            }
        }
    }

    fn construct(&mut self, kind: ConstructKind, arguments: &[ExprId], ty: TypeId) -> Val {
        let values = self.in_order(arguments);
        let count = self.types.flat_len(ty) as usize;
        match kind {
            ConstructKind::Splat => {
                let one = values.first().and_then(|value| value.first()).copied();
                one.map_or_else(Val::new, |one| (0..count).map(|_| one).collect())
            }
            ConstructKind::Compose => values.into_iter().flatten().take(count).collect(),
            ConstructKind::Array | ConstructKind::Struct => values.into_iter().flatten().collect(),
            ConstructKind::Diagonal => {
                let one = values.first().and_then(|value| value.first()).copied();
                let diagonal = one.unwrap_or_else(|| self.emit.zero(Class::Float));
                self.matrix_from(ty, |this, column, row| if column == row { diagonal } else { this.emit.float(0.0) })
            }
            ConstructKind::Resize => {
                let source = arguments.first().map(|argument| self.types.get(self.ty(*argument)));
                let Some(Type::Matrix(columns, rows)) = source else { return Val::new() };
                let value = values.into_iter().next().unwrap_or_default();
                self.matrix_from(ty, |this, column, row| {
                    let inside = column < columns && row < rows;
                    let flat = usize::from(column) * usize::from(rows) + usize::from(row);
                    match value.get(flat).filter(|_| inside) {
                        Some(operand) => *operand,
                        None => this.emit.float(if column == row { 1.0 } else { 0.0 }),
                    }
                })
            }
        }
    }

    fn matrix_from(&mut self, ty: TypeId, mut element: impl FnMut(&mut Self, u8, u8) -> Operand) -> Val {
        let Type::Matrix(columns, rows) = self.types.get(ty) else { return Val::new() };
        let places = (0..columns).flat_map(|column| (0..rows).map(move |row| (column, row)));
        places.map(|(column, row)| element(self, column, row)).collect()
    }

    fn unary(&mut self, op: UnaryOp, value: &[Operand], ty: TypeId) -> Val {
        let float = self.class(ty) == Class::Float;
        value
            .iter()
            .map(|a| match op {
                UnaryOp::Negate if float => self.float1(Float1::Neg, *a),
                UnaryOp::Negate => self.int1(Int1::Neg, *a),
                UnaryOp::Not => self.int1(Int1::Not, *a),
                UnaryOp::BitNot => self.int1(Int1::BitNot, *a),
            })
            .collect()
    }

    fn inc_dec(&mut self, op: IncDec, place: ExprId) -> Val {
        let ty = self.ty(place);
        let path = self.path(place);
        let before = self.read_path(&path);
        let before = self.keep_all(place, before);
        let one = if self.class(ty) == Class::Float { self.emit.float(1.0) } else { self.emit.int(1) };
        let plus = matches!(op, IncDec::PreIncrement | IncDec::PostIncrement);
        let operator = if plus { BinaryOp::Add } else { BinaryOp::Sub };
        let after: Val = before.iter().map(|a| self.arithmetic(operator, *a, one, self.types.scalar_of(ty))).collect();
        self.write_path(&path, &after);
        self.note_stepped(place, &after);
        if matches!(op, IncDec::PreIncrement | IncDec::PreDecrement) { after } else { before }
    }

    fn binary_expr(&mut self, op: BinaryOp, a: ExprId, b: ExprId, ty: TypeId) -> Val {
        let left = self.expr(a);
        let left = if self.effects.has(b) { self.keep_all(a, left) } else { left };
        let right = self.expr(b);
        self.binary(op, &left, self.ty(a), &right, self.ty(b), ty)
    }

    /// `left op right` with these types and the result type `ty`.
    pub(super) fn binary(
        &mut self,
        op: BinaryOp,
        left: &[Operand],
        left_ty: TypeId,
        right: &[Operand],
        right_ty: TypeId,
        ty: TypeId,
    ) -> Val {
        match op {
            BinaryOp::MatMul => self.mat_mul(left, left_ty, right, right_ty),
            BinaryOp::Equal | BinaryOp::NotEqual => {
                let same = self.whole_equal(left, right, left_ty);
                Val::from_slice(&[if op == BinaryOp::Equal { same } else { self.int1(Int1::Not, same) }])
            }
            _ => {
                let scalar = self.types.scalar_of(left_ty);
                let count = (self.types.flat_len(ty) as usize).max(1);
                (0..count)
                    .map(|flat| {
                        let a = component(left, flat).unwrap_or_else(|| self.emit.zero(Class::Int));
                        let b = component(right, flat).unwrap_or_else(|| self.emit.zero(Class::Int));
                        self.arithmetic(op, a, b, scalar)
                    })
                    .collect()
            }
        }
    }

    /// An operator on scalars of a type.
    pub(super) fn arithmetic(&mut self, op: BinaryOp, a: Operand, b: Operand, scalar: Option<Scalar>) -> Operand {
        use BinaryOp as B;
        let signed = scalar == Some(Scalar::Int);
        if scalar == Some(Scalar::Float) {
            return match op {
                B::Add => self.chained(Float2::Add, a, b),
                B::Sub => self.chained(Float2::Sub, a, b),
                B::Mul => self.chained(Float2::Mul, a, b),
                B::Div => self.chained(Float2::Div, a, b),
                B::Rem => self.float2(Float2::Mod, a, b),
                B::Less => self.compare(Compare::Less, a, b),
                B::Greater => self.compare(Compare::Less, b, a),
                B::LessEqual => self.compare(Compare::LessEqual, a, b),
                B::GreaterEqual => self.compare(Compare::LessEqual, b, a),
                B::Equal => self.compare(Compare::Equal, a, b),
                B::NotEqual => self.compare(Compare::NotEqual, a, b),
                B::MatMul | B::Shl | B::Shr | B::BitAnd | B::BitXor | B::BitOr | B::LogicalXor => a,
            };
        }
        let by_sign = |yes: Int2, no: Int2| if signed { yes } else { no };
        let less = by_sign(Int2::LessSigned, Int2::LessUnsigned);
        let less_equal = by_sign(Int2::LessEqualSigned, Int2::LessEqualUnsigned);
        match op {
            B::Add => self.int2(Int2::Add, a, b),
            B::Sub => self.int2(Int2::Sub, a, b),
            B::Mul | B::MatMul => self.int2(Int2::Mul, a, b),
            B::Div => self.int2(by_sign(Int2::DivSigned, Int2::DivUnsigned), a, b),
            B::Rem => self.int2(by_sign(Int2::RemSigned, Int2::RemUnsigned), a, b),
            B::Shl => self.int2(Int2::Shl, a, b),
            B::Shr => self.int2(by_sign(Int2::ShrSigned, Int2::ShrUnsigned), a, b),
            B::BitAnd => self.int2(Int2::And, a, b),
            B::BitOr => self.int2(Int2::Or, a, b),
            B::BitXor | B::LogicalXor => self.int2(Int2::Xor, a, b),
            B::Less => self.int2(less, a, b),
            B::Greater => self.int2(less, b, a),
            B::LessEqual => self.int2(less_equal, a, b),
            B::GreaterEqual => self.int2(less_equal, b, a),
            B::Equal => self.int2(Int2::Equal, a, b),
            B::NotEqual => self.int2(Int2::NotEqual, a, b),
        }
    }

    /// Whether all scalars are equal (§5.9).
    fn whole_equal(&mut self, left: &[Operand], right: &[Operand], ty: TypeId) -> Operand {
        let classes = self.classes(ty);
        let mut all: Option<Operand> = None;
        for ((a, b), class) in left.iter().zip(right).zip(classes.iter()) {
            let same = match class {
                Class::Float => self.compare(Compare::Equal, *a, *b),
                Class::Int => self.int2(Int2::Equal, *a, *b),
            };
            all = Some(match all {
                None => same,
                Some(before) => self.int2(Int2::And, before, same),
            });
        }
        all.unwrap_or_else(|| self.emit.int(1))
    }

    fn logical(&mut self, op: LogicalOp, a: ExprId, b: ExprId) -> Val {
        let left = self.scalar(a);
        if !self.effects.has(b) && !self.emit.form.notes() {
            let right = self.chosen(left, op == LogicalOp::And, b).first().copied();
            let right = right.unwrap_or_else(|| self.emit.zero(Class::Int));
            let op = if op == LogicalOp::And { Int2::And } else { Int2::Or };
            return Val::from_slice(&[self.int2(op, left, right)]);
        }
        let left = self.emit.keep(Class::Int, left);
        let result = self.declare(TypeId::BOOL, false);
        self.assign(result, 0, left);
        let condition = if op == LogicalOp::And { left } else { self.int1(Int1::Not, left) };
        self.when(condition, b, result);
        self.read_all(result)
    }

    /// An operand without effects that is executed only where `condition` is `is`: all lanes compute it, since nobody can tell, but an
    /// observer that counts sees the others idle.
    fn chosen(&mut self, condition: Operand, is: bool, expr: ExprId) -> Val {
        if !self.emit.form.chooses() {
            return self.expr(expr);
        }
        let slot = self.emit.slot();
        self.emit.push(Inst::Watch { c: condition, is, slot });
        let value = self.expr(expr);
        self.emit.push(Inst::Unwatch { slot });
        value
    }

    /// Assigns the value of `expr` to `result` in the lanes where `condition` is true.
    fn when(&mut self, condition: Operand, expr: ExprId, result: super::vars::VarId) {
        let mut assigned = Assigned::default();
        self.effects.expr(self.shader, expr, &mut assigned);
        self.settle_assigned(&assigned);
        let classes = self.vars.get(result.0).map_or(0, |var| var.classes.len());
        for flat in 0..classes {
            self.settle(result, flat);
        }
        let (join, rest) = (self.emit.slot(), self.emit.slot());
        self.emit.push(Inst::Save { slot: join });
        let arm = self.emit.jump(Inst::Arm { c: condition, rest, next: 0 });
        self.scopes.push(Scope::Arms { join });
        self.in_region(|this| {
            let value = this.expr(expr);
            this.assign_all(result, &value);
        });
        self.scopes.pop();
        self.emit.land(arm);
        self.emit.push(Inst::Join { slot: join });
    }

    fn ternary(&mut self, condition: ExprId, yes: ExprId, no: ExprId, ty: TypeId) -> Val {
        let c = self.scalar(condition);
        if !self.effects.has(yes) && !self.effects.has(no) && !self.emit.form.notes() {
            let (yes, no) = (self.chosen(c, true, yes), self.chosen(c, false, no));
            let classes = self.classes(ty);
            return (yes.iter().zip(&no).zip(classes.iter()))
                .map(|((a, b), class)| if a == b { *a } else { self.select(*class, c, *a, *b) })
                .collect();
        }
        let c = self.emit.keep(Class::Int, c);
        let opposite = self.int1(Int1::Not, c);
        let result = self.declare(ty, false);
        self.when(c, yes, result);
        self.when(opposite, no, result);
        self.read_all(result)
    }

    fn assignment(&mut self, op: Option<BinaryOp>, place: ExprId, value: ExprId) -> Val {
        let path = self.path_before(place, self.effects.has(value));
        let ty = self.ty(place);
        let value = match op {
            None => self.expr(value),
            Some(op) => {
                // `a op= b` is `a = a op b`: the left operand is read first.
                let left = self.read_path(&path);
                let left = if self.effects.has(value) { self.keep_all(place, left) } else { left };
                let value_ty = self.ty(value);
                let right = self.expr(value);
                self.binary(op, &left, ty, &right, value_ty, ty)
            }
        };
        if value.len() != self.types.flat_len(ty) as usize && !self.full() {
            let span = self.shader.expr(place).span;
            self.refuse(&codes::general::INTERNAL, span, "an assignment of another size");
        }
        let value = self.keep_all(place, value);
        self.write_path(&path, &value);
        value
    }
}

/// The component of a vector or matrix, or the scalar itself.
pub(super) fn component(value: &[Operand], flat: usize) -> Option<Operand> {
    if value.len() == 1 { value.first().copied() } else { value.get(flat).copied() }
}
