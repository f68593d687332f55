//! Compares blocks with the scalar operations, lane by lane.

use super::EnvelopeBlock;
use super::operations::Answers;
use crate::domain::envelope::{EnvelopeFloat, EnvelopeInt};
use crate::domain::rules::FLUSH;
use crate::domain::{Block, Integer, Number, NumberBlock, WIDTH};

/// Random numbers from a seed, the same in every run.
struct Random(u64);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    /// An f32 of any size, often one that needs special treatment by a rule.
    fn end(&mut self) -> f64 {
        const APART: [f64; 16] = [
            0.0,
            1.0,
            0.5,
            2.0,
            4096.0,
            FLUSH,
            1e-40f32 as f64,
            1.0 / FLUSH,
            f32::MAX as f64,
            f64::INFINITY,
            0.75,
            1.5,
            3e19f32 as f64,
            2e-19f32 as f64,
            32.0,
            127.5,
        ];
        let size = match self.below(6) {
            0 => APART[self.below(APART.len())],
            1 => (self.unit() * 9.0).floor(),
            2 => self.unit(),
            3 => (self.unit() * 40.0 - 20.0).exp2(),
            4 => (self.unit() * 250.0 - 125.0).exp2(),
            _ => self.unit() * 10.0,
        };
        let size = f64::from(size as f32);
        if self.unit() < 0.3 { -size } else { size }
    }

    fn number(&mut self) -> EnvelopeFloat {
        let (a, b) = (self.end(), self.end());
        let near = f64::from((a * (1.0 + self.unit() * 1e-6)) as f32);
        let (low, high) = match self.below(4) {
            0 => (a, a),
            1 => (a.min(near), a.max(near)),
            2 => (a.abs().min(b.abs()), a.abs().max(b.abs())),
            _ => (a.min(b), a.max(b)),
        };
        let value = match self.below(20) {
            0 => f64::NAN,
            1 => self.end(),
            _ if low.is_infinite() || high.is_infinite() => self.end(),
            _ => low + (high - low) * self.unit(),
        };
        if self.below(30) == 0 {
            return EnvelopeFloat::anything(value);
        }
        EnvelopeFloat { value, low, high, may_be_nan: self.below(15) == 0 }
    }

    fn block(&mut self) -> EnvelopeBlock {
        let mut block = EnvelopeBlock::default();
        // Whole blocks of lanes that are not special are the important case.
        let tame = self.below(2) == 0;
        for lane in 0..WIDTH {
            let mut number = self.number();
            while tame && !(number.high < 1e10 && number.low > 1e-10 && !number.may_be_nan) {
                number = self.number();
            }
            block.set(lane, number);
        }
        block
    }

    fn answers(&mut self) -> Answers {
        std::array::from_fn(|_| match self.below(4) {
            0 => EnvelopeInt::from_bool(false),
            1 => EnvelopeInt::from_bool(true),
            undecided => EnvelopeInt::undecided(undecided == 2),
        })
    }
}

/// Whether the bounds are equal, and the values too, including the sign of a zero.
fn same(a: EnvelopeFloat, b: EnvelopeFloat) -> bool {
    let values = a.value.to_bits() == b.value.to_bits() || a.value.is_nan() && b.value.is_nan();
    values && a.low == b.low && a.high == b.high && a.may_be_nan == b.may_be_nan
}

#[track_caller]
fn assert_lanes(name: &str, found: &EnvelopeBlock, exact: impl Fn(usize) -> EnvelopeFloat, of: &[EnvelopeBlock]) {
    for lane in 0..WIDTH {
        let (found, exact) = (found.get(lane), exact(lane));
        let operands: Vec<EnvelopeFloat> = of.iter().map(|block| block.get(lane)).collect();
        assert!(same(found, exact), "{name} of {operands:?}:\n{found:?}, not\n{exact:?}");
    }
}

