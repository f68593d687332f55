//! How often a loop runs.
//!
//! *In:* a loop, the statements before it, and what is known of values. *Out:* the fewest and the most rounds, and from where they are
//! known. *Holds:* rounds are counted by running the counter; a bound that is a uniform is limited by its stated range, or by the
//! arrays that the counter indexes. *Not done here:* loops that are left by `break`: who walks their paths knows it.

use super::known::Known;
use glisten_front::hir::written_by;
use glisten_front::hir::{
    ArraySize, BinaryOp, Condition, ExprId, ExprKind, IncDec, LocalId, LogicalOp, LoopKind, Scalar, Stmt, StmtKind,
    Type, VarRef,
};

/// The rounds that are counted one by one.
const MOST: u64 = 1 << 20;

/// From where the rounds of a loop are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Source {
    /// Its counter has constant bounds.
    Counted,
    /// The stated range of a uniform.
    Range,
    /// The sizes of the arrays that the counter indexes.
    Array,
    /// Not at all.
    Assumed,
}

/// The rounds of a loop.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trips {
    pub(super) least: u64,
    pub(super) most: u64,
    pub(super) source: Source,
}

/// A loop as it is written.
#[derive(Clone, Copy)]
pub(super) struct Repeat<'a> {
    pub(super) kind: LoopKind,
    pub(super) condition: Option<&'a Condition>,
    pub(super) step: Option<ExprId>,
    pub(super) body: &'a [Stmt],
}

/// A counter: where it begins, and what a round does to it.
struct Counter {
    local: LocalId,
    start: f64,
    step: Step,
    is_float: bool,
}

#[derive(Clone, Copy)]
enum Step {
    Add(f64),
    Times(f64),
}

/// The rounds of a loop with `assumed` rounds where nothing is known.
pub(super) fn trips(known: &Known<'_>, repeat: Repeat<'_>, before: &[Stmt], assumed: u64) -> Trips {
    let least = u64::from(repeat.kind == LoopKind::DoWhile);
    let unknown = Trips { least, most: assumed.max(least), source: Source::Assumed };
    let Some(condition) = repeat.condition else { return unknown };
    match known.decided(condition.expr) {
        Some(true) => return unknown,
        Some(false) => return Trips { least, most: least, source: Source::Counted },
        None => {}
    }
    let (bound, is_whole) = first_comparison(known, condition.expr);
    let Some((local, operator, limit)) = bound else { return unknown };
    let Some(counter) = counter(known, repeat, local, before) else { return unknown };
    let rounds = |limit: f64| counted(&counter, operator, limit).map(|rounds| rounds.max(least));
    if let Some(limit) = known.constant(limit) {
        let Some(most) = rounds(limit) else { return unknown };
        return Trips { least: if is_whole { most } else { least }, most, source: Source::Counted };
    }
    let array = smallest_array(known, repeat.body, counter.local);
    let by_array = array.and_then(|size| counted(&counter, BinaryOp::Less, f64::from(size)));
    if let Some([low, high]) = known.bounds(limit)
        && let (Some(one), Some(other)) = (rounds(low), rounds(high))
        && high.is_finite()
    {
        let most = one.max(other).min(by_array.unwrap_or(u64::MAX));
        let fewest = if is_whole && low.is_finite() { one.min(other).min(most) } else { least };
        return Trips { least: fewest, most: most.max(least), source: Source::Range };
    }
    match by_array {
        Some(most) => Trips { least, most: most.max(least), source: Source::Array },
        None => unknown,
    }
}

/// The comparison of a local with a limit in a condition, and whether it is all of it.
fn first_comparison(known: &Known<'_>, condition: ExprId) -> (Option<(LocalId, BinaryOp, ExprId)>, bool) {
    let (mut at, mut is_whole) = (condition, true);
    while let ExprKind::Logical(LogicalOp::And, first, _) = &known.shader.expr(at).kind {
        (at, is_whole) = (*first, false);
    }
    let ExprKind::Binary(operator, left, right) = &known.shader.expr(at).kind else { return (None, is_whole) };
    let local = |id: ExprId| {
        let mut at = id;
        while let ExprKind::Convert(inner) = known.shader.expr(at).kind {
            at = inner;
        }
        match known.shader.expr(at).kind {
            ExprKind::Var(VarRef::Local(local)) => Some(local),
            _ => None,
        }
    };
    let mirrored = match operator {
        BinaryOp::Less => BinaryOp::Greater,
        BinaryOp::LessEqual => BinaryOp::GreaterEqual,
        BinaryOp::Greater => BinaryOp::Less,
        BinaryOp::GreaterEqual => BinaryOp::LessEqual,
        BinaryOp::NotEqual => BinaryOp::NotEqual,
        _ => return (None, is_whole),
    };
    let found = match (local(*left), local(*right)) {
        (Some(counter), _) => Some((counter, *operator, *right)),
        (None, Some(counter)) => Some((counter, mirrored, *left)),
        _ => None,
    };
    (found, is_whole)
}

