//! Whether one execution of a vertex shader may read two attributes that share a location (OpenGL 3.2 §2.11.3).
//!
//! Each statement has the set of possible reads of an execution through it: neither attribute, the first, the second,
//! both. The sets of statements in sequence combine; those of branches unite. Every condition counts as unknown, so
//! the answer errs on the side of "yes". Functions are examined callees first; GLSL has no recursion.

use crate::hir::{ExprId, ExprKind, FunctionId, GlobalId, Shader, Stmt, StmtKind, VarRef};

/// A set of subsets of {first, second}: bit n represents the subset whose members are the bits of n.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Paths(u8);

impl Paths {
    /// An execution that reads neither.
    const NONE: Self = Self(1);

    fn reading(which: usize) -> Self {
        Self(1 << (1 << which))
    }

    fn then(self, next: Self) -> Self {
        let mut result = 0;
        for a in 0..4u8 {
            for b in 0..4u8 {
                if self.0 >> a & 1 == 1 && next.0 >> b & 1 == 1 {
                    result |= 1 << (a | b);
                }
            }
        }
        Self(result)
    }

    fn or(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }

    fn has_both(self) -> bool {
        self.0 >> 3 & 1 == 1
    }
}

struct Walk<'a> {
    shader: &'a Shader,
    pair: [GlobalId; 2],
    functions: Vec<Paths>,
}

/// Whether an execution of the shader may read both globals.
pub(super) fn path_reads_both(shader: &Shader, first: GlobalId, second: GlobalId) -> bool {
    let Some(main) = shader.main else { return false };
    let mut walk = Walk { shader, pair: [first, second], functions: vec![Paths::NONE; shader.functions.len()] };
    let mut paths = Paths::NONE;
    for id in shader.callees_first(main) {
        paths = shader.on_stack(|| walk.function(id));
    }
    paths.has_both()
}

impl Walk<'_> {
    fn function(&mut self, id: FunctionId) -> Paths {
        let shader = self.shader;
        let paths = shader.function(id).body.as_deref().map_or(Paths::NONE, |body| self.statements(body));
        if let Some(slot) = self.functions.get_mut(id.index()) {
            *slot = paths;
        }
        paths
    }

    fn statements(&mut self, statements: &[Stmt]) -> Paths {
        statements.iter().fold(Paths::NONE, |paths, statement| paths.then(self.statement(statement)))
    }

    fn statement(&mut self, statement: &Stmt) -> Paths {
        match &statement.kind {
            StmtKind::Expr(expr) => self.expr(*expr),
            StmtKind::Local(_, initializer) => initializer.map_or(Paths::NONE, |expr| self.expr(expr)),
            StmtKind::Block(body) => self.statements(body),
            StmtKind::If { arms, otherwise } => {
                let mut conditions = Paths::NONE;
                let mut result = Paths(0);
                for (condition, body) in arms {
                    conditions = conditions.then(self.expr(*condition));
                    let body = self.statements(body);
                    result = result.or(conditions.then(body));
                }
                let otherwise = self.statements(otherwise);
                result.or(conditions.then(otherwise))
            }
            StmtKind::Switch { selector, cases } => {
                let selector = self.expr(*selector);
                // Cases may fall through, so any sequence of consecutive cases is a path.
                let mut result = Paths::NONE;
                let mut running = Paths(0);
                for case in cases {
                    let body = self.statements(&case.body);
                    running = running.or(Paths::NONE).then(body);
                    result = result.or(running);
                    if case.body.last().is_some_and(|last| matches!(last.kind, StmtKind::Break | StmtKind::Return(_))) {
                        running = Paths(0);
                    }
                }
                selector.then(result)
            }
            StmtKind::Loop { condition, step, body, .. } => {
                let condition = condition.as_ref().map_or(Paths::NONE, |condition| self.expr(condition.expr));
                let step = step.map_or(Paths::NONE, |step| self.expr(step));
                let round = condition.then(self.statements(body)).then(step);
                condition.or(round).or(round.then(round))
            }
            StmtKind::Return(value) => value.map_or(Paths::NONE, |value| self.expr(value)),
            StmtKind::Break | StmtKind::Continue | StmtKind::Discard => Paths::NONE,
        }
    }

    fn expr(&mut self, id: ExprId) -> Paths {
        let shader = self.shader;
        match &shader.expr(id).kind {
            ExprKind::Error | ExprKind::Literal(_) | ExprKind::Var(VarRef::Local(_)) => Paths::NONE,
            ExprKind::Var(VarRef::Global(global)) => {
                self.pair.iter().position(|one| one == global).map_or(Paths::NONE, Paths::reading)
            }
            ExprKind::Member(a, _)
            | ExprKind::Swizzle(a, _)
            | ExprKind::Convert(a)
            | ExprKind::Unary(_, a)
            | ExprKind::IncDec(_, a) => self.expr(*a),
            ExprKind::Index(a, b) | ExprKind::Binary(_, a, b) | ExprKind::Assign(_, a, b) | ExprKind::Comma(a, b) => {
                let left = self.expr(*a);
                left.then(self.expr(*b))
            }
            ExprKind::Logical(_, a, b) => {
                let left = self.expr(*a);
                left.then(self.expr(*b).or(Paths::NONE))
            }
            ExprKind::Ternary(a, b, c) => {
                let condition = self.expr(*a);
                let chosen = self.expr(*b).or(self.expr(*c));
                condition.then(chosen)
            }
            ExprKind::Construct(_, arguments) | ExprKind::BuiltinCall(_, arguments) => self.list(arguments),
            ExprKind::Call(function, arguments) => {
                let arguments = self.list(arguments);
                arguments.then(self.functions.get(function.index()).copied().unwrap_or(Paths::NONE))
            }
        }
    }

    fn list(&mut self, list: &[ExprId]) -> Paths {
        list.iter().fold(Paths::NONE, |paths, &expr| paths.then(self.expr(expr)))
    }
}
