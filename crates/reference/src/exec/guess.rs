//! [`Guess`]: numbers in the place of what the language leaves undefined.
//!
//! *In:* code of the form [`Form::Guessed`](super::Form::Guessed), and numbers. *Out:* results with those numbers wherever an
//! operation is undefined for its operands or a variable was never written; the places where that happened. *Holds:* a
//! picture that is the same with any numbers does not depend on them. Operations that every GPU defines alike are no such
//! places: `x / 0.0` is an infinity.

use super::code::{Code, Inner, Section};
use super::inst::{
    Class, Compare, Composite, Float1, Float2, Float3, FloatToInt, Inst, Lookup, Operand, TextureCall, Use,
};
use super::machine::Machine;
use super::{LANES, Mask};
use crate::domain::{Domain, Integer, Number, Source};
use crate::texture;
use glisten_front::hir::Stage;
use glisten_front::source::Span;
use std::sync::Mutex;

/// The numbers of a guess.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Numbers {
    /// Of floats, if `step` is 0.
    pub float: f64,
    /// How far a float may be from `float`: results and lanes get numbers between them. 0: all get the same.
    pub step: f64,
    /// Of integers, as bits.
    pub int: u32,
    /// Whether `pow` of a negative base is that of its magnitude, as where a driver multiplies, and all else is as the domain defines it.
    pub magnitudes: bool,
}

impl Numbers {
    /// The float of a result in a lane. Neighbors differ by the golden ratio, so that no two texels are alike.
    fn float(&self, lane: usize, result: usize) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        self.float + self.step * ((lane * 7 + result * 3) as f64 * GOLDEN).fract()
    }
}

/// How something is undefined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum UndefinedKind {
    /// An operand that an operation has no result for.
    Domain,
    /// A division by 0 that has no result, an infinity included.
    Division,
    /// Something that is not there: a value, an element, a texel, a neighbor; or a NaN that is compared.
    Absent,
}

/// An undefined thing.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct UndefinedThing {
    /// The thing, in words.
    pub text: &'static str,
    /// How it is undefined.
    pub kind: UndefinedKind,
}

/// A place where something undefined was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The expression, or the declaration of a variable.
    pub span: Span,
    /// The undefined thing.
    pub what: UndefinedThing,
}

/// An operation that has no result for an operand.
const fn domain(text: &'static str) -> UndefinedThing {
    UndefinedThing { text, kind: UndefinedKind::Domain }
}

/// A division by 0.
const fn division(text: &'static str) -> UndefinedThing {
    UndefinedThing { text, kind: UndefinedKind::Division }
}

/// Something that is not there.
const fn absent(text: &'static str) -> UndefinedThing {
    UndefinedThing { text, kind: UndefinedKind::Absent }
}

/// Numbers in the place of undefined ones; the places are collected.
#[derive(Debug, Default)]
pub struct Guess {
    /// The numbers; `None`: those that the domain defines.
    numbers: Option<Numbers>,
    /// The only place; all if there is none.
    only: Option<Place>,
    found: Mutex<Vec<Place>>,
}

/// The name that a variable without a value has in reports.
pub(super) const UNWRITTEN: UndefinedThing = absent("a variable or a result that was never written");
const NO_PLACE: UndefinedThing = absent("a lookup at a coordinate that is no finite number");
const SPLIT_LOOKUP: UndefinedThing = absent("a lookup by derivatives that only a part of the quad runs");
/// GLSL 4.60 §4.7.1: operations on a NaN need not know that it is one. Drivers differ in `!=`.
const NAN_COMPARED: UndefinedThing = absent("a comparison with NaN");
/// GLSL 1.50 §4.1.4: a NaN need not be there. A driver may fold `x * 0.0`, and `isnan` with it.
const NAN_ASKED: UndefinedThing = absent("`isnan` of a NaN");
const SPLIT_DERIVATIVE: UndefinedThing = absent("a derivative that only a part of the quad runs");

