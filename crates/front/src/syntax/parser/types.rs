//! Parses qualifiers, types, structs and their members (GLSL 1.50 §4, §9).

use super::place::Start;
use super::{Between, Parse, Parser, Reported, Token, TokenKind, TokenSource, codes};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::language::Extensions;
use crate::source::Span;
use crate::syntax::ast::{
    ArrayDim, Declarator, ExprId, ExprKind, LayoutId, MemberDecl, Qualifier, QualifierKind, StructSpec, TypeBase,
    TypeSpec,
};
use crate::syntax::keywords::{Keyword, TABLE};
use crate::syntax::of_later_word;

/// The qualifier that a token kind is by itself.
pub(super) fn qualifier(kind: TokenKind) -> Option<QualifierKind> {
    Some(match kind {
        TokenKind::Const => QualifierKind::Const,
        TokenKind::Attribute => QualifierKind::Attribute,
        TokenKind::Varying => QualifierKind::Varying,
        TokenKind::In => QualifierKind::In,
        TokenKind::Out => QualifierKind::Out,
        TokenKind::Inout => QualifierKind::Inout,
        TokenKind::Uniform => QualifierKind::Uniform,
        TokenKind::Centroid => QualifierKind::Centroid,
        TokenKind::Sample => QualifierKind::Sample,
        TokenKind::Smooth => QualifierKind::Smooth,
        TokenKind::Flat => QualifierKind::Flat,
        TokenKind::Noperspective => QualifierKind::Noperspective,
        TokenKind::Invariant => QualifierKind::Invariant,
        TokenKind::Precise => QualifierKind::Precise,
        TokenKind::Highp => QualifierKind::Highp,
        TokenKind::Mediump => QualifierKind::Mediump,
        TokenKind::Lowp => QualifierKind::Lowp,
        _ => return None,
    })
}

/// Whether it is `lowp`, `mediump` or `highp`.
pub(super) fn is_precision(kind: &QualifierKind) -> bool {
    matches!(kind, QualifierKind::Lowp | QualifierKind::Mediump | QualifierKind::Highp)
}

/// Whether it is a storage qualifier of global variables and blocks.
fn is_of_global(kind: TokenKind) -> bool {
    use TokenKind::*;
    matches!(kind, Const | Uniform | In | Out | Attribute | Varying)
}

