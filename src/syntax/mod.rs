//! Text to syntax tree.
//!
//! *In:* a [`SourceMap`](crate::source::SourceMap) and the file to start with, the include resolver, predefined
//! macros. *Out:* an [`ast::Ast`] of what was understood, and diagnostics.
//!
//! Three steps, each lazy and each with its budgets: [`lexer`] cuts text into tokens, [`preprocessor`] runs the
//! directives and expands macros (GLSL 1.50 §3.3) behind the [`TokenSource`](token::TokenSource) interface, and
//! [`parser`] follows the grammar (§9) with recovery at declarations and statements.
//!
//! *Holds:* no type or scope is known here; `S(x)` is a call of something named `S`.

pub mod ast;
pub mod token;
