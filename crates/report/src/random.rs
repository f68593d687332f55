//! [`Random`]: numbers by chance that are the same on every run.

use glisten_scene::random::SplitMix64;

/// A generator of orders.
#[derive(Clone, Debug)]
pub(super) struct Random(SplitMix64);

impl Random {
    /// A generator with this seed.
    pub(super) fn new(seed: u64) -> Self {
        Self(SplitMix64::new(seed))
    }

    /// A number from 0 to 1, 1 excluded.
    #[cfg(test)]
    pub(super) fn unit(&mut self) -> f64 {
        self.0.unit()
    }

    /// The numbers below `count` in an order by chance (Fisher and Yates).
    pub(super) fn permutation(&mut self, count: usize) -> Vec<usize> {
        let mut order: Vec<usize> = (0..count).collect();
        for last in (1..count).rev() {
            // The bias of the remainder is below 2^-50 for any number of variants.
            let chosen = (self.0.bits() % (last as u64 + 1)) as usize;
            order.swap(last, chosen);
        }
        order
    }
}

#[cfg(test)]
mod tests {
    use super::Random;

    #[test]
    fn every_order_is_as_likely() {
        let mut random = Random::new(1);
        let mut seen = std::collections::BTreeMap::new();
        for _ in 0..6000 {
            *seen.entry(random.permutation(3)).or_insert(0) += 1;
        }
        assert_eq!(seen.len(), 6);
        assert!(seen.values().all(|count| (850..1150).contains(count)), "{seen:?}");
        assert_eq!(Random::new(5).permutation(9), Random::new(5).permutation(9));
        assert!(random.permutation(0).is_empty());
    }
}
