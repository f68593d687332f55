//! Built-in functions of whole vectors and matrices (§8.4, §8.5): computed in the domain's wide type, rounded once.
//!
//! The formulas are those that the specification names. A vector without length normalizes to NaN, a singular matrix
//! inverts to infinities or NaN: both are undefined in GLSL.

use super::inst::{Composite, Operand};
use super::registers::{Filled, Registers};
use crate::domain::{Block, Domain, Element, Few, LANES, Number, Source, WIDTH};

type Vector<B, const N: usize> = [B; N];

/// What a domain's built-in functions are computed in.
type Wide<D> = <<D as Domain>::Float as Number>::Wide;

/// Eight lanes of it.
type WideFew<D> = <Wide<D> as Element>::Few;

/// A vector by its components. Unlike the library's `from_fn` it is part of the loop that calls it, and so compiled for
/// the same vector unit.
#[inline(always)]
fn each<B: Copy + Default, const N: usize>(component: impl Fn(usize) -> B) -> Vector<B, N> {
    let mut vector = [B::default(); N];
    for (k, slot) in vector.iter_mut().enumerate() {
        *slot = component(k);
    }
    vector
}

/// The same number in all lanes.
#[inline(always)]
fn splat<W: Number>(value: f64) -> W::Few {
    W::Few::splat(W::from_f64(value))
}

#[inline(always)]
fn dot<W: Number, const N: usize>(a: &Vector<W::Few, N>, b: &Vector<W::Few, N>) -> W::Few {
    Block::sum(
        N,
        #[inline(always)]
        |k| a[k].mul(&b[k]),
    )
}

/// `dot(a, a)`
#[inline(always)]
fn squared<W: Number, const N: usize>(a: &Vector<W::Few, N>) -> W::Few {
    Block::sum(
        N,
        #[inline(always)]
        |k| a[k].square(),
    )
}

#[inline(always)]
fn length<W: Number, const N: usize>(a: &Vector<W::Few, N>) -> W::Few {
    squared::<W, N>(a).sqrt()
}

/// A vector over the root of its squared length.
#[inline(always)]
fn normalize<W: Number, const N: usize>(a: &Vector<W::Few, N>, squared: &W::Few) -> Vector<W::Few, N> {
    let scale = squared.inversesqrt();
    each(
        #[inline(always)]
        |k| a[k].mul(&scale).cosine_at_most(),
    )
}

#[inline(always)]
fn cross<W: Number>(a: &Vector<W::Few, 3>, b: &Vector<W::Few, 3>) -> Vector<W::Few, 3> {
    each(
        #[inline(always)]
        |k| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            a[i].mul(&b[j]).sub(&b[i].mul(&a[j]))
        },
    )
}

/// `I - 2 dot(N, I) N`
#[inline(always)]
fn reflect<W: Number, const N: usize>(incident: &Vector<W::Few, N>, normal: &Vector<W::Few, N>) -> Vector<W::Few, N> {
    let twice = dot::<W, N>(normal, incident).mul(&splat::<W>(2.0));
    each(
        #[inline(always)]
        |k| incident[k].sub(&twice.mul(&normal[k])),
    )
}

/// With `k = 1 - eta eta (1 - dot(N, I)^2)`: 0 if that is negative, else `eta I - (eta dot(N, I) + sqrt(k)) N`.
#[inline(always)]
fn refract<W: Number, const N: usize>(
    incident: &Vector<W::Few, N>,
    normal: &Vector<W::Few, N>,
    eta: W::Few,
) -> Vector<W::Few, N> {
    let (zero, one) = (splat::<W>(0.0), splat::<W>(1.0));
    let cosine = dot::<W, N>(normal, incident);
    let k = one.sub(&eta.mul(&eta).mul(&one.sub(&cosine.mul(&cosine))));
    let along = eta.mul(&cosine).add(&k.max(&zero).sqrt());
    let none = k.less(&zero);
    each(
        #[inline(always)]
        |i| Block::select(&none, &zero, &eta.mul(&incident[i]).sub(&along.mul(&normal[i]))),
    )
}

