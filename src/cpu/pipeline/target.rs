//! What is drawn to: colors, depth, coverage, cut into square bins that threads own (OpenGL 3.2 §4.1, §4.2).
//!
//! *In:* fragments after shading. *Out:* the [`Picture`].
//! *Holds:* a value is stored as the attachment's format stores it, except that `rgba32float` keeps the domain's own
//! precision: the reference is not rounded to f32. Depth is stored as f32, as the format has it.

use crate::compare::Picture;
use crate::cpu::domain::{Domain, Number};
use crate::cpu::raster::Bounds;
use crate::scene::{BlendFactor, Compare, Format, Framebuffer, State};
use half::f16;

/// Pixels along a side of a bin; even, so that quads lie within one.
pub(super) const BIN: i64 = 32;

/// How far blending may be off in an 8-bit attachment, which may be computed in as many bits as the attachment has
/// (OpenGL 3.2 §4.1.7): the source, the factors and the products are each rounded to steps of 1/255. Measured on Mesa
/// 22.3's software drivers: up to two steps.
const BLEND_SLACK: f64 = 2.0 / 255.0;

/// A bin's part of the framebuffer.
#[derive(Debug)]
pub(super) struct Bin<D: Domain> {
    /// Its pixels; at the right and lower rim some of them lie outside the picture and are never drawn.
    pub(super) area: Bounds,
    colors: Vec<Vec<[D::Float; 4]>>,
    depth: Vec<D::Float>,
    covered: Vec<bool>,
    near_edge: Vec<bool>,
    /// A branch of the last fragment may go either way.
    undecided_color: Vec<bool>,
    /// Whether some fragment is drawn at all may go either way.
    undecided_cover: Vec<bool>,
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
fn local(area: Bounds, x: i64, y: i64) -> usize {
    ((y - area.y0) * BIN + (x - area.x0)) as usize
}

impl<D: Domain> Target<D> {
    /// A cleared framebuffer.
    pub(super) fn new(framebuffer: Framebuffer) -> Self {
        let (width, height) = (i64::from(framebuffer.width), i64::from(framebuffer.height));
        let (columns, rows) = ((width + BIN - 1) / BIN, (height + BIN - 1) / BIN);
        let clear = framebuffer.clear.map(|value| store::<D>(D::Float::from_f64(value), framebuffer.format));
        let pixels = (BIN * BIN) as usize;
        let bins = (0..columns * rows)
            .map(|index| {
                let (x0, y0) = (index % columns * BIN, index / columns * BIN);
                Bin {
                    area: Bounds { x0, x1: (x0 + BIN).min(width), y0, y1: (y0 + BIN).min(height) },
                    colors: vec![vec![clear; pixels]; framebuffer.attachments as usize],
                    depth: vec![D::Float::from_f64(1.0); pixels],
                    covered: vec![false; pixels],
                    near_edge: vec![false; pixels],
                    undecided_color: vec![false; pixels],
                    undecided_cover: vec![false; pixels],
                }
            })
            .collect();
        Self { framebuffer, columns, rows, bins }
    }

    /// The picture that was drawn.
    pub(super) fn picture(&self) -> Picture {
        let (width, height) = (self.framebuffer.width, self.framebuffer.height);
        let pixels = width as usize * height as usize;
        let attachments = self.framebuffer.attachments as usize;
        let has_bounds = D::Float::with_error(0.0, 1.0).error() > 0.0;
        let mut picture = Picture {
            width,
            height,
            attachments: vec![vec![[0.0; 4]; pixels]; attachments],
            covered: vec![false; pixels],
            bounds: has_bounds.then(|| vec![vec![[0.0; 4]; pixels]; attachments]),
            undecided: vec![false; pixels],
            near_edge: vec![false; pixels],
        };
        for bin in &self.bins {
            bin.write(&mut picture);
        }
        picture
    }
}

impl<D: Domain> Bin<D> {
    fn write(&self, picture: &mut Picture) {
        for y in self.area.y0..self.area.y1 {
            for x in self.area.x0..self.area.x1 {
                let (from, to) = (local(self.area, x, y), (y * i64::from(picture.width) + x) as usize);
                picture.covered[to] = self.covered[from];
                picture.near_edge[to] = self.near_edge[from];
                picture.undecided[to] = self.undecided_color[from] || self.undecided_cover[from];
                for (attachment, colors) in self.colors.iter().enumerate() {
                    picture.attachments[attachment][to] = colors[from].map(Number::value);
                    if let Some(bounds) = &mut picture.bounds {
                        bounds[attachment][to] = colors[from].map(Number::error);
                    }
                }
            }
        }
    }

