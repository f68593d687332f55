//! `#include` (ARB_shading_language_include, GL_GOOGLE_include_directive).

use super::{
    Extensions, FileId, ParseSession, Preprocessor, Span, Token, TokenFlags, TokenKind, codes, extension, kind,
};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place, codes::general};
use crate::source::{IncludeForm, Included, Inclusion};
use crate::syntax::directives::IncludeName;

/// The largest depth of nested includes.
const MAX_DEPTH: usize = 64;

/// The name in an `#include`.
struct Header {
    /// The name, with its quotes or angle brackets.
    text: String,
    /// The position.
    span: Span,
}

impl Preprocessor<'_> {
    /// `#include "x"`, `#include <x>`, or macros that expand to one of them. An `import` is the engine's own directive.
    pub(super) fn include(&mut self, session: &mut ParseSession<'_>, directive: Span, import: bool) {
        let plain = self.frames.last_mut().and_then(|frame| frame.lexer.header_name());
        let header = match plain {
            Some(span) => {
                self.expect_line_end(session, "#include");
                Header { text: session.sources.snippet(span).to_owned(), span }
            }
            None => match self.expanded_header(session, directive) {
                Some(header) => header,
                None => return,
            },
        };
        self.include_header(session, directive, &header, import);
    }

    /// `#pragma include "x"` and `#pragma include : "x"`, of engines that replace it. The tokens are those after `include`.
    pub(super) fn pragma_include(&mut self, session: &mut ParseSession<'_>, directive: Span, tokens: &[Token]) -> bool {
        let tokens = match tokens {
            [colon, rest @ ..] if colon.kind == TokenKind::Colon => rest,
            all => all,
        };
        let (Some(first), Some(last)) = (tokens.first(), tokens.last()) else { return false };
        let span = session.sources.join(first.span, last.span);
        let text = session.sources.snippet(span).to_owned();
        let is_header = text.len() > 2
            && (text.starts_with('"') && text.ends_with('"') || text.starts_with('<') && text.ends_with('>'));
        if is_header {
            self.include_header(session, directive, &Header { text, span }, true);
        }
        is_header
    }

    /// Begins to read the file that a header names.
    fn include_header(&mut self, session: &mut ParseSession<'_>, directive: Span, header: &Header, import: bool) {
        let whole = session.sources.join(directive, header.span);
        let resolved = import || self.engine.resolves_includes;
        if !self.extensions.contains(Extensions::INCLUDE) && !resolved {
            let diagnostic = kind::INCLUDE_WITHOUT_EXTENSION.diagnostic(
                self.strict,
                whole,
                "`#include` without the extension that provides it",
            );
            // The extension is one of OpenGL.
            session.report(if self.version.is_es() {
                diagnostic.help("a build has to put the file in its place: no driver of OpenGL ES knows `#include`")
            } else {
                diagnostic.help(Advice::new(
                    Applicability::Unsafe,
                    "write `#extension GL_ARB_shading_language_include : require` before it",
                    Place::Before,
                    "#extension GL_ARB_shading_language_include : require\n",
                ))
            });
        } else if let Some(warning) = extension::warning_of_use(self.extensions, Extensions::INCLUDE, whole) {
            session.report(warning);
        }
        let file = self.find_include(session, header);
        self.outcome.directives.includes.push(IncludeName { span: header.span, file });
        let Some(file) = file else { return };
        // Under another name, such as that of a link, it is the same file: nothing tells files apart here but their texts.
        let text = |file: FileId| session.sources.file(file).text();
        let entered = !self.once.iter().any(|once| *once == file || text(*once) == text(file));
        self.outcome.inclusions.push(Inclusion { directive, file: entered.then_some(file) });
        if !entered {
            return;
        }
        if import && self.engine.directive.is_some_and(|directive| directive.once) {
            self.once.insert(file);
        }
        if self.frames.len() >= MAX_DEPTH {
            let name = session.sources.file(file).name();
            let message = format!("files include each other more than {MAX_DEPTH} levels deep, `{name}` last");
            session
                .report(Diagnostic::new(&codes::INCLUDE_TOO_DEEP, whole, message).help("write `#pragma once` into it"));
            return self.stop();
        }
        self.enter(session, file, whole);
    }

    /// The name that the macros of an `#include` line expand to; `None` after an error.
    fn expanded_header(&mut self, session: &mut ParseSession<'_>, directive: Span) -> Option<Header> {
        let mut line = Vec::new();
        self.rest_of_line(session, &mut line);
        let span = match (line.first(), line.last()) {
            (Some(first), Some(last)) => session.sources.join(first.span, last.span),
            _ => directive.after(),
        };
        let tokens = self.expand_all(session, line);
        if std::mem::take(&mut self.broken_line) || self.stopped {
            return None;
        }
        let text: String = tokens
            .iter()
            .enumerate()
            .map(|(place, &token)| {
                let space = if place > 0 && token.flags.contains(TokenFlags::SPACE) { " " } else { "" };
                format!("{space}{}", super::expand::written(session, token))
            })
            .collect();
        let inside = |open, close| text.strip_prefix(open).and_then(|rest| rest.strip_suffix(close));
        let header = match tokens.as_slice() {
            [_] => inside('"', '"'),
            [first, .., _] if first.kind == TokenKind::LeftAngle => inside('<', '>'),
            _ => None,
        };
        if header.is_none_or(str::is_empty) {
            let found = if text.is_empty() { "nothing is here".to_owned() } else { format!("found `{text}`") };
            let message = "`#include` needs a name in quotes or angle brackets";
            session.report(Diagnostic::new(&codes::MALFORMED_DIRECTIVE, span, message).here(found));
            return None;
        }
        Some(Header { text, span })
    }

    /// The file of an include; each is resolved and loaded once.
    fn find_include(&mut self, session: &mut ParseSession<'_>, header: &Header) -> Option<FileId> {
        let from = self.frames.last()?.file;
        let Header { text: quoted, span: header } = header;
        let form = if quoted.starts_with('"') { IncludeForm::Quoted } else { IncludeForm::Angled };
        let path = quoted.get(1..quoted.len().saturating_sub(1)).unwrap_or("").to_owned();
        if let Some(&file) = self.resolved.get(&(from, form, path.clone())) {
            return Some(file);
        }
        let included = self.includes.resolve(&path, form, session.sources.file(from).name());
        let included = match included {
            Ok(included) => included,
            Err(reason) if self.includes.finds_no_text(&path, form, session.sources.file(from).name()) => {
                session.report(Diagnostic::new(&general::BINARY_SOURCE, *header, reason).here("included here"));
                return None;
            }
            Err(reason) => {
                let message = format!("the include `{path}` was not found");
                let help = self.includes.remedy(&path, session.sources.file(from).name());
                session
                    .report(Diagnostic::new(&codes::INCLUDE_NOT_FOUND, *header, message).here(reason).maybe_help(help));
                return None;
            }
        };
        let Some(file) = load(session, included) else {
            session.report(Diagnostic::new(&general::TOO_LARGE, *header, "there is no room for the included text"));
            self.stop();
            return None;
        };
        self.resolved.insert((from, form, path), file);
        Some(file)
    }
}

/// The file in the map, where another include or stage may have put it, so that its errors are reported once.
fn load(session: &mut ParseSession<'_>, included: Included) -> Option<FileId> {
    let known = session.sources.files().find(|(_, file)| file.name() == included.name && *file.text() == included.text);
    match known.map(|(id, _)| id) {
        Some(id) => Some(id),
        None => session.sources.add(included.name, included.text),
    }
}
