//! Generated programs: they are accepted, and what draws the same picture does. Each saved one was once wrong; its name says how.

use glisten_fuzz::checks::{Chosen, Texts, fault, fault_of_texts};
use glisten_fuzz::generate::Program;
use std::path::Path;

/// The stack that the generator has in a thread.
const STACK: usize = 64 << 20;

fn on_stack<T: Send + 'static>(run: impl FnOnce() -> T + Send + 'static) -> T {
    let thread = std::thread::Builder::new().stack_size(STACK).spawn(run).expect("a thread");
    thread.join().expect("it does not panic")
}

#[test]
fn saved_programs_hold() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus/generated");
    let mut wrong = Vec::new();
    let mut tried = 0;
    for entry in std::fs::read_dir(&folder).expect("saved programs").flatten() {
        let text = std::fs::read_to_string(entry.path()).expect("a readable program");
        tried += 1;
        let found = on_stack(move || fault_of_texts(Texts::of(&text)));
        wrong.extend(found.map(|fault| format!("{}: {}: {}", entry.path().display(), fault.check, fault.message)));
    }
    assert!(tried > 4 && wrong.is_empty(), "{tried} programs, wrong: {}", wrong.join("\n"));
}

/// `GENERATED=first..end` runs other seeds.
#[test]
fn generated_programs_hold() {
    let asked = std::env::var("GENERATED").ok();
    let bounds = asked.as_deref().and_then(|asked| asked.split_once(".."));
    let bounds = bounds.and_then(|(first, end)| Some(first.parse().ok()?..end.parse().ok()?));
    let mut wrong = Vec::new();
    for seed in bounds.unwrap_or(0..48) {
        let found = on_stack(move || fault(&Program::new(seed), Chosen::default()));
        wrong.extend(found.map(|fault| format!("seed {seed}: {}: {}", fault.check, fault.message)));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The texts of the faults that `--faults` plants are where the table says.
#[test]
fn faults_have_their_places() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let count = glisten_fuzz::faults::check(&root).expect("every text is once in its file");
    assert!(count >= 50, "{count} faults");
}
