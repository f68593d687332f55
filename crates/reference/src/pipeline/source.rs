//! [`Source`]: the primitive from which fragments are interpolated.
//!
//! *In:* a primitive and its vertices, and the positions of its fragments. *Out:* for each fragment the weights of
//! the vertices, depth, `1/w` and varyings, many fragments at a time ([`Fragments`]). *Holds:* the equations are
//! those of [`interpolate`](crate::interpolate). A segment has the weights `1 - t`, `t` and 0, with which (108) and
//! (106) are OpenGL's (3.6) and (3.7); a point has the weights 1, 0, 0.
//!
//! In a domain with envelopes, the value is that of f64. The interval is defined by glisten ([`Slack`]), since no
//! specification defines one.

use super::assembly::{Corners, Prim};
use super::slack::{Plane, Slack};
use super::sloped::SlopedPlane;
use super::surface::BIN;
use super::tilt::Tilted;
use super::vertices::Vertices;
use crate::domain::limits::POINT_SIZE_ERROR;
use crate::domain::{Domain, Element, F64, Number, NumberBlock, Planes, WIDTH, rules};
use crate::exec::LANES;
use crate::interpolate::{Eight, Frame, Vec2, along, linear, perspective, perspective_w, weights};
use glisten_front::hir::Interpolation;
use glisten_scene::picture::Interval;
use std::ops::Range;

/// The positions of fragments, lane by lane.
#[derive(Debug)]
pub(super) struct Places<D: Domain> {
    /// Window x and y of their centers, in picture rows.
    pub(super) x: [f64; LANES],
    pub(super) y: [f64; LANES],
    /// The weights of the second and the third vertex.
    weights: [[D::Float; LANES]; 2],
    /// The weights from the values alone, in a domain with envelopes: [`Slack`] already accounts for errors of the
    /// vertices' positions.
    plain: [[f64; LANES]; 2],
}

impl<D: Domain> Places<D> {
    /// The weights in some lanes, in a domain without envelopes.
    #[inline(always)]
    fn weights(&self, lanes: Range<usize>) -> impl Iterator<Item = [D::Float; 3]> {
        let [u, v] = &self.weights;
        u[lanes.clone()].iter().zip(&v[lanes]).map(|(u, v)| weights(*u, *v))
    }

    /// The weights in eight lanes from `start` of some.
    #[inline(always)]
    fn weights_of_eight(&self, lanes: &Range<usize>, start: usize) -> [Eight<D::Float>; 3] {
        let [u, v] = self.weights.each_ref().map(|weights| Eight::from(&weights[lanes.clone()], start));
        weights(u, v)
    }
}

/// Fragments, lane by lane: their pixels, and the values that every program needs.
#[derive(Debug)]
pub(super) struct Fragments<D: Domain> {
    /// The indices of their pixels in the bin.
    pub(super) pixels: [u32; LANES],
    pub(super) places: Places<D>,
    /// Window z.
    pub(super) z: [D::Float; LANES],
    /// `gl_FragCoord.w`
    pub(super) reciprocal: [D::Float; LANES],
    /// The reciprocal of that.
    w: [D::Float; LANES],
}

impl<D: Domain> Fragments<D> {
    pub(super) fn new() -> Self {
        let blank = [D::Float::default(); LANES];
        let places = Places { x: [0.0; LANES], y: [0.0; LANES], weights: [blank; 2], plain: [[0.0; LANES]; 2] };
        Self { pixels: [0; LANES], places, z: blank, reciprocal: blank, w: blank }
    }

    /// Moves the values of `COUNT` fragments to other lanes.
    #[inline(always)]
    pub(super) fn shift<const COUNT: usize>(&mut self, from: usize, to: usize) {
        let from = from..from + COUNT;
        self.pixels.copy_within(from.clone(), to);
        self.z.copy_within(from.clone(), to);
        let Places { x, y, weights, plain } = &mut self.places;
        x.copy_within(from.clone(), to);
        y.copy_within(from.clone(), to);
        if D::HAS_INTERVALS {
            plain.iter_mut().for_each(|lanes| lanes.copy_within(from.clone(), to));
        } else {
            weights.iter_mut().for_each(|lanes| lanes.copy_within(from.clone(), to));
        }
    }
}

