//! Arithmetic: one loop over the lanes an instruction.

use super::code::Section;
use super::inst::{Compare, Derivative, Float1, Float2, Float3, FloatToInt, Inst, Int1, Int2, IntToFloat, Operand};
use super::registers::{Filled, Registers, Source, map1, map2, map3};
use super::{DFDY_SIGN, LANES};
use crate::cpu::domain::faults::{self, Fault};
use crate::cpu::domain::{Domain, Integer, Number};

type Float<D> = <D as Domain>::Float;

#[inline(always)]
fn constant<N: Number>(value: f64) -> N {
    N::from_f64(value)
}

/// A product with what is no float, rounded once.
#[inline(always)]
fn scaled<N: Number>(x: N, factor: f64) -> N {
    N::narrow(x.widen().mul(constant(factor)))
}

fn float1<N: Number>(op: Float1, out: &mut [N; LANES], a: Source<'_, N>) -> Filled {
    match op {
        Float1::Neg => map1(out, a, N::neg),
        Float1::Abs => map1(out, a, N::abs),
        Float1::Sign => map1(out, a, N::sign),
        Float1::Floor => map1(out, a, N::floor),
        Float1::Ceil => map1(out, a, N::ceil),
        Float1::Trunc => map1(out, a, N::trunc),
        Float1::Round => map1(out, a, N::round),
        Float1::Fract => map1(out, a, N::fract),
        Float1::Sqrt => map1(out, a, N::sqrt),
        Float1::Inversesqrt => map1(out, a, N::inversesqrt),
        Float1::Exp => map1(out, a, N::exp),
        Float1::Log => map1(out, a, N::log),
        Float1::Exp2 => map1(out, a, N::exp2),
        Float1::Log2 => map1(out, a, N::log2),
        Float1::Sin => map1(out, a, N::sin),
        Float1::Cos => map1(out, a, N::cos),
        Float1::Tan => map1(out, a, N::tan),
        Float1::Asin => map1(out, a, N::asin),
        Float1::Acos => map1(out, a, N::acos),
        Float1::Atan => map1(out, a, N::atan),
        Float1::Sinh => map1(out, a, N::sinh),
        Float1::Cosh => map1(out, a, N::cosh),
        Float1::Tanh => map1(out, a, N::tanh),
        Float1::Asinh => map1(out, a, N::asinh),
        Float1::Acosh => map1(out, a, N::acosh),
        Float1::Atanh => map1(out, a, N::atanh),
        Float1::Radians => map1(out, a, |x| scaled(x, std::f64::consts::PI / 180.0)),
        Float1::Degrees => map1(out, a, |x| scaled(x, 180.0 / std::f64::consts::PI)),
    }
}

#[inline(always)]
fn float2<N: Number>(op: Float2, out: &mut [N; LANES], a: Source<'_, N>, b: Source<'_, N>) -> Filled {
    match op {
        Float2::Add => map2(out, a, b, N::add),
        Float2::Sub => map2(out, a, b, N::sub),
        Float2::Mul => map2(out, a, b, N::mul),
        Float2::Div => map2(out, a, b, N::div),
        Float2::Min => map2(out, a, b, N::min),
        Float2::Max => map2(out, a, b, N::max),
        Float2::Mod => map2(out, a, b, N::modulo),
        Float2::Pow => map2(out, a, b, N::pow),
        Float2::Atan2 => map2(out, a, b, N::atan2),
        Float2::Step => map2(out, a, b, |edge, x| N::select(x.less(edge), constant(0.0), constant(1.0))),
    }
}

fn float3<N: Number>(op: Float3, out: &mut [N; LANES], a: Source<'_, N>, b: Source<'_, N>, c: Source<'_, N>) -> Filled {
    match op {
        Float3::Mix => map3(out, a, b, c, N::mix),
        Float3::Clamp => map3(out, a, b, c, |x, least, most| x.max(least).min(most)),
        Float3::Smoothstep => map3(out, a, b, c, N::smoothstep),
    }
}

#[inline(always)]
fn compare<N: Number>(op: Compare, out: &mut [N::Int; LANES], a: Source<'_, N>, b: Source<'_, N>) -> Filled {
    match op {
        Compare::Less => map2(out, a, b, N::less),
        Compare::LessEqual => map2(out, a, b, N::less_equal),
        Compare::Equal => map2(out, a, b, N::equal),
        Compare::NotEqual => map2(out, a, b, |a, b| a.equal(b).not()),
    }
}

