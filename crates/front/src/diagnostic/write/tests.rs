//! Unit tests of the writers, on small hand-made diagnostics.

use super::hostile::is_hostile;
use super::{Finding, findings, github, gitlab, human, json, junit, sarif};
use crate::diagnostic::codes::general::{NOT_SUPPORTED_YET, TOO_DEEP};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Severity};
use crate::source::{Expansion, SourceMap, Span};

fn source(text: &str) -> (SourceMap, u32) {
    let mut sources = SourceMap::default();
    let id = sources.add("dir/a b.vert", text).expect("there is room");
    let base = sources.file(id).base();
    (sources, base)
}

fn span_of(text: &str, base: u32, part: &str) -> Span {
    let start = base + text.find(part).expect("the part is in the text") as u32;
    Span::new(start, start + part.len() as u32)
}

#[test]
fn human_shows_excerpt_label_note_and_help() {
    let text = "void main() {\n\tfoo(1);\n}\n";
    let (sources, base) = source(text);
    let diagnostic = Diagnostic::new(&NOT_SUPPORTED_YET, span_of(text, base, "foo"), "`foo` is unknown")
        .here("no such function")
        .note("a fact")
        .help("write `bar`");
    let shown = human(&sources, [&diagnostic], false);
    for part in ["error[E0001]: `foo` is unknown", "dir/a b.vert:2:2", "^^^ no such function", "a fact", "write `bar`"]
    {
        assert!(shown.contains(part), "{part} is not in\n{shown}");
    }
}

#[test]
fn a_macro_is_shown_at_its_use_with_its_body_as_a_label() {
    let text = "#define M (1 + x)\nfloat a = M;\n";
    let (mut sources, base) = source(text);
    let call = span_of(text, base, "M;");
    let call = Span::new(call.start, call.end - 1);
    let definition = span_of(text, base, "M (");
    let expansion =
        sources.add_expansion(Expansion { name: "M".into(), call, definition: Span::new(definition.start, call.end) });
    let x = Span { expansion, ..span_of(text, base, "x") };
    let diagnostic = Diagnostic::new(&NOT_SUPPORTED_YET, x, "`x` is unknown");
    let finding = Finding::new(&sources, &diagnostic);
    assert_eq!((finding.region.line, finding.region.column, finding.region.end_column), (2, 11, 12));
    assert_eq!((finding.labels[0].region.line, finding.labels[0].region.column), (1, 16));
    assert!(finding.labels[0].message.contains("`M`"));
    let shown = human(&sources, [&diagnostic], false);
    assert!(shown.contains("a b.vert:2:11"), "{shown}");
}

#[test]
fn json_has_the_keys_of_the_contract_and_counts_characters() {
    let text = "// é\tü x\n";
    let (sources, base) = source(text);
    let diagnostic = Diagnostic::new(&TOO_DEEP, span_of(text, base, "x"), "deep");
    let value: serde_json::Value =
        serde_json::from_str(&json(&findings(&sources, [&diagnostic]), None)).expect("it is JSON");
    let row = &value[0];
    assert_eq!(row["file"], "dir/a b.vert");
    assert_eq!((row["line"].as_u64(), row["column"].as_u64()), (Some(1), Some(8)));
    assert_eq!((row["end_line"].as_u64(), row["end_column"].as_u64()), (Some(1), Some(9)));
    assert_eq!(row["severity"], "error");
    assert_eq!(row["code"], "E0003");
    assert!(row["help"].is_null());
    assert_eq!(row["labels"], serde_json::json!([]));
}

#[test]
fn sarif_names_rule_level_and_region() {
    let text = "x\n";
    let (sources, base) = source(text);
    let mut diagnostic = Diagnostic::new(&TOO_DEEP, span_of(text, base, "x"), "deep");
    diagnostic.severity = Severity::Warning;
    let value: serde_json::Value =
        serde_json::from_str(&sarif(&findings(&sources, [&diagnostic]), None)).expect("JSON");
    let run = &value["runs"][0];
    assert_eq!(run["tool"]["driver"]["rules"][0]["id"], "E0003");
    assert_eq!(run["results"][0]["level"], "warning");
    let location = &run["results"][0]["locations"][0]["physicalLocation"];
    assert_eq!(location["artifactLocation"]["uri"], "dir/a%20b.vert");
    assert_eq!(location["region"]["endColumn"], 2);
}

