//! Judges what may overtake what: reads, stores and calls.

use super::effects::{Class, Effects, Root, root};
use super::plan::Planner;
use naga::{Expression, Function, Handle};

/// The effect of a statement after its operands are evaluated.
#[derive(Clone, Copy)]
pub(super) enum Effect<'s> {
    None,
    Store(Option<Root>),
    Call { function: Handle<Function>, arguments: &'s [Handle<Expression>] },
}

impl Planner<'_> {
    /// Whether an effect changes what an expression reads, or the other way round.
    pub(super) fn is_overtaken(&self, one: Handle<Expression>, effect: Effect<'_>) -> bool {
        match effect {
            Effect::None => false,
            Effect::Store(None) => false,
            Effect::Store(Some(root)) => match self.class(one) {
                Class::Load(read, _) => read == root,
                Class::Call => self.touches(one, root, true),
                _ => false,
            },
            Effect::Call { function, arguments } => match self.class(one) {
                Class::Load(read, _) => self.call_touches(function, arguments, read, false),
                Class::Call => self.is_effectful(one) || self.of(function).writes,
                _ => false,
            },
        }
    }

    fn of(&self, function: Handle<Function>) -> Effects {
        self.effects.get(function.index()).copied().unwrap_or(Effects { writes: true, reads: true })
    }

    fn is_effectful(&self, call: Handle<Expression>) -> bool {
        let call = self.calls.get(call.index()).copied().flatten();
        call.is_none_or(|(function, _)| self.of(function).writes)
    }

    /// Whether a call reads or writes what a root leads to; `reads` says whether reading counts.
    fn call_touches(
        &self,
        function: Handle<Function>,
        arguments: &[Handle<Expression>],
        root_: Root,
        reads: bool,
    ) -> bool {
        let effects = self.of(function);
        let passed = || {
            let is_it = |argument: &Handle<Expression>| match self.function.expressions[*argument] {
                Expression::LocalVariable(_) | Expression::FunctionArgument(_) | Expression::GlobalVariable(_) => {
                    root(self.module, &self.function.expressions, *argument) == Some(root_)
                }
                _ => false,
            };
            arguments.iter().any(is_it)
        };
        match root_ {
            Root::Global(_) => effects.writes || (reads && effects.reads),
            Root::Local(_) | Root::Parameter(_) => passed(),
        }
    }

    fn touches(&self, call: Handle<Expression>, root: Root, reads: bool) -> bool {
        let call = self.calls.get(call.index()).copied().flatten();
        call.is_none_or(|(function, arguments)| self.call_touches(function, arguments, root, reads))
    }

    /// Whether two atoms must stay in their order.
    pub(super) fn conflict(&self, one: Handle<Expression>, other: Handle<Expression>) -> bool {
        match (self.class(one), self.class(other)) {
            (Class::Call, Class::Call) => {
                let (Some((first, _)), Some((second, _))) =
                    (self.calls.get(one.index()).copied().flatten(), self.calls.get(other.index()).copied().flatten())
                else {
                    return true;
                };
                let (first, second) = (self.of(first), self.of(second));
                first.writes || second.writes
            }
            (Class::Call, Class::Load(root, _)) => self.touches(one, root, false),
            (Class::Load(root, _), Class::Call) => self.touches(other, root, false),
            _ => false,
        }
    }
}
