//! The understood part of a statement or declaration that has an error.
//!
//! *In:* the expressions and names that were read before the error. *Out:* a [`Fragment`], so that names in broken text are known to an
//! editor, and variables have their types. *Not done here:* saying anything about it; the error has been reported.

use super::{Mark, Parser, TokenSource};
use crate::source::Span;
use crate::syntax::ast::{Expr, ExprId, ExprKind, Fragment, VariableDecl};

impl<T: TokenSource> Parser<'_, '_, T> {
    /// The number of expressions so far.
    pub(super) fn n_exprs(&self) -> usize {
        self.ast.exprs.len()
    }

    /// Begins a statement or declaration.
    pub(super) fn begin(&mut self) {
        self.declaring.clear();
        self.unfinished = None;
        self.taken.clear();
    }

    /// The understood part of the statement or declaration that began at a mark.
    pub(super) fn fragment(&mut self, start: Mark, span: Span) -> Fragment {
        let variables = self.unfinished.take();
        let names = std::mem::take(&mut self.declaring);
        let belong = variables.iter().flat_map(exprs_of).collect();
        let pieces = self.pieces(start.exprs, belong);
        let rest = (!pieces.is_empty()).then(|| self.error_expr(span, pieces));
        Fragment { names, variables, rest }
    }

    /// An expression that replaces an error, with those read since number `from`.
    pub(super) fn broken_expr(&mut self, from: usize, span: Span) -> ExprId {
        let pieces = self.pieces(from, Vec::new());
        self.error_expr(span, pieces)
    }

    /// The expressions from a number on that are in no other one. What statements inside have is theirs.
    fn pieces(&self, from: usize, belong: Vec<ExprId>) -> Vec<ExprId> {
        let from = from.max(self.settled);
        let exprs = self.ast.exprs.get(from..).unwrap_or_default();
        let mut is_inner = vec![false; exprs.len()];
        let inner = exprs.iter().flat_map(children).chain(belong);
        for id in inner.filter_map(|id| id.index().checked_sub(from)) {
            if let Some(flag) = is_inner.get_mut(id) {
                *flag = true;
            }
        }
        let is_kept = |kind: &ExprKind| match kind {
            ExprKind::Literal(_) | ExprKind::List(_) => false,
            ExprKind::Error(pieces) => !pieces.is_empty(),
            _ => true,
        };
        let roots = exprs.iter().zip(&is_inner).enumerate();
        let roots = roots.filter(|(_, (expr, is_inner))| !**is_inner && is_kept(&expr.kind));
        roots.map(|(number, _)| ExprId::at(from + number)).collect()
    }
}

fn exprs_of(variables: &VariableDecl) -> Vec<ExprId> {
    let arrays = variables.declarators.iter().flat_map(|declarator| &declarator.array).chain(&variables.ty.array);
    arrays
        .filter_map(|dim| dim.size)
        .chain(variables.declarators.iter().filter_map(|declarator| declarator.initializer))
        .collect()
}

fn children(expr: &Expr) -> Vec<ExprId> {
    match &expr.kind {
        ExprKind::Literal(_) | ExprKind::Name(_) => Vec::new(),
        ExprKind::Unary(_, a) | ExprKind::IncDec(_, a) | ExprKind::Field(a, _) | ExprKind::Index(a, None) => vec![*a],
        ExprKind::Binary(_, _, a, b)
        | ExprKind::Comma(a, b)
        | ExprKind::Assign(_, _, a, b)
        | ExprKind::Index(a, Some(b)) => vec![*a, *b],
        ExprKind::Ternary(a, b, c) => vec![*a, *b, *c],
        ExprKind::Error(list) | ExprKind::Call(_, list) | ExprKind::List(list) => list.clone(),
        ExprKind::Construct(ty, list) => {
            list.iter().copied().chain(ty.array.iter().filter_map(|dim| dim.size)).collect()
        }
        ExprKind::Method(a, _, list) => std::iter::once(*a).chain(list.iter().copied()).collect(),
    }
}
