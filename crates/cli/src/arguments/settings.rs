//! `[lint.budgets]` and `[lint.ranges]` of `glisten.toml`: limits of costs, and ranges of inputs.
//!
//! ```toml
//! [lint.budgets]                       # by patterns of `.gitignore`; the last one that fits counts
//! "mobile/*.frag" = { weight = 400, lookups = 4, varyings = 8 }
//!
//! [lint.ranges]                        # of uniforms, varyings and attributes
//! lights = [0, 8]
//! normal = "unit"
//! ```
//!
//! *In:* tables. *Out:* [`Budgets`] and ranges. *Holds:* what is wrong is reported at its place and left out.

use crate::arguments::bounds::Bounds;
use crate::files;
use glisten_cost::{CLASSES, ProgramCost, Ranges, StageCost};
use glisten_front::diagnostic::codes::general::{BAD_CONFIG, OVER_BUDGET};
use glisten_front::diagnostic::{Diagnostic, did_you_mean};
use glisten_scene::tables::{Node, Reader};
use ignore::gitignore::GitignoreBuilder;
use std::path::{Path, PathBuf};
use toml::de::{DeTable, DeValue};

/// A budget's limit of what is interpolated.
const VARYINGS: &str = "varyings";
/// A budget's rounds of loops of which nothing is known.
const ITERATIONS: &str = "iterations";

/// The limits for a file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Budget {
    /// The limit of each class of operations on the longest path, in the order of [`CLASSES`].
    limits: Vec<Option<u64>>,
    varyings: Option<u64>,
    /// The rounds of a loop of which nothing is known.
    pub(crate) iterations: Option<u64>,
}

/// The budgets of a `glisten.toml`.
#[derive(Clone, Debug, Default)]
pub(crate) struct Budgets {
    /// The folder of the file.
    root: PathBuf,
    /// Patterns with their limits, in the order of the file.
    rows: Vec<(String, Budget)>,
}

impl Budgets {
    /// Reads `[lint.budgets]` of a file in the folder `root`.
    pub(crate) fn read(reader: &mut Reader, table: &DeTable<'_>, root: &Path) -> Self {
        let mut rows = Vec::new();
        for (pattern, node) in table {
            if let Err(error) = GitignoreBuilder::new("").add_line(None, pattern.get_ref()) {
                let span = reader.span_of(pattern);
                reader.report(Diagnostic::new(&BAD_CONFIG, span, format!("not a pattern: {error}")));
                continue;
            }
            let Some(limits) = reader.table(node, pattern.get_ref()) else { continue };
            rows.push((node.span().start, pattern.get_ref().to_string(), budget(reader, limits)));
        }
        rows.sort_by_key(|(start, ..)| *start);
        let rows = rows.into_iter().map(|(_, pattern, budget)| (pattern, budget)).collect();
        Self { root: root.to_owned(), rows }
    }

    /// Whether there is none.
    pub(crate) fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The budget of a file.
    pub(crate) fn of(&self, file: &str) -> Option<&Budget> {
        let absolute = files::real(Path::new(file));
        let fits = |pattern: &str| {
            let mut patterns = GitignoreBuilder::new(&self.root);
            patterns.add_line(None, pattern).ok()?;
            Some(patterns.build().ok()?.matched(&absolute, false).is_ignore())
        };
        let last = self.rows.iter().rfind(|(pattern, _)| fits(pattern).unwrap_or(false));
        last.map(|(_, budget)| budget)
    }
}

/// The limits of a table.
fn budget(reader: &mut Reader, table: &DeTable<'_>) -> Budget {
    let names = CLASSES.iter().map(|(name, _)| *name).chain([VARYINGS, ITERATIONS]);
    let known: Vec<&str> = names.collect();
    reader.check_keys(table, "a budget", &known);
    let mut limit = |key: &str, least: i64| {
        let node = table.get(key)?;
        reader.integer(node, key, least..=1_000_000_000_000).and_then(|limit| u64::try_from(limit).ok())
    };
    let limits = CLASSES.iter().map(|(name, _)| limit(name, 0)).collect();
    Budget { limits, varyings: limit(VARYINGS, 0), iterations: limit(ITERATIONS, 1) }
}