    pub(super) fn mark_near_edge(&mut self, x: i64, y: i64) {
        let index = local(self.area, x, y);
        self.near_edge[index] = true;
    }

    /// The depth test (§4.1.5) and, if it passes, the write.
    #[inline(always)]
    pub(super) fn depth_test(&mut self, x: i64, y: i64, z: D::Float, state: &State) -> bool {
        if !state.depth_test {
            return true;
        }
        let index = local(self.area, x, y);
        let stored = self.depth[index];
        let z = store_depth::<D>(z);
        if z.error() + stored.error() > 0.0
            && (z.value() - stored.value()).abs() <= z.error() + stored.error()
            && !matches!(state.depth_func, Compare::Always | Compare::Never)
        {
            self.undecided_cover[index] = true;
        }
        let passes = compare(state.depth_func, z.value(), stored.value());
        if passes && state.depth_write {
            self.depth[index] = z;
        }
        passes
    }

    /// Marks that a fragment may or may not be drawn here.
    pub(super) fn mark_undecided_cover(&mut self, x: i64, y: i64) {
        let index = local(self.area, x, y);
        self.undecided_cover[index] = true;
    }

    /// Notes that a fragment is written to the pixel.
    pub(super) fn cover(&mut self, x: i64, y: i64, undecided: bool, blends: bool) {
        let index = local(self.area, x, y);
        self.covered[index] = true;
        let before = blends && self.undecided_color[index];
        self.undecided_color[index] = undecided || before;
    }

