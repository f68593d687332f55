//! The targets, with one file for each: how naga writes it, and with which options.
//!
//! *In:* a validated module. *Out:* the text or the words, or naga's message. *Holds:* every option is set
//! explicitly, so that an update of naga changes nothing silently.

pub(super) mod glsl;
pub(super) mod native;
mod spirv;
mod wgsl;

use super::emitted::{Emitted, Traced};
use crate::target::{Conventions, Slots, Target};
use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::FEATURE_NOT_IN_TARGET;
use glisten_front::hir::{Shader, Stage, Types};
use glisten_front::source::{SourceMap, Span};
use naga::Module;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};
use naga::valid::ModuleInfo;

/// The input of a writer.
#[cfg_attr(target_family = "wasm", allow(dead_code, reason = "some is for MSL and HLSL alone"))]
pub(super) struct Job<'a> {
    pub(super) module: Module,
    pub(super) info: &'a ModuleInfo,
    pub(super) conventions: &'a Conventions,
    pub(super) sources: Option<&'a SourceMap>,
    pub(super) slots: &'a Slots,
    pub(super) types: &'a Types,
    /// The stages that the module comes from.
    pub(super) shaders: Vec<&'a Shader>,
    /// Whether all stages of the program are in one file, with entry points of different names.
    pub(super) is_single: bool,
}

impl Job<'_> {
    /// Whether the module has this stage.
    fn has(&self, stage: Stage) -> bool {
        self.shaders.iter().any(|shader| shader.stage == stage)
    }

    /// Whether anything in it is declared `precise`.
    fn is_precise(&self) -> bool {
        self.shaders.iter().any(|shader| !shader.precise.is_empty())
    }
}

/// Writes a module for a target.
pub(super) fn write(target: Target, job: Job<'_>) -> Result<Traced, String> {
    match target {
        Target::Wgsl => wgsl::write(&job),
        Target::Spirv => spirv::write(&job).map(Emitted::Words).map(Traced::of),
        Target::Msl => native::msl(job).map(Emitted::Text).map(Traced::of),
        Target::Hlsl => native::hlsl(job).map(Emitted::Text).map(Traced::of),
        // Written from the typed program, before there is a module.
        Target::Glsl => Err("GLSL is not written from a module".to_owned()),
    }
}

/// The diagnostic for a module that the target cannot accept.
pub(super) fn limit(target: Target, module: &Module, slots: &Slots) -> Option<Diagnostic> {
    match target {
        Target::Wgsl => wgsl::limit(module),
        Target::Msl | Target::Hlsl => too_many(target, module, slots),
        Target::Spirv | Target::Glsl => None,
    }
}

/// The diagnostic for a resource whose number the target does not have.
fn too_many(target: Target, module: &Module, slots: &Slots) -> Option<Diagnostic> {
    module.global_variables.iter().find_map(|(handle, variable)| {
        let own = variable.binding?;
        let (kind, number) = slots.get(own.group, own.binding)?;
        let limit = kind.limit(target);
        if number < limit {
            return None;
        }
        let place = module.global_variables.get_span(handle).to_range();
        let span = place.map_or(Span::default(), |range| Span::new(range.start as u32, range.end as u32));
        let message = format!("{} has {limit} {}, and the program has more", target.name(), kind.name());
        let help = "leave some out, or combine them: textures of one size into an array, small blocks into one";
        Some(Diagnostic::new(&FEATURE_NOT_IN_TARGET, span, message).help(help))
    })
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
