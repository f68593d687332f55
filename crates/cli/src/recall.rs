//! [`Recall`]: compiles a program, or takes it from a cache.
//!
//! *In:* the options of a command, a group of files, a cache. *Out:* a [`Unit`], compiled or recalled; what was compiled is
//! kept. *Holds:* the key of a program has every flag that may change its outputs, so that a new flag cannot be forgotten: it
//! is the text of all of them. Standard input is never kept.

use crate::arguments::args::{BindingArgs, SourceArgs};
use crate::arguments::engine::Engines;
use crate::cache::{Cache, CacheArgs, Kept};
use crate::console::Console;
use crate::digest::Digest;
use crate::exit::Failure;
use crate::inputs::Group;
use crate::outputs::{Output, OutputPlan};
use crate::session::{Fresh, Unit, compile_group};
use crate::trace::{self, Trace};
use glisten_front::compiler::Compiler;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::general::INTERNAL;
use std::fs;
use std::path::Path;

/// A cache with the options of a command.
pub(crate) struct Recall {
    cache: Option<Cache>,
    engines: Engines,
    options: String,
    /// Whether results with errors are kept, too.
    keeps_errors: bool,
}

impl Recall {
    /// The cache of a command.
    ///
    /// # Errors
    /// A size or an address that is none.
    pub(crate) fn new(
        args: &CacheArgs,
        engines: &Engines,
        sources: &SourceArgs,
        bindings: &BindingArgs,
        plan: &OutputPlan,
    ) -> Result<Self, Failure> {
        let options = format!("{} {plan:?}", compiler_options(sources, bindings));
        Ok(Self { cache: Cache::open(args, engines.clone())?, engines: engines.clone(), options, keeps_errors: false })
    }

    /// The cache of `lint`, whose results have no outputs. `options` is all that findings depend on besides the compiler.
    ///
    /// # Errors
    /// A size or an address that is none.
    pub(crate) fn of_findings(
        args: &CacheArgs,
        engines: &Engines,
        sources: &SourceArgs,
        bindings: &BindingArgs,
        options: &str,
    ) -> Result<Self, Failure> {
        let options = format!("{} lint {options}", compiler_options(sources, bindings));
        Ok(Self { cache: Cache::open(args, engines.clone())?, engines: engines.clone(), options, keeps_errors: true })
    }

    /// Takes a program from the cache, or compiles it. `variant` tells apart programs that differ in their compilers.
    pub(crate) fn compile(&self, compiler: &Compiler, group: Group, variant: &str) -> (Unit, usize) {
        self.compile_by(group, variant, |group| compile_group(compiler, group))
    }

    /// The same, compiled by `by`.
    pub(crate) fn compile_by(
        &self,
        group: Group,
        variant: &str,
        by: impl FnOnce(Group) -> (Unit, usize),
    ) -> (Unit, usize) {
        let Some((cache, key)) = self.cache.as_ref().and_then(|cache| Some((cache, self.key(cache, &group, variant)?)))
        else {
            return by(group);
        };
        if let Some(kept) = cache.find(key) {
            return recalled(group, kept);
        }
        let ((mut unit, dropped), trace) = trace::recorded(|| by(group));
        let diagnostics = unit.batch.diagnostics.clone();
        let is_whole = unit.unread.is_empty() && !diagnostics.iter().any(|one| *one.code == INTERNAL);
        let is_kept = if self.keeps_errors { is_whole } else { unit.program.is_some() };
        unit.fresh = is_kept.then_some(Fresh { key, trace, diagnostics, dropped });
        (unit, dropped)
    }

    /// Keeps what was made of a program, if it was compiled.
    pub(crate) fn keep(&self, unit: &Unit, outputs: &[Output], notes: &[Diagnostic]) {
        self.keep_all(unit, &Trace::default(), outputs, notes);
    }

    /// Keeps what was found in a program, if it was compiled, which depends on what `trace` has, too.
    pub(crate) fn keep_found(&self, unit: &Unit, trace: &Trace, notes: &[Diagnostic]) {
        self.keep_all(unit, trace, &[], notes);
    }

    fn keep_all(&self, unit: &Unit, more: &Trace, outputs: &[Output], notes: &[Diagnostic]) {
        let (Some(cache), Some(fresh)) = (&self.cache, &unit.fresh) else { return };
        let kept = Kept {
            outputs: outputs.to_vec(),
            sources: unit.batch.sources.clone(),
            diagnostics: fresh.diagnostics.clone(),
            notes: notes.to_vec(),
            dropped: fresh.dropped,
            asked: unit.asked.clone(),
            read: unit.read.clone(),
        };
        cache.keep(fresh.key, &fresh.trace.with(more), &kept);
    }

    /// Tells what went wrong with the cache, and cleans it.
    pub(crate) fn close(&self, console: &Console) {
        if let Some(cache) = &self.cache {
            cache.close(console);
        }
    }

    /// The earlier result of a scene, or else a place for a new one.
    pub(crate) fn scene(&self, path: &str, options: &str) -> (Option<Kept>, Option<Digest>) {
        let Some(cache) = &self.cache else { return (None, None) };
        let key = cache.key(&[&self.options, "scene", path, options, &self.folder_that_matters([Path::new(path)])]);
        (cache.find(key), Some(key))
    }

    /// Keeps what was made of a scene.
    pub(crate) fn keep_scene(&self, key: Option<Digest>, trace: &Trace, kept: &Kept) {
        if let (Some(cache), Some(key)) = (&self.cache, key) {
            cache.keep(key, trace, kept);
        }
    }

    fn key(&self, cache: &Cache, group: &Group, variant: &str) -> Option<Digest> {
        if group.inputs.iter().any(|input| input.path.is_none()) {
            return None;
        }
        let here = self.folder_that_matters(group.inputs.iter().filter_map(|input| input.path.as_deref()));
        Some(cache.key(&[&self.options, &format!("{group:?}"), variant, &here]))
    }

    /// The working folder, if an engine may look into the folders above, whose names then matter.
    fn folder_that_matters<'a>(&self, files: impl IntoIterator<Item = &'a Path>) -> String {
        let folder_of = |path: &Path| path.parent().map(Path::to_owned).filter(|folder| !folder.as_os_str().is_empty());
        let mut folders = files.into_iter().map(|path| folder_of(path).unwrap_or_else(|| ".".into()));
        let is_bound =
            self.engines.is_engine_given() || folders.any(|folder| self.engines.trace_of_rules(&folder).is_some());
        let here = if is_bound { std::env::current_dir().unwrap_or_default() } else { Default::default() };
        here.to_string_lossy().into_owned()
    }
}

/// Everything that a compiler is told.
fn compiler_options(sources: &SourceArgs, bindings: &BindingArgs) -> String {
    let preludes: Vec<Option<Digest>> =
        sources.preludes.iter().map(|path| fs::read(path).ok().map(|bytes| Digest::of(&bytes))).collect();
    format!("{sources:?} {preludes:?} {bindings:?}")
}

/// A program as the cache has it.
fn recalled(group: Group, mut kept: Kept) -> (Unit, usize) {
    let mut unit = Unit::new(group);
    unit.batch.sources = std::mem::take(&mut kept.sources);
    unit.batch.diagnostics = std::mem::take(&mut kept.diagnostics);
    unit.asked = std::mem::take(&mut kept.asked);
    unit.read = std::mem::take(&mut kept.read);
    let dropped = kept.dropped;
    unit.kept = Some(kept);
    (unit, dropped)
}
