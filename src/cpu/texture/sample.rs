//! Filtered lookups (OpenGL 3.2 §3.8.11 to §3.8.12, §3.8.16).

use super::texel::{self, dimensions};
use super::{Near, Sampled, cube, level};
use crate::cpu::domain::rules;
use crate::hir::{SamplerDim, SamplerType, Scalar};
use crate::scene::{Compare, Filter, Texture, TextureLevel, Wrap};

/// One lookup.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request {
    pub(crate) kind: SamplerType,
    /// s, t, r, as far as the texture has them.
    pub(crate) at: [Near; 3],
    pub(crate) layer: Near,
    /// Of a shadow sampler.
    pub(crate) reference: Near,
    /// The level of detail, bias included.
    pub(crate) level: Near,
    /// In texels.
    pub(crate) offset: [i32; 3],
    /// Whether the errors are wanted.
    pub(crate) bounded: bool,
}

/// One axis of a lookup in a level: the texels left and right, the weight of the right one, and how far a GPU's place may
/// be off, in texels.
#[derive(Clone, Copy, Debug)]
struct Axis {
    first: i64,
    second: i64,
    weight: f64,
    error: f64,
}

/// Looks a texture up.
pub(crate) fn sample(texture: &Texture, request: &Request) -> Sampled {
    let mut request = *request;
    for at in &mut request.at {
        if !at.value.is_finite() {
            *at = Near { value: 0.0, error: f64::INFINITY };
        }
    }
    if request.kind.texel != Scalar::Float {
        // Integers are not filtered (§3.8.14): nearest, in the base level.
        let Some(base) = level(texture, 0) else { return Sampled::Bits([0; 4], true) };
        let (place, sure) = nearest_place(texture, base, &request);
        return Sampled::Bits(texel::bits(base, place), sure);
    }
    let floats = match texture.filter {
        Filter::Nearest => at_level(texture, 0, &request, false),
        Filter::Linear => at_level(texture, 0, &request, true),
        Filter::Trilinear => trilinear(texture, &request),
    };
    Sampled::Floats(floats)
}

/// Linear between levels; magnified, the base level.
fn trilinear(texture: &Texture, request: &Request) -> [Near; 4] {
    let last = texture.levels.len().saturating_sub(1) as f64;
    let lambda = if request.level.value.is_nan() { 0.0 } else { request.level.value.clamp(0.0, last) };
    let (below, weight) = (lambda.floor(), lambda - lambda.floor());
    let finer = at_level(texture, below as usize, request, true);
    let error = if request.bounded { request.level.error + rules::FILTER_WEIGHT.allowance.at(0.0, 0.0) } else { 0.0 };
    if last == 0.0 || (weight == 0.0 && error == 0.0) {
        return finer;
    }
    let coarser = at_level(texture, below as usize + 1, request, true);
    // Where the level may be one further down, its texels count for the bound, too.
    let further =
        if weight < error && below > 0.0 { at_level(texture, below as usize - 1, request, true) } else { finer };
    std::array::from_fn(|k| {
        let (a, b, c) = (finer[k], coarser[k], further[k]);
        let spread = (a.value - b.value).abs().max((a.value - c.value).abs());
        Near {
            value: a.value * (1.0 - weight) + b.value * weight,
            error: a.error.max(b.error) + if request.bounded { spread * error } else { 0.0 },
        }
    })
}

/// The layer: nearest, limited to those that there are.
fn layer(level: &TextureLevel, at: Near) -> (i64, bool) {
    let pick = |value: f64| ((value + 0.5).floor() as i64).clamp(0, i64::from(level.depth.max(1)) - 1);
    let chosen = pick(at.value);
    (chosen, pick(at.value - at.error) == chosen && pick(at.value + at.error) == chosen)
}

/// The coordinate in texels of a level, with its error.
fn in_texels(kind: SamplerType, at: Near, size: u32) -> Near {
    if kind.dim == SamplerDim::Rect {
        return at;
    }
    let scale = f64::from(size);
    // A GPU multiplies in f32.
    Near { value: at.value * scale, error: at.error * scale + rules::ulp(at.value * scale) }
}

fn wrapped(wrap: Wrap, index: i64, size: u32) -> i64 {
    let n = i64::from(size.max(1));
    match wrap {
        Wrap::Repeat => index.rem_euclid(n),
        Wrap::ClampToEdge => index.clamp(0, n - 1),
        Wrap::MirroredRepeat => {
            let within = index.rem_euclid(2 * n);
            if within < n { within } else { 2 * n - 1 - within }
        }
    }
}

/// An index from a float; far ones stay far.
fn index(value: f64) -> i64 {
    const FAR: f64 = 4.0e18;
    value.clamp(-FAR, FAR) as i64
}

