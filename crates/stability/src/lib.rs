//! Numerical stability of scenes: whether f32 arithmetic harms the picture, where, why, and what to write instead.
//!
//! *In:* a scene with the texts of its shaders. *Out:* [`Findings`]: the verdict, the figures of the picture, and the
//! causes at their places, each with a help text. The measurement itself is
//! [`glisten_reference::stability`]; this folder adds places in the text ([`findings`](Findings)), help texts (`advice`),
//! and inputs other than the scene's ([`sweep`], [`stiff`]).
//!
//! *Holds:* nothing here prints or writes files. Figures are the same on every run.

mod advice;
mod exact;
mod findings;
mod forms;
mod heat;
pub mod library;
#[cfg(feature = "page")]
pub mod page;
mod patterns;
mod recomputed;
mod rewrite;
pub mod settings;
pub mod stiff;
pub mod sweep;

pub use exact::with_exact;
pub use findings::{CauseFound, Findings, PictureFigures, Spot, WorstPixel, find};
pub use glisten_reference::stability::{
    BOUND, CAUSE_BITS, Cause, CauseKind, ErrorMap, Examination, ExamineOptions, Pair, SpanError, Stability, Trace,
    errors_of, examine, inputs_at, pictures_of, trace,
};
pub use heat::heat;
pub use recomputed::{ExactFound, ExactPixelFound};
pub use rewrite::Reload;
