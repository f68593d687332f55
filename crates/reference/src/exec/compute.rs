//! Arithmetic, with one loop over the lanes for each instruction.

use super::code::Section;
use super::inst::{Compare, Derivative, Float1, Float2, Float3, FloatToInt, Inst, Int1, Int2, IntToFloat, Operand};
use super::registers::{Filled, Registers, blocks1, blocks2, blocks3, calls1, calls2, calls3, copy, map1, map2, map3};
use super::{DFDY_SIGN, LANES, noise};
use crate::domain::rules;
use crate::domain::{Block, Corner, Domain, Element, Integer, Lanes, Number, NumberBlock, Source};
use glisten_front::builtin::operations::BitFunction;
use glisten_front::builtin::operations::{DerivativeAxis, DerivativeControl};
use glisten_scene::picture::Interval;

type Float<D> = <D as Domain>::Float;

#[inline(always)]
fn constant<N: Number>(value: f64) -> N {
    N::from_f64(value)
}

/// An operation with a form for blocks.
macro_rules! each {
    ($out:expr, $a:expr, $operation:ident) => {
        blocks1(
            $out,
            $a,
            #[inline(always)]
            |a| a.$operation(),
            N::$operation,
        )
    };
    ($out:expr, $a:expr, $b:expr, $operation:ident) => {
        blocks2(
            $out,
            $a,
            $b,
            #[inline(always)]
            |a, b| a.$operation(b),
            N::$operation,
        )
    };
}

fn float1<N: Number>(op: Float1, out: &mut Lanes<N>, a: Source<'_, N>) -> Filled {
    match op {
        Float1::Neg => each!(out, a, neg),
        Float1::Abs => each!(out, a, abs),
        Float1::Sign => map1(out, a, N::sign),
        Float1::Floor => each!(out, a, floor),
        Float1::Ceil => map1(out, a, N::ceil),
        Float1::Trunc => map1(out, a, N::trunc),
        Float1::Round => map1(out, a, N::round),
        Float1::Fract => each!(out, a, fract),
        Float1::Sqrt => each!(out, a, sqrt),
        Float1::Inversesqrt => each!(out, a, inversesqrt),
        Float1::Exp => each!(out, a, exp),
        Float1::Log => each!(out, a, log),
        Float1::Exp2 => each!(out, a, exp2),
        Float1::Log2 => each!(out, a, log2),
        Float1::Sin => calls1(out, a, &N::sin),
        Float1::Cos => calls1(out, a, &N::cos),
        Float1::Tan => calls1(out, a, &N::tan),
        Float1::Asin => calls1(out, a, &N::asin),
        Float1::Acos => calls1(out, a, &N::acos),
        Float1::Atan => calls1(out, a, &N::atan),
        Float1::Sinh => each!(out, a, sinh),
        Float1::Cosh => each!(out, a, cosh),
        Float1::Tanh => each!(out, a, tanh),
        Float1::Asinh => each!(out, a, asinh),
        Float1::Acosh => each!(out, a, acosh),
        Float1::Atanh => each!(out, a, atanh),
        Float1::Radians => map1(out, a, N::radians),
        Float1::Degrees => map1(out, a, N::degrees),
    }
}

#[inline(always)]
fn float2<N: Number>(op: Float2, out: &mut Lanes<N>, a: Source<'_, N>, b: Source<'_, N>) -> Filled {
    match op {
        Float2::Add => each!(out, a, b, add),
        Float2::Sub => each!(out, a, b, sub),
        Float2::Mul => each!(out, a, b, mul),
        Float2::Div => each!(out, a, b, div),
        Float2::Min => each!(out, a, b, min),
        Float2::Max => each!(out, a, b, max),
        Float2::Mod => map2(out, a, b, N::modulo),
        Float2::Pow => each!(out, a, b, pow),
        Float2::Atan2 => calls2(out, a, b, &N::atan2),
        Float2::Step => blocks2(
            out,
            a,
            b,
            #[inline(always)]
            |edge, x| N::Block::select(&x.less(edge), &N::Block::splat(constant(0.0)), &N::Block::splat(constant(1.0))),
            |edge, x| N::select(x.less(edge), constant(0.0), constant(1.0)),
        ),
    }
}

fn float3<N: Number>(op: Float3, out: &mut Lanes<N>, a: Source<'_, N>, b: Source<'_, N>, c: Source<'_, N>) -> Filled {
    match op {
        Float3::Mix => blocks3(
            out,
            [a, b, c],
            #[inline(always)]
            |x, y, a| x.mix(y, a),
            N::mix,
        ),
        Float3::Clamp => blocks3(
            out,
            [a, b, c],
            #[inline(always)]
            |x, least, most| x.limited(least, most),
            N::limited,
        ),
        Float3::Smoothstep => map3(out, a, b, c, N::smoothstep),
        Float3::Fma => map3(out, a, b, c, N::fma),
    }
}

