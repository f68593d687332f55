//! What the page of `glisten play` shows of a scene, without files, processes and GPUs.
//!
//! ```text
//!  a job ──► jobs
//!  a scene that was read, a Judge ──► look ──► one JSON object
//!                                      ▲
//!  the text of the scene file ──► controls
//! ```
//!
//! *In:* jobs, and scenes that were read. *Out:* answers as JSON. *Holds:* nothing here reads a file or starts a process; the levels
//! of findings are the [`Judge`]'s.

mod controls;
mod jobs;
mod look;

pub use controls::{Control, Kind, controls};
pub use jobs::{Job, Wish};
pub use look::{Judge, Shown, look, told};
