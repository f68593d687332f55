//! Times all variants of a report, in rounds.
//!
//! *In:* variants on the device, and an empty frame. *Out:* their times round by round, and those of a second copy of the first variant.
//!
//! *Holds:* each round times every variant once, in an order by chance with a fixed seed, so that no variant always follows the same
//! other way. A time is the mean of as many frames as last tens of milliseconds. Rounds go on until the interval of every
//! ratio to the baseline is narrow enough, or a limit is reached.

use super::figures::spread;
use super::interval::FEWEST;
use super::model::{Ended, Spread};
use super::options::Watcher;
use super::random::Random;
use glisten_gpu::{Error, Gpu, Prepared};
use std::time::{Duration, Instant};

/// The limits of the rounds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The most rounds; at least six are done, as fewer have no interval.
    pub rounds: u32,
    /// The time after which no round begins.
    pub time: Duration,
}

impl Default for Limits {
    fn default() -> Self {
        Self { rounds: 100, time: Duration::from_secs(30) }
    }
}

/// How narrow the intervals are to be: the width, as a part of the median.
const NARROW: f64 = 0.03;
/// The rounds before intervals can be narrow enough: fewer cannot decide which variant is faster.
const DECIDING: u32 = 20;
/// The seed of the orders.
pub(super) const SEED: u64 = 1;

/// A variant on the device.
pub(super) struct Candidate {
    pub(super) prepared: Prepared,
    /// The frames of a measurement.
    pub(super) frames: u32,
}

/// The times of a run.
#[derive(Debug)]
pub(super) struct Times {
    /// Of each variant, round by round, in milliseconds per frame.
    pub(super) ways: Vec<Vec<f64>>,
    /// Of the second copy of the first variant.
    pub(super) again: Vec<f64>,
    /// Of a frame that only clears, if it is measured.
    pub(super) empty: Vec<f64>,
    /// Why there were no more rounds.
    pub(super) ended: Ended,
}

impl Times {
    /// The rounds that are complete.
    pub(super) fn rounds(&self) -> u32 {
        self.again.len() as u32
    }

    /// The ratios of times to those of the baseline in the same round.
    pub(super) fn ratio(&self, times: &[f64]) -> Spread {
        let baseline = self.ways.first().map_or(&[][..], Vec::as_slice);
        let ratios: Vec<f64> = times.iter().zip(baseline).map(|(time, base)| time / base).collect();
        spread(&ratios)
    }

    /// The width of the widest interval as a part of its median.
    fn widest(&self) -> f64 {
        let all = self.ways.iter().skip(1).chain([&self.again]);
        let widths = all.map(|times| {
            let Spread { median, interval: [low, high], .. } = self.ratio(times);
            (high - low) / median
        });
        widths.fold(0.0, |widest, width| if width <= widest { widest } else { width })
    }
}

/// The first word of the steps at which variants are timed, after all are drawn.
pub const TIMING: &str = "timing";

/// Times all variants and the empty frame; the steps of the watcher are those before it and one a round. An error names the variant by
/// its number.
pub(super) fn time(
    gpu: &Gpu,
    (candidates, empty): (&[Candidate], Option<&Candidate>),
    limits: Limits,
    (before, watcher): (usize, &mut dyn Watcher),
) -> Result<Times, (usize, Error)> {
    let mut times =
        Times { ways: vec![Vec::new(); candidates.len()], again: Vec::new(), empty: Vec::new(), ended: Ended::Rounds };
    // The second copy of the baseline, and then the empty frame, are numbered after the variants.
    let turns: Vec<&Candidate> = candidates.iter().chain(candidates.first()).chain(empty).collect();
    let mut random = Random::new(SEED);
    let start = Instant::now();
    let limits = Limits { rounds: limits.rounds.max(FEWEST), ..limits };
    loop {
        let rounds = times.rounds();
        times.ended = match &times {
            _ if watcher.is_stopped() || turns.is_empty() => Ended::Stopped,
            times if rounds >= DECIDING.min(limits.rounds) && times.widest() < NARROW => Ended::Narrow,
            _ if rounds >= limits.rounds => Ended::Rounds,
            _ if rounds >= FEWEST && start.elapsed() >= limits.time => Ended::Seconds,
            _ => {
                watcher.steps(before + expected(&times, limits, start.elapsed()) as usize);
                watcher.step(&format!("{TIMING}, round {}", rounds + 1));
                round(gpu, &turns, &mut random, &mut times, watcher)?;
                continue;
            }
        };
        return Ok(times);
    }
}

/// One round; it counts only if it is complete.
fn round(
    gpu: &Gpu,
    turns: &[&Candidate],
    random: &mut Random,
    times: &mut Times,
    watcher: &dyn Watcher,
) -> Result<(), (usize, Error)> {
    let mut measured = vec![0.0; turns.len()];
    for turn in random.permutation(turns.len()) {
        if watcher.is_stopped() {
            return Ok(());
        }
        if let (Some(candidate), Some(slot)) = (turns.get(turn), measured.get_mut(turn)) {
            *slot = gpu.measure(&candidate.prepared, candidate.frames).map_err(|error| (turn, error))?;
        }
    }
    let others = measured.split_off(times.ways.len().min(measured.len()));
    times.ways.iter_mut().zip(measured).for_each(|(times, time)| times.push(time));
    times.again.extend(others.first());
    times.empty.extend(others.get(1));
    Ok(())
}

/// The number of rounds that there will be: intervals become narrower with the root of their number.
fn expected(times: &Times, limits: Limits, elapsed: Duration) -> u32 {
    let done = times.rounds();
    if done == 0 {
        return limits.rounds.min(DECIDING);
    }
    let a_round = elapsed.as_secs_f64() / f64::from(done);
    let in_time = (limits.time.as_secs_f64() / a_round).ceil().max(f64::from(FEWEST));
    let narrow = if done < FEWEST { 0.0 } else { f64::from(done) * (times.widest() / NARROW).powi(2) };
    let wanted = narrow.max(f64::from(DECIDING)).min(in_time).min(f64::from(limits.rounds));
    (wanted.ceil() as u32).max(done + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(rounds: usize, noise: f64) -> Times {
        let mut random = Random::new(4);
        let mut series = || (0..rounds).map(|_| 1.0 + noise * random.unit()).collect::<Vec<f64>>();
        Times { ways: vec![vec![1.0; rounds], series()], again: series(), empty: Vec::new(), ended: Ended::Rounds }
    }

    #[test]
    fn the_estimate_grows_with_the_noise_up_to_the_limits() {
        let limits = Limits::default();
        let second = Duration::from_secs(1);
        assert_eq!(expected(&times(0, 0.0), limits, Duration::ZERO), DECIDING);
        assert_eq!(expected(&times(10, 0.001), limits, second), DECIDING);
        let noisy = expected(&times(20, 0.2), limits, second);
        assert!((21..=100).contains(&noisy), "{noisy}");
        assert_eq!(expected(&times(20, 3.0), limits, second), 100);
        assert_eq!(expected(&times(20, 3.0), limits, 20 * second), 30);
    }

    #[test]
    fn widths_are_parts_of_the_median() {
        assert!(times(30, 0.001).widest() < NARROW);
        assert!(times(30, 1.0).widest() > NARROW);
        assert!(times(3, 0.0).widest().is_nan(), "three rounds have no interval");
    }
}
