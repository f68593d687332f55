//! Texts that do not state their version and use what their language does not have.
//!
//! *In:* a finding that the language lacks something. *Out:* the same, or the error that the version is missing (§3.3).

use super::keywords::TABLE;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::preprocess::MISSING_VERSION;
use crate::language::{NEVER, Version};

/// The finding that the language lacks something. Where the text does not state its version, that is the error.
pub(crate) fn of_version(finding: Diagnostic, version: Version) -> Diagnostic {
    if version.span.is_known() {
        return finding;
    }
    let Diagnostic { message, primary, .. } = finding;
    Diagnostic::new(&MISSING_VERSION, primary.span, "the source has no `#version` line")
        .here(message)
        .note("without it the language is GLSL 1.10")
        .help("begin the source with the line of its version, such as `#version 150`, or say `--assume-version 150`")
}

/// The error that the version is missing, if the word is a keyword of later versions alone and the text states none.
pub(crate) fn of_later_word(finding: Diagnostic, word: &str, version: Version) -> Diagnostic {
    let is_later = |version: Version| {
        let mut rows = TABLE.iter().filter(|row| row.spelling == word);
        rows.any(|row| row.keyword.desktop != NEVER && !version.reaches(row.keyword))
    };
    if version.span.is_known() || !is_later(version) {
        return finding;
    }
    of_version(Diagnostic { message: format!("`{word}` is not in {}", version.name()), ..finding }, version)
}
