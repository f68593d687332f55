//! Syntax tree to typed program: scopes, types, overloads, conversions, constants, qualifiers (GLSL 1.50 §4 to §7).
//!
//! *In:* an [`Ast`]. *Out:* a [`Shader`], whole even where the source is wrong, and diagnostics.
//!
//! One walk over the declarations in their order does almost everything, for every rule of the language looks back and
//! none looks ahead; what needs the whole shader stands behind it: the sizes of implicitly sized arrays
//! (`finish`), recursion (`recursion`), static use (in [`hir`](crate::hir)).
//!
//! * `context` holds the state of the walk, `scope` the names in sight.
//! * `types`, `qualifiers` and `layout` read what stands before a name.
//! * `declare` enters names: variables, structs, blocks, functions, redeclared built-ins.
//! * `statement` and `expr` read function bodies.
//! * [`fold`] computes constants.
//!
//! *Holds:* one mistake raises one message: what is not understood becomes an expression or a type of
//! [`TypeId::ERROR`](crate::hir::TypeId::ERROR), with which everything agrees. No walk recurses along left operands.

mod constant;
mod context;
mod declare;
mod expr;
mod finish;
mod keywords;
mod layout;
mod limits;
mod qualifiers;
mod recursion;
mod scope;
mod statement;
mod types;
mod wording;

#[cfg(test)]
mod tests;

use crate::diagnostic::Diagnostics;
use crate::hir::{Shader, Stage, Types};
use crate::source::SourceMap;
use crate::stack::with_stack;
use crate::syntax::ast::Ast;
use context::Analyzer;

/// Gives a syntax tree its meaning. `strict` makes errors of what every driver forgives; `types` is shared by all
/// stages of a compilation.
pub fn analyze(
    ast: &Ast,
    stage: Stage,
    strict: bool,
    types: &mut Types,
    sources: &SourceMap,
    diagnostics: &mut Diagnostics,
) -> Shader {
    with_stack(nesting(ast), || Analyzer::new(ast, stage, strict, types, sources, diagnostics).run())
}

/// How deep the walk may recurse: right operands, arguments and indices; left operands are walked by a loop. Statements
/// nest at most as deep as the parser allows, and each level of either kind is counted.
fn nesting(ast: &Ast) -> u32 {
    let mut depths: Vec<u32> = Vec::with_capacity(ast.exprs.len());
    let mut deepest = 0;
    for expr in &ast.exprs {
        let depth = expr::recursion_depth(&expr.kind, &depths);
        deepest = deepest.max(depth);
        depths.push(depth);
    }
    deepest.saturating_add(statement::nesting(ast))
}