#[inline(always)]
fn compare<N: Number>(op: Compare, out: &mut Lanes<N::Int>, a: Source<'_, N>, b: Source<'_, N>) -> Filled {
    match op {
        Compare::Less => each!(out, a, b, less),
        Compare::LessEqual => each!(out, a, b, less_equal),
        Compare::Equal => each!(out, a, b, equal),
        Compare::NotEqual => map2(out, a, b, |a, b| a.equal(b).not()),
    }
}

fn int1<I: Integer>(op: Int1, out: &mut Lanes<I>, a: Source<'_, I>) -> Filled {
    match op {
        Int1::Neg => map1(out, a, I::neg),
        Int1::BitNot => map1(out, a, |a| a.lift1(|a| !a)),
        Int1::Not => map1(out, a, I::not),
        Int1::Bool => map1(out, a, |a| a.lift1(|a| u32::from(a != 0))),
        Int1::Abs => map1(out, a, |a| a.lift1(|a| (a as i32).wrapping_abs() as u32)),
        Int1::Sign => map1(out, a, |a| a.lift1(|a| (a as i32).signum() as u32)),
        Int1::Reverse => map1(out, a, |a| a.lift1(u32::reverse_bits)),
        Int1::Count => map1(out, a, |a| a.lift1(u32::count_ones)),
        Int1::Lowest => map1(out, a, |a| a.lift1(|a| BitFunction::Lowest.of(a, 0, 0, 0, false))),
        Int1::HighestSigned => map1(out, a, |a| a.lift1(|a| BitFunction::Highest.of(a, 0, 0, 0, true))),
        Int1::HighestUnsigned => map1(out, a, |a| a.lift1(|a| BitFunction::Highest.of(a, 0, 0, 0, false))),
    }
}

fn int2<I: Integer>(op: Int2, out: &mut Lanes<I>, a: Source<'_, I>, b: Source<'_, I>) -> Filled {
    match op {
        Int2::Add => map2(out, a, b, I::add),
        Int2::Sub => map2(out, a, b, I::sub),
        Int2::Mul => map2(out, a, b, I::mul),
        Int2::DivSigned => map2(out, a, b, I::div_signed),
        Int2::DivUnsigned => map2(out, a, b, I::div_unsigned),
        Int2::RemSigned => map2(out, a, b, I::rem_signed),
        Int2::RemUnsigned => map2(out, a, b, I::rem_unsigned),
        Int2::Shl => map2(out, a, b, I::shl),
        Int2::ShrSigned => map2(out, a, b, I::shr_signed),
        Int2::ShrUnsigned => map2(out, a, b, I::shr_unsigned),
        Int2::And => map2(out, a, b, I::and),
        Int2::Or => map2(out, a, b, I::or),
        Int2::Xor => map2(out, a, b, I::xor),
        Int2::Equal => map2(out, a, b, I::equal),
        Int2::NotEqual => map2(out, a, b, |a, b| a.equal(b).not()),
        Int2::LessSigned => map2(out, a, b, I::less_signed),
        Int2::LessUnsigned => map2(out, a, b, I::less_unsigned),
        Int2::LessEqualSigned => map2(out, a, b, I::less_equal_signed),
        Int2::LessEqualUnsigned => map2(out, a, b, I::less_equal_unsigned),
        Int2::MinSigned => map2(out, a, b, |a, b| b.less_signed(a).select(b, a)),
        Int2::MinUnsigned => map2(out, a, b, |a, b| b.less_unsigned(a).select(b, a)),
        Int2::MaxSigned => map2(out, a, b, |a, b| a.less_signed(b).select(b, a)),
        Int2::MaxUnsigned => map2(out, a, b, |a, b| a.less_unsigned(b).select(b, a)),
        Int2::ClampIndex => map2(out, a, b, I::clamp_index),
    }
}

/// A GPU may use one difference for the whole quad, so each may also be the other.
#[inline(always)]
fn either<N: Number>(a: N, b: N) -> (N, N) {
    (a.joined(b), b.joined(a))
}

/// A number is equal to itself, wherever it is in its interval, unless it is NaN.
fn compare_with_itself<N: Number>(op: Compare, out: &mut Lanes<N::Int>, a: Source<'_, N>) -> Filled {
    match op {
        Compare::Less => map1(out, a, |_| N::Int::from_bool(false)),
        Compare::LessEqual | Compare::Equal => map1(out, a, |a| a.isnan().not()),
        Compare::NotEqual => map1(out, a, N::isnan),
    }
}

