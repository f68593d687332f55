//! [`Begun`] and [`Part`]: sources are read one by one, so that compilations of several variants share what is equal.
//!
//! *In:* a compiler and its sources, in their order. *Out:* a [`Compilation`], as if each source had been read for it alone; and, of
//! a source without errors, the [`Part`] that it added. *Holds:* what a source adds depends on nothing but its text, the
//! macros that it asks for, what it includes, and the state [`Before`] it. Who keeps parts, and for how long, is the caller's affair.

use super::{Compilation, Compiler, Facts, Source, stem};
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::hir::Types;
use crate::index::{Inspection, View};
use crate::link::{Program, Understood};
use crate::source::{Addition, FileId, Mark, SourceMap};
use std::collections::BTreeSet;

/// A compilation that has read some of its sources.
#[derive(Debug)]
pub struct Begun {
    sources: SourceMap,
    types: Types,
    diagnostics: Diagnostics,
    shaders: Vec<Option<Understood>>,
    asked: BTreeSet<String>,
    read: Vec<Vec<FileId>>,
}

/// All that the reading of a source depends on besides the source, its includes and the options.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Before {
    types: Types,
    mark: Mark,
    diagnostics: usize,
}

/// The facts that a source without errors has added to a compilation.
#[derive(Clone, Debug)]
pub struct Part {
    sources: Addition,
    types: Types,
    diagnostics: Vec<Diagnostic>,
    shader: Understood,
    asked: BTreeSet<String>,
    read: Vec<FileId>,
}

impl Part {
    /// The [watched](super::Options::watched) names that it depends on.
    pub fn asked(&self) -> &BTreeSet<String> {
        &self.asked
    }
}

impl Begun {
    /// A compilation that has read nothing yet, and will add its texts to a map.
    pub(super) fn new(sources: SourceMap) -> Self {
        let (types, diagnostics) = (Types::new(), Diagnostics::default());
        Self { sources, types, diagnostics, shaders: Vec::new(), asked: BTreeSet::new(), read: Vec::new() }
    }

    /// The state that the reading of the next source depends on; none if there was an error, after which nothing is shared.
    pub fn before(&self) -> Option<Before> {
        let is_sound = !self.diagnostics.has_errors() && self.shaders.iter().all(Option::is_some);
        is_sound.then(|| Before {
            types: self.types.clone(),
            mark: self.sources.mark(),
            diagnostics: self.diagnostics.len(),
        })
    }

    /// Adds what a source has added to a compilation in the same state.
    ///
    /// # Errors
    /// This one is in another state; nothing is added.
    pub fn add(&mut self, part: &Part) -> Result<(), OtherState> {
        if !self.sources.append(&part.sources) {
            return Err(OtherState);
        }
        self.types.clone_from(&part.types);
        self.diagnostics.extend(part.diagnostics.iter().cloned());
        self.shaders.push(Some(part.shader.clone()));
        self.asked.extend(part.asked.iter().cloned());
        self.read.push(part.read.clone());
        Ok(())
    }

    /// Reads a source, which may add its views to what an observer keeps.
    pub(super) fn read(&mut self, compiler: &Compiler, source: &Source, facts: &mut Facts<'_>) {
        let Self { sources, types, diagnostics, shaders, .. } = self;
        shaders.push(compiler.shader(source, types, sources, diagnostics, facts));
    }

    /// Adds the facts that the sources have told.
    pub(super) fn told(&mut self, asked: BTreeSet<String>, read: Vec<Vec<FileId>>) {
        self.asked.extend(asked);
        self.read.extend(read);
    }

    /// Links what was read. `views` are those of an observer.
    pub(super) fn end(
        self,
        compiler: &Compiler,
        name: String,
        views: Option<Vec<Option<View>>>,
    ) -> (Compilation, Inspection) {
        let Self { sources, types, mut diagnostics, shaders, asked, read } = self;
        let inspected = views.map(|views| Inspection { types: types.clone(), views });
        let texts = shaders.iter().flatten().flat_map(|understood| understood.shader.texts.iter().cloned()).collect();
        let shaders: Option<Vec<Understood>> = shaders.into_iter().collect();
        let program: Option<Program> =
            shaders.and_then(|shaders| compiler.link(name.clone(), types, shaders, &mut diagnostics));
        if let Some(levels) = &compiler.levels {
            diagnostics.retain_mut(|diagnostic| levels.apply(&sources, diagnostic));
        }
        let compilation = Compilation { name, sources, program, texts, diagnostics, read, asked };
        (compilation, inspected.unwrap_or_default())
    }
}

