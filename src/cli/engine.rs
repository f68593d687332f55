//! [`Engines`]: completes each source that a command reads, by its flags and by the `[[source]]` tables of `glisten.toml`.
//!
//! *In:* the name of a source, its text and its stage. *Out:* its part of a file with several stages, macros, preludes, the
//! version if it has none, and the resolver of its includes. *Holds:* all commands compile through it, so a source means the
//! same to each of them. Flags take precedence over tables, and those over the profile of the engine.

use super::args::SourceArgs;
use super::config;
use super::exit::{Exit, Failure};
use super::files;
use super::includes::DiskIncludes;
use super::rules::Rule;
use super::stages;
use super::trace::{self, Trace};
use crate::engines::{self, GameProgram, Member, Profile, Style, combined};
use glisten_front::compiler::{Preparation, Prepared, Source};
use glisten_front::diagnostic::codes::general;
use glisten_front::hir::Stage;
use glisten_front::source::{Completion, Prelude, blanked};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// The name of standard input in diagnostics.
pub(super) const STDIN: &str = "<stdin>";

/// The settings that the flags and the tables give to one source.
struct Settings {
    profile: Option<&'static Profile>,
    version: Option<String>,
    style: Option<Style>,
    stage: Option<Stage>,
    preludes: Vec<Prelude>,
    defines: Vec<(String, String)>,
    folders: Vec<PathBuf>,
}

/// Completes sources.
#[derive(Clone, Debug)]
pub(super) struct Engines {
    flags: Arc<Flags>,
    /// The rules of each folder so far.
    rules: Arc<Mutex<BTreeMap<PathBuf, Known>>>,
    /// The programs that files of JSON in each folder describe, by the names of the files.
    programs: Arc<Mutex<BTreeMap<PathBuf, Programs>>>,
}

/// Programs by the names of their files, without the extension.
type Programs = Arc<BTreeMap<String, GameProgram>>;

/// The rules of a folder, and what was read for them.
type Known = (Arc<Vec<Rule>>, Arc<Trace>);

/// The flags of the command line.
#[derive(Debug)]
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
    pub(super) fn new(args: &SourceArgs) -> Result<Self, Failure> {
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
        Ok(Self { flags: Arc::new(flags), rules: Arc::default(), programs: Arc::default() })
    }

    /// The resolver of includes for sources that no engine completes.
    pub(super) fn includes(&self) -> DiskIncludes {
        DiskIncludes::of_engine(self.flags.folders.clone(), Style::Quote, &[])
    }

    /// The rules for a folder.
    fn rules(&self, folder: &Path) -> Arc<Vec<Rule>> {
        trace::rules_of(folder);
        self.known(folder).0
    }

    fn known(&self, folder: &Path) -> Known {
        let mut known = self.rules.lock().unwrap_or_else(PoisonError::into_inner);
        let read = || {
            let (rules, trace) = trace::recorded(|| config::rules(folder));
            (Arc::new(rules), Arc::new(trace))
        };
        known.entry(folder.to_owned()).or_insert_with(read).clone()
    }

    /// The trace of reading the rules of a folder, or `None` if there is no rule.
    pub(super) fn trace_of_rules(&self, folder: &Path) -> Option<Arc<Trace>> {
        let (rules, trace) = self.known(folder);
        (!rules.is_empty()).then_some(trace)
    }

    /// Whether sources are completed by more than their texts and the search path for includes.
    pub(super) fn is_engine_given(&self) -> bool {
        self.flags.profile.is_some() || self.flags.style.is_some()
    }

    /// The settings of a file by the flags and the tables.
    fn settings(&self, path: Option<&Path>) -> Settings {
        let flags = &*self.flags;
        let mut settings = Settings {
            profile: None,
            version: None,
            style: None,
            stage: None,
            preludes: Vec::new(),
            defines: Vec::new(),
            folders: flags.folders.clone(),
        };
        if let Some(path) = path {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
            for rule in self.rules(folder).iter().filter(|rule| rule.fits(path)) {
                settings.add(rule);
            }
        }
        settings.profile = flags.profile.or(settings.profile);
        settings.version = flags.version.clone().or(settings.version);
        settings.style = flags.style.or(settings.style);
        settings.preludes.extend_from_slice(&flags.preludes);
        settings
    }

    /// The macros of the program that a file belongs to: of several, the one with its name, otherwise the first.
    fn macros_of_program(&self, source: &Source) -> Vec<(String, String)> {
        let path = Path::new(&source.name);
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut known = self.programs.lock().unwrap_or_else(PoisonError::into_inner);
        let programs = Arc::clone(known.entry(folder.to_owned()).or_insert_with(|| Arc::new(programs_in(folder))));
        drop(known);
        if !programs.is_empty() {
            // The result depends on which files there are.
            trace::beyond();
        }
        let own = path.file_stem().and_then(|stem| programs.get(&*stem.to_string_lossy()));
        let fits = |program: &&GameProgram| program.has(source.stage, path);
        let program = own.filter(fits).or_else(|| programs.values().find(fits));
        program.map(|program| program.defines().collect()).unwrap_or_default()
    }

    /// The stage that the flags and the tables give to a file whose name tells none.
    pub(super) fn stage(&self, path: &Path) -> Option<Stage> {
        let settings = self.settings(Some(path));
        settings.stage.or(settings.profile.and_then(|profile| profile.stage))
    }
}

impl Engines {
    /// Whether the engine of a file never takes it for a shader, whatever is in it.
    pub(super) fn is_part(&self, path: &Path) -> bool {
        let parts = self.settings(Some(path)).profile.and_then(|profile| profile.parts.as_deref());
        parts.is_some_and(|parts| path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(parts)))
    }
}

