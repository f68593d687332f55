//! The names of the packages are free, or ours.
//!
//! If a registry does not answer, the test says so and passes, also if `CI` is set: machines without a network build, too.

use super::support::root;
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
