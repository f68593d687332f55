//! Loops that an engine unrolls before a driver sees them: `#pragma unroll_loop_start` of three.js.
//!
//! ```text
//! #pragma unroll_loop_start
//! for ( int i = 0; i < COUNT; i ++ ) { .. [ i ] .. UNROLLED_LOOP_INDEX .. }
//! #pragma unroll_loop_end
//! ```
//!
//! *In:* the pragma, before its loop. *Out:* the body is read once for each number from the first to the last, in which
//! `[ i ]` and `UNROLLED_LOOP_INDEX` are that number, also in directives. *Holds:* what is read has the positions of the
//! body, so diagnostics point into the loop. A loop of another form, or without an end, stays a loop, as in three.js.
//! Macros in the head are expanded, since three.js has replaced its counts by then.

use super::{FileFrame, FileId, Lexer, MAX_BYTES, Mode, ParseSession, Preprocessor, Span, Token, TokenKind};
use crate::diagnostic::{Diagnostic, codes::general};
use crate::source::Unrolled;
use std::ops::Range;
use std::sync::Arc;

/// How many tokens the head of a loop may have before its macros are expanded.
const LONGEST_HEAD: usize = 64;
const COUNTER: &str = "i";
const INDEX: &str = "UNROLLED_LOOP_INDEX";
const END: &str = "#pragma unroll_loop_end";
/// The bytes that a copy counts besides its text, against the limit of bytes.
const COPY: usize = 64;

/// The copy of a body that a frame reads.
pub(super) struct Copy {
    /// The number in this copy.
    index: u64,
    /// The number after that of the last copy.
    end: u64,
    /// A lexer at the beginning of the body.
    body: Lexer,
    /// The kind of the token before.
    before: TokenKind,
}

/// The next pragma that ends a loop, so that a text with many beginnings is searched once.
#[derive(Debug, Default)]
pub(super) struct NextEnd {
    file: Option<FileId>,
    searched_from: usize,
    found: Option<EndPragma>,
}

/// A pragma that ends a loop.
#[derive(Clone, Copy, Debug)]
struct EndPragma {
    start: usize,
    /// The place of the brace before it, if only white space is between them.
    brace: Option<usize>,
}

impl NextEnd {
    /// The first one in a file at or after a place.
    fn after(&mut self, file: FileId, text: &str, start: usize) -> Option<EndPragma> {
        let known = self.file == Some(file)
            && start >= self.searched_from
            && self.found.is_none_or(|pragma| start <= pragma.start);
        if !known {
            let place = text.get(start..)?.find(END).map(|place| start + place);
            let brace = |end: usize| Some(text.get(..end)?.trim_end().strip_suffix('}')?.len());
            let found = place.map(|start| EndPragma { start, brace: brace(start) });
            *self = Self { file: Some(file), searched_from: start, found };
        }
        self.found
    }
}

