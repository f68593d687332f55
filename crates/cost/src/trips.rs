//! How often a loop runs.
//!
//! *In:* a loop, the statements before it, and what is known of values. *Out:* the fewest and the most rounds, and from where they are
//! known. *Holds:* rounds are counted by running the counter, as its kind of number runs; a start or a limit that is a uniform is
//! between the ends of its stated range, or of the arrays that the counter indexes. *Not done here:* loops that are left by `break`: who
//! walks their paths knows it.

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
    /// The counter, and its bounds in the body, if nothing but the step of the loop changes it.
    pub(super) counter: Option<(LocalId, [f64; 2])>,
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
#[derive(Clone, Copy)]
struct Counter {
    /// Its value at the first test.
    start: Bound,
    step: Step,
    scalar: Scalar,
    /// Whether nothing but the step of the loop changes it.
    is_steady: bool,
}

/// A number of which two sides are known.
#[derive(Clone, Copy)]
struct Bound {
    sides: [f64; 2],
    /// Whether the range of a uniform says so.
    is_stated: bool,
}

#[derive(Clone, Copy)]
enum Step {
    Add(f64),
    Times(f64),
    Over(f64),
    /// By so many bits to the right.
    Down(f64),
}

/// A test of a counter.
#[derive(Clone, Copy)]
struct Test {
    local: LocalId,
    operator: BinaryOp,
    limit: ExprId,
    /// The expression that steps the counter on the way, and whether the test sees the value after it.
    steps: Option<(ExprId, bool)>,
}

/// The rounds of a loop with `assumed` rounds where nothing is known.
pub(super) fn trips(known: &Known<'_>, repeat: Repeat<'_>, before: &[Stmt], assumed: u64) -> Trips {
    let least = u64::from(repeat.kind == LoopKind::DoWhile);
    let unknown = Trips { least, most: assumed.max(least), source: Source::Assumed, counter: None };
    let Some(condition) = repeat.condition else { return unknown };
    match known.decided(condition.expr) {
        Some(true) => return unknown,
        Some(false) => return Trips { least, most: least, source: Source::Counted, counter: None },
        None => {}
    }
    // The loop ends with the first of its conditions that fails.
    let mut all: Option<Trips> = None;
    let (mut is_whole, mut is_stated) = (true, false);
    for part in parts(known, condition.expr) {
        if known.decided(part) == Some(true) {
            is_stated |= known.is_stated(part);
            continue;
        }
        match tests(known, part).into_iter().flatten().find_map(|test| tested(known, repeat, before, test)) {
            Some(own) => all = Some(all.map_or(own, |all| all.first(own))),
            None => is_whole = false,
        }
    }
    let Some(trips) = all else { return unknown };
    let source = if is_stated && trips.source == Source::Counted { Source::Range } else { trips.source };
    let fewest = if is_whole { trips.least.max(least) } else { least };
    Trips { least: fewest, most: trips.most.max(least), source, ..trips }
}

impl Trips {
    /// The rounds of a loop with two conditions that end it.
    fn first(self, other: Self) -> Self {
        let source = match (self.source, other.source) {
            (Source::Range, _) | (_, Source::Range) => Source::Range,
            (own, _) if self.most <= other.most => own,
            (_, other) => other,
        };
        let counter = self.counter.or(other.counter);
        Self { least: self.least.min(other.least), most: self.most.min(other.most), source, counter }
    }
}

/// The conditions that hold together.
fn parts(known: &Known<'_>, condition: ExprId) -> Vec<ExprId> {
    let (mut parts, mut pending) = (Vec::new(), vec![condition]);
    while let Some(id) = pending.pop() {
        match known.shader.expr(id).kind {
            ExprKind::Logical(LogicalOp::And, first, second) => pending.extend([second, first]),
            _ => parts.push(id),
        }
    }
    parts
}