/// A primitive prepared for interpolation.
#[derive(Debug)]
pub(super) struct Source<'v, D: Domain> {
    kind: Kind<D>,
    /// In domains with intervals.
    plain: Option<Plain>,
    quotients: [&'v [D::Float]; 3],
    /// The values that the quotients are of.
    values: [&'v [D::Float]; 3],
    /// The values of the provoking vertex.
    flat: &'v [D::Float],
    pub(super) ints: &'v [D::Int],
    reciprocals: [D::Float; 3],
    z: [D::Float; 3],
    pub(super) point: Option<Sprite<D>>,
}

/// The primitive by its values alone, and the largest error of a GPU.
#[derive(Debug)]
struct Plain {
    kind: Kind<F64>,
    slack: Slack,
}

#[derive(Debug)]
enum Kind<D: Domain> {
    Point,
    Line(Vec2<D::Float>, Vec2<D::Float>),
    Triangle(Frame<D::Float>),
}

/// The square of a point, for `gl_PointCoord`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sprite<D: Domain> {
    center: Vec2<D::Float>,
    size: D::Float,
}

impl<D: Domain> Sprite<D> {
    /// Equations (3.3) and (3.4), with the origin at the upper left, which is OpenGL's default, in picture rows.
    pub(super) fn coordinates(&self, x: f64, y: f64) -> [D::Float; 2] {
        let half = D::Float::from_f64(0.5);
        let along = |p: f64, center: D::Float| {
            let off = D::Float::from_f64(D::point_size_share() * POINT_SIZE_ERROR);
            let size = if D::point_size_share() == 0.0 { self.size } else { self.size.add(off) };
            let exact = half.add(D::Float::from_f64(p).sub(center).div(size));
            let sized = (exact.value() - 0.5).abs() * POINT_SIZE_ERROR / self.size.value();
            exact.widened(sized + const { rules::POINT_COORD.absolute() })
        };
        [along(x, self.center[0]), along(y, self.center[1])]
    }
}

impl<'v, D: Domain> Source<'v, D> {
    /// Whether the domain computes eight numbers at once faster than one by one.
    const BY_EIGHT: bool = <D::Float as Element>::Block::OWN && !D::HAS_INTERVALS;

    pub(super) fn new(prim: &Prim, vertices: &'v Vertices<D>) -> Self {
        let corners = match prim.corners {
            Corners::Point(vertex) => [vertex; 3],
            Corners::Line([from, to]) => [from, to, to],
            Corners::Triangle(corners) => corners,
        };
        let window = corners.map(|vertex| vertices.window.get(vertex as usize).copied().unwrap_or_default());
        let places = window.map(|[x, y, _, _]| [x, y]);
        let places = match D::positions() {
            Some(steps) => places.map(|place| place.map(|at| D::Float::from_f64(steps.nearest(at.value())))),
            None => places,
        };
        let displaced = vertices.profile.displacement();
        let kind = Kind::<D>::of(&prim.corners, places);
        let is_point = matches!(kind, Kind::Point);
        let [least, most] = [1.0, f64::from(crate::raster::point::MAX_SIZE)].map(D::Float::from_f64);
        let size = vertices.size.get(corners[0] as usize).copied().unwrap_or(least).max(least).min(most);
        Self {
            kind,
            plain: D::HAS_INTERVALS.then(|| Plain {
                kind: Kind::of(&prim.corners, places.map(|place| place.map(Number::value))),
                slack: Slack::new(
                    &prim.corners,
                    places.map(|p| p.map(|c: D::Float| (c.value(), c.error() + displaced))),
                ),
            }),
            quotients: corners.map(|vertex| vertices.quotients_of(vertex)),
            values: corners.map(|vertex| vertices.floats_of(vertex)),
            flat: vertices.floats_of(prim.provoking),
            ints: vertices.ints_of(prim.provoking),
            reciprocals: window.map(|[_, _, _, reciprocal]| reciprocal),
            z: window.map(|[_, _, z, _]| z),
            point: is_point.then(|| Sprite { center: places[0], size }),
        }
    }

    /// Computes the weights and depth of the fragments in some lanes, in a bin with this corner.
    #[inline(always)]
    pub(super) fn locate(&self, fragments: &mut Fragments<D>, [x0, y0]: [i32; 2], lanes: Range<usize>) {
        let Fragments { pixels, places, z, .. } = fragments;
        let (x, y) = (&mut places.x[lanes.clone()], &mut places.y[lanes.clone()]);
        for ((x, y), &pixel) in x.iter_mut().zip(y.iter_mut()).zip(&pixels[lanes.clone()]) {
            let pixel = pixel as i32;
            *x = f64::from(x0 + pixel % BIN as i32) + 0.5;
            *y = f64::from(y0 + pixel / BIN as i32) + 0.5;
        }
        match &self.plain {
            Some(plain) => plain.kind.weights(x, y, places.plain.each_mut().map(|to| &mut to[lanes.clone()])),
            None => self.kind.weights(x, y, places.weights.each_mut().map(|to| &mut to[lanes.clone()])),
        }
        self.in_plane(self.z, places, lanes.clone(), &mut z[lanes]);
    }

