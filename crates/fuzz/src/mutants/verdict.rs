//! [`Verdict`]: what glisten says of a text.
//!
//! *In:* a text and its stage. *Out:* its first error, and how long it took. *Holds:* a text that takes longer than the limit has a
//! verdict, too; the thread that works on it is left behind.

use glisten_front::{Compiler, Options, Source, Stage};
use std::sync::mpsc;
use std::time::{Duration, Instant};

/// The stack of the thread: as that of the program.
const STACK_BYTES: usize = 16 << 20;

/// The answer of a compiler to a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// There is no error.
    Accepted,
    /// There is an error.
    Refused {
        /// The line of the first error in the order of the text, 0 if it has none.
        line: usize,
        /// Its code and message, with names left out.
        says: String,
    },
    /// It took longer than the limit.
    Endless,
    /// It ended with a panic.
    Panicked,
}

/// Glisten's verdict, and the time that it took.
pub fn verdict(text: &str, stage: Stage, limit: Duration) -> (Verdict, Duration) {
    let (sender, receiver) = mpsc::channel();
    let source = Source { name: "mutant".into(), text: text.into(), stage };
    let start = Instant::now();
    let work = move || {
        // After the limit, nobody listens.
        let _ = sender.send(judged(source));
    };
    if std::thread::Builder::new().stack_size(STACK_BYTES).spawn(work).is_err() {
        return (Verdict::Panicked, start.elapsed());
    }
    let verdict = match receiver.recv_timeout(limit) {
        Ok(verdict) => verdict,
        Err(mpsc::RecvTimeoutError::Timeout) => Verdict::Endless,
        Err(mpsc::RecvTimeoutError::Disconnected) => Verdict::Panicked,
    };
    (verdict, start.elapsed())
}

fn judged(source: Source) -> Verdict {
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let line = |one: &glisten_front::Diagnostic| {
        compilation.sources.line(compilation.sources.call_site(one.primary.span)).unwrap_or(0) as usize
    };
    let errors = compilation.diagnostics.iter().filter(|one| one.is_error());
    match errors.min_by_key(|one| line(one)) {
        Some(first) => {
            Verdict::Refused { line: line(first), says: format!("{} {}", first.code.id, without_names(&first.message)) }
        }
        None => Verdict::Accepted,
    }
}

/// A message without its quoted parts.
fn without_names(message: &str) -> String {
    let parts = message.split('`').enumerate();
    parts.map(|(number, part)| if number % 2 == 0 { part } else { "`_`" }).collect()
}
