//! [`PrecisionLimits`]: the precision of the fixed-function parts of a device, which wgpu does not report.
//!
//! *In:* an adapter. *Out:* `VkPhysicalDeviceLimits`' bits of positions, texels and levels, if it is one of Vulkan.

/// The precision of a device's fixed-function parts, in bits after the point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PrecisionLimits {
    /// `subPixelPrecisionBits`: window positions.
    pub sub_pixel: u32,
    /// `subTexelPrecisionBits`: coordinates in texels, weights of linear filtering.
    pub sub_texel: u32,
    /// `mipmapPrecisionBits`: levels of detail, weights between levels.
    pub mipmap: u32,
}

impl PrecisionLimits {
    /// The limits of an adapter.
    #[expect(unsafe_code, reason = "wgpu shows its adapter of Vulkan only so")]
    pub(super) fn of(adapter: &wgpu::Adapter) -> Option<Self> {
        // SAFETY: the adapter is only asked for what it stored when it was opened; no handle leaves this function.
        let held = unsafe { adapter.as_hal::<wgpu::hal::api::Vulkan>() }?;
        let limits = held.physical_device_capabilities().properties().limits;
        Some(Self {
            sub_pixel: limits.sub_pixel_precision_bits,
            sub_texel: limits.sub_texel_precision_bits,
            mipmap: limits.mipmap_precision_bits,
        })
    }

    /// The bits in the order of the fields.
    pub fn bits(self) -> [u32; 3] {
        [self.sub_pixel, self.sub_texel, self.mipmap]
    }
}
