//! Which names a shader may declare (§3.7).

use super::super::context::Analyzer;
use super::super::expr::foreign;
use crate::builtin::functions;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::names;
use crate::language::Feature;
use crate::syntax::ast::Ident;

impl Analyzer<'_> {
    /// Checks that a global may have its name, which no built-in function has from ES 3.00 on (ES 3.00 §4.2).
    pub(in crate::analysis) fn check_builtin_scope(&mut self, name: Ident) {
        if functions::named(self.name(name)).iter().any(|row| row.availability.in_version(self.ast.version)) {
            self.require(Feature::BuiltinScope, name.span);
        }
    }

    /// Checks that a name may be declared: it must not start with `gl_`. (The preprocessor warns about two
    /// consecutive underscores.)
    pub(in crate::analysis) fn check_name(&mut self, name: Ident) -> bool {
        let spelling = self.name(name);
        if foreign::is_unsupported_variable(spelling, self.ast.version, self.extensions) {
            let message = format!("the variable `{spelling}` is not supported yet");
            self.report(Diagnostic::new(&NOT_SUPPORTED_YET, name.span, message));
            return false;
        }
        if spelling.starts_with("gl_") {
            let rest = spelling.trim_start_matches("gl_");
            let is_name = rest.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
            self.report(
                Diagnostic::new(&names::RESERVED_NAME, name.span, format!("`{spelling}` cannot be declared"))
                    .here("names that start with `gl_` belong to OpenGL")
                    .maybe_help(is_name.then(|| format!("call it `{rest}`"))),
            );
            return false;
        }
        true
    }
}
