//! Filtered texture lookups (OpenGL 3.2 §3.8.11 to §3.8.12, §3.8.16).

use super::texel;
use super::{BoundedFloat, BoundedInt, Sampled, cube, level};
use crate::domain::{FixedPoint, Profile, limits, rules};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use glisten_scene::{Compare, Texture, TextureLevel, Wrap};

/// One lookup.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Request {
    pub(crate) kind: SamplerType,
    /// s, t, r, as far as the texture has them.
    pub(crate) at: [BoundedFloat; 3],
    pub(crate) layer: BoundedFloat,
    /// The reference value of a shadow sampler.
    pub(crate) reference: BoundedFloat,
    /// The level of detail, including the bias.
    pub(crate) level: BoundedFloat,
    /// The offset in texels.
    pub(crate) offset: [i32; 3],
    /// Whether intervals are needed.
    pub(crate) bounded: bool,
    /// The steps of the weights of linear filtering; none if they are exact.
    pub(crate) weights: Option<FixedPoint>,
    /// The precision of the filters.
    pub(crate) profile: Profile,
}

/// One axis of a lookup in a level: the texels left and right, the weight of the right one, the largest error of a
/// GPU's position in texels, and the texels that it may touch.
#[derive(Clone, Copy, Debug, Default)]
struct Axis {
    first: i64,
    second: i64,
    weight: f64,
    error: f64,
    touched: (i64, i64),
}

/// Looks a texture up.
pub(crate) fn sample(texture: &Texture, request: &Request) -> Sampled {
    let mut request = *request;
    for at in &mut request.at {
        if !at.value.is_finite() {
            *at = BoundedFloat::anything(0.0);
        }
    }
    if request.kind.texel != Scalar::Float {
        // Integers are not filtered (§3.8.14): the nearest texel of the base level.
        let Some(base) = level(texture, 0) else { return Sampled::Ints([BoundedInt::default(); 4]) };
        return Sampled::Ints(nearest_bits(texture, base, &request));
    }
    let (linear, uses_levels) = (texture.filter.is_linear(), texture.filter.uses_levels());
    let minified = || if uses_levels { mipmapped(texture, &request) } else { at_level(texture, 0, &request, linear) };
    if !texture.sampling.has_two_filters(texture.filter) {
        return Sampled::Floats(minified());
    }
    let last = texture.sampling.magnified_up_to(texture.filter);
    let magnified = || at_level(texture, 0, &request, texture.sampling.magnifies_linearly(texture.filter));
    let (value, other) = if request.level.value <= last { (magnified(), None) } else { (minified(), Some(())) };
    // A GPU may switch at 0, or at 0.5.
    let is_near = request.bounded && request.level.low <= 0.5 && request.level.high >= 0.0;
    if !is_near {
        return Sampled::Floats(value);
    }
    let other = if other.is_some() { magnified() } else { minified() };
    Sampled::Floats(std::array::from_fn(|k| value[k].joined(other[k])))
}

/// The texels of a gather, as the sides of both axes: i0 j1, i1 j1, i1 j0, i0 j0 (GLSL 4.00 §8.9.3).
const GATHERED: [[i64; 2]; 4] = [[0, 1], [1, 1], [1, 0], [0, 0]];