/// The rounds that one condition allows.
fn tested(known: &Known<'_>, repeat: Repeat<'_>, before: &[Stmt], test: Test) -> Option<Trips> {
    let array = smallest_array(known, repeat.body, test.local).map(f64::from);
    let counter = counter(known, repeat, before, test, array)?;
    let more = u64::from(repeat.kind == LoopKind::DoWhile);
    let limit = known.bounds(test.limit);
    let falls = counter.step.falls();
    let by_array = match (counter.step, array) {
        (Step::Add(_), Some(size)) if !falls => counted(&counter, counter.start.sides[0], BinaryOp::Less, size),
        _ => None,
    };
    if let Some(sides) = limit {
        let limit = Bound { sides, is_stated: known.is_stated(test.limit) };
        if let Some([fewest, most]) = extremes(&counter, test.operator, limit) {
            let is_known = |bound: Bound| bound.sides[0] == bound.sides[1] && !bound.is_stated;
            let source = match () {
                () if is_known(counter.start) && is_known(limit) => Source::Counted,
                () if !counter.start.is_stated && counter.start.sides[0] == f64::NEG_INFINITY => Source::Array,
                () => Source::Range,
            };
            // An array says nothing against bounds that are constant.
            let by_array = by_array.filter(|_| source != Source::Counted).unwrap_or(u64::MAX);
            let most = most.min(by_array);
            let counter = counter.within(most).map(|sides| (test.local, sides));
            return Some(Trips { least: fewest.min(most) + more, most: most + more, source, counter });
        }
    }
    by_array.map(|most| Trips { least: more, most: most + more, source: Source::Array, counter: None })
}

/// The fewest and the most rounds, which are at the ends of both bounds: a counter that starts nearer to its limit makes no more of them.
fn extremes(counter: &Counter, operator: BinaryOp, limit: Bound) -> Option<[u64; 2]> {
    let [start, end] = [counter.start.sides, limit.sides];
    let is_constant = start[0] == start[1] && end[0] == end[1];
    if operator == BinaryOp::NotEqual && !is_constant {
        // Steps of 1 meet every whole number on their way; others may pass it.
        let on_way = match counter.step {
            Step::Add(1.0) => start[1] <= end[0],
            Step::Add(-1.0) => start[0] >= end[1],
            _ => false,
        };
        if !on_way || counter.scalar == Scalar::Float {
            return None;
        }
    }
    let mut found: Option<[u64; 2]> = None;
    for from in start {
        for to in end {
            let rounds = counted(counter, from, operator, to)?;
            found = Some(found.map_or([rounds; 2], |[least, most]| [least.min(rounds), most.max(rounds)]));
        }
    }
    found
}

/// The tests of a local against a limit that a condition may be: either side may be the counter.
fn tests(known: &Known<'_>, condition: ExprId) -> [Option<Test>; 2] {
    let ExprKind::Binary(operator, left, right) = &known.shader.expr(condition).kind else { return [None; 2] };
    let local = |id: ExprId| {
        let mut at = id;
        while let ExprKind::Convert(inner) = known.shader.expr(at).kind {
            at = inner;
        }
        let (place, steps) = match known.shader.expr(at).kind {
            ExprKind::IncDec(IncDec::PreIncrement | IncDec::PreDecrement, place) => (place, Some((at, true))),
            ExprKind::IncDec(_, place) => (place, Some((at, false))),
            _ => (at, None),
        };
        match known.shader.expr(place).kind {
            ExprKind::Var(VarRef::Local(local)) => Some((local, steps)),
            _ => None,
        }
    };
    let mirrored = match operator {
        BinaryOp::Less => BinaryOp::Greater,
        BinaryOp::LessEqual => BinaryOp::GreaterEqual,
        BinaryOp::Greater => BinaryOp::Less,
        BinaryOp::GreaterEqual => BinaryOp::LessEqual,
        BinaryOp::NotEqual => BinaryOp::NotEqual,
        _ => return [None; 2],
    };
    let test = |(local, steps), operator, limit| Test { local, operator, limit, steps };
    [local(*left).map(|found| test(found, *operator, *right)), local(*right).map(|found| test(found, mirrored, *left))]
}

