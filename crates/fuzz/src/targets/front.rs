//! Preprocessor, parser, analysis, link and lint.

use super::{no_internal_error, no_internal_errors};
use crate::Sections;
use crate::sections::named;
use glisten_front::diagnostic::codes::link::{LONE_WITHOUT_DEFINITION, LONE_WITHOUT_MAIN};
use glisten_front::diagnostic::write::{Finding, findings, human, json, sarif};
use glisten_front::diagnostic::{Applicability, Code, Diagnostic, Patch};
use glisten_front::source::{Completion, SourceMap};
use glisten_front::{Compilation, Compiler, Options, Source, lint};

/// The compilation of an input.
pub(super) fn compiled(sources: &[Source]) -> Compilation {
    let compilation = compiler().compile(sources);
    no_internal_error(&compilation.diagnostics);
    compilation
}

/// The compiler of every target: without includes, with three.js' loops.
pub(super) fn compiler() -> Compiler {
    let completion = Completion { unrolls: true, ..Completion::default() };
    Compiler::new(Options { completion, ..Options::default() })
}

/// Warnings about a shader that is a part of a program.
static PARTS: [&Code; 2] = [&LONE_WITHOUT_MAIN, &LONE_WITHOUT_DEFINITION];

/// A program or errors, which can be written.
pub(super) fn check(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let sources = Sections::of(&text).shaders();
    let compilation = compiled(&sources);
    // A shader without `main`, or with a function that another shader defines, is a part of a program; there are no programs of parts
    // alone, and no error.
    let is_lone = |diagnostic: &Diagnostic| PARTS.contains(&diagnostic.code);
    let is_part = !text.contains("main") || compilation.diagnostics.iter().any(is_lone);
    let is_decided = compilation.program.is_some() || compilation.diagnostics.has_errors();
    assert!(is_decided || is_part || sources.is_empty(), "neither a program nor an error");
    written(&compilation.sources, compilation.diagnostics.iter());
}

/// Every finding has a place in its text, and can be written in each format.
fn written<'a>(sources: &SourceMap, list: impl Iterator<Item = &'a Diagnostic> + Clone) -> Vec<Finding> {
    human(sources, list.clone(), false);
    let findings = findings(sources, list);
    json(&findings, None);
    sarif(&findings, None);
    findings
}

/// The rules, and their fixes.
pub(super) fn lint(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let sources = Sections::of(&text).shaders();
    let compilation = compiled(&sources);
    let Some(program) = &compilation.program else { return };
    let found = lint::check(program, &compilation.sources);
    no_internal_errors(&found);
    for finding in written(&compilation.sources, found.iter()) {
        for fix in finding.fixes.iter().filter(|fix| fix.applicability == Applicability::Safe) {
            let mut patch = Patch::default();
            patch.add(fix);
            let new = |source: &Source| {
                let text = patch.applied(&source.name, &source.text);
                Source { text: text.expect("its edits are in the text").into(), ..source.clone() }
            };
            let changed: Vec<Source> = sources.iter().map(new).collect();
            let again = compiled(&changed);
            let error = again.diagnostics.iter().find(|one| one.is_error());
            let message = error.map(|error| error.message.as_str()).unwrap_or_default();
            assert!(error.is_none(), "a fix of {} breaks the text: {message}\n{}", finding.code, named(&changed));
        }
    }
}
