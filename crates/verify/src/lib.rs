//! Scenes judged.
//!
//! ```text
//!  scene file ──► scene::load ──► Scene ──┬─► verify::verify            is the picture of a runner right?
//!                                         ├─► specialize                what its picture does not need
//!                                         └─► trace                     what a pixel computed
//!
//!  function, inputs ──► evaluate ──► measure          its error against the closed form
//!  .shader_test     ──► shader_test ──► unit_test     what probes and values say
//!  panorama         ──► environment                   prefiltered, and how far that is from integrals
//! ```
//!
//! *In:* scenes, functions, tests. *Out:* verdicts and errors. *Not done here:* nothing prints or makes pages.

pub mod environment;
pub mod evaluate;
pub mod measure;
mod numeric;
pub mod scene;
pub mod shader_test;
pub mod specialize;
#[cfg(feature = "stability")]
pub mod trace;
pub mod unit_test;
pub mod verify;