impl Guess {
    /// A guess, at one place or at all.
    pub fn new(numbers: Option<Numbers>, only: Option<Place>) -> Self {
        Self { numbers, only, found: Mutex::default() }
    }

    /// The places where something undefined was computed, in the order of the text.
    pub fn places(&self) -> Vec<Place> {
        let mut places = self.found.lock().map(|found| found.clone()).unwrap_or_default();
        places.sort_by_key(|place| (place.span, place.what));
        places
    }

    fn applies(&self, place: Place) -> bool {
        self.only.is_none_or(|only| only == place)
    }

    /// The numbers of a variable that was never written.
    pub(super) fn unwritten(&self, span: Span) -> Option<Numbers> {
        self.numbers.filter(|_| self.applies(Place { span, what: UNWRITTEN }))
    }

    fn note(&self, place: Place) {
        if let Ok(mut found) = self.found.lock()
            && !found.contains(&place)
        {
            found.push(place);
        }
    }
}

impl Code {
    /// The variables that may be read before anything is written to them, in code of the form
    /// [`Form::Guessed`](super::Form::Guessed).
    pub fn unwritten(&self) -> Vec<Place> {
        self.inner.unwritten.iter().map(|span| Place { span: *span, what: UNWRITTEN }).collect()
    }

    /// Whether an instruction may be undefined although its envelope does not say so: a texel that is fetched, an element
    /// at an index, a variable, a derivative in a branch or a loop.
    pub fn hides_undefined(&self) -> bool {
        let insts = &self.inner.main.insts;
        let branches = insts.iter().any(|inst| {
            matches!(
                inst,
                Inst::Arm { .. }
                    | Inst::LoopTest { .. }
                    | Inst::LoopBack { .. }
                    | Inst::CaseMask { .. }
                    | Inst::Discard
                    | Inst::Watch { .. }
            )
        });
        let hides = |inst: &Inst| match inst {
            Inst::LoadFloat { .. } | Inst::LoadInt { .. } => true,
            Inst::Derivative { .. } => branches,
            Inst::Texture { call } => self.inner.textures.get(*call as usize).is_some_and(|call| match call.lookup {
                Lookup::Fetch => true,
                Lookup::Implicit | Lookup::QueryLod => branches,
                _ => false,
            }),
            _ => false,
        };
        !self.inner.unwritten.is_empty() || insts.iter().any(hides)
    }
}

