//! Upgrades: a source of GLSL 1.10 to 1.40, of the compatibility profile or of ES 1.00, written as 1.50 core, 3.30, 4.50, 4.60, ES
//! 3.00, or 4.50 for Vulkan.
//!
//! *In:* the texts of a program, each with its stage. *Out:* the new texts and notes on what the host has to do differently.
//! *Holds:* only words are replaced and declarations added: comments, macros, includes and layout stay as they are. [`rewrite()`]
//! does not decide whether the result is valid; [`upgrade()`] lets a compiler check it.

mod names;
mod plan;
mod program;
mod rewrite;
mod selected;
mod tokens;
mod uses;
mod vulkan;

pub use plan::{Plan, Target, Text};
pub use program::{Refused, Upgraded, completed, plan_of, upgrade};
pub use program::{names_in, plan_in};
pub use rewrite::rewrite;
pub use selected::{Macros, selected};
pub use vulkan::{
    Dialect, HostBlock, Includes, NewFile, NewTree, Note, Numbering, TreeProgram, converts_depth, moved_path, plain,
    to_vulkan, tree, with_version,
};
