//! Lowers statements (§6) except loops and switches.

use super::Try;
use super::function::Ctx;
use super::slots::LocalSlot;
use crate::target::FloatWidth;
use glisten_front::hir::{ExprId, LocalId, LocalKind, Scalar, Stmt, StmtKind, Type, TypeId};
use naga::{Block, Expression, Handle, Statement};

/// How many arms of an `else if` chain nest in the text. After these, a flag continues the chain at the outer level:
/// naga and Tint reject text that nests a thousand levels, and the indentation alone would take megabytes.
const NESTED_ARMS: usize = 8;

impl Ctx<'_, '_> {
    /// Lowers the statements of a block. Drops what follows a jump, since naga allows nothing there.
    pub(super) fn body(&mut self, body: &[Stmt]) -> Try<()> {
        for stmt in body {
            if self.is_over() {
                break;
            }
            let outer = self.at(stmt.span);
            let done = self.stmt(stmt);
            self.flush();
            self.back_to(outer);
            done?;
        }
        Ok(())
    }

    fn stmt(&mut self, stmt: &Stmt) -> Try<()> {
        match &stmt.kind {
            StmtKind::Expr(id) => self.effect(*id),
            StmtKind::Local(local, initializer) => self.declare(*local, *initializer),
            StmtKind::Block(body) => {
                // Names are unique in the whole function here, so a block needs no block of its own.
                let in_switch = std::mem::replace(&mut self.in_switch, false);
                let done = self.body(body);
                self.in_switch = in_switch;
                done
            }
            StmtKind::If { arms, otherwise } => self.chain(arms, otherwise),
            StmtKind::Switch { selector, cases } => self.switch(*selector, cases),
            StmtKind::Loop { kind, condition, step, body } => self.repeat(*kind, condition.as_ref(), *step, body),
            StmtKind::Break => {
                self.statement(Statement::Break);
                Ok(())
            }
            StmtKind::Continue => {
                self.statement(Statement::Continue);
                Ok(())
            }
            StmtKind::Return(Some(value)) => {
                let value = self.value(*value)?;
                self.statement(Statement::Return { value: Some(value) });
                Ok(())
            }
            StmtKind::Return(None) => self.return_nothing(),
            StmtKind::Discard => self.discard(),
        }
    }

    /// `discard`: naga's `Kill`. Where the invocation continues without effects, a loop around it could run forever and the end
    /// of a function would lack its result, so the function is left, too. Loops in the callers, and later loops, check a flag
    /// (see [`Ctx::repeat`]).
    fn discard(&mut self) -> Try<()> {
        if let Some(variable) = self.low.discarded {
            let pointer = self.global_variable(variable);
            let yes = self.boolean(true);
            self.store(pointer, yes);
        }
        let wants_result = self.out.result.is_some() && self.is_outermost();
        if self.low.can().ends_at_discard || (self.loops == 0 && !wants_result) {
            self.statement(Statement::Kill);
            return Ok(());
        }
        let condition = self.boolean(true);
        let accept = self.in_block(|ctx| {
            ctx.statement(Statement::Kill);
            Ok(())
        })?;
        self.statement(Statement::If { condition, accept, reject: Block::new() });
        self.return_nothing()
    }

    /// Returns from the function without a value from the shader: with the outputs in an entry point, with a zero if
    /// a value is expected (§6.1: undefined).
    pub(super) fn return_nothing(&mut self) -> Try<()> {
        if self.is_entry {
            return self.return_outputs();
        }
        let value = match self.shader.function(self.id).ret {
            TypeId::VOID => None,
            ty => {
                let ty = self.low.value_type(ty)?;
                Some(self.zero(ty))
            }
        };
        self.statement(Statement::Return { value });
        Ok(())
    }

