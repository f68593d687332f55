//! The invariants of `docs/architecture.md` that can be tested: which crate depends on which, in which order the folders of a
//! crate may use each other, who prints, what a file looks like.
//!
//! That a crate cannot name another one without depending on it is the compiler's work; here the manifests are compared with
//! the documented walls, and paths inside of a crate are resolved, `super` included.

use super::support::{files_with, root};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Lines that a file may have.
const MAX_LINES: usize = 700;

/// Every crate, the crates of glisten that it may depend on, and outside crates that it must not depend on.
static CRATES: &[(&str, &[&str], &[&str])] = &[
    ("crates/features", &[], &["wgpu"]),
    ("crates/front", &[], &["naga", "wgpu", "clap", "png", "toml", "rayon", "tempfile"]),
    ("crates/emit", &["glisten-front"], &["wgpu", "clap", "png", "toml", "rayon"]),
    ("crates/scene", &["glisten-front"], &["naga", "wgpu", "clap"]),
    ("crates/reference", &["glisten-front", "glisten-scene"], &["naga", "wgpu", "clap"]),
    ("crates/specialize", &["glisten-front"], &["naga", "wgpu", "clap", "png", "toml", "rayon", "tempfile"]),
    ("crates/plan", &["glisten-front", "glisten-emit", "glisten-scene"], &["wgpu", "clap", "png", "toml", "rayon"]),
    ("crates/gpu", &["glisten-front", "glisten-emit", "glisten-scene", "glisten-plan"], &["clap"]),
    ("crates/gl", &["glisten-front", "glisten-scene"], &["naga", "wgpu", "clap"]),
    (
        "crates/build",
        &[
            "glisten-emit",
            "glisten-front",
            "glisten-library",
            "glisten-scene",
            "glisten-sources",
            "glisten-specialize",
            "glisten-verify",
        ],
        &["wgpu", "clap", "png", "rayon", "tempfile"],
    ),
    (
        "crates/cli",
        &[
            "glisten-build",
            "glisten-cost",
            "glisten-emit",
            "glisten-format",
            "glisten-front",
            "glisten-gl",
            "glisten-gpu",
            "glisten-library",
            "glisten-lsp",
            "glisten-page",
            "glisten-play",
            "glisten-port",
            "glisten-reference",
            "glisten-report",
            "glisten-scene",
            "glisten-snapshot",
            "glisten-sources",
            "glisten-specialize",
            "glisten-stability",
            "glisten-upgrade",
            "glisten-verify",
        ],
        &[],
    ),
    ("crates/cost", &["glisten-front", "glisten-library"], &["naga", "wgpu", "clap", "png", "toml", "rayon"]),
    ("crates/format", &["glisten-front"], &["naga", "wgpu", "clap", "png", "toml", "rayon"]),
    (
        "crates/lsp",
        &["glisten-format", "glisten-front", "glisten-library", "glisten-scene"],
        &["naga", "wgpu", "clap", "tempfile"],
    ),
    ("crates/page", &["glisten-front", "glisten-library", "glisten-scene"], &["naga", "wgpu", "clap", "toml"]),
    (
        "crates/play",
        &[
            "glisten-emit",
            "glisten-front",
            "glisten-plan",
            "glisten-reference",
            "glisten-scene",
            "glisten-specialize",
            "glisten-stability",
            "glisten-verify",
        ],
        &["wgpu", "clap", "rayon", "tempfile"],
    ),
    (
        "crates/port",
        &["glisten-emit", "glisten-front", "glisten-page", "glisten-sources", "glisten-upgrade"],
        &["wgpu", "clap", "tempfile"],
    ),
    (
        "crates/report",
        &[
            "glisten-cost",
            "glisten-emit",
            "glisten-front",
            "glisten-gpu",
            "glisten-library",
            "glisten-page",
            "glisten-reference",
            "glisten-scene",
            "glisten-specialize",
            "glisten-verify",
        ],
        &["clap", "tempfile"],
    ),
    (
        "crates/snapshot",
        &["glisten-emit", "glisten-front", "glisten-page", "glisten-reference", "glisten-scene", "glisten-verify"],
        &["wgpu", "clap"],
    ),
    ("crates/sources", &["glisten-front", "glisten-library"], &["naga", "wgpu", "clap", "png", "rayon", "tempfile"]),
    (
        "crates/stability",
        &["glisten-front", "glisten-library", "glisten-page", "glisten-reference", "glisten-scene", "glisten-verify"],
        &["naga", "wgpu", "clap"],
    ),
    ("crates/upgrade", &["glisten-front", "glisten-sources"], &["naga", "wgpu", "clap", "png", "toml", "rayon"]),
    (
        "crates/variants",
        &["glisten-emit", "glisten-front", "glisten-specialize"],
        &["wgpu", "clap", "png", "toml", "rayon"],
    ),
    (
        "crates/verify",
        &[
            "glisten-front",
            "glisten-gl",
            "glisten-gpu",
            "glisten-library",
            "glisten-reference",
            "glisten-scene",
            "glisten-sources",
            "glisten-specialize",
            "glisten-variants",
        ],
        &["naga", "wgpu", "clap"],
    ),
    (
        "shader_lib",
        &["glisten-emit", "glisten-front", "glisten-scene", "glisten-specialize"],
        &["naga", "wgpu", "clap", "png", "toml", "rayon"],
    ),
    (
        "crates/fuzz",
        &[
            "glisten",
            "glisten-emit",
            "glisten-format",
            "glisten-front",
            "glisten-plan",
            "glisten-reference",
            "glisten-scene",
            "glisten-specialize",
            "glisten-verify",
        ],
        &["wgpu"],
    ),
    (
        "crates/studies",
        &[
            "glisten",
            "glisten-cli",
            "glisten-features",
            "glisten-front",
            "glisten-fuzz",
            "glisten-gpu",
            "glisten-library",
            "glisten-reference",
            "glisten-report",
            "glisten-scene",
            "glisten-specialize",
            "glisten-stability",
            "glisten-verify",
        ],
        &["clap"],
    ),
];

