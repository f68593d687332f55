//! Built-in functions of whole vectors and matrices (§8.4, §8.5): computed in the domain's wide type, rounded once.
//!
//! *In:* registers of the arguments, component by component. *Out:* registers of the results.
//!
//! The formulas are those that the specification names. A vector without length normalizes to NaN, a singular matrix
//! inverts to infinities or NaN: both are undefined in GLSL.
//!
//! *Holds:* a formula is compiled once a domain, for any number of components. Three components of plain numbers are
//! compiled apart: there the loops over components cost more than what is in them.

use super::inst::{Composite, Operand};
use super::registers::{Filled, Registers};
use crate::domain::{Block, Domain, Element, Few, LANES, Number, Source, WIDTH};
use smallvec::SmallVec;
use std::hint::black_box;

/// The most components of a vector.
const MOST: usize = 4;

/// The components of a vector; those that it lacks are blank.
type Vector<B> = [B; MOST];

/// What a domain's built-in functions are computed in.
type Wide<D> = <<D as Domain>::Float as Number>::Wide;

/// Eight lanes of it.
type WideFew<D> = <Wide<D> as Element>::Few;

/// A vector of `size` components. Unlike the library's `from_fn` it is part of the loop that calls it, and so compiled for
/// the same vector unit.
#[inline(always)]
fn each<B: Copy + Default>(size: usize, component: impl Fn(usize) -> B) -> Vector<B> {
    let mut vector = [B::default(); MOST];
    for k in 0..size {
        vector[k % MOST] = component(k);
    }
    vector
}

/// The same number in all lanes.
#[inline(always)]
fn splat<W: Number>(value: f64) -> W::Few {
    W::Few::splat(W::from_f64(value))
}

#[inline(always)]
fn dot<W: Number>(size: usize, a: &Vector<W::Few>, b: &Vector<W::Few>) -> W::Few {
    Block::sum(
        size,
        #[inline(always)]
        |k| a[k % MOST].mul(&b[k % MOST]),
    )
}

/// `dot(a, a)`
#[inline(always)]
fn squared<W: Number>(size: usize, a: &Vector<W::Few>) -> W::Few {
    Block::sum(
        size,
        #[inline(always)]
        |k| a[k % MOST].square(),
    )
}

/// A vector over the root of its squared length.
#[inline(always)]
fn normalize<W: Number>(size: usize, a: &Vector<W::Few>) -> Vector<W::Few> {
    let scale = squared::<W>(size, a).inversesqrt();
    each(
        size,
        #[inline(always)]
        |k| a[k % MOST].mul(&scale).cosine_at_most(),
    )
}

#[inline(always)]
fn cross<W: Number>(size: usize, a: &Vector<W::Few>, b: &Vector<W::Few>) -> Vector<W::Few> {
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
fn reflect<W: Number>(size: usize, incident: &Vector<W::Few>, normal: &Vector<W::Few>) -> Vector<W::Few> {
    let twice = dot::<W>(size, normal, incident).mul(&splat::<W>(2.0));
    each(
        size,
        #[inline(always)]
        |k| incident[k % MOST].sub(&twice.mul(&normal[k % MOST])),
    )
}

/// With `k = 1 - eta eta (1 - dot(N, I)^2)`: 0 if that is negative, else `eta I - (eta dot(N, I) + sqrt(k)) N`.
#[inline(always)]
fn refract<W: Number>(
    size: usize,
    incident: &Vector<W::Few>,
    normal: &Vector<W::Few>,
    eta: &W::Few,
) -> Vector<W::Few> {
    let (zero, one) = (splat::<W>(0.0), splat::<W>(1.0));
    let cosine = dot::<W>(size, normal, incident);
    let k = one.sub(&eta.mul(eta).mul(&one.sub(&cosine.mul(&cosine))));
    let along = eta.mul(&cosine).add(&k.max(&zero).sqrt());
    let none = k.less(&zero);
    each(
        size,
        #[inline(always)]
        |i| Block::select(&none, &zero, &eta.mul(&incident[i % MOST]).sub(&along.mul(&normal[i % MOST]))),
    )
}

/// `dot(Nref, I) < 0 ? N : -N`
#[inline(always)]
fn faceforward<W: Number>(
    size: usize,
    normal: &Vector<W::Few>,
    incident: &Vector<W::Few>,
    reference: &Vector<W::Few>,
) -> Vector<W::Few> {
    let side = dot::<W>(size, reference, incident).less(&splat::<W>(0.0));
    each(
        size,
        #[inline(always)]
        |k| Block::select(&side, &normal[k % MOST], &normal[k % MOST].neg()),
    )
}

/// The determinant of the columns and rows named, of a matrix of `size` columns.
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
            sum.unwrap_or(splat::<W>(1.0))
        }
        _ => splat::<W>(1.0),
    }
}

/// Rare enough that it is compiled for no vector unit.
#[inline(never)]
fn determinant<W: Number>(m: &[W::Few], size: usize) -> W::Few {
    let all = [0, 1, 2, 3];
    minor::<W>(m, size, &all[..size], &all[..size])
}

