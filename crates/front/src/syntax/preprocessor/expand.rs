//! Macro expansion by the rules of C++, on an explicit stack (GLSL 1.50 §3.3).

use super::definition::Meaning;
use super::{Mode, ParseSession, Preprocessor, Span, Token, TokenFlags, TokenKind, codes};
use crate::diagnostic::Diagnostic;
use crate::source::{Expansion, ExpansionId};
use crate::syntax::lexer::Lexer;
use std::sync::Arc;

/// How deep macro uses may nest.
const MAX_DEPTH: usize = 4096;
/// How deep macro uses may nest in each other's arguments. Each level takes a little of the real stack.
const MAX_ARGUMENT_DEPTH: usize = 64;
/// How many tokens macros may produce: this many, plus [`STEPS_A_BYTE`] for each byte of the text.
const STEPS: usize = 500_000;
const STEPS_A_BYTE: usize = 2;
/// How many characters `##` may join for one of those tokens: a chain of it joins ever longer names.
const PASTED_A_STEP: usize = 4;

/// Tokens that are read before the rest of the files.
enum RunTokens {
    /// The body of a macro as defined; each token gets this expansion.
    Body(Arc<[Token]>, ExpansionId),
    /// Tokens that have their positions already.
    List(Vec<Token>),
}

/// A run of tokens, and how much of it has been read.
pub(super) struct TokenRun {
    run: RunTokens,
    next: usize,
    definition: Option<usize>,
    barrier: bool,
    /// Whether the first of them begins a line, as the name of the macro does.
    starts_line: bool,
}

impl TokenRun {
    /// Tokens after which nothing else is read until they are removed.
    pub(super) fn barrier(tokens: Vec<Token>) -> Self {
        Self { barrier: true, ..Self::of(RunTokens::List(tokens), None) }
    }

    fn list(tokens: Vec<Token>, definition: Option<usize>) -> Self {
        Self::of(RunTokens::List(tokens), definition)
    }

    fn of(run: RunTokens, definition: Option<usize>) -> Self {
        Self { run, next: 0, definition, barrier: false, starts_line: false }
    }

    /// The same tokens in place of the name of a macro.
    fn in_place_of(self, name: Token) -> Self {
        Self { starts_line: name.starts_line(), ..self }
    }

    pub(super) fn next(&mut self) -> Option<Token> {
        let mut token = match &self.run {
            RunTokens::Body(body, expansion) => body.get(self.next).map(|token| placed(*token, *expansion)),
            RunTokens::List(tokens) => tokens.get(self.next).copied(),
        };
        if let Some(first) = token.as_mut().filter(|_| self.next == 0 && self.definition.is_some()) {
            first.flags.set(TokenFlags::LINE_START, self.starts_line);
        }
        self.next += 1;
        token
    }

    pub(super) fn is_barrier(&self) -> bool {
        self.barrier
    }

    pub(super) fn definition(&self) -> Option<usize> {
        self.definition
    }
}

/// A token of a macro's body, placed at the use of the macro.
fn placed(mut token: Token, expansion: ExpansionId) -> Token {
    token.span.expansion = expansion;
    token.flags.remove(TokenFlags::LINE_START);
    token
}