/// The difference of two numbers, whose errors are at most `apart` from each other.
fn difference<N: Number>(a: N, b: N, apart: Option<f64>) -> N {
    let plain = a.sub(b);
    let Some(apart) = apart else { return plain };
    let value = a.value() - b.value();
    let (wide, near) = (plain.interval(), N::with_error(value, apart).interval());
    let (low, high) = (wide.low.max(near.low), wide.high.min(near.high));
    if low <= high { N::with_interval(value, Interval { low, high, ..wide }) } else { plain }
}

/// Differences in quads, separately for each row and column. With the noise of the numbers, the errors of two of them
/// are at most its sum apart.
fn derivative<N: Number>(op: Derivative, out: &mut Lanes<N>, a: Source<'_, N>, noise: Option<Source<'_, N>>) {
    for quad in (0..LANES).step_by(4) {
        let less = |one: usize, other: usize| {
            let (one, other) = (quad + one, quad + other);
            let apart = noise.map(|noise| noise.at(one).value() + noise.at(other).value());
            difference(a.at(one), a.at(other), apart)
        };
        let up = |upper: usize, lower: usize| if DFDY_SIGN < 0.0 { less(upper, lower) } else { less(lower, upper) };
        // One GPU has one of both, which it chooses below.
        let is_open = N::HAS_INTERVALS && op.control() != DerivativeControl::Fine;
        let of_quad = |a: N, b: N| if is_open { either(a, b) } else { (a, b) };
        let (top, bottom) = of_quad(less(1, 0), less(3, 2));
        let (left, right) = of_quad(up(0, 2), up(1, 3));
        let corner = match op.control() {
            DerivativeControl::Any => N::corner(),
            DerivativeControl::Fine => None,
            DerivativeControl::Coarse => Some(N::corner().unwrap_or(Corner { lower: false, right: false })),
        };
        let (top, bottom, left, right) = match corner {
            None => (top, bottom, left, right),
            Some(corner) => {
                let (row, column) = (if corner.lower { bottom } else { top }, if corner.right { right } else { left });
                (row, row, column, column)
            }
        };
        let differences = match op.axis() {
            DerivativeAxis::X => [top, top, bottom, bottom],
            DerivativeAxis::Y => [left, right, left, right],
            DerivativeAxis::Width => {
                let [top, bottom, left, right] = [top, bottom, left, right].map(N::abs);
                [top.add(left), top.add(right), bottom.add(left), bottom.add(right)]
            }
        };
        for (place, difference) in differences.into_iter().enumerate() {
            out.set(quad + place, difference);
        }
    }
}

impl<D: Domain> Registers<D> {
    /// [`Self::compute`] as a call, for operations that take far longer than the call.
    #[inline(never)]
    pub(super) fn compute_apart(&mut self, inst: &Inst, section: &Section) {
        self.compute(inst, section);
    }

