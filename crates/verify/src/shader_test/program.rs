//! The program of a test: compiles and links its shaders, and checks whether the link should succeed.

use super::fixed::other_stage;
use super::parse::{ShaderText, TestFile};
use super::require::Setup;
use super::{TestResult, fail};
use glisten_front::compiler::{Compilation, Compiler, Options, Source};
use glisten_front::diagnostic::codes::general::NOT_SUPPORTED_YET;
use glisten_front::diagnostic::codes::{Code, qualifiers, statements};
use glisten_front::diagnostic::{Diagnostic, Diagnostics};
use glisten_front::hir::Stage;
use glisten_front::link::{FixedState, Program};
use glisten_front::source::SourceMap;
use std::sync::Arc;

/// A program, and how it is compiled again for other state of the fixed-function pipeline.
pub(super) struct Built {
    pub(super) program: Arc<Program>,
    sources: Vec<Source>,
    compiler: Compiler,
    variants: Vec<(FixedState, Arc<Program>)>,
}

impl Built {
    /// The program for a state. A test changes the state between draws.
    pub(super) fn variant(&mut self, fixed: FixedState) -> Result<Arc<Program>, TestResult> {
        if fixed == FixedState::default() {
            return Ok(Arc::clone(&self.program));
        }
        if let Some((_, program)) = self.variants.iter().find(|(known, _)| *known == fixed) {
            return Ok(Arc::clone(program));
        }
        let options = Options { fixed, ..self.compiler.options().clone() };
        let compilation = self.compiler.with_options(options).compile(&self.sources);
        let program = linked(compilation)?;
        self.variants.push((fixed, Arc::clone(&program)));
        Ok(program)
    }
}

/// The shaders of a test called `name`.
fn sources(name: &str, file: &TestFile, setup: &Setup) -> Vec<Source> {
    let source = |shader: &ShaderText| {
        let text = if shader.passthrough { passthrough(setup) } else { versioned(shader, setup) };
        Source { name: name.into(), text: text.into(), stage: shader.stage }
    };
    file.shaders.iter().map(source).collect()
}

/// The compilation of the shaders of a test, unless it has an error that the test wants, or that is told as a skip.
pub(super) fn compilation(name: &str, file: &TestFile, setup: &Setup, compiler: &Compiler) -> Option<Compilation> {
    let compilation = compiler.compile(&sources(name, file, setup));
    let is_wanted = file.commands.iter().any(|line| line.text.starts_with("link error"));
    (compilation.program.is_some() || !is_wanted && !is_unsupported(&compilation)).then_some(compilation)
}

/// The program, or `None` if it does not link and the test expects `link error`.
pub(super) fn build(
    name: &str,
    file: &TestFile,
    setup: &Setup,
    compiler: &Compiler,
) -> Result<Option<Built>, TestResult> {
    let mut sources = sources(name, file, setup);
    let mut compilation = compiler.compile(&sources);
    let expects = |phrase: &str| file.commands.iter().any(|line| line.text.starts_with(phrase));
    match &compilation.program {
        Some(program) if expects("link error") => {
            let command = file.commands.iter().find(|line| line.text.starts_with("link error"));
            let line = command.map_or(0, |line| line.number);
            return fail(line, format_args!("program `{}` links, and the test expects a link error", program.name));
        }
        Some(program) if expects("draw") => {
            // A stage that is missing is that of the fixed-function pipeline.
            let missing = [Stage::Vertex, Stage::Fragment].into_iter().find(|stage| program.stage(*stage).is_none());
            if let Some(stage) = missing {
                let clips = expects("clip plane");
                let next = if stage == Stage::Vertex { program.stages.first() } else { program.stages.last() };
                let text = other_stage(stage, &program.types, next, clips);
                let source = Source { name: name.into(), text: text.into(), stage };
                sources.insert(if stage == Stage::Vertex { 0 } else { sources.len() }, source);
                compilation = compiler.compile(&sources);
            }
        }
        None if expects("link error") => return no_link(&compilation).map(|()| None),
        _ => {}
    }
    let program = linked(compilation)?;
    Ok(Some(Built { program, sources, compiler: compiler.clone(), variants: Vec::new() }))
}

fn linked(compilation: Compilation) -> Result<Arc<Program>, TestResult> {
    if let Some(program) = compilation.program {
        return Ok(Arc::new(program));
    }
    let reason = first_error(&compilation.diagnostics, &compilation.sources, Diagnostic::is_error);
    match is_unsupported(&compilation) {
        true => Err(TestResult::Skip(reason)),
        false => Err(TestResult::Fail(reason)),
    }
}

fn is_unsupported(compilation: &Compilation) -> bool {
    compilation.diagnostics.iter().any(|diagnostic| *diagnostic.code == NOT_SUPPORTED_YET)
}

