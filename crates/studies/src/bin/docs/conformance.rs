//! The tables of `docs/conformance.md`: which section of the specification is enforced by which code and tested by which
//! fixture, in which versions, and what is not covered.
//!
//! *In:* the registry of codes, the tables of versions and of built-ins, the fixtures with their expectations. *Out:*
//! Markdown. *Holds:* a section that has neither a code nor a row of a table is listed as not covered, with the reason.

use super::sections::{OWN_CODES, SECTIONS, Section};
use glisten::{Compiler, Options, Source};
use glisten_front::builtin::{constants, functions, variables};
use glisten_front::diagnostic::{Code, codes};
use glisten_front::language::{FEATURES, Feature, FeatureRow, NEVER, Stage};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// The folders whose fixtures expect diagnostics in comments.
const FOLDERS: [&str; 5] = ["invalid", "valid", "link", "lint", "versions"];

/// A fixture with what it expects.
struct Fixture {
    /// The path below `fixtures`.
    name: String,
    text: String,
    stage: Stage,
    /// `1.50`, `ES 3.00`
    version: String,
    codes: BTreeSet<String>,
}

/// The text of the region.
pub(crate) fn conformance() -> Result<String, String> {
    let fixtures = fixtures(&PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures"))?;
    let mut text = String::new();
    rules(&fixtures, &mut text);
    features(&fixtures, &mut text);
    built_ins(&mut text);
    not_covered(&mut text);
    super::numbers::numbers(&mut text)?;
    Ok(text.trim_end().to_owned())
}

fn fixtures(root: &Path) -> Result<Vec<Fixture>, String> {
    let mut list = Vec::new();
    for folder in FOLDERS {
        collect(root, &root.join(folder), &mut list).map_err(|error| format!("fixtures/{folder}: {error}"))?;
    }
    list.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(list)
}

fn collect(root: &Path, folder: &Path, list: &mut Vec<Fixture>) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(root, &path, list)?;
            continue;
        }
        let stage = match path.extension().and_then(|extension| extension.to_str()) {
            Some("vert") => Stage::Vertex,
            Some("geom") => Stage::Geometry,
            Some("frag") => Stage::Fragment,
            _ => continue,
        };
        let text = String::from_utf8_lossy(&std::fs::read(&path)?).into_owned();
        let name = path.strip_prefix(root).unwrap_or(&path).display().to_string();
        let (version, codes) = (version_of(&text), codes_of(&text));
        list.push(Fixture { name, text, stage, version, codes });
    }
    Ok(())
}

/// The codes in `//~ CODE start:end` comments.
fn codes_of(text: &str) -> BTreeSet<String> {
    let expectations = text.lines().flat_map(|line| line.split("//~").skip(1));
    let code = |rest: &str| rest.trim_start_matches('^').split_whitespace().next().map(str::to_owned);
    expectations.filter_map(code).collect()
}

fn version_of(text: &str) -> String {
    let line = text.lines().find_map(|line| line.trim_start().strip_prefix("#version"));
    let mut words = line.unwrap_or("110").split_whitespace();
    let number: u32 = words.next().and_then(|word| word.parse().ok()).unwrap_or(110);
    let is_es = number == 100 || words.next() == Some("es");
    format!("{}{}.{:02}", if is_es { "ES " } else { "" }, number / 100, number % 100)
}

/// `§4.3.8.1` as numbers, to sort by.
fn key(section: &str) -> Vec<u32> {
    section.trim_start_matches('§').split('.').map(|part| part.parse().unwrap_or(u32::MAX)).collect()
}

/// The sections of GLSL that a code cites.
fn cited(code: &Code) -> Vec<&'static str> {
    let Some(rest) = code.section.strip_prefix("GLSL ") else { return Vec::new() };
    rest.split([' ', ',']).filter(|word| word.starts_with('§')).collect()
}

/// The first sentence of a page.
fn sentence(page: &str) -> &str {
    page.find(". ").map_or(page, |end| page.get(..=end).unwrap_or(page))
}

