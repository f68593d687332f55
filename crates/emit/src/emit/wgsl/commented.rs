//! The statements that comments may belong to, found by their places.
//!
//! *In:* the tree of a function and its text. *Out:* answers by search, so that work does not grow with the product of
//! statements and comments. *Holds:* where several statements have one place, the first of the tree comes first.

use super::tree::{BlockId, Body, StmtKind};
use rustc_hash::FxHashMap;

/// The braces of a body. Positions are offsets in the file.
#[derive(Debug, Default)]
pub(super) struct Braces {
    /// Where blocks begin and end, in order, with the brace that is innermost from there on.
    pub(super) list: Vec<(usize, usize)>,
    /// Where the body begins and ends.
    pub(super) range: (usize, usize),
}

impl Braces {
    /// The innermost brace around a position.
    pub(super) fn brace_at(&self, at: usize) -> usize {
        let after = self.list.partition_point(|(start, _)| *start < at);
        after.checked_sub(1).and_then(|index| self.list.get(index)).map_or(0, |(_, brace)| *brace)
    }
}

/// A statement of the tree with its range in the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) start: usize,
    pub(super) end: usize,
    pub(super) brace: usize,
    pub(super) block: BlockId,
    pub(super) at: usize,
    /// Whether it has blocks.
    pub(super) compound: bool,
}

/// All statements of a function.
#[derive(Debug, Default)]
pub(super) struct Candidates {
    /// In the order of the tree.
    all: Vec<Candidate>,
    /// The numbers of all, by their starts.
    by_start: Vec<usize>,
    /// The numbers of those without blocks, by their starts, each with the largest end up to it.
    simple: Vec<(usize, usize)>,
    /// The starts of those with blocks, each with the largest end up to it.
    compound: Vec<(usize, usize)>,
    /// The numbers of those with blocks, by their ends.
    by_end: Vec<usize>,
    /// The numbers of those in a brace.
    in_brace: FxHashMap<usize, Vec<usize>>,
}

impl Candidates {
    /// The statements of a body whose file begins at `base`.
    pub(super) fn of(body: &Body<'_>, base: usize, braces: &Braces) -> Self {
        let mut all = Vec::new();
        collect(body, BlockId(0), base, braces, &mut all);
        let sorted = |key: &dyn Fn(&Candidate) -> usize, is_meant: &dyn Fn(&Candidate) -> bool| {
            let mut numbers: Vec<(usize, usize)> = all
                .iter()
                .enumerate()
                .filter(|(_, one)| is_meant(one))
                .map(|(number, one)| (key(one), number))
                .collect();
            numbers.sort_unstable();
            numbers.into_iter().map(|(_, number)| number).collect::<Vec<usize>>()
        };
        let end_of = |number: usize| all.get(number).map_or(0, |one: &Candidate| one.end);
        let start_of = |number: usize| all.get(number).map_or(0, |one: &Candidate| one.start);
        let with_ends = |numbers: Vec<usize>, first: &dyn Fn(usize) -> usize| {
            let mut most = 0;
            let largest = |number: usize| {
                most = most.max(end_of(number));
                (first(number), most)
            };
            numbers.into_iter().map(largest).collect::<Vec<(usize, usize)>>()
        };
        let simple = with_ends(sorted(&|one| one.start, &|one| !one.compound), &|number| number);
        let compound = with_ends(sorted(&|one| one.start, &|one| one.compound), &start_of);
        let by_start = sorted(&|one| one.start, &|_| true);
        let by_end = sorted(&|one| one.end, &|one| one.compound);
        let mut in_brace: FxHashMap<usize, Vec<usize>> = FxHashMap::default();
        for (number, one) in all.iter().enumerate() {
            in_brace.entry(one.brace).or_default().push(number);
        }
        Self { all, by_start, simple, compound, by_end, in_brace }
    }

    /// All, in the order of the tree.
    pub(super) fn iter(&self) -> impl Iterator<Item = &Candidate> {
        self.all.iter()
    }

    /// The first that starts at a place or behind it.
    pub(super) fn from(&self, place: usize) -> Option<&Candidate> {
        let first = self.by_start.partition_point(|number| self.all.get(*number).is_some_and(|one| one.start < place));
        self.all.get(*self.by_start.get(first)?)
    }

    /// Those without blocks that start before a place and end at `end` or behind it.
    pub(super) fn simple(&self, before: usize, end: usize) -> impl Iterator<Item = (usize, &Candidate)> {
        let count =
            self.simple.partition_point(|(number, _)| self.all.get(*number).is_some_and(|one| one.start < before));
        let near = self.simple.get(..count).unwrap_or(&[]).iter().rev().take_while(move |(_, most)| *most >= end);
        near.filter_map(|(number, _)| Some((*number, self.all.get(*number)?))).filter(move |(_, one)| one.end >= end)
    }

    /// Those with blocks that end from `first` to `last`.
    pub(super) fn that_end(&self, first: usize, last: usize) -> impl Iterator<Item = &Candidate> {
        let from = self.by_end.partition_point(|number| self.all.get(*number).is_some_and(|one| one.end < first));
        let rest = self.by_end.get(from..).unwrap_or(&[]).iter().filter_map(|number| self.all.get(*number));
        rest.take_while(move |one| one.end <= last)
    }

    /// Whether one with blocks starts before a place and ends at `end` or behind it.
    pub(super) fn is_around(&self, before: usize, end: usize) -> bool {
        let count = self.compound.partition_point(|(start, _)| *start < before);
        count.checked_sub(1).and_then(|last| self.compound.get(last)).is_some_and(|(_, most)| *most >= end)
    }

    /// The last in a brace that starts before a place.
    pub(super) fn last_in(&self, brace: usize, before: usize) -> Option<&Candidate> {
        let numbers = self.in_brace.get(&brace)?.iter().rev();
        numbers.filter_map(|number| self.all.get(*number)).find(|one| one.start < before)
    }
}

/// The statements of the tree in their order.
fn collect(body: &Body<'_>, id: BlockId, base: usize, braces: &Braces, candidates: &mut Vec<Candidate>) {
    let Some(block) = body.blocks.get(id.0) else { return };
    for (at, stmt) in block.statements.iter().enumerate() {
        for span in [stmt.span, stmt.declared] {
            let Some(range) = span.to_range().filter(|_| !matches!(stmt.kind, StmtKind::Empty)) else { continue };
            let (Some(start), Some(end)) = (range.start.checked_sub(base), range.end.checked_sub(base)) else {
                continue;
            };
            if start > braces.range.0 && end <= braces.range.1 {
                let mut compound = false;
                stmt.kind.for_each_block(&mut |_| compound = true);
                let brace = braces.brace_at(start);
                candidates.push(Candidate { start, end, brace, block: id, at, compound });
            }
        }
        stmt.kind.for_each_block(&mut |inner| collect(body, inner, base, braces, candidates));
    }
}
