//! [`Variants`]: the residuals of a program for a host that draws with many values.
//!
//! *In:* a program, and what is known of it, as often as a host asks. *Out:* a [`Variant`]: the residual, its modules and its
//! reflection. *Holds:* the same values give the same variant, whatever else the host sets; values that make the same residual
//! give the same variant, so a host keeps its pipelines by [`Variant::id`]. Several threads may ask at once.

use super::smallest::specialize_smallest;
use glisten_emit::{Conventions, Emitted, Reflection, Target, emit, reflect};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::link::Program;
use glisten_specialize::{Known, Options, Residual, optimize};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A residual of a program.
#[derive(Clone, Debug)]
pub struct Variant {
    id: usize,
    residual: Residual,
    program: Program,
}

impl Variant {
    /// Its number: equal residuals of one [`Variants`] have one.
    pub fn id(&self) -> usize {
        self.id
    }

    /// The residual: texts, and what was left out.
    pub fn residual(&self) -> &Residual {
        &self.residual
    }

    /// The module of a stage.
    ///
    /// # Errors
    /// What the target lacks, or that there is no such stage.
    pub fn module(&self, stage: Stage, target: Target, conventions: &Conventions) -> Result<Emitted, Vec<Diagnostic>> {
        emit(&self.program, stage, target, conventions)
    }

    /// Where the residual's inputs are. What it does not have is not there.
    pub fn reflection(&self, conventions: &Conventions) -> Reflection {
        reflect(&self.program, conventions)
    }
}

#[derive(Debug, Default)]
struct Cache {
    /// By the values that may decide something.
    by_values: BTreeMap<String, Arc<Variant>>,
    /// By the texts of the residual.
    by_texts: BTreeMap<Vec<String>, Arc<Variant>>,
}

/// The residuals of a program, cached.
#[derive(Debug)]
pub struct Variants {
    program: Program,
    cache: Mutex<Cache>,
}

impl Variants {
    /// None yet.
    pub fn new(program: Program) -> Self {
        Self { program, cache: Mutex::new(Cache::default()) }
    }

    /// The program that all of them are variants of.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The variant for what is known, if it was made before. This does not wait for one that is being made.
    pub fn made(&self, known: &Known) -> Option<Arc<Variant>> {
        let key = self.key(known);
        let cache = self.cache.try_lock().ok()?;
        cache.by_values.get(&key).cloned()
    }

    /// The variant for what is known.
    pub fn get(&self, known: &Known) -> Arc<Variant> {
        let key = self.key(known);
        if let Some(variant) = self.cache.lock().unwrap_or_else(PoisonError::into_inner).by_values.get(&key) {
            return Arc::clone(variant);
        }
        // Nobody waits for the lock while this is made; two threads that make the same agree.
        let residual = specialize_smallest(&self.program, known, &Options::default());
        let texts: Vec<String> = residual.stages.iter().map(|stage| stage.text.clone()).collect();
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let id = cache.by_texts.len();
        let made = || Arc::new(Variant { id, program: optimize(&residual.program), residual });
        let variant = Arc::clone(cache.by_texts.entry(texts).or_insert_with(made));
        cache.by_values.insert(key, Arc::clone(&variant));
        variant
    }

    /// How many residuals there are.
    pub fn len(&self) -> usize {
        self.cache.lock().unwrap_or_else(PoisonError::into_inner).by_texts.len()
    }

    /// Whether there is none yet.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The values that may decide something: those of inputs that the program reads.
    fn key(&self, known: &Known) -> String {
        let interface = &self.program.interface;
        let mut known = known.clone();
        let reads = |name: &String| interface.uniforms.iter().any(|leaf| leaf.active && leaf.name == *name);
        known.uniforms.retain(|name, _| reads(name));
        known.attributes.retain(|name, _| interface.attributes.iter().any(|one| one.active && one.name == *name));
        known.textures.retain(|name, _| interface.samplers.iter().any(|one| one.active && one.name == *name));
        // By bits: 0 and -0 differ in their texts, as do all other numbers.
        format!("{known:?}")
    }
}
