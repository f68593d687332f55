//! What is drawn to: colors, depth, coverage, cut into square bins that threads own (OpenGL 3.2 §4.1, §4.2).
//!
//! *In:* fragments after shading. *Out:* the [`Picture`].
//! *Holds:* a value is stored as the attachment's format stores it, except that `rgba32float` keeps the domain's own
//! precision: the reference is not rounded to f32. Depth is stored as f32, as the format has it.

use super::store::{Test, depth_test, is_integer, keeps, store, write_color};
use crate::compare::{Picture, Range};
use crate::cpu::domain::{Domain, Number};
use crate::cpu::exec::{LANES, Mask};
use crate::cpu::raster::Bounds;
use crate::scene::{BlendFactor, Framebuffer, State};
use rayon::prelude::*;

/// Pixels along a side of a bin; even, so that quads lie within one.
pub(super) const BIN: i64 = 32;

/// What becomes of the fragments of a batch, as sets of lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tests {
    /// Those that are drawn by the values.
    pub(super) passes: u64,
    /// Those where a conforming GPU may decide otherwise.
    pub(super) open: u64,
}

impl Tests {
    /// Those that some GPU draws.
    pub(super) fn possible(self) -> u64 {
        self.passes | self.open
    }

    #[inline(always)]
    fn of(self, lane: usize) -> Test {
        Test { passes: self.passes >> lane & 1 == 1, open: self.open >> lane & 1 == 1 }
    }
}

/// A bin's part of the framebuffer.
#[derive(Clone, Debug)]
pub(super) struct Bin<D: Domain> {
    /// Its pixels; at the right and lower rim some of them lie outside the picture and are never drawn.
    pub(super) area: Bounds,
    framebuffer: Framebuffer,
    /// None as long as nothing is drawn: then all have the clear color.
    pixels: Option<Pixels<D>>,
}

/// What is stored of a bin's pixels, row by row of [`BIN`].
#[derive(Clone, Debug)]
struct Pixels<D: Domain> {
    colors: Vec<Vec<[D::Float; 4]>>,
    /// Empty before the first test.
    depth: Vec<D::Float>,
    covered: Vec<bool>,
    near_edge: Vec<bool>,
    /// Whether a fragment that shows is drawn at all, or what it holds, is left open.
    undecided: Vec<bool>,
}

/// The framebuffer.
#[derive(Debug)]
pub(super) struct Target<D: Domain> {
    framebuffer: Framebuffer,
    pub(super) columns: i64,
    pub(super) rows: i64,
    pub(super) bins: Vec<Bin<D>>,
}

/// The place of a pixel in its bin.
#[inline(always)]
pub(super) fn local(area: Bounds, x: i64, y: i64) -> u32 {
    ((y - area.y0) * BIN + (x - area.x0)) as u32
}

/// What a pixel has before anything is drawn to it.
fn cleared<D: Domain>(framebuffer: Framebuffer) -> [D::Float; 4] {
    framebuffer.clear.map(|value| store::<D>(D::Float::from_f64(value), framebuffer.format))
}

impl<D: Domain> Target<D> {
    /// A cleared framebuffer.
    pub(super) fn new(framebuffer: Framebuffer) -> Self {
        let (width, height) = (i64::from(framebuffer.width), i64::from(framebuffer.height));
        let (columns, rows) = ((width + BIN - 1) / BIN, (height + BIN - 1) / BIN);
        let bins = (0..columns * rows)
            .map(|index| {
                let (x0, y0) = (index % columns * BIN, index / columns * BIN);
                let area = Bounds { x0, x1: (x0 + BIN).min(width), y0, y1: (y0 + BIN).min(height) };
                Bin::new(framebuffer, area)
            })
            .collect();
        Self { framebuffer, columns, rows, bins }
    }

    /// The picture that was drawn.
    pub(super) fn picture(&self) -> Picture {
        let attachments = 0..self.framebuffer.attachments as usize;
        let clear = cleared::<D>(self.framebuffer).map(Number::value);
        let colors = |attachment: usize| {
            self.gathered(
                ([0.0; 4], clear),
                |pixels| &pixels.colors[attachment],
                |color: [D::Float; 4]| color.map(Number::value),
            )
        };
        let flags = |of: fn(&Pixels<D>) -> &[bool]| self.gathered((false, false), of, |flag| flag);
        Picture {
            width: self.framebuffer.width,
            height: self.framebuffer.height,
            attachments: attachments.clone().map(colors).collect(),
            covered: flags(|pixels| &pixels.covered),
            ranges: D::OPEN.then(|| attachments.map(|attachment| self.ranges(attachment)).collect()),
            undecided: flags(|pixels| &pixels.undecided),
            near_edge: flags(|pixels| &pixels.near_edge),
        }
    }

    /// What each pixel has of its bin, else `clear`: rows of bins side by side in threads, since nothing is drawn
    /// meanwhile. They find zeros, which the system gives for nothing.
    fn gathered<S: Copy + Send + Sync, T: Copy + Send + Sync>(
        &self,
        (zero, clear): (T, T),
        of: impl Fn(&Pixels<D>) -> &[S] + Sync,
        convert: impl Fn(S) -> T + Sync,
    ) -> Vec<T> {
        let (width, height) = (self.framebuffer.width as usize, self.framebuffer.height as usize);
        let mut all = vec![zero; width * height];
        let strips = all.par_chunks_mut((BIN as usize * width).max(1));
        strips.zip(self.bins.par_chunks((self.columns as usize).max(1))).for_each(|(strip, bins)| {
            for bin in bins {
                let columns = bin.area.x0 as usize..bin.area.x1 as usize;
                let rows = strip.chunks_exact_mut(width).map(|row| &mut row[columns.clone()]);
                match &bin.pixels {
                    Some(pixels) => {
                        for (row, from) in rows.zip(of(pixels).chunks_exact(BIN as usize)) {
                            for (pixel, from) in row.iter_mut().zip(from) {
                                *pixel = convert(*from);
                            }
                        }
                    }
                    None => rows.for_each(|row| row.fill(clear)),
                }
            }
        });
        all
    }

