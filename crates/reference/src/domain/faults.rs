//! The cases in which a driver is known to violate its specification.
//!
//! *In:* nothing. *Out:* [`KNOWN`], with a row for each fault, and [`Faults`], the set of those that an envelope
//! excuses.
//!
//! *Holds:* the strict envelope excuses none. `verify` excuses them only for pixels that are outside the strict
//! envelope, counts these pixels separately, and has an option against it.

/// A known fault of a driver.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// It computes `noperspective` varyings incorrectly for triangles that are clipped along an edge of constant x.
    ClippedNoperspective,
    /// It ends the loops of fragments after [`MOST_ROUNDS`] rounds of all of them together.
    CutLoops,
}

/// The rounds after which llvmpipe ends loops (`LP_MAX_TGSI_LOOP_ITERATIONS`).
pub const MOST_ROUNDS: u64 = 65_535;

/// A row of [`KNOWN`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownFault {
    /// The fault.
    pub fault: Fault,
    /// Its name in reports.
    pub name: &'static str,
    /// The rule that it breaks.
    pub rule: &'static str,
    /// The largest measured error, and what the wider envelope excuses.
    pub measured: &'static str,
    /// The cases to which it applies.
    pub applies: &'static str,
}

/// All known faults of Mesa 22.3.6's llvmpipe and lavapipe.
pub static KNOWN: &[KnownFault] = &[
    KnownFault {
        fault: Fault::ClippedNoperspective,
        name: "clipped_noperspective",
        rule: "OpenGL 3.2 2.19.1: noperspective varyings are linear in the window",
        measured: "NaN, or wrong by the reciprocal of the difference of x",
        applies: "triangles clipped along an edge whose ends have nearly one x and different w",
    },
    KnownFault {
        fault: Fault::CutLoops,
        name: "cut_loops",
        rule: "GLSL 1.50 6.3: a loop runs until its condition is false",
        measured: "the state after 65,535 rounds",
        applies: "fragments whose loops run more rounds than that together",
    },
];

/// A set of faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Faults(u8);

impl Faults {
    /// No faults: the strict envelope.
    pub const NONE: Self = Self(0);

    /// All known faults.
    pub fn all() -> Self {
        KNOWN.iter().fold(Self::NONE, |set, known| set.with(known.fault))
    }

    /// Only this fault.
    pub fn only(fault: Fault) -> Self {
        Self::NONE.with(fault)
    }

    fn with(self, fault: Fault) -> Self {
        Self(self.0 | 1 << fault as u8)
    }

    /// Whether the fault is excused.
    #[inline(always)]
    pub fn excuses(self, fault: Fault) -> bool {
        self.0 >> fault as u8 & 1 == 1
    }
}
