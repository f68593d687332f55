//! [`Gpu`]: a GPU that conforms, by its choices among what the specifications leave open.
//!
//! *In:* a seed and a number. *Out:* the choices, the same for the same seed and number. *Holds:* a choice is a GPU's, not
//! an operation's: the same operation on the same numbers always has the same result, as in hardware. The first two
//! GPUs are drawn by no chance: number 0 rounds each operation to the nearest, number 1 as well but interpolates by
//! planes and flushes subnormals, as most drivers do, and stores 16-bit floats toward zero, as llvmpipe does. The first
//! [`Gpu::TYPICAL`] are as drivers are: their functions err by no more than drivers' do. Those of the others err by up to
//! what the rules allow; those of the first two of these as far as they may, up and down.

use super::levels::{Levels, Measure};
use super::rounding::{Rounder, Rounding};
use crate::domain::{Corner, FixedPoint, Profile};
use glisten_scene::random::{mixed, unit};
use std::cell::Cell;

/// The equation by which varyings are interpolated over a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planes {
    /// Weights of the vertices.
    Weights,
    /// A value at the window's corner and two slopes.
    FromCorner,
    /// The value at the first vertex and two slopes.
    FromVertex,
}

/// A simulated GPU.
#[derive(Clone, Copy, Debug)]
pub struct Gpu {
    seed: u64,
    pub(super) rounding: Rounding,
    /// How it stores 16-bit floats.
    stores: Rounding,
    pub(super) flushes: bool,
    /// Whether a product is added without being rounded.
    pub(super) fuses: bool,
    /// The zero that is added to each product: 0 if the sign of a product that is 0 is lost, else -0.
    pub(super) zero: f64,
    /// Whether sums of products begin with the last one.
    pub(super) sums_backward: bool,
    /// Whether `min` and `max` pass a NaN on.
    pub(super) passes_nan: bool,
    /// The row and the column of the quad whose derivatives are those of all four fragments, if they are coarse.
    pub(super) corner: Option<Corner>,
    pub(super) planes: Planes,
    /// The steps of window positions between which varyings are interpolated; none if they are floats.
    pub(super) positions: Option<FixedPoint>,
    /// The steps of filter weights; none if they are floats.
    pub(super) weights: Option<FixedPoint>,
    /// The level of detail of textures.
    pub(super) levels: Levels,
    /// Whether its functions err as those of drivers do, and not as far as the rules allow.
    pub(super) typical: bool,
    /// Whether its sine and cosine are those of llvmpipe, and whether products are fused in them.
    pub(super) sine: Option<bool>,
    /// A bit for each [`Form`].
    forms: u8,
    /// The error of every function, as a share of the allowed one, of a GPU that errs as far as it may; else 0.
    extreme: f64,
}

/// The error of such a GPU.
const EXTREME: f64 = 0.97;

/// A choice of its own of each GPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Choice {
    Rounding,
    Flush,
    Fuse,
    Sums,
    Nan,
    Coarse,
    Planes,
    Weights,
    Levels,
    Corner,
    Measure,
    Straight,
    QuadLevels,
    LevelCorner,
    Forms,
    Undefined,
    /// Of each [`Function`], from here on.
    Functions,
    WeightsDown = 1 << 16,
    LevelsDown,
    Positions,
    Stores,
    Zero,
}

/// A function with an error of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Function {
    Divide,
    Sqrt,
    Inversesqrt,
    Exp,
    Exp2,
    Log,
    Log2,
    Pow,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Sinh,
    Cosh,
    Tanh,
    Asinh,
    Acosh,
    Atanh,
    /// Of a point, which a driver rounds.
    PointSize,
}

/// An operation with two forms.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    /// Of a rule that allows two.
    Rule,
    /// Rounding from a half.
    Half,
    Mix,
    /// Of functions that inherit their precision: the formula, or the function with an error of its own.
    Inherited,
}

/// The error of a function.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Swing {
    /// The largest, as a share of the allowed one, -1 to 1; 0 if the function is computed as well as possible.
    size: f64,
    /// Where it begins to swing, 0 to 1.
    begin: f64,
    /// How often it swings.
    times: f64,
}

