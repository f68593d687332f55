//! GLSL 4.50 for OpenGL.

use super::{Job, policies};
use crate::emit::messages::chain;
use glisten_front::hir::Stage;
use naga::back::glsl;

/// Writes GLSL.
pub(super) fn write(job: &Job<'_>) -> Result<String, String> {
    let Job { module, info, stage, .. } = job;
    let options = glsl::Options {
        version: glsl::Version::Desktop(450),
        // Not ADJUST_COORDINATE_SPACE, for the reason in [`spirv`](super::spirv).
        writer_flags: glsl::WriterFlags::empty(),
        ..glsl::Options::default()
    };
    let shader_stage = if *stage == Stage::Vertex { naga::ShaderStage::Vertex } else { naga::ShaderStage::Fragment };
    let pipeline = glsl::PipelineOptions { shader_stage, entry_point: "main".to_owned(), multiview: None };
    let mut text = String::new();
    let mut writer =
        glsl::Writer::new(&mut text, module, info, &options, &pipeline, policies()).map_err(|error| chain(&error))?;
    writer.write().map_err(|error| chain(&error))?;
    Ok(text)
}
