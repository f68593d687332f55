//! The front end of glisten: from GLSL 1.50 text to a checked, linked program, with all diagnostics.
//!
//! ```text
//!  text ──► syntax ──► analysis ──► link ──► lint
//!           tree       typed        program  findings
//!                      program      and its
//!                      (hir)        interface
//! ```
//!
//! [`Compiler`] is the entry. The modules are public for the other crates of glisten; users depend on `glisten`,
//! which re-exports what they need.
//!
//! *Holds:* no I/O, no threads, no global state, no code generator. A linter that depends on this crate depends on
//! nothing else.

pub mod analysis;
pub mod builtin;
pub mod compiler;
pub mod diagnostic;
pub mod fold;
pub mod hir;
pub mod index;
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
