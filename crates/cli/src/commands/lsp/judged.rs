//! Findings on numerics in the language server: they are told with inputs that show them, once the editor rests.
//!
//! *In:* a program and its findings. *Out:* the findings that a run shows. *Holds:* a run takes longer than an edit may, so what needs one
//! waits until nothing else is to be done, and is not told before. What was found counts as long as the texts of the program stay.

use crate::arguments::bounds::Bounds;
use crate::inputs::Group;
use crate::witness::{self, Case, has_ranges, is_judged};
use glisten_front::compiler::Compiler;
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_lsp::{Overlay, ProgramKey};
use glisten_verify::scene::{DiskFiles, FileError, FileSource};
use std::collections::BTreeMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash, Hasher};
use std::path::Path;

/// By how much less inputs are tried than by `glisten lint`.
const HASTE: u64 = 4;
/// The most programs whose judgements are kept.
const MOST_KEPT: usize = 64;

/// The findings that were judged, and the programs that wait for it.
#[derive(Default)]
pub(crate) struct Judged {
    /// The findings of programs, by the digests of their texts.
    known: BTreeMap<ProgramKey, (u64, Vec<Diagnostic>)>,
    waiting: Vec<ProgramKey>,
}

/// The files of a program: what is open in the editor, and the others on the disk.
pub(crate) struct OpenFiles(pub(crate) Overlay);

impl FileSource for OpenFiles {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        let open = self.0.text(Path::new(path));
        open.map_or_else(|| DiskFiles.read(path), |text| Ok(text.as_bytes().to_vec()))
    }
}

/// A program to judge.
pub(crate) struct Judging<'a> {
    pub(crate) group: &'a Group,
    pub(crate) program: &'a Program,
    pub(crate) sources: &'a SourceMap,
    pub(crate) ranges: &'a [(String, Bounds)],
}

impl Judged {
    /// The findings of a program, as far as they are judged. Those that wait are not among them.
    pub(crate) fn told(&mut self, key: &ProgramKey, case: &Judging<'_>, found: Vec<Diagnostic>) -> Vec<Diagnostic> {
        if !found.iter().any(is_judged) && !has_ranges(case.program, case.sources, case.ranges) {
            self.known.remove(key);
            return found;
        }
        let digest = digest(case.sources);
        match self.known.get(key) {
            Some((known, findings)) if *known == digest => findings.clone(),
            _ => {
                if !self.waiting.contains(key) {
                    self.waiting.push(key.clone());
                }
                found.into_iter().filter(|one| !is_judged(one)).collect()
            }
        }
    }

    /// A program that waits.
    pub(crate) fn next(&mut self) -> Option<ProgramKey> {
        self.waiting.pop()
    }

    /// Judges the findings of a program. Whether they are others than those that were told.
    pub(crate) fn find_witnesses(
        &mut self,
        key: &ProgramKey,
        case: &Judging<'_>,
        (compiler, files): (&Compiler, &dyn FileSource),
        wanted: impl Fn(&Code) -> bool,
        found: Vec<Diagnostic>,
    ) -> bool {
        let told = found.iter().filter(|one| !is_judged(one)).count();
        let Judging { group, program, sources, ranges } = *case;
        let case = Case { group, program, sources, ranges, compiler, files, haste: HASTE };
        let (findings, _) = witness::settle(&case, wanted, found);
        let is_news = findings.len() != told;
        if self.known.len() >= MOST_KEPT {
            self.known.clear();
        }
        self.known.insert(key.clone(), (digest(sources), findings));
        is_news
    }

    /// Forgets everything: other files or settings count.
    pub(crate) fn clear(&mut self) {
        *self = Self::default();
    }
}

fn digest(sources: &SourceMap) -> u64 {
    let mut hasher = DefaultHasher::new();
    for (_, file) in sources.files() {
        file.name().hash(&mut hasher);
        file.text().hash(&mut hasher);
    }
    hasher.finish()
}
