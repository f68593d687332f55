//! The program of a test: compiles and links its shaders, and checks whether the link should succeed.

use super::parse::TestFile;
use super::require::Setup;
use super::{TestResult, fail};
use glisten_front::compiler::{Compiler, Source};
use glisten_front::diagnostic::Diagnostics;
use glisten_front::link::Program;
use glisten_front::source::SourceMap;
use std::sync::Arc;

/// The version that replaces older versions.
const RAISED: &str = "150";
/// The versions that are replaced.
const OLDER: &[&str] = &["110", "120", "130", "140"];

/// The program, or `None` if it does not link and the test expects `link error`.
pub(super) fn build(
    name: &str,
    file: &TestFile,
    setup: &Setup,
    compiler: &Compiler,
) -> Result<Option<Arc<Program>>, TestResult> {
    let mut raised = false;
    let sources: Vec<Source> = file
        .shaders
        .iter()
        .map(|shader| {
            let text = versioned(&shader.text, setup.version);
            let newer = raise(&text);
            raised |= newer.is_some();
            let text = newer.unwrap_or(text);
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
            if raised || setup.compatibility {
                Err(TestResult::Skip(format!("not valid GLSL 1.50 core: {reason}")))
            } else {
                Err(TestResult::Fail(reason))
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

/// The text with its version raised, if that is an older desktop version.
fn raise(text: &str) -> Option<String> {
    let start = text.find("#version")?;
    let (line, _) = text[start..].split_once('\n')?;
    let mut words = line.split_whitespace().skip(1);
    let version = words.next().filter(|version| OLDER.contains(version))?;
    if words.next().is_some_and(|profile| profile.chars().all(char::is_alphabetic)) {
        return None;
    }
    let place = start + line.find(version)?;
    let mut text = text.to_owned();
    text.replace_range(place..place + version.len(), RAISED);
    Some(text)
}

#[cfg(test)]
mod unit {
    use super::*;

    #[test]
    fn older_versions_are_raised() {
        assert_eq!(raise("\n#version 130\nx"), Some("\n#version 150\nx".into()));
        assert_eq!(raise("#version 150\n"), None);
        assert_eq!(raise("void main() {}\n"), None);
        assert_eq!(versioned("\n\nvoid main() {}\n", 130), "#version 130\n\nvoid main() {}\n");
    }
}