/// Whether a token begins a qualifier.
pub(super) fn is_qualifier(kind: TokenKind) -> bool {
    kind == TokenKind::Layout || qualifier(kind).is_some()
}

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Qualifiers in any number and order; the analysis knows which may be combined.
    pub(super) fn qualifiers(&mut self) -> Parse<Vec<Qualifier>> {
        let mut list = Vec::new();
        loop {
            let start = self.start();
            self.correct_block();
            if let Some(kind) = qualifier(self.kind()) {
                self.bump();
                list.push(Qualifier { kind, span: start.span });
            } else if self.is_next_layout(&list) {
                return Ok(list);
            } else if self.kind() == TokenKind::Layout || self.is_later_layout() {
                let kind = QualifierKind::Layout(self.layout()?);
                list.push(Qualifier { kind, span: self.since(start) });
            } else if self.is_foreign_qualifier() || self.is_storage_block() {
                let _: Reported = self.foreign();
            } else if self.is_reserved_qualifier() {
                let token = self.current;
                self.report_reserved_qualifier(token);
                self.bump();
            } else if self.is_unknown_qualifier() {
                list.extend(self.unknown_qualifier().map(|kind| Qualifier { kind, span: start.span }));
            } else {
                return Ok(list);
            }
        }
    }

    /// Whether the next line begins a declaration of its own, `layout(..) out`, behind qualifiers that lack their `;`: `layout(..) in`.
    fn is_next_layout(&mut self, list: &[Qualifier]) -> bool {
        use TokenKind::{In, LeftParen, Out, RightParen, Uniform};
        let is_storage =
            |kind: &QualifierKind| matches!(kind, QualifierKind::In | QualifierKind::Out | QualifierKind::Uniform);
        let is_whole = matches!(list, [.., layout, storage]
            if matches!(layout.kind, QualifierKind::Layout(_)) && is_storage(&storage.kind));
        if !is_whole || self.kind() != TokenKind::Layout || !self.current.starts_line() {
            return false;
        }
        let behind = self.past_bracket(1, LeftParen, RightParen);
        matches!(self.ahead(behind).kind, In | Out | Uniform)
    }

    /// Reports qualifiers behind the type, as in `vec3 in n`, and reads them as if they were in front of it.
    pub(super) fn late_qualifiers(&mut self, list: &mut Vec<Qualifier>, start: Start, ty: &TypeSpec) -> Parse<()> {
        let behind = match self.kind() {
            TokenKind::Layout if self.ahead(1).kind == TokenKind::LeftParen => {
                let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
                self.ahead(behind)
            }
            kind if qualifier(kind).is_some() => self.ahead(1),
            _ => return Ok(()),
        };
        // What begins the next line is a declaration of its own, and one without a name behind it is a name.
        let is_late = (behind.kind == TokenKind::Ident || is_qualifier(behind.kind)) && !behind.starts_line();
        if self.current.starts_line() || !is_late {
            return Ok(());
        }
        let first = self.start();
        list.extend(self.qualifiers()?);
        let snippet = |span| self.session.sources.snippet(span).to_owned();
        let (words, name) = (snippet(self.since(first)), snippet(ty.span));
        let help = match ty.base {
            TypeBase::Struct(_) => Advice::from("write it before the type"),
            _ if self.since(start).expansion.is_some() => Advice::from("write it before the type"),
            _ => Advice::write(Applicability::Safe, format!("{words} {name}")),
        };
        let diagnostic =
            Diagnostic::new(&codes::UNEXPECTED_TOKEN, self.since(start), format!("`{words}` is behind the type"))
                .here("qualifiers come before the type")
                .help(help);
        self.session.report(diagnostic);
        Ok(())
    }

    /// A name where only a qualifier makes sense, such as `coherent` in `coherent uniform float x`.
    pub(super) fn is_unknown_qualifier(&mut self) -> bool {
        if self.kind() != TokenKind::Ident {
            return false;
        }
        let next = self.ahead(1);
        let declares = is_qualifier(next.kind) || matches!(next.kind, TokenKind::Type | TokenKind::Void);
        // What begins the next line may be a declaration of its own, after an unfinished one.
        declares && !next.starts_line()
    }

    /// Whether a qualifier of later versions is next, before a type: `highp float x` in GLSL 1.10.
    pub(super) fn is_later_qualifier(&mut self) -> bool {
        let is_word = |row: &Keyword, word: &str| row.spelling == word && is_qualifier(row.kind);
        self.is_unknown_qualifier() && TABLE.iter().any(|row| is_word(row, self.session.spelling(self.current)))
    }

    /// A reserved word where only a qualifier makes sense, such as `static` in `static float x`.
    fn is_reserved_qualifier(&mut self) -> bool {
        if self.kind() != TokenKind::Reserved || self.is_unsigned_int() {
            return false;
        }
        let next = self.ahead(1).kind;
        is_qualifier(next) || matches!(next, TokenKind::Type | TokenKind::Void | TokenKind::Struct)
    }

    fn report_reserved_qualifier(&mut self, token: Token) {
        let name = self.session.spelling(token).to_owned();
        let message = format!("the reserved word `{name}` is not a qualifier");
        let help = match name.as_str() {
            "attribute" => Some("write `in`; versions before GLSL ES 3.00 have `attribute`"),
            "varying" => Some(
                "write `out` in a vertex shader and `in` in a fragment shader; versions before GLSL ES 3.00 have `varying`",
            ),
            _ => None,
        };
        let help = help.filter(|_| self.session.version.is_es());
        let finding = Diagnostic::new(&codes::RESERVED_WORD, token.span, message).maybe_help(help.map(str::to_owned));
        self.session.report(of_later_word(finding, &name, self.session.version));
    }

    /// `layout(..) in` where `layout` is no keyword yet. The analysis knows which version has what is in the parentheses.
    pub(super) fn is_later_layout(&mut self) -> bool {
        let is_word = matches!(self.kind(), TokenKind::Ident | TokenKind::Reserved)
            && self.ahead(1).kind == TokenKind::LeftParen
            && self.session.spelling(self.current) == "layout";
        if !is_word {
            return false;
        }
        let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
        let next = self.ahead(behind).kind;
        is_qualifier(next) || matches!(next, TokenKind::Type | TokenKind::Void)
    }

    /// layout_qualifier
    fn layout(&mut self) -> Parse<Vec<LayoutId>> {
        self.bump();
        let opening = self.expect(TokenKind::LeftParen)?;
        let mut ids = Vec::new();
        loop {
            // Outside `layout(..)`, `packed` and `row_major` are reserved words, and `shared` is one of compute shaders from 4.30 on.
            let is_shared = self.kind() == TokenKind::Foreign && self.session.spelling(self.current) == "shared";
            if !is_shared && !matches!(self.kind(), TokenKind::Ident | TokenKind::Reserved) {
                return Err(self.unexpected("the name of a layout"));
            }
            let token = self.bump();
            let name = crate::syntax::ast::Ident { symbol: token.symbol(), span: token.span };
            let has_value = self.eat(TokenKind::Equal).is_some();
            let parenthesized = has_value && self.kind() == TokenKind::LeftParen;
            let value = if has_value { Some(self.constant_expression()?) } else { None };
            ids.push(LayoutId { name, value, parenthesized });
            if self.eat(TokenKind::Comma).is_none() {
                break;
            }
        }
        self.close(opening, TokenKind::RightParen, "`,` or `)`")?;
        Ok(ids)
    }

    /// type_specifier_no_prec
    pub(super) fn type_specifier(&mut self) -> Parse<TypeSpec> {
        let (token, start) = (self.current, self.start());
        let base = match token.kind {
            TokenKind::Void => {
                self.bump();
                TypeBase::Void
            }
            TokenKind::Type => {
                self.bump();
                TypeBase::Keyword(token.symbol())
            }
            TokenKind::Unsigned => self.unsigned(),
            TokenKind::Foreign => {
                let _: Reported = self.foreign();
                TypeBase::Error
            }
            TokenKind::Ident => {
                self.note_later_statement();
                TypeBase::Named(self.ident("a type")?)
            }
            TokenKind::Reserved if self.is_unsigned_int() => self.reserved_unsigned(),
            TokenKind::Reserved => {
                self.report_reserved_type();
                TypeBase::Error
            }
            TokenKind::Struct => TypeBase::Struct(self.nested(Self::struct_specifier)?),
            _ => return Err(self.unexpected("a type")),
        };
        let array = self.array_specifiers()?;
        Ok(TypeSpec { base, array, span: self.since(start) })
    }

    /// Reports `precision mediump float` and its like where the version is missing: two names before a keyword for a type are
    /// nothing else.
    fn note_later_statement(&mut self) {
        if self.ahead(1).kind == TokenKind::Ident && self.ahead(2).kind == TokenKind::Type {
            let (word, span) = (self.session.spelling(self.current).to_owned(), self.current.span);
            let finding = Diagnostic::new(&codes::UNEXPECTED_TOKEN, span, "");
            let finding = of_later_word(finding, &word, self.session.version);
            if finding.code.id != codes::UNEXPECTED_TOKEN.id {
                self.session.report(finding);
            }
        }
    }

    /// `unsigned int`, which GL_EXT_gpu_shader4 spells as C does.
    fn unsigned(&mut self) -> TypeBase {
        self.bump();
        if self.kind() == TokenKind::Type && self.session.spelling(self.current) == "int" {
            self.bump();
        }
        TypeBase::Keyword(self.session.names.intern("uint"))
    }

    /// Whether `unsigned int` is next, in a language that has `uint`.
    fn is_unsigned_int(&mut self) -> bool {
        let next = self.ahead(1);
        self.session.spelling(self.current) == "unsigned"
            && next.kind == TokenKind::Type
            && self.session.spelling(next) == "int"
            && TABLE.iter().any(|row| {
                row.spelling == "uint" && row.kind_in(self.session.version, Extensions::empty()) == TokenKind::Type
            })
    }

    /// Reports `unsigned int` of C, and reads it as the `uint` that is meant.
    fn reserved_unsigned(&mut self) -> TypeBase {
        let start = self.start();
        let base = self.unsigned();
        let message = "`unsigned int` has another name in GLSL";
        let help = Advice::write(Applicability::Safe, "uint");
        let diagnostic = Diagnostic::new(&codes::RESERVED_WORD, self.since(start), message);
        self.session.report(diagnostic.here("reserved for later versions").help(help));
        base
    }

    /// Reports a reserved word used as a type, at each use, since no declaration can make it right.
    fn report_reserved_type(&mut self) {
        let token = self.bump();
        let name = self.session.spelling(token).to_owned();
        let help = match name.as_str() {
            "double" | "half" | "fixed" => Some("float"),
            "long" | "short" => Some("int"),
            "unsigned" => Some("uint"),
            _ => None,
        };
        let diagnostic = Diagnostic::new(
            &codes::RESERVED_WORD,
            token.span,
            format!("the reserved word `{name}` is not a type in this version"),
        )
        .here("reserved for later versions")
        .maybe_help(help.map(|word| Advice::write(Applicability::Unsafe, word)));
        self.session.report(of_later_word(diagnostic, &name, self.session.version));
    }

    /// `[n]`, `[]`, any number of them
    pub(super) fn array_specifiers(&mut self) -> Parse<Vec<ArrayDim>> {
        let mut dims = Vec::new();
        while self.kind() == TokenKind::LeftBracket {
            let start = self.start();
            let opening = self.bump();
            let size = if self.kind() == TokenKind::RightBracket { None } else { Some(self.constant_expression()?) };
            self.close(opening, TokenKind::RightBracket, "`]` or an operator")?;
            dims.push(ArrayDim { size, span: self.since(start) });
            if dims.len() > super::MAX_NESTING as usize {
                return Err(self.too_deep(opening.span));
            }
        }
        Ok(dims)
    }

    /// struct_specifier
    fn struct_specifier(&mut self) -> Parse<StructSpec> {
        self.bump();
        let name = if self.kind() == TokenKind::LeftBrace { None } else { Some(self.ident("the name of a struct")?) };
        let members = self.member_list()?;
        Ok(StructSpec { name, members })
    }

    /// The `{` of a struct or a block. A missing one before members and their `}` is reported and assumed.
    fn opening_brace(&mut self) -> Parse<Span> {
        let is_lost = self.begins_member(0) && self.before_lost_brace(0) == Some(Between::Declarations);
        if !is_lost {
            return self.expect(TokenKind::LeftBrace).map(|token| token.span);
        }
        let at = self.behind();
        let diagnostic = Diagnostic::new(&codes::UNEXPECTED_TOKEN, at, "`{` is missing before the members")
            .here("expected `{`")
            .help(Advice::new(Applicability::Unsafe, "write `{` here", Place::Before, " {"));
        self.session.report(diagnostic);
        self.braces += 1;
        Ok(at)
    }

    /// Whether a line that begins with a token begins a member.
    pub(super) fn begins_member(&mut self, at: usize) -> bool {
        let first = self.ahead(at);
        let is_type = matches!(first.kind, TokenKind::Type | TokenKind::Ident);
        first.starts_line() && (is_type && self.ahead(at + 1).kind == TokenKind::Ident || is_qualifier(first.kind))
    }

    /// Whether a function or a uniform begins where a member may, though braces are missing.
    fn begins_global_in_members(&mut self) -> bool {
        let begins = match self.kind() {
            TokenKind::Type | TokenKind::Void | TokenKind::Ident => {
                self.ahead(1).kind == TokenKind::Ident && self.ahead(2).kind == TokenKind::LeftParen
            }
            TokenKind::Layout if self.ahead(1).kind == TokenKind::LeftParen => {
                let behind = self.past_bracket(1, TokenKind::LeftParen, TokenKind::RightParen);
                is_of_global(self.ahead(behind).kind)
            }
            kind => is_of_global(kind),
        };
        begins && self.current.starts_line() && !self.braces_are_paired()
    }

    /// Reports members whose `}` is missing before something global, and goes on as if it and its `;` were there.
    fn unclosed_members(&mut self, opening: Span) -> Reported {
        let at = self.behind();
        let diagnostic = Diagnostic::new(&codes::UNCLOSED_DELIMITER, opening, "`{` is not closed")
            .here("this brace is never closed")
            .label(at, "what is behind this is global");
        self.session.report(diagnostic);
        self.braces -= 1;
        self.assumed_semicolon = true;
        Reported
    }

    /// struct_declaration_list, in its braces
    pub(super) fn member_list(&mut self) -> Parse<Vec<MemberDecl>> {
        let opening = self.opening_brace()?;
        let mut members = Vec::new();
        while self.kind() != TokenKind::RightBrace {
            if self.kind() == TokenKind::Eof {
                return Err(self.unclosed_brace(opening));
            }
            if self.begins_global_in_members() {
                let _: Reported = self.unclosed_members(opening);
                return Ok(members);
            }
            let before = self.mark();
            self.taken.clear();
            let start = self.start();
            let mut named = Vec::new();
            match self.nested(|this| this.member(&mut named)) {
                Ok(member) => members.push(member),
                Err(_) => {
                    self.recover_statement(before);
                    members.extend(self.broken_member(start, named));
                }
            }
        }
        self.bump();
        Ok(members)
    }

    /// struct_declaration
    fn member(&mut self, named: &mut Vec<Declarator>) -> Parse<MemberDecl> {
        let start = self.start();
        let mut qualifiers = self.qualifiers()?;
        let type_start = self.start();
        let ty = self.type_specifier()?;
        self.late_qualifiers(&mut qualifiers, type_start, &ty)?;
        loop {
            self.member_declarator(named)?;
            if self.eat(TokenKind::Comma).is_none() || self.ends_at_comma(&ty) {
                break;
            }
        }
        self.semicolon("the member")?;
        let declarators = std::mem::take(named);
        Ok(MemberDecl { qualifiers, ty, declarators, span: self.since(start) })
    }

    /// The understood part of a member that has an error: its names.
    fn broken_member(&self, start: Start, declarators: Vec<Declarator>) -> Option<MemberDecl> {
        let span = self.since(start);
        let ty = TypeSpec { base: TypeBase::Error, array: Vec::new(), span };
        (!declarators.is_empty()).then_some(MemberDecl { qualifiers: Vec::new(), ty, declarators, span })
    }

    /// Reads a declarator. Its name is known, too, if the rest is broken.
    fn member_declarator(&mut self, named: &mut Vec<Declarator>) -> Parse<()> {
        let name = self.ident("the name of a member")?;
        named.push(Declarator { name, array: Vec::new(), initializer: None });
        let array = self.array_specifiers()?;
        if let Some(last) = named.last_mut() {
            last.array = array;
        }
        let equal = self.start();
        if self.eat(TokenKind::Equal).is_some() {
            self.initializer()?;
            let span = self.since(equal);
            let message = format!("the member `{}` has an initializer", self.session.names.spelling(name.symbol));
            self.report(&codes::MEMBER_INITIALIZER, span, message);
        }
        Ok(())
    }

    /// initializer, including the lists of 420pack; the analysis knows whether the language has them
    pub(super) fn initializer(&mut self) -> Parse<ExprId> {
        if self.kind() != TokenKind::LeftBrace {
            return self.assignment_expression();
        }
        self.initializer_list()
    }

    fn initializer_list(&mut self) -> Parse<ExprId> {
        self.nested(|this| {
            let start = this.start();
            let opening = this.bump();
            let mut items = Vec::new();
            while this.kind() != TokenKind::RightBrace {
                let item = match this.kind() {
                    TokenKind::LeftBrace => this.initializer_list()?,
                    _ => this.assignment_expression()?,
                };
                items.push(item);
                if this.eat(TokenKind::Comma).is_none() {
                    break;
                }
            }
            this.close(opening, TokenKind::RightBrace, "`,` or `}`")?;
            this.push(ExprKind::List(items), start)
        })
    }
}
