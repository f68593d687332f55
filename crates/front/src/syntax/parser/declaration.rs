//! Parses declarations, global and local (GLSL 1.50 §4, §6.1, §9).

use super::place::Start;
use super::types::{is_precision, is_qualifier};
use super::{Between, Parse, Parser, Reported, Token, TokenKind, TokenSource, codes};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::language::Feature;
use crate::syntax::ast::{
    BlockDecl, Declaration, DeclarationKind, Declarator, FunctionHeader, Ident, ParamDecl, Qualifier, Stmt, TypeBase,
    TypeSpec, VariableDecl,
};
use crate::syntax::{kind, of_later_word};

/// How many tokens the parser looks ahead to tell a declaration from an expression. Without a bound, a text that
/// never closes its brackets would be searched to its end from each statement.
const MAX_AHEAD: usize = 1024;
/// How many tokens a function may have for its forgotten `{` to be found.
pub(super) const MAX_BODY: usize = 1 << 16;

impl<T: TokenSource> Parser<'_, '_, T> {
    /// external_declaration
    pub(super) fn external_declaration(&mut self) {
        // Braces that close nothing, or that nothing closes, are none of the next declaration.
        self.braces = 0;
        let (first, start) = (self.current, self.start());
        let before = self.mark();
        self.begin();
        let kind = match self.kind() {
            TokenKind::Semicolon => {
                let span = self.bump().span;
                if !self.session.version.has(Feature::EmptyDeclarations) {
                    let message = "a lone `;` at global scope";
                    let advice = Advice::new(Applicability::Safe, "leave it out", Place::Over, "");
                    let diagnostic = kind::STRAY_SEMICOLON.diagnostic(self.strict, span, message).help(advice);
                    self.session.report(diagnostic);
                }
                Ok(DeclarationKind::Empty)
            }
            TokenKind::RightBrace => {
                self.stray_brace();
                return;
            }
            _ => self.global(),
        };
        let kind = kind.unwrap_or_else(|_: Reported| {
            self.recover_declaration(before);
            self.name_skipped();
            self.name_members();
            let fragment = self.fragment(before, start.span);
            DeclarationKind::Broken(Box::new(fragment))
        });
        let span = self.since(start);
        // A line in the body of a function turns an extension on from there.
        let extensions = self.session.extensions_at(first) | self.session.extensions_at(self.previous);
        self.ast.declarations.push(Declaration { kind, span, extensions });
    }

    /// Handles a stray `}`. If an opening brace was assumed before, this one may be its partner.
    fn stray_brace(&mut self) {
        let span = self.bump().span;
        if !std::mem::take(&mut self.assumed_brace) {
            let diagnostic =
                Diagnostic::new(&codes::STRAY_DELIMITER, span, "`}` closes nothing").here("no brace is open here");
            self.session.report(diagnostic);
        }
    }

    fn global(&mut self) -> Parse<DeclarationKind> {
        self.correct_layout();
        if self.kind() == TokenKind::Ident && !self.begins_named_declaration() {
            return Err(self.missing_type());
        }
        let kind = self.declaration()?;
        if let (DeclarationKind::Prototype(_), TokenKind::LeftBrace) = (&kind, self.kind()) {
            let DeclarationKind::Prototype(header) = kind else { return Err(Reported) };
            return self.function_definition(header);
        }
        if matches!(kind, DeclarationKind::Prototype(_))
            && self.kind() != TokenKind::Semicolon
            && self.before_lost_brace(0).is_some()
        {
            let DeclarationKind::Prototype(header) = kind else { return Err(Reported) };
            return Ok(self.function_without_brace(header));
        }
        if self.is_head(&kind) {
            return self.unknown_head(kind);
        }
        if !matches!(kind, DeclarationKind::Function(..))
            && let Err(reported) = self.semicolon("the declaration")
        {
            if let DeclarationKind::Variables(variables) = kind {
                self.unfinished = Some(variables);
            }
            return Err(reported);
        }
        Ok(kind)
    }

    /// Whether a name at the start of a declaration can be a type: a name or a block's brace follows, after any
    /// brackets.
    fn begins_named_declaration(&mut self) -> bool {
        let mut at = 1;
        while self.ahead(at).kind == TokenKind::LeftBracket {
            at = self.past_bracket(at, TokenKind::LeftBracket, TokenKind::RightBracket);
        }
        let token = self.ahead(at);
        match token.kind {
            TokenKind::Ident | TokenKind::Reserved => true,
            // A lone type, `S;`. The analysis knows whether `S` is a type.
            TokenKind::Semicolon => true,
            TokenKind::LeftBrace => at == 1,
            // A missing name after a type is reported later.
            _ => self.is_unknown_qualifier() || self.is_later_layout(),
        }
    }

