//! [`SimulatedBlock`]: eight numbers of a simulated GPU.
//!
//! *In:* operands of eight lanes. *Out:* the result of [`SimulatedFloat`]'s operation in each lane. *Holds:* the operation on
//! one number is the definition; a test compares both bit by bit. The GPU is read once for eight lanes, and what depends
//! on a lane does not branch.

use super::gpu::{Form, Function, Gpu};
use super::{SimulatedFloat, addends, functions, larger, smaller};
use crate::domain::rules;
use crate::domain::{Block, Element, NumberBlock, WIDTH, unit};

/// A number in each of eight lanes. Vectors of four never cross a cache line.
#[repr(align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SimulatedBlock([f64; WIDTH]);

impl Element for SimulatedFloat {
    const PLAIN: bool = true;
    type Block = SimulatedBlock;
}

impl Block<SimulatedFloat> for SimulatedBlock {
    #[inline(always)]
    fn splat(value: SimulatedFloat) -> Self {
        Self([value.0; WIDTH])
    }
    #[inline(always)]
    fn of(elements: &[SimulatedFloat; WIDTH]) -> Self {
        each(
            #[inline(always)]
            |lane| elements[lane].0,
        )
    }
    #[inline(always)]
    fn get(&self, lane: usize) -> SimulatedFloat {
        SimulatedFloat(self.0[lane % WIDTH])
    }
    #[inline(always)]
    fn set(&mut self, lane: usize, value: SimulatedFloat) {
        self.0[lane % WIDTH] = value.0;
    }
}

/// The block of a number for each lane.
#[inline(always)]
fn each(f: impl Fn(usize) -> f64) -> SimulatedBlock {
    let mut out = [0.0; WIDTH];
    for (lane, out) in out.iter_mut().enumerate() {
        *out = f(lane);
    }
    SimulatedBlock(out)
}

impl SimulatedBlock {
    /// The f32 numbers.
    #[inline(always)]
    fn read(&self, gpu: &Gpu) -> Self {
        if gpu.fuses { self.rounded(gpu) } else { *self }
    }

    #[inline(always)]
    fn rounded(&self, gpu: &Gpu) -> Self {
        Self(gpu.rounder().all(&self.0))
    }

    /// A sum. One of the terms may be a product that is not rounded.
    #[inline(always)]
    fn plus(&self, other: &Self, sign: f64) -> Self {
        let gpu = Gpu::current();
        let other = if gpu.fuses {
            let rounded = other.rounded(&gpu);
            each(
                #[inline(always)]
                |lane| addends(self.0[lane], other.0[lane], rounded.0[lane]),
            )
        } else {
            *other
        };
        each(
            #[inline(always)]
            |lane| self.0[lane] + sign * other.0[lane],
        )
        .rounded(&gpu)
    }

    /// A function whose result is an f32 if its operand is one.
    #[inline(always)]
    fn exactly(&self, f: impl Fn(f64) -> f64) -> Self {
        let x = self.read(&Gpu::current());
        each(
            #[inline(always)]
            |lane| f(x.0[lane]),
        )
    }

    /// The smaller or larger one.
    #[inline(always)]
    fn limit(&self, other: &Self, f: impl Fn(f64, f64) -> f64) -> Self {
        let gpu = Gpu::current();
        let (a, b) = (self.read(&gpu), other.read(&gpu));
        let chosen = each(
            #[inline(always)]
            |lane| f(a.0[lane], b.0[lane]),
        );
        if !gpu.passes_nan {
            return chosen;
        }
        each(
            #[inline(always)]
            |lane| if a.0[lane].is_nan() | b.0[lane].is_nan() { f64::NAN } else { chosen.0[lane] },
        )
    }

    /// Exact results with this GPU's error of a function of a number, whose rule allows a number of ULPs.
    #[inline(always)]
    fn with_error(&self, gpu: &Gpu, of: &Self, function: Function, ulps: f64) -> Self {
        let swing = Gpu::swing_of(function);
        if swing.is_none() {
            return self.rounded(gpu);
        }
        each(
            #[inline(always)]
            |lane| {
                functions::off(self.0[lane], ulps * rules::ulp(self.0[lane]), swing, functions::fraction(of.0[lane]))
            },
        )
        .rounded(gpu)
    }

    /// The answers of a comparison.
    #[inline(always)]
    fn compared(&self, other: &Self, f: impl Fn(f64, f64) -> bool) -> [u32; WIDTH] {
        let gpu = Gpu::current();
        let (a, b) = (self.read(&gpu), other.read(&gpu));
        let mut out = [0; WIDTH];
        for (lane, out) in out.iter_mut().enumerate() {
            *out = u32::from(f(a.0[lane], b.0[lane]));
        }
        out
    }
}

