//! `glisten.toml`: the levels of a project, found by searching upwards from each source.
//!
//! ```toml
//! [lint]
//! allow = ["W0001"]
//! warn = []
//! deny = ["warnings"]
//! exclude = ["third_party", "*.generated.frag"]
//! assume_version = "330"
//! baseline = "lint.json"       # findings that may stay
//!
//! [lint.configurations]        # for `lint --configurations`
//! values = { LIGHTS = [0, 1, 4], LEGACY = [false] }
//! skip = ["PCF !SHADOWS"]
//!
//! [lint.budgets]               # what a shader may cost ([`crate::arguments::settings`])
//! "*.frag" = { weight = 400, lookups = 4, varyings = 8 }
//!
//! [lint.ranges]                # what inputs may be
//! lights = [0, 8]
//!
//! [fmt]
//! indent = 4                   # or "tab"
//! width = 100
//! braces = "same-line"         # or "next-line"
//!
//! [stability.bounds]
//! "scenes/far/*.toml" = 0.01
//! "*.toml" = 0.001
//! ```
//!
//! `[[source]]` tables say how the engine of a folder completes its sources ([`crate::arguments::rules`]).
//!
//! `exclude` names what a search of a folder passes over, by the patterns of `.gitignore`, relative to the file's folder. It may
//! also stand above all tables. `assume_version` is the version of sources without a `#version` line, for all commands, unless a
//! `[[source]]` table gives another. `[stability.bounds]` states the accepted error of scenes by such patterns; the last one that
//! fits counts, in the order of the file.
//!
//! *Holds:* only the nearest file counts; a level on the command line takes precedence.

use crate::arguments::args::set_level;
use crate::arguments::bounds::Bounds;
use crate::arguments::rules::{KEYS as SOURCE_KEYS, Rule, RuleReader};
use crate::arguments::settings::{Budgets, ranges};
use crate::batch::Batch;
use crate::files;
use crate::seen;
use crate::variants::stated::Stated;
use glisten_front::diagnostic::codes::general::BAD_CONFIG;
use glisten_front::diagnostic::{Diagnostic, Level, Levels};
use glisten_front::source::SourceMap;
use glisten_scene::is_allowed;
use glisten_scene::tables::{CONFIGURATION, Reader};
use ignore::gitignore::{Gitignore, GitignoreBuilder};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use toml::de::DeTable;

const NAME: &str = "glisten.toml";

/// The keys of the file and of its tables.
const KEYS: &[&str] = &["exclude", "lint", "stability", "source", "fmt"];
const LINT_KEYS: &[&str] = &[
    "allow",
    "warn",
    "deny",
    "exclude",
    "assume_version",
    "assume-version",
    "baseline",
    "configurations",
    "budgets",
    "ranges",
];
const LEVELS: &[(&str, Level)] = &[("allow", Level::Allow), ("warn", Level::Warn), ("deny", Level::Deny)];

const FMT_KEYS: &[&str] = &["indent", "width", "braces"];
const BRACES: &[(&str, bool)] = &[("same-line", false), ("next-line", true)];

/// A configuration.
#[derive(Default)]
struct Configuration {
    exclude: Vec<String>,
    levels: Levels,
    rules: Vec<Rule>,
    /// Patterns of scenes and the error that they may have, in the order of the file.
    bounds: Vec<(String, f64)>,
    style: glisten_format::Options,
    /// The values of macros for `lint --configurations`.
    stated: Stated,
    budgets: Budgets,
    ranges: Vec<(String, Bounds)>,
    baseline: Option<PathBuf>,
}

impl Configuration {
    /// Reads the file at `path`, whose text is in `reader`. What is wrong is reported and left out.
    fn read(reader: &mut Reader, text: &str, path: &Path) -> Self {
        let Some(document) = reader.document(text) else { return Self::default() };
        reader.check_keys(&document, "`glisten.toml`", KEYS);
        let mut read = Self { exclude: patterns(reader, &document), ..Self::default() };
        let lint = reader.table_at(&document, "lint");
        if let Some(lint) = lint {
            reader.check_keys(lint, "`[lint]`", LINT_KEYS);
            read.exclude.extend(patterns(reader, lint));
            read.levels = levels(reader, lint);
            let folder = path.parent().unwrap_or(Path::new(""));
            read.baseline = reader.text_at(lint, "baseline").map(|(name, _)| folder.join(name));
            if let Some(table) = reader.table_at(lint, "configurations") {
                read.stated = Stated::read(reader, table);
            }
            if let Some(table) = reader.table_at(lint, "budgets") {
                read.budgets = Budgets::read(reader, table, path.parent().unwrap_or(Path::new("")));
            }
            if let Some(table) = reader.table_at(lint, "ranges") {
                read.ranges = ranges(reader, table);
            }
        }
        if let Some(stability) = reader.table_at(&document, "stability") {
            reader.check_keys(stability, "`[stability]`", &["bounds"]);
            read.bounds = bounds(reader, stability);
        }
        if let Some(table) = reader.table_at(&document, "fmt") {
            reader.check_keys(table, "`[fmt]`", FMT_KEYS);
            read.style = style(reader, table);
        }
        let version = lint.and_then(|lint| {
            let key = if lint.contains_key("assume_version") { "assume_version" } else { "assume-version" };
            reader.version_at(lint, key)
        });
        let sources = reader.tables_at(&document, "source");
        for (table, _) in &sources {
            reader.check_keys(table, "`[[source]]`", SOURCE_KEYS);
        }
        let mut rules = RuleReader::new(path.parent().unwrap_or(Path::new("")), reader);
        read.rules = rules.rules(version, sources.iter().map(|(table, _)| *table));
        read
    }

