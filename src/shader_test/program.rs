//! The program of a test: compiles and links its shaders, and checks whether the link should succeed.

use super::parse::TestFile;
use super::require::Setup;
use super::{TestResult, fail, fixed};
use glisten_front::compiler::{Compiler, Source};
use glisten_front::diagnostic::Diagnostics;
use glisten_front::diagnostic::codes::general::NOT_SUPPORTED_YET;
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use glisten_scene::fixed::OtherStage;
use std::sync::Arc;

/// A program, and its stage that the test does not have.
type Built = (Arc<Program>, Option<OtherStage>);

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
            let text = versioned(&shader.text, setup.version);
            Source { name: name.into(), text: text.into(), stage: shader.stage }
        })
        .collect();
    let generated = fixed::missing_stage(compiler, file, &sources);
    if let Some(made) = &generated {
        sources.push(Source { name: name.into(), text: made.text.as_str().into(), stage: made.stage });
    }
    let compilation = compiler.compile(&sources);
    let expects = |phrase: &str| file.commands.iter().any(|line| line.text.starts_with(phrase));
    match compilation.program {
        Some(program) if expects("link error") => {
            fail(0, format_args!("program `{}` links, and the test expects a link error", program.name))
        }
        Some(program) => Ok(Some((Arc::new(program), generated))),
        None if expects("link error") => Ok(None),
        None => {
            let reason = first_error(&compilation.diagnostics, &compilation.sources);
            let unsupported = compilation.diagnostics.iter().any(|diagnostic| *diagnostic.code == NOT_SUPPORTED_YET);
            match unsupported {
                true => Err(TestResult::Skip(reason)),
                false => Err(TestResult::Fail(reason)),
            }
        }
    }
}

fn first_error(diagnostics: &Diagnostics, sources: &SourceMap) -> String {
    let Some(error) = diagnostics.iter().find(|diagnostic| diagnostic.is_error()) else {
        return "it does not compile".into();
    };
    let line = sources.location(error.primary.span).map_or(0, |location| location.line);
    format!("line {line}: {} ({})", error.message, error.code.id)
}

/// The text with a `#version` line. If it has none of its own, one of the empty lines before it becomes one.
fn versioned(text: &str, version: u32) -> String {
    if text.contains("#version") {
        return text.to_owned();
    }
    match text.strip_prefix('\n') {
        Some(rest) => format!("#version {version}\n{rest}"),
        None => format!("#version {version}\n{text}"),
    }
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn a_text_without_a_version_gets_that_of_the_test() {
        assert_eq!(versioned("\n\nvoid main() {}\n", 130), "#version 130\n\nvoid main() {}\n");
    }
}
