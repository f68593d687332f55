//! How a function uses its variables: reads, writes, conditions; and whether expressions have the same form.
//!
//! *In:* the statements of a function. *Out:* a [`LocalUse`] for each local.

use crate::hir::{
    BinaryOp, ExprId, ExprKind, Function, GlobalId, ParamMode, Shader, Stmt, StmtKind, VarRef, same_value, written_by,
};
use rustc_hash::FxHashSet;

/// The uses of a local.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LocalUse {
    /// The value in its declaration.
    pub(super) initializer: Option<ExprId>,
    /// Whether it is declared in a statement (and not a parameter or the variable of a condition).
    pub(super) is_declared: bool,
    /// How often it is assigned, besides its declaration.
    pub(super) writes: usize,
    /// How often its value is used, other than for a new value of itself.
    pub(super) reads: usize,
    /// How often the text names it, besides its declaration.
    pub(super) mentions: usize,
    /// Whether a condition names it.
    pub(super) in_condition: bool,
}

/// The uses of all locals of a function, and the globals that its conditions name.
pub(super) fn of_variables(
    shader: &Shader,
    function: &Function,
    statements: &[&Stmt],
) -> (Vec<LocalUse>, FxHashSet<GlobalId>) {
    let mut locals = vec![LocalUse::default(); function.locals.len()];
    let (mut globals, mut marked) = (FxHashSet::default(), FxHashSet::default());
    for statement in statements {
        match &statement.kind {
            StmtKind::Local(id, initializer) => {
                if let Some(local) = locals.get_mut(id.index()) {
                    (local.initializer, local.is_declared) = (*initializer, true);
                }
            }
            StmtKind::Loop { condition: Some(condition), .. } => {
                let local = condition.local.and_then(|id| locals.get_mut(id.index()));
                local.into_iter().for_each(|local| local.reads += 1);
            }
            _ => {}
        }
        for root in statement.kind.exprs() {
            let is_whole = matches!(statement.kind, StmtKind::Expr(_)) || is_step(statement, root);
            visit(shader, root, is_whole, &mut locals);
            shader.visit_expr(root, &mut |expr| {
                if let ExprKind::Var(VarRef::Local(local)) = shader.expr(expr).kind {
                    locals.get_mut(local.index()).into_iter().for_each(|local| local.mentions += 1);
                }
            });
        }
        conditions(shader, statement, &mut |condition| {
            mark(shader, condition, &mut locals, (&mut globals, &mut marked));
        });
    }
    (locals, globals)
}

fn is_step(statement: &Stmt, root: ExprId) -> bool {
    matches!(statement.kind, StmtKind::Loop { step: Some(step), .. } if step == root)
}

/// Counts the reads and writes of an expression. The value of `root` is dropped if it is a whole statement.
fn visit(shader: &Shader, root: ExprId, is_whole: bool, locals: &mut [LocalUse]) {
    let mut pending = vec![(root, is_whole)];
    while let Some((id, is_dropped)) = pending.pop() {
        let kind = &shader.expr(id).kind;
        let written = |target: ExprId, locals: &mut [LocalUse], reads: bool| {
            if let Some(VarRef::Local(local)) = shader.root_variable(target)
                && let Some(local) = locals.get_mut(local.index())
            {
                local.writes += 1;
                local.reads += usize::from(reads);
            }
        };
        match kind {
            ExprKind::Var(VarRef::Local(local)) => {
                locals.get_mut(local.index()).into_iter().for_each(|local| local.reads += 1);
            }
            ExprKind::Assign(_, target, value) => {
                written(*target, locals, !is_dropped);
                pending.extend(shader.indices_of_place(*target).into_iter().map(|index| (index, false)));
                pending.push((*value, false));
            }
            ExprKind::IncDec(_, target) => {
                written(*target, locals, !is_dropped);
                pending.extend(shader.indices_of_place(*target).into_iter().map(|index| (index, false)));
            }
            ExprKind::Comma(first, second) => pending.extend([(*first, true), (*second, is_dropped)]),
            ExprKind::Call(..) | ExprKind::BuiltinCall(..) => {
                let mut outs = Vec::new();
                written_by(shader, id, &mut |target| outs.push(target));
                for (index, argument) in kind.children().into_iter().enumerate() {
                    let reads = match kind {
                        ExprKind::Call(callee, _) => shader.function(*callee).param_mode(index) != ParamMode::Out,
                        _ => false,
                    };
                    if outs.contains(&argument) {
                        written(argument, locals, reads);
                        pending.extend(shader.indices_of_place(argument).into_iter().map(|index| (index, false)));
                    } else {
                        pending.push((argument, false));
                    }
                }
            }
            _ => pending.extend(kind.children().into_iter().map(|child| (child, false))),
        }
    }
}

