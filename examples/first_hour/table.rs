//! The tables: how far the programs of each kind got, and each failure with its reason.

use crate::programs::Found;
use crate::steps::Taken;
use std::collections::BTreeMap;

/// The counts of a kind.
#[derive(Default)]
struct Row {
    all: usize,
    written: usize,
    drawn: usize,
    covers: usize,
    colorful: usize,
    holds: usize,
    inconclusive: usize,
    fails: usize,
}

impl Row {
    fn add(&mut self, found: &Found, taken: &Taken) {
        let verdict = |word: &str| usize::from(taken.verdict.as_deref() == Some(word));
        self.all += 1;
        self.written += usize::from(taken.written);
        self.drawn += usize::from(taken.drawn);
        self.covers += usize::from(taken.covers());
        self.colorful += usize::from(taken.covers() && (!taken.is_flat() || found.is_flat));
        self.holds += verdict("holds");
        self.inconclusive += verdict("inconclusive");
        self.fails += verdict("fails");
    }

    fn line(&self, name: &str) -> String {
        let Self { all, written, drawn, covers, colorful, holds, inconclusive, fails } = self;
        format!("| {name} | {all} | {written} | {drawn} | {covers} | {colorful} | {holds} | {inconclusive} | {fails} |")
    }
}

/// A program with how far it got.
pub(crate) fn line(found: &Found, taken: &Taken) -> String {
    let shown = taken.shown.map_or("-".to_owned(), |(covered, contrast)| format!("{covered:.2} {contrast:.2}"));
    let verdict = taken.verdict.as_deref().unwrap_or("-");
    let state = if !taken.reason.is_empty() {
        taken.reason.as_str()
    } else if taken.covers() && taken.is_flat() && !found.is_flat {
        "flat"
    } else {
        ""
    };
    format!("{}\t{}\t{shown}\t{verdict}\t{state}", found.kind, found.files.join(" "))
}

/// Both tables.
pub(crate) fn tables(results: &[(usize, Found, Taken)]) -> String {
    let mut rows: BTreeMap<&str, Row> = BTreeMap::new();
    let mut all = Row::default();
    let mut failures = Vec::new();
    for (_, found, taken) in results {
        rows.entry(&found.kind).or_default().add(found, taken);
        all.add(found, taken);
        let why = match taken {
            Taken { reason, .. } if !reason.is_empty() => reason.clone(),
            taken if !taken.covers() => "it covers nothing".to_owned(),
            taken if taken.is_flat() && !found.is_flat => "one color".to_owned(),
            Taken { verdict: Some(verdict), .. } if verdict == "fails" => "verify fails".to_owned(),
            _ => continue,
        };
        failures.push(format!(
            "| {} | {} | {} | {} |",
            found.repository,
            found.kind,
            found.files.join(" "),
            why.replace('|', "/")
        ));
    }
    let mut lines = vec![
        "| kind | programs | scene | draws | covers | not flat | holds | inconclusive | fails |".to_owned(),
        "| --- | --: | --: | --: | --: | --: | --: | --: | --: |".to_owned(),
    ];
    lines.extend(rows.iter().map(|(kind, row)| row.line(kind)));
    lines.push(all.line("all"));
    lines.push("\n| repository | kind | files | reason |\n| --- | --- | --- | --- |".to_owned());
    lines.extend(failures);
    lines.join("\n")
}
