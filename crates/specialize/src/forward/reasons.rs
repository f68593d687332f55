//! [`Reasons`]: what the walk decided, by the place in the text.
//!
//! *In:* what each call, round and evaluation decides of a place. *Out:* the [`Reason`] that holds of all of them.

use glisten_front::source::Span;
use rustc_hash::{FxHashMap, FxHashSet};

/// Why something went.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reason {
    /// The condition is known to hold, or not to.
    Condition(bool),
    /// The condition is known, and holds in some calls or rounds, but not in all.
    Both,
    /// Somewhere it is open.
    Open,
    /// The loop runs so many times and is written out.
    Unrolled(u32),
    /// The loop runs at most so many times, as it may be left before, and is written out.
    UnrolledUpTo(u32),
    /// The selector of a switch is known.
    Selector,
}

impl Reason {
    /// What holds of a place that is decided in two ways.
    fn and(self, other: Self) -> Self {
        match (self, other) {
            (known, other) if known == other => known,
            (Self::Condition(_) | Self::Both, Self::Condition(_) | Self::Both) => Self::Both,
            (Self::Unrolled(a) | Self::UnrolledUpTo(a), Self::Unrolled(b) | Self::UnrolledUpTo(b)) => {
                Self::UnrolledUpTo(a.max(b))
            }
            (known, _) => known,
        }
    }
}

/// What was told of a place.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    /// What was decided there, wherever it was.
    decided: Option<Reason>,
    /// Whether it is open somewhere.
    open: bool,
}

impl Told {
    fn tell(&mut self, reason: Reason) {
        match reason {
            Reason::Open => self.open = true,
            decided => self.decided = Some(self.decided.map_or(decided, |known| known.and(decided))),
        }
    }
}

/// What was decided, by the place of the condition, and which statements nothing gets to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reasons {
    told: FxHashMap<Span, Told>,
    /// The statements that were walked.
    reached: FxHashSet<Span>,
    /// Statements behind what leaves a body, and the condition that was decided so, if there is one.
    behind: FxHashMap<Span, Option<Span>>,
}

impl Reasons {
    /// Notes what was decided at a place. It is walked once for each call and round, which may decide it otherwise.
    pub(super) fn tell(&mut self, place: Span, reason: Reason) {
        self.told.entry(place).or_default().tell(reason);
    }

    /// Notes that a statement is walked.
    pub(super) fn reach(&mut self, stmt: Span) {
        self.reached.insert(stmt);
    }

    /// Notes that nothing gets to a statement in this call and round, since a condition is decided.
    pub(super) fn pass_over(&mut self, stmt: Span, condition: Option<Span>) {
        self.behind.entry(stmt).or_insert(condition);
    }

    /// Whether nothing ever gets to a statement, and the place of the condition that is decided so, if there is one.
    pub(crate) fn never_reached(&self, stmt: Span) -> Option<Option<Span>> {
        self.behind.get(&stmt).copied().filter(|_| !self.reached.contains(&stmt))
    }

    /// What holds of a place.
    pub(crate) fn get(&self, place: Span) -> Option<Reason> {
        let told = self.told.get(&place)?;
        if told.open { Some(Reason::Open) } else { told.decided }
    }

    /// Adds what evaluating the residual decided: what was open may be so no longer.
    pub(crate) fn then(&mut self, later: Self) {
        // Each place has its own entry, so their order does not matter.
        later.told.into_iter().for_each(|(place, told)| {
            let own = self.told.entry(place).or_default();
            own.open = told.open;
            if let Some(decided) = told.decided {
                own.tell(decided);
            }
        });
        self.reached = later.reached;
        later.behind.into_iter().for_each(|(stmt, condition)| self.pass_over(stmt, condition));
    }
}
