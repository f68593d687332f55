//! [`Parts`]: a source that several variants of a program read alike is read once.
//!
//! *In:* the sources of a program, and its variants. *Out:* their compilations. *Holds:* each is what the compiler makes of the variant
//! alone, with the same notes on what was read. What a source becomes depends on the macros that it asks for, and on what
//! stands before it: the table of types, and the places of the texts.

use super::shared::Shared;
use crate::trace::{self, Trace};
use crate::variants::Variant;
use glisten_front::compiler::{Before, Compilation, Compiler, Part, Source};
use std::collections::{BTreeSet, HashMap};
use std::sync::{Arc, Mutex, PoisonError};

/// The part that a source has added, and what was read for it.
struct Kept {
    part: Part,
    trace: Trace,
}

/// Parts by the number of the source, and what is before it.
type Known = HashMap<(usize, Before), Arc<Shared<Kept>>>;

/// The sources of a program so far.
pub(super) struct Parts<'a> {
    names: &'a BTreeSet<String>,
    variants: &'a [Variant],
    nothing_is_shared: bool,
    known: Mutex<Known>,
}

impl<'a> Parts<'a> {
    /// None yet. The arguments are those of [`Shared::new`].
    pub(super) fn new(names: &'a BTreeSet<String>, variants: &'a [Variant], nothing_is_shared: bool) -> Self {
        Self { names, variants, nothing_is_shared, known: Mutex::default() }
    }

    /// Compiles a variant, by a compiler with its macros.
    pub(super) fn compile(&self, compiler: &Compiler, sources: &[Source], variant: &Variant) -> Compilation {
        let mut begun = compiler.begin();
        for (number, source) in sources.iter().enumerate() {
            let shared = begun.before().map(|before| self.shared(number, before));
            let known = shared.as_ref().and_then(|shared| shared.find(variant));
            if let Some(kept) = known.filter(|kept| begun.add(&kept.part).is_ok()) {
                trace::again(&kept.trace);
                continue;
            }
            let (part, trace) = trace::recorded(|| compiler.read(&mut begun, source));
            trace::again(&trace);
            if let (Some(shared), Some(part)) = (shared, part) {
                let asked = part.asked().clone();
                shared.keep(variant, &asked, Kept { part, trace });
            }
        }
        compiler.end(begun, sources)
    }

    fn shared(&self, number: usize, before: Before) -> Arc<Shared<Kept>> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        let new = || Arc::new(Shared::new(self.names, self.variants, self.nothing_is_shared));
        Arc::clone(known.entry((number, before)).or_insert_with(new))
    }
}
