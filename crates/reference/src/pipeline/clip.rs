//! Clips primitives in homogeneous coordinates (OpenGL 3.2 §2.19).
//!
//! *In:* shaded vertices. *Out:* the vertices of the remaining part of a primitive, with new ones added after the
//! others.
//!
//! *Holds:* the f32 positions determine which planes cut, and the order of cuts and vertices, which are those of
//! Mesa's vertex pipeline: x, y, near, far, then the clip distances, polygon by polygon. The position of a cut on an
//! edge is computed in each domain from its own positions. Afterwards `w > 0`, so equation (108) is valid everywhere.
//! Varyings of new vertices: `smooth` ones by the `t` of the cut (§2.19.1), `noperspective` ones by the `t` that is
//! linear in window space, `t w_in / w`. That is also correct where a driver derives it from a difference of
//! coordinates that may be 0. Where w is about 0, they are computed from their products with w.

use super::vertices::{Vertices, may_be_far};
use crate::domain::faults::Fault;
use crate::domain::{Domain, Number};
use glisten_front::hir::Interpolation;
use glisten_scene::picture::Interval;
use smallvec::SmallVec;

/// The six planes of the view volume.
const VOLUME: usize = 6;
/// The planes that are sides of the window, as a mask.
pub(super) const SIDES: u32 = 0b1111;

/// The corners of the remaining part of a triangle.
pub(super) type Polygon = SmallVec<[u32; 12]>;

/// A cut is at the eye if its w is at most this share of that of the ends of its edge.
const AT_EYE: f32 = 1.0 / 1024.0;

/// A vertex that a cut has added where w is about 0. Varyings that are linear in the window are large there, or infinite.
#[derive(Debug)]
pub(super) struct AtEye<F> {
    vertex: u32,
    /// Each `noperspective` varying times w.
    products: Vec<F>,
}

/// How far along an edge a plane cuts it: in the domain, from the f32 positions in f32, and from them in f64.
#[derive(Clone, Copy, Debug)]
struct Cut<F> {
    t: F,
    single: f32,
    double: f64,
}

impl<D: Domain> Vertices<D> {
    /// The distance of a vertex from a plane in f32, in the order of operations of a dot product with the plane.
    fn distance32(&self, vertex: u32, plane: usize) -> f32 {
        let [x, y, z, w] = self.clip32.get(vertex as usize).copied().unwrap_or_default();
        // Depth is clipped as in the target, where z is in [0, w].
        let halved = (z + w) * 0.5;
        match plane {
            0 => w - x,
            1 => x + w,
            2 => w - y,
            3 => y + w,
            4 => halved,
            5 => w - halved,
            _ => {
                let index = vertex as usize * self.distance_count + plane - VOLUME;
                self.distances32.get(index).copied().unwrap_or(0.0)
            }
        }
    }

    /// The distance in f64, up to a factor.
    fn distance64(&self, vertex: u32, plane: usize) -> f64 {
        let [x, y, z, w] = self.clip32.get(vertex as usize).copied().unwrap_or_default().map(f64::from);
        match plane {
            0 => w - x,
            1 => x + w,
            2 => w - y,
            3 => y + w,
            4 => z + w,
            5 => w - z,
            _ => f64::from(self.distance32(vertex, plane)),
        }
    }

    fn distance(&self, vertex: u32, plane: usize) -> D::Float {
        let [x, y, z, w] = self.clip.get(vertex as usize).copied().unwrap_or_default();
        match plane {
            0 => w.sub(x),
            1 => x.add(w),
            2 => w.sub(y),
            3 => y.add(w),
            4 => z.add(w),
            5 => w.sub(z),
            _ => {
                let index = vertex as usize * self.distance_count + plane - VOLUME;
                self.distances.get(index).copied().unwrap_or_default()
            }
        }
    }

    /// The planes that a vertex is outside; `None` if a coordinate is not finite.
    pub(super) fn outside(&self, vertex: u32) -> Option<u32> {
        self.outside.get(vertex as usize).copied().flatten()
    }

    /// Computes the planes that a vertex is outside.
    pub(super) fn find_outside(&self, vertex: u32) -> Option<u32> {
        let clip = self.clip32.get(vertex as usize)?;
        if !clip.iter().all(|value| value.is_finite()) {
            return None;
        }
        let mut mask = 0;
        for plane in 0..VOLUME + self.distance_count {
            let distance = self.distance32(vertex, plane);
            if distance.is_nan() {
                return None;
            }
            mask |= u32::from(distance < 0.0) << plane;
        }
        Some(mask)
    }