    /// Blends a color into an attachment and stores it.
    pub(super) fn write_color(
        &mut self,
        (x, y): (i64, i64),
        attachment: usize,
        color: [D::Float; 4],
        blend: Option<(BlendFactor, BlendFactor)>,
        format: Format,
    ) {
        let index = local(self.area, x, y);
        let Some(slot) = self.colors.get_mut(attachment).and_then(|colors| colors.get_mut(index)) else { return };
        let color = match blend {
            Some(factors) if !is_integer(format) => {
                let slack = if format == Format::Rgba8Unorm { BLEND_SLACK } else { 0.0 };
                blended::<D>(factors, clamped::<D>(color, format), *slot)
                    .map(|channel| D::Float::with_error(channel.value(), channel.error() + slack))
            }
            _ => color,
        };
        *slot = color.map(|channel| store::<D>(channel, format));
    }
}

pub(super) fn is_integer(format: Format) -> bool {
    matches!(format, Format::Rgba32Sint | Format::Rgba32Uint)
}

/// A comparison of depth.
pub(super) fn compare(function: Compare, new: f64, stored: f64) -> bool {
    match function {
        Compare::Never => false,
        Compare::Less => new < stored,
        Compare::Equal => new == stored,
        Compare::Lequal => new <= stored,
        Compare::Greater => new > stored,
        Compare::Notequal => new != stored,
        Compare::Gequal => new >= stored,
        Compare::Always => true,
    }
}

/// Depth as a 32-bit float, clamped to [0, 1] (§2.12.1).
fn store_depth<D: Domain>(z: D::Float) -> D::Float {
    let stored = f64::from(z.value() as f32).clamp(0.0, 1.0);
    D::Float::with_error(stored, z.error())
}

/// A fixed-point attachment's source is clamped before blending (§4.1.7).
fn clamped<D: Domain>(color: [D::Float; 4], format: Format) -> [D::Float; 4] {
    if format != Format::Rgba8Unorm {
        return color;
    }
    color.map(|channel| channel.max(D::Float::default()).min(D::Float::from_f64(1.0)))
}

/// `source * S + destination * D` (§4.1.7, tables 4.1 and 4.2).
fn blended<D: Domain>(
    (source_factor, destination_factor): (BlendFactor, BlendFactor),
    source: [D::Float; 4],
    destination: [D::Float; 4],
) -> [D::Float; 4] {
    let by = |name: BlendFactor| factor::<D>(name, source, destination);
    let (s, d) = (by(source_factor), by(destination_factor));
    std::array::from_fn(|i| {
        let part = |weight: D::Float, value: D::Float, name: BlendFactor| match name {
            // Nothing times infinity is nothing, where the factor is not computed.
            BlendFactor::Zero => D::Float::default(),
            BlendFactor::One => value,
            _ => weight.mul(value),
        };
        part(s[i], source[i], source_factor).add(part(d[i], destination[i], destination_factor))
    })
}

fn factor<D: Domain>(name: BlendFactor, source: [D::Float; 4], destination: [D::Float; 4]) -> [D::Float; 4] {
    let one = D::Float::from_f64(1.0);
    let rest = |value: D::Float| one.sub(value);
    let [_, _, _, source_alpha] = source;
    let [_, _, _, destination_alpha] = destination;
    match name {
        BlendFactor::Zero => [D::Float::default(); 4],
        BlendFactor::One => [one; 4],
        BlendFactor::SrcColor => source,
        BlendFactor::OneMinusSrcColor => source.map(rest),
        BlendFactor::DstColor => destination,
        BlendFactor::OneMinusDstColor => destination.map(rest),
        BlendFactor::SrcAlpha => [source_alpha; 4],
        BlendFactor::OneMinusSrcAlpha => [rest(source_alpha); 4],
        BlendFactor::DstAlpha => [destination_alpha; 4],
        BlendFactor::OneMinusDstAlpha => [rest(destination_alpha); 4],
        BlendFactor::SrcAlphaSaturate => {
            let least = source_alpha.min(rest(destination_alpha));
            [least, least, least, one]
        }
    }
}

/// A channel as the format stores it (§2.1.5, §4.1.7): for a bounded value the widest step that a value within the bound
/// may be stored at.
fn store<D: Domain>(value: D::Float, format: Format) -> D::Float {
    let convert: fn(f64) -> f64 = match format {
        Format::Rgba32Float | Format::Rgba32Sint | Format::Rgba32Uint => return value,
        Format::Rgba16Float => |x| f64::from(f16::from_f64(x)),
        Format::Rgba8Unorm => unorm8,
    };
    let stored = convert(value.value());
    let error = value.error();
    if error == 0.0 && (stored == value.value() || format == Format::Rgba8Unorm) {
        return D::Float::from_f64(stored);
    }
    let reach = |x: f64| (convert(x) - stored).abs();
    // A driver's own rounding to 8 bits may be off by a little more than half a step. Halves may be rounded either way
    // (OpenGL 3.2 §2.1.2), so the next one is as good; Mesa's software drivers cut off.
    let (slack, step) = match format {
        Format::Rgba8Unorm => (error + 1e-6, 0.0),
        _ => (error, f64::from(f16::EPSILON) * stored.abs().max(f64::from(f16::MIN_POSITIVE))),
    };
    D::Float::with_error(stored, reach(value.value() - slack).max(reach(value.value() + slack)) + step)
}

/// An 8-bit normalized channel: clamped, `round(255 x) / 255`; NaN is 0.
fn unorm8(x: f64) -> f64 {
    if x.is_nan() { 0.0 } else { (x.clamp(0.0, 1.0) * 255.0).round_ties_even() / 255.0 }
}