/// The crate of programs that print, and that nothing depends on.
const STUDIES: &str = "crates/studies";

/// The top-level modules of a crate in the order of the data: each may use those before it.
static ORDER: &[(&str, &[&str])] = &[
    (
        "crates/front/src",
        &[
            "stack",
            "source",
            "language",
            "diagnostic",
            "syntax",
            "builtin",
            "hir",
            "fold",
            "analysis",
            "link",
            "lint",
            "index",
            "compiler",
        ],
    ),
    ("crates/emit/src", &["target", "select", "lower", "width", "emit"]),
    (
        "crates/scene/src",
        &[
            "random",
            "toml_string",
            "dependence",
            "picture",
            "profile",
            "compare",
            "fixed",
            "dynamic",
            "model",
            "files",
            "library",
            "values",
            "reads",
            "roles",
            "tables",
            "geometry",
            "load",
            "portrait",
        ],
    ),
    ("crates/sources/src", &["engines", "embedded", "stages", "disk", "includes", "programs", "settings", "host"]),
    (
        "crates/verify/src",
        &[
            "numeric",
            "scene",
            "verify",
            "evaluate",
            "measure",
            "environment",
            "shader_test",
            "unit_test",
            "specialize",
            "trace",
        ],
    ),
];

/// Only the command line does this.
static PRINTING: &[&str] = &["println!", "print!(", "eprintln!", "eprint!(", "process::exit", "dbg!("];
/// Only the command line and the sources of files do this.
static OUTSIDE: &[&str] = &["std::env", "std::fs", "std::thread"];
/// Files that may do so, each with its reason.
static MAY_TOUCH_OUTSIDE: &[(&str, &str)] = &[
    ("crates/cli/src/", "the program"),
    ("crates/fuzz/src/", "starts libFuzzer, from the fixtures"),
    ("src/main.rs", "the program"),
    ("crates/scene/src/files.rs", "`DiskFiles`, which a host chooses"),
    ("crates/gpu/src/", "waits for the device"),
    ("crates/snapshot/src/", "reads and writes the pictures of tests"),
    ("crates/sources/src/", "reads shaders, for the program and for build scripts"),
    ("crates/build/src/", "reads shaders and writes a module, for a build script"),
    ("crates/verify/src/verify/files.rs", "leaves the pictures of a failure in a folder that the host names"),
];

pub(super) fn rust_files(folder: &str) -> Vec<PathBuf> {
    files_with(&root().join(folder), "rs")
}

/// The folders of the sources of all crates but the studies.
pub(super) fn source_folders() -> impl Iterator<Item = String> {
    let crates = CRATES.iter().map(|(folder, _, _)| *folder).filter(|folder| *folder != STUDIES);
    ["src".to_owned()].into_iter().chain(crates.map(|folder| format!("{folder}/src")))
}

/// The sources of all crates.
fn sources() -> Vec<PathBuf> {
    let files: Vec<PathBuf> = source_folders().flat_map(|folder| rust_files(&folder)).collect();
    assert!(files.len() > 300, "the sources are not where they are looked for: {}", files.len());
    files
}

