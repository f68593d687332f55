//! Fifty faults, and who finds them: glisten, glslang and naga by running them, the others by what their own documents say
//! (docs/comparison.md).
//!
//! ```sh
//! cargo test --all-features --test it -- comparison --nocapture
//! ```
//!
//! prints the table. *Holds:* glisten finds a fault if it says something at its line, which ends with `// fault`; a compiler does if it
//! refuses the program, which has no other fault.

use crate::cli::Folder;
use crate::support::root;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A fault with the rules of those that do not run here: shader-clippy, wgslender, Godot. `compiler` is a mistake that no compiler of
/// their languages lets pass, `language` one that WGSL does not have.
type Row = (&'static str, [&'static str; 3]);

const NONE: &str = "";
const NOT_READ: &str = "not read";
const COMPILER: [&str; 3] = ["compiler", "compiler", "compiler"];

static FAULTS: [Row; 50] = [
    ("missing_semicolon", COMPILER),
    ("misspelled_name", COMPILER),
    ("wrong_type", COMPILER),
    ("wrong_arguments", COMPILER),
    ("swizzle_beyond_vector", COMPILER),
    ("assigned_uniform", COMPILER),
    ("missing_return_value", COMPILER),
    ("return_on_some_ways", [NONE, "language", NONE]),
    ("recursion", ["compiler", "language", NONE]),
    ("index_out_of_range", [NONE, "language", NONE]),
    ("duplicate_case", ["compiler", "`no-duplicate-case`", NONE]),
    ("read_before_written", [NONE, "language", NONE]),
    ("read_on_some_ways", [NONE, "language", NONE]),
    ("output_never_written", [NONE, NONE, NONE]),
    ("position_never_written", [NONE, NONE, NONE]),
    ("out_parameter_never_written", [NONE, NONE, NONE]),
    ("endless_loop", [NONE, "language", NONE]),
    ("loop_counts_away", [NONE, "`for-direction`", NONE]),
    ("unreachable", [NONE, "`no-unreachable`", NONE]),
    ("assignment_as_condition", [NONE, "language", NONE]),
    ("self_assignment", [NONE, "`no-self-assign`", NONE]),
    ("equal_branches", ["`redundant-computation-in-branch`", NONE, NONE]),
    ("empty_body", [NONE, "`no-empty`", NONE]),
    ("constant_condition", [NONE, "`no-constant-condition`", NONE]),
    ("integer_division", [NONE, NONE, NONE]),
    ("comparison_with_itself", [NONE, NONE, NONE]),
    ("comparison_chain", [NONE, NONE, NONE]),
    ("lookup_in_divergent_flow", ["`derivative-in-divergent-cf`", "language", NONE]),
    ("varying_never_written", [NONE, NONE, NONE]),
    ("varying_of_another_type", [NONE, NONE, NONE]),
    ("varying_that_is_missing", [NONE, NONE, NONE]),
    ("pow_of_negative", [NONE, NONE, NONE]),
    ("root_of_negative", ["`sqrt-of-potentially-negative`", NONE, NONE]),
    ("acos_beyond_one", ["`acos-without-saturate`", NONE, NONE]),
    ("log_of_zero", [NONE, NONE, NONE]),
    ("division_by_clamped_zero", ["`div-without-epsilon`", NONE, NONE]),
    ("direction_of_zero", [NONE, NONE, NONE]),
    ("infinite_constant", [NONE, "language", NONE]),
    ("integer_division_by_zero", [NONE, "language", NONE]),
    ("pow_of_negative_constant", [NONE, "language", NONE]),
    ("float_equality", ["`compare-equal-float`", NONE, "`FLOAT_COMPARISON`"]),
    ("float_counter", [NONE, NONE, NONE]),
    ("interpolated_normal", [NONE, NONE, NONE]),
    ("normal_by_model_matrix", [NONE, NONE, NONE]),
    ("lookup_that_the_loop_repeats", ["`loop-invariant-sample`", NONE, NONE]),
    ("inverse_for_each_pixel", [NONE, NONE, NONE]),
    ("discard_after_work", ["`early-z-disabled-by-conditional-discard`", NONE, NONE]),
    ("unused_variable", [NONE, "`no-unused-vars`", "`UNUSED_LOCAL_VARIABLE`"]),
    ("varying_never_read", [NONE, NONE, "`UNUSED_VARYING`"]),
    ("shadowed_variable", [NONE, "`no-shadow`", NONE]),
];

/// The faults that glisten does not find, and why.
static MISSED: [(&str, &str); 1] =
    [("direction_of_zero", "that a cross product can be zero is told only with stated ranges, by `L0074`")];

/// A fault: its files, and the place.
struct Fault {
    files: Vec<PathBuf>,
    /// The file with the fault, and the line.
    at: (PathBuf, usize),
}

fn fault(name: &str) -> Fault {
    let folder = root().join("fixtures/faults");
    let files: Vec<PathBuf> = ["vert", "frag"]
        .map(|stage| folder.join(format!("{name}.{stage}")))
        .into_iter()
        .filter(|path| path.is_file())
        .collect();
    let line = |path: &Path| {
        let text = fs::read_to_string(path).expect("a text");
        text.lines().position(|line| line.ends_with("// fault")).map(|line| line + 1)
    };
    let at = files.iter().find_map(|path| line(path).map(|line| (path.clone(), line)));
    Fault { at: at.unwrap_or_else(|| panic!("{name} says where its fault is")), files }
}

