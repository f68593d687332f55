//! [`Files`]: the answers of the program to the language server, which are those of `glisten lint`.
//!
//! *In:* paths, and the texts of open documents. *Out:* programs, what the compiler says of them with the levels of their
//! configurations, styles. *Holds:* a text in the editor counts instead of the file. A panic of the compiler is a finding.

use super::args::{BindingArgs, LevelArgs, SourceArgs};
use super::batch::Batch;
use super::console::Console;
use super::engine::{Engines, Traced};
use super::exit::Failure;
use super::files;
use super::inputs::{self, Group, Input};
use super::lsp_files::{self, Includes};
use super::session::Session;
use super::{config, fmt, guard, search};
use crate::format::{Formatted, Options};
use crate::library;
use crate::lsp::{Compiled, Overlay, ProgramKey, Project};
use crate::sources::{Disk, stages};
use glisten_front::compiler::{Compilation, Source};
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::{Code, Diagnostic, Levels};
use glisten_front::hir::Stage;
use glisten_front::index::Inspection;
use glisten_front::link::Program;
use glisten_front::lint::check_some;
use glisten_front::source::{SourceMap, Span};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The name of a configuration.
const CONFIGURATION: &str = "glisten.toml";
/// The largest number of programs that are tried for a header.
const MAX_INCLUDERS: usize = 12;

/// Files, configurations and the compiler.
pub(super) struct Files<'a> {
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
}

/// Reads included files, the open documents first.
struct Open(Overlay);