fn axis(at: Near, offset: i32, linear: bool) -> Axis {
    let base = if linear { at.value - 0.5 } else { at.value };
    let floor = base.floor();
    let first = index(floor).saturating_add(i64::from(offset));
    Axis { first, second: first.saturating_add(1), weight: if linear { base - floor } else { 0.0 }, error: at.error }
}

/// The coordinates of a lookup in a level, as axes, and the face or layer.
struct Footprint {
    axes: [Axis; 3],
    count: usize,
    slice: i64,
    slice_sure: bool,
    wrap: Wrap,
    cube: bool,
}

fn footprint(texture: &Texture, level: &TextureLevel, request: &Request, linear: bool) -> Footprint {
    let kind = request.kind;
    let none = Axis { first: 0, second: 0, weight: 0.0, error: 0.0 };
    let mut axes = [none; 3];
    if kind.dim == SamplerDim::Cube {
        let there = cube::face_of(request.at.map(|at| at.value));
        let error = request.at.iter().map(|at| at.error).fold(0.0, f64::max) / there.ma;
        for (axis_at, c) in axes.iter_mut().zip([there.sc, there.tc]) {
            let s = if there.ma > 0.0 { 0.5 * (c / there.ma + 1.0) } else { 0.5 };
            *axis_at =
                axis(in_texels(kind, Near { value: s, error: error + 4.0 * rules::ulp(1.0) }, level.width), 0, linear);
        }
        let near_edge = there.sc.abs().max(there.tc.abs()) + 2.0 * error * there.ma >= there.ma;
        return Footprint {
            axes,
            count: 2,
            slice: there.face as i64,
            slice_sure: !near_edge,
            wrap: Wrap::ClampToEdge,
            cube: true,
        };
    }
    let count = dimensions(kind.dim);
    for (place, size) in [level.width, level.height, level.depth].into_iter().enumerate().take(count) {
        axes[place] = axis(in_texels(kind, request.at[place], size), request.offset[place], linear);
    }
    let (slice, slice_sure) = if kind.arrayed { layer(level, request.layer) } else { (0, true) };
    let wrap = if kind.dim == SamplerDim::Rect { Wrap::ClampToEdge } else { texture.wrap };
    Footprint { axes, count, slice, slice_sure, wrap, cube: false }
}

impl Footprint {
    /// The place of a texel by unwrapped indices; `None` past a cube's corner.
    fn place(&self, level: &TextureLevel, at: [i64; 3]) -> Option<[i64; 3]> {
        if self.cube {
            let (face, x, y) = cube::across(self.slice as usize, at[0], at[1], level.width)?;
            return Some([x, y, face as i64]);
        }
        let sizes = [level.width, level.height, level.depth];
        let mut place = [0, 0, self.slice];
        for axis in 0..self.count {
            place[axis] = wrapped(self.wrap, at[axis], sizes[axis]);
        }
        Some(place)
    }
}

fn nearest_place(texture: &Texture, level: &TextureLevel, request: &Request) -> ([i64; 3], bool) {
    let footprint = footprint(texture, level, request, false);
    let at = footprint.axes.map(|axis| axis.first);
    let limit = i64::from(level.width.max(1)) - 1;
    let at = if footprint.cube { [at[0].clamp(0, limit), at[1].clamp(0, limit), 0] } else { at };
    let place = footprint.place(level, at).unwrap_or([0; 3]);
    let mut sure = footprint.slice_sure;
    for (axis, coordinate) in request.at.iter().enumerate().take(footprint.count) {
        let size = [level.width, level.height, level.depth][axis];
        let near = in_texels(request.kind, *coordinate, size);
        sure &= (near.value - near.error).floor() == (near.value + near.error).floor();
    }
    (place, sure)
}

/// A texel, or what comparing it gives.
fn value(level: &TextureLevel, place: [i64; 3], texture: &Texture, request: &Request) -> [Near; 4] {
    let texel = texel::floats(level, place);
    if !request.kind.shadow {
        return texel.map(Near::exact);
    }
    let passed = compare(texture.compare, request.reference.value, texel[0]);
    // Both sides reach the comparison in f32.
    let open =
        request.bounded && (request.reference.value - texel[0]).abs() <= request.reference.error + rules::ulp(texel[0]);
    let result = Near { value: f64::from(u8::from(passed)), error: if open { 1.0 } else { 0.0 } };
    [result, Near::exact(0.0), Near::exact(0.0), Near::exact(1.0)]
}

/// `reference op stored` (§3.8.16).
fn compare(op: Compare, reference: f64, stored: f64) -> bool {
    match op {
        Compare::Never => false,
        Compare::Less => reference < stored,
        Compare::Equal => reference == stored,
        Compare::Lequal => reference <= stored,
        Compare::Greater => reference > stored,
        Compare::Notequal => reference != stored,
        Compare::Gequal => reference >= stored,
        Compare::Always => true,
    }
}

