//! How often the values of expressions change: never, from draw to draw, or within one.
//!
//! *In:* a shader. *Out:* a [`Rate`] for each of its expressions. *Holds:* what is not certain changes; a variable that is assigned
//! again changes from draw to draw at least, as a counter does, and as often as the conditions around its assignments. Functions are
//! looked at once for all of their calls.

use glisten_front::builtin::operations::Class;
use glisten_front::hir::written_by;
use glisten_front::hir::{ExprId, ExprKind, FunctionId, Shader, Stmt, StmtKind, Storage, Type, Types, VarRef};

/// How often a value changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Rate {
    /// Never: compilers fold it.
    #[default]
    Constant,
    /// From draw to draw.
    Draw,
    /// From vertex to vertex or from fragment to fragment.
    Invocation,
}

/// The rates of a shader.
pub(super) struct Rates {
    exprs: Vec<Rate>,
    locals: Vec<Vec<Rate>>,
    globals: Vec<Rate>,
    returns: Vec<Rate>,
    changed: bool,
}

impl Rates {
    /// The rates of the functions `order`, callees first.
    pub(super) fn of(types: &Types, shader: &Shader, order: &[FunctionId]) -> Self {
        let global = |storage| match storage {
            Storage::Const => Rate::Constant,
            Storage::Uniform => Rate::Draw,
            Storage::In => Rate::Invocation,
            _ => Rate::Constant,
        };
        let returns = |function: &glisten_front::hir::Function| {
            // A call for its effects is never folded.
            if matches!(types.get(function.ret), Type::Void) { Rate::Draw } else { Rate::Constant }
        };
        let mut rates = Self {
            exprs: vec![Rate::Constant; shader.exprs.len()],
            locals: shader.functions.iter().map(|function| vec![Rate::Constant; function.locals.len()]).collect(),
            globals: shader.globals.iter().map(|one| global(one.storage)).collect(),
            returns: shader.functions.iter().map(returns).collect(),
            changed: true,
        };
        for (index, one) in shader.globals.iter().enumerate() {
            // Private variables keep what an earlier function gave them.
            if one.written && one.storage != Storage::In {
                rates.raise_global(index, Rate::Draw);
            }
        }
        // Results flow to callers, and arguments to callees: both ways in each round.
        while std::mem::take(&mut rates.changed) {
            for &function in order.iter().chain(order.iter().rev()) {
                let body = shader.function(function).body.as_deref().unwrap_or(&[]);
                Pass { shader, function, rates: &mut rates }.list(body, Rate::Constant);
            }
        }
        rates
    }

    pub(super) fn at(&self, expr: ExprId) -> Rate {
        self.exprs.get(expr.index()).copied().unwrap_or(Rate::Invocation)
    }

    fn raise(slot: Option<&mut Rate>, rate: Rate, changed: &mut bool) {
        if let Some(slot) = slot.filter(|slot| **slot < rate) {
            (*slot, *changed) = (rate, true);
        }
    }

    fn raise_global(&mut self, index: usize, rate: Rate) {
        Self::raise(self.globals.get_mut(index), rate, &mut self.changed);
    }

    fn raise_local(&mut self, function: FunctionId, index: usize, rate: Rate) {
        let slot = self.locals.get_mut(function.index()).and_then(|locals| locals.get_mut(index));
        Self::raise(slot, rate, &mut self.changed);
    }

    fn local(&self, function: FunctionId, index: usize) -> Rate {
        let locals = self.locals.get(function.index());
        locals.and_then(|locals| locals.get(index)).copied().unwrap_or(Rate::Invocation)
    }
}

/// One look at a function.
struct Pass<'a> {
    shader: &'a Shader,
    function: FunctionId,
    rates: &'a mut Rates,
}