    /// Reads the nearest configuration of a folder. Its errors are reported when its levels are read.
    fn nearest(folder: &Path) -> Option<(Self, PathBuf)> {
        let path = Nearest::default().of(folder)?;
        Some((Self::at(&path)?, path))
    }

    /// Reads the configuration at `path`. Its errors are reported when its levels are read.
    fn at(path: &Path) -> Option<Self> {
        let bytes = files::read(&path.to_string_lossy(), path).ok()?;
        let text: Arc<str> = String::from_utf8_lossy(&bytes).into();
        let mut reader = Reader::new(&CONFIGURATION, 0, Arc::clone(&text));
        Some(Self::read(&mut reader, &text, path))
    }
}

/// The levels of `[lint]`.
fn levels(reader: &mut Reader, lint: &DeTable<'_>) -> Levels {
    let mut levels = Levels::default();
    for (key, level) in LEVELS {
        for (code, span) in reader.texts_at(lint, key) {
            if let Err((message, help)) = set_level(&mut levels, *level, code) {
                reader.report(Diagnostic::new(&BAD_CONFIG, span, message).maybe_help(help));
            }
        }
    }
    levels
}

/// The patterns of `exclude`.
fn patterns(reader: &mut Reader, table: &DeTable<'_>) -> Vec<String> {
    let mut patterns = Vec::new();
    for (pattern, span) in reader.texts_at(table, "exclude") {
        match GitignoreBuilder::new("").add_line(None, pattern) {
            Ok(_) => patterns.push(pattern.to_owned()),
            Err(error) => reader.report(Diagnostic::new(&BAD_CONFIG, span, format!("not a pattern: {error}"))),
        }
    }
    patterns
}

/// The accepted errors of `[stability.bounds]`.
fn bounds(reader: &mut Reader, stability: &DeTable<'_>) -> Vec<(String, f64)> {
    let Some(table) = reader.table_at(stability, "bounds") else { return Vec::new() };
    let mut bounds = Vec::new();
    for (pattern, node) in table {
        let Some(bound) = reader.finite(node, pattern.get_ref()) else { continue };
        if bound > 0.0 {
            bounds.push((node.span().start, pattern.get_ref().to_string(), bound));
        } else {
            let span = reader.span_of(node);
            reader.report(Diagnostic::new(&BAD_CONFIG, span, "a bound is a positive number"));
        }
    }
    bounds.sort_by_key(|(start, ..)| *start);
    bounds.into_iter().map(|(_, pattern, bound)| (pattern, bound)).collect()
}

/// The style of `[fmt]`.
fn style(reader: &mut Reader, table: &DeTable<'_>) -> glisten_format::Options {
    let standard = glisten_format::Options::default();
    let [least, most] = glisten_format::WIDTHS.map(|width| width as u32);
    let width = reader.count(table, "width", standard.width as u32, least..=most) as usize;
    let braces_below = reader.choice_at(table, "braces", standard.braces_below, BRACES);
    let indent = match table.get("indent") {
        None => standard.indent,
        Some(node) if node.get_ref().as_str().is_some() => {
            reader.choice(node, "indent", &[("tab", ())]).map_or(standard.indent, |()| None)
        }
        Some(_) => Some(reader.count(table, "indent", 4, 1..=glisten_format::MAX_INDENT as u32) as usize),
    };
    glisten_format::Options { indent, width, braces_below }
}

/// The nearest configurations of folders. Each folder is looked at once.
#[derive(Debug, Default)]
pub(crate) struct Nearest(HashMap<PathBuf, Option<PathBuf>>);

impl Nearest {
    /// The nearest configuration of a folder: its own, or that of one above it.
    pub(crate) fn of(&mut self, folder: &Path) -> Option<PathBuf> {
        if let Some(known) = self.0.get(folder) {
            return known.clone();
        }
        let found = self.of_absolute(&files::real(folder));
        self.0.insert(folder.to_owned(), found.clone());
        found
    }

    fn of_absolute(&mut self, folder: &Path) -> Option<PathBuf> {
        if let Some(known) = self.0.get(folder) {
            return known.clone();
        }
        let own = folder.join(NAME);
        seen::note(&own);
        let found = match own.is_file() {
            true => Some(own).filter(|path| is_allowed(path)),
            false => folder.parent().and_then(|above| self.of_absolute(above)),
        };
        self.0.insert(folder.to_owned(), found.clone());
        found
    }
}