    /// The index after the bracket that closes the one at `at`. If nothing closes it, the index of what shows that:
    /// the end of a statement, or [`MAX_AHEAD`] tokens.
    pub(super) fn past_bracket(&mut self, mut at: usize, open: TokenKind, close: TokenKind) -> usize {
        let mut depth = 0_usize;
        loop {
            let kind = self.ahead(at).kind;
            if kind == TokenKind::Eof || at > MAX_AHEAD {
                return at;
            }
            at += 1;
            if kind == open {
                depth += 1;
            } else if kind == close {
                depth -= 1;
                if depth == 0 {
                    return at;
                }
            } else if matches!(kind, TokenKind::Semicolon | TokenKind::LeftBrace | TokenKind::RightBrace) {
                return at - 1;
            }
        }
    }

    fn missing_type(&mut self) -> Reported {
        let name = self.session.spelling(self.current).to_owned();
        let (message, help) = match self.ahead(1).kind {
            TokenKind::LeftParen => (
                format!("expected a declaration, found `{name}(`"),
                format!(
                    "a function begins with its return type: write `void {name}(..)`; a call must be inside a function"
                ),
            ),
            TokenKind::Comma => {
                (format!("`{name}` is declared without a type"), format!("write a type before `{name}`"))
            }
            _ => (
                format!("expected a declaration, found `{name}`"),
                format!("write a type before `{name}` to declare it; statements belong inside functions"),
            ),
        };
        let span = self.current.span;
        let diagnostic = Diagnostic::new(&codes::MISSING_TYPE, span, message).help(help);
        self.session.report(of_later_word(diagnostic, &name, self.session.version));
        Reported
    }

    /// function_definition, after its header
    pub(super) fn function_definition(&mut self, header: FunctionHeader) -> Parse<DeclarationKind> {
        self.function_brace = self.current.span;
        let body: Vec<Stmt> = self.compound_statement();
        self.leaving_function = false;
        Ok(DeclarationKind::Function(header, body))
    }

    /// function_definition without its `{`, which is reported and assumed.
    fn function_without_brace(&mut self, header: FunctionHeader) -> DeclarationKind {
        let at = self.behind();
        let diagnostic =
            Diagnostic::new(&codes::UNEXPECTED_TOKEN, at, "`{` is missing before the body of the function")
                .here("expected `{`")
                .help(Advice::new(Applicability::Unsafe, "write `{` here", Place::Before, " {"));
        let _: Reported = self.report_found(diagnostic);
        self.function_brace = at;
        self.braces += 1;
        let body = self.rest_of_compound(at);
        self.leaving_function = false;
        DeclarationKind::Function(header, body)
    }

    /// declaration, without its `;`
    pub(super) fn declaration(&mut self) -> Parse<DeclarationKind> {
        if self.kind() == TokenKind::Precision {
            return self.precision();
        }
        if let Some(reported) = self.definition_of_type() {
            return Err(reported);
        }
        let start = self.start();
        let qualifiers = self.qualifiers()?;
        if !qualifiers.is_empty() {
            match (self.kind(), self.ahead(1).kind) {
                (TokenKind::Semicolon | TokenKind::Layout, _) => {
                    return Ok(DeclarationKind::Requalify { qualifiers, names: Vec::new() });
                }
                (TokenKind::Ident, TokenKind::Comma | TokenKind::Semicolon) => return self.requalify(qualifiers),
                (TokenKind::Ident, TokenKind::Equal) => {
                    let name = Ident { symbol: self.current.symbol(), span: self.current.span };
                    let reported = self.missing_type();
                    self.declaring.push(name);
                    return Err(reported);
                }
                _ => {}
            }
        }
        if self.kind() == TokenKind::Ident
            && (self.ahead(1).kind == TokenKind::LeftBrace || self.lacks_brace(&qualifiers))
        {
            return self.block(qualifiers);
        }
        let mut qualifiers = qualifiers;
        if self.kind() == TokenKind::LeftBrace && !qualifiers.is_empty() {
            return Err(self.nameless_block());
        }
        let type_start = self.start();
        let ty = self.type_specifier()?;
        self.late_qualifiers(&mut qualifiers, type_start, &ty)?;
        if matches!(self.kind(), TokenKind::Semicolon) || self.forgot_semicolon(&ty) {
            return Ok(DeclarationKind::Variables(VariableDecl { qualifiers, ty, declarators: Vec::new() }));
        }
        // The grammar lets a list begin with the type alone: `float, a = 0.0;` (§9, init_declarator_list).
        if self.kind() == TokenKind::Comma
            && matches!(ty.base, TypeBase::Keyword(_) | TypeBase::Struct(_))
            && self.ahead(1).kind == TokenKind::Ident
        {
            self.bump();
        }
        let name = self.ident("a name")?;
        if self.kind() == TokenKind::LeftParen {
            // If the header is broken, the name is known all the same.
            self.declaring.push(name);
            let header = self.function_header(start, qualifiers, ty, name)?;
            self.declaring.clear();
            return Ok(DeclarationKind::Prototype(header));
        }
        let mut declarators = Vec::new();
        let done = self.declarators(name, &ty, &mut declarators);
        let variables = VariableDecl { qualifiers, ty, declarators };
        if let Err(reported) = done {
            self.unfinished = Some(variables);
            return Err(reported);
        }
        Ok(DeclarationKind::Variables(variables))
    }