    /// An instruction whose only effects are its results.
    #[inline(always)]
    pub(super) fn compute(&mut self, inst: &Inst, section: &Section) {
        match *inst {
            Inst::Float1 { op, dst, a } => self.write_float(dst, |this, out| float1(op, out, this.float(a))),
            // A number times itself is a square, for which an envelope is narrower.
            Inst::Float2 { op: Float2::Mul, dst, a, b } if D::HAS_INTERVALS && a == b => {
                self.write_float(dst, |this, out| {
                    blocks1(
                        out,
                        this.float(a),
                        #[inline(always)]
                        |a| a.square(),
                        Number::square,
                    )
                });
            }
            Inst::MulAdd { dst, a, b, c } if D::HAS_INTERVALS && a == b => self.write_float(dst, |this, out| {
                blocks2(
                    out,
                    this.float(a),
                    this.float(c),
                    #[inline(always)]
                    |a, c| a.square().add(c),
                    |a: Float<D>, c| a.square().add(c),
                )
            }),
            // The same number twice, for which an envelope is narrower: `a - a` and `a / a`.
            Inst::Float2 { op: op @ (Float2::Sub | Float2::Div), dst, a, b } if D::HAS_INTERVALS && a == b => {
                let same: fn(Float<D>) -> Float<D> =
                    if op == Float2::Sub { Number::less_itself } else { Number::over_itself };
                self.write_float(dst, |this, out| map1(out, this.float(a), same));
            }
            Inst::Float2 { op: Float2::Div, dst, a, b } if D::HAS_INTERVALS && !self.profile.exact_halves => {
                self.write_float(dst, |this, out| {
                    let (a, b) = (this.float(a), this.float(b));
                    let filled = float2(Float2::Div, out, a, b);
                    out.update(|lane, quotient| quotient.loosened(b.at(lane)));
                    filled
                });
            }
            Inst::Float2 { op: Float2::Mod, dst, a, b } if D::HAS_INTERVALS && !self.profile.exact_halves => {
                self.write_float(dst, |this, out| map2(out, this.float(a), this.float(b), Number::modulo_loosened));
            }
            Inst::Float3 { op: Float3::Smoothstep, dst, a, b, c } if D::HAS_INTERVALS && !self.profile.exact_halves => {
                self.write_float(dst, |this, out| {
                    map3(out, this.float(a), this.float(b), this.float(c), Number::smoothstep_loosened)
                });
            }
            Inst::Float2 { op, dst, a, b } => {
                self.write_float(dst, |this, out| float2(op, out, this.float(a), this.float(b)));
            }
            Inst::MulAdd { dst, a, b, c } => self.write_float(dst, |this, out| {
                blocks3(
                    out,
                    [a, b, c].map(|operand| this.float(operand)),
                    #[inline(always)]
                    |a, b, c| a.mul(b).add(c),
                    |a: Float<D>, b, c| a.mul(b).add(c),
                )
            }),
            Inst::Folded { dst, a, .. } if !(D::HAS_INTERVALS || Float::<D>::SUMS_BY_CHOICE) => {
                self.write_float(dst, |this, out| copy(out, this.float(a)));
            }
            Inst::Folded { sum, dst, a, list } => {
                self.write_float(dst, |this, out| folded(this, sum, a, section.list(list), out));
            }
            Inst::SumOfProducts { dst, list } => {
                self.write_float(dst, |this, out| sum_of_products(this, section.list(list), out));
            }
            Inst::Float3 { op, dst, a, b, c } => {
                self.write_float(dst, |this, out| float3(op, out, this.float(a), this.float(b), this.float(c)));
            }
            Inst::Compare { op, dst, a, b } => {
                self.write_int(dst, |this, out| match a == b {
                    true => compare_with_itself(op, out, this.float(a)),
                    false => compare(op, out, this.float(a), this.float(b)),
                });
            }
            Inst::FloatToInt { op, dst, a } => self.write_int(dst, |this, out| {
                let a = this.float(a);
                match op {
                    FloatToInt::Int => map1(out, a, Float::<D>::to_int),
                    FloatToInt::Uint => map1(out, a, Float::<D>::to_uint),
                    FloatToInt::Bool => map1(out, a, |a| a.equal(constant(0.0)).not()),
                    FloatToInt::IsNan => map1(out, a, Float::<D>::isnan),
                    FloatToInt::IsInf => map1(out, a, Float::<D>::isinf),
                    FloatToInt::Bits => map1(out, a, Float::<D>::to_bits),
                    FloatToInt::Half => map1(out, a, Float::<D>::to_half),
                }
            }),
            Inst::IntToFloat { op, dst, a } => self.write_float(dst, |this, out| match op {
                IntToFloat::Int => map1(out, this.int(a), Float::<D>::from_int),
                IntToFloat::Uint => map1(out, this.int(a), Float::<D>::from_uint),
                IntToFloat::Bits => map1(out, this.int(a), Float::<D>::from_bits),
                IntToFloat::Half => map1(out, this.int(a), Float::<D>::from_half),
            }),
            Inst::Int1 { op, dst, a } => self.write_int(dst, |this, out| int1(op, out, this.int(a))),
            Inst::Int2 { op, dst, a, b } if D::CHOOSES && op.undefined_name().is_some() => {
                self.write_int(dst, |this, out| {
                    let (a, b) = (this.int(a), this.int(b));
                    let filled = int2(op, out, a, b);
                    let is_undefined = |lane: usize| op.is_undefined(a.at(lane).interval(), b.at(lane).interval());
                    out.update(|lane, found| if is_undefined(lane) { D::undefined(found) } else { found });
                    filled
                });
            }
            Inst::Int2 { op, dst, a, b } => self.write_int(dst, |this, out| int2(op, out, this.int(a), this.int(b))),
            Inst::SelectFloat { dst, c, a, b } => {
                self.write_float(dst, |this, out| select(out, this.int(c), this.float(a), this.float(b)));
            }
            Inst::SelectInt { dst, c, a, b } => {
                self.write_int(dst, |this, out| map3(out, this.int(c), this.int(a), this.int(b), D::Int::select));
            }
            Inst::Composite { op, size, results, arguments } => {
                self.composite(op, size, section.list(results), section.list(arguments));
            }
            Inst::Noise { .. } if !D::HAS_INTERVALS => {}
            Inst::Noise { dst, of, divides, list } => {
                let roundings = if divides { rules::DIV.ulps() } else { 1.0 };
                self.write_float(dst, |this, out| {
                    noise::linear(this, this.float(of), roundings, section.list(list), out);
                    Filled::Lanes
                });
            }
            Inst::NoiseOf { .. } if !D::HAS_INTERVALS => {}
            Inst::NoiseOf { op, dst, of, list } => self.write_float(dst, |this, out| {
                noise::of(this, (op, this.float(of)), section.list(list), out);
                Filled::Lanes
            }),
            Inst::Derivative { op, dst, a, noise } => self.write_float(dst, |this, out| {
                // Infinity and envelopes have differences other than 0, even if all lanes are equal.
                let noise = noise.filter(|_| D::HAS_INTERVALS).map(|noise| this.float(noise));
                derivative(op, out, this.float(a), noise);
                if D::HAS_INTERVALS && !this.profile.limits_differences {
                    out.update(|_, number| Number::with_interval(number.value(), Interval::ALL));
                }
                Filled::Lanes
            }),
            Inst::MoveFloat { dst, a } => self.write_float(dst, |this, out| copy(out, this.float(a))),
            Inst::MoveInt { dst, a } => self.write_int(dst, |this, out| copy(out, this.int(a))),
            // `execute` handles the rest.
            _ => {}
        }
    }
}

