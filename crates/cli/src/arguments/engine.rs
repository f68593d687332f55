//! [`Engines`]: completes each source that a command reads, by its flags and by the `[[source]]` tables of `glisten.toml`.
//!
//! *In:* the name of a source, its text and its stage. *Out:* its part of a file with several stages, macros, preludes, the
//! version if it has none, and the resolver of its includes. *Holds:* all commands compile through it, so a source means the
//! same to each of them. Flags take precedence over tables, and those over the profile of the engine.

use crate::arguments::args::SourceArgs;
use crate::arguments::config::{self, Nearest};
use crate::arguments::rules::Rule;
use crate::exit::{Exit, Failure};
use crate::files;
use crate::seen;
use crate::trace::{self, Trace};
use glisten_front::compiler::{Preparation, Prepared, Source, SourceSettings};
use glisten_front::diagnostic::codes::general;
use glisten_front::hir::Stage;
use glisten_front::source::Prelude;
use glisten_sources::engines::{self, Profile, Style};
use glisten_sources::{Disk, DiskIncludes, ProgramFiles, Settings, normal, stages};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The name of standard input in diagnostics.
pub(crate) const STDIN: &str = glisten_front::source::SourceMap::STDIN;

/// Completes sources.
#[derive(Clone, Debug, Default)]
pub(crate) struct Engines {
    flags: Arc<Flags>,
    /// The settings of a draw.
    draw: Arc<Settings>,
    /// The settings of sources about whose engine and version nothing else is said.
    fallback: Arc<Settings>,
    rules: Arc<Mutex<Rules>>,
    programs: ProgramFiles,
    disk: Files,
    /// Whether files have absolute names, as the documents of an editor do.
    is_absolute: bool,
}

/// Who reads the files that sources include.
#[derive(Clone)]
struct Files(Arc<dyn Disk>);

impl Default for Files {
    fn default() -> Self {
        Self(Arc::new(Traced))
    }
}

impl std::fmt::Debug for Files {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("Files")
    }
}

/// Rules, and what was read for them.
type Known = (Arc<Vec<Rule>>, Arc<Trace>);

/// The rules of folders so far.
#[derive(Debug, Default)]
struct Rules {
    nearest: Nearest,
    /// Those of each `glisten.toml`.
    by_file: HashMap<PathBuf, Known>,
}

/// The flags of the command line.
#[derive(Debug, Default)]
struct Flags {
    profile: Option<&'static Profile>,
    version: Option<String>,
    style: Option<Style>,
    preludes: Vec<Prelude>,
    folders: Vec<PathBuf>,
}

impl Engines {
    /// The engines of a command.
    ///
    /// # Errors
    /// A prelude that cannot be read.
    pub(crate) fn new(args: &SourceArgs) -> Result<Self, Failure> {
        args.refuse_two_values()?;
        let mut preludes = Vec::new();
        for path in &args.preludes {
            preludes.push(files::read_prelude(path).map_err(|error| {
                let is_text = [general::BINARY_SOURCE.id, general::TOO_LARGE.id].contains(&error.code.id);
                let failure = Failure::new(if is_text { Exit::Content } else { Exit::Usage }, error.message);
                if let Some(help) = error.help { failure.help(help) } else { failure }
            })?);
        }
        let flags = Flags {
            profile: args.engine.as_deref().and_then(engines::find),
            version: args.assume_version.clone(),
            style: args.include_style,
            preludes,
            folders: args.include_dirs.clone(),
        };
        Ok(Self { flags: Arc::new(flags), ..Self::default() })
    }

    /// These engines for an editor: `disk` reads what sources include and what stands before them, by absolute paths.
    #[cfg(feature = "lsp")]
    #[must_use]
    pub(crate) fn with_disk(self, disk: Arc<dyn Disk>) -> Self {
        Self { disk: Files(disk), is_absolute: true, ..self }
    }

    /// These engines, with settings for sources about whose engine and version nothing else is said.
    #[must_use]
    pub(crate) fn with_fallback(&self, fallback: Settings) -> Self {
        Self { fallback: Arc::new(fallback), ..self.clone() }
    }

