//! [`Files`]: the answers of the program to the language server, which are those of `glisten lint`.
//!
//! *In:* paths, and the texts of open documents. *Out:* programs, what the compiler says of them with the levels of their
//! configurations, styles. *Holds:* a text in the editor counts instead of the file. A panic of the compiler is a finding.

use crate::arguments::args::{BindingArgs, LevelArgs, SourceArgs};
use crate::arguments::bounds::Bounds;
use crate::arguments::config;
use crate::arguments::engine::{Engines, Traced};
use crate::baseline::{Baseline, BaselineArgs};
use crate::batch::Batch;
use crate::commands::explain::page;
use crate::commands::fmt;
use crate::commands::lsp::drawing::Drawing;
use crate::commands::lsp::files::{Includes, listed, scenes};
use crate::commands::lsp::judged::{Judged, Judging, OpenFiles};
use crate::console::Console;
use crate::exit::Failure;
use crate::files;
use crate::inputs::{self, Group, Input};
use crate::process::guard;
use crate::search;
use crate::session::{Session, allow_more_shaders};
use crate::strings;
use glisten_format::{Formatted, Options};
use glisten_front::compiler::{Compilation, Compiler, Source};
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::{Code, Diagnostic, Levels};
use glisten_front::hir::Stage;
use glisten_front::index::Inspection;
use glisten_front::link::Program;
use glisten_front::lint::check_some;
use glisten_front::source::{SourceMap, Span};
use glisten_lsp::{Compiled, Overlay, Piece, ProgramKey, Project};
use glisten_sources::embedded::{Filling, Host, styled};
use glisten_sources::{Disk, stages};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The name of a configuration.
const CONFIGURATION: &str = "glisten.toml";
/// How long the scenes of a workspace are known.
const FRESH: Duration = Duration::from_secs(2);
/// The largest number of programs in which a name of a header is followed.
const MAX_USERS: usize = 1000;
/// The largest number of programs that are tried for a header.
const MAX_INCLUDERS: usize = 12;

/// Files, configurations and the compiler.
pub(crate) struct Files<'a> {
    /// The macros that the editor has chosen.
    pub(crate) chosen: BTreeMap<String, String>,
    /// The processes that draw.
    pub(crate) drawing: Drawing,
    /// The baseline of the command line.
    baseline: Option<Baseline>,
    /// Those that configurations name, as far as they are there.
    baselines: BTreeMap<PathBuf, Option<Baseline>>,
    judged: Judged,
    scenes: Option<Scenes>,
    console: &'a Console,
    sources: &'a SourceArgs,
    levels: &'a LevelArgs,
    bindings: &'a BindingArgs,
    overlay: Overlay,
    session: Session<'a>,
    groups: BTreeMap<ProgramKey, Group>,
    includes: Includes,
    /// The folders whose configurations count.
    folders: BTreeSet<PathBuf>,
    /// The files with the pages of codes, as far as they were asked for.
    pages: RefCell<BTreeMap<&'static str, Option<PathBuf>>>,
}

/// The scenes of folders, and when they were read.
struct Scenes {
    read: Instant,
    folders: Vec<PathBuf>,
    found: Vec<(PathBuf, Arc<str>)>,
}

/// Reads included files, the open documents first.
struct Open(Overlay);

impl Disk for Open {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        self.0.text(path).map_or_else(|| Traced.text(path), Ok)
    }

    fn is_binary(&self, path: &Path) -> bool {
        self.0.text(path).is_none() && Traced.is_binary(path)
    }

    fn looked_for(&self, path: &Path) {
        Traced.looked_for(path);
    }

    fn searched(&self) {
        Traced.searched();
    }
}

impl<'a> Files<'a> {
    /// The files of a command.
    ///
    /// # Errors
    /// A prelude that cannot be read, or a code that does not exist.
    pub(crate) fn new(
        console: &'a Console,
        sources: &'a SourceArgs,
        levels: &'a LevelArgs,
        bindings: &'a BindingArgs,
        baseline: Option<Baseline>,
    ) -> Result<Self, Failure> {
        let overlay = Overlay::default();
        let session = session(console, sources, levels, bindings, &overlay)?;
        let (groups, includes, folders, pages) = Default::default();
        let (chosen, drawing, scenes, baselines, judged) = Default::default();
        Ok(Self {
            chosen,
            drawing,
            baseline,
            baselines,
            judged,
            scenes,
            console,
            sources,
            levels,
            bindings,
            overlay,
            session,
            groups,
            includes,
            folders,
            pages,
        })
    }