/// A lookup in one level.
fn at_level(texture: &Texture, number: usize, request: &Request, linear: bool) -> [Near; 4] {
    let Some(level) = level(texture, number) else { return super::MISSING.map(Near::exact) };
    let mut footprint = footprint(texture, level, request, linear);
    if footprint.cube && !linear {
        let limit = i64::from(level.width.max(1)) - 1;
        footprint.axes.iter_mut().for_each(|axis| axis.first = axis.first.clamp(0, limit));
    }
    let mut result = blend(texture, level, request, &footprint, linear);
    if request.bounded {
        let extra = spread(texture, level, request, &footprint, linear);
        for (near, extra) in result.iter_mut().zip(extra) {
            near.error += extra + if linear { 4.0 * rules::ulp(near.value) } else { 0.0 };
        }
    }
    result
}

/// The weighted sum over the corners of the footprint.
fn blend(texture: &Texture, level: &TextureLevel, request: &Request, footprint: &Footprint, linear: bool) -> [Near; 4] {
    let corners = if linear { 1usize << footprint.count } else { 1 };
    let mut sum = [Near::default(); 4];
    let mut missing = 0.0;
    let mut present: [Option<[Near; 4]>; 8] = [None; 8];
    for (corner, kept) in present.iter_mut().enumerate().take(corners) {
        let pick = |axis: usize| {
            let side = footprint.axes[axis];
            if corner >> axis & 1 == 1 { (side.second, side.weight) } else { (side.first, 1.0 - side.weight) }
        };
        let weight: f64 = (0..footprint.count).map(|axis| pick(axis).1).product();
        match footprint.place(level, std::array::from_fn(|axis| pick(axis).0)) {
            Some(place) => {
                let texel = value(level, place, texture, request);
                *kept = Some(texel);
                for (sum, texel) in sum.iter_mut().zip(texel) {
                    // A texel of weight 0 does not count, not even a NaN.
                    if weight != 0.0 {
                        sum.value += weight * texel.value;
                        sum.error = sum.error.max(texel.error);
                    }
                }
            }
            None => missing += weight,
        }
    }
    if missing > 0.0 {
        // At a cube's corner three texels meet: the fourth is their mean.
        for texel in present.iter().flatten() {
            for (sum, texel) in sum.iter_mut().zip(texel) {
                sum.value += missing * texel.value / 3.0;
            }
        }
    }
    sum
}

/// How far the result may be off because of where the footprint is: the range of the texels that it touches or may touch,
/// times how far it may be off.
fn spread(texture: &Texture, level: &TextureLevel, request: &Request, footprint: &Footprint, linear: bool) -> [f64; 4] {
    const MOST: f64 = 4.0;
    if footprint.axes.iter().take(footprint.count).any(|axis| axis.error.is_nan() || axis.error > MOST)
        || !footprint.slice_sure && !footprint.cube
    {
        return [f64::INFINITY; 4];
    }
    let error_of = |axis: &Axis| axis.error + if linear { rules::FILTER_WEIGHT.allowance.at(0.0, 0.0) } else { 0.0 };
    let mut ranges = [(0i64, 0i64); 3];
    for (axis, range) in ranges.iter_mut().enumerate().take(footprint.count) {
        let side = footprint.axes[axis];
        let error = error_of(&side);
        let within = if linear { side.weight } else { fraction(request, footprint, level, axis) };
        let last = if linear { side.second } else { side.first };
        *range = (
            side.first - (error - within).ceil().max(0.0) as i64,
            last + (within + error - 1.0).floor().max(-1.0) as i64 + 1,
        );
        if within + error < 1.0 {
            range.1 = last;
        }
    }
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    for z in ranges[2].0..=ranges[2].1 {
        for y in ranges[1].0..=ranges[1].1 {
            for x in ranges[0].0..=ranges[0].1 {
                let Some(place) = footprint.place(level, [x, y, z]) else { continue };
                for (k, texel) in value(level, place, texture, request).into_iter().enumerate() {
                    low[k] = low[k].min(texel.value);
                    high[k] = high[k].max(texel.value);
                }
            }
        }
    }
    let total: f64 = footprint.axes.iter().take(footprint.count).map(error_of).sum();
    let factor = if linear { total.min(1.0) } else { 1.0 };
    std::array::from_fn(|k| if high[k] > low[k] { (high[k] - low[k]) * factor } else { 0.0 })
}

/// Where in its texel a nearest lookup stands, 0 to 1.
fn fraction(request: &Request, footprint: &Footprint, level: &TextureLevel, axis: usize) -> f64 {
    if footprint.cube {
        return 0.5;
    }
    let size = [level.width, level.height, level.depth][axis];
    let near = in_texels(request.kind, request.at[axis], size);
    near.value - near.value.floor()
}
