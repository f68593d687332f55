//! Built-in functions of whole vectors and matrices (§8.4, §8.5): computed in the domain's wide type, rounded once.
//!
//! *In:* registers of the arguments, component by component. *Out:* registers of the results.
//!
//! The formulas are those of the specification. A vector without length normalizes to NaN, and the inverse of a
//! singular matrix has infinities or NaN. GLSL leaves both undefined.
//!
//! *Holds:* a formula is compiled once per domain, for any number of components. Three components of plain numbers
//! are compiled separately, since loops over components would cost more than their bodies.

use super::inst::{Composite, Operand};
use super::registers::{Filled, Register, Registers};
use crate::domain::{Block, Domain, Element, LANES, Number, NumberBlock, Source, WIDTH};
use glisten_scene::picture::Interval;
use smallvec::SmallVec;
use std::hint::black_box;

/// The largest number of components of a vector.
const MOST: usize = 4;

/// The components of a vector, at most `C`. Missing ones are blank.
type Vector<B, const C: usize> = [B; C];

/// The type in which a domain's built-in functions are computed.
type Wide<D> = <<D as Domain>::Float as Number>::Wide;

/// Eight lanes with separate numbers.
type ByLane<W> = [W; WIDTH];

/// A vector of `size` components. Unlike the standard library's `from_fn`, it is inlined into the calling loop and so
/// compiled for the same vector unit.
#[inline(always)]
fn each<B: Copy + Default, const C: usize>(size: usize, component: impl Fn(usize) -> B) -> Vector<B, C> {
    let mut vector = [B::default(); C];
    for k in 0..size {
        vector[k % C] = component(k);
    }
    vector
}

/// A number in all lanes.
#[inline(always)]
fn splat<W: Number, B: NumberBlock<W>>(value: f64) -> B {
    B::splat(W::from_f64(value))
}

#[inline(always)]
fn dot<W: Number, B: NumberBlock<W>, const C: usize>(size: usize, a: &Vector<B, C>, b: &Vector<B, C>) -> B {
    B::sum(
        size,
        #[inline(always)]
        |k| a[k % C].mul(&b[k % C]),
    )
}

/// `dot(a, a)`
#[inline(always)]
fn squared<W: Number, B: NumberBlock<W>, const C: usize>(size: usize, a: &Vector<B, C>) -> B {
    B::sum(
        size,
        #[inline(always)]
        |k| a[k % C].square(),
    )
}

/// A vector over the root of its squared length. The domain chooses between a product and a quotient.
#[inline(always)]
fn normalize<W: Number, B: NumberBlock<W>, const C: usize>(size: usize, a: &Vector<B, C>) -> Vector<B, C> {
    let scale = squared::<W, B, C>(size, a).unit_scale();
    each(
        size,
        #[inline(always)]
        |k| a[k % C].scaled(&scale).cosine_at_most(),
    )
}

#[inline(always)]
fn cross<W: Number, B: NumberBlock<W>, const C: usize>(
    size: usize,
    a: &Vector<B, C>,
    b: &Vector<B, C>,
) -> Vector<B, C> {
    each(
        size,
        #[inline(always)]
        |k| {
            let (i, j) = ((k + 1) % 3 % C, (k + 2) % 3 % C);
            a[i].mul(&b[j]).sub(&b[i].mul(&a[j]))
        },
    )
}

/// `I - 2 dot(N, I) N`
#[inline(always)]
fn reflect<W: Number, B: NumberBlock<W>, const C: usize>(
    size: usize,
    incident: &Vector<B, C>,
    normal: &Vector<B, C>,
) -> Vector<B, C> {
    let twice = dot::<W, B, C>(size, normal, incident).mul(&splat::<W, B>(2.0));
    each(
        size,
        #[inline(always)]
        |k| incident[k % C].sub(&twice.mul(&normal[k % C])),
    )
}

/// With `k = 1 - eta eta (1 - dot(N, I)^2)`: 0 if that is negative, else `eta I - (eta dot(N, I) + sqrt(k)) N`.
#[inline(always)]
fn refract<W: Number, B: NumberBlock<W>, const C: usize>(
    size: usize,
    incident: &Vector<B, C>,
    normal: &Vector<B, C>,
    eta: &B,
) -> Vector<B, C> {
    let (zero, one) = (splat::<W, B>(0.0), splat::<W, B>(1.0));
    let cosine = dot::<W, B, C>(size, normal, incident);
    let k = one.sub(&eta.mul(eta).mul(&one.sub(&cosine.mul(&cosine))));
    let along = eta.mul(&cosine).add(&k.max(&zero).sqrt());
    let none = k.less(&zero);
    each(
        size,
        #[inline(always)]
        |i| B::select(&none, &zero, &eta.mul(&incident[i % C]).sub(&along.mul(&normal[i % C]))),
    )
}

