//! Which names may be declared (§3.7).

use super::super::context::Analyzer;
use crate::diagnostic::codes::names;
use crate::diagnostic::{Diagnostic, Severity};
use crate::syntax::ast::Ident;

impl Analyzer<'_> {
    /// Whether a name may be declared: not if it starts with `gl_`. Two underscores in a row are reserved and taken by
    /// every driver.
    pub(in crate::analysis) fn check_name(&mut self, name: Ident) -> bool {
        let spelling = self.name(name);
        if spelling.starts_with("gl_") {
            self.report(
                Diagnostic::new(&names::RESERVED_NAME, name.span, format!("`{spelling}` cannot be declared"))
                    .here("names that start with `gl_` belong to OpenGL")
                    .help(format!("call it `{}`", spelling.trim_start_matches("gl_"))),
            );
            return false;
        }
        if spelling.contains("__") {
            let mut finding = Diagnostic::new(
                &names::DOUBLE_UNDERSCORE,
                name.span,
                format!("`{spelling}` has two underscores in a row"),
            )
            .here("such names are reserved")
            .help(format!("call it `{}`", spelling.replace("__", "_")));
            if self.strict {
                finding.severity = Severity::Error;
            }
            self.report(finding);
        }
        true
    }
}
