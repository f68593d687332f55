//! The list of rules is made: `rules/mod.rs` has a line `mod` and a row for each file of its folder, in the order of the codes.

use crate::diagnostic::{Code, codes};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use std::{env, fs};

/// The text of `rules/mod.rs` for these files and their codes.
fn list(files: &BTreeSet<String>, codes: &[&Code]) -> String {
    let mut text = String::from(
        "//! The rules, one file each. This list is made from the folder and the table of codes:\n\
         //! `UPDATE_RULES=1 cargo test -p glisten-front every_rule_is_listed`.\n\n",
    );
    for file in files {
        let _ = writeln!(text, "mod {file};");
    }
    text.push_str(
        "\nuse super::Rule;\nuse crate::diagnostic::codes::lints;\n\npub(super) static RULES: &[Rule] = &[\n",
    );
    for code in codes {
        let file = file_of(code);
        let _ = writeln!(text, "    Rule {{ code: &lints::{}, check: {file}::check }},", file.to_uppercase());
    }
    text + "];\n"
}

fn file_of(code: &Code) -> String {
    code.name.replace('-', "_")
}

#[test]
fn every_rule_is_listed() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/lint/rules");
    let files = fs::read_dir(&folder).expect("the folder is there").filter_map(|entry| {
        let name = entry.expect("the folder can be read").file_name().into_string().expect("names are ASCII");
        name.strip_suffix(".rs").filter(|name| *name != "mod").map(str::to_owned)
    });
    let files: BTreeSet<String> = files.collect();
    let mut rules: Vec<&Code> = codes::all().filter(|code| code.lint.is_some()).collect();
    rules.retain(|code| files.contains(&file_of(code)));
    rules.sort_by_key(|code| code.id);
    let named: BTreeSet<String> = rules.iter().map(|code| file_of(code)).collect();
    let unnamed: Vec<&String> = files.difference(&named).collect();
    assert!(unnamed.is_empty(), "no code of a lint rule has the name of these files: {unnamed:?}");
    let (file, text) = (folder.join("mod.rs"), list(&files, &rules));
    if env::var_os("UPDATE_RULES").is_some() {
        fs::write(&file, &text).expect("it can be written");
    }
    let found = fs::read_to_string(&file).expect("it is there");
    assert!(
        found == text,
        "rules/mod.rs is not current: UPDATE_RULES=1 cargo test -p glisten-front every_rule_is_listed"
    );
}
