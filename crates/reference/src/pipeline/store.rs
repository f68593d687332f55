//! Writes one fragment to its pixel: depth test, blending, rounding to the format (OpenGL 3.2 §4.1).
//!
//! *In:* the depth and color of a fragment, and the contents of the pixel. *Out:* the new contents. *Holds:* if a
//! conforming GPU may decide either way, the pixel contains the hull of both.

use crate::domain::{Domain, Number, rules};
use glisten_scene::picture::Interval;
use glisten_scene::{Blend, BlendFactor, Compare, Format, State};
use half::f16;

/// The result of testing a fragment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Test {
    /// Whether the values pass, so that the fragment is drawn.
    pub(super) passes: bool,
    /// Whether a conforming GPU may decide differently.
    pub(super) undecided: bool,
}

/// Runs the depth test (§4.1.5) of a fragment that passed all earlier tests, and writes depth if it passes.
#[inline(always)]
pub(super) fn depth_test<D: Domain>(slot: &mut D::Float, z: D::Float, state: &State, before: Test) -> Test {
    let stored = *slot;
    let z = store_depth::<D>(z);
    let passes = compare(state.depth_func, z.value(), stored.value());
    let mut test = Test { passes: before.passes && passes, undecided: before.undecided };
    if D::HAS_INTERVALS {
        let (always, never) = certain(state.depth_func, z.interval(), stored.interval());
        test = Test {
            passes: before.passes && !never && (passes || always),
            undecided: !never && (before.undecided || !always),
        };
    }
    if state.depth_write {
        match (test.passes, test.undecided) {
            (false, false) => {}
            (true, false) => *slot = z,
            (true, true) => *slot = z.joined(stored),
            (false, true) => *slot = stored.joined(z),
        }
    }
    test
}

/// A color blended with the contents of a pixel, in the attachment's format.
pub(super) fn stored<D: Domain>(
    color: [D::Float; 4],
    old: [D::Float; 4],
    blend: Option<Blend>,
    format: Format,
    test: Test,
) -> [D::Float; 4] {
    let color = match blend {
        Some(blend) => {
            let in_bytes = D::HAS_INTERVALS && format == Format::Rgba8Unorm;
            let round = if in_bytes { in_steps::<D> } else { |value| value };
            blended::<D>(blend, clamped::<D>(color, format).map(round), old, round)
        }
        None => color,
    };
    let new = color.map(|channel| store::<D>(channel, format));
    match (test.passes, test.undecided) {
        (_, false) => new,
        (true, true) => std::array::from_fn(|i| new[i].joined(old[i])),
        (false, true) => std::array::from_fn(|i| old[i].joined(new[i])),
    }
}

/// Whether the format stores colors unchanged.
pub(super) fn keeps(format: Format) -> bool {
    matches!(format, Format::Rgba32Float | Format::Rgba32Sint | Format::Rgba32Uint)
}

pub(super) fn is_integer(format: Format) -> bool {
    matches!(format, Format::Rgba32Sint | Format::Rgba32Uint)
}

