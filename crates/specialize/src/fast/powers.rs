//! `pow(x, n)` of a whole `n` as products.
//!
//! *In:* a call with a constant exponent. *Out:* a shorter expression, or a call of a function such as `pow5`, which
//! squares and multiplies. *Holds:* as many products as people would write, at most [`MOST`]; `x` is evaluated once.

use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{
    BinaryOp, Expr, ExprId, ExprKind, Function, FunctionId, Local, LocalId, LocalKind, ParamMode, ScalarValue, Shader,
    Stmt, StmtKind, TypeId, Types, Value, VarRef, all_names, fresh_name,
};
use glisten_front::source::Span;
use rustc_hash::FxHashMap;

/// Products that take the place of a power.
const MOST: u32 = 7;

/// The functions that were written so far, by type and exponent.
#[derive(Default)]
pub(super) struct Powers {
    known: FxHashMap<(TypeId, u32), FunctionId>,
}

impl Powers {
    /// `pow(x, exponent)`, if the exponent is one number that products or roots do for.
    pub(super) fn power(
        &mut self,
        types: &Types,
        shader: &mut Shader,
        x: ExprId,
        exponent: &Value,
        expr: &Expr,
    ) -> Option<ExprKind> {
        let ScalarValue::Float(first) = exponent.scalars.first().copied()? else { return None };
        let same = exponent.scalars.iter().all(|one| *one == ScalarValue::Float(first));
        if !same || shader.expr(x).ty != expr.ty || types.scalar_of(expr.ty).is_none() {
            return None;
        }
        if first == 0.5 {
            return Some(ExprKind::BuiltinCall(F::Sqrt, vec![x]));
        }
        if first == -0.5 {
            return Some(ExprKind::BuiltinCall(F::Inversesqrt, vec![x]));
        }
        if first == 1.0 {
            return Some(shader.expr(x).kind.clone());
        }
        let n = first.abs() as u32;
        if n as f32 != first.abs() || n == 0 || products(n) > MOST {
            return None;
        }
        let positive = if n == 1 {
            x
        } else {
            let function = self.function(types, shader, expr.ty, n);
            let call = ExprKind::Call(function, vec![x]);
            if first > 0.0 {
                return Some(call);
            }
            shader.push(call, expr.ty, expr.span)
        };
        let one = shader.push(ExprKind::Literal(ScalarValue::Float(1.0)), TypeId::FLOAT, expr.span);
        Some(ExprKind::Binary(BinaryOp::Div, one, positive))
    }

    fn function(&mut self, types: &Types, shader: &mut Shader, ty: TypeId, n: u32) -> FunctionId {
        if let Some(function) = self.known.get(&(ty, n)) {
            return *function;
        }
        let function = written(types, shader, ty, n);
        let id = FunctionId::new(shader.functions.len());
        shader.functions.push(function);
        self.known.insert((ty, n), id);
        id
    }
}

/// Products of squaring and multiplying.
fn products(n: u32) -> u32 {
    n.ilog2() + n.count_ones() - 1
}

/// `float pow5(float x) { float x2 = x * x; float x4 = x2 * x2; return x * x4; }`
fn written(types: &Types, shader: &mut Shader, ty: TypeId, n: u32) -> Function {
    let span = Span::default();
    let taken = all_names(types, shader);
    let name = fresh_name(&format!("pow{n}"), |name| taken.contains(name));
    let local = |name: String, kind: LocalKind| Local { name, ty, kind, value: None, span };
    let mut locals = vec![local("x".into(), LocalKind::Param(ParamMode::In))];
    let mut body = Vec::new();
    let variable = |shader: &mut Shader, id: LocalId| shader.push(ExprKind::Var(VarRef::Local(id)), ty, span);
    let product =
        |shader: &mut Shader, a: ExprId, b: ExprId| shader.push(ExprKind::Binary(BinaryOp::Mul, a, b), ty, span);
    let mut result: Option<ExprId> = None;
    let (mut square, mut exponent) = (LocalId::new(0), 1);
    loop {
        if n & exponent != 0 {
            let factor = variable(shader, square);
            result = Some(match result {
                Some(other) => product(shader, other, factor),
                None => factor,
            });
        }
        if exponent * 2 > n {
            break;
        }
        let (a, b) = (variable(shader, square), variable(shader, square));
        let value = product(shader, a, b);
        exponent *= 2;
        // The last square of a power of two, or of 3, is no variable of its own.
        if exponent * 2 > n && (n == exponent || n == 3) {
            result = Some(match result {
                Some(other) => product(shader, value, other),
                None => value,
            });
            break;
        }
        square = LocalId::new(locals.len());
        locals.push(local(format!("x{exponent}"), LocalKind::Variable));
        body.push(Stmt { kind: StmtKind::Local(square, Some(value)), span });
    }
    body.push(Stmt { kind: StmtKind::Return(result), span });
    Function { name, ret: ty, param_count: 1, locals, body: Some(body), reachable: true, span }
}