#[test]
fn github_escapes_properties_and_data() {
    let text = "x\n";
    let (sources, base) = source(text);
    let diagnostic = Diagnostic::new(&TOO_DEEP, span_of(text, base, "x"), "50% deep").help("less");
    assert_eq!(
        github(&findings(&sources, [&diagnostic]), None),
        "::error file=dir/a b.vert,line=1,endLine=1,col=1,endColumn=2,title=E0003 nesting-too-deep::50%25 deep%0Ahelp: \
         less\n"
    );
}

#[test]
fn long_lines_are_cut_and_control_characters_replaced() {
    let text = format!("{}\u{1b}[31mHERE{}\n", "a".repeat(5000), "b".repeat(5000));
    let (sources, base) = source(&text);
    let diagnostic = Diagnostic::new(&TOO_DEEP, span_of(&text, base, "HERE"), "evil \u{1b}[0m name");
    let shown = human(&sources, [&diagnostic], false);
    assert!(!shown.contains('\u{1b}'), "{shown}");
    assert!(shown.len() < 1500, "{}", shown.len());
    assert!(shown.contains(":1:5006"), "{shown}");
    assert!(shown.contains("^^^^"), "{shown}");
}

#[test]
fn no_format_has_characters_that_a_terminal_obeys() {
    let text = "x\n";
    let (sources, base) = source(text);
    let evil = "\u{1b}[2J \u{7} \u{9b}31m \u{202e}\u{7f}\r";
    let diagnostic = Diagnostic::new(&TOO_DEEP, span_of(text, base, "x"), evil).help(evil).note(evil).here(evil);
    let found = findings(&sources, [&diagnostic]);
    for write in [json, sarif, github, gitlab, junit] {
        let shown = write(&found, None);
        assert!(!shown.chars().any(|c| c != '\n' && is_hostile(c)), "{shown:?}");
    }
    let value: serde_json::Value = serde_json::from_str(&json(&found, None)).expect("JSON");
    assert_eq!(value[0]["message"], evil, "nothing is lost in JSON");
}

#[test]
fn the_texts_of_a_diagnostic_and_their_number_are_bounded() {
    let name = "a".repeat(1 << 20);
    let mut diagnostic = Diagnostic::new(&TOO_DEEP, Span::default(), format!("`{name}` is deep"))
        .here(name.clone())
        .help(Advice::write(Applicability::Safe, name.clone()));
    for _ in 0..1000 {
        diagnostic = diagnostic.label(Span::default(), name.clone()).note(name.clone());
    }
    assert!(diagnostic.message.starts_with("`aaa") && diagnostic.message.ends_with("a…` is deep"));
    assert!(diagnostic.secondary.len() == Diagnostic::MOST && diagnostic.notes.len() <= Diagnostic::MOST + 2);
    assert!(diagnostic.notes.iter().any(|note| note == "more places are not shown"), "{:?}", diagnostic.notes);
    assert!(diagnostic.notes.iter().any(|note| note == "more is not shown"), "{:?}", diagnostic.notes);
    assert_eq!(diagnostic.fixes[0].edits[0].text, name, "a fix writes the whole name");
    assert!(format!("{:?}", Diagnostic { fixes: Vec::new(), ..diagnostic }).len() < 16_384);
}

#[test]
fn a_place_that_is_nowhere_or_at_the_end_is_no_trouble() {
    let (sources, base) = source("");
    let nowhere = Diagnostic::new(&TOO_DEEP, Span::default(), "nowhere");
    let empty = Diagnostic::new(&TOO_DEEP, Span::new(base, base), "empty");
    assert!(human(&sources, [&nowhere, &empty], true).contains("nowhere"));
    let text = "abc";
    let (sources, base) = source(text);
    let end = Diagnostic::new(&TOO_DEEP, Span::new(base + 3, base + 3), "expected `;`");
    assert!(human(&sources, [&end], false).contains(":1:4"));
    assert_eq!(findings(&SourceMap::default(), [&nowhere])[0].region.line, 1);
}
