//! [`Source`]: what a primitive's fragments are interpolated from.
//!
//! *In:* a primitive and its vertices. *Out:* for each fragment the weights of the vertices, depth, `1/w` and varyings.
//! *Holds:* the equations are those of [`interpolate`](crate::cpu::interpolate). A segment has the weights `1 - t`, `t`
//! and 0, by which (108) and (106) are OpenGL's (3.6) and (3.7); a point has the weights 1, 0, 0.
//!
//! In a domain with envelopes the value is that of f64, and the interval is of our own making, for no specification has
//! one ([`Slack`]).

use super::assembly::{Corners, Prim};
use super::vertices::Vertices;
use crate::compare::Range;
use crate::cpu::domain::{Domain, F64, Number, rules};
use crate::cpu::interpolate::{Frame, Vec2, along, linear, perspective, perspective_w, weights};
use crate::hir::Interpolation;

/// An ULP of f32 at 1.
const ULP: f64 = 1.0 / (1 << 23) as f64;

/// The place of a fragment relative to a primitive.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fragment<F> {
    pub(super) weights: [F; 3],
    /// The reciprocal of `gl_FragCoord.w`.
    pub(super) w: F,
    /// `gl_FragCoord.w`
    pub(super) reciprocal: F,
    /// Window z.
    pub(super) z: F,
    place: [f64; 2],
}

/// How an f32 GPU that evaluates plane equations `a + b x + c y` from the corner of the window goes astray: each of its
/// roundings costs up to half an ULP of the largest term, and a vertex that is off moves the plane by its slope.
///
/// The terms are the slopes, as sums of the absolute values of their parts, times the distance from the corner.
#[derive(Clone, Copy, Debug)]
struct Slack {
    /// What differences of values along the first edge and the second give as slope in x.
    x: [f64; 2],
    /// Likewise in y.
    y: [f64; 2],
    /// How far the vertices may be off in x and y.
    off: [f64; 2],
    /// Where the first vertex is.
    origin: [f64; 2],
}

/// A primitive ready to be interpolated.
#[derive(Debug)]
pub(super) struct Source<'v, D: Domain> {
    kind: Kind<D>,
    /// The same by the values alone, in a domain with envelopes: what the vertices' places may be off is counted once, by
    /// [`Slack`].
    plain: Option<Kind<F64>>,
    quotients: [&'v [D::Float]; 3],
    /// Of the provoking vertex.
    flat: &'v [D::Float],
    pub(super) ints: &'v [D::Int],
    reciprocals: [D::Float; 3],
    z: [D::Float; 3],
    slack: Option<Slack>,
    pub(super) point: Option<Sprite<D>>,
}

#[derive(Debug)]
enum Kind<D: Domain> {
    Point,
    Line(Vec2<D::Float>, Vec2<D::Float>),
    Triangle(Frame<D::Float>),
}

/// How far a driver's size of a point may be from the one that is asked for: half of the granularity that it has for them
/// (OpenGL 3.2 §3.4.1), here of 1/256 pixel, the one of window positions.
const POINT_SIZE_ERROR: f64 = 0.5 / 256.0;

/// The square of a point, for `gl_PointCoord`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sprite<D: Domain> {
    center: Vec2<D::Float>,
    size: D::Float,
}

impl<D: Domain> Sprite<D> {
    /// Equations (3.3) and (3.4) with the origin at the upper left, which is OpenGL's default, in picture rows.
    pub(super) fn coordinates(&self, x: f64, y: f64) -> [D::Float; 2] {
        let half = D::Float::from_f64(0.5);
        let along = |p: f64, center: D::Float| {
            let exact = half.add(D::Float::from_f64(p).sub(center).div(self.size));
            let sized = (exact.value() - 0.5).abs() * POINT_SIZE_ERROR / self.size.value();
            exact.widened(sized + rules::POINT_COORD.absolute())
        };
        [along(x, self.center[0]), along(y, self.center[1])]
    }
}

impl<'v, D: Domain> Source<'v, D> {
    pub(super) fn new(prim: &Prim, vertices: &'v Vertices<D>) -> Self {
        let corners = match prim.corners {
            Corners::Point(vertex) => [vertex; 3],
            Corners::Line([from, to]) => [from, to, to],
            Corners::Triangle(corners) => corners,
        };
        let window = corners.map(|vertex| vertices.window.get(vertex as usize).copied().unwrap_or_default());
        let places = window.map(|[x, y, _, _]| [x, y]);
        let kind = Kind::<D>::of(&prim.corners, places);
        let is_point = matches!(kind, Kind::Point);
        let size = vertices.size.get(corners[0] as usize).copied().unwrap_or(1.0).max(1.0);
        let size = size.min(crate::cpu::raster::point::MAX_SIZE);
        Self {
            plain: D::OPEN.then(|| Kind::<F64>::of(&prim.corners, places.map(|place| place.map(Number::value)))),
            slack: D::OPEN.then(|| Slack::new(&kind, places.map(|p| p.map(|c: D::Float| (c.value(), c.error()))))),
            kind,
            quotients: corners.map(|vertex| vertices.quotients_of(vertex)),
            flat: vertices.floats_of(prim.provoking),
            ints: vertices.ints_of(prim.provoking),
            reciprocals: window.map(|[_, _, _, reciprocal]| reciprocal),
            z: window.map(|[_, _, z, _]| z),
            point: is_point.then(|| Sprite { center: places[0], size: D::Float::from_f64(f64::from(size)) }),
        }
    }