impl Pass<'_> {
    fn list(&mut self, statements: &[Stmt], control: Rate) {
        for statement in statements {
            self.statement(statement, control);
        }
    }

    fn statement(&mut self, statement: &Stmt, control: Rate) {
        match &statement.kind {
            StmtKind::Local(local, value) => {
                let rate = value.map_or(Rate::Constant, |value| self.expr(value, control));
                self.rates.raise_local(self.function, local.index(), rate.max(control));
            }
            StmtKind::Return(value) => {
                let rate = value.map_or(Rate::Constant, |value| self.expr(value, control)).max(control);
                let slot = self.rates.returns.get_mut(self.function.index());
                Rates::raise(slot, rate, &mut self.rates.changed);
            }
            StmtKind::If { arms, otherwise } => {
                let mut control = control;
                for (condition, body) in arms {
                    control = control.max(self.expr(*condition, control));
                    self.list(body, control);
                }
                self.list(otherwise, control);
            }
            StmtKind::Switch { selector, cases } => {
                let control = control.max(self.expr(*selector, control));
                for case in cases {
                    self.list(&case.body, control);
                }
            }
            StmtKind::Loop { condition, step, body, .. } => {
                let mut control = control;
                if let Some(condition) = condition {
                    let rate = self.expr(condition.expr, control);
                    if let Some(local) = condition.local {
                        self.rates.raise_local(self.function, local.index(), rate.max(Rate::Draw));
                    }
                    control = control.max(rate);
                }
                control = control.max(self.leaving(body));
                self.list(body, control);
                step.iter().for_each(|step| {
                    self.expr(*step, control);
                });
            }
            StmtKind::Block(body) => self.list(body, control),
            kind => kind.exprs().into_iter().for_each(|expr| {
                self.expr(expr, control);
            }),
        }
    }

    /// The rate of the conditions in a loop's body that leaves it somewhere: they decide how often the rest runs.
    fn leaving(&self, body: &[Stmt]) -> Rate {
        let (mut rate, mut leaves) = (Rate::Constant, false);
        self.shader.visit_statements(body, &mut |statement| match &statement.kind {
            StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::Discard => leaves = true,
            StmtKind::If { arms, .. } => {
                rate = arms.iter().fold(rate, |rate, (condition, _)| rate.max(self.rates.at(*condition)));
            }
            StmtKind::Switch { selector, .. } => rate = rate.max(self.rates.at(*selector)),
            _ => {}
        });
        if leaves { rate } else { Rate::Constant }
    }

    /// The rate of an expression; enters those of its operands, and of what it writes.
    fn expr(&mut self, root: ExprId, control: Rate) -> Rate {
        // Operands have smaller numbers.
        let mut order = Vec::new();
        self.shader.visit_expr(root, &mut |expr| order.push(expr));
        order.sort_unstable();
        order.dedup();
        for id in order {
            let rate = self.own(id, control);
            Rates::raise(self.rates.exprs.get_mut(id.index()), rate, &mut self.rates.changed);
        }
        self.rates.at(root)
    }

    fn own(&mut self, id: ExprId, control: Rate) -> Rate {
        let shader = self.shader;
        let kind = &shader.expr(id).kind;
        let operands = |rates: &Rates| kind.children().iter().map(|child| rates.at(*child)).max().unwrap_or_default();
        let rate = match kind {
            ExprKind::Literal(_) => Rate::Constant,
            ExprKind::Error => Rate::Invocation,
            ExprKind::Var(VarRef::Local(local)) => self.rates.local(self.function, local.index()),
            ExprKind::Var(VarRef::Global(global)) => {
                self.rates.globals.get(global.index()).copied().unwrap_or(Rate::Invocation)
            }
            ExprKind::Assign(None, _, value) => self.rates.at(*value).max(Rate::Draw),
            ExprKind::Assign(..) | ExprKind::IncDec(..) => operands(self.rates).max(Rate::Draw),
            ExprKind::Call(callee, arguments) => {
                for (index, argument) in arguments.iter().enumerate() {
                    let rate = self.rates.at(*argument).max(control);
                    self.rates.raise_local(*callee, index, rate);
                }
                self.rates.returns.get(callee.index()).copied().unwrap_or(Rate::Invocation)
            }
            ExprKind::BuiltinCall(function, _) => match function.class() {
                Class::Texture(_) => operands(self.rates).max(Rate::Draw),
                Class::Derivative(_) | Class::Emission(_) => Rate::Invocation,
                _ => operands(self.rates),
            },
            _ => operands(self.rates),
        };
        let mut written = Vec::new();
        written_by(shader, id, &mut |target| written.push(target));
        for target in written {
            let value = match kind {
                ExprKind::Call(callee, arguments) => {
                    let index = arguments.iter().position(|argument| *argument == target);
                    index.map_or(Rate::Invocation, |index| self.rates.local(*callee, index))
                }
                _ => rate,
            };
            // Which element is written may change, too.
            let value = value.max(control).max(self.rates.at(target)).max(Rate::Draw);
            match shader.root_variable(target) {
                Some(VarRef::Local(local)) => self.rates.raise_local(self.function, local.index(), value),
                Some(VarRef::Global(global)) => self.rates.raise_global(global.index(), value),
                None => {}
            }
        }
        rate
    }
}