fn int1<I: Integer>(op: Int1, out: &mut [I; LANES], a: Source<'_, I>) -> Filled {
    match op {
        Int1::Neg => map1(out, a, I::neg),
        Int1::BitNot => map1(out, a, |a| a.lift1(|a| !a)),
        Int1::Not => map1(out, a, I::not),
        Int1::Bool => map1(out, a, |a| a.lift1(|a| u32::from(a != 0))),
        Int1::Abs => map1(out, a, |a| a.lift1(|a| (a as i32).wrapping_abs() as u32)),
        Int1::Sign => map1(out, a, |a| a.lift1(|a| (a as i32).signum() as u32)),
    }
}

#[inline(always)]
fn int2<I: Integer>(op: Int2, out: &mut [I; LANES], a: Source<'_, I>, b: Source<'_, I>) -> Filled {
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

/// A GPU may take one difference for the whole quad: each may be the other, too.
#[inline(always)]
fn either<N: Number>(a: N, b: N) -> (N, N) {
    (a.joined(b), b.joined(a))
}

/// Whatever the number is within its interval, it equals itself, if it is one.
fn compare_with_itself<N: Number>(op: Compare, out: &mut [N::Int; LANES], a: Source<'_, N>) -> Filled {
    match op {
        Compare::Less => map1(out, a, |_| N::Int::from_bool(false)),
        Compare::LessEqual | Compare::Equal => map1(out, a, |a| a.isnan().not()),
        Compare::NotEqual => map1(out, a, N::isnan),
    }
}

/// Differences in quads: each row and column of a quad by itself.
fn derivative<N: Number>(op: Derivative, out: &mut [N; LANES], a: &[N; LANES]) {
    let up = |upper: N, lower: N| if DFDY_SIGN < 0.0 { upper.sub(lower) } else { lower.sub(upper) };
    for (out, a) in out.chunks_exact_mut(4).zip(a.chunks_exact(4)) {
        if let ([o0, o1, o2, o3], [a0, a1, a2, a3]) = (out, a) {
            let (top, bottom) = either(a1.sub(*a0), a3.sub(*a2));
            let (left, right) = either(up(*a0, *a2), up(*a1, *a3));
            match op {
                Derivative::X => (*o0, *o1, *o2, *o3) = (top, top, bottom, bottom),
                Derivative::Y => (*o0, *o1, *o2, *o3) = (left, right, left, right),
                Derivative::Width => {
                    let [top, bottom, left, right] = [top, bottom, left, right].map(N::abs);
                    (*o0, *o1, *o2, *o3) = (top.add(left), top.add(right), bottom.add(left), bottom.add(right));
                }
            }
        }
    }
}

impl<D: Domain> Registers<D> {
    /// An instruction without effects but on its results.
    #[inline(always)]
    pub(super) fn compute(&mut self, inst: &Inst, section: &Section) {
        match *inst {
            Inst::Float1 { op, dst, a } => self.write_float(dst, |this, out| {
                let filled = float1(op, out, this.float(a));
                if D::OPEN && matches!(op, Float1::Asin | Float1::Acos) && this.faults.admits(Fault::ArcFunctions) {
                    out.iter_mut().for_each(|lane| *lane = lane.widened(faults::ARC_FUNCTIONS));
                }
                filled
            }),
            // One number twice is a square, which an envelope can make more of.
            Inst::Float2 { op: Float2::Mul, dst, a, b } if D::OPEN && a == b => {
                self.write_float(dst, |this, out| map1(out, this.float(a), Number::square));
            }
            Inst::MulAdd { dst, a, b, c } if D::OPEN && a == b => self.write_float(dst, |this, out| {
                map2(out, this.float(a), this.float(c), |a: Float<D>, c| a.square().add(c))
            }),
            Inst::Float2 { op, dst, a, b } => {
                self.write_float(dst, |this, out| float2(op, out, this.float(a), this.float(b)));
            }
            Inst::MulAdd { dst, a, b, c } => self.write_float(dst, |this, out| {
                map3(out, this.float(a), this.float(b), this.float(c), |a: Float<D>, b, c| a.mul(b).add(c))
            }),
            Inst::SumOfProducts { dst, list } if D::OPEN => {
                self.write_float(dst, |this, out| sum_in_any_order(this, section.list(list), out));
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
                }
            }),
            Inst::IntToFloat { op, dst, a } => self.write_float(dst, |this, out| match op {
                IntToFloat::Int => map1(out, this.int(a), Float::<D>::from_int),
                IntToFloat::Uint => map1(out, this.int(a), Float::<D>::from_uint),
            }),
            Inst::Int1 { op, dst, a } => self.write_int(dst, |this, out| int1(op, out, this.int(a))),
            Inst::Int2 { op, dst, a, b } => self.write_int(dst, |this, out| int2(op, out, this.int(a), this.int(b))),
            Inst::SelectFloat { dst, c, a, b } => self
                .write_float(dst, |this, out| map3(out, this.int(c), this.float(a), this.float(b), Float::<D>::select)),
            Inst::SelectInt { dst, c, a, b } => {
                self.write_int(dst, |this, out| map3(out, this.int(c), this.int(a), this.int(b), D::Int::select));
            }
            Inst::Composite { op, size, results, arguments } => {
                self.composite(op, size, section.list(results), section.list(arguments));
            }
            Inst::Derivative { op, dst, a } => self.write_float(dst, |this, out| {
                match this.float(a) {
                    Source::Lanes(a) => derivative(op, out, a),
                    // Infinity and envelopes have differences other than 0.
                    Source::One(a) => derivative(op, out, &[a; LANES]),
                }
                Filled::Lanes
            }),
            Inst::MoveFloat { dst, a } => self.write_float(dst, |this, out| map1(out, this.float(a), |a| a)),
            Inst::MoveInt { dst, a } => self.write_int(dst, |this, out| map1(out, this.int(a), |a| a)),
            // The rest is `execute`'s.
            _ => {}
        }
    }
}