type Unary = (&'static str, fn(&EnvelopeBlock) -> EnvelopeBlock, fn(EnvelopeFloat) -> EnvelopeFloat);
type Binary = (
    &'static str,
    fn(&EnvelopeBlock, &EnvelopeBlock) -> EnvelopeBlock,
    fn(EnvelopeFloat, EnvelopeFloat) -> EnvelopeFloat,
);
type Answer =
    (&'static str, fn(&EnvelopeBlock, &EnvelopeBlock) -> Answers, fn(EnvelopeFloat, EnvelopeFloat) -> EnvelopeInt);

macro_rules! pairs {
    ($($name:ident),*) => { &[$((stringify!($name), <EnvelopeBlock as NumberBlock<EnvelopeFloat>>::$name, <EnvelopeFloat as Number>::$name)),*] };
}

const UNARY: &[Unary] = pairs!(
    neg,
    abs,
    square,
    floor,
    fract,
    sqrt,
    inversesqrt,
    exp,
    exp2,
    log,
    log2,
    sinh,
    cosh,
    tanh,
    asinh,
    acosh,
    atanh,
    cosine_at_most,
    unit_scale
);
const BINARY: &[Binary] = pairs!(add, sub, mul, div, min, max, pow, scaled);
const ANSWERS: &[Answer] = pairs!(less, less_equal, equal);

#[test]
fn blocks_are_their_lanes() {
    let mut random = Random(1);
    let mut block = EnvelopeBlock::default();
    let numbers: [EnvelopeFloat; WIDTH] = std::array::from_fn(|_| random.number());
    for (lane, number) in numbers.iter().enumerate() {
        block.set(lane, *number);
    }
    assert_lanes("set", &block, |lane| numbers[lane], &[]);
    assert_lanes("of", &EnvelopeBlock::of(&numbers), |lane| numbers[lane], &[]);
    assert_lanes("splat", &EnvelopeBlock::splat(numbers[3]), |_| numbers[3], &[]);
}

#[test]
fn functions_of_one_block_are_those_of_its_lanes() {
    let mut random = Random(2);
    for _ in 0..20_000 {
        let a = random.block();
        for (name, block, exact) in UNARY {
            assert_lanes(name, &block(&a), |lane| exact(a.get(lane)), &[a]);
        }
    }
}

#[test]
fn functions_of_two_blocks_are_those_of_their_lanes() {
    let mut random = Random(3);
    for _ in 0..30_000 {
        let (a, b) = (random.block(), random.block());
        for (name, block, exact) in BINARY {
            assert_lanes(name, &block(&a, &b), |lane| exact(a.get(lane), b.get(lane)), &[a, b]);
        }
        for (name, block, exact) in ANSWERS {
            let found = block(&a, &b);
            for (lane, found) in found.iter().enumerate() {
                let (a, b) = (a.get(lane), b.get(lane));
                assert_eq!(*found, exact(a, b), "{name} of {a:?}, {b:?}");
            }
        }
    }
}

#[test]
fn functions_of_three_blocks_are_those_of_their_lanes() {
    let mut random = Random(4);
    for _ in 0..20_000 {
        let of = [random.block(), random.block(), random.block()];
        let [a, b, c] = of;
        assert_lanes("mix", &a.mix(&b, &c), |lane| a.get(lane).mix(b.get(lane), c.get(lane)), &of);
        let condition = random.answers();
        let chosen = |lane: usize| EnvelopeFloat::select(condition[lane], a.get(lane), b.get(lane));
        assert_lanes("select", &EnvelopeBlock::select(&condition, &a, &b), chosen, &of);
        let mask = (random.unit() * 256.0) as u8;
        let replaced = |lane: usize| if mask >> lane & 1 == 1 { b.get(lane) } else { a.get(lane) };
        assert_lanes("replaced", &a.replaced(&b, mask), replaced, &of);
        for count in 0..=3 {
            let sum = <EnvelopeBlock as NumberBlock<_>>::sum(count, |place| of[place]);
            let terms = |lane: usize| of.iter().take(count).map(move |term| term.get(lane));
            assert_lanes("sum", &sum, |lane| EnvelopeFloat::sum(terms(lane)), &of);
        }
    }
}
