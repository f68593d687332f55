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
use crate::domain::{Block, Domain, Element, Few, LANES, Number, Source, WIDTH};
use smallvec::SmallVec;
use std::hint::black_box;

/// The largest number of components of a vector.
const MOST: usize = 4;

/// The components of a vector. Missing ones are blank.
type Vector<B> = [B; MOST];

/// The type in which a domain's built-in functions are computed.
type Wide<D> = <<D as Domain>::Float as Number>::Wide;

/// Eight lanes with separate numbers.
type ByLane<W> = [W; WIDTH];

/// A vector of `size` components. Unlike the standard library's `from_fn`, it is inlined into the calling loop and so
/// compiled for the same vector unit.
#[inline(always)]
fn each<B: Copy + Default>(size: usize, component: impl Fn(usize) -> B) -> Vector<B> {
    let mut vector = [B::default(); MOST];
    for k in 0..size {
        vector[k % MOST] = component(k);
    }
    vector
}

/// A number in all lanes.
#[inline(always)]
fn splat<W: Number, B: Block<W>>(value: f64) -> B {
    B::splat(W::from_f64(value))
}

#[inline(always)]
fn dot<W: Number, B: Block<W>>(size: usize, a: &Vector<B>, b: &Vector<B>) -> B {
    B::sum(
        size,
        #[inline(always)]
        |k| a[k % MOST].mul(&b[k % MOST]),
    )
}

/// `dot(a, a)`
#[inline(always)]
fn squared<W: Number, B: Block<W>>(size: usize, a: &Vector<B>) -> B {
    B::sum(
        size,
        #[inline(always)]
        |k| a[k % MOST].square(),
    )
}

/// A vector over the root of its squared length.
#[inline(always)]
fn normalize<W: Number, B: Block<W>>(size: usize, a: &Vector<B>) -> Vector<B> {
    let scale = squared::<W, B>(size, a).inversesqrt();
    each(
        size,
        #[inline(always)]
        |k| a[k % MOST].mul(&scale).cosine_at_most(),
    )
}

#[inline(always)]
fn cross<W: Number, B: Block<W>>(size: usize, a: &Vector<B>, b: &Vector<B>) -> Vector<B> {
    each(
        size,
        #[inline(always)]
        |k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            a[i].mul(&b[j]).sub(&b[i].mul(&a[j]))
        },
    )
}

/// `I - 2 dot(N, I) N`
#[inline(always)]
fn reflect<W: Number, B: Block<W>>(size: usize, incident: &Vector<B>, normal: &Vector<B>) -> Vector<B> {
    let twice = dot::<W, B>(size, normal, incident).mul(&splat::<W, B>(2.0));
    each(
        size,
        #[inline(always)]
        |k| incident[k % MOST].sub(&twice.mul(&normal[k % MOST])),
    )
}

/// With `k = 1 - eta eta (1 - dot(N, I)^2)`: 0 if that is negative, else `eta I - (eta dot(N, I) + sqrt(k)) N`.
#[inline(always)]
fn refract<W: Number, B: Block<W>>(size: usize, incident: &Vector<B>, normal: &Vector<B>, eta: &B) -> Vector<B> {
    let (zero, one) = (splat::<W, B>(0.0), splat::<W, B>(1.0));
    let cosine = dot::<W, B>(size, normal, incident);
    let k = one.sub(&eta.mul(eta).mul(&one.sub(&cosine.mul(&cosine))));
    let along = eta.mul(&cosine).add(&k.max(&zero).sqrt());
    let none = k.less(&zero);
    each(
        size,
        #[inline(always)]
        |i| B::select(&none, &zero, &eta.mul(&incident[i % MOST]).sub(&along.mul(&normal[i % MOST]))),
    )
}

/// `dot(Nref, I) < 0 ? N : -N`
#[inline(always)]
fn faceforward<W: Number, B: Block<W>>(
    size: usize,
    normal: &Vector<B>,
    incident: &Vector<B>,
    reference: &Vector<B>,
) -> Vector<B> {
    let side = dot::<W, B>(size, reference, incident).less(&splat::<W, B>(0.0));
    each(
        size,
        #[inline(always)]
        |k| B::select(&side, &normal[k % MOST], &normal[k % MOST].neg()),
    )
}

