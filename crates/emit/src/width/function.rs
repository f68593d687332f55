//! A function in another width.
//!
//! *In:* a function in f32, and the types of its expressions. *Out:* the function, with expressions of the other width and
//! conversions where its surroundings keep f32.
//!
//! *Holds:* what is emitted together stays together and in order, conversions right behind what they convert.

use super::expressions::Value;
use super::types::contains_float;
use super::{Refusal, Widths};
use naga::valid::FunctionInfo;
use naga::{
    ArraySize, Block, Bytes, Expression, Function, Handle, Range, ScalarKind, Span, Statement, SwitchCase, TypeInner,
};

/// A function on its way to another width.
pub(super) struct Rewriter<'w, 'm> {
    pub(super) widths: &'w mut Widths<'m>,
    pub(super) old: &'m Function,
    pub(super) info: &'m FunctionInfo,
    /// Whether its parameters and its result are the stage's interface.
    is_entry: bool,
    pub(super) new: Function,
    /// The results for the old expressions.
    pub(super) values: Vec<Value>,
    /// The new expressions that are emitted where the old one was.
    emitted: Vec<Option<Range<Expression>>>,
    /// Conversions of what needs no emission, at the start of the body.
    prologue: Vec<Range<Expression>>,
    pub(super) span: Span,
}

impl<'w, 'm> Rewriter<'w, 'm> {
    pub(super) fn new(widths: &'w mut Widths<'m>, old: &'m Function, info: &'m FunctionInfo, is_entry: bool) -> Self {
        let new = Function {
            name: old.name.clone(),
            diagnostic_filter_leaf: old.diagnostic_filter_leaf,
            arguments: old.arguments.clone(),
            result: old.result.clone(),
            local_variables: old.local_variables.clone(),
            ..Function::default()
        };
        let (values, emitted, prologue) = (Vec::new(), Vec::new(), Vec::new());
        Self { widths, old, info, is_entry, new, values, emitted, prologue, span: Span::UNDEFINED }
    }

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

    /// The result for an old expression.
    pub(super) fn value(&self, old: Handle<Expression>) -> Value {
        // Operands come before what uses them.
        self.values[old.index()]
    }

    /// The type of an old expression.
    pub(super) fn inner(&self, old: Handle<Expression>) -> &'m TypeInner {
        let module: &'m naga::Module = self.widths.old;
        self.info[old].ty.inner_with(&module.types)
    }

    /// Whether an old expression is a value with floats.
    pub(super) fn is_float(&self, old: Handle<Expression>) -> bool {
        contains_float(&self.widths.old.types, self.inner(old))
    }

    pub(super) fn add(&mut self, expression: Expression) -> Handle<Expression> {
        self.new.expressions.append(expression, self.span)
    }

    /// An operand in f32.
    pub(super) fn single(&mut self, old: Handle<Expression>) -> Handle<Expression> {
        let Value { handle, kept } = self.value(old);
        if kept || !self.is_float(old) {
            return handle;
        }
        match self.inner(old) {
            // `gl_ClipDistance` is the one aggregate of an interface.
            TypeInner::Array { size: ArraySize::Constant(size), .. } => {
                let Some(ty) = self.info[old].ty.handle() else { return handle };
                let components = (0..size.get()).map(|index| {
                    let element = self.add(Expression::AccessIndex { base: handle, index });
                    self.to(4, element)
                });
                let components = components.collect();
                self.add(Expression::Compose { ty, components })
            }
            _ => self.to(4, handle),
        }
    }

    /// A scalar, vector or matrix of floats with so many bytes each.
    pub(super) fn to(&mut self, bytes: Bytes, expr: Handle<Expression>) -> Handle<Expression> {
        self.add(Expression::As { expr, kind: ScalarKind::Float, convert: Some(bytes) })
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
