//! [`Files`]: the texts that programs are made of, each once.
//!
//! *In:* compiled programs. *Out:* each file with its text and the stages that read it. *Holds:* a file that stages read as different
//! texts, because an older version has other words for them, or because it includes such a file, has a variant for each stage.

use super::conditions::Directive;
use super::{Compiled, Key};
use glisten_front::hir::Stage;
use glisten_front::source::SourceMap;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// A file.
#[derive(Clone, Debug)]
pub(super) struct File {
    /// Its text.
    pub(super) text: Arc<str>,
    /// The programs and stages that read it.
    pub(super) readers: BTreeSet<(usize, Stage)>,
    /// The programs that it is a source of.
    pub(super) source_of: BTreeSet<usize>,
}

impl File {
    /// The program that alone has this file, as one of its sources.
    pub(super) fn owner(&self) -> Option<usize> {
        let first = self.source_of.first().copied()?;
        let is_own = self.readers.iter().all(|(unit, _)| *unit == first) && self.readers.len() == 1;
        is_own.then_some(first)
    }

    /// Whether a stage reads it.
    pub(super) fn is_read_by(&self, stage: Stage) -> bool {
        self.readers.iter().any(|(_, other)| *other == stage)
    }
}

/// The files of a tree.
#[derive(Default)]
pub(super) struct Files {
    pub(super) all: BTreeMap<Key, File>,
    /// The names of files that have a variant for each stage.
    pub(super) split: BTreeSet<String>,
    /// The file that an include names, by the file that it is in and its path.
    pub(super) includes: BTreeMap<(String, String), String>,
}

/// The texts that the stages of a program read: for each text of the source map the stage, or none for those of the compiler.
pub(super) fn stages_of_texts(compiled: &Compiled<'_>) -> Vec<Option<Stage>> {
    let mut next = compiled.unit.sources.iter().peekable();
    let mut stage = None;
    let files = compiled.compilation.sources.files();
    files
        .map(|(_, file)| {
            if let Some(source) = next.next_if(|source| source.name == file.name()) {
                stage = Some(source.stage);
            }
            stage.filter(|_| !is_made(file.name()))
        })
        .collect()
}

/// Whether a text is no file: macros of the command line, what an engine adds, modules of glisten.
fn is_made(name: &str) -> bool {
    name.starts_with('<') || name == SourceMap::COMMAND_LINE
}

impl Files {
    /// The files of programs.
    ///
    /// # Errors
    /// A stage of two programs reads a file as two texts: the index of the later program, and the reason.
    pub(super) fn new(
        programs: &[Compiled<'_>],
        includes: BTreeMap<(String, String), String>,
    ) -> Result<Self, (usize, String)> {
        let mut texts: BTreeMap<String, BTreeMap<Stage, Arc<str>>> = BTreeMap::new();
        for compiled in programs {
            let stages = stages_of_texts(compiled);
            for ((_, file), stage) in compiled.compilation.sources.files().zip(&stages) {
                let Some(stage) = *stage else { continue };
                let known = texts.entry(file.name().to_owned()).or_default();
                let text = known.entry(stage).or_insert_with(|| Arc::clone(file.text()));
                if **text != **file.text() {
                    let what = "would become different texts for the programs that read it";
                    return Err((compiled.index, format!("`{}` {what}", file.name())));
                }
            }
        }
        let differs =
            |texts: &BTreeMap<Stage, Arc<str>>| texts.values().any(|text| Some(text) != texts.values().next());
        let mut split: BTreeSet<String> =
            texts.iter().filter(|(_, texts)| differs(texts)).map(|(name, _)| name.clone()).collect();
        // Who includes a file with variants has variants, too, if several stages read it.
        loop {
            let before = split.len();
            for ((from, _), to) in &includes {
                if split.contains(to) && texts.get(from).is_some_and(|texts| texts.len() > 1) {
                    split.insert(from.clone());
                }
            }
            if split.len() == before {
                break;
            }
        }
        let mut files = Self { all: BTreeMap::new(), split, includes };
        for compiled in programs {
            for ((_, file), stage) in compiled.compilation.sources.files().zip(stages_of_texts(compiled)) {
                let Some(stage) = stage else { continue };
                let text = Arc::clone(file.text());
                let new = File { text, readers: BTreeSet::new(), source_of: BTreeSet::new() };
                let one = files.all.entry(files.key(file.name(), stage)).or_insert(new);
                one.readers.insert((compiled.index, stage));
                let is_source =
                    compiled.unit.sources.iter().any(|source| source.name == file.name() && source.stage == stage);
                if is_source {
                    one.source_of.insert(compiled.index);
                }
            }
        }
        Ok(files)
    }

    /// A text of a file, whatever stage it is for.
    pub(super) fn any(&self, name: &str) -> Option<&str> {
        let mut texts = self.all.range((name.to_owned(), None)..);
        texts.next().filter(|((file, _), _)| file == name).map(|(_, file)| &*file.text)
    }

    /// The names of the files that a file includes.
    pub(super) fn included_by(&self, name: &str) -> impl Iterator<Item = &str> {
        self.paths_of(name).map(|(_, to)| to)
    }

    /// The name of the file that a directive includes.
    pub(super) fn included(&self, name: &str, directive: &Directive) -> Option<&str> {
        let rest = directive.rest().get(1..)?;
        let named = self.paths_of(name).filter(|(path, _)| rest.starts_with(path));
        named.max_by_key(|(path, _)| path.len()).map(|(_, to)| to)
    }

    /// The paths in the includes of a file, and the names of the files that they name.
    fn paths_of(&self, name: &str) -> impl Iterator<Item = (&str, &str)> {
        let all = self.includes.range((name.to_owned(), String::new())..);
        all.take_while(move |((from, _), _)| from == name).map(|((_, path), to)| (path.as_str(), to.as_str()))
    }

    /// The key of a file as a stage reads it.
    pub(super) fn key(&self, name: &str, stage: Stage) -> Key {
        (name.to_owned(), self.split.contains(name).then_some(stage))
    }
}
