//! Every target with every saved input. Each input once broke its promise; its name says by what.

use glisten_fuzz::{TARGETS, seeds};
use std::path::{Path, PathBuf};

/// The stack that the program has in a thread.
const STACK: usize = 8 << 20;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Calls a target with an input; the message of the panic, if it breaks the promise.
fn broken(check: fn(&[u8]), input: Vec<u8>) -> bool {
    std::thread::Builder::new().stack_size(STACK).spawn(move || check(&input)).expect("a thread").join().is_err()
}

#[test]
fn saved_inputs_keep_their_promises() {
    let mut tried = 0;
    let mut wrong = Vec::new();
    for target in TARGETS {
        let folder = root().join("crates/fuzz/corpus").join(target.name);
        for entry in std::fs::read_dir(&folder).into_iter().flatten().flatten() {
            let path = entry.path();
            let input = std::fs::read(&path).expect("a readable input");
            tried += 1;
            if broken(target.check, input) {
                wrong.push(format!("{} {}", target.name, path.display()));
            }
        }
    }
    assert!(wrong.is_empty(), "{tried} inputs, broken: {wrong:#?}");
}

/// The inputs that fuzzing starts from break nothing, so that what it finds is new. A few of each kind, in turn.
#[test]
fn fixtures_keep_the_promises() {
    let folders = [root().join("fixtures"), root().join("shader_lib")];
    let mut wrong = Vec::new();
    for target in TARGETS {
        let all = seeds(target.begins, &folders);
        assert!(!all.is_empty(), "{} starts from nothing", target.name);
        let step = all.len().div_ceil(if std::env::var_os("FUZZ_SEEDS").is_some() { all.len() } else { 6 });
        for seed in all.into_iter().step_by(step) {
            if broken(target.check, seed.bytes) {
                wrong.push(format!("{} {}", target.name, seed.name));
            }
        }
    }
    assert!(wrong.is_empty(), "broken: {wrong:#?}");
}