/// A part of a compilation in another state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OtherState;

impl Compiler {
    /// Begins a compilation of which each source is read on its own: [`Self::read`], [`Begun::add`], [`Self::end`].
    pub fn begin(&self) -> Begun {
        Begun::new(SourceMap::default())
    }

    /// Reads a source. The result is what it has added, unless it has errors.
    pub fn read(&self, begun: &mut Begun, source: &Source) -> Option<Part> {
        let (before, is_sound) = (begun.sources.mark(), begun.before().is_some());
        let (kept, seen) = (begun.diagnostics.len(), begun.diagnostics.seen());
        let mut facts = Facts::default();
        begun.read(self, source, &mut facts);
        let Facts { asked, read, .. } = facts;
        let files = read.first().cloned().unwrap_or_default();
        begun.told(asked.clone(), read);
        let Begun { sources, types, diagnostics, shaders, .. } = &*begun;
        // Of what was dropped, nobody could tell what it would have hidden.
        let is_whole = diagnostics.len() - kept == diagnostics.seen() - seen;
        let is_shared = is_sound && is_whole && !diagnostics.has_errors() && !diagnostics.is_full();
        let shader = shaders.last()?.as_ref().filter(|_| is_shared)?;
        Some(Part {
            sources: sources.since(before),
            types: types.clone(),
            diagnostics: diagnostics.iter().skip(kept).cloned().collect(),
            shader: shader.clone(),
            asked,
            read: files,
        })
    }

    /// Links the sources that were read. The program is named after the first of them.
    pub fn end(&self, begun: Begun, sources: &[Source]) -> Compilation {
        let name = sources.first().map_or_else(String::new, |source| stem(&source.name));
        begun.end(self, name, None).0
    }
}

#[cfg(test)]
mod tests {
    use super::super::Options;
    use super::{Compiler, OtherState, Source};
    use crate::hir::Stage;

    const VERTEX: &str = "#version 150\nin vec3 p;\nout vec3 v;\nstruct S { float a; };\n#ifdef A\nuniform S s[2];\n#endif\n\
        void main() { v = p; gl_Position = vec4(p, 1.0); }\n";
    const FRAGMENT: &str = "#version 150\n#define TWICE(x) (2.0 * x)\nin vec3 v;\nout vec4 c;\n\
        void main() { float never; c = vec4(TWICE(v), B); }\n";

    fn sources() -> [Source; 2] {
        let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
        [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", FRAGMENT, Stage::Fragment)]
    }

    fn compiler(defines: &[(&str, &str)]) -> Compiler {
        let defines = defines.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
        let watched = ["A", "B", "C"].map(str::to_owned).to_vec();
        Compiler::new(Options { defines, watched, ..Options::default() })
    }

    #[test]
    fn parts_make_what_sources_make() {
        let sources = sources();
        let compiler = compiler(&[("B", "1.0")]);
        let whole = compiler.compile(&sources);
        let mut begun = compiler.begin();
        let parts: Vec<_> =
            sources.iter().map(|source| compiler.read(&mut begun, source).expect("no error is in it")).collect();
        assert_eq!(parts.iter().map(|part| part.asked().len()).collect::<Vec<_>>(), [1, 1]);
        let read = compiler.end(begun, &sources);
        let mut begun = compiler.begin();
        parts.iter().for_each(|part| begun.add(part).expect("the state is the same"));
        let added = compiler.end(begun, &sources);
        assert_eq!(format!("{whole:?}"), format!("{read:?}"));
        assert_eq!(format!("{whole:?}"), format!("{added:?}"));
    }

    #[test]
    fn a_part_fits_its_own_state_alone() {
        let sources = sources();
        let read = |defines: &[(&str, &str)]| {
            let compiler = compiler(defines);
            let mut begun = compiler.begin();
            let first = compiler.read(&mut begun, &sources[0]).expect("no error is in it");
            (begun.before(), first, begun)
        };
        let (plain, first, mut begun) = read(&[("B", "1.0")]);
        assert_eq!(plain, read(&[("B", "2.0"), ("C", "1")]).0);
        assert_ne!(plain, read(&[("A", "1"), ("B", "1.0")]).0, "the array is another type");
        assert_eq!(begun.add(&first), Err(OtherState));
    }

    #[test]
    fn nothing_of_a_source_with_errors_is_shared() {
        let mut begun = compiler(&[]).begin();
        assert!(compiler(&[]).read(&mut begun, &sources()[1]).is_none(), "B is not declared");
        assert_eq!(begun.before(), None);
    }
}
