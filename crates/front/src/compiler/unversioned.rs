//! The language of a source that has no `#version` line, where the source shows it.
//!
//! *In:* a source as its engine completes it. *Out:* the version of ES that it is written in, if nothing says its version and it has
//! precision qualifiers, which GLSL 1.10 does not have: 1.00, or 3.00 if that reads what 1.00 does not. *Holds:* the conditions of the
//! preprocessor decide: a qualifier between `#ifdef GL_ES` and `#endif` shows nothing, since 1.10 skips it. A source whose words no
//! version of ES has stays one of 1.10.

use super::{Compiler, Prepared, Source};
use crate::analysis::analyze;
use crate::diagnostic::codes::names::BUILTIN_UNAVAILABLE;
use crate::diagnostic::codes::preprocess::{ASSUMED_VERSION, MISSING_VERSION};
use crate::diagnostic::codes::qualifiers::NEEDS_EXTENSION;
use crate::diagnostic::codes::syntax::RESERVED_WORD;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::hir::Types;
use crate::language::Feature;
use crate::source::{SourceMap, version_line};
use crate::syntax::{self, ParseOptions};
use std::sync::Arc;

/// The words that only ES has in its first version.
const WORDS: [&str; 4] = ["precision", "highp", "mediump", "lowp"];

/// The versions of ES that are tried, as a `#version` line has them.
const TRIED: [&str; 2] = ["100", "300 es"];

/// A version that a source is read in although it does not say so.
pub(super) struct Assumed {
    /// The version, as a `#version` line has it.
    pub(super) version: &'static str,
    /// The place in the source of what shows it.
    place: (u32, u32),
}

impl Assumed {
    /// The warning about it, for a source whose text begins at an offset.
    pub(super) fn warning(&self, base: u32) -> Diagnostic {
        let span = crate::source::Span::new(base + self.place.0, base + self.place.1);
        let name = if self.version == "100" { "GLSL ES 1.00" } else { "GLSL ES 3.00" };
        let message = format!("the source has no `#version` line, and is read as {name}");
        Diagnostic::new(&ASSUMED_VERSION, span, message)
            .here("a precision: OpenGL's language of that time, GLSL 1.10, has none")
            .help(format!("begin the source with `#version {0}`, or say `--assume-version \"{0}\"`", self.version))
    }
}

/// The freedoms of OpenGL's language that people take in ES by mistake.
const MISTAKES: [Feature; 4] =
    [Feature::ImplicitToFloat, Feature::ImplicitToUint, Feature::ArrayObjects, Feature::IntegerOperators];

fn is_mistake(found: &Diagnostic) -> bool {
    found.lacking.is_some_and(|feature| MISTAKES.contains(&feature))
}

/// The errors of a source that was read in some version.
struct Errors {
    /// Words, functions and constructs that the version lacks.
    words: usize,
    /// [Mistakes](MISTAKES).
    rules: usize,
    all: usize,
}

impl Compiler {
    /// The version that the source shows, if nothing says it.
    pub(super) fn assumed(&self, source: &Source, prepared: &Prepared) -> Option<Assumed> {
        let text = prepared.text.as_ref().unwrap_or(&source.text);
        let completion = &prepared.completion;
        let is_said = completion.assumed_version.is_some()
            || completion.preludes.iter().any(|prelude| version_line(&prelude.text).is_some());
        if is_said || !WORDS.iter().any(|word| text.contains(word)) || version_line(text).is_some() {
            return None;
        }
        let place = self.trial(source, prepared, None, |found, map| {
            let shows =
                |one: &&Diagnostic| *one.code == MISSING_VERSION && WORDS.contains(&map.snippet(one.primary.span));
            let span = map.call_site(found.iter().find(shows)?.primary.span);
            let (_, file) = map.files().next()?;
            let is_own = (file.base()..=file.end()).contains(&span.start);
            is_own.then(|| (span.start - file.base(), span.end - file.base()))
        })?;
        let errors = TRIED.map(|version| {
            self.trial(source, prepared, Some(version), |found, _| {
                let count = |is_it: &dyn Fn(&Diagnostic) -> bool| found.iter().filter(|one| is_it(one)).count();
                let is_word = |one: &Diagnostic| [&BUILTIN_UNAVAILABLE, &RESERVED_WORD].contains(&one.code);
                let is_rule = |one: &Diagnostic| *one.code == NEEDS_EXTENSION;
                Errors {
                    words: count(&|one| is_word(one) || is_rule(one) && !is_mistake(one)),
                    rules: count(&|one| is_rule(one) && is_mistake(one)),
                    all: found.iter().filter(|one| one.is_error()).count(),
                }
            })
        });
        let tried = || TRIED.into_iter().zip(&errors);
        // A version that lacks what the source uses is not its own, unless they all do: then the source has a mistake.
        let fitting =
            tried().filter(|(_, errors)| errors.words + errors.rules == 0).min_by_key(|(_, errors)| errors.all);
        let mistaken = || tried().filter(|(_, errors)| errors.words == 0).min_by_key(|(_, errors)| errors.rules);
        let (version, _) = fitting.or_else(mistaken)?;
        Some(Assumed { version, place })
    }

    /// Reads a source in a version, for what is found then.
    fn trial<T>(
        &self,
        source: &Source,
        prepared: &Prepared,
        version: Option<&str>,
        judged: impl FnOnce(&Diagnostics, &SourceMap) -> T,
    ) -> T {
        let (mut map, mut types, mut found) = (SourceMap::default(), Types::new(), Diagnostics::default());
        let text = prepared.text.as_ref().unwrap_or(&source.text);
        if let Some(file) = map.add(source.name.as_str(), Arc::clone(text)) {
            let mut completion = prepared.completion.clone();
            completion.assumed_version = version.map(str::to_owned);
            let (strict, defines) = (self.options.strict, prepared.defines.clone());
            let options = ParseOptions { stage: source.stage, defines, strict, completion };
            let includes = prepared.includes.as_ref().unwrap_or(&self.includes);
            let ast = syntax::parse(&mut map, file, &options, &**includes, &mut found);
            analyze(&ast, source.stage, strict, &mut types, &map, &mut found);
        }
        judged(&found, &map)
    }
}
