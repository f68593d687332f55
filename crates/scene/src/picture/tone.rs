//! [`Tone`] and [`Encoding`]: from the light of a scene to that of a screen, and to the numbers of a picture file.
//!
//! *In:* and *out:* pixels of linear light; alpha is never changed. *Holds:* the curves are those of the library's module `tonemap`, in
//! f64, with constants that are the published digits as f32 has them. A channel below 0 counts as 0 for a curve; a channel that is no
//! number stays none. As [`Transfer`], it concerns files of 8 bits alone.

use super::Transfer;

/// A curve from light without a largest value to 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tone {
    /// The light as it is: what is above 1 is clamped.
    #[default]
    None,
    /// Reinhard et al. 2002, (3): c / (1 + c).
    Reinhard,
    /// Hable 2010, with his exposure of 2 and his white of 11.2.
    Hable,
    /// Narkowicz's fit of ACES, 2016.
    Narkowicz,
    /// Hill's fit of ACES, 2016.
    Aces,
    /// AgX, by the polynomial of Wrensch, 2023.
    Agx,
    /// Khronos PBR Neutral, 2024.
    Neutral,
}

type Color = [f64; 3];

/// Digits as f32 has them.
fn f(digits: f32) -> f64 {
    f64::from(digits)
}

/// A matrix by rows, times a color.
fn rows(m: [[f32; 3]; 3], c: Color) -> Color {
    m.map(|row| row.iter().zip(c).map(|(m, c)| f64::from(*m) * c).sum())
}

fn hable(x: f64) -> f64 {
    let [a, b, c, d, e, g] = [0.15, 0.5, 0.1, 0.2, 0.02, 0.3];
    (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * g) - e / g
}

fn narkowicz(x: f64) -> f64 {
    let [a, b, c, d, e] = [2.51_f32, 0.03, 2.43, 0.59, 0.14].map(f64::from);
    ((x * (a * x + b)) / (x * (c * x + d) + e)).clamp(0.0, 1.0)
}

/// Hill's: into the space of the reference display transform, the fit, and out.
fn aces(c: Color) -> Color {
    let v = rows([[0.597_19, 0.354_58, 0.048_23], [0.076, 0.908_34, 0.015_66], [0.028_4, 0.133_83, 0.837_77]], c);
    let fit = |v: f64| {
        let above = v * v + v * f(0.024_578_6) - f(0.000_090_537);
        above / (f(0.983_729) * v * v + f(0.432_951) * v + f(0.238_081))
    };
    let out = [[1.604_75, -0.531_08, -0.073_67], [-0.102_08, 1.108_13, -0.006_05], [-0.003_27, -0.072_76, 1.076_02]];
    rows(out, v.map(fit)).map(|x| x.clamp(0.0, 1.0))
}

/// Wrensch's fit of AgX: inset, logarithm, contrast, outset, and the decoding of the screen's power.
fn agx(c: Color) -> Color {
    let inset = [
        [0.842_479_05, 0.078_433_6, 0.079_223_745],
        [0.042_328_242, 0.878_468_63, 0.079_166_13],
        [0.042_375_654, 0.078_433_6, 0.879_143],
    ];
    let outset = [
        [1.196_879, -0.098_020_88, -0.099_029_74],
        [-0.052_896_854, 1.151_903_2, -0.098_961_174],
        [-0.052_971_635, -0.098_043_45, 1.151_073_7],
    ];
    let (low, high) = (-f(12.473_93), f(4.026_069));
    let contrast = |x: f64| {
        f(15.5) * x.powi(6) - f(40.14) * x.powi(5) + f(31.96) * x.powi(4) - f(6.868) * x.powi(3)
            + f(0.429_8) * x * x
            + f(0.119_1) * x
            - f(0.002_32)
    };
    let stops = rows(inset, c).map(|x| contrast((x.log2().clamp(low, high) - low) / (high - low)));
    rows(outset, stops).map(|x| x.clamp(0.0, 1.0).powf(f(2.2)))
}

/// The Khronos PBR Neutral tone mapper, as its specification prints it.
fn neutral(c: Color) -> Color {
    let (start, desaturation) = (f(0.8) - f(0.04), f(0.15));
    let low = c.iter().fold(f64::INFINITY, |least: f64, x| least.min(*x));
    let offset = if low < f(0.08) { low - 6.25 * low * low } else { f(0.04) };
    let c = c.map(|x| x - offset);
    let peak = c.iter().fold(0.0, |most: f64, x| most.max(*x));
    if peak < start {
        return c;
    }
    let d = 1.0 - start;
    let top = 1.0 - d * d / (peak + d - start);
    let g = 1.0 - 1.0 / (desaturation * (peak - top) + 1.0);
    c.map(|x| (1.0 - g) * top / peak * x + g * top)
}