    /// Computes `gl_FragCoord.w` of fragments whose weights are known, and its reciprocal.
    #[inline(always)]
    pub(super) fn find_w(&self, fragments: &mut Fragments<D>, lanes: Range<usize>) {
        let Fragments { places, reciprocal, w, .. } = fragments;
        let (reciprocal, w) = (&mut reciprocal[lanes.clone()], &mut w[lanes.clone()]);
        self.in_plane(self.reciprocals, places, lanes.clone(), reciprocal);
        if Self::BY_EIGHT && self.is_sloped() {
            Eight::fill(
                w,
                #[inline(always)]
                |start| Eight::from(reciprocal, start).reciprocal(),
            );
        } else if self.plain.is_some() || self.is_sloped() {
            for (w, reciprocal) in w.iter_mut().zip(reciprocal) {
                *w = D::Float::from_f64(1.0).div(*reciprocal);
            }
        } else if Self::BY_EIGHT {
            let reciprocals = self.reciprocals.map(Eight::splat);
            Eight::fill(
                w,
                #[inline(always)]
                |start| perspective_w(places.weights_of_eight(&lanes, start), reciprocals),
            );
        } else {
            for (w, weights) in w.iter_mut().zip(places.weights(lanes)) {
                *w = perspective_w(weights, self.reciprocals);
            }
        }
    }

    /// Whether it is interpolated by slopes instead of weights.
    #[inline(always)]
    fn is_sloped(&self) -> bool {
        D::planes() != Planes::Weights && matches!(self.kind, Kind::Triangle(_))
    }

    /// Equation (106), with the bound of its evaluation in f32.
    #[inline(always)]
    fn in_plane(&self, values: [D::Float; 3], places: &Places<D>, lanes: Range<usize>, to: &mut [D::Float]) {
        match &self.plain {
            Some(plain) => {
                let plane = Plane::new(&plain.slack, values);
                let [u, v] = places.plain.each_ref().map(|weights| &weights[lanes.clone()]);
                plane.fill([u, v, &places.x[lanes.clone()], &places.y[lanes]], to);
            }
            None => {
                if let (Kind::Triangle(frame), true) = (&self.kind, self.is_sloped()) {
                    let plane = SlopedPlane::new(frame, values, D::planes()).map(Eight::splat);
                    let (x, y) = (&places.x[lanes.clone()], &places.y[lanes]);
                    return Eight::fill(
                        to,
                        #[inline(always)]
                        |start| plane.at([Eight::of_values(x, start), Eight::of_values(y, start)]),
                    );
                }
                if Self::BY_EIGHT {
                    let values = values.map(Eight::splat);
                    return Eight::fill(
                        to,
                        #[inline(always)]
                        |start| linear(places.weights_of_eight(&lanes, start), values),
                    );
                }
                for (to, weights) in to.iter_mut().zip(places.weights(lanes)) {
                    *to = linear(weights, values);
                }
            }
        }
    }

    /// A scalar of a varying at the fragments in some lanes, whose `w` is known.
    #[inline(always)]
    pub(super) fn varying(
        &self,
        fragments: &Fragments<D>,
        lanes: Range<usize>,
        (index, interpolation): (usize, Interpolation),
        to: &mut [D::Float],
    ) {
        if interpolation == Interpolation::Flat || matches!(self.kind, Kind::Point) {
            let value = self.flat.get(index).copied().unwrap_or_default();
            to.fill(if self.is_scaled(interpolation) { of_point(value) } else { value });
            return;
        }
        let values = self.quotients.map(|quotients| quotients.get(index).copied().unwrap_or_default());
        let Fragments { places, w, .. } = fragments;
        let w = &w[lanes.clone()];
        match (interpolation, &self.plain) {
            (Interpolation::Smooth, None) => {
                if !self.is_sloped()
                    && let Some(value) = self.same_at_all(index)
                {
                    to.fill(value);
                    return;
                }
                if Self::BY_EIGHT {
                    self.in_plane(values, places, lanes, to);
                    for start in (0..to.len()).step_by(WIDTH) {
                        let found = Eight::from(to, start).times(Eight::from(w, start));
                        found.store(&mut to[start..]);
                    }
                    return;
                }
                for ((to, weights), w) in to.iter_mut().zip(places.weights(lanes)).zip(w) {
                    *to = perspective(weights, *w, values);
                }
            }
            (Interpolation::Smooth, Some(_)) => {
                self.in_plane(values, places, lanes, to);
                for (to, w) in to.iter_mut().zip(w) {
                    *to = to.mul(*w);
                }
            }
            (Interpolation::Noperspective | Interpolation::Flat, _) => self.in_plane(values, places, lanes, to),
        }
    }
}

