//! Syntax tree to typed program (GLSL 1.50 §3 to §7): scopes, types, overloads, conversions, constants, qualifiers.
//!
//! *In:* an [`Ast`](crate::syntax::ast::Ast) and the stage. *Out:* a [`Shader`](crate::hir::Shader) of what was
//! understood, and diagnostics.

pub mod fold;