    /// The folders in which the includes of a file are searched.
    #[cfg(feature = "lsp")]
    pub(crate) fn folders(&self, file: &Path) -> Vec<PathBuf> {
        self.settings(Some(file)).folders.iter().map(|folder| self.placed(folder)).collect()
    }

    /// The paths of the preludes of a file.
    #[cfg(feature = "lsp")]
    pub(crate) fn preludes(&self, file: &Path) -> Vec<PathBuf> {
        self.settings(Some(file)).preludes.iter().map(|prelude| self.placed(Path::new(&prelude.name))).collect()
    }

    /// Whether a file is the prelude of sources whose settings were asked for.
    #[cfg(feature = "lsp")]
    pub(crate) fn is_prelude(&self, file: &Path) -> bool {
        let is_it = |prelude: &Prelude| self.placed(Path::new(&prelude.name)) == file;
        let known = self.rules.lock().unwrap_or_else(PoisonError::into_inner);
        let mut rules = known.by_file.values().flat_map(|(rules, _)| rules.iter());
        self.flags.preludes.iter().any(is_it) || rules.any(|rule| rule.preludes.iter().any(is_it))
    }

    /// The resolver of includes for sources that no engine completes.
    pub(crate) fn includes(&self) -> DiskIncludes {
        let folders = self.flags.folders.iter().map(|folder| self.placed(folder)).collect();
        DiskIncludes::new(Arc::clone(&self.disk.0), folders, Style::Quote, &[])
    }

    /// A path of a flag or a table, absolute where files have absolute names.
    fn placed(&self, path: &Path) -> PathBuf {
        if !self.is_absolute {
            return path.to_owned();
        }
        std::path::absolute(path).map_or_else(|_| path.to_owned(), |path| normal(&path))
    }

    /// Settings with the names that files have here, and with preludes as they are now: an editor may have them open.
    fn as_named(&self, mut settings: Settings) -> Settings {
        if !self.is_absolute {
            return settings;
        }
        for folder in &mut settings.folders {
            *folder = self.placed(folder);
        }
        for prelude in &mut settings.preludes {
            let path = self.placed(Path::new(&prelude.name));
            if let Ok(text) = self.disk.0.text(&path) {
                *prelude = Prelude { name: path.to_string_lossy().into_owned(), text };
            }
        }
        settings
    }

    /// The rules for a folder.
    fn rules(&self, folder: &Path) -> Arc<Vec<Rule>> {
        trace::rules_of(folder);
        self.known(folder).0
    }

    fn known(&self, folder: &Path) -> Known {
        let mut known = self.rules.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(file) = known.nearest.of(folder) else { return Known::default() };
        let read = |file: &PathBuf| {
            let (rules, trace) = trace::recorded(|| config::rules(file));
            (Arc::new(rules), Arc::new(trace))
        };
        known.by_file.entry(file).or_insert_with_key(read).clone()
    }

    /// The trace of reading the rules of a folder, or `None` if there is no rule.
    pub(crate) fn trace_of_rules(&self, folder: &Path) -> Option<Arc<Trace>> {
        let (rules, trace) = self.known(folder);
        (!rules.is_empty()).then_some(trace)
    }

    /// Whether sources are completed by more than their texts and the search path for includes.
    pub(crate) fn is_engine_given(&self) -> bool {
        self.flags.profile.is_some() || self.flags.style.is_some()
    }

    /// The tables that fit a file, in their order.
    fn of_tables(&self, path: &Path, visit: impl FnMut(&Rule)) {
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
        self.rules(folder).iter().filter(|rule| rule.fits(path)).for_each(visit);
    }

    /// The settings of a file by the flags, the draw and the tables, in the order of their precedence.
    fn settings(&self, path: Option<&Path>) -> Settings {
        let flags = &*self.flags;
        let mut tables = Settings { programs: self.programs.clone(), ..Settings::default() };
        if let Some(path) = path {
            self.of_tables(path, |rule| add(&mut tables, rule));
        }
        let given = Settings {
            profile: flags.profile,
            version: flags.version.clone(),
            style: flags.style,
            preludes: flags.preludes.clone(),
            folders: flags.folders.clone(),
            ..Settings::default()
        };
        let said = given.over((*self.draw).clone().over(tables));
        let is_silent = said.profile.is_none() && said.version.is_none();
        if is_silent { said.over((*self.fallback).clone()) } else { said }
    }