/// Calls `f` for each condition of a statement and of the expressions in it.
fn conditions(shader: &Shader, statement: &Stmt, f: &mut dyn FnMut(ExprId)) {
    match &statement.kind {
        StmtKind::If { arms, .. } => arms.iter().for_each(|(condition, _)| f(*condition)),
        StmtKind::Loop { condition: Some(condition), .. } => f(condition.expr),
        StmtKind::Switch { selector, .. } => f(*selector),
        _ => {}
    }
    for root in statement.kind.exprs() {
        shader.visit_expr(root, &mut |expr| match &shader.expr(expr).kind {
            ExprKind::Ternary(condition, ..) | ExprKind::Logical(_, condition, _) => f(*condition),
            _ => {}
        });
    }
}

/// Marks the variables of a condition. What was marked is passed over: in `a && b && c`, each operand is in the conditions around it.
fn mark(
    shader: &Shader,
    condition: ExprId,
    locals: &mut [LocalUse],
    (globals, marked): (&mut FxHashSet<GlobalId>, &mut FxHashSet<ExprId>),
) {
    let mut pending = vec![condition];
    while let Some(expr) = pending.pop() {
        if !marked.insert(expr) {
            continue;
        }
        match &shader.expr(expr).kind {
            ExprKind::Var(VarRef::Local(local)) => {
                locals.get_mut(local.index()).into_iter().for_each(|local| local.in_condition = true);
            }
            ExprKind::Var(VarRef::Global(global)) => {
                globals.insert(*global);
            }
            kind => pending.extend(kind.children()),
        }
    }
}

/// Whether two bodies do the same, statement by statement. Bodies that declare variables are never the same.
pub(super) fn same_statements(shader: &Shader, a: &[Stmt], b: &[Stmt]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_statement(shader, a, b))
}

fn same_statement(shader: &Shader, a: &Stmt, b: &Stmt) -> bool {
    match (&a.kind, &b.kind) {
        (StmtKind::Expr(a), StmtKind::Expr(b)) => same_effect(shader, *a, *b),
        (StmtKind::Block(a), StmtKind::Block(b)) => same_statements(shader, a, b),
        (StmtKind::Return(Some(a)), StmtKind::Return(Some(b))) => same_value(shader, *a, *b),
        (StmtKind::Return(None), StmtKind::Return(None))
        | (StmtKind::Break, StmtKind::Break)
        | (StmtKind::Continue, StmtKind::Continue)
        | (StmtKind::Discard, StmtKind::Discard) => true,
        _ => false,
    }
}

/// Whether two expressions that stand alone do the same.
fn same_effect(shader: &Shader, a: ExprId, b: ExprId) -> bool {
    match (&shader.expr(a).kind, &shader.expr(b).kind) {
        (ExprKind::Assign(one, target, value), ExprKind::Assign(other, other_target, other_value)) => {
            one == other && same_value(shader, *target, *other_target) && same_value(shader, *value, *other_value)
        }
        (ExprKind::IncDec(one, a), ExprKind::IncDec(other, b)) => one == other && same_value(shader, *a, *b),
        (ExprKind::Call(one, a), ExprKind::Call(other, b)) => {
            one == other && a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same_value(shader, *a, *b))
        }
        _ => same_value(shader, a, b),
    }
}

/// The l-values that an expression itself writes, each with whether it is read, too; and the indices on the way there.
pub(super) fn written_by_parts(shader: &Shader, id: ExprId) -> (Vec<(ExprId, bool)>, Vec<ExprId>) {
    let kind = &shader.expr(id).kind;
    let mut written = Vec::new();
    written_by(shader, id, &mut |target| written.push(target));
    let reads = |target: ExprId| match kind {
        ExprKind::Assign(operator, ..) => operator.is_some(),
        ExprKind::IncDec(..) => true,
        ExprKind::Call(callee, arguments) => {
            let index = arguments.iter().position(|argument| *argument == target);
            index.is_some_and(|index| shader.function(*callee).param_mode(index) == ParamMode::Inout)
        }
        _ => false,
    };
    let inner = written.iter().flat_map(|target| shader.indices_of_place(*target)).collect();
    (written.iter().map(|target| (*target, reads(*target))).collect(), inner)
}

/// Whether an operator compares.
pub(super) fn compares(operator: BinaryOp) -> bool {
    use BinaryOp::{Equal, Greater, GreaterEqual, Less, LessEqual, NotEqual};
    matches!(operator, Less | Greater | LessEqual | GreaterEqual | Equal | NotEqual)
}