/// One component of the four texels of the base level that a linear filter mixes. In an envelope, those of all positions
/// that the coordinate may have.
pub(crate) fn gather(texture: &Texture, request: &Request, component: usize) -> Sampled {
    let mut request = *request;
    request.at.iter_mut().filter(|at| !at.value.is_finite()).for_each(|at| *at = BoundedFloat::anything(0.0));
    let integers = request.kind.texel != Scalar::Float && !request.kind.shadow;
    let Some(base) = level(texture, 0) else { return Sampled::Floats([BoundedFloat::default(); 4]) };
    let footprint = footprint(texture, base, &request, true);
    let [x, y, _] = footprint.axes;
    let ranges = [(x, x.first), (y, y.first)].map(|(axis, first)| {
        if request.bounded {
            (axis.touched.0.min(first), axis.touched.1.saturating_sub(1).max(first))
        } else {
            (first, first)
        }
    });
    let positions = ranges.iter().fold(footprint.slices.1 - footprint.slices.0 + 1, |product, (low, high)| {
        product.saturating_mul(high.saturating_sub(*low).saturating_add(1))
    });
    let has_faces = footprint.faces.iter().flatten().count() > 1;
    if integers {
        let bits = GATHERED.map(|[right, up]| {
            let place = |right: i64, up: i64| footprint.place(base, [x.first + right, y.first + up, 0]);
            // Where three faces of a cube meet there is no fourth texel, and OpenGL leaves open what it is: one of the three, which no mean of
            // integers would be (OpenGL 4.5 §8.14.3).
            let place = place(right, up).or_else(|| place(1 - right, up)).unwrap_or([0; 3]);
            BoundedInt::exact(texel::bits(base, place).get(component).copied().unwrap_or(0))
        });
        return if (positions > 1 || has_faces) && request.bounded {
            Sampled::Ints(bits).unknown()
        } else {
            Sampled::Ints(bits)
        };
    }
    Sampled::Floats(GATHERED.map(|[right, up]| {
        let one = |i: i64, j: i64, slice: i64| {
            let place = footprint.place_in(base, [i + right, j + up, 0], slice)?;
            value(base, place, texture, &request).get(component).copied()
        };
        // Past a cube's corner there is no texel, and OpenGL leaves open what is there: the mean of the others is likely.
        let Some(likely) = one(x.first, y.first, footprint.slice) else {
            let around = GATHERED.map(|[i, j]| one(x.first + i - right, y.first + j - up, footprint.slice));
            let sum: f64 = around.iter().flatten().map(|texel| texel.value).sum();
            return BoundedFloat::anything(sum / 3.0);
        };
        // On a cube, farther texels may be those of any face, and where faces meet, a direction may be on either.
        let is_far = footprint.cube && request.bounded && (has_faces || x.error >= 1.0 || y.error >= 1.0);
        if positions > limits::MOST_TEXELS || is_far {
            return BoundedFloat::anything(likely.value);
        }
        let mut hull = likely;
        for slice in footprint.slices.0..=footprint.slices.1 {
            for j in ranges[1].0..=ranges[1].1 {
                for i in ranges[0].0..=ranges[0].1 {
                    hull = one(i, j, slice).map_or(BoundedFloat::anything(likely.value), |other| hull.joined(other));
                }
            }
        }
        hull
    }))
}

/// In the nearest level, or linear between levels; for magnification, the base level. The interval is the hull over the
/// possible levels of detail, linear between whole ones.
fn mipmapped(texture: &Texture, request: &Request) -> [BoundedFloat; 4] {
    let last = texture.levels.len().saturating_sub(1) as f64;
    let limited = |lambda: f64| if lambda.is_nan() { 0.0 } else { lambda.clamp(0.0, last) };
    let at = |lambda: f64| between(texture, request, lambda);
    let mut result = at(limited(request.level.value));
    if request.bounded {
        let weight = request.profile.level_weight();
        let (low, high) = (limited(request.level.low - weight), limited(request.level.high + weight));
        let whole = (low.ceil() as u64..=high.floor() as u64).map(|level| level as f64);
        for lambda in [low, high].into_iter().chain(whole) {
            for (bounded, other) in result.iter_mut().zip(at(lambda)) {
                *bounded = bounded.joined(other);
            }
        }
    }
    result
}

/// In the level nearest to a level of detail (OpenGL 3.2 equation 3.23), or between the two around it.
fn between(texture: &Texture, request: &Request, lambda: f64) -> [BoundedFloat; 4] {
    let linear = texture.filter.is_linear();
    if !texture.filter.blends_levels() {
        return at_level(texture, ((lambda + 0.5).ceil() - 1.0).max(0.0) as usize, request, linear);
    }
    let (below, weight) = (lambda.floor(), lambda - lambda.floor());
    let finer = at_level(texture, below as usize, request, linear);
    if weight == 0.0 {
        return finer;
    }
    let coarser = at_level(texture, below as usize + 1, request, linear);
    let mix = |a: f64, b: f64| a * (1.0 - weight) + b * weight;
    std::array::from_fn(|k| {
        let (a, b) = (finer[k], coarser[k]);
        BoundedFloat { value: mix(a.value, b.value), low: mix(a.low, b.low), high: mix(a.high, b.high) }
    })
}

/// The layer: the nearest one, limited to those that exist.
fn layers(count: u32, at: BoundedFloat) -> (i64, (i64, i64)) {
    let pick = |value: f64| (index((value + 0.5).floor())).clamp(0, i64::from(count.max(1)) - 1);
    (pick(at.value), (pick(at.low), pick(at.high)))
}

