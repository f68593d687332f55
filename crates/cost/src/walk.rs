//! Walks a shader: the paths through each function, its loops, and what keeps a GPU from testing the depth early.
//!
//! *In:* a shader, the rates of its values, what is known of its uniforms. *Out:* the paths of `main` and what was seen on the way.
//! *Holds:* operations on constants count nothing, since every compiler folds them; a function is walked once. A condition that is
//! known takes one branch.

use super::counts::Counts;
use super::known::{Known, Ranges};
use super::paths::{Exit, Flow, Line, Path, Paths, Way};
use super::rates::{Rate, Rates};
use super::trips::{Repeat, Trips, trips};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::written_by;
use glisten_front::hir::{
    Case, ExprId, ExprKind, FunctionId, LogicalOp, Shader, Stmt, StmtKind, Storage, Types, VarRef,
};
use glisten_front::source::Span;
use glisten_library::own_cost;
use std::collections::BTreeMap;

/// Things that a walk sees besides the paths.
#[derive(Default)]
pub(super) struct Seen {
    /// The loops, each with its place.
    pub(super) loops: Vec<(Span, Trips)>,
    /// The places that keep a GPU from testing the depth before the fragment stage runs.
    pub(super) late: Vec<(Span, &'static str)>,
}

/// The state of a walk.
pub(super) struct Walk<'a> {
    pub(super) types: &'a Types,
    pub(super) shader: &'a Shader,
    pub(super) ranges: &'a Ranges,
    pub(super) assumed: u64,
    /// The line of a place.
    pub(super) line_of: &'a mut dyn FnMut(Span) -> Line,
    pub(super) paths: Paths,
    pub(super) seen: Seen,
    rates: Rates,
    functions: BTreeMap<FunctionId, Flow>,
}

impl<'a> Walk<'a> {
    pub(super) fn new(
        (types, shader): (&'a Types, &'a Shader),
        ranges: &'a Ranges,
        assumed: u64,
        line_of: &'a mut dyn FnMut(Span) -> Line,
    ) -> Self {
        let order = shader.main.map(|main| shader.callees_first(main)).unwrap_or_default();
        let rates = Rates::of(types, shader, &order);
        let (paths, seen, functions) = (Paths::new(), Seen::default(), BTreeMap::new());
        Self { types, shader, ranges, assumed, line_of, paths, seen, rates, functions }
    }

    /// The shortest and the longest path of the whole shader.
    pub(super) fn whole(&mut self) -> Way {
        let shader = self.shader;
        let Some(main) = shader.main else { return Paths::way(Paths::NOTHING) };
        let known = Known::new(self.types, shader, shader.function(main), self.ranges);
        let mut flow = Paths::nothing();
        for global in shader.globals.iter().filter(|global| global.used && global.storage != Storage::Uniform) {
            if let Some(value) = global.initializer {
                let value = self.expr(&known, value);
                flow = self.paths.then(flow, value);
            }
        }
        for function in shader.callees_first(main) {
            let known = Known::new(self.types, shader, shader.function(function), self.ranges);
            let body = known.function.body.as_deref().unwrap_or(&[]);
            let inside = self.list(&known, body);
            let next = self.paths.way_or(inside.at(Exit::Next), inside.at(Exit::Return));
            let whole = Flow::leaving(Exit::Next, next).with(Exit::End, inside.at(Exit::End));
            self.functions.insert(function, whole);
        }
        let body = self.functions.get(&main).copied().unwrap_or_default();
        let flow = self.paths.then(flow, body);
        let way = self.paths.way_or(flow.at(Exit::Next), flow.at(Exit::End));
        way.unwrap_or_else(|| Paths::way(Paths::NOTHING))
    }

    fn list(&mut self, known: &Known<'_>, statements: &[Stmt]) -> Flow {
        let mut flow = Paths::nothing();
        for (index, statement) in statements.iter().enumerate() {
            let before = statements.get(..index).unwrap_or(&[]);
            let next = self.statement(known, statement, before);
            flow = self.paths.then(flow, next);
            if flow.at(Exit::Next).is_none() {
                break;
            }
        }
        flow
    }

