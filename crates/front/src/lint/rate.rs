//! How often a value changes: never, from draw to draw, or within one; and what of a loop stays the same.
//!
//! *In:* an expression of a function. *Out:* a [`Rate`]; for a loop, whether the expression is the same in each iteration.
//! *Holds:* what is not certain changes.

use super::subject::Place;
use crate::builtin::BuiltinFunction as B;
use crate::hir::{Condition, ExprId, ExprKind, Stmt, StmtKind, Storage, VarRef, may_act, written_by};
use rustc_hash::FxHashSet;

/// How often a value changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rate {
    /// Never.
    Constant,
    /// From draw to draw.
    Draw,
    /// From vertex to vertex or from fragment to fragment.
    Invocation,
}

/// The most expressions that a value is followed through.
const MOST: usize = 256;

/// How often the value of an expression changes.
pub(super) fn rate(place: &Place<'_>, root: ExprId) -> Rate {
    let mut pending = vec![root];
    let (mut rate, mut count) = (Rate::Constant, 0);
    while let Some(id) = pending.pop() {
        count += 1;
        let own = match place.kind(id) {
            ExprKind::Var(VarRef::Global(global)) => {
                let global = place.shader.global(*global);
                match global.storage {
                    Storage::Const => Rate::Constant,
                    Storage::Uniform => Rate::Draw,
                    // A variable that nothing assigns to keeps the value of its declaration.
                    Storage::Private if !global.written && global.initializer.is_some() => {
                        pending.extend(global.initializer);
                        Rate::Constant
                    }
                    _ => Rate::Invocation,
                }
            }
            ExprKind::Var(VarRef::Local(local)) => match place.definition(*local) {
                Some(value) => {
                    pending.push(value);
                    Rate::Constant
                }
                None => Rate::Invocation,
            },
            ExprKind::Call(..) | ExprKind::Assign(..) | ExprKind::IncDec(..) | ExprKind::Error => Rate::Invocation,
            ExprKind::BuiltinCall(function, _) if !function.follows_from_arguments() => Rate::Invocation,
            _ => Rate::Constant,
        };
        rate = rate.max(own);
        if rate == Rate::Invocation || count > MOST {
            return Rate::Invocation;
        }
        pending.extend(place.kind(id).children());
    }
    rate
}

/// The variables that a loop changes.
pub(super) struct Changing {
    variables: FxHashSet<VarRef>,
    /// Whether a function is called, which may change any variable of the shader.
    calls: bool,
}

impl Changing {
    /// The variables that a loop changes: those that it declares, too.
    pub(super) fn of(place: &Place<'_>, condition: Option<&Condition>, step: Option<ExprId>, body: &[Stmt]) -> Self {
        let mut changing = Self { variables: FxHashSet::default(), calls: false };
        let mut roots: Vec<ExprId> = condition.iter().map(|condition| condition.expr).chain(step).collect();
        changing.variables.extend(condition.and_then(|condition| condition.local).map(VarRef::Local));
        place.shader.visit_statements(body, &mut |statement| {
            if let StmtKind::Local(local, _) = statement.kind {
                changing.variables.insert(VarRef::Local(local));
            }
            roots.extend(statement.kind.exprs());
        });
        for root in roots {
            place.shader.visit_expr(root, &mut |expr| {
                changing.calls |= matches!(place.kind(expr), ExprKind::Call(..));
                written_by(place.shader, expr, &mut |target| {
                    changing.variables.extend(place.shader.root_variable(target));
                });
            });
        }
        changing
    }

    /// Whether an expression has the same value in each iteration.
    pub(super) fn leaves(&self, place: &Place<'_>, root: ExprId) -> bool {
        let mut same = true;
        place.shader.visit_expr(root, &mut |expr| {
            same &= match place.kind(expr) {
                ExprKind::Var(variable @ VarRef::Global(global)) => {
                    let global = place.shader.global(*global);
                    let fixed = matches!(global.storage, Storage::Const | Storage::Uniform | Storage::In);
                    fixed || !self.calls && !self.variables.contains(variable)
                }
                ExprKind::Var(variable) => !self.variables.contains(variable),
                kind => !may_act(kind),
            };
        });
        same
    }
}

/// Whether a call takes more than a few instructions on every GPU.
pub(super) fn is_costly(function: B) -> bool {
    matches!(
        function,
        B::Inverse
            | B::Determinant
            | B::Normalize
            | B::Pow
            | B::Exp
            | B::Exp2
            | B::Log
            | B::Log2
            | B::Sqrt
            | B::Inversesqrt
            | B::Sin
            | B::Cos
            | B::Tan
            | B::Asin
            | B::Acos
            | B::Atan
            | B::Length
            | B::Distance
            | B::Reflect
            | B::Refract
    )
}

/// Whether a function reads a texture.
pub(super) fn is_lookup(function: B) -> bool {
    matches!(function.class(), crate::builtin::operations::Class::Texture(_))
}
