//! Differences and quotients of what became one and the same: `a - a * u` by u = 1.
//!
//! *In:* a walked stage. *Out:* the differences and quotients whose operands are written alike once what is known is a literal,
//! and were not before. *Holds:* a driver makes 0 of `a - a`, although it is NaN where `a` is infinite; of two uniforms it knows
//! nothing. So where operands may be infinite, what makes them alike stays in its uniform.

use super::identities;
use crate::forward::Walked;
use glisten_front::hir::{
    BinaryOp, ExprId, ExprKind, FunctionId, LocalId, ParamMode, ScalarValue, Stmt, StmtKind, Storage, UnaryOp, VarRef,
};
use rustc_hash::{FxHashMap, FxHashSet, FxHasher};
use std::hash::{Hash, Hasher};

/// Deeper expressions are taken to differ.
const DEPTH: u32 = 48;

/// The differences and quotients of a stage that must not become those of one expression.
pub(super) fn cancelling(walked: &Walked) -> FxHashSet<ExprId> {
    let mut found = FxHashSet::default();
    for (function, body) in walked.shader.functions().filter_map(|(id, one)| Some((id, one.body.as_deref()?))) {
        let mut keys = Keys { walked, function, definitions: definitions(walked, body), known: FxHashMap::default() };
        walked.shader.visit_statements(body, &mut |stmt| {
            for root in stmt.kind.exprs() {
                walked.shader.visit_expr(root, &mut |id| {
                    if keys.cancels(id) {
                        found.insert(id);
                    }
                });
            }
        });
    }
    found
}

/// The locals that hold one value all their life.
fn definitions(walked: &Walked, body: &[Stmt]) -> FxHashMap<LocalId, ExprId> {
    let mut defined = FxHashMap::default();
    let mut changed = FxHashSet::default();
    let shader = &walked.shader;
    let mut assigned = |target: ExprId| {
        if let Some(VarRef::Local(local)) = shader.root_variable(target) {
            changed.insert(local);
        }
    };
    shader.visit_statements(body, &mut |stmt| {
        if let StmtKind::Local(local, Some(value)) = stmt.kind {
            defined.insert(local, value);
        }
        for root in stmt.kind.exprs() {
            shader.visit_expr(root, &mut |id| match &shader.expr(id).kind {
                ExprKind::Assign(_, target, _) | ExprKind::IncDec(_, target) => assigned(*target),
                // What a call writes to is among its arguments.
                ExprKind::Call(_, arguments) | ExprKind::BuiltinCall(_, arguments) => {
                    arguments.iter().filter(|one| matches!(shader.expr(**one).kind, ExprKind::Var(_))).for_each(
                        |one| {
                            if is_written(walked, id, *one) {
                                assigned(*one);
                            }
                        },
                    );
                }
                _ => {}
            });
        }
    });
    defined.retain(|local, _| !changed.contains(local));
    defined
}

/// Whether a call writes to an argument.
fn is_written(walked: &Walked, call: ExprId, argument: ExprId) -> bool {
    match &walked.shader.expr(call).kind {
        ExprKind::Call(callee, arguments) => arguments.iter().enumerate().any(|(index, one)| {
            let mode = walked.shader.function(*callee).param_mode(index);
            *one == argument && !matches!(mode, ParamMode::In)
        }),
        ExprKind::BuiltinCall(function, arguments) => {
            *function == glisten_front::builtin::BuiltinFunction::Modf && arguments.get(1) == Some(&argument)
        }
        _ => false,
    }
}

struct Keys<'a> {
    walked: &'a Walked,
    function: FunctionId,
    definitions: FxHashMap<LocalId, ExprId>,
    /// Keys before and after, by expression.
    known: FxHashMap<(ExprId, bool), u64>,
}

