//! Texts of other languages, which somebody gave the name of a shader of GLSL.
//!
//! *In:* the diagnostics of one shader. *Out:* the same, or one error in place of all that follow from the language. *Holds:* what
//! the preprocessor skips shows nothing, so that a text of several languages stays one of GLSL.

use crate::diagnostic::codes::general::OTHER_LANGUAGE;
use crate::diagnostic::codes::preprocess::ILLEGAL_CHARACTER;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::source::SourceMap;

/// Attributes of WGSL, which follow a `@`.
const ATTRIBUTES: [&str; 8] =
    ["vertex", "fragment", "compute", "group", "binding", "builtin", "location", "workgroup_size"];
/// Semantics of HLSL, which follow a `:`. Digits may follow them, `_` stands for the rest of a name, `(` for arguments.
const SEMANTICS: [&str; 8] = ["SV_", "register(", "POSITION", "TEXCOORD", "NORMAL", "COLOR", "TANGENT", "packoffset("];

/// Keeps one error about the language, if an error from number `first` on shows another one.
pub fn keep_language(diagnostics: &mut Diagnostics, map: &SourceMap, first: usize) {
    let shown = diagnostics.iter().skip(first).filter(|found| found.is_error()).find_map(|found| language(found, map));
    let Some(finding) = shown else { return };
    let mut index = 0;
    diagnostics.retain_mut(|found| {
        index += 1;
        index <= first || !found.is_error()
    });
    diagnostics.push(finding);
}

/// The error about the language, if the place of an error shows it.
fn language(found: &Diagnostic, map: &SourceMap) -> Option<Diagnostic> {
    let span = found.primary.span;
    let file = map.file(map.file_of(span).filter(|_| !span.expansion.is_some())?);
    let text = file.text().get(span.start.checked_sub(file.base())? as usize..)?;
    let (name, words, translator) = if *found.code == ILLEGAL_CHARACTER && text.starts_with('@') {
        ("WGSL", ATTRIBUTES, "WGSL needs no translation for WebGPU")
    } else if text.starts_with(':') {
        ("HLSL", SEMANTICS, "translate it first, with DXC and SPIRV-Cross for example")
    } else {
        return None;
    };
    let after = text.get(1..)?.trim_start_matches([' ', '\t']);
    let word = words.iter().find(|word| is_word(after, word))?.trim_end_matches('(');
    let sign = text.get(..1)?;
    let space = if sign == ":" { " " } else { "" };
    Some(
        Diagnostic::new(&OTHER_LANGUAGE, span, format!("this is {name}, and glisten reads GLSL"))
            .here(format!("`{sign}{space}{word}` is {name}"))
            .help(translator),
    )
}

/// Whether a text starts with this word, as it is written in the tables above.
fn is_word(text: &str, word: &str) -> bool {
    let Some(rest) = text.strip_prefix(word) else { return false };
    let rest = rest.trim_start_matches(|digit: char| digit.is_ascii_digit());
    word.ends_with(['_', '(']) || !rest.starts_with(|next: char| next == '_' || next.is_alphanumeric())
}
