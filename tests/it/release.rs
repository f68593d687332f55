//! The names of the packages are free, or ours; what is published depends on nothing else; `cargo run` is the program.
//!
//! If a registry does not answer, the first test says so and passes, also if `CI` is set: machines without a network build, too.

use super::support::root;
use serde_json::Value;
use std::process::Command;

#[test]
#[expect(clippy::print_stderr, reason = "a registry that was not asked is told aloud")]
fn nobody_else_has_the_names_of_the_packages() {
    let output = Command::new("python3").arg(root().join("integrations/release/ready")).arg("names").output();
    let output = output.expect("Python starts");
    let [text, why] = [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned());
    assert!(output.status.success(), "{text}{why}");
    text.lines().filter(|line| line.starts_with("NOT ASKED")).for_each(|line| eprintln!("{line}"));
    for registry in ["crates.io", "PyPI"] {
        let told = |word: &str| text.lines().any(|line| line.starts_with(word) && line.contains(registry));
        assert!(told("free") || told("ours") || told("NOT ASKED"), "{registry}: {text}");
    }
}

/// The workspace as Cargo knows it.
fn metadata() -> Value {
    let metadata = Command::new(env!("CARGO"))
        .args(["metadata", "--no-deps", "--format-version", "1", "--offline", "--locked"])
        .current_dir(root())
        .output()
        .expect("Cargo starts");
    serde_json::from_slice(&metadata.stdout).expect("JSON")
}

/// The README's first command is `cargo run`: of several binaries of the default members, Cargo takes the one default that a package names.
#[test]
fn cargo_run_is_the_program() {
    let metadata = metadata();
    let is_default = |package: &&Value| {
        let defaults = metadata["workspace_default_members"].as_array().expect("a list");
        defaults.contains(&package["id"])
    };
    let packages = metadata["packages"].as_array().expect("a list");
    let named = packages.iter().filter(is_default).filter(|package| package["default_run"].is_string());
    let named: Vec<(&Value, &Value)> = named.map(|package| (&package["name"], &package["default_run"])).collect();
    assert_eq!(named, [(&Value::from("glisten"), &Value::from("glisten"))]);
}

/// `cargo package` refuses a crate that depends on one without a version, and a registry one that depends on a crate which is not there.
#[test]
fn published_crates_depend_on_published_ones() {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().expect("a list");
    let is_published = |package: &&Value| package["publish"].is_null();
    let (published, others): (Vec<&Value>, Vec<&Value>) = packages.iter().partition(is_published);
    let names: Vec<&Value> = published.iter().map(|package| &package["name"]).collect();
    let mut n_checked = 0;
    for package in &published {
        let all = package["dependencies"].as_array().expect("a list");
        for dependency in all.iter().filter(|one| one["path"].is_string() && one["kind"] != "dev") {
            assert!(names.contains(&&dependency["name"]), "{}: {dependency}", package["name"]);
            assert_ne!(dependency["req"], "*", "{}: {dependency}", package["name"]);
            n_checked += 1;
        }
    }
    assert!(n_checked > 10, "{n_checked}");
    let told = Command::new(root().join("integrations/release/unpublished")).output().expect("it starts");
    let told = String::from_utf8_lossy(&told.stdout).into_owned();
    let words: Vec<&str> =
        others.iter().filter_map(|package| package["name"].as_str()).flat_map(|name| ["--exclude", name]).collect();
    assert_eq!(told.split_whitespace().collect::<Vec<_>>(), words);
}