const FUNCTIONS: usize = Function::PointSize as usize + 1;

thread_local! {
    /// The GPU that computes on this thread.
    static CURRENT: Cell<Gpu> = const { Cell::new(Gpu::STRICT) };
    /// The errors of its functions.
    static SWINGS: [Cell<Swing>; FUNCTIONS] =
        const { [const { Cell::new(Swing { size: 0.0, begin: 0.0, times: 0.0 }) }; FUNCTIONS] };
}

impl Swing {
    /// Whether the function is computed as well as possible.
    #[inline(always)]
    pub(super) fn is_none(self) -> bool {
        self.size == 0.0
    }

    /// The error at a place between 0 and 1, as a share of the allowed one, -1 to 1. It swings like the error of a
    /// polynomial.
    #[inline(always)]
    pub(super) fn at(self, place: f64) -> f64 {
        let turn = place * self.times + self.begin;
        self.size * (1.0 - 4.0 * (turn - turn.floor() - 0.5).abs())
    }
}

impl Gpu {
    /// Rounds to the nearest, and has no other freedom.
    pub const STRICT: Self = Self {
        seed: 0,
        rounding: Rounding::Nearest,
        stores: Rounding::Nearest,
        flushes: false,
        fuses: false,
        zero: -0.0,
        sums_backward: false,
        passes_nan: false,
        corner: None,
        planes: Planes::Weights,
        positions: None,
        weights: None,
        levels: Levels::EXACT,
        typical: true,
        sine: None,
        forms: 0,
        extreme: 0.0,
    };

    /// The number of GPUs that are as drivers are. Those after them err as far as the rules allow.
    pub const TYPICAL: u32 = 16;
    const LAST_EXTREME: u32 = Self::TYPICAL + 1;

    /// The GPU of this number in the population of a seed.
    pub fn of(seed: u64, number: u32) -> Self {
        match number {
            0 => return Self::STRICT,
            1 => {
                let stores = Rounding::TowardZero;
                return Self { stores, flushes: true, planes: Planes::FromCorner, ..Self::STRICT };
            }
            _ => {}
        }
        let blank = Self { seed: mixed(seed ^ mixed(u64::from(number))) | 1, ..Self::STRICT };
        let typical = number < Self::TYPICAL;
        if let Self::TYPICAL | Self::LAST_EXTREME = number {
            return Self { extreme: if number == Self::TYPICAL { EXTREME } else { -EXTREME }, typical, ..blank };
        }
        let yes = |choice: Choice| blank.pick(choice, 2) == 1;
        Self {
            rounding: match blank.pick(Choice::Rounding, 8) {
                0..4 => Rounding::Nearest,
                4 => Rounding::TowardZero,
                _ => Rounding::Either,
            },
            stores: match blank.pick(Choice::Stores, 3) {
                0 => Rounding::Nearest,
                1 => Rounding::TowardZero,
                _ => Rounding::Either,
            },
            flushes: yes(Choice::Flush),
            fuses: yes(Choice::Fuse),
            zero: if yes(Choice::Zero) { 0.0 } else { -0.0 },
            sums_backward: yes(Choice::Sums),
            passes_nan: yes(Choice::Nan),
            corner: yes(Choice::Coarse).then(|| blank.corner(Choice::Corner)),
            planes: match blank.pick(Choice::Planes, 3) {
                0 => Planes::Weights,
                1 => Planes::FromCorner,
                _ => Planes::FromVertex,
            },
            weights: yes(Choice::Weights).then_some(FixedPoint { bits: 8, down: yes(Choice::WeightsDown) }),
            levels: blank.levels(),
            typical,
            forms: blank.pick(Choice::Forms, 256) as u8,
            ..blank
        }
    }

    /// How many GPUs compute as llvmpipe may do.
    pub const LLVMPIPES: u32 = 4;