impl Settings {
    fn add(&mut self, rule: &Rule) {
        self.profile = rule.profile.or(self.profile);
        self.version = rule.version.clone().or(self.version.take());
        self.style = rule.style.or(self.style);
        self.stage = rule.stage.or(self.stage);
        self.preludes.extend_from_slice(&rule.preludes);
        self.defines.extend_from_slice(&rule.defines);
        self.folders.extend_from_slice(&rule.includes);
    }

    /// Whether nothing is to be done.
    fn is_plain(&self) -> bool {
        let no_engine = self.profile.is_none() && self.version.is_none() && self.style.is_none();
        no_engine && self.preludes.is_empty() && self.defines.is_empty()
    }

    /// The source with all that belongs to it.
    fn complete(self, source: &Source, header: &str, prepared: &mut Prepared) {
        let style = self.style.or(self.profile.and_then(|profile| profile.style));
        let roots = self.profile.map_or(&[][..], |profile| &profile.roots);
        let mut version = self.version.or(self.profile.and_then(|profile| profile.version.clone()));
        let own = prepared.text.as_ref().unwrap_or(&source.text);
        if let Some((profile, line)) = self.profile.and_then(|profile| Some((profile, profile.old_version_line(own)?)))
        {
            prepared.text = Some(blanked(own, &[line]));
            version.clone_from(&profile.least_version);
        }
        let text = prepared.text.as_ref().unwrap_or(&source.text);
        let mut added = self.profile.map(|profile| profile.addition(text, source.stage, header)).unwrap_or_default();
        let taken = match self.profile {
            Some(profile) => profile.taken(text, self.defines),
            None => self.defines,
        };
        let of_stage = std::mem::take(&mut prepared.defines);
        prepared.defines = last_of_each(added.defines.into_iter().chain(of_stage).chain(taken).collect());
        added.preludes.extend(self.profile.and_then(|profile| companion(profile, &source.name)));
        added.preludes.extend(self.preludes);
        prepared.completion = Completion {
            assumed_version: version,
            preludes: added.preludes,
            directive: style.and_then(|style| style.lookup().directive),
            resolves_includes: style.is_some(),
            redefines: self.profile.and_then(|profile| profile.redefines).unwrap_or(false),
        };
        prepared.problems = added.problems;
        let includes = DiskIncludes::of_engine(self.folders, style.unwrap_or(Style::Quote), roots);
        prepared.includes = Some(Arc::new(includes));
    }
}

/// The programs with macros that files of JSON in a folder describe.
fn programs_in(folder: &Path) -> BTreeMap<String, GameProgram> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let mut programs = BTreeMap::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let is_json = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json"));
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).filter(|_| is_json);
        let Some(stem) = stem else { continue };
        let text = files::read(&path.to_string_lossy(), &path).ok();
        let program = text.and_then(|bytes| GameProgram::read(&String::from_utf8_lossy(&bytes)));
        if let Some(program) = program.filter(GameProgram::has_defines) {
            programs.insert(stem, program);
        }
    }
    programs
}

/// The file next to a source that its engine reads before it.
fn companion(profile: &Profile, source: &str) -> Option<Prelude> {
    let source = Path::new(source);
    // The names may differ in case alone, and so may files.
    let is_source = |path: &Path| {
        path.file_name().map(|name| name.to_ascii_lowercase())
            == source.file_name().map(|name| name.to_ascii_lowercase())
    };
    let paths = profile.before.iter().map(|name| source.with_file_name(name));
    let is_there = |path: &PathBuf| {
        trace::looked_for(path);
        path.is_file() && !is_source(path)
    };
    let path = paths.into_iter().find(is_there)?;
    files::read_prelude(&path).ok()
}

/// The last definition of each macro.
fn last_of_each(defines: Vec<(String, String)>) -> Vec<(String, String)> {
    let mut kept: Vec<(String, String)> = Vec::new();
    for (name, value) in defines {
        kept.retain(|(other, _)| *other != name);
        kept.push((name, value));
    }
    kept
}

/// The programs of a file with several stages; none if its name tells its stage.
pub(super) fn members(path: Option<&Path>, text: &str) -> Vec<Member> {
    if path.is_some_and(|path| stages::by_name(path).is_some()) { Vec::new() } else { combined::members(text) }
}

/// The text with the header of a source: the fragment shader next to a vertex shader, otherwise the source itself.
fn header_of(source: &Source, path: Option<&Path>) -> Arc<str> {
    let fragment = || {
        let path = path?.with_extension("fs");
        files::read_source(&path.to_string_lossy(), Some(&path)).ok()
    };
    let other = if source.stage == Stage::Vertex { fragment() } else { None };
    other.unwrap_or_else(|| Arc::clone(&source.text))
}

impl Preparation for Engines {
    fn prepare(&self, source: &Source) -> Prepared {
        let mut prepared = Prepared::default();
        if source.name.starts_with('<') && source.name != STDIN {
            return prepared;
        }
        let path = (source.name != STDIN).then(|| Path::new(source.name.as_str()));
        let members = members(path, &source.text);
        if let Some(part) = members.iter().find_map(|member| member.part(source.stage)) {
            prepared.text = (!part.others.is_empty()).then(|| part.text(&source.text));
            prepared.defines.clone_from(&part.defines);
        }
        let settings = self.settings(path);
        if !settings.is_plain() || !settings.folders.is_empty() {
            if settings.profile.is_some_and(|profile| profile.has_program_files) {
                prepared.defines.extend(self.macros_of_program(source));
            }
            let has_header = settings.profile.is_some_and(|profile| profile.has_isf_header);
            let header = if has_header { header_of(source, path) } else { Arc::clone(&source.text) };
            settings.complete(source, &header, &mut prepared);
        }
        prepared
    }
}