    /// Whether a file has a wanted word.
    fn has_word(&self, path: &Path, is_wanted: &dyn Fn(&str) -> bool) -> bool {
        let read = || files::read_source(&path.to_string_lossy(), Some(path)).ok();
        let Some(text) = self.overlay.text(path).or_else(read) else { return false };
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        text.split(|letter: char| !is_part(letter)).any(|word| !word.is_empty() && is_wanted(word))
    }

    /// The macros of the command line.
    pub(crate) fn given(&self) -> BTreeSet<String> {
        self.sources.defines.iter().map(|(name, _)| name.clone()).collect()
    }

    /// The files that may include a file, and those that it stands before.
    fn readers_of(&self, file: &Path) -> Vec<PathBuf> {
        let mut readers = self.includes.of(file);
        let engines = self.session.engines();
        if engines.is_prelude(file) {
            let is_reader =
                |path: &&PathBuf| *path != file && engines.preludes(path).iter().any(|prelude| prelude == file);
            readers.extend(self.includes.files().filter(is_reader).cloned());
        }
        readers
    }

    fn note_folder(&mut self, file: &Path) {
        if let Some(folder) = file.parent() {
            self.folders.insert(folder.to_owned());
        }
    }

    /// The stages of a file: one, unless it contains several.
    fn inputs(&self, path: &Path) -> Vec<Input> {
        let input = |stage| {
            vec![Input { name: path.to_string_lossy().into_owned(), path: Some(path.to_owned()), stage, part: None }]
        };
        if Host::of(path).is_some() {
            let text = self.overlay.text(path);
            return text.map_or_else(Vec::new, |text| strings::inputs_in(path, &text));
        }
        if let Some(stage) = stages::by_name(path) {
            return input(stage);
        }
        let parts = match self.overlay.text(path) {
            Some(text) => inputs::parts_in(path, &text),
            None if stages::may_be_combined(path) => inputs::parts(path),
            None => Vec::new(),
        };
        if !parts.is_empty() {
            return parts;
        }
        self.session.engines().stage(path).map(input).unwrap_or_default()
    }

    fn keep(&mut self, group: Group) -> ProgramKey {
        let files = group.inputs.iter().filter_map(|input| input.path.clone()).collect();
        let key = ProgramKey { name: group.name.clone(), files };
        self.groups.insert(key.clone(), group);
        key
    }

    /// The findings of those rules that can report anything in a program's files.
    fn lints(&mut self, compilation: &Compilation) -> Vec<Diagnostic> {
        let Some(program) = &compilation.program else { return Vec::new() };
        let files = compilation.sources.files();
        let levels: Vec<Levels> = files.map(|(_, file)| self.session.levels_of(file.name())).collect();
        let wanted = |code: &Code| levels.iter().any(|levels| levels.may_report(code));
        match guard::guarded(|| check_some(program, &compilation.sources, wanted)) {
            Ok(found) => found,
            Err(panic) => {
                let base = compilation.sources.files().next().map_or(0, |(_, file)| file.base());
                vec![guard::diagnostic(&panic, Span::new(base, base))]
            }
        }
    }

    /// The baseline that counts for a program. One that is not there, or is none, leaves nothing out.
    fn baseline_of(&mut self, group: &Group) -> Option<&Baseline> {
        if self.baseline.is_some() {
            return self.baseline.as_ref();
        }
        let path = self.session.settings_of(&group.inputs.first()?.name).baseline.clone()?;
        let read = |path: &PathBuf| Baseline::new(&BaselineArgs::of(Some(path.clone()))).ok().flatten();
        self.baselines.entry(path.clone()).or_insert_with(|| read(&path)).as_ref()
    }

    /// The ranges of inputs that the configuration of a program states.
    fn ranges_of(&mut self, group: &Group) -> Vec<(String, Bounds)> {
        let first = group.inputs.first();
        first.map_or_else(Vec::new, |input| self.session.settings_of(&input.name).ranges.clone())
    }

    /// The findings of the rules as far as they are judged by runs.
    fn judged_lints(
        &mut self,
        key: &ProgramKey,
        group: &Group,
        compilation: &Compilation,
        lints: Vec<Diagnostic>,
    ) -> Vec<Diagnostic> {
        let Some(linked) = &compilation.program else { return lints };
        let ranges = self.ranges_of(group);
        let case = Judging { group, program: linked, sources: &compilation.sources, ranges: &ranges };
        self.judged.told(key, &case, lints)
    }

