//! [`shrunk`]: a program without what its fault does not need.
//!
//! *In:* a program, and whether a smaller one still has the fault. *Out:* the smallest that was found. *Holds:* statements go, bodies take the
//! place of what is around them, expressions become their operands or constants.

use super::Program;
use super::tree::{Expr, Role, Stmt, StmtPart, Use};
use super::types::Ty;
use glisten_front::hir::Scalar;

/// How many programs are tried at most.
const MOST_TRIES: usize = 3000;

/// Makes a program smaller as long as `has_fault` holds.
pub fn shrunk(program: &Program, has_fault: &mut dyn FnMut(&Program) -> bool) -> Program {
    let mut best = program.clone();
    let mut tries = 0;
    loop {
        let before = (size(&best), best.scene.len());
        for pass in [remove, unwrap, simplify, lines] {
            pass(&mut best, &mut |smaller| {
                tries += 1;
                // A stage without its version or its `main` is another program.
                let is_whole = smaller
                    .sources()
                    .iter()
                    .all(|one| one.text.starts_with("#version") && one.text.contains("void main"));
                is_whole && tries < MOST_TRIES && has_fault(smaller)
            });
        }
        if (size(&best), best.scene.len()) == before || tries >= MOST_TRIES {
            return best;
        }
    }
}

fn size(program: &Program) -> usize {
    program.sources().iter().map(|source| source.text.len()).sum()
}

type Keep<'k> = dyn FnMut(&Program) -> bool + 'k;

/// All lists of statements, outer ones first, by their numbers: calls `f` with the list of a number.
fn with_list<T>(program: &mut Program, number: usize, f: impl FnOnce(&mut Vec<Stmt>) -> T) -> Option<T> {
    fn find<'s>(list: &'s mut Vec<Stmt>, left: &mut usize) -> Option<&'s mut Vec<Stmt>> {
        if *left == 0 {
            return Some(list);
        }
        *left -= 1;
        for statement in list {
            for part in &mut statement.parts {
                if let StmtPart::Body(body) = part
                    && let Some(found) = find(body, left)
                {
                    return Some(found);
                }
            }
        }
        None
    }
    let mut left = number;
    program.stages_mut().into_iter().rev().find_map(|list| find(list, &mut left)).map(f)
}

/// Leaves statements out: runs of them first, then each.
fn remove(best: &mut Program, keep: &mut Keep<'_>) {
    let mut number = 0;
    while let Some(len) = with_list(best, number, |list| list.len()) {
        let mut width = len.max(1);
        while width > 0 {
            let mut end = with_list(best, number, |list| list.len()).unwrap_or(0);
            while end > 0 {
                let start = end.saturating_sub(width);
                let mut smaller = best.clone();
                // An output without a value is undefined.
                let is_needed =
                    with_list(&mut smaller, number, |list| list.drain(start..end).any(|one| one.role == Role::Output));
                if is_needed != Some(true) && keep(&smaller) {
                    *best = smaller;
                }
                end = start;
            }
            width /= 2;
        }
        number += 1;
    }
}

/// Puts the statements of bodies in the place of what is around them.
fn unwrap(best: &mut Program, keep: &mut Keep<'_>) {
    let mut number = 0;
    while let Some(len) = with_list(best, number, |list| list.len()) {
        for index in (0..len).rev() {
            let mut smaller = best.clone();
            let has_body = with_list(&mut smaller, number, |list| {
                let Some(statement) = list.get_mut(index) else { return false };
                let bodies: Vec<Stmt> = statement
                    .parts
                    .drain(..)
                    .filter_map(|part| if let StmtPart::Body(body) = part { Some(body) } else { None })
                    .flatten()
                    .collect();
                let has_body = !bodies.is_empty();
                list.splice(index..=index, bodies);
                has_body
            });
            if has_body == Some(true) && keep(&smaller) {
                *best = smaller;
            }
        }
        number += 1;
    }
}

/// Calls `f` with the expression of a number, outer ones first.
fn with_expr<T>(program: &mut Program, number: usize, f: impl FnOnce(&mut Expr) -> T) -> Option<T> {
    fn in_expr<'e>(expr: &'e mut Expr, left: &mut usize) -> Option<&'e mut Expr> {
        if *left == 0 {
            return Some(expr);
        }
        *left -= 1;
        expr.operands.iter_mut().find_map(|operand| in_expr(operand, left))
    }
    fn in_list<'e>(list: &'e mut [Stmt], left: &mut usize) -> Option<&'e mut Expr> {
        list.iter_mut().flat_map(|statement| &mut statement.parts).find_map(|part| match part {
            StmtPart::Expr(expr) => in_expr(expr, left),
            StmtPart::Body(body) => in_list(body, left),
        })
    }
    let mut left = number;
    program.stages_mut().into_iter().rev().find_map(|list| in_list(list, &mut left)).map(f)
}

/// Expressions become one of their operands, or a constant.
fn simplify(best: &mut Program, keep: &mut Keep<'_>) {
    let mut number = 0;
    while let Some(expr) = with_expr(best, number, |expr| expr.clone()) {
        let mut simpler: Vec<Expr> = Vec::new();
        if expr.usage == Use::Value && !expr.operands.is_empty() {
            simpler.extend(constant(&expr.ty));
            simpler.extend(expr.operands.iter().filter(|operand| operand.ty == expr.ty).cloned());
        }
        let mut is_changed = false;
        for one in simpler {
            let mut smaller = best.clone();
            with_expr(&mut smaller, number, |place| *place = one);
            if keep(&smaller) {
                *best = smaller;
                is_changed = true;
                break;
            }
        }
        if !is_changed {
            number += 1;
        }
    }
}

/// A constant of a type.
fn constant(ty: &Ty) -> Option<Expr> {
    let one = match ty.scalar()? {
        Scalar::Float => "1.0",
        Scalar::Int => "1",
        Scalar::Uint => "1u",
        Scalar::Bool => "true",
    };
    let is_scalar = matches!(ty, Ty::Vector(_, 1));
    Some(Expr::leaf(ty.clone(), if is_scalar { one.to_owned() } else { format!("{}({one})", ty.name()) }))
}

/// Leaves lines of the scene out.
fn lines(best: &mut Program, keep: &mut Keep<'_>) {
    for index in (0..best.scene.len()).rev() {
        let mut smaller = best.clone();
        smaller.scene.remove(index);
        if keep(&smaller) {
            *best = smaller;
        }
    }
}
