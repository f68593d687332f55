//! `[[source]]` tables of `glisten.toml`: how the engine of a folder completes its sources.
//!
//! ```toml
//! [[source]]
//! glob = "assets/**"            # patterns of .gitignore, relative to this file; without them, all files below it
//! profile = "minecraft"         # an engine that glisten knows; `engine` is another name of the key
//! version = "330"               # of sources without a #version line
//! prelude = "prelude.glsl"      # text before each source; several as a list
//! includes = ["include"]        # folders to search for included files
//! defines = ["FAST", "N=4"]     # or { FAST = 1, N = 4 }
//! include-style = "moj"
//! stage = "fragment"            # of files whose names tell none
//! ```
//!
//! *In:* the tables. *Out:* a [`Rule`] each, and what is wrong with them. *Holds:* all tables that fit a file count; a later one
//! takes precedence, lists add up. Paths are relative to the file's folder.

use crate::arguments::stages::StageArg;
use crate::files;
use crate::variants::axes::define;
use clap::ValueEnum;
use glisten_front::diagnostic::codes::general::{BAD_CONFIG, FILE_NOT_FOUND};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::hir::Stage;
use glisten_front::source::{Prelude, Span};
use glisten_scene::tables::Reader;
use glisten_sources::engines::{self, Profile, Style};
use glisten_sources::parse_version;
use ignore::gitignore::{Gitignore, GitignoreBuilder};
use std::env;
use std::path::{Path, PathBuf};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The keys of a table.
pub(crate) const KEYS: &[&str] = &[
    "glob",
    "profile",
    "engine",
    "version",
    "prelude",
    "includes",
    "defines",
    "include-style",
    "include_style",
    "stage",
];

/// How the sources that it fits are completed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rule {
    /// The files that it fits; all files without it.
    patterns: Option<Gitignore>,
    pub(crate) profile: Option<&'static Profile>,
    pub(crate) version: Option<String>,
    pub(crate) preludes: Vec<Prelude>,
    pub(crate) includes: Vec<PathBuf>,
    pub(crate) defines: Vec<(String, String)>,
    pub(crate) style: Option<Style>,
    pub(crate) stage: Option<Stage>,
    /// A stage that there is not.
    pub(crate) unknown_stage: Option<String>,
}

impl Rule {
    /// Whether the rule is for this file.
    pub(crate) fn fits(&self, path: &Path) -> bool {
        self.patterns.as_ref().is_none_or(|patterns| {
            let absolute = files::real(path);
            absolute.starts_with(patterns.path()) && patterns.matched_path_or_any_parents(&absolute, false).is_ignore()
        })
    }
}

/// Reads tables, and reports what is wrong.
pub(crate) struct RuleReader<'a> {
    root: &'a Path,
    reader: &'a mut Reader,
}

impl<'a> RuleReader<'a> {
    /// A reader of the tables of the file in the folder `root`.
    pub(crate) fn new(root: &'a Path, reader: &'a mut Reader) -> Self {
        Self { root, reader }
    }

    fn wrong(&mut self, span: Span, message: impl Into<String>, help: Option<String>) {
        self.reader.report(Diagnostic::new(&BAD_CONFIG, span, message.into()).maybe_help(help));
    }