    /// The fragment whose center is at (x, y).
    #[inline(always)]
    pub(super) fn fragment(&self, x: f64, y: f64) -> Fragment<D::Float> {
        let zero = D::Float::default();
        let weights = match &self.plain {
            Some(kind) => kind.weights(x, y).map(|weight| D::Float::whole(weight, Range::point(weight))),
            None => self.kind.weights(x, y),
        };
        let mut fragment = Fragment { weights, w: zero, reciprocal: zero, z: zero, place: [x, y] };
        fragment.z = self.in_plane(&fragment, self.z);
        fragment.reciprocal = self.in_plane(&fragment, self.reciprocals);
        fragment.w = if self.slack.is_some() {
            D::Float::from_f64(1.0).div(fragment.reciprocal)
        } else {
            perspective_w(weights, self.reciprocals)
        };
        fragment
    }

    /// Equation (106), with the bound of its evaluation in f32.
    #[inline(always)]
    fn in_plane(&self, fragment: &Fragment<D::Float>, values: [D::Float; 3]) -> D::Float {
        match &self.slack {
            None => linear(fragment.weights, values),
            Some(slack) => slack.linear::<D>(fragment, values),
        }
    }

    /// A varying's scalar at a fragment.
    #[inline(always)]
    pub(super) fn varying(
        &self,
        fragment: &Fragment<D::Float>,
        index: usize,
        interpolation: Interpolation,
    ) -> D::Float {
        if interpolation == Interpolation::Flat || matches!(self.kind, Kind::Point) {
            return self.flat.get(index).copied().unwrap_or_default();
        }
        let values = self.quotients.map(|quotients| quotients.get(index).copied().unwrap_or_default());
        match (interpolation, &self.slack) {
            (Interpolation::Smooth, None) => perspective(fragment.weights, fragment.w, values),
            (Interpolation::Smooth, Some(slack)) => slack.linear::<D>(fragment, values).mul(fragment.w),
            (Interpolation::Noperspective | Interpolation::Flat, _) => self.in_plane(fragment, values),
        }
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

    /// The weights of the vertices at (x, y).
    #[inline(always)]
    fn weights(&self, x: f64, y: f64) -> [D::Float; 3] {
        let place = [D::Float::from_f64(x), D::Float::from_f64(y)];
        let zero = D::Float::default();
        match self {
            Self::Point => [D::Float::from_f64(1.0), zero, zero],
            Self::Line(from, to) => weights(along(place, *from, *to), zero),
            Self::Triangle(frame) => {
                let (u, v) = frame.coordinates(place);
                weights(u, v)
            }
        }
    }
}

impl Slack {
    fn new<D: Domain>(kind: &Kind<D>, places: [[(f64, f64); 2]; 3]) -> Self {
        let value = |corner: usize, axis: usize| places[corner][axis].0;
        let edge = |corner: usize| [0, 1].map(|axis| value(corner, axis) - value(0, axis));
        let (u, v) = (edge(1), edge(2));
        let (x, y) = match kind {
            Kind::Point => ([0.0; 2], [0.0; 2]),
            Kind::Line(..) => {
                let squared = u[0] * u[0] + u[1] * u[1];
                ([u[0] / squared, 0.0], [u[1] / squared, 0.0])
            }
            Kind::Triangle(_) => {
                let determinant = u[0] * v[1] - v[0] * u[1];
                ([v[1] / determinant, -u[1] / determinant], [-v[0] / determinant, u[0] / determinant])
            }
        };
        let off = [0, 1].map(|axis| (0..3).map(|corner| places[corner][axis].1).fold(0.0, f64::max));
        Self { x, y, off, origin: [value(0, 0), value(0, 1)] }
    }

    fn linear<D: Domain>(&self, fragment: &Fragment<D::Float>, values: [D::Float; 3]) -> D::Float {
        let plain = values.map(Number::value);
        let weights = fragment.weights.map(Number::value);
        let value = linear(weights, plain);
        let rise = [plain[1] - plain[0], plain[2] - plain[0]];
        let slope = |parts: [f64; 2]| parts[0] * rise[0] + parts[1] * rise[1];
        let size = |parts: [f64; 2]| (parts[0] * rise[0]).abs() + (parts[1] * rise[1]).abs();
        let [x, y] = fragment.place;
        let terms = size(self.x) * (x + self.origin[0].abs()) + size(self.y) * (y + self.origin[1].abs());
        let largest = plain.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let spread: f64 = weights.iter().map(|weight| weight.abs()).sum();
        let moved = spread * (slope(self.x).abs() * self.off[0] + slope(self.y).abs() * self.off[1]);
        let carried: f64 = weights.iter().zip(&values).map(|(weight, value)| weight.abs() * value.error()).sum();
        let rounded = rules::VARYING.ulps() * ULP * (terms + largest) + rules::ulp(value);
        D::Float::with_error(value, carried + moved + rounded)
    }
}
