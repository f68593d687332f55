//! The fronts: the variants that no other variant of their model beats, in error and work, and in error and time.
//!
//! *In:* variants with their figures, and the times of all rounds. *Out:* their marks.
//!
//! *Holds:* a variant beats another if it is better in one and not worse in the other; equal variants do not beat each other. The
//! error is the RMSE. A variant whose picture is not finite where that of another variant of the model is, or that covers too little
//! of what the reference covers, is *unfit*: it is on no front and beats nothing, since its RMSE leaves out what is wrong.
//!
//! Work is exact. Time is measured, so a variant is *clearly* faster than another only by this: the interval of the median of their
//! ratios, round by round, parts from 1 by a margin. What is neither clearly faster nor clearly slower is open.

use super::interval::{DECISIVE, median_interval};
use super::model::{OnFront, Spread, Truth, Way};

/// The least margin by which a variant must be faster than another.
const LEAST_MARGIN: f64 = 0.1;

/// The margin of a run, by the noise of its baseline against itself: as far as its interval reaches, and its quartiles.
pub(super) fn margin(same_again: &Spread) -> f64 {
    let [low, high] = same_again.interval;
    let reach = [1.0 / low, high, 1.0 / same_again.low, same_again.high];
    reach.iter().map(|far| far - 1.0).filter(|far| far.is_finite()).fold(LEAST_MARGIN, f64::max)
}

/// Whether the first variant is clearly faster than the second, given their times round by round.
pub(super) fn is_faster(first: &[f64], second: &[f64], margin: f64) -> bool {
    let ratios: Vec<f64> = first.iter().zip(second).map(|(first, second)| first / second).collect();
    median_interval(&ratios, DECISIVE).is_some_and(|[_, high]| high < 1.0 / (1.0 + margin))
}

/// For each variant, whether its figures leave out what is wrong with it.
pub(super) fn unfit(ways: &[Way], truths: &[Truth]) -> Vec<bool> {
    let least = |model: &str| {
        ways.iter().filter(|way| way.model == model).map(|way| way.error.non_finite).min().unwrap_or_default()
    };
    let covered = |model: &str| {
        let truth = truths.iter().find(|truth| truth.model == model);
        truth.map_or(0, |truth| truth.picture.covered.iter().filter(|covered| **covered).count() as u64)
    };
    let is_unfit =
        |way: &Way| way.error.non_finite > least(&way.model) || 2 * way.error.coverage_mismatch > covered(&way.model);
    ways.iter().map(is_unfit).collect()
}

/// Marks the fronts of every model.
pub(super) fn mark(ways: &mut [Way], truths: &[Truth], margin: f64) {
    let unfit = unfit(ways, truths);
    let mut marks = Vec::with_capacity(ways.len());
    for (way, &is_unfit) in ways.iter().zip(&unfit) {
        if is_unfit {
            marks.push((false, OnFront::No));
            continue;
        }
        let is_other = |other: &&Way| !std::ptr::eq(*other, way) && other.model == way.model;
        let others = ways.iter().zip(&unfit).filter(|(_, unfit)| !**unfit).map(|(other, _)| other).filter(is_other);
        let as_close: Vec<&Way> = others.filter(|other| other.error.rmse <= way.error.rmse).collect();
        marks.push((by_work(way, &as_close), by_time(way, &as_close, margin)));
    }
    for (way, (pareto, pareto_time)) in ways.iter_mut().zip(marks) {
        way.pareto = pareto;
        way.pareto_time = pareto_time;
    }
}

/// Whether none of the variants that are as close to the reference beats the variant in work.
fn by_work(way: &Way, as_close: &[&Way]) -> bool {
    let point = |way: &Way| (way.error.rmse, way.work.operations);
    !as_close.iter().any(|other| other.work.operations <= way.work.operations && point(other) != point(way))
}

/// Whether each of the variants that are as close to the reference is slower, or one of them faster.
fn by_time(way: &Way, as_close: &[&Way], margin: f64) -> OnFront {
    if as_close.iter().any(|other| is_faster(&other.times, &way.times, margin)) {
        OnFront::No
    } else if as_close.iter().all(|other| is_faster(&way.times, &other.times, margin)) {
        OnFront::Yes
    } else {
        OnFront::Open
    }
}

