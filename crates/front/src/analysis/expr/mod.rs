//! Analyzes expressions (§5): from the syntax tree to typed expressions.
//!
//! A chain such as `a + b + c + ...` leans to the left and may be thousands of operators long. The traversal
//! therefore descends along left operands with a loop and types the operators on its way back. It recurses only into
//! right operands, arguments and indices, which nest at most as deep as the parser allows.

mod access;
mod assign;
mod builtin;
mod call;
mod composed;
mod construct;
mod convert;
pub(super) mod foreign;
mod list;
mod lvalue;
mod name;
mod operator;
mod overload;
mod swizzle;

use super::context::Analyzer;
use crate::diagnostic::{Advice, Applicability};
use crate::hir::{ExprId, ScalarValue};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{self, ExprKind, IncDec, Literal};

pub(in crate::analysis) use lvalue::Purpose;

impl Analyzer<'_> {
    /// Types an expression.
    pub(in crate::analysis) fn expr(&mut self, root: ast::ExprId) -> ExprId {
        let mut spine = Vec::new();
        let mut at = root;
        while let Some(left) = left_operand(&self.ast.expr(at).kind) {
            spine.push(at);
            at = left;
        }
        let mut value = self.leaf(at);
        while let Some(node) = spine.pop() {
            value = self.operation(node, value);
        }
        value
    }

    /// Types an expression that has no left operand.
    fn leaf(&mut self, id: ast::ExprId) -> ExprId {
        let expr = self.ast.expr(id);
        let span = expr.span;
        match &expr.kind {
            ExprKind::Literal(literal) => {
                self.check_suffix(*literal, span);
                self.literal(scalar(*literal), span)
            }
            ExprKind::Name(name) => self.name_expr(*name),
            ExprKind::Unary(operator, operand) => {
                let operand = self.expr(*operand);
                self.unary(*operator, operand, span)
            }
            ExprKind::IncDec(operator, operand) => {
                let operand = self.expr(*operand);
                self.inc_dec(*operator, operand, span)
            }
            ExprKind::Call(name, arguments) => self.call(*name, arguments, span),
            ExprKind::Construct(spec, arguments) => self.construct_spec(spec, arguments, span),
            ExprKind::List(elements) => self.misplaced_list(elements, span),
            ExprKind::Error(pieces) => {
                self.quietly(|this| {
                    for piece in pieces {
                        this.expr(*piece);
                    }
                });
                self.poison(span)
            }
            // Expressions with a left operand never get here; `left_operand` has taken them apart.
            _ => self.poison(span),
        }
    }

    /// Reports the suffixes that 1.10 and ES 1.00 lack.
    fn check_suffix(&mut self, literal: Literal, span: Span) {
        match literal {
            Literal::Uint(_) => self.require(Feature::UnsignedLiterals, span),
            Literal::Float(_) if !self.ast.version.has(Feature::FloatSuffix) => {
                if let Some(number) = self.sources.snippet(span).strip_suffix(['f', 'F']) {
                    let help = Advice::write(Applicability::Safe, number);
                    self.require_with(Feature::FloatSuffix, span, Some(help));
                }
            }
            Literal::Float(_) | Literal::Bool(_) | Literal::Int(_) => {}
        }
    }

    /// Types an operation whose left operand has been typed.
    fn operation(&mut self, id: ast::ExprId, left: ExprId) -> ExprId {
        let expr = self.ast.expr(id);
        let span = expr.span;
        match &expr.kind {
            ExprKind::Binary(operator, at, _, right) => {
                let right = self.expr(*right);
                self.binary(*operator, *at, left, right, span)
            }
            ExprKind::Assign(operator, at, _, right) => {
                let right = self.expr(*right);
                self.assign(*operator, *at, left, right, span)
            }
            ExprKind::Ternary(_, yes, no) => {
                let (yes, no) = (self.expr(*yes), self.expr(*no));
                self.ternary(left, yes, no, span)
            }
            ExprKind::Comma(_, right) => {
                let right = self.expr(*right);
                self.comma(left, right, span)
            }
            ExprKind::IncDec(operator, _) => self.inc_dec(*operator, left, span),
            ExprKind::Index(_, index) => {
                let index = index.map(|index| self.expr(index));
                self.index(left, index, span)
            }
            ExprKind::Field(_, field) => self.field(left, *field, span),
            ExprKind::Method(_, name, arguments) => self.method(left, *name, arguments, span),
            _ => self.poison(span),
        }
    }
}

/// The leftmost operand of an operation.
fn left_operand(kind: &ExprKind) -> Option<ast::ExprId> {
    match kind {
        ExprKind::Binary(_, _, left, _)
        | ExprKind::Assign(_, _, left, _)
        | ExprKind::Ternary(left, ..)
        | ExprKind::Comma(left, _)
        | ExprKind::IncDec(IncDec::PostIncrement | IncDec::PostDecrement, left)
        | ExprKind::Index(left, _)
        | ExprKind::Field(left, _)
        | ExprKind::Method(left, ..) => Some(*left),
        _ => None,
    }
}

fn scalar(literal: Literal) -> ScalarValue {
    match literal {
        Literal::Bool(value) => ScalarValue::Bool(value),
        Literal::Int(value) => ScalarValue::Int(value),
        Literal::Uint(value) => ScalarValue::Uint(value),
        Literal::Float(value) => ScalarValue::Float(value),
    }
}

/// How deep the traversal of an expression recurses, given the depths of all earlier expressions.
pub(super) fn recursion_depth(kind: &ExprKind, depths: &[u32]) -> u32 {
    let at = |id: &ast::ExprId| depths.get(id.index()).copied().unwrap_or(0);
    let list = |ids: &[ast::ExprId]| ids.iter().map(at).max().unwrap_or(0);
    let dims = |dims: &[ast::ArrayDim]| dims.iter().filter_map(|dim| dim.size.as_ref()).map(at).max().unwrap_or(0);
    // The deepest operand that the loop visits, and the deepest that it recurses into.
    let (left, right) = match kind {
        ExprKind::Literal(_) | ExprKind::Name(_) => return 0,
        ExprKind::Unary(_, a) | ExprKind::IncDec(IncDec::PreIncrement | IncDec::PreDecrement, a) => (0, at(a)),
        ExprKind::IncDec(_, a) | ExprKind::Index(a, None) | ExprKind::Field(a, _) => return at(a),
        ExprKind::Binary(_, _, a, b)
        | ExprKind::Assign(_, _, a, b)
        | ExprKind::Comma(a, b)
        | ExprKind::Index(a, Some(b)) => (at(a), at(b)),
        ExprKind::Ternary(a, b, c) => (at(a), at(b).max(at(c))),
        ExprKind::Error(arguments) | ExprKind::Call(_, arguments) | ExprKind::List(arguments) => (0, list(arguments)),
        ExprKind::Construct(spec, arguments) => (0, list(arguments).max(dims(&spec.array))),
        ExprKind::Method(a, _, arguments) => (at(a), list(arguments)),
    };
    left.max(right.saturating_add(1))
}
