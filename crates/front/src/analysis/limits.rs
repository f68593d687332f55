//! Limits on the sizes of types and variables. Beyond them, no target can bind or store the data.
//!
//! The minima of `gl_Max*` are not limits, since drivers have more. These limits are far above those of any driver.
//! They keep a short text from asking for gigabytes: structs that contain each other twice double in size with each
//! line.

use super::context::Analyzer;
use super::layout::Layout;
use super::state::MAX_BOUND;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{qualifiers, types};
use crate::hir::{ArraySize, Storage, Type, TypeId};
use crate::source::Span;

/// The largest number of scalars of one type, of all variables of a function, and of all non-uniform globals of a
/// shader.
const MAX_SCALARS: u32 = 1 << 20;

/// The largest number of scalars of all uniforms of a shader: 64 times what drivers have.
const MAX_UNIFORM_SCALARS: u32 = 1 << 18;

/// The texture units, and the binding points of uniform blocks. Drivers have some hundreds of the first, and fewer of the second.
const MAX_BINDINGS: u32 = 1 << 10;

/// The locations of uniforms: one for each scalar that uniforms may have. Drivers have up to a hundred thousand.
const MAX_UNIFORM_LOCATIONS: u32 = MAX_UNIFORM_SCALARS;

impl Analyzer<'_> {
    /// Checks that a uniform, a sampler or a block is below the last binding and the last location, with all elements of an array
    /// (GLSL 4.20 §4.4.4 and 4.4.5, 4.30 §4.4.3).
    pub(super) fn check_places(&mut self, layout: &Layout, ty: TypeId, is_block: bool) {
        let places = if is_block { self.blocks(ty) } else { self.types.leaves(ty) };
        self.check_last(layout.binding, "binding", places, MAX_BINDINGS);
        self.check_last(layout.host_location, "location", places, MAX_UNIFORM_LOCATIONS);
    }

    /// The number of blocks of a block's declaration: the elements of its array, or one.
    fn blocks(&self, ty: TypeId) -> u32 {
        match self.types.get(ty) {
            Type::Array(element, ArraySize::Sized(size)) => size.saturating_mul(self.blocks(element)),
            Type::Array(element, ArraySize::Unsized) => self.blocks(element),
            _ => 1,
        }
    }

    fn check_last(&mut self, place: Option<(u32, Span)>, name: &str, places: u32, limit: u32) {
        let Some((first, span)) = place else { return };
        let last = first.saturating_add(places.saturating_sub(1));
        if last >= limit {
            let message = format!("`{name} = {last}` is above the largest, {}", limit - 1);
            let here = if last == first { "too large".to_owned() } else { format!("the last of {places} has {last}") };
            self.report(Diagnostic::new(&qualifiers::LAYOUT_VALUE, span, message).here(here));
        }
    }

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
