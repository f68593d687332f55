//! Fragment stages of GLSL 1.50 by chance, for pictures that drivers draw: [`exact`] and [`numeric`].
//!
//! *In:* a seed. *Out:* a text. *Holds:* the same seed gives the same text on every machine, so that tests name the seeds that drivers get wrong.
//! Not every version, nor every construct: that is [`generate`](crate::generate).

pub mod exact;
pub mod numeric;
