//! Lowers loops and switches (§6.2, §6.3).

use super::Try;
use super::function::Ctx;
use super::slots::LocalSlot;
use glisten_front::hir::{
    Case, CaseLabel, Condition, ExprId, ExprKind, LoopKind, Scalar, ScalarValue, Stmt, StmtKind, TypeId,
};
use naga::{BinaryOperator, Block, Statement, SwitchCase, SwitchValue};

/// The flag that a loop checks before each iteration, if it has to.
type Guard = Option<naga::Handle<naga::GlobalVariable>>;

impl Ctx<'_, '_> {
    /// `for`, `while`, `do`.
    pub(super) fn repeat(
        &mut self,
        kind: LoopKind,
        condition: Option<&Condition>,
        step: Option<ExprId>,
        body: &[Stmt],
    ) -> Try<()> {
        self.loops += 1;
        let in_switch = std::mem::replace(&mut self.in_switch, false);
        // In targets where an invocation continues after a `discard`, it may continue with values that the program
        // never meant to use. A loop that does not evidently end is then left.
        let span = self.here();
        let guarded = self.low.facts.loops_after_discard.contains(&(span.start, span.end));
        let guard = self.low.discarded.filter(|_| guarded);
        let lowered = match kind {
            LoopKind::For | LoopKind::While => self.loop_in_front(condition, step, body, guard),
            LoopKind::DoWhile => self.loop_behind(condition, body, guard),
        };
        self.loops -= 1;
        self.in_switch = in_switch;
        lowered
    }

    fn leave_if_discarded(&mut self, guard: Guard) {
        if let Some(variable) = guard {
            let pointer = self.global_variable(variable);
            let discarded = self.load(pointer);
            self.leave_if(discarded);
        }
    }

    fn loop_in_front(
        &mut self,
        condition: Option<&Condition>,
        step: Option<ExprId>,
        body: &[Stmt],
        guard: Guard,
    ) -> Try<()> {
        let condition = condition.filter(|condition| condition.local.is_some() || !self.is_true(condition.expr));
        let block = self.in_block(|ctx| {
            ctx.leave_if_discarded(guard);
            match condition {
                Some(condition) => ctx.leave_unless(condition)?,
                // Tint rejects a loop that nothing leaves.
                None if guard.is_none() && !leaves(body) => {
                    let never = ctx.boolean(false);
                    ctx.leave_if(never);
                }
                None => {}
            }
            ctx.body(body)
        })?;
        let continuing = match step {
            Some(step) => self.in_block(|ctx| ctx.effect(step))?,
            None => Block::new(),
        };
        self.statement(Statement::Loop { body: block, continuing, break_if: None });
        Ok(())
    }

    fn loop_behind(&mut self, condition: Option<&Condition>, body: &[Stmt], guard: Guard) -> Try<()> {
        let block = self.in_block(|ctx| {
            ctx.leave_if_discarded(guard);
            ctx.body(body)
        })?;
        let mut break_if = None;
        let continuing = self.in_block(|ctx| {
            if let Some(condition) = condition {
                let value = ctx.value(condition.expr)?;
                break_if = Some(ctx.not(value));
            }
            Ok(())
        })?;
        self.statement(Statement::Loop { body: block, continuing, break_if });
        Ok(())
    }

    fn is_true(&self, id: ExprId) -> bool {
        matches!(self.shader.expr(id).kind, ExprKind::Literal(ScalarValue::Bool(true)))
    }

    fn leave_unless(&mut self, condition: &Condition) -> Try<()> {
        let value = self.value(condition.expr)?;
        if let Some(local) = condition.local {
            let name = self.shader.function(self.id).local(local).name.clone();
            let variable = self.variable_of(&name, TypeId::BOOL)?;
            self.store(variable, value);
            self.set_slot(local, LocalSlot::Pointer(variable));
        }
        let stop = self.not(value);
        self.leave_if(stop);
        Ok(())
    }

    fn leave_if(&mut self, condition: naga::Handle<naga::Expression>) {
        let mut accept = Block::new();
        accept.push(Statement::Break, naga::Span::UNDEFINED);
        self.statement(Statement::If { condition, accept, reject: Block::new() });
    }

    /// `switch`. Targets have no fall-through. If a case falls through, the switch only determines where to start,
    /// and the bodies follow it in sequence.
    pub(super) fn switch(&mut self, selector: ExprId, cases: &[Case]) -> Try<()> {
        let unsigned = self.low.types.scalar_of(self.shader.expr(selector).ty) == Some(Scalar::Uint);
        let selector = self.value(selector)?;
        let in_switch = std::mem::replace(&mut self.in_switch, true);
        let runs_on = cases.split_last().is_some_and(|(_, others)| others.iter().any(|case| !ends(&case.body)));
        let lowered =
            if runs_on { self.row(selector, cases, unsigned) } else { self.plain_switch(selector, cases, unsigned) };
        self.in_switch = in_switch;
        lowered
    }