    /// A GPU that computes as llvmpipe does, as far as that is known: it rounds to the nearest, flushes, divides, and its sine is
    /// a known polynomial. What depends on the processor and on the compiler are numbers of their own: whether the polynomial has
    /// fused products, whether constants of a chain are combined.
    #[must_use]
    pub fn llvmpipe(number: u32) -> Self {
        Self {
            stores: Rounding::TowardZero,
            flushes: true,
            planes: Planes::FromCorner,
            sine: Some(number & 1 == 0),
            forms: if number & 2 == 2 { 1 << Form::Rule as u8 } else { 0 },
            ..Self::STRICT
        }
    }

    /// The same GPU with what is known of a device, if it is one that is as drivers are.
    #[must_use]
    pub fn on(self, profile: &Profile) -> Self {
        if !self.typical {
            return self;
        }
        let bits = u32::from(profile.subpixel_bits);
        let positions = match self.pick(Choice::Positions, 4) {
            // The first GPUs are drawn by no chance.
            _ if self.is_strict() => None,
            0 => None,
            1 => Some(FixedPoint { bits: bits.max(8), down: false }),
            2 => Some(FixedPoint { bits, down: false }),
            _ => Some(FixedPoint { bits, down: true }),
        };
        Self {
            positions: positions.filter(|_| !profile.exact_positions),
            corner: self.corner.filter(|_| !profile.fine_derivatives),
            weights: self.weights.filter(|_| !profile.float_weights),
            levels: if profile.straight_levels { Levels::LLVMPIPE } else { self.levels },
            ..self
        }
    }

    /// A corner of the quad.
    fn corner(&self, choice: Choice) -> Corner {
        let bits = self.pick(choice, 4);
        Corner { lower: bits & 1 == 1, right: bits & 2 == 2 }
    }

    fn levels(&self) -> Levels {
        Levels {
            measure: match self.pick(Choice::Measure, 4) {
                0 => Measure::LongestAxis,
                1 => Measure::Sum,
                _ => Measure::Root,
            },
            straight: self.pick(Choice::Straight, 4) == 0,
            steps: match self.pick(Choice::Levels, 3) {
                0 => None,
                1 => Some(8),
                _ => Some(4),
            }
            .map(|bits| FixedPoint { bits, down: self.pick(Choice::LevelsDown, 2) == 1 }),
            corner: (self.pick(Choice::QuadLevels, 2) == 1).then(|| self.corner(Choice::LevelCorner)),
        }
    }

    /// Computes on this thread from now on.
    pub fn enter(self) {
        CURRENT.set(self);
        SWINGS.with(|swings| swings.iter().enumerate().for_each(|(function, swing)| swing.set(self.swing(function))));
    }

    /// Half of all GPUs compute a function as well as possible.
    fn swing(&self, function: usize) -> Swing {
        if self.is_extreme() {
            return Swing { size: self.extreme, begin: 0.5, times: 0.0 };
        }
        let bits = mixed(self.seed ^ mixed(Choice::Functions as u64 + function as u64));
        if self.is_strict() || bits & 1 == 0 {
            return Swing::default();
        }
        let [size, begin] = [mixed(bits ^ 1), mixed(bits ^ 2)].map(unit);
        Swing { size: 2.0 * size - 1.0, begin, times: (1 + (bits >> 1) % 8) as f64 }
    }

    /// The GPU that computes on this thread.
    #[inline(always)]
    pub(super) fn current() -> Self {
        CURRENT.get()
    }

    /// Whether it is the one without freedom.
    #[inline(always)]
    fn is_strict(&self) -> bool {
        self.seed == 0
    }

    /// Whether each function errs as far as it may, always to the same side.
    #[inline(always)]
    pub(super) fn is_extreme(&self) -> bool {
        self.extreme != 0.0
    }

    /// One of `count` choices.
    fn pick(&self, choice: Choice, count: u64) -> u64 {
        mixed(self.seed ^ mixed(choice as u64)) % count.max(1)
    }

    /// An integer that the language leaves undefined: the number that others define, 0, or the end of the range on either
    /// side.
    pub(super) fn undefined(&self, defined: u32) -> u32 {
        match self.pick(Choice::Undefined, 4) {
            _ if self.is_strict() => defined,
            0 => defined,
            1 => 0,
            2 => i32::MAX as u32,
            _ => i32::MIN as u32,
        }
    }

