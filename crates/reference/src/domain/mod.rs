//! Domains: the representations of `float` and `int` while a shader runs on the CPU.
//!
//! *In:* f32 values of literals, uniforms and attributes. *Out:* the results of each operation of GLSL 1.50 (§5, §8).
//! One executor serves every domain; a domain only defines what one number is and what one operation does.
//!
//! | domain | a `float` is | an operation |
//! | --- | --- | --- |
//! | [`F64`] | an f64 | f64's: the reference |
//! | [`F32`] | an f32 | rounds once; a built-in function is computed in f64 and rounded once: a strict GPU |
//! | [`Envelope`] | an f64 and the interval of a GPU's values | yields the hull of what [`rules`] allow |
//! | [`Shadow`] | an f32 and an f64 side by side | is done in both, which shows the error of f32 |
//! | [`Simulated`] | an f32 | has the error that one conforming GPU, drawn by chance, makes |
//! | `Stepwise` | an f32 | rounds once; formulas round each step: a GPU, and the f32 side of `Shadow` |
//! | `Exact` | a number of 192 bits | rounds once: the reference for the reference (feature `stability`) |
//!
//! Registers store numbers in [`Lanes`], blocks of eight; a domain may define its own operations on [`NumberBlock`]s.
//!
//! *Holds:* every operation is total: nothing panics, whatever the bits. What GLSL leaves undefined is defined here,
//! in the documentation of the operation. Comparisons yield [`Integer`]s, so that a domain may leave a condition
//! undecided ([`Integer::is_decided`]); the executor asks only where the condition determines what runs.

#[cfg(any(test, feature = "stability"))]
mod big;
mod envelope;
pub mod faults;
pub mod fitted;
mod integer;
mod lanes;
pub mod limits;
mod number;
mod plain;
mod profile;
pub mod rules;
mod shadow;
mod simulated;
#[cfg(any(test, feature = "stability"))]
mod stepwise;
mod unit;

#[cfg(any(test, feature = "stability"))]
pub use big::{BITS as EXACT_BITS, Big};
pub use envelope::{EnvelopeBlock, EnvelopeFloat, EnvelopeInt};
#[cfg(test)]
pub(crate) use envelope::{binary, unary};
pub(crate) use envelope::{evaluate, take_redone};
pub use integer::Integer;
pub use lanes::{Block, Element, LANES, Lanes, Source, WIDTH};
pub use number::{Answers, Corner, ErrorPart, Number, NumberBlock};
pub use profile::Profile;
pub use shadow::{ShadowFloat, ShadowInt, Shadowed, rounded};
pub use simulated::{Gpu, Planes, Simulated, SimulatedFloat};
#[cfg(any(test, feature = "stability"))]
pub use stepwise::StepFloat;

/// A pair of number types.
pub trait Domain: Copy + Send + Sync + std::fmt::Debug + 'static {
    /// The `float`.
    type Float: Number<Int = Self::Int>;
    /// The `int`, `uint` (as bits) and `bool` (0 or 1).
    type Int: Integer;
    /// `f64`, `f32`, `envelope`
    const NAME: &'static str;
    /// Whether conditions may be undecided, because conforming GPUs may disagree.
    const HAS_INTERVALS: bool = <Self::Float as Number>::HAS_INTERVALS;

    /// Whether what the language leaves undefined of integers is a GPU's choice.
    const CHOOSES: bool = false;
    /// The result of an operation on integers that the language leaves undefined (GLSL 1.50 §5.9), given the one that
    /// [`Integer`] defines.
    #[inline(always)]
    fn undefined(defined: Self::Int) -> Self::Int {
        defined
    }
    /// Computes as this GPU on this thread from now on, in the domain of simulated GPUs.
    #[inline(always)]
    fn enter(gpu: Gpu) {
        let _ = gpu;
    }
    /// The equation by which varyings are interpolated.
    #[inline(always)]
    fn planes() -> Planes {
        Planes::Weights
    }
    /// The steps of window positions between which varyings are interpolated; none if they are the domain's numbers.
    #[inline(always)]
    fn positions() -> Option<FixedPoint> {
        None
    }
    /// The steps of the weights of linear filtering; none if they are the domain's numbers.
    #[inline(always)]
    fn weights() -> Option<FixedPoint> {
        None
    }
    /// The 16-bit float in which a framebuffer stores a number: the nearest one, or the other neighbor (OpenGL 3.2 §2.1.2).
    #[inline(always)]
    fn stored_half(exact: f64) -> f64 {
        f64::from(half::f16::from_f64(exact))
    }
    /// The error of a point's size, as a share of the allowed one, -1 to 1.
    #[inline(always)]
    fn point_size_share() -> f64 {
        0.0
    }
    /// A level of detail from the two steps in texels to the neighboring pixels: the logarithm of the longer one (OpenGL
    /// 3.2 §3.8.11).
    #[inline(always)]
    fn level(steps: [[f64; 3]; 2]) -> f64 {
        longest(steps)
    }
    /// A level of detail, bias included, with the steps that it has.
    #[inline(always)]
    fn stepped_level(level: f64) -> f64 {
        level
    }
    /// The row and the column of the quad whose steps make the level of detail of all four fragments; none if each has its
    /// own.
    #[inline(always)]
    fn level_corner() -> Option<Corner> {
        None
    }
}