/// The determinant of these columns and rows of a matrix with `size` columns.
fn minor<W: Number>(m: &[W::Few], size: usize, columns: &[usize], rows: &[usize]) -> W::Few {
    match (columns, rows) {
        ([c], [r]) => m[c * size + r],
        ([c, d], [r, s]) => m[c * size + r].mul(&m[d * size + s]).sub(&m[d * size + r].mul(&m[c * size + s])),
        ([first, rest @ ..], _) => {
            let mut sum: Option<W::Few> = None;
            for (k, row) in rows.iter().enumerate() {
                let others: SmallVec<[usize; 4]> = rows.iter().copied().filter(|other| other != row).collect();
                let term = m[first * size + row].mul(&minor::<W>(m, size, rest, &others));
                sum = Some(match sum {
                    None => term,
                    Some(sum) if k % 2 == 1 => sum.sub(&term),
                    Some(sum) => sum.add(&term),
                });
            }
            sum.unwrap_or(splat::<W, W::Few>(1.0))
        }
        _ => splat::<W, W::Few>(1.0),
    }
}

/// Rare, so it is not compiled for a vector unit.
#[inline(never)]
fn determinant<W: Number>(m: &[W::Few], size: usize) -> W::Few {
    let all = [0, 1, 2, 3];
    minor::<W>(m, size, &all[..size], &all[..size])
}

/// The inverse by cofactors and the determinant.
#[inline(never)]
fn inverse<W: Number>(m: &[W::Few], size: usize) -> [W::Few; 16] {
    let mut out = [splat::<W, W::Few>(0.0); 16];
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

/// A vector of arguments.
#[inline(always)]
fn vector<B: Copy + Default>(size: usize, number: usize, scalar: &impl Fn(usize) -> B) -> Vector<B> {
    each(
        size,
        #[inline(always)]
        |k| scalar(number * size + k),
    )
}

/// A scalar as a result.
#[inline(always)]
fn alone<B: Copy + Default>(scalar: B) -> Vector<B> {
    [scalar, B::default(), B::default(), B::default()]
}

/// A function of vectors of `size` components. The components of all arguments follow each other.
#[inline(always)]
fn of_vectors<W: Number, B: Block<W>>(
    (op, squares): (Composite, bool),
    size: usize,
    scalar: impl Fn(usize) -> B,
) -> Vector<B> {
    match op {
        Composite::Length => alone(squared::<W, B>(size, &vector(size, 0, &scalar)).sqrt()),
        // The same vector twice: its components are squares, for which an envelope is narrower.
        Composite::Dot if squares => alone(squared::<W, B>(size, &vector(size, 0, &scalar))),
        Composite::Normalize => normalize::<W, B>(size, &vector(size, 0, &scalar)),
        Composite::Dot => alone(dot::<W, B>(size, &vector(size, 0, &scalar), &vector(size, 1, &scalar))),
        Composite::Distance => {
            let gap = each(
                size,
                #[inline(always)]
                |k| scalar(k).sub(&scalar(size + k)),
            );
            alone(squared::<W, B>(size, &gap).sqrt())
        }
        Composite::Cross => cross::<W, B>(size, &vector(size, 0, &scalar), &vector(size, 1, &scalar)),
        Composite::Reflect => reflect::<W, B>(size, &vector(size, 0, &scalar), &vector(size, 1, &scalar)),
        Composite::Refract => {
            refract::<W, B>(size, &vector(size, 0, &scalar), &vector(size, 1, &scalar), &scalar(2 * size))
        }
        Composite::Faceforward => {
            faceforward::<W, B>(size, &vector(size, 0, &scalar), &vector(size, 1, &scalar), &vector(size, 2, &scalar))
        }
        // `composite` has handled these.
        Composite::Determinant | Composite::Inverse => Vector::default(),
    }
}

/// The arguments of a function.
struct Arguments<'a, N: Number>(SmallVec<[Source<'a, N>; 12]>);

