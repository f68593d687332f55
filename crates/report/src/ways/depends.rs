//! [`Tabulated`]: the parts of a fragment stage that are functions of one number.
//!
//! *In:* a fragment stage. *Out:* the largest expressions that depend on one scalar that differs between fragments, and on
//! uniforms and constants besides, and that cost more than a look-up saves. *Holds:* what is found has no effects, looks up
//! no texture and takes no derivative; the scalar is an expression inside of it.

use super::fixed::{Fixed, Place};
use super::names::{Names, pure_functions};
use super::same::form;
use glisten_front::builtin::BuiltinFunction as F;
use glisten_front::hir::{BinaryOp, ExprId, ExprKind, FunctionId, Shader, TypeId, Types, VarRef};
use glisten_library::cost;
use std::collections::{BTreeMap, BTreeSet};

/// The work that a look-up has to save: the weight of a power is 9, that of a division or a root 4, that of a product 1.
const LEAST_WEIGHT: u32 = 6;

/// A function of one number.
#[derive(Clone, Debug)]
pub(super) struct Tabulated {
    /// The function of the shader that it is in.
    pub(super) function: FunctionId,
    /// The expression.
    pub(super) expr: ExprId,
    /// The scalar that it depends on, or one of its equals.
    pub(super) argument: ExprId,
    /// The form of the scalar.
    pub(super) key: String,
    /// The weight of its operations.
    pub(super) weight: u32,
}

/// How an expression depends on what differs between fragments.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Depends {
    /// Not at all.
    Fixed,
    /// On one scalar: its form.
    One(String),
    /// On more, or in a way that no table has.
    Many,
}

/// Looks for functions of one number.
struct Search<'a> {
    at: Place<'a>,
    fixed: &'a Fixed,
    pure: BTreeSet<FunctionId>,
    known: BTreeMap<ExprId, Depends>,
}

/// The functions of one number in a stage, costliest first.
pub(super) fn tabulated(types: &Types, shader: &Shader, fixed: &Fixed) -> Vec<Tabulated> {
    let names = Names::of(shader);
    let at = Place { types, shader, names: &names };
    let mut pure = pure_functions(shader);
    pure.retain(|id| reads_fixed_alone(shader, fixed, *id));
    let mut search = Search { at, fixed, pure, known: BTreeMap::new() };
    let mut found: Vec<Tabulated> = Vec::new();
    for function in shader.main.map(|main| shader.callees_first(main)).unwrap_or_default().into_iter().rev() {
        let body = shader.function(function).body.as_deref().unwrap_or(&[]);
        for root in shader.roots(body) {
            search.largest(function, root, &mut found);
        }
    }
    found.sort_by_key(|one| std::cmp::Reverse(one.weight));
    found
}

/// Whether a function, with those that it calls, reads no uniform but fixed ones.
fn reads_fixed_alone(shader: &Shader, fixed: &Fixed, id: FunctionId) -> bool {
    let mut all = true;
    for id in shader.callees_first(id) {
        shader.visit_body(shader.function(id).body.as_deref().unwrap_or(&[]), &mut |expr| {
            if let ExprKind::Var(VarRef::Global(global)) = shader.expr(expr).kind {
                all &= fixed.is_fixed(global);
            }
        });
    }
    all
}

