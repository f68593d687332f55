//! [`Watchdog`]: ends a command whose work does not look at the clock.
//!
//! *In:* a limit of time. *Out:* if it passes, one sentence and the exit code of a wrong input. *Holds:* what has results to show asks
//! for the time itself, and ends with them; [`Watchdog::again`] gives its next step the whole limit. So nothing goes on for more than
//! twice the limit. Files are written under their names at once, so what is ended leaves none half written.

use crate::console::Console;
use crate::exit::Exit;
use crate::process::journal::{self, Note};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Ends the program unless it is dropped in time.
pub(crate) struct Watchdog {
    limit: Duration,
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    /// The end; none if the work is done.
    deadline: Mutex<Option<Instant>>,
    changed: Condvar,
}

impl Watchdog {
    /// Watches from now on. Where the system gives no thread, nothing does.
    pub(crate) fn new(limit: Duration, console: &Console) -> Self {
        let shared = Arc::new(Shared::default());
        let watchdog = Self { limit, shared: Arc::clone(&shared) };
        watchdog.again();
        let console = console.clone();
        let watch = move || {
            if shared.passes() {
                gave_up(limit, &console);
            }
        };
        // A limit that nobody watches is no reason to fail.
        let _ = std::thread::Builder::new().spawn(watch);
        watchdog
    }

    /// Gives the next step the whole limit.
    pub(crate) fn again(&self) {
        self.shared.set(Instant::now().checked_add(self.limit));
    }
}

impl Drop for Watchdog {
    fn drop(&mut self) {
        self.shared.set(None);
    }
}

impl Shared {
    fn set(&self, deadline: Option<Instant>) {
        *self.deadline.lock().unwrap_or_else(PoisonError::into_inner) = deadline;
        self.changed.notify_all();
    }

    /// Waits. Whether the deadline passes.
    fn passes(&self) -> bool {
        let mut deadline = self.deadline.lock().unwrap_or_else(PoisonError::into_inner);
        while let Some(end) = *deadline {
            let left = end.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return true;
            }
            deadline = self.changed.wait_timeout(deadline, left).unwrap_or_else(PoisonError::into_inner).0;
        }
        false
    }
}

/// The sentence of a limit that has passed, and its help.
pub(crate) fn sentence(limit: Duration) -> (String, &'static str) {
    (format!("gave up after {} s", limit.as_secs_f64()), "`--timeout` gives more time")
}

/// Ends the program.
#[expect(clippy::exit, reason = "the work that takes too long cannot be asked to return")]
fn gave_up(limit: Duration, console: &Console) {
    let (message, help) = sentence(limit);
    console.clear_line();
    console.write_document();
    console.failure(&message, Some(help));
    // Whoever watches over this process is not to take it for a crash.
    journal::note(&Note::Done(Exit::Content as u8));
    std::process::exit(Exit::Content as i32);
}

#[cfg(test)]
mod tests {
    use super::Shared;
    use std::time::{Duration, Instant};

    #[test]
    fn a_deadline_passes_unless_it_is_moved_or_taken_back() {
        let shared = Shared::default();
        assert!(!shared.passes());
        shared.set(Some(Instant::now()));
        assert!(shared.passes());
        let later = Duration::from_millis(50);
        shared.set(Instant::now().checked_add(later));
        let start = Instant::now();
        std::thread::scope(|scope| {
            let waiting = scope.spawn(|| shared.passes());
            shared.set(Instant::now().checked_add(2 * later));
            assert!(waiting.join().expect("no panic"));
            assert!(start.elapsed() >= 2 * later);
            let waiting = scope.spawn(|| shared.passes());
            shared.set(Some(Instant::now() + Duration::from_secs(60)));
            shared.set(None);
            waiting.join().expect("no panic");
        });
    }
}
