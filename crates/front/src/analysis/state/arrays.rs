//! Which elements of arrays without a size the shader uses (§4.1.9).
//!
//! *In:* constant indices, as the traversal meets them. *Out:* the largest for each array, and its position.

use crate::hir::{GlobalId, LocalId};
use crate::source::Span;
use rustc_hash::FxHashMap;

/// An array that may still lack a size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(in crate::analysis) enum ArrayKey {
    /// A global.
    Global(GlobalId),
    /// A member of a global that is a block or an array of blocks.
    Member(GlobalId, u32),
    /// A local of the current function.
    Local(LocalId),
}

/// For each array without a size, the largest constant index, and its position.
#[derive(Debug, Default)]
pub(in crate::analysis) struct ArrayUses {
    globals: FxHashMap<ArrayKey, (u32, Span)>,
    /// The same map for the locals of the current function.
    locals: FxHashMap<LocalId, (u32, Span)>,
}

impl ArrayUses {
    /// Notes the use of an element.
    pub(in crate::analysis) fn note(&mut self, key: ArrayKey, index: u32, at: Span) {
        let entry = match key {
            ArrayKey::Local(id) => self.locals.entry(id).or_insert((index, at)),
            ArrayKey::Global(_) | ArrayKey::Member(..) => self.globals.entry(key).or_insert((index, at)),
        };
        if entry.0 < index {
            *entry = (index, at);
        }
    }

    /// The largest index, and its position.
    pub(in crate::analysis) fn largest(&self, key: ArrayKey) -> Option<(u32, Span)> {
        match key {
            ArrayKey::Local(id) => self.locals.get(&id).copied(),
            ArrayKey::Global(_) | ArrayKey::Member(..) => self.globals.get(&key).copied(),
        }
    }

    /// Whether the current function uses elements of such a local.
    pub(in crate::analysis) fn any_local(&self) -> bool {
        !self.locals.is_empty()
    }

    /// Forgets the locals at the end of a function.
    pub(in crate::analysis) fn end_function(&mut self) {
        self.locals.clear();
    }
}