impl Preprocessor<'_> {
    /// The next token, after macro expansion.
    pub(super) fn next_expanded(&mut self, session: &mut ParseSession<'_>) -> Token {
        loop {
            let token = self.next_unexpanded(session, false);
            if token.kind != TokenKind::Word || token.flags.contains(TokenFlags::NO_EXPAND) {
                return token;
            }
            let Some(index) = self.macro_of(token.symbol()) else { return token };
            if !self.expand(session, token, index) {
                return token;
            }
            if self.stopped {
                return self.end(token.span);
            }
        }
    }

    /// Begins the expansion of a macro use. Returns false if it is not a use (a function-like macro without
    /// arguments).
    fn expand(&mut self, session: &mut ParseSession<'_>, name: Token, index: usize) -> bool {
        let Some(definition) = self.macros.get(index) else { return false };
        let function_like = definition.params.is_some();
        if definition.meaning != Meaning::Body {
            let number = self.magic_number(session, definition.meaning, name.span);
            self.contexts.push(TokenRun::list(vec![self.number_token(session, number, name)], None));
            return true;
        }
        if !function_like && !definition.pastes {
            let (body, span) = (definition.body.clone(), name.span);
            let id = self.note_expansion(session, index, span);
            self.spend(session, body.len(), span);
            self.push(session, TokenRun::of(RunTokens::Body(body, id), Some(index)).in_place_of(name), span);
            return true;
        }
        let mut call = name.span;
        let mut arguments = Vec::new();
        if function_like {
            let Some(opening) = self.take_opening(session) else { return false };
            self.in_arguments = true;
            let read = self.arguments(session, name, opening, index);
            self.in_arguments = false;
            let Some((list, closing)) = read else { return true };
            arguments = list;
            call = session.sources.join(name.span, closing);
        }
        let Some(arguments) = self.check_argument_count(session, index, arguments, call) else { return true };
        let id = self.note_expansion(session, index, call);
        let tokens = self.substitute(session, index, &arguments, id);
        self.push(session, TokenRun::list(tokens, Some(index)).in_place_of(name), call);
        true
    }

    fn push(&mut self, session: &mut ParseSession<'_>, context: TokenRun, span: Span) {
        if let Some(definition) = context.definition.and_then(|index| self.macros.get_mut(index)) {
            definition.disabled = true;
        }
        self.contexts.push(context);
        if self.contexts.len() > MAX_DEPTH {
            let message = format!("macros use macros more than {MAX_DEPTH} levels deep");
            session.report(Diagnostic::new(&codes::EXPANSION_TOO_DEEP, session.sources.call_site(span), message));
            self.stop();
        }
    }

    fn note_expansion(&mut self, session: &mut ParseSession<'_>, index: usize, call: Span) -> ExpansionId {
        let Some(definition) = self.macros.get(index) else { return ExpansionId::NONE };
        let expansion = Expansion { name: definition.name.clone(), call, definition: definition.span };
        session.sources.add_expansion(expansion)
    }

    /// Charges tokens to the budget.
    fn spend(&mut self, session: &mut ParseSession<'_>, tokens: usize, span: Span) {
        self.steps += tokens + 1;
        if self.steps > STEPS + STEPS_A_BYTE * self.bytes && !self.stopped {
            let message =
                format!("the macros of the source produce more than {} tokens", STEPS + STEPS_A_BYTE * self.bytes);
            let diagnostic = Diagnostic::new(&codes::EXPANSION_TOO_LARGE, session.sources.call_site(span), message)
                .here("in this use");
            session.report(diagnostic);
            self.stop();
        }
    }

    fn magic_number(&self, session: &ParseSession<'_>, meaning: Meaning, span: Span) -> u32 {
        let site = session.sources.call_site(span);
        match meaning {
            Meaning::Line => session.sources.presented_line(site).or_else(|| session.sources.line(site)).unwrap_or(0),
            Meaning::File | Meaning::Body => self.frames.last().map_or(0, |frame| frame.number),
        }
    }

    fn number_token(&self, session: &mut ParseSession<'_>, number: u32, at: Token) -> Token {
        let mut token = Token { kind: TokenKind::Number, ..at };
        token.payload = session.names.intern(&number.to_string()).bits();
        token
    }

    /// Reads `(` if it is next.
    fn take_opening(&mut self, session: &mut ParseSession<'_>) -> Option<Token> {
        let token = self.next_unexpanded(session, true);
        match token.kind {
            TokenKind::LeftParen => return Some(token),
            TokenKind::Eof => {}
            _ => self.contexts.push(TokenRun::list(vec![token], None)),
        }
        None
    }

    /// The arguments after `(`, and the position of the `)`.
    fn arguments(
        &mut self,
        session: &mut ParseSession<'_>,
        name: Token,
        opening: Token,
        index: usize,
    ) -> Option<(Vec<Vec<Token>>, Span)> {
        let mut arguments = vec![Vec::new()];
        let mut depth = 0_usize;
        // What has been read from the `;` on, which ends a statement if the call has no end.
        let mut rest: Vec<Token> = Vec::new();
        loop {
            let token = self.next_unexpanded(session, true);
            if token.kind == TokenKind::Semicolon || !rest.is_empty() {
                rest.push(token);
            }
            match token.kind {
                TokenKind::Eof => {
                    rest.pop();
                    self.unterminated_call(session, (name, opening), index, rest);
                    return None;
                }
                TokenKind::RightParen if depth == 0 => return Some((arguments, token.span)),
                TokenKind::RightParen => depth -= 1,
                TokenKind::LeftParen => depth += 1,
                TokenKind::Comma if depth == 0 => {
                    arguments.push(Vec::new());
                    continue;
                }
                _ => {}
            }
            // The arguments of nested uses are kept once for each level.
            self.spend(session, 0, token.span);
            if let Some(argument) = arguments.last_mut() {
                argument.push(token);
            }
        }
    }

    /// Reports a macro use whose `)` is missing. In a directive the rest of the line is lost. In the text, the first one ends at its
    /// `;`, and what follows is read again; after another one, the rest of the file is lost, so that none is read again and again.
    fn unterminated_call(
        &mut self,
        session: &mut ParseSession<'_>,
        (name, opening): (Token, Token),
        index: usize,
        rest: Vec<Token>,
    ) {
        if self.stopped {
            return;
        }
        let what = self.macros.get(index).map_or("", |definition| &definition.name);
        let message = format!("the arguments of the macro `{what}` have no end");
        let diagnostic = Diagnostic::new(&codes::UNTERMINATED_MACRO_CALL, name.span, message)
            .label(opening.span, "this bracket is never closed");
        session.report(diagnostic);
        if self.contexts.iter().any(TokenRun::is_barrier) {
            self.broken_line = true;
        } else if rest.is_empty() || std::mem::replace(&mut self.read_again, true) {
            self.stop();
        } else {
            let mut hole = Token { kind: TokenKind::Invalid, ..name };
            hole.flags.insert(TokenFlags::REPORTED);
            self.contexts.push(TokenRun::list(rest, None));
            self.contexts.push(TokenRun::list(vec![hole], None));
        }
    }

    fn check_argument_count(
        &mut self,
        session: &mut ParseSession<'_>,
        index: usize,
        mut arguments: Vec<Vec<Token>>,
        call: Span,
    ) -> Option<Vec<Vec<Token>>> {
        let definition = self.macros.get(index)?;
        let Some(params) = &definition.params else { return Some(Vec::new()) };
        if params.is_empty() && arguments.iter().all(Vec::is_empty) && arguments.len() == 1 {
            arguments.clear();
        }
        if params.len() == arguments.len() {
            return Some(arguments);
        }
        let (wanted, given) = (params.len(), arguments.len());
        let plural = if wanted == 1 { "" } else { "s" };
        let message = format!("the macro `{}` takes {wanted} argument{plural} and is given {given}", definition.name);
        let diagnostic = Diagnostic::new(&codes::MACRO_ARGUMENTS, call, message).label(definition.span, "defined here");
        session.report(diagnostic);
        // Something replaces the use, so that the parser sees no hole: a value of no known type, and a number in a condition.
        let mut instead = self.number_token(session, 0, Token::new(TokenKind::Number, call));
        if !self.contexts.iter().any(TokenRun::is_barrier) {
            instead.kind = TokenKind::Invalid;
            instead.flags.insert(TokenFlags::REPORTED);
        }
        self.contexts.push(TokenRun::list(vec![instead], None));
        None
    }

    /// The body with its parameters replaced by arguments and its `##` applied.
    fn substitute(
        &mut self,
        session: &mut ParseSession<'_>,
        index: usize,
        arguments: &[Vec<Token>],
        id: ExpansionId,
    ) -> Vec<Token> {
        let Some(body) = self.macros.get(index).map(|definition| definition.body.clone()) else { return Vec::new() };
        self.spend(
            session,
            body.len(),
            session.sources.expansion(id).map_or(Span::default(), |expansion| expansion.call),
        );
        let mut expanded: Vec<Option<Vec<Token>>> = vec![None; arguments.len()];
        let mut tokens: Vec<Token> = Vec::with_capacity(body.len());
        let mut place = 0;
        while let Some(&token) = body.get(place) {
            let pasted_next = body.get(place + 1).is_some_and(|next| next.kind == TokenKind::HashHash);
            let chain_start = tokens.len();
            self.operand(session, token, arguments, &mut expanded, pasted_next, id, &mut tokens);
            place += 1;
            let mut left_empty = tokens.len() == chain_start;
            while !self.stopped && body.get(place).is_some_and(|next| next.kind == TokenKind::HashHash) {
                let Some(&right) = body.get(place + 1) else { break };
                let boundary = tokens.len();
                self.operand(session, right, arguments, &mut expanded, true, id, &mut tokens);
                let right_empty = tokens.len() == boundary;
                if !left_empty && !right_empty {
                    self.paste(session, &mut tokens, boundary, id);
                }
                left_empty &= right_empty;
                place += 2;
            }
            if self.stopped {
                break;
            }
        }
        tokens
    }

    /// Appends one token of a body, or the argument that it names.
    #[expect(clippy::too_many_arguments, reason = "the state of one substitution, used nowhere else")]
    fn operand(
        &mut self,
        session: &mut ParseSession<'_>,
        token: Token,
        arguments: &[Vec<Token>],
        expanded: &mut [Option<Vec<Token>>],
        pasted: bool,
        id: ExpansionId,
        tokens: &mut Vec<Token>,
    ) {
        if token.kind != TokenKind::Param {
            tokens.push(placed(token, id));
            return;
        }
        let param = token.payload as usize;
        let Some(argument) = arguments.get(param) else { return };
        let start = tokens.len();
        if pasted {
            self.spend(session, argument.len(), token.span);
            tokens.extend_from_slice(argument);
            space_as(token, tokens.get_mut(start));
            return;
        }
        let Some(cache) = expanded.get_mut(param) else { return };
        if cache.is_none() {
            *cache = Some(self.expand_argument(session, argument));
        }
        let from = cache.as_deref().unwrap_or(&[]);
        self.spend(session, from.len(), token.span);
        if !self.stopped {
            tokens.extend_from_slice(from);
            space_as(token, tokens.get_mut(start));
        }
    }

    /// An argument after the expansion of its own macros.
    fn expand_argument(&mut self, session: &mut ParseSession<'_>, argument: &[Token]) -> Vec<Token> {
        let has_macro =
            argument.iter().any(|token| token.kind == TokenKind::Word && self.macro_of(token.symbol()).is_some());
        if !has_macro {
            return argument.to_vec();
        }
        if self.argument_depth >= MAX_ARGUMENT_DEPTH {
            let span = argument.first().map_or(Span::default(), |token| session.sources.call_site(token.span));
            let message =
                format!("macro uses are nested in each other's arguments more than {MAX_ARGUMENT_DEPTH} levels deep");
            session.report(Diagnostic::new(&codes::EXPANSION_TOO_DEEP, span, message));
            self.stop();
            return Vec::new();
        }
        self.argument_depth += 1;
        let tokens = self.expand_all(session, argument.to_vec());
        self.argument_depth -= 1;
        tokens
    }

    /// A list of tokens after macro expansion, on its own.
    pub(super) fn expand_all(&mut self, session: &mut ParseSession<'_>, list: Vec<Token>) -> Vec<Token> {
        let floor = self.contexts.len();
        self.contexts.push(TokenRun::barrier(list));
        let mut tokens = Vec::new();
        while !self.stopped {
            let token = self.next_expanded(session);
            if token.kind == TokenKind::Eof {
                break;
            }
            tokens.push(token);
        }
        while self.contexts.len() > floor {
            self.pop_context();
        }
        tokens
    }

    /// Joins the token at `boundary` with the one before it.
    fn paste(&mut self, session: &mut ParseSession<'_>, tokens: &mut Vec<Token>, boundary: usize, id: ExpansionId) {
        let (Some(&left), Some(&right)) = (boundary.checked_sub(1).and_then(|at| tokens.get(at)), tokens.get(boundary))
        else {
            return;
        };
        let text = format!("{}{}", written(session, left), written(session, right));
        self.spend(session, text.len() / PASTED_A_STEP, left.span);
        if self.stopped {
            return;
        }
        let mut trivia = Vec::new();
        let mut lexer = Lexer::new(text.as_str().into(), 1);
        let mut joined = lexer.next(Mode::Text, &mut session.names, &mut trivia);
        let rest = lexer.next(Mode::Text, &mut session.names, &mut trivia);
        if rest.kind != TokenKind::Eof || !trivia.is_empty() || joined.kind == TokenKind::Unknown {
            let message = format!(
                "`##` joins `{}` and `{}` to `{text}`, which is not a token",
                written(session, left),
                written(session, right)
            );
            let span = session.sources.call_site(Span { expansion: id, ..left.span });
            session.report(Diagnostic::new(&codes::INVALID_PASTE, span, message).label(left.span, "the left side"));
            tokens.iter_mut().skip(boundary).take(1).for_each(|token| token.flags.insert(TokenFlags::REPORTED));
            return;
        }
        joined.span = Span { expansion: id, ..left.span };
        joined.flags = left.flags & TokenFlags::SPACE;
        if let Some(place) = tokens.get_mut(boundary - 1) {
            *place = joined;
        }
        tokens.remove(boundary);
    }
}

/// Gives an argument white space before it if its parameter has some.
fn space_as(parameter: Token, first: Option<&mut Token>) {
    if let Some(first) = first {
        first.flags.set(TokenFlags::SPACE, parameter.flags.contains(TokenFlags::SPACE));
    }
}

/// The text of a token.
pub(super) fn written(session: &ParseSession<'_>, token: Token) -> String {
    match token.kind {
        TokenKind::Word | TokenKind::Number | TokenKind::Invalid => session.spelling(token).to_owned(),
        TokenKind::Unknown => session.sources.snippet(token.span).to_owned(),
        kind => kind.spelling().to_owned(),
    }
}
