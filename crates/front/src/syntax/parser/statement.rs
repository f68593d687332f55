//! Parses statements (GLSL 1.50 §6.2 to §6.4, §9).

use super::declaration::MAX_BODY;
use super::{Mark, Parse, Parser, Reported, Token, TokenKind, TokenSource, codes};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::source::Span;
use crate::syntax::ast::{Condition, Declaration, DeclarationKind, ExprId, Stmt, StmtKind, SwitchItem, VariableDecl};
use crate::syntax::of_later_word;

/// How many tokens the header of a statement may have for its forgotten `(` to be found.
const MAX_HEADER: usize = 256;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// compound_statement; reports a missing closing brace.
    pub(super) fn compound_statement(&mut self) -> Vec<Stmt> {
        let opening = self.bump();
        self.rest_of_compound(opening.span)
    }

    /// The statements of a block after its `{`, up to its `}`.
    pub(super) fn rest_of_compound(&mut self, opening: Span) -> Vec<Stmt> {
        let mut statements = Vec::new();
        loop {
            match self.kind() {
                TokenKind::RightBrace if self.ends_too_early() => self.early_brace(),
                TokenKind::RightBrace => {
                    self.labelled = self.labelled.filter(|braces| *braces < self.braces);
                    self.bump();
                    return statements;
                }
                TokenKind::Eof => {
                    let _: Reported = self.unclosed_brace(opening);
                    statements.push(Stmt { kind: StmtKind::Error, span: self.current.span });
                    return statements;
                }
                // A megabyte of empty statements need not be kept.
                TokenKind::Semicolon => {
                    self.bump();
                }
                _ => statements.push(self.statement()),
            }
            if self.leaving_function {
                return statements;
            }
        }
    }

    /// statement; reports and skips one that makes no sense.
    pub(super) fn statement(&mut self) -> Stmt {
        let start = self.start();
        let before = self.mark();
        self.begin();
        let kind = self.nested(Self::statement_kind).unwrap_or_else(|_: Reported| {
            if !self.leaving_function {
                self.recover_statement(before);
                self.name_skipped();
            }
            let fragment = self.fragment(before, start.span);
            if fragment.is_empty() { StmtKind::Error } else { StmtKind::Broken(Box::new(fragment)) }
        });
        self.taken.clear();
        self.settled = self.n_exprs();
        Stmt { kind, span: self.since(start) }
    }

    fn statement_kind(&mut self) -> Parse<StmtKind> {
        if self.kind() == TokenKind::Ident {
            self.correct_statement();
        }
        match self.kind() {
            TokenKind::LeftBrace => Ok(StmtKind::Block(self.compound_statement())),
            TokenKind::Semicolon => {
                self.bump();
                Ok(StmtKind::Empty)
            }
            TokenKind::If => self.if_statement(),
            TokenKind::Switch => self.switch_statement(),
            TokenKind::For => self.for_statement(),
            TokenKind::While => self.while_statement(),
            TokenKind::Do => self.do_statement(),
            TokenKind::Case | TokenKind::Default => Err(self.stray_case()),
            TokenKind::Continue => self.jump(StmtKind::Continue, "`continue`"),
            TokenKind::Break if self.labelled == Some(self.braces) => self.jump(StmtKind::Error, "`break`"),
            TokenKind::Break => self.jump(StmtKind::Break, "`break`"),
            TokenKind::Discard => self.jump(StmtKind::Discard, "`discard`"),
            TokenKind::Return => self.return_statement(),
            TokenKind::Else => {
                let span = self.current.span;
                let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, "`else` without an `if` before it")
                    .here("expected a statement");
                Err(self.report_found(diagnostic))
            }
            TokenKind::LeftBracket if self.is_attribute() => self.attribute(),
            TokenKind::Ident | TokenKind::Reserved if self.is_later_switch() => Ok(self.later_switch()),
            TokenKind::Ident if self.is_misspelled_else_if() => {
                let name = self.session.spelling(self.current).to_owned();
                let message = format!("`{name}` is not a keyword of GLSL");
                let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, message)
                    .here("expected a statement")
                    .help(Advice::write(Applicability::Safe, "else if"));
                self.session.report(diagnostic);
                self.if_statement()
            }
            _ => self.simple_statement(),
        }
    }

    /// Whether an attribute is next, such as `[unroll]` of HLSL and `[[unroll]]` of GL_EXT_control_flow_attributes: brackets before a statement that begins with a keyword.
    fn is_attribute(&mut self) -> bool {
        let behind = self.past_bracket(0, TokenKind::LeftBracket, TokenKind::RightBracket);
        matches!(
            self.ahead(behind).kind,
            TokenKind::For | TokenKind::While | TokenKind::Do | TokenKind::If | TokenKind::Switch
        )
    }

    /// Reports the attribute, and reads the statement behind it.
    fn attribute(&mut self) -> Parse<StmtKind> {
        let opening = self.start();
        let mut depth = 0_usize;
        loop {
            match self.bump().kind {
                TokenKind::LeftBracket => depth += 1,
                TokenKind::RightBracket => depth = depth.saturating_sub(1),
                _ => {}
            }
            if depth == 0 {
                break;
            }
        }
        let span = self.since(opening);
        let message = format!("`{}` is an attribute, and GLSL has none", self.session.sources.snippet(span));
        let help = Advice::new(Applicability::Safe, "leave it out", Place::Over, "");
        let finding = Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, message).here("expected a statement").help(help);
        self.session.report(finding);
        self.statement_kind()
    }

    /// Whether `elseif (..) statement` is next, rather than a call of something named so.
    fn is_misspelled_else_if(&mut self) -> bool {
        if self.ahead(1).kind != TokenKind::LeftParen
            || !matches!(self.session.spelling(self.current), "elseif" | "elif" | "elsif")
        {
            return false;
        }
        let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
        matches!(self.ahead(behind).kind, TokenKind::LeftBrace | TokenKind::Ident)
    }

    /// Whether `switch (..) {` is next in a version without it.
    fn is_later_switch(&mut self) -> bool {
        if self.ahead(1).kind != TokenKind::LeftParen || self.session.spelling(self.current) != "switch" {
            return false;
        }
        let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
        self.ahead(behind).kind == TokenKind::LeftBrace
    }

    /// Reports a `switch` that the version lacks, and skips it: its labels are no keywords.
    fn later_switch(&mut self) -> StmtKind {
        let word = self.bump();
        let version = self.session.version;
        let message = format!("`switch` is not in {}", version.name());
        let finding = Diagnostic::new(&codes::RESERVED_WORD, word.span, message).here("reserved for later versions");
        self.session.report(of_later_word(finding, "switch", version));
        let outside = self.braces;
        while self.kind() != TokenKind::Eof {
            let token = self.bump();
            if token.kind == TokenKind::RightBrace && self.braces <= outside {
                break;
            }
        }
        StmtKind::Error
    }

    fn simple_statement(&mut self) -> Parse<StmtKind> {
        if self.begins_global() {
            return Err(self.leave_before_global());
        }
        if !self.begins_declaration() {
            let expr = self.expression()?;
            self.semicolon("the expression")?;
            return Ok(StmtKind::Expr(expr));
        }
        if self.begins_function_definition() {
            return self.nested_function();
        }
        let kind = self.local_declaration()?;
        if let Err(reported) = self.semicolon("the declaration") {
            if let StmtKind::Variables(variables) = kind {
                self.unfinished = Some(variables);
            }
            return Err(reported);
        }
        Ok(kind)
    }

    fn local_declaration(&mut self) -> Parse<StmtKind> {
        let start = self.start();
        Ok(match self.declaration()? {
            DeclarationKind::Precision { qualifier, ty } => StmtKind::Precision { qualifier, ty },
            DeclarationKind::Variables(variables) => StmtKind::Variables(variables),
            DeclarationKind::Requalify { qualifiers, names } => StmtKind::Requalify { qualifiers, names },
            DeclarationKind::Prototype(header) => StmtKind::Prototype(header),
            DeclarationKind::Block(_) => {
                let span = self.since(start);
                self.report(&codes::UNEXPECTED_TOKEN, span, "an interface block is only allowed at global scope");
                StmtKind::Error
            }
            DeclarationKind::Error
            | DeclarationKind::Broken(_)
            | DeclarationKind::Empty
            | DeclarationKind::Function(..) => StmtKind::Error,
        })
    }

    /// Whether `type name ( .. ) {` is next.
    fn begins_function_definition(&mut self) -> bool {
        if !matches!(self.kind(), TokenKind::Void | TokenKind::Type | TokenKind::Ident) {
            return false;
        }
        if self.ahead(1).kind != TokenKind::Ident || self.ahead(2).kind != TokenKind::LeftParen {
            return false;
        }
        let behind = self.past_bracket(2, TokenKind::LeftParen, TokenKind::RightParen);
        self.ahead(behind).kind == TokenKind::LeftBrace && self.ahead(behind - 1).kind == TokenKind::RightParen
    }

    /// Handles a function inside a function. If the braces of the file are in pairs, it is one; otherwise it is parsed as if the outer
    /// one had ended.
    fn nested_function(&mut self) -> Parse<StmtKind> {
        let name = self.ahead(1);
        let is_nested = self.braces_are_paired();
        let message = format!("the function `{}` is defined inside a function", self.session.spelling(name));
        let diagnostic = Diagnostic::new(&codes::NESTED_FUNCTION, name.span, message)
            .here("functions can only be defined at global scope")
            .label(self.function_brace, "the function around it begins here")
            .help(match is_nested {
                true => "move it out, and make parameters of what it reads of the function around it",
                false => "if this is not a nested function, a `}` is missing above",
            });
        self.session.report(diagnostic);
        if is_nested {
            return self.inner_function();
        }
        self.leaving_function = true;
        self.assumed_brace = true;
        Err(Reported)
    }

    /// Reads a function inside a function, as if it were in front of the outer one.
    fn inner_function(&mut self) -> Parse<StmtKind> {
        let (first, start, outer_brace) = (self.current, self.start(), self.function_brace);
        let DeclarationKind::Prototype(mut header) = self.declaration()? else { return Err(Reported) };
        // It may read what the outer one declares, which is not known in front of it.
        header.is_whole = false;
        let kind = self.function_definition(header)?;
        self.function_brace = outer_brace;
        let extensions = self.session.extensions_at(first);
        self.ast.declarations.push(Declaration { kind, span: self.since(start), extensions });
        Ok(StmtKind::Empty)
    }

    /// Whether each brace that is open is closed up to the end of the file. They are counted only once.
    pub(super) fn braces_are_paired(&mut self) -> bool {
        if let Some(paired) = self.paired {
            return paired;
        }
        let mut depth = self.braces;
        let mut paired = false;
        for at in 0..MAX_BODY {
            match self.ahead(at).kind {
                TokenKind::LeftBrace => depth += 1,
                TokenKind::RightBrace => depth -= 1,
                TokenKind::Eof => {
                    paired = depth == 0;
                    break;
                }
                _ => {}
            }
        }
        self.paired = Some(paired);
        paired
    }

    /// Whether a line is next that declares something only outside of functions: if braces are missing, one is above it.
    fn begins_global(&mut self) -> bool {
        use TokenKind::*;
        self.braces > 0
            && self.current.starts_line()
            && matches!(self.kind(), Uniform | In | Out | Attribute | Varying | Layout)
            && !self.braces_are_paired()
    }

    /// Reports the function whose `}` is missing above a global declaration, and leaves it.
    fn leave_before_global(&mut self) -> Reported {
        let diagnostic = Diagnostic::new(&codes::UNCLOSED_DELIMITER, self.function_brace, "`{` is not closed")
            .here("the function begins here")
            .label(self.current.span, "this declares something outside of functions: a `}` is missing above");
        self.session.report(diagnostic);
        self.leaving_function = true;
        self.assumed_brace = true;
        Reported
    }

    fn stray_case(&mut self) -> Reported {
        let token = self.bump();
        let name = token.kind.spelling();
        let message = format!("`{name}` is outside the braces of a `switch`");
        self.report(&codes::STRAY_CASE, token.span, message);
        while !matches!(
            self.kind(),
            TokenKind::Colon | TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace | TokenKind::Eof
        ) {
            self.bump();
        }
        self.eat(TokenKind::Colon);
        // What follows the label is an ordinary statement, but a `break` belongs to the `switch` that is not there.
        self.labelled = Some(self.braces);
        self.recovered = true;
        Reported
    }

    /// `( expression )` after `if`, `switch` or `while`; skips a broken one to its end.
    fn condition_in_parens(&mut self) -> Parse<ExprId> {
        let from = self.n_exprs();
        let condition = self.in_parens(|this| this.expression())?;
        Ok(condition.unwrap_or_else(|| self.broken_expr(from, self.previous.span)))
    }

    /// Parses `( production )`. Returns `None` if the production failed and parsing can go on after its `)`.
    fn in_parens<R>(&mut self, production: impl FnOnce(&mut Self) -> Parse<R>) -> Parse<Option<R>> {
        let opening: Option<Token> = self.opening_paren()?;
        let result = production(self).and_then(|inner| {
            match opening {
                Some(opening) => self.close(opening, TokenKind::RightParen, "`)` or an operator")?,
                None if self.kind() == TokenKind::LeftBrace => self.previous,
                None => self.expect(TokenKind::RightParen)?,
            };
            Ok(inner)
        });
        match result {
            Ok(inner) => Ok(Some(inner)),
            Err(reported) => {
                if self.recover_header() {
                    Ok(None)
                } else {
                    Err(reported)
                }
            }
        }
    }

    /// The `(` after a keyword. A missing one before a body in braces is reported and assumed: `for int i = 0; i < 3; i++ {`.
    fn opening_paren(&mut self) -> Parse<Option<Token>> {
        if self.kind() == TokenKind::LeftParen || !self.body_ends_line() {
            return self.expect(TokenKind::LeftParen).map(Some);
        }
        let reported = self.unexpected("`(`");
        if self.recovered { Err(reported) } else { Ok(None) }
    }

    /// Whether there is a `{` behind something on this line.
    fn body_ends_line(&mut self) -> bool {
        for at in 0..MAX_HEADER {
            let token = self.ahead(at);
            match token.kind {
                _ if token.starts_line() => return false,
                TokenKind::LeftBrace => return at > 0,
                TokenKind::RightBrace | TokenKind::Eof => return false,
                _ => {}
            }
        }
        false
    }

    /// selection_statement; a loop handles `else if`.
    fn if_statement(&mut self) -> Parse<StmtKind> {
        let mut arms = Vec::new();
        loop {
            self.bump();
            let condition = self.condition_in_parens()?;
            let body = self.statement();
            arms.push((condition, body));
            self.correct_else();
            if self.leaving_function || self.eat(TokenKind::Else).is_none() {
                return Ok(StmtKind::If { arms, otherwise: None });
            }
            if self.kind() != TokenKind::If {
                let otherwise = Some(Box::new(self.statement()));
                return Ok(StmtKind::If { arms, otherwise });
            }
        }
    }

    /// switch_statement
    fn switch_statement(&mut self) -> Parse<StmtKind> {
        self.bump();
        let selector = self.condition_in_parens()?;
        if self.kind() != TokenKind::LeftBrace {
            return Err(self.unexpected("`{` after the `switch`"));
        }
        let opening = self.bump();
        let mut body = Vec::new();
        while self.kind() != TokenKind::RightBrace {
            if self.kind() == TokenKind::Eof {
                return Err(self.unclosed_brace(opening.span));
            }
            let before = self.mark();
            let start = self.start();
            self.begin();
            match self.switch_item() {
                Ok(item) => body.push(item),
                Err(_) => {
                    self.recover_label(before);
                    let span = self.since(start);
                    let value = self.broken_expr(before.exprs, span);
                    // It is a label, and something follows it.
                    body.push(SwitchItem::Case(value, span));
                    body.push(SwitchItem::Stmt(Stmt { kind: StmtKind::Error, span }));
                }
            }
            if self.leaving_function {
                return Err(Reported);
            }
        }
        self.bump();
        Ok(StmtKind::Switch { selector, body })
    }

    /// case_label or statement
    fn switch_item(&mut self) -> Parse<SwitchItem> {
        self.correct_label();
        let start = self.start();
        match self.kind() {
            TokenKind::Case => {
                self.bump();
                let value = self.expression()?;
                self.expect(TokenKind::Colon)?;
                Ok(SwitchItem::Case(value, self.since(start)))
            }
            TokenKind::Default => {
                self.bump();
                self.expect(TokenKind::Colon)?;
                Ok(SwitchItem::Default(self.since(start)))
            }
            _ => Ok(SwitchItem::Stmt(self.statement())),
        }
    }

    fn for_statement(&mut self) -> Parse<StmtKind> {
        self.bump();
        let from = self.n_exprs();
        let header = self.in_parens(|this| {
            let init = this.for_init()?;
            let condition = if this.kind() == TokenKind::Semicolon { None } else { Some(this.condition()?) };
            if this.eat(TokenKind::Semicolon).is_none() {
                return Err(this.unexpected("`;` after the condition of the `for`"));
            }
            let step = if this.kind() == TokenKind::RightParen { None } else { Some(this.expression()?) };
            Ok((init, condition, step))
        })?;
        let (init, condition, step) = match header {
            Some(header) => header,
            None => self.broken_for(from),
        };
        let body = Box::new(self.statement());
        Ok(StmtKind::For { init: Box::new(init), condition, step, body })
    }

    /// The known part of the header of a `for` that has an error: its variable.
    fn broken_for(&mut self, from: usize) -> (Stmt, Option<Condition>, Option<ExprId>) {
        let span = self.previous.span;
        let start = Mark { exprs: from, ..self.mark() };
        let fragment = self.fragment(start, span);
        (Stmt { kind: StmtKind::Broken(Box::new(fragment)), span }, None, None)
    }

    /// for_init_statement
    fn for_init(&mut self) -> Parse<Stmt> {
        let start = self.start();
        let kind = if self.kind() == TokenKind::Semicolon {
            StmtKind::Empty
        } else if self.begins_declaration() {
            self.local_declaration()?
        } else {
            StmtKind::Expr(self.expression()?)
        };
        if let StmtKind::Variables(variables) = &kind {
            // The rest of the header may be broken.
            self.unfinished = Some(variables.clone());
        }
        if self.eat(TokenKind::Semicolon).is_none() {
            return Err(self.unexpected("`;` after the first part of the `for`"));
        }
        Ok(Stmt { kind, span: self.since(start) })
    }

    /// condition
    fn condition(&mut self) -> Parse<Condition> {
        if !self.begins_declaration() {
            return Ok(Condition::Expr(self.expression()?));
        }
        let start = self.start();
        match self.declaration()? {
            DeclarationKind::Variables(variables) if is_one_initialized(&variables) => {
                Ok(Condition::Declaration(Box::new(variables)))
            }
            _ => {
                let span = self.since(start);
                let diagnostic =
                    Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, "a condition declares one variable with a value")
                        .help("write `bool name = ..`");
                Err(self.report_found(diagnostic))
            }
        }
    }

    fn while_statement(&mut self) -> Parse<StmtKind> {
        self.bump();
        let from = self.n_exprs();
        let condition = self.in_parens(|this| this.condition())?;
        let condition = condition.unwrap_or_else(|| {
            let pieces = self.broken_expr(from, self.previous.span);
            Condition::Expr(pieces)
        });
        let names = std::mem::take(&mut self.declaring);
        let body = Box::new(self.statement());
        if !names.is_empty() && matches!(condition, Condition::Expr(_)) {
            // The body may use what the broken condition declares.
            return Ok(StmtKind::Error);
        }
        Ok(StmtKind::While { condition, body })
    }

    fn do_statement(&mut self) -> Parse<StmtKind> {
        let opening = self.bump();
        let body = Box::new(self.statement());
        if self.leaving_function {
            return Err(Reported);
        }
        if self.eat(TokenKind::While).is_none() {
            let found = self.describe(self.current);
            let diagnostic = Diagnostic::new(
                &codes::UNEXPECTED_TOKEN,
                self.current.span,
                format!("expected `while` after the body of the `do`, found {found}"),
            )
            .label(opening.span, "the `do`");
            return Err(self.report_found(diagnostic));
        }
        let condition = self.condition_in_parens()?;
        self.semicolon("the `do` loop")?;
        Ok(StmtKind::DoWhile { body, condition })
    }

    fn jump(&mut self, kind: StmtKind, name: &str) -> Parse<StmtKind> {
        self.bump();
        self.semicolon(name)?;
        Ok(kind)
    }

    fn return_statement(&mut self) -> Parse<StmtKind> {
        self.bump();
        // A `return` whose `;` is missing does not return what is on the next line if that is not an expression.
        let next = self.taken.len();
        let value = match self.kind() {
            TokenKind::Semicolon | TokenKind::RightBrace => None,
            _ if self.certainly_begins(next) => None,
            _ => Some(self.expression()?),
        };
        self.semicolon("`return`")?;
        Ok(StmtKind::Return(value))
    }
}

fn is_one_initialized(variables: &VariableDecl) -> bool {
    matches!(variables.declarators.as_slice(), [one] if one.initializer.is_some() && one.array.is_empty())
}
