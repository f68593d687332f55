//! `#version`, and the end of the main file, where the lack of one is known (GLSL 1.50 §3.3).

use super::{ParseSession, Preprocessor, Profile, Span, Token, TokenKind, Version, codes, keywords, kind};
use crate::diagnostic::{Diagnostic, codes::general};

/// The newest version that glisten compiles; it also reads texts without a version.
pub(super) const NEWEST_SUPPORTED: u16 = 150;

/// A version of the language.
struct Edition {
    number: u16,
    /// Whether it is for embedded systems; its `#version` line ends in `es` from 300 on.
    es: bool,
    /// Whether it has profiles.
    profiles: bool,
    supported: bool,
}

const fn edition(number: u16, es: bool, profiles: bool, supported: bool) -> Edition {
    Edition { number, es, profiles, supported }
}

/// All versions.
static EDITIONS: &[Edition] = &[
    edition(100, true, false, false),
    edition(110, false, false, false),
    edition(120, false, false, false),
    edition(130, false, false, false),
    edition(140, false, false, false),
    edition(150, false, true, true),
    edition(300, true, false, false),
    edition(310, true, false, false),
    edition(320, true, false, false),
    edition(330, false, true, false),
    edition(400, false, true, false),
    edition(410, false, true, false),
    edition(420, false, true, false),
    edition(430, false, true, false),
    edition(440, false, true, false),
    edition(450, false, true, false),
    edition(460, false, true, false),
];

const HELP: &str = "write `#version 150`";

impl Preprocessor<'_> {
    /// `#version number profile`, without macro expansion.
    pub(super) fn version(&mut self, session: &mut ParseSession<'_>, directive: Span) {
        let number = self.line_token(session);
        let parsed: Option<u16> =
            if number.kind == TokenKind::Number { session.spelling(number).parse().ok() } else { None };
        let Some(parsed) = parsed else {
            self.version_seen = true;
            return self.malformed(session, number, "`#version` needs a number such as 150");
        };
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
        if !self.check_place(session, span) {
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

    fn end_line_with_extra(&mut self, session: &mut ParseSession<'_>, token: Token) {
        if !matches!(token.kind, TokenKind::Newline | TokenKind::Eof) {
            kind::EXTRA_TEXT.report(session, self.strict, token.span, "there is text after the complete `#version`");
            self.skip_line(session);
        }
    }

    /// Whether the directive is valid here: it is the first, and no token comes before it.
    fn check_place(&mut self, session: &mut ParseSession<'_>, span: Span) -> bool {
        let late = |message: &str, first: Span, label: &str| {
            Diagnostic::new(&codes::LATE_VERSION, span, message).label(first, label).help("make it the first line")
        };
        if self.version_seen {
            session.report(late("there is a second `#version`", self.version.span, "the first"));
            return false;
        }
        if let Some(first) = self.first_token {
            session.report(late("`#version` does not come first", first, "this comes before it"));
        } else if let Some(first) = self.before_version {
            let diagnostic = kind::BEFORE_VERSION
                .diagnostic(self.strict, first, "a directive before `#version`")
                .label(span, "this must come first");
            session.report(diagnostic);
        }
        true
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
        let Some(edition) = EDITIONS.iter().find(|edition| edition.number == version.number) else {
            let numbers: Vec<_> = EDITIONS.iter().map(|edition| edition.number.to_string()).collect();
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
            "" if edition.es => Some(Profile::Es),
            "" | "core" if named.is_empty() || edition.profiles => Some(Profile::Core),
            "compatibility" if edition.profiles => Some(Profile::Compatibility),
            "es" if edition.es && version.number >= 300 => Some(Profile::Es),
            _ => None,
        };
        let Some(wanted) = wanted else {
            let message = format!("GLSL {} has no profile `{named}`", version.number);
            let help = if edition.profiles { "the profiles are `core` and `compatibility`" } else { HELP };
            session.report(Diagnostic::new(&codes::UNKNOWN_VERSION, profile, message).help(help));
            return;
        };
        version.profile = wanted;
        self.version = version;
        if edition.supported && wanted == Profile::Core {
            self.apply_version(session);
            return;
        }
        let (span, message) = if edition.supported {
            (profile, format!("the {named} profile of GLSL {} is not supported yet", version.number))
        } else {
            (number, format!("GLSL version {} is not supported yet", version.number))
        };
        let diagnostic = Diagnostic::new(&codes::UNSUPPORTED_VERSION, span, message)
            .here("glisten compiles version 150 with the core profile")
            .help(HELP);
        session.report(diagnostic);
        self.outcome.supported = false;
        self.stop();
    }

    /// Sets the keywords and `__VERSION__` of the version.
    fn apply_version(&mut self, session: &mut ParseSession<'_>) {
        if self.version.number == NEWEST_SUPPORTED {
            return;
        }
        self.kinds = keywords::kinds_in(self.version.number);
        for (word, kind) in self.words.iter_mut().zip(&self.kinds) {
            word.kind = *kind;
        }
        let number = session.names.intern(&self.version.number.to_string()).bits();
        let name = session.names.intern("__VERSION__");
        let definition = self.macro_of(name).and_then(|index| self.macros.get_mut(index));
        if let Some(definition) = definition {
            definition.body = definition.body.iter().map(|token| Token { payload: number, ..*token }).collect();
        }
    }

    /// Handles the end of the main file.
    pub(super) fn at_end(&mut self, session: &mut ParseSession<'_>) {
        if self.version_seen || self.stopped {
            return;
        }
        self.version_seen = true;
        self.outcome.supported = false;
        // The first token may be in an included file; the line belongs in the main file.
        let main = self.frames.first().map(|frame| frame.file);
        let in_main = |span: &Span| session.sources.file_of(session.sources.call_site(*span)) == main;
        let places = [self.first_token, self.before_version];
        let first = places.into_iter().flatten().find(in_main).or(self.first_token.or(self.before_version));
        let Some(first) = first else {
            let span = self.frames.first().map_or(Span::default(), |frame| {
                let base = session.sources.file(frame.file).base();
                Span::new(base, base)
            });
            let diagnostic = Diagnostic::new(&general::EMPTY_SOURCE, span, "the source is empty")
                .help("a shader begins with `#version 150` and defines `void main()`");
            session.report(diagnostic);
            return self.stop();
        };
        self.version = Version { number: 110, profile: Profile::Core, span: Span::default() };
        let diagnostic = Diagnostic::new(&codes::MISSING_VERSION, first, "the source has no `#version` line")
            .here("such a line belongs before this")
            .note("without it the language is GLSL 1.10, which glisten does not support yet")
            .help("begin the source with `#version 150`");
        session.report(diagnostic);
    }
}