    /// The ranges of an attachment. Each pixel asks for its bin, so that nothing is written twice: they are the largest part
    /// of a picture.
    fn ranges(&self, attachment: usize) -> Vec<[Range; 4]> {
        let clear = cleared::<D>(self.framebuffer).map(Number::range);
        let width = self.framebuffer.width.max(1);
        (0..self.framebuffer.width * self.framebuffer.height)
            .into_par_iter()
            .map(|index| {
                let (x, y) = (index % width, index / width);
                let bin = (y / BIN as u32) as usize * self.columns as usize + (x / BIN as u32) as usize;
                let color = self.bins.get(bin).and_then(|bin| {
                    let place = (y % BIN as u32) * BIN as u32 + x % BIN as u32;
                    bin.color(attachment, place)
                });
                color.map_or(clear, |color| color.map(Number::range))
            })
            .collect()
    }
}

impl<D: Domain> Pixels<D> {
    fn new(framebuffer: Framebuffer) -> Self {
        const PIXELS: usize = (BIN * BIN) as usize;
        let clear = cleared::<D>(framebuffer);
        Self {
            colors: vec![vec![clear; PIXELS]; framebuffer.attachments as usize],
            depth: Vec::new(),
            covered: vec![false; PIXELS],
            near_edge: vec![false; PIXELS],
            undecided: vec![false; PIXELS],
        }
    }
}

impl<D: Domain> Bin<D> {
    /// A cleared part.
    pub(super) fn new(framebuffer: Framebuffer, area: Bounds) -> Self {
        Self { area, framebuffer, pixels: None }
    }

    #[inline(always)]
    fn pixels(&mut self) -> &mut Pixels<D> {
        self.pixels.get_or_insert_with(|| Pixels::new(self.framebuffer))
    }

    fn color(&self, attachment: usize, place: u32) -> Option<[D::Float; 4]> {
        self.pixels.as_ref()?.colors.get(attachment)?.get(place as usize).copied()
    }

    /// What a channel of a pixel inside may be.
    pub(super) fn range(&self, x: i64, y: i64, attachment: usize, channel: usize) -> Range {
        let has = (attachment as u64) < u64::from(self.framebuffer.attachments);
        let clear = has.then(|| cleared::<D>(self.framebuffer));
        let color = self.color(attachment, local(self.area, x, y)).or(clear);
        color.and_then(|color| color.get(channel).copied()).map_or(Range::ALL, Number::range)
    }

    pub(super) fn mark_near_edge(&mut self, x: i64, y: i64) {
        let place = local(self.area, x, y) as usize;
        self.pixels().near_edge[place] = true;
    }

    /// The depth test (§4.1.5) of fragments that came so far, and the write where it passes.
    pub(super) fn depth_tests(
        &mut self,
        places: &[u32; LANES],
        depths: &[D::Float; LANES],
        state: &State,
        before: Tests,
    ) -> Tests {
        if !state.depth_test {
            return before;
        }
        let depth = &mut self.pixels().depth;
        if depth.is_empty() {
            *depth = vec![D::Float::from_f64(1.0); (BIN * BIN) as usize];
        }
        let mut after = Tests::default();
        for lane in Mask(before.possible()).lanes() {
            let Some(stored) = depth.get_mut(places[lane] as usize) else { continue };
            let test = depth_test::<D>(stored, depths[lane], state, before.of(lane));
            after.passes |= u64::from(test.passes) << lane;
            after.open |= u64::from(test.open) << lane;
        }
        after
    }

    /// Notes that fragments are written to pixels, or may be. One that certainly is, and hides what was there, settles what
    /// was open.
    pub(super) fn cover(&mut self, places: &[u32; LANES], tests: Tests, undecided: u64, blends: bool) {
        let pixels = self.pixels();
        for lane in Mask(tests.passes).lanes() {
            pixels.covered[places[lane] as usize] = true;
        }
        if D::OPEN {
            for lane in Mask(tests.possible()).lanes() {
                let slot = &mut pixels.undecided[places[lane] as usize];
                let open = tests.of(lane).open;
                *slot = undecided >> lane & 1 == 1 || open || ((blends || open) && *slot);
            }
        }
    }

    /// Blends colors into an attachment and stores them.
    #[inline(always)]
    pub(super) fn write_colors(
        &mut self,
        places: &[u32; LANES],
        attachment: usize,
        color: impl Fn(usize) -> [D::Float; 4],
        blend: Option<(BlendFactor, BlendFactor)>,
        tests: Tests,
    ) {
        let format = self.framebuffer.format;
        let blend = blend.filter(|_| !is_integer(format));
        let Some(colors) = self.pixels().colors.get_mut(attachment) else { return };
        if blend.is_none() && keeps(format) && tests.open == 0 {
            for lane in Mask(tests.passes).lanes() {
                if let Some(slot) = colors.get_mut(places[lane] as usize) {
                    *slot = color(lane);
                }
            }
            return;
        }
        for lane in Mask(tests.possible()).lanes() {
            if let Some(slot) = colors.get_mut(places[lane] as usize) {
                write_color::<D>(slot, color(lane), blend, format, tests.of(lane));
            }
        }
    }
}
