//! [`compile`]: sources to a [`Compiled`] program, which emits code and a reflection, and tells what is wrong.
//!
//! *Holds:* a compiled program never changes, and can be used from many threads. The same input gives the same bytes.

use crate::error::Error;
use crate::settings::Settings;
use glisten::diagnostic::Severity;
use glisten::emit::{Emitted, Reflection, Target};
use glisten::source::SourceMap;
use glisten::{Program, Source, Stage};
use glisten_emit as emit;
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::write;
use glisten_front::diagnostic::write::Finding;
use glisten_front::lint;
use std::collections::HashSet;
use std::sync::OnceLock;

/// The targets that can be written.
pub fn targets() -> impl Iterator<Item = Target> {
    Target::ALL.iter().copied().filter(|target| target.is_there())
}

/// The target of a word.
///
/// # Errors
/// There is no such target, or this build cannot write it.
pub fn target_of_word(word: &str) -> Result<Target, Error> {
    let words = || targets().map(Target::word).collect::<Vec<_>>().join(", ");
    match Target::from_word(word) {
        Some(target) if target.is_there() => Ok(target),
        Some(target) => {
            let place = "only the module with the reference writes";
            Err(Error::argument(format!("{place} {}; this one writes {}", target.name(), words())))
        }
        None => Err(Error::argument(format!("`{word}` is no target: {}", words()))),
    }
}

/// A format of diagnostics.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Excerpts with carets.
    Human,
    /// A JSON array.
    Json,
    /// SARIF 2.1.0.
    Sarif,
    /// Workflow commands of GitHub Actions.
    Github,
}

/// Diagnostics with the texts that they are about.
#[derive(Debug, Default)]
pub(crate) struct Report {
    pub(crate) sources: SourceMap,
    pub(crate) diagnostics: Vec<Diagnostic>,
}

impl Report {
    pub(crate) fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(Diagnostic::is_error)
    }

    /// Leaves out what was found before at the same place: stages in one text share declarations.
    fn tell_once(&mut self) {
        let Self { sources, diagnostics } = self;
        let mut told = HashSet::new();
        diagnostics.retain(|diagnostic| {
            let place = sources.location(diagnostic.primary.span);
            let place = place.map(|place| (sources.file(place.file).name(), place.line, place.column));
            told.insert((place, diagnostic.code.id, diagnostic.message.clone()))
        });
    }

    /// The error that these diagnostics are, which only a use of the program shows.
    pub(crate) fn error(&self, found: &[Diagnostic]) -> Error {
        let message = write::human(&self.sources, found, false).trim_end().to_owned();
        let diagnostics = Some(write::json(&write::findings(&self.sources, found), None));
        Error { diagnostics, ..Error::content(message) }
    }

    pub(crate) fn findings(&self) -> Vec<Finding> {
        write::findings(&self.sources, &self.diagnostics)
    }

    pub(crate) fn text(&self, format: Format) -> String {
        match format {
            Format::Human => write::human(&self.sources, &self.diagnostics, false),
            Format::Json => write::json(&self.findings(), None),
            Format::Sarif => write::sarif(&self.findings(), None),
            Format::Github => write::github(&self.findings(), None),
        }
    }
}

/// The result of a compilation.
pub struct Compiled {
    settings: Settings,
    report: Report,
    program: Option<Program>,
    optimized: OnceLock<Program>,
}

/// Compiles the sources of one program; with `lints`, also looks for what is legal but will hurt.
///
/// # Errors
/// There are no sources.
pub fn compile(settings: &Settings, sources: &[Source], lints: bool) -> Result<Compiled, Error> {
    if sources.is_empty() {
        return Err(Error::argument("there are no sources"));
    }
    let compilation = settings.compiler_for(sources).compile(sources);
    let mut report =
        Report { sources: compilation.sources, diagnostics: compilation.diagnostics.into_iter().collect() };
    match &compilation.program {
        Some(program) if lints => {
            let mut found = lint::check(program, &report.sources);
            found.retain_mut(|diagnostic| settings.levels.apply(&report.sources, diagnostic));
            report.diagnostics.extend(found);
        }
        // A part of a program is legal, but nothing can be emitted for it.
        None if !lints => report.diagnostics.iter_mut().for_each(|diagnostic| {
            if [&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION].contains(&diagnostic.code) {
                diagnostic.severity = Severity::Error;
            }
        }),
        _ => {}
    }
    let place = |diagnostic: &Diagnostic| report.sources.call_site(diagnostic.primary.span).start;
    report.diagnostics.sort_by_key(place);
    report.tell_once();
    let program = compilation.program.filter(|_| !report.has_errors());
    Ok(Compiled { settings: settings.clone(), report, program, optimized: OnceLock::new() })
}

