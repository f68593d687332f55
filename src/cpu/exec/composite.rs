//! Built-in functions of whole vectors and matrices (§8.4, §8.5): computed in the domain's wide type, rounded once.
//!
//! The formulas are those that the specification names. A vector without length normalizes to NaN, a singular matrix
//! inverts to infinities or NaN: both are undefined in GLSL.

use super::LANES;
use super::inst::{Composite, Operand};
use super::registers::{Lanes, Registers, Source};
use crate::cpu::domain::{Domain, Number};

/// Lanes that are computed together, enough for every vector unit.
const STEP: usize = 8;

/// Some lanes of a scalar.
#[derive(Clone, Copy)]
struct Few<W>([W; STEP]);

impl<W: Number> Few<W> {
    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self([W::from_f64(value); STEP])
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

type Vector<W, const N: usize> = [Few<W>; N];

#[inline(always)]
fn dot<W: Number, const N: usize>(a: &Vector<W, N>, b: &Vector<W, N>) -> Few<W> {
    let mut sum = a[0].mul(b[0]);
    for k in 1..N {
        sum = sum.add(a[k].mul(b[k]));
    }
    sum
}

#[inline(always)]
fn length<W: Number, const N: usize>(a: &Vector<W, N>) -> Few<W> {
    dot(a, a).map(W::sqrt)
}

#[inline(always)]
fn normalize<W: Number, const N: usize>(a: &Vector<W, N>) -> Vector<W, N> {
    let scale = dot(a, a).map(W::inversesqrt);
    a.map(|component| component.mul(scale))
}

#[inline(always)]
fn cross<W: Number>(a: &Vector<W, 3>, b: &Vector<W, 3>) -> Vector<W, 3> {
    let minor = |i: usize, j: usize| a[i].mul(b[j]).sub(b[i].mul(a[j]));
    [minor(1, 2), minor(2, 0), minor(0, 1)]
}

/// `I - 2 dot(N, I) N`
#[inline(always)]
fn reflect<W: Number, const N: usize>(incident: &Vector<W, N>, normal: &Vector<W, N>) -> Vector<W, N> {
    let twice = dot(normal, incident).mul(Few::splat(2.0));
    std::array::from_fn(|k| incident[k].sub(twice.mul(normal[k])))
}

/// With `k = 1 - eta eta (1 - dot(N, I)^2)`: 0 if that is negative, else `eta I - (eta dot(N, I) + sqrt(k)) N`.
#[inline(always)]
fn refract<W: Number, const N: usize>(incident: &Vector<W, N>, normal: &Vector<W, N>, eta: Few<W>) -> Vector<W, N> {
    let one = Few::splat(1.0);
    let cosine = dot(normal, incident);
    let k = one.sub(eta.mul(eta).mul(one.sub(cosine.mul(cosine))));
    let along = eta.mul(cosine).add(k.map(|k| k.max(W::from_f64(0.0)).sqrt()));
    std::array::from_fn(|i| k.negative(Few::splat(0.0), eta.mul(incident[i]).sub(along.mul(normal[i]))))
}

/// `dot(Nref, I) < 0 ? N : -N`
#[inline(always)]
fn faceforward<W: Number, const N: usize>(
    normal: &Vector<W, N>,
    incident: &Vector<W, N>,
    reference: &Vector<W, N>,
) -> Vector<W, N> {
    let side = dot(reference, incident);
    std::array::from_fn(|k| side.negative(normal[k], normal[k].map(W::neg)))
}

/// The determinant of the columns and rows named, of a matrix of `size` columns.
fn minor<W: Number>(m: &[Few<W>], size: usize, columns: &[usize], rows: &[usize]) -> Few<W> {
    match (columns, rows) {
        ([c], [r]) => m[c * size + r],
        ([c, d], [r, s]) => m[c * size + r].mul(m[d * size + s]).sub(m[d * size + r].mul(m[c * size + s])),
        ([first, rest @ ..], _) => {
            let mut sum: Option<Few<W>> = None;
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

fn determinant<W: Number>(m: &[Few<W>], size: usize) -> Few<W> {
    let all = [0, 1, 2, 3];
    minor(m, size, &all[..size], &all[..size])
}

/// Cofactors over the determinant.
fn inverse<W: Number>(m: &[Few<W>], size: usize, out: &mut [Few<W>]) {
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
}

/// Consecutive arguments as one vector.
#[inline(always)]
fn vector<W: Copy, const N: usize>(arguments: &[W], place: usize) -> [W; N] {
    std::array::from_fn(|k| arguments[place * N + k])
}

/// The functions whose shape is a number of components.
#[inline(always)]
fn of_vectors<W: Number, const N: usize>(op: Composite, a: &[Few<W>], out: &mut [Few<W>]) {
    match op {
        Composite::Length => out[0] = length::<W, N>(&vector(a, 0)),
        Composite::Distance => {
            let (p, q) = (vector::<_, N>(a, 0), vector::<_, N>(a, 1));
            out[0] = length::<W, N>(&std::array::from_fn(|k| p[k].sub(q[k])));
        }
        Composite::Dot => out[0] = dot::<W, N>(&vector(a, 0), &vector(a, 1)),
        Composite::Normalize => out[..N].copy_from_slice(&normalize::<W, N>(&vector(a, 0))),
        Composite::Faceforward => {
            out[..N].copy_from_slice(&faceforward::<W, N>(&vector(a, 0), &vector(a, 1), &vector(a, 2)));
        }
        Composite::Reflect => out[..N].copy_from_slice(&reflect::<W, N>(&vector(a, 0), &vector(a, 1))),
        Composite::Refract => {
            out[..N].copy_from_slice(&refract::<W, N>(&vector(a, 0), &vector(a, 1), a[2 * N]));
        }
        Composite::Cross => out[..3].copy_from_slice(&cross(&vector(a, 0), &vector(a, 1))),
        Composite::Determinant => out[0] = determinant(a, N),
        Composite::Inverse => inverse(a, N, out),
    }
}

/// The most arguments: `faceforward` of `vec4` has 12, a `mat4` 16.
const MOST: usize = 16;

impl<D: Domain> Registers<D> {
    pub(super) fn composite(&mut self, op: Composite, size: u8, results: &[Operand], arguments: &[Operand]) {
        match size {
            1 => self.composite_of::<1>(op, results, arguments),
            2 => self.composite_of::<2>(op, results, arguments),
            3 => self.composite_of::<3>(op, results, arguments),
            _ => self.composite_of::<4>(op, results, arguments),
        }
    }

    fn composite_of<const N: usize>(&mut self, op: Composite, results: &[Operand], arguments: &[Operand]) {
        let mut outs: Vec<Lanes<D::Float>> = std::mem::take(&mut self.spare_floats);
        for start in (0..LANES).step_by(STEP) {
            let mut few = [Few([<D::Float as Number>::Wide::default(); STEP]); MOST];
            let mut out = [Few([<D::Float as Number>::Wide::default(); STEP]); MOST];
            for (few, operand) in few.iter_mut().zip(arguments) {
                few.0 = match self.float(*operand) {
                    Source::Lanes(lanes) => {
                        let lanes = &lanes[start..start + STEP];
                        std::array::from_fn(|lane| lanes[lane].widen())
                    }
                    Source::One(value) => [value.widen(); STEP],
                };
            }
            of_vectors::<_, N>(op, &few, &mut out);
            for (lanes, out) in outs.iter_mut().zip(&out).take(results.len()) {
                for (lane, value) in lanes[start..start + STEP].iter_mut().zip(out.0) {
                    *lane = D::Float::narrow(value);
                }
            }
        }
        for (operand, lanes) in results.iter().zip(&mut outs) {
            std::mem::swap(&mut self.floats[operand.number()], lanes);
        }
        self.spare_floats = outs;
    }
}