/// Whether a number in all lanes comes of these.
#[inline(always)]
fn is_same<D: Domain>(this: &Registers<D>, operands: &[Operand]) -> bool {
    operands.iter().all(|operand| matches!(this.float(*operand), Source::One(_)))
}

/// Lane by lane, for a domain that sums in any order.
fn sum_in_any_order<D: Domain>(this: &Registers<D>, pairs: &[Operand], out: &mut [Float<D>; LANES]) -> Filled {
    let same = is_same(this, pairs);
    for (lane, out) in out.iter_mut().enumerate().take(if same { 1 } else { LANES }) {
        let products = pairs.chunks_exact(2).filter_map(|pair| match pair {
            [a, b] if a == b => Some(this.float(*a).at(lane).square()),
            [a, b] => Some(this.float(*a).at(lane).mul(this.float(*b).at(lane))),
            _ => None,
        });
        *out = Number::sum(products);
    }
    if same { Filled::One } else { Filled::Lanes }
}

/// Eight lanes at a time, so that the sum stays in vector registers.
fn sum_of_products<D: Domain>(this: &Registers<D>, pairs: &[Operand], out: &mut [Float<D>; LANES]) -> Filled {
    const STEP: usize = 8;
    let chunk = |operand: Operand, start: usize| -> [Float<D>; STEP] {
        match this.float(operand) {
            Source::Lanes(lanes) => {
                let lanes = &lanes[start..start + STEP];
                std::array::from_fn(|lane| lanes[lane])
            }
            Source::One(value) => [value; STEP],
        }
    };
    let same = is_same(this, pairs);
    for start in (0..if same { STEP } else { LANES }).step_by(STEP) {
        let mut sum = [Float::<D>::default(); STEP];
        for (place, pair) in pairs.chunks_exact(2).enumerate() {
            if let [a, b] = pair {
                let (a, b) = (chunk(*a, start), chunk(*b, start));
                if place == 0 {
                    sum = std::array::from_fn(|lane| a[lane].mul(b[lane]));
                } else {
                    sum = std::array::from_fn(|lane| sum[lane].add(a[lane].mul(b[lane])));
                }
            }
        }
        out[start..start + STEP].copy_from_slice(&sum);
    }
    if same { Filled::One } else { Filled::Lanes }
}
