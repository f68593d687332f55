//! The CPU reference: executes the typed program by OpenGL 3.2's rules.
//!
//! *In:* a [`Scene`](crate::scene::Scene). *Out:* a [`Picture`](crate::compare::Picture).
//!
//! *Holds:* never sees naga IR, so that a mistake in lowering shows as a difference.

pub mod domain;
pub mod exec;
