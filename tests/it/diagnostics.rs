//! The fixtures in `fixtures/valid`, `fixtures/invalid` and `fixtures/link`: the diagnostics of each are exactly
//! those that its comments expect.
//!
//! A comment `//~ CODE start:end` expects a diagnostic on its own line, `//~^ CODE start:end` on the line above (one
//! `^` for each line, not counting lines that contain only such comments). Columns count from 1, the end is
//! exclusive; a diagnostic that spans several lines is `start:+lines:end`. A first line `// fixture: strict,
//! NAME=VALUE, NAME, attribute NAME=LOCATION` sets how the file is compiled. Files in `fixtures/link` whose names are
//! equal up to the first dot are one program (`a.vert`, `a.2.vert`, `a.frag`).

use crate::support::{Settings, Shader, compile, shaders_under};
use glisten_front::diagnostic::Diagnostics;
use glisten_front::source::{SourceMap, Span};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// The file, the line, and the rest of the expectation.
type Finding = (String, u32, String);

fn settings(text: &str) -> Settings {
    let mut settings = Settings::default();
    let words = text.lines().next().and_then(|line| line.strip_prefix("// fixture:")).unwrap_or("");
    for word in words.split(',').map(str::trim).filter(|word| !word.is_empty()) {
        if let Some((name, location)) = word.strip_prefix("attribute ").and_then(|binding| binding.split_once('=')) {
            let location = location.parse().expect("the location of an attribute is a number");
            settings.attribute_locations.push((name.to_owned(), location));
            continue;
        }
        match word.split_once('=') {
            Some((name, value)) => settings.defines.push((name.to_owned(), value.to_owned())),
            None if word == "strict" => settings.strict = true,
            None => settings.defines.push((word.to_owned(), String::new())),
        }
    }
    settings
}

/// The diagnostics that the comments of a text expect.
fn expected(name: &str, text: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    // The numbers of the lines that contain more than expectations.
    let mut lines = Vec::new();
    for (index, line) in text.split('\n').enumerate() {
        if !line.trim_start().starts_with("//~") {
            lines.push(index as u32 + 1);
        }
        let own = lines.len();
        for comment in line.split("//~").skip(1) {
            let words = comment.trim_start_matches('^');
            let above = comment.len() - words.len();
            let first_above = if line.trim_start().starts_with("//~") { own + 1 } else { own };
            let line = (first_above - above).checked_sub(1).and_then(|place| lines.get(place)).copied().unwrap_or(0);
            let place: Vec<&str> = words.split_whitespace().take(2).collect();
            findings.push((name.to_owned(), line, place.join(" ")));
        }
    }
    findings
}

/// The diagnostics, in the notation of the comments.
fn found(sources: &SourceMap, diagnostics: &Diagnostics) -> Vec<Finding> {
    let finding = |span: Span, code: &str| {
        let Some(at) = sources.location(sources.call_site(span)) else {
            return ("nowhere".to_owned(), 0, code.to_owned());
        };
        let lines = if at.end_line == at.line { String::new() } else { format!("+{}:", at.end_line - at.line) };
        let place = format!("{code} {}:{lines}{}", at.column, at.end_column);
        (sources.file(at.file).name().to_owned(), at.line, place)
    };
    diagnostics.iter().map(|diagnostic| finding(diagnostic.primary.span, diagnostic.code.id)).collect()
}

/// Compiles a program and reports how its diagnostics differ from those that its comments expect.
pub(crate) fn check(shaders: &[Shader]) -> Result<(), String> {
    let first = shaders.first().map_or("", |shader| &shader.text);
    let (sources, diagnostics) = compile(shaders, &settings(first));
    let mut wanted: Vec<Finding> = sources.files().flat_map(|(_, file)| expected(file.name(), file.text())).collect();
    let mut got = found(&sources, &diagnostics);
    wanted.sort();
    got.sort();
    if wanted == got {
        return Ok(());
    }
    let mut report = String::new();
    for (file, line, place) in wanted.iter().filter(|finding| !got.contains(finding)) {
        let _ = writeln!(report, "{file}:{line}: not found: //~ {place}");
    }
    for (finding, diagnostic) in found(&sources, &diagnostics).iter().zip(&diagnostics) {
        if !wanted.contains(finding) {
            let (file, line, place) = finding;
            let _ = writeln!(report, "{file}:{line}: not expected: //~ {place}   {}", diagnostic.message);
        }
    }
    if report.is_empty() {
        report = format!("{}: a finding is there more often than expected\n", shaders.first().map_or("", |s| &s.name));
    }
    Err(report)
}

fn check_all(programs: Vec<Vec<Shader>>) {
    assert!(!programs.is_empty(), "no fixtures");
    let reports: String = programs.iter().filter_map(|program| check(program).err()).collect();
    assert!(reports.is_empty(), "\n{reports}");
}

#[test]
fn valid_shaders_have_no_errors() {
    let shaders = shaders_under("fixtures/valid");
    for shader in &shaders {
        let expects_error = expected(&shader.name, &shader.text).iter().any(|finding| finding.2.starts_with('E'));
        assert!(
            !expects_error || settings(&shader.text).strict,
            "{} expects an error and is no valid shader",
            shader.name
        );
    }
    check_all(shaders.into_iter().map(|shader| vec![shader]).collect());
}

#[test]
fn invalid_shaders_have_the_expected_findings() {
    let shaders = shaders_under("fixtures/invalid");
    for shader in &shaders {
        assert!(!expected(&shader.name, &shader.text).is_empty(), "{} expects nothing", shader.name);
    }
    check_all(shaders.into_iter().map(|shader| vec![shader]).collect());
}

#[test]
fn linked_programs_have_the_expected_findings() {
    let mut programs: BTreeMap<String, Vec<Shader>> = BTreeMap::new();
    for shader in shaders_under("fixtures/link") {
        let file = Path::new(&shader.name).file_name().unwrap_or_default().to_string_lossy();
        let stem = file.split('.').next().unwrap_or("").to_owned();
        let stem = Path::new(&shader.name).with_file_name(stem).to_string_lossy().into_owned();
        programs.entry(stem).or_default().push(shader);
    }
    if !programs.is_empty() {
        check_all(programs.into_values().collect());
    }
}
