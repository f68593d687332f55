//! Residual programs for hosts.
//!
//! *In:* a program, and what a host knows of its inputs. *Out:* [`specialize_smallest`] makes the smallest of its residuals;
//! [`Variants`] keeps one for each set of values. *Not done here:* partial evaluation itself, which is `glisten_specialize`.

mod smallest;
mod variants;

pub use smallest::{body_instructions, specialize_smallest, spirv_instructions};
pub use variants::{Variant, Variants};
