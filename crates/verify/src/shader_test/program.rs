//! The program of a test: compiles and links its shaders, and checks whether the link should succeed.

use super::fixed::other_stage;
use super::parse::TestFile;
use super::require::Setup;
use super::{TestResult, fail};
use glisten_front::compiler::{Compilation, Compiler, Options, Source};
use glisten_front::diagnostic::Diagnostics;
use glisten_front::diagnostic::codes::general::NOT_SUPPORTED_YET;
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

/// The program, or `None` if it does not link and the test expects `link error`.
pub(super) fn build(
    name: &str,
    file: &TestFile,
    setup: &Setup,
    compiler: &Compiler,
) -> Result<Option<Built>, TestResult> {
    let mut sources: Vec<Source> = file
        .shaders
        .iter()
        .map(|shader| {
            let text = if shader.passthrough { passthrough(setup) } else { versioned(&shader.text, setup) };
            Source { name: name.into(), text: text.into(), stage: shader.stage }
        })
        .collect();
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
        None if expects("link error") => return Ok(None),
        _ => {}
    }
    let program = linked(compilation)?;
    Ok(Some(Built { program, sources, compiler: compiler.clone(), variants: Vec::new() }))
}

fn linked(compilation: Compilation) -> Result<Arc<Program>, TestResult> {
    if let Some(program) = compilation.program {
        return Ok(Arc::new(program));
    }
    let reason = first_error(&compilation.diagnostics, &compilation.sources);
    let unsupported = compilation.diagnostics.iter().any(|diagnostic| *diagnostic.code == NOT_SUPPORTED_YET);
    match unsupported {
        true => Err(TestResult::Skip(reason)),
        false => Err(TestResult::Fail(reason)),
    }
}

fn first_error(diagnostics: &Diagnostics, sources: &SourceMap) -> String {
    let Some(error) = diagnostics.iter().find(|diagnostic| diagnostic.is_error()) else {
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

/// The text with a `#version` line. If it has none of its own, one of the empty lines before it becomes one, and others become
/// lines for the extensions that a context enables for every shader: those of a compatibility context of 1.40, and
/// ARB_texture_rectangle on a desktop.
fn versioned(text: &str, setup: &Setup) -> String {
    let line = text.lines().find(|line| line.trim_start().starts_with("#version"));
    let version = line.map_or_else(|| version_line(setup), |line| line.trim().to_owned());
    let mut added = Vec::new();
    if setup.compatibility && version == "#version 140" {
        added.push("#extension GL_ARB_compatibility : enable");
    }
    if !setup.es && text.contains("2DRect") && !text.contains("GL_ARB_texture_rectangle") {
        added.push("#extension GL_ARB_texture_rectangle : enable");
    }
    let Some(rest) = text.strip_prefix(&"\n".repeat(added.len() + 1)) else {
        return if line.is_some() { text.to_owned() } else { format!("{version}\n{}", text.trim_start_matches('\n')) };
    };
    if line.is_some() && added.is_empty() {
        return text.to_owned();
    }
    let rest = line.map_or_else(|| rest.to_owned(), |line| rest.replacen(line, "", 1));
    let lines: String = added.iter().map(|line| format!("{line}\n")).collect();
    format!("{version}\n{lines}{rest}")
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn a_text_without_a_version_gets_that_of_the_test() {
        let setup = Setup { size: [1, 1], compatibility: false, version: 130, es: false };
        assert_eq!(versioned("\n\nvoid main() {}\n", &setup), "#version 130\n\nvoid main() {}\n");
        let es = Setup { version: 300, es: true, ..setup };
        assert_eq!(versioned("void main() {}\n", &es), "#version 300 es\nvoid main() {}\n");
        let compatibility = Setup { version: 140, compatibility: true, ..setup };
        let text = versioned("\n\n\n#version 140\nvoid main() {}\n", &compatibility);
        assert_eq!(text, "#version 140\n#extension GL_ARB_compatibility : enable\n\n\nvoid main() {}\n");
        let rectangle = versioned("\n\nuniform sampler2DRect t;\n", &setup);
        assert_eq!(rectangle, "#version 130\n#extension GL_ARB_texture_rectangle : enable\nuniform sampler2DRect t;\n");
    }
}
