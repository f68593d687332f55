//! [`spent`]: the time that work takes, for benches of processes.
//!
//! *In:* work. *Out:* seconds on the clock and of all processors, those of ended child processes among them.

#![allow(dead_code, reason = "each bench uses a part")]

use std::fs;
use std::time::Instant;

/// Time that something takes: on the clock, and of all processors.
#[derive(Clone, Copy)]
pub(crate) struct Spent {
    /// On the clock.
    pub(crate) seconds: f64,
    /// Of all processors.
    pub(crate) cpu: f64,
}

impl Spent {
    /// A time that was not measured.
    pub(crate) const UNKNOWN: Self = Self { seconds: f64::NAN, cpu: f64::NAN };

    /// This many times as long.
    pub(crate) fn times(self, factor: f64) -> Self {
        Self { seconds: self.seconds * factor, cpu: self.cpu * factor }
    }
}

/// The time that a piece of work takes, with that of the processes that it has waited for.
pub(crate) fn spent<R>(work: impl FnOnce() -> R) -> Spent {
    let (start, before) = (Instant::now(), cpu());
    work();
    Spent { seconds: start.elapsed().as_secs_f64(), cpu: cpu() - before }
}

/// The CPU seconds of this process and of those that it has waited for, by Linux, which counts hundredths.
fn cpu() -> f64 {
    let stat = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields = stat.rsplit(')').next().unwrap_or_default().split_whitespace();
    // utime, stime, cutime, cstime are fields 14 to 17; the name, which may have blanks, is the second.
    let ticks: Vec<f64> = fields.skip(11).take(4).filter_map(|field| field.parse().ok()).collect();
    if ticks.len() == 4 { ticks.iter().sum::<f64>() / 100.0 } else { f64::NAN }
}

/// The medians of seconds and of CPU seconds.
pub(crate) fn median(times: impl Iterator<Item = Spent> + Clone) -> Spent {
    let of = |column: &dyn Fn(Spent) -> f64| {
        let mut column: Vec<f64> = times.clone().map(column).collect();
        column.sort_by(f64::total_cmp);
        column[column.len() / 2]
    };
    Spent { seconds: of(&|time| time.seconds), cpu: of(&|time| time.cpu) }
}