impl Preprocessor<'_> {
    /// Begins to read the copies of the loop after `#pragma unroll_loop_start`, whose `#` is at `pragma`.
    pub(super) fn unroll(&mut self, session: &mut ParseSession<'_>, pragma: Span) {
        let Some(frame) = self.frames.last() else { return };
        // three.js does not look into what it has unrolled.
        if !self.engine.unrolls || frame.copy.is_some() {
            return;
        }
        let (before, file) = (frame.lexer.clone(), frame.file);
        let found = self.head(session).and_then(|numbers| {
            let source = session.sources.file(file);
            let start = self.frames.last()?.lexer.offset().checked_sub(source.base())? as usize;
            let pragma = self.engine.unroll_end.after(file, source.text(), start)?;
            let brace = pragma.brace.filter(|brace| *brace >= start)?;
            Some((numbers, start..brace, pragma.start + END.len()))
        });
        match found {
            Some((numbers, body, end)) => self.enter_copies(session, pragma, numbers, body, end),
            None => {
                if let Some(frame) = self.frames.last_mut() {
                    frame.lexer = before;
                }
            }
        }
    }

    /// Reads `for ( int i = FIRST; i < LAST; i ++ ) {`; the two numbers.
    fn head(&mut self, session: &mut ParseSession<'_>) -> Option<Range<u64>> {
        let mut tokens: Vec<Token> = Vec::new();
        while tokens.last().is_none_or(|last| last.kind != TokenKind::LeftBrace) {
            let frame = self.frames.last_mut()?;
            let token = frame.lexer.next(Mode::Text, &mut session.names, &mut self.trivia);
            self.trivia.clear();
            if tokens.len() > LONGEST_HEAD || matches!(token.kind, TokenKind::Eof | TokenKind::Hash) {
                return None;
            }
            tokens.push(token);
        }
        let tokens = self.expand_all(session, tokens);
        let words: Vec<String> = tokens.iter().map(|token| super::expand::written(session, *token)).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let ["for", "(", "int", "i", "=", first, ";", "i", "<", last, ";", "i", "++", ")", "{"] = words.as_slice()
        else {
            return None;
        };
        Some(first.parse().ok()?..last.parse().ok()?)
    }

    fn enter_copies(
        &mut self,
        session: &mut ParseSession<'_>,
        pragma: Span,
        numbers: Range<u64>,
        body: Range<usize>,
        end: usize,
    ) {
        let Some(frame) = self.frames.last_mut() else { return };
        let (file, number) = (frame.file, frame.number);
        let source = session.sources.file(file);
        let text = source.text().get(body.clone()).unwrap_or("");
        let base = source.base();
        frame.lexer.go_to(end);
        let count = usize::try_from(numbers.end.saturating_sub(numbers.start)).unwrap_or(usize::MAX);
        self.bytes = self.bytes.saturating_add(count.saturating_mul(text.len() + COPY));
        if self.bytes > MAX_BYTES {
            let message = format!("the source has more than {} MiB after its loops are unrolled", MAX_BYTES >> 20);
            session.report(Diagnostic::new(&general::TOO_LARGE, pragma, message));
            return self.stop();
        }
        let copies = numbers.clone().map(|index| copy_of(text, index)).collect();
        self.outcome.unrolled.push(Unrolled { start: pragma.start, end: base + end as u32, text: copies });
        if numbers.is_empty() {
            return;
        }
        let mut lexer = Lexer::new(Arc::from(text), base + body.start as u32);
        lexer.joins_comments = self.joins_lines();
        let copy = Copy { index: numbers.start, end: numbers.end, body: lexer.clone(), before: TokenKind::Eof };
        self.frames.push(FileFrame { file, lexer, number, conditionals: Vec::new(), copy: Some(copy) });
    }

    /// Begins the next copy at the end of one. Returns false after the last.
    pub(super) fn next_copy(&mut self) -> bool {
        let Some(frame) = self.frames.last_mut() else { return false };
        let Some(copy) = &mut frame.copy else { return false };
        copy.index += 1;
        if copy.index >= copy.end {
            return false;
        }
        frame.lexer = copy.body.clone();
        copy.before = TokenKind::Eof;
        true
    }

    /// A token of the topmost file, or the number of the copy in its place.
    pub(super) fn in_copy(&mut self, session: &mut ParseSession<'_>, token: Token) -> Token {
        let Some(frame) = self.frames.last_mut() else { return token };
        let Some(copy) = &mut frame.copy else { return token };
        let before = std::mem::replace(&mut copy.before, token.kind);
        if token.kind != TokenKind::Word {
            return token;
        }
        let is_number = match session.names.spelling(token.symbol()) {
            INDEX => true,
            COUNTER if before == TokenKind::LeftBracket => {
                let next = frame.lexer.clone().next(Mode::Text, &mut session.names, &mut Vec::new());
                next.kind == TokenKind::RightBracket
            }
            _ => false,
        };
        if !is_number {
            return token;
        }
        let symbol = session.names.intern(&copy.index.to_string());
        Token { kind: TokenKind::Number, payload: symbol.bits(), ..token }
    }
}

