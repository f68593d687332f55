//! The numbers of the sections in the other versions, for `docs/conformance.md`.
//!
//! *In:* the list of the sections of 1.50, and the front end's table of numbers. *Out:* Markdown. *Holds:* each section of the
//! list is in the table, under the same title.

use super::sections::SECTIONS;
use glisten_front::language::{EDITIONS, Edition, Section, runs};
use std::fmt::Write;

const LISTED: Edition = Edition { es: false, number: 150 };

/// The sections whose numbers depend on the version.
///
/// # Errors
/// The two lists differ.
pub(crate) fn numbers(text: &mut String) -> Result<(), String> {
    let known = |number: &str, title: &str| {
        Section::all().iter().any(|row| row.number(LISTED) == Some(number) && row.title.eq_ignore_ascii_case(title))
    };
    let missing = SECTIONS.iter().find(|section| !known(section.number.trim_start_matches('§'), section.title));
    if let Some(section) = missing {
        return Err(format!("{} {} is not in crates/front/src/language/sections.txt", section.number, section.title));
    }
    text.push_str("\n### Numbers in other versions\n\nOf the sections of 1.50 that have another number elsewhere.\n\n");
    text.push_str("| section | title | in other versions |\n| --- | --- | --- |\n");
    for section in SECTIONS {
        let elsewhere = runs(&format!("GLSL 1.50 {}", section.number));
        let others: Vec<String> = elsewhere
            .into_iter()
            .filter(|(_, _, number)| number != section.number)
            .map(|(first, last, number)| format!("{} {number}", range(first, last)))
            .collect();
        if !others.is_empty() {
            let _ = writeln!(text, "| {} | {} | {} |", section.number, section.title, others.join(", "));
        }
    }
    Ok(())
}

/// `1.10 to 1.40`, `ES 1.00`
fn range(first: Edition, last: Edition) -> String {
    let name = |edition: Edition| edition.name().trim_start_matches("GLSL ").to_owned();
    let until = EDITIONS.iter().find(|edition| **edition == last).filter(|_| first != last);
    until.map_or_else(
        || name(first),
        |last| format!("{} to {}.{:02}", name(first), last.number / 100, last.number % 100),
    )
}
