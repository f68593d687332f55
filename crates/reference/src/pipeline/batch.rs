//! [`Batch`]: fragments that are shaded together.
//!
//! *In:* pixels of one primitive after another. *Out:* lanes for the executor, and which run of them belongs to which
//! primitive. *Holds:* lanes are in the order of the primitives. New pixels are *candidates* after the other lanes.
//! Values that every program needs are computed for all candidates of a primitive at once; then they are tested, and
//! only those that pass remain.

use super::assembly::Prim;
use super::edges::EdgeFragment;
use super::fragment_tests::Tests;
use super::source::{Fragments, Source};
use crate::domain::Domain;
use crate::exec::{LANES, Mask};
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// The lanes of a primitive, from its first one on.
#[derive(Debug)]
pub(super) struct Run<'v, D: Domain> {
    pub(super) source: Source<'v, D>,
    pub(super) front: bool,
    pub(super) id: u32,
    undecided: bool,
    perhaps: bool,
    start: usize,
}

/// The fragments of a batch.
pub(super) struct Batch<'v, D: Domain> {
    pub(super) fragments: Fragments<D>,
    /// The lanes to shade, without helper lanes of quads.
    pub(super) live: u64,
    /// The results of their tests so far; for candidates, their roles near edges.
    pub(super) tests: Tests,
    runs: Vec<Run<'v, D>>,
    count: usize,
    /// The index of the first candidate.
    settled: usize,
    /// The upper left pixel of the bin.
    corner: [i32; 2],
}

impl<'v, D: Domain> Batch<'v, D> {
    pub(super) fn new(corner: [i32; 2]) -> Self {
        let fragments = Fragments::new();
        let tests = Tests::default();
        Self { fragments, live: 0, tests, runs: Vec::new(), count: 0, settled: 0, corner }
    }

    /// Begins the pixels of a primitive.
    pub(super) fn begin(&mut self, prim: &Prim, source: Source<'v, D>) {
        // The previous primitive may have no lanes left.
        self.runs.pop_if(|run| run.start == self.count);
        let Prim { front, id, undecided, perhaps, .. } = *prim;
        self.runs.push(Run { source, front, id, undecided, perhaps, start: self.count });
    }

    pub(super) fn is_full(&self) -> bool {
        self.count == LANES
    }

    /// Adds pixels of a row while there is room; bit `i` of `set` is the `i`th pixel from `first` on. Returns the
    /// pixels that did not fit.
    #[inline(always)]
    pub(super) fn add_row(&mut self, first: u32, set: u64) -> u64 {
        let mut rest = set;
        let start = self.count;
        for slot in &mut self.fragments.pixels[start..] {
            if rest == 0 {
                break;
            }
            *slot = first + rest.trailing_zeros();
            rest &= rest - 1;
            self.count += 1;
        }
        self.live |= Mask::first(self.count).0 & !Mask::first(start).0;
        rest
    }

    /// Adds a quad with the given covered pixels; `row` is the distance between its rows. There must be room.
    #[inline(always)]
    pub(super) fn add_quad(&mut self, first: u32, row: u32, covered: u32) {
        let lanes = self.fragments.pixels.iter_mut().skip(self.count);
        for (slot, pixel) in lanes.zip([first, first + 1, first + row, first + row + 1]) {
            *slot = pixel;
        }
        self.live |= u64::from(covered) << self.count;
        self.count += 4;
    }

    /// Adds a fragment near an edge. There must be room.
    pub(super) fn add_edge(&mut self, fragment: &EdgeFragment) {
        self.add_row(fragment.place, 1);
        self.tests.set_role(self.count - 1, fragment.role, fragment.is_inside);
    }

    /// Notes that a lane of the last quad, whose first lane is the upper left pixel, is near an edge.
    pub(super) fn mark_in_quad(&mut self, lane: usize, fragment: &EdgeFragment) {
        self.tests.set_role(self.count.saturating_sub(4) + lane, fragment.role, fragment.is_inside);
    }

    /// Computes the candidates' weights and depth. Returns the state of their tests; `None` if there are none.
    pub(super) fn locate(&mut self) -> Option<Tests> {
        let lanes = self.settled..self.count;
        let run = self.runs.last().filter(|_| !lanes.is_empty())?;
        let covered = self.live & !Mask::first(lanes.start).0;
        let roles = self.tests.moved(|set| set & covered);
        let doubtful = if run.undecided { covered } else { 0 };
        let drawn = if run.perhaps { 0 } else { covered };
        let locate = Locate { source: &run.source, fragments: &mut self.fragments, corner: self.corner, lanes };
        pulp::Arch::new().dispatch(locate);
        let passes = drawn & !(roles.open & roles.outside);
        Some(Tests { passes, undecided: doubtful | roles.open, doubtful, ..roles })
    }

