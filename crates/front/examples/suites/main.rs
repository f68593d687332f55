//! Compares the front end with two test suites of GLSL, and prints the tables of `docs/conformance.md`.
//!
//! ```text
//! cargo run -p glisten-front --example suites -- piglit FOLDER [--show] [ONLY]
//! cargo run -p glisten-front --example suites -- glslang FOLDER [--show] [ONLY]
//! ```
//!
//! FOLDER is a copy of the suite. `--show` prints each difference with the first error, ONLY restricts the run to the tests
//! whose path contains it. It exits with 1 if a verdict differs without a reason in `known.txt`, or if a reason there is no
//! longer needed.

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

mod glslang;
mod judge;
mod known;
mod piglit;

use known::Known;
use std::path::Path;
use std::process::ExitCode;

/// One finished comparison.
pub(crate) struct Finding {
    /// The row of the table that it counts in.
    pub(crate) group: String,
    /// The path of the test below the suite's folder.
    pub(crate) name: String,
    /// The outcome of the comparison.
    pub(crate) outcome: Outcome,
}

/// The outcome of a comparison.
pub(crate) enum Outcome {
    /// As the suite expects.
    Agrees,
    /// Not as the suite expects: the difference in words.
    Differs(String),
    /// Not compared, and the reason.
    Omitted(String),
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let show = arguments.iter().any(|argument| argument == "--show");
    let mut words = arguments.iter().filter(|argument| !argument.starts_with("--")).map(String::as_str);
    let (Some(suite), Some(folder)) = (words.next(), words.next()) else {
        eprintln!("usage: suites piglit|glslang FOLDER [--show] [ONLY]");
        return ExitCode::from(2);
    };
    let only = words.next();
    let run = match suite {
        "piglit" => piglit::run,
        "glslang" => glslang::run,
        _ => {
            eprintln!("the suites are piglit and glslang, not {suite}");
            return ExitCode::from(2);
        }
    };
    let mut findings = match run(Path::new(folder)) {
        Ok(findings) => findings,
        Err(error) => {
            eprintln!("{folder}: {error}");
            return ExitCode::from(2);
        }
    };
    findings.retain(|finding| only.is_none_or(|only| finding.name.contains(only)));
    if show {
        findings.iter().for_each(explain);
    }
    let known = Known::of(suite);
    print!("{}", known::table(&findings, &known));
    let open = known::open(&findings, &known, only.is_none());
    open.iter().for_each(|line| println!("{line}"));
    if open.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn explain(finding: &Finding) {
    match &finding.outcome {
        Outcome::Agrees => {}
        Outcome::Differs(how) => println!("{}: {how}", finding.name),
        Outcome::Omitted(why) => println!("{}: omitted: {why}", finding.name),
    }
}