    /// The compiler for a program.
    fn compiler(&self, group: &Group) -> Compiler {
        let compiler = self.session.compiler();
        let open = |input: &Input| self.overlay.text(input.path.as_deref()?);
        let text = group.inputs.first().and_then(open);
        let own = text.and_then(|text| strings::compiler(compiler, self.session.engines(), group, &text));
        own.unwrap_or_else(|| compiler.clone())
    }

    /// Lets findings in a part of a file show the lines of the file.
    fn show_files(&self, group: &Group, sources: &mut SourceMap) {
        strings::show_files(group, sources, |input| {
            let open = input.path.as_deref().and_then(|path| self.overlay.text(path));
            open.or_else(|| files::read_source(&input.name, input.path.as_deref()).ok())
        });
    }

    /// Drops findings that depend on what strings leave open.
    fn keep_certain(&self, group: &Group, batch: &mut Batch) {
        let Some(path) = group.inputs.first().and_then(|input| input.path.as_deref()) else { return };
        let Some(text) = self.overlay.text(path).filter(|_| Host::of(path).is_some()) else { return };
        strings::keep_certain(group, &text, batch, |group| {
            let (sources, ..) = self.read(&group);
            let compilation = guard::guarded(|| self.compiler(&group).compile(&sources)).ok()?;
            Some(Batch { sources: compilation.sources, diagnostics: compilation.diagnostics.into_iter().collect() })
        });
    }

    /// The sources of a program, and what cannot be read.
    fn read(&self, group: &Group) -> (Vec<Source>, Vec<Diagnostic>, SourceMap) {
        let (mut sources, mut unread, mut map) = (Vec::new(), Vec::new(), SourceMap::default());
        for input in &group.inputs {
            let open = input.path.as_deref().and_then(|path| self.overlay.text(path));
            let text = match open {
                Some(text) => Ok(text),
                None => files::read_source(&input.name, input.path.as_deref()),
            };
            match text {
                Ok(text) => {
                    let text = input.part.as_ref().map_or(text.clone(), |part| part.text(&text, input.stage));
                    sources.push(Source { name: input.name.clone(), text, stage: input.stage });
                }
                Err(error) => unread.push(error.diagnostic(&mut map, &input.name)),
            }
        }
        (sources, unread, map)
    }
}

/// The source of a file in which a text that was cut stands, and the text as it is read: that stage which the end of the text is in.
fn read_at<'g>(group: &'g Group, file: &Path, text: &Arc<str>) -> Option<(&'g Input, Arc<str>)> {
    let own = group.inputs.iter().filter(|input| input.path.as_deref() == Some(file));
    let read = own.map(|input| match &input.part {
        // The text is that of a shader in a string already, if it is one.
        Some(part) if part.host().is_none() => (input, part.text(text, input.stage)),
        _ => (input, Arc::clone(text)),
    });
    read.max_by_key(|(_, text)| text.trim_end().len())
}

/// The folder of texts of the program that an editor shows.
fn texts_folder() -> Option<PathBuf> {
    let folder = std::env::temp_dir().join(concat!("glisten-", env!("CARGO_PKG_VERSION")));
    std::fs::create_dir_all(&folder).ok()?;
    Some(folder)
}

/// Writes a file, unless it has this text already.
fn keep_text(path: &Path, text: &[u8]) -> Option<()> {
    if std::fs::read(path).ok().as_deref() == Some(text) {
        return Some(());
    }
    files::replace(path, text).ok()
}

fn session<'a>(
    console: &'a Console,
    sources: &SourceArgs,
    levels: &LevelArgs,
    bindings: &BindingArgs,
    overlay: &Overlay,
) -> Result<Session<'a>, Failure> {
    let engines = Engines::new(sources)?.with_disk(Arc::new(Open(overlay.clone())));
    Ok(Session::new(console, sources, bindings, levels, 1)?.with_engines(engines, sources, bindings))
}

