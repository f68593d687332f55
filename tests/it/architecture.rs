//! The invariants of `docs/architecture.md` that can be tested: module docs, who may use what, sizes of files, and what
//! the compiler core depends on.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines that a file may have, tables and their like left out.
const MAX_LINES: usize = 700;

/// Files above [`MAX_LINES`], each a table or a list of the grammar's productions.
static LONG_FILES: &[&str] = &[];

/// Path prefixes under `src`, and what no `use` or path in them may name.
static FORBIDDEN: &[(&str, &[&str])] = &[
    ("source/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::hir", "crate::link", "std::fs", "std::env"]),
    ("diagnostic/", &["naga::", "wgpu::", "clap::", "crate::cli", "std::fs", "std::env"]),
    ("syntax/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::lower", "std::fs", "std::env"]),
    ("builtin/", &["wgpu::", "clap::", "crate::cli", "std::fs", "std::env"]),
    ("hir/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::lower", "std::fs", "std::env"]),
    ("analysis/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::lower", "std::fs", "std::env"]),
    ("link/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::lower", "std::fs", "std::env"]),
    ("lint/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::lower", "std::fs", "std::env"]),
    ("library/", &["naga::", "wgpu::", "clap::", "crate::cli", "std::env"]),
    ("shader_test/", &["naga::", "wgpu::", "clap::", "crate::cli", "std::env"]),
    ("lower/", &["wgpu::", "clap::", "crate::cli", "crate::cpu", "std::fs", "std::env"]),
    ("emit/", &["wgpu::", "clap::", "crate::cli", "crate::cpu", "std::fs", "std::env"]),
    ("scene/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::lower", "std::env"]),
    (
        "cpu/",
        &[
            "naga::",
            "wgpu::",
            "clap::",
            "crate::cli",
            "crate::lower",
            "crate::emit",
            "crate::gl",
            "crate::gpu",
            "std::fs",
            "std::env",
        ],
    ),
    ("compare/", &["naga::", "wgpu::", "clap::", "crate::cli", "crate::cpu", "crate::gpu", "std::fs", "std::env"]),
    ("gpu/", &["clap::", "crate::cli", "crate::cpu", "crate::gl"]),
    (
        "gl/",
        &[
            "naga::",
            "wgpu::",
            "clap::",
            "crate::cli",
            "crate::cpu",
            "crate::lower",
            "crate::emit",
            "crate::gpu",
            "std::fs",
            "std::env",
        ],
    ),
];

/// What only the command line does.
static PRINTING: &[&str] = &["println!", "print!(", "eprintln!", "eprint!(", "process::exit", "dbg!("];

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn rust_files(folder: &str) -> Vec<PathBuf> {
    let mut pending = vec![root().join(folder)];
    let mut files = Vec::new();
    while let Some(folder) = pending.pop() {
        for entry in fs::read_dir(&folder).expect("the folder is there") {
            let path = entry.expect("a folder entry").path();
            if path.is_dir() {
                pending.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    files
}

fn name_of(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// Lines that are code: no comment lines, and nothing from the unit tests on.
fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]")
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(index, line)| (index + 1, line))
}

#[test]
fn every_file_has_a_module_doc() {
    let folders = ["src", "tests", "examples", "benches"];
    let files = folders.iter().filter(|folder| root().join(folder).is_dir()).flat_map(|folder| rust_files(folder));
    let without: Vec<String> = files
        .filter(|path| !fs::read_to_string(path).expect("readable").starts_with("//! "))
        .map(|path| name_of(&path))
        .collect();
    assert!(without.is_empty(), "files that do not start with a module doc: {without:#?}");
}

#[test]
fn phases_use_only_what_they_may() {
    let mut wrong = Vec::new();
    assert!(rust_files("src").len() > 50, "the sources are not where they are looked for");
    for path in rust_files("src") {
        let name = name_of(&path);
        let text = fs::read_to_string(&path).expect("readable");
        let within = name.trim_start_matches("src/");
        let rules = FORBIDDEN.iter().filter(|(prefix, _)| within.starts_with(prefix));
        for (number, line) in code_lines(&text) {
            for needle in rules.clone().flat_map(|(_, needles)| needles.iter()) {
                if line.contains(needle) {
                    wrong.push(format!("{name}:{number} uses {needle}"));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn only_the_command_line_prints_and_exits() {
    let mut wrong = Vec::new();
    for path in rust_files("src") {
        let name = name_of(&path);
        if name.starts_with("src/cli/") || name == "src/main.rs" {
            continue;
        }
        let text = fs::read_to_string(&path).expect("readable");
        for (number, line) in code_lines(&text) {
            wrong.extend(
                PRINTING
                    .iter()
                    .filter(|needle| line.contains(*needle))
                    .map(|needle| format!("{name}:{number} {needle}")),
            );
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn files_keep_to_a_size_that_can_be_read() {
    let long: Vec<String> = rust_files("src")
        .iter()
        .map(|path| (name_of(path), fs::read_to_string(path).expect("readable").lines().count()))
        .filter(|(name, lines)| *lines > MAX_LINES && !LONG_FILES.contains(&name.as_str()))
        .map(|(name, lines)| format!("{name}: {lines} lines"))
        .collect();
    assert!(long.is_empty(), "{long:#?}");
}

#[test]
fn the_compiler_core_depends_on_no_gpu_and_no_command_line() {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["tree", "--no-default-features", "--edges", "normal", "--prefix", "none", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let tree = String::from_utf8_lossy(&output.stdout);
    for absent in ["wgpu", "clap", "image", "indicatif", "rayon", "toml", "tempfile", "plotters"] {
        let found = tree.lines().any(|line| line.split(' ').next() == Some(absent));
        assert!(!found, "the core depends on {absent}:\n{tree}");
    }
    assert!(tree.lines().any(|line| line.starts_with("naga ")), "{tree}");
}

#[test]
fn nothing_names_a_place_on_one_machine() {
    let mut wrong = Vec::new();
    let output = Command::new("git").args(["ls-files"]).current_dir(root()).output();
    // Outside of a checkout (a packaged crate) there is nothing to look at.
    let Ok(output) = output else { return };
    for name in String::from_utf8_lossy(&output.stdout).lines() {
        let Ok(text) = fs::read_to_string(root().join(name)) else { continue };
        let needles = [concat!("/wo", "rk/"), concat!("/tmp/", "prep"), concat!("/tmp/", "wt"), concat!("/ro", "ot/")];
        wrong.extend(needles.iter().filter(|needle| text.contains(*needle)).map(|needle| format!("{name}: {needle}")));
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