pub(super) fn name_of(path: &Path) -> String {
    path.strip_prefix(root()).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

pub(super) fn text_of(path: &Path) -> String {
    fs::read_to_string(path).expect("readable")
}

/// Lines that are code: no comment lines, and nothing from the unit tests on.
pub(super) fn code_lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    text.lines()
        .enumerate()
        .take_while(|(_, line)| line.trim() != "#[cfg(test)]")
        .filter(|(_, line)| !line.trim_start().starts_with("//"))
        .map(|(index, line)| (index + 1, line))
}

#[test]
fn crates_depend_on_what_the_walls_allow() {
    let folders: BTreeSet<String> = fs::read_dir(root().join("crates"))
        .expect("the folder is there")
        .map(|entry| format!("crates/{}", entry.expect("an entry").file_name().to_string_lossy()))
        .chain(["shader_lib".to_owned()])
        .collect();
    assert_eq!(folders, CRATES.iter().map(|(folder, _, _)| (*folder).to_owned()).collect());
    for (folder, allowed, forbidden) in CRATES {
        let manifest: toml::Table = text_of(&root().join(folder).join("Cargo.toml")).parse().expect("a manifest");
        let dependencies = manifest["dependencies"].as_table().expect("a table");
        for name in dependencies.keys() {
            let ours = name.starts_with("glisten");
            assert!(!ours || allowed.contains(&name.as_str()), "{folder} depends on {name}");
            assert!(!forbidden.contains(&name.as_str()), "{folder} depends on {name}");
        }
        let readme = text_of(&root().join(folder).join("README.md"));
        assert!(readme.lines().count() >= 8, "{folder}/README.md says too little");
    }
}

/// Whether the documentation of a file has an example that runs.
fn has_examples(text: &str) -> bool {
    let docs = text.lines().filter_map(|line| line.trim_start().strip_prefix("//")?.strip_prefix(['/', '!']));
    let mut fences = docs.filter_map(|line| line.trim_start().strip_prefix("```"));
    let mut any = false;
    while let Some(kind) = fences.next() {
        any |= !["text", "ignore", "toml", "sh", "glsl", "wgsl", "json"].contains(&kind);
        // The end of the block.
        fences.next();
    }
    any
}

#[test]
fn crates_whose_examples_are_not_run_have_none() {
    let mut count = 0;
    for (folder, _, _) in CRATES {
        let manifest: toml::Table = text_of(&root().join(folder).join("Cargo.toml")).parse().expect("a manifest");
        if manifest.get("lib").and_then(|lib| lib.get("doctest")?.as_bool()) != Some(false) {
            continue;
        }
        count += 1;
        for path in rust_files(&format!("{folder}/src")) {
            assert!(!has_examples(&text_of(&path)), "{} has an example; `doctest = false` must go", name_of(&path));
        }
    }
    assert!(count > 10, "only {count} crates were looked at");
    assert!(has_examples("/// ```\n/// f();\n/// ```\n") && !has_examples("//! ```text\n//! a\n//! ```\n"));
}

/// Whether a file under a `src` holds unit tests alone.
fn is_of_tests(name: &str) -> bool {
    name.contains("/tests/") || name.ends_with("/tests.rs")
}

/// The module path of a file below its `src`: `lower/outputs.rs` is `["lower", "outputs"]`.
fn module_path(within: &str) -> Vec<String> {
    let path = within.trim_end_matches(".rs");
    let mut parts: Vec<String> = path.split('/').map(str::to_owned).collect();
    if parts.last().is_some_and(|last| last == "mod" || last == "lib") {
        parts.pop();
    }
    parts
}