impl NumberBlock<SimulatedFloat> for SimulatedBlock {
    const OWN: bool = true;
    #[inline(always)]
    fn if_vectorized<R>(work: impl FnOnce() -> R) -> Option<R> {
        unit::if_wide(work)
    }
    #[inline(always)]
    fn vectorized<R>(work: impl FnOnce() -> R) -> R {
        unit::widest(work)
    }
    #[inline(always)]
    fn of_values(values: &[f64; WIDTH]) -> Self {
        Self(*values).rounded(&Gpu::current())
    }
    #[inline(always)]
    fn widen(&self) -> Self {
        *self
    }
    #[inline(always)]
    fn narrow(wide: &Self) -> Self {
        *wide
    }
    #[inline(always)]
    fn sum(count: usize, term: impl Fn(usize) -> Self) -> Self {
        let is_backward = Gpu::current().sums_backward;
        let at = |place: usize| if is_backward { count - 1 - place } else { place };
        let mut sum = if count == 0 { Self::default() } else { term(at(0)) };
        for place in 1..count {
            sum = sum.add(&term(at(place)));
        }
        sum
    }
    #[inline(always)]
    fn add(&self, other: &Self) -> Self {
        self.plus(other, 1.0)
    }
    #[inline(always)]
    fn sub(&self, other: &Self) -> Self {
        self.plus(other, -1.0)
    }
    #[inline(always)]
    fn mul(&self, other: &Self) -> Self {
        let gpu = Gpu::current();
        let (a, b) = (self.read(&gpu), other.read(&gpu));
        let exact = each(
            #[inline(always)]
            |lane| a.0[lane] * b.0[lane] + gpu.zero,
        );
        if gpu.fuses { exact } else { exact.rounded(&gpu) }
    }
    #[inline(always)]
    fn div(&self, other: &Self) -> Self {
        let gpu = Gpu::current();
        let (a, b) = (self.read(&gpu), other.read(&gpu));
        if gpu.typical && !Gpu::is_precise(Function::Divide) {
            return each(
                #[inline(always)]
                |lane| functions::by_reciprocal(a.0[lane], b.0[lane]),
            )
            .rounded(&gpu);
        }
        let exact = each(
            #[inline(always)]
            |lane| a.0[lane] / b.0[lane],
        );
        exact.with_error(&gpu, &b, Function::Divide, rules::DIV.ulps())
    }
    #[expect(clippy::redundant_closure, reason = "a function passed by name is not compiled for the vector unit")]
    #[inline(always)]
    fn min(&self, other: &Self) -> Self {
        self.limit(
            other,
            #[inline(always)]
            |a, b| smaller(a, b),
        )
    }
    #[expect(clippy::redundant_closure, reason = "a function passed by name is not compiled for the vector unit")]
    #[inline(always)]
    fn max(&self, other: &Self) -> Self {
        self.limit(
            other,
            #[inline(always)]
            |a, b| larger(a, b),
        )
    }
    #[inline(always)]
    fn neg(&self) -> Self {
        self.exactly(
            #[inline(always)]
            |x| -x,
        )
    }
    #[inline(always)]
    fn abs(&self) -> Self {
        self.exactly(
            #[inline(always)]
            |x| x.abs(),
        )
    }
    #[inline(always)]
    fn square(&self) -> Self {
        self.mul(self)
    }
    #[inline(always)]
    fn floor(&self) -> Self {
        self.exactly(
            #[inline(always)]
            |x| x.floor(),
        )
    }
    #[inline(always)]
    fn fract(&self) -> Self {
        self.sub(&self.floor())
    }
    #[inline(always)]
    fn sqrt(&self) -> Self {
        let gpu = Gpu::current();
        if Gpu::is_precise(Function::Sqrt) || gpu.has_second(Form::Inherited) {
            let x = self.read(&gpu);
            return each(
                #[inline(always)]
                |lane| x.0[lane].sqrt(),
            )
            .rounded(&gpu);
        }
        Self([1.0; WIDTH]).div(&self.inversesqrt())
    }
    #[inline(always)]
    fn inversesqrt(&self) -> Self {
        let gpu = Gpu::current();
        let x = self.read(&gpu);
        let exact = each(
            #[inline(always)]
            |lane| 1.0 / x.0[lane].sqrt(),
        );
        exact.with_error(&gpu, &x, Function::Inversesqrt, rules::INVERSESQRT.ulps())
    }
    #[inline(always)]
    fn unit_scale(&self) -> Self {
        self.inversesqrt()
    }
    #[inline(always)]
    fn scaled(&self, scale: &Self) -> Self {
        self.mul(scale)
    }
    #[inline(always)]
    fn limited(&self, least: &Self, most: &Self) -> Self {
        self.max(least).min(most)
    }
    #[inline(always)]
    fn cosine_at_most(&self) -> Self {
        *self
    }
    #[inline(always)]
    fn mix(&self, y: &Self, a: &Self) -> Self {
        if Gpu::current().has_second(Form::Mix) {
            return self.add(&y.sub(self).mul(a));
        }
        self.mul(&Self([1.0; WIDTH]).sub(a)).add(&y.mul(a))
    }
    #[inline(always)]
    fn less(&self, other: &Self) -> [u32; WIDTH] {
        self.compared(
            other,
            #[inline(always)]
            |a, b| a < b,
        )
    }
    #[inline(always)]
    fn less_equal(&self, other: &Self) -> [u32; WIDTH] {
        self.compared(
            other,
            #[inline(always)]
            |a, b| a <= b,
        )
    }
    #[inline(always)]
    fn equal(&self, other: &Self) -> [u32; WIDTH] {
        self.compared(
            other,
            #[inline(always)]
            |a, b| a == b,
        )
    }
    #[inline(always)]
    fn select(condition: &[u32; WIDTH], yes: &Self, no: &Self) -> Self {
        each(
            #[inline(always)]
            |lane| if condition[lane] != 0 { yes.0[lane] } else { no.0[lane] },
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::Number;

    type Two = fn(&SimulatedBlock, &SimulatedBlock) -> SimulatedBlock;
    type TwoOfOne = fn(SimulatedFloat, SimulatedFloat) -> SimulatedFloat;

    const OPERATIONS: &[(&str, Two, TwoOfOne)] = &[
        ("+", |a, b| a.add(b), |a, b| a.add(b)),
        ("-", |a, b| a.sub(b), |a, b| a.sub(b)),
        ("*", |a, b| a.mul(b), |a, b| a.mul(b)),
        ("* +", |a, b| a.mul(b).add(b), |a, b| a.mul(b).add(b)),
        ("+ *", |a, b| a.add(&a.mul(b)), |a, b| a.add(a.mul(b))),
        ("* *", |a, b| a.mul(b).mul(a), |a, b| a.mul(b).mul(a)),
        ("* - *", |a, b| a.mul(b).sub(&a.mul(a)), |a, b| a.mul(b).sub(a.mul(a))),
        ("/", |a, b| a.div(b), |a, b| a.div(b)),
        ("min", |a, b| a.min(b), |a, b| a.min(b)),
        ("max", |a, b| a.max(b), |a, b| a.max(b)),
        ("sqrt", |a, _| a.sqrt(), |a, _| a.sqrt()),
        ("inversesqrt", |a, _| a.inversesqrt(), |a, _| a.inversesqrt()),
        ("fract", |a, _| a.fract(), |a, _| a.fract()),
        ("neg", |a, b| a.mul(b).neg(), |a, b| a.mul(b).neg()),
        ("abs", |a, _| a.abs(), |a, _| a.abs()),
        ("mix", |a, b| a.mix(b, &b.square()), |a, b| a.mix(b, b.square())),
        ("clamp", |a, b| a.limited(b, &b.abs()), |a, b| a.limited(b, b.abs())),
        (
            "sum",
            |a, b| SimulatedBlock::sum(3, |place| [*a, *b, a.mul(b)][place]),
            |a, b| SimulatedFloat::sum([a, b, a.mul(b)].into_iter()),
        ),
        ("<", |a, b| SimulatedBlock::select(&a.less(b), a, b), |a, b| SimulatedFloat::select(a.less(b), a, b)),
    ];

    /// Numbers of many sizes, zeros, subnormal numbers, infinities and NaN.
    fn numbers() -> Vec<f64> {
        let special = [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e-40, -3e-45, 3.4e38, 16.0];
        let random = (0..245).map(|k| {
            let bits = glisten_scene::random::mixed(k);
            let unit = (bits >> 40) as f64 / (1_u64 << 24) as f64;
            f64::from(((unit * 2.0 - 1.0) * 2f64.powi((bits % 23) as i32 - 11)) as f32)
        });
        special.into_iter().chain(random).collect()
    }

    #[test]
    fn a_block_computes_what_each_number_does() {
        let numbers = numbers();
        for number in 0..64 {
            Gpu::of(5, number).enter();
            for (shift, chunk) in numbers.as_chunks::<WIDTH>().0.iter().enumerate() {
                let a: [_; WIDTH] = std::array::from_fn(|lane| SimulatedFloat::from_f64(chunk[lane]));
                let b: [_; WIDTH] = std::array::from_fn(|lane| {
                    SimulatedFloat::from_f64(numbers[(7 * shift + 3 * lane + 1) % numbers.len()])
                });
                for (name, of_blocks, of_one) in OPERATIONS {
                    let found = of_blocks(&SimulatedBlock::of(&a), &SimulatedBlock::of(&b));
                    for lane in 0..WIDTH {
                        let (found, expected) = (found.get(lane).0, of_one(a[lane], b[lane]).0);
                        let same = found == expected || found.is_nan() && expected.is_nan();
                        assert!(same, "{name} of {:?} and {:?}: {found} {expected}", a[lane], b[lane]);
                    }
                }
            }
        }
        Gpu::STRICT.enter();
    }
}
