//! Textures by formula: `tex = { pattern = "specular", exponent = 32 }`.
//!
//! *In:* the name of a pattern and its parameters. *Out:* a level of float texels, computed in f64 and rounded once.
//!
//! *Holds:* tables over a cosine (`specular`, `metal`, `soft`, `hemisphere`) contain f(i / (n - 1)) in texel i, so
//! that their ends are exact and match the library's coordinate `lutCoordinate`. Pictures (`checker`, `tile`, `sky`)
//! contain the color at each texel's center and repeat. The formulas are in `docs/scenes.md`.

use super::{Loader, fibers};
use crate::model::{Texels, TextureLevel, Wrap};
use crate::tables::{Node, list};
use glisten_front::diagnostic::codes::scenes::{SCENE_WRONG_KIND, SCENE_WRONG_VALUE};
use glisten_front::hir::{SamplerDim, SamplerType, Scalar};
use std::f64::consts::TAU;
use std::sync::LazyLock;
use toml::de::DeTable;

type Color = [f64; 3];
type Texel = [f64; 4];

/// A pattern: its name, formula and defaults.
#[derive(Clone, Copy)]
pub(super) struct Pattern {
    name: &'static str,
    /// The parameters that it uses.
    keys: &'static [&'static str],
    /// The number of texels along s and t, unless the scene gives them.
    size: (u32, u32),
    /// Whether texel i is the value at i / (n - 1) rather than at its center.
    is_table: bool,
    from: Color,
    to: Color,
    formula: fn(&Parameters, f64, f64) -> Texel,
}

/// The parameters of a formula.
struct Parameters {
    from: Color,
    to: Color,
    exponent: f64,
    bands: f64,
    edge: f64,
    softness: f64,
    cells: f64,
    gap: f64,
}

/// The parameters of all patterns.
pub(super) const KEYS: &[&str] = &["from", "to", "exponent", "bands", "edge", "softness", "cells", "gap"];

const BLACK: Color = [0.0; 3];
const WHITE: Color = [1.0; 3];

const PATTERNS: &[Pattern] = &[
    Pattern {
        name: "plain",
        keys: &["to"],
        size: (1, 1),
        is_table: false,
        from: BLACK,
        to: WHITE,
        formula: |p, _, _| opaque(p.to),
    },
    Pattern {
        name: "specular",
        keys: &["from", "to", "exponent"],
        size: (256, 1),
        is_table: true,
        from: BLACK,
        to: WHITE,
        formula: |p, x, _| opaque(mix(p.from, p.to, x.powf(p.exponent))),
    },
    Pattern {
        name: "metal",
        keys: &["from", "to", "exponent", "bands"],
        size: (256, 1),
        is_table: true,
        from: BLACK,
        to: WHITE,
        formula: |p, x, _| opaque(mix(p.from, p.to, metal(p, x))),
    },
    Pattern {
        name: "soft",
        keys: &["from", "to", "edge", "softness"],
        size: (256, 1),
        is_table: true,
        from: [0.95, 0.5, 0.2],
        to: WHITE,
        formula: |p, x, _| opaque(mix(p.from, p.to, smoothstep(p.edge - p.softness, p.edge + p.softness, x))),
    },
    Pattern {
        name: "hemisphere",
        keys: &["from", "to"],
        size: (2, 1),
        is_table: true,
        from: [0.35, 0.25, 0.15],
        to: [0.6, 0.75, 1.0],
        formula: |p, x, _| opaque(mix(p.from, p.to, x)),
    },
    Pattern {
        name: "checker",
        keys: &["from", "to", "cells"],
        size: (256, 256),
        is_table: false,
        from: [0.2; 3],
        to: [0.9; 3],
        formula: |p, s, t| opaque(if is_odd(p, s, t) { p.from } else { p.to }),
    },
    Pattern {
        name: "tile",
        keys: &["from", "to", "cells", "gap"],
        size: (256, 256),
        is_table: false,
        from: [0.45, 0.42, 0.4],
        to: [0.8, 0.76, 0.7],
        formula: |p, s, t| opaque(tile(p, s, t)),
    },
    Pattern {
        name: "sky",
        keys: &["from", "to"],
        size: (512, 256),
        is_table: false,
        from: [0.85, 0.9, 0.95],
        to: [0.25, 0.5, 0.85],
        formula: |p, s, t| opaque(sky(p, s, t)),
    },
    Pattern {
        name: "ltc_matrix",
        keys: &[],
        size: (LTC, LTC),
        is_table: true,
        from: BLACK,
        to: WHITE,
        formula: |_, x, y| cosines(x, y, |[a, b, c, d, ..]| [a, b, c, d]),
    },
    Pattern {
        name: "ltc_albedo",
        keys: &[],
        size: (LTC, LTC),
        is_table: true,
        from: BLACK,
        to: WHITE,
        formula: |_, x, y| {
            let [all, grazing, ..] = cosines(x, y, |[.., all, grazing]| [all, grazing, 0.0, 0.0]);
            [all, grazing, mean_albedo(y), 1.0]
        },
    },
    Pattern {
        name: "sheen_albedo",
        keys: &[],
        size: (LTC, LTC),
        is_table: true,
        from: BLACK,
        to: WHITE,
        formula: |_, x, y| opaque([fibers::albedo(x * x, y); 3]),
    },
];

