//! Functions of which nothing but one short expression is left go where they are called.
//!
//! *In:* a stage. *Out:* the stage; whether anything went. *Holds:* arguments are without effects, and each stands for a
//! parameter that is used at most once, or is as short as a name or a number. One with implicit derivatives (§8.7, §8.8) does
//! not go where fragments next to each other may not both evaluate it. Nor does what computes something go into an operand of `?:` or
//! `&&`: with a call one operand is executed, without calls both are, and one is chosen.

use glisten_front::hir::{Expr, ExprId, ExprKind, FunctionId, Shader, Stmt, StmtKind, VarRef, may_act};
use rustc_hash::FxHashMap;
use smallvec::SmallVec;

/// A function may be so many expressions long to be written where it is called from several places.
const SHORT: usize = 5;

/// A function that is one expression.
struct Small {
    result: ExprId,
    params: usize,
    /// How often each parameter is used.
    uses: Vec<u32>,
    /// Whether a use of each parameter is evaluated under a condition.
    conditional: Vec<bool>,
    length: usize,
}

/// Writes short functions where they are called.
pub(super) fn inline(shader: &mut Shader) -> bool {
    let mut calls = vec![0u32; shader.functions.len()];
    for expr in &shader.exprs {
        if let ExprKind::Call(callee, _) = expr.kind
            && let Some(calls) = calls.get_mut(callee.index())
        {
            *calls += 1;
        }
    }
    let conditional = conditional_calls(shader);
    let mut changed = false;
    // Children precede their parents, and what is inserted follows: an expression is looked at once.
    for index in 0..shader.exprs.len() {
        let Some(Expr { kind: ExprKind::Call(callee, arguments), .. }) = shader.exprs.get(index) else { continue };
        let (callee, arguments) = (*callee, arguments.clone());
        let Some(small) = small(shader, callee) else { continue };
        let once = calls.get(callee.index()).copied().unwrap_or(0) <= 1;
        if small.length > if once { 4 * SHORT } else { SHORT } || !fits(shader, &small, &arguments) {
            continue;
        }
        let under = conditional.get(&index);
        if under.is_some_and(|works| *works || !gives_a_part(shader, small.result)) {
            continue;
        }
        let inserted = substitute(shader, small.result, &arguments);
        let Expr { kind, .. } = shader.expr(inserted).clone();
        if let Some(expr) = shader.exprs.get_mut(index) {
            expr.kind = kind;
            changed = true;
        }
    }
    changed
}

/// The calls that are evaluated under a condition, by their numbers, and whether anything else is computed next to them.
fn conditional_calls(shader: &Shader) -> FxHashMap<usize, bool> {
    let mut calls: FxHashMap<usize, bool> = FxHashMap::default();
    for expr in &shader.exprs {
        let operands = under_condition(&expr.kind);
        let mut own = Vec::new();
        let mut works = false;
        for operand in operands {
            shader.visit_expr(operand, &mut |inner| match &shader.expr(inner).kind {
                ExprKind::Call(..) => own.push(inner),
                kind => works |= computes(kind),
            });
        }
        for call in own {
            *calls.entry(call.index()).or_default() |= works;
        }
    }
    calls
}

/// Whether an expression only takes values apart, or puts them together.
fn gives_a_part(shader: &Shader, root: ExprId) -> bool {
    let mut works = false;
    shader.visit_expr(root, &mut |expr| works |= computes(&shader.expr(expr).kind));
    !works
}

fn computes(kind: &ExprKind) -> bool {
    match kind {
        ExprKind::Error
        | ExprKind::Literal(_)
        | ExprKind::Var(_)
        | ExprKind::Member(..)
        | ExprKind::Index(..)
        | ExprKind::Swizzle(..)
        | ExprKind::Construct(..)
        | ExprKind::Comma(..)
        | ExprKind::Call(..) => false,
        ExprKind::Convert(_)
        | ExprKind::Unary(..)
        | ExprKind::IncDec(..)
        | ExprKind::Binary(..)
        | ExprKind::Logical(..)
        | ExprKind::Ternary(..)
        | ExprKind::Assign(..)
        | ExprKind::BuiltinCall(..) => true,
    }
}