    /// Reports `typedef vec4 color;` or `using namespace glm;`, and reads it up to its name, which is known all the same.
    fn definition_of_type(&mut self) -> Option<Reported> {
        let word = self.session.spelling(self.current).to_owned();
        if self.kind() != TokenKind::Reserved || !matches!(word.as_str(), "typedef" | "using") {
            return None;
        }
        let message = format!("the reserved word `{word}` begins no declaration");
        let help = match word.as_str() {
            "typedef" => "a macro can be another name of a type: `#define color vec4`",
            _ => "leave it out: GLSL has no namespaces",
        };
        let diagnostic = Diagnostic::new(&codes::RESERVED_WORD, self.current.span, message)
            .here("reserved for later versions")
            .help(help);
        let reported = self.report_found(diagnostic);
        self.bump();
        if word == "typedef" && self.type_specifier().is_ok() && self.kind() == TokenKind::Ident {
            let name = self.bump();
            self.declaring.push(Ident { symbol: name.symbol(), span: name.span });
        }
        Some(reported)
    }

    /// Whether what follows the `}` of a struct cannot be a variable, so that a `;` must be missing.
    fn forgot_semicolon(&mut self, ty: &TypeSpec) -> bool {
        let begins = |kind| is_qualifier(kind) || matches!(kind, TokenKind::Type | TokenKind::Void | TokenKind::Struct);
        // In `Ray make(..)`, the first name is a type.
        let names = |this: &mut Self| this.kind() == TokenKind::Ident && this.ahead(1).kind == TokenKind::Ident;
        matches!(ty.base, TypeBase::Struct(_)) && self.current.starts_line() && (begins(self.kind()) || names(self))
    }

