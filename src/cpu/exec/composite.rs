//! Built-in functions of whole vectors and matrices (§8.4, §8.5): computed in the domain's wide type, rounded once.
//!
//! The formulas are those that the specification names. A vector without length normalizes to NaN, a singular matrix
//! inverts to infinities or NaN: both are undefined in GLSL.

use super::LANES;
use super::inst::{Composite, Operand};
use super::registers::{Filled, Registers, Source};
use crate::cpu::domain::{Domain, Number};

/// Lanes that are computed together, enough for every vector unit. Envelopes are too large for that: lane by lane.
const STEP: usize = 8;

/// `S` lanes of a scalar.
#[derive(Clone, Copy)]
struct Few<W, const S: usize>([W; S]);

impl<W: Number, const S: usize> Few<W, S> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([W::from_f64(value); S])
    }
    #[inline(always)]
    fn map(self, f: impl Fn(W) -> W) -> Self {
        Self(std::array::from_fn(|lane| f(self.0[lane])))
    }
    #[inline(always)]
    fn zip(self, other: Self, f: impl Fn(W, W) -> W) -> Self {
        Self(std::array::from_fn(|lane| f(self.0[lane], other.0[lane])))
    }
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        self.zip(other, W::add)
    }
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self.zip(other, W::sub)
    }
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        self.zip(other, W::mul)
    }
    /// Where this is below 0 the one, else the other.
    #[inline(always)]
    fn negative(self, yes: Self, no: Self) -> Self {
        let zero = W::from_f64(0.0);
        Self(std::array::from_fn(|lane| W::select(self.0[lane].less(zero), yes.0[lane], no.0[lane])))
    }
}

type Vector<W, const N: usize, const S: usize> = [Few<W, S>; N];

/// What a domain's built-in functions are computed in.
type Wide<D> = <<D as Domain>::Float as Number>::Wide;

#[inline(always)]
fn dot<W: Number, const N: usize, const S: usize>(a: &Vector<W, N, S>, b: &Vector<W, N, S>) -> Few<W, S> {
    if W::OPEN {
        return Few(std::array::from_fn(|lane| W::sum((0..N).map(|k| a[k].0[lane].mul(b[k].0[lane])))));
    }
    let mut sum = a[0].mul(b[0]);
    for k in 1..N {
        sum = sum.add(a[k].mul(b[k]));
    }
    sum
}

/// `dot(a, a)`
#[inline(always)]
fn squared<W: Number, const N: usize, const S: usize>(a: &Vector<W, N, S>) -> Few<W, S> {
    if W::OPEN {
        return Few(std::array::from_fn(|lane| W::sum((0..N).map(|k| a[k].0[lane].square()))));
    }
    dot(a, a)
}

#[inline(always)]
fn length<W: Number, const N: usize, const S: usize>(a: &Vector<W, N, S>) -> Few<W, S> {
    squared(a).map(W::sqrt)
}

#[inline(always)]
fn normalize<W: Number, const N: usize, const S: usize>(a: &Vector<W, N, S>) -> Vector<W, N, S> {
    let scale = squared(a).map(W::inversesqrt);
    a.map(|component| component.mul(scale).map(W::cosine_at_most))
}

