//! [`Store`]: what is known of each variable where the evaluation stands.
//!
//! *In:* assignments. *Out:* facts, and what happens to them where paths part and meet again.
//! *Holds:* every change is in the journal, so that going back to a mark costs as much as was changed since.

use crate::facts::{self, Fact};
use rustc_hash::FxHashMap;
use std::rc::Rc;

/// A variable in the store: globals come first, then the locals of each call under way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Key(pub(super) u32);

/// What is known of a variable, scalar by scalar; empty if nothing ever is.
pub(super) type Cell = Rc<Vec<Fact>>;

/// A place in the journal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Mark(usize);

/// What was changed since a mark.
#[derive(Debug)]
pub(super) struct Changes(pub(super) Vec<(Key, Cell)>);

/// Facts by variable.
#[derive(Debug, Default)]
pub(super) struct Store {
    cells: Vec<Cell>,
    journal: Vec<(Key, Cell)>,
    /// Whether anything gets here at all.
    pub(super) live: bool,
}

impl Store {
    /// An empty one that something gets to.
    pub(super) fn live() -> Self {
        Self { live: true, ..Self::default() }
    }

    /// Adds a variable.
    pub(super) fn push(&mut self, facts: Vec<Fact>) -> Key {
        self.cells.push(Rc::new(facts));
        Key(self.cells.len() as u32 - 1)
    }

    /// How many variables there are.
    pub(super) fn len(&self) -> u32 {
        self.cells.len() as u32
    }

    /// Forgets the variables from a number on.
    pub(super) fn truncate(&mut self, len: u32) {
        self.cells.truncate(len as usize);
    }

    /// The facts of a variable.
    pub(super) fn get(&self, key: Key) -> &[Fact] {
        self.cells.get(key.0 as usize).map_or(&[], |cell| cell.as_slice())
    }

    /// The variable's facts as they are kept.
    pub(super) fn cell(&self, key: Key) -> Cell {
        self.cells.get(key.0 as usize).cloned().unwrap_or_default()
    }

    /// Changes the facts of a variable.
    pub(super) fn change(&mut self, key: Key, change: impl FnOnce(&mut [Fact])) {
        let Some(cell) = self.cells.get_mut(key.0 as usize) else { return };
        self.journal.push((key, Rc::clone(cell)));
        change(Rc::make_mut(cell).as_mut_slice());
    }

    /// Replaces the facts of a variable.
    pub(super) fn set(&mut self, key: Key, facts: Cell) {
        let Some(cell) = self.cells.get_mut(key.0 as usize) else { return };
        self.journal.push((key, std::mem::replace(cell, facts)));
    }

    /// Forgets all that is known of a variable.
    pub(super) fn forget(&mut self, key: Key) {
        if self.get(key).iter().any(|fact| *fact != Fact::ANY) {
            self.change(key, |facts| facts.fill(Fact::ANY));
        }
    }

    /// Where the journal stands.
    pub(super) fn mark(&self) -> Mark {
        Mark(self.journal.len())
    }

    /// What was changed since a mark, each variable once, in order.
    pub(super) fn changes(&self, mark: Mark) -> Changes {
        let mut keys: Vec<Key> = self.journal.iter().skip(mark.0).map(|(key, _)| *key).collect();
        keys.sort_unstable();
        keys.dedup();
        keys.retain(|key| (key.0 as usize) < self.cells.len());
        Changes(keys.into_iter().map(|key| (key, self.cell(key))).collect())
    }

    /// Back to how it was at a mark, and live.
    pub(super) fn roll_back(&mut self, mark: Mark) {
        while self.journal.len() > mark.0 {
            let Some((key, cell)) = self.journal.pop() else { break };
            if let Some(slot) = self.cells.get_mut(key.0 as usize) {
                *slot = cell;
            }
        }
        self.live = true;
    }

    /// How the variables that were changed since a mark were there.
    fn before(&self, mark: Mark) -> FxHashMap<Key, Cell> {
        let mut before = FxHashMap::default();
        for (key, cell) in self.journal.iter().skip(mark.0) {
            before.entry(*key).or_insert_with(|| Rc::clone(cell));
        }
        before
    }

    /// Another way, that parted at `mark` and changed this, meets the one that the store is on.
    pub(super) fn meet(&mut self, other: &Changes, mark: Mark) {
        let own = self.changes(mark);
        let before = self.before(mark);
        let before = |key: Key| before.get(&key).cloned().unwrap_or_default();
        if !self.live {
            for (key, _) in &own.0 {
                self.set(*key, before(*key));
            }
            for (key, cell) in &other.0 {
                self.set(*key, Rc::clone(cell));
            }
            self.live = true;
            return;
        }
        for (key, cell) in &other.0 {
            self.join(*key, cell);
        }
        for (key, _) in &own.0 {
            if other.0.binary_search_by_key(key, |(key, _)| *key).is_err() {
                self.join(*key, &before(*key));
            }
        }
    }

    fn join(&mut self, key: Key, other: &Cell) {
        let own = self.cell(key);
        if Rc::ptr_eq(&own, other) || own.as_slice() == other.as_slice() {
            return;
        }
        let joined = facts::join(&own, other);
        self.set(key, Rc::new(joined.into_vec()));
    }
}
