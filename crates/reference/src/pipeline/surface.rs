//! [`Surface`]: the colors of the picture during drawing.
//!
//! *In:* a framebuffer. *Out:* the [`Picture`]. *Holds:* each pixel has its final position in memory, so that nothing
//! is copied at the end; bins own pieces of the rows. A number of a domain with envelopes is stored as its value and
//! its interval, from which the same number can be restored.

use super::store::store;
use crate::domain::{Domain, Number};
use glisten_scene::Framebuffer;
use glisten_scene::picture::{Interval, Picture};
use rayon::prelude::*;

/// The side of a bin in pixels; it is even, so that quads are within one bin.
pub(super) const BIN: i64 = 32;

/// The contents of the attachments.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    pub(super) framebuffer: Framebuffer,
    pub(super) attachments: Vec<Attachment>,
}

/// The contents of an attachment, row by row.
#[derive(Clone, Debug)]
pub(super) struct Attachment {
    colors: Vec<[f64; 4]>,
    /// Empty in domains without envelopes.
    intervals: Vec<[Interval; 4]>,
}

/// Which pixels were drawn to, row by row.
#[derive(Debug)]
pub(super) struct Marks {
    pub(super) covered: Vec<bool>,
    pub(super) undecided: Vec<bool>,
    pub(super) near_edge: Vec<bool>,
    pub(super) silhouette: Vec<bool>,
    pub(super) owner_width: Vec<f32>,
}

/// A bin's part of the rows of an attachment.
#[derive(Debug)]
pub(super) struct Piece<'s> {
    colors: Vec<&'s mut [[f64; 4]]>,
    intervals: Vec<&'s mut [[Interval; 4]]>,
}

/// A pixel of an attachment.
#[derive(Debug)]
pub(super) struct Pixel<'p> {
    color: &'p mut [f64; 4],
    interval: Option<&'p mut [Interval; 4]>,
}

impl Surface {
    /// A cleared surface for a domain.
    pub(super) fn new<D: Domain>(framebuffer: Framebuffer) -> Self {
        let count = framebuffer.width as usize * framebuffer.height as usize;
        let clear = framebuffer.clear.map(|value| store::<D>(D::Float::from_f64(value), framebuffer.format));
        let cleared = || Attachment {
            colors: filled(count, clear.map(Number::value)),
            intervals: if D::HAS_INTERVALS { filled(count, clear.map(Number::interval)) } else { Vec::new() },
        };
        Self { framebuffer, attachments: (0..framebuffer.attachments).map(|_| cleared()).collect() }
    }

    /// The finished picture.
    pub(super) fn picture<D: Domain>(self, marks: Marks) -> Picture {
        let (colors, intervals) = self.attachments.into_iter().map(|held| (held.colors, held.intervals)).unzip();
        Picture {
            width: self.framebuffer.width,
            height: self.framebuffer.height,
            attachments: colors,
            covered: marks.covered,
            intervals: D::HAS_INTERVALS.then_some(intervals),
            undecided: marks.undecided,
            near_edge: marks.near_edge,
            silhouette: marks.silhouette,
            owner_width: marks.owner_width,
        }
    }
}

/// A vector with equal elements, written by all threads, because new memory takes longer to map than to fill.
fn filled<T: Copy + Send + Sync>(count: usize, value: T) -> Vec<T> {
    (0..count).into_par_iter().with_min_len(1 << 12).map(|_| value).collect()
}

impl Attachment {
    /// The pieces that bins own, bin by bin.
    pub(super) fn pieces(&mut self, width: usize) -> impl Iterator<Item = Piece<'_>> {
        let columns = width.div_ceil(BIN as usize);
        let rows = self.colors.len() / width.max(1);
        let mut pieces = Vec::new();
        pieces.resize_with(columns * rows.div_ceil(BIN as usize), || Piece {
            colors: Vec::with_capacity(BIN as usize),
            intervals: Vec::with_capacity(if self.intervals.is_empty() { 0 } else { BIN as usize }),
        });
        deal(&mut self.colors, width, &mut pieces, |piece| &mut piece.colors);
        deal(&mut self.intervals, width, &mut pieces, |piece| &mut piece.intervals);
        pieces.into_iter()
    }
}

/// Gives each bin its part of the rows.
fn deal<'s, T>(
    all: &'s mut [T],
    width: usize,
    pieces: &mut [Piece<'s>],
    of: impl for<'p> Fn(&'p mut Piece<'s>) -> &'p mut Vec<&'s mut [T]>,
) {
    let columns = width.div_ceil(BIN as usize).max(1);
    let strips = all.chunks_mut((BIN as usize * width).max(1));
    for (strip, pieces) in strips.zip(pieces.chunks_mut(columns)) {
        for row in strip.chunks_mut(width.max(1)) {
            for (part, piece) in row.chunks_mut(BIN as usize).zip(pieces.iter_mut()) {
                of(piece).push(part);
            }
        }
    }
}

impl Piece<'_> {
    /// A pixel by its index in the bin.
    #[inline(always)]
    pub(super) fn pixel(&mut self, place: u32) -> Option<Pixel<'_>> {
        let (row, column) = ((place / BIN as u32) as usize, (place % BIN as u32) as usize);
        let color = self.colors.get_mut(row)?.get_mut(column)?;
        Some(Pixel { color, interval: self.intervals.get_mut(row).and_then(|row| row.get_mut(column)) })
    }
}

impl Pixel<'_> {
    #[inline(always)]
    pub(super) fn read<D: Domain>(&self) -> [D::Float; 4] {
        let interval = |channel: usize, value: f64| {
            self.interval.as_ref().map_or(Interval::point(value), |interval| interval[channel])
        };
        std::array::from_fn(|channel| {
            D::Float::integer_with_interval(self.color[channel], interval(channel, self.color[channel]))
        })
    }

    #[inline(always)]
    pub(super) fn write<D: Domain>(&mut self, color: [D::Float; 4]) {
        for (to, channel) in self.color.iter_mut().zip(&color) {
            *to = channel.value();
        }
        if D::HAS_INTERVALS
            && let Some(interval) = self.interval.as_deref_mut()
        {
            for (to, channel) in interval.iter_mut().zip(&color) {
                *to = channel.interval();
            }
        }
    }
}
