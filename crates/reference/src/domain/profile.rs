//! [`Profile`]: what a specification leaves to the device, as numbers.
//!
//! *In:* nothing, or the limits that an adapter reports. *Out:* the precision of texture filters, of window positions,
//! and of what a specification does not limit at all.
//!
//! *Holds:* a profile only widens or narrows what [`rules`](super::rules) leave open; the rules of the operations are
//! the same in all profiles: a GPU may follow Vulkan's or WGSL's. `vulkan` and `wgsl` allow what every conforming
//! implementation may do. `device` allows what this device may do.

/// The limits of a device or of a specification.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Profile {
    /// `vulkan`, `wgsl` or `device`
    pub name: &'static str,
    /// The fractional bits of window positions: Vulkan's `subPixelPrecisionBits`.
    pub subpixel_bits: u8,
    /// The fractional bits of coordinates in texels, and so of the weights of linear filtering:
    /// `subTexelPrecisionBits`.
    pub subtexel_bits: u8,
    /// The fractional bits of a level of detail, and so of the weights between levels: `mipmapPrecisionBits`.
    pub mipmap_bits: u8,
    /// Whether `x / 2^n` is exact, as on hardware that multiplies by a reciprocal. The specifications allow 2.5 ULP.
    pub exact_halves: bool,
    /// Whether derivatives are those of each row and column of a quad. A GPU may use one of them for all.
    pub fine_derivatives: bool,
    /// Whether the weights of linear filters are floats, for textures of floats. A GPU may give them `subtexel_bits`.
    pub float_weights: bool,
    /// Whether a level of detail is one for each quad, by a logarithm that is a straight line between powers of two.
    pub straight_levels: bool,
    /// Whether varyings are interpolated between the positions of f32, and not between those of `subpixel_bits`. Vulkan 1.0
    /// (Limits) gives window coordinates that precision, and SwiftShader interpolates between them.
    pub exact_positions: bool,
    /// Whether derivatives are differences in the quad, and determinants sums of products. WGSL states no accuracy.
    pub limits_differences: bool,
}

impl Profile {
    /// Vulkan 1.0 (Limits, table "Required Limits"): what every implementation has.
    pub const VULKAN: Self = Self {
        name: "vulkan",
        subpixel_bits: 4,
        subtexel_bits: 4,
        mipmap_bits: 4,
        exact_halves: false,
        fine_derivatives: false,
        float_weights: false,
        straight_levels: false,
        exact_positions: false,
        limits_differences: true,
    };

    /// WGSL, which states no limits of its own and runs on Vulkan. The accuracy of derivatives and determinants is
    /// infinite there.
    pub const WGSL: Self = Self { name: "wgsl", limits_differences: false, ..Self::VULKAN };

    /// Mesa's llvmpipe and lavapipe, as it reports them. It divides by `divps`, which rounds correctly. Its derivatives and its
    /// filters are known to the simulated GPUs, but no reason for narrower envelopes.
    pub const LLVMPIPE: Self = Self {
        name: "device",
        subpixel_bits: 8,
        subtexel_bits: 8,
        mipmap_bits: 4,
        exact_halves: true,
        fine_derivatives: true,
        float_weights: true,
        straight_levels: true,
        exact_positions: true,
        limits_differences: true,
    };

    /// A device with this name and these limits: the bits of window positions, of coordinates in texels and of levels
    /// of detail. Without limits, those of a known driver, or Vulkan's.
    pub fn of_device(adapter: &str, limits: Option<[u32; 3]>) -> Self {
        let known = Self { name: "device", ..if is_llvmpipe(adapter) { Self::LLVMPIPE } else { Self::VULKAN } };
        let Some([subpixel, subtexel, mipmap]) = limits else { return known };
        // Less than four bits conforms to nothing, and more than 23 an f32 does not have.
        let bits = |bits: u32| bits.clamp(4, 23) as u8;
        Self { subpixel_bits: bits(subpixel), subtexel_bits: bits(subtexel), mipmap_bits: bits(mipmap), ..known }
    }

    /// The largest error of a weight of linear filtering, and of a position in texels.
    pub fn filter_weight(&self) -> f64 {
        step(self.subtexel_bits)
    }

    /// The largest error of a level of detail, and of the weight between levels.
    pub fn level_weight(&self) -> f64 {
        step(self.mipmap_bits)
    }

    /// By how much the window position of a vertex may be off where varyings are interpolated, in each direction, in pixels.
    pub fn displacement(&self) -> f64 {
        if self.exact_positions { 0.0 } else { step(self.subpixel_bits) }
    }

    /// Half the width of the band around an edge in which coverage may differ, in pixels: snapping moves both ends of
    /// the edge, here and on the device.
    pub fn edge_band(&self) -> f64 {
        2.0 * step(self.subpixel_bits)
    }
}

/// That of the driver on which glisten's own rules are measured.
impl Default for Profile {
    fn default() -> Self {
        Self::LLVMPIPE
    }
}

fn step(bits: u8) -> f64 {
    (-f64::from(bits)).exp2()
}

fn is_llvmpipe(adapter: &str) -> bool {
    adapter.to_lowercase().contains("llvmpipe")
}

#[cfg(test)]
mod tests {
    use super::Profile;

    #[test]
    fn a_device_has_its_own_limits_and_its_driver_habits() {
        let known = Profile::of_device("llvmpipe (LLVM 15.0.6, 256 bits)", None);
        assert_eq!(known, Profile::LLVMPIPE);
        let reported = Profile::of_device("GeForce", Some([8, 8, 8]));
        assert_eq!((reported.name, reported.mipmap_bits, reported.exact_halves), ("device", 8, false));
        let unknown = Profile::of_device("GeForce", None);
        assert_eq!(Profile { name: "vulkan", ..unknown }, Profile::VULKAN);
        assert_eq!(Profile::of_device("", Some([0, 99, 6])).subtexel_bits, 23);
    }

    #[test]
    fn bits_are_steps() {
        assert_eq!(Profile::LLVMPIPE.filter_weight(), 1.0 / 256.0);
        assert_eq!(Profile::VULKAN.level_weight(), 1.0 / 16.0);
        assert_eq!(Profile::LLVMPIPE.edge_band(), 1.0 / 128.0);
        assert_eq!([Profile::LLVMPIPE, Profile::WGSL].map(|profile| profile.displacement()), [0.0, 1.0 / 16.0]);
    }
}