    fn statement(&mut self, known: &Known<'_>, statement: &Stmt, before: &[Stmt]) -> Flow {
        let leaving = |exit| Flow::leaving(exit, Some(Paths::way(Paths::NOTHING)));
        match &statement.kind {
            StmtKind::Expr(expr) | StmtKind::Local(_, Some(expr)) => self.expr(known, *expr),
            StmtKind::Local(_, None) => Paths::nothing(),
            StmtKind::Block(body) => self.list(known, body),
            StmtKind::If { arms, otherwise } => self.branches(known, arms, otherwise),
            StmtKind::Switch { selector, cases } => {
                let inside = self.cases(known, *selector, cases);
                let selector = self.expr(known, *selector);
                let decision = self.decision(statement.span);
                let selector = self.paths.then(selector, decision);
                self.paths.then(selector, inside)
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let repeat = Repeat { kind: *kind, condition: condition.as_ref(), step: *step, body };
                self.repeat(known, repeat, statement.span, before)
            }
            StmtKind::Break => leaving(Exit::Break),
            StmtKind::Continue => leaving(Exit::Continue),
            StmtKind::Return(None) => leaving(Exit::Return),
            StmtKind::Return(Some(value)) => {
                let value = self.expr(known, *value);
                self.paths.then(value, leaving(Exit::Return))
            }
            StmtKind::Discard => {
                self.seen.late.push((statement.span, "discard"));
                leaving(Exit::End)
            }
        }
    }

    fn decision(&mut self, span: Span) -> Flow {
        let line = (self.line_of)(span);
        let path = self.paths.work(line, Counts::BRANCH, false);
        Flow::leaving(Exit::Next, Some(Paths::way(path)))
    }

    fn branches(&mut self, known: &Known<'_>, arms: &[(ExprId, Vec<Stmt>)], otherwise: &[Stmt]) -> Flow {
        let mut flow = self.list(known, otherwise);
        for (condition, body) in arms.iter().rev() {
            let inside = self.list(known, body);
            let choice = match known.decided(*condition) {
                Some(true) => inside,
                Some(false) => flow,
                None => self.paths.or(inside, flow),
            };
            let head = self.expr(known, *condition);
            let decision = self.decision(self.shader.expr(*condition).span);
            let head = self.paths.then(head, decision);
            flow = self.paths.then(head, choice);
        }
        flow
    }

    /// The cases of a `switch`: each that the selector allows may be where it begins, and goes on into the next.
    fn cases(&mut self, known: &Known<'_>, selector: ExprId, cases: &[Case]) -> Flow {
        let (may_begin, may_pass) = known.may_begin(selector, cases);
        let mut all = if may_pass { Paths::nothing() } else { Flow::default() };
        let mut rest = Paths::nothing();
        for (case, may_begin) in cases.iter().zip(may_begin).rev() {
            let body = self.list(known, &case.body);
            rest = self.paths.then(body, rest);
            if may_begin {
                all = self.paths.or(all, rest);
            }
        }
        let next = self.paths.way_or(all.at(Exit::Next), all.at(Exit::Break));
        all.with(Exit::Next, next).with(Exit::Break, None)
    }