/// A number with a few bits of fraction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FixedPoint {
    /// The bits of the fraction.
    pub bits: u32,
    /// Whether what is between two steps becomes the lower one, not the nearer one.
    pub down: bool,
}

impl FixedPoint {
    /// The step that a number becomes.
    #[inline(always)]
    pub fn nearest(self, number: f64) -> f64 {
        let steps = f64::from(1_u32 << self.bits.min(24));
        let scaled = number * steps;
        (if self.down { scaled.floor() } else { scaled.round() }) / steps
    }
}

/// The logarithm of the longer one of two steps. Minus infinity if nothing changes.
pub(crate) fn longest(steps: [[f64; 3]; 2]) -> f64 {
    let [x, y] = steps.map(|step| step.iter().map(|change| change * change).sum::<f64>().sqrt());
    x.max(y).log2()
}

/// The reference: IEEE f64.
#[derive(Clone, Copy, Debug)]
pub struct F64;

/// A strict GPU: IEEE f32, with one rounding per operation or built-in function.
#[derive(Clone, Copy, Debug)]
pub struct F32;

/// f64 with the interval of values that a conforming f32 GPU may have.
#[derive(Clone, Copy, Debug)]
pub struct Envelope;

impl Domain for F64 {
    type Float = f64;
    type Int = u32;
    const NAME: &'static str = "f64";
}

impl Domain for F32 {
    type Float = f32;
    type Int = u32;
    const NAME: &'static str = "f32";
}

impl Domain for Envelope {
    type Float = EnvelopeFloat;
    type Int = EnvelopeInt;
    const NAME: &'static str = "envelope";
    const CHOOSES: bool = true;

    fn undefined(defined: EnvelopeInt) -> EnvelopeInt {
        EnvelopeInt::unknown(defined.bits)
    }
}

/// f32 and f64 side by side.
#[derive(Clone, Copy, Debug)]
pub struct Shadow;

impl Domain for Shadow {
    type Float = ShadowFloat;
    type Int = ShadowInt;
    const NAME: &'static str = "shadow";
}

/// Numbers of 192 bits, against which f64 is checked.
#[cfg(any(test, feature = "stability"))]
#[derive(Clone, Copy, Debug)]
pub struct Exact;

#[cfg(any(test, feature = "stability"))]
impl Domain for Exact {
    type Float = Big;
    type Int = u32;
    const NAME: &'static str = "exact";
}

/// The f32 side of [`Shadow`] alone.
#[cfg(any(test, feature = "stability"))]
#[derive(Clone, Copy, Debug)]
pub struct Stepwise;

#[cfg(any(test, feature = "stability"))]
impl Domain for Stepwise {
    type Float = StepFloat;
    type Int = u32;
    const NAME: &'static str = "stepwise";
}
