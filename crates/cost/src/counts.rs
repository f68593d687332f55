//! [`Counts`]: scalar operations by class.
//!
//! *Holds:* sums and products saturate, so that no nest of loops overflows.

use glisten_library::Cost;
use serde::{Serialize, Serializer, ser::SerializeStruct};

/// The scalar operations of a part of a program, by class.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Additions, products, comparisons, minima, maxima, conversions, selections.
    pub arithmetic: u64,
    /// Divisions, roots, exponentials, logarithms, trigonometry.
    pub special: u64,
    /// Texture lookups.
    pub lookups: u64,
    /// Decisions of branches and loops.
    pub branches: u64,
}

/// A class of operations: its name in tables, JSON and budgets, and its count.
pub type Class = (&'static str, fn(&Counts) -> u64);

/// The classes.
pub const CLASSES: &[Class] = &[
    ("arithmetic", |counts| counts.arithmetic),
    ("special", |counts| counts.special),
    ("lookups", |counts| counts.lookups),
    ("branches", |counts| counts.branches),
    ("weight", |counts| counts.weight()),
];

impl Counts {
    /// One decision.
    pub(super) const BRANCH: Self = Self { arithmetic: 0, special: 0, lookups: 0, branches: 1 };

    /// The sum.
    pub fn plus(self, other: Self) -> Self {
        Self {
            arithmetic: self.arithmetic.saturating_add(other.arithmetic),
            special: self.special.saturating_add(other.special),
            lookups: self.lookups.saturating_add(other.lookups),
            branches: self.branches.saturating_add(other.branches),
        }
    }

    /// The counts of a part that runs so many times.
    pub fn times(self, count: u64) -> Self {
        Self {
            arithmetic: self.arithmetic.saturating_mul(count),
            special: self.special.saturating_mul(count),
            lookups: self.lookups.saturating_mul(count),
            branches: self.branches.saturating_mul(count),
        }
    }

    /// The weight by which paths are compared: that of the library's catalogue.
    pub fn weight(&self) -> u64 {
        let special = self.special.saturating_mul(4);
        let lookups = self.lookups.saturating_mul(16);
        self.arithmetic.saturating_add(special).saturating_add(lookups).saturating_add(self.branches)
    }

    /// Whether nothing is counted.
    pub fn is_nothing(self) -> bool {
        self == Self::default()
    }
}

impl From<Cost> for Counts {
    fn from(cost: Cost) -> Self {
        Self {
            arithmetic: cost.arithmetic.into(),
            special: cost.special.into(),
            lookups: cost.texture.into(),
            branches: cost.branches.into(),
        }
    }
}

impl Serialize for Counts {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut object = serializer.serialize_struct("Counts", CLASSES.len())?;
        for (name, of) in CLASSES {
            object.serialize_field(name, &of(self))?;
        }
        object.end()
    }
}