/// The patterns that the configuration at `path` excludes.
pub(crate) fn excluded(path: &Path) -> Option<Gitignore> {
    let configuration = Configuration::at(path)?;
    let mut patterns = GitignoreBuilder::new(path.parent()?);
    for pattern in &configuration.exclude {
        // A pattern that is wrong excludes nothing.
        let _ = patterns.add_line(None, pattern);
    }
    patterns.build().ok()
}

/// The rules of the configuration at `path` for sources.
pub(crate) fn rules(path: &Path) -> Vec<Rule> {
    Configuration::at(path).map_or_else(Vec::new, |configuration| configuration.rules)
}

/// The style of the nearest configuration for the sources of a folder.
pub(crate) fn style_of(folder: &Path) -> glisten_format::Options {
    Configuration::nearest(folder)
        .map_or_else(glisten_format::Options::default, |(configuration, _)| configuration.style)
}

/// The values of macros that the nearest configuration states for the programs of a folder.
pub(crate) fn stated(folder: &Path) -> Stated {
    Configuration::nearest(folder).map_or_else(Stated::default, |(configuration, _)| configuration.stated)
}

/// The accepted error of a scene by the nearest configuration.
pub(crate) fn stability_bound(scene: &Path) -> Option<f64> {
    let folder = scene.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let (configuration, path) = Configuration::nearest(folder)?;
    let root = path.parent()?;
    let absolute = files::real(scene);
    let fits = |pattern: &str| {
        let mut patterns = GitignoreBuilder::new(root);
        patterns.add_line(None, pattern).ok()?;
        let patterns = patterns.build().ok()?;
        Some(patterns.matched(&absolute, false).is_ignore())
    };
    let last = configuration.bounds.iter().rfind(|(pattern, _)| fits(pattern).unwrap_or(false));
    last.map(|(_, bound)| *bound)
}

/// The settings that `lint` obeys for the files of a folder.
#[derive(Clone, Default)]
pub(crate) struct Settings {
    pub(crate) levels: Levels,
    /// The costs that shaders may have.
    pub(crate) budgets: Budgets,
    /// The ranges of inputs.
    pub(crate) ranges: Vec<(String, Bounds)>,
    /// The file of the findings that may stay.
    pub(crate) baseline: Option<PathBuf>,
}

impl Settings {
    /// A text that differs if other findings come of a file.
    pub(crate) fn text_of(&self, file: &str) -> String {
        format!("{:?} {:?} {:?}", self.levels, self.ranges, self.budgets.of(file))
    }
}

/// The configurations of all folders so far, completed by the levels of the command line.
pub(crate) struct Configs {
    given: Levels,
    nearest: Nearest,
    by_folder: HashMap<PathBuf, Arc<Settings>>,
    /// Those of each `glisten.toml`.
    by_file: HashMap<PathBuf, Arc<Settings>>,
    /// The errors in the configurations themselves.
    pub(crate) errors: Vec<Batch>,
}

impl Configs {
    /// An empty set of configurations, with the levels of the command line.
    pub(crate) fn new(given: Levels) -> Self {
        let (by_folder, by_file) = (HashMap::new(), HashMap::new());
        Self { given, nearest: Nearest::default(), by_folder, by_file, errors: Vec::new() }
    }

    /// The levels for the file called `name`.
    pub(crate) fn levels(&mut self, name: &str) -> &Levels {
        &self.settings(name).levels
    }

    /// The settings for the file called `name`.
    pub(crate) fn settings(&mut self, name: &str) -> &Arc<Settings> {
        let folder = Path::new(name).parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !self.by_folder.contains_key(folder) {
            // Of no file, the settings are those of the command line.
            let path = self.nearest.of(folder).unwrap_or_default();
            let known = self.by_file.get(&path).map(Arc::clone);
            let found = known.unwrap_or_else(|| {
                let mut read = if path == Path::new("") { Settings::default() } else { self.read(&path) };
                read.levels = self.given.over(&read.levels);
                let read = Arc::new(read);
                self.by_file.insert(path, Arc::clone(&read));
                read
            });
            self.by_folder.insert(folder.to_owned(), found);
        }
        &self.by_folder[folder]
    }

    /// The settings of a `glisten.toml`.
    fn read(&mut self, path: &Path) -> Settings {
        let name = path.to_string_lossy().into_owned();
        let mut sources = SourceMap::default();
        let mut settings = Settings::default();
        let diagnostics = match files::read(&name, path) {
            Ok(bytes) => {
                let text: Arc<str> = String::from_utf8_lossy(&bytes).into();
                let base = sources.add(&name, Arc::clone(&text)).map_or(0, |id| sources.file(id).base());
                let mut reader = Reader::new(&CONFIGURATION, base, Arc::clone(&text));
                let Configuration { levels, budgets, ranges, baseline, .. } =
                    Configuration::read(&mut reader, &text, path);
                settings = Settings { levels, budgets, ranges, baseline };
                reader.diagnostics.into_iter().collect()
            }
            Err(error) => vec![error.diagnostic(&mut sources, &name)],
        };
        let batch = Batch { sources, diagnostics };
        if !batch.diagnostics.is_empty() {
            self.errors.push(batch);
        }
        settings
    }
}
