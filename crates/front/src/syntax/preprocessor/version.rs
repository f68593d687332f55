//! `#version`, and the end of the main file, where the lack of one is known (GLSL 1.50 §3.3).

use super::{Mode, ParseSession, Preprocessor, Profile, Span, Token, TokenKind, Version, codes, keywords, kind};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Edit, Fix, Place, codes::general};
use crate::language::{EDITIONS, Edition, Feature};
use crate::source::{is_replaced, version_line};
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

/// The words for profiles.
const PROFILES: [&str; 3] = ["core", "compatibility", "es"];

/// The language that the `#version` line of a text states, for the lines before it: from GLSL 4.20 on, a backslash joins lines before comments are
/// read (4.60 §3.3), also there. A line that would itself be joined to a comment says nothing.
pub(in crate::syntax) fn announced(text: &str) -> Option<Version> {
    if !text.contains('\\') {
        return None;
    }
    let line = version_line(text)?;
    let above = text.get(..line.start)?.trim_end_matches([' ', '\t']);
    let above = above.strip_suffix('\n').unwrap_or(above);
    if above.strip_suffix('\r').unwrap_or(above).ends_with('\\') {
        return None;
    }
    let mut words = text.get(line)?.trim_start_matches('#').split_whitespace().skip(1);
    let number = words.next()?.parse().ok()?;
    let profile = if words.next() == Some("es") { Profile::Es } else { Profile::Core };
    Some(Version { number, profile, ..UNWRITTEN })
}

impl Preprocessor<'_> {
    /// `#version number profile`, without macro expansion.
    pub(super) fn version(&mut self, session: &mut ParseSession<'_>, directive: Span) {
        let number = self.line_token(session);
        let spelling =
            if number.kind == TokenKind::Number { session.spelling(number).to_owned() } else { String::new() };
        let (digits, attached) = parts(&spelling);
        let Ok(parsed) = digits.parse::<u16>() else { return self.version_by_name(session, number) };
        let mut span = session.sources.join(directive, number.span);
        let profile = self.line_token(session);
        let (named, rest) = if !attached.is_empty() {
            let message = format!("`{attached}` is a word of its own");
            let finding = Diagnostic::new(&codes::MALFORMED_DIRECTIVE, number.span, message);
            session.report(finding.help(Advice::write(Applicability::Safe, format!("{digits} {attached}"))));
            (attached.to_owned(), profile)
        } else if profile.kind == TokenKind::Word {
            span = session.sources.join(span, profile.span);
            let named = session.spelling(profile).to_owned();
            (named, self.line_token(session))
        } else {
            (String::new(), profile)
        };
        let profile_here = if named == "es" { Profile::Es } else { Profile::Core };
        let stated = Version { number: parsed, profile: profile_here, span };
        self.end_version_line(session, rest, stated);
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

    /// Whether a text begins with `version 150`, whose `#` is missing.
    pub(super) fn is_bare_version(&self, session: &mut ParseSession<'_>, token: Token) -> bool {
        if self.first_token.is_some() || self.version_seen || session.spelling(token) != "version" {
            return false;
        }
        let Some(mut lexer) = self.frames.last().map(|frame| frame.lexer.clone()) else { return false };
        let next = lexer.next(Mode::Directive, &mut session.names, &mut Vec::new());
        next.kind == TokenKind::Number
    }

    /// Reports the missing `#`, and reads the directive.
    pub(super) fn bare_version(&mut self, session: &mut ParseSession<'_>, token: Token) {
        let help = Advice::new(Applicability::Safe, "put `#` in front of it", Place::Before, "#");
        let finding = Diagnostic::new(&codes::MALFORMED_DIRECTIVE, token.span, "`version` without `#` is no directive");
        session.report(finding.here("expected `#version`").help(help));
        self.version(session, token.span);
        self.enter_preludes(session);
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

    /// Reports text after a complete `#version`, by the rule of the version that it states.
    fn end_version_line(&mut self, session: &mut ParseSession<'_>, token: Token, stated: Version) {
        if matches!(token.kind, TokenKind::Newline | TokenKind::Eof) {
            return;
        }
        let message = "there is text after the complete `#version`";
        session.report(kind::EXTRA_TEXT.judged(stated, self.strict, token.span, message));
        self.skip_line(session);
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
            self.outcome.late_version = Some(span);
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
            .help(meant_by(version.number, named));
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
        // What follows is read as what was meant.
        version.profile = wanted.unwrap_or(if edition.es { Profile::Es } else { Profile::Core });
        if wanted.is_none() {
            let message = format!("{} has no profile `{named}`", version.name());
            session.report(Diagnostic::new(&codes::UNKNOWN_VERSION, profile, message).help(right_profile(edition)));
        }
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

/// The digits of a version, and the word for a profile that follows them without a space.
fn parts(spelling: &str) -> (&str, &str) {
    let end = spelling.find(|sign: char| !sign.is_ascii_digit()).unwrap_or(spelling.len());
    let (digits, rest) = spelling.split_at(end);
    if rest.is_empty() || PROFILES.contains(&rest) { (digits, rest) } else { ("", "") }
}

/// The line for a number that is no version. The numbers of OpenGL and of OpenGL ES are others than those of their languages.
fn meant_by(number: u16, profile: &str) -> String {
    let line = match (number, profile) {
        (200, "es") => return "OpenGL ES 2.0 has the language 1.00: write `#version 100`".to_owned(),
        (_, "es") => "300 es",
        (200, _) => return "OpenGL 2.0 has the language 1.10: write `#version 110`".to_owned(),
        (210, _) => return "OpenGL 2.1 has the language 1.20: write `#version 120`".to_owned(),
        _ => return format!("write `#version {}`", completed(number).unwrap_or_else(|| nearest(number))),
    };
    format!("write `#version {line}`")
}

/// The version of OpenGL's language whose last digits are missing: 330 of 33.
fn completed(number: u16) -> Option<u16> {
    let mut known = EDITIONS.iter().filter(|edition| !edition.es).map(|edition| edition.number);
    known.find(|known| number > 9 && known / 10 == number)
}

/// The version of OpenGL's language whose number is the nearest.
fn nearest(number: u16) -> u16 {
    let numbers = EDITIONS.iter().filter(|edition| !edition.es).map(|edition| edition.number);
    numbers.min_by_key(|known| known.abs_diff(number)).unwrap_or(150)
}

/// How the line of a version ends.
fn right_profile(edition: &Edition) -> String {
    let number = edition.number;
    match (edition.es, edition.has_profiles()) {
        (true, _) if number >= 300 => format!("write `#version {number} es`"),
        (_, true) => "the profiles are `core` and `compatibility`".to_owned(),
        _ => format!("write `#version {number}` alone: profiles came with GLSL 1.50 and GLSL ES 3.00"),
    }
}