impl Budget {
    /// The costs of a stage of a program beyond the budget.
    pub(crate) fn check(&self, program: &ProgramCost, stage: &StageCost) -> Vec<Diagnostic> {
        let mut found = Vec::new();
        for ((name, of), limit) in CLASSES.iter().zip(&self.limits) {
            let (spent, Some(limit)) = (of(&stage.longest), *limit) else { continue };
            if spent <= limit {
                continue;
            }
            let message = format!("the longest path has {}, over the budget of {limit}", spending(name, spent));
            let mut finding = Diagnostic::new(&OVER_BUDGET, stage.span, message);
            if let Some(line) = stage.lines.iter().max_by_key(|line| (of(&line.longest), line.span.start)) {
                finding = finding.label(line.span, format!("{} of them on this line", of(&line.longest)));
            }
            for one in stage.loops.iter().filter(|one| one.known == "assumed") {
                let (file, line, most) = (&one.file, one.line, one.most);
                finding =
                    finding.note(format!("the loop at {file}:{line} counts {most} rounds, since nothing limits it"));
            }
            found.push(finding.help(format!("`glisten cost {}` shows each line", stage.file)));
        }
        let registers = program.varyings.registers as u64;
        if let Some(limit) = self.varyings.filter(|limit| stage.stage == "fragment" && registers > *limit) {
            let message = format!("{registers} registers of varyings are interpolated, over the budget of {limit}");
            found.push(Diagnostic::new(&OVER_BUDGET, stage.span, message));
        }
        found
    }
}

/// How much a path has of a class, in words.
fn spending(class: &str, number: u64) -> String {
    let of = |one: &str, many: &str| format!("{number} {}", if number == 1 { one } else { many });
    match class {
        "arithmetic" => of("arithmetic operation", "arithmetic operations"),
        "special" => of("division or transcendental function", "divisions and transcendental functions"),
        "lookups" => of("texture lookup", "texture lookups"),
        "branches" => of("branch", "branches"),
        _ => format!("a weight of {number}"),
    }
}

/// The ranges of `[lint.ranges]`.
pub(crate) fn ranges(reader: &mut Reader, table: &DeTable<'_>) -> Vec<(String, Bounds)> {
    let mut found = Vec::new();
    for (name, node) in table {
        let bounds = bounds(reader, node, name.get_ref());
        found.extend(bounds.map(|bounds| (name.get_ref().to_string(), bounds)));
    }
    found
}

/// `[low, high]`, one number, or `"unit"`.
fn bounds(reader: &mut Reader, node: &Node<'_>, name: &str) -> Option<Bounds> {
    match node.get_ref() {
        DeValue::String(word) => {
            let found = Bounds::parse(word);
            if found.is_none() {
                let near = did_you_mean(word, ["unit"]).map(|near| format!("did you mean `{near}`?"));
                let message = format!("`{word}` is no range");
                let span = reader.span_of(node);
                let help = near.unwrap_or_else(|| "write `[low, high]`, a number, or `\"unit\"`".to_owned());
                reader.report(Diagnostic::new(&BAD_CONFIG, span, message).help(help));
            }
            found
        }
        DeValue::Array(parts) => {
            let numbers: Vec<f64> = parts.iter().filter_map(|part| reader.finite(part, name)).collect();
            match numbers.as_slice() {
                [low, high] if low <= high && parts.len() == 2 => Some(Bounds::Within([*low, *high])),
                _ => {
                    let span = reader.span_of(node);
                    let message = format!("the range of `{name}` is two numbers, the smaller one first");
                    reader.report(Diagnostic::new(&BAD_CONFIG, span, message));
                    None
                }
            }
        }
        _ => reader.finite(node, name).map(|number| Bounds::Within([number, number])),
    }
}

/// The ranges of numbers, as costs take them.
pub(crate) fn numbers(ranges: &[(String, Bounds)]) -> Ranges {
    let mut numbers = Ranges::default();
    for (name, bounds) in ranges {
        if let Bounds::Within(range) = bounds {
            numbers.add(name, *range);
        }
    }
    numbers
}
