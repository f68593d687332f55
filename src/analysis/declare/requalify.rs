//! Declarations without a type: `invariant a, b;` (§4.6.1), `layout(..) uniform;`, `layout(..) in;` (§4.3.8).

use super::super::context::Analyzer;
use super::super::layout::{BlockDefaults, LayoutPlace};
use super::super::qualifiers::{Place, Qualifiers, StorageWord};
use super::super::scope::Entry;
use crate::builtin::variables;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{names, qualifiers};
use crate::hir::{GlobalId, Stage, Storage, VarRef};
use crate::source::Span;
use crate::syntax::ast::{Ident, Qualifier};

impl Analyzer<'_> {
    /// Qualifiers for what is declared already, or for what will be.
    pub(in crate::analysis) fn requalify(&mut self, list: &[Qualifier], idents: &[Ident], span: Span) {
        let record = self.qualifiers(list, Place::Alone);
        if idents.is_empty() {
            self.default_layout(&record, span);
            return;
        }
        if record.invariant.is_none() {
            self.report(
                Diagnostic::new(&qualifiers::MISPLACED, span, "a declaration without a type")
                    .here("only `invariant` may be added to a declared variable"),
            );
            return;
        }
        for &name in idents {
            self.make_invariant(name);
        }
    }

    /// `invariant a;`: `a` is an output, or an input of a fragment shader, not used before. Of a member of a block the
    /// whole block becomes invariant, which is more than was asked.
    fn make_invariant(&mut self, name: Ident) {
        let spelling = self.name(name);
        let Some(id) = self.global_named(name) else { return };
        let global = self.shader.global(id);
        let (storage, declared) = (global.storage, global.span);
        let crosses = storage == Storage::Out || (storage == Storage::In && self.stage == Stage::Fragment);
        let is_instance = global.block.as_ref().is_some_and(|block| block.instance.is_some());
        let candidate = crosses && !is_instance;
        if !candidate {
            self.report(
                Diagnostic::new(&qualifiers::INVARIANT, name.span, format!("`{spelling}` cannot be invariant"))
                    .here("not an output of the shader")
                    .label(declared, "declared here"),
            );
            return;
        }
        if let Some(&used) = self.first_uses.get(&id) {
            self.report(
                Diagnostic::new(
                    &names::REDECLARED_AFTER_USE,
                    name.span,
                    format!("`{spelling}` is made invariant after it was used"),
                )
                .here("too late")
                .label(used, "used here"),
            );
        }
        if let Some(global) = self.shader.globals.get_mut(id.index()) {
            global.invariant = true;
        }
    }

    /// The global behind a name, declared or built in; else that is reported.
    fn global_named(&mut self, name: Ident) -> Option<GlobalId> {
        let spelling = self.name(name);
        match self.scopes.find(name.symbol).map(|binding| binding.entry) {
            Some(Entry::Variable(VarRef::Global(id)) | Entry::Member(id, _)) => Some(id),
            Some(Entry::Poison) => None,
            Some(_) => {
                self.report(
                    Diagnostic::new(&names::NOT_A_VARIABLE, name.span, format!("`{spelling}` is not a variable"))
                        .here("a variable is wanted here"),
                );
                None
            }
            None => {
                let row = variables::named(spelling, self.ast.version, self.extensions, self.stage);
                if row.is_none() {
                    self.report(
                        Diagnostic::new(&names::UNDECLARED, name.span, format!("`{spelling}` is not declared"))
                            .here("declare it before this line"),
                    );
                }
                row.map(|row| self.builtin_global(row))
            }
        }
    }

    fn default_layout(&mut self, record: &Qualifiers, span: Span) {
        match record.storage {
            Some((StorageWord::Uniform, _)) => {
                let layout = self.layout(record, LayoutPlace::UniformDefault);
                self.block_defaults = BlockDefaults {
                    layout: layout.block.unwrap_or(self.block_defaults.layout),
                    matrix: layout.matrix.unwrap_or(self.block_defaults.matrix),
                };
            }
            Some((StorageWord::In, _)) if self.stage == Stage::Geometry => {
                let layout = self.layout(record, LayoutPlace::GeometryIn);
                self.geometry_input_layout(&layout, span);
            }
            Some((StorageWord::Out, _)) if self.stage == Stage::Geometry => {
                let layout = self.layout(record, LayoutPlace::GeometryOut);
                self.geometry_output_layout(&layout);
            }
            Some((word @ (StorageWord::In | StorageWord::Out), at)) => {
                let (word, stage) = (word.spelling(), self.stage.name());
                self.report(
                    Diagnostic::new(
                        &qualifiers::LAYOUT_PLACE,
                        record.layout_span.unwrap_or(at),
                        format!("a {stage} shader has no layout for `{word}`"),
                    )
                    .here("not allowed here"),
                );
            }
            _ => {
                self.report(
                    Diagnostic::new(&qualifiers::MISPLACED, span, "qualifiers without a declaration")
                        .here("nothing is declared"),
                );
            }
        }
    }
}
