//! Lowers `==` of matrices, arrays and structs (§5.7, §5.9): inline for matrices, through a generated function for
//! the others.

use super::function::Ctx;
use super::{Lower, Try};
use glisten_front::hir::{ArraySize, Type, TypeId};
use naga::{BinaryOperator, Expression, Handle, Statement};
use rustc_hash::FxHashMap;

/// The functions generated so far.
#[derive(Debug, Default)]
pub(super) struct Helpers {
    equal: FxHashMap<TypeId, Handle<naga::Function>>,
}

impl Ctx<'_, '_> {
    /// `==` (or `!=`) of two values of any type; the result is one `bool`.
    pub(super) fn whole_equal(
        &mut self,
        left: Handle<Expression>,
        right: Handle<Expression>,
        ty: TypeId,
        equal: bool,
    ) -> Try<Handle<Expression>> {
        match self.low.types.get(ty) {
            Type::Matrix(..) => {
                let (column_ty, lefts) = self.columns(left, ty)?;
                let (_, rights) = self.columns(right, ty)?;
                let join = if equal { BinaryOperator::LogicalAnd } else { BinaryOperator::LogicalOr };
                let mut result = None;
                for (left, right) in lefts.into_iter().zip(rights) {
                    let column = self.vector_equal(left, right, column_ty, equal);
                    result = Some(match result {
                        Some(before) => self.op(join, before, column),
                        None => column,
                    });
                }
                Ok(result.unwrap_or_else(|| self.boolean(equal)))
            }
            Type::Struct(_) | Type::Array(..) => {
                let helper = self.low.equal_helper(ty)?;
                let Some(result) = self.call(helper, vec![left, right], true) else {
                    return Err(self.internal_error("a comparison without a result"));
                };
                Ok(if equal { result } else { self.not(result) })
            }
            _ => Ok(self.vector_equal(left, right, ty, equal)),
        }
    }

    /// `for index in 0..len`, with the index as a `uint`.
    pub(super) fn count_to(
        &mut self,
        len: u32,
        body: impl FnOnce(&mut Self, Handle<Expression>) -> Try<()>,
    ) -> Try<()> {
        let counter = self.variable_of("index", TypeId::UINT)?;
        let zero = self.uint(0);
        self.store(counter, zero);
        let block = self.in_block(|ctx| {
            let index = ctx.load(counter);
            let end = ctx.uint(len);
            let done = ctx.op(BinaryOperator::GreaterEqual, index, end);
            let mut leave = naga::Block::new();
            leave.push(Statement::Break, naga::Span::UNDEFINED);
            ctx.statement(Statement::If { condition: done, accept: leave, reject: naga::Block::new() });
            body(ctx, index)
        })?;
        let continuing = self.in_block(|ctx| {
            let index = ctx.load(counter);
            let one = ctx.uint(1);
            let next = ctx.op(BinaryOperator::Add, index, one);
            ctx.store(counter, next);
            Ok(())
        })?;
        self.statement(Statement::Loop { body: block, continuing, break_if: None });
        Ok(())
    }
}

impl Lower<'_> {
    fn equal_helper(&mut self, ty: TypeId) -> Try<Handle<naga::Function>> {
        if let Some(known) = self.helpers.equal.get(&ty) {
            return Ok(*known);
        }
        let value_ty = self.value_type(ty)?;
        let result = self.value_type(TypeId::BOOL)?;
        let name = format!("equal_{}", self.types.name(ty).replace(['[', ']'], "_"));
        let mut ctx = Ctx::helper(self, name.trim_end_matches('_'));
        ctx.out.result = Some(naga::FunctionResult { ty: result, binding: None });
        let left = ctx.argument("left", value_ty, None);
        let right = ctx.argument("right", value_ty, None);
        let equal = match ctx.low.types.get(ty) {
            Type::Array(element, ArraySize::Sized(len)) => ctx.equal_elements(left, right, value_ty, (element, len))?,
            _ => ctx.equal_members(left, right, ty)?,
        };
        ctx.statement(Statement::Return { value: Some(equal) });
        let (out, low) = ctx.finish();
        let handle = low.module.functions.append(out, naga::Span::UNDEFINED);
        low.helpers.equal.insert(ty, handle);
        Ok(handle)
    }
}

impl Ctx<'_, '_> {
    fn equal_members(
        &mut self,
        left: Handle<Expression>,
        right: Handle<Expression>,
        ty: TypeId,
    ) -> Try<Handle<Expression>> {
        let Type::Struct(id) = self.low.types.get(ty) else { return Err(self.internal_error("a struct was expected")) };
        let mut result = None;
        for number in 0..self.low.types.structure(id).members.len() as u32 {
            let Some(index) = self.low.member_index(ty, number) else { continue };
            let member_ty = self.low.member_type(ty, number);
            let left = self.add(Expression::AccessIndex { base: left, index });
            let right = self.add(Expression::AccessIndex { base: right, index });
            let equal = self.whole_equal(left, right, member_ty, true)?;
            result = Some(match result {
                Some(before) => self.op(BinaryOperator::LogicalAnd, before, equal),
                None => equal,
            });
        }
        Ok(result.unwrap_or_else(|| self.boolean(true)))
    }

    fn equal_elements(
        &mut self,
        left: Handle<Expression>,
        right: Handle<Expression>,
        value_ty: Handle<naga::Type>,
        (element, len): (TypeId, u32),
    ) -> Try<Handle<Expression>> {
        // Not every target can index an argument with a variable.
        let left_copy = self.variable("left_array", value_ty);
        let right_copy = self.variable("right_array", value_ty);
        self.store(left_copy, left);
        self.store(right_copy, right);
        let result = self.variable_of("equal", TypeId::BOOL)?;
        let yes = self.boolean(true);
        self.store(result, yes);
        self.count_to(len, |ctx, index| {
            let left = ctx.add(Expression::Access { base: left_copy, index });
            let left = ctx.load(left);
            let right = ctx.add(Expression::Access { base: right_copy, index });
            let right = ctx.load(right);
            let equal = ctx.whole_equal(left, right, element, true)?;
            let before = ctx.load(result);
            let both = ctx.op(BinaryOperator::LogicalAnd, before, equal);
            ctx.store(result, both);
            Ok(())
        })?;
        Ok(self.load(result))
    }
}
