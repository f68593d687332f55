//! The contents of the regions of the documentation, and their sources.
//!
//! *In:* a region's name, or a command line of glisten. *Out:* Markdown. *Holds:* [`REGIONS`] has a row for each
//! name, which says whether its text is the same on every machine. Measured text is generated only on request.

use super::regions::Maker;
use glisten::diagnostic::Severity;
use glisten_front::builtin;
use glisten_front::diagnostic::codes;
use glisten_library as library;
use glisten_reference::domain::{faults, fitted, rules};
use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;

/// The source of a region.
enum Source {
    /// From the tables of the code.
    Tables(fn() -> String),
    /// From an examination, which may fail.
    Examined(fn() -> Result<String, String>),
    /// From the output of the program, with these arguments.
    Output(&'static [&'static str]),
    /// From the help of the program.
    Help,
    /// From the output of the program, which depends on the machine.
    Measured(&'static [&'static str]),
    /// From the differences that `glisten lib prefilter` prints for the panorama of the gallery's scene `studio`.
    Panorama,
    /// From the output of a benchmark with an argument.
    Bench(&'static str, &'static str),
    /// From the output of another study with arguments.
    Study(&'static str, &'static [&'static str]),
}

static REGIONS: &[(&str, Source)] = &[
    ("claims", Source::Study("claims", &[])),
    ("claims-time", Source::Study("claims", &["time"])),
    ("codes", Source::Tables(diagnostics)),
    ("commands", Source::Help),
    ("conformance", Source::Examined(super::conformance::conformance)),
    ("faults", Source::Tables(known_faults)),
    ("fitted", Source::Tables(fitted_constants)),
    ("library", Source::Output(&["lib", "list"])),
    ("library-errors", Source::Measured(&["lib", "measure"])),
    ("library-stability", Source::Examined(super::numerics::equations)),
    ("lint-rules", Source::Tables(lint_rules)),
    ("operations", Source::Tables(builtin::operations_markdown)),
    ("pipeline", Source::Tables(pipeline)),
    ("precision", Source::Tables(builtin::precision_markdown)),
    ("prefilter", Source::Panorama),
    ("programs", Source::Tables(programs)),
    ("specialize-draw", Source::Bench("specialize", "draw")),
    ("specialize-make", Source::Bench("specialize", "make")),
    ("threejs", Source::Examined(super::threejs::table)),
];

/// Commands whose output depends on the machine.
static MEASURED: &[&str] = &["verify", "report", "render", "gallery", "test"];

/// Makes all regions.
pub(crate) struct Generator {
    /// The program `glisten`.
    pub(crate) program: PathBuf,
    /// The folder of the repository.
    pub(crate) root: PathBuf,
    /// Whether measured parts are made, too.
    pub(crate) measured: bool,
    /// The number of parts that were made.
    pub(crate) made: usize,
    /// The number of parts that were left, because they are measured.
    pub(crate) left: usize,
}

impl Generator {
    fn run(&self, arguments: &[&str]) -> Result<String, String> {
        let output = Command::new(&self.program)
            .args(arguments)
            .current_dir(&self.root)
            .output()
            .map_err(|error| format!("{} cannot run: {error}", self.program.display()))?;
        Ok(String::from_utf8_lossy(&output.stderr).into_owned() + &String::from_utf8_lossy(&output.stdout))
    }

    /// The output of a benchmark.
    fn bench(&self, name: &str, argument: &str) -> Result<String, String> {
        self.cargo(name, &["bench", "--quiet", "--bench", name, "--", argument])
    }

    /// The output of another study.
    fn study(&self, name: &str, arguments: &[&str]) -> Result<String, String> {
        self.cargo(
            name,
            &[&["run", "--quiet", "--release", "--package", "glisten-studies", "--bin", name, "--"], arguments]
                .concat(),
        )
    }

    /// The output of what cargo builds and runs.
    fn cargo(&self, name: &str, arguments: &[&str]) -> Result<String, String> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(cargo);
        command.args(arguments).current_dir(&self.root);
        let output = command.output().map_err(|error| format!("cargo cannot run: {error}"))?;
        if !output.status.success() {
            return Err(format!("`{name}` fails: {}", String::from_utf8_lossy(&output.stderr)));
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// Draws the panorama on the reference, so that every machine has the same one, and prefilters it.
    fn panorama(&self) -> Result<String, String> {
        let folder = std::env::temp_dir().join(format!("glisten-docs-{}", std::process::id()));
        let [panorama, maps] = ["studio.exr", "maps"].map(|name| folder.join(name).display().to_string());
        std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let scene = "examples/environment/studio.toml";
        let drawn = self.printed(&["render", scene, "--backend", "cpu", "-o", &panorama]);
        let sizes = ["--size", "65", "--levels", "6"];
        let text =
            drawn.and_then(|_| self.printed(&[&["lib", "prefilter", &panorama, "-o", &maps], &sizes[..]].concat()));
        // What is left there is no reason to fail.
        let _ = std::fs::remove_dir_all(&folder);
        text
    }

    /// The standard output of the program.
    fn printed(&self, arguments: &[&str]) -> Result<String, String> {
        let mut command = Command::new(&self.program);
        command.args(arguments).current_dir(&self.root);
        let output = command.output().map_err(|error| format!("{} cannot run: {error}", self.program.display()))?;
        if !output.status.success() {
            return Err(format!("`{}` fails: {}", arguments.join(" "), String::from_utf8_lossy(&output.stderr)));
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }

    fn leave(&mut self) -> Result<Option<String>, String> {
        self.left += 1;
        Ok(None)
    }

    fn make(&mut self, text: String) -> Result<Option<String>, String> {
        self.made += 1;
        Ok(Some(text))
    }
}

impl Maker for Generator {
    fn region(&mut self, name: &str) -> Result<Option<String>, String> {
        let Some((_, source)) = REGIONS.iter().find(|(known, _)| *known == name) else {
            return Err(format!("nobody makes the region `{name}`"));
        };
        match source {
            Source::Tables(table) => self.make(table()),
            Source::Examined(examine) => {
                let text = examine()?;
                self.make(text)
            }
            Source::Output(arguments) => {
                let text = self.run(arguments)?;
                self.make(format!("```text\n{}\n```", text.trim_end()))
            }
            Source::Help => {
                let text = super::help::commands(|arguments| self.run(arguments))?;
                self.make(text)
            }
            Source::Measured(_) | Source::Panorama | Source::Bench(..) | Source::Study(..) if !self.measured => {
                self.leave()
            }
            Source::Panorama => {
                let text = self.panorama()?;
                self.make(text)
            }
            Source::Study(name, arguments) => {
                let text = self.study(name, arguments)?;
                self.make(text)
            }
            Source::Bench(name, argument) => {
                let text = self.bench(name, argument)?;
                self.make(text)
            }
            Source::Measured(arguments) => {
                let text = self.run(arguments)?;
                self.make(text)
            }
        }
    }

    fn output(&mut self, command: &str) -> Result<Option<String>, String> {
        let arguments: Vec<&str> = command.split_whitespace().skip(1).collect();
        let measured = arguments.first().is_some_and(|subcommand| MEASURED.contains(subcommand));
        if measured && !self.measured {
            return self.leave();
        }
        let text = self.run(&arguments)?;
        self.make(text)
    }
}

fn lint_rules() -> String {
    let mut text =
        "| code | name | group | level | fixes | what it finds |\n| --- | --- | --- | --- | --- | --- |\n".to_owned();
    let mut rules: Vec<_> = codes::all().filter_map(|code| Some((code, code.lint?))).collect();
    rules.sort_by_key(|(code, lint)| (lint.group, code.id));
    for (code, lint) in rules {
        let end = code.page.find(". ").map_or(code.page.len(), |end| end + 1);
        let (group, level, fixes) = (lint.group.name(), lint.level.name(), lint.fixable.name());
        let finds = code.page.get(..end).unwrap_or(code.page).replace('|', "\\|");
        let _ = writeln!(text, "| `{}` | {} | {group} | {level} | {fixes} | {finds} |", code.id, code.name);
    }
    text
}

fn diagnostics() -> String {
    let mut text = "| code | name | level | section |\n| --- | --- | --- | --- |\n".to_owned();
    for code in codes::all() {
        let level = match code.severity {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note if code.is_off() => "allow",
            Severity::Note => "note",
        };
        let _ = writeln!(text, "| `{}` | {} | {level} | {} |", code.id, code.name, code.section);
    }
    text
}

fn pipeline() -> String {
    let mut out = String::from("| step | allowed | source |\n| --- | --- | --- |\n");
    for step in rules::PIPELINE.iter().chain(rules::OWN) {
        let _ = writeln!(out, "| {} | {} | {} |", step.operation, step.describe(), step.source);
    }
    out
}

fn fitted_constants() -> String {
    let mut text = "| constant | value | profile | measured by |\n| --- | --- | --- | --- |\n".to_owned();
    for row in fitted::FITTED {
        let value = format!("{} {}", row.value, row.unit);
        let _ = writeln!(text, "| {} | {} | {} | {} |", row.what, value.trim(), row.profile, row.measured);
    }
    text
}

fn known_faults() -> String {
    let mut text = "| name | broken rule | measured | applies to |\n| --- | --- | --- | --- |\n".to_owned();
    for fault in faults::KNOWN {
        let _ = writeln!(text, "| `{}` | {} | {} | {} |", fault.name, fault.rule, fault.measured, fault.applies);
    }
    text
}

fn programs() -> String {
    let mut text = "| `program` | what it draws |\n| --- | --- |\n".to_owned();
    for program in library::programs() {
        let _ = writeln!(text, "| `{}` | {} |", program.name, program.about);
    }
    text
}
