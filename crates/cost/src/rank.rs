//! How well one list of numbers ranks another: Spearman's coefficient.
//!
//! *In:* pairs. *Out:* from -1 to 1, and nothing for fewer than three pairs or equal numbers. *Holds:* equal numbers share the mean of their
//! ranks.

/// Spearman's coefficient of pairs of numbers: the correlation of their ranks.
pub fn spearman(pairs: &[(f64, f64)]) -> Option<f64> {
    if pairs.len() < 3 || pairs.iter().any(|(a, b)| a.is_nan() || b.is_nan()) {
        return None;
    }
    let first = ranks(&pairs.iter().map(|pair| pair.0).collect::<Vec<_>>());
    let second = ranks(&pairs.iter().map(|pair| pair.1).collect::<Vec<_>>());
    let mean = (pairs.len() + 1) as f64 / 2.0;
    let sum =
        |of: &dyn Fn(f64, f64) -> f64| first.iter().zip(&second).map(|(a, b)| of(a - mean, b - mean)).sum::<f64>();
    let spread = (sum(&|a, _| a * a) * sum(&|_, b| b * b)).sqrt();
    (spread > 0.0).then(|| sum(&|a, b| a * b) / spread)
}

/// The rank of each number, from 1.
pub fn ranks(numbers: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..numbers.len()).collect();
    let number = |index: usize| numbers.get(index).copied().unwrap_or(f64::NAN);
    order.sort_by(|a, b| number(*a).total_cmp(&number(*b)));
    let mut ranks = vec![0.0; numbers.len()];
    let mut start = 0;
    for equal in order.chunk_by(|a, b| number(*a) == number(*b)) {
        let rank = start as f64 + (equal.len() + 1) as f64 / 2.0;
        for index in equal {
            ranks.get_mut(*index).into_iter().for_each(|slot| *slot = rank);
        }
        start += equal.len();
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::{ranks, spearman};

    #[test]
    fn equal_numbers_share_ranks() {
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [3.5, 1.0, 3.5, 2.0]);
    }

    #[test]
    fn order_counts_and_size_does_not() {
        assert_eq!(spearman(&[(1.0, 1.0), (2.0, 100.0), (3.0, 101.0)]), Some(1.0));
        assert_eq!(spearman(&[(1.0, 3.0), (2.0, 2.0), (3.0, 1.0)]), Some(-1.0));
        let swapped = spearman(&[(1.0, 1.0), (2.0, 2.0), (3.0, 4.0), (4.0, 3.0)]).expect("they differ");
        assert!((swapped - 0.8).abs() < 1e-12, "{swapped}");
        assert_eq!(spearman(&[(1.0, 1.0), (1.0, 2.0), (1.0, 3.0)]), None);
    }
}