    /// Whether an operation has its second form.
    #[inline(always)]
    pub(super) fn has_second(&self, form: Form) -> bool {
        self.forms >> (form as u8) & 1 == 1
    }

    /// Whether the GPU of this thread computes a function as well as possible.
    #[inline(always)]
    pub(super) fn is_precise(function: Function) -> bool {
        Self::swing_of(function).is_none()
    }

    /// The error of a function of the GPU of this thread.
    #[inline(always)]
    pub(super) fn swing_of(function: Function) -> Swing {
        SWINGS.with(|swings| swings[function as usize].get())
    }

    /// How it rounds.
    #[inline(always)]
    pub(super) fn rounder(&self) -> Rounder {
        Rounder { rounding: self.rounding, seed: (self.seed >> 32) as u32, flushes: self.flushes }
    }

    /// The 16-bit float in which it stores a number.
    pub(super) fn halves(&self, exact: f64) -> f64 {
        Rounder { rounding: self.stores, ..self.rounder() }.half(exact)
    }

    /// The f32 to which it rounds.
    #[inline(always)]
    pub(super) fn rounded(&self, exact: f64) -> f64 {
        self.rounder().one(exact)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_gpu_rounds_to_a_neighbor() {
        let mut counts = [0; 3];
        for number in 0..64 {
            let gpu = Gpu::of(7, number);
            counts[gpu.rounding as usize] += 1;
            for place in 1..2000 {
                let exact = f64::from(place) * 0.000_7 - 0.5;
                let nearest = f64::from(exact as f32);
                let ulp = crate::domain::rules::ulp(exact);
                let found = gpu.rounded(exact);
                assert_eq!(found, f64::from(found as f32), "an f32");
                assert!((found - exact).abs() < ulp, "{exact} {found} {gpu:?}");
                assert!(gpu.rounding != Rounding::Nearest || found == nearest);
                assert!(gpu.rounding != Rounding::TowardZero || found.abs() <= exact.abs());
                assert_eq!(gpu.rounded(found), found, "an f32 stays");
            }
        }
        assert!(counts.iter().all(|count| *count > 2), "{counts:?}");
    }

    #[test]
    fn each_gpu_stores_a_16_bit_float_as_a_neighbor() {
        let mut counts = [0; 3];
        for number in 0..64 {
            let gpu = Gpu::of(7, number);
            counts[gpu.stores as usize] += 1;
            for exact in (1..2000).map(|place| f64::from(place) * 0.000_7 - 0.5).chain([1e-8, -1e-8, 65_510.0, 1e9]) {
                let nearest = half::f16::from_f64(exact);
                let found = gpu.halves(exact);
                let stored = half::f16::from_f64(found);
                assert_eq!(f64::from(stored), found, "a 16-bit float");
                assert!(stored.to_bits().abs_diff(nearest.to_bits()) % 0x8000 <= 1, "{exact} {found} {nearest}");
                assert!(gpu.stores != Rounding::Nearest || stored == nearest);
                assert!(gpu.stores != Rounding::TowardZero || found.abs() <= exact.abs());
                assert_eq!(gpu.halves(found), found, "a 16-bit float stays");
            }
        }
        assert!(counts.iter().all(|count| *count > 2), "{counts:?}");
    }

    #[test]
    fn errors_of_functions_fill_their_room() {
        let mut most = 0.0_f64;
        let mut precise = 0;
        for number in 2..66 {
            Gpu::of(1, number).enter();
            precise += u32::from(Gpu::is_precise(Function::Sin));
            let share = |k: i32| Gpu::swing_of(Function::Sin).at(f64::from(k) / 100.0).abs();
            let largest = (0..100).map(share).fold(0.0, f64::max);
            assert!(largest <= 1.0);
            most = most.max(largest);
        }
        Gpu::STRICT.enter();
        assert!(most > 0.8 && (16..48).contains(&precise), "{most} {precise}");
    }
}