/// The code that glisten has for the place, with and without the rules that are off by default.
fn by_glisten(folder: &Folder, fault: &Fault) -> String {
    let files: Vec<&str> = fault.files.iter().map(|path| path.to_str().expect("a name")).collect();
    let name = fault.at.0.to_string_lossy().into_owned();
    let codes = |more: &[&str]| -> Vec<String> {
        let (findings, _) = folder.lint(&[&files[..], more].concat());
        let is_there = |one: &&Value| one["line"] == fault.at.1 && one["file"] == name.as_str();
        findings.iter().filter(is_there).map(|one| format!("`{}`", one["code"].as_str().unwrap_or(""))).collect()
    };
    let plain = codes(&[]);
    if let Some(first) = plain.first() {
        return first.clone();
    }
    let groups = ["correctness", "port", "numerics", "performance", "style"];
    let all: Vec<&str> = groups.iter().flat_map(|group| ["--warn", group]).collect();
    codes(&all).first().map_or_else(String::new, |code| format!("{code}, off by default"))
}

/// The output of a command, without colors; nothing if it is not installed.
fn said(command: &mut Command) -> Option<String> {
    let output = command.env("NO_COLOR", "1").output().ok()?;
    let text = [output.stdout, output.stderr].concat();
    let text = String::from_utf8_lossy(&text).into_owned();
    let mut plain = String::new();
    let mut rest = text.as_str();
    while let Some((before, after)) = rest.split_once('\u{1b}') {
        plain.push_str(before);
        rest = after.split_once('m').map_or("", |(_, rest)| rest);
    }
    plain.push_str(rest);
    Some(plain)
}

fn by_glslang(fault: &Fault) -> Option<String> {
    let mut command = Command::new("glslangValidator");
    if fault.files.len() > 1 {
        command.arg("-l");
    }
    let text = said(command.args(&fault.files))?;
    let mark = format!(":{}:", fault.at.1);
    let is_there = |line: &str| line.contains(&mark) || line.contains("Linking");
    let found = |word: &str| text.lines().any(|line| line.starts_with(word) && is_there(line));
    Some(
        if found("ERROR") {
            "error"
        } else if found("WARNING") {
            "warning"
        } else {
            NONE
        }
        .to_owned(),
    )
}

fn by_naga(fault: &Fault) -> Option<String> {
    let path = &fault.at.0;
    let stage = path.extension()?.to_str()?;
    let text = said(Command::new("naga").args(["--input-kind", "glsl", "--shader-stage", stage]).arg(path))?;
    if text.contains("Validation successful") {
        return Some(String::new());
    }
    // A combined sampler is refused whatever else there is.
    let has_sampler = fs::read_to_string(path).ok()?.contains("sampler2D");
    Some(if has_sampler { NOT_READ } else { "error" }.to_owned())
}

#[test]
#[expect(clippy::print_stdout, reason = "the table is for the page")]
fn fifty_faults_are_found() {
    let folder = Folder::new(&[]);
    let names: BTreeSet<String> = fs::read_dir(root().join("fixtures/faults"))
        .expect("the folder")
        .map(|entry| entry.expect("an entry").path().file_stem().expect("a name").to_string_lossy().into_owned())
        .collect();
    assert!(names.iter().map(String::as_str).eq(FAULTS.iter().map(|row| row.0).collect::<BTreeSet<_>>()));
    let mut table = String::new();
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    let mut wrong = Vec::new();
    let page = fs::read_to_string(root().join("docs/comparison.md")).expect("the page");
    let dash = |text: &str| if text.is_empty() { "–".to_owned() } else { text.to_owned() };
    for (name, others) in &FAULTS {
        let fault = fault(name);
        let own = by_glisten(&folder, &fault);
        let missing = || "not installed".to_owned();
        let (glslang, naga) = (by_glslang(&fault).unwrap_or_else(missing), by_naga(&fault).unwrap_or_else(missing));
        let cells: Vec<String> =
            [own.as_str(), &glslang, &naga].into_iter().chain(others.iter().copied()).map(dash).collect();
        for (column, cell) in cells.iter().enumerate() {
            *counts.entry(column).or_default() += usize::from(cell != "–" && cell != NOT_READ);
        }
        let _ = writeln!(table, "| {} | {} |", name.replace('_', " "), cells.join(" | "));
        let excused = MISSED.iter().any(|row| row.0 == *name);
        if own.is_empty() != excused {
            wrong.push(format!("{name}: glisten says `{own}`"));
        }
        if !page.contains(&format!("| {} | {} |", name.replace('_', " "), dash(&own))) {
            wrong.push(format!("{name}: docs/comparison.md has another code than {own}"));
        }
    }
    let sums: Vec<String> = counts.values().map(ToString::to_string).collect();
    println!("{table}| of 50 | {} |", sums.join(" | "));
    assert!(wrong.is_empty(), "{wrong:#?}");
}