impl Tone {
    /// The names in a scene.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("none", Self::None),
        ("reinhard", Self::Reinhard),
        ("hable", Self::Hable),
        ("narkowicz", Self::Narkowicz),
        ("aces", Self::Aces),
        ("agx", Self::Agx),
        ("neutral", Self::Neutral),
    ];

    /// The color of a screen for linear light with the primaries of Rec. 709.
    pub fn apply(self, color: [f64; 3]) -> [f64; 3] {
        if self == Self::None || color.iter().any(|channel| channel.is_nan()) {
            return color;
        }
        // Above, every curve has reached its end.
        let c = color.map(|channel| channel.clamp(0.0, 40.0f64.exp2()));
        match self {
            Self::None => color,
            Self::Reinhard => c.map(|c| c / (1.0 + c)),
            Self::Hable => c.map(|c| (hable(2.0 * c) / hable(11.2)).min(1.0)),
            Self::Narkowicz => c.map(narkowicz),
            Self::Aces => aces(c),
            Self::Agx => agx(c),
            Self::Neutral => neutral(c),
        }
    }
}

/// How the numbers of an 8-bit picture file follow from the light that a shader computed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Encoding {
    /// The exposure in stops: light counts 2^exposure times.
    pub exposure: f64,
    /// The curve.
    pub tone: Tone,
    /// The transfer function.
    pub transfer: Transfer,
}

impl From<Transfer> for Encoding {
    fn from(transfer: Transfer) -> Self {
        Self { transfer, ..Self::default() }
    }
}

impl Encoding {
    /// A pixel as the light of a screen, before the transfer function.
    pub fn expose(self, [red, green, blue, alpha]: [f64; 4]) -> [f64; 4] {
        // Exactly 1 for no stops, so that nothing rounds.
        let gain = self.exposure.exp2();
        let [red, green, blue] = self.tone.apply([red, green, blue].map(|channel| channel * gain));
        [red, green, blue, alpha]
    }

    /// A pixel as it is stored: red, green and blue encoded, alpha as it is.
    pub fn encode_pixel(self, pixel: [f64; 4]) -> [f64; 4] {
        self.transfer.encode_pixel(self.expose(pixel))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Values that others publish for gray: Reinhard's by hand; Narkowicz's, Hill's and Khronos' by their own code, with the digits that they
    /// print.
    #[test]
    fn gray_has_the_published_values() {
        let gray = |tone: Tone, x: f64| tone.apply([x; 3])[0];
        for (tone, x, y, error) in [
            (Tone::None, 3.0, 3.0, 0.0),
            (Tone::Reinhard, 1.0, 0.5, 0.0),
            (Tone::Narkowicz, 1.0, 2.54 / 3.16, 1e-6),
            (Tone::Hable, 5.6, 1.0, 1e-12),
            // The offset of 0.04 below the knee at 0.8, white only at infinity.
            (Tone::Neutral, 0.5, 0.46, 1e-6),
            (Tone::Neutral, 0.8, 0.76, 1e-6),
            (Tone::Neutral, 1.0, 1.0 - 0.24 * 0.24 / (0.96 + 0.24 - 0.76), 1e-6),
            // Middle gray becomes about half of the signal of a screen with the exponent 2.2.
            (Tone::Agx, 0.18, 0.5f64.powf(2.2), 0.005),
            (Tone::Aces, 0.18, 0.105, 0.005),
        ] {
            assert!((gray(tone, x) - y).abs() <= error, "{tone:?} of {x}: {}", gray(tone, x));
        }
    }

    #[test]
    fn curves_rise_stay_on_screen_and_pass_on_what_is_no_number() {
        for (name, tone) in Tone::NAMES {
            let values: Vec<f64> = (0..400).map(|i| tone.apply([1e-4 * 1.06f64.powi(i); 3])[1]).collect();
            assert!(values.is_sorted(), "{name}");
            assert!(*tone == Tone::None || values.iter().all(|y| (0.0..=1.0).contains(y)), "{name}");
            assert!(tone.apply([0.0, f64::NAN, 1.0]).iter().any(|channel| channel.is_nan()), "{name}");
            let extreme = tone.apply([f64::INFINITY, -1.0, 1e300]);
            assert!(*tone == Tone::None || extreme.iter().all(|y| (0.0..=1.0).contains(y)), "{name}: {extreme:?}");
        }
    }

    #[test]
    fn exposure_counts_in_stops_and_transfer_comes_last() {
        let encoding = Encoding { exposure: 2.0, tone: Tone::Reinhard, transfer: Transfer::Srgb };
        let [red, _, _, alpha] = encoding.encode_pixel([0.25, 0.0, 0.0, 0.5]);
        assert!((red - Transfer::Srgb.encode(0.5)).abs() < 1e-12 && alpha == 0.5);
        assert_eq!(Encoding::from(Transfer::Linear), Encoding::default());
        assert_eq!(Encoding::default().encode_pixel([3.0, -1.0, 0.1, 2.0]), [3.0, -1.0, 0.1, 2.0]);
    }
}
