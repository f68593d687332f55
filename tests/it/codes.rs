//! Tests of the registry of codes: each has an example that raises it and one that is clean, a fixture, and a page in
//! whole sentences.

use crate::support::{Settings, Shader, compile, shaders_under};
use glisten_front::diagnostic::{Code, Example, codes};
use glisten_front::hir::Stage;
use std::collections::BTreeSet;

/// Codes without a `bad` example that runs, and the reason.
static WITHOUT_EXAMPLE: &[(&str, &str)] = &[
    ("E0001", "what raises it changes with what is supported"),
    ("E0002", "a fault of glisten"),
    ("E0003", "too long for a page; tests/it/hostile.rs has them"),
    ("E0004", "too long for a page; tests/it/hostile.rs has them"),
    ("E0013", "an example is given a `#version` line, and is not empty then"),
    ("E0014", "an example in a page is text"),
    ("E0120", "examples are given a `#version` line; the fixtures have it"),
    ("E0128", "needs a second file; tests/it/hostile.rs has it"),
    ("E0129", "too long for a page; tests/it/hostile.rs has it"),
    ("E0130", "too long for a page; tests/it/hostile.rs has it"),
    ("E0513", "too long for a page; crates/front/src/analysis/tests.rs has it"),
    ("E0729", "needs a binding by name; a fixture has it"),
    ("W0701", "needs a binding by name; a fixture has it"),
    ("W0708", "needs a binding by name; a fixture has it"),
    ("E0132", "a name of 1,025 characters; the fixture has it"),
    ("W0108", "needs a second file; the fixtures have it"),
    ("W0115", "`lint --configurations` reports it; tests/it/configurations.rs makes it"),
    ("W0116", "examples are given a `#version` line; the fixtures have none"),
];

/// Codes that no fixture raises, and the reason.
static WITHOUT_FIXTURE: &[(&str, &str)] = &[
    ("E0001", "what raises it changes with what is supported"),
    ("E0002", "a fault of glisten"),
    ("E0003", "tests/it/hostile.rs makes them"),
    ("E0004", "tests/it/hostile.rs makes them"),
    ("E0128", "tests/it/hostile.rs makes them"),
    ("E0129", "tests/it/hostile.rs makes them"),
    ("E0130", "tests/it/hostile.rs makes them"),
    ("E0513", "crates/front/src/analysis/tests.rs makes them"),
    ("W0115", "tests/it/configurations.rs makes it"),
];

/// Phases whose codes each have a fixture.
fn has_fixtures(code: &Code) -> bool {
    is_of_the_front_end(code)
}

/// Whether a code's examples are compiled here; codes of targets, scenes and the command line are not raised by
/// compiling.
fn is_of_the_front_end(code: &Code) -> bool {
    let phase = code.id.get(1..3).and_then(|digits| digits.parse::<u32>().ok());
    let compiles = matches!(phase, Some(1..=7)) && !code.id.starts_with('L');
    compiles || code.id.starts_with("E000")
}

fn shaders(example: Example) -> Vec<Shader> {
    let shader = |text: &str, stage: Stage| {
        let versioned = text.contains("#version");
        let text = if versioned { text.to_owned() } else { format!("#version 150\n{text}") };
        Shader { name: format!("example.{}", stage.name()), text, stage }
    };
    match example {
        Example::Vertex(text) => vec![shader(text, Stage::Vertex)],
        Example::Fragment(text) => vec![shader(text, Stage::Fragment)],
        Example::Geometry(text) => vec![shader(text, Stage::Geometry)],
        Example::Program(vertex, fragment) => vec![shader(vertex, Stage::Vertex), shader(fragment, Stage::Fragment)],
        Example::Shaders(shaders) => shaders.iter().map(|&(stage, text)| shader(text, stage)).collect(),
        Example::Text(_) | Example::None => Vec::new(),
    }
}

fn raised(example: Example) -> Vec<String> {
    let (_, diagnostics) = compile(&shaders(example), &Settings::default());
    diagnostics.iter().map(|diagnostic| format!("{} {}", diagnostic.code.id, diagnostic.message)).collect()
}

#[test]
fn bad_examples_raise_their_code_and_good_ones_are_clean() {
    let mut wrong = Vec::new();
    for code in codes::all().filter(|code| is_of_the_front_end(code)) {
        let excused = WITHOUT_EXAMPLE.iter().any(|row| row.0 == code.id);
        let bad = raised(code.bad);
        if !excused && !bad.iter().any(|finding| finding.starts_with(code.id)) {
            wrong.push(format!("{}: the bad example raises {bad:?}", code.id));
        }
        let good = raised(code.good);
        if !good.is_empty() {
            wrong.push(format!("{}: the good example raises {good:?}", code.id));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn every_code_has_a_fixture() {
    let mut expected = BTreeSet::new();
    for shader in
        ["fixtures/valid", "fixtures/invalid", "fixtures/link"].iter().flat_map(|folder| shaders_under(folder))
    {
        for comment in shader.text.split("//~").skip(1) {
            expected.extend(comment.trim_start_matches('^').split_whitespace().next().map(str::to_owned));
        }
    }
    let without: Vec<_> = codes::all()
        .filter(|code| has_fixtures(code))
        .filter(|code| !expected.contains(code.id) && !WITHOUT_FIXTURE.iter().any(|row| row.0 == code.id))
        .map(|code| format!("{} {}", code.id, code.name))
        .collect();
    assert!(without.is_empty(), "{without:#?}");
    let unknown: Vec<_> = expected.iter().filter(|id| codes::find(id).is_none()).collect();
    assert!(unknown.is_empty(), "{unknown:?}");
}

#[test]
fn rows_are_complete_and_unique() {
    let mut seen = BTreeSet::new();
    for code in codes::all() {
        assert!(seen.insert(code.id) && seen.insert(code.name), "{} or {} stands twice", code.id, code.name);
        assert!(code.page.ends_with('.') && code.page.len() > 20, "{} has no page", code.id);
        assert!(code.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-'), "{}", code.name);
    }
}