/// Cofactors over the determinant.
#[inline(never)]
fn inverse<W: Number>(m: &[W::Few], size: usize) -> [W::Few; 16] {
    let mut out = [splat::<W>(0.0); 16];
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

/// The arguments of a function, and the block of lanes that is computed.
struct Arguments<'a, N: Number> {
    sources: &'a [Source<'a, N>],
    place: usize,
}

impl<N: Number> Arguments<'_, N> {
    /// A component; what is not there is blank.
    #[inline(always)]
    fn scalar(&self, number: usize) -> <N::Wide as Element>::Few {
        match self.sources.get(number) {
            Some(source) => source.block(self.place).widen(),
            None => Default::default(),
        }
    }

    /// Consecutive components as a vector.
    #[inline(always)]
    fn vector(&self, size: usize, number: usize) -> Vector<<N::Wide as Element>::Few> {
        each(
            size,
            #[inline(always)]
            |k| self.scalar(number * size + k),
        )
    }

    /// All components, of a matrix.
    fn all(&self) -> [<N::Wide as Element>::Few; 16] {
        let mut all = [Default::default(); 16];
        for (k, slot) in all.iter_mut().enumerate() {
            *slot = self.scalar(k);
        }
        all
    }
}

impl<D: Domain> Registers<D> {
    pub(super) fn composite(&mut self, op: Composite, size: u8, results: &[Operand], arguments: &[Operand]) {
        let size = usize::from(size).min(MOST);
        match op {
            Composite::Determinant => {
                self.each_few(results, arguments, |a| [determinant::<Wide<D>>(&a.all(), size)]);
            }
            Composite::Inverse => self.each_few(results, arguments, |a| inverse::<Wide<D>>(&a.all(), size)),
            _ if size == 3 && Wide::<D>::PLAIN => self.of_vectors(op, 3, results, arguments),
            // The compiler is not told how few they are, or it would write a loop out as often.
            _ => self.of_vectors(op, black_box(size), results, arguments),
        }
    }

    /// The functions of vectors of `size` components.
    #[inline(always)]
    fn of_vectors(&mut self, op: Composite, size: usize, results: &[Operand], arguments: &[Operand]) {
        match op {
            Composite::Length => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| [squared::<Wide<D>>(size, &a.vector(size, 0)).sqrt()],
            ),
            Composite::Normalize => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| normalize::<Wide<D>>(size, &a.vector(size, 0)),
            ),
            Composite::Dot if D::OPEN && arguments.get(..size) == arguments.get(size..) => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| [squared::<Wide<D>>(size, &a.vector(size, 0))],
            ),
            Composite::Dot => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| [dot::<Wide<D>>(size, &a.vector(size, 0), &a.vector(size, 1))],
            ),
            Composite::Distance => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| {
                    let gap = each(
                        size,
                        #[inline(always)]
                        |k| a.scalar(k).sub(&a.scalar(size + k)),
                    );
                    [squared::<Wide<D>>(size, &gap).sqrt()]
                },
            ),
            Composite::Cross => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| cross::<Wide<D>>(size, &a.vector(size, 0), &a.vector(size, 1)),
            ),
            Composite::Reflect => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| reflect::<Wide<D>>(size, &a.vector(size, 0), &a.vector(size, 1)),
            ),
            Composite::Refract => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| refract::<Wide<D>>(size, &a.vector(size, 0), &a.vector(size, 1), &a.scalar(2 * size)),
            ),
            Composite::Faceforward => self.each_few(
                results,
                arguments,
                #[inline(always)]
                |a| faceforward::<Wide<D>>(size, &a.vector(size, 0), &a.vector(size, 1), &a.vector(size, 2)),
            ),
            // `composite` has seen to these.
            Composite::Determinant | Composite::Inverse => {}
        }
    }

    /// Applies a function with at most `R` results to a few lanes at a time.
    #[inline(always)]
    fn each_few<const R: usize>(
        &mut self,
        results: &[Operand],
        arguments: &[Operand],
        f: impl Fn(&Arguments<'_, D::Float>) -> [WideFew<D>; R],
    ) {
        let mut outs: [_; R] = std::array::from_fn(|_| self.floats.take());
        let sources: SmallVec<[Source<'_, D::Float>; 12]> =
            arguments.iter().map(|operand| self.float(*operand)).collect();
        let same = sources.iter().all(|source| matches!(source, Source::One(_)));
        let (blocks, filled) = if same { (1, Filled::One) } else { (LANES / WIDTH, Filled::Lanes) };
        WideFew::<D>::vectorized(
            #[inline(always)]
            || {
                for place in 0..blocks {
                    let found = f(&Arguments { sources: &sources, place });
                    for (out, found) in outs.iter_mut().zip(&found).take(results.len()) {
                        out.fill(
                            #[inline(always)]
                            |lanes| {
                                lanes.blocks_mut()[place] = Block::narrow(found);
                                filled
                            },
                        );
                    }
                }
            },
        );
        drop(sources);
        for (place, out) in outs.into_iter().enumerate() {
            match results.get(place) {
                Some(operand) => self.floats.put(*operand, out),
                None => self.floats.give_back(out),
            }
        }
    }
}
