//! `glisten.toml`: the levels of a project, found by searching upwards from each source.
//!
//! ```toml
//! [lint]
//! allow = ["W0001"]
//! warn = []
//! deny = ["warnings"]
//! exclude = ["third_party", "*.generated.frag"]
//! assume_version = "330"
//!
//! [stability.bounds]
//! "scenes/far/*.toml" = 0.01
//! "*.toml" = 0.001
//! ```
//!
//! `[[source]]` tables say how the engine of a folder completes its sources ([`super::rules`]).
//!
//! `exclude` names what a search of a folder passes over, by the patterns of `.gitignore`, relative to the file's folder. It may
//! also stand above all tables. `assume_version` is the version of sources without a `#version` line, for all commands, unless a
//! `[[source]]` table gives another. `[stability.bounds]` states the accepted error of scenes by such patterns; the last one that
//! fits counts, in the order of the file.
//!
//! *Holds:* only the nearest file counts; a level on the command line takes precedence.

use super::args::set_level;
use super::batch::Batch;
use super::files;
use super::rules::{Rule, RuleReader, SourceTable};
use super::toml_errors;
use glisten_front::diagnostic::codes::general::BAD_CONFIG;
use glisten_front::diagnostic::{Diagnostic, Level, Levels};
use glisten_front::source::{SourceMap, Span};
use ignore::gitignore::{Gitignore, GitignoreBuilder};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use toml::Spanned;

