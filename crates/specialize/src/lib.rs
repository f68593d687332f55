//! Leaves out of a program what the values that a host fixes do not need.
//!
//! ```text
//!  Program, Known ──► forward ──► settle ──► prune ──► text ──► Compiler ──► Residual
//!                     decides,    literals   what        GLSL 150
//!                     unrolls,    in place   reaches
//!                     clones      of values  no output
//!                        ▲                      │
//!                        └─ until nothing goes ─┘
//! ```
//!
//! *In:* a linked [`Program`] and what is [`Known`] of its inputs, by the names of its reflection. *Out:* a [`Residual`]: a
//! program that draws the same picture with those inputs, as GLSL 1.50 that reads back, with the names and comments of the
//! original, and an account of what was left out.
//!
//! *Holds:* the residual computes what the original computes, bit for bit in f32, NaN and signs of zeros included, on any
//! target that follows the specification; a number becomes a literal only where that gives a driver no freedom to gain or
//! lose a NaN or an infinity. The work is linear in the size of the program, whatever its loops and calls do.
//! This crate knows no scenes and no pictures: a build script can use it.
//!
//! # Example
//!
//! ```
//! use glisten_front::{Compiler, Options, Source, Stage};
//! use glisten_front::hir::ScalarValue;
//! use glisten_specialize::{Known, specialize};
//!
//! let fragment = "#version 150\nuniform bool dark;\nin vec3 c;\nout vec4 color;\n\
//!     void main() { color = dark ? vec4(c * 0.5, 1.0) : vec4(c, 1.0); }\n";
//! let vertex = "#version 150\nin vec4 p;\nout vec3 c;\nvoid main() { c = p.xyz; gl_Position = p; }\n";
//! let source = |name: &str, text: &str, stage| Source { name: name.into(), text: text.into(), stage };
//! let sources = [source("a.vert", vertex, Stage::Vertex), source("a.frag", fragment, Stage::Fragment)];
//! let compiled = Compiler::new(Options::default()).compile(&sources);
//! let mut known = Known::default();
//! known.uniforms.insert("dark".into(), vec![ScalarValue::Bool(false)]);
//! let residual = specialize(&compiled.program.expect("it links"), &known);
//! assert!(!residual.text(Stage::Fragment).expect("a stage").contains("dark"));
//! ```

mod account;
mod facts;
mod fast;
mod forward;
mod inputs;
mod known;
mod left;
mod motion;
mod named_parts;
mod optimize;
mod options;
mod prune;
mod residual;
mod settle;
mod text;
mod unlocated;
mod words;

pub use account::{Kind, LeftOut, Moved};
pub use known::{Input, Known, KnownState, KnownTexture};
pub use optimize::{left_out, optimize, optimize_by, without_unreached};
pub use options::{Extent, Math, Options};
pub use residual::{Residual, ResidualStage, specialize, specialize_with};

pub use glisten_front::Program;