/// The text of a copy, for drivers.
fn copy_of(body: &str, index: u64) -> String {
    let number = index.to_string();
    let mut text = String::with_capacity(body.len());
    let mut parts = body.split('[');
    text.push_str(parts.next().unwrap_or(""));
    for part in parts {
        let inner = part.trim_start();
        let rest = inner.strip_prefix(COUNTER).map(str::trim_start).filter(|rest| rest.starts_with(']'));
        match rest {
            Some(rest) => text.extend(["[", number.as_str(), rest]),
            None => text.extend(["[", part]),
        }
    }
    text.replace(INDEX, &number)
}

#[cfg(test)]
mod tests {
    use crate::hir::Stage;
    use crate::source::Completion;
    use crate::{Compiler, Options, Source};

    /// The text for drivers, and the diagnostics with the texts that they point to.
    fn unrolled(body: &str) -> (String, Vec<(String, String)>) {
        let completion = Completion { unrolls: true, ..Completion::default() };
        let defines = vec![("COUNT".to_owned(), "3".to_owned()), ("UNROLLED_LOOP_INDEX".to_owned(), "0".to_owned())];
        let options = Options { completion, defines, ..Options::default() };
        let text = format!("#version 330\nuniform vec4 a[3]; out vec4 c;\nvoid main() {{ c = vec4(0.0);\n{body}\n}}\n");
        let source = Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment };
        let compilation = Compiler::new(options).compile(&[source]);
        let found = compilation.diagnostics.iter();
        let found =
            found.map(|found| (found.message.clone(), compilation.sources.snippet(found.primary.span).to_owned()));
        (compilation.texts.iter().map(|text| text.to_string()).collect(), found.collect())
    }

    const START: &str = "#pragma unroll_loop_start\n";
    const END: &str = "\n#pragma unroll_loop_end";

    #[test]
    fn the_body_is_read_for_each_number() {
        let body = "for ( int i = 0; i < COUNT; i ++ ) {\n  c += a[ i ] * float( UNROLLED_LOOP_INDEX );\n\
                    #if UNROLLED_LOOP_INDEX < 1\n  c *= a[i].x;\n#endif\n}";
        let (text, found) = unrolled(&format!("{START}{body}{END}\nc += a[0];"));
        assert_eq!(found, []);
        assert_eq!(text.matches("c += a[2] * float( 2 );").count(), 1, "{text}");
        assert_eq!(text.matches("#if 1 < 1").count(), 1, "{text}");
        assert!(!text.contains("for (") && text.contains("c += a[0];\n}"), "{text}");
    }

    #[test]
    fn diagnostics_point_into_the_loop() {
        let body = "for (int i = 0; i < 2; i++) { c += b[ i ]; }";
        let (_, found) = unrolled(&format!("{START}{body}{END}"));
        assert_eq!(found, [("`b` is not declared".to_owned(), "b".to_owned())]);
        let body = "for (int i = 2; i < 5; i++) { c += a[i]; }";
        let (_, found) = unrolled(&format!("{START}{body}{END}"));
        assert_eq!(found, [("a `vec4[3]` has no element 3".to_owned(), "i".to_owned())]);
    }

    #[test]
    fn other_loops_stay() {
        for body in [
            "for (int j = 0; j < 2; j++) { c += a[j]; }",
            "for (int i = 0; i <= 2; i++) { c += a[i]; }",
            "for (int i = int(c.x); i < 2; i++) { c += a[i]; }",
        ] {
            let (text, found) = unrolled(&format!("{START}{body}{END}"));
            assert_eq!((text.contains(body), found), (true, vec![]), "{body}");
        }
        let (text, found) = unrolled(&format!("{START}for (int i = 0; i < 2; i++) {{ c += a[i]; }}"));
        assert_eq!((text.contains("i++"), found), (true, vec![]));
    }

    #[test]
    fn no_number_of_copies_runs_away() {
        let body = "for (int i = 0; i < 4000000000; i++) { }";
        let (_, found) = unrolled(&format!("{START}{body}{END}"));
        assert!(found.iter().any(|(message, _)| message.contains("unrolled")), "{found:?}");
        assert_eq!(unrolled(&format!("{START}for (int i = 3; i < 2; i++) {{ x }}{END}")).1, []);
    }
}