impl Keys<'_> {
    fn cancels(&mut self, id: ExprId) -> bool {
        let shader = &self.walked.shader;
        let (a, b) = match shader.expr(id).kind {
            ExprKind::Binary(BinaryOp::Sub | BinaryOp::Div, a, b) => (a, b),
            ExprKind::Binary(BinaryOp::Add, a, b) => match (&shader.expr(a).kind, &shader.expr(b).kind) {
                (_, ExprKind::Unary(UnaryOp::Negate, b)) => (a, *b),
                (ExprKind::Unary(UnaryOp::Negate, a), _) => (*a, b),
                _ => return false,
            },
            _ => return false,
        };
        let facts = self.walked.facts(a);
        let float =
            |fact: &crate::facts::Fact| !matches!(fact.value(), Some(ScalarValue::Int(_) | ScalarValue::Uint(_)));
        let finite = !facts.is_empty() && facts.iter().all(|fact| fact.range().is_finite() && float(fact));
        let bound = |id: ExprId| self.walked.facts(id).iter().any(|fact| fact.bound);
        if finite || !(bound(a) || bound(b)) {
            return false;
        }
        self.key(a, true, 0) == self.key(b, true, 0) && self.key(a, false, 0) != self.key(b, false, 0)
    }

    /// What an expression computes: equal keys are equal values. `after` counts what is known as its value.
    fn key(&mut self, id: ExprId, after: bool, depth: u32) -> u64 {
        if let Some(key) = self.known.get(&(id, after)) {
            return *key;
        }
        let key = match self.same_as(id, after).filter(|_| depth < DEPTH) {
            Some(same) => self.key(same, after, depth + 1),
            None => {
                let mut hasher = FxHasher::default();
                if depth < DEPTH {
                    self.hash(id, after, depth, &mut hasher);
                } else {
                    (0u8, id, self.function).hash(&mut hasher);
                }
                hasher.finish()
            }
        };
        self.known.insert((id, after), key);
        key
    }

    /// Another expression that an expression is: the operand that it gives back, what a variable was made of.
    fn same_as(&self, id: ExprId, after: bool) -> Option<ExprId> {
        let expr = self.walked.shader.expr(id);
        if after {
            if self.walked.literal(id, super::Demand::NONE).is_some() {
                return None;
            }
            let operand = identities::operand(self.walked, id);
            if let Some(same) = operand.and_then(|operand| expr.kind.children().get(operand).copied()) {
                return Some(same);
            }
        }
        match expr.kind {
            ExprKind::Var(VarRef::Local(local)) => self.definitions.get(&local).copied(),
            _ => None,
        }
    }

    fn hash(&mut self, id: ExprId, after: bool, depth: u32, hasher: &mut FxHasher) {
        let walked = self.walked;
        let expr = walked.shader.expr(id);
        if after && let Some(values) = walked.literal(id, super::Demand::NONE) {
            1u8.hash(hasher);
            values.iter().for_each(|value| bits(*value).hash(hasher));
            return;
        }
        match &expr.kind {
            ExprKind::Literal(value) => (1u8, bits(*value)).hash(hasher),
            ExprKind::Var(VarRef::Global(global)) if is_input(walked.shader.global(*global).storage) => {
                (2u8, global).hash(hasher);
            }
            ExprKind::Member(_, member) => (3u8, member).hash(hasher),
            ExprKind::Swizzle(_, swizzle) => (4u8, swizzle).hash(hasher),
            ExprKind::Binary(op, ..) => (5u8, op).hash(hasher),
            ExprKind::Unary(op, _) => (6u8, op).hash(hasher),
            ExprKind::BuiltinCall(function, _) => (7u8, function.name()).hash(hasher),
            ExprKind::Construct(kind, _) => (8u8, kind, expr.ty).hash(hasher),
            ExprKind::Convert(_) => (9u8, expr.ty).hash(hasher),
            ExprKind::Index(..) => 10u8.hash(hasher),
            // What may be another value at another time.
            _ => return (0u8, id, self.function).hash(hasher),
        }
        for child in expr.kind.children() {
            self.key(child, after, depth + 1).hash(hasher);
        }
    }
}

fn bits(value: ScalarValue) -> (u8, u32) {
    match value {
        ScalarValue::Float(value) => (0, value.to_bits()),
        ScalarValue::Int(value) => (1, value as u32),
        ScalarValue::Uint(value) => (2, value),
        ScalarValue::Bool(value) => (3, u32::from(value)),
    }
}

/// Whether a stage only reads it.
fn is_input(storage: Storage) -> bool {
    matches!(storage, Storage::In | Storage::Uniform | Storage::Const)
}