/// The pattern that a scene requests, if it does, with the keys that it adds to those of any texture.
pub(super) fn find(table: &DeTable<'_>) -> Option<Pattern> {
    let name = table.get("pattern")?.get_ref().as_str()?;
    PATTERNS.iter().find(|pattern| pattern.name == name).copied()
}

/// The level of a pattern without any keys.
pub(super) fn by_default(name: &str) -> Option<TextureLevel> {
    let pattern = PATTERNS.iter().find(|pattern| pattern.name == name)?;
    let parameters = Parameters { from: pattern.from, to: pattern.to, ..Parameters::default() };
    Some(fill(pattern, &parameters, pattern.size.0, pattern.size.1))
}

impl Default for Parameters {
    fn default() -> Self {
        Self { from: BLACK, to: WHITE, exponent: 32.0, bands: 3.0, edge: 0.55, softness: 0.06, cells: 8.0, gap: 0.04 }
    }
}

impl Pattern {
    /// The default wrap mode. Tables clamp: a table that repeats would mix its two ends at both.
    pub(super) fn wrap(&self) -> Wrap {
        if self.is_table { Wrap::ClampToEdge } else { Wrap::Repeat }
    }
}

/// The level for a texture's table; `node` is its `pattern`.
pub(super) fn load(
    loader: &mut Loader<'_>,
    table: &DeTable<'_>,
    node: &Node<'_>,
    name: &str,
    kind: SamplerType,
) -> Option<TextureLevel> {
    let names: Vec<(&str, Pattern)> = PATTERNS.iter().map(|pattern| (pattern.name, *pattern)).collect();
    let reader = &mut loader.reader;
    let pattern = reader.choice(node, "pattern", &names)?;
    let span = reader.span_of(node);
    if !matches!(kind.dim, SamplerDim::D1 | SamplerDim::D2)
        || kind.arrayed
        || kind.shadow
        || kind.texel != Scalar::Float
    {
        let message = format!("`{name}` is a {}: a pattern is a 2D or 1D texture of floats", kind.name());
        reader.error(&SCENE_WRONG_KIND, span, message, "not for this sampler");
        return None;
    }
    for (key, _) in table {
        let key_name: &str = key.get_ref();
        if KEYS.contains(&key_name) && !pattern.keys.contains(&key_name) {
            let span = reader.span_of(key);
            let message = format!("the pattern `{}` has no `{key_name}`", pattern.name);
            let has = format!("it has {}", list(pattern.keys));
            reader.error(&SCENE_WRONG_VALUE, span, message, &has);
        }
    }
    let width = reader.count(table, "width", pattern.size.0, 1..=4096);
    let is_flat = kind.dim == SamplerDim::D1;
    let height = if is_flat { 1 } else { reader.count(table, "height", pattern.size.1, 1..=4096) };
    let own = Parameters::default();
    let parameters = Parameters {
        from: reader.reals(table, "from", pattern.from),
        to: reader.reals(table, "to", pattern.to),
        exponent: reader.real(table, "exponent", own.exponent),
        bands: reader.real(table, "bands", own.bands),
        edge: reader.real(table, "edge", own.edge),
        softness: reader.real(table, "softness", own.softness),
        cells: reader.real(table, "cells", own.cells),
        gap: reader.real(table, "gap", own.gap),
    };
    Some(fill(&pattern, &parameters, width, height))
}

