//! [`Budget`]: how much time, and how many variables, a shader may still take.
//!
//! *Holds:* a short text cannot ask for gigabytes or minutes.

use std::cell::Cell;

/// How many scalars the constants of a shader may read and make; it takes some tenths of a second.
const MAX_FOLD_STEPS: u64 = 1 << 26;

/// How many times the analysis searches for a name similar to an unknown one.
const MAX_SUGGESTIONS: usize = 64;

/// How many names all these searches may compare.
const MAX_COMPARED: usize = 1 << 17;

/// The largest number of inputs, outputs, blocks and samplers of a shader. Each needs a location or binding, and no
/// target has more than a thousand of any kind.
pub(in crate::analysis) const MAX_BOUND: u32 = 4096;

/// How much a shader has taken so far, and may still take.
#[derive(Debug)]
pub(in crate::analysis) struct Budget {
    /// The steps that constant evaluation may still take.
    steps: Cell<u64>,
    suggestions: usize,
    /// The scalars of all globals so far.
    globals: u32,
    /// The scalars of all locals of the current function.
    locals: u32,
    /// The number of globals that need a location or binding.
    bound: u32,
}

impl Default for Budget {
    fn default() -> Self {
        Self { steps: Cell::new(MAX_FOLD_STEPS), suggestions: 0, globals: 0, locals: 0, bound: 0 }
    }
}

impl Budget {
    /// The steps that constant evaluation may still take.
    pub(in crate::analysis) fn steps(&self) -> &Cell<u64> {
        &self.steps
    }

    /// Whether constant evaluation may take no more steps.
    pub(in crate::analysis) fn is_exhausted(&self) -> bool {
        self.steps.get() == 0
    }

    /// Takes steps from constant evaluation.
    pub(in crate::analysis) fn spend(&self, steps: u64) {
        self.steps.set(self.steps.get().saturating_sub(steps));
    }

    /// Whether to search for names similar to an unknown one, among this many: each search compares it with all.
    pub(in crate::analysis) fn may_suggest(&mut self, names: usize) -> bool {
        self.suggestions += 1;
        self.suggestions <= MAX_SUGGESTIONS && self.suggestions.saturating_mul(names) <= MAX_COMPARED
    }

    /// Adds a global that needs a location or binding. Returns whether there is one left for it.
    pub(in crate::analysis) fn add_bound(&mut self) -> bool {
        self.bound += 1;
        self.bound <= MAX_BOUND
    }

    /// Adds a global. Returns the scalars of all of them.
    pub(in crate::analysis) fn add_global(&mut self, scalars: u32) -> u32 {
        self.globals = self.globals.saturating_add(scalars);
        self.globals
    }

    /// Adds a local. Returns the scalars of all locals of the function.
    pub(in crate::analysis) fn add_local(&mut self, scalars: u32) -> u32 {
        self.locals = self.locals.saturating_add(scalars);
        self.locals
    }

    /// Begins a function, which has no locals yet.
    pub(in crate::analysis) fn begin_function(&mut self) {
        self.locals = 0;
    }
}
