//! `[[source]]` tables of `glisten.toml`: how the engine of a folder completes its sources.
//!
//! ```toml
//! [[source]]
//! glob = "assets/**"            # patterns of .gitignore, relative to this file; without them, all files below it
//! profile = "minecraft"         # an engine that glisten knows
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

use super::args::parse_define;
use super::files;
use super::stages::StageArg;
use crate::engines::{self, Profile, Style};
use crate::sources::parse_version;
use clap::ValueEnum;
use glisten_front::diagnostic::codes::general::{BAD_CONFIG, FILE_NOT_FOUND};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_front::hir::Stage;
use glisten_front::source::{Prelude, Span};
use ignore::gitignore::{Gitignore, GitignoreBuilder};
use indexmap::IndexMap;
use serde::Deserialize;
use std::env;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

/// A string or a list of strings.
#[derive(Deserialize)]
#[serde(untagged, expecting = "a string, or a list of strings")]
enum Strings {
    One(String),
    Many(Vec<String>),
}

/// Macros: `"A"`, `["A", "B=2"]`, `{ A = 1 }`.
#[derive(Deserialize)]
#[serde(untagged, expecting = "macros: `[\"A\", \"B=2\"]` or `{ A = 1, B = 2 }`")]
enum Defines {
    Texts(Strings),
    Table(IndexMap<String, toml::Value>),
}

/// A `[[source]]` table.
#[derive(Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub(super) struct SourceTable {
    glob: Option<Spanned<Strings>>,
    profile: Option<Spanned<String>>,
    version: Option<Spanned<String>>,
    prelude: Option<Spanned<Strings>>,
    includes: Option<Spanned<Strings>>,
    defines: Option<Spanned<Defines>>,
    #[serde(alias = "include_style")]
    include_style: Option<Spanned<String>>,
    stage: Option<Spanned<String>>,
}

/// How the sources that it fits are completed.
#[derive(Clone, Debug, Default)]
pub(super) struct Rule {
    /// The files that it fits; all files without it.
    patterns: Option<Gitignore>,
    pub(super) profile: Option<&'static Profile>,
    pub(super) version: Option<String>,
    pub(super) preludes: Vec<Prelude>,
    pub(super) includes: Vec<PathBuf>,
    pub(super) defines: Vec<(String, String)>,
    pub(super) style: Option<Style>,
    pub(super) stage: Option<Stage>,
}

impl Rule {
    /// Whether the rule is for this file.
    pub(super) fn fits(&self, path: &Path) -> bool {
        self.patterns.as_ref().is_none_or(|patterns| {
            let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            absolute.starts_with(patterns.path()) && patterns.matched_path_or_any_parents(&absolute, false).is_ignore()
        })
    }
}

impl Strings {
    fn list(&self) -> &[String] {
        match self {
            Self::One(one) => std::slice::from_ref(one),
            Self::Many(many) => many,
        }
    }
}

/// Reads tables, and collects what is wrong.
pub(super) struct RuleReader<'a> {
    root: &'a Path,
    base: u32,
    pub(super) diagnostics: Vec<Diagnostic>,
}

impl<'a> RuleReader<'a> {
    /// A reader of the tables of the file in the folder `root`, whose text begins at the offset `base`.
    pub(super) fn new(root: &'a Path, base: u32) -> Self {
        Self { root, base, diagnostics: Vec::new() }
    }

    fn at(&self, range: Range<usize>) -> Span {
        Span::new(self.base + range.start as u32, self.base + range.end as u32)
    }

    fn wrong(&mut self, range: Range<usize>, message: impl Into<String>, help: Option<String>) {
        let diagnostic = Diagnostic::new(&BAD_CONFIG, self.at(range), message.into()).maybe_help(help);
        self.diagnostics.push(diagnostic);
    }

    /// The path of a file or a folder that a table names; an error if it is not there.
    fn path(&mut self, name: &str, range: Range<usize>) -> Option<PathBuf> {
        let path = self.root.join(name);
        // Shown as the user would write it, if it is below the working directory.
        let here = env::current_dir().ok();
        let shown = here.and_then(|here| path.strip_prefix(here).ok().map(Path::to_owned)).unwrap_or(path);
        if shown.exists() {
            return Some(shown);
        }
        let message = format!("there is no `{}`", shown.display());
        self.diagnostics.push(Diagnostic::new(&FILE_NOT_FOUND, self.at(range), message));
        None
    }

