//! [`upgrade`]: sources of older versions, rewritten for 1.50 core, 3.30, 4.50, 4.60 or ES 3.00.

use crate::error::Error;
use crate::program::{Format, Report};
use crate::settings::Settings;
use crate::sources::share_a_text;
use glisten::upgrade::{Refused, Target};
use glisten::{Compilation, Source};
use glisten_front::diagnostic::write::Finding;

/// The sources of a program in another language; or what is wrong with them.
#[derive(Debug, Default)]
pub struct Upgraded {
    report: Report,
    texts: Vec<String>,
    notes: Vec<String>,
}

/// Rewrites the sources of a program, as `glisten upgrade` does. Files that they include stay as they are.
///
/// # Errors
/// There are no sources, or there is no such version to write; two sources are stages of one text; a source is newer, or the version has no
/// counterpart for a name.
pub fn upgrade(settings: &Settings, sources: &[Source], version: &str) -> Result<Upgraded, Error> {
    if sources.is_empty() {
        return Err(Error::argument("there are no sources"));
    }
    if share_a_text(sources) {
        return Err(Error::argument(
            "a source has several stages, and each stage becomes a text: give one source for each",
        ));
    }
    let Some((_, target)) = Target::ALL.iter().find(|(word, _)| *word == version) else {
        let words = Target::ALL.map(|(word, _)| word).join(", ");
        return Err(Error::argument(format!("`{version}` is not a version to write: {words}")));
    };
    match glisten::upgrade::upgrade(&settings.compiler(), sources, *target) {
        Ok(done) => Ok(Upgraded { report: Report::default(), texts: done.texts, notes: done.notes }),
        Err(Refused::Wrong(compilation) | Refused::NotValid(compilation)) => {
            let Compilation { sources, diagnostics, .. } = *compilation;
            let report = Report { sources, diagnostics: diagnostics.into_iter().collect() };
            Ok(Upgraded { report, ..Upgraded::default() })
        }
        Err(refused) => Err(Error::content(refused.to_string())),
    }
}

impl Upgraded {
    /// Whether there are no errors, neither in the sources nor in the new texts.
    pub fn is_sound(&self) -> bool {
        !self.report.has_errors()
    }

    /// The new texts in the order of the sources; none if there are errors.
    pub fn texts(&self) -> &[String] {
        &self.texts
    }

    /// What the author of the host has to know.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// The diagnostics in the order of their places.
    pub fn findings(&self) -> Vec<Finding> {
        self.report.findings()
    }

    /// The diagnostics as a text.
    pub fn diagnostics(&self, format: Format) -> String {
        self.report.text(format)
    }
}

#[cfg(test)]
mod tests {
    use super::upgrade;
    use crate::error::Kind;
    use crate::program::Format;
    use crate::settings::Settings;
    use glisten::{Source, Stage};

    #[test]
    fn old_sources_become_new_ones() {
        let source = |text: &str| [Source { name: "a.frag".into(), text: text.into(), stage: Stage::Fragment }];
        let settings = Settings::default();
        let old = source("varying vec4 tint;\nvoid main() { gl_FragColor = tint; }\n");
        let done = upgrade(&settings, &old, "330").expect("it can be rewritten");
        assert!(done.is_sound() && done.texts()[0].contains("in vec4 tint;"), "{:?}", done.texts());
        let wrong = upgrade(&settings, &source("void main() { x; }\n"), "330").expect("it has errors");
        assert!(!wrong.is_sound() && wrong.texts().is_empty() && wrong.diagnostics(Format::Human).contains("`x`"));
        let refused = |text: &str, version| upgrade(&settings, &source(text), version).expect_err("refused");
        assert_eq!(refused("void main() {}\n", "440").kind, Kind::Argument);
        assert_eq!(refused("#version 330\nvoid main() {}\n", "150").kind, Kind::Content);
    }
}
