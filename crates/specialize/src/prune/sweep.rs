//! Sweeps a stage: stores that nobody reads, statements without effect and empty constructs go.
//!
//! *In:* a stage and the outputs that somebody reads. *Out:* the same stage, shorter; whether anything went.
//! *Holds:* bodies are walked from their ends, so that what only a removed statement read goes in the same sweep.

use super::once;
use super::uses::{Parts, Stored, Uses, stored};
use glisten_front::hir::{
    ConstructKind, Expr, ExprId, ExprKind, FunctionId, GlobalId, LocalId, ParamMode, Shader, Stmt, StmtKind, Storage,
    Type, TypeId, Types, UnaryOp, VarRef, may_act, same_value,
};
use rustc_hash::FxHashSet;

/// Sweeps a stage once. `live` says for each global whether somebody reads it when the stage has ended, `uses` counts what is in it.
pub(super) fn sweep(types: &Types, shader: &mut Shader, live: &[bool], uses: Uses) -> Swept {
    let functions = uses.functions.clone();
    let mut sweeper = Sweeper { types, shader, live, uses, changed: false };
    let mut unwanted = Vec::new();
    for id in functions {
        sweeper.uses.function = id;
        let body = sweeper.shader.functions.get_mut(id.index()).and_then(|function| function.body.take());
        if let Some(body) = body {
            let gives_to_nobody = sweeper.gives_to_nobody();
            let mut body = sweeper.body(body);
            if gives_to_nobody {
                unwanted.push(id);
            }
            if matches!(body.last(), Some(Stmt { kind: StmtKind::Return(None), .. })) {
                body.pop();
                sweeper.changed = true;
            }
            if let Some(function) = sweeper.shader.functions.get_mut(id.index()) {
                function.body = Some(body);
            }
        }
    }
    let swept = Swept { changed: sweeper.changed, uses: sweeper.uses };
    give_nothing(shader, &unwanted);
    swept
}

/// Functions whose results nobody wants no longer give any.
fn give_nothing(shader: &mut Shader, functions: &[FunctionId]) {
    let mut unwanted: FxHashSet<FunctionId> = FxHashSet::default();
    for id in functions {
        if let Some(function) = shader.functions.get_mut(id.index()).filter(|function| function.ret != TypeId::VOID) {
            function.ret = TypeId::VOID;
            unwanted.insert(*id);
        }
    }
    if unwanted.is_empty() {
        return;
    }
    for expr in &mut shader.exprs {
        if matches!(expr.kind, ExprKind::Call(callee, _) if unwanted.contains(&callee)) {
            expr.ty = TypeId::VOID;
        }
    }
}

/// Whether it is a number, or made of numbers.
fn is_constant(shader: &Shader, root: ExprId) -> bool {
    let mut constant = true;
    shader.visit_expr(root, &mut |expr| {
        constant &= matches!(shader.expr(expr).kind, ExprKind::Literal(_) | ExprKind::Construct(..));
    });
    constant
}

/// What a sweep did.
pub(super) struct Swept {
    /// Whether anything went.
    pub(super) changed: bool,
    /// The counts of what is left. Functions that nothing calls any more are still among those that are reached.
    pub(super) uses: Uses,
}

struct Sweeper<'a> {
    types: &'a Types,
    shader: &'a mut Shader,
    live: &'a [bool],
    uses: Uses,
    changed: bool,
}

