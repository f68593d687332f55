//! The programs of a tree, and its new texts: [`TreeProgram`], [`NewTree`].
//!
//! *In:* nothing. *Out:* the types that others read. *Holds:* an included file that each stage reads as another text gets a name for each.

use super::conditions::Conditions;
use crate::rewrite::applied;
use glisten_front::compiler::{Compiler, Source};
use glisten_front::hir::Stage;
use glisten_front::source::version_line;

/// A program of a tree.
#[derive(Clone)]
pub struct TreeProgram {
    /// Its compiler.
    pub compiler: Compiler,
    /// Its sources, each named like its file.
    pub sources: Vec<Source>,
}

/// A file with its new text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NewFile {
    /// The name of the file.
    pub name: String,
    /// The stage that the text is for, if each stage gets another one.
    pub stage: Option<Stage>,
    /// The text that was read.
    pub old: String,
    /// The new text.
    pub text: String,
    /// The programs that read it, by their indices.
    pub readers: Vec<usize>,
    /// Whether it is a source of a program, and not only included.
    pub is_source: bool,
    /// The paths in its includes that name files with other names now.
    pub(super) pointed: Vec<Pointed>,
    /// The stage of whoever includes it first.
    pub(super) first: Stage,
}

/// A path in an include whose file has another name now.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Pointed {
    pub(super) path: String,
    /// The folder that the file was moved to, next to the old one.
    pub(super) folder: Option<String>,
    /// Whether there is a file for each stage.
    pub(super) is_split: bool,
}

impl NewFile {
    /// The name of the new file: that of the old one, with the stage before its extension if each stage gets another text.
    pub fn new_name(&self) -> String {
        match self.stage.filter(|_| !self.is_source) {
            Some(stage) => of_stage(&self.name, stage),
            None => self.name.clone(),
        }
    }

    /// Lets its includes name the files that moved, and those for its stage.
    pub(super) fn point(&mut self) {
        let conditions = Conditions::new(&self.text);
        let mut edits = Vec::new();
        for one in conditions.list.iter().filter(|one| one.is_include()) {
            let named = self
                .pointed
                .iter()
                .find(|pointed| one.rest().get(1..).is_some_and(|rest| rest.starts_with(pointed.path.as_str())));
            let line = self.text.get(one.range.clone()).unwrap_or("");
            if let Some((pointed, at)) = named.and_then(|named| Some((named, line.find(named.path.as_str())?))) {
                let start = one.range.start + at;
                let moved = pointed.folder.as_deref().map(|folder| moved_path(&pointed.path, folder));
                let path = moved.unwrap_or_else(|| pointed.path.clone());
                let path = if pointed.is_split { of_stage(&path, self.first) } else { path };
                edits.push((start..start + pointed.path.len(), path));
            }
        }
        self.text = applied(&self.text, edits);
    }
}

/// The new text of an included file with its old `#version` line: an engine that ignores that line reads blanks instead.
pub fn with_version(old: &str, new: &str) -> String {
    let line = version_line(old).filter(|_| version_line(new).is_none());
    let blank =
        line.filter(|range| new.get(range.clone()).is_some_and(|text| text.trim().is_empty() && !text.is_empty()));
    let Some(range) = blank else { return new.to_owned() };
    let end = range.start + old.get(range.clone()).map_or(0, |line| line.trim_end().len());
    let [before, line, after] =
        [new.get(..range.start), old.get(range.start..end), new.get(end..)].map(Option::unwrap_or_default);
    format!("{before}{line}{after}")
}

/// A path with a folder before its file: `minecraft:older/fog.glsl`.
pub fn moved_path(path: &str, folder: &str) -> String {
    let at = path.rfind(['/', ':']).map_or(0, |at| at + 1);
    let (before, file) = path.split_at(at);
    format!("{before}{folder}/{file}")
}

/// The name of a file for one stage: `fog.frag.glsl`.
fn of_stage(name: &str, stage: Stage) -> String {
    let stage = match stage {
        Stage::Vertex => "vert",
        Stage::Fragment => "frag",
        Stage::Geometry => "geom",
    };
    let slash = name.rfind('/').map_or(0, |at| at + 1);
    match name.get(slash..).and_then(|file| file.rfind('.')) {
        Some(dot) => {
            format!("{}.{stage}{}", name.get(..slash + dot).unwrap_or(""), name.get(slash + dot..).unwrap_or(""))
        }
        None => format!("{name}.{stage}"),
    }
}

/// A sentence about a place.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Note {
    /// The name of the file.
    pub file: String,
    /// The line, counted from 1.
    pub line: u32,
    /// The sentence.
    pub text: String,
}

/// A tree with its new texts.
#[derive(Clone, Debug, Default)]
pub struct NewTree {
    /// The files of all programs that are rewritten.
    pub files: Vec<NewFile>,
    /// For each program the reason why it is left out.
    pub refused: Vec<Option<String>>,
    /// Sentences for the author.
    pub notes: Vec<Note>,
}
