//! Writes `for`, `while`, `+=` and `++` where a module has what they mean.
//!
//! *Holds:* naga's front end reads the result as the module that the tree came from.

use super::tree::{Block, Expr, StmtKind};

/// `a = a + b` as `a += b`; by one, as `a++`, which vectors do not have.
pub(super) fn compound(stmt: StmtKind<'_>, is_scalar: bool) -> StmtKind<'_> {
    let StmtKind::Assign { target, op: None, value: Expr::Binary(op, left, right), whole } = stmt else { return stmt };
    let arithmetic = matches!(op, "+" | "-" | "*" | "/" | "%" | "&" | "|" | "^" | "<<" | ">>");
    if !arithmetic || *left != target || !target.is_plain_place() {
        return StmtKind::Assign { target, op: None, value: Expr::Binary(op, left, right), whole };
    }
    let by_one =
        is_scalar && matches!(&*right, Expr::Number(one) if one.digits == "1" && matches!(one.suffix, "i" | "u"));
    match op {
        "+" if by_one => StmtKind::Step { target, op: "++" },
        "-" if by_one => StmtKind::Step { target, op: "--" },
        op => StmtKind::Assign { target, op: Some(op), value: *right, whole: None },
    }
}

/// How the first statement of a loop leaves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Leaves {
    /// `if condition { break; }`
    If,
    /// `if condition { } else { break; }`
    Unless,
    /// Not at all.
    No,
}

/// A loop that begins with `if !condition { break; }` as `while` or `for`. The parts that move into the head leave
/// their blocks. `leaves` says whether that is what the loop begins with.
pub(super) fn head<'m>(
    body: &mut Block<'m>,
    continuing: &mut Block<'m>,
    leaves: Leaves,
) -> Option<(Option<Expr<'m>>, Option<StmtKind<'m>>)> {
    let steps = continuing.statements.len();
    let has_step = match continuing.statements.as_slice() {
        [] => false,
        [only] if matches!(only.kind, StmtKind::Assign { .. } | StmtKind::Step { .. } | StmtKind::Call(_)) => true,
        _ => return None,
    };
    let condition = body.statements.first_mut().and_then(|first| match (&mut first.kind, leaves) {
        (StmtKind::If { condition: Expr::Unary("!", condition), .. }, Leaves::If) => {
            let condition = std::mem::replace(&mut **condition, Expr::Leaf("".into()));
            first.kind = StmtKind::Empty;
            Some(condition)
        }
        (StmtKind::If { condition, .. }, Leaves::Unless) => {
            let condition = std::mem::replace(condition, Expr::Leaf("".into()));
            first.kind = StmtKind::Empty;
            Some(condition)
        }
        _ => None,
    });
    if condition.is_none() && !has_step {
        return None;
    }
    body.in_head = usize::from(condition.is_some());
    continuing.in_head = steps;
    let step = continuing.statements.pop().map(|step| step.kind);
    Some((condition, step))
}
