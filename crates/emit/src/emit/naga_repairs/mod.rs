//! Repairs for gaps of naga: in its output, and for modules that it would not survive.
//!
//! *In:* modules before naga writes them, and its output. *Out:* the same with the gaps filled. Each file describes
//! naga's behavior, and when the file becomes superfluous. Those for MSL and HLSL are with their writers, in `targets/native`.
//!
//! | file | superfluous once |
//! | --- | --- |
//! | `contraction` | naga has a word for `precise` |
//! | `nesting` | naga's validator and writers limit how deep they recurse |
//! | `sample_mask` | naga's SPIR-V writer declares the mask of samples as an array |
//! | `lines` | naga's SPIR-V writer accepts several source files |

pub(super) mod contraction;
pub(super) mod lines;
pub(super) mod nesting;
pub(super) mod sample_mask;
