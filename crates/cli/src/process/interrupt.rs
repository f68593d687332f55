//! [`Interrupt`]: Ctrl-C ends a command that can show what it has done.
//!
//! *Holds:* the first Ctrl-C only sets a flag; a second one ends the program at once.

use signal_hook::consts::SIGINT;
use signal_hook::flag;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// The exit code of a program that Ctrl-C ended, in a shell.
const INTERRUPTED: i32 = 130;

/// Whether the user pressed Ctrl-C.
#[derive(Clone, Debug, Default)]
pub(crate) struct Interrupt {
    pressed: Arc<AtomicBool>,
}

impl Interrupt {
    /// Watches for Ctrl-C from now on. Where the system does not allow that, Ctrl-C ends the program as ever.
    pub(crate) fn watch() -> Self {
        let pressed = Arc::new(AtomicBool::new(false));
        // The order counts: the first press passes here while the flag is not yet set.
        let _ = flag::register_conditional_shutdown(SIGINT, INTERRUPTED, Arc::clone(&pressed))
            .and_then(|_| flag::register(SIGINT, Arc::clone(&pressed)));
        Self { pressed }
    }

    /// Whether it was pressed.
    pub(crate) fn is_pressed(&self) -> bool {
        self.pressed.load(Ordering::Relaxed)
    }
}
