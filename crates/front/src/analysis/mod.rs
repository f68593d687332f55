//! From syntax tree to typed program: scopes, types, overloads, conversions, constants, qualifiers (GLSL 1.50 §4 to
//! §7).
//!
//! *In:* an [`Ast`]. *Out:* a [`Shader`], complete even if the source has errors, and diagnostics.
//!
//! One traversal of the declarations in source order does almost everything, because every rule of the language looks
//! back and none looks ahead. What needs the whole shader comes after it: the sizes of implicitly sized arrays
//! (`finish`), recursion (`recursion`), and static use (in [`hir`](crate::hir)).
//!
//! * `context` holds the state of the traversal, `state` its parts, and `scope` the names in scope.
//! * `types`, `qualifiers` and `layout` analyze what precedes a name.
//! * `declare` enters names: variables, structs, blocks, functions, redeclared built-in variables.
//! * `statement` and `expr` analyze function bodies.
//! * [`fold`](crate::fold) computes constants.
//! * `understood` removes uncertain declarations of a shader with errors from its interface.
//!
//! *Holds:* one mistake raises one message. Whatever is in error gets the type
//! [`TypeId::ERROR`](crate::hir::TypeId::ERROR), which is compatible with everything. No traversal recurses along
//! left operands.

mod broken;
mod constant;
mod context;
mod decisive;
mod declare;
mod expr;
mod features;
mod finish;
mod keywords;
mod layout;
mod limits;
mod notes;
mod other_language;
mod qualifiers;
mod recursion;
mod scope;
mod shadertoy;
mod state;
mod statement;
mod types;
mod understood;
mod wording;

#[cfg(test)]
mod tests;

use crate::diagnostic::Diagnostics;
use crate::hir::{Shader, Stage, Types};
use crate::source::SourceMap;
use crate::stack::with_stack;
use crate::syntax::ast::Ast;
use context::Analyzer;
use state::NoteTaker;

pub use decisive::keep_decisive;
pub use other_language::keep_language;
pub use shadertoy::point_to_engine;
pub(crate) use shadertoy::{HELP as SHADERTOY_HELP, NOTE as SHADERTOY_NOTE, is_shadertoy};
pub use state::{Denoted, Note, NoteRole, Notes, Probe};
pub use understood::keep_understood;

/// Analyzes a syntax tree. `strict` turns what every driver accepts into errors; all stages of a compilation share
/// `types`.
pub fn analyze(
    ast: &Ast,
    stage: Stage,
    strict: bool,
    types: &mut Types,
    sources: &SourceMap,
    diagnostics: &mut Diagnostics,
) -> Shader {
    with_stack(nesting(ast), || analyzed(Analyzer::new(ast, stage, strict, types, sources, diagnostics, None))).0
}

/// Analyzes like [`analyze`], and notes what each name denotes. `probe` is a name that stands where its author wants to know what
/// could stand there.
pub fn analyze_with_notes(
    ast: &Ast,
    stage: Stage,
    strict: bool,
    types: &mut Types,
    sources: &SourceMap,
    diagnostics: &mut Diagnostics,
    probe: Option<&str>,
) -> (Shader, Notes) {
    let probe = probe.and_then(|probe| ast.names.get(probe));
    let taker = NoteTaker { notes: Notes::default(), probe };
    let depth = nesting(ast);
    with_stack(depth, || analyzed(Analyzer::new(ast, stage, strict, types, sources, diagnostics, Some(taker))))
}

/// Runs an analysis; the statements of the shader nest as deep as those of the tree.
fn analyzed(analyzer: Analyzer<'_>) -> (Shader, Notes) {
    let nesting = statement::nesting(analyzer.ast);
    let (mut shader, notes) = analyzer.run();
    shader.depth = shader.depth.saturating_add(nesting);
    (shader, notes)
}

/// How deep the traversal may recurse. It recurses into right operands, arguments and indices; a loop handles left
/// operands. Statements nest at most as deep as the parser allows, and each level of either kind counts.
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
