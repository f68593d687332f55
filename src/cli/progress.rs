//! [`Progress`]: a progress bar on the terminal for work that takes longer than a second.
//!
//! *Holds:* it is drawn on standard error, only if that is a terminal, only without `--quiet`, and never in the first
//! second. It disappears when the work is done.

use super::console::Console;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How long nothing is shown.
const PATIENCE: Duration = Duration::from_secs(1);

/// Counts steps of a piece of work.
pub(super) struct Progress {
    bar: ProgressBar,
    start: Instant,
    watched: bool,
    shown: AtomicBool,
}

impl Progress {
    /// A bar for work of `steps` steps.
    pub(super) fn new(console: &Console, steps: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{wide_msg} [{bar:30}] {pos}/{len} {elapsed}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
        Self { bar, start: Instant::now(), watched: console.is_watched(), shown: AtomicBool::new(false) }
    }

    /// This bar with an estimate of the time that is left.
    pub(super) fn with_estimate(self) -> Self {
        let style = ProgressStyle::with_template("{wide_msg} [{bar:30}] {pos}/{len} {elapsed}, about {eta} left");
        self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
        self
    }

    /// Sets the number of steps.
    pub(super) fn extend_to(&self, steps: usize) {
        self.bar.set_length(steps as u64);
    }

    /// Sets how many steps of how many are done.
    pub(super) fn reach(&self, done: usize, steps: usize) {
        self.bar.set_length(steps as u64);
        self.bar.set_position(done as u64);
        self.show_if_late();
    }

    /// Shows the current step.
    pub(super) fn say(&self, what: &str) {
        self.bar.set_message(what.to_owned());
        self.show_if_late();
    }

    /// Completes a step.
    pub(super) fn step(&self) {
        self.bar.inc(1);
        self.show_if_late();
    }

    fn show_if_late(&self) {
        if self.watched && self.start.elapsed() > PATIENCE && !self.shown.swap(true, Ordering::Relaxed) {
            self.bar.set_draw_target(ProgressDrawTarget::stderr());
            self.bar.enable_steady_tick(Duration::from_millis(200));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}
