//! Differences, quotients and their like of what became one and the same: `a - a * u` by u = 1.
//!
//! *In:* a walked stage. *Out:* the operations of which two operands are written alike once what is known is a literal,
//! and were not before. *Holds:* a driver makes 0 of `a - a`, although it is NaN where `a` is infinite; of two uniforms it knows
//! nothing. So where operands may be infinite, what makes them alike stays in its uniform.

use super::identities;
use crate::forward::Walked;
use glisten_front::builtin::operations::{Binary, Class, Numbers};
use glisten_front::hir::written_by;
use glisten_front::hir::{
    BinaryOp, ConstructKind, ExprId, ExprKind, FunctionId, LocalId, ScalarValue, Stmt, StmtKind, Storage, UnaryOp,
    VarRef,
};
use rustc_hash::{FxHashMap, FxHashSet, FxHasher};
use smallvec::{SmallVec, smallvec};
use std::hash::{Hash, Hasher};

/// Deeper expressions are taken to differ.
const DEPTH: u32 = 48;

/// The operations of a stage that must not become those of one expression.
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
            shader.visit_expr(root, &mut |id| written_by(shader, id, &mut assigned));
        }
    });
    defined.retain(|local, _| !changed.contains(local));
    defined
}

/// The pairs of operands of which an operation gives something else if they are one expression.
fn candidates(walked: &Walked, id: ExprId) -> SmallVec<[(ExprId, ExprId); 3]> {
    let shader = &walked.shader;
    match &shader.expr(id).kind {
        ExprKind::Binary(op, a, b) => match op {
            BinaryOp::Sub | BinaryOp::Div => smallvec![(*a, *b)],
            BinaryOp::Add => match (&shader.expr(*a).kind, &shader.expr(*b).kind) {
                (_, ExprKind::Unary(UnaryOp::Negate, b)) => smallvec![(*a, *b)],
                (ExprKind::Unary(UnaryOp::Negate, a), _) => smallvec![(*a, *b)],
                _ => SmallVec::new(),
            },
            // A NaN is neither equal to itself, nor at most itself.
            BinaryOp::LessEqual | BinaryOp::GreaterEqual | BinaryOp::Equal | BinaryOp::NotEqual => smallvec![(*a, *b)],
            // The same of one expression as of two, or of no floats.
            BinaryOp::Mul
            | BinaryOp::MatMul
            | BinaryOp::Rem
            | BinaryOp::Shl
            | BinaryOp::Shr
            | BinaryOp::BitAnd
            | BinaryOp::BitXor
            | BinaryOp::BitOr
            | BinaryOp::Less
            | BinaryOp::Greater
            | BinaryOp::LogicalXor => SmallVec::new(),
        },
        ExprKind::BuiltinCall(function, arguments) if may_cancel(function.class()) => {
            let pairs = arguments.iter().enumerate();
            pairs.flat_map(|(index, a)| arguments.iter().skip(index + 1).map(|b| (*a, *b))).collect()
        }
        _ => SmallVec::new(),
    }
}

/// Whether a function may give something else if two of its arguments are one expression.
fn may_cancel(class: Class) -> bool {
    match class {
        Class::Binary(op) => !matches!(op, Binary::Min | Binary::Max),
        Class::Numbers(op) => !matches!(op, Numbers::Min | Numbers::Max),
        Class::Ternary(_) | Class::Composite(_) | Class::Relation(_) | Class::Composed => true,
        // Of one argument, or products, or nothing that a driver knows by heart.
        Class::Unary(_)
        | Class::Matrix(_)
        | Class::Boolean(_)
        | Class::Test(_)
        | Class::BitCast(_)
        | Class::Bits(_)
        | Class::Packing(_)
        | Class::Modf
        | Class::Derivative(_)
        | Class::Noise(_)
        | Class::Texture(_)
        | Class::Emission(_) => false,
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
        candidates(self.walked, id).into_iter().any(|(a, b)| self.become_one(a, b))
    }

    /// Whether two operands are one expression once what is known is a literal, and may be infinite or NaN.
    fn become_one(&mut self, a: ExprId, b: ExprId) -> bool {
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
            let operand = identities::operand(self.walked, id).or_else(|| identities::spread_operand(self.walked, id));
            if let Some(same) = operand.and_then(|operand| expr.kind.children().get(operand).copied()) {
                return Some(same);
            }
        }
        match &expr.kind {
            ExprKind::Var(VarRef::Local(local)) => self.definitions.get(local).copied(),
            // Next to a vector a scalar is every component.
            ExprKind::Construct(ConstructKind::Splat, parts) => parts.first().copied(),
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
