//! The typed program to naga IR: OpenGL's semantics to WebGPU's and Vulkan's.
//!
//! *In:* a [`Program`](crate::link::Program) without errors and the conventions. *Out:* a `naga::Module` for one stage.
