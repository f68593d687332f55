//! [`Effects`]: which expressions change variables, and which variables a construct changes.

use glisten_front::hir::{
    Condition, ExprId, ExprKind, FunctionId, GlobalId, LocalId, Shader, Stmt, StmtKind, Storage, VarRef, written_by,
};
use std::collections::BTreeSet;

/// The variables that a construct assigns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Assigned {
    pub(super) globals: BTreeSet<GlobalId>,
    /// The locals of the function that contains the construct.
    pub(super) locals: BTreeSet<LocalId>,
}

/// Facts about a shader's expressions and functions.
pub(super) struct Effects {
    /// For each expression, whether it assigns or calls a function of the shader.
    exprs: Vec<bool>,
    /// For each function, the globals that it or its callees assign.
    functions: Vec<Option<BTreeSet<GlobalId>>>,
}

impl Effects {
    pub(super) fn of(shader: &Shader) -> Self {
        let mut exprs: Vec<bool> = Vec::with_capacity(shader.exprs.len());
        for expr in &shader.exprs {
            let mut has = match &expr.kind {
                ExprKind::Assign(..) | ExprKind::IncDec(..) | ExprKind::Call(..) => true,
                ExprKind::BuiltinCall(function, _) => function.written_argument().is_some(),
                _ => false,
            };
            // Children come before their parents.
            expr.kind.children().into_iter().for_each(|child| has |= exprs.get(child.index()).copied().unwrap_or(true));
            exprs.push(has);
        }
        let mut effects = Self { exprs, functions: vec![None; shader.functions.len()] };
        // Callees first: a chain of calls takes no stack.
        for id in shader.callees_first_of(shader.functions().map(|(id, _)| id)) {
            effects.function(shader, id);
        }
        effects
    }

    /// Whether evaluating the expression may change a variable.
    pub(super) fn has(&self, expr: ExprId) -> bool {
        self.exprs.get(expr.index()).copied().unwrap_or(true)
    }

    fn function(&mut self, shader: &Shader, id: FunctionId) -> BTreeSet<GlobalId> {
        if let Some(Some(known)) = self.functions.get(id.index()) {
            return known.clone();
        }
        if let Some(entry) = self.functions.get_mut(id.index()) {
            // Recursion, which the analysis excludes, would end here.
            *entry = Some(BTreeSet::new());
        }
        let mut assigned = Assigned::default();
        if let Some(body) = &shader.function(id).body {
            self.stmts(shader, body, &mut assigned);
        }
        if let Some(entry) = self.functions.get_mut(id.index()) {
            *entry = Some(assigned.globals.clone());
        }
        assigned.globals
    }

    /// Adds the variables that the statements assign.
    pub(super) fn stmts(&mut self, shader: &Shader, stmts: &[Stmt], assigned: &mut Assigned) {
        for stmt in stmts {
            match &stmt.kind {
                StmtKind::Expr(expr) => self.expr(shader, *expr, assigned),
                StmtKind::Local(local, init) => {
                    assigned.locals.insert(*local);
                    init.iter().for_each(|init| self.expr(shader, *init, assigned));
                }
                StmtKind::Block(body) => self.stmts(shader, body, assigned),
                StmtKind::If { arms, otherwise } => {
                    for (condition, body) in arms {
                        self.expr(shader, *condition, assigned);
                        self.stmts(shader, body, assigned);
                    }
                    self.stmts(shader, otherwise, assigned);
                }
                StmtKind::Switch { selector, cases } => {
                    self.expr(shader, *selector, assigned);
                    cases.iter().for_each(|case| self.stmts(shader, &case.body, assigned));
                }
                StmtKind::Loop { condition, step, body, .. } => {
                    self.condition(shader, condition.as_ref(), assigned);
                    step.iter().for_each(|step| self.expr(shader, *step, assigned));
                    self.stmts(shader, body, assigned);
                }
                StmtKind::Return(value) => value.iter().for_each(|value| self.expr(shader, *value, assigned)),
                StmtKind::Break | StmtKind::Continue | StmtKind::Discard => {}
            }
        }
    }

    fn condition(&mut self, shader: &Shader, condition: Option<&Condition>, assigned: &mut Assigned) {
        if let Some(condition) = condition {
            assigned.locals.extend(condition.local);
            self.expr(shader, condition.expr, assigned);
        }
    }

    /// Adds the variables that the expression assigns.
    pub(super) fn expr(&mut self, shader: &Shader, expr: ExprId, assigned: &mut Assigned) {
        let mut rest = vec![expr];
        while let Some(expr) = rest.pop() {
            if !self.has(expr) {
                continue;
            }
            let kind = &shader.expr(expr).kind;
            written_by(shader, expr, &mut |place| root(shader, place, assigned));
            if let ExprKind::Call(function, _) = kind {
                let globals = self.function(shader, *function);
                assigned.globals.extend(globals);
            }
            rest.extend(kind.children());
        }
    }
}

/// Adds the variable of an l-value.
fn root(shader: &Shader, place: ExprId, assigned: &mut Assigned) {
    match shader.root_variable(place) {
        Some(VarRef::Global(global)) => {
            if matches!(shader.global(global).storage, Storage::Out | Storage::Private) {
                assigned.globals.insert(global);
            }
        }
        Some(VarRef::Local(local)) => {
            assigned.locals.insert(local);
        }
        None => {}
    }
}