fn rules(fixtures: &[Fixture], text: &mut String) {
    let mut rows: Vec<(Vec<u32>, &Code)> = Vec::new();
    for code in codes::all().filter(|code| code.section.starts_with("GLSL ")) {
        rows.push((cited(code).first().map_or_else(Vec::new, |section| key(section)), code));
    }
    rows.sort_by(|(a, first), (b, second)| a.cmp(b).then(first.id.cmp(second.id)));
    text.push_str(
        "### Rules by section\n\n| section | rule | code | fixtures | versions |\n| --- | --- | --- | --- | --- |\n",
    );
    for (_, code) in rows {
        let breaking: Vec<&Fixture> = fixtures.iter().filter(|fixture| fixture.codes.contains(code.id)).collect();
        let versions: BTreeSet<&str> = breaking.iter().map(|fixture| fixture.version.as_str()).collect();
        let named = match breaking.split_first() {
            Some((first, [])) => format!("`{}`", first.name),
            Some((first, rest)) => format!("`{}` and {} more", first.name, rest.len()),
            None => "the page's example".to_owned(),
        };
        let versions: Vec<&str> = versions.into_iter().collect();
        let rule = sentence(code.page).replace('|', "\\|");
        let _ = writeln!(
            text,
            "| {} | {rule} | `{}` | {named} | {} |",
            code.section.trim_start_matches("GLSL "),
            code.id,
            versions.join(", ")
        );
    }
}

fn since(number: u16) -> String {
    if number == NEVER { "never".into() } else { format!("{}.{:02}", number / 100, number % 100) }
}

fn features(fixtures: &[Fixture], text: &mut String) {
    text.push_str("\n### Rules that depend on the version\n\n");
    text.push_str(
        "| section | rule | since | in ES since | until | fixture |\n| --- | --- | --- | --- | --- | --- |\n",
    );
    let found = lacking(fixtures);
    let mut rows: Vec<&FeatureRow> = FEATURES.iter().collect();
    rows.sort_by_key(|row| (key(row.section), row.name));
    for row in rows {
        let until = if row.gone.desktop == NEVER { String::new() } else { since(row.gone.desktop) };
        let own = OWN_CODES.iter().find(|(rule, _)| *rule == row.name).map(|(_, code)| *code);
        let fixture = match own {
            Some(code) => fixtures.iter().find(|fixture| fixture.codes.contains(code)).map(|found| found.name.as_str()),
            None => found.get(&row.feature).copied(),
        };
        let code = own.or(fixture.map(|_| "E0617")).map_or_else(String::new, |code| format!("`{code}`"));
        let fixture = fixture.map_or_else(|| "none".to_owned(), |name| format!("`{name}`"));
        let (desktop, es) = (since(row.since.desktop), since(row.since.es));
        let _ = writeln!(text, "| {} | {} | {desktop} | {es} | {until} | {code} | {fixture} |", row.section, row.name);
    }
}

/// The features that some fixture lacks, with the first one of each.
fn lacking(fixtures: &[Fixture]) -> HashMap<Feature, &str> {
    let compiler = Compiler::new(Options::default());
    let mut found = HashMap::new();
    for fixture in fixtures.iter().filter(|fixture| fixture.codes.contains("E0617")) {
        let source = Source { name: fixture.name.clone(), text: fixture.text.as_str().into(), stage: fixture.stage };
        for feature in compiler.compile(&[source]).diagnostics.iter().filter_map(|diagnostic| diagnostic.lacking) {
            found.entry(feature).or_insert(fixture.name.as_str());
        }
    }
    found
}

fn built_ins(text: &mut String) {
    let mut counts: BTreeMap<Vec<u32>, (&str, BTreeSet<&str>)> = BTreeMap::new();
    let functions = functions::all().map(|row| (row.section, row.name));
    let variables = variables::VARIABLES.iter().map(|row| (row.section, row.name));
    let constants = constants::CONSTANTS.iter().map(|row| ("§7.4", row.name));
    for (section, name) in functions.chain(variables).chain(constants).filter(|(section, _)| section.starts_with('§'))
    {
        counts.entry(key(section)).or_insert((section, BTreeSet::new())).1.insert(name);
    }
    text.push_str("\n### Built-in names\n\nEach has its versions in the tables of [operations](operations.md).\n\n");
    text.push_str("| section | title | names |\n| --- | --- | --- |\n");
    for (section, names) in counts.values() {
        let title = SECTIONS.iter().find(|known| known.number == *section).map_or("", |known| known.title);
        let _ = writeln!(text, "| {section} | {title} | {} |", names.len());
    }
}

fn not_covered(text: &mut String) {
    let mut known: BTreeSet<&str> = codes::all().flat_map(cited).collect();
    known.extend(FEATURES.iter().map(|row| row.section));
    known.extend(functions::all().map(|row| row.section));
    known.extend(variables::VARIABLES.iter().map(|row| row.section));
    text.push_str("\n### Without a code\n\nSections of GLSL 1.50 that no code cites and no table has.\n\n");
    text.push_str("| section | title | why |\n| --- | --- | --- |\n");
    for Section { number, title, note } in SECTIONS.iter().filter(|section| !known.contains(section.number)) {
        let why = if note.is_empty() { "not covered" } else { note };
        let _ = writeln!(text, "| {number} | {title} | {why} |");
    }
}
