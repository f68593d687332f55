//! The program of a test: its shaders compiled, linked, and whether the link's success is what the test expects.

use super::parse::{ShaderText, TestFile};
use super::{Outcome, fail};
use crate::compiler::{Compiler, Source};
use crate::diagnostic::Diagnostics;
use crate::link::Program;
use crate::source::SourceMap;
use std::sync::Arc;

/// The version that older texts are raised to.
const RAISED: &str = "150";
/// Versions that are raised.
const OLDER: &[&str] = &["110", "120", "130", "140"];

/// The program, or `None` if it does not link and the test says `link error`.
pub(super) fn build(
    name: &str,
    file: &TestFile,
    compatibility: bool,
    compiler: &Compiler,
) -> Result<Option<Arc<Program>>, Outcome> {
    let mut raised = false;
    let sources: Vec<Source> = file
        .shaders
        .iter()
        .map(|shader| {
            let text = raise(shader);
            raised |= text.is_some();
            let text = text.unwrap_or_else(|| shader.text.clone());
            Source { name: name.into(), text: text.into(), stage: shader.stage }
        })
        .collect();
    let compilation = compiler.compile(&sources);
    let expects = |phrase: &str| file.commands.iter().any(|line| line.text.starts_with(phrase));
    match compilation.program {
        Some(program) if expects("link error") => {
            fail(0, format_args!("program `{}` links, and the test expects a link error", program.name))
        }
        Some(program) => Ok(Some(Arc::new(program))),
        None if expects("link error") => Ok(None),
        None => {
            let reason = first_error(&compilation.diagnostics, &compilation.sources);
            if raised || compatibility {
                Err(Outcome::Skip(format!("not valid GLSL 1.50 core: {reason}")))
            } else {
                Err(Outcome::Fail(reason))
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

/// The text with its version raised, if it is an older one of the desktop.
fn raise(shader: &ShaderText) -> Option<String> {
    let start = shader.text.find("#version")?;
    let (line, _) = shader.text[start..].split_once('\n')?;
    let mut words = line.split_whitespace().skip(1);
    let version = words.next().filter(|version| OLDER.contains(version))?;
    if words.next().is_some_and(|profile| profile.chars().all(char::is_alphabetic)) {
        return None;
    }
    let place = start + line.find(version)?;
    let mut text = shader.text.clone();
    text.replace_range(place..place + version.len(), RAISED);
    Some(text)
}

#[cfg(test)]
mod unit {
    use super::*;
    use crate::hir::Stage;

    #[test]
    fn older_versions_are_raised() {
        let text = |text: &str| ShaderText { stage: Stage::Vertex, text: text.into(), passthrough: false };
        assert_eq!(raise(&text("\n#version 130\nx")), Some("\n#version 150\nx".into()));
        assert_eq!(raise(&text("#version 150\n")), None);
        assert_eq!(raise(&text("void main() {}\n")), None);
    }
}
