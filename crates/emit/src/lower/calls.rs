//! Lowers calls of the shader's own functions (§6.1).
//!
//! *Holds:* arguments are evaluated left to right, each once. `out` and `inout` arguments are copied to and from
//! temporaries, in the order of the parameters. A whole local variable that no other argument mentions is its own
//! temporary, since nothing else can access it during the call.

use super::function::Ctx;
use super::places::Place;
use super::{Try, internal};
use glisten_front::hir::{ExprId, ExprKind, FunctionId, ParamMode, TypeId, VarRef};
use naga::{Expression, Handle};

/// An argument that is copied back after the call.
struct CopyBack {
    from: Handle<Expression>,
    from_ty: TypeId,
    to: Place,
    to_ty: TypeId,
}

impl Ctx<'_, '_> {
    /// Lowers a call; returns the result, if the function has one.
    pub(super) fn user_call(&mut self, id: FunctionId, arguments: &[ExprId]) -> Try<Option<Handle<Expression>>> {
        let callee = self.shader.function(id);
        let Some(lowered) = self.low.lowered(id).copied() else {
            return Err(internal(self.here(), format!("`{}` is called before it is lowered", callee.name)));
        };
        let mut values = Vec::new();
        let mut copies = Vec::new();
        for (index, (argument, param)) in arguments.iter().zip(callee.params()).enumerate() {
            if self.low.types.contains_sampler(param.ty) {
                for sampler in self.samplers_of(*argument)? {
                    values.push(sampler.texture);
                    values.extend(sampler.sampler);
                    values.extend(sampler.texel_count);
                }
            }
            if !self.low.has_value(param.ty) {
                continue;
            }
            let mode = callee.param_mode(index);
            if matches!(mode, ParamMode::In | ParamMode::ConstIn) {
                values.push(self.value(*argument)?);
            } else if let Some(pointer) = self.own_temporary(*argument, arguments, index, param.ty)? {
                values.push(pointer);
            } else {
                let to = self.target(*argument)?;
                let to_ty = self.shader.expr(*argument).ty;
                let temporary = self.variable_of(&param.name, param.ty)?;
                if mode == ParamMode::Inout {
                    let before = self.load_place(&to)?;
                    let before = self.converted(before, to_ty, param.ty);
                    self.store(temporary, before);
                }
                values.push(temporary);
                copies.push(CopyBack { from: temporary, from_ty: param.ty, to, to_ty });
            }
        }
        let result = self.call(lowered.handle, values, callee.ret != TypeId::VOID);
        for copy in copies {
            let value = self.load(copy.from);
            let value = self.converted(value, copy.from_ty, copy.to_ty);
            self.store_place(&copy.to, value)?;
        }
        Ok(result)
    }

    /// The pointer to a whole local variable that can be its own temporary.
    fn own_temporary(
        &mut self,
        argument: ExprId,
        arguments: &[ExprId],
        index: usize,
        ty: TypeId,
    ) -> Try<Option<Handle<Expression>>> {
        let expr = self.shader.expr(argument);
        let ExprKind::Var(VarRef::Local(local)) = expr.kind else { return Ok(None) };
        let others = arguments.iter().enumerate().filter(|(other, _)| *other != index);
        if expr.ty != ty || others.into_iter().any(|(_, other)| self.names(*other, VarRef::Local(local))) {
            return Ok(None);
        }
        match self.place(argument)? {
            Place::Pointer(pointer, _) => Ok(Some(pointer)),
            _ => Ok(None),
        }
    }

    /// Whether the expression mentions the variable.
    fn names(&self, id: ExprId, var: VarRef) -> bool {
        let mut work = vec![id];
        while let Some(id) = work.pop() {
            let kind = &self.shader.expr(id).kind;
            if matches!(kind, ExprKind::Var(named) if *named == var) {
                return true;
            }
            work.extend(kind.children());
        }
        false
    }
}
