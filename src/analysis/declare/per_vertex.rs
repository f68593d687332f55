//! `gl_PerVertex` declared anew (ARB_separate_shader_objects).

use super::super::context::Analyzer;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::general;
use crate::hir::Storage;
use crate::syntax::ast::BlockDecl;

impl Analyzer<'_> {
    /// `out gl_PerVertex { vec4 gl_Position; };`
    pub(super) fn redeclare_per_vertex(&mut self, block: &BlockDecl, _: Storage) {
        self.report(Diagnostic::new(
            &general::NOT_SUPPORTED_YET,
            block.name.span,
            "`gl_PerVertex` cannot be declared again yet",
        ));
    }
}
