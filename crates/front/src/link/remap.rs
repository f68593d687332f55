//! Moves the handles of one shader after those of another.

use crate::hir::{Expr, ExprId, ExprKind, FunctionId, GlobalId, Shader, Stmt, StmtKind, Type, Types, VarRef};

/// The new handles of everything in a shader that is appended to another.
#[derive(Clone, Debug)]
pub struct Remap {
    /// The number of expressions before it.
    pub exprs: u32,
    /// The new handle of each global.
    pub globals: Vec<GlobalId>,
    /// The new handle of each function.
    pub functions: Vec<FunctionId>,
}

impl Remap {
    /// The new handle of an expression.
    pub fn expr_id(&self, id: ExprId) -> ExprId {
        ExprId(id.0 + self.exprs)
    }

    /// The new handle of a function.
    pub fn function_id(&self, id: FunctionId) -> FunctionId {
        self.functions.get(id.index()).copied().unwrap_or(id)
    }

    fn global_id(&self, id: GlobalId) -> GlobalId {
        self.globals.get(id.index()).copied().unwrap_or(id)
    }

    /// The expression with new handles.
    pub fn expr(&self, expr: Expr) -> Expr {
        Expr { kind: self.kind(expr.kind), ..expr }
    }

    fn kind(&self, mut kind: ExprKind) -> ExprKind {
        match &mut kind {
            ExprKind::Var(VarRef::Global(global)) => *global = self.global_id(*global),
            ExprKind::Call(function, _) => *function = self.function_id(*function),
            _ => {}
        }
        kind.for_each_operand(&mut |id| *id = self.expr_id(*id));
        kind
    }

    /// Gives the statements of a body new handles. It recurses into blocks, which nest at most as deep as the parser
    /// allows.
    pub fn body(&self, body: &mut [Stmt]) {
        for statement in body {
            match &mut statement.kind {
                StmtKind::Expr(expr) => *expr = self.expr_id(*expr),
                StmtKind::Local(_, expr) | StmtKind::Return(expr) => *expr = expr.map(|expr| self.expr_id(expr)),
                StmtKind::Block(body) => self.body(body),
                StmtKind::If { arms, otherwise } => {
                    for (condition, body) in arms {
                        *condition = self.expr_id(*condition);
                        self.body(body);
                    }
                    self.body(otherwise);
                }
                StmtKind::Switch { selector, cases } => {
                    *selector = self.expr_id(*selector);
                    cases.iter_mut().for_each(|case| self.body(&mut case.body));
                }
                StmtKind::Loop { condition, step, body, .. } => {
                    if let Some(condition) = condition {
                        condition.expr = self.expr_id(condition.expr);
                    }
                    *step = step.map(|step| self.expr_id(step));
                    self.body(body);
                }
                StmtKind::Break | StmtKind::Continue | StmtKind::Discard => {}
            }
        }
    }
}

/// Updates the type of each expression that refers to a global or a part of one, since its size may have changed.
/// Children come before their parents.
pub(super) fn retype_globals(types: &Types, shader: &mut Shader) {
    for index in 0..shader.exprs.len() {
        let Some(expr) = shader.exprs.get(index) else { continue };
        let ty = match expr.kind {
            ExprKind::Var(VarRef::Global(id)) => shader.globals.get(id.index()).map(|global| global.ty),
            ExprKind::Index(base, _) => match types.get(shader.expr(base).ty) {
                Type::Array(element, _) => Some(element),
                _ => None,
            },
            ExprKind::Member(base, member) => match types.get(shader.expr(base).ty) {
                Type::Struct(id) => types.structure(id).members.get(member as usize).map(|member| member.ty),
                _ => None,
            },
            _ => None,
        };
        if let (Some(ty), Some(expr)) = (ty, shader.exprs.get_mut(index)) {
            expr.ty = ty;
        }
    }
}