/// `dot(Nref, I) < 0 ? N : -N`
#[inline(always)]
fn faceforward<W: Number, B: NumberBlock<W>, const C: usize>(
    size: usize,
    normal: &Vector<B, C>,
    incident: &Vector<B, C>,
    reference: &Vector<B, C>,
) -> Vector<B, C> {
    let side = dot::<W, B, C>(size, reference, incident).less(&splat::<W, B>(0.0));
    each(
        size,
        #[inline(always)]
        |k| B::select(&side, &normal[k % C], &normal[k % C].neg()),
    )
}

/// The determinant of these columns and rows of a matrix with `size` columns.
fn minor<W: Number>(m: &[W::Block], size: usize, columns: &[usize], rows: &[usize]) -> W::Block {
    match (columns, rows) {
        ([c], [r]) => m[c * size + r],
        ([c, d], [r, s]) => m[c * size + r].mul(&m[d * size + s]).sub(&m[d * size + r].mul(&m[c * size + s])),
        ([first, rest @ ..], _) => {
            let mut sum: Option<W::Block> = None;
            for (k, row) in rows.iter().enumerate() {
                let others: SmallVec<[usize; 4]> = rows.iter().copied().filter(|other| other != row).collect();
                let term = m[first * size + row].mul(&minor::<W>(m, size, rest, &others));
                sum = Some(match sum {
                    None => term,
                    Some(sum) if k % 2 == 1 => sum.sub(&term),
                    Some(sum) => sum.add(&term),
                });
            }
            sum.unwrap_or(splat::<W, W::Block>(1.0))
        }
        _ => splat::<W, W::Block>(1.0),
    }
}

/// Rare, so it is not compiled for a vector unit.
#[inline(never)]
fn determinant<W: Number>(m: &[W::Block], size: usize) -> W::Block {
    let all = [0, 1, 2, 3];
    minor::<W>(m, size, &all[..size], &all[..size])
}

/// The inverse by cofactors and the determinant.
#[inline(never)]
fn inverse<W: Number>(m: &[W::Block], size: usize) -> [W::Block; 16] {
    let mut out = [splat::<W, W::Block>(0.0); 16];
    let all = [0usize, 1, 2, 3];
    let determinant = determinant::<W>(m, size);
    for column in 0..size {
        for row in 0..size {
            let without = |gone: usize| -> SmallVec<[usize; 4]> {
                all[..size].iter().copied().filter(|place| *place != gone).collect()
            };
            // The transposed cofactor.
            let cofactor = minor::<W>(m, size, &without(row), &without(column));
            let signed = if (column + row) % 2 == 1 { cofactor.neg() } else { cofactor };
            out[column * size + row] = signed.div(&determinant);
        }
    }
    out
}

/// A function of vectors of `size` components. `scalar` returns the components of all arguments, which follow each other;
/// `result` takes the components of the result.
#[inline(always)]
fn of_vectors<W: Number, B: NumberBlock<W>, const C: usize>(
    (op, squares): (Composite, bool),
    size: usize,
    scalar: impl Fn(usize) -> B,
    mut result: impl FnMut(usize, &B),
) {
    let a: Vector<B, C> = vector(size, 0, &scalar);
    let found = match op {
        Composite::Length => return result(0, &squared::<W, B, C>(size, &a).sqrt()),
        // The same vector twice: its components are squares, for which an envelope is narrower.
        Composite::Dot if squares => return result(0, &squared::<W, B, C>(size, &a)),
        Composite::Dot => return result(0, &dot::<W, B, C>(size, &a, &vector(size, 1, &scalar))),
        Composite::Distance => {
            let gap = each(
                size,
                #[inline(always)]
                |k| a[k % C].sub(&scalar(size + k)),
            );
            return result(0, &squared::<W, B, C>(size, &gap).sqrt());
        }
        Composite::Normalize => normalize::<W, B, C>(size, &a),
        Composite::Cross => cross::<W, B, C>(size, &a, &vector(size, 1, &scalar)),
        Composite::Reflect => reflect::<W, B, C>(size, &a, &vector(size, 1, &scalar)),
        Composite::Refract => refract::<W, B, C>(size, &a, &vector(size, 1, &scalar), &scalar(2 * size)),
        Composite::Faceforward => {
            faceforward::<W, B, C>(size, &a, &vector(size, 1, &scalar), &vector(size, 2, &scalar))
        }
        // `composite` has handled these.
        Composite::Determinant | Composite::Inverse => return,
    };
    for k in 0..size {
        result(k, &found[k % C]);
    }
}

