//! Sums of what a program computes: a difference anywhere reaches the picture.
//!
//! *In:* what is visible at the end of a scope. *Out:* statements that add numbers of it to the sum, and numbers for the outputs. *Holds:* a sum
//! stays small, whatever is added, so that later numbers are not lost in it.

use super::tree::{Expr, Stmt, Variable};
use super::types::{FLOAT, Ty};
use super::writer::Writer;
use glisten_front::hir::Scalar;
use glisten_front::language::Feature;

/// The name of the sum, a `vec4`.
pub(super) const SUM: &str = "acc";

/// The most numbers that a stage's outputs have together.
const NUMBERS: usize = 16;

impl Writer<'_> {
    /// Adds to the sum what the innermost scope has declared.
    pub(super) fn sink(&mut self, body: &mut Vec<Stmt>) {
        let own: Vec<Variable> = self.scopes.last().cloned().unwrap_or_default();
        let visible = self.visible();
        for variable in own.into_iter().filter(|one| visible.contains(one)) {
            if self.chance.once_in(5) {
                continue;
            }
            let mut all = Vec::new();
            self.scalars(Expr::leaf(variable.ty.clone(), variable.name), &mut all);
            for _ in 0..if all.len() > 3 { 2 } else { 1 } {
                if let Some(number) = self.chance.one(&all).cloned() {
                    body.push(self.added(number));
                }
            }
        }
    }

    /// `acc.x += number;` with bounds for a number that may be anything.
    pub(super) fn added(&mut self, number: Expr) -> Stmt {
        self.note("sum");
        let place = self.chance.word(&["x", "y", "z", "w"]);
        let is_whole = number.texts().first().is_some_and(|text| text.starts_with("float("));
        if is_whole {
            return Stmt::new(&format!("{SUM}.{place} += @ * 0.0625;"), vec![number], Vec::new());
        }
        let pattern = format!("{SUM}.{place} += (@ < 8.0 ? max(@, -8.0) : 8.0);");
        Stmt::new(&pattern, vec![number.clone(), number], Vec::new())
    }

    /// Numbers from everything that is visible, for the outputs: so many.
    pub(super) fn numbers(&mut self, count: usize) -> Vec<Expr> {
        let mut all = Vec::new();
        let is_own = |one: &Variable| (one.local || one.writable) && !one.constant;
        for variable in self.visible().into_iter().filter(is_own) {
            let whole = Expr::leaf(variable.ty.clone(), variable.name);
            self.scalars(whole, &mut all);
        }
        let mut chosen = Vec::new();
        while chosen.len() < count.min(NUMBERS) {
            if all.is_empty() {
                chosen.push(Expr::leaf(FLOAT, "uf"));
            } else {
                chosen.push(all.swap_remove(self.chance.below(all.len())));
            }
        }
        chosen
    }

    /// All numbers in a value, as floats.
    pub(super) fn scalars(&mut self, whole: Expr, all: &mut Vec<Expr>) {
        match whole.ty.clone() {
            Ty::Vector(Scalar::Float, 1) => all.push(whole),
            Ty::Vector(Scalar::Int, 1) if self.language.has(Feature::IntegerOperators) => {
                all.push(Expr::new(FLOAT, "float(@ & 0xffff)", vec![whole.clone()]));
                all.push(Expr::new(FLOAT, "float((@ >> 16) & 0xffff)", vec![whole]));
            }
            Ty::Vector(Scalar::Uint, 1) => {
                all.push(Expr::new(FLOAT, "float(@ & 0xffffu)", vec![whole.clone()]));
                all.push(Expr::new(FLOAT, "float(@ >> 16u)", vec![whole]));
            }
            Ty::Vector(_, 1) => all.push(Expr::new(FLOAT, "float(@)", vec![whole])),
            Ty::Vector(scalar, size) => {
                for letter in "xyzw".chars().take(usize::from(size)) {
                    self.scalars(Expr::new(Ty::Vector(scalar, 1), &format!("@.{letter}"), vec![whole.clone()]), all);
                }
            }
            Ty::Matrix(columns, rows) => {
                for column in 0..columns {
                    let pattern = format!("@[{column}]");
                    self.scalars(Expr::new(Ty::Vector(Scalar::Float, rows), &pattern, vec![whole.clone()]), all);
                }
            }
            Ty::Array(element, size) => {
                for index in 0..size {
                    self.scalars(Expr::new((*element).clone(), &format!("@[{index}]"), vec![whole.clone()]), all);
                }
            }
            Ty::Struct(number) => {
                for (name, ty) in self.structs.get(number).cloned().unwrap_or_default() {
                    self.scalars(Expr::new(ty, &format!("@.{name}"), vec![whole.clone()]), all);
                }
            }
        }
    }
}
