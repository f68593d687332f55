//! Commands of this repository ask the same features of their dependencies, so that nothing is built twice.
//!
//! *In:* the workspace, through `cargo tree`. *Out:* the dependencies that a command would build again after
//! `cargo test --all-features`, with the features that it asks for. *Holds:* `crates/features` is part of each command.

use super::support::root;
use std::collections::BTreeSet;
use std::process::Command;

/// The commands of `.ci/run` that build or check, without the tests: the packages, their features, and whether
/// dependencies of tests count.
static COMMANDS: &[(&[&str], &str, bool)] = &[
    (&[], "--all-features", false),
    (&[], "", true),
    (&["glisten"], "", false),
    (&["glisten"], "--no-default-features", false),
    (&["glisten-example-wgpu"], "", false),
];

/// Crates that nothing large depends on, which may be built twice: ours, and that of HTTP, whose TLS is a feature of ours.
fn may_differ(dependency: &str) -> bool {
    dependency.starts_with("glisten") || dependency.starts_with("ureq ")
}

/// The dependencies of a command on this machine, each as "name version [features]".
fn dependencies(packages: &[&str], features: &str, tests: bool) -> BTreeSet<String> {
    let kinds = if tests { "normal,build,dev" } else { "normal,build" };
    let mut command = Command::new(env!("CARGO"));
    command.current_dir(root()).args([
        "tree",
        "--offline",
        "--locked",
        "--prefix",
        "none",
        "--no-dedupe",
        "--format",
        "{p} [{f}]",
    ]);
    command.args(["--edges", kinds]);
    for package in packages.iter().chain(packages.first().map(|_| &"glisten-features")) {
        command.args(["--package", package]);
    }
    if !features.is_empty() {
        command.arg(features);
    }
    let output = command.output().expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout)
        .lines()
        .map(|line| line.replace(" (*)", "").replace(" (proc-macro)", ""))
        .filter(|line| !line.is_empty())
        .collect()
}

#[test]
fn commands_share_what_they_build() {
    let built = dependencies(&[], "--all-features", true);
    assert!(built.len() > 200, "only {} dependencies were listed", built.len());
    for (packages, features, tests) in COMMANDS {
        let again: Vec<String> = dependencies(packages, features, *tests)
            .difference(&built)
            .filter(|one| !may_differ(one))
            .cloned()
            .collect();
        assert!(again.is_empty(), "{packages:?} {features} builds again: {again:#?}");
    }
}
