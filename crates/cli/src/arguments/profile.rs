//! `--profile`: whose freedom an envelope allows.
//!
//! *In:* the choice, and the open GPU. *Out:* a [`Profile`].

use clap::ValueEnum;
use glisten_gpu::{Gpu, PrecisionLimits};
use glisten_reference::domain::Profile;

/// The choices.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(crate) enum ProfileChoice {
    /// Every implementation of Vulkan
    Vulkan,
    /// Every implementation of WGSL, where derivatives have no accuracy
    Wgsl,
    /// This device: the specifications with the limits that it reports
    #[default]
    Device,
}

impl ProfileChoice {
    /// The profile for pictures of a GPU.
    pub(crate) fn of(self, gpu: &Gpu) -> Profile {
        match self {
            Self::Vulkan => Profile::VULKAN,
            Self::Wgsl => Profile::WGSL,
            Self::Device => Profile::of_device(&gpu.adapter().name, gpu.precision().map(PrecisionLimits::bits)),
        }
    }
}
