//! [`Progress`]: a progress bar on the terminal for work that takes longer than two seconds.
//!
//! *Holds:* it is drawn on standard error, only if that is a terminal, only without `--quiet`, and never in the first two
//! seconds; after that also in the middle of a long step. It disappears when the work is done.

use crate::console::Console;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::Duration;

/// How long nothing is shown.
const PATIENCE: Duration = Duration::from_secs(2);

/// Counts steps of a piece of work.
pub(crate) struct Progress {
    bar: ProgressBar,
    /// Held while the work goes on.
    working: Option<Sender<()>>,
}

impl Progress {
    /// A bar for work of `steps` steps.
    pub(crate) fn new(console: &Console, steps: usize) -> Self {
        let bar = ProgressBar::with_draw_target(Some(steps as u64), ProgressDrawTarget::hidden());
        let style = ProgressStyle::with_template("{wide_msg} [{bar:30}] {pos}/{len} {elapsed}");
        bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
        let working = console.is_watched().then(|| show_late(&bar));
        Self { bar, working }
    }

    /// This bar, but never shown if the result is for a program.
    pub(crate) fn unless(mut self, is_for_program: bool) -> Self {
        if is_for_program {
            self.working = None;
        }
        self
    }

    /// This bar with an estimate of the time that is left.
    pub(crate) fn with_estimate(self) -> Self {
        let style = ProgressStyle::with_template("{wide_msg} [{bar:30}] {pos}/{len} {elapsed}, about {eta} left");
        self.bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> "));
        self
    }

    /// Sets the number of steps.
    pub(crate) fn extend_to(&self, steps: usize) {
        self.bar.set_length(steps as u64);
    }

    /// Adds steps.
    pub(crate) fn extend_by(&self, steps: usize) {
        self.bar.inc_length(steps as u64);
    }

    /// Sets how many steps of how many are done.
    pub(crate) fn reach(&self, done: usize, steps: usize) {
        self.bar.set_length(steps as u64);
        self.bar.set_position(done as u64);
    }

    /// Shows the current step.
    pub(crate) fn say(&self, what: &str) {
        self.bar.set_message(what.to_owned());
    }

    /// Completes a step.
    pub(crate) fn step(&self) {
        self.bar.inc(1);
    }
}

/// Shows the bar if the work is not done in time.
fn show_late(bar: &ProgressBar) -> Sender<()> {
    let (working, done) = channel();
    let bar = bar.clone();
    thread::spawn(move || {
        if done.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
            bar.set_draw_target(ProgressDrawTarget::stderr());
            bar.enable_steady_tick(Duration::from_millis(200));
        }
    });
    working
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.working = None;
        self.bar.finish_and_clear();
    }
}
