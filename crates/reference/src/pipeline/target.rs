//! The framebuffer: colors, depth and coverage, divided into square bins that threads own (OpenGL 3.2 §4.1, §4.2).
//!
//! *In:* fragments after shading. *Out:* the contents of their pixels. *Holds:* a value is stored in the attachment's
//! format, except that `rgba32float` keeps the precision of the domain: the reference is not rounded to f32. Depth is
//! stored as f32, in its format. Colors are written directly to the picture ([`Surface`]); everything else belongs to
//! the bin and is allocated when something is drawn.

use super::store::{Test, depth_test, is_integer, keeps, stored};
use super::surface::{BIN, Marks, Piece, Surface};
use crate::domain::{Domain, Number};
use crate::exec::{LANES, Mask};
use crate::raster::Bounds;
use glisten_scene::picture::Interval;
use glisten_scene::{BlendFactor, Format, Framebuffer, State};
use smallvec::SmallVec;

/// The test results of the fragments of a batch, as sets of lanes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Tests {
    /// Those whose values pass.
    pub(super) passes: u64,
    /// Those for which a conforming GPU may decide differently.
    pub(super) undecided: u64,
}

impl Tests {
    /// Those that some conforming GPU draws.
    pub(super) fn possible(self) -> u64 {
        self.passes | self.undecided
    }

    #[inline(always)]
    fn of(self, lane: usize) -> Test {
        Test { passes: self.passes >> lane & 1 == 1, undecided: self.undecided >> lane & 1 == 1 }
    }
}

/// The framebuffer, divided into bins.
#[derive(Debug)]
pub(super) struct Target<'s, D: Domain> {
    framebuffer: Framebuffer,
    pub(super) columns: i64,
    pub(super) rows: i64,
    pub(super) bins: Vec<Bin<'s, D>>,
}

/// A bin's part of the framebuffer.
#[derive(Debug)]
pub(super) struct Bin<'s, D: Domain> {
    /// The pixels of the bin; at the right and lower border it has fewer than elsewhere.
    pub(super) area: Bounds,
    format: Format,
    attachments: SmallVec<[Piece<'s>; 1]>,
    /// `None` as long as nothing is drawn.
    pixels: Option<Pixels<D>>,
}

/// The state of a bin's pixels besides their colors, row by row of [`BIN`].
#[derive(Clone, Debug)]
struct Pixels<D: Domain> {
    /// Empty before the first depth test.
    depth: Vec<D::Float>,
    covered: Vec<bool>,
    /// Empty if no pixel is near an edge.
    near_edge: Vec<bool>,
    /// Whether it is undecided if a visible fragment is drawn, or which one. Empty in domains without envelopes.
    undecided: Vec<bool>,
}

/// The index of a pixel in its bin.
#[inline(always)]
pub(super) fn local(area: Bounds, x: i64, y: i64) -> u32 {
    ((y - area.y0) * BIN + (x - area.x0)) as u32
}

impl<'s, D: Domain> Target<'s, D> {
    /// A framebuffer with these attachments.
    pub(super) fn new(surface: &'s mut Surface) -> Self {
        let framebuffer = surface.framebuffer;
        let (width, height) = (i64::from(framebuffer.width), i64::from(framebuffer.height));
        let (columns, rows) = ((width + BIN - 1) / BIN, (height + BIN - 1) / BIN);
        let mut bins: Vec<Bin<'_, D>> = (0..columns * rows)
            .map(|index| {
                let (x0, y0) = (index % columns * BIN, index / columns * BIN);
                let area = Bounds { x0, x1: (x0 + BIN).min(width), y0, y1: (y0 + BIN).min(height) };
                Bin { area, format: framebuffer.format, attachments: SmallVec::new(), pixels: None }
            })
            .collect();
        for attachment in &mut surface.attachments {
            for (bin, piece) in bins.iter_mut().zip(attachment.pieces(framebuffer.width as usize)) {
                bin.attachments.push(piece);
            }
        }
        Self { framebuffer, columns, rows, bins }
    }

    /// Which pixels were drawn to.
    pub(super) fn into_marks(self) -> Marks {
        Marks {
            covered: self.gathered(|pixels| &pixels.covered),
            undecided: self.gathered(|pixels| &pixels.undecided),
            near_edge: self.gathered(|pixels| &pixels.near_edge),
            silhouette: Vec::new(),
            owner_width: Vec::new(),
        }
    }