impl Project for Files<'_> {
    fn overlay(&self) -> &Overlay {
        &self.overlay
    }

    fn programs_of(&mut self, file: &Path) -> Vec<ProgramKey> {
        self.note_folder(file);
        let own = self.inputs(file);
        if own.is_empty() || stages::is_part(file) && self.overlay.text(file).is_none() {
            return Vec::new();
        }
        if Host::of(file).is_some() {
            return inputs::group(own).into_iter().map(|group| self.keep(group)).collect();
        }
        let stem = stages::stem(file);
        let folder = file.parent().unwrap_or(Path::new("."));
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut listed: BTreeSet<PathBuf> =
            entries.map(|entry| entry.path()).filter(|path| path.is_file() && stages::stem(path) == stem).collect();
        listed.insert(file.to_owned());
        let engines = self.session.engines().clone();
        let is_taken = |path: &PathBuf| path == file || matches!(search::classify(path, &engines), Some(Ok(())));
        let inputs = listed.iter().filter(|path| is_taken(path)).flat_map(|path| self.inputs(path)).collect();
        let groups = inputs::without_gaps(inputs::group(inputs), &|_| true).into_iter();
        let has = |group: &Group| group.inputs.iter().any(|input| input.path.as_deref() == Some(file));
        groups.filter(has).map(|group| self.keep(group)).collect()
    }

    fn includers_of(&mut self, file: &Path, folders: &[PathBuf]) -> Vec<ProgramKey> {
        for folder in folders {
            self.includes.add(folder);
        }
        let mut keys: Vec<ProgramKey> = Vec::new();
        for includer in self.readers_of(file) {
            if keys.len() >= MAX_INCLUDERS {
                break;
            }
            for key in self.programs_of(&includer) {
                if !keys.contains(&key) {
                    keys.push(key);
                }
            }
        }
        keys
    }

    fn users_of(&mut self, file: &Path, folders: &[PathBuf], words: &[&str]) -> (Vec<ProgramKey>, bool) {
        for folder in folders {
            self.includes.add(folder);
        }
        let mut keys: BTreeSet<ProgramKey> = BTreeSet::new();
        for includer in self.readers_of(file) {
            if !self.has_word(&includer, &|word| words.contains(&word)) {
                continue;
            }
            let own = self.programs_of(&includer);
            // What is included itself is used by its includers, of which some are enough.
            let used = if own.is_empty() { self.includers_of(&includer, folders) } else { own };
            keys.extend(used);
            if keys.len() >= MAX_USERS {
                return (keys.into_iter().collect(), true);
            }
        }
        (keys.into_iter().collect(), false)
    }

    fn includes_changed(&mut self, file: &Path) {
        if let Some(text) = self.overlay.text(file) {
            self.includes.set(file, &text);
        }
    }

    fn programs_with(&mut self, folder: &Path, is_wanted: &dyn Fn(&str) -> bool, most: usize) -> Vec<ProgramKey> {
        self.includes.add(folder);
        let files: Vec<PathBuf> = self.includes.files().filter(|path| path.starts_with(folder)).cloned().collect();
        let mut keys: BTreeSet<ProgramKey> = BTreeSet::new();
        for file in files {
            if keys.len() >= most {
                break;
            }
            if keys.iter().any(|key| key.files.contains(&file)) || !self.has_word(&file, is_wanted) {
                continue;
            }
            let own = self.programs_of(&file);
            if own.is_empty() {
                let includers = self.includes.of(&file);
                keys.extend(includers.iter().find_map(|includer| self.programs_of(includer).into_iter().next()));
            } else {
                keys.extend(own);
            }
        }
        keys.into_iter().collect()
    }

    fn alone(&mut self, file: &Path) -> ProgramKey {
        self.note_folder(file);
        let mut inputs = self.inputs(file);
        if inputs.is_empty() {
            let name = file.to_string_lossy().into_owned();
            inputs.push(Input { name, path: Some(file.to_owned()), stage: Stage::Fragment, part: None });
        }
        let name = format!("{} alone", stages::stem(file));
        self.keep(Group::new(name, inputs))
    }

    fn compile(&mut self, program: &ProgramKey) -> Compiled {
        let Some(group) = self.groups.get(program).cloned() else { return nothing() };
        let (sources, unread, map) = self.read(&group);
        if sources.is_empty() {
            return Compiled { findings: unread, sources: map, ..nothing() };
        }
        let compiler = self.compiler(&group);
        match guard::guarded(|| compiler.inspect(&sources, None)) {
            Ok((mut compilation, inspection)) => {
                self.show_files(&group, &mut compilation.sources);
                let lints = self.lints(&compilation);
                let lints = self.judged_lints(program, &group, &compilation, lints);
                let mut batch = Batch { sources: compilation.sources, diagnostics: Vec::new() };
                let mut found: Vec<Diagnostic> = compilation.diagnostics.into_iter().collect();
                if group.has_files() {
                    // The names of files are all that tells the programs here.
                    allow_more_shaders(&mut found);
                }
                self.session.add(&mut batch, found);
                self.session.add(&mut batch, lints);
                self.keep_certain(&group, &mut batch);
                if let Some(baseline) = self.baseline_of(&group) {
                    baseline.keep_new(&mut batch);
                }
                let program = compilation.program.map(|linked| Program { name: group.name.clone(), ..linked });
                Compiled {
                    sources: batch.sources,
                    findings: batch.diagnostics,
                    inspection,
                    program: program.filter(|_| unread.is_empty()),
                    read: compilation.read,
                }
            }
            Err(panic) => {
                let mut map = SourceMap::default();
                let mut span = Span::default();
                for source in sources.iter().rev() {
                    if let Some(id) = map.add(source.name.clone(), source.text.clone()) {
                        span = Span::new(map.file(id).base(), map.file(id).base());
                    }
                }
                Compiled { findings: vec![guard::diagnostic(&panic, span)], sources: map, ..nothing() }
            }
        }
    }

    fn find_witnesses(&mut self) -> Option<ProgramKey> {
        let key = self.judged.next()?;
        let group = self.groups.get(&key).cloned()?;
        let (sources, unread, _) = self.read(&group);
        if sources.is_empty() || !unread.is_empty() {
            return None;
        }
        let compiler = self.compiler(&group);
        let compilation = guard::guarded(|| compiler.inspect(&sources, None)).ok()?.0;
        let linked = compilation.program.as_ref()?;
        let found = self.lints(&compilation);
        let ranges = self.ranges_of(&group);
        let files = compilation.sources.files();
        let levels: Vec<Levels> = files.map(|(_, file)| self.session.levels_of(file.name())).collect();
        let wanted = |code: &Code| levels.iter().any(|levels| levels.may_report(code));
        let case = Judging { group: &group, program: linked, sources: &compilation.sources, ranges: &ranges };
        let files = OpenFiles(self.overlay.clone());
        self.judged.find_witnesses(&key, &case, (&compiler, &files), wanted, found).then_some(key)
    }

    fn probe(&mut self, program: &ProgramKey, file: &Path, text: Arc<str>, probe: Option<&str>) -> Option<Compiled> {
        let group = self.groups.get(program)?;
        let input = read_at(group, file, &text);
        // A header stands for itself: what is read before it is unknown, so its includer is compiled with the text in its place.
        let before = self.overlay.text(file);
        let sources = match input {
            Some((input, text)) => vec![Source { name: input.name.clone(), text, stage: input.stage }],
            None => {
                self.overlay.set(file, Some(text));
                let group = group.clone();
                self.read(&group).0
            }
        };
        let (is_include, group) =
            (!group.inputs.iter().any(|input| input.path.as_deref() == Some(file)), group.clone());
        let compiler = self.compiler(&group);
        let done = guard::guarded(|| compiler.inspect(&sources, probe));
        if is_include {
            self.overlay.set(file, before);
        }
        let (mut compilation, inspection) = done.ok()?;
        self.show_files(&group, &mut compilation.sources);
        Some(Compiled {
            sources: compilation.sources,
            findings: Vec::new(),
            inspection,
            program: None,
            read: compilation.read,
        })
    }

    fn style(&mut self, file: &Path) -> Option<Options> {
        self.note_folder(file);
        self.session.read_configuration(&file.to_string_lossy());
        self.session
            .configuration_errors()
            .is_empty()
            .then(|| config::style_of(file.parent().unwrap_or(Path::new("."))))
    }

    fn format(&mut self, file: &Path, text: &str, style: &Options) -> Formatted {
        fmt::formatted(text, file, style)
    }

    fn pieces(&self, file: &Path, text: &str) -> Option<Vec<Piece>> {
        let programs = strings::programs(file, text)?;
        let inputs = strings::inputs_in(file, text);
        let has_own_comments = Host::of(file) != Some(Host::Python);
        let mut pieces = Vec::new();
        for (input, shader) in inputs.iter().zip(programs.iter().flat_map(|program| &program.shaders)) {
            let text = shader.text(text, Filling::Name);
            pieces.push(Piece { inside: shader.inside.clone(), text, program: input.stem(), has_own_comments });
        }
        Some(pieces)
    }

    fn format_pieces(&mut self, file: &Path, text: &str, style: &Options) -> String {
        let programs = strings::programs(file, text).unwrap_or_default();
        styled(text, &programs, &mut |text| fmt::formatted(text, Path::new("string.glsl"), style).text)
    }

    fn configuration_findings(&mut self) -> Vec<(SourceMap, Vec<Diagnostic>)> {
        let files: Vec<PathBuf> = self.folders.iter().map(|folder| folder.join("source")).collect();
        for file in files {
            self.session.read_configuration(&file.to_string_lossy());
        }
        let errors = self.session.configuration_errors().iter();
        errors.map(|batch| (batch.sources.clone(), batch.diagnostics.clone())).collect()
    }

    fn configurations(&self) -> Vec<PathBuf> {
        let above = self.folders.iter().flat_map(|folder| folder.ancestors());
        let mut paths: Vec<PathBuf> = above.map(|folder| folder.join(CONFIGURATION)).collect();
        paths.extend(self.baselines.keys().cloned());
        paths.extend(self.baseline.as_ref().map(|baseline| files::real(baseline.path())));
        paths.sort();
        paths.dedup();
        paths
    }

    fn reload(&mut self) {
        // The arguments were good before; if a prelude is gone meanwhile, the old one stays.
        self.scenes = None;
        let mut sources = self.sources.clone();
        sources.defines.extend(self.chosen.clone());
        if let Ok(session) = session(self.console, &sources, self.levels, self.bindings, &self.overlay) {
            self.session = session;
        }
        self.groups.clear();
        self.baselines.clear();
        // As long as it cannot be read, what was known is.
        let again = self.baseline.as_ref().map(|old| Baseline::new(&BaselineArgs::of(Some(old.path().to_owned()))));
        if let Some(Ok(Some(read))) = again {
            self.baseline = Some(read);
        }
        self.judged.clear();
        self.includes = Includes::default();
    }

    fn embedded(&self, name: &str) -> Option<PathBuf> {
        let file = name.strip_prefix("<glisten>/")?;
        glisten_library::modules().iter().find(|module| file.strip_suffix(".glsl") == Some(module.name))?;
        let folder = texts_folder()?;
        // Modules include each other.
        for module in glisten_library::modules() {
            keep_text(&folder.join(format!("{}.glsl", module.name)), module.text.as_bytes())?;
        }
        Some(folder.join(file))
    }

    fn explained(&self, code: &'static Code) -> Option<PathBuf> {
        let write = || {
            let path = texts_folder()?.join(format!("{}.txt", code.id));
            keep_text(&path, page(code).as_bytes())?;
            Some(path)
        };
        self.pages.borrow_mut().entry(code.id).or_insert_with(write).clone()
    }

    fn include_names(&mut self, file: &Path, written: &str, angled: bool) -> Vec<String> {
        let within = written.rsplit_once('/').map_or("", |(folder, _)| folder);
        let mut names = Vec::new();
        let mut folders = self.session.engines().folders(file);
        if !angled {
            folders.extend(file.parent().map(Path::to_owned));
        }
        for folder in folders {
            names.extend(listed(&folder.join(within.trim_start_matches('/'))));
        }
        if angled && within.is_empty() {
            names.push("glisten/".to_owned());
        }
        if angled && within == "glisten" {
            names.extend(glisten_library::modules().iter().map(|module| format!("{}.glsl", module.name)));
        }
        let own = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        names.retain(|name| *name != own);
        names.sort();
        names.dedup();
        names
    }

    fn scenes(&mut self, folders: &[PathBuf], fresh: bool) -> Vec<(PathBuf, Arc<str>)> {
        let known = self.scenes.take();
        let known = known.filter(|known| !fresh && known.folders == folders && known.read.elapsed() < FRESH);
        let known =
            known.unwrap_or_else(|| Scenes { read: Instant::now(), folders: folders.to_vec(), found: scenes(folders) });
        let mut scenes = known.found.clone();
        self.scenes = Some(known);
        for (path, text) in &mut scenes {
            if let Some(open) = self.overlay.text(path) {
                *text = open;
            }
        }
        scenes
    }

    fn is_about_a_part(&self, finding: &Diagnostic) -> bool {
        [&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION].contains(&finding.code)
    }
}

/// The result of a program that there is nothing to say about.
fn nothing() -> Compiled {
    Compiled {
        sources: SourceMap::default(),
        findings: Vec::new(),
        inspection: Inspection::default(),
        program: None,
        read: Vec::new(),
    }
}