impl Search<'_> {
    /// The largest parts of an expression that are functions of one number.
    fn largest(&mut self, function: FunctionId, id: ExprId, found: &mut Vec<Tabulated>) {
        let shader = self.at.shader;
        if let Depends::One(key) = self.depends(function, id)
            && is_value(shader.expr(id).ty)
            && key != form(shader, id, None)
            && let Some(argument) = self.argument(function, id, &key)
        {
            let weight = self.weight(function, id, &key);
            // The scalar itself may be a function of another number.
            for child in shader.children(argument) {
                self.largest(function, child, found);
            }
            if weight >= LEAST_WEIGHT {
                found.push(Tabulated { function, expr: id, argument, key, weight });
            }
            return;
        }
        let children = match &shader.expr(id).kind {
            // The target is a place, not a value.
            ExprKind::Assign(_, _, value) => vec![*value],
            ExprKind::IncDec(..) => Vec::new(),
            kind => kind.children().to_vec(),
        };
        for child in children {
            self.largest(function, child, found);
        }
    }

    /// The expression that a local stands for, if that is a function of a scalar that can be evaluated wherever the local can be read.
    fn seen_through(&mut self, function: FunctionId, id: ExprId) -> Option<ExprId> {
        let shader = self.at.shader;
        let ExprKind::Var(VarRef::Local(local)) = shader.expr(id).kind else { return None };
        let (within, value) = self.at.names.get(function, local)?;
        let steady = within == function && self.at.names.is_steady(shader, function, value);
        (steady && local.index() >= shader.function(function).param_count).then_some(value)
    }

    /// An occurrence of the scalar in an expression, or in what its locals stand for.
    fn argument(&mut self, function: FunctionId, id: ExprId, key: &str) -> Option<ExprId> {
        let mut pending = vec![id];
        while let Some(id) = pending.pop() {
            if form(self.at.shader, id, None) == key {
                return Some(id);
            }
            if self.depends(function, id) == Depends::Fixed {
                continue;
            }
            pending.extend(self.seen_through(function, id));
            pending.extend(self.at.shader.children(id));
        }
        None
    }

    fn depends(&mut self, function: FunctionId, id: ExprId) -> Depends {
        if let Some(known) = self.known.get(&id) {
            return known.clone();
        }
        let depends = self.computed(function, id);
        self.known.insert(id, depends.clone());
        depends
    }

    fn computed(&mut self, function: FunctionId, id: ExprId) -> Depends {
        let shader = self.at.shader;
        if self.fixed.value(&self.at, function, id).is_some() {
            return Depends::Fixed;
        }
        if let Some(value) = self.seen_through(function, id) {
            match self.depends(function, value) {
                Depends::One(key) if key != form(shader, value, None) => return Depends::One(key),
                _ => {}
            }
        }
        let expr = shader.expr(id);
        let depends = match &expr.kind {
            ExprKind::Call(callee, list) if self.pure.contains(callee) => self.all(function, list),
            ExprKind::BuiltinCall(builtin, _) if !builtin.follows_from_arguments() => Depends::Many,
            // Limits are cheap, and a table of a limited number has finer steps.
            ExprKind::BuiltinCall(F::Min | F::Max | F::Clamp | F::Abs, _) if expr.ty == TypeId::FLOAT => Depends::Many,
            kind @ (ExprKind::Swizzle(..)
            | ExprKind::Convert(_)
            | ExprKind::Construct(..)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::Logical(..)
            | ExprKind::Ternary(..)
            | ExprKind::BuiltinCall(..)) => self.all(function, &kind.children()),
            _ => Depends::Many,
        };
        // A scalar of which nothing else is known is the one that its surroundings may depend on.
        match depends {
            Depends::Many if expr.ty == TypeId::FLOAT && self.may_repeat(id) => Depends::One(form(shader, id, None)),
            other => other,
        }
    }

    /// Whether an expression may be evaluated once instead of twice: it has no effects.
    fn may_repeat(&self, id: ExprId) -> bool {
        let shader = self.at.shader;
        let mut plain = true;
        shader.visit_expr(id, &mut |part| {
            plain &= match &shader.expr(part).kind {
                ExprKind::Assign(..) | ExprKind::IncDec(..) | ExprKind::Comma(..) => false,
                ExprKind::Call(callee, _) => self.pure.contains(callee),
                _ => true,
            };
        });
        plain
    }

    fn all(&mut self, function: FunctionId, list: &[ExprId]) -> Depends {
        let mut whole = Depends::Fixed;
        for id in list {
            whole = match (whole, self.depends(function, *id)) {
                (Depends::Fixed, other) => other,
                (one, Depends::Fixed) => one,
                (Depends::One(a), Depends::One(b)) if a == b => Depends::One(a),
                _ => return Depends::Many,
            };
        }
        whole
    }

    /// The weight of the operations of an expression, without those of the scalar, and without what is fixed.
    fn weight(&mut self, function: FunctionId, id: ExprId, key: &str) -> u32 {
        let shader = self.at.shader;
        let len = |id: ExprId| self.at.types.flat_len(shader.expr(id).ty);
        let (mut weight, mut pending) = (0u32, vec![id]);
        while let Some(id) = pending.pop() {
            if form(shader, id, None) == key || self.fixed.value(&self.at, function, id).is_some() {
                continue;
            }
            let own = match &shader.expr(id).kind {
                ExprKind::Binary(BinaryOp::Div, ..) => 4 * len(id),
                ExprKind::Binary(..) | ExprKind::Unary(..) | ExprKind::Ternary(..) => len(id),
                ExprKind::Call(callee, _) => cost(self.at.types, shader, *callee).weight(),
                ExprKind::BuiltinCall(builtin, list) => {
                    let cost = builtin.operation().cost;
                    let first = list.first().map_or(1, |first| len(*first));
                    4 * cost.special.at(len(id), first) + cost.arithmetic.at(len(id), first)
                }
                _ => 0,
            };
            weight = weight.saturating_add(own);
            pending.extend(shader.children(id));
        }
        weight
    }
}

/// Whether it is a float or a vector of floats.
fn is_value(ty: TypeId) -> bool {
    [TypeId::FLOAT, TypeId::VEC2, TypeId::VEC3, TypeId::VEC4].contains(&ty)
}