/// A comparison of depth.
fn compare(function: Compare, new: f64, stored: f64) -> bool {
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

/// Whether a comparison of depth holds for equal numbers.
pub(super) fn holds_for_equal(function: Compare) -> bool {
    compare(function, 0.0, 0.0)
}

/// Whether a comparison of depth certainly holds, and whether it certainly fails.
fn certain(function: Compare, new: Interval, stored: Interval) -> (bool, bool) {
    let below = new.high < stored.low;
    let above = new.low > stored.high;
    let not_above = new.high <= stored.low;
    let not_below = new.low >= stored.high;
    let same = new.width() == 0.0 && stored.width() == 0.0 && new.low == stored.low;
    let disjoint = below || above;
    match function {
        _ if new.may_be_nan => (function == Compare::Always, function == Compare::Never),
        Compare::Never => (false, true),
        Compare::Less => (below, not_below),
        Compare::Equal => (same, disjoint),
        Compare::Lequal => (not_above, above),
        Compare::Greater => (above, not_above),
        Compare::Notequal => (disjoint, same),
        Compare::Gequal => (not_below, below),
        Compare::Always => (true, false),
    }
}

/// Depth as a 32-bit float, clamped to [0, 1] (§2.12.1).
fn store_depth<D: Domain>(z: D::Float) -> D::Float {
    let stored = f64::from(z.value() as f32).clamp(0.0, 1.0);
    if !D::HAS_INTERVALS {
        return D::Float::from_f64(stored);
    }
    let Interval { low, high, may_be_nan } = z.interval();
    D::Float::with_interval(stored, Interval { low: low.clamp(0.0, 1.0), high: high.clamp(0.0, 1.0), may_be_nan })
}

/// Clamps the source color of a fixed-point attachment before blending (§4.1.7).
fn clamped<D: Domain>(color: [D::Float; 4], format: Format) -> [D::Float; 4] {
    if format != Format::Rgba8Unorm {
        return color;
    }
    color.map(|channel| channel.max(D::Float::default()).min(D::Float::from_f64(1.0)))
}

/// A number, joined with the nearest step of 1/255: blending in an 8-bit attachment may use only as many bits as the
/// attachment has (§4.1.7), which rounds the source, the factors and the products, or may use floats.
fn in_steps<D: Domain>(value: D::Float) -> D::Float {
    let Interval { low, high, may_be_nan } = value.interval();
    let slack = const { rules::STORE_SLACK.absolute() };
    let steps = const { rules::BLEND_8_BITS.steps() };
    let step = |x: f64| (x * steps).round() / steps;
    let (low, high) = (low.min(step(low - slack)), high.max(step(high + slack)));
    D::Float::with_interval(value.value(), Interval { low, high, may_be_nan })
}

/// `source * S + destination * D` (§4.1.7, tables 4.1 and 4.2), with a rounding of factors and products.
fn blended<D: Domain>(
    blend: Blend,
    source: [D::Float; 4],
    destination: [D::Float; 4],
    round: impl Fn(D::Float) -> D::Float,
) -> [D::Float; 4] {
    let constant = blend.constant.map(|channel| D::Float::from_f64(f64::from(channel)));
    let by = |name: BlendFactor| factor::<D>(name, source, destination, constant).map(&round);
    let (s, d) = (by(blend.source), by(blend.destination));
    std::array::from_fn(|i| {
        let part = |weight: D::Float, value: D::Float, name: BlendFactor| match name {
            // A factor that is not computed yields 0, even with infinity.
            BlendFactor::Zero => D::Float::default(),
            BlendFactor::One => value,
            _ => round(weight.mul(value)),
        };
        part(s[i], source[i], blend.source).add(part(d[i], destination[i], blend.destination))
    })
}

fn factor<D: Domain>(
    name: BlendFactor,
    source: [D::Float; 4],
    destination: [D::Float; 4],
    constant: [D::Float; 4],
) -> [D::Float; 4] {
    let one = D::Float::from_f64(1.0);
    let rest = |value: D::Float| one.sub(value);
    let [_, _, _, source_alpha] = source;
    let [_, _, _, destination_alpha] = destination;
    let [_, _, _, constant_alpha] = constant;
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
        BlendFactor::ConstantColor => constant,
        BlendFactor::OneMinusConstantColor => constant.map(rest),
        BlendFactor::ConstantAlpha => [constant_alpha; 4],
        BlendFactor::OneMinusConstantAlpha => [rest(constant_alpha); 4],
    }
}

/// A channel as the format stores it (§2.1.5, §4.1.7). With an envelope, it covers all steps at which a number inside
/// may be stored.
pub(super) fn store<D: Domain>(value: D::Float, format: Format) -> D::Float {
    let convert: fn(f64) -> f64 = match format {
        Format::Rgba32Float | Format::Rgba32Sint | Format::Rgba32Uint => return value,
        Format::Rgba16Float => D::stored_half,
        Format::Rgba8Unorm => unorm8,
    };
    let stored = convert(value.value());
    if !D::HAS_INTERVALS {
        return D::Float::from_f64(stored);
    }
    let Interval { low, high, may_be_nan } = value.interval();
    if low == high && convert(low) == low {
        return D::Float::from_f64(stored);
    }
    // A step of 8 bits is not an f32: its bounds are rounded outward once more.
    let interval = match format {
        Format::Rgba8Unorm => {
            let slack = const { rules::STORE_SLACK.absolute() };
            let low = if may_be_nan { 0.0 } else { convert(low - slack) };
            Interval { low, high: convert(high + slack), may_be_nan: false }
        }
        _ => Interval { low: half_below(low), high: -half_below(-high), may_be_nan },
    };
    D::Float::with_interval(stored, interval)
}

/// The largest half-precision float not above a number.
fn half_below(x: f64) -> f64 {
    let near = f16::from_f64(x);
    let value = f64::from(near);
    if value <= x || value.is_nan() {
        return value;
    }
    let bits = near.to_bits();
    let below = match (value > 0.0, value == 0.0) {
        (true, _) => bits - 1,
        (_, true) => 0x8001,
        _ => bits + 1,
    };
    f64::from(f16::from_bits(below))
}

/// An 8-bit normalized channel: clamped, `round(255 x) / 255`; NaN is 0.
fn unorm8(x: f64) -> f64 {
    let steps = const { rules::STORE_8_BITS.steps() };
    if x.is_nan() { 0.0 } else { (x.clamp(0.0, 1.0) * steps).round_ties_even() / steps }
}