    /// Adds the vertex at `t` between `from` and `to`: `from + t (to - from)`.
    fn add_between(&mut self, from: u32, to: u32, cut: Cut<D::Float>) -> u32 {
        let Cut { t, single: t32, .. } = cut;
        let id = self.clip.len() as u32;
        let (a, b) = (from as usize, to as usize);
        let mix = |x: D::Float, y: D::Float, t: D::Float| x.add(t.mul(y.sub(x)));
        let mix32 = |x: f32, y: f32| x + t32 * (y - x);
        let clip: [D::Float; 4] = std::array::from_fn(|i| mix(self.clip[a][i], self.clip[b][i], t));
        let clip32: [f32; 4] = self.cut32(a, b, cut);
        let in_window = t.mul(self.clip[b][3]).div(clip[3]);
        let is_at_eye = clip32[3].abs() <= AT_EYE * self.clip32[a][3].abs().max(self.clip32[b][3].abs());
        let starts_at_eye = [a, b].map(|end| self.at_eye.iter().any(|one| one.vertex as usize == end));
        let mut products = Vec::new();
        self.clip.push(clip);
        self.clip32.push(clip32);
        self.size.push(mix(self.size[a], self.size[b], t));
        self.size32.push(mix32(self.size32[a], self.size32[b]));
        self.undecided.push(self.undecided[a] || self.undecided[b]);
        for i in 0..self.distance_count {
            let (x, y) = (a * self.distance_count + i, b * self.distance_count + i);
            self.distances.push(mix(self.distances[x], self.distances[y], t));
            self.distances32.push(mix32(self.distances32[x], self.distances32[y]));
        }
        for i in 0..self.float_count {
            let (x, y) = (self.floats[a * self.float_count + i], self.floats[b * self.float_count + i]);
            self.floats.push(match self.interpolations[i] {
                Interpolation::Smooth => mix(x, y, t),
                Interpolation::Noperspective => {
                    let is_excused = self.faults.excuses(Fault::ClippedNoperspective);
                    let share = if is_excused { self.lost_in_window(a, b) } else { 0.0 };
                    if is_at_eye || starts_at_eye != [false; 2] {
                        let (from, to) = (self.product(a, i), self.product(b, i));
                        // What is cut from here goes on with what the driver may have made of it.
                        let product = excused(mix(from, to, t), share, (to.value() - from.value()).abs());
                        products.push(product);
                        product.div(clip[3])
                    } else {
                        excused(mix(x, y, in_window), share, (y.value() - x.value()).abs())
                    }
                }
                // It is taken from the provoking vertex, never from here.
                Interpolation::Flat => x,
            });
        }
        if is_at_eye && !products.is_empty() {
            self.at_eye.push(AtEye { vertex: id, products });
        }
        for i in 0..self.int_count {
            self.ints.push(self.ints[a * self.int_count + i]);
        }
        self.finish_last();
        id
    }

    /// A `noperspective` varying times w, which is linear in clip space as well, and finite where w is 0.
    fn product(&self, vertex: usize, varying: usize) -> D::Float {
        let is_linear = |interpolation: &&Interpolation| **interpolation == Interpolation::Noperspective;
        let place = self.interpolations[..varying].iter().filter(is_linear).count();
        let kept = self.at_eye.iter().find(|one| one.vertex as usize == vertex);
        kept.and_then(|one| one.products.get(place).copied())
            .unwrap_or_else(|| self.floats[vertex * self.float_count + varying].mul(self.clip[vertex][3]))
    }

    /// The f32 position of a cut. If an end is so far out that f32 has no digits left for the cut, the position
    /// computed in f64: there, drivers draw anything or nothing.
    fn cut32(&self, from: usize, to: usize, cut: Cut<D::Float>) -> [f32; 4] {
        const FAR: f32 = 16384.0;
        let (a, b) = (self.clip32[from], self.clip32[to]);
        let near: [f32; 4] = std::array::from_fn(|i| a[i] + cut.single * (b[i] - a[i]));
        let reach = a.iter().chain(&b).fold(0.0_f32, |most, value| most.max(value.abs()));
        if reach <= FAR * near[3].abs() {
            return near;
        }
        let (a, b) = (a.map(f64::from), b.map(f64::from));
        std::array::from_fn(|i| (a[i] + cut.double * (b[i] - a[i])) as f32)
    }

    /// How far off a driver may be that, like Mesa 22.3, derives the position along an edge in window space only from
    /// the difference of its ends' x: infinitely, if that is 0.
    fn lost_in_window(&self, from: usize, to: usize) -> f64 {
        const ROUNDINGS: f64 = 8.0 * 5.960_464_477_539_063e-8;
        let x = |vertex: usize| f64::from(self.clip32[vertex][0]) / f64::from(self.clip32[vertex][3]);
        let (from, to) = (x(from), x(to));
        ROUNDINGS * from.abs().max(to.abs()) / (from - to).abs()
    }

