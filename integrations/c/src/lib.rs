//! glisten for C and C++: `glisten.h` is generated from these functions.
//!
//! *In:* pointers and numbers of a host. *Out:* handles, texts, bytes, a [`Status`](status::Status).
//!
//! *Holds:* no panic leaves a function. Every pointer is compared with null, every text is checked for UTF-8, every number that
//! names something is looked up. What remains the host's duty is in the header: pointers that are not null are valid.

#![allow(unsafe_code, reason = "a C interface takes pointers; each function says what it expects of them")]

pub mod blob;
pub mod compiler;
pub mod diagnostic;
pub mod names;
#[cfg(feature = "render")]
pub mod picture;
mod pointers;
pub mod program;
pub mod reply;
#[cfg(feature = "render")]
pub mod scene;
pub mod status;
pub mod upgrade;
