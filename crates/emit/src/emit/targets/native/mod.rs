//! MSL and HLSL, the languages of native hosts, whose writers a module for the web may leave out.
//!
//! *In:* a validated module. *Out:* its text. *Holds:* without these writers, a sentence that says so.

#[cfg(any(not(target_family = "wasm"), feature = "native"))]
mod hlsl;
#[cfg(any(not(target_family = "wasm"), feature = "native"))]
mod inline;
#[cfg(any(not(target_family = "wasm"), feature = "native"))]
mod msl;
#[cfg(any(not(target_family = "wasm"), feature = "native"))]
mod repairs;

use super::Job;
use glisten_front::hir::Stage;

/// The name of the entry point of a stage in MSL.
pub(in crate::emit) fn msl_entry_point(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vertex_main",
        Stage::Geometry => "geometry_main",
        Stage::Fragment => "fragment_main",
    }
}

/// Writes MSL.
pub(super) fn msl(job: Job<'_>) -> Result<String, String> {
    #[cfg(any(not(target_family = "wasm"), feature = "native"))]
    return msl::write(job);
    #[cfg(all(target_family = "wasm", not(feature = "native")))]
    return absent(&job);
}

/// Writes HLSL.
pub(super) fn hlsl(job: Job<'_>) -> Result<String, String> {
    #[cfg(any(not(target_family = "wasm"), feature = "native"))]
    return hlsl::write(job);
    #[cfg(all(target_family = "wasm", not(feature = "native")))]
    return absent(&job);
}

#[cfg(all(target_family = "wasm", not(feature = "native")))]
fn absent(_: &Job<'_>) -> Result<String, String> {
    Err("this module for the web has no such writer; the one with the reference has".to_owned())
}