/// The value of a point's vertex, with the error of a GPU that interpolates it like that of a triangle.
fn of_point<F: Number>(value: F) -> F {
    let size = value.value();
    if size.is_finite() { value.widened(const { rules::POINT_VARYING.ulps() } * rules::ulp(size)) } else { value }
}

impl<D: Domain> Source<'_, D> {
    /// Whether it is a point whose varyings a GPU may divide by w, and multiply by it again.
    fn is_scaled(&self, interpolation: Interpolation) -> bool {
        let w = self.reciprocals[0];
        D::HAS_INTERVALS
            && interpolation == Interpolation::Smooth
            && matches!(self.kind, Kind::Point)
            && !(w.value() == 1.0 && w.error() == 0.0)
    }

    /// The part of the error of a varying that neighbors do not share, at the fragments in some lanes.
    pub(super) fn noise(
        &self,
        fragments: &Fragments<D>,
        lanes: Range<usize>,
        (index, interpolation): (usize, Interpolation),
        to: &mut [D::Float],
    ) {
        let plain = match &self.plain {
            Some(plain) if interpolation != Interpolation::Flat && !matches!(self.kind, Kind::Point) => plain,
            // The same number at all fragments.
            _ => return to.fill(D::Float::default()),
        };
        let values = self.quotients.map(|quotients| quotients.get(index).copied().unwrap_or_default());
        let (value, reciprocal) = (Tilted::new(&plain.slack, values), Tilted::new(&plain.slack, self.reciprocals));
        let Fragments { places: Places { x, y, plain: [u, v], .. }, .. } = fragments;
        for (to, lane) in to.iter_mut().zip(lanes) {
            let place = [x[lane], y[lane]];
            let weights = weights(u[lane], v[lane]);
            let noise = match interpolation {
                Interpolation::Smooth => value.noise_over(&reciprocal, weights, place),
                Interpolation::Noperspective | Interpolation::Flat => value.noise(weights, place),
            };
            *to = D::Float::integer_with_interval(noise, Interval::point(noise));
        }
    }

    /// The value of a varying that is the same at all vertices: it is interpolated to that very value, as
    /// [`linear`] does in the window. Programs compare such values for equality, and what is known of them is a constant.
    /// A GPU that interpolates quotients by slopes is off by an ULP or two, and a simulated one is, too.
    #[inline(always)]
    fn same_at_all(&self, index: usize) -> Option<D::Float> {
        let [a, b, c] = self.values.map(|values| values.get(index).copied().unwrap_or_default());
        let bits = |x: D::Float| (x.value().to_bits(), x.second().to_bits());
        (bits(a) == bits(b) && bits(a) == bits(c) && a.value().is_finite()).then_some(a)
    }
}

impl<D: Domain> Kind<D> {
    fn of(corners: &Corners, places: [Vec2<D::Float>; 3]) -> Self {
        match corners {
            Corners::Point(_) => Self::Point,
            Corners::Line(_) => Self::Line(places[0], places[1]),
            Corners::Triangle(_) => Self::Triangle(Frame::new(places[0], places[1], places[2])),
        }
    }

    /// The weights of the second and the third vertex at these positions.
    #[inline(always)]
    fn weights(&self, x: &[f64], y: &[f64], [second, third]: [&mut [D::Float]; 2]) {
        let places = x.iter().zip(y).map(|(x, y)| [D::Float::from_f64(*x), D::Float::from_f64(*y)]);
        let to = second.iter_mut().zip(third.iter_mut());
        let zero = D::Float::default();
        match self {
            Self::Point => to.for_each(|(u, v)| (*u, *v) = (zero, zero)),
            Self::Line(from, end) => {
                to.zip(places).for_each(|((u, v), place)| (*u, *v) = (along(place, *from, *end), zero));
            }
            Self::Triangle(frame) if Source::<D>::BY_EIGHT => {
                let frame = frame.map(Eight::splat);
                for start in (0..second.len()).step_by(WIDTH) {
                    let place = [x, y].map(|values| Eight::of_values(values, start));
                    let (u, v) = frame.coordinates(place);
                    u.store(&mut second[start..]);
                    v.store(&mut third[start..]);
                }
            }
            Self::Triangle(frame) => {
                to.zip(places).for_each(|((u, v), place)| (*u, *v) = frame.coordinates(place));
            }
        }
    }
}
