//! [`Memo`]: a stage that several programs have alike is optimized once and emitted once.
//!
//! *In:* linked programs of one run, with the same conventions. *Out:* what the optimizer and the writers make of their stages.
//! *Holds:* a result is found by the digest of all that it is made from, and is made from nothing else. A stage of GLSL depends on
//! the others, and so does one before a geometry stage: these are made each time.

use crate::digest::{Content, Digest, of_structure};
use glisten_emit::{self as emit, Conventions, Emitted, Target};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::{Shader, Stage, Types};
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_specialize as specialize;
use std::collections::HashMap;
use std::sync::{Arc, PoisonError, RwLock};

/// The stages that are known so far.
#[derive(Default)]
pub(crate) struct Memo {
    optimized: Known<Shader>,
    emitted: Known<Content>,
}

impl Memo {
    /// The program without what reaches no output.
    pub(crate) fn optimized(&self, program: &Program) -> Program {
        let types = of_structure(&program.types);
        specialize::optimize_by(program, &|_: &Types, shader, live| {
            let make = || Ok(specialize::without_unreached(&program.types, shader, live));
            let known: Result<_, ()> = self.optimized.get(of_structure(&(types, shader, live)), make);
            let Ok(known) = known else { return shader.clone() };
            // Where a shader comes from is no part of the digest.
            let (texts, origin) = (shader.texts.clone(), shader.origin.clone());
            Shader { texts, origin, ..(*known).clone() }
        })
    }

    /// The code of a stage.
    ///
    /// # Errors
    /// Those of the writer.
    pub(crate) fn code(
        &self,
        program: &Program,
        stage: Stage,
        target: Target,
        conventions: &Conventions,
        sources: &SourceMap,
    ) -> Result<Content, Vec<Diagnostic>> {
        let make = |program: &Program| {
            emit::emit_traced(program, stage, target, conventions, Some(sources)).map(|traced| code(traced.emitted))
        };
        let part = program.stage(stage).zip(emit::interface_of(program, stage, target));
        let Some((shader, interface)) = part else { return make(program) };
        // Comments and names of files come from the texts.
        let reads_texts = target.is_text() || conventions.debug_lines;
        let texts = reads_texts.then_some((sources, &shader.texts));
        let key = of_structure(&(target.word(), shader, &program.types, &interface, texts));
        let make_alone = || {
            let (name, types, stages) = (program.name.clone(), program.types.clone(), vec![shader.clone()]);
            make(&Program { name, types, stages, interface })
        };
        self.emitted.get(key, make_alone).map(|known| (*known).clone())
    }
}

/// The bytes of what was emitted.
pub(crate) fn code(emitted: Emitted) -> Content {
    Content::from(emitted.into_bytes())
}

/// Results by the digest of what they are made from.
struct Known<T>(RwLock<HashMap<Digest, Arc<T>>>);

impl<T> Default for Known<T> {
    fn default() -> Self {
        Self(RwLock::default())
    }
}

impl<T> Known<T> {
    /// The result that is known, or else is made now. Two threads may make the same at once.
    fn get<E>(&self, key: Digest, make: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E> {
        let known = self.0.read().unwrap_or_else(PoisonError::into_inner).get(&key).map(Arc::clone);
        if let Some(known) = known {
            return Ok(known);
        }
        let made = Arc::new(make()?);
        self.0.write().unwrap_or_else(PoisonError::into_inner).insert(key, Arc::clone(&made));
        Ok(made)
    }
}