impl Sweeper<'_> {
    fn body(&mut self, body: Vec<Stmt>) -> Vec<Stmt> {
        let mut out: Vec<Stmt> = Vec::with_capacity(body.len());
        for stmt in body.into_iter().rev() {
            self.statement(stmt, &mut out);
        }
        out.reverse();
        out
    }

    /// Appends what is left of a statement to `out`, which runs backwards.
    fn statement(&mut self, stmt: Stmt, out: &mut Vec<Stmt>) {
        let Stmt { kind, span } = stmt;
        match kind {
            StmtKind::Expr(expr) => self.effect(expr, span, out),
            StmtKind::Local(local, initializer) => {
                let count = self.uses.get(VarRef::Local(local));
                let initializer = match initializer {
                    Some(expr) if count.reads <= 0 && self.is_pure(expr) => {
                        let within = Some(Stored::whole(VarRef::Local(local)));
                        self.uses.stored_value(self.types, self.shader, expr, -1, within);
                        None
                    }
                    initializer => initializer.map(|expr| self.partly(VarRef::Local(local), expr)),
                };
                let count = self.uses.get(VarRef::Local(local));
                match initializer {
                    None if count.named <= 0 => self.changed = true,
                    Some(expr) if count.named <= 0 => {
                        // Its value is nobody's, and it does something.
                        self.changed = true;
                        self.effect(expr, span, out);
                    }
                    initializer => out.push(Stmt { kind: StmtKind::Local(local, initializer), span }),
                }
            }
            StmtKind::Block(body) => {
                let body = self.body(body);
                let body = self.without_unnamed(body);
                if body.iter().any(|stmt| matches!(stmt.kind, StmtKind::Local(..))) {
                    out.push(Stmt { kind: StmtKind::Block(body), span });
                } else {
                    self.changed = true;
                    out.extend(body.into_iter().rev());
                }
            }
            StmtKind::If { arms, otherwise } => self.selection(arms, otherwise, span, out),
            StmtKind::Switch { selector, cases } => {
                let mut cases = cases;
                for case in cases.iter_mut().rev() {
                    let body = std::mem::take(&mut case.body);
                    case.body = self.body(body);
                }
                let idle =
                    |case: &glisten_front::hir::Case| case.body.iter().all(|stmt| matches!(stmt.kind, StmtKind::Break));
                if cases.iter().all(idle) && self.is_pure(selector) {
                    self.forget(selector, None);
                    self.changed = true;
                } else {
                    out.push(Stmt { kind: StmtKind::Switch { selector, cases }, span });
                }
            }
            StmtKind::Loop { kind, condition, step, body } => {
                let mut body = self.body(body);
                if once::runs_once(self.shader, kind, condition.as_ref()) {
                    match once::without_jumps(self.shader, body) {
                        Ok(apart) => {
                            self.changed = true;
                            // As a block it may be taken apart in the next sweep.
                            out.push(Stmt { kind: StmtKind::Block(apart), span });
                            return;
                        }
                        Err(whole) => body = whole,
                    }
                }
                let whole = StmtKind::Loop { kind, condition, step, body };
                if self.is_idle(&whole) {
                    self.uses.body(self.types, self.shader, &[Stmt { kind: whole, span }], -1);
                    self.changed = true;
                } else {
                    out.push(Stmt { kind: whole, span });
                }
            }
            StmtKind::Return(Some(value)) if self.gives_to_nobody() => {
                self.changed = true;
                out.push(Stmt { kind: StmtKind::Return(None), span });
                // Its value was wanted by the result alone.
                self.effect(value, span, out);
            }
            kind => out.push(Stmt { kind, span }),
        }
    }

    /// Whether all calls of the present function throw its result away.
    fn gives_to_nobody(&self) -> bool {
        let own = self.uses.function;
        let count = |counts: &[i32]| counts.get(own.index()).copied().unwrap_or(1);
        Some(own) != self.shader.main && count(&self.uses.wanted) <= 0 && count(&self.uses.calls) > 0
    }

    /// A value of which nothing is computed that is stored to parts of a variable that nobody reads.
    fn partly(&mut self, variable: VarRef, value: ExprId) -> ExprId {
        let Expr { kind, ty, span } = self.shader.expr(value).clone();
        let ExprKind::Construct(construct, mut list) = kind else { return value };
        let unread = self.unread_arguments(variable, value);
        if unread.is_empty() {
            return value;
        }
        let acts = self.uses.acts(self.shader, value);
        for index in unread {
            let Some(slot) = list.get_mut(index) else { continue };
            // Nothing in it acts, but another argument may.
            let within = Some(Stored::whole(variable)).filter(|_| !acts);
            self.forget(*slot, within);
            let (ty, span) = (self.shader.expr(*slot).ty, self.shader.expr(*slot).span);
            *slot = super::zero(self.types, self.shader, ty, span);
        }
        self.changed = true;
        self.shader.push(ExprKind::Construct(construct, list), ty, span)
    }

    fn has_unread_parts(&self, target: ExprId, value: ExprId) -> bool {
        match self.shader.expr(target).kind {
            ExprKind::Var(variable) => !self.unread_arguments(variable, value).is_empty(),
            _ => false,
        }
    }

    /// The arguments of a constructor that reach only parts of the variable that nobody reads.
    fn unread_arguments(&self, variable: VarRef, value: ExprId) -> Vec<usize> {
        let Expr { kind: ExprKind::Construct(construct, list), ty, .. } = self.shader.expr(value) else {
            return Vec::new();
        };
        let (size, by_element) = match (self.types.get(*ty), construct) {
            (Type::Vector(..), ConstructKind::Compose) => (1, false),
            (Type::Matrix(_, rows), ConstructKind::Compose) => (u32::from(rows), false),
            (Type::Array(..), ConstructKind::Array) => (1, true),
            _ => return Vec::new(),
        };
        if !self.is_own(variable) || self.uses.get(variable).whole > 0 {
            return Vec::new();
        }
        let mut first = 0;
        let mut unread = Vec::new();
        for (index, argument) in list.iter().enumerate() {
            let len = if by_element { 1 } else { self.types.flat_len(self.shader.expr(*argument).ty) };
            let parts = (first / size..(first + len).div_ceil(size))
                .try_fold(0, |parts: Parts, part| Some(parts | 1u64.checked_shl(part)?));
            first += len;
            let nobody = parts.is_some_and(|parts| !self.uses.reads_any(variable, parts));
            if nobody && self.is_pure(*argument) && !is_constant(self.shader, *argument) {
                unread.push(index);
            }
        }
        unread
    }

    /// A block without the declarations of what it does not name. Blocks that were one loop declare the same locals, and another of them
    /// may name these.
    fn without_unnamed(&mut self, body: Vec<Stmt>) -> Vec<Stmt> {
        let is_unnamed = |stmt: &Stmt| match stmt.kind {
            StmtKind::Local(local, None) => {
                let mut named = false;
                self.shader.visit_body(&body, &mut |expr| {
                    named |= matches!(self.shader.expr(expr).kind, ExprKind::Var(VarRef::Local(other)) if other == local);
                });
                !named
            }
            _ => false,
        };
        let unnamed: Vec<bool> = body.iter().map(is_unnamed).collect();
        self.changed |= unnamed.contains(&true);
        body.into_iter().zip(unnamed).filter(|(_, unnamed)| !unnamed).map(|(stmt, _)| stmt).collect()
    }

    /// An expression for its effects alone.
    fn effect(&mut self, expr: ExprId, span: glisten_front::source::Span, out: &mut Vec<Stmt>) {
        let keep = Stmt { kind: StmtKind::Expr(expr), span };
        match self.shader.expr(expr).kind.clone() {
            _ if self.is_pure(expr) => {
                self.forget_effect(expr);
                self.changed = true;
            }
            ExprKind::Assign(_, target, value) if self.is_dead(target) && self.has_pure_indices(target) => {
                self.changed = true;
                if self.is_pure(value) {
                    self.forget_effect(expr);
                } else {
                    // The target is no longer named; what the value does stays.
                    self.forget_effect(expr);
                    self.uses.value(self.types, self.shader, value, 1, None);
                    self.effect(value, span, out);
                }
            }
            ExprKind::Assign(None, target, value) if self.has_unread_parts(target, value) => {
                let ExprKind::Var(variable) = self.shader.expr(target).kind else { return out.push(keep) };
                let value = self.partly(variable, value);
                if let Some(expr) = self.shader.exprs.get_mut(expr.index()) {
                    expr.kind = ExprKind::Assign(None, target, value);
                }
                out.push(keep);
            }
            ExprKind::Assign(None, target, value) if same_value(self.shader, target, value) => {
                self.forget_effect(expr);
                self.changed = true;
            }
            ExprKind::IncDec(_, target) if self.is_dead(target) && self.has_pure_indices(target) => {
                self.forget_effect(expr);
                self.changed = true;
            }
            ExprKind::Comma(left, right) => {
                self.effect(right, span, out);
                self.effect(left, span, out);
                self.changed = true;
            }
            ExprKind::Logical(..) | ExprKind::Ternary(..) => out.push(keep),
            // Nobody wants the result: what the operands do is left, from left to right.
            kind if !may_act(&kind) => {
                self.forget_effect(expr);
                self.changed = true;
                let operands: Vec<ExprId> = kind.children().into_iter().filter(|child| !self.is_pure(*child)).collect();
                for operand in operands.into_iter().rev() {
                    self.uses.effect(self.types, self.shader, operand, 1);
                    self.effect(operand, span, out);
                }
            }
            // A call that gives a value alone was seen above, unless its arguments do something.
            _ => out.push(keep),
        }
    }

    fn selection(
        &mut self,
        arms: Vec<(ExprId, Vec<Stmt>)>,
        otherwise: Vec<Stmt>,
        span: glisten_front::source::Span,
        out: &mut Vec<Stmt>,
    ) {
        let mut otherwise = self.body(otherwise);
        let mut arms: Vec<(ExprId, Vec<Stmt>)> =
            arms.into_iter().rev().map(|(condition, body)| (condition, self.body(body))).collect();
        arms.reverse();
        while otherwise.is_empty()
            && let Some((condition, body)) = arms.last()
            && body.is_empty()
            && self.is_pure(*condition)
        {
            let condition = *condition;
            self.forget(condition, None);
            arms.pop();
            self.changed = true;
        }
        if let [(condition, body)] = arms.as_mut_slice()
            && body.is_empty()
            && !otherwise.is_empty()
        {
            let (ty, place) = (TypeId::BOOL, self.shader.expr(*condition).span);
            *condition = match self.shader.expr(*condition).kind {
                ExprKind::Unary(UnaryOp::Not, inner) => inner,
                _ => self.shader.push(ExprKind::Unary(UnaryOp::Not, *condition), ty, place),
            };
            *body = std::mem::take(&mut otherwise);
            self.changed = true;
        }
        match arms.first() {
            None => out.extend(otherwise.into_iter().rev()),
            Some((condition, body)) if arms.len() == 1 && body.is_empty() && otherwise.is_empty() => {
                let condition = *condition;
                self.changed = true;
                self.effect(condition, span, out);
            }
            Some(_) => out.push(Stmt { kind: StmtKind::If { arms, otherwise }, span }),
        }
    }

    /// Takes an expression out of the counts.
    fn forget(&mut self, expr: ExprId, within: Option<Stored>) {
        self.uses.value(self.types, self.shader, expr, -1, within);
    }

    /// Takes an expression that was a statement out of the counts.
    fn forget_effect(&mut self, expr: ExprId) {
        self.uses.effect(self.types, self.shader, expr, -1);
    }

    /// Whether evaluating it changes nothing that anybody sees.
    fn is_pure(&self, root: ExprId) -> bool {
        let mut pure = true;
        self.shader.visit_expr(root, &mut |expr| {
            pure &= match &self.shader.expr(expr).kind {
                ExprKind::Call(callee, arguments) => self.is_idle_call(*callee, arguments),
                kind => !may_act(kind),
            };
        });
        pure
    }

    /// Whether a call does nothing but give a value.
    fn is_idle_call(&self, callee: FunctionId, arguments: &[ExprId]) -> bool {
        let effect = self.uses.effects.function(callee);
        let writes = effect.writes.iter().any(|global| !self.is_unread(VarRef::Global(*global)));
        let function = self.shader.function(callee);
        let gives = arguments.iter().enumerate().any(|(index, argument)| {
            matches!(function.param_mode(index), ParamMode::Out | ParamMode::Inout) && !self.is_dead(*argument)
        });
        !effect.ends && !writes && !gives
    }

    fn is_unread(&self, variable: VarRef) -> bool {
        let live = match variable {
            VarRef::Global(id) => self.is_live(id),
            VarRef::Local(id) => self.is_given_back(id),
        };
        !live && self.uses.get(variable).reads <= 0
    }

    /// Whether a local is a parameter whose value some caller takes and reads.
    fn is_given_back(&self, id: LocalId) -> bool {
        let own = self.uses.function;
        let function = self.shader.function(own);
        let gives = id.index() < function.param_count
            && matches!(function.param_mode(id.index()), ParamMode::Out | ParamMode::Inout);
        gives && !self.uses.is_unread_by_callers(self.types, self.shader, self.live, (own, id.index()))
    }

    /// Whether nobody but the present function, or the stage while it runs, sees what is stored to a variable.
    fn is_own(&self, variable: VarRef) -> bool {
        match variable {
            VarRef::Local(id) => !self.is_given_back(id),
            VarRef::Global(id) => self.shader.global(id).storage == Storage::Private,
        }
    }

    fn is_live(&self, id: GlobalId) -> bool {
        self.live.get(id.index()).copied().unwrap_or(true)
    }

    /// Whether nobody reads what is stored there.
    fn is_dead(&self, target: ExprId) -> bool {
        let Some(Stored { variable, member, parts }) = stored(self.types, self.shader, target) else { return false };
        if self.is_unread(variable) {
            return true;
        }
        let own = match variable {
            VarRef::Local(_) => true,
            VarRef::Global(id) => self.shader.global(id).storage == Storage::Private,
        };
        if self.is_own(variable) && parts.is_some_and(|parts| !self.uses.reads_any(variable, parts)) {
            return true;
        }
        // A struct that a call gives or takes is one of its type: nobody reads the member of any of them.
        own && member.is_some_and(|member| self.uses.members.get(&member).copied().unwrap_or(0) <= 0)
    }

    fn has_pure_indices(&self, target: ExprId) -> bool {
        let mut at = target;
        loop {
            match &self.shader.expr(at).kind {
                ExprKind::Index(base, index) => {
                    if !self.is_pure(*index) {
                        return false;
                    }
                    at = *base;
                }
                ExprKind::Member(base, _) | ExprKind::Swizzle(base, _) => at = *base,
                _ => return true,
            }
        }
    }

    /// Whether a loop changes nothing but locals that nobody else reads.
    fn is_idle(&mut self, whole: &StmtKind) -> bool {
        let body = [Stmt { kind: whole.clone(), span: glisten_front::source::Span::default() }];
        let mut idle = true;
        self.shader.visit_statements(&body, &mut |stmt| {
            idle &= !matches!(stmt.kind, StmtKind::Return(_) | StmtKind::Discard);
        });
        self.shader.visit_body(&body, &mut |expr| {
            idle &= match &self.shader.expr(expr).kind {
                ExprKind::Call(callee, arguments) => self.is_idle_call(*callee, arguments),
                ExprKind::BuiltinCall(function, _) => !function.has_effects(),
                _ => true,
            };
        });
        if !idle {
            return false;
        }
        let assigned = self.uses.effects.assigned(self.shader, &body, &[]);
        // What it reads itself does not count.
        self.uses.body(self.types, self.shader, &body, -1);
        let unread = |variable| match variable {
            VarRef::Global(id) => !self.is_live(id) && self.uses.get(variable).reads <= 0,
            VarRef::Local(id) => !self.is_given_back(id) && self.uses.get(variable).reads <= 0,
        };
        let idle = assigned.locals.iter().all(|local| unread(VarRef::Local(*local)))
            && assigned.globals.iter().all(|global| unread(VarRef::Global(*global)));
        self.uses.body(self.types, self.shader, &body, 1);
        idle
    }
}