/// Whether the result is one number for all lanes.
#[inline(always)]
fn is_same<D: Domain>(this: &Registers<D>, operands: &[Operand]) -> bool {
    operands.iter().all(|operand| matches!(this.float(*operand), Source::One(_)))
}

/// The hull of a chain's result and of the same chain with its constants combined.
fn folded<D: Domain>(
    this: &Registers<D>,
    sum: bool,
    written: Operand,
    chain: &[Operand],
    out: &mut Lanes<Float<D>>,
) -> Filled {
    let written = this.float(written);
    let combined = |lane: usize| {
        let terms = chain.iter().map(|term| this.float(*term).at(lane));
        terms.reduce(if sum { Number::add } else { Number::mul })
    };
    let both = |lane: usize, number: Float<D>| combined(lane).map_or(number, |other| number.joined(other));
    if let Source::One(number) = written {
        out.set(0, both(0, number));
        return Filled::One;
    }
    out.update(|lane, _| both(lane, written.at(lane)));
    Filled::Lanes
}

fn sum_of_products<D: Domain>(this: &Registers<D>, pairs: &[Operand], out: &mut Lanes<Float<D>>) -> Filled {
    let same = is_same(this, pairs);
    let count = pairs.len() / 2;
    let done = <Float<D> as Element>::Block::if_vectorized(
        #[inline(always)]
        || {
            for (place, out) in out.blocks_mut().iter_mut().enumerate().take(if same { 1 } else { usize::MAX }) {
                *out = NumberBlock::sum(
                    count,
                    #[inline(always)]
                    |product| match pairs.get(2 * product..2 * product + 2) {
                        Some([a, b]) if D::HAS_INTERVALS && a == b => this.float(*a).block(place).square(),
                        Some([a, b]) => this.float(*a).block(place).mul(&this.float(*b).block(place)),
                        _ => Block::splat(constant(0.0)),
                    },
                );
            }
        },
    );
    if done.is_none() {
        out.update(|lane, _| {
            Number::sum(pairs.chunks_exact(2).map(|pair| match pair {
                [a, b] if D::HAS_INTERVALS && a == b => this.float(*a).at(lane).square(),
                [a, b] => this.float(*a).at(lane).mul(this.float(*b).at(lane)),
                _ => constant(0.0),
            }))
        });
    }
    if same { Filled::One } else { Filled::Lanes }
}

/// `c ? a : b`
fn select<N: Number>(out: &mut Lanes<N>, c: Source<'_, N::Int>, a: Source<'_, N>, b: Source<'_, N>) -> Filled {
    if let Source::One(c) = c {
        return map2(out, a, b, |a, b| N::select(c, a, b));
    }
    let done = N::Block::if_vectorized(
        #[inline(always)]
        || {
            for (place, out) in out.blocks_mut().iter_mut().enumerate() {
                *out = N::Block::select(&c.block(place), &a.block(place), &b.block(place));
            }
            Filled::Lanes
        },
    );
    done.unwrap_or_else(|| calls3(out, c, a, b, &N::select))
}
