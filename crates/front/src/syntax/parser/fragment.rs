//! The understood part of a statement or declaration that has an error.
//!
//! *In:* the expressions and names that were read before the error. *Out:* a [`Fragment`], so that names in broken text are known to an
//! editor, and variables have their types. *Not done here:* saying anything about it; the error has been reported.

use super::types::is_qualifier;
use super::{Mark, Parser, TokenKind, TokenSource};
use crate::source::Span;
use crate::syntax::ast::{self, Expr, ExprId, ExprKind, Fragment, VariableDecl};

/// How many tokens of a broken statement are searched for the names that it declares.
const MAX_SKIPPED: usize = 256;

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

    /// Looks for the names that a broken statement or declaration declares, if none was read before the error: `vec4<f32> x = ..`,
    /// `layout(location 0) in vec3 a;`.
    pub(super) fn name_skipped(&mut self) {
        use TokenKind::*;
        if !self.declaring.is_empty() || self.taken.len() > MAX_SKIPPED {
            return;
        }
        let mut depth = 0_i32;
        let mut names = Vec::new();
        let next = self.taken.iter().skip(1).chain([&self.current]);
        for (index, (token, next)) in self.taken.iter().zip(next).enumerate() {
            match token.kind {
                LeftParen | LeftBrace | LeftBracket => depth += 1,
                RightParen | RightBrace | RightBracket => depth -= 1,
                _ => {}
            }
            let before: [TokenKind; 4] = std::array::from_fn(|back| {
                index.checked_sub(back + 1).and_then(|at| self.taken.get(at)).map_or(Eof, |token| token.kind)
            });
            let is_typed = matches!(before, [Type, ..] | [RightAngle, Type | Ident, LeftAngle, Type]);
            let is_declared = is_typed && matches!(next.kind, Equal | Semicolon | Comma | LeftBracket);
            // The parentheses of a `layout` may be broken.
            let is_global = is_typed && is_qualifier(before[1]) && matches!(next.kind, Semicolon | LeftBracket);
            if (depth == 0 || is_global) && token.kind == Ident && is_declared {
                names.push(ast::Ident { symbol: token.symbol(), span: token.span });
            }
        }
        self.declaring = names;
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