/// A vector of arguments.
#[inline(always)]
fn vector<B: Copy + Default, const C: usize>(size: usize, number: usize, scalar: &impl Fn(usize) -> B) -> Vector<B, C> {
    each(
        size,
        #[inline(always)]
        |k| scalar(number * size + k),
    )
}

/// A block of an argument. Missing ones are blank.
#[inline(always)]
fn scalar<N: Number>(arguments: &[Source<'_, N>], place: usize, number: usize) -> <N::Wide as Element>::Block {
    match arguments.get(number) {
        Some(source) => source.block(place).widen(),
        None => Default::default(),
    }
}

/// The block of an argument as separate numbers.
#[inline(always)]
fn by_lane<N: Number>(arguments: &[Source<'_, N>], place: usize, number: usize) -> ByLane<N::Wide> {
    let lanes_of = scalar(arguments, place, number);
    let mut lanes = [N::Wide::default(); WIDTH];
    for (lane, slot) in lanes.iter_mut().enumerate() {
        *slot = lanes_of.get(lane);
    }
    lanes
}

/// All components of a matrix.
fn all<N: Number>(arguments: &[Source<'_, N>], place: usize) -> [<N::Wide as Element>::Block; 16] {
    let mut all = [Default::default(); 16];
    for (k, slot) in all.iter_mut().enumerate() {
        *slot = scalar(arguments, place, k);
    }
    all
}

/// The number of blocks to compute: one if each argument is one number for all lanes.
fn blocks<N: Number>(arguments: &[Source<'_, N>]) -> (usize, Filled) {
    let same = arguments.iter().all(|source| matches!(source, Source::One(_)));
    if same { (1, Filled::One) } else { (LANES / WIDTH, Filled::Lanes) }
}

/// Writes a block of a result.
#[inline(always)]
fn write<N: Number>(
    outs: &mut [Register<N>],
    number: usize,
    (place, filled): (usize, Filled),
    found: &<N::Wide as Element>::Block,
) {
    if let Some(out) = outs.get_mut(number) {
        out.fill(
            #[inline(always)]
            |lanes| {
                lanes.blocks_mut()[place % (LANES / WIDTH)] = NumberBlock::narrow(found);
                filled
            },
        );
    }
}

/// A function of vectors, for all lanes.
#[inline(always)]
fn loops<N: Number, const C: usize>(
    op: (Composite, bool),
    size: usize,
    arguments: &[Source<'_, N>],
    outs: &mut [Register<N>],
) {
    let (blocks, filled) = blocks(arguments);
    for place in 0..blocks {
        of_vectors::<N::Wide, <N::Wide as Element>::Block, C>(
            op,
            size,
            #[inline(always)]
            |number| scalar(arguments, place, number),
            #[inline(always)]
            |number, found| write(outs, number, (place, filled), found),
        );
    }
}

/// The same lane by lane, for a machine without the vector unit.
fn loops_by_lane<N: Number>(op: (Composite, bool), size: usize, arguments: &[Source<'_, N>], outs: &mut [Register<N>]) {
    let (blocks, filled) = blocks(arguments);
    for place in 0..blocks {
        of_vectors::<N::Wide, ByLane<N::Wide>, MOST>(
            op,
            size,
            |number| by_lane(arguments, place, number),
            |number, found| write(outs, number, (place, filled), &Block::of(found)),
        );
    }
}

fn vectors<N: Number>(op: (Composite, bool), size: usize, arguments: &[Source<'_, N>], outs: &mut [Register<N>]) {
    if N::Wide::PLAIN && size == 3 {
        let done = <N::Wide as Element>::Block::if_vectorized(
            #[inline(always)]
            || loops::<N, 3>(op, 3, arguments, outs),
        );
        if done.is_some() {
            return;
        }
    }
    // The number of components is hidden from the compiler, which would otherwise unroll each loop for each number.
    let size = black_box(size);
    let done = <N::Wide as Element>::Block::if_vectorized(
        #[inline(always)]
        || loops::<N, MOST>(op, size, arguments, outs),
    );
    if done.is_none() {
        loops_by_lane(op, size, arguments, outs);
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn composite(&mut self, op: Composite, size: u8, results: &[Operand], operands: &[Operand]) {
        let size = usize::from(size).min(MOST);
        let mut outs: SmallVec<[Register<D::Float>; 16]> = SmallVec::new();
        outs.extend(results.iter().map(|_| self.floats.take()));
        let mut arguments: SmallVec<[Source<'_, D::Float>; 12]> = SmallVec::new();
        arguments.extend(operands.iter().map(|operand| self.float(*operand)));
        let (blocks, filled) = blocks(&arguments);
        match op {
            Composite::Determinant => {
                for place in 0..blocks {
                    let found = determinant::<Wide<D>>(&all(&arguments, place), size);
                    write(&mut outs, 0, (place, filled), &found);
                }
            }
            Composite::Inverse => {
                for place in 0..blocks {
                    for (number, found) in inverse::<Wide<D>>(&all(&arguments, place), size).iter().enumerate() {
                        write(&mut outs, number, (place, filled), found);
                    }
                }
            }
            _ => {
                let squares = D::HAS_INTERVALS && operands.get(..size) == operands.get(size..);
                vectors((op, squares), size, &arguments, &mut outs);
            }
        }
        drop(arguments);
        if D::HAS_INTERVALS
            && !self.profile.limits_differences
            && matches!(op, Composite::Determinant | Composite::Inverse)
        {
            let unlimited = |number: D::Float| Number::with_interval(number.value(), Interval::ALL);
            outs.iter_mut().for_each(|out| out.change(unlimited));
        }
        for (operand, out) in results.iter().zip(outs.drain(..)) {
            self.floats.put(*operand, out);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::domain::{EnvelopeBlock, EnvelopeFloat};

    /// Components of vectors that differ in each lane; some are 0, and some are not exact.
    fn component(number: usize) -> ByLane<EnvelopeFloat> {
        let mut lanes = [EnvelopeFloat::default(); WIDTH];
        for (lane, slot) in lanes.iter_mut().enumerate() {
            let value = ((number * 7 + lane * 3) % 11) as f64 - 5.0;
            *slot = EnvelopeFloat::with_error(value * 0.3, if lane % 2 == 0 { 0.0 } else { 1e-6 });
        }
        lanes
    }

    #[test]
    fn a_machine_without_the_vector_unit_gives_the_same() {
        use Composite::{Cross, Distance, Dot, Faceforward, Length, Normalize, Reflect, Refract};
        for op in [Length, Distance, Dot, Cross, Normalize, Faceforward, Reflect, Refract] {
            for size in if op == Cross { 3..=3 } else { 1..=MOST } {
                for squares in [false, true] {
                    let (mut by_lane, mut by_block) = (Vec::new(), Vec::new());
                    of_vectors::<EnvelopeFloat, ByLane<EnvelopeFloat>, MOST>(
                        (op, squares),
                        size,
                        component,
                        |_, lanes_of| {
                            by_lane.push(*lanes_of);
                        },
                    );
                    let block = |number: usize| EnvelopeBlock::of(&component(number));
                    of_vectors::<EnvelopeFloat, EnvelopeBlock, MOST>((op, squares), size, block, |_, lanes_of| {
                        by_block.push(*lanes_of);
                    });
                    assert_eq!(by_lane.len(), by_block.len());
                    for (by_lane, by_block) in by_lane.iter().zip(&by_block) {
                        for lane in 0..WIDTH {
                            let (a, b) = (by_lane.get(lane), by_block.get(lane));
                            assert!(same(a, b), "{op:?} of {size}, lane {lane}: {a:?}, {b:?}");
                        }
                    }
                }
            }
        }
    }

    /// Whether two numbers are equal. NaN equals itself, and zeros have no sign.
    fn same(a: EnvelopeFloat, b: EnvelopeFloat) -> bool {
        let equal = |a: f64, b: f64| a == b || a.is_nan() && b.is_nan();
        equal(a.value, b.value) && equal(a.low, b.low) && equal(a.high, b.high) && a.may_be_nan == b.may_be_nan
    }
}
