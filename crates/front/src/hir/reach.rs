//! Static use (§3.8): which functions `main` can reach, and which globals those read and write.
//!
//! *In:* a shader with complete bodies. *Out:* its flags `reachable`, `used` and `written`.

use super::{ExprId, ExprKind, FunctionId, GlobalId, ScalarValue, Shader, Stmt, StmtKind, VarRef, written_by};
use crate::builtin::BuiltinVariable;
use rustc_hash::FxHashSet;

/// The globals and functions that a function or an initializer mentions.
#[derive(Default)]
struct Mentions {
    globals: Vec<GlobalId>,
    written: Vec<GlobalId>,
    calls: Vec<FunctionId>,
}

impl Shader {
    /// Whether it reads the second component of `gl_FragCoord` (§7.2), which depends on the window's origin.
    pub fn reads_row_of_frag_coord(&self) -> bool {
        let is_coordinate = |id: ExprId| match self.expr(id).kind {
            ExprKind::Var(VarRef::Global(global)) => self.global(global).builtin == Some(BuiltinVariable::FragCoord),
            _ => false,
        };
        // Of a coordinate's components, those that an expression reads.
        let leaves_row = |kind: &ExprKind| match kind {
            ExprKind::Swizzle(_, swizzle) => !swizzle.as_slice().contains(&1),
            ExprKind::Index(_, index) => matches!(
                self.expr(*index).kind,
                ExprKind::Literal(ScalarValue::Int(0 | 2 | 3) | ScalarValue::Uint(0 | 2 | 3))
            ),
            _ => false,
        };
        // What a later step has dropped may still have a coordinate as its operand, next to what took its place.
        let coordinates = (0..self.exprs.len()).map(|index| ExprId(index as u32)).filter(|id| is_coordinate(*id));
        let mut whole: Vec<ExprId> = coordinates.collect();
        if whole.is_empty() {
            return false;
        }
        for expr in &self.exprs {
            match expr.kind {
                ExprKind::Swizzle(base, _) | ExprKind::Index(base, _) if leaves_row(&expr.kind) => {
                    whole.retain(|id| *id != base);
                }
                _ if expr.kind.children().into_iter().any(is_coordinate) => return true,
                _ => {}
            }
        }
        !whole.is_empty()
    }

    /// Sets [`Function::reachable`](super::Function::reachable), [`Global::used`](super::Global::used) and
    /// [`Global::written`](super::Global::written) from the bodies. Call it again after changing bodies.
    pub fn mark_static_use(&mut self) {
        self.functions.iter_mut().for_each(|function| function.reachable = false);
        for global in &mut self.globals {
            (global.used, global.written) = (false, false);
        }
        let mut functions: Vec<FunctionId> = self.main.into_iter().collect();
        let mut globals: Vec<GlobalId> = Vec::new();
        loop {
            let mentions = if let Some(id) = functions.pop() {
                match self.functions.get_mut(id.index()) {
                    Some(function) if !function.reachable => function.reachable = true,
                    _ => continue,
                }
                self.mentions_of_function(id)
            } else if let Some(id) = globals.pop() {
                let Some(initializer) = self.global(id).initializer else { continue };
                let mut mentions = Mentions::default();
                self.mentions_of_expr(initializer, &mut mentions);
                mentions
            } else {
                return;
            };
            self.apply(mentions, &mut functions, &mut globals);
        }
    }

    /// The globals that the body of any function writes, whether or not `main` calls it: those are statically assigned (§3.8).
    pub fn statically_written(&self) -> FxHashSet<GlobalId> {
        let written = |id: usize| self.mentions_of_function(FunctionId::new(id)).written;
        (0..self.functions.len()).flat_map(written).collect()
    }

    /// The expressions that `main` can reach, and the initializers of the globals that it uses. Call it after
    /// [`mark_static_use`](Self::mark_static_use).
    pub fn used_expressions(&self) -> Vec<ExprId> {
        let bodies =
            self.functions.iter().filter(|function| function.reachable).filter_map(|function| function.body.as_deref());
        let globals = self.globals.iter().filter(|global| global.used).filter_map(|global| global.initializer);
        let mut pending: Vec<ExprId> = bodies.flat_map(|body| self.roots(body)).chain(globals).collect();
        let mut used = Vec::new();
        while let Some(id) = pending.pop() {
            used.push(id);
            pending.extend(self.expr(id).kind.children());
        }
        used.sort_unstable();
        used.dedup();
        used
    }

    fn apply(&mut self, mentions: Mentions, functions: &mut Vec<FunctionId>, globals: &mut Vec<GlobalId>) {
        functions.extend(mentions.calls);
        for id in mentions.written {
            if let Some(global) = self.globals.get_mut(id.index()) {
                global.written = true;
            }
        }
        for id in mentions.globals {
            match self.globals.get_mut(id.index()) {
                Some(global) if !global.used => global.used = true,
                _ => continue,
            }
            globals.push(id);
        }
    }

    fn mentions_of_function(&self, id: FunctionId) -> Mentions {
        let mut mentions = Mentions::default();
        for root in self.roots(self.function(id).body.as_deref().unwrap_or(&[])) {
            self.mentions_of_expr(root, &mut mentions);
        }
        mentions
    }

    fn mentions_of_expr(&self, root: ExprId, mentions: &mut Mentions) {
        let mut pending = vec![root];
        while let Some(id) = pending.pop() {
            let kind = &self.expr(id).kind;
            match kind {
                ExprKind::Var(VarRef::Global(global)) => mentions.globals.push(*global),
                ExprKind::Call(function, _) => mentions.calls.push(*function),
                _ => {}
            }
            written_by(self, id, &mut |target| self.mention_write(target, mentions));
            pending.extend(kind.children());
        }
    }

    fn mention_write(&self, target: ExprId, mentions: &mut Mentions) {
        if let Some(VarRef::Global(global)) = self.root_variable(target) {
            mentions.written.push(global);
        }
    }

    /// The expressions directly in statements, in source order.
    pub fn roots(&self, body: &[Stmt]) -> Vec<ExprId> {
        let mut roots = Vec::new();
        collect_roots(body, &mut roots);
        roots
    }
}

/// Recurses into blocks, which nest at most as deep as the parser allows.
fn collect_roots(body: &[Stmt], roots: &mut Vec<ExprId>) {
    for stmt in body {
        match &stmt.kind {
            StmtKind::Expr(expr) => roots.push(*expr),
            StmtKind::Local(_, initializer) | StmtKind::Return(initializer) => roots.extend(*initializer),
            StmtKind::Block(body) => collect_roots(body, roots),
            StmtKind::If { arms, otherwise } => {
                for (condition, body) in arms {
                    roots.push(*condition);
                    collect_roots(body, roots);
                }
                collect_roots(otherwise, roots);
            }
            StmtKind::Switch { selector, cases } => {
                roots.push(*selector);
                cases.iter().for_each(|case| collect_roots(&case.body, roots));
            }
            StmtKind::Loop { condition, step, body, .. } => {
                roots.extend(condition.as_ref().map(|condition| condition.expr));
                roots.extend(*step);
                collect_roots(body, roots);
            }
            StmtKind::Break | StmtKind::Continue | StmtKind::Discard => {}
        }
    }
}
