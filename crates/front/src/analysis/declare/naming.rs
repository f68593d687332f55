//! Which names may be declared (§3.7).

use super::super::context::Analyzer;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::names;
use crate::syntax::ast::Ident;

impl Analyzer<'_> {
    /// Whether a name may be declared: not if it starts with `gl_`. (The lexer warns of two underscores in a row.)
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
        true
    }
}