/// The coordinate in texels of a level.
fn in_texels(kind: SamplerType, at: BoundedFloat, size: u32) -> BoundedFloat {
    if kind.dim == SamplerDim::Rect {
        return at;
    }
    let scale = f64::from(size);
    // A GPU multiplies in f32.
    at.map(|at| at * scale).widened(const { rules::TEXEL_COORDINATE.ulps() } * rules::ulp(at.value * scale))
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

/// An integer index from a float; far ones remain far.
fn index(value: f64) -> i64 {
    const FAR: f64 = 4.0e18;
    value.clamp(-FAR, FAR) as i64
}

fn axis(at: BoundedFloat, offset: i32, linear: bool, request: &Request) -> Axis {
    let shift = if linear { 0.5 } else { 0.0 };
    let base = at.value - shift;
    let floor = base.floor();
    let place = |value: f64| index(value.floor()).saturating_add(i64::from(offset));
    let first = place(base);
    let second = first.saturating_add(1);
    let weight = if linear { request.profile.filter_weight() } else { 0.0 };
    let touched = (place(at.low - shift - weight), place(at.high - shift + weight).saturating_add(i64::from(linear)));
    Axis { first, second, weight: if linear { base - floor } else { 0.0 }, error: at.error() + weight, touched }
}

/// The texels of a face of a cube that a lookup may touch.
#[derive(Clone, Copy, Debug)]
struct OnFace {
    face: i64,
    x: (i64, i64),
    y: (i64, i64),
}

/// The coordinates of a lookup in a level, as axes, and the face or layer.
struct Footprint {
    axes: [Axis; 3],
    /// The texels of each face of a cube that it may touch, in an envelope.
    faces: [Option<OnFace>; 6],
    count: usize,
    slice: i64,
    /// The layers that it may be.
    slices: (i64, i64),
    wrap: Wrap,
    cube: bool,
}

fn footprint(texture: &Texture, level: &TextureLevel, request: &Request, linear: bool) -> Footprint {
    let kind = request.kind;
    let mut axes = [Axis::default(); 3];
    if kind.dim == SamplerDim::Cube {
        return on_cube(level, request, linear);
    }
    let count = usize::from(kind.dimensions());
    for (place, size) in [level.width, level.height, level.depth].into_iter().enumerate().take(count) {
        axes[place] = axis(in_texels(kind, request.at[place], size), request.offset[place], linear, request);
    }
    let (slice, slices) = if kind.arrayed { layers(level.depth, request.layer) } else { (0, (0, 0)) };
    let wrap = if kind.dim == SamplerDim::Rect { Wrap::ClampToEdge } else { texture.wrap };
    Footprint { axes, faces: [None; 6], count, slice, slices, wrap, cube: false }
}

/// The footprint in a cube. A direction within intervals may hit several faces, each in a part of its own.
fn on_cube(level: &TextureLevel, request: &Request, linear: bool) -> Footprint {
    let kind = request.kind;
    let there = cube::face_of(request.at.map(|at| at.value));
    let of = |value: f64, (low, high): (f64, f64)| {
        let bounded = BoundedFloat { value, low: value.min(low), high: value.max(high) }.map(|c| 0.5 * (c + 1.0));
        let bounded = bounded.widened(const { rules::CUBE_COORDINATE.ulps() } * rules::ulp(1.0));
        axis(in_texels(kind, bounded, level.width), 0, linear, request)
    };
    let mut axes = [Axis::default(); 3];
    let mut faces = [None; 6];
    let around = if request.bounded { cube::on_plane(there.face, request.at) } else { [(0.0, 0.0); 2] };
    for ((axis_at, c), around) in axes.iter_mut().zip([there.sc, there.tc]).zip(around) {
        let value = if there.ma > 0.0 { c / there.ma } else { 0.0 };
        *axis_at = of(value, if request.bounded { around } else { (value, value) });
    }
    if request.bounded {
        // A nearest lookup stays within its face, a linear one reads the texels next to it.
        let beyond = i64::from(linear);
        let texels = |between: (f64, f64)| {
            let (low, high) = of(between.0, between).touched;
            let limited = |at: i64| at.clamp(-beyond, i64::from(level.width.max(1)) - 1 + beyond);
            (limited(low), limited(high))
        };
        for (face, found) in faces.iter_mut().enumerate() {
            *found = cube::region(face, request.at).map(|region| OnFace {
                face: face as i64,
                x: texels(region.sc),
                y: texels(region.tc),
            });
        }
    }
    let face = there.face as i64;
    let (layer, layers) = if kind.arrayed { layers(level.depth / 6, request.layer) } else { (0, (0, 0)) };
    let slices = (6 * layers.0 + face, 6 * layers.1 + face);
    Footprint { axes, faces, count: 2, slice: 6 * layer + face, slices, wrap: Wrap::ClampToEdge, cube: true }
}

impl Footprint {
    /// The index of a texel from unwrapped indices; `None` past a cube's corner.
    fn place(&self, level: &TextureLevel, at: [i64; 3]) -> Option<[i64; 3]> {
        self.place_in(level, at, self.slice)
    }

    /// The index of a texel in another layer.
    fn place_in(&self, level: &TextureLevel, at: [i64; 3], slice: i64) -> Option<[i64; 3]> {
        if self.cube {
            let (face, x, y) = cube::across((slice % 6) as usize, at[0], at[1], level.width)?;
            return Some([x, y, slice - slice % 6 + face as i64]);
        }
        let sizes = [level.width, level.height, level.depth];
        let mut place = [0, 0, slice];
        for axis in 0..self.count {
            place[axis] = wrapped(self.wrap, at[axis], sizes[axis]);
        }
        Some(place)
    }

    /// Shows every texel that it may touch. Returns false if there are too many.
    fn each_touched(&self, level: &TextureLevel, mut show: impl FnMut([i64; 3])) -> bool {
        if self.cube {
            return self.each_on_faces(level, show);
        }
        let sizes = [level.width, level.height, level.depth].map(i64::from);
        let mut ranges = [(0i64, 0i64); 3];
        let mut total = self.slices.1 - self.slices.0 + 1;
        for (axis, range) in ranges.iter_mut().enumerate().take(self.count) {
            let (low, high) = self.axes[axis].touched;
            let clamped = self.wrap == Wrap::ClampToEdge;
            let limit = |at: i64| if clamped { at.clamp(-1, sizes[axis]) } else { at };
            let (low, high) = (limit(low), limit(high));
            // Two periods are everything there is, since mirrored textures repeat after two.
            *range = (low, high.min(low.saturating_add(2 * sizes[axis])));
            total = total.saturating_mul(range.1 - range.0 + 1);
        }
        if total > limits::MOST_TEXELS {
            return false;
        }
        for slice in self.slices.0..=self.slices.1 {
            for z in ranges[2].0..=ranges[2].1 {
                for y in ranges[1].0..=ranges[1].1 {
                    for x in ranges[0].0..=ranges[0].1 {
                        if let Some(place) = self.place_in(level, [x, y, z], slice) {
                            show(place);
                        }
                    }
                }
            }
        }
        true
    }

    /// Shows every texel of a cube that it may touch. Returns false if there are too many.
    fn each_on_faces(&self, level: &TextureLevel, mut show: impl FnMut([i64; 3])) -> bool {
        let count = |(low, high): (i64, i64)| high - low + 1;
        let layers = (self.slices.0.div_euclid(6), self.slices.1.div_euclid(6));
        let texels: i64 = self.faces.iter().flatten().map(|on| count(on.x).saturating_mul(count(on.y))).sum();
        if texels.saturating_mul(count(layers)) > limits::MOST_TEXELS {
            return false;
        }
        for layer in layers.0..=layers.1 {
            for on in self.faces.iter().flatten() {
                for y in on.y.0..=on.y.1 {
                    for x in on.x.0..=on.x.1 {
                        if let Some(place) = self.place_in(level, [x, y, 0], 6 * layer + on.face) {
                            show(place);
                        }
                    }
                }
            }
        }
        true
    }
}

fn nearest_bits(texture: &Texture, level: &TextureLevel, request: &Request) -> [BoundedInt; 4] {
    let footprint = nearest(texture, level, request);
    let place = footprint.place(level, footprint.axes.map(|axis| axis.first)).unwrap_or([0; 3]);
    let mut result = texel::bits(level, place).map(BoundedInt::exact);
    if request.bounded {
        let known = footprint.each_touched(level, |place| {
            for (result, bits) in result.iter_mut().zip(texel::bits(level, place)) {
                *result = result.joined(bits);
            }
        });
        if !known {
            return result.map(|bits| BoundedInt { low: i32::MIN, high: i32::MAX, ..bits });
        }
    }
    result
}

/// The footprint of a nearest lookup; in a cube it stays within its face.
fn nearest(texture: &Texture, level: &TextureLevel, request: &Request) -> Footprint {
    let mut footprint = footprint(texture, level, request, false);
    if footprint.cube {
        let limit = i64::from(level.width.max(1)) - 1;
        footprint.axes.iter_mut().for_each(|axis| axis.first = axis.first.clamp(0, limit));
    }
    footprint
}

/// A texel, or the result of comparing it.
fn value(level: &TextureLevel, place: [i64; 3], texture: &Texture, request: &Request) -> [BoundedFloat; 4] {
    let texel = texel::floats(level, place);
    if !request.kind.shadow {
        return texel.map(BoundedFloat::exact);
    }
    let reference =
        if texture.sampling.fixed_point_depth { request.reference.map(in_depths) } else { request.reference };
    let passed = compare(texture.compare, reference.value, texel[0]);
    let slack = const { rules::COMPARED_DEPTH.ulps() } * rules::ulp(texel[0]);
    // A clamped reference and a stored bound of the range are exact.
    let exact = texture.sampling.fixed_point_depth && reference.low == reference.high && matches!(texel[0], 0.0 | 1.0);
    let undecided = request.bounded
        && !exact
        && (reference.low - slack..=reference.high + slack).contains(&texel[0])
        && !matches!(texture.compare, Compare::Always | Compare::Never);
    let value = f64::from(u8::from(passed));
    let result = if undecided { BoundedFloat { value, low: 0.0, high: 1.0 } } else { BoundedFloat::exact(value) };
    [result, BoundedFloat::exact(0.0), BoundedFloat::exact(0.0), BoundedFloat::exact(1.0)]
}

/// A reference as a fixed-point texture compares it (§3.8.14).
fn in_depths(reference: f64) -> f64 {
    if reference.is_nan() { reference } else { reference.clamp(0.0, 1.0) }
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
fn at_level(texture: &Texture, number: usize, request: &Request, linear: bool) -> [BoundedFloat; 4] {
    let Some(level) = level(texture, number) else { return super::MISSING.map(BoundedFloat::exact) };
    if is_plain(request) {
        return plain(texture, level, request, linear).map(BoundedFloat::exact);
    }
    let footprint = if linear { footprint(texture, level, request, linear) } else { nearest(texture, level, request) };
    let result = blend(texture, level, request, &footprint, linear);
    if request.bounded { limited(texture, level, request, &footprint, linear, result) } else { result }
}

/// Whether a lookup is of numbers alone: without intervals, comparisons, and the edges of a cube.
fn is_plain(request: &Request) -> bool {
    !request.bounded && !request.kind.shadow && request.kind.dim != SamplerDim::Cube
}

/// A [plain](is_plain) lookup in a level: the same numbers as those of [`blend`] in the same order.
fn plain(texture: &Texture, level: &TextureLevel, request: &Request, linear: bool) -> [f64; 4] {
    let kind = request.kind;
    let count = usize::from(kind.dimensions());
    let wrap = if kind.dim == SamplerDim::Rect { Wrap::ClampToEdge } else { texture.wrap };
    // For each axis the texels left and right, and their weights.
    let mut sides = [[(0i64, 1.0f64); 2]; 3];
    for (axis, size) in [level.width, level.height, level.depth].into_iter().enumerate().take(count) {
        let scale = if kind.dim == SamplerDim::Rect { 1.0 } else { f64::from(size) };
        let base = request.at[axis].value * scale - if linear { 0.5 } else { 0.0 };
        let floor = base.floor();
        let first = index(floor).saturating_add(i64::from(request.offset[axis]));
        let weight = if linear { base - floor } else { 0.0 };
        let weight = request.weights.map_or(weight, |steps| steps.nearest(weight));
        let place = |at| wrapped(wrap, at, size);
        sides[axis] = [(place(first), 1.0 - weight), (place(first.saturating_add(1)), weight)];
    }
    if kind.arrayed {
        sides[2][0].0 = layers(level.depth, request.layer).0;
    }
    if !linear {
        return texel::floats(level, sides.map(|sides| sides[0].0));
    }
    let mut sum = [0.0; 4];
    for corner in 0..1usize << count {
        let mut at = sides.map(|sides| sides[0].0);
        let mut weight = 1.0;
        for axis in 0..count {
            let side = sides[axis][corner >> axis & 1];
            at[axis] = side.0;
            weight *= side.1;
        }
        // A texel of weight 0 does not count, even if it is a NaN.
        if weight != 0.0 {
            let texel = texel::floats(level, at);
            sum.iter_mut().zip(texel).for_each(|(sum, texel)| *sum += weight * texel);
        }
    }
    sum
}

/// The weighted sum over the corners of the footprint.
fn blend(
    texture: &Texture,
    level: &TextureLevel,
    request: &Request,
    footprint: &Footprint,
    linear: bool,
) -> [BoundedFloat; 4] {
    let corners = if linear { 1usize << footprint.count } else { 1 };
    // A GPU may round the share of the texels that pass a comparison instead.
    let is_share = |steps: &FixedPoint| request.kind.shadow && !steps.down;
    let (of_share, of_weights) = (request.weights.filter(is_share), request.weights.filter(|steps| !is_share(steps)));
    let mut sum = [BoundedFloat::default(); 4];
    let mut missing = 0.0;
    let mut present: [Option<[BoundedFloat; 4]>; 8] = [None; 8];
    let add = |sum: &mut [BoundedFloat; 4], weight: f64, texel: &[BoundedFloat; 4]| {
        for (sum, texel) in sum.iter_mut().zip(texel) {
            sum.value += weight * texel.value;
            sum.low += weight * texel.low;
            sum.high += weight * texel.high;
        }
    };
    for (corner, kept) in present.iter_mut().enumerate().take(corners) {
        let pick = |axis: usize| {
            let side = footprint.axes[axis];
            let weight = of_weights.map_or(side.weight, |steps| steps.nearest(side.weight));
            if corner >> axis & 1 == 1 { (side.second, weight) } else { (side.first, 1.0 - weight) }
        };
        let weight: f64 = (0..footprint.count).map(|axis| pick(axis).1).product();
        match footprint.place(level, std::array::from_fn(|axis| pick(axis).0)) {
            Some(place) => {
                let texel = value(level, place, texture, request);
                *kept = Some(texel);
                // A texel of weight 0 does not count, even if it is a NaN.
                if weight != 0.0 {
                    add(&mut sum, weight, &texel);
                }
            }
            None => missing += weight,
        }
    }
    if missing > 0.0 {
        // Three texels meet at a cube's corner: the fourth is their mean.
        present.iter().flatten().for_each(|texel| add(&mut sum, missing / 3.0, texel));
    }
    if let (Some(steps), [share, ..]) = (of_share, &mut sum) {
        share.value = steps.nearest(share.value);
    }
    sum
}

/// The interval of a GPU's results for the possible positions of the footprint: for a nearest lookup, all texels that
/// it touches; for a linear one, at most the spread of these times the error of the weights, plus its own roundings.
fn limited(
    texture: &Texture,
    level: &TextureLevel,
    request: &Request,
    footprint: &Footprint,
    linear: bool,
    result: [BoundedFloat; 4],
) -> [BoundedFloat; 4] {
    let (mut low, mut high) = ([f64::INFINITY; 4], [f64::NEG_INFINITY; 4]);
    let known = footprint.each_touched(level, |place| {
        for (k, texel) in value(level, place, texture, request).into_iter().enumerate() {
            low[k] = low[k].min(texel.low);
            high[k] = high[k].max(texel.high);
        }
    });
    if !known {
        return result.map(|bounded| BoundedFloat::anything(bounded.value));
    }
    // Between layers nothing is filtered: where it may be another one, every texel is possible.
    let is_one_layer = footprint.slices.0 == footprint.slices.1;
    let errors = footprint.axes.iter().take(footprint.count).map(|axis| axis.error);
    let off: f64 = if is_one_layer { errors.sum() } else { 1.0 };
    std::array::from_fn(|k| {
        let bounded = result[k];
        if !linear {
            return BoundedFloat {
                value: bounded.value,
                low: bounded.low.min(low[k]),
                high: bounded.high.max(high[k]),
            };
        }
        let spread = if high[k] > low[k] { (high[k] - low[k]) * off.min(1.0) } else { 0.0 };
        let rounded = const { rules::FILTER_SUM.ulps() } * rules::ulp(low[k].abs().max(high[k].abs()));
        // A mean of texels is between them.
        let (least, most) = (low[k].min(bounded.low) - rounded, high[k].max(bounded.high) + rounded);
        BoundedFloat {
            value: bounded.value,
            low: (bounded.low - spread - rounded).max(least),
            high: (bounded.high + spread + rounded).min(most),
        }
    })
}
