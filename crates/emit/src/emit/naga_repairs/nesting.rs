//! Limits how deep statements nest, before anything recurses over them.
//!
//! naga's validator and writers recurse over nested blocks without a limit. The larger stack is superfluous once they
//! have one; the limit of WGSL's parsers stays.
//!
//! *In:* a lowered module. *Out:* whether it needs a larger stack, and the diagnostic for nesting that no WGSL parser
//! accepts.

use glisten_front::diagnostic::Diagnostic;
use glisten_front::diagnostic::codes::targets::NESTING_TOO_DEEP_FOR_TARGET;
use glisten_front::source::Span;
use naga::{Block, Module, Statement};

/// How many levels of blocks and statements Tint accepts; naga accepts more.
const WGSL_LEVELS: u32 = 127;

/// Calls `visit` with each block inside a statement, and with its level of nesting relative to the statement.
fn inner(statement: &Statement, mut visit: impl FnMut(&Block, u32)) {
    match statement {
        Statement::Block(block) => visit(block, 1),
        Statement::If { accept, reject, .. } => {
            visit(accept, 2);
            visit(reject, 2);
        }
        Statement::Loop { body, continuing, .. } => {
            visit(body, 2);
            visit(continuing, 4);
        }
        Statement::Switch { cases, .. } => cases.iter().for_each(|case| visit(&case.body, 3)),
        _ => {}
    }
}

/// Whether blocks nest deeper than `limit`.
pub(in crate::emit) fn is_nested(module: &Module, limit: u32) -> bool {
    fn deeper(block: &Block, limit: u32) -> bool {
        let Some(limit) = limit.checked_sub(1) else { return true };
        block.iter().any(|statement| {
            let mut found = false;
            inner(statement, |block, _| found = found || deeper(block, limit));
            found
        })
    }
    bodies(module).any(|body| deeper(body, limit))
}

fn bodies(module: &Module) -> impl Iterator<Item = &Block> {
    let functions = module.functions.iter().map(|(_, function)| &function.body);
    functions.chain(module.entry_points.iter().map(|entry| &entry.function.body))
}

/// The diagnostic for the first statement that is nested too deeply for WGSL.
pub(in crate::emit) fn too_deep(module: &Module) -> Option<Diagnostic> {
    let span = bodies(module).find_map(|body| beyond(body, 1))?;
    let place = span.to_range().map_or(Span::default(), |range| Span::new(range.start as u32, range.end as u32));
    let message = format!("statements nest deeper than the {WGSL_LEVELS} levels that Tint reads of WGSL");
    let help = "move the inner statements into a function of their own, or compile for SPIR-V (`--target spirv`)";
    Some(Diagnostic::new(&NESTING_TOO_DEEP_FOR_TARGET, place, message).here("nested too deeply here").help(help))
}

/// The first statement of a block at `level` that is nested too deeply. Does not descend below the limit.
fn beyond(block: &Block, level: u32) -> Option<naga::Span> {
    for (statement, span) in block.span_iter() {
        if level >= WGSL_LEVELS && !matches!(statement, Statement::Emit(_)) {
            return Some(*span);
        }
        let mut found = None;
        inner(statement, |block, deeper| {
            if found.is_none() && !block.is_empty() {
                found = beyond(block, level + deeper);
            }
        });
        if found.is_some() {
            return found;
        }
    }
    None
}
