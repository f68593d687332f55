//! Repairs for gaps of naga: in its output, and for modules that it would not survive.
//!
//! *In:* modules before naga writes them, and its output. *Out:* the same with the gaps filled. Each file describes
//! naga's behavior, and when the file becomes superfluous.
//!
//! | file | superfluous once |
//! | --- | --- |
//! | `contraction` | naga has a word for `precise` |
//! | `inline` | naga's text writers name only the loads that need a name |
//! | `nesting` | naga's validator and writers limit how deep they recurse |
//! | `sample_mask` | naga's SPIR-V writer declares the mask of samples as an array |
//! | `hlsl` | naga writes HLSL for hosts without wgpu's root signature |
//! | `lines` | naga's SPIR-V writer accepts several source files |

pub(super) mod contraction;
pub(super) mod hlsl;
pub(super) mod inline;
pub(super) mod lines;
pub(super) mod nesting;
pub(super) mod sample_mask;
