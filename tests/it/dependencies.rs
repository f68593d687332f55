//! `docs/dependencies.md` has each crate that a manifest names, once, and no other; `docs/SECURITY.md` each file with unsafe code.

use crate::support::root;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

/// The manifests of the repository.
fn manifests() -> Vec<PathBuf> {
    let mut found = vec![root().join("Cargo.toml")];
    for folder in ["crates", "crates/fuzz", "examples", "integrations", "integrations/web"] {
        let entries = fs::read_dir(root().join(folder)).expect("a folder of the repository");
        found.extend(entries.flatten().map(|entry| entry.path().join("Cargo.toml")).filter(|path| path.is_file()));
    }
    found
}

/// The crates of others that a table of a manifest depends on, by their names on crates.io.
fn named(table: &Table, into: &mut BTreeSet<String>) {
    for (key, value) in table {
        match value {
            Value::Table(inner) if key.ends_with("dependencies") => {
                for (name, dependency) in inner {
                    let package = dependency.get("package").and_then(Value::as_str).unwrap_or(name);
                    into.insert(package.to_owned());
                }
            }
            Value::Table(inner) => named(inner, into),
            _ => {}
        }
    }
}

/// The crates in the first columns of the page's tables, with duplicates.
fn listed(page: &str) -> Vec<String> {
    let rows = page.lines().filter(|line| line.starts_with("| `"));
    let cells = rows.filter_map(|line| line.split('|').nth(1));
    cells
        .flat_map(|cell| cell.split(',').map(|name| name.trim().trim_matches('`').to_owned()).collect::<Vec<_>>())
        .collect()
}

#[test]
fn each_crate_has_its_sentence() {
    let mut used = BTreeSet::new();
    let paths = manifests();
    assert!(paths.len() > 10, "the manifests are not where they are looked for");
    for path in paths {
        let text = fs::read_to_string(&path).expect("readable");
        named(&text.parse::<Table>().expect("a manifest is TOML"), &mut used);
    }
    used.retain(|name| name != "glisten" && !name.starts_with("glisten-"));
    let page = fs::read_to_string(root().join(Path::new("docs/dependencies.md"))).expect("readable");
    let rows = listed(&page);
    let there: BTreeSet<String> = rows.iter().cloned().collect();
    assert_eq!(rows.len(), there.len(), "a crate stands there twice");
    assert_eq!(there, used, "left: docs/dependencies.md, right: the manifests");
    assert!(
        page.lines()
            .filter(|line| line.starts_with("| `"))
            .all(|line| { line.split('|').nth(2).is_some_and(|sentence| sentence.trim().len() > 6) })
    );
}

/// The files of Rust below a folder, by their paths in the repository.
fn sources(folder: &str, into: &mut Vec<String>) {
    for entry in fs::read_dir(root().join(folder)).expect("a folder of the repository").flatten() {
        let name = format!("{folder}/{}", entry.file_name().to_string_lossy());
        if entry.path().is_dir() && !name.ends_with("/target") {
            sources(&name, into);
        } else if name.ends_with(".rs") {
            into.push(name);
        }
    }
}

#[test]
fn each_file_with_unsafe_code_is_told() {
    let mut files = Vec::new();
    ["src", "crates", "integrations", "examples", "benches"].iter().for_each(|folder| sources(folder, &mut files));
    let is_unsafe = |name: &String| {
        let text = fs::read_to_string(root().join(name)).expect("readable");
        ["expect(unsafe_code", "allow(unsafe_code"].iter().any(|attribute| text.contains(attribute))
    };
    let mut found: BTreeSet<String> = files.into_iter().filter(is_unsafe).collect();
    found.retain(|name| !name.starts_with("integrations/c/"));
    found.insert("integrations/c".to_owned());
    let page = fs::read_to_string(root().join("docs/SECURITY.md")).expect("readable");
    let told: BTreeSet<String> = listed(&page).into_iter().collect();
    assert_eq!(told, found, "left: docs/SECURITY.md, right: the sources");
}
