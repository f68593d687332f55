//! [`Kept`]: programs that stay for the next time that the same texts are compiled, while another text around them changes.
//!
//! *In:* a compiler, sources, and the map that they are added to. *Out:* [`Shared`]: the program, of which everybody has the same one.
//! *Holds:* the result is that of [`Compiler::compile_into`]. All that it depends on is compared: the options, the levels, each source as it is
//! prepared, the files that its includes find, and the state of the map.

use super::{Compiler, Options, Prepared, Source};
use crate::diagnostic::{Diagnostics, Levels};
use crate::link::Program;
use crate::source::{Addition, IncludeForm, IncludeResolver, Included, SourceMap};
use std::sync::{Arc, Mutex, PoisonError};

/// How many programs are kept; the oldest goes first.
const MOST: usize = 64;

/// A resolver that several sources share.
type Resolver = Arc<dyn IncludeResolver + Send + Sync>;

/// Programs without errors that were compiled before.
#[derive(Debug, Default)]
pub struct Kept {
    entries: Vec<Entry>,
}

/// The result of a compilation whose program may be one that was kept.
#[derive(Clone, Debug)]
pub struct Shared {
    /// All texts, as in [`Compilation`](super::Compilation).
    pub sources: SourceMap,
    /// The linked program, if there are no errors.
    pub program: Option<Arc<Program>>,
    /// All diagnostics.
    pub diagnostics: Diagnostics,
}

/// A program, with all that it depends on.
#[derive(Debug)]
struct Entry {
    options: Options,
    levels: Option<Levels>,
    sources: Vec<Source>,
    prepared: Vec<Prepared>,
    asked: Vec<Question>,
    added: Addition,
    diagnostics: Diagnostics,
    program: Arc<Program>,
}

/// An include that was resolved for a source.
#[derive(Clone, Debug, PartialEq)]
struct Question {
    source: usize,
    path: String,
    form: IncludeForm,
    from: String,
    found: Result<Included, String>,
}

/// Resolves the includes of a source, and notes them.
struct Noting {
    source: usize,
    inner: Resolver,
    asked: Arc<Mutex<Vec<Question>>>,
}

impl IncludeResolver for Noting {
    fn resolve(&self, path: &str, form: IncludeForm, from: &str) -> Result<Included, String> {
        let found = self.inner.resolve(path, form, from);
        let question =
            Question { source: self.source, path: path.into(), form, from: from.into(), found: found.clone() };
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).push(question);
        found
    }

    fn remedy(&self, path: &str, from: &str) -> Option<String> {
        self.inner.remedy(path, from)
    }

    fn finds_no_text(&self, path: &str, form: IncludeForm, from: &str) -> bool {
        self.inner.finds_no_text(path, form, from)
    }
}

impl Entry {
    /// Whether a compilation of these sources has this result, wherever its texts are.
    fn is_of(&self, compiler: &Compiler, sources: &[Source], prepared: &[Prepared]) -> bool {
        let is_found_again = |question: &Question| {
            let own = prepared.get(question.source).and_then(|prepared| prepared.includes.as_ref());
            own.unwrap_or(&compiler.includes).resolve(&question.path, question.form, &question.from) == question.found
        };
        self.options == compiler.options
            && self.levels == compiler.levels
            && self.sources == sources
            && self.prepared.iter().zip(prepared).all(|(kept, now)| is_alike(kept, now))
            && self.asked.iter().all(is_found_again)
    }
}

/// Whether two preparations are the same, but for the resolver of includes.
fn is_alike(one: &Prepared, other: &Prepared) -> bool {
    one.text == other.text
        && one.defines == other.defines
        && one.completion == other.completion
        && one.problems.is_empty()
        && other.problems.is_empty()
}

impl Compiler {
    /// Compiles like [`Self::compile_into`], and keeps nothing.
    pub fn compile_shared(&self, map: SourceMap, sources: &[Source]) -> Shared {
        let compilation = self.compile_into(map, sources);
        let program = compilation.program.map(Arc::new);
        Shared { sources: compilation.sources, program, diagnostics: compilation.diagnostics }
    }