fn fill(pattern: &Pattern, parameters: &Parameters, width: u32, height: u32) -> TextureLevel {
    let place = |index: u32, count: u32| match (pattern.is_table, count) {
        (true, 1) => 1.0,
        (true, _) => f64::from(index) / f64::from(count - 1),
        (false, _) => (f64::from(index) + 0.5) / f64::from(count),
    };
    let mut texels = Vec::with_capacity(width as usize * height as usize);
    for row in 0..height {
        for column in 0..width {
            let texel = (pattern.formula)(parameters, place(column, width), place(row, height));
            texels.push(texel.map(|channel| channel as f32));
        }
    }
    TextureLevel { width, height, depth: 1, texels: Texels::Float(texels) }
}

fn opaque([r, g, b]: Color) -> Texel {
    [r, g, b, 1.0]
}

/// The columns and the rows of `ltc.txt`.
const LTC: u32 = 32;

/// `ltc.txt`, which `cargo run --release -p glisten-studies --bin ltc` made: six numbers for each texel.
static COSINES: LazyLock<Vec<[f64; 6]>> = LazyLock::new(|| {
    let texel = |line: &str| {
        let mut numbers = line.split(' ').map(|number| number.parse().unwrap_or(f64::NAN));
        std::array::from_fn(|_| numbers.next().unwrap_or(f64::NAN))
    };
    include_str!("ltc.txt").lines().map(texel).collect()
});

