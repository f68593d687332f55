//! `glisten trace`: what single invocations computed, at its places in the text.
//!
//! *In:* a [`Trace`](glisten_reference::trace::Trace) of the reference, and the texts of its scene. *Out:* a [`Told`], whose
//! JSON is the format of the command (`model`), and lines for people ([`lines()`]). *Holds:* nothing here prints.

mod lines;
mod model;
mod numbers;

pub use lines::{Shown, lines};
pub use model::{Told, told};