/// Whether shaders that become no program do so as a test that expects a link error wants it: each of them compiles.
fn no_link(compilation: &Compilation) -> Result<(), TestResult> {
    let is_of_shader = |found: &Diagnostic| found.is_error() && !is_of_link(found.code);
    if !compilation.diagnostics.iter().any(is_of_shader) {
        return Ok(());
    }
    let reason = first_error(&compilation.diagnostics, &compilation.sources, is_of_shader);
    match is_unsupported(compilation) {
        true => Err(TestResult::Skip(reason)),
        false => {
            Err(TestResult::Fail(format!("{reason}; the test expects a link error, and this shader does not compile")))
        }
    }
}

/// How the codes of the errors of a link begin.
const LINK: &str = "E07";

/// Whether an error is one of the program: of its stages together, or of its call graph (GLSL 1.50 §6.1).
fn is_of_link(code: &Code) -> bool {
    code.id.starts_with(LINK) || [&statements::RECURSION, &qualifiers::OUTPUTS_EXCLUDE].contains(&code)
}

fn first_error(diagnostics: &Diagnostics, sources: &SourceMap, is_meant: impl Fn(&Diagnostic) -> bool) -> String {
    let Some(error) = diagnostics.iter().find(|diagnostic| is_meant(diagnostic)) else {
        return "it does not compile".into();
    };
    let line = sources.location(error.primary.span).map_or(0, |location| location.line);
    format!("line {line}: {} ({})", error.message, error.code.id)
}

/// The text of `[vertex shader passthrough]`.
fn passthrough(setup: &Setup) -> String {
    let (version, input) = match setup {
        Setup { es: true, version: 300.., .. } => (version_line(setup), "in"),
        Setup { es: true, .. } => (version_line(setup), "attribute"),
        _ => ("#version 150".to_owned(), "in"),
    };
    format!("{version}\n{input} vec4 piglit_vertex;\nvoid main() {{ gl_Position = piglit_vertex; }}\n")
}

fn version_line(setup: &Setup) -> String {
    let profile = if setup.es && setup.version >= 300 { " es" } else { "" };
    format!("#version {}{profile}", setup.version)
}

/// The text with a `#version` line, after so many empty lines that its line numbers are those of the test. If it has none of its own, one
/// of the empty lines becomes one, and others become lines for the extensions that a context enables for every shader: those of a
/// compatibility context of 1.40, and ARB_texture_rectangle on a desktop.
fn versioned(shader: &ShaderText, setup: &Setup) -> String {
    let ShaderText { text, header, .. } = shader;
    let own = text.lines().find(|line| line.trim_start().starts_with("#version"));
    let version = own.map_or_else(|| version_line(setup), |line| line.trim().to_owned());
    let mut added = Vec::new();
    if setup.compatibility && version == "#version 140" {
        added.push("#extension GL_ARB_compatibility : enable");
    }
    if !setup.es && text.contains("2DRect") && !text.contains("GL_ARB_texture_rectangle") {
        added.push("#extension GL_ARB_texture_rectangle : enable");
    }
    let empty = *header as usize;
    // GLSL ES wants the version in the first line of the shader, which the section's first line is.
    let is_first = version.ends_with(" es") && own == text.lines().next();
    if own.is_some() && added.is_empty() && !is_first {
        return "\n".repeat(empty) + text;
    }
    let rest = own.map_or_else(|| text.clone(), |line| text.replacen(line, "", 1));
    let lines: String = added.iter().map(|line| format!("{line}\n")).collect();
    format!("{version}\n{lines}{}{rest}", "\n".repeat(empty.saturating_sub(added.len() + 1)))
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn a_text_without_a_version_gets_that_of_the_test() {
        let setup = Setup { size: [1, 1], compatibility: false, version: 130, es: false };
        let versioned = |text: &str, header, setup: &Setup| {
            versioned(&ShaderText { stage: Stage::Fragment, text: text.into(), header, passthrough: false }, setup)
        };
        assert_eq!(versioned("void main() {}\n", 2, &setup), "#version 130\n\nvoid main() {}\n");
        assert_eq!(versioned("#version 150\n", 2, &setup), "\n\n#version 150\n");
        let es = Setup { version: 300, es: true, ..setup };
        assert_eq!(versioned("void main() {}\n", 1, &es), "#version 300 es\nvoid main() {}\n");
        assert_eq!(versioned("#version 310 es\nint a;\n", 2, &es), "#version 310 es\n\n\nint a;\n");
        assert_eq!(versioned("//\n#version 310 es\n", 1, &es), "\n//\n#version 310 es\n");
        let compatibility = Setup { version: 140, compatibility: true, ..setup };
        let text = versioned("#version 140\nvoid main() {}\n", 3, &compatibility);
        assert_eq!(text, "#version 140\n#extension GL_ARB_compatibility : enable\n\n\nvoid main() {}\n");
        let rectangle = versioned("uniform sampler2DRect t;\n", 2, &setup);
        assert_eq!(rectangle, "#version 130\n#extension GL_ARB_texture_rectangle : enable\nuniform sampler2DRect t;\n");
    }
}
