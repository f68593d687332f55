//! Operands: pairs for an operator, parts for a constructor, values of another type.
//!
//! *In:* the type of a result. *Out:* an expression of it. *Holds:* what is converted has a value in the other type.

use super::expressions::constructed;
use super::tree::Expr;
use super::types::{INT, Ty};
use super::writer::Writer;
use glisten_front::hir::Scalar;
use glisten_front::language::Feature;

impl Writer<'_> {
    /// `(a - (b - c))`, whose parentheses matter.
    pub(super) fn difference(&mut self, ty: &Ty, depth: usize) -> Expr {
        self.note("difference of a difference");
        let (left, middle, right) = (self.expr(ty, depth), self.simple(ty), self.simple(ty));
        let inner = self.chance.word(&["(@ - @)", "(@ + @)"]);
        Expr::new(ty.clone(), "(@ - @)", vec![left, Expr::new(ty.clone(), inner, vec![middle, right])])
    }

    /// Two operands for a result: the same types, or a scalar and a vector, or an integer that is converted.
    pub(super) fn mixed(&mut self, ty: &Ty, depth: usize) -> (Expr, Expr) {
        let scalar = Ty::Vector(ty.scalar().unwrap_or(Scalar::Float), 1);
        let left = self.expr(ty, depth);
        let right = match self.chance.below(5) {
            0 => self.expr(&scalar, depth),
            1 if self.language.has(Feature::ImplicitToFloat) && ty.is_vector_of(Scalar::Float) => {
                self.note("implicit conversion");
                self.expr(&INT, depth)
            }
            _ => self.expr(ty, depth),
        };
        if self.chance.once_in(2) { (left, right) } else { (right, left) }
    }

    /// A constructor of a vector or a scalar from one of any scalar type, its own among them.
    pub(super) fn conversion(&mut self, ty: &Ty, scalar: Scalar, size: u8, depth: usize) -> Expr {
        self.note("conversion");
        let from: Vec<Scalar> =
            Scalar::ALL.into_iter().filter(|one| self.language.basics.contains(&Ty::Vector(*one, size))).collect();
        let other = self.chance.one(&from).copied().unwrap_or(Scalar::Bool);
        let inner = self.expr(&Ty::Vector(other, size), depth);
        let pattern = match (scalar, other) {
            // Floats out of range and negative ones for `uint` are undefined.
            (Scalar::Int, Scalar::Float) => format!("{}(clamp(@, -1000.0, 1000.0))", ty.name()),
            (Scalar::Uint, Scalar::Float) => format!("{}(clamp(@, 0.0, 1000.0))", ty.name()),
            _ => format!("{}(@)", ty.name()),
        };
        let converted = Expr::new(ty.clone(), &pattern, vec![inner]);
        let needs_function =
            pattern.contains("clamp") && self.is_constant && !self.language.has(Feature::ConstantFunctions);
        if needs_function { self.literal(ty) } else { converted }
    }

    /// A constructor from parts that have as many components together.
    pub(super) fn composed(&mut self, ty: &Ty, scalar: Scalar, size: u8, depth: usize) -> Expr {
        if size == 1 {
            let from = 2 + self.chance.below(3) as u8;
            let inner = self.expr(&Ty::Vector(scalar, from), depth);
            return Expr::new(ty.clone(), &format!("{}(@)", ty.name()), vec![inner]);
        }
        self.note("constructor from parts");
        let (mut left, mut parts) = (size, Vec::new());
        while left > 0 {
            let part = (1 + self.chance.below(usize::from(left)) as u8).min(left);
            let part = if part == size { 1 } else { part };
            parts.push(self.expr(&Ty::Vector(scalar, part), depth));
            left -= part;
        }
        constructed(ty, parts)
    }
}