/// `dot(Nref, I) < 0 ? N : -N`
#[inline(always)]
fn faceforward<W: Number, const N: usize>(
    normal: &Vector<W::Few, N>,
    incident: &Vector<W::Few, N>,
    reference: &Vector<W::Few, N>,
) -> Vector<W::Few, N> {
    let side = dot::<W, N>(reference, incident).less(&splat::<W>(0.0));
    each(
        #[inline(always)]
        |k| Block::select(&side, &normal[k], &normal[k].neg()),
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
                let others: smallvec::SmallVec<[usize; 4]> =
                    rows.iter().copied().filter(|other| other != row).collect();
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

fn determinant<W: Number>(m: &[W::Few], size: usize) -> W::Few {
    let all = [0, 1, 2, 3];
    minor::<W>(m, size, &all[..size], &all[..size])
}

/// Cofactors over the determinant.
fn inverse<W: Number>(m: &[W::Few], size: usize) -> [W::Few; 16] {
    let mut out = [splat::<W>(0.0); 16];
    let all = [0usize, 1, 2, 3];
    let determinant = determinant::<W>(m, size);
    for column in 0..size {
        for row in 0..size {
            let without = |gone: usize| -> smallvec::SmallVec<[usize; 4]> {
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

/// Consecutive arguments as one vector.
#[inline(always)]
fn vector<B, const N: usize>(arguments: &[B], place: usize) -> &Vector<B, N> {
    arguments[place * N..].first_chunk().expect("`by_few` counts the arguments")
}

impl<D: Domain> Registers<D> {
    pub(super) fn composite(&mut self, op: Composite, size: u8, results: &[Operand], arguments: &[Operand]) {
        // Sizes of arrays cannot be computed from `N`: arguments and results a function are counted here.
        match (op, size) {
            (Composite::Cross, _) => self.each_few::<6, 3>(
                results,
                arguments,
                #[inline(always)]
                |a| cross::<Wide<D>>(vector(a, 0), vector(a, 1)),
            ),
            (Composite::Determinant, _) => {
                let size = usize::from(size.min(4));
                self.each_few::<16, 1>(
                    results,
                    arguments,
                    #[inline(always)]
                    |a| [determinant::<Wide<D>>(a, size)],
                );
            }
            (Composite::Inverse, _) => {
                let size = usize::from(size.min(4));
                self.each_few::<16, 16>(
                    results,
                    arguments,
                    #[inline(always)]
                    |a| inverse::<Wide<D>>(a, size),
                );
            }
            (_, 1) => self.of_vectors::<1, 2, 3>(op, results, arguments),
            (_, 2) => self.of_vectors::<2, 4, 6>(op, results, arguments),
            (_, 3) => self.of_vectors::<3, 6, 9>(op, results, arguments),
            _ => self.of_vectors::<4, 8, 12>(op, results, arguments),
        }
    }

    /// The functions of `N` components, of one, two (`N2` scalars) or three (`N3`) vectors.
    fn of_vectors<const N: usize, const N2: usize, const N3: usize>(
        &mut self,
        op: Composite,
        results: &[Operand],
        arguments: &[Operand],
    ) {
        match op {
            Composite::Length => self.each_few::<N, 1>(
                results,
                arguments,
                #[inline(always)]
                |a| [length::<Wide<D>, N>(a)],
            ),
            Composite::Normalize => self.each_few::<N, N>(
                results,
                arguments,
                #[inline(always)]
                |a| normalize::<Wide<D>, N>(a, &squared::<Wide<D>, N>(a)),
            ),
            Composite::Dot if D::OPEN && arguments.get(..N) == arguments.get(N..) => {
                self.each_few::<N, 1>(
                    results,
                    arguments,
                    #[inline(always)]
                    |a| [squared::<Wide<D>, N>(a)],
                );
            }
            Composite::Dot => self.each_few::<N2, 1>(
                results,
                arguments,
                #[inline(always)]
                |a| [dot::<Wide<D>, N>(vector(a, 0), vector(a, 1))],
            ),
            Composite::Distance => self.each_few::<N2, 1>(
                results,
                arguments,
                #[inline(always)]
                |a| {
                    let gap: Vector<_, N> = each(
                        #[inline(always)]
                        |k| a[k].sub(&a[N + k]),
                    );
                    [length::<Wide<D>, N>(&gap)]
                },
            ),
            Composite::Reflect => {
                self.each_few::<N2, N>(
                    results,
                    arguments,
                    #[inline(always)]
                    |a| reflect::<Wide<D>, N>(vector(a, 0), vector(a, 1)),
                );
            }
            Composite::Refract => {
                // Of the third argument, a float, one scalar is there; the rest is blank.
                self.each_few::<N3, N>(
                    results,
                    arguments,
                    #[inline(always)]
                    |a| refract::<Wide<D>, N>(vector(a, 0), vector(a, 1), a[N2]),
                );
            }
            Composite::Faceforward => self.each_few::<N3, N>(
                results,
                arguments,
                #[inline(always)]
                |a| faceforward::<Wide<D>, N>(vector(a, 0), vector(a, 1), vector(a, 2)),
            ),
            // `composite` has seen to these.
            Composite::Cross | Composite::Determinant | Composite::Inverse => {}
        }
    }

    /// Applies a function of at most `A` scalars with at most `R` results to a few lanes at a time.
    #[inline(always)]
    fn each_few<const A: usize, const R: usize>(
        &mut self,
        results: &[Operand],
        arguments: &[Operand],
        f: impl Fn(&[WideFew<D>; A]) -> [WideFew<D>; R],
    ) {
        let blank = Source::One(D::Float::default());
        let mut outs: [_; R] = std::array::from_fn(|_| self.floats.take());
        let sources: [Source<'_, D::Float>; A] =
            std::array::from_fn(|k| arguments.get(k).map_or(blank, |operand| self.float(*operand)));
        let same = sources.iter().all(|source| matches!(source, Source::One(_)));
        let (blocks, filled) = if same { (1, Filled::One) } else { (LANES / WIDTH, Filled::Lanes) };
        WideFew::<D>::vectorized(
            #[inline(always)]
            || {
                for place in 0..blocks {
                    let few: [WideFew<D>; A] = each(
                        #[inline(always)]
                        |k| sources[k].block(place).widen(),
                    );
                    let found = f(&few);
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
        for (place, out) in outs.into_iter().enumerate() {
            match results.get(place) {
                Some(operand) => self.floats.put(*operand, out),
                None => self.floats.give_back(out),
            }
        }
    }
}
