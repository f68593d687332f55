//! The targets, with one file for each: how naga writes it, and with which options.
//!
//! *In:* a validated module. *Out:* the text or the words, or naga's message. *Holds:* every option is set
//! explicitly, so that an update of naga changes nothing silently.

mod glsl;
mod hlsl;
mod msl;
mod spirv;
mod wgsl;

use super::emitted::Emitted;
use crate::target::{Conventions, Target};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::hir::Stage;
use glisten_front::source::SourceMap;
use naga::Module;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::ModuleInfo;

/// The input of a writer.
pub(super) struct Job<'a> {
    pub(super) module: Module,
    pub(super) info: &'a ModuleInfo,
    pub(super) stage: Stage,
    pub(super) conventions: &'a Conventions,
    pub(super) sources: Option<&'a SourceMap>,
}

/// Writes a module for a target.
pub(super) fn write(target: Target, job: Job<'_>) -> Result<Emitted, String> {
    match target {
        Target::Wgsl => wgsl::write(job).map(Emitted::Text),
        Target::Spirv => spirv::write(&job).map(Emitted::Words),
        Target::Msl => msl::write(job).map(Emitted::Text),
        Target::Hlsl => hlsl::write(&job).map(Emitted::Text),
        Target::Glsl => glsl::write(&job).map(Emitted::Text),
    }
}

/// The diagnostic for a module that the target cannot accept.
pub(super) fn limit(target: Target, module: &Module) -> Option<Diagnostic> {
    match target {
        Target::Wgsl => wgsl::limit(module),
        Target::Spirv | Target::Msl | Target::Hlsl | Target::Glsl => None,
    }
}

/// Whether naga's writer of this target has gaps (for example `inverse` in MSL and HLSL).
pub(super) fn has_gaps(target: Target) -> bool {
    match target {
        Target::Wgsl | Target::Spirv => false,
        Target::Msl | Target::Hlsl | Target::Glsl => true,
    }
}

/// Indices out of bounds are undefined in GLSL (§4.1.9) and must not crash a host: they are clamped.
fn policies() -> BoundsCheckPolicies {
    BoundsCheckPolicies {
        index: BoundsCheckPolicy::Restrict,
        buffer: BoundsCheckPolicy::Restrict,
        image_load: BoundsCheckPolicy::Restrict,
        binding_array: BoundsCheckPolicy::Unchecked,
    }
}
