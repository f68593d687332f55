//! Times two scenes in turns.
//!
//! *In:* two scenes of one picture. *Out:* their times, and the ratio with its interval. *Holds:* the rounds are those of a report
//! ([`super::clock`]), so the first scene is drawn twice a round, and the ratio of it to itself tells the noise.

use super::clock::{Candidate, Limits, time};
use super::figures::spread;
use super::interval::{DECISIVE, median_interval};
use super::model::Spread;
use super::options::Watcher;
use glisten_gpu::{Error, Gpu, Via};
use glisten_scene::Scene;
use serde::Serialize;

/// The times of two scenes that were drawn in turns.
#[derive(Clone, Debug, Serialize)]
pub struct Paired {
    /// The median time of the first, in milliseconds a frame.
    pub first_ms: f64,
    /// The median time of the second.
    pub second_ms: f64,
    /// The second's time to that of the first in the same round.
    pub ratio: Spread,
    /// The first's time to its own in the same round.
    pub same_again: Spread,
    /// The rounds.
    pub rounds: u32,
    /// Whether the second is slower: the median of the ratio is above 1, and above what the noise reaches, with a confidence of
    /// 99.99 %.
    pub slower: bool,
}

/// Draws two scenes in turns, and times them.
///
/// # Errors
/// A scene that cannot be drawn.
pub fn paired(
    gpu: &Gpu,
    scenes: [&Scene; 2],
    via: Via,
    limits: Limits,
    watcher: &mut dyn Watcher,
) -> Result<Paired, Error> {
    let [first, second] = scenes;
    let first = gpu.prepare(first, via)?;
    let second = gpu.prepare(second, via)?;
    let frames = gpu.frames_for_a_stretch(&first)?.max(gpu.frames_for_a_stretch(&second)?);
    let candidates = [first, second].map(|prepared| Candidate { prepared, frames });
    let times = time(gpu, (&candidates, None), limits, (0, watcher)).map_err(|(_, error)| error)?;
    let [first, second] = times.ways.as_slice() else { return Err(Error::Refused("nothing was timed".into())) };
    let (ratio, same_again) = (times.ratio(second), times.ratio(&times.again));
    let ratios: Vec<f64> = second.iter().zip(first).map(|(second, first)| second / first).collect();
    let noise = same_again.interval[1].max(1.0);
    let slower = median_interval(&ratios, DECISIVE).is_some_and(|[low, _]| low > noise);
    let rounds = times.rounds();
    Ok(Paired { first_ms: spread(first).median, second_ms: spread(second).median, ratio, same_again, rounds, slower })
}