#[inline(always)]
fn cross<W: Number, const S: usize>(a: &Vector<W, 3, S>, b: &Vector<W, 3, S>) -> Vector<W, 3, S> {
    let minor = |i: usize, j: usize| a[i].mul(b[j]).sub(b[i].mul(a[j]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// `I - 2 dot(N, I) N`
#[inline(always)]
fn reflect<W: Number, const N: usize, const S: usize>(
    incident: &Vector<W, N, S>,
    normal: &Vector<W, N, S>,
) -> Vector<W, N, S> {
    let twice = dot(normal, incident).mul(Few::splat(2.0));
    std::array::from_fn(|k| incident[k].sub(twice.mul(normal[k])))
}

/// With `k = 1 - eta eta (1 - dot(N, I)^2)`: 0 if that is negative, else `eta I - (eta dot(N, I) + sqrt(k)) N`.
#[inline(always)]
fn refract<W: Number, const N: usize, const S: usize>(
    incident: &Vector<W, N, S>,
    normal: &Vector<W, N, S>,
    eta: Few<W, S>,
) -> Vector<W, N, S> {
    let one = Few::splat(1.0);
    let cosine = dot(normal, incident);
    let k = one.sub(eta.mul(eta).mul(one.sub(cosine.mul(cosine))));
    let along = eta.mul(cosine).add(k.map(|k| k.max(W::from_f64(0.0)).sqrt()));
    std::array::from_fn(|i| k.negative(Few::splat(0.0), eta.mul(incident[i]).sub(along.mul(normal[i]))))
}

/// `dot(Nref, I) < 0 ? N : -N`
#[inline(always)]
fn faceforward<W: Number, const N: usize, const S: usize>(
    normal: &Vector<W, N, S>,
    incident: &Vector<W, N, S>,
    reference: &Vector<W, N, S>,
) -> Vector<W, N, S> {
    let side = dot(reference, incident);
    std::array::from_fn(|k| side.negative(normal[k], normal[k].map(W::neg)))
}

/// The determinant of the columns and rows named, of a matrix of `size` columns.
fn minor<W: Number, const S: usize>(m: &[Few<W, S>], size: usize, columns: &[usize], rows: &[usize]) -> Few<W, S> {
    match (columns, rows) {
        ([c], [r]) => m[c * size + r],
        ([c, d], [r, s]) => m[c * size + r].mul(m[d * size + s]).sub(m[d * size + r].mul(m[c * size + s])),
        ([first, rest @ ..], _) => {
            let mut sum: Option<Few<W, S>> = None;
            for (k, row) in rows.iter().enumerate() {
                let others: smallvec::SmallVec<[usize; 4]> =
                    rows.iter().copied().filter(|other| other != row).collect();
                let term = m[first * size + row].mul(minor(m, size, rest, &others));
                sum = Some(match sum {
                    None => term,
                    Some(sum) if k % 2 == 1 => sum.sub(term),
                    Some(sum) => sum.add(term),
                });
            }
            sum.unwrap_or(Few::splat(1.0))
        }
        _ => Few::splat(1.0),
    }
}

fn determinant<W: Number, const S: usize>(m: &[Few<W, S>], size: usize) -> Few<W, S> {
    let all = [0, 1, 2, 3];
    minor(m, size, &all[..size], &all[..size])
}

/// Cofactors over the determinant.
fn inverse<W: Number, const S: usize>(m: &[Few<W, S>], size: usize) -> [Few<W, S>; 16] {
    let mut out = [Few::splat(0.0); 16];
    let all = [0usize, 1, 2, 3];
    let determinant = determinant(m, size);
    for column in 0..size {
        for row in 0..size {
            let without = |gone: usize| -> smallvec::SmallVec<[usize; 4]> {
                all[..size].iter().copied().filter(|place| *place != gone).collect()
            };
            // The transposed cofactor.
            let cofactor = minor(m, size, &without(row), &without(column));
            let signed = if (column + row) % 2 == 1 { cofactor.map(W::neg) } else { cofactor };
            out[column * size + row] = signed.zip(determinant, W::div);
        }
    }
    out
}

/// Consecutive arguments as one vector.
#[inline(always)]
fn vector<W: Copy, const N: usize>(arguments: &[W], place: usize) -> [W; N] {
    std::array::from_fn(|k| arguments[place * N + k])
}

impl<D: Domain> Registers<D> {
    pub(super) fn composite(&mut self, op: Composite, size: u8, results: &[Operand], arguments: &[Operand]) {
        if D::OPEN {
            self.by_few::<1>(op, size, results, arguments);
        } else {
            self.by_few::<STEP>(op, size, results, arguments);
        }
    }

    fn by_few<const S: usize>(&mut self, op: Composite, size: u8, results: &[Operand], arguments: &[Operand]) {
        // Sizes of arrays cannot be computed from `N`: arguments and results a function are counted here.
        match (op, size) {
            (Composite::Cross, _) => {
                self.each_few::<6, 3, S>(results, arguments, |a| cross(&vector(a, 0), &vector(a, 1)))
            }
            (Composite::Determinant, _) => {
                let size = usize::from(size.min(4));
                self.each_few::<16, 1, S>(results, arguments, |a| [determinant(a, size)]);
            }
            (Composite::Inverse, _) => {
                let size = usize::from(size.min(4));
                self.each_few::<16, 16, S>(results, arguments, |a| inverse(a, size));
            }
            (_, 1) => self.of_vectors::<1, 2, 3, S>(op, results, arguments),
            (_, 2) => self.of_vectors::<2, 4, 6, S>(op, results, arguments),
            (_, 3) => self.of_vectors::<3, 6, 9, S>(op, results, arguments),
            _ => self.of_vectors::<4, 8, 12, S>(op, results, arguments),
        }
    }

    /// The functions of `N` components, of one, two (`N2` scalars) or three (`N3`) vectors.
    fn of_vectors<const N: usize, const N2: usize, const N3: usize, const S: usize>(
        &mut self,
        op: Composite,
        results: &[Operand],
        arguments: &[Operand],
    ) {
        match op {
            Composite::Length => self.each_few::<N, 1, S>(results, arguments, |a| [length(a)]),
            Composite::Normalize => self.each_few::<N, N, S>(results, arguments, normalize),
            Composite::Dot if D::OPEN && arguments.get(..N) == arguments.get(N..) => {
                self.each_few::<N, 1, S>(results, arguments, |a| [squared(a)]);
            }
            Composite::Dot => {
                self.each_few::<N2, 1, S>(results, arguments, |a| [dot::<_, N, S>(&vector(a, 0), &vector(a, 1))])
            }
            Composite::Distance => self.each_few::<N2, 1, S>(results, arguments, |a| {
                let gap: Vector<_, N, S> = std::array::from_fn(|k| a[k].sub(a[N + k]));
                [length(&gap)]
            }),
            Composite::Reflect => {
                self.each_few::<N2, N, S>(results, arguments, |a| reflect(&vector(a, 0), &vector(a, 1)));
            }
            Composite::Refract => {
                // Of the third argument, a float, one scalar is there; the rest is blank.
                self.each_few::<N3, N, S>(results, arguments, |a| refract(&vector(a, 0), &vector(a, 1), a[N2]));
            }
            Composite::Faceforward => self
                .each_few::<N3, N, S>(results, arguments, |a| faceforward(&vector(a, 0), &vector(a, 1), &vector(a, 2))),
            // `composite` has seen to these.
            Composite::Cross | Composite::Determinant | Composite::Inverse => {}
        }
    }

    /// Applies a function of at most `A` scalars with at most `R` results to a few lanes at a time.
    #[inline(always)]
    fn each_few<const A: usize, const R: usize, const S: usize>(
        &mut self,
        results: &[Operand],
        arguments: &[Operand],
        f: impl Fn(&[Few<Wide<D>, S>; A]) -> [Few<Wide<D>, S>; R],
    ) {
        let blank = Source::One(D::Float::default());
        let mut outs: [_; R] = std::array::from_fn(|_| self.floats.take());
        let sources: [Source<'_, D::Float>; A] =
            std::array::from_fn(|k| arguments.get(k).map_or(blank, |operand| self.float(*operand)));
        let same = sources.iter().all(|source| matches!(source, Source::One(_)));
        let (end, filled) = if same { (S, Filled::One) } else { (LANES, Filled::Lanes) };
        for start in (0..end).step_by(S) {
            let few: [Few<Wide<D>, S>; A] = std::array::from_fn(|k| match &sources[k] {
                Source::Lanes(lanes) => {
                    let lanes = &lanes[start..start + S];
                    Few(std::array::from_fn(|lane| lanes[lane].widen()))
                }
                Source::One(value) => Few([value.widen(); S]),
            });
            for (out, few) in outs.iter_mut().zip(f(&few)).take(results.len()) {
                out.fill(|lanes| {
                    for (lane, value) in lanes[start..start + S].iter_mut().zip(few.0) {
                        *lane = D::Float::narrow(value);
                    }
                    filled
                });
            }
        }
        for (place, out) in outs.into_iter().enumerate() {
            match results.get(place) {
                Some(operand) => self.floats.put(*operand, out),
                None => self.floats.give_back(out),
            }
        }
    }
}
