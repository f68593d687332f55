//! [`differing`]: the globals of a stage whose values may differ between its invocations.
//!
//! *In:* a shader, and which of its inputs differ. *Out:* [`Differing`]: a flag for each global. *Holds:* a variable counts as a whole and
//! regardless of the order of its assignments, but the fourth component of an output counts by itself. A condition that differs makes
//! what it guards differ; if it guards a jump, all of the function.

use glisten_front::hir::written_by;
use glisten_front::hir::{
    Condition, ConstructKind, ExprId, ExprKind, FunctionId, ParamMode, Shader, Stmt, StmtKind, Storage, Types, VarRef,
};

/// The globals whose values may differ.
pub(super) struct Differing {
    pub(super) globals: Vec<bool>,
    /// Of outputs, whether the fourth component may differ.
    pub(super) alphas: Vec<bool>,
}

struct Walk<'a> {
    types: &'a Types,
    shader: &'a Shader,
    found: Differing,
    locals: Vec<Vec<bool>>,
    returns: Vec<bool>,
    /// Functions that only some invocations run to their end or at all.
    partly: Vec<bool>,
    function: FunctionId,
    changed: bool,
}

/// The globals of a shader whose values may differ, if those with a flag do.
pub(super) fn differing(types: &Types, shader: &Shader, starts: Vec<bool>) -> Differing {
    walked(types, shader, starts).found
}

/// Whether an expression of a function may differ, if the globals with a flag do.
pub(super) fn expression_differs(
    types: &Types,
    shader: &Shader,
    starts: Vec<bool>,
    (function, expr): (FunctionId, ExprId),
) -> bool {
    let walk = walked(types, shader, starts);
    Walk { function, ..walk }.differs(expr)
}

fn walked<'a>(types: &'a Types, shader: &'a Shader, globals: Vec<bool>) -> Walk<'a> {
    let alphas = vec![false; globals.len()];
    let main = shader.main.unwrap_or(FunctionId::new(0));
    let mut walk = Walk {
        types,
        shader,
        found: Differing { globals, alphas },
        locals: shader.functions.iter().map(|function| vec![false; function.locals.len()]).collect(),
        returns: vec![false; shader.functions.len()],
        partly: vec![false; shader.functions.len()],
        function: main,
        changed: true,
    };
    let order = shader.main.map(|main| shader.callees_first(main)).unwrap_or_default();
    // Each round sets at least one flag, so this ends.
    while std::mem::take(&mut walk.changed) {
        walk.initializers();
        for &id in &order {
            walk.function = id;
            let partly = walk.partly.get(id.index()) == Some(&true);
            if let Some(body) = &shader.function(id).body {
                walk.body(body, partly);
            }
        }
    }
    walk
}

