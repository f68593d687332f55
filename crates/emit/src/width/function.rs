//! A function in another width, statement by statement.
//!
//! *In:* a function in f32, and the types of its expressions. *Out:* the function, with expressions of the other width and
//! conversions where its surroundings keep f32.
//!
//! *Holds:* what is emitted together stays together and in order, conversions right behind what they convert.

use super::Refusal;
use super::rewriter::Rewriter;
use naga::{Block, Expression, Function, Handle, Range, Span, Statement, SwitchCase};

impl Rewriter<'_, '_> {
    /// The function in the other width.
    pub(super) fn run(mut self) -> Result<Function, Refusal> {
        self.signature()?;
        for (handle, expression) in self.old.expressions.iter() {
            self.span = self.old.expressions.get_span(handle);
            let start = self.new.expressions.len();
            let value = self.expression(handle, expression)?;
            self.values.push(value);
            self.record(expression, start);
        }
        for (handle, variable) in self.old.local_variables.iter() {
            let init = variable.init.map(|init| self.value(init).handle);
            self.new.local_variables[handle].init = init;
        }
        for (&handle, name) in &self.old.named_expressions {
            self.new.named_expressions.insert(self.value(handle).handle, name.clone());
        }
        let mut body = Block::new();
        for range in std::mem::take(&mut self.prologue) {
            body.push(Statement::Emit(range), Span::UNDEFINED);
        }
        self.block(&self.old.body, &mut body)?;
        self.new.body = body;
        Ok(self.new)
    }

    fn signature(&mut self) -> Result<(), Refusal> {
        for (handle, variable) in self.old.local_variables.iter() {
            self.new.local_variables[handle].ty = self.widths.value_type(variable.ty)?;
        }
        if self.is_entry {
            return Ok(());
        }
        for argument in &mut self.new.arguments {
            argument.ty = self.widths.value_type(argument.ty)?;
        }
        if let Some(result) = &mut self.new.result {
            result.ty = self.widths.value_type(result.ty)?;
        }
        Ok(())
    }

    /// Remembers which new expressions an old one became, from `start` on.
    fn record(&mut self, old: &Expression, start: usize) {
        let range = self.made_since(start);
        if !is_free(old) {
            self.emitted.push(range);
            return;
        }
        self.prologue.extend(range);
        self.emitted.push(None);
    }

    /// The new expressions from `start` on that have to be emitted.
    fn made_since(&self, start: usize) -> Option<Range<Expression>> {
        let made: Vec<Handle<Expression>> = self
            .new
            .expressions
            .iter()
            .skip(start)
            .filter(|(_, one)| !is_free(one))
            .map(|(handle, _)| handle)
            .collect();
        Some(Range::new_from_bounds(*made.first()?, *made.last()?))
    }

    /// A block, statement by statement.
    fn block(&mut self, old: &Block, into: &mut Block) -> Result<(), Refusal> {
        for (statement, span) in old.span_iter() {
            self.span = *span;
            self.statement(statement, into)?;
        }
        Ok(())
    }

    fn inside(&mut self, old: &Block) -> Result<Block, Refusal> {
        let mut block = Block::new();
        self.block(old, &mut block)?;
        Ok(block)
    }

    fn statement(&mut self, old: &Statement, into: &mut Block) -> Result<(), Refusal> {
        let span = self.span;
        let of = |rewriter: &Self, handle: &Handle<Expression>| rewriter.value(*handle).handle;
        let new = match old {
            Statement::Emit(range) => {
                for handle in range.clone() {
                    if let Some(range) = self.emitted.get(handle.index()).cloned().flatten() {
                        into.push(Statement::Emit(range), span);
                    }
                }
                return Ok(());
            }
            Statement::Block(block) => Statement::Block(self.inside(block)?),
            Statement::If { condition, accept, reject } => Statement::If {
                condition: of(self, condition),
                accept: self.inside(accept)?,
                reject: self.inside(reject)?,
            },
            Statement::Switch { selector, cases } => Statement::Switch {
                selector: of(self, selector),
                cases: cases
                    .iter()
                    .map(|case| Ok(SwitchCase { body: self.inside(&case.body)?, ..case.clone() }))
                    .collect::<Result<_, Refusal>>()?,
            },
            Statement::Loop { body, continuing, break_if } => {
                let (body, continuing) = (self.inside(body)?, self.inside(continuing)?);
                Statement::Loop { body, continuing, break_if: break_if.as_ref().map(|one| of(self, one)) }
            }
            Statement::Return { value: Some(value) } if self.is_entry => {
                Statement::Return { value: Some(self.in_single(*value, into)) }
            }
            Statement::Return { value } => Statement::Return { value: value.as_ref().map(|one| of(self, one)) },
            Statement::Store { pointer, value } => {
                let target = self.value(*pointer);
                let value = if target.kept { self.in_single(*value, into) } else { of(self, value) };
                Statement::Store { pointer: target.handle, value }
            }
            Statement::Call { function, arguments, result } => Statement::Call {
                function: *function,
                arguments: arguments.iter().map(|one| of(self, one)).collect(),
                result: result.as_ref().map(|one| of(self, one)),
            },
            Statement::Break | Statement::Continue | Statement::Kill => old.clone(),
            _ => return Err("it contains a statement that no vertex or fragment stage has".into()),
        };
        into.push(new, span);
        Ok(())
    }

    /// A value in f32, converted in front of the statement that uses it.
    fn in_single(&mut self, old: Handle<Expression>, into: &mut Block) -> Handle<Expression> {
        let start = self.new.expressions.len();
        let handle = self.single(old);
        if let Some(range) = self.made_since(start) {
            into.push(Statement::Emit(range), self.span);
        }
        handle
    }
}

/// Whether an expression takes effect without being emitted.
fn is_free(expression: &Expression) -> bool {
    expression.needs_pre_emit() || matches!(expression, Expression::CallResult(_))
}
