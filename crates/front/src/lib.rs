//! The front of glisten: GLSL 1.50 text to a checked, linked program, and everything that is wrong with it.
//!
//! ```text
//!  text ──► syntax ──► analysis ──► link ──► lint
//!           tree       typed        program  findings
//!                      program      and its
//!                      (hir)        interface
//! ```
//!
//! [`Compiler`] is the door. The modules are public for the other crates of glisten; a user takes what `glisten`
//! re-exports of them.
//!
//! *Holds:* no I/O, no threads, no global state, no code generator: a linter built on this crate depends on nothing else.

pub mod analysis;
pub mod builtin;
pub mod compiler;
pub mod diagnostic;
pub mod fold;
pub mod hir;
pub mod language;
pub mod link;
pub mod lint;
pub mod source;
pub mod stack;
pub mod syntax;

pub use compiler::{Compilation, Compiler, Options, Source};
pub use diagnostic::{Diagnostic, Diagnostics};
pub use language::Stage;
pub use link::Program;
