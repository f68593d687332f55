//! [`Project`]: what the server asks the program about files: which form a program, how they are completed, what is configured.
//!
//! *Holds:* the answers are those of `glisten lint`. The server reads no file and no configuration by itself.

use glisten_format::{Formatted, Options};
use glisten_front::diagnostic::{Code, Diagnostic};
use glisten_front::index::Inspection;
use glisten_front::link::Program;
use glisten_front::source::{FileId, SourceMap};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The texts of open documents, which count instead of the files.
#[derive(Clone, Debug, Default)]
pub struct Overlay(Arc<Mutex<BTreeMap<PathBuf, Arc<str>>>>);

impl Overlay {
    /// The text of an open document.
    pub fn text(&self, path: &Path) -> Option<Arc<str>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).get(path).cloned()
    }

    /// Opens, changes or closes a document.
    pub fn set(&self, path: &Path, text: Option<Arc<str>>) {
        let mut texts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match text {
            Some(text) => texts.insert(path.to_owned(), text),
            None => texts.remove(path),
        };
    }

    /// Closes all documents.
    pub(crate) fn clear(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }
}

/// The files of a program, by a key that tells programs apart.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProgramKey {
    /// The name of the program.
    pub name: String,
    /// The files, in the order of the pipeline.
    pub files: Vec<PathBuf>,
}

/// A compiled program, with or without errors.
pub struct Compiled {
    /// The texts.
    pub sources: SourceMap,
    /// The findings, with the levels that the configuration gives them.
    pub findings: Vec<Diagnostic>,
    /// The things that names denote.
    pub inspection: Inspection,
    /// The linked program, if there are no errors.
    pub program: Option<Program>,
    /// The files of each source: its own, then those that it includes.
    pub read: Vec<Vec<FileId>>,
}

/// A shader in a string of a document of another language.
pub struct Piece {
    /// The inside of the string.
    pub inside: Range<usize>,
    /// The text of the shader, as long as the document, with everything else blank.
    pub text: Arc<str>,
    /// The name of its program.
    pub program: String,
    /// Whether `//` begins a comment outside of the string, too.
    pub has_own_comments: bool,
}

/// A macro that conditions ask for and no text defines.
pub struct Choice {
    /// Its name.
    pub name: String,
    /// The values that make a difference; nothing for a macro that is not defined.
    pub values: Vec<Option<String>>,
    /// The value that is shown.
    pub chosen: Option<String>,
}

/// The next step with a picture, or with the reason why there is none.
pub type Drawn = Box<dyn FnOnce(Result<PathBuf, String>) + Send>;

/// The answers besides findings.
pub trait Shown {
    /// The macros that the conditions of these texts ask for.
    fn asked(&mut self, texts: &[(String, Arc<str>)]) -> Vec<Choice>;

    /// Defines a macro from outside, or takes the definition back. It counts after [`Project::reload`].
    ///
    /// # Errors
    /// What is no name of a macro, or no value of one.
    fn choose(&mut self, name: &str, value: Option<String>) -> Result<(), String>;

    /// The macros that were defined so.
    fn chosen(&self) -> Vec<(String, String)>;

    /// A program in a language, by its stages.
    ///
    /// # Errors
    /// A language that does not exist, or cannot have the program.
    fn translation(&self, program: &Program, target: &str) -> Result<Vec<(String, String)>, String>;

    /// Draws a scene, and does something with the picture's file. It does not wait.
    fn picture(&self, scene: &Path, done: Drawn);

    /// Ends what is being drawn.
    fn end(&mut self);
}

/// The files, as the program knows them.
pub trait Project: Shown {
    /// The texts of open documents, which all other answers take into account.
    fn overlay(&self) -> &Overlay;

    /// The shaders in the strings of a document; nothing for one that is a shader itself.
    fn pieces(&self, file: &Path, text: &str) -> Option<Vec<Piece>>;

    /// Formats the shaders in the strings of a document.
    fn format_pieces(&mut self, file: &Path, text: &str, style: &Options) -> String;

    /// The programs of which a file is a source of its own.
    fn programs_of(&mut self, file: &Path) -> Vec<ProgramKey>;

    /// The programs in a folder and below it that may include a file, likely ones first.
    fn includers_of(&mut self, file: &Path, folders: &[PathBuf]) -> Vec<ProgramKey>;

    /// The programs in a folder and below it that may include a file and use one of these words, and whether there are more.
    fn users_of(&mut self, file: &Path, folders: &[PathBuf], words: &[&str]) -> (Vec<ProgramKey>, bool);

    /// Notes that the include directives of an open document changed.
    fn includes_changed(&mut self, file: &Path);

    /// Programs in a folder and below it that together have all files with a wanted word. The search ends when there are `most`.
    fn programs_with(&mut self, folder: &Path, is_wanted: &dyn Fn(&str) -> bool, most: usize) -> Vec<ProgramKey>;

    /// A file alone, for one that belongs to no program.
    fn alone(&mut self, file: &Path) -> ProgramKey;

    /// Compiles a program, and lints it.
    fn compile(&mut self, program: &ProgramKey) -> Compiled;

    /// Judges by runs what one program's findings say about numbers, if a program waits for it. Its key, if that changed its findings.
    fn find_witnesses(&mut self) -> Option<ProgramKey>;

    /// Compiles one file up to where `text` ends, with a name in it about which more is wanted.
    fn probe(&mut self, program: &ProgramKey, file: &Path, text: Arc<str>, probe: Option<&str>) -> Option<Compiled>;

    /// The style of a file, or `None` if the configuration is wrong.
    fn style(&mut self, file: &Path) -> Option<Options>;

    /// Formats the text of a file.
    fn format(&mut self, file: &Path, text: &str, style: &Options) -> Formatted;

    /// The findings in configurations themselves, by the texts that they are in.
    fn configuration_findings(&mut self) -> Vec<(SourceMap, Vec<Diagnostic>)>;

    /// The configuration files that the answers so far depend on, whether they exist or not.
    fn configurations(&self) -> Vec<PathBuf>;

    /// Forgets what was read of configurations and folders.
    fn reload(&mut self);

    /// A file on disk with the text of an embedded module.
    fn embedded(&self, name: &str) -> Option<PathBuf>;

    /// A file on disk with the page of a code.
    fn explained(&self, code: &'static Code) -> Option<PathBuf>;

    /// The names of files that an include in a file could name, with or without angle brackets.
    fn include_names(&mut self, file: &Path, written: &str, angled: bool) -> Vec<String>;

    /// The scene files in these folders, with their texts; unless `fresh`, those of a moment ago will do.
    fn scenes(&mut self, folders: &[PathBuf], fresh: bool) -> Vec<(PathBuf, Arc<str>)>;

    /// Whether a finding says that a file lacks what the files that include it have.
    fn is_about_a_part(&self, finding: &Diagnostic) -> bool;
}
