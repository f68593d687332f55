//! The framebuffer: colors, depth and coverage, divided into square bins that threads own (OpenGL 3.2 §4.1, §4.2).
//!
//! *In:* fragments after shading. *Out:* the contents of their pixels. *Holds:* a value is stored in the attachment's
//! format, except that `rgba32float` keeps the precision of the domain: the reference is not rounded to f32. Depth is
//! stored as f32, in its format. Colors are written directly to the picture ([`Surface`]); everything else belongs to
//! the bin and is allocated when something is drawn.

use super::fragment_tests::Tests;
use super::same_surface::Origin;
use super::store::{Test, depth_test, holds_for_equal, is_integer, keeps, store, stored};
use super::surface::{BIN, Marks, Piece, Surface};
use super::worlds::{self, World, Worlds, joined};
use crate::domain::{Domain, Number};
use crate::exec::{LANES, Mask};
use crate::raster::Bounds;
use glisten_scene::picture::Interval;
use glisten_scene::{Blend, Format, Framebuffer, State};
use smallvec::SmallVec;

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
    /// The fragments that the depths are of; empty if no surface is drawn twice.
    origins: Vec<Origin>,
    covered: Vec<bool>,
    /// Pixels near an edge. Empty if there are none.
    edges: Vec<EdgeMarks>,
    /// Pixels whose owner is open while a draw lasts.
    worlds: Worlds<D>,
    /// Whether it is undecided if a visible fragment is drawn, or which one. Empty in domains without envelopes.
    undecided: Vec<bool>,
}

/// The state of a pixel near an edge.
#[derive(Clone, Copy, Debug, Default)]
struct EdgeMarks {
    /// Whether the color depends on which primitive owns the pixel.
    color: bool,
    /// Whether the depth does.
    depth: bool,
    /// Whether the pixel may be left uncovered.
    silhouette: bool,
    /// The largest width of the color of one owner.
    owner_width: f32,
}

/// The index of a pixel in its bin.
#[inline(always)]
pub(super) fn local(area: Bounds, x: i64, y: i64) -> u32 {
    ((y - area.y0) * BIN + (x - area.x0)) as u32
}

/// The place in the picture of a pixel that is known by its index in its bin.
#[inline(always)]
pub(super) fn global(area: Bounds, index: u32) -> [i64; 2] {
    [area.x0 + i64::from(index) % BIN, area.y0 + i64::from(index) / BIN]
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
            covered: self.gathered(|pixels| &pixels.covered, |covered| *covered),
            undecided: self.gathered(|pixels| &pixels.undecided, |undecided| *undecided),
            near_edge: self.gathered(|pixels| &pixels.edges, |marks| marks.color),
            silhouette: self.gathered(|pixels| &pixels.edges, |marks| marks.silhouette),
            owner_width: self.gathered(|pixels| &pixels.edges, |marks| marks.owner_width),
        }
    }

    /// A value of each pixel, row by row.
    fn gathered<T, R: Clone + Default>(&self, of: impl Fn(&Pixels<D>) -> &[T], value: impl Fn(&T) -> R) -> Vec<R> {
        let (width, height) = (self.framebuffer.width as usize, self.framebuffer.height as usize);
        let mut all = vec![R::default(); width * height];
        for bin in &self.bins {
            let Some(marks) = bin.pixels.as_ref().map(&of) else { continue };
            let columns = bin.area.x0 as usize..bin.area.x1 as usize;
            let rows = all.chunks_exact_mut(width).skip(bin.area.y0 as usize);
            for (row, marks) in rows.zip(marks.chunks_exact(BIN as usize)) {
                row[columns.clone()].iter_mut().zip(marks).for_each(|(to, mark)| *to = value(mark));
            }
        }
        all
    }
}

impl<D: Domain> Pixels<D> {
    fn new() -> Self {
        let count = (BIN * BIN) as usize;
        let undecided = vec![false; if D::HAS_INTERVALS { count } else { 0 }];
        let (edges, worlds) = (Vec::new(), Worlds::new());
        Self { depth: Vec::new(), origins: Vec::new(), covered: vec![false; count], edges, worlds, undecided }
    }
}

