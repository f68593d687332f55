//! Heads that nothing has: `varing Block {`, `class A {`, `float f {`.
//!
//! *In:* a declaration of variables that a `{` follows, at global scope. *Out:* one error. The names between the braces are known all the
//! same, and what reads as a function is one.

use super::{Parse, Parser, Reported, TokenKind, TokenSource, codes};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::syntax::ast::{self, DeclarationKind, FunctionHeader, TypeBase, VariableDecl};

/// How many tokens between braces are searched.
const MAX_BETWEEN: usize = 1024;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Whether a global declaration reads as the head of the braces that are next.
    pub(super) fn is_head(&self, kind: &DeclarationKind) -> bool {
        let is_one = |variables: &VariableDecl| matches!(variables.declarators.as_slice(), [one] if one.initializer.is_none() && one.array.is_empty());
        self.kind() == TokenKind::LeftBrace
            && matches!(kind, DeclarationKind::Variables(variables) if is_one(variables))
    }

    /// Reports a head, and reads its braces if they are the body of a function.
    pub(super) fn unknown_head(&mut self, kind: DeclarationKind) -> Parse<DeclarationKind> {
        let DeclarationKind::Variables(VariableDecl { qualifiers, ty, mut declarators }) = kind else {
            return Err(Reported);
        };
        let Some(name) = declarators.pop().map(|one| one.name) else { return Err(Reported) };
        let spelling = self.session.names.spelling(name.symbol).to_owned();
        let is_function = match ty.base {
            TypeBase::Void | TypeBase::Keyword(_) => true,
            TypeBase::Named(_) => self.returns(),
            TypeBase::Struct(_) | TypeBase::Error => false,
        };
        if is_function && qualifiers.is_empty() {
            let diagnostic = Diagnostic::new(
                &codes::UNEXPECTED_TOKEN,
                self.behind(),
                format!("the function `{spelling}` has no parentheses"),
            )
            .here("expected `(`")
            .help(Advice::new(Applicability::Unsafe, "write `()` here", Place::Before, "()"));
            self.session.report(diagnostic);
            self.declaring.clear();
            let header = FunctionHeader { qualifiers, span: ty.span, ty, name, params: Vec::new(), is_whole: false };
            return self.function_definition(header);
        }
        // A word that is no type has been reported.
        if !matches!(ty.base, TypeBase::Error) {
            let message = format!("`{spelling}` is no block, no struct and no function");
            let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, ty.span, message)
                .here("expected `uniform`, `in`, `out` or `struct`");
            self.session.report(diagnostic);
        }
        Err(Reported)
    }

    /// Whether there is a `return` between the braces that are next, and not in braces of its own.
    fn returns(&mut self) -> bool {
        let mut depth = 0_usize;
        for at in 0..MAX_BETWEEN {
            match self.ahead(at).kind {
                TokenKind::LeftBrace => depth += 1,
                TokenKind::RightBrace if depth <= 1 => return false,
                TokenKind::RightBrace => depth -= 1,
                TokenKind::Return if depth == 1 => return true,
                TokenKind::Eof => return false,
                _ => {}
            }
        }
        false
    }

    /// Looks for the names that a broken global declaration has between its braces, which are those of its members, and for the name
    /// behind them.
    pub(super) fn name_members(&mut self) {
        use TokenKind::*;
        if self.previous.kind == RightBrace && self.kind() == Ident && self.ahead(1).kind == Semicolon {
            let token = self.bump();
            self.declaring.push(ast::Ident { symbol: token.symbol(), span: token.span });
            self.bump();
        }
        let (mut depth, mut is_typed, mut before) = (0_i32, false, Eof);
        let next = self.taken.iter().skip(1).map(|token| token.kind).chain([Eof]);
        let mut names = Vec::new();
        for (token, next) in self.taken.iter().zip(next).take(MAX_BETWEEN) {
            match token.kind {
                LeftBrace => depth += 1,
                RightBrace => depth -= 1,
                Semicolon => is_typed = false,
                Ident if depth == 1 && matches!(next, Semicolon | Comma | LeftBracket) => {
                    is_typed |= matches!(before, Type | Ident | Reserved);
                    if is_typed && matches!(before, Type | Ident | Reserved | Comma) {
                        names.push(ast::Ident { symbol: token.symbol(), span: token.span });
                    }
                }
                _ => {}
            }
            before = token.kind;
        }
        self.declaring.extend(names);
    }
}