impl Walk<'_> {
    /// Variables at global scope that begin with a value that differs.
    fn initializers(&mut self) {
        let shader = self.shader;
        for (id, global) in shader.globals() {
            if global.storage == Storage::Private && global.initializer.is_some_and(|value| self.differs(value)) {
                self.mark(VarRef::Global(id));
            }
        }
    }

    fn body(&mut self, body: &[Stmt], partly: bool) {
        body.iter().for_each(|statement| self.statement(statement, partly));
    }

    fn statement(&mut self, statement: &Stmt, partly: bool) {
        let kind = &statement.kind;
        kind.exprs().into_iter().for_each(|expr| self.expr(expr, partly));
        match kind {
            StmtKind::Local(id, Some(value)) if partly || self.differs(*value) => self.mark(VarRef::Local(*id)),
            StmtKind::If { arms, otherwise } => {
                let inner = partly || arms.iter().any(|(condition, _)| self.differs(*condition));
                arms.iter().for_each(|(_, body)| self.guarded(body, (partly, inner)));
                self.guarded(otherwise, (partly, inner));
            }
            StmtKind::Switch { selector, cases } => {
                let inner = partly || self.differs(*selector);
                cases.iter().for_each(|case| self.guarded(&case.body, (partly, inner)));
            }
            StmtKind::Loop { condition, body, .. } => {
                let condition = condition.as_ref();
                let inner = partly || condition.is_some_and(|Condition { expr, .. }| self.differs(*expr));
                if let Some(id) = condition.and_then(|condition| condition.local).filter(|_| inner) {
                    self.mark(VarRef::Local(id));
                }
                self.guarded(body, (partly, inner));
                if inner {
                    // What the step assigns, too, differs by the number of rounds.
                    kind.exprs().into_iter().for_each(|expr| self.expr(expr, true));
                }
            }
            StmtKind::Block(body) => self.body(body, partly),
            StmtKind::Return(Some(value)) if partly || self.differs(*value) => {
                set(&mut self.returns, self.function.index(), &mut self.changed);
            }
            _ => {}
        }
    }

    /// A body under a condition. If the condition differs and guards a jump, what follows is guarded, too: all of the function.
    fn guarded(&mut self, body: &[Stmt], (partly, inner): (bool, bool)) {
        self.body(body, inner);
        if inner && !partly {
            let mut jumps = false;
            self.shader.visit_statements(body, &mut |statement| {
                jumps |= matches!(statement.kind, StmtKind::Return(_) | StmtKind::Break | StmtKind::Continue);
            });
            if jumps {
                set(&mut self.partly, self.function.index(), &mut self.changed);
            }
        }
    }

    /// Whether a value may differ.
    fn differs(&self, root: ExprId) -> bool {
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            let kind = &self.shader.expr(id).kind;
            let own = match kind {
                ExprKind::Var(variable) => self.is_marked(*variable),
                ExprKind::Call(function, _) => self.returns.get(function.index()) == Some(&true),
                _ => false,
            };
            if own {
                return true;
            }
            pending.extend(kind.children());
        }
        false
    }

    fn is_marked(&self, variable: VarRef) -> bool {
        match variable {
            VarRef::Global(id) => {
                let of = |flags: &[bool]| flags.get(id.index()) == Some(&true);
                of(&self.found.globals) || of(&self.found.alphas)
            }
            VarRef::Local(id) => {
                self.locals.get(self.function.index()).and_then(|locals| locals.get(id.index())) == Some(&true)
            }
        }
    }

    fn mark(&mut self, variable: VarRef) {
        match variable {
            VarRef::Global(id) => set(&mut self.found.globals, id.index(), &mut self.changed),
            VarRef::Local(id) => {
                if let Some(locals) = self.locals.get_mut(self.function.index()) {
                    set(locals, id.index(), &mut self.changed);
                }
            }
        }
    }

    /// The effects of an expression and of everything in it.
    fn expr(&mut self, root: ExprId, partly: bool) {
        let shader = self.shader;
        let mut pending = vec![(root, partly)];
        while let Some((id, partly)) = pending.pop() {
            let kind = &shader.expr(id).kind;
            match kind {
                ExprKind::Assign(operator, target, value) => {
                    self.assign((*target, *value), operator.is_some(), partly);
                }
                ExprKind::Call(function, arguments) => self.call(*function, arguments, partly),
                _ => {
                    let differs = partly || matches!(kind, ExprKind::BuiltinCall(..)) && self.differs(id);
                    written_by(shader, id, &mut |target| {
                        if let Some(variable) = shader.root_variable(target).filter(|_| differs) {
                            self.mark(variable);
                        }
                    });
                }
            }
            let condition = match kind {
                ExprKind::Logical(_, condition, _) | ExprKind::Ternary(condition, ..) => Some(*condition),
                _ => None,
            };
            let inner = partly || condition.is_some_and(|condition| self.differs(condition));
            pending.extend(kind.children().into_iter().map(|child| (child, inner)));
        }
    }

    /// An assignment. Of an output, the fourth component counts by itself.
    fn assign(&mut self, (target, value): (ExprId, ExprId), combines: bool, partly: bool) {
        let shader = self.shader;
        let Some(variable) = shader.root_variable(target) else { return };
        let output = match variable {
            VarRef::Global(id) if shader.global(id).storage == Storage::Out => Some(id),
            _ => None,
        };
        let of_index = |id: ExprId| match &shader.expr(id).kind {
            ExprKind::Index(_, index) => self.differs(*index),
            _ => false,
        };
        let differs = partly || self.differs(value) || of_index(target);
        let (Some(output), true) = (output, differs) else {
            if differs {
                self.mark(variable);
            }
            return;
        };
        let only_alpha = match &shader.expr(target).kind {
            ExprKind::Swizzle(_, swizzle) => swizzle.as_slice() == [3],
            _ => !partly && !combines && self.differs_in_alpha_alone(value),
        };
        match only_alpha {
            true => set(&mut self.found.alphas, output.index(), &mut self.changed),
            false => self.mark(variable),
        }
    }

    /// Whether a vector is made of parts, of which only the fourth component may differ.
    fn differs_in_alpha_alone(&self, value: ExprId) -> bool {
        let ExprKind::Construct(ConstructKind::Compose, parts) = &self.shader.expr(value).kind else { return false };
        let mut place = 0;
        parts.iter().all(|&part| {
            let is_alpha = place >= 3;
            place += self.types.flat_len(self.shader.expr(part).ty);
            is_alpha || !self.differs(part)
        })
    }

    fn call(&mut self, function: FunctionId, arguments: &[ExprId], partly: bool) {
        let shader = self.shader;
        if partly {
            set(&mut self.partly, function.index(), &mut self.changed);
        }
        for (index, &argument) in arguments.iter().enumerate() {
            let mode = shader.function(function).param_mode(index);
            if mode != ParamMode::Out
                && self.differs(argument)
                && let Some(locals) = self.locals.get_mut(function.index())
            {
                set(locals, index, &mut self.changed);
            }
            let inside = self.locals.get(function.index()).and_then(|locals| locals.get(index)) == Some(&true);
            if matches!(mode, ParamMode::Out | ParamMode::Inout)
                && (inside || partly)
                && let Some(variable) = shader.root_variable(argument)
            {
                self.mark(variable);
            }
        }
    }
}

fn set(flags: &mut [bool], index: usize, changed: &mut bool) {
    if let Some(flag) = flags.get_mut(index).filter(|flag| !**flag) {
        *flag = true;
        *changed = true;
    }
}