    /// Keeps the candidates that some conforming GPU draws; if whole quads are kept (`COUNT` is 4), all candidates of
    /// a quad with such a one.
    pub(super) fn keep<const COUNT: usize>(&mut self, tests: Tests) {
        let (start, end) = (self.settled, self.count);
        let (before, possible) = (Mask::first(start).0, tests.possible());
        let candidates = self.live & !before;
        self.live &= before;
        self.tests = self.tests.moved(|set| set & before);
        let unit = (1_u64 << COUNT) - 1;
        self.settled = end;
        if possible == candidates {
            self.live |= possible;
            self.tests.merge(tests);
            return;
        }
        let mut to = start;
        for from in (start..end).step_by(COUNT) {
            let lanes = |of: u64| of >> from & unit;
            if lanes(possible) == 0 {
                continue;
            }
            self.fragments.shift::<COUNT>(from, to);
            self.live |= lanes(possible) << to;
            self.tests.merge(tests.moved(|set| lanes(set) << to));
            to += COUNT;
        }
        (self.count, self.settled) = (to, to);
    }

    /// The helper lanes.
    pub(super) fn helpers(&self) -> Mask {
        Mask(Mask::first(self.count).0 & !self.live)
    }

    /// The primitives and their lanes.
    #[inline(always)]
    pub(super) fn runs(&self) -> impl Iterator<Item = (&Run<'v, D>, Range<usize>)> {
        let ends = self.runs.iter().skip(1).map(|run| run.start).chain([self.count]);
        self.runs.iter().zip(ends).map(|(run, end)| (run, run.start..end))
    }

    /// Computes what (108) needs besides the weights.
    #[inline(always)]
    pub(super) fn find_w(&mut self) {
        let ends = self.runs.iter().skip(1).map(|run| run.start).chain([self.count]);
        for (run, end) in self.runs.iter().zip(ends) {
            run.source.find_w(&mut self.fragments, run.start..end);
        }
    }

    /// Empties the batch. The last primitive may continue.
    pub(super) fn clear(&mut self) {
        self.runs.drain(..self.runs.len().saturating_sub(1));
        if let Some(last) = self.runs.first_mut() {
            last.start = 0;
        }
        (self.count, self.settled, self.live) = (0, 0, 0);
        self.tests = Tests::default();
    }
}

/// A loop to compile for wide vectors.
struct Locate<'a, 'v, D: Domain> {
    source: &'a Source<'v, D>,
    fragments: &'a mut Fragments<D>,
    corner: [i32; 2],
    lanes: Range<usize>,
}

impl<D: Domain> WithSimd for Locate<'_, '_, D> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        self.source.locate(self.fragments, self.corner, self.lanes);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::F64;

    #[test]
    fn what_fails_leaves_no_gap() {
        let mut batch = Batch::<F64>::new([0, 0]);
        assert_eq!(batch.add_row(40, 0b1011), 0);
        batch.keep::<1>(Tests { passes: 0b001, undecided: 0b100, ..Tests::default() });
        assert_eq!(batch.fragments.pixels[..2], [40, 43]);
        assert_eq!((batch.live, batch.tests), (0b11, Tests { passes: 0b01, undecided: 0b10, ..Tests::default() }));
        // After the lanes that remained, which need nothing more.
        assert_eq!(batch.add_row(64, 0b11), 0);
        batch.keep::<1>(Tests { passes: 0b1000, ..Tests::default() });
        assert_eq!(batch.fragments.pixels[..3], [40, 43, 65]);
        assert_eq!((batch.live, batch.tests), (0b111, Tests { passes: 0b101, undecided: 0b010, ..Tests::default() }));
        assert!(batch.helpers().is_empty());
    }

    #[test]
    fn a_quad_stays_whole_or_goes() {
        let mut batch = Batch::<F64>::new([0, 0]);
        batch.add_quad(0, 32, 0b0001);
        batch.add_quad(2, 32, 0b0110);
        batch.keep::<4>(Tests { passes: 0b0010 << 4, ..Tests::default() });
        assert_eq!(batch.fragments.pixels[..4], [2, 3, 34, 35]);
        assert_eq!((batch.live, batch.helpers()), (0b0010, Mask(0b1101)));
    }

    #[test]
    fn a_full_batch_gives_the_rest_back() {
        let mut batch = Batch::<F64>::new([0, 0]);
        assert_eq!(batch.add_row(0, (1 << 40) - 1), 0);
        assert_eq!(batch.add_row(64, (1 << 32) - 1), 0xff << 24);
        assert!(batch.is_full());
        assert_eq!((batch.live, batch.fragments.pixels[63]), (u64::MAX, 64 + 23));
    }
}