/// The counter of a loop, if exactly one expression of it changes the local, by a constant.
fn counter(known: &Known<'_>, repeat: Repeat<'_>, local: LocalId, before: &[Stmt]) -> Option<Counter> {
    let is_counter = |target: ExprId| known.shader.root_variable(target) == Some(VarRef::Local(local));
    let mut writes = Vec::new();
    let mut note = |expr: ExprId| {
        written_by(known.shader, expr, &mut |target| {
            if is_counter(target) {
                writes.push(expr);
            }
        })
    };
    known.shader.visit_body(repeat.body, &mut note);
    for root in repeat.condition.map(|condition| condition.expr).into_iter().chain(repeat.step) {
        known.shader.visit_expr(root, &mut note);
    }
    let [write] = writes.as_slice() else { return None };
    // A write in the body counts if each round makes it.
    let in_step = repeat.step.is_some_and(|step| {
        let mut found = false;
        known.shader.visit_expr(step, &mut |expr| found |= expr == *write);
        found
    });
    let each_round = repeat.body.iter().any(|one| matches!(one.kind, StmtKind::Expr(expr) if expr == *write));
    if !in_step && !each_round {
        return None;
    }
    let step = match &known.shader.expr(*write).kind {
        ExprKind::IncDec(IncDec::PreIncrement | IncDec::PostIncrement, _) => Step::Add(1.0),
        ExprKind::IncDec(..) => Step::Add(-1.0),
        ExprKind::Assign(Some(operator), _, value) => by(known, *operator, *value)?,
        ExprKind::Assign(None, _, value) => match &known.shader.expr(*value).kind {
            ExprKind::Binary(operator, a, b) if is_counter(*a) => by(known, *operator, *b)?,
            _ => return None,
        },
        _ => return None,
    };
    let ty = known.function.locals.get(local.index())?.ty;
    let is_float = matches!(known.types.get(ty), Type::Scalar(Scalar::Float));
    Some(Counter { local, start: start(known, local, before)?, step, is_float })
}

fn by(known: &Known<'_>, operator: BinaryOp, value: ExprId) -> Option<Step> {
    let value = known.constant(value)?;
    match operator {
        BinaryOp::Add => Some(Step::Add(value)),
        BinaryOp::Sub => Some(Step::Add(-value)),
        BinaryOp::Mul => Some(Step::Times(value)),
        BinaryOp::Div => Some(Step::Times(1.0 / value)),
        BinaryOp::Shl => Some(Step::Times(2.0_f64.powf(value))),
        BinaryOp::Shr => Some(Step::Times(2.0_f64.powf(-value))),
        _ => None,
    }
}

/// The value of a local before a loop, from the nearest statement before it that gives it one.
fn start(known: &Known<'_>, local: LocalId, before: &[Stmt]) -> Option<f64> {
    for statement in before.iter().rev() {
        match &statement.kind {
            StmtKind::Local(declared, value) if *declared == local => return known.constant((*value)?),
            StmtKind::Expr(expr) => {
                if let ExprKind::Assign(None, target, value) = &known.shader.expr(*expr).kind
                    && matches!(known.shader.expr(*target).kind, ExprKind::Var(VarRef::Local(one)) if one == local)
                {
                    return known.constant(*value);
                }
            }
            _ => {}
        }
        let mut writes = false;
        known.shader.visit_body(std::slice::from_ref(statement), &mut |expr| {
            written_by(known.shader, expr, &mut |target| {
                writes |= known.shader.root_variable(target) == Some(VarRef::Local(local));
            });
        });
        if writes {
            return None;
        }
    }
    None
}

/// How often a condition on a counter holds, counted in the precision of its kind.
fn counted(counter: &Counter, operator: BinaryOp, limit: f64) -> Option<u64> {
    let (mut value, mut rounds) = (counter.start, 0);
    loop {
        let holds = match operator {
            BinaryOp::Less => value < limit,
            BinaryOp::LessEqual => value <= limit,
            BinaryOp::Greater => value > limit,
            BinaryOp::GreaterEqual => value >= limit,
            BinaryOp::NotEqual => value != limit,
            _ => return None,
        };
        if !holds {
            return Some(rounds);
        }
        rounds += 1;
        let next = match counter.step {
            Step::Add(by) => value + by,
            Step::Times(by) => value * by,
        };
        let next = if counter.is_float { f64::from(next as f32) } else { next.trunc() };
        if rounds > MOST || next == value {
            return None;
        }
        value = next;
    }
}

/// The size of the smallest array that a body indexes by a counter alone.
fn smallest_array(known: &Known<'_>, body: &[Stmt], counter: LocalId) -> Option<u32> {
    let mut smallest = None;
    known.shader.visit_body(body, &mut |expr| {
        let ExprKind::Index(array, index) = known.shader.expr(expr).kind else { return };
        let is_counter =
            matches!(known.shader.expr(index).kind, ExprKind::Var(VarRef::Local(local)) if local == counter);
        if let (true, Type::Array(_, ArraySize::Sized(size))) =
            (is_counter, known.types.get(known.shader.expr(array).ty))
        {
            smallest = Some(smallest.map_or(size, |known: u32| known.min(size)));
        }
    });
    smallest
}