impl<N: Number> Arguments<'_, N> {
    /// A block of a component. Missing ones are blank.
    #[inline(always)]
    fn scalar(&self, place: usize, number: usize) -> <N::Wide as Element>::Few {
        match self.0.get(number) {
            Some(source) => source.block(place).widen(),
            None => Default::default(),
        }
    }

    /// The block of a component as separate numbers.
    #[inline(always)]
    fn by_lane(&self, place: usize, number: usize) -> ByLane<N::Wide> {
        let few = self.scalar(place, number);
        let mut lanes = [N::Wide::default(); WIDTH];
        for (lane, slot) in lanes.iter_mut().enumerate() {
            *slot = few.get(lane);
        }
        lanes
    }

    /// All components of a matrix.
    fn all(&self, place: usize) -> [<N::Wide as Element>::Few; 16] {
        let mut all = [Default::default(); 16];
        for (k, slot) in all.iter_mut().enumerate() {
            *slot = self.scalar(place, k);
        }
        all
    }

    /// The number of blocks to compute: one if each argument is one number for all lanes.
    fn blocks(&self) -> (usize, Filled) {
        let same = self.0.iter().all(|source| matches!(source, Source::One(_)));
        if same { (1, Filled::One) } else { (LANES / WIDTH, Filled::Lanes) }
    }
}

/// Writes a block of each result.
#[inline(always)]
fn write<N: Number>(outs: &mut [Register<N>], place: usize, filled: Filled, found: &[<N::Wide as Element>::Few]) {
    for (out, found) in outs.iter_mut().zip(found) {
        out.fill(
            #[inline(always)]
            |lanes| {
                lanes.blocks_mut()[place] = Block::narrow(found);
                filled
            },
        );
    }
}

/// A function of vectors, for all lanes.
fn vectors<N: Number>(op: (Composite, bool), size: usize, arguments: &Arguments<'_, N>, outs: &mut [Register<N>]) {
    let (blocks, filled) = arguments.blocks();
    if N::Wide::PLAIN {
        for place in 0..blocks {
            let found = if size == 3 {
                of_vectors::<N::Wide, <N::Wide as Element>::Few>(
                    op,
                    3,
                    #[inline(always)]
                    |number| arguments.scalar(place, number),
                )
            } else {
                of_vectors::<N::Wide, <N::Wide as Element>::Few>(
                    op,
                    black_box(size),
                    #[inline(always)]
                    |number| arguments.scalar(place, number),
                )
            };
            write(outs, place, filled, &found);
        }
        return;
    }
    // The number of components is hidden from the compiler, which would otherwise unroll each loop for each number.
    let size = black_box(size);
    let done = <N::Wide as Element>::Few::if_vectorized(
        #[inline(always)]
        || {
            for place in 0..blocks {
                let found = of_vectors::<N::Wide, <N::Wide as Element>::Few>(
                    op,
                    size,
                    #[inline(always)]
                    |number| arguments.scalar(place, number),
                );
                write(outs, place, filled, &found);
            }
        },
    );
    if done.is_none() {
        for place in 0..blocks {
            let found = of_vectors::<N::Wide, ByLane<N::Wide>>(op, size, |number| arguments.by_lane(place, number));
            write(outs, place, filled, &found.map(|found| Few::of(&found)));
        }
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn composite(&mut self, op: Composite, size: u8, results: &[Operand], arguments: &[Operand]) {
        let size = usize::from(size).min(MOST);
        let mut outs: SmallVec<[Register<D::Float>; 16]> = results.iter().map(|_| self.floats.take()).collect();
        let squares = D::OPEN && arguments.get(..size) == arguments.get(size..);
        let arguments = Arguments(arguments.iter().map(|operand| self.float(*operand)).collect());
        let (blocks, filled) = arguments.blocks();
        match op {
            Composite::Determinant => {
                for place in 0..blocks {
                    write(&mut outs, place, filled, &[determinant::<Wide<D>>(&arguments.all(place), size)]);
                }
            }
            Composite::Inverse => {
                for place in 0..blocks {
                    write(&mut outs, place, filled, &inverse::<Wide<D>>(&arguments.all(place), size));
                }
            }
            _ => vectors((op, squares), size, &arguments, &mut outs),
        }
        drop(arguments);
        for (operand, out) in results.iter().zip(outs) {
            self.floats.put(*operand, out);
        }
    }
}
