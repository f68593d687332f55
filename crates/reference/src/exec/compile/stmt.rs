//! Compiles statements and calls (§6).

use super::super::inst::{Class, Inst, Operand, Slot, Target};
use super::super::note::NoteKind;
use super::effects::Assigned;
use super::path::Path;
use super::vars::VarId;
use super::{Compiler, Frame, Scope, Val};
use glisten_front::diagnostic::codes;
use glisten_front::hir::{
    Case, CaseLabel, Condition, ExprId, Function, FunctionId, LocalId, LocalKind, LoopKind, ParamMode, Stmt, StmtKind,
    TypeId,
};
use glisten_front::source::Span;
use glisten_front::stack::with_stack;

/// The destination of a jump out of nested constructs.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Exit {
    Break,
    Continue,
    Return,
}

impl Compiler<'_> {
    /// Compiles statements. Returns false if no lane reaches their end.
    fn stmts(&mut self, stmts: &[Stmt]) -> bool {
        for stmt in stmts {
            if self.full() {
                return false;
            }
            if !self.at(stmt.span, |this| this.stmt(stmt)) {
                return false;
            }
        }
        true
    }

    fn stmt(&mut self, stmt: &Stmt) -> bool {
        match &stmt.kind {
            StmtKind::Expr(expr) => {
                self.expr(*expr);
            }
            StmtKind::Local(local, init) => self.local(*local, *init),
            StmtKind::Block(body) => return self.stmts(body),
            StmtKind::If { arms, otherwise } => self.selection(arms, otherwise),
            StmtKind::Switch { selector, cases } => self.switch(*selector, cases),
            StmtKind::Loop { kind, condition, step, body } => self.iteration(*kind, condition.as_ref(), *step, body),
            StmtKind::Break => self.leave(Exit::Break),
            StmtKind::Continue => self.leave(Exit::Continue),
            StmtKind::Return(value) => {
                self.give(*value);
                // At the end of a function that cannot be left earlier, all lanes are still together.
                if self.frames.last().is_some_and(|frame| frame.parts) {
                    self.leave(Exit::Return);
                }
            }
            StmtKind::Discard => {
                self.note_discard();
                self.emit.push(Inst::Discard);
            }
        }
        !matches!(stmt.kind, StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::Discard)
    }

    fn local(&mut self, local: LocalId, init: Option<ExprId>) {
        let Some(function) = self.frames.last().map(|frame| frame.function) else { return };
        let shader = self.shader;
        let facts = shader.function(function).local(local);
        let is_open = facts.kind == LocalKind::Const && init.is_some_and(|init| self.is_open(init));
        let value = match (&facts.value, init) {
            (Some(value), _) if facts.kind == LocalKind::Const && !is_open => Some(self.constant(value)),
            (_, Some(init)) => Some(self.expr(init)),
            (_, None) => None,
        };
        // It is declared after its initializer, which may use an outer variable of the same name.
        let var = self.declare(facts.ty, false);
        self.bind(local, var);
        if is_open {
            self.open.insert(var);
        }
        if let Some(value) = value {
            self.note_local(facts, &value);
            self.assign_all(var, &value);
        }
    }

    fn settle_for_stmts<'s>(&mut self, bodies: impl Iterator<Item = &'s [Stmt]>, exprs: &[ExprId]) {
        let mut assigned = Assigned::default();
        for body in bodies {
            self.effects.stmts(self.shader, body, &mut assigned);
        }
        for expr in exprs {
            self.effects.expr(self.shader, *expr, &mut assigned);
        }
        self.settle_assigned(&assigned);
    }

    /// Compiles nested statements in a region of their own.
    fn nested(&mut self, scope: Scope, stmts: &[Stmt]) {
        self.scopes.push(scope);
        self.in_region(|this| {
            this.stmts(stmts);
        });
        self.scopes.pop();
    }

    fn selection(&mut self, arms: &[(ExprId, Vec<Stmt>)], otherwise: &[Stmt]) {
        let Some((asked, _)) = arms.first() else { return };
        let first = self.scalar(*asked);
        let first = self.emit.keep(Class::Int, first);
        self.note_branch(NoteKind::If, *asked, first);
        let later: Vec<ExprId> = arms.iter().skip(1).map(|arm| arm.0).collect();
        let bodies = arms.iter().map(|arm| arm.1.as_slice()).chain([otherwise]);
        self.settle_for_stmts(bodies, &later);
        let (join, rest) = (self.emit.slot(), self.emit.slot());
        self.emit.push(Inst::Save { slot: join });
        let mut ends: Vec<Target> = Vec::new();
        for (place, (condition, body)) in arms.iter().enumerate() {
            let c = if place == 0 { first } else { self.later_condition(join, *condition) };
            let span = self.shader.expr(*condition).span;
            let arm = self.at(span, |this| this.emit.jump(Inst::Arm { c, rest, next: 0 }));
            self.nested(Scope::Arms { join }, body);
            self.emit.land(arm);
            if place + 1 < arms.len() || !otherwise.is_empty() {
                ends.push(self.emit.jump(Inst::Rest { rest, end: 0 }));
            }
        }
        if !otherwise.is_empty() {
            self.nested(Scope::Arms { join }, otherwise);
        }
        ends.into_iter().for_each(|end| self.emit.land(end));
        self.emit.push(Inst::Join { slot: join });
        self.parted |= arms.iter().any(|arm| returns(&arm.1)) || returns(otherwise);
    }

    fn later_condition(&mut self, join: Slot, condition: ExprId) -> Operand {
        self.scopes.push(Scope::Arms { join });
        let value = self.in_region(|this| this.scalar(condition));
        self.scopes.pop();
        self.note_branch(NoteKind::If, condition, value);
        value
    }

    fn switch(&mut self, selector: ExprId, cases: &[Case]) {
        let asked = selector;
        let selector = self.scalar(selector);
        let selector = self.emit.keep(Class::Int, selector);
        self.note_branch(NoteKind::Switch, asked, selector);
        let selector = self.emit.in_register(Class::Int, selector);
        self.settle_for_stmts(cases.iter().map(|case| case.body.as_slice()), &[]);
        let (join, rest) = (self.emit.slot(), self.emit.slot());
        self.emit.push(Inst::Save { slot: join });
        self.emit.push(Inst::Save { slot: rest });
        let mut slots: Vec<Slot> = Vec::new();
        for case in cases {
            let slot = self.emit.slot();
            slots.push(slot);
            let labels: Vec<u32> = (case.labels.iter())
                .filter_map(|label| match label {
                    CaseLabel::Value(bits) => Some(*bits),
                    CaseLabel::Default => None,
                })
                .collect();
            let labels = self.emit.words(&labels);
            self.emit.push(Inst::CaseMask { selector, labels, rest, slot });
        }
        self.emit.push(Inst::Idle);
        self.scopes.push(Scope::Switch { join });
        self.in_region(|this| {
            for (case, slot) in cases.iter().zip(slots) {
                if case.labels.contains(&CaseLabel::Default) {
                    // The lanes that no label took.
                    this.emit.push(Inst::Case { slot: rest, next: 0 });
                    let here = this.emit.here();
                    this.emit.land(here - 1);
                }
                let enter = this.emit.jump(Inst::Case { slot, next: 0 });
                this.stmts(&case.body);
                this.emit.land(enter);
            }
        });
        self.scopes.pop();
        self.emit.push(Inst::Join { slot: join });
        self.parted |= cases.iter().any(|case| returns(&case.body));
    }

    fn iteration(&mut self, kind: LoopKind, condition: Option<&Condition>, step: Option<ExprId>, body: &[Stmt]) {
        let exprs: Vec<ExprId> = condition.map(|condition| condition.expr).into_iter().chain(step).collect();
        self.settle_for_stmts(std::iter::once(body), &exprs);
        let (join, active) = (self.emit.slot(), self.emit.slot());
        self.emit.push(Inst::Save { slot: join });
        self.emit.push(Inst::Save { slot: active });
        let head = self.emit.here();
        let mut exits: Vec<Target> = Vec::new();
        self.scopes.push(Scope::Loop { join, active });
        self.in_region(|this| {
            if kind != LoopKind::DoWhile {
                exits.extend(this.loop_test(condition, active));
            }
            this.stmts(body);
            exits.push(this.emit.jump(Inst::LoopNext { active, exit: 0 }));
            if let Some(step) = step {
                this.expr(step);
            }
            if kind == LoopKind::DoWhile {
                exits.extend(this.loop_test(condition, active));
            }
        });
        self.scopes.pop();
        exits.push(self.emit.jump(Inst::LoopBack { head, exit: 0 }));
        exits.into_iter().for_each(|exit| self.emit.land(exit));
        self.emit.push(Inst::Join { slot: join });
        self.parted |= returns(body);
    }

    fn loop_test(&mut self, condition: Option<&Condition>, active: Slot) -> Option<Target> {
        let condition = condition?;
        let c = self.scalar(condition.expr);
        self.note_branch(NoteKind::Loop, condition.expr, c);
        if let Some(local) = condition.local {
            let var = self.declare(TypeId::BOOL, false);
            self.bind(local, var);
            self.assign(var, 0, c);
        }
        let span = self.shader.expr(condition.expr).span;
        Some(self.at(span, |this| this.emit.jump(Inst::LoopTest { c, active, exit: 0 })))
    }

    /// The active lanes leave the constructs around them.
    fn leave(&mut self, exit: Exit) {
        let mut slots = Vec::new();
        for scope in self.scopes.iter().rev() {
            match (scope, exit) {
                (Scope::Function, _) => break,
                (Scope::Arms { join }, _) => slots.push(*join),
                (Scope::Switch { .. }, Exit::Break) => break,
                (Scope::Switch { join }, _) => slots.push(*join),
                (Scope::Loop { active, .. }, Exit::Break) => {
                    slots.push(*active);
                    break;
                }
                (Scope::Loop { .. }, Exit::Continue) => break,
                (Scope::Loop { join, active }, Exit::Return) => slots.extend([*join, *active]),
            }
        }
        let slots = self.emit.words(&slots);
        self.emit.push(Inst::Leave { slots });
    }

    /// Sets the result of the function.
    fn give(&mut self, value: Option<ExprId>) {
        let Some(value) = value else { return };
        let value = self.expr(value);
        if let Some(result) = self.frames.last().and_then(|frame| frame.result) {
            self.assign_all(result, &value);
        }
    }

    pub(super) fn call(&mut self, function: FunctionId, arguments: &[ExprId], span: Span) -> Val {
        let callee = self.shader.function(function);
        let mut values: Vec<Val> = Vec::new();
        let mut places: Vec<(usize, Path)> = Vec::new();
        let last_effect = arguments.iter().rposition(|argument| self.effects.has(*argument)).unwrap_or(0);
        for (index, argument) in arguments.iter().enumerate() {
            let mode = callee.param_mode(index);
            if matches!(mode, ParamMode::In | ParamMode::ConstIn) {
                let value = self.expr(*argument);
                values.push(if index < last_effect { self.keep_all(*argument, value) } else { value });
                continue;
            }
            let path = self.path_before(*argument, true);
            let value = if mode == ParamMode::Inout { self.read_path(&path) } else { Val::new() };
            let value = if mode == ParamMode::Inout { self.keep_all(*argument, value) } else { value };
            values.push(value);
            places.push((index, path));
        }
        // The callee's body is compiled in the midst of the caller's, however long the chain of calls is.
        let (result, finals) = with_stack(self.shader.depth, || self.inline(function, values, span));
        for ((index, path), value) in places.into_iter().zip(finals) {
            let from = callee.params().get(index).map_or(TypeId::ERROR, |param| param.ty);
            let to = arguments.get(index).map_or(TypeId::ERROR, |argument| self.ty(*argument));
            let value = self.convert(&value, from, to);
            self.write_path(&path, &value);
        }
        result
    }

    /// Whether the function may be left before its end.
    fn parts(function: &Function) -> bool {
        let Some(body) = &function.body else { return false };
        let (last, before) = match body.split_last() {
            Some((last, before)) => (std::slice::from_ref(last), before),
            None => return false,
        };
        returns(before) || (returns(last) && !last.iter().all(|stmt| matches!(stmt.kind, StmtKind::Return(_))))
    }

    /// Inlines a function. Returns its result and the final values of its `out` and `inout` parameters.
    pub(super) fn inline(&mut self, function: FunctionId, arguments: Vec<Val>, span: Span) -> (Val, Vec<Val>) {
        let shader = self.shader;
        let callee = shader.function(function);
        let Some(body) = &callee.body else {
            self.refuse(&codes::general::INTERNAL, span, &format!("`{}`, which has no body", callee.name));
            return (Val::new(), Vec::new());
        };
        if self.frames.len() > shader.functions.len() || self.full() {
            // Deeper than the number of functions: recursion.
            return (Val::new(), Vec::new());
        }
        if !self.frames.is_empty() && self.is_too_long(function) {
            return self.endless_call(callee, span);
        }
        let parts = Self::parts(callee);
        self.frames.push(Frame { function, locals: vec![None; callee.locals.len()], result: None, parts });
        let mut outs: Vec<VarId> = Vec::new();
        for index in 0..callee.param_count {
            let mode = callee.param_mode(index);
            let out = matches!(mode, ParamMode::Out | ParamMode::Inout);
            let ty = callee.params().get(index).map_or(TypeId::ERROR, |param| param.ty);
            let var = self.declare(ty, parts);
            if out {
                outs.push(var);
            }
            self.bind(LocalId::new(index), var);
            if let Some(value) = arguments.get(index).filter(|_| mode != ParamMode::Out) {
                // Not a store of the callee: it applies to every lane.
                let parted = std::mem::replace(&mut self.parted, false);
                self.assign_all(var, value);
                self.parted = parted;
            }
        }
        let result = self.declare(callee.ret, parts);
        if let Some(frame) = self.frames.last_mut() {
            frame.result = Some(result);
        }
        let outer = self.parted;
        let join = self.emit.slot();
        if parts {
            self.emit.push(Inst::Save { slot: join });
            // Lanes that return here and lanes that continue compute their results at different places.
            for flat in 0..self.classes(callee.ret).len() {
                self.settle(result, flat);
            }
        }
        self.note_call(callee, span, &arguments);
        self.scopes.push(Scope::Function);
        self.stmts(body);
        self.scopes.pop();
        if parts {
            self.emit.push(Inst::Join { slot: join });
        }
        self.parted = outer;
        let finals = outs.into_iter().map(|var| self.read_all(var)).collect();
        let value = self.read_all(result);
        self.note_return(callee, span, &value);
        self.frames.pop();
        (value, finals)
    }
}