#[cfg(test)]
mod tests {
    use super::super::page::tests::way;
    use super::super::random::Random;
    use super::*;

    /// Variants of one model with these errors, operations and times; each round is off by up to `noise`.
    fn ways(points: &[(f64, u64, f64)], rounds: usize, noise: f64, seed: u64) -> Vec<Way> {
        let mut random = Random::new(seed);
        let mut ways: Vec<Way> = points.iter().map(|(error, work, _)| way("m", *error, *work)).collect();
        for _ in 0..rounds {
            for (way, (_, _, time)) in ways.iter_mut().zip(points) {
                // A heavy tail: one round in ten takes up to three times as long.
                let tail = if random.unit() < 0.1 { 1.0 + 2.0 * random.unit() } else { 1.0 };
                way.times.push(time * tail * (1.0 + noise * (random.unit() - 0.5)));
            }
        }
        ways
    }

    fn marks(mut ways: Vec<Way>) -> Vec<(bool, OnFront)> {
        mark(&mut ways, &[], LEAST_MARGIN);
        ways.iter().map(|way| (way.pareto, way.pareto_time)).collect()
    }

    #[test]
    fn a_way_is_beaten_only_beyond_doubt() {
        use OnFront::{No, Open, Yes};
        // Error, operations, time; the marks by work and by time.
        let table = [
            ((0.1, 10, 1.0), (true, Yes)),
            // Beaten by the first in all.
            ((0.2, 20, 2.0), (false, No)),
            // A little slower than the first, and less exact.
            ((0.3, 10, 1.03), (false, Open)),
            // Less work and time, at the price of exactness.
            ((0.4, 5, 0.5), (true, Yes)),
        ];
        let points: Vec<_> = table.iter().map(|(point, _)| *point).collect();
        let expected: Vec<_> = table.iter().map(|(_, marks)| *marks).collect();
        assert_eq!(marks(ways(&points, 40, 0.1, 1)), expected);
        // Too few rounds decide nothing but what needs no time.
        let few: Vec<OnFront> = marks(ways(&points, 8, 0.0, 1)).into_iter().map(|(_, time)| time).collect();
        assert_eq!(few, [Yes, Open, Open, Open]);
    }

    #[test]
    fn of_identical_ways_none_beats_another() {
        for seed in 0..100 {
            let marks = marks(ways(&[(0.1, 10, 1.0); 3], 40, 0.8, seed));
            assert_eq!(marks, [(true, OnFront::Open); 3], "seed {seed}");
        }
    }

    #[test]
    fn noise_never_turns_yes_into_no() {
        for time in [0.7, 0.85, 0.9, 0.95, 1.0, 1.05, 1.1, 1.2, 1.5] {
            let found: Vec<OnFront> =
                (0..50).map(|seed| marks(ways(&[(0.1, 10, time), (0.2, 5, 1.0)], 30, 1.0, seed))[1].1).collect();
            assert!(!(found.contains(&OnFront::Yes) && found.contains(&OnFront::No)), "{time}: {found:?}");
        }
    }

    #[test]
    fn what_is_not_finite_is_on_no_front() {
        let mut all = ways(&[(0.0, 1, 0.1), (0.2, 20, 2.0)], 40, 0.1, 3);
        all[0].error.non_finite = 5;
        assert_eq!(marks(all), [(false, OnFront::No), (true, OnFront::Yes)]);
    }

    #[test]
    fn the_margin_grows_with_the_noise() {
        let spread = |low, high, interval| Spread { median: 1.0, low, high, interval };
        assert_eq!(margin(&spread(0.99, 1.01, [0.99, 1.01])), LEAST_MARGIN);
        assert!((margin(&spread(0.6, 1.5, [0.9, 1.2])) - 2.0 / 3.0).abs() < 1e-12);
        assert_eq!(margin(&spread(f64::NAN, f64::NAN, [f64::NAN; 2])), LEAST_MARGIN);
    }
}
