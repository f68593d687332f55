//! Faults around a cache never reach the output: kill -9, a full disk, damaged entries, builds at the same time.

use crate::cache::files;
use crate::cli::{Folder, code, err};
use crate::support::root;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// A program of 48 variants.
const VARIANTS: &str = "[[program]]\nfiles = [\"uber.vert\", \"uber.frag\"]\nkeywords = [\"multi_compile PHONG GGX\", \
    \"multi_compile _ FOG_LINEAR FOG_EXP\", \"shader_feature NORMAL_MAP\", \"shader_feature SKINNED\"]\n\
    values = { LIGHTS = [1, 2] }\n";

fn project() -> Folder {
    let text = |name: &str| fs::read(root().join("fixtures/permutations").join(name)).expect("the fixture");
    Folder::new(&[
        ("uber.vert", &text("uber.vert")),
        ("uber.frag", &text("uber.frag")),
        ("lights.glsl", &text("lights.glsl")),
        ("p.toml", VARIANTS.as_bytes()),
    ])
}

const WORDS: [&str; 8] = ["compile", "--permutations", "p.toml", "-o", "out", "-j2", "--target", "spirv"];

/// The outputs of a build without a cache.
fn truth(folder: &Folder) -> BTreeMap<String, Vec<u8>> {
    let run = folder.run(&[&WORDS[..], &["--no-cache"]].concat());
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert!(err(&run).contains("48 variants, 48 distinct"), "{}", err(&run));
    let truth = files(&folder.path("out"));
    fs::remove_dir_all(folder.path("out")).expect("removed");
    truth
}

fn entries(folder: &Path) -> Vec<PathBuf> {
    let below = ["ac", "cas"].into_iter().flat_map(|kind| fs::read_dir(folder.join(kind)).into_iter().flatten());
    let below = below.filter_map(Result::ok).flat_map(|one| fs::read_dir(one.path()).into_iter().flatten());
    let mut paths: Vec<PathBuf> = below.filter_map(Result::ok).map(|entry| entry.path()).collect();
    paths.sort();
    paths
}

#[test]
fn a_killed_build_leaves_no_half_file() {
    let folder = project();
    let truth = truth(&folder);
    let words = [&WORDS[..], &["--cache", "kept"]].concat();
    for delay in [20, 120, 250, 400, 700, 1200] {
        let mut child = folder.command(&words).stderr(Stdio::null()).spawn().expect("it starts");
        std::thread::sleep(Duration::from_millis(delay));
        // SIGKILL: nothing of the program runs any more.
        child.kill().expect("killed, or done");
        child.wait().expect("it has ended");
        for (name, bytes) in files(&folder.path("out")) {
            let is_temporary = name.rsplit('/').next().is_some_and(|name| name.starts_with(".glisten-"));
            assert!(is_temporary || truth.get(&name) == Some(&bytes), "after {delay} ms `{name}` is not whole");
        }
    }
    let run = folder.run(&words);
    assert_eq!(code(&run), 0, "{}", err(&run));
    let left = files(&folder.path("out"));
    assert!(left.keys().all(|name| !name.contains(".glisten-")), "the next build removes what a killed one left");
    assert_eq!(fs::read_dir(folder.path("kept/tmp")).expect("a folder").count(), 0);
    assert!(left == truth, "after the kills the outputs differ");
    let run = folder.run(&words);
    assert!(err(&run).contains("48 of 48 from the cache"), "{}", err(&run));
}

#[test]
fn damaged_entries_are_made_again() {
    let folder = project();
    let truth = truth(&folder);
    let words = [&WORDS[..], &["--cache", "kept"]].concat();
    assert_eq!(code(&folder.run(&words)), 0);
    for (number, path) in entries(&folder.path("kept")).iter().enumerate() {
        let mut bytes = fs::read(path).expect("an entry");
        let middle = bytes.len() / 2;
        match number % 5 {
            0 => bytes.truncate(middle),
            1 => bytes.clear(),
            2 => bytes[middle] ^= 1,
            3 => bytes.extend(b"more"),
            _ => continue,
        }
        fs::write(path, bytes).expect("damaged");
    }
    fs::remove_dir_all(folder.path("out")).expect("removed");
    let run = folder.run(&words);
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert!(!err(&run).contains("48 of 48"), "{}", err(&run));
    assert!(files(&folder.path("out")) == truth, "the outputs differ");
    let run = folder.run(&words);
    assert!(err(&run).contains("48 of 48 from the cache"), "what was damaged is whole again: {}", err(&run));
}

