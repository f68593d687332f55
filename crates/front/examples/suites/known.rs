//! The known differences with their reasons (`known.txt`), and the tables.
//!
//! *In:* findings. *Out:* Markdown. *Holds:* each difference has one reason, and each reason belongs to a difference.

use super::{Finding, Outcome};
use std::collections::BTreeMap;
use std::fmt::Write;

/// The differences of one suite.
pub(crate) struct Known {
    /// The end of a test's path, and the reason.
    rows: Vec<(&'static str, &'static str)>,
}

impl Known {
    /// The rows of a suite: lines `suite | path | reason`.
    pub(crate) fn of(suite: &str) -> Self {
        let row = |line: &'static str| {
            let (name, rest) = line.split_once(" | ")?;
            (name == suite).then(|| rest.split_once(" | ")).flatten()
        };
        Self { rows: include_str!("known.txt").lines().filter_map(row).collect() }
    }

    /// The reason of a difference. A row names one test, and covers all its lines.
    fn reason(&self, name: &str) -> Option<&'static str> {
        self.rows.iter().find(|(row, _)| covers(row, name)).map(|(_, reason)| *reason)
    }
}

fn covers(row: &str, name: &str) -> bool {
    name.ends_with(row) || name.strip_prefix(row).is_some_and(|line| line.starts_with(':'))
}

/// The counts of a row.
#[derive(Default)]
struct Count {
    tests: usize,
    agree: usize,
    differ: usize,
    omitted: usize,
}

/// The table of the counts, that of the differences and that of what is omitted.
pub(crate) fn table(findings: &[Finding], known: &Known) -> String {
    let mut counts: BTreeMap<&str, Count> = BTreeMap::new();
    let mut total = Count::default();
    for finding in findings {
        for count in [counts.entry(&finding.group).or_default(), &mut total] {
            count.tests += 1;
            match finding.outcome {
                Outcome::Agrees => count.agree += 1,
                Outcome::Differs(_) => count.differ += 1,
                Outcome::Omitted(_) => count.omitted += 1,
            }
        }
    }
    let mut text =
        String::from("| folder | tests | as expected | different | omitted |\n| --- | --- | --- | --- | --- |\n");
    for (group, count) in
        counts.iter().map(|(group, count)| (format!("`{group}`"), count)).chain([("all".into(), &total)])
    {
        let Count { tests, agree, differ, omitted } = count;
        let _ = writeln!(text, "| {group} | {tests} | {agree} | {differ} | {omitted} |");
    }
    reasons(findings, known, &mut text);
    text
}

/// The tests that differ or are omitted, by reason.
fn reasons(findings: &[Finding], known: &Known, text: &mut String) {
    let mut differ: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    let mut omitted: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for finding in findings {
        match &finding.outcome {
            Outcome::Agrees => {}
            Outcome::Differs(_) => {
                if let Some(reason) = known.reason(&finding.name) {
                    differ.entry(reason).or_default().push(&finding.name);
                }
            }
            Outcome::Omitted(why) => omitted.entry(why).or_default().push(&finding.name),
        }
    }
    for (title, rows) in [("different", differ), ("omitted", omitted)] {
        if rows.is_empty() {
            continue;
        }
        let _ = writeln!(text, "\n| {title} | why |\n| --- | --- |");
        for (why, names) in rows {
            let _ = writeln!(text, "| {} | {why} |", listed(&names));
        }
    }
}

/// `a`, `b` 7, 9 and 3 more
fn listed(names: &[&str]) -> String {
    const SHOWN: usize = 3;
    let mut files: Vec<(&str, Vec<&str>)> = Vec::new();
    for name in names.iter().map(|name| name.rsplit('/').next().unwrap_or(name)) {
        let (file, line) = name.split_once(':').map_or((name, None), |(file, line)| (file, Some(line)));
        match files.last_mut().filter(|(known, _)| *known == file) {
            Some((_, lines)) => lines.extend(line),
            None => files.push((file, line.into_iter().collect())),
        }
    }
    let short = |(file, lines): &(&str, Vec<&str>)| match lines.as_slice() {
        [] => format!("`{file}`"),
        lines => format!("`{file}` {}", lines.join(", ")),
    };
    let shown: Vec<String> = files.iter().take(SHOWN).map(short).collect();
    match files.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// Differences without a reason, and, after a `whole` run, reasons without a difference.
pub(crate) fn open(findings: &[Finding], known: &Known, whole: bool) -> Vec<String> {
    let differences: Vec<(&str, &str)> = findings
        .iter()
        .filter_map(|finding| match &finding.outcome {
            Outcome::Differs(how) => Some((finding.name.as_str(), how.as_str())),
            _ => None,
        })
        .collect();
    let unexplained = differences.iter().filter(|(name, _)| known.reason(name).is_none());
    let mut open: Vec<String> = unexplained.map(|(name, how)| format!("unexplained: {name}: {how}")).collect();
    let stale = known.rows.iter().filter(|(row, _)| whole && !differences.iter().any(|(name, _)| covers(row, name)));
    open.extend(stale.map(|(row, _)| format!("no longer different: {row}")));
    open
}