    fn gathered(&self, of: impl Fn(&Pixels<D>) -> &[bool]) -> Vec<bool> {
        let (width, height) = (self.framebuffer.width as usize, self.framebuffer.height as usize);
        let mut all = vec![false; width * height];
        for bin in &self.bins {
            let Some(marks) = bin.pixels.as_ref().map(&of) else { continue };
            let columns = bin.area.x0 as usize..bin.area.x1 as usize;
            let rows = all.chunks_exact_mut(width).skip(bin.area.y0 as usize);
            for (row, marks) in rows.zip(marks.chunks_exact(BIN as usize)) {
                row[columns.clone()].copy_from_slice(&marks[..columns.len()]);
            }
        }
        all
    }
}

impl<D: Domain> Pixels<D> {
    fn new() -> Self {
        let count = (BIN * BIN) as usize;
        let undecided = vec![false; if D::HAS_INTERVALS { count } else { 0 }];
        Self { depth: Vec::new(), covered: vec![false; count], near_edge: Vec::new(), undecided }
    }
}

impl<D: Domain> Bin<'_, D> {
    #[inline(always)]
    fn pixels(&mut self) -> &mut Pixels<D> {
        self.pixels.get_or_insert_with(Pixels::new)
    }

    pub(super) fn mark_near_edge(&mut self, x: i64, y: i64) {
        let place = local(self.area, x, y) as usize;
        let near_edge = &mut self.pixels().near_edge;
        near_edge.resize((BIN * BIN) as usize, false);
        near_edge[place] = true;
    }

    /// Runs the depth test (§4.1.5) of fragments that passed all earlier tests, and writes depth where it passes.
    pub(super) fn depth_tests(
        &mut self,
        places: &[u32; LANES],
        depth_of: impl Fn(usize) -> D::Float,
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
            let test = depth_test::<D>(stored, depth_of(lane), state, before.of(lane));
            after.passes |= u64::from(test.passes) << lane;
            after.undecided |= u64::from(test.undecided) << lane;
        }
        after
    }

    /// Records that fragments are written to pixels, or may be. A fragment that certainly is, and that hides the
    /// previous contents, resolves what was undecided.
    pub(super) fn cover(&mut self, places: &[u32; LANES], tests: Tests, undecided: u64, blends: bool) {
        let pixels = self.pixels();
        for lane in Mask(tests.passes).lanes() {
            pixels.covered[places[lane] as usize] = true;
        }
        if D::HAS_INTERVALS {
            for lane in Mask(tests.possible()).lanes() {
                let slot = &mut pixels.undecided[places[lane] as usize];
                let uncertain = tests.of(lane).undecided;
                *slot = undecided >> lane & 1 == 1 || uncertain || (blends && *slot);
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
        let format = self.format;
        let blend = blend.filter(|_| !is_integer(format));
        let Some(piece) = self.attachments.get_mut(attachment) else { return };
        if blend.is_none() && keeps(format) && tests.undecided == 0 {
            for lane in Mask(tests.passes).lanes() {
                if let Some(mut pixel) = piece.pixel(places[lane]) {
                    pixel.write::<D>(color(lane));
                }
            }
            return;
        }
        for lane in Mask(tests.possible()).lanes() {
            if let Some(mut pixel) = piece.pixel(places[lane]) {
                let color = stored::<D>(color(lane), pixel.read::<D>(), blend, format, tests.of(lane));
                pixel.write::<D>(color);
            }
        }
    }
}

/// A part of a picture that is drawn alone, and can be drawn again from its previous state.
#[derive(Clone, Debug)]
pub(super) struct Patch<D: Domain> {
    pub(super) area: Bounds,
    surface: Surface,
    pixels: Option<Pixels<D>>,
}

impl<D: Domain> Patch<D> {
    /// A cleared patch, at most as large as a bin.
    pub(super) fn new(framebuffer: Framebuffer, area: Bounds) -> Self {
        let (width, height) = ((area.x1 - area.x0) as u32, (area.y1 - area.y0) as u32);
        Self { area, surface: Surface::new::<D>(Framebuffer { width, height, ..framebuffer }), pixels: None }
    }

    /// Draws on the patch.
    pub(super) fn draw(&mut self, draw: impl FnOnce(&mut Bin<'_, D>)) {
        if let Some(bin) = Target::<D>::new(&mut self.surface).bins.first_mut() {
            bin.area = self.area;
            bin.pixels = self.pixels.take();
            draw(bin);
            self.pixels = bin.pixels.take();
        }
    }

    /// The interval of a channel of a pixel inside the patch.
    pub(super) fn interval(&mut self, x: i64, y: i64, attachment: usize, channel: usize) -> Interval {
        let mut interval = Interval::ALL;
        let place = local(self.area, x, y);
        self.draw(|bin| {
            let color = bin.attachments.get_mut(attachment).and_then(|piece| piece.pixel(place)).map(|p| p.read::<D>());
            interval = color.and_then(|color| color.get(channel).copied()).map_or(Interval::ALL, Number::interval);
        });
        interval
    }
}
