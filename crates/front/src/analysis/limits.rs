//! Limits on the sizes of types and variables. Beyond them, no target can bind or store the data.
//!
//! The minima of `gl_Max*` are not limits, since drivers have more. These limits are far above those of any driver.
//! They keep a short text from asking for gigabytes: structs that contain each other twice double in size with each
//! line.

use super::context::Analyzer;
use super::state::MAX_BOUND;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::types;
use crate::hir::{Storage, TypeId};
use crate::source::Span;

/// The largest number of scalars of one type, of all variables of a function, and of all non-uniform globals of a
/// shader.
const MAX_SCALARS: u32 = 1 << 20;

/// The largest number of scalars of all uniforms of a shader: 64 times what drivers have.
const MAX_UNIFORM_SCALARS: u32 = 1 << 18;

impl Analyzer<'_> {
    /// Checks that a type is small enough.
    pub(super) fn check_size(&mut self, ty: TypeId, span: Span) -> bool {
        self.check_fits(self.types.flat_len(ty) <= MAX_SCALARS, MAX_SCALARS, span)
    }

    /// Checks that a global still fits together with those before it.
    pub(super) fn check_global_size(&mut self, ty: TypeId, storage: Storage, is_block: bool, span: Span) -> bool {
        let limit = if storage == Storage::Uniform { MAX_UNIFORM_SCALARS } else { MAX_SCALARS };
        let is_bound = matches!(storage, Storage::In | Storage::Out) || is_block || self.types.contains_sampler(ty);
        if is_bound && !self.budget.add_bound() {
            self.report(
                Diagnostic::new(&types::TOO_LARGE, span, "this is too much for any target")
                    .here(format!("more than {MAX_BOUND} inputs, outputs, blocks and samplers")),
            );
            return false;
        }
        let fits = self.budget.add_global(self.types.flat_len(ty), storage == Storage::Uniform, limit);
        self.check_fits(fits, limit, span)
    }

    /// Checks that a local still fits together with those before it.
    pub(super) fn check_local_size(&mut self, ty: TypeId, span: Span) -> bool {
        let fits = self.budget.add_local(self.types.flat_len(ty), MAX_SCALARS);
        self.check_fits(fits, MAX_SCALARS, span)
    }

    fn check_fits(&mut self, fits: bool, limit: u32, span: Span) -> bool {
        if !fits {
            self.report(
                Diagnostic::new(&types::TOO_LARGE, span, "this is too large for any target")
                    .here(format!("makes it more than {limit} numbers")),
            );
        }
        fits
    }
}