    /// `precision highp float`
    fn precision(&mut self) -> Parse<DeclarationKind> {
        self.bump();
        let mut qualifiers = self.qualifiers()?;
        let wrong = qualifiers.iter().find(|one| !is_precision(&one.kind)).map(|one| one.span);
        if let Some(span) = wrong.or(qualifiers.get(1).map(|second| second.span)) {
            let word = self.session.sources.snippet(span).to_owned();
            let message = format!("expected one of `lowp`, `mediump` and `highp` after `precision`, found `{word}`");
            let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, message).here("not a precision");
            return Err(self.report_found(diagnostic));
        }
        let Some(qualifier) = qualifiers.pop() else {
            return Err(self.unexpected("`lowp`, `mediump` or `highp` after `precision`"));
        };
        let ty = self.type_specifier()?;
        Ok(DeclarationKind::Precision { qualifier, ty })
    }

    fn requalify(&mut self, qualifiers: Vec<Qualifier>) -> Parse<DeclarationKind> {
        let mut names = vec![self.ident("the name of a variable")?];
        while self.eat(TokenKind::Comma).is_some() {
            names.push(self.ident("the name of a variable")?);
        }
        Ok(DeclarationKind::Requalify { qualifiers, names })
    }

    /// Whether a block is next whose `{` is missing: `uniform Light`, and members on the lines below it.
    fn lacks_brace(&mut self, qualifiers: &[Qualifier]) -> bool {
        self.braces == 0
            && !self.in_parameters
            && !qualifiers.is_empty()
            && self.begins_member(1)
            && self.before_lost_brace(1) == Some(Between::Declarations)
    }

    /// An interface block (§4.3.7).
    fn block(&mut self, qualifiers: Vec<Qualifier>) -> Parse<DeclarationKind> {
        let name = self.ident("the name of a block")?;
        if qualifiers.is_empty() {
            let message = format!("the block `{}` has no storage qualifier", self.session.names.spelling(name.symbol));
            let diagnostic = Diagnostic::new(&codes::MISSING_BLOCK_QUALIFIER, name.span, message)
                .here("there is no `uniform`, `in` or `out` before it");
            self.session.report(diagnostic);
        }
        let members = self.member_list()?;
        let mut instance = None;
        if self.kind() == TokenKind::Ident {
            let name = self.ident("the name of an instance")?;
            instance = Some((name, self.array_specifiers()?));
            if self.kind() == TokenKind::Comma {
                self.declaring.push(name);
                return Err(self.second_instance());
            }
        }
        if qualifiers.is_empty() {
            return Ok(DeclarationKind::Error);
        }
        Ok(DeclarationKind::Block(BlockDecl { qualifiers, name, members, instance }))
    }

    /// Reports `B {..} b, d;`, and reads the names.
    fn second_instance(&mut self) -> Reported {
        let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, "a block has one instance")
            .here("expected `;`")
            .help("write an array of instances, such as `b[2]`, or declare another block");
        let reported = self.report_found(diagnostic);
        while self.eat(TokenKind::Comma).is_some() && self.kind() == TokenKind::Ident {
            let name = self.bump();
            self.declaring.push(Ident { symbol: name.symbol(), span: name.span });
        }
        reported
    }

    /// Reports a block without a name, and reads it. The names that it declares are known all the same.
    fn nameless_block(&mut self) -> Reported {
        let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, "the block has no name")
            .here("expected the name of a block");
        let reported = self.report_found(diagnostic);
        let Ok(members) = self.member_list() else { return reported };
        if self.kind() == TokenKind::Ident {
            let instance = self.bump();
            self.declaring.push(Ident { symbol: instance.symbol(), span: instance.span });
        } else {
            self.declaring.extend(members.iter().flat_map(|member| &member.declarators).map(|one| one.name));
        }
        reported
    }

    /// init_declarator_list, from its first name on
    fn declarators(&mut self, first: Ident, ty: &TypeSpec, list: &mut Vec<Declarator>) -> Parse<()> {
        self.declarator(first, list)?;
        while self.eat(TokenKind::Comma).is_some() {
            if matches!(self.kind(), TokenKind::Int | TokenKind::Uint | TokenKind::Float) {
                let found = self.describe(self.current);
                let message = format!("expected the name of a variable, found {found}");
                let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, message)
                    .here("expected the name of a variable")
                    .help("several values belong into a constructor, such as `vec2(1.0, 2.0)`");
                return Err(self.report_found(diagnostic));
            }
            if self.ends_at_comma(ty) {
                break;
            }
            let name = self.ident("the name of a variable")?;
            self.declarator(name, list)?;
        }
        Ok(())
    }

    /// Reads a declarator. One whose initializer is broken is kept without it.
    fn declarator(&mut self, name: Ident, list: &mut Vec<Declarator>) -> Parse<()> {
        self.declaring.push(name);
        let array = self.array_specifiers()?;
        let value = if self.eat(TokenKind::Equal).is_some() { self.initializer().map(Some) } else { Ok(None) };
        let (initializer, done) = match value {
            Ok(initializer) => (initializer, Ok(())),
            Err(reported) => (None, Err(reported)),
        };
        list.push(Declarator { name, array, initializer });
        done
    }

    /// function_prototype, from its parentheses on
    fn function_header(
        &mut self,
        start: Start,
        qualifiers: Vec<Qualifier>,
        ty: TypeSpec,
        name: Ident,
    ) -> Parse<FunctionHeader> {
        let opening: Token = self.bump();
        self.in_parameters = true;
        let mut params = Vec::new();
        let read = self.parameters(&mut params);
        // Before a body, a forgotten `)` is reported and assumed.
        let body_follows = self.kind() == TokenKind::LeftBrace;
        let closed =
            if read.is_ok() { self.close(opening, TokenKind::RightParen, "`,` or `)`").map(|_| ()) } else { Ok(()) };
        let is_whole = read.is_ok() && closed.is_ok();
        let is_understood = is_whole || body_follows || self.body_follows_later();
        self.in_parameters = false;
        if !is_understood {
            return Err(Reported);
        }
        Ok(FunctionHeader { qualifiers, ty, name, params, is_whole, span: self.since(start) })
    }

    /// Skips the rest of a broken parameter list. Returns whether a body follows it: then the name and the body are understood.
    fn body_follows_later(&mut self) -> bool {
        self.recover_header() && self.kind() == TokenKind::LeftBrace
    }

    fn parameters(&mut self, params: &mut Vec<ParamDecl>) -> Parse<()> {
        if self.kind() == TokenKind::Void && self.ahead(1).kind == TokenKind::RightParen {
            self.bump();
        }
        if !matches!(self.kind(), TokenKind::RightParen | TokenKind::LeftBrace) {
            params.push(self.parameter()?);
            while self.another_parameter()? {
                params.push(self.parameter()?);
            }
        }
        Ok(())
    }

    /// Reads the comma before another parameter. A missing comma before the start of a parameter is reported and
    /// assumed, unless the error is that the list was left unfinished on a line before.
    fn another_parameter(&mut self) -> Parse<bool> {
        if self.eat(TokenKind::Comma).is_some() {
            return Ok(true);
        }
        let forgotten = matches!(self.kind(), TokenKind::Type | TokenKind::Struct) || is_qualifier(self.kind());
        if forgotten {
            let before = self.consumed;
            let reported = self.unexpected("`,` or `)`");
            if self.consumed < before {
                return Err(reported);
            }
        }
        Ok(forgotten)
    }

    /// parameter_declaration
    fn parameter(&mut self) -> Parse<ParamDecl> {
        let start = self.start();
        let mut qualifiers = self.qualifiers()?;
        let type_start = self.start();
        let ty = self.type_specifier()?;
        self.late_qualifiers(&mut qualifiers, type_start, &ty)?;
        if matches!(self.kind(), TokenKind::Star | TokenKind::Ampersand) {
            let spelling = self.kind().spelling();
            let message = format!("`{spelling}` before a parameter: there are neither pointers nor references");
            let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.current.span, message)
                .here("expected the name of a parameter")
                .help("write `inout` before the type for a parameter that is changed");
            self.session.report(diagnostic);
            self.bump();
        }
        let named = !matches!(self.kind(), TokenKind::Comma | TokenKind::RightParen);
        let name = if named { Some(self.ident("the name of a parameter")?) } else { None };
        let array = self.array_specifiers()?;
        if let Some(equal) = self.eat(TokenKind::Equal) {
            let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, equal.span, "a parameter has no default value")
                .here("expected `,` or `)`")
                .help("overload the function");
            self.session.report(diagnostic);
            self.assignment_expression()?;
        }
        Ok(ParamDecl { qualifiers, ty, name, array, span: self.since(start) })
    }

    /// Whether a declaration begins here, where an expression might as well. Two names in a row are a declaration,
    /// brackets between them aside.
    pub(super) fn begins_declaration(&mut self) -> bool {
        match self.kind() {
            TokenKind::Struct | TokenKind::Precision | TokenKind::Void => true,
            TokenKind::Foreign => self.is_foreign_qualifier() || self.ahead(1).kind != TokenKind::LeftParen,
            TokenKind::Unsigned => true,
            TokenKind::Type => {
                let behind = self.behind_brackets();
                !matches!(behind, TokenKind::LeftParen | TokenKind::Dot)
            }
            TokenKind::Ident if self.is_later_qualifier() => true,
            TokenKind::Ident => matches!(self.behind_brackets(), TokenKind::Ident | TokenKind::Reserved),
            TokenKind::Reserved => {
                let next = self.ahead(1).kind;
                matches!(next, TokenKind::Ident | TokenKind::Type) || is_qualifier(next)
            }
            kind => is_qualifier(kind),
        }
    }

    /// The kind of the token after the next one and its `[..]`.
    fn behind_brackets(&mut self) -> TokenKind {
        let mut at = 1;
        while self.ahead(at).kind == TokenKind::LeftBracket {
            let end = self.past_bracket(at, TokenKind::LeftBracket, TokenKind::RightBracket);
            if end == at {
                break;
            }
            at = end;
        }
        self.ahead(at).kind
    }
}
