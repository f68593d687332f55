//! SPIR-V 1.3.

use super::{Job, policies};
use crate::emit::messages::chain;
use crate::emit::naga_repairs::contraction::forbidden;
use crate::emit::naga_repairs::lines::SourceLines;
use crate::emit::naga_repairs::sample_mask::as_array;
use naga::back::spv;
use naga::proc::{BoundsCheckPolicies, BoundsCheckPolicy};

/// Writes SPIR-V.
pub(super) fn write(job: &Job<'_>) -> Result<Vec<u32>, String> {
    let Job { module, info, conventions, sources, .. } = job;
    // Not ADJUST_COORDINATE_SPACE, which flips y: the lowering has applied the conventions. Not CLAMP_FRAG_DEPTH:
    // OpenGL clamps in fixed function after the shader, and so does Vulkan. Not LABEL_VARYINGS: names of locations
    // have no meaning. FORCE_POINT_SIZE, since in Vulkan the size of a point is undefined if it is not written.
    let mut flags = spv::WriterFlags::FORCE_POINT_SIZE;
    let lines = sources.filter(|_| conventions.debug_lines).and_then(|sources| SourceLines::of(module, sources));
    if lines.is_some() {
        flags |= spv::WriterFlags::DEBUG;
    }
    let debug_info = lines.as_ref().map(|lines| spv::DebugInfo {
        source_code: &lines.text,
        file_name: lines.name(),
        language: spv::SourceLanguage::GLSL,
    });
    let options = spv::Options {
        // Vulkan 1.1 accepts up to 1.3.
        lang_version: (1, 3),
        flags,
        // A missing binding is an internal error, which must not be hidden.
        fake_missing_bindings: false,
        binding_map: own_bindings(module),
        // Vulkan's robust access keeps reads of uniform buffers inside them. An index clamped here would hide from
        // the driver that a loop over lights stays within the array, so the driver would not unroll the loop: in a
        // measurement, lavapipe took 1.6 times as long.
        bounds_check_policies: BoundsCheckPolicies { buffer: BoundsCheckPolicy::Unchecked, ..policies() },
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        // This would add a pair of counters to every loop, against compilers that assume that loops end. GLSL does
        // not require it.
        force_loop_bounding: false,
        // This would add a function call for every `/` and `%`. §5.9 leaves division by zero undefined "without
        // termination".
        emit_int_div_checks: false,
        debug_info,
        ..spv::Options::default()
    };
    let words = spv::write_vec(module, info, &options, None).map_err(|error| chain(&error))?;
    let words = match lines {
        Some(lines) => lines.restored(&words),
        None => words,
    };
    let words = as_array(words);
    Ok(if job.is_precise() { forbidden(words) } else { words })
}

/// Gives every resource the binding that link has assigned.
fn own_bindings(module: &naga::Module) -> spv::BindingMap {
    let bindings = module.global_variables.iter().filter_map(|(_, variable)| variable.binding);
    bindings
        .map(|own| {
            let info = spv::BindingInfo { descriptor_set: own.group, binding: own.binding, binding_array_size: None };
            (own, info)
        })
        .collect()
}
