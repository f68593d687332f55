//! HLSL for shader model 5.0, with plain registers.
//!
//! *Holds:* registers are those of [`Slots`], which the reflection tells: `b` for uniform buffers, `t` for textures, `s`
//! for samplers. naga takes samplers from a heap through a buffer of indices, which only wgpu binds; here each sampler
//! is a variable with a register of its own.

use super::inline::inline_loads;
use super::repairs::{repaired, with_clip_distances};
use crate::emit::messages::chain;
use crate::emit::targets::Job;
use crate::target::Slots;
use naga::back::hlsl;

/// Writes HLSL.
pub(super) fn write(mut job: Job<'_>) -> Result<String, String> {
    inline_loads(&mut job.module);
    let Job { module, info, slots, .. } = &job;
    let groups = module.global_variables.iter().filter_map(|(_, variable)| variable.binding).map(|own| own.group);
    let options = hlsl::Options {
        shader_model: hlsl::ShaderModel::V5_0,
        binding_map: registers(module, slots),
        sampler_buffer_binding_map: groups
            .map(|group| (hlsl::SamplerIndexBufferKey { group }, hlsl::BindTarget::default()))
            .collect(),
        // A missing binding is an internal error, which must not be hidden.
        fake_missing_bindings: false,
        force_loop_bounding: false,
        restrict_indexing: true,
        ..hlsl::Options::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None).map_err(|error| chain(&error))?;
    let text = repaired(&text);
    Ok(match clip_distances(module) {
        Some(count) => with_clip_distances(&text, count),
        None => text,
    })
}

/// How many clip distances the stage writes.
fn clip_distances(module: &naga::Module) -> Option<u32> {
    let result = module.entry_points.first()?.function.result.as_ref()?;
    let naga::TypeInner::Struct { members, .. } = &module.types[result.ty].inner else { return None };
    let is_clip =
        |binding: &Option<naga::Binding>| matches!(binding, Some(naga::Binding::BuiltIn(naga::BuiltIn::ClipDistances)));
    let member = members.iter().find(|member| is_clip(&member.binding))?;
    match module.types[member.ty].inner {
        naga::TypeInner::Array { size: naga::ArraySize::Constant(size), .. } => Some(size.get()),
        _ => None,
    }
}

/// The registers of the resources of a stage.
fn registers(module: &naga::Module, slots: &Slots) -> hlsl::BindingMap {
    let bindings = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    let registers = bindings.filter_map(|own| {
        let (_, register) = slots.get(own.group, own.binding)?;
        Some((own, hlsl::BindTarget { register, ..hlsl::BindTarget::default() }))
    });
    registers.collect()
}