    fn repeat(&mut self, known: &Known<'_>, repeat: Repeat<'_>, span: Span, before: &[Stmt]) -> Flow {
        let trips = trips(known, repeat, before, self.assumed);
        let mut head = self.decision(span);
        if let Some(condition) = repeat.condition {
            let condition = self.expr(known, condition.expr);
            head = self.paths.then(condition, head);
        }
        let step = repeat.step.map_or_else(Paths::nothing, |step| self.expr(known, step));
        let body = known.inside(trips.counter, || self.list(known, repeat.body));
        // On the shortest path the first round leaves the loop.
        let leaves = [Exit::Break, Exit::Return, Exit::End].iter().any(|exit| body.at(*exit).is_some());
        let least = if leaves { trips.least.min(1) } else { trips.least };
        self.seen.loops.push((span, Trips { least, ..trips }));
        let end = self.paths.way_or(body.at(Exit::Next), body.at(Exit::Continue));
        let round = self.paths.then(Flow::leaving(Exit::Next, end), step);
        let round = self.paths.then(round, head).at(Exit::Next);
        let is_endless = match repeat.condition {
            None => true,
            Some(condition) => known.decided(condition.expr) == Some(true),
        };
        let done = match round {
            _ if is_endless => None,
            Some(round) => Some(Way {
                least: self.paths.path_times(trips.least, round.least),
                most: self.paths.path_times(trips.most, round.most),
            }),
            None => (trips.least == 0).then_some(Paths::way(Paths::NOTHING)),
        };
        let left = trips.most.saturating_sub(1);
        let rounds_before = round.map_or(Paths::NOTHING, |round| self.paths.path_times(left, round.most));
        let mut leaving = |exit: Exit| {
            let way = body.at(exit).filter(|_| trips.most > 0)?;
            Some(Way { least: way.least, most: self.paths.path_then(rounds_before, way.most) })
        };
        let (by_break, by_return, by_end) = (leaving(Exit::Break), leaving(Exit::Return), leaving(Exit::End));
        let next = self.paths.way_or(done, by_break);
        let whole = Flow::leaving(Exit::Next, next).with(Exit::Return, by_return).with(Exit::End, by_end);
        match repeat.kind {
            glisten_front::hir::LoopKind::DoWhile => whole,
            _ => self.paths.then(head, whole),
        }
    }

    fn expr(&mut self, known: &Known<'_>, id: ExprId) -> Flow {
        let rate = self.rates.at(id);
        if rate == Rate::Constant {
            return Paths::nothing();
        }
        let shader = self.shader;
        let expr = shader.expr(id);
        self.note_depth(id);
        let own = self.work(id, expr.span, rate);
        match &expr.kind {
            ExprKind::Ternary(condition, yes, no) => {
                let (yes, no) = (self.expr(known, *yes), self.expr(known, *no));
                let choice = match known.decided(*condition) {
                    Some(true) => yes,
                    Some(false) => no,
                    None => self.paths.or(yes, no),
                };
                let condition = self.expr(known, *condition);
                let flow = self.paths.then(condition, choice);
                self.paths.then(flow, own)
            }
            ExprKind::Logical(operator, first, second) => {
                let second = self.expr(known, *second);
                let second = match known.decided(*first) {
                    Some(is_true) if is_true == (*operator == LogicalOp::And) => second,
                    Some(_) => Paths::nothing(),
                    None => self.paths.or(Paths::nothing(), second),
                };
                let first = self.expr(known, *first);
                let flow = self.paths.then(first, second);
                self.paths.then(flow, own)
            }
            kind => {
                let mut flow = Paths::nothing();
                for child in kind.children() {
                    let child = self.expr(known, child);
                    flow = self.paths.then(flow, child);
                }
                let own = match kind {
                    ExprKind::Call(callee, _) => self.functions.get(callee).copied().unwrap_or_else(Paths::nothing),
                    _ => own,
                };
                self.paths.then(flow, own)
            }
        }
    }

    /// The operations of an expression itself.
    fn work(&mut self, id: ExprId, span: Span, rate: Rate) -> Flow {
        let counts = Counts::from(own_cost(self.types, self.shader, id));
        if counts.is_nothing() {
            return Paths::nothing();
        }
        let line = (self.line_of)(span);
        let path: Path = self.paths.work(line, counts, rate < Rate::Invocation);
        Flow::leaving(Exit::Next, Some(Paths::way(path)))
    }

    /// Notes a value that the fragment stage gives the depth.
    fn note_depth(&mut self, id: ExprId) {
        let shader = self.shader;
        let mut found = None;
        written_by(shader, id, &mut |target| {
            if let Some(VarRef::Global(global)) = shader.root_variable(target)
                && shader.global(global).builtin == Some(BuiltinVariable::FragDepth)
            {
                found = Some(shader.expr(target).span);
            }
        });
        self.seen.late.extend(found.map(|span| (span, "gl_FragDepth")));
    }
}
