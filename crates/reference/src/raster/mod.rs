//! Rasterization: which fragments a primitive produces (OpenGL 3.2 §3.4 to §3.6).
//!
//! *In:* window positions in f32. *Out:* a [`Shape`] in integers, which reports the pixels that it covers for one
//! rectangle at a time.
//!
//! *Holds:* coverage is decided in units of 1/256 pixel, in integers without rounding, and so is the same in every
//! domain. Rows are those of the picture, the top row first, and the top-left rule refers to them: a pixel whose
//! center is on a top or left edge is covered, on another edge it is not, so that pixels along a shared edge are
//! drawn once. Positions are snapped as by Mesa's software drivers: `(x - 0.5) * 256`, rounded to nearest, half to
//! even.
//!
//! *Not done here:* the fragments' values ([`interpolate`](super::interpolate)), clipping.

pub(crate) mod band;
pub(crate) mod line;
pub(crate) mod point;
pub(crate) mod triangle;

use pulp::{Simd, WithSimd};

/// Units of the fixed-point grid in a pixel.
pub(crate) const ONE: i64 = 256;

/// Half the width of the band around an edge within which `near_edge` is marked, in units of the grid: 1/128 pixel.
/// Devices with a coarser grid, and positions with an envelope, have a [wider](Shape::widened) one.
pub(crate) const NEAR: f64 = 2.0;

/// A window position in units of the grid; pixel centers are at multiples of [`ONE`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fixed {
    pub(crate) x: i64,
    pub(crate) y: i64,
}

impl Fixed {
    /// Snaps a window position in pixels. Returns `None` for coordinates that are not finite or further out than 2^21
    /// pixels, so that products of differences fit 64 bits.
    pub(crate) fn snap(x: f32, y: f32) -> Option<Self> {
        let snap = |value: f32| {
            let scaled = (value - 0.5) * ONE as f32;
            (scaled.abs() < (1_u64 << 29) as f32).then(|| scaled.round_ties_even() as i64)
        };
        Some(Self { x: snap(x)?, y: snap(y)? })
    }
}

/// A rectangle of pixels, upper bounds exclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bounds {
    pub(crate) x0: i64,
    pub(crate) x1: i64,
    pub(crate) y0: i64,
    pub(crate) y1: i64,
}

impl Bounds {
    /// The intersection of two rectangles; may be empty.
    pub(crate) fn intersect(self, other: Self) -> Self {
        Self {
            x0: self.x0.max(other.x0),
            x1: self.x1.min(other.x1),
            y0: self.y0.max(other.y0),
            y1: self.y1.min(other.y1),
        }
    }
}

/// A half plane of pixels: those where `value(x, y) >= 0`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Edge {
    /// The value at pixel (0, 0), including the fill rule.
    pub(crate) origin: i64,
    /// The increment for the next pixel to the right.
    pub(crate) step_x: i64,
    /// The increment for the next pixel down.
    pub(crate) step_y: i64,
    /// A pixel's center is near the edge if the absolute value is at most this.
    pub(crate) near: i64,
}

impl Edge {
    /// The half plane to the right of the direction from `from` to `to`, as seen in the picture.
    pub(crate) fn new(from: Fixed, to: Fixed) -> Self {
        let (dx, dy) = (to.x - from.x, to.y - from.y);
        // The inside is below a top edge, which runs right, and right of a left edge, which runs up.
        let is_top_or_left = dy < 0 || (dy == 0 && dx > 0);
        let exact = dy * from.x - dx * from.y;
        Self {
            origin: exact - i64::from(!is_top_or_left),
            step_x: -dy * ONE,
            step_y: dx * ONE,
            near: ((dx as f64).hypot(dy as f64) * NEAR).ceil() as i64,
        }
    }

    /// The value at a pixel.
    #[inline(always)]
    pub(crate) fn at(&self, x: i64, y: i64) -> i64 {
        self.origin + self.step_x * x + self.step_y * y
    }

