//! `#extension` (GLSL 1.50 §3.3), and the names of all registered extensions.

use super::{Behavior, Extensions, Feature, ParseSession, Preprocessor, Profile, Span, Token, TokenKind, codes, kind};
use crate::diagnostic::{Advice, Diagnostic, did_you_mean};
use crate::language::EXTENSIONS;
use std::sync::LazyLock;

/// Every extension name of the OpenGL and OpenGL ES registries and of the Khronos GLSL repository, sorted, one on
/// each line.
static REGISTERED: &str = include_str!("extensions.txt");

/// The names of [`REGISTERED`], for lookup.
static NAMES: LazyLock<Vec<&'static str>> = LazyLock::new(|| REGISTERED.lines().collect());

fn is_registered(name: &str) -> bool {
    NAMES.binary_search(&name).is_ok()
}

/// The warning for a use of a feature that any of `bringing` provides, where `on` are enabled: there is one if every
/// enabled extension that allows the use is enabled with `warn` (§3.3).
pub(crate) fn warning_of_use(on: Extensions, bringing: Extensions, span: Span) -> Option<Diagnostic> {
    let warned = on.to_warn_of(bringing)?;
    let name = warned.name().unwrap_or("an extension");
    let message = format!("this is not in the language without `{name}`");
    let diagnostic = Diagnostic::new(&codes::EXTENSION_USED, span, message).here("a use of the extension");
    Some(diagnostic.note("`#extension` requests a warning for each use"))
}

/// The behaviors by name.
static BEHAVIORS: &[(&str, Behavior)] = &[
    ("require", Behavior::Require),
    ("enable", Behavior::Enable),
    ("warn", Behavior::Warn),
    ("disable", Behavior::Disable),
];

impl Preprocessor<'_> {
    /// `#extension name : behavior`, without macro expansion.
    pub(super) fn extension(&mut self, session: &mut ParseSession<'_>, directive: Span) {
        let name = self.line_token(session);
        if name.kind != TokenKind::Word {
            return self.malformed(session, name, "`#extension` needs the name of an extension or `all`");
        }
        let colon = self.line_token(session);
        if colon.kind != TokenKind::Colon {
            self.malformed(session, colon, "`#extension` needs `:` and a behavior after the name");
            return self.enable_meant(session, name);
        }
        let behavior = self.line_token(session);
        let spelled =
            if behavior.kind == TokenKind::Word { session.spelling(behavior).to_owned() } else { String::new() };
        let Some(meant) = BEHAVIORS.iter().find(|row| row.0 == spelled).map(|row| row.1) else {
            let message = "the behavior is `require`, `enable`, `warn` or `disable`";
            self.malformed(session, behavior, message);
            return self.enable_meant(session, name);
        };
        let rest = self.line_token(session);
        if !matches!(rest.kind, TokenKind::Newline | TokenKind::Eof) {
            return self.malformed(session, rest, "`#extension` ends after its behavior");
        }
        if self.is_import_extension(session.spelling(name)) {
            return;
        }
        let span = session.sources.join(directive, behavior.span);
        if let Some(first) = self.first_token {
            let diagnostic = kind::LATE_EXTENSION
                .judged(self.version, self.strict, span, "`#extension` after the first token")
                .label(first, "the first token");
            session.report(diagnostic);
        }
        let spelled = session.spelling(name).to_owned();
        let before = self.extensions;
        self.set_behavior(session, name, &spelled, meant, span);
        self.extensions_changed(session, before);
    }

    /// Enables the extension of a line that is malformed, so that its uses raise no more messages.
    fn enable_meant(&mut self, session: &mut ParseSession<'_>, name: Token) {
        let before = self.extensions;
        let spelled = session.spelling(name);
        if let Some(row) = EXTENSIONS.iter().find(|row| row.name == spelled && row.is_for(self.version)) {
            self.extensions.insert(row.bit);
        }
        self.extensions_changed(session, before);
    }

    fn extensions_changed(&mut self, session: &mut ParseSession<'_>, before: Extensions) {
        if self.extensions != before {
            self.extension_set = session.extension_sets.number(self.extensions);
            self.set_keywords();
        }
        let joins_comments = self.joins_lines();
        if let Some(frame) = self.frames.last_mut() {
            frame.lexer.joins_comments = joins_comments;
        }
    }

    fn set_behavior(
        &mut self,
        session: &mut ParseSession<'_>,
        token: Token,
        name: &str,
        behavior: Behavior,
        span: Span,
    ) {
        if name == "all" {
            return self.set_all(session, token, behavior);
        }
        if name == "GL_ARB_compatibility" && self.version.has(Feature::CompatibilityExtension) {
            return self.set_compatibility(session, behavior);
        }
        let version = self.version;
        if let Some(row) = EXTENSIONS.iter().find(|row| row.name == name && row.is_for(version)) {
            self.extensions.set(row.bit, behavior != Behavior::Disable);
            self.extensions.set_warned(row.bit, behavior == Behavior::Warn);
            if behavior != Behavior::Disable {
                self.outcome.extension_lines.push((name.to_owned(), behavior, span));
            }
            return;
        }
        let registered = is_registered(name);
        let required = behavior == Behavior::Require;
        // It is disabled already.
        if registered && behavior == Behavior::Disable {
            return;
        }
        let code = match (required, registered) {
            (false, _) => &codes::EXTENSION_IGNORED,
            (true, true) => &codes::UNSUPPORTED_EXTENSION,
            (true, false) => &codes::UNKNOWN_EXTENSION,
        };
        let (message, help) = if registered {
            (format!("the extension `{name}` is not supported"), None)
        } else {
            let names = REGISTERED.lines().chain(EXTENSIONS.iter().map(|row| row.name));
            let near = if session.may_suggest() { did_you_mean(name, names) } else { None };
            let near = near.map(Advice::meant);
            (format!("there is no extension `{name}`"), near)
        };
        let here = if required { "and the source requires it" } else { "the line is ignored" };
        session.report(Diagnostic::new(code, token.span, message).here(here).maybe_help(help));
    }

    /// GL_ARB_compatibility makes the core of 1.40 and later versions the compatibility profile.
    fn set_compatibility(&mut self, session: &mut ParseSession<'_>, behavior: Behavior) {
        if behavior != Behavior::Disable {
            self.version.profile = Profile::Compatibility;
            self.define_version(session);
        }
    }

    fn set_all(&mut self, session: &mut ParseSession<'_>, token: Token, behavior: Behavior) {
        match behavior {
            Behavior::Disable => self.extensions = Extensions::empty(),
            Behavior::Warn => self.extensions = Extensions::all(),
            Behavior::Enable | Behavior::Require => {
                let message = "`all` extensions can only be disabled or warned about";
                let diagnostic = Diagnostic::new(&codes::EXTENSION_FOR_ALL, token.span, message)
                    .help("name each extension that the source uses");
                session.report(diagnostic);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_that_is_implemented_is_registered() {
        for row in EXTENSIONS {
            assert!(is_registered(row.name), "{}", row.name);
        }
        assert!(REGISTERED.lines().is_sorted());
    }
}
