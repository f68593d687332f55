//! Macros: `#define`, `#undef`, and the predefined ones (GLSL 1.50 §3.3).

use super::definition::{Macro, Meaning};
use super::{
    Feature, ParseSession, Preprocessor, Profile, Span, Symbol, Token, TokenFlags, TokenKind, codes, kind, predefined,
    version,
};
use crate::diagnostic::codes::qualifiers::NEEDS_EXTENSION;
use crate::diagnostic::{Applicability, Diagnostic, Fix};
use crate::language::Since;
use crate::source::SourceMap;
use crate::syntax::directives::MacroDefinition;
use std::sync::Arc;

/// The largest number of parameters of a macro.
const MAX_PARAMS: usize = 256;

impl Preprocessor<'_> {
    /// Defines the macros that every shader of the version has.
    pub(super) fn define_predefined(&mut self, session: &mut ParseSession<'_>) {
        self.predefine(session, "__VERSION__", &version::UNWRITTEN.number.to_string(), Meaning::Body);
        self.predefine(session, "__LINE__", "0", Meaning::Line);
        self.predefine(session, "__FILE__", "0", Meaning::File);
        let version = self.version;
        for (row, symbol, definition) in predefined::extension_macros() {
            if row.is_for(version) {
                self.bind(*symbol, definition.clone());
            }
        }
    }

    /// Defines the macro of the profile, and gives `__VERSION__` its value.
    pub(super) fn define_version(&mut self, session: &mut ParseSession<'_>) {
        let number = session.names.intern(&self.version.number.to_string()).bits();
        let name = session.names.intern("__VERSION__");
        let definition = self.macro_of(name).and_then(|index| self.macros.get_mut(index));
        if let Some(definition) = definition {
            definition.body = definition.body.iter().map(|token| Token { payload: number, ..*token }).collect();
        }
        if self.version.has(Feature::Precision) {
            self.predefine(session, "GL_FRAGMENT_PRECISION_HIGH", "1", Meaning::Body);
        }
        match self.version.profile {
            Profile::Es => {
                for (row, symbol, definition) in predefined::extension_macros() {
                    match row.is_for(self.version) {
                        true => self.bind(*symbol, definition.clone()),
                        false => self.word(*symbol).definition = 0,
                    }
                }
                self.predefine(session, "GL_ES", "1", Meaning::Body);
            }
            Profile::Compatibility => self.predefine(session, "GL_compatibility_profile", "1", Meaning::Body),
            Profile::Core if self.version.number < 150 => {}
            Profile::Core => self.predefine(session, "GL_core_profile", "1", Meaning::Body),
        }
    }

    fn predefine(&mut self, session: &mut ParseSession<'_>, name: &str, value: &str, meaning: Meaning) {
        let definition = Macro { meaning, ..Macro::number(&mut session.names, name, value) };
        let symbol = session.names.intern(name);
        self.bind(symbol, definition);
    }

    fn bind(&mut self, symbol: Symbol, definition: Macro) {
        self.macros.push(definition);
        self.word(symbol).definition = self.macros.len() as u32;
    }

    /// Processes the definitions of the command line as a text of their own, so that errors in them have a position.
    pub(super) fn define_from_outside(&mut self, session: &mut ParseSession<'_>, defines: &[(String, String)]) {
        if defines.is_empty() {
            return;
        }
        let one_line = |text: &str| text.replace(['\n', '\r'], " ");
        let text: String =
            defines.iter().map(|(name, value)| format!("#define {} {}\n", one_line(name), one_line(value))).collect();
        let Some(file) = session.sources.add(SourceMap::COMMAND_LINE, text) else { return };
        self.enter(session, file, Span::default());
        let token = self.next_from_file(session, true);
        if token.kind != TokenKind::Eof {
            let message = "the definition does not end with its line";
            session.report(Diagnostic::new(&codes::MALFORMED_DIRECTIVE, token.span, message));
        }
        self.frames.pop();
        self.before_version = None;
    }

    /// `#define NAME body`, `#define NAME(a, b) body`
    pub(super) fn define(&mut self, session: &mut ParseSession<'_>) {
        let Some(name) = self.macro_name(session, "#define") else { return };
        self.check_length(session, name);
        let first = self.line_token(session);
        let mut tokens = Vec::new();
        let mut params = None;
        if first.kind == TokenKind::LeftParen && !first.flags.contains(TokenFlags::SPACE) {
            let Some(list) = self.parameters(session, name, first) else { return };
            params = Some(list);
        } else if first.kind != TokenKind::Newline && first.kind != TokenKind::Eof {
            tokens.push(first);
        }
        self.rest_of_line(session, &mut tokens);
        let whole = match (tokens.first(), tokens.last()) {
            (Some(first), Some(last)) => session.sources.join(first.span, last.span),
            _ => Span::default(),
        };
        let Some(pastes) = self.check_body(session, params.as_deref(), &mut tokens) else { return };
        let definition = Macro {
            name: session.spelling(name).into(),
            span: name.span,
            meaning: Meaning::Body,
            params,
            body: tokens.into(),
            pastes,
            disabled: false,
        };
        self.outcome.directives.definitions.push(MacroDefinition {
            name: Arc::clone(&definition.name),
            span: name.span,
            params: definition
                .params
                .as_ref()
                .map(|params| params.iter().map(|&param| Arc::from(session.names.spelling(param))).collect()),
            body: whole,
        });
        self.check_redefinition(session, name, &definition);
        self.bind(name.symbol(), definition);
    }

    /// `#undef NAME`
    pub(super) fn undef(&mut self, session: &mut ParseSession<'_>) {
        let Some(name) = self.macro_name(session, "#undef") else { return };
        self.mention(name);
        self.word(name.symbol()).definition = 0;
        self.expect_line_end(session, "#undef");
    }

    /// The name after `#define` or `#undef`, if it may be defined or undefined.
    fn macro_name(&mut self, session: &mut ParseSession<'_>, directive: &str) -> Option<Token> {
        let token = self.line_token(session);
        if token.kind != TokenKind::Word {
            self.malformed(session, token, &format!("`{directive}` needs the name of a macro"));
            return None;
        }
        let name = session.spelling(token).to_owned();
        let predefined = self.macro_of(token.symbol()).and_then(|index| self.macros.get(index));
        let predefined = predefined.is_some_and(Macro::is_predefined);
        if predefined || name.starts_with("GL_") || name == "defined" {
            let (verb, why) = match (directive, predefined) {
                ("#undef", true) => ("undefined", "it is predefined"),
                (_, true) => ("redefined", "it is predefined"),
                ("#undef", false) => ("undefined", "it is reserved"),
                (_, false) => ("defined", "it is reserved"),
            };
            let why = if name == "defined" { "it is an operator of `#if`" } else { why };
            let message = format!("the macro name `{name}` cannot be {verb}");
            session.report(Diagnostic::new(&codes::RESERVED_MACRO, token.span, message).here(why));
            self.skip_line(session);
            return None;
        }
        if name.contains("__")
            && directive == "#define"
            && !std::mem::replace(&mut self.word(token.symbol()).checked, true)
        {
            let message = format!("the macro name `{name}` is reserved: it holds two underscores in a row");
            kind::RESERVED_NAME.report(session, self.strict, token.span, message);
        }
        Some(token)
    }

    /// The parameters up to the `)`; `None` after an error.
    fn parameters(&mut self, session: &mut ParseSession<'_>, name: Token, opening: Token) -> Option<Vec<Symbol>> {
        let mut params: Vec<Symbol> = Vec::new();
        loop {
            let token = self.line_token(session);
            match token.kind {
                TokenKind::RightParen if params.is_empty() => return Some(params),
                TokenKind::Word if params.contains(&token.symbol()) => {
                    let message = format!(
                        "the macro `{}` has two parameters `{}`",
                        session.spelling(name),
                        session.spelling(token)
                    );
                    session.report(Diagnostic::new(&codes::MALFORMED_PARAMETERS, token.span, message));
                    self.skip_line(session);
                    return None;
                }
                TokenKind::Word if params.len() >= MAX_PARAMS => {
                    let message =
                        format!("the macro `{}` has more than {MAX_PARAMS} parameters", session.spelling(name));
                    session.report(Diagnostic::new(&codes::MALFORMED_PARAMETERS, token.span, message));
                    self.skip_line(session);
                    return None;
                }
                TokenKind::Word => params.push(token.symbol()),
                _ => return self.malformed_parameters(session, name, opening, token, "a name"),
            }
            let token = self.line_token(session);
            match token.kind {
                TokenKind::Comma => {}
                TokenKind::RightParen => return Some(params),
                _ => return self.malformed_parameters(session, name, opening, token, "`,` or `)`"),
            }
        }
    }

    fn malformed_parameters(
        &mut self,
        session: &mut ParseSession<'_>,
        name: Token,
        opening: Token,
        found: Token,
        expected: &str,
    ) -> Option<Vec<Symbol>> {
        let message = format!("in the parameters of the macro `{}`: expected {expected}", session.spelling(name));
        let mut diagnostic = Diagnostic::new(&codes::MALFORMED_PARAMETERS, found.span, message);
        if matches!(found.kind, TokenKind::Newline | TokenKind::Eof) {
            diagnostic = diagnostic.label(opening.span, "opened here");
        }
        if found.kind == TokenKind::Dot {
            diagnostic = diagnostic.help("GLSL has no variadic macros");
        }
        session.report(diagnostic);
        self.end_line(session, found);
        None
    }

    /// Marks the parameters in a body and checks its `##`. Returns whether the body pastes, or `None` after an error.
    fn check_body(
        &mut self,
        session: &mut ParseSession<'_>,
        params: Option<&[Symbol]>,
        body: &mut [Token],
    ) -> Option<bool> {
        let mut pastes = false;
        let last = body.len().wrapping_sub(1);
        for (index, token) in body.iter_mut().enumerate() {
            match token.kind {
                TokenKind::Word => {
                    let place = params.and_then(|params| params.iter().position(|&param| param == token.symbol()));
                    if let Some(place) = place {
                        (token.kind, token.payload) = (TokenKind::Param, place as u32);
                    }
                }
                TokenKind::HashHash if index == 0 || index == last => {
                    let message = "`##` needs a token on both sides";
                    session.report(Diagnostic::new(&codes::INVALID_PASTE, token.span, message));
                    return None;
                }
                TokenKind::HashHash => {
                    let is_first = !std::mem::replace(&mut pastes, true);
                    if is_first {
                        self.check_paste(session, token.span);
                    }
                }
                TokenKind::Hash => {
                    let diagnostic = Diagnostic::new(
                        &codes::MISPLACED_HASH,
                        token.span,
                        "`#` is not an operator in a macro of GLSL",
                    )
                    .help("there are no strings; `##` joins two tokens");
                    session.report(diagnostic);
                    return None;
                }
                _ => {}
            }
        }
        Some(pastes)
    }

    /// Checks that the version has `##`: GLSL since 1.30 (§3.3), GLSL ES never (ES 3.20 §3.4).
    fn check_paste(&self, session: &mut ParseSession<'_>, span: Span) {
        let version = self.version;
        if version.is_es() {
            let message = format!("`##` is not in {}", version.name());
            let diagnostic =
                Diagnostic::new(&NEEDS_EXTENSION, span, message).here("not in this version of the language");
            let diagnostic = Diagnostic { lacking: Some(Feature::TokenPasting), ..diagnostic };
            session.report(diagnostic.help("write the joined tokens; GLSL ES has no operator that joins them"));
        } else if !version.reaches(Since::of(130)) {
            kind::EARLY_PASTE.report(session, self.strict, span, format!("`##` is not in {}", version.name()));
        }
    }

    fn check_redefinition(&mut self, session: &mut ParseSession<'_>, name: Token, new: &Macro) {
        let Some(old) = self.macro_of(name.symbol()).and_then(|index| self.macros.get(index)) else { return };
        if old.span == new.span || self.engine.redefines || old.same(new, session) {
            return;
        }
        let undef = format!("#undef {}", new.name);
        let mut diagnostic = Diagnostic::new(
            &codes::MACRO_REDEFINED,
            name.span,
            format!("the macro `{}` is defined again with a different body", new.name),
        )
        .here("a different definition")
        .label(old.span, "defined here before")
        .help(format!("write `{undef}` first"));
        // Which of the two was meant is not known.
        if let Some(line) = session.sources.line_of(name.span) {
            let start = Span { end: line.start, ..line };
            let title = format!("write `{undef}` first");
            diagnostic = diagnostic.fix(Fix::new(Applicability::Unsafe, title, start, format!("{undef}\n")));
        }
        session.report(diagnostic);
    }
}
