//! Declares variables where they are first used, as the source does: naga declares all of them at the beginning of the
//! function.
//!
//! *Holds:* no evaluation moves, only declarations. A declaration moves into a loop only with a store to the whole
//! variable, which it becomes; otherwise the variable would lose its value between iterations.

use super::tree::{Block, Expr, Stmt};

/// With more work than this, declarations stay where they are.
const MOST_WORK: usize = 20_000_000;

/// A variable that looks for its place.
struct Variable {
    name: String,
    ty: String,
    value: Option<Expr>,
}

/// Moves the declarations at the beginning of a function.
pub(super) fn sink(block: &mut Block) {
    let count = block.iter().take_while(|stmt| matches!(stmt, Stmt::Var { .. })).count();
    let nodes: usize = block.iter().map(Stmt::len).sum();
    if count.saturating_mul(nodes) > MOST_WORK {
        return;
    }
    let declared: Vec<Stmt> = block.drain(..count).collect();
    let mut stuck = Vec::new();
    // Those that move to one place keep their order.
    for stmt in declared {
        let Stmt::Var { name, ty, value } = stmt else { continue };
        let variable = Variable { name, ty, value };
        if !place(block, &variable, false) {
            stuck.push(variable.declaration(variable.value.clone()));
        }
    }
    block.splice(0..0, stuck);
}

impl Variable {
    fn declaration(&self, value: Option<Expr>) -> Stmt {
        Stmt::Var { name: self.name.clone(), ty: self.ty.clone(), value }
    }

    fn is(&self, expr: &Expr) -> bool {
        matches!(expr, Expr::Leaf(name) if *name == self.name)
    }

    /// The value of a store to the whole variable that does not read it.
    fn stored(&self, stmt: &Stmt) -> Option<Expr> {
        match stmt {
            Stmt::Assign { target, op: None, value } if self.is(target) && !value.mentions(&self.name) => {
                Some(value.clone())
            }
            _ => None,
        }
    }
}

/// Declares a variable in a block. Returns whether there was a place.
fn place(block: &mut Block, variable: &Variable, in_loop: bool) -> bool {
    let uses: Vec<usize> = (0..block.len()).filter(|at| block[*at].mentions(&variable.name)).collect();
    let Some(&first) = uses.first() else { return true };
    if uses.len() == 1
        && let Some((inner, is_loop)) = only_block(&mut block[first], &variable.name)
        && place(inner, variable, in_loop || is_loop)
    {
        return true;
    }
    if let Some(value) = variable.stored(&block[first]) {
        let declaration = variable.declaration(Some(value));
        let next_is_last = uses.get(1) == Some(&(first + 1)) && uses.len() == 2;
        if next_is_last && adopt(&mut block[first + 1], &variable.name, &declaration) {
            block.remove(first);
        } else {
            block[first] = declaration;
        }
        return true;
    }
    if in_loop {
        return false;
    }
    let declaration = variable.declaration(variable.value.clone());
    let adopted = uses.len() == 1 && variable.value.is_some() && adopt(&mut block[first], &variable.name, &declaration);
    if !adopted {
        block.insert(first, declaration);
    }
    true
}

/// Makes a declaration the first part of a `for` that steps the variable.
fn adopt(stmt: &mut Stmt, name: &str, declaration: &Stmt) -> bool {
    match stmt {
        Stmt::For { init: init @ None, step: Some(step), .. } if step.mentions(name) => {
            *init = Some(Box::new(declaration.clone()));
            true
        }
        _ => false,
    }
}

/// The one block inside a statement that mentions a name, and whether it is repeated; none if something else of the
/// statement mentions it, too.
fn only_block<'a>(stmt: &'a mut Stmt, name: &str) -> Option<(&'a mut Block, bool)> {
    if stmt.exprs().iter().any(|expr| expr.mentions(name)) {
        return None;
    }
    let is_loop = matches!(stmt, Stmt::Loop { .. } | Stmt::For { .. } | Stmt::While { .. });
    let of_loop = matches!(stmt, Stmt::Loop { .. });
    let mut found = None;
    for (index, block) in stmt.blocks_mut().into_iter().enumerate() {
        if block.iter().any(|stmt| stmt.mentions(name)) {
            // What a `continuing` block needs is declared outside: a `continue` must not skip it.
            if found.is_some() || (of_loop && index == 1) {
                return None;
            }
            found = Some(block);
        }
    }
    found.map(|block| (block, is_loop))
}
