//! The parts of a statement of naga: its blocks, its expressions.
//!
//! *In:* a statement. *Out:* its blocks, and the expressions that it evaluates itself. *Holds:* the expressions of its blocks are
//! not among them.

use naga::{Block, Expression, Handle, Statement};

/// The blocks of a statement, in the order of the text.
pub(super) fn blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Calls `visit` with the operands that a statement evaluates before it does anything else.
pub(super) fn operands(statement: &Statement, mut visit: impl FnMut(Handle<Expression>)) {
    match statement {
        Statement::If { condition, .. } => visit(*condition),
        Statement::Switch { selector, .. } => visit(*selector),
        Statement::Loop { break_if: Some(condition), .. } => visit(*condition),
        Statement::Return { value: Some(value) } => visit(*value),
        Statement::Store { pointer, value } => {
            visit(*pointer);
            visit(*value);
        }
        Statement::Call { arguments, .. } => arguments.iter().for_each(|argument| visit(*argument)),
        _ => {}
    }
}
