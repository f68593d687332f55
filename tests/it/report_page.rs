//! The page of `glisten report`: whole, alone, and right as HTML.

use crate::report::{report_with, small_scene};
use serde_json::Value;
use std::collections::BTreeSet;

/// Elements without an end.
const VOID: [&str; 6] = ["meta", "img", "input", "br", "hr", "link"];

/// The report's JSON and its page.
fn report_and_page() -> (Value, String) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let out = folder.path().join("out");
    let run = report_with(&small_scene(folder.path()), &out, &[]);
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    let read = |name: &str| std::fs::read_to_string(out.join(name)).expect(name);
    (serde_json::from_str(&read("report.json")).expect("it is JSON"), read("report.html"))
}

/// The text between two marks.
fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split_once(from).and_then(|(_, rest)| rest.split_once(to)).map_or("", |(inner, _)| inner)
}

/// The tags of a page in order, without the contents of scripts and styles.
fn tags(page: &str) -> Vec<&str> {
    let mut tags = Vec::new();
    let mut rest = page;
    while let Some((_, from)) = rest.split_once('<') {
        let Some((tag, after)) = from.split_once('>') else { break };
        tags.push(tag);
        let raw = ["script", "style"].into_iter().find(|name| tag.split_whitespace().next() == Some(name));
        rest = raw.and_then(|name| after.find(&format!("</{name}>")).map(|end| &after[end..])).unwrap_or(after);
    }
    tags
}

/// The first tag that does not match the one that is open, if there is one.
fn first_unbalanced(page: &str) -> Option<String> {
    let mut open: Vec<&str> = Vec::new();
    for tag in tags(page) {
        let name = tag.trim_start_matches('/').split([' ', '\n', '/']).next().unwrap_or_default();
        match () {
            () if tag.starts_with('!') || tag.ends_with('/') || VOID.contains(&name) => {}
            () if tag.starts_with('/') => {
                if open.pop() != Some(name) {
                    return Some(tag.to_owned());
                }
            }
            () => open.push(name),
        }
    }
    open.pop().map(str::to_owned)
}

#[test]
fn the_page_is_whole_and_alone() {
    let (report, page) = report_and_page();
    assert_eq!(first_unbalanced(&page), None);
    // The viewer waits for its pictures, in the words that users read.
    assert!(page.contains("<div class=\"viewer\" id=\"views\"") && page.matches("<figure class=\"view ").count() == 3);
    let words = between(&page, "<main>", "<section class=\"wide\"");
    for word in ["truth", "Truth", " way ", " ways ", "same again"] {
        assert!(!words.contains(word), "{word}");
    }
    for outside in ["http://", "https://", "src=\"/", "<link", "@import", "url(", "fetch("] {
        assert!(!page.contains(outside), "{outside}");
    }
    // Every way has a row with all figures and a card, and the columns are as many as the cells.
    let ways = report["ways"].as_array().expect("ways");
    let columns = page.matches("<th scope=\"col\"").count();
    for (number, way) in ways.iter().enumerate() {
        let row = between(&page, &format!("<tr id=\"row-{number}\""), "</tr>");
        assert!(row.contains(way["name"].as_str().expect("a name")), "{row}");
        assert_eq!(row.matches("<td").count() + 1, columns, "{row}");
        assert!(page.contains(&format!("id=\"way-{number}\"")), "{number}");
    }
    // What a script needs is what a program reads.
    let data = between(&page, "<script type=\"application/json\" id=\"data\">", "</script>");
    let data: Value = serde_json::from_str(data).expect("the data are JSON");
    assert_eq!(data["report"], report);
    let profile = data["page"]["ways"][0]["profile"].as_array().expect("a profile");
    assert_eq!(profile.len(), 48);
    assert!(profile.iter().any(Value::is_number), "the row goes through the highlight");
    let programs = data["page"]["ways"][0]["programs"].as_array().expect("programs");
    assert_eq!(programs.len(), 2, "{programs:?}");
    // Pictures are embedded once each.
    let uris: Vec<&str> = page.split("src=\"data:").skip(1).filter_map(|rest| rest.split('"').next()).collect();
    assert_eq!(uris.iter().collect::<BTreeSet<_>>().len(), uris.len());
    assert!(uris.len() > 2 * ways.len() && page.len() < 2 << 20, "{} pictures, {} bytes", uris.len(), page.len());
}

#[test]
fn unbalanced_tags_are_found() {
    assert_eq!(first_unbalanced("<!doctype html><p>a<br>b<svg><path d=\"\"/></svg></p>"), None);
    assert_eq!(first_unbalanced("<script>if (a < b) {}</script>"), None);
    assert_eq!(first_unbalanced("<p><b></p>").as_deref(), Some("/p"));
    assert_eq!(first_unbalanced("<div><p></p>").as_deref(), Some("div"));
}
