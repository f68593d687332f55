//! Keywords of features that glisten does not support: one error that names the feature.

use super::{Parser, Reported, TokenKind, TokenSource};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;

/// How such keywords begin, and the feature that they belong to; of several rows the first counts.
static FEATURES: &[(&str, &str)] = &[
    ("double", "double precision"),
    ("dvec", "double precision"),
    ("dmat", "double precision"),
    ("image", "images (`imageLoad`, `imageStore`)"),
    ("iimage", "images (`imageLoad`, `imageStore`)"),
    ("uimage", "images (`imageLoad`, `imageStore`)"),
    ("coherent", "a memory qualifier"),
    ("volatile", "a memory qualifier"),
    ("restrict", "a memory qualifier"),
    ("readonly", "a memory qualifier"),
    ("writeonly", "a memory qualifier"),
    ("atomic_uint", "atomic counters"),
    ("buffer", "shader storage blocks (`buffer`)"),
    ("shared", "compute shaders (`shared`)"),
    ("subroutine", "subroutines"),
    ("patch", "tessellation (`patch`)"),
];

/// The feature of a keyword.
fn feature(word: &str) -> &'static str {
    FEATURES.iter().find(|row| word.starts_with(row.0)).map_or("this keyword", |row| row.1)
}

/// The words that are qualifiers; all others are types.
static QUALIFIERS: &[&str] =
    &["coherent", "volatile", "restrict", "readonly", "writeonly", "buffer", "shared", "subroutine", "patch"];

impl<T: TokenSource> Parser<'_, '_, T> {
    /// Whether the next token is a qualifier of a feature that is not supported.
    pub(super) fn is_foreign_qualifier(&self) -> bool {
        self.kind() == TokenKind::Foreign && QUALIFIERS.contains(&self.session.spelling(self.current))
    }

    /// Whether `buffer B {` is next where `buffer` is no keyword yet. A struct of that name makes no sense there.
    pub(super) fn is_storage_block(&mut self) -> bool {
        self.kind() == TokenKind::Ident
            && self.session.spelling(self.current) == "buffer"
            && self.ahead(1).kind == TokenKind::Ident
            && self.ahead(2).kind == TokenKind::LeftBrace
    }

    /// Reports the keyword and reads it.
    pub(super) fn foreign(&mut self) -> Reported {
        let token = self.bump();
        let message = format!("{} not supported yet", is(feature(self.session.spelling(token))));
        self.session.report(Diagnostic::new(&NOT_SUPPORTED_YET, token.span, message));
        Reported
    }
}

/// The feature with its verb.
fn is(feature: &str) -> String {
    let word = feature.split(" (").next().unwrap_or(feature);
    let plural = word.ends_with('s') && !word.ends_with("ss");
    format!("{feature} {}", if plural { "are" } else { "is" })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::syntax::keywords::TABLE;

    #[test]
    fn every_foreign_word_has_a_feature() {
        for row in TABLE.iter().filter(|row| row.kind == TokenKind::Foreign) {
            assert_ne!(feature(row.spelling), "this keyword", "{}", row.spelling);
        }
        assert_eq!(is("subroutines"), "subroutines are");
        assert_eq!(is("double precision"), "double precision is");
        assert_eq!(is(feature("image2D")), "images (`imageLoad`, `imageStore`) are");
    }
}
