//! The answers of the page of `glisten play`, without files, processes and GPUs.
//!
//! ```text
//!  a job ──► jobs
//!  job, scene that was read ──► answers ──┬─► look ◄── controls, translations   findings, texts
//!                                         ├─► pictures             the reference's picture, a pixel
//!                                         ├─► needs                what the picture does not need
//!                                         ├─► stability            what f32 does to it
//!                                         └─► glisten_verify::trace    what a pixel computed
//!  scene ──► browser: a plan for WebGPU; what it read back ──► verdict
//! ```
//!
//! *In:* jobs, and scenes that were read. *Out:* answers as JSON. *Holds:* nothing here reads a file or starts a process; the levels
//! of findings are those of [`Criteria`], which the host of the page decides.

mod answers;
#[cfg(feature = "plan")]
mod browser;
mod controls;
mod criteria;
mod jobs;
mod kept;
mod look;
mod needs;
mod pictures;
mod stability;
mod translations;
mod verdict;

pub use answers::{OwnLevels, answer, drawable};
#[cfg(feature = "plan")]
pub use browser::{compare, plan, show};
pub use controls::{Control, Kind, controls};
pub use criteria::{Criteria, told};
pub use jobs::{Job, Positions, Wish};
pub use kept::Kept;
pub use look::{Shown, look};
pub use pictures::{Pictures, drawn};
pub use verdict::judged;
