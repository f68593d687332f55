//! The tables: how far the programs of each kind got, those of each repository, and each program without a picture with its reason.

use crate::list::List;
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
    flat_by_itself: usize,
    holds: usize,
    inconclusive: usize,
    fails: usize,
}

const HEADER: &str = "programs | scene | draws | covers | not flat | flat by itself | holds | inconclusive | fails |";
const RULE: &str = "--: | --: | --: | --: | --: | --: | --: | --: | --: |";

impl Row {
    fn add(&mut self, found: &Found, taken: &Taken) {
        let verdict = |word: &str| usize::from(taken.verdict.as_deref() == Some(word));
        self.all += 1;
        self.written += usize::from(taken.written);
        self.drawn += usize::from(taken.drawn);
        self.covers += usize::from(taken.covers());
        self.colorful += usize::from(taken.covers() && !taken.is_flat());
        self.flat_by_itself += usize::from(taken.is_flat() && by_itself(found).is_some());
        self.holds += verdict("holds");
        self.inconclusive += verdict("inconclusive");
        self.fails += verdict("fails");
    }

    fn line(&self, name: &str) -> String {
        let Self { all, written, drawn, covers, colorful, flat_by_itself, holds, inconclusive, fails } = self;
        let counts = [all, written, drawn, covers, colorful, flat_by_itself, holds, inconclusive, fails];
        format!("| {name} | {} |", counts.map(usize::to_string).join(" | "))
    }
}

/// Why the text of a program gives one color, if it does.
fn by_itself(found: &Found) -> Option<&'static str> {
    let dependence = found.dependence;
    match (dependence.written, dependence.color, dependence.alpha) {
        (false, ..) => Some("flat by itself: no color is written"),
        (true, false, true) => Some("flat by itself: only alpha depends on a varying or `gl_FragCoord`"),
        (true, false, false) => Some("flat by itself: the color depends on no varying and not on `gl_FragCoord`"),
        (true, true, _) => None,
    }
}

/// Why a program has no picture of several colors, or why it does not hold.
fn reason(found: &Found, taken: &Taken) -> Option<String> {
    match taken {
        Taken { reason, .. } if !reason.is_empty() => Some(reason.clone()),
        taken if !taken.covers() && !found.dependence.covers => {
            Some("covers nothing by itself: no position is written, or each fragment is discarded".to_owned())
        }
        taken if !taken.covers() => Some("it covers nothing".to_owned()),
        taken if taken.is_flat() => Some(by_itself(found).unwrap_or("one color").to_owned()),
        Taken { verdict: Some(verdict), .. } if verdict == "fails" => Some("verify fails".to_owned()),
        _ => None,
    }
}

/// A program with how far it got.
pub(crate) fn line(found: &Found, taken: &Taken) -> String {
    let shown = taken.shown.map_or("-".to_owned(), |shown| format!("{:.2} {:.2}", shown.covered, shown.contrast));
    let verdict = taken.verdict.as_deref().unwrap_or("-");
    let reason = reason(found, taken).unwrap_or_default();
    format!("{}\t{}\t{shown}\t{verdict}\t{reason}", found.kind, found.files.join(" "))
}

/// All tables; `folder` is left out of the names of files. What is known about a program follows its reason.
pub(crate) fn tables(results: &[(usize, Found, Taken)], known: &List, folder: &str) -> String {
    let mut kinds: BTreeMap<&str, Row> = BTreeMap::new();
    let mut places: BTreeMap<&str, Row> = BTreeMap::new();
    let mut all = Row::default();
    let mut reasons = Vec::new();
    for (_, found, taken) in results {
        for row in [kinds.entry(&found.kind).or_default(), places.entry(&found.repository).or_default(), &mut all] {
            row.add(found, taken);
        }
        let short = |file: &String| {
            let inner = file.strip_prefix(folder).unwrap_or(file).trim_start_matches('/');
            inner.strip_prefix(&found.repository).unwrap_or(inner).trim_start_matches('/').to_owned()
        };
        let files: Vec<String> = found.files.iter().map(short).collect();
        if let Some(why) = reason(found, taken) {
            let name = found.repository.replace('+', "/");
            let files = files.join(" ");
            let because = known.because(&name, &found.kind, &files, &why).map(|text| format!(": {text}"));
            let why = why.replace('|', "/") + &because.unwrap_or_default();
            reasons.push(format!("| {name} | {} | {files} | {why} |", found.kind));
        }
    }
    let mut lines = vec![format!("| kind | {HEADER}"), format!("| --- | {RULE}")];
    lines.extend(kinds.iter().map(|(kind, row)| row.line(kind)));
    lines.push(all.line("all"));
    lines.extend([String::new(), format!("| repository | {HEADER}"), format!("| --- | {RULE}")]);
    let shown = |name: &str| {
        let commit = known.repository.iter().find(|row| row.folder() == name).map(|row| format!(" {}", row.commit));
        name.replace('+', "/") + &commit.unwrap_or_default()
    };
    lines.extend(places.iter().map(|(name, row)| row.line(&shown(name))));
    lines.push("\n| repository | kind | files | reason |\n| --- | --- | --- | --- |".to_owned());
    lines.extend(reasons);
    lines.join("\n")
}
