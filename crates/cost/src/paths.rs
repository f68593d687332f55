//! [`Paths`]: the shortest and the longest path through a part of a program, and what they are made of.
//!
//! *In:* pieces of work at lines. *Out:* the counts of a path, and those of each of its lines. *Holds:* a path is a graph of pieces
//! that paths share, so its size does not depend on how often loops run or functions are called.

use super::counts::Counts;

/// A line of a file, by the number that `lines` gives it.
pub(super) type Line = u32;

/// A path, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Path(u32);

/// A piece of a path. It names earlier pieces only.
enum Piece {
    Nothing,
    Work { line: Line, counts: Counts, is_uniform: bool },
    Then(Path, Path),
    Times(u64, Path),
}

/// The shortest and the longest of several paths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Way {
    pub(super) least: Path,
    pub(super) most: Path,
}

/// How control may leave a part of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Exit {
    /// At its end.
    Next,
    Break,
    Continue,
    Return,
    /// By `discard`, for the whole shader.
    End,
}

/// All exits.
const EXITS: [Exit; 5] = [Exit::Next, Exit::Break, Exit::Continue, Exit::Return, Exit::End];

/// The paths to each exit of a part; none to an exit that it does not have.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Flow([Option<Way>; 5]);

impl Flow {
    /// The paths that leave at one exit.
    pub(super) fn leaving(exit: Exit, way: Option<Way>) -> Self {
        Self::default().with(exit, way)
    }

    pub(super) fn at(&self, exit: Exit) -> Option<Way> {
        self.0.get(exit as usize).copied().flatten()
    }

    pub(super) fn with(mut self, exit: Exit, way: Option<Way>) -> Self {
        if let Some(slot) = self.0.get_mut(exit as usize) {
            *slot = way;
        }
        self
    }
}

/// All paths of a shader.
pub(super) struct Paths {
    pieces: Vec<Piece>,
    totals: Vec<Counts>,
}

/// The counts of a line on a path: all, and those of values that are the same in the whole draw.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    pub(super) all: Counts,
    pub(super) uniform: Counts,
}

impl Paths {
    /// The path on which nothing is done.
    pub(super) const NOTHING: Path = Path(0);

    pub(super) fn new() -> Self {
        Self { pieces: vec![Piece::Nothing], totals: vec![Counts::default()] }
    }

    /// The flow of a part that does nothing.
    pub(super) fn nothing() -> Flow {
        Flow::leaving(Exit::Next, Some(Self::way(Self::NOTHING)))
    }

    /// The way that is one path.
    pub(super) fn way(path: Path) -> Way {
        Way { least: path, most: path }
    }

    pub(super) fn total(&self, path: Path) -> Counts {
        self.totals.get(path.0 as usize).copied().unwrap_or_default()
    }

    fn weight(&self, path: Path) -> u64 {
        self.total(path).weight()
    }

    fn push(&mut self, piece: Piece, total: Counts) -> Path {
        let number = u32::try_from(self.pieces.len()).unwrap_or(0);
        if number > 0 {
            self.pieces.push(piece);
            self.totals.push(total);
        }
        Path(number)
    }

    /// A piece of work.
    pub(super) fn work(&mut self, line: Line, counts: Counts, is_uniform: bool) -> Path {
        if counts.is_nothing() {
            return Self::NOTHING;
        }
        self.push(Piece::Work { line, counts, is_uniform }, counts)
    }

    pub(super) fn path_then(&mut self, first: Path, second: Path) -> Path {
        match (first, second) {
            (Self::NOTHING, other) | (other, Self::NOTHING) => other,
            _ => {
                let total = self.total(first).plus(self.total(second));
                self.push(Piece::Then(first, second), total)
            }
        }
    }

    pub(super) fn path_times(&mut self, count: u64, path: Path) -> Path {
        match (count, path) {
            (0, _) | (_, Self::NOTHING) => Self::NOTHING,
            (1, path) => path,
            _ => {
                let total = self.total(path).times(count);
                self.push(Piece::Times(count, path), total)
            }
        }
    }

    fn way_then(&mut self, first: Way, second: Way) -> Way {
        Way { least: self.path_then(first.least, second.least), most: self.path_then(first.most, second.most) }
    }

    /// One way or the other.
    pub(super) fn way_or(&self, first: Option<Way>, second: Option<Way>) -> Option<Way> {
        let (Some(first), Some(second)) = (first, second) else { return first.or(second) };
        let shorter = self.weight(second.least) < self.weight(first.least);
        let longer = self.weight(second.most) > self.weight(first.most);
        Some(Way {
            least: if shorter { second.least } else { first.least },
            most: if longer { second.most } else { first.most },
        })
    }

    /// One part, and the other behind its end.
    pub(super) fn then(&mut self, first: Flow, second: Flow) -> Flow {
        let Some(next) = first.at(Exit::Next) else { return first };
        let mut both = first.with(Exit::Next, None);
        for exit in EXITS {
            let Some(way) = second.at(exit) else { continue };
            let whole = self.way_then(next, way);
            both = both.with(exit, self.way_or(both.at(exit), Some(whole)));
        }
        both
    }

    /// One part or the other.
    pub(super) fn or(&self, first: Flow, second: Flow) -> Flow {
        EXITS.iter().fold(first, |both, &exit| both.with(exit, self.way_or(first.at(exit), second.at(exit))))
    }

    /// The counts of each line on a path.
    pub(super) fn shares(&self, path: Path, lines: usize) -> Vec<Share> {
        let mut shares = vec![Share::default(); lines];
        let mut often = vec![0_u64; path.0 as usize + 1];
        let add = |often: &mut Vec<u64>, path: Path, count: u64| {
            often.get_mut(path.0 as usize).into_iter().for_each(|slot| *slot = slot.saturating_add(count));
        };
        add(&mut often, path, 1);
        // A piece names earlier ones, so all that need it have been seen when it is its turn.
        for number in (0..often.len()).rev() {
            let count = often.get(number).copied().unwrap_or(0);
            match self.pieces.get(number) {
                Some(Piece::Work { line, counts, is_uniform }) if count > 0 => {
                    let Some(share) = shares.get_mut(*line as usize) else { continue };
                    share.all = share.all.plus(counts.times(count));
                    if *is_uniform {
                        share.uniform = share.uniform.plus(counts.times(count));
                    }
                }
                Some(Piece::Then(first, second)) if count > 0 => {
                    add(&mut often, *first, count);
                    add(&mut often, *second, count);
                }
                Some(Piece::Times(times, inner)) if count > 0 => {
                    add(&mut often, *inner, count.saturating_mul(*times));
                }
                _ => {}
            }
        }
        shares
    }
}
