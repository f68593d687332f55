//! Texture functions (§8.7) on textures and samplers apart.

use super::function::Ctx;
use super::{Try, unsupported};
use crate::builtin::BuiltinFunction;
use crate::hir::ExprId;
use naga::{Expression, Handle};

impl Ctx<'_, '_> {
    /// A call of a texture function.
    pub(super) fn texture_call(&mut self, function: BuiltinFunction, arguments: &[ExprId]) -> Try<Handle<Expression>> {
        let _ = arguments;
        Err(unsupported(self.here(), format!("`{}` is not lowered yet", function.name())))
    }
}