    /// The cut of the edge from `from`, which is outside, to `to` by a plane.
    fn crossing(&self, from: u32, to: u32, plane: usize) -> Cut<D::Float> {
        let (outside, inside) = (self.distance32(from, plane), self.distance32(to, plane));
        let single = outside / (outside - inside);
        let (outside, inside) = (self.distance64(from, plane), self.distance64(to, plane));
        let double = outside / (outside - inside);
        let (outside, inside) = (self.distance(from, plane), self.distance(to, plane));
        let t = outside.div(outside.sub(inside));
        let usable = t.value() >= 0.0 && t.value() <= 1.0;
        Cut { t: if usable { t } else { D::Float::from_f64(f64::from(single)) }, single, double }
    }

    /// The planes of clip distances that may be on either side of these vertices, as far as an envelope knows: one of the distances may be
    /// off by as much as moves a cut along the whole edge.
    pub(super) fn open_planes(&self, corners: &[u32]) -> u32 {
        if !D::HAS_INTERVALS {
            return 0;
        }
        let is_open = |plane: &usize| {
            let distances = || corners.iter().map(|&vertex| self.distance(vertex, *plane));
            let largest = distances().fold(0.0_f64, |most, distance| most.max(distance.value().abs()));
            distances().any(|distance| may_be_far(distance, largest))
        };
        (VOLUME..VOLUME + self.distance_count).filter(is_open).fold(0, |planes, plane| planes | 1 << plane)
    }

    /// The planes that a point may be on either side of, as far as an envelope knows.
    pub(super) fn open_planes_of_point(&self, vertex: u32) -> u32 {
        if !D::HAS_INTERVALS {
            return 0;
        }
        let is_open = |plane: &usize| {
            let Interval { low, high, may_be_nan } = self.distance(vertex, *plane).interval();
            may_be_nan || low < 0.0 && high >= 0.0
        };
        (0..VOLUME + self.distance_count).filter(is_open).fold(0, |planes, plane| planes | 1 << plane)
    }

    /// The remaining part of a triangle: the corners of a convex polygon, or none. The planes of the set `without` cut nothing.
    pub(super) fn clip_triangle(&mut self, corners: [u32; 3], without: u32) -> Polygon {
        let outside = corners.map(|vertex| self.outside(vertex).map(|planes| planes & !without));
        let [Some(a), Some(b), Some(c)] = outside else { return Polygon::new() };
        let mut polygon = Polygon::from_slice(&corners);
        if a & b & c != 0 {
            return Polygon::new();
        }
        let crossed = a | b | c;
        for plane in (0..VOLUME + self.distance_count).filter(|plane| crossed >> plane & 1 == 1) {
            let mut left = Polygon::new();
            for (index, &vertex) in polygon.iter().enumerate() {
                let next = polygon[(index + 1) % polygon.len()];
                let (distance, next_distance) = (self.distance32(vertex, plane), self.distance32(next, plane));
                if !distance.is_finite() || !next_distance.is_finite() {
                    return Polygon::new();
                }
                if distance >= 0.0 {
                    left.push(vertex);
                }
                if (distance < 0.0) != (next_distance < 0.0) {
                    // The cut is measured from the vertex outside, whatever the direction of the edge.
                    let (outside, inside) = if distance < 0.0 { (vertex, next) } else { (next, vertex) };
                    let cut = self.crossing(outside, inside, plane);
                    left.push(self.add_between(outside, inside, cut));
                }
            }
            polygon = left;
            if polygon.len() < 3 {
                return Polygon::new();
            }
        }
        polygon
    }

    /// The remaining part of a line. The planes of the set `without` cut nothing.
    pub(super) fn clip_line(&mut self, [from, to]: [u32; 2], without: u32) -> Option<[u32; 2]> {
        let (a, b) = (self.outside(from)? & !without, self.outside(to)? & !without);
        if a & b != 0 {
            return None;
        }
        if a | b == 0 {
            return Some([from, to]);
        }
        // From each end, the farthest cut by a plane that this end is outside of.
        let mut start = Cut { t: D::Float::default(), single: 0.0, double: 0.0 };
        let mut end = start;
        for plane in (0..VOLUME + self.distance_count).filter(|plane| (a | b) >> plane & 1 == 1) {
            if a >> plane & 1 == 1 {
                let cut = self.crossing(from, to, plane);
                start = if cut.single > start.single { cut } else { start };
            }
            if b >> plane & 1 == 1 {
                let cut = self.crossing(to, from, plane);
                end = if cut.single > end.single { cut } else { end };
            }
        }
        if start.single + end.single >= 1.0 {
            return None;
        }
        let first = if a == 0 { from } else { self.add_between(from, to, start) };
        let last = if b == 0 { to } else { self.add_between(to, from, end) };
        Some([first, last])
    }
}

/// A varying that a driver may get wrong by a share of its difference along the edge. If that is not small, the
/// difference of x may be 0, and the driver's result NaN.
fn excused<F: Number>(value: F, share: f64, difference: f64) -> F {
    const SMALL: f64 = 1.0 / 64.0;
    if share == 0.0 {
        value
    } else if share <= SMALL {
        value.widened(share * difference)
    } else {
        F::with_interval(value.value(), Interval::ALL)
    }
}