impl<D: Domain> Machine<D> {
    /// The lanes in which an instruction that is about to run is undefined, and why.
    pub(super) fn undefined(
        &self,
        inst: &Inst,
        section: &Section,
        inner: &Inner,
        mask: u64,
    ) -> Option<(UndefinedThing, u64)> {
        self.guess.as_ref()?;
        let float = |operand| self.registers.float(operand);
        let int = |operand| self.registers.int(operand);
        let (what, lanes) = match *inst {
            Inst::Float1 { op, a, .. } => {
                let (what, test) = of_one(op)?;
                (what, lanes1(float(a), mask, test))
            }
            Inst::Float2 { op, a, b, .. } => {
                let (what, test) = of_two(op)?;
                let (a, b) = (float(a), float(b));
                (what, lanes_where(mask, |lane| test(a.at(lane).value(), b.at(lane).value())))
            }
            Inst::Float3 { op: Float3::Clamp, b, c, .. } => {
                let (b, c) = (float(b), float(c));
                (
                    domain("`clamp` with a minimum above the maximum"),
                    lanes_where(mask, |lane| b.at(lane).value() > c.at(lane).value()),
                )
            }
            Inst::Float3 { op: Float3::Smoothstep, a, b, .. } => {
                let (a, b) = (float(a), float(b));
                let lanes = lanes_where(mask, |lane| a.at(lane).value() >= b.at(lane).value());
                (domain("`smoothstep` with edges that are equal or in the wrong order"), lanes)
            }
            Inst::Composite { op: Composite::Normalize, arguments, .. } => {
                let all: Vec<_> = section.list(arguments).iter().map(|operand| float(*operand)).collect();
                let is_zero = |lane: usize| all.iter().all(|one| one.at(lane).value() == 0.0);
                (division("`normalize` of a vector of length 0"), lanes_where(mask, is_zero))
            }
            Inst::FloatToInt { op: FloatToInt::Int, a, .. } => {
                let fits = |x: f64| x > -2_147_483_649.0 && x < 2_147_483_648.0;
                (domain("`int` of a number that no `int` has"), lanes1(float(a), mask, |x| !fits(x)))
            }
            Inst::FloatToInt { op: FloatToInt::Uint, a, .. } => {
                let fits = |x: f64| x > -1.0 && x < 4_294_967_296.0;
                (domain("`uint` of a number that no `uint` has"), lanes1(float(a), mask, |x| !fits(x)))
            }
            Inst::FloatToInt { op: FloatToInt::IsNan, a, .. } => (NAN_ASKED, lanes1(float(a), mask, f64::is_nan)),
            Inst::Compare { a, b, .. } => {
                let (a, b) = (float(a), float(b));
                let has_nan = |lane: usize| a.at(lane).value().is_nan() || b.at(lane).value().is_nan();
                (NAN_COMPARED, lanes_where(mask, has_nan))
            }
            Inst::Int2 { op, a, b, .. } => {
                op.undefined_name()?;
                let (a, b) = (int(a), int(b));
                let what = if op.divides() {
                    division("a division of integers by 0, or of negative ones")
                } else {
                    domain("a shift by too much")
                };
                (what, lanes_where(mask, |lane| op.is_undefined(a.at(lane).interval(), b.at(lane).interval())))
            }
            Inst::LoadFloat { table, index, .. } | Inst::LoadInt { table, index, .. } => {
                let (index, count) = (int(index), section.list(table).len() as i64);
                let beyond = |lane: usize| !(0..count).contains(&i64::from(index.at(lane).bits() as i32));
                (absent("an index outside of the array"), lanes_where(mask, beyond))
            }
            Inst::Texture { call } => {
                let call = inner.textures.get(call as usize)?;
                match call.lookup {
                    Lookup::Fetch => {
                        let lanes = lanes_where(mask, |lane| self.is_beyond(call, lane));
                        (absent("`texelFetch` outside of the texture"), lanes)
                    }
                    Lookup::Implicit | Lookup::QueryLod
                        if inner.stage == Stage::Fragment && self.without_a_place(call, mask) == 0 =>
                    {
                        let split = self.split(mask);
                        (SPLIT_LOOKUP, lanes_where(split, |lane| self.needs_level(call, lane)))
                    }
                    Lookup::Lod | Lookup::Grad | Lookup::Gather | Lookup::Implicit | Lookup::QueryLod => {
                        (NO_PLACE, self.without_a_place(call, mask))
                    }
                    _ => return None,
                }
            }
            Inst::Derivative { .. } => (SPLIT_DERIVATIVE, self.split(mask)),
            _ => return None,
        };
        (lanes != 0).then_some((what, lanes))
    }

    /// The lanes whose quad has lanes elsewhere in the program, such as fragments that are discarded: these derivatives are undefined
    /// (GLSL 1.50 §8.7, §8.8). An operand that is not chosen runs in no lane (§5.9).
    fn split(&self, mask: u64) -> u64 {
        let mask = mask & self.watched;
        let elsewhere = self.whole & !mask;
        let split = (0..LANES).step_by(4).map(|first| 0xf << first).filter(|quad| elsewhere & quad != 0);
        mask & split.fold(0, |lanes, quad: u64| lanes | quad)
    }

    /// The lanes in which a coordinate of a lookup is no finite number: no texel is there (GLSL 1.50 §8.7).
    fn without_a_place(&self, call: &TextureCall, mask: u64) -> u64 {
        let is_finite = |lane, operand: &Operand| self.registers.float(*operand).at(lane).value().is_finite();
        lanes_where(mask, |lane| !call.coordinate.iter().all(|operand| is_finite(lane, operand)))
    }

