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
    /// The scalars of all globals so far, other than uniforms.
    globals: u32,
    /// The scalars of all uniforms so far.
    uniforms: u32,
    /// The scalars of all locals of the current function.
    locals: u32,
    /// The number of globals that need a location or binding.
    bound: u32,
}

impl Default for Budget {
    fn default() -> Self {
        Self { steps: Cell::new(MAX_FOLD_STEPS), suggestions: 0, globals: 0, uniforms: 0, locals: 0, bound: 0 }
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

    /// Adds a global, if all of its kind then have at most `limit` scalars. Returns whether they have.
    pub(in crate::analysis) fn add_global(&mut self, scalars: u32, is_uniform: bool, limit: u32) -> bool {
        add(if is_uniform { &mut self.uniforms } else { &mut self.globals }, scalars, limit)
    }

    /// Adds a local, if all locals of the function then have at most `limit` scalars. Returns whether they have.
    pub(in crate::analysis) fn add_local(&mut self, scalars: u32, limit: u32) -> bool {
        add(&mut self.locals, scalars, limit)
    }

    /// Begins a function, which has no locals yet.
    pub(in crate::analysis) fn begin_function(&mut self) {
        self.locals = 0;
    }
}

/// Adds to a sum that stays within a limit. What does not fit is left out, so that what follows is judged without it.
fn add(sum: &mut u32, scalars: u32, limit: u32) -> bool {
    let next = sum.saturating_add(scalars);
    let fits = next <= limit;
    if fits {
        *sum = next;
    }
    fits
}
