//! glslang's `Test/110.*` to `330.*`, `100.*` and `300.*`.
//!
//! *In:* the folder of glslang. *Out:* a finding for each line that one of the two rejects. A line that glslang rejects is one that a comment marks
//! (`// ERROR`) and that its recorded result lists (`Test/baseResults`); glisten has to reject it, too, and no line that
//! neither of the two names. A shader that glslang accepts has to be accepted.

use super::judge::{compile, files, line_of, stage_of, text_of};
use super::{Finding, Outcome};
use glisten_front::diagnostic::Area;
use glisten_front::{Diagnostic, Stage};
use std::collections::BTreeSet;
use std::io;
use std::path::Path;

const VERSIONS: [&str; 8] = ["100", "110", "120", "130", "140", "150", "300", "330"];

/// The lines of a shader that glslang rejects.
struct Expected {
    /// Marked, and rejected.
    rejected: BTreeSet<u32>,
    /// Marked, or rejected.
    doubtful: BTreeSet<u32>,
}

/// All shaders of the versions.
pub(crate) fn run(root: &Path) -> io::Result<Vec<Finding>> {
    let folder = root.join("Test");
    let mut findings = Vec::new();
    for path in files(&folder)?.iter().filter(|path| path.parent() == Some(&folder)) {
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let version = VERSIONS.iter().find(|version| name.starts_with(**version));
        let (Some(version), Some(stage)) = (version, stage_of(path)) else { continue };
        let text = text_of(path)?;
        let recorded = text_of(&folder.join("baseResults").join(format!("{name}.out")));
        let group = format!("{version}.*");
        let Ok(recorded) = recorded else {
            let outcome = Outcome::Omitted("glslang has no recorded result of it alone".to_owned());
            findings.push(Finding { group, name, outcome });
            continue;
        };
        for (line, outcome) in lines(stage, &text, &expected(&text, &recorded)) {
            let name = line.map_or_else(|| name.clone(), |line| format!("{name}:{line}"));
            findings.push(Finding { group: group.clone(), name, outcome });
        }
    }
    Ok(findings)
}

/// A finding for each line that one of the two rejects; one for the whole text where neither rejects a line.
fn lines(stage: Stage, text: &str, expected: &Expected) -> Vec<(Option<u32>, Outcome)> {
    let judged = Judged::of(stage, text, expected);
    let outcome = |line: &u32| match judged.rejected.contains(line) {
        true => Outcome::Agrees,
        false => Outcome::Differs("must be rejected".to_owned()),
    };
    let mut found: Vec<_> = expected.rejected.iter().map(|line| (Some(*line), outcome(line))).collect();
    found.extend(judged.more.iter().map(|line| (Some(*line), Outcome::Differs("must be accepted".to_owned()))));
    if found.is_empty() {
        found.push((None, Outcome::Agrees));
    }
    found
}

/// The lines that glisten rejects.
#[derive(Default)]
struct Judged {
    rejected: BTreeSet<u32>,
    /// Rejected, and neither marked nor recorded.
    more: BTreeSet<u32>,
}

impl Judged {
    /// Compiles the text. An error may hide others: one of the grammar all, one of a declaration those of its uses and of the
    /// link. So the rejected lines are emptied, and the rest is compiled again.
    fn of(stage: Stage, text: &str, expected: &Expected) -> Self {
        let mut judged = Self::default();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        // What is rejected further down may follow from an emptied declaration, once the declarations have been read.
        let mut counts = true;
        for _ in 0..lines.len() {
            let compilation = compile(&[(stage, lines.join("\n") + "\n")]);
            let errors: Vec<&Diagnostic> =
                compilation.diagnostics.iter().filter(|finding| finding.is_error()).collect();
            let mut emptied = false;
            for error in &errors {
                let line = line_of(&compilation, error);
                let presented = compilation.sources.presented_line(compilation.sources.call_site(error.primary.span));
                let places = [Some(line), presented];
                judged.rejected.extend(places.into_iter().flatten());
                let is_known = places.into_iter().flatten().any(|line| expected.doubtful.contains(&line));
                if counts && !is_known {
                    judged.more.insert(line);
                }
                emptied |= empty(&mut lines, line);
            }
            counts &= errors.iter().all(|error| matches!(error.code.area(), Area::Preprocess | Area::Syntax));
            if !emptied {
                break;
            }
        }
        judged
    }
}

/// Empties a line up to its braces. Returns whether it had more than these.
fn empty(lines: &mut [String], number: u32) -> bool {
    let index = usize::try_from(number).unwrap_or(usize::MAX).wrapping_sub(1);
    let Some(line) = lines.get_mut(index) else { return false };
    let code = line.split("//").next().unwrap_or_default();
    let braces: String = code.chars().filter(|c| matches!(c, '{' | '}')).collect();
    let changes = *line != braces;
    *line = braces;
    changes
}

/// The lines by the comments and by the recorded result (`ERROR: 0:12: ..`).
fn expected(text: &str, recorded: &str) -> Expected {
    let number = |index: usize| u32::try_from(index + 1).unwrap_or(u32::MAX);
    let lines = text.lines().enumerate();
    let marked: BTreeSet<u32> = lines
        .filter(|(_, line)| line.split_once("//").is_some_and(|(_, comment)| comment.to_lowercase().contains("error")))
        .map(|(index, _)| number(index))
        .collect();
    let place = |line: &str| line.strip_prefix("ERROR: 0:")?.split(':').next()?.parse().ok();
    let listed: BTreeSet<u32> = recorded.lines().filter_map(place).collect();
    Expected {
        rejected: marked.intersection(&listed).copied().collect(),
        doubtful: marked.union(&listed).copied().collect(),
    }
}
