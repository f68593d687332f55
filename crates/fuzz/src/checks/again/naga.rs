//! Emitted code as GLSL that naga writes.
//!
//! *In:* naga's module of a stage. *Out:* a text of GLSL 4.50, and where its blocks and textures come from. *Holds:* a panic of naga is a
//! limit.

use super::super::drawn::Emission;
use super::host::Layout;
use super::{Failed, Frame, NO_GEOMETRY, Written, replaced, source};
use glisten_front::Stage;
use glisten_front::link::SlotBinding;
use naga::back::glsl;
use naga::proc::BoundsCheckPolicies;
use naga::{GlobalVariable, Handle};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// A stage as GLSL.
pub(super) fn written(stage: &Emission, frame: Frame) -> Result<Written<'_>, Failed> {
    let read = stage.read.as_ref().ok_or(Failed::Limit("naga does not read a stage"))?;
    let shader_stage = match stage.stage {
        Stage::Vertex => naga::ShaderStage::Vertex,
        Stage::Fragment => naga::ShaderStage::Fragment,
        Stage::Geometry => return Err(Failed::Limit(NO_GEOMETRY)),
    };
    let limit = || Failed::Limit("naga cannot write a stage as GLSL");
    let entry_point = read.module.entry_points.first().ok_or_else(limit)?.name.clone();
    let options = glsl::Options { version: glsl::Version::Desktop(450), ..glsl::Options::default() };
    let pipeline = glsl::PipelineOptions { shader_stage, entry_point, multiview: None };
    let write = || {
        let mut text = String::new();
        let policies = BoundsCheckPolicies::default();
        let mut writer = glsl::Writer::new(&mut text, &read.module, &read.info, &options, &pipeline, policies).ok()?;
        let reflection = writer.write().ok()?;
        drop(writer);
        Some((text, reflection))
    };
    // naga 30.0.1 panics where a lookup has an offset.
    let (text, reflection) = catch_unwind(AssertUnwindSafe(write)).ok().flatten().ok_or_else(limit)?;
    let slot = |handle: Handle<GlobalVariable>| {
        let binding = read.module.global_variables[handle].binding.as_ref()?;
        Some(SlotBinding { group: binding.group, binding: binding.binding })
    };
    let layout =
        |handle: Handle<GlobalVariable>| Layout { module: &read.module, ty: read.module.global_variables[handle].ty };
    let blocks = reflection
        .uniforms
        .iter()
        .filter_map(|(handle, name)| Some((name.clone(), slot(*handle)?, layout(*handle))))
        .collect();
    let textures = reflection
        .texture_mapping
        .iter()
        .filter_map(|(name, mapping)| Some((name.clone(), slot(mapping.texture)?)))
        .collect();
    // naga turns the picture upside down, for OpenGL.
    let text = replaced(&text, "vec2(-gl_Position.y, gl_Position.z", "vec2(gl_Position.y, gl_Position.z");
    Ok(Written { source: source(stage.stage, &text, frame)?, blocks, textures })
}