    /// The path of a file or a folder that a table names; an error if it is not there.
    fn path(&mut self, name: &str, span: Span) -> Option<PathBuf> {
        let path = self.root.join(name);
        // Shown as the user would write it, if it is below the working directory.
        let here = env::current_dir().ok();
        let shown = here.and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned)).unwrap_or(path);
        if shown.exists() {
            return Some(shown);
        }
        let message = format!("there is no `{}`", shown.display());
        self.reader.report(Diagnostic::new(&FILE_NOT_FOUND, span, message));
        None
    }

    /// The rules of the tables, after that of the version for all files.
    pub(crate) fn rules<'t, 'i: 't>(
        &mut self,
        version: Option<(String, Span)>,
        tables: impl Iterator<Item = &'t DeTable<'i>>,
    ) -> Vec<Rule> {
        let version = version.and_then(|version| self.version(version));
        let first = version.map(|version| Rule { version: Some(version), ..Rule::default() });
        first.into_iter().chain(tables.map(|table| self.rule(table))).collect()
    }

    fn version(&mut self, (version, span): (String, Span)) -> Option<String> {
        parse_version(&version).map_err(|message| self.wrong(span, message, None)).ok()
    }

    /// The rule of a table.
    fn rule(&mut self, table: &DeTable<'_>) -> Rule {
        let mut rule = Rule { patterns: self.patterns(table), ..Rule::default() };
        for key in ["profile", "engine"] {
            if let Some(name) = self.reader.text_at(table, key) {
                rule.profile = self.known(name, "profile", engines::find(name.0), engines::names());
            }
        }
        for key in ["include-style", "include_style"] {
            if let Some(name) = self.reader.text_at(table, key) {
                let names = engines::STYLES.iter().map(|row| row.name);
                rule.style = self.known(name, "include style", Style::named(name.0), names);
            }
        }
        if let Some(name) = self.reader.text_at(table, "stage") {
            let stage = StageArg::from_str(name.0, true).ok().map(Stage::from);
            rule.unknown_stage = stage.is_none().then(|| name.0.to_owned());
            rule.stage = self.known(name, "stage", stage, ["vertex", "fragment", "geometry"].into_iter());
        }
        rule.version = self.reader.version_at(table, "version").and_then(|version| self.version(version));
        rule.preludes = self.preludes(table);
        let folders = self.reader.texts_at(table, "includes");
        rule.includes = folders.into_iter().filter_map(|(name, span)| self.path(name, span)).collect();
        rule.defines = self.defines(table);
        rule
    }

    /// The value of a name, or an error with the nearest name.
    fn known<T>(
        &mut self,
        (name, span): (&str, Span),
        what: &str,
        value: Option<T>,
        names: impl Iterator<Item = &'static str>,
    ) -> Option<T> {
        if value.is_none() {
            let names: Vec<&str> = names.collect();
            let near = did_you_mean(name, names.iter().copied());
            let help = near.map_or(format!("there are {}", names.join(", ")), |near| format!("did you mean `{near}`?"));
            self.wrong(span, format!("there is no {what} `{name}`"), Some(help));
        }
        value
    }

    fn patterns(&mut self, table: &DeTable<'_>) -> Option<Gitignore> {
        table.get("glob")?;
        let mut patterns = GitignoreBuilder::new(self.root);
        for (pattern, span) in self.reader.texts_at(table, "glob") {
            if let Err(error) = patterns.add_line(None, pattern) {
                self.wrong(span, format!("not a pattern: {error}"), None);
            }
        }
        Some(patterns.build().unwrap_or_else(|_| Gitignore::empty()))
    }

    fn preludes(&mut self, table: &DeTable<'_>) -> Vec<Prelude> {
        let mut preludes = Vec::new();
        for (name, span) in self.reader.texts_at(table, "prelude") {
            let Some(path) = self.path(name, span) else { continue };
            match files::read_prelude(&path) {
                Ok(prelude) => preludes.push(prelude),
                Err(error) => self.reader.report(Diagnostic::new(error.code, span, error.message)),
            }
        }
        preludes
    }

    /// Macros: `"A"`, `["A", "B=2"]`, `{ A = 1 }`.
    fn defines(&mut self, table: &DeTable<'_>) -> Vec<(String, String)> {
        let mut read = Vec::new();
        if let Some(DeValue::Table(macros)) = table.get("defines").map(Spanned::get_ref) {
            for (name, node) in macros {
                let Some(name) = self.reader.macro_name(name) else { continue };
                read.extend(self.reader.macro_text(node, &name, ["0", "1"]).map(|value| (name, value)));
            }
            return read;
        }
        for (text, span) in self.reader.texts_at(table, "defines") {
            match define(text) {
                Ok(define) => read.push(define),
                Err(message) => self.wrong(span, message, Some("write `{ A = 1 }` or `[\"A\", \"B=2\"]`".into())),
            }
        }
        read
    }
}
