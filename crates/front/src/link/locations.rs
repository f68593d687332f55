//! The allocator of all locations: those of attributes, varyings, clip distances and fragment outputs.
//!
//! *In:* the number of locations. *Out:* which are free, and the contents of each.
//!
//! *Holds:* a location at or above the limit is never assigned.

use std::ops::Range;

/// The locations below a limit, each with its contents.
#[derive(Clone)]
pub(super) struct Locations<T> {
    slots: Vec<T>,
}

impl<T: Clone + Default> Locations<T> {
    /// `limit` locations with default contents.
    pub(super) fn new(limit: u32) -> Self {
        Self { slots: vec![T::default(); limit as usize] }
    }

    /// `count` locations from `first`, or `None` if the last of them is above the limit.
    pub(super) fn run(&self, first: u32, count: u32) -> Option<&[T]> {
        self.slots.get(range(first, count)?)
    }

    /// Returns the same locations mutably.
    pub(super) fn run_mut(&mut self, first: u32, count: u32) -> Option<&mut [T]> {
        self.slots.get_mut(range(first, count)?)
    }

    /// The lowest range of `count` locations that all fit.
    pub(super) fn lowest(&self, count: u32, fits: impl Fn(&T) -> bool) -> Option<u32> {
        let last = (self.slots.len() as u32).checked_sub(count)?;
        (0..=last).find(|&first| self.run(first, count).is_some_and(|run| run.iter().all(&fits)))
    }

    /// The range of `count` locations above all that do not fit. If that is above the limit: the lowest range that
    /// fits.
    pub(super) fn above_all(&self, count: u32, fits: impl Fn(&T) -> bool) -> Option<u32> {
        let first = self.slots.iter().rposition(|slot| !fits(slot)).map_or(0, |last| last as u32 + 1);
        self.run(first, count).map(|_| first).or_else(|| self.lowest(count, fits))
    }
}

fn range(first: u32, count: u32) -> Option<Range<usize>> {
    Some(first as usize..first.checked_add(count)? as usize)
}

#[cfg(test)]
mod tests {
    use super::Locations;

    fn taken(limit: u32, taken: &[u32]) -> Locations<bool> {
        let mut locations = Locations::new(limit);
        for &location in taken {
            locations.run_mut(location, 1).expect("the location is below the limit").fill(true);
        }
        locations
    }

    #[test]
    fn the_lowest_run_has_room_for_all() {
        let locations = taken(8, &[0, 2, 5]);
        let lowest = |count| locations.lowest(count, |taken| !taken);
        assert_eq!([1, 2, 3, 8, u32::MAX].map(lowest), [Some(1), Some(3), None, None, None]);
    }

    #[test]
    fn what_comes_last_goes_into_a_gap_if_it_must() {
        let above = |taken: &Locations<bool>, count| taken.above_all(count, |taken| !taken);
        assert_eq!(above(&taken(8, &[0, 2]), 2), Some(3));
        assert_eq!(above(&taken(8, &[0, 7]), 2), Some(1));
        assert_eq!(above(&taken(3, &[1]), 2), None);
        assert_eq!(above(&taken(3, &[]), 3), Some(0));
    }

    #[test]
    fn runs_beyond_the_limit_do_not_exist() {
        let locations = taken(8, &[]);
        assert!(locations.run(7, 1).is_some());
        assert!(locations.run(7, 2).is_none());
        assert!(locations.run(u32::MAX, u32::MAX).is_none());
    }
}
