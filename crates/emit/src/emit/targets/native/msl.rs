//! MSL 2.3, with a number for every buffer, texture and sampler.
//!
//! *Holds:* the numbers are those of [`Slots`], which the reflection tells. The entry points are `vertex_main` and
//! `fragment_main`, so that both fit into one library: `main` is a word of Metal's.

use super::inline::inline_loads;
use super::msl_entry_point;

use crate::emit::messages::chain;
use crate::emit::targets::{Job, policies};
use crate::target::{SlotKind, Slots};
use glisten_front::hir::Stage;
use naga::back::msl;

/// Writes MSL.
pub(super) fn write(mut job: Job<'_>) -> Result<String, String> {
    inline_loads(&mut job.module);
    for entry in job.module.entry_points.iter_mut().filter(|_| !job.is_single) {
        let stage = if entry.stage == naga::ShaderStage::Vertex { Stage::Vertex } else { Stage::Fragment };
        entry.name = msl_entry_point(stage).to_owned();
    }
    let Job { module, info, conventions, slots, .. } = &job;
    let names = module.entry_points.iter().map(|entry| entry.name.clone());
    let options = msl::Options {
        // The lowest version that has `primitive_id`.
        lang_version: (2, 3),
        per_entry_point_map: names.map(|name| (name, resources(module, slots))).collect(),
        // A missing binding is an internal error, which must not be hidden.
        fake_missing_bindings: false,
        bounds_check_policies: policies(),
        zero_initialize_workgroup_memory: false,
        force_loop_bounding: false,
        // The reasons are in [`spirv`](crate::emit::targets::spirv).
        emit_int_div_checks: false,
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions {
        // Metal wants a size where points are drawn and refuses it elsewhere.
        allow_and_force_point_size: conventions.program_point_size && job.has(Stage::Vertex),
        ..msl::PipelineOptions::default()
    };
    msl::write_string(module, info, &options, &pipeline).map(|(text, _)| text).map_err(|error| chain(&error))
}

/// The numbers of the resources of a stage.
fn resources(module: &naga::Module, slots: &Slots) -> msl::EntryPointResources {
    let bindings = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    let resources = bindings.filter_map(|own| {
        let (kind, number) = slots.get(own.group, own.binding)?;
        let number = u8::try_from(number).ok()?;
        let target = match kind {
            SlotKind::Buffer => msl::BindTarget { buffer: Some(number), ..msl::BindTarget::default() },
            SlotKind::Texture => msl::BindTarget { texture: Some(number), ..msl::BindTarget::default() },
            SlotKind::Sampler => {
                let sampler = Some(msl::BindSamplerTarget::Resource(number));
                msl::BindTarget { sampler, ..msl::BindTarget::default() }
            }
        };
        Some((own, target))
    });
    msl::EntryPointResources { resources: resources.collect(), immediates_buffer: None, sizes_buffer: None }
}