    fn plain_switch(&mut self, selector: naga::Handle<naga::Expression>, cases: &[Case], unsigned: bool) -> Try<()> {
        let mut lowered = Vec::new();
        for case in cases {
            let body = match case.body.split_last() {
                Some((Stmt { kind: StmtKind::Break, .. }, before)) => before,
                _ => &case.body,
            };
            let body = self.in_block(|ctx| ctx.body(body))?;
            push_case(&mut lowered, &case.labels, body, unsigned);
        }
        with_default(&mut lowered);
        self.statement(Statement::Switch { selector, cases: lowered });
        Ok(())
    }

    /// Cases that fall through: `start` is the index of the first body to run, and each body from there on runs.
    fn row(&mut self, selector: naga::Handle<naga::Expression>, cases: &[Case], unsigned: bool) -> Try<()> {
        let start = self.variable_of("start", TypeId::INT)?;
        let none = self.int(cases.len() as i32);
        self.store(start, none);
        let mut lowered = Vec::new();
        for (index, case) in cases.iter().enumerate() {
            let body = self.in_block(|ctx| {
                let index = ctx.int(index as i32);
                ctx.store(start, index);
                Ok(())
            })?;
            push_case(&mut lowered, &case.labels, body, unsigned);
        }
        with_default(&mut lowered);
        self.statement(Statement::Switch { selector, cases: lowered });
        // A switch with one body gives `break` something to leave.
        let bodies = self.in_block(|ctx| {
            for (index, case) in cases.iter().enumerate() {
                let first = ctx.load(start);
                let index = ctx.int(index as i32);
                let condition = ctx.op(BinaryOperator::LessEqual, first, index);
                let accept = ctx.in_block(|ctx| ctx.body(&case.body))?;
                ctx.statement(Statement::If { condition, accept, reject: Block::new() });
            }
            Ok(())
        })?;
        let selector = self.int(0);
        let only = SwitchCase { value: SwitchValue::Default, body: bodies, fall_through: false };
        self.statement(Statement::Switch { selector, cases: vec![only] });
        Ok(())
    }
}

fn push_case(cases: &mut Vec<SwitchCase>, labels: &[CaseLabel], body: Block, unsigned: bool) {
    let value = |label: &CaseLabel| match label {
        CaseLabel::Default => SwitchValue::Default,
        CaseLabel::Value(bits) if unsigned => SwitchValue::U32(*bits),
        CaseLabel::Value(bits) => SwitchValue::I32(*bits as i32),
    };
    let Some((last, before)) = labels.split_last() else { return };
    for label in before {
        cases.push(SwitchCase { value: value(label), body: Block::new(), fall_through: true });
    }
    cases.push(SwitchCase { value: value(last), body, fall_through: false });
}

/// Adds the default that naga requires in every switch.
fn with_default(cases: &mut Vec<SwitchCase>) {
    if !cases.iter().any(|case| case.value == SwitchValue::Default) {
        cases.push(SwitchCase { value: SwitchValue::Default, body: Block::new(), fall_through: false });
    }
}

/// Whether control evidently does not reach the end of the statements.
fn ends(body: &[Stmt]) -> bool {
    match body.last().map(|stmt| &stmt.kind) {
        Some(StmtKind::Break | StmtKind::Continue | StmtKind::Return(_) | StmtKind::Discard) => true,
        // A `break` inside the last block leaves the switch as well.
        Some(StmtKind::Block(body)) => ends(body),
        Some(StmtKind::If { arms, otherwise }) => ends(otherwise) && arms.iter().all(|(_, body)| ends(body)),
        _ => false,
    }
}

/// Whether something in the body of a loop leaves the loop.
fn leaves(body: &[Stmt]) -> bool {
    body.iter().any(|stmt| match &stmt.kind {
        StmtKind::Break | StmtKind::Return(_) => true,
        StmtKind::Block(body) => leaves(body),
        StmtKind::If { arms, otherwise } => leaves(otherwise) || arms.iter().any(|(_, body)| leaves(body)),
        StmtKind::Switch { cases, .. } => cases.iter().any(|case| returns(&case.body)),
        StmtKind::Loop { body, .. } => returns(body),
        _ => false,
    })
}

/// Whether there is a `return` anywhere inside.
fn returns(body: &[Stmt]) -> bool {
    body.iter().any(|stmt| match &stmt.kind {
        StmtKind::Return(_) => true,
        StmtKind::Block(body) | StmtKind::Loop { body, .. } => returns(body),
        StmtKind::If { arms, otherwise } => returns(otherwise) || arms.iter().any(|(_, body)| returns(body)),
        StmtKind::Switch { cases, .. } => cases.iter().any(|case| returns(&case.body)),
        _ => false,
    })
}
