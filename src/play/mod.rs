//! The answers of the page of `glisten play`, without files, processes and GPUs.
//!
//! ```text
//!  a job ──► jobs
//!  a scene that was read, Criteria ──► look ──► one JSON object
//!                                         ▲
//!  the text of the scene file ──► controls
//! ```
//!
//! *In:* jobs, and scenes that were read. *Out:* answers as JSON. *Holds:* nothing here reads a file or starts a process; the levels
//! of findings are those of [`Criteria`].

mod controls;
mod jobs;
mod look;

pub use controls::{Control, Kind, controls};
pub use jobs::{Job, Wish};
pub use look::{Criteria, Shown, look, told};