const NAME: &str = "glisten.toml";

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct Config {
    #[serde(default)]
    exclude: Vec<Spanned<String>>,
    #[serde(default)]
    lint: LintTable,
    #[serde(default)]
    stability: StabilityTable,
    #[serde(default)]
    source: Vec<SourceTable>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct StabilityTable {
    #[serde(default)]
    bounds: BTreeMap<String, Spanned<f64>>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
struct LintTable {
    #[serde(default)]
    allow: Vec<Spanned<String>>,
    #[serde(default)]
    warn: Vec<Spanned<String>>,
    #[serde(default)]
    deny: Vec<Spanned<String>>,
    #[serde(default)]
    exclude: Vec<Spanned<String>>,
    #[serde(alias = "assume-version")]
    assume_version: Option<Spanned<String>>,
}

/// The nearest configuration of a folder or of one above it.
fn nearest(folder: &Path) -> Option<PathBuf> {
    let absolute = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
    absolute.ancestors().map(|above| above.join(NAME)).find(|path| path.is_file())
}

/// The patterns that the nearest configuration excludes. Its errors are reported when its levels are read.
pub(super) fn excluded(folder: &Path) -> Option<Gitignore> {
    let path = nearest(folder)?;
    let config: Config =
        toml::from_str(&String::from_utf8_lossy(&files::read(&path.to_string_lossy(), &path).ok()?)).ok()?;
    let mut patterns = GitignoreBuilder::new(path.parent()?);
    for pattern in config.exclude.iter().chain(&config.lint.exclude) {
        // A pattern that is wrong excludes nothing.
        let _ = patterns.add_line(None, pattern.get_ref());
    }
    patterns.build().ok()
}

/// The rules of the nearest configuration for the sources of a folder. Its errors are reported when its levels are read.
pub(super) fn rules(folder: &Path) -> Vec<Rule> {
    let Some(path) = nearest(folder) else { return Vec::new() };
    let Ok(bytes) = files::read(&path.to_string_lossy(), &path) else { return Vec::new() };
    let Ok(config) = toml::from_str::<Config>(&String::from_utf8_lossy(&bytes)) else { return Vec::new() };
    let mut reader = RuleReader::new(path.parent().unwrap_or(Path::new("")), 0);
    reader.rules(config.lint.assume_version.as_ref(), &config.source)
}

/// The accepted error of a scene by the nearest configuration.
pub(super) fn stability_bound(scene: &Path) -> Option<f64> {
    let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let path = nearest(folder)?;
    let text = files::read(&path.to_string_lossy(), &path).ok()?;
    let config: Config = toml::from_str(&String::from_utf8_lossy(&text)).ok()?;
    let root = path.parent()?;
    let absolute = std::path::absolute(scene).ok()?;
    let fits = |pattern: &str| {
        let mut patterns = GitignoreBuilder::new(root);
        patterns.add_line(None, pattern).ok()?;
        let patterns = patterns.build().ok()?;
        Some(patterns.matched(&absolute, false).is_ignore())
    };
    let bounds = config.stability.bounds.iter().filter(|(pattern, _)| fits(pattern).unwrap_or(false));
    let last = bounds.max_by_key(|(_, bound)| bound.span().start);
    last.map(|(_, bound)| *bound.get_ref()).filter(|bound| *bound > 0.0)
}

/// The configurations of all folders so far, completed by the levels of the command line.
pub(super) struct Configs {
    given: Levels,
    by_folder: BTreeMap<PathBuf, Levels>,
    /// The errors in the configurations themselves.
    pub(super) errors: Vec<Batch>,
}

impl Configs {
    /// An empty set of configurations, with the levels of the command line.
    pub(super) fn new(given: Levels) -> Self {
        Self { given, by_folder: BTreeMap::new(), errors: Vec::new() }
    }

    /// The levels for the file called `name`.
    pub(super) fn levels(&mut self, name: &str) -> &Levels {
        let folder = Path::new(name).parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !self.by_folder.contains_key(folder) {
            let found = self.search(folder);
            let levels = self.given.over(&found);
            self.by_folder.insert(folder.to_owned(), levels);
        }
        &self.by_folder[folder]
    }

    fn search(&mut self, folder: &Path) -> Levels {
        let Some(path) = nearest(folder) else { return Levels::default() };
        let name = path.to_string_lossy().into_owned();
        let mut sources = SourceMap::default();
        let mut levels = Levels::default();
        let diagnostics = match files::read(&name, &path) {
            Ok(bytes) => parse(&String::from_utf8_lossy(&bytes), &name, &mut sources, &mut levels),
            Err(error) => vec![error.diagnostic(&mut sources, &name)],
        };
        let batch = Batch { sources, diagnostics };
        if !batch.diagnostics.is_empty() && !self.errors.iter().any(|other| other.diagnostics == batch.diagnostics) {
            self.errors.push(batch);
        }
        levels
    }
}

/// Reads a configuration into `levels`.
fn parse(text: &str, name: &str, sources: &mut SourceMap, levels: &mut Levels) -> Vec<Diagnostic> {
    let base = sources.add(name, text).map_or(0, |id| sources.file(id).base());
    let at = |range: Range<usize>| Span::new(base + range.start as u32, base + range.end as u32);
    let config: Config = match toml::from_str(text) {
        Ok(config) => config,
        Err(error) => {
            let span = error.span().unwrap_or(0..0);
            let (message, help) = toml_errors::explained(&error);
            return vec![Diagnostic::new(&BAD_CONFIG, at(span), message).maybe_help(help)];
        }
    };
    let lists = [(Level::Allow, config.lint.allow), (Level::Warn, config.lint.warn), (Level::Deny, config.lint.deny)];
    let mut diagnostics = Vec::new();
    for pattern in config.exclude.iter().chain(&config.lint.exclude) {
        if let Err(error) = GitignoreBuilder::new("").add_line(None, pattern.get_ref()) {
            diagnostics.push(Diagnostic::new(&BAD_CONFIG, at(pattern.span()), format!("not a pattern: {error}")));
        }
    }
    for bound in
        config.stability.bounds.values().filter(|bound| !(*bound.get_ref() > 0.0 && bound.get_ref().is_finite()))
    {
        diagnostics.push(Diagnostic::new(&BAD_CONFIG, at(bound.span()), "a bound is a positive number"));
    }
    let mut reader = RuleReader::new(Path::new(name).parent().unwrap_or(Path::new("")), base);
    reader.rules(config.lint.assume_version.as_ref(), &config.source);
    diagnostics.append(&mut reader.diagnostics);
    for (level, keys) in lists {
        for key in keys {
            if let Err((message, help)) = set_level(levels, level, key.get_ref()) {
                diagnostics.push(Diagnostic::new(&BAD_CONFIG, at(key.span()), message).maybe_help(help));
            }
        }
    }
    diagnostics
}