impl<D: Domain> Bin<'_, D> {
    #[inline(always)]
    fn pixels(&mut self) -> &mut Pixels<D> {
        self.pixels.get_or_insert_with(Pixels::new)
    }

    /// Marks a pixel near an edge, in a domain without envelopes.
    pub(super) fn mark_near_edge(&mut self, x: i64, y: i64) {
        let place = local(self.area, x, y);
        if let Some(marks) = self.edge_marks(place) {
            marks.color = true;
        }
    }

    fn edge_marks(&mut self, place: u32) -> Option<&mut EdgeMarks> {
        let edges = &mut self.pixels().edges;
        edges.resize((BIN * BIN) as usize, EdgeMarks::default());
        edges.get_mut(place as usize)
    }

    /// Forgets the worlds of a draw that is complete: each of its owners has been one.
    pub(super) fn end_draw(&mut self) {
        if let Some(pixels) = &mut self.pixels {
            pixels.worlds.clear();
        }
    }

    /// Runs the depth test (§4.1.5) of fragments that passed all earlier tests, and writes depth where it passes.
    pub(super) fn depth_tests(
        &mut self,
        places: &[u32; LANES],
        depth_of: impl Fn(usize) -> D::Float,
        state: &State,
        before: Tests,
        origins: Option<&[Origin; LANES]>,
    ) -> Tests {
        if !state.depth_test {
            return before;
        }
        let depth = &mut self.pixels().depth;
        if depth.is_empty() {
            *depth = vec![D::Float::from_f64(1.0); (BIN * BIN) as usize];
        }
        let mut after = Tests { passes: 0, undecided: 0, ..before };
        if origins.is_some() {
            self.pixels().origins.resize((BIN * BIN) as usize, Origin::default());
        }
        for lane in Mask(before.possible()).lanes() {
            let origin = origins.map(|origins| origins[lane]);
            if let Some(origin) = origin
                && self.has_same_depth(lane, places[lane], depth_of(lane), state, before, origin)
            {
                if holds_for_equal(state.depth_func) {
                    after.add(lane, before.of(lane));
                } else if before.owners >> lane & 1 == 1 {
                    self.leave(places[lane]);
                }
                continue;
            }
            if D::HAS_INTERVALS && self.has_edges(before) {
                self.edge_depth_test(lane, places[lane], depth_of(lane), state, before, &mut after);
                self.note_origin(lane, places[lane], state, after, origin);
                continue;
            }
            let depth = &mut self.pixels().depth;
            let Some(stored) = depth.get_mut(places[lane] as usize) else { continue };
            let test = depth_test::<D>(stored, depth_of(lane), state, before.of(lane));
            after.add(lane, test);
            after.doubtful |= u64::from(test.undecided) << lane;
            self.note_origin(lane, places[lane], state, after, origin);
        }
        after
    }

    /// Whether the depth at a fragment's pixel is certainly that of the same fragment in another draw; near an edge, of
    /// one of those that may own the pixel, if the comparison holds for equal depths.
    fn has_same_depth(
        &self,
        lane: usize,
        place: u32,
        z: D::Float,
        state: &State,
        before: Tests,
        origin: Origin,
    ) -> bool {
        let Some(pixels) = &self.pixels else { return false };
        let (Some(known), Some(stored)) = (pixels.origins.get(place as usize), pixels.depth.get(place as usize)) else {
            return false;
        };
        if known.surface != origin.surface {
            return false;
        }
        if before.edge() >> lane & 1 == 0 {
            return known.primitive == origin.primitive;
        }
        let (new, old) = (z.interval(), stored.interval());
        known.primitive == Origin::ANY
            && holds_for_equal(state.depth_func)
            && new.low <= old.high
            && new.high >= old.low
    }

    /// Remembers whose depth a pixel has after a test.
    fn note_origin(&mut self, lane: usize, place: u32, state: &State, after: Tests, origin: Option<Origin>) {
        let has = |set: u64| set >> lane & 1 == 1;
        if !state.depth_write || !has(after.possible()) {
            return;
        }
        let Some(slot) = self.pixels.as_mut().and_then(|pixels| pixels.origins.get_mut(place as usize)) else { return };
        let any = |origin: Origin| Origin { primitive: Origin::ANY, ..origin };
        *slot = match origin {
            Some(origin) if has(after.edge()) && !has(after.doubtful) => any(origin),
            Some(origin) if !has(after.undecided) => origin,
            Some(origin) if slot.surface == origin.surface => any(origin),
            _ => Origin::default(),
        };
    }

    /// Whether a pixel or a fragment near an edge is concerned.
    fn has_edges(&self, tests: Tests) -> bool {
        tests.edge() != 0 || self.pixels.as_ref().is_some_and(|pixels| !pixels.edges.is_empty())
    }

    /// The depth test of a fragment in a bin with edges. Where the stored depth depends on an edge, so does the result.
    fn edge_depth_test(
        &mut self,
        lane: usize,
        place: u32,
        z: D::Float,
        state: &State,
        before: Tests,
        after: &mut Tests,
    ) {
        let (bit, attachments) = (1_u64 << lane, self.attachments.len());
        let was_open = self.edge_marks(place).is_some_and(|marks| marks.depth);
        let pixels = self.pixels.get_or_insert_with(Pixels::new);
        let Some(stored) = pixels.depth.get_mut(place as usize) else { return };
        let is_owner = before.owners & bit != 0;
        let world = match is_owner {
            true => Some(pixels.worlds.entry(place).or_insert_with(|| worlds::Pixel::new(attachments))),
            false => pixels.worlds.get_mut(&place),
        };
        // Whether the comparison alone is open.
        let alone = |stored: D::Float| {
            depth_test::<D>(&mut { stored }, z, state, Test { passes: true, undecided: false }).undecided
        };
        let mut is_close = alone(*stored);
        let mut test = before.of(lane);
        let test = match world {
            Some(pixel) if is_owner && !matches!(pixel.depth, World::Joined) => {
                let none = if let World::Apart(none) = pixel.depth { none } else { *stored };
                is_close = alone(none);
                let mut mine = none;
                let test = depth_test::<D>(&mut mine, z, state, test);
                *stored = match pixel.depth {
                    World::Untouched => mine,
                    _ if before.outside & bit != 0 => stored.joined(mine),
                    _ => mine.joined(*stored),
                };
                pixel.depth = World::Apart(none);
                test
            }
            Some(pixel) => {
                // A fragment between owners, or an owner after such a one.
                let mut hull = *stored;
                if let World::Apart(none) = pixel.depth {
                    hull = hull.joined(none);
                }
                is_close = alone(hull);
                if is_owner {
                    after.owners &= !bit;
                    after.open |= bit;
                    test = opened(test, before.outside & bit != 0);
                }
                let test = depth_test::<D>(&mut hull, z, state, test);
                if test.passes || test.undecided {
                    (pixel.depth, *stored) = (World::Joined, hull);
                }
                test
            }
            None => depth_test::<D>(stored, z, state, test),
        };
        after.add(lane, test);
        let is_possible = test.passes || test.undecided;
        let is_certain = test.passes && !test.undecided;
        if is_owner && !is_certain {
            self.leave(place);
        }
        match is_close {
            true if was_open => after.open |= bit & !after.owners,
            true => after.doubtful |= bit,
            false => {}
        }
        let is_edge = after.edge() & bit != 0;
        if state.depth_write
            && is_possible
            && let Some(marks) = self.edge_marks(place)
        {
            marks.depth = is_edge || !is_certain && marks.depth;
        }
    }

    /// Notes that an owner leaves a pixel as it was.
    pub(super) fn leave(&mut self, place: u32) {
        let count = self.attachments.len();
        let pixels = self.pixels.get_or_insert_with(Pixels::new);
        let pixel = pixels.worlds.entry(place).or_insert_with(|| worlds::Pixel::new(count));
        pixel.leaves = true;
        for (attachment, world) in self.attachments.iter_mut().zip(&pixel.colors) {
            if let World::Apart(none) = world
                && let Some(mut at) = attachment.pixel(place)
            {
                at.write::<D>(joined(at.read::<D>(), *none));
            }
        }
    }

    /// Records that fragments are written to pixels, or may be. A fragment that certainly is, and that hides the
    /// previous contents, resolves what was undecided, and what was open because of an edge.
    pub(super) fn cover(&mut self, places: &[u32; LANES], tests: Tests, undecided: u64, blends: bool) {
        let has_edges = self.has_edges(tests);
        let pixels = self.pixels();
        if D::HAS_INTERVALS && has_edges {
            return self.cover_edges(places, tests, undecided, blends);
        }
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

    fn cover_edges(&mut self, places: &[u32; LANES], tests: Tests, undecided: u64, blends: bool) {
        for lane in Mask(tests.possible()).lanes() {
            let has = |set: u64| set >> lane & 1 == 1;
            let place = places[lane];
            let is_covered = self.pixels().covered.get(place as usize).copied().unwrap_or(false);
            let keeps = blends || has(tests.undecided | tests.edge());
            if let Some(marks) = self.edge_marks(place) {
                marks.color = has(tests.edge()) || keeps && marks.color;
                if !keeps {
                    marks.owner_width = 0.0;
                }
                if has(tests.open) && !has(tests.doubtful) {
                    marks.silhouette |= !is_covered;
                } else if !has(tests.undecided) {
                    marks.silhouette = false;
                }
            }
            let pixels = self.pixels();
            if let Some(slot) = pixels.undecided.get_mut(place as usize) {
                *slot = has(undecided | tests.doubtful) || keeps && *slot;
            }
            if let Some(covered) = pixels.covered.get_mut(place as usize) {
                *covered |= has(tests.passes & !tests.outside);
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
        blend: Option<Blend>,
        tests: Tests,
    ) {
        let format = self.format;
        let blend = blend.filter(|_| !is_integer(format));
        let has_worlds = tests.edge() != 0 || self.pixels.as_ref().is_some_and(|pixels| !pixels.worlds.is_empty());
        if D::HAS_INTERVALS && has_worlds {
            return self.write_edge_colors(places, attachment, color, blend, tests);
        }
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

    /// Writes colors among which are those of pixels near an edge.
    fn write_edge_colors(
        &mut self,
        places: &[u32; LANES],
        attachment: usize,
        color: impl Fn(usize) -> [D::Float; 4],
        blend: Option<Blend>,
        tests: Tests,
    ) {
        let (format, count) = (self.format, self.attachments.len());
        let pixels = self.pixels.get_or_insert_with(Pixels::new);
        let Some(piece) = self.attachments.get_mut(attachment) else { return };
        for lane in Mask(tests.possible()).lanes() {
            let (place, bit) = (places[lane], 1_u64 << lane);
            let Some(mut at) = piece.pixel(place) else { continue };
            let (new, is_owner, is_outside) = (color(lane), tests.owners & bit != 0, tests.outside & bit != 0);
            if tests.edge() & bit != 0
                && let Some(marks) = pixels.edges.get_mut(place as usize)
            {
                marks.owner_width = marks.owner_width.max(width::<D>(new, format));
            }
            let world = match is_owner {
                true => Some(pixels.worlds.entry(place).or_insert_with(|| worlds::Pixel::new(count))),
                false => pixels.worlds.get_mut(&place),
            };
            let leaves = world.as_ref().is_some_and(|world| world.leaves);
            let mut unknown = World::Untouched;
            let world = world.and_then(|world| world.colors.get_mut(attachment)).unwrap_or(&mut unknown);
            let now = at.read::<D>();
            if is_owner && !matches!(world, World::Joined) {
                let (none, is_first) = if let World::Apart(none) = world { (*none, false) } else { (now, true) };
                let mine = stored::<D>(new, none, blend, format, tests.of(lane));
                at.write::<D>(match is_first {
                    true if leaves => joined(mine, none),
                    true => mine,
                    false if is_outside => joined(now, mine),
                    false => joined(mine, now),
                });
                *world = World::Apart(none);
                continue;
            }
            let now = if let World::Apart(none) = world { joined(now, *none) } else { now };
            if matches!(world, World::Apart(_)) {
                *world = World::Joined;
            }
            let test = if is_owner { opened(tests.of(lane), is_outside) } else { tests.of(lane) };
            at.write::<D>(stored::<D>(new, now, blend, format, test));
        }
    }
}

/// The test of an owner that may or may not draw, because another fragment came in between.
fn opened(test: Test, is_outside: bool) -> Test {
    Test { passes: test.passes && !is_outside, undecided: true }
}

/// The width of the widest channel of a color, as the format stores it.
fn width<D: Domain>(color: [D::Float; 4], format: Format) -> f32 {
    let widths = color.map(|channel| store::<D>(channel, format).interval().width());
    widths.into_iter().fold(0.0, |most: f64, width| if width.is_nan() { f64::INFINITY } else { most.max(width) }) as f32
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
