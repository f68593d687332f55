//! The cache of `lint`: what is taken from it is told as a run without it tells it; whatever findings depend on makes it a miss.

use crate::cli::{Folder, code, err, out};
use std::fs;

const NUMERIC: &str = "#version 150\n#include \"part.glsl\"\nin vec3 n;\nuniform float t; // glisten: range(-1, 1)\nout vec4 c;\n\
    void main() {\n    float unused;\n    c = vec4(twice(log(t)), 1.0 / t, n.x == 0.5, 1);\n}\n";
const PART: &str = "float twice(float x) { return TIMES * x; }\n";
const BROKEN: &str = "#version 150\nout vec4 c;\nvoid main() {\n    c = vec4(missing);\n}\n";
const CLEAN: &str = "#version 150\nout vec4 c;\nvoid main() {\n    c = vec4(1.0);\n}\n";
const NO_VERSION: &str = "in vec4 p;\nvoid main() { gl_Position = p; }\n";

/// A tree with findings of each kind: those of the compiler, those of rules, those with witnesses, a file that is not checked.
fn tree() -> Folder {
    Folder::new(&[
        ("a/numeric.frag", NUMERIC.as_bytes()),
        ("a/part.glsl", PART.as_bytes()),
        ("b/broken.frag", BROKEN.as_bytes()),
        ("b/clean.frag", CLEAN.as_bytes()),
        ("c/old.vert", NO_VERSION.as_bytes()),
    ])
}

const RULES: &[&str] = &["--warn", "correctness", "--warn", "numerics", "-DTIMES=2.0"];

/// The outcome of a run: its exit code, its output, its messages but for the line on the cache, and that line.
fn lint(folder: &Folder, more: &[&str]) -> (i32, String, String, String) {
    let run = folder.run(&[&["lint", "."], RULES, more].concat());
    let (messages, cache): (Vec<String>, Vec<String>) =
        err(&run).lines().map(str::to_owned).partition(|line| !line.ends_with("from the cache"));
    (code(&run), out(&run), messages.join("\n"), cache.join("\n"))
}

/// Runs with the cache, compares with a run without it, and returns the line on the cache.
fn cached(folder: &Folder, more: &[&str]) -> String {
    let (exit, told, messages, cache) = lint(folder, &[more, &["--cache", "kept"]].concat());
    let (plain_exit, plain, plain_messages, _) = lint(folder, more);
    assert_eq!((exit, told, messages), (plain_exit, plain, plain_messages), "{more:?}");
    cache
}

#[test]
fn what_is_recalled_is_told_alike() {
    let folder = tree();
    assert_eq!(cached(&folder, &[]), "0 of 4 from the cache");
    assert_eq!(cached(&folder, &[]), "4 of 4 from the cache");
    for format in ["json", "sarif", "github", "gitlab", "junit"] {
        assert_eq!(cached(&folder, &["--format", format]), "4 of 4 from the cache", "{format}");
    }
    let (exit, told, messages, _) = lint(&folder, &["--cache", "kept"]);
    assert_eq!(exit, 1);
    for part in ["E0301", "L0074", "L0051", "with `t` = 0.0"] {
        assert!(told.contains(part), "{part}: {told}");
    }
    assert!(messages.contains("1 file was not checked"), "{messages}");
    assert_eq!(cached(&folder, &["--quiet"]), "");
}

#[test]
fn whatever_findings_depend_on_makes_it_a_miss() {
    let folder = tree();
    let settled = |more: &[&str]| {
        cached(&folder, more);
        assert_eq!(cached(&folder, more), "4 of 4 from the cache", "{more:?}");
    };
    settled(&[]);
    let missed = |what: &str, count: usize, more: &[&str]| {
        assert_eq!(cached(&folder, more), format!("{} of 4 from the cache", 4 - count), "{what}");
        settled(more);
    };
    let write = |name: &str, text: &str| fs::write(folder.path(name), text).expect("written");
    write("a/part.glsl", &PART.replace("TIMES", "0.5 * TIMES"));
    missed("an include", 1, &[]);
    write("b/clean.frag", &CLEAN.replace("1.0", "0.5"));
    missed("a source", 1, &[]);
    write("glisten.toml", "[fmt]\nindent = 2\n");
    assert_eq!(cached(&folder, &[]), "4 of 4 from the cache", "what findings do not depend on");
    write("glisten.toml", "[lint]\nallow = [\"L0051\"]\n");
    missed("levels of the project", 4, &[]);
    write("glisten.toml", "[lint.ranges]\nn = [0, 1]\n");
    missed("ranges of the project", 4, &[]);
    write("glisten.toml", "[lint.budgets]\n\"b/*.frag\" = { weight = 1 }\n");
    // The two files of the pattern; for the others, nothing is said as in the beginning.
    assert_eq!(cached(&folder, &[]), "2 of 4 from the cache", "budgets of the project");
    write("b/glisten.toml", "[lint.budgets]\n\"*.frag\" = { weight = 1000 }\n");
    missed("a nearer configuration", 2, &[]);
    missed("levels of the command line", 4, &["--allow", "L0031"]);
    missed("macros", 4, &["-DMORE"]);
    settled(&[]);
}

#[test]
fn only_plain_runs_use_it() {
    let folder = tree();
    assert_eq!(cached(&folder, &[]), "0 of 4 from the cache");
    for more in [&["--diff"][..], &["--configurations"]] {
        assert_eq!(cached(&folder, more), "", "{more:?}");
    }
    let fixed = folder.run(&[&["lint", "a", "--fix", "--cache", "kept"], RULES].concat());
    assert!(err(&fixed).contains("fix changed 1 file"), "{}", err(&fixed));
    assert_eq!(cached(&folder, &[]), "3 of 4 from the cache", "the fixed file is another one");
    // Findings that a baseline knows are left out of what is recalled, too.
    let known = ["--baseline", "known.json"];
    assert_eq!(cached(&folder, &[&known[..], &["--update-baseline"]].concat()), "4 of 4 from the cache");
    assert_eq!(cached(&folder, &known), "4 of 4 from the cache");
    assert_eq!(lint(&folder, &[&known[..], &["--cache", "kept"]].concat()).0, 0);
    // A file that cannot be read is no result.
    let run = folder.run(&["lint", "b/none.frag", "b/clean.frag", "--cache", "kept"]);
    assert!(code(&run) == 2 && err(&run).contains("of 2 from the cache"), "{}", err(&run));
}

#[test]
fn damaged_entries_are_made_again() {
    let folder = tree();
    cached(&folder, &[]);
    let entries = crate::cache::files(&folder.path("kept"));
    let results: Vec<&String> = entries.keys().filter(|name| name.starts_with("ac/")).collect();
    assert_eq!(results.len(), 8);
    for name in results {
        let path = folder.path("kept").join(name);
        let bytes = &entries[name];
        fs::write(&path, &bytes[..bytes.len() / 2]).expect("written");
    }
    assert_eq!(cached(&folder, &[]), "0 of 4 from the cache");
    assert_eq!(cached(&folder, &[]), "4 of 4 from the cache");
}
