//! Where a driver is known to break its own specification.
//!
//! *In:* nothing. *Out:* [`KNOWN`], a row each, and [`Faults`], the set of those that an envelope admits.
//!
//! *Holds:* the strict envelope admits none. `verify` admits them only for pixels that the strict envelope leaves
//! outside, counts these apart, and can be told not to.

/// A way in which a driver is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Fault {
    /// `asin` and `acos` by a short polynomial.
    ArcFunctions,
    /// The level of detail by a crude logarithm.
    LevelOfDetail,
    /// `noperspective` varyings of triangles that are clipped along an edge of one x.
    ClippedNoperspective,
}

/// A row of [`KNOWN`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownFault {
    /// Which one.
    pub fault: Fault,
    /// Its name in reports.
    pub name: &'static str,
    /// The rule that is broken.
    pub rule: &'static str,
    /// How far the driver was found to go, and what the wider envelope admits.
    pub measured: &'static str,
    /// Where it applies.
    pub applies: &'static str,
}

/// All known faults, of Mesa 22.3.6's llvmpipe and lavapipe.
pub static KNOWN: &[KnownFault] = &[
    KnownFault {
        fault: Fault::ArcFunctions,
        name: "acos",
        rule: "Vulkan: Asin, Acos: inherited from atan2 and sqrt; WGSL: 6.8e-5",
        measured: "asin 3.9e-4, acos 1.6e-4 off",
        applies: "asin, acos of any argument",
    },
    KnownFault {
        fault: Fault::LevelOfDetail,
        name: "level_of_detail",
        rule: "OpenGL 3.2 3.8.11: the scale factor is at least the longest step along an axis",
        measured: "up to 0.043 off in levels",
        applies: "lookups of mipmapped textures by derivatives, with a trilinear filter",
    },
    KnownFault {
        fault: Fault::ClippedNoperspective,
        name: "clipped_noperspective",
        rule: "OpenGL 3.2 2.19.1: noperspective varyings are linear in the window",
        measured: "NaN, or wrong by the reciprocal of the difference of x",
        applies: "triangles clipped along an edge whose ends have nearly one x and different w",
    },
];

/// A set of faults.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Faults(u8);

impl Faults {
    /// The strict envelope.
    pub const NONE: Self = Self(0);

    /// All that are known.
    pub fn all() -> Self {
        KNOWN.iter().fold(Self::NONE, |set, known| set.with(known.fault))
    }

    /// This one alone.
    pub fn only(fault: Fault) -> Self {
        Self::NONE.with(fault)
    }

    fn with(self, fault: Fault) -> Self {
        Self(self.0 | 1 << fault as u8)
    }

    /// Whether the fault is admitted.
    #[inline(always)]
    pub fn admits(self, fault: Fault) -> bool {
        self.0 >> fault as u8 & 1 == 1
    }
}

/// How far `asin` and `acos` may be off where that is admitted.
pub const ARC_FUNCTIONS: f64 = 4.0e-4;
/// How far, in levels, a level of detail.
pub const LEVEL_OF_DETAIL: f64 = 0.05;
