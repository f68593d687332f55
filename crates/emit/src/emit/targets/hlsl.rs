//! HLSL, with naga's default shader model.

use super::Job;
use crate::emit::messages::chain;
use naga::back::hlsl;

/// Writes HLSL.
pub(super) fn write(job: &Job<'_>) -> Result<String, String> {
    let Job { module, info, .. } = job;
    let options = hlsl::Options {
        fake_missing_bindings: true,
        force_loop_bounding: false,
        restrict_indexing: true,
        ..hlsl::Options::default()
    };
    let pipeline = hlsl::PipelineOptions::default();
    let mut text = String::new();
    hlsl::Writer::new(&mut text, &options, &pipeline).write(module, info, None).map_err(|error| chain(&error))?;
    Ok(text)
}