    /// Compiles like [`Self::compile_into`]. A program without errors is kept, and is the result again as long as nothing that it depends on
    /// changes.
    pub fn compile_kept(&self, mut map: SourceMap, sources: &[Source], kept: &mut Kept) -> Shared {
        let prepared: Vec<Prepared> = sources.iter().map(|source| self.prepared(source)).collect();
        let known = kept.entries.iter().filter(|entry| entry.is_of(self, sources, &prepared));
        for entry in known {
            if map.append(&entry.added) {
                let (program, diagnostics) = (Some(Arc::clone(&entry.program)), entry.diagnostics.clone());
                return Shared { sources: map, program, diagnostics };
            }
        }
        let before = map.mark();
        let (noting, asked) = self.noting(sources);
        let shared = noting.compile_shared(map, sources);
        if let Some(program) = &shared.program {
            let asked = std::mem::take(&mut *asked.lock().unwrap_or_else(PoisonError::into_inner));
            if kept.entries.len() >= MOST {
                kept.entries.remove(0);
            }
            kept.entries.push(Entry {
                options: self.options.clone(),
                levels: self.levels.clone(),
                sources: sources.to_vec(),
                prepared,
                asked,
                added: shared.sources.since(before),
                diagnostics: shared.diagnostics.clone(),
                program: Arc::clone(program),
            });
        }
        shared
    }

    /// This compiler, and the includes that it will resolve.
    fn noting(&self, sources: &[Source]) -> (Self, Arc<Mutex<Vec<Question>>>) {
        let asked = Arc::<Mutex<Vec<Question>>>::default();
        let (all, notes, own) = (sources.to_vec(), Arc::clone(&asked), self.includes());
        let noting = self.clone().with_change(move |source, prepared| {
            let index = all.iter().position(|other| other == source).unwrap_or(0);
            let inner = prepared.includes.clone().unwrap_or_else(|| Arc::clone(&own));
            let includes = Noting { source: index, inner, asked: Arc::clone(&notes) };
            Prepared { includes: Some(Arc::new(includes)), ..prepared }
        });
        (noting, asked)
    }
}

#[cfg(test)]
mod tests {
    use super::{Compiler, Kept, Options, Shared, Source};
    use crate::hir::Stage;
    use crate::source::{IncludeForm, IncludeResolver, Included, SourceMap};
    use std::sync::Arc;

    const VERTEX: &str = "#version 150\nin vec3 p;\nvoid main() { gl_Position = vec4(p, 1.0); }\n";
    const FRAGMENT: &str =
        "#version 150\n#include \"half\"\nout vec4 c;\nvoid main() { float never; c = vec4(HALF); }\n";

    /// An include with this text.
    struct Half(&'static str);

    impl IncludeResolver for Half {
        fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
            Ok(Included { name: path.into(), text: self.0.into() })
        }
    }

    fn compiled(kept: &mut Kept, scene: &str, half: &'static str, options: Options) -> Shared {
        let mut map = SourceMap::default();
        map.add_changing("scene", scene).expect("room");
        let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
        let sources = [source("a.vert", VERTEX, Stage::Vertex), source("a.frag", FRAGMENT, Stage::Fragment)];
        let compiler = Compiler::new(options).with_includes(Half(half));
        let plain = compiler.compile_into(map.clone(), &sources);
        let shared = compiler.compile_kept(map, &sources, kept);
        let told = |sources: &SourceMap, program, diagnostics| format!("{sources:?} {program:?} {diagnostics:?}");
        assert_eq!(
            told(&shared.sources, shared.program.as_deref(), &shared.diagnostics),
            told(&plain.sources, plain.program.as_ref(), &plain.diagnostics)
        );
        shared
    }

    #[test]
    fn a_program_stays_while_the_text_before_it_changes() {
        const HALF: &str = "#define HALF 0.5\n";
        let mut kept = Kept::default();
        let mut now = |scene: &str, half, options: Options| {
            compiled(&mut kept, scene, half, options).program.expect("there is no error")
        };
        let first = now("a = 1", HALF, Options::default());
        let is_first = |other: &_| Arc::ptr_eq(&first, other);
        assert!(is_first(&now("a = 1.25", HALF, Options::default())));
        assert!(!is_first(&now("a = 1", "#define HALF 0.25\n", Options::default())), "the include is another one");
        let defines = vec![("A".to_owned(), "1".to_owned())];
        assert!(!is_first(&now("a = 1", HALF, Options { defines, ..Options::default() })));
        assert!(!is_first(&now(&"a".repeat(5000), HALF, Options::default())), "its texts are elsewhere");
        assert!(is_first(&now("b = 1", HALF, Options::default())));
    }

    #[test]
    fn nothing_with_errors_is_kept() {
        let mut kept = Kept::default();
        for _ in 0..2 {
            assert!(compiled(&mut kept, "", "#define HALF nothing\n", Options::default()).program.is_none());
        }
        assert!(kept.entries.is_empty());
    }
}
