//! The interval of a median, whatever the distribution of the values.
//!
//! *In:* values of independent rounds. *Out:* two of them between which the median of the distribution is with a given
//! confidence.
//!
//! *Holds:* each value is above the median by a chance of one half, so the number of values above it is binomial, and two
//! order statistics bound it. The confidence is at least the asked one; too few values give no interval.

/// The confidence of the intervals that a report shows.
pub(super) const SHOWN: f64 = 0.95;
/// The confidence by which one variant may beat another. There are many pairs and many runs.
pub(super) const DECISIVE: f64 = 0.9999;
/// The fewest values that have an interval of 95 %.
pub(super) const FEWEST: u32 = 6;

/// The interval of the median of `values` with this confidence; `None` if there are too few.
pub(super) fn median_interval(values: &[f64], confidence: f64) -> Option<[f64; 2]> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = rank(sorted.len(), confidence)?;
    Some([*sorted.get(rank)?, *sorted.get(sorted.len() - 1 - rank)?])
}

/// The largest number of values to leave out at both ends: `P(B <= rank) <= (1 - confidence) / 2` for a binomial `B` of
/// `count` coins.
fn rank(count: usize, confidence: f64) -> Option<usize> {
    let allowed = (1.0 - confidence) / 2.0;
    // `count` is at most a thousand, and 2^-1000 is a normal number.
    let mut chance = 0.5f64.powi(i32::try_from(count).ok()?);
    let mut below = 0.0;
    let mut rank = None;
    for taken in 0..count / 2 {
        below += chance;
        if below > allowed {
            break;
        }
        rank = Some(taken);
        chance *= (count - taken) as f64 / (taken + 1) as f64;
    }
    rank
}

#[cfg(test)]
mod tests {
    use super::super::random::Random;
    use super::*;

    #[test]
    fn ranks_are_those_of_the_tables() {
        // Conover, Practical Nonparametric Statistics, the sign test: the ranks count from 0 here.
        for (count, expected) in
            [(5, None), (6, Some(0)), (8, Some(0)), (9, Some(1)), (15, Some(3)), (20, Some(5)), (100, Some(39))]
        {
            assert_eq!(rank(count, SHOWN), expected, "{count}");
        }
        assert_eq!((rank(14, DECISIVE), rank(15, DECISIVE)), (None, Some(0)));
        assert!(rank(1000, SHOWN).is_some_and(|rank| (460..500).contains(&rank)));
    }

    /// How often the interval holds the median 1 of a skewed distribution with a heavy tail.
    fn coverage(rounds: usize, confidence: f64) -> f64 {
        let mut random = Random::new(7);
        let trials = 4000;
        let hits = (0..trials).filter(|_| {
            let values: Vec<f64> = (0..rounds).map(|_| 1.0 / (random.unit() + 0.5).powi(3)).collect();
            median_interval(&values, confidence).is_some_and(|[low, high]| low <= 1.0 && 1.0 <= high)
        });
        hits.count() as f64 / f64::from(trials)
    }

    #[test]
    fn intervals_hold_the_median_as_often_as_they_say() {
        for rounds in [6, 9, 15, 40, 101] {
            let share = coverage(rounds, SHOWN);
            assert!((0.94..0.985).contains(&share), "{rounds} rounds: {share}");
        }
        assert!(coverage(20, DECISIVE) > 0.9995);
    }

    #[test]
    fn too_few_values_have_no_interval() {
        assert_eq!(median_interval(&[1.0; 5], SHOWN), None);
        assert_eq!(median_interval(&[3.0, 1.0, 2.0, 5.0, 4.0, 6.0], SHOWN), Some([1.0, 6.0]));
        assert_eq!(median_interval(&[], SHOWN), None);
    }
}
