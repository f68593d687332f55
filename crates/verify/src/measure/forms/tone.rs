//! Closed forms of tone curves and of color spaces, by the numbers of their papers and standards. Constants are those digits as f32 has
//! them, since a GPU has no others.

use super::{Form, InputKind, dot, forms};
use crate::measure::vector::{V, add};
use crate::measure::{Answer, Args};
use glisten_scene::picture::Tone;

/// Digits as f32 has them.
fn f(digits: f32) -> f64 {
    f64::from(digits)
}

/// A matrix by rows, times a vector.
fn rows(m: [[f32; 3]; 3], v: V) -> V {
    m.map(|row| dot(row.map(f64::from), v))
}

/// A color whose errors count relative to its largest channel, or to 1.
fn color(values: V, condition: f64) -> Option<Answer> {
    let most = values.iter().fold(1.0, |most: f64, x| most.max(x.abs()));
    Some(Answer::new(values, most).conditioned(condition))
}

/// The same relative to the argument.
fn of_color(values: V, argument: V, condition: f64) -> Option<Answer> {
    let most = argument.iter().fold(f64::MIN_POSITIVE, |most: f64, x| most.max(x.abs()));
    Some(Answer::new(values, most).conditioned(condition))
}

/// Reinhard et al. (4).
fn reinhard(a: &Args<'_>) -> Option<Answer> {
    let (c, white) = (a.v(), a.f());
    color(c.map(|c| c * (1.0 + c / (white * white)) / (1.0 + c)), 6.0)
}

/// Hable's curve before its white: its two quotients.
fn hable(x: f64) -> f64 {
    let [a, b, c, d, e, g] = [0.15, 0.5, 0.1, 0.2, 0.02, 0.3];
    (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * g) - e / g
}

const FROM_OKLAB: [[f32; 3]; 3] = [
    [4.076_741_7, -3.307_711_6, 0.230_969_94],
    [-1.268_438, 2.609_757_4, -0.341_319_38],
    [-0.004_196_086_4, -0.703_418_6, 1.707_614_7],
];

fn to_oklab(c: V) -> V {
    let cones = [
        [0.412_221_46, 0.536_332_55, 0.051_445_995],
        [0.211_903_5, 0.680_699_5, 0.107_396_96],
        [0.088_302_46, 0.281_718_85, 0.629_978_7],
    ];
    let opponents = [
        [0.210_454_26, 0.793_617_8, -0.004_072_047],
        [1.977_998_5, -2.428_592_2, 0.450_593_7],
        [0.025_904_037, 0.782_771_77, -0.808_675_77],
    ];
    rows(opponents, rows(cones, c).map(f64::cbrt))
}

fn from_oklab(lab: V) -> V {
    let cones =
        [[1.0, 0.396_337_78, 0.215_803_76], [1.0, -0.105_561_346, -0.063_854_17], [1.0, -0.089_484_18, -1.291_485_5]];
    rows(FROM_OKLAB, rows(cones, lab).map(|x| x.powi(3)))
}

/// Krystek's fit of the Planckian locus, CIE 1960, as X and Z for Y = 1, and that in the primaries of sRGB: what they cannot show is cut, and
/// the luminance is 1 again.
fn temperature(kelvin: f64) -> V {
    let t = kelvin / 1000.0;
    let u = (f(0.860_117_73) + f(0.154_118_25) * t + f(0.128_641_22) * t * t)
        / (1.0 + f(0.842_420_2) * t + f(0.708_145_14) * t * t);
    let v = (f(0.317_398_73) + f(0.042_280_626) * t + f(0.042_048_167) * t * t)
        / (1.0 - f(0.028_974_181) * t + f(0.161_456_05) * t * t);
    let (x, y) = (3.0 * u / (2.0 * u - 8.0 * v + 4.0), 2.0 * v / (2.0 * u - 8.0 * v + 4.0));
    let xyz = [x / y, 1.0, (1.0 - x - y) / y];
    let srgb = [
        [3.240_454_2, -1.537_138_5, -0.498_531_4],
        [-0.969_266, 1.876_010_8, 0.041_556],
        [0.055_643_4, -0.204_025_9, 1.057_225_2],
    ];
    let shown = rows(srgb, xyz).map(|x| x.max(0.0));
    let luminance = rows([[0.212_6, 0.715_2, 0.072_2]; 3], shown)[0];
    shown.map(|x| x / luminance)
}

