//! Writes `for`, `while`, `+=` and `++` where naga writes what they mean.
//!
//! *Holds:* naga's front end reads the result as the module that the text came from.

use super::tree::{Block, Expr, Stmt};

/// Rewrites a block and everything in it.
pub(super) fn rewrite(block: &mut Block) {
    for stmt in block.iter_mut() {
        stmt.blocks_mut().into_iter().for_each(rewrite);
        if let Some(new) = compound(stmt).or_else(|| counted(stmt)) {
            *stmt = new;
        }
    }
}

/// `a = a + b` as `a += b`; by one, as `a++`.
fn compound(stmt: &Stmt) -> Option<Stmt> {
    let Stmt::Assign { target, op: None, value: Expr::Binary(op, left, right) } = stmt else { return None };
    let arithmetic = matches!(*op, "+" | "-" | "*" | "/" | "%" | "&" | "|" | "^" | "<<" | ">>");
    if !arithmetic || **left != *target || !target.is_plain_place() {
        return None;
    }
    let by_one = matches!(&**right, Expr::Leaf(one) if one == "1i" || one == "1u");
    match *op {
        "+" if by_one => Some(Stmt::Step { target: target.clone(), op: "++" }),
        "-" if by_one => Some(Stmt::Step { target: target.clone(), op: "--" }),
        op => Some(Stmt::Assign { target: target.clone(), op: Some(op), value: (**right).clone() }),
    }
}

/// A loop that begins with `if !condition { break; }` as `while` or `for`.
fn counted(stmt: &Stmt) -> Option<Stmt> {
    let Stmt::Loop { body, continuing, break_if: None } = stmt else { return None };
    let step = match continuing.as_slice() {
        [] => None,
        [only @ (Stmt::Assign { .. } | Stmt::Step { .. } | Stmt::Call(_))] => Some(Box::new(only.clone())),
        _ => return None,
    };
    let (condition, body) = match body.as_slice() {
        [Stmt::If { condition, accept, reject }, rest @ ..]
            if matches!(accept.as_slice(), [Stmt::Word("break")]) && reject.is_empty() =>
        {
            let Expr::Unary("!", condition) = condition else { return None };
            (Some((**condition).clone()), rest.to_vec())
        }
        _ => (None, body.clone()),
    };
    match (condition, step) {
        (condition, Some(step)) => Some(Stmt::For { init: None, condition, step: Some(step), body }),
        (Some(condition), None) => Some(Stmt::While { condition, body }),
        (None, None) => None,
    }
}
