//! Texts that do not state their version and use what their language does not have.
//!
//! *In:* a finding that the language lacks something. *Out:* the same, with what has it, or the error that the version is missing
//! (§3.3).

use super::keywords::{Keyword, TABLE};
use super::token::TokenKind;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::preprocess::MISSING_VERSION;
use crate::language::{NEVER, Since, Version};

/// The rest of the help for what a later version has and glisten does not support.
pub(crate) const NOT_YET: &str = "glisten does not support it yet";

/// The finding that the language lacks something. Where the text does not state its version, that is the error.
pub(crate) fn of_version(finding: Diagnostic, version: Version) -> Diagnostic {
    if version.span.is_known() {
        return finding;
    }
    let Diagnostic { message, primary, lacking, .. } = finding;
    let missing = Diagnostic::new(&MISSING_VERSION, primary.span, "the source has no `#version` line");
    Diagnostic { lacking, ..missing }
        .here(message)
        .note("without it the language is GLSL 1.10")
        .help("begin the source with the line of its version, such as `#version 150`, or say `--assume-version 150`")
}

/// The finding about a word that is a keyword of later versions alone: where the text states no version, that is the error; else the
/// help names the version or the extension that has the word.
pub(crate) fn of_later_word(finding: Diagnostic, word: &str, version: Version) -> Diagnostic {
    let is_later =
        |row: &&Keyword| row.spelling == word && row.keyword.desktop != NEVER && !version.reaches(row.keyword);
    let Some(row) = TABLE.iter().find(is_later) else { return finding };
    if version.span.is_known() {
        // Advice that needs no other version comes first.
        let has_own = finding.help.as_ref().is_some_and(|help| help.starts_with("write `"));
        let remedy = version.remedy(row.keyword, Since::NEVER, row.extensions).filter(|_| !has_own);
        let is_foreign = row.kind == TokenKind::Foreign;
        let remedy = remedy.map(|remedy| if is_foreign { format!("{remedy}; {NOT_YET}") } else { remedy });
        return match remedy {
            Some(remedy) => Diagnostic { help: Some(remedy), fixes: Vec::new(), ..finding },
            None => finding,
        };
    }
    of_version(Diagnostic { message: format!("`{word}` is not in {}", version.name()), ..finding }, version)
}
