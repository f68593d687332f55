//! `#version`, and the end of the main file, where the lack of one is known (GLSL 1.50 §3.3).

use super::{ParseSession, Preprocessor, Profile, Span, Token, TokenKind, Version, codes, keywords, kind};
use crate::diagnostic::{Applicability, Diagnostic, Edit, Fix, codes::general};
use crate::language::{EDITIONS, Feature};
use crate::source::is_replaced;
use std::collections::BTreeSet;

/// The change that moves a directive to the begin of a text.
fn to_first_line(session: &ParseSession<'_>, first: Span, directive: Span) -> Fix {
    let line = format!("{}\n", session.sources.snippet(directive));
    let edits = vec![Edit { span: first, text: line }, Edit { span: directive, text: String::new() }];
    Fix { title: "make it the first line".to_owned(), applicability: Applicability::Safe, edits }
}

/// The language of a text without a `#version` line (§3.3).
pub(super) const UNWRITTEN: Version = Version {
    number: 110,
    profile: Profile::Core,
    span: Span { start: 0, end: 0, expansion: crate::source::ExpansionId::NONE },
};

const HELP: &str = "write `#version 150`";

impl Preprocessor<'_> {
    /// `#version number profile`, without macro expansion.
    pub(super) fn version(&mut self, session: &mut ParseSession<'_>, directive: Span) {
        let number = self.line_token(session);
        let parsed: Option<u16> =
            if number.kind == TokenKind::Number { session.spelling(number).parse().ok() } else { None };
        let Some(parsed) = parsed else { return self.version_by_name(session, number) };
        let mut span = session.sources.join(directive, number.span);
        let profile = self.line_token(session);
        let named = if profile.kind == TokenKind::Word {
            span = session.sources.join(span, profile.span);
            self.expect_line_end(session, "#version");
            session.spelling(profile).to_owned()
        } else {
            self.end_line_with_extra(session, profile);
            String::new()
        };
        let profile_here = if named == "es" { Profile::Es } else { Profile::Core };
        let stated = Version { number: parsed, profile: profile_here, span };
        if !self.check_place(session, stated) {
            return;
        }
        self.version_seen = true;
        let profile_span = if named.is_empty() { span } else { profile.span };
        self.set_version(
            session,
            Version { number: parsed, profile: Profile::Core, span },
            &named,
            number.span,
            profile_span,
        );
    }

    /// A line without a number. If a build fills one in, what the command line or an engine assumes stands for it.
    fn version_by_name(&mut self, session: &mut ParseSession<'_>, found: Token) {
        let file = |span| session.sources.file_of(span);
        let is_assumed = self.version_seen && file(self.version.span) != file(found.span);
        if is_assumed {
            return self.skip_line(session);
        }
        let replaced = !self.version_seen && is_replaced(session.sources.snippet(found.span));
        self.version_seen = true;
        if !replaced {
            self.malformed(session, found, "`#version` needs a number such as 150");
            self.outcome.supported = false;
            return self.stop();
        }
        let name = session.sources.snippet(found.span).to_owned();
        session.report(
            Diagnostic::new(&codes::MISSING_VERSION, found.span, "`#version` needs a number such as 150")
                .here(format!("`{name}` is not a number, so a build must replace it"))
                .help("say what stands for it, such as `--assume-version 330`"),
        );
        // All that follows would be judged by the wrong language.
        self.outcome.supported = false;
        self.stop();
    }

    fn end_line_with_extra(&mut self, session: &mut ParseSession<'_>, token: Token) {
        if !matches!(token.kind, TokenKind::Newline | TokenKind::Eof) {
            kind::EXTRA_TEXT.report(session, self.strict, token.span, "there is text after the complete `#version`");
            self.skip_line(session);
        }
    }

    /// Whether the directive is valid here: it is the first, and no token comes before it.
    fn check_place(&mut self, session: &mut ParseSession<'_>, stated: Version) -> bool {
        let span = stated.span;
        let late = |message: &str, first: Span, label: &str| {
            Diagnostic::new(&codes::LATE_VERSION, span, message).label(first, label).help("make it the first line")
        };
        if self.version_seen {
            let finding = late("there is a second `#version`", self.version.span, "the first");
            session.report(finding.help("take it out: the first one is for the whole shader, with what it includes"));
            return false;
        }
        if let Some(first) = self.first_token {
            session.report(late("`#version` does not come first", first, "this comes before it"));
        } else if let Some(first) = self.text_before(session, stated) {
            let message = format!("`#version` is not in the first line, as {} wants it", stated.name());
            let fix = to_first_line(session, first, span);
            session.report(late(&message, first, "the first line").fix(fix));
        } else if let Some(first) = self.before_version {
            let diagnostic = kind::BEFORE_VERSION
                .diagnostic(self.strict, first, "a directive before `#version`")
                .label(span, "this must come first");
            session.report(diagnostic);
        }
        true
    }

    /// The begin of a text in which the directive is not in the first line, where the language wants it there: "The directive is only
    /// permitted in the first line of a shader" (GLSL ES 3.00 §3.4). Blank lines with spaces may be what is left of a file with
    /// more than one shader, and do not count.
    fn text_before(&self, session: &ParseSession<'_>, stated: Version) -> Option<Span> {
        let main = self.frames.first().filter(|_| stated.has(Feature::VersionOnFirstLine))?;
        let source = session.sources.file(main.file);
        let base = source.base();
        let before = source.text().get(..stated.span.start.checked_sub(base)? as usize)?;
        let before = before.strip_prefix('\u{feff}').unwrap_or(before);
        let is_first = !before.contains(['\n', '\r']) && before.trim_start().is_empty();
        let is_left_over = before.trim_start().is_empty() && before.contains([' ', '\t']);
        (!is_first && !is_left_over).then(|| Span::new(base, base))
    }

    fn set_version(
        &mut self,
        session: &mut ParseSession<'_>,
        mut version: Version,
        named: &str,
        number: Span,
        profile: Span,
    ) {
        self.version = version;
        session.version = version;
        let Some(edition) = EDITIONS.iter().find(|edition| edition.number == version.number) else {
            let numbers: BTreeSet<u16> = EDITIONS.iter().map(|edition| edition.number).collect();
            let numbers: Vec<_> = numbers.iter().map(u16::to_string).collect();
            let diagnostic = Diagnostic::new(
                &codes::UNKNOWN_VERSION,
                number,
                format!("there is no GLSL version {}", version.number),
            )
            .note(format!("the versions are {}", numbers.join(", ")))
            .help(HELP);
            session.report(diagnostic);
            self.outcome.supported = false;
            return self.stop();
        };
        let wanted = match named {
            "" if edition.es => {
                if version.number >= 300 {
                    let message =
                        format!("`#version {}` is a version of ES, and lacks the profile `es`", version.number);
                    let whole = format!("write `#version {} es`", version.number);
                    // The profile "is not optional and must be es" (GLSL 4.60 §3.3).
                    session.report(Diagnostic::new(&codes::UNKNOWN_VERSION, number, message).help(whole));
                }
                Some(Profile::Es)
            }
            "" | "core" if named.is_empty() || edition.has_profiles() => Some(Profile::Core),
            "compatibility" if edition.has_profiles() => Some(Profile::Compatibility),
            "es" if edition.es && version.number >= 300 => Some(Profile::Es),
            _ => None,
        };
        let Some(wanted) = wanted else {
            let message = format!("GLSL {} has no profile `{named}`", version.number);
            let help = if edition.has_profiles() { "the profiles are `core` and `compatibility`" } else { HELP };
            session.report(Diagnostic::new(&codes::UNKNOWN_VERSION, profile, message).help(help));
            return;
        };
        version.profile = wanted;
        self.version = version;
        session.version = version;
        self.apply_version(session);
    }

    /// Sets the keywords and macros of the version.
    fn apply_version(&mut self, session: &mut ParseSession<'_>) {
        self.set_keywords();
        let joins_comments = self.joins_lines();
        if let Some(frame) = self.frames.last_mut() {
            frame.lexer.joins_comments = joins_comments;
        }
        self.define_version(session);
    }

    /// Gives each word the kind that it has in the version with the enabled extensions.
    pub(super) fn set_keywords(&mut self) {
        self.kinds = keywords::kinds_in(self.version, self.extensions);
        for (word, kind) in self.words.iter_mut().zip(&self.kinds) {
            word.kind = *kind;
        }
    }

    /// Handles the end of the main file.
    pub(super) fn at_end(&mut self, session: &mut ParseSession<'_>) {
        if self.version_seen || self.stopped {
            return;
        }
        self.version_seen = true;
        if self.first_token.or(self.before_version).is_some() {
            return;
        }
        self.outcome.supported = false;
        let span = self.frames.first().map_or(Span::default(), |frame| {
            let base = session.sources.file(frame.file).base();
            Span::new(base, base)
        });
        let diagnostic = Diagnostic::new(&general::EMPTY_SOURCE, span, "the source is empty")
            .help("a shader begins with `#version 150` and defines `void main()`");
        session.report(diagnostic);
        self.stop();
    }
}