#[test]
fn builds_at_the_same_time_share_a_cache_and_a_folder() {
    let folder = project();
    let truth = truth(&folder);
    let words = [&WORDS[..], &["--cache", "kept"]].concat();
    let start = |_| folder.command(&words).stderr(Stdio::piped()).spawn().expect("it starts");
    let running: Vec<_> = (0..3).map(start).collect();
    for child in running {
        let run = child.wait_with_output().expect("it ends");
        assert_eq!(code(&run), 0, "{}", err(&run));
    }
    assert!(files(&folder.path("out")) == truth, "the outputs differ");
    // One empties the cache while others use it.
    let running: Vec<_> = (0..2).map(start).collect();
    for _ in 0..20 {
        assert_eq!(code(&folder.run(&["cache", "clean", "--cache", "kept"])), 0);
    }
    for child in running {
        let run = child.wait_with_output().expect("it ends");
        assert_eq!(code(&run), 0, "{}", err(&run));
    }
    assert!(files(&folder.path("out")) == truth, "the outputs differ");
}

#[test]
fn a_cache_keeps_below_its_limit() {
    let folder = project();
    let words = [&WORDS[..], &["--cache", "kept", "--cache-limit", "100K"]].concat();
    assert_eq!(code(&folder.run(&words)), 0);
    let bytes: u64 =
        entries(&folder.path("kept")).iter().filter_map(|path| fs::metadata(path).ok()).map(|it| it.len()).sum();
    assert!(bytes > 20_000 && bytes <= 100 << 10, "{bytes}");
    assert_eq!(code(&folder.run(&words)), 0);
}

#[test]
fn a_cache_that_cannot_be_written_to_is_a_warning() {
    let folder = project();
    let truth = truth(&folder);
    fs::write(folder.path("file"), "no folder").expect("written");
    let run = folder.run(&[&WORDS[..], &["--cache", "file/kept"]].concat());
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert_eq!(err(&run).matches("warning: cannot write to the cache").count(), 1, "{}", err(&run));
    assert!(files(&folder.path("out")) == truth, "the outputs differ");
}

/// Runs a line of shell in a folder.
fn shell(folder: &Folder, line: &str) -> std::process::Output {
    let mut command = Command::new("sh");
    command.arg("-c").arg(line).current_dir(folder.path("")).env("GLISTEN", env!("CARGO_BIN_EXE_glisten"));
    command.output().expect("a shell runs")
}

#[cfg(unix)]
#[test]
fn files_that_cannot_grow_are_not_left_half() {
    let folder = project();
    // No file may become larger than 512 bytes, which stops the cache and the outputs alike.
    let limited = "ulimit -f 1; trap '' XFSZ; exec \"$GLISTEN\"";
    let run = shell(&folder, &format!("{limited} {} --cache kept --check", WORDS.join(" ")));
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert_eq!(err(&run).matches("warning: cannot write to the cache").count(), 1, "{}", err(&run));
    let run = shell(&folder, &format!("{limited} {} --cache kept", WORDS.join(" ")));
    assert_eq!(code(&run), 2, "{}", err(&run));
    assert!(err(&run).contains("cannot write `out/"), "{}", err(&run));
    assert!(!files(&folder.path("out")).contains_key("index.json"));
    let truth = truth(&folder);
    let run = folder.run(&[&WORDS[..], &["--cache", "kept"]].concat());
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert!(files(&folder.path("out")) == truth, "the outputs differ");
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_a_warning() {
    let folder = project();
    let truth = truth(&folder);
    fs::create_dir(folder.path("small")).expect("made");
    // A disk of 64 KiB, in a name space of its own, which goes with the process.
    let line = format!(
        "exec unshare --mount --map-root-user sh -c 'mount -t tmpfs -o size=64k none small || exit 99; \
         \"$GLISTEN\" {} --cache small/kept; code=$?; df small >&2; exit $code'",
        WORDS.join(" ")
    );
    let run = shell(&folder, &line);
    if code(&run) == 99 || err(&run).contains("unshare") {
        let message = format!("no disk can be mounted here, so a full one is not tested: {}", err(&run));
        writeln!(std::io::stderr(), "\n{message}").expect("standard error can be written to");
        return;
    }
    assert_eq!(code(&run), 0, "{}", err(&run));
    assert!(err(&run).contains("warning: cannot write to the cache") && err(&run).contains("100%"), "{}", err(&run));
    assert!(files(&folder.path("out")) == truth, "the outputs differ");
}