    /// Whether a lookup depends on the level of detail.
    fn needs_level(&self, call: &TextureCall, lane: usize) -> bool {
        let slot = self.registers.int(call.sampler).at(lane).bits() as usize;
        let texture = self.textures.get(slot).and_then(Option::as_deref);
        texture.is_some_and(|texture| {
            texture.filter.uses_levels() && texture.levels.len() > 1 || texture.sampling.has_two_filters(texture.filter)
        })
    }

    /// Whether a texel that a lane fetches is not in the texture.
    fn is_beyond(&self, call: &TextureCall, lane: usize) -> bool {
        let at = |operand: &Operand| i64::from(self.registers.int(*operand).at(lane).bits() as i32);
        let slot = self.registers.int(call.sampler).at(lane).bits() as usize;
        // A texture that is missing or incomplete is (0, 0, 0, 1).
        let Some(texture) = self.textures.get(slot).and_then(Option::as_deref) else { return false };
        // A multisample texture has samples in place of levels.
        let is_multisample = call.kind.dim == glisten_front::hir::SamplerDim::Multisample;
        let samples = 0..texture.levels.len() as i64;
        if is_multisample && call.level.as_ref().is_some_and(|sample| !samples.contains(&at(sample))) {
            return true;
        }
        let level = call.level.as_ref().filter(|_| !is_multisample);
        let size = texture::size(texture, call.kind, level.map_or(0, |level| at(level) as i32));
        let offset = |axis: usize| call.offset.get(axis).map_or(0, at);
        let mut places = call.coordinate.iter().zip(size).enumerate();
        places.any(|(axis, (operand, size))| !(0..i64::from(size)).contains(&(at(operand) + offset(axis))))
    }

    /// Before an instruction runs that is undefined: the powers of magnitudes, if it is `pow` and these are the guess.
    pub(super) fn note_powers(&mut self, inst: &Inst) {
        let is_wanted =
            self.guess.as_ref().is_some_and(|guess| guess.numbers.is_some_and(|numbers| numbers.magnitudes));
        self.powers = match *inst {
            Inst::Float2 { op: Float2::Pow, a, b, .. } if is_wanted => {
                let (base, exponent) = (self.registers.float(a), self.registers.float(b));
                let power = |lane| base.at(lane).value().abs().powf(exponent.at(lane).value());
                Some((0..LANES).map(power).collect())
            }
            _ => None,
        };
    }

    /// Replaces the results of an instruction that has just run in the lanes in which it is undefined.
    pub(super) fn put_guess(
        &mut self,
        inst: &Inst,
        section: &Section,
        place: usize,
        (what, lanes): (UndefinedThing, u64),
    ) {
        let Some(guess) = self.guess.clone() else { return };
        let place = Place { span: section.spans.get(place).copied().unwrap_or_default(), what };
        guess.note(place);
        let Some(numbers) = guess.numbers.filter(|_| guess.applies(place)) else { return };
        let powers = self.powers.take();
        if numbers.magnitudes && powers.is_none() {
            return;
        }
        let is_replaced = |lane: usize| lanes >> lane & 1 == 1;
        let power = |lane: usize| powers.as_ref().and_then(|powers| powers.get(lane)).copied();
        for (result, (class, operand)) in self.operands(inst, section, Use::Write).into_iter().enumerate() {
            match class {
                Class::Float => {
                    let lanes = self.registers.floats.register(operand).spread();
                    let float = |lane| D::Float::from_f64(power(lane).unwrap_or_else(|| numbers.float(lane, result)));
                    lanes.update(|lane, old| if is_replaced(lane) { float(lane) } else { old });
                }
                Class::Int => {
                    let lanes = self.registers.ints.register(operand).spread();
                    let int = match inst {
                        // The two kinds differ for some numbers, so that a later comparison does not undo an earlier one.
                        Inst::Compare { op: Compare::Equal | Compare::NotEqual, .. } => {
                            D::Int::from_bool(numbers.int & 1 == 1)
                        }
                        Inst::Compare { .. } | Inst::FloatToInt { op: FloatToInt::IsNan, .. } => {
                            D::Int::from_bool(numbers.int & 2 == 2)
                        }
                        _ => D::Int::from_bits(numbers.int),
                    };
                    lanes.update(|lane, old| if is_replaced(lane) { int } else { old });
                }
            }
        }
    }