impl Compiler<'_> {
    fn is_too_long(&self, function: FunctionId) -> bool {
        self.sizes.get(function.index()).is_some_and(|size| *size > super::MAX_INSTRUCTIONS as u64)
    }

    /// A call that ends the run. Its result and its `out` parameters are 0, which nothing ever reads.
    fn endless_call(&mut self, callee: &Function, span: Span) -> (Val, Vec<Val>) {
        self.at(span, |this| this.emit.push(Inst::Endless));
        let zeros = |this: &mut Self, ty: TypeId| -> Val {
            let classes = this.classes(ty);
            classes.iter().map(|class| this.emit.zero(*class)).collect()
        };
        let outs = callee.param_types().filter(|(_, mode)| matches!(mode, ParamMode::Out | ParamMode::Inout));
        let finals = outs.map(|(ty, _)| zeros(self, ty)).collect();
        (zeros(self, callee.ret), finals)
    }
}

/// Whether there is a `return` anywhere among them.
fn returns(stmts: &[Stmt]) -> bool {
    stmts.iter().any(|stmt| match &stmt.kind {
        StmtKind::Return(_) => true,
        StmtKind::Block(body) | StmtKind::Loop { body, .. } => returns(body),
        StmtKind::If { arms, otherwise } => arms.iter().any(|arm| returns(&arm.1)) || returns(otherwise),
        StmtKind::Switch { cases, .. } => cases.iter().any(|case| returns(&case.body)),
        StmtKind::Expr(_) | StmtKind::Local(..) | StmtKind::Break | StmtKind::Continue | StmtKind::Discard => false,
    })
}