    /// The largest value in a rectangle of pixels.
    fn largest(&self, area: Bounds) -> i64 {
        let x = if self.step_x > 0 { area.x1 - 1 } else { area.x0 };
        let y = if self.step_y > 0 { area.y1 - 1 } else { area.y0 };
        self.at(x, y)
    }
}

/// The pixels of a primitive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Shape {
    /// The pixels inside `bounds` and all of the edges, of which there may be none.
    Convex {
        /// The bounds, as tight as possible.
        bounds: Bounds,
        /// The edges, at most four.
        edges: [Edge; 4],
        /// The number of edges.
        count: usize,
    },
    /// These pixels, in order.
    Pixels(Vec<(i64, i64)>),
}

impl Shape {
    /// A rectangle that contains all of its pixels, and those near its edges.
    pub(crate) fn bounds(&self) -> Bounds {
        match self {
            Self::Convex { bounds, .. } => *bounds,
            Self::Pixels(pixels) => {
                let empty = Bounds { x0: i64::MAX, x1: i64::MIN, y0: i64::MAX, y1: i64::MIN };
                pixels.iter().fold(empty, |b, &(x, y)| Bounds {
                    x0: b.x0.min(x),
                    x1: b.x1.max(x + 1),
                    y0: b.y0.min(y),
                    y1: b.y1.max(y + 1),
                })
            }
        }
    }

    /// The shape with a wider band around its edges, by some units of the grid to either side.
    pub(crate) fn widened(mut self, units: f64) -> Self {
        /// Far enough for any window.
        const MOST: f64 = (1_u64 << 24) as f64;
        if let Self::Convex { bounds, edges, count } = &mut self
            && *count > 0
            && units > 0.0
        {
            let units = units.min(MOST);
            for edge in edges.iter_mut().take(*count) {
                let length = (edge.step_x as f64).hypot(edge.step_y as f64) / ONE as f64;
                edge.near += (length * units).ceil() as i64;
            }
            let pixels = (units / ONE as f64).ceil() as i64;
            let Bounds { x0, x1, y0, y1 } = *bounds;
            *bounds = Bounds { x0: x0 - pixels, x1: x1 + pixels, y0: y0 - pixels, y1: y1 + pixels };
        }
        self
    }

    /// Whether it may cover a pixel of `area`, or have one near an edge.
    pub(crate) fn may_touch(&self, area: Bounds) -> bool {
        match self {
            Self::Convex { edges, count, .. } => {
                edges.iter().take(*count).all(|edge| edge.largest(area) >= -edge.near - 1)
            }
            Self::Pixels(pixels) => {
                pixels.iter().any(|&(x, y)| x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1)
            }
        }
    }

    /// Calls `emit` with the covered pixels of `area`, each once, several of a row at a time: the row, a column, and
    /// the set of pixels from there (bit `i` is the `i`th to the right).
    #[inline(always)]
    pub(crate) fn rows(&self, area: Bounds, mut emit: impl FnMut(i64, i64, u64)) {
        match self {
            Self::Convex { bounds, edges, count } => {
                blocks(edges, *count, bounds.intersect(area), |x, y, rows| {
                    for (y, &pixels) in (y..).zip(rows).filter(|(_, pixels)| **pixels != 0) {
                        emit(y, x, pixels);
                    }
                });
            }
            Self::Pixels(pixels) => {
                for &(x, y) in pixels {
                    if x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1 {
                        emit(y, x, 1);
                    }
                }
            }
        }
    }

