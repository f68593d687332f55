//! MSL 2.3.

use super::{Job, policies};
use crate::emit::messages::chain;
use crate::emit::naga_repairs::inline::inline_loads;
use naga::back::msl;

/// Writes MSL.
pub(super) fn write(mut job: Job<'_>) -> Result<String, String> {
    inline_loads(&mut job.module);
    let Job { module, info, .. } = &job;
    let options = msl::Options {
        // The lowest version that has `primitive_id`.
        lang_version: (2, 3),
        fake_missing_bindings: true,
        bounds_check_policies: policies(),
        zero_initialize_workgroup_memory: false,
        force_loop_bounding: false,
        ..msl::Options::default()
    };
    let pipeline = msl::PipelineOptions::default();
    msl::write_string(module, info, &options, &pipeline).map(|(text, _)| text).map_err(|error| chain(&error))
}