/// The top-level modules that the paths of a line name, seen from the module `here`.
fn named_modules(line: &str, here: &[String]) -> Vec<String> {
    let mut found = Vec::new();
    let mut add_list = |rest: &str| match rest.strip_prefix('{') {
        Some(list) => {
            // The first word of each item at the outermost level of the braces.
            let (mut depth, mut item) = (0, String::new());
            for letter in list.chars().chain(",".chars()) {
                match letter {
                    '{' => depth += 1,
                    '}' => depth -= 1,
                    ',' if depth <= 0 => found.push(word(std::mem::take(&mut item).trim())),
                    _ if depth <= 0 => item.push(letter),
                    _ => {}
                }
                if depth < 0 {
                    found.push(word(item.trim()));
                    break;
                }
            }
        }
        None => found.push(word(rest)),
    };
    for (at, _) in line.match_indices("crate::") {
        let own = !line[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_');
        if own {
            add_list(&line[at + "crate::".len()..]);
        }
    }
    for (at, _) in line.match_indices("super::") {
        if line[..at].ends_with("super::") {
            continue;
        }
        let mut rest = &line[at..];
        let mut ups = 0;
        while let Some(after) = rest.strip_prefix("super::") {
            (rest, ups) = (after, ups + 1);
        }
        if ups == here.len() {
            add_list(rest);
        }
    }
    found
}

fn word(text: &str) -> String {
    text.chars().take_while(|letter| letter.is_alphanumeric() || *letter == '_').collect()
}

#[test]
fn folders_use_only_those_before_them() {
    let (mut wrong, mut arrows) = (Vec::new(), BTreeMap::<String, usize>::new());
    for (folder, order) in ORDER {
        for path in rust_files(folder) {
            let name = name_of(&path);
            if is_of_tests(&name) {
                continue;
            }
            let here = module_path(name.trim_start_matches(folder).trim_start_matches('/'));
            let Some(place) = here.first().and_then(|first| order.iter().position(|module| module == first)) else {
                assert!(here.is_empty(), "{name}: its folder stands nowhere in the order of {folder}");
                continue;
            };
            for (number, line) in code_lines(&text_of(&path)) {
                for module in named_modules(line, &here) {
                    let Some(other) = order.iter().position(|known| *known == module) else { continue };
                    if other > place {
                        wrong.push(format!("{name}:{number} uses {module}"));
                    } else if other < place {
                        *arrows.entry(format!("{folder}: {} to {module}", order[place])).or_default() += 1;
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(arrows.len() > 40, "only {} arrows were seen: {arrows:?}", arrows.len());
}

#[test]
fn paths_are_resolved() {
    let here = module_path("lower/outputs/points.rs");
    assert_eq!(here, ["lower", "outputs", "points"]);
    assert_eq!(named_modules("use crate::{emit::{self, A}, target};", &here), ["emit", "target"]);
    assert_eq!(named_modules("use super::super::super::emit::B;", &here), ["emit"]);
    assert!(named_modules("use super::super::emit::B; use glisten_front::hir;", &here).is_empty());
}

#[test]
fn every_file_has_a_module_doc() {
    let mut files = sources();
    for folder in ["tests", "examples", "benches", "integrations", STUDIES] {
        files.extend(rust_files(folder));
    }
    // An example keeps a module that the program wrote.
    let is_written = |text: &str| text.starts_with("// Written by glisten ");
    let lacks = |text: String| !text.starts_with("//! ") && !is_written(&text);
    let without: Vec<String> = files.iter().filter(|path| lacks(text_of(path))).map(|path| name_of(path)).collect();
    assert!(without.is_empty(), "files that do not start with a module doc: {without:#?}");
}

#[test]
fn only_the_command_line_prints_and_touches_the_outside() {
    let mut wrong = Vec::new();
    for path in sources() {
        let name = name_of(&path);
        let may = is_of_tests(&name) || MAY_TOUCH_OUTSIDE.iter().any(|(prefix, _)| name.starts_with(prefix));
        // Cargo reads what a build script prints.
        let prints = ["crates/cli/src/", "src/main.rs", "crates/build/src/lib.rs", "crates/fuzz/src/main.rs"]
            .iter()
            .any(|prefix| name.starts_with(prefix));
        for (number, line) in code_lines(&text_of(&path)) {
            let printing = PRINTING.iter().filter(|_| !prints);
            let outside = OUTSIDE.iter().filter(|_| !may);
            let found = printing.chain(outside).filter(|needle| line.contains(*needle));
            wrong.extend(found.map(|needle| format!("{name}:{number} {needle}")));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn files_keep_to_a_size_that_can_be_read() {
    let long: Vec<String> = sources()
        .iter()
        .map(|path| (name_of(path), text_of(path).lines().count()))
        .filter(|(_, lines)| *lines > MAX_LINES)
        .map(|(name, lines)| format!("{name}: {lines} lines"))
        .collect();
    assert!(long.is_empty(), "{long:#?}");
}

/// The names in the tree of what a package depends on.
fn tree(arguments: &[&str]) -> Vec<String> {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .arg("tree")
        .args(arguments)
        .args(["--edges", "normal", "--prefix", "none", "--offline"])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    text.lines().filter_map(|line| line.split(' ').next()).map(str::to_owned).collect()
}

#[test]
fn the_compiler_core_depends_on_no_gpu_and_no_command_line() {
    let core = tree(&["--package", "glisten", "--no-default-features"]);
    for absent in ["wgpu", "clap", "png", "indicatif", "rayon", "tempfile"] {
        assert!(!core.iter().any(|name| name == absent), "the core depends on {absent}");
    }
    assert!(core.iter().any(|name| name == "naga"), "{core:?}");
    let front = tree(&["--package", "glisten-front"]);
    assert!(!front.iter().any(|name| name == "naga"), "a linter needs no naga");
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
