//! Runs emitted code on Vulkan through wgpu.
//!
//! *In:* a [`Scene`](crate::scene::Scene). *Out:* a [`Picture`](crate::compare::Picture) and times.