    /// Calls `emit` with each quad of 2x2 pixels (whose corner is even) that contains a covered pixel of `area`: its
    /// upper left pixel, and which pixels are covered (bit 0 upper left, 1 upper right, 2 lower left, 3 lower right).
    /// A convex shape reports each quad once.
    #[inline(always)]
    pub(crate) fn quads(&self, area: Bounds, mut emit: impl FnMut(i64, i64, u32)) {
        match self {
            Self::Convex { bounds, edges, count } => {
                let inside = bounds.intersect(area);
                let whole = Bounds { x0: inside.x0 & !1, y0: inside.y0 & !1, ..inside };
                blocks(edges, *count, whole, |x, y, rows| {
                    let first = if x < inside.x0 { !1 } else { !0 };
                    for (y, pair) in (y..).step_by(2).zip(rows.chunks(2)) {
                        let upper = if y < inside.y0 { 0 } else { pair[0] & first };
                        let lower = pair.get(1).map_or(0, |row| row & first);
                        let mut rest = upper | lower;
                        while rest != 0 {
                            let at = rest.trailing_zeros() & !1;
                            emit(x + i64::from(at), y, (upper >> at & 0b11 | (lower >> at & 0b11) << 2) as u32);
                            rest &= !(0b11 << at);
                        }
                    }
                });
            }
            Self::Pixels(pixels) => {
                for &(x, y) in pixels {
                    if x >= area.x0 && x < area.x1 && y >= area.y0 && y < area.y1 {
                        emit(x & !1, y & !1, 1 << ((x & 1) + 2 * (y & 1)));
                    }
                }
            }
        }
    }
}

/// The width of a block, in pixels; even.
const WIDTH: usize = 64;
/// The height of a block; even.
const HEIGHT: usize = 32;

/// Calls `emit` with the pixels of `area` inside all edges, block by block: the upper left pixel of the block, and
/// the set of pixels in each of its rows.
#[inline(always)]
fn blocks(edges: &[Edge; 4], count: usize, area: Bounds, mut emit: impl FnMut(i64, i64, &[u64])) {
    let mut rows = [0; HEIGHT];
    for y in (area.y0..area.y1).step_by(HEIGHT) {
        for x in (area.x0..area.x1).step_by(WIDTH) {
            let block = Bounds { x0: x, x1: area.x1.min(x + WIDTH as i64), y0: y, y1: area.y1.min(y + HEIGHT as i64) };
            let rows = &mut rows[..(block.y1 - y) as usize];
            match *edges {
                [a, b, c, _] if count <= 3 => pulp::Arch::new().dispatch(Block { edges: [a, b, c], block, rows }),
                edges => pulp::Arch::new().dispatch(Block { edges, block, rows }),
            }
            emit(x, y, rows);
        }
    }
}

/// Computes the covered pixels of a block, in a loop to compile for wide vectors. `EDGES` edges are tested.
struct Block<'r, const EDGES: usize> {
    edges: [Edge; EDGES],
    block: Bounds,
    rows: &'r mut [u64],
}

impl<const EDGES: usize> WithSimd for Block<'_, EDGES> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        /// The number of pixels that are decided together.
        const LANES: usize = 4;
        let Self { edges, block, rows } = self;
        let width = (block.x1 - block.x0) as usize;
        let mut starts = edges.map(|edge| {
            let first = edge.at(block.x0, block.y0);
            [0, 1, 2, 3].map(|pixel| first + pixel * edge.step_x)
        });
        for row in rows {
            let mut values = starts;
            let mut covered = [0; LANES];
            let mut bits = [1_u64, 2, 4, 8];
            for _ in 0..width.div_ceil(LANES) {
                // The sign bit stays set if an edge excludes the pixel.
                let mut signs = [0_i64; LANES];
                for (values, edge) in values.iter_mut().zip(&edges) {
                    for lane in 0..LANES {
                        signs[lane] |= values[lane];
                        values[lane] += LANES as i64 * edge.step_x;
                    }
                }
                for lane in 0..LANES {
                    covered[lane] |= !(signs[lane] >> 63) as u64 & bits[lane];
                    bits[lane] <<= LANES;
                }
            }
            *row = covered.iter().fold(0, |all, lane| all | lane) & u64::MAX >> (WIDTH - width);
            for (start, edge) in starts.iter_mut().zip(&edges) {
                for value in start {
                    *value += edge.step_y;
                }
            }
        }
    }
}