/// Numbers of that table between its texels.
fn cosines(x: f64, y: f64, part: fn([f64; 6]) -> Texel) -> Texel {
    let last = LTC - 1;
    let place = |x: f64| {
        let at = x.clamp(0.0, 1.0) * f64::from(last);
        let below = (at.floor() as u32).min(last - 1);
        (below, at - f64::from(below))
    };
    let ((column, s), (row, t)) = (place(x), place(y));
    let at = |column: u32, row: u32| part(COSINES.get((row * LTC + column) as usize).copied().unwrap_or([f64::NAN; 6]));
    let corners = [at(column, row), at(column + 1, row), at(column, row + 1), at(column + 1, row + 1)];
    let weights = [(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t];
    std::array::from_fn(|channel| corners.iter().zip(weights).map(|(corner, weight)| corner[channel] * weight).sum())
}

/// The mean over all directions of the first number of `ltc_albedo`, by the cosine: with cos = x^2, of 4 x^3 over x.
fn mean_albedo(y: f64) -> f64 {
    const STEPS: u32 = 8 * (LTC - 1);
    let part = |step: u32| {
        let x = (f64::from(step) + 0.5) / f64::from(STEPS);
        let [all, ..] = cosines(x, y, |[.., all, _]| [all, 0.0, 0.0, 0.0]);
        all * 4.0 * x.powi(3) / f64::from(STEPS)
    };
    (0..STEPS).map(part).sum()
}

fn mix(from: Color, to: Color, x: f64) -> Color {
    std::array::from_fn(|channel| from[channel] * (1.0 - x) + to[channel] * x)
}

fn smoothstep(low: f64, high: f64, x: f64) -> f64 {
    if high <= low {
        return if x < low { 0.0 } else { 1.0 };
    }
    let t = ((x - low) / (high - low)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn is_odd(p: &Parameters, s: f64, t: f64) -> bool {
    ((s * p.cells).floor() + (t * p.cells).floor()).rem_euclid(2.0) >= 1.0
}

/// Bands that grow brighter towards the highlight, times the highlight's power: the mottled look of metal that
/// mirrors its surroundings.
fn metal(p: &Parameters, x: f64) -> f64 {
    let band = 0.5 - 0.5 * (TAU * p.bands * x).cos();
    (0.12 * x + 0.5 * x * band + 0.9 * x.powf(p.exponent)).min(1.0)
}

/// Square tiles, every other one a little darker, separated by gaps of `gap` of a tile.
fn tile(p: &Parameters, s: f64, t: f64) -> Color {
    let inside = |x: f64| {
        let place = (x * p.cells).rem_euclid(1.0);
        place >= p.gap / 2.0 && place <= 1.0 - p.gap / 2.0
    };
    if !inside(s) || !inside(t) {
        return p.from;
    }
    let level = if is_odd(p, s, t) { 0.88 } else { 1.0 };
    p.to.map(|channel| channel * level)
}

/// From the horizon (t = 0) to the zenith (t = 1), with clouds: five octaves of crossed sine waves, with whole
/// numbers of waves around.
fn sky(p: &Parameters, s: f64, t: f64) -> Color {
    let mut cloud = 0.0;
    for octave in 0..5 {
        let scale = f64::from(1 << octave);
        let phase = 1.7 * f64::from(octave);
        let bend = (TAU * (scale * s + 0.3 * scale * t) + phase).sin();
        cloud += (TAU * (2.0 * scale * s + 0.25 * bend) + 2.0 * phase).sin()
            * (TAU * (2.0 * scale * t + 0.2 * bend) + phase).sin()
            / (scale * 1.2);
    }
    let cover = smoothstep(0.05, 0.9, cloud) * (1.0 - t) * 0.9;
    mix(mix(p.from, p.to, t.powf(0.7)), WHITE, cover)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texels(name: &str, width: u32, height: u32) -> Vec<[f32; 4]> {
        let pattern = PATTERNS.iter().find(|pattern| pattern.name == name).expect("it is there");
        let parameters = Parameters {
            from: pattern.from,
            to: pattern.to,
            exponent: 32.0,
            bands: 3.0,
            edge: 0.55,
            softness: 0.06,
            cells: 8.0,
            gap: 0.04,
        };
        match fill(pattern, &parameters, width, height).texels {
            Texels::Float(texels) => texels,
            other => panic!("patterns are floats: {other:?}"),
        }
    }

    #[test]
    fn tables_hold_the_function_at_both_ends() {
        let power = texels("specular", 256, 1);
        assert_eq!((power[0][0], power[255][0]), (0.0, 1.0));
        assert_eq!(power[128][0], (128.0_f64 / 255.0).powi(32) as f32);
        let dome = texels("hemisphere", 2, 1);
        assert_eq!(dome, [[0.35, 0.25, 0.15, 1.0], [0.6, 0.75, 1.0, 1.0]]);
        let soft = texels("soft", 256, 1);
        assert_eq!((soft[0][1], soft[255][1]), (0.5, 1.0));
        assert!(soft.is_sorted_by(|a, b| a[1] <= b[1]));
        let metal = texels("metal", 256, 1);
        assert_eq!((metal[0][0], metal[255][0]), (0.0, 1.0));
        assert!(!metal.is_sorted_by(|a, b| a[0] <= b[0]), "it is mottled");
    }

    #[test]
    fn every_pattern_is_a_color_everywhere() {
        for pattern in PATTERNS.iter().filter(|pattern| !pattern.name.starts_with("ltc")) {
            for texel in texels(pattern.name, 67, 31) {
                assert!(texel.iter().all(|channel| (0.0..=1.0).contains(channel)), "{}: {texel:?}", pattern.name);
            }
        }
    }

    #[test]
    fn the_cosines_are_all_there() {
        assert_eq!(COSINES.len(), (LTC * LTC) as usize);
        assert!(COSINES.iter().flatten().all(|number| number.is_finite()));
        // An eye above the surface sees the same in all directions; between texels is the mean.
        let matrix = texels("ltc_matrix", LTC, LTC);
        assert!(matrix.iter().step_by(LTC as usize).all(|texel| texel[0] == 1.0 && texel[1] == 0.0));
        let (fine, albedo) = (texels("ltc_matrix", 2 * LTC - 1, 1), texels("ltc_albedo", LTC, LTC));
        assert!((fine[1][1] - 0.5 * (matrix[992][1] + matrix[993][1])).abs() < 1e-7);
        assert!(albedo.iter().all(|texel| texel[0] <= 1.0 && texel[1] <= texel[0]));
    }

    #[test]
    fn pictures_repeat_without_a_seam() {
        let checker = texels("checker", 64, 64);
        assert_eq!(checker[0][0], 0.9);
        assert_eq!((checker[8][0], checker[63][0]), (0.2, 0.2));
        // Around the horizon, neighbors at the seam differ no more than elsewhere.
        let sky = texels("sky", 512, 64);
        for row in sky.chunks(512) {
            let step = |a: [f32; 4], b: [f32; 4]| (a[0] - b[0]).abs();
            let largest = row.windows(2).map(|pair| step(pair[0], pair[1])).fold(0.0, f32::max);
            assert!(step(row[511], row[0]) <= 1.5 * largest.max(0.01));
        }
    }
}