fn small(shader: &Shader, callee: FunctionId) -> Option<Small> {
    let function = shader.functions.get(callee.index())?;
    let [Stmt { kind: StmtKind::Return(Some(result)), .. }] = function.body.as_deref()? else { return None };
    let in_only = (0..function.param_count).all(|index| crate::forward::is_in(function.param_mode(index)));
    let mut uses = vec![0u32; function.param_count];
    let mut conditional = vec![false; function.param_count];
    let (mut length, mut plain) = (0, in_only);
    shader.visit_expr(*result, &mut |expr| {
        length += 1;
        for part in under_condition(&shader.expr(expr).kind) {
            shader.visit_expr(part, &mut |inner| {
                if let ExprKind::Var(VarRef::Local(local)) = shader.expr(inner).kind
                    && let Some(conditional) = conditional.get_mut(local.index())
                {
                    *conditional = true;
                }
            });
        }
        match shader.expr(expr).kind {
            ExprKind::Var(VarRef::Local(local)) => match uses.get_mut(local.index()) {
                Some(uses) => *uses += 1,
                None => plain = false,
            },
            // A built-in function may write to a parameter, which an argument need not allow (GLSL 1.50 §6.1.1).
            ref kind if may_act(kind) => plain = false,
            _ => {}
        }
    });
    plain.then_some(Small { result: *result, params: function.param_count, uses, conditional, length })
}

/// The operands that are evaluated only if another one is so.
fn under_condition(kind: &ExprKind) -> SmallVec<[ExprId; 2]> {
    match kind {
        ExprKind::Ternary(_, yes, no) => SmallVec::from_slice(&[*yes, *no]),
        ExprKind::Logical(_, _, right) => SmallVec::from_slice(&[*right]),
        _ => SmallVec::new(),
    }
}

fn fits(shader: &Shader, small: &Small, arguments: &[ExprId]) -> bool {
    // What is given back as it is may do anything: nothing else is evaluated.
    if arguments.len() == 1 && small.params == 1 && small.length == 1 && small.uses == [1] {
        return true;
    }
    arguments.len() == small.params
        && arguments.iter().zip(&small.uses).zip(&small.conditional).all(|((argument, uses), conditional)| {
            let mut plain = true;
            shader.visit_expr(*argument, &mut |expr| {
                let kind = &shader.expr(expr).kind;
                let derives = matches!(kind, ExprKind::BuiltinCall(function, _) if function.implicit_derivatives());
                plain &= !(may_act(kind) || derives && *conditional);
            });
            let short = matches!(shader.expr(*argument).kind, ExprKind::Var(_) | ExprKind::Literal(_));
            plain && (*uses <= 1 || short)
        })
}

/// The expression with arguments in the place of parameters, after all others.
fn substitute(shader: &mut Shader, root: ExprId, arguments: &[ExprId]) -> ExprId {
    let mut order = Vec::new();
    shader.visit_expr(root, &mut |expr| order.push(expr));
    let mut places = FxHashMap::default();
    for id in order.into_iter().rev() {
        if let ExprKind::Var(VarRef::Local(local)) = shader.expr(id).kind
            && let Some(argument) = arguments.get(local.index())
        {
            places.insert(id, *argument);
            continue;
        }
        let Expr { mut kind, ty, span } = shader.expr(id).clone();
        kind.for_each_operand(&mut |child| {
            if let Some(place) = places.get(child) {
                *child = *place;
            }
        });
        let copy = shader.push(kind, ty, span);
        places.insert(id, copy);
    }
    places.get(&root).copied().unwrap_or(root)
}