/// Bayer's matrix by its recursion: M(2n) = 4 M(n) + [0 2; 3 1].
fn bayer(x: f64, y: f64) -> f64 {
    let (x, y) = (x.floor().rem_euclid(8.0) as u32, y.floor().rem_euclid(8.0) as u32);
    let mut rank = 0;
    for bit in 0..3 {
        let quarter = match ((x >> bit) & 1, (y >> bit) & 1) {
            (0, 0) => 0,
            (1, 0) => 2,
            (0, _) => 3,
            _ => 1,
        };
        rank = 4 * rank + quarter;
    }
    (f64::from(rank) + 0.5) / 64.0 - 0.5
}

pub(super) static FORMS: &[Form] = forms! {
    "tonemap" "tonemapLimit(vec3)" [Bright] |a| color(a.v(), 1.0);
    "tonemap" "tonemapExposure(float)" [Stops] |a| Some(Answer::relative([1.0 / (f(1.2) * a.f().exp2())]).conditioned(16.0));
    "tonemap" "tonemapReinhard(vec3,float)" [Bright, White] reinhard;
    "tonemap" "tonemapHableCurve(vec3)" [Bright] |a| color(a.v().map(hable), 6.0);
    "tonemap" "tonemapHable(vec3)" [Bright] |a| color(Tone::Hable.apply(a.v()), 8.0);
    "tonemap" "tonemapNarkowicz(vec3)" [Bright] |a| color(Tone::Narkowicz.apply(a.v()), 6.0);
    "tonemap" "tonemapAces(vec3)" [Bright] |a| color(Tone::Aces.apply(a.v()), 24.0);
    "tonemap" "tonemapAgx(vec3)" [Bright] |a| color(Tone::Agx.apply(a.v()), 128.0);
    "tonemap" "tonemapNeutral(vec3)" [Bright] |a| color(Tone::Neutral.apply(a.v()), 8.0);
    "color" "colorLuminance(vec3)" [Intensity] |a| {
        let c = a.v();
        let value = rows([[0.212_6, 0.715_2, 0.072_2]; 3], c)[0];
        Some(Answer::new([value], 4.0))
    };
    "color" "colorToP3(vec3)" [Intensity] |a| {
        let c = a.v();
        of_color(rows([[0.822_461_96, 0.177_538_04, 0.0], [0.033_194_2, 0.966_805_8, 0.0], [0.017_082_632, 0.072_397_44, 0.910_519_96]], c), c, 2.0)
    };
    "color" "colorFromP3(vec3)" [Intensity] |a| {
        let c = a.v();
        of_color(rows([[1.224_940_2, -0.224_940_18, 0.0], [-0.042_056_955, 1.042_056_9, 0.0], [-0.019_637_555, -0.078_636_04, 1.098_273_6]], c), c, 3.0)
    };
    "color" "colorToRec2020(vec3)" [Intensity] |a| {
        let c = a.v();
        of_color(rows([[0.627_4, 0.329_3, 0.043_3], [0.069_1, 0.919_5, 0.011_4], [0.016_4, 0.088, 0.895_6]], c), c, 2.0)
    };
    "color" "colorFromRec2020(vec3)" [Intensity] |a| {
        let c = a.v();
        of_color(rows([[1.660_491, -0.587_641, -0.072_85], [-0.124_55, 1.132_9, -0.008_349], [-0.018_151, -0.100_579, 1.118_73]], c), c, 4.0)
    };
    "color" "colorCubeRoot(float)" [Any] |a| Some(Answer::relative([a.f().cbrt()]).conditioned(2.0));
    "color" "colorToOklab(vec3)" [Intensity] |a| color(to_oklab(a.v()), 16.0);
    "color" "colorFromOklab(vec3)" [Unit, Signed, Signed] |a| {
        let lab = a.v();
        // Cubes of up to 3.6 that cancel.
        color(from_oklab(lab), 512.0)
    };
    "color" "colorTemperature(float)" [Kelvin] |a| color(temperature(a.f()), 48.0);
    "color" "colorBayer(vec2)" [Pixel] |a| Some(Answer::new([bayer(a.f(), a.f())], 1.0));
    "color" "colorDither(vec3,vec2,float)" [Color, Pixel, Size] |a| {
        let (c, dither) = (a.v(), bayer(a.f(), a.f()));
        let levels = a.f().clamp(2.0, 65536.0);
        color(add(c, [dither / (levels - 1.0); 3]), 2.0)
    };
};