    /// Declares a local: as a name for its initializer if it is never written, otherwise as a variable.
    fn declare(&mut self, local: LocalId, initializer: Option<ExprId>) -> Try<()> {
        let declared = self.shader.function(self.id).local(local);
        if declared.kind == LocalKind::Const && declared.value.is_some() {
            return Ok(());
        }
        let value = match initializer {
            Some(initializer) => Some(self.value(initializer)?),
            None => None,
        };
        let facts = self.low.facts.function(self.id);
        let written = facts.and_then(|facts| facts.needs_variable.get(local.index())) != Some(&false);
        let literal = value.is_some_and(|value| {
            matches!(self.expressions()[value], Expression::Literal(_) | Expression::ZeroValue(_))
        });
        match value {
            Some(value) if !written && !self.in_switch && !literal => {
                let value = self.with_own_name(value, declared.ty);
                if !self.is_named(value) {
                    self.name(value, &declared.name);
                    self.flush();
                }
                self.set_slot(local, LocalSlot::Value(value));
            }
            // A variable's own initial value is set only once, before the function starts.
            Some(value) if literal && self.loops == 0 && !self.in_switch => {
                let ty = self.low.value_type(declared.ty)?;
                let variable = self.variable_with(&declared.name, ty, Some(value));
                self.set_slot(local, LocalSlot::Pointer(variable));
            }
            _ => {
                let variable = match self.slot(local) {
                    LocalSlot::Pointer(known) => known,
                    LocalSlot::Unset | LocalSlot::Value(_) => self.variable_of(&declared.name, declared.ty)?,
                };
                if let Some(value) = value {
                    self.store(variable, value);
                }
                self.set_slot(local, LocalSlot::Pointer(variable));
            }
        }
        Ok(())
    }

    /// A value that may have a second name: a conversion to its own type, which is written as the value.
    fn with_own_name(&mut self, value: Handle<Expression>, ty: TypeId) -> Handle<Expression> {
        let applies = self.low.can().names_conversions && self.low.conventions.floats == FloatWidth::Single;
        let is_value = matches!(self.low.types.get(ty), Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..));
        let (kind, convert) = match self.low.types.scalar_of(ty) {
            Some(Scalar::Float) => (naga::ScalarKind::Float, Some(4)),
            Some(Scalar::Int) => (naga::ScalarKind::Sint, Some(4)),
            Some(Scalar::Uint) => (naga::ScalarKind::Uint, Some(4)),
            Some(Scalar::Bool) => (naga::ScalarKind::Bool, Some(naga::BOOL_WIDTH)),
            None => return value,
        };
        if !applies || !is_value || !self.is_named(value) {
            return value;
        }
        self.add(Expression::As { expr: value, kind, convert })
    }

    /// `if .. else if .. else`, flattened if it is long.
    fn chain(&mut self, arms: &[(ExprId, Vec<Stmt>)], otherwise: &[Stmt]) -> Try<()> {
        let in_switch = std::mem::replace(&mut self.in_switch, false);
        let lowered = self.first_of(
            arms,
            &|ctx, (condition, _)| ctx.value(*condition),
            &|ctx, (_, body)| ctx.body(body),
            &|ctx| ctx.body(otherwise),
        );
        self.in_switch = in_switch;
        lowered
    }

    /// The body of the first arm whose condition holds, or `otherwise`.
    pub(super) fn first_of<A>(
        &mut self,
        arms: &[A],
        condition: Condition<'_, Self, A>,
        body: Body<'_, Self, A>,
        otherwise: &dyn Fn(&mut Self) -> Try<()>,
    ) -> Try<()> {
        if arms.len() <= NESTED_ARMS {
            return self.nested(arms, condition, body, otherwise);
        }
        let ty = self.low.value_type(TypeId::BOOL)?;
        let rest = self.variable("go_on", ty);
        let (yes, no) = (self.boolean(true), self.boolean(false));
        self.store(rest, yes);
        let mut chunks = arms.chunks(NESTED_ARMS).peekable();
        while let Some(chunk) = chunks.next() {
            let is_last = chunks.peek().is_none();
            let goes_on = self.load(rest);
            let accept = self.in_block(|ctx| {
                ctx.store(rest, no);
                ctx.nested(chunk, condition, body, &|ctx| {
                    if is_last {
                        return otherwise(ctx);
                    }
                    ctx.store(rest, yes);
                    Ok(())
                })
            })?;
            self.statement(Statement::If { condition: goes_on, accept, reject: Block::new() });
        }
        Ok(())
    }

    fn nested<A>(
        &mut self,
        arms: &[A],
        condition: Condition<'_, Self, A>,
        body: Body<'_, Self, A>,
        otherwise: &dyn Fn(&mut Self) -> Try<()>,
    ) -> Try<()> {
        let Some((arm, rest)) = arms.split_first() else { return otherwise(self) };
        let holds = condition(self, arm)?;
        let accept = self.in_block(|ctx| body(ctx, arm))?;
        let reject = self.in_block(|ctx| ctx.nested(rest, condition, body, otherwise))?;
        self.statement(Statement::If { condition: holds, accept, reject });
        Ok(())
    }
}

/// Evaluates the condition of an arm.
type Condition<'f, C, A> = &'f dyn Fn(&mut C, &A) -> Try<Handle<Expression>>;

/// Lowers the body of an arm.
type Body<'f, C, A> = &'f dyn Fn(&mut C, &A) -> Try<()>;
