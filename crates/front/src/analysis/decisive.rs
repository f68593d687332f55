//! Errors that explain all others of a shader: its language is not the one that it is written in (`E0120`), or it has a
//! feature that glisten does not support (`E0001`), or requires such an extension (`E0125`).
//!
//! *In:* the diagnostics of one shader. *Out:* the same, without the errors that follow from a decisive one.

use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::preprocess::{LATE_VERSION, MISSING_VERSION, UNSUPPORTED_EXTENSION};
use crate::diagnostic::codes::qualifiers::{MISSING_PRECISION, UNKNOWN_LAYOUT};
use crate::diagnostic::codes::types::UNSIZED_ARRAY;
use crate::diagnostic::{Area, Code, Diagnostic, Diagnostics};
use crate::language::Feature;
use crate::source::Span;

/// The label of an unsupported variable, function or constant. It declares nothing, so that no error follows from it.
pub(super) const UNKNOWN_VALUE: &str = "its value is not known here";

/// How many bytes the qualifiers before a keyword take at most.
const QUALIFIERS: u32 = 64;

/// The features that people take for granted in every version: a text that uses one may be of the version that it is read in.
const FOR_GRANTED: [Feature; 3] = [Feature::ImplicitToFloat, Feature::ImplicitToUint, Feature::FloatSuffix];

/// Drops what follows from a decisive error, among the diagnostics from number `first` on: with a missing version all
/// other errors but those of tokens before the place that shows it, or all before it if that is taken for granted;
/// after an unsupported feature or extension those of the syntax and the meaning of the text. `late` is a `#version` line that
/// tokens come before.
pub fn keep_decisive(diagnostics: &mut Diagnostics, first: usize, late: Option<Span>) {
    if diagnostics.iter().skip(first).any(|found| *found.code == LATE_VERSION) {
        // There is a `#version` line, and what comes before it was read without.
        let before = late.map_or(0, |line| line.start);
        let mut index = 0;
        diagnostics.retain_mut(|found| {
            index += 1;
            let is_syntax = found.is_error() && found.code.area() == Area::Syntax && found.primary.span.start < before;
            let is_precision = *found.code == MISSING_PRECISION && before > 0;
            index <= first || !(is_syntax || is_precision || *found.code == MISSING_VERSION)
        });
    }
    let place = |code: &Code| {
        let found = diagnostics.iter().skip(first).position(|diagnostic: &Diagnostic| *diagnostic.code == *code);
        found.map(|place| place + first)
    };
    let version = first_in_text(diagnostics, first);
    let is_feature = |found: &Diagnostic| [&NOT_SUPPORTED_YET, &UNSUPPORTED_EXTENSION].contains(&found.code);
    let declares = |found: &Diagnostic| is_feature(found) && found.primary.message != UNKNOWN_VALUE;
    let feature = diagnostics.iter().skip(first).position(declares).map(|place| place + first);
    let is_extension = place(&UNSUPPORTED_EXTENSION).is_some();
    let start_of = |index: Option<usize>| {
        index.and_then(|index| diagnostics.iter().nth(index)).map_or(0, |diagnostic| diagnostic.primary.span.start)
    };
    let version_start = start_of(version);
    let shown = version.and_then(|index| diagnostics.iter().nth(index)).and_then(|found| found.lacking);
    let is_for_granted = shown.is_some_and(|feature| FOR_GRANTED.contains(&feature));
    let start = diagnostics.iter().nth(feature.unwrap_or(0)).map_or(0, |diagnostic| diagnostic.primary.span.start);
    let mut messages: Vec<String> = Vec::new();
    let mut index = 0;
    diagnostics.retain_mut(|diagnostic| {
        let own = index;
        index += 1;
        if own < first || !diagnostic.is_error() {
            return true;
        }
        if version.is_some() {
            // What is wrong with the tokens before is so in every version. All else may follow from what is not there: the macros and
            // the version of an engine.
            let is_of_tokens = matches!(diagnostic.code.area(), Area::Preprocess | Area::Syntax);
            let is_before = diagnostic.primary.span.start < version_start && *diagnostic.code != MISSING_VERSION;
            return Some(own) == version || is_before && (is_of_tokens || is_for_granted);
        }
        if !is_feature(diagnostic) {
            if feature.is_none() {
                return true;
            }
            // What is of a feature has no type here, so that an error of types does not follow from it. Arrays without a size are
            // of storage blocks, and of extensions.
            let follows = matches!(diagnostic.code.area(), Area::Syntax | Area::Names | Area::Qualifiers)
                || *diagnostic.code == UNSIZED_ARRAY
                || is_extension && matches!(diagnostic.code.area(), Area::Types | Area::Statements);
            // A layout that is not known may be of the feature's declaration, and what is just before it is its qualifiers.
            let own = diagnostic.primary.span;
            let is_qualifier =
                diagnostic.code.area() == Area::Qualifiers && start.saturating_sub(own.start) < QUALIFIERS;
            let is_layout = *diagnostic.code == UNKNOWN_LAYOUT || is_qualifier;
            return !follows || (own.start < start && !is_layout);
        }
        // Each feature is named once.
        let is_new = !messages.contains(&diagnostic.message);
        messages.push(diagnostic.message.clone());
        is_new
    });
}

/// The number of the error about a missing version that is the first in the text, among the diagnostics from number `first` on. The
/// parser finds what it lacks before the analysis does.
fn first_in_text(diagnostics: &Diagnostics, first: usize) -> Option<usize> {
    let versions = diagnostics.iter().enumerate().skip(first).filter(|(_, found)| *found.code == MISSING_VERSION);
    versions.min_by_key(|(_, found)| found.primary.span.start).map(|(number, _)| number)
}