    /// The stage that the flags and the tables give to a file whose name tells none.
    pub(crate) fn stage(&self, path: &Path) -> Option<Stage> {
        let mut stage = None;
        self.of_tables(path, |rule| stage = rule.stage.or(stage));
        stage.or_else(|| self.settings(Some(path)).profile.and_then(|profile| profile.stage))
    }

    /// The stage that a table gives to a file although there is no such stage.
    pub(crate) fn unknown_stage(&self, path: &Path) -> Option<String> {
        let mut unknown = None;
        self.of_tables(path, |rule| unknown = rule.unknown_stage.clone().or(unknown.take()));
        unknown
    }
}

impl Engines {
    /// Whether includes of a file are searched along folders that the user gave, who then knows that something resolves them.
    pub(crate) fn has_folders(&self, name: &str) -> bool {
        !self.flags.folders.is_empty() || !self.settings(Some(Path::new(name))).folders.is_empty()
    }

    /// Whether the engine of a file has programs of this stage alone, so that no file is its partner.
    pub(crate) fn is_whole(&self, path: &Path) -> bool {
        self.settings(Some(path)).profile.is_some_and(|profile| profile.stage == Some(Stage::Fragment))
    }

    /// Whether the engine of a file never takes it for a shader, whatever is in it.
    pub(crate) fn is_part(&self, path: &Path) -> bool {
        let parts = self.settings(Some(path)).profile.and_then(|profile| profile.parts.as_deref());
        parts.is_some_and(|parts| match parts.strip_suffix('/') {
            Some(folder) => path.ancestors().skip(1).any(|parent| parent.ends_with(folder)),
            None => {
                let has = |extension: &std::ffi::OsStr| extension.eq_ignore_ascii_case(parts);
                stages::may_be_included(path) && path.extension().is_some_and(has)
            }
        })
    }
}

/// Adds what a table says.
fn add(settings: &mut Settings, rule: &Rule) {
    settings.profile = rule.profile.or(settings.profile);
    settings.version = rule.version.clone().or(settings.version.take());
    settings.style = rule.style.or(settings.style);
    settings.preludes.extend_from_slice(&rule.preludes);
    settings.defines.extend_from_slice(&rule.defines);
    settings.folders.extend_from_slice(&rule.includes);
}

/// Reads files for a command, and notes what it reads.
pub(crate) struct Traced;

impl Disk for Traced {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        let name = path.to_string_lossy();
        // An included file may be empty; otherwise the same rules hold as for a source.
        let bytes = files::read(&name, path).map_err(|error| error.message)?;
        if bytes.is_empty() {
            return Ok("".into());
        }
        files::text_of(&name, bytes).map_err(|error| error.message)
    }

    fn is_binary(&self, path: &Path) -> bool {
        let name = path.to_string_lossy();
        files::read(&name, path).is_ok_and(|bytes| files::refuse_binary(&name, &bytes).is_err())
    }

    fn looked_for(&self, path: &Path) {
        trace::looked_for(path);
        seen::note(path);
    }

    fn searched(&self) {
        trace::beyond();
    }
}

impl Preparation for Engines {
    fn prepare(&self, source: &Source) -> Prepared {
        if source.name.starts_with('<') && source.name != STDIN {
            return Prepared::default();
        }
        let path = (source.name != STDIN).then(|| Path::new(source.name.as_str()));
        self.as_named(self.settings(path)).complete(source, path, Arc::clone(&self.disk.0))
    }

    fn with_settings(&self, settings: &SourceSettings) -> Option<Arc<dyn Preparation + Send + Sync>> {
        Some(Arc::new(Self { draw: Arc::new(Settings::from_host(settings)), ..self.clone() }))
    }
}