impl Compiled {
    /// Whether there are no errors. A part of a program without `main` has no errors for [`compile`] with lints alone.
    pub fn is_sound(&self) -> bool {
        !self.report.has_errors()
    }

    /// The diagnostics in the order of their places.
    pub fn findings(&self) -> Vec<Finding> {
        self.report.findings()
    }

    /// The diagnostics as a text.
    pub fn diagnostics(&self, format: Format) -> String {
        self.report.text(format)
    }

    /// The stages of the program, in the order of the pipeline; none if there are errors.
    pub fn stages(&self) -> Vec<Stage> {
        let stages = self.program.iter().flat_map(|program| &program.stages);
        stages.map(|shader| shader.stage).collect()
    }

    fn program(&self) -> Result<&Program, Error> {
        self.program.as_ref().ok_or_else(|| Error::content("there is no program, since its sources have errors"))
    }

    /// The program to emit for a target.
    fn program_for(&self, target: Target) -> Result<&Program, Error> {
        let program = self.program()?;
        Ok(match self.settings.optimizes(target) {
            true => self.optimized.get_or_init(|| glisten::emit::optimize(program)),
            false => program,
        })
    }

    /// The code of a stage.
    ///
    /// # Errors
    /// There is no such stage, or the target cannot represent something of it.
    pub fn emit(&self, stage: Stage, target: Target) -> Result<Vec<u8>, Error> {
        let program = self.program_for(target)?;
        if !self.stages().contains(&stage) {
            return Err(Error::argument(format!("the program has no {} stage", stage.name())));
        }
        let sources = Some(&self.report.sources);
        emit::emit_traced(program, stage, target, &self.settings.conventions, sources)
            .map(|traced| traced.emitted.into_bytes())
            .map_err(|errors| self.report.error(&errors))
    }

    /// What a host needs to know of the program as it is emitted for WGSL, as JSON.
    ///
    /// # Errors
    /// There is no program.
    pub fn reflect(&self) -> Result<String, Error> {
        let program = self.program_for(Target::Wgsl)?;
        let conventions = &self.settings.conventions;
        let mut reflection: Reflection = emit::reflect(program, conventions);
        for shader in &program.stages {
            if let Ok(Emitted::Text(text)) = emit::emit(program, shader.stage, Target::Wgsl, conventions) {
                reflection.name_in_wgsl(&text);
            }
        }
        reflection.compact();
        serde_json::to_string_pretty(&reflection)
            .map(|text| text + "\n")
            .map_err(|error| Error::content(format!("the reflection is no JSON: {error}")))
    }
}

#[cfg(test)]
mod tests {
    use super::{Format, compile};
    use crate::Settings;
    use crate::sources::stage_of_name;
    use glisten::emit::Target;
    use glisten::{Source, Stage};

    fn source(name: &str, text: &str) -> Source {
        let stage = stage_of_name(name).expect("a name with a stage");
        Source { name: name.into(), text: format!("#version 150\n{text}").into(), stage }
    }

    #[test]
    fn a_program_has_code_and_a_reflection() {
        let sources = [
            source("a.vert", "in vec4 p; void main() { gl_Position = p; }"),
            source("a.frag", "uniform vec4 tint; out vec4 c; void main() { c = tint; }"),
        ];
        let compiled = compile(&Settings::default(), &sources, false).expect("sources");
        assert_eq!(compiled.stages(), [Stage::Vertex, Stage::Fragment]);
        for target in Target::ALL {
            assert!(!compiled.emit(Stage::Fragment, *target).expect("code").is_empty());
        }
        assert!(compiled.emit(Stage::Geometry, Target::Wgsl).is_err());
        assert!(compiled.reflect().expect("a reflection").contains("\"tint\""));
    }

    #[test]
    fn errors_and_lints_are_told() {
        let wrong = [source("a.frag", "void main() { x = 1; }")];
        let compiled = compile(&Settings::default(), &wrong, false).expect("sources");
        assert!(!compiled.is_sound() && compiled.stages().is_empty() && compiled.reflect().is_err());
        assert!(compiled.diagnostics(Format::Human).contains("`x`"));
        let part = [source("a.frag", "float half_of(float x) { return 0.5 * x; }")];
        assert!(compile(&Settings::default(), &part, true).expect("sources").is_sound());
        assert!(!compile(&Settings::default(), &part, false).expect("sources").is_sound());
        let risky = [source("a.frag", "out vec4 c; void main() { float x; c = vec4(x); }")];
        let found = |lints| compile(&Settings::default(), &risky, lints).expect("sources").findings().len();
        assert!(found(true) > found(false), "lints find more");
    }
}
