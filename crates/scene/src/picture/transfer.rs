//! [`Transfer`]: from linear light to the numbers of a picture file, and back (IEC 61966-2-1).
//!
//! *In:* and *out:* channels; alpha is never encoded. *Holds:* it concerns files of 8 bits alone. Whatever is compared
//! or written as a float stays linear.

/// How the 8-bit colors of a file relate to the light that a shader computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transfer {
    /// The numbers as they are, as `glReadPixels` gives them.
    #[default]
    Linear,
    /// Encoded by the transfer function of sRGB, which viewers of pictures expect.
    Srgb,
}

impl Transfer {
    /// The names in a scene.
    pub const NAMES: &'static [(&'static str, Self)] = &[("linear", Self::Linear), ("srgb", Self::Srgb)];

    /// A linear channel as it is stored; what is not in [0, 1] is clamped when it is rounded.
    pub fn encode(self, linear: f64) -> f64 {
        match self {
            Self::Linear => linear,
            Self::Srgb if linear <= 0.003_130_8 => 12.92 * linear,
            Self::Srgb => 1.055 * linear.powf(1.0 / 2.4) - 0.055,
        }
    }

    /// The linear value of a stored channel.
    pub fn decode(self, stored: f64) -> f64 {
        match self {
            Self::Linear => stored,
            Self::Srgb if stored <= 0.040_45 => stored / 12.92,
            Self::Srgb => ((stored + 0.055) / 1.055).powf(2.4),
        }
    }

    /// A pixel as it is stored: red, green and blue encoded, alpha as it is.
    pub fn encode_pixel(self, [red, green, blue, alpha]: [f64; 4]) -> [f64; 4] {
        [self.encode(red), self.encode(green), self.encode(blue), alpha]
    }
}

#[cfg(test)]
mod tests {
    use super::Transfer::{self, Linear, Srgb};

    #[test]
    fn the_values_of_the_standard() {
        // IEC 61966-2-1: black, the joint, 18 % gray as 8 bits, white.
        for (linear, byte) in [(0.0, 0.0), (0.003_130_8, 10.31), (0.18, 117.63), (0.5, 187.52), (1.0, 255.0)] {
            assert!((255.0 * Srgb.encode(linear) - byte).abs() < 0.05, "{linear}: {}", 255.0 * Srgb.encode(linear));
            assert!((Linear.encode(linear) - linear).abs() < f64::EPSILON);
        }
        assert_eq!(Srgb.encode_pixel([0.0, 1.0, 0.5, 0.25])[3], 0.25);
        assert!(Srgb.encode(f64::NAN).is_nan() && Srgb.encode(-1.0) < 0.0);
    }

    #[test]
    fn every_byte_comes_back() {
        for byte in 0..=255 {
            let stored = f64::from(byte) / 255.0;
            assert!((Srgb.encode(Srgb.decode(stored)) - stored).abs() < 1e-6, "{byte}");
        }
        assert_eq!(Transfer::default(), Linear);
    }
}