/// The counter of a loop, if exactly one expression of it changes the local, by a constant. `size` is that of an array that it indexes.
fn counter(known: &Known<'_>, repeat: Repeat<'_>, before: &[Stmt], test: Test, size: Option<f64>) -> Option<Counter> {
    let local = test.local;
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
    // A write in the body or the condition counts if each round makes it.
    let in_step = repeat.step.is_some_and(|step| {
        let mut found = false;
        known.shader.visit_expr(step, &mut |expr| found |= expr == *write);
        found
    });
    let in_body = repeat.body.iter().any(|one| matches!(one.kind, StmtKind::Expr(expr) if expr == *write));
    let in_test = test.steps.filter(|(expr, _)| expr == write);
    if !in_step && !in_body && in_test.is_none() {
        return None;
    }
    let step = match &known.shader.expr(*write).kind {
        ExprKind::IncDec(IncDec::PreIncrement | IncDec::PostIncrement, _) => Step::Add(1.0),
        ExprKind::IncDec(..) => Step::Add(-1.0),
        ExprKind::Assign(Some(operator), _, value) => by(known, *operator, *value)?,
        ExprKind::Assign(None, _, value) => match &known.shader.expr(*value).kind {
            ExprKind::Binary(operator, a, b) if is_counter(*a) => by(known, *operator, *b)?,
            ExprKind::Binary(operator @ (BinaryOp::Add | BinaryOp::Mul), a, b) if is_counter(*b) => {
                by(known, *operator, *a)?
            }
            _ => return None,
        },
        _ => return None,
    };
    let ty = known.function.locals.get(local.index())?.ty;
    let Type::Scalar(scalar) = known.types.get(ty) else { return None };
    let mut start = match start(known, local, before) {
        Some(value) => known.bounds(value).map(|sides| Bound { sides, is_stated: known.is_stated(value) }),
        None => None,
    };
    // One that falls from an unknown place still begins within the array.
    if let (true, Some(size)) = (step.falls(), size) {
        let bound = start.unwrap_or(Bound { sides: [f64::NEG_INFINITY, f64::INFINITY], is_stated: false });
        let [low, high] = bound.sides;
        if low < high {
            start = Some(Bound { sides: [low, high.min(size - 1.0)], ..bound });
        }
    }
    let is_steady = in_step && repeat.kind != LoopKind::DoWhile;
    let counter = Counter { start: start?, step, scalar, is_steady };
    // The first test sees the counter after a step where it comes behind one.
    let is_behind = match in_test {
        Some((_, is_behind)) => is_behind,
        None => repeat.kind == LoopKind::DoWhile,
    };
    if !is_behind {
        return Some(counter);
    }
    let sides = counter.start.sides.map(|side| counter.next(side));
    Some(Counter { start: Bound { sides, ..counter.start }, ..counter })
}

fn by(known: &Known<'_>, operator: BinaryOp, value: ExprId) -> Option<Step> {
    let value = known.constant(value)?;
    match operator {
        BinaryOp::Add => Some(Step::Add(value)),
        BinaryOp::Sub => Some(Step::Add(-value)),
        BinaryOp::Mul if value > 0.0 => Some(Step::Times(value)),
        BinaryOp::Div if value > 0.0 => Some(Step::Over(value)),
        BinaryOp::Shl => Some(Step::Times(value.exp2())),
        BinaryOp::Shr => Some(Step::Down(value)),
        _ => None,
    }
}

/// The value that a local is given before a loop, by the nearest statement before it that gives it one.
fn start(known: &Known<'_>, local: LocalId, before: &[Stmt]) -> Option<ExprId> {
    for statement in before.iter().rev() {
        match &statement.kind {
            StmtKind::Local(declared, value) if *declared == local => return *value,
            StmtKind::Expr(expr) => {
                if let ExprKind::Assign(None, target, value) = &known.shader.expr(*expr).kind
                    && matches!(known.shader.expr(*target).kind, ExprKind::Var(VarRef::Local(one)) if one == local)
                {
                    return Some(*value);
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

impl Step {
    /// Whether it makes a counter from 0 on less.
    fn falls(self) -> bool {
        match self {
            Self::Add(by) => by < 0.0,
            Self::Times(by) => by < 1.0,
            Self::Over(by) => by > 1.0,
            Self::Down(_) => true,
        }
    }
}

impl Counter {
    /// The bounds of its values in so many rounds.
    fn within(&self, rounds: u64) -> Option<[f64; 2]> {
        let Step::Add(by) = self.step else { return None };
        let way = by * rounds.checked_sub(1)? as f64;
        let [low, high] = self.start.sides;
        self.is_steady.then_some([low + way.min(0.0), high + way.max(0.0)])
    }

    /// The value after a step, as its kind of number has it: integers wrap (§4.1.3).
    fn next(&self, value: f64) -> f64 {
        let next = match self.step {
            Step::Add(by) => value + by,
            Step::Times(by) => value * by,
            Step::Over(by) => value / by,
            Step::Down(bits) => (value / bits.exp2()).floor(),
        };
        const ALL: f64 = 4_294_967_296.0;
        match self.scalar {
            _ if !next.is_finite() => next,
            Scalar::Float => f64::from(next as f32),
            Scalar::Uint | Scalar::Bool => next.trunc().rem_euclid(ALL),
            Scalar::Int => (next.trunc() + ALL / 2.0).rem_euclid(ALL) - ALL / 2.0,
        }
    }
}

/// How often a condition on a counter holds, counted in the numbers of its kind.
fn counted(counter: &Counter, start: f64, operator: BinaryOp, limit: f64) -> Option<u64> {
    let (mut value, mut rounds) = (start, 0);
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
        let next = counter.next(value);
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
