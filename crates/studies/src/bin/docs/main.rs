//! Writes the generated parts of `README.md` and `docs/*.md`.
//!
//! ```sh
//! cargo run -p glisten-studies --bin docs                        # the parts that are the same on every machine
//! cargo run -p glisten-studies --bin docs -- --check             # exit code 1 if those are not current
//! cargo run -p glisten-studies --bin docs -- docs/conformance.md # one page
//! cargo run --release -p glisten-studies --bin docs -- --measured   # the measured parts, too
//! ```

#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program for the terminal")]

mod conformance;
mod help;
mod maker;
mod numbers;
mod numerics;
mod regions;
mod sections;
mod threejs;

use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};
use std::{env, fs};

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let has = |flag: &str| arguments.iter().any(|argument| argument == flag);
    let (flags, wanted): (Vec<String>, Vec<String>) =
        arguments.iter().cloned().partition(|argument| argument.starts_with("--"));
    if let Some(unknown) = flags.iter().find(|flag| !["--check", "--measured"].contains(&flag.as_str())) {
        eprintln!("unknown argument {unknown}; there are --check and --measured");
        return ExitCode::from(2);
    }
    match run(has("--check"), has("--measured"), &wanted) {
        Ok(stale) if stale.is_empty() => ExitCode::SUCCESS,
        Ok(stale) => {
            eprintln!("not current: {}\nrun: cargo run -p glisten-studies --bin docs", stale.join(", "));
            ExitCode::FAILURE
        }
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Generates the wanted pages again, or all. Returns the pages that differ and were not written.
fn run(check: bool, measured: bool, wanted: &[String]) -> Result<Vec<String>, String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let program = program(&root)?;
    let mut generator = maker::Generator { program, root: root.clone(), measured, made: 0, left: 0 };
    let mut stale = Vec::new();
    let pages = pages(&root).map_err(|error| format!("docs cannot be read: {error}"))?;
    for page in &pages {
        let name = page.strip_prefix(&root).unwrap_or(page).display().to_string();
        if !wanted.is_empty() && !wanted.contains(&name) {
            continue;
        }
        let old = fs::read_to_string(page).map_err(|error| format!("{name}: {error}"))?;
        let new = regions::remake(&old, &mut generator).map_err(|error| format!("{name}: {error}"))?;
        match (old == new, check) {
            (true, _) => {}
            (false, true) => stale.push(name),
            (false, false) => fs::write(page, new).map_err(|error| format!("{name}: {error}"))?,
        }
    }
    println!("{} pages, {} parts made, {} measured parts left", pages.len(), generator.made, generator.left);
    Ok(stale)
}

/// Builds the program and returns its path, which is next to this one.
fn program(root: &Path) -> Result<PathBuf, String> {
    let own = env::current_exe().map_err(|error| error.to_string())?;
    let folder = own.parent().ok_or("this program is not in a target folder")?;
    let release = folder.file_name().is_some_and(|name| name == "release");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut build = Command::new(cargo);
    build.args(["build", "--quiet", "--bin", "glisten", "--all-features"]).current_dir(root);
    let status = build.args(release.then_some("--release")).status();
    let status = status.map_err(|error| format!("cargo cannot run: {error}"))?;
    if !status.success() {
        return Err("the program `glisten` does not build".to_owned());
    }
    Ok(folder.join(format!("glisten{}", env::consts::EXE_SUFFIX)))
}

fn pages(root: &Path) -> std::io::Result<Vec<PathBuf>> {
    let mut pages = vec![root.join("README.md")];
    for entry in fs::read_dir(root.join("docs"))? {
        pages.push(entry?.path());
    }
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    Ok(pages)
}