    /// The rules of the tables, after that of the version for all files.
    pub(super) fn rules(&mut self, version: Option<&Spanned<String>>, tables: &[SourceTable]) -> Vec<Rule> {
        let version = version.and_then(|version| self.version(version));
        let first = version.map(|version| Rule { version: Some(version), ..Rule::default() });
        first.into_iter().chain(tables.iter().map(|table| self.rule(table))).collect()
    }

    fn version(&mut self, version: &Spanned<String>) -> Option<String> {
        parse_version(version.get_ref()).map_err(|message| self.wrong(version.span(), message, None)).ok()
    }

    /// The rule of a table.
    fn rule(&mut self, table: &SourceTable) -> Rule {
        let mut rule = Rule { patterns: self.patterns(table.glob.as_ref()), ..Rule::default() };
        if let Some(name) = &table.profile {
            rule.profile = self.known(name, "profile", engines::find(name.get_ref()), engines::names());
        }
        if let Some(name) = &table.include_style {
            let names = engines::STYLES.iter().map(|row| row.name);
            rule.style = self.known(name, "include style", Style::named(name.get_ref()), names);
        }
        if let Some(name) = &table.stage {
            let stage = StageArg::from_str(name.get_ref(), true).ok().map(Stage::from);
            rule.stage = self.known(name, "stage", stage, ["vertex", "fragment", "geometry"].into_iter());
        }
        if let Some(version) = &table.version {
            rule.version = self.version(version);
        }
        if let Some(preludes) = &table.prelude {
            rule.preludes = self.preludes(preludes);
        }
        if let Some(folders) = &table.includes {
            let names = folders.get_ref().list();
            rule.includes = names.iter().filter_map(|name| self.path(name, folders.span())).collect();
        }
        if let Some(defines) = &table.defines {
            rule.defines = self.defines(defines);
        }
        rule
    }

    /// The value that a name stands for, or an error with the nearest name.
    fn known<T>(
        &mut self,
        name: &Spanned<String>,
        what: &str,
        value: Option<T>,
        names: impl Iterator<Item = &'static str>,
    ) -> Option<T> {
        if value.is_none() {
            let names: Vec<&str> = names.collect();
            let near = did_you_mean(name.get_ref(), names.iter().copied());
            let help = near.map_or(format!("there are {}", names.join(", ")), |near| format!("did you mean `{near}`?"));
            self.wrong(name.span(), format!("there is no {what} `{}`", name.get_ref()), Some(help));
        }
        value
    }

    fn patterns(&mut self, glob: Option<&Spanned<Strings>>) -> Option<Gitignore> {
        let glob = glob?;
        let mut patterns = GitignoreBuilder::new(self.root);
        for pattern in glob.get_ref().list() {
            if let Err(error) = patterns.add_line(None, pattern) {
                self.wrong(glob.span(), format!("not a pattern: {error}"), None);
            }
        }
        Some(patterns.build().unwrap_or_else(|_| Gitignore::empty()))
    }

    fn preludes(&mut self, names: &Spanned<Strings>) -> Vec<Prelude> {
        let mut preludes = Vec::new();
        for name in names.get_ref().list() {
            let Some(path) = self.path(name, names.span()) else { continue };
            match files::read_prelude(&path) {
                Ok(prelude) => preludes.push(prelude),
                Err(error) => self.diagnostics.push(Diagnostic::new(error.code, self.at(names.span()), error.message)),
            }
        }
        preludes
    }

    fn defines(&mut self, defines: &Spanned<Defines>) -> Vec<(String, String)> {
        let texts: Vec<String> = match defines.get_ref() {
            Defines::Texts(texts) => texts.list().to_vec(),
            Defines::Table(table) => {
                table.iter().map(|(name, value)| format!("{name}={}", macro_text(value))).collect()
            }
        };
        let mut read = Vec::new();
        for text in texts {
            match parse_define(&text) {
                Ok(define) => read.push(define),
                Err(message) => self.wrong(defines.span(), message, None),
            }
        }
        read
    }
}

/// The text of a macro from a value of TOML.
fn macro_text(value: &toml::Value) -> String {
    match value {
        toml::Value::String(text) => text.clone(),
        toml::Value::Boolean(value) => u8::from(*value).to_string(),
        other => other.to_string(),
    }
}
