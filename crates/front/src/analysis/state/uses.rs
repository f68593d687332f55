//! [`Uses`]: where something is used first.

use super::arrays::{ArrayKey, ArrayUses};
use crate::hir::GlobalId;
use crate::source::Span;
use rustc_hash::FxHashMap;

/// The first uses so far.
#[derive(Debug, Default)]
pub(in crate::analysis) struct Uses {
    globals: FxHashMap<GlobalId, Span>,
    /// Members of input and output blocks without an instance name.
    members: FxHashMap<(GlobalId, u32), Span>,
    /// The elements that are used of arrays without a size (§4.1.9).
    arrays: ArrayUses,
}

impl Uses {
    /// Notes a use of a global.
    pub(in crate::analysis) fn note(&mut self, global: GlobalId, span: Span) {
        self.globals.entry(global).or_insert(span);
    }

    /// Notes a use of a member of a block without an instance name.
    pub(in crate::analysis) fn note_member(&mut self, block: GlobalId, member: u32, span: Span) {
        self.members.entry((block, member)).or_insert(span);
    }

    /// Notes the use of an element of an array.
    pub(in crate::analysis) fn note_element(&mut self, array: ArrayKey, index: u32, span: Span) {
        self.arrays.note(array, index, span);
    }

    /// The first use of a global.
    pub(in crate::analysis) fn first(&self, global: GlobalId) -> Option<Span> {
        self.globals.get(&global).copied()
    }

    /// The first use of a member of a block without an instance name.
    pub(in crate::analysis) fn first_of_member(&self, block: GlobalId, member: u32) -> Option<Span> {
        self.members.get(&(block, member)).copied()
    }

    /// The largest index of an array, and its position.
    pub(in crate::analysis) fn largest_index(&self, array: ArrayKey) -> Option<(u32, Span)> {
        self.arrays.largest(array)
    }

    /// Whether the current function uses elements of local arrays without a size.
    pub(in crate::analysis) fn any_local_array(&self) -> bool {
        self.arrays.any_local()
    }

    /// Forgets the locals at the end of a function.
    pub(in crate::analysis) fn end_function(&mut self) {
        self.arrays.end_function();
    }
}
