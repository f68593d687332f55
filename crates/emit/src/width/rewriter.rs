//! [`Rewriter`]: a function while its width changes.
//!
//! *In:* a function in f32, and the types of its expressions. *Out:* the operands of expressions and statements: what an old
//! expression became, in the other width or in f32.

use super::Widths;
use super::types::contains_float;
use naga::valid::FunctionInfo;
use naga::{ArraySize, Bytes, Expression, Function, Handle, Range, ScalarKind, Span, TypeInner};

/// The result of rewriting an expression.
#[derive(Clone, Copy, Debug)]
pub(super) struct Value {
    pub(super) handle: Handle<Expression>,
    /// Whether it is an aggregate in f32, or a pointer to f32.
    pub(super) kept: bool,
}

/// A function on its way to another width.
pub(super) struct Rewriter<'w, 'm> {
    pub(super) widths: &'w mut Widths<'m>,
    pub(super) old: &'m Function,
    pub(super) info: &'m FunctionInfo,
    /// Whether its parameters and its result are the stage's interface.
    pub(super) is_entry: bool,
    pub(super) new: Function,
    /// The results for the old expressions.
    pub(super) values: Vec<Value>,
    /// The new expressions that are emitted where the old one was.
    pub(super) emitted: Vec<Option<Range<Expression>>>,
    /// Conversions of what needs no emission, at the start of the body.
    pub(super) prologue: Vec<Range<Expression>>,
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
}