impl Disk for Open {
    fn text(&self, path: &Path) -> Result<Arc<str>, String> {
        self.0.text(path).map_or_else(|| Traced.text(path), Ok)
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
    pub(super) fn new(
        console: &'a Console,
        sources: &'a SourceArgs,
        levels: &'a LevelArgs,
        bindings: &'a BindingArgs,
    ) -> Result<Self, Failure> {
        let overlay = Overlay::default();
        let session = session(console, sources, levels, bindings, &overlay)?;
        let (groups, includes, folders) = Default::default();
        Ok(Self { console, sources, levels, bindings, overlay, session, groups, includes, folders })
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
        let stem = stages::stem(file);
        let folder = file.parent().unwrap_or(Path::new("."));
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        let mut listed: BTreeSet<PathBuf> =
            entries.map(|entry| entry.path()).filter(|path| path.is_file() && stages::stem(path) == stem).collect();
        listed.insert(file.to_owned());
        let engines = self.session.engines().clone();
        let is_taken = |path: &PathBuf| path == file || matches!(search::classify(path, &engines), Some(Ok(())));
        let inputs = listed.iter().filter(|path| is_taken(path)).flat_map(|path| self.inputs(path)).collect();
        let groups = inputs::group(inputs).into_iter();
        let has = |group: &Group| group.inputs.iter().any(|input| input.path.as_deref() == Some(file));
        groups.filter(has).map(|group| self.keep(group)).collect()
    }

    fn includers_of(&mut self, file: &Path, folders: &[PathBuf]) -> Vec<ProgramKey> {
        for folder in folders {
            self.includes.add(folder);
        }
        let mut keys: Vec<ProgramKey> = Vec::new();
        for includer in self.includes.of(file) {
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

    fn includes_changed(&mut self, file: &Path) {
        if let Some(text) = self.overlay.text(file) {
            self.includes.set(file, &text);
        }
    }

    fn programs_in(&mut self, folder: &Path) -> Vec<ProgramKey> {
        self.includes.add(folder);
        let engines = self.session.engines().clone();
        let files: Vec<PathBuf> = self.includes.files().filter(|path| path.starts_with(folder)).cloned().collect();
        let inputs = files.iter().filter(|path| matches!(search::classify(path, &engines), Some(Ok(()))));
        let inputs = inputs.flat_map(|path| self.inputs(path)).collect();
        inputs::group(inputs).into_iter().map(|group| self.keep(group)).collect()
    }

    fn alone(&mut self, file: &Path) -> ProgramKey {
        self.note_folder(file);
        let mut inputs = self.inputs(file);
        if inputs.is_empty() {
            let name = file.to_string_lossy().into_owned();
            inputs.push(Input { name, path: Some(file.to_owned()), stage: Stage::Fragment, part: None });
        }
        let name = format!("{} alone", stages::stem(file));
        self.keep(Group { name, inputs })
    }

    fn compile(&mut self, program: &ProgramKey) -> Compiled {
        let Some(group) = self.groups.get(program).cloned() else { return nothing() };
        let (sources, unread, map) = self.read(&group);
        if sources.is_empty() {
            return Compiled { findings: unread, sources: map, ..nothing() };
        }
        let compiler = self.session.compiler();
        match guard::guarded(|| compiler.inspect(&sources, None)) {
            Ok((compilation, inspection)) => {
                let lints = self.lints(&compilation);
                let mut batch = Batch { sources: compilation.sources, diagnostics: Vec::new() };
                let found: Vec<Diagnostic> = compilation.diagnostics.into_iter().collect();
                self.session.add(&mut batch, found);
                self.session.add(&mut batch, lints);
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

    fn probe(&mut self, program: &ProgramKey, file: &Path, text: Arc<str>, probe: Option<&str>) -> Option<Compiled> {
        let group = self.groups.get(program)?;
        let input = group.inputs.iter().find(|input| input.path.as_deref() == Some(file));
        // A header stands for itself: what is read before it is unknown, so its includer is compiled with the text in its place.
        let before = self.overlay.text(file);
        let sources = match input {
            Some(input) => {
                let text = input.part.as_ref().map_or(text.clone(), |part| part.text(&text, input.stage));
                vec![Source { name: input.name.clone(), text, stage: input.stage }]
            }
            None => {
                self.overlay.set(file, Some(text));
                let group = group.clone();
                self.read(&group).0
            }
        };
        let compiler = self.session.compiler();
        let done = guard::guarded(|| compiler.inspect(&sources, probe));
        if input.is_none() {
            self.overlay.set(file, before);
        }
        let (compilation, inspection) = done.ok()?;
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
        paths.sort();
        paths.dedup();
        paths
    }

    fn reload(&mut self) {
        // The arguments were good before; if a prelude is gone meanwhile, the old one stays.
        if let Ok(session) = session(self.console, self.sources, self.levels, self.bindings, &self.overlay) {
            self.session = session;
        }
        self.groups.clear();
        self.includes = Includes::default();
    }

    fn embedded(&self, name: &str) -> Option<PathBuf> {
        let file = name.strip_prefix("<glisten>/")?;
        library::modules().iter().find(|module| file.strip_suffix(".glsl") == Some(module.name))?;
        let folder = std::env::temp_dir().join(concat!("glisten-", env!("CARGO_PKG_VERSION")));
        std::fs::create_dir_all(&folder).ok()?;
        // Modules include each other.
        for module in library::modules() {
            let path = folder.join(format!("{}.glsl", module.name));
            if std::fs::read(&path).ok().as_deref() != Some(module.text.as_bytes()) {
                files::write(&path, module.text.as_bytes()).ok()?;
            }
        }
        Some(folder.join(file))
    }

    fn include_names(&mut self, file: &Path, written: &str, angled: bool) -> Vec<String> {
        let within = written.rsplit_once('/').map_or("", |(folder, _)| folder);
        let mut names = Vec::new();
        let mut folders = self.session.engines().folders(file);
        if !angled {
            folders.extend(file.parent().map(Path::to_owned));
        }
        for folder in folders {
            names.extend(lsp_files::listed(&folder.join(within.trim_start_matches('/'))));
        }
        if angled && within.is_empty() {
            names.push("glisten/".to_owned());
        }
        if angled && within == "glisten" {
            names.extend(library::modules().iter().map(|module| format!("{}.glsl", module.name)));
        }
        let own = file.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        names.retain(|name| *name != own);
        names.sort();
        names.dedup();
        names
    }

    fn scenes(&mut self, folders: &[PathBuf]) -> Vec<(PathBuf, Arc<str>)> {
        let mut scenes = lsp_files::scenes(folders);
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