    /// The registers that an instruction reads, or those that it writes.
    pub(super) fn operands(&self, inst: &Inst, section: &Section, wanted: Use) -> Vec<(Class, Operand)> {
        let mut found = Vec::new();
        let mut copy = *inst;
        let mut note = |class, using, operand: &mut Operand| {
            if using == wanted {
                found.push((class, *operand));
            }
        };
        copy.visit(&mut note);
        if let Inst::Texture { call } = inst
            && let Some(call) = self.code.inner.textures.get(*call as usize)
        {
            call.clone().visit(&mut note);
        }
        for (class, _, list) in inst.lists().into_iter().flatten().filter(|(_, using, _)| *using == wanted) {
            found.extend(section.list(list).iter().map(|operand| (class, *operand)));
        }
        found
    }
}

/// The lanes of a mask in which a test holds.
fn lanes_where(mask: u64, test: impl Fn(usize) -> bool) -> u64 {
    Mask(mask).lanes().filter(|lane| test(*lane)).fold(0, |lanes, lane| lanes | 1 << (lane % LANES))
}

fn lanes1<N: Number>(a: Source<'_, N>, mask: u64, test: impl Fn(f64) -> bool) -> u64 {
    match a {
        Source::One(a) => {
            if test(a.value()) {
                mask
            } else {
                0
            }
        }
        Source::Lanes(_) => lanes_where(mask, |lane| test(a.at(lane).value())),
    }
}

/// The undefined case of a function of one number, and a test of the operand for it.
type OfOne = (UndefinedThing, fn(f64) -> bool);
/// The undefined case of a function of two numbers, with its test.
type OfTwo = (UndefinedThing, fn(f64, f64) -> bool);

/// For which operand a function is undefined (GLSL 1.50 §8.1, §8.2).
fn of_one(op: Float1) -> Option<OfOne> {
    Some(match op {
        Float1::Sqrt => (domain("`sqrt` of a negative number"), |x| x < 0.0),
        Float1::Inversesqrt => (domain("`inversesqrt` of 0 or less"), |x| x <= 0.0),
        Float1::Log => (domain("`log` of 0 or less"), |x| x <= 0.0),
        Float1::Log2 => (domain("`log2` of 0 or less"), |x| x <= 0.0),
        Float1::Asin => (domain("`asin` of a number beyond 1"), |x| x.abs() > 1.0),
        Float1::Acos => (domain("`acos` of a number beyond 1"), |x| x.abs() > 1.0),
        Float1::Acosh => (domain("`acosh` of a number below 1"), |x| x < 1.0),
        Float1::Atanh => (domain("`atanh` of 1 or more"), |x| x.abs() >= 1.0),
        _ => return None,
    })
}

/// For which operands a function of two is undefined (GLSL 1.50 §8.1 to §8.3).
fn of_two(op: Float2) -> Option<OfTwo> {
    Some(match op {
        Float2::Pow => (domain("`pow` of a negative number, or of 0 with an exponent of 0 or less"), |x, y| {
            x < 0.0 || x == 0.0 && y <= 0.0
        }),
        Float2::Atan2 => (domain("`atan` of (0, 0)"), |y, x| y == 0.0 && x == 0.0),
        Float2::Div => (division("0.0 / 0.0"), |a, b| a == 0.0 && b == 0.0),
        Float2::Mod => (division("`mod` by 0"), |_, y| y == 0.0),
        _ => return None,
    })
}
