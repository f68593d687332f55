//! Declarations without a type: `invariant a, b;` (§4.6.1), `layout(..) uniform;`, `layout(..) in;` (§4.3.8).

use super::super::context::Analyzer;
use super::super::layout::LayoutSubject;
use super::super::qualifiers::{DeclarationContext, Qualifiers, StorageWord};
use super::super::scope::Entry;
use super::super::state::BlockDefaults;
use super::super::state::{Denoted, NoteRole};
use crate::builtin::{BuiltinVariable, fixed, variables};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::{names, qualifiers};
use crate::hir::{GlobalId, Stage, Storage, Type, VarRef};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{Ident, LayoutId, Qualifier};

impl Analyzer<'_> {
    /// Applies qualifiers to earlier declarations, or sets defaults for later ones.
    pub(in crate::analysis) fn requalify(&mut self, list: &[Qualifier], idents: &[Ident], span: Span) {
        let record = self.qualifiers(list, DeclarationContext::Alone);
        if idents.is_empty() {
            self.default_layout(&record, span);
            return;
        }
        self.check_added(&record);
        match (record.precise, record.invariant) {
            (Some(_), None) => return self.make_precise(idents),
            // A name that is no variable is reported for `invariant`.
            (Some(_), Some(_)) => self.quietly(|this| this.make_precise(idents)),
            (None, _) => {}
        }
        for &name in idents {
            self.is_probe(name);
        }
        if record.invariant.is_none() {
            // `uniform S;` declares nothing, which is legal if `S` is a struct (§9).
            let is_struct = |name: &Ident| {
                self.scopes.find(name.symbol).is_some_and(|binding| matches!(binding.entry, Entry::Struct(_)))
            };
            if matches!(idents, [name] if is_struct(name)) {
                return;
            }
            self.without_type(idents, span);
            return;
        }
        for &name in idents {
            self.make_invariant(name);
        }
    }

    /// Reports `uniform t;`. If nothing is declared by a name, it is known from here on.
    fn without_type(&mut self, idents: &[Ident], span: Span) {
        let finding = Diagnostic::new(&qualifiers::MISPLACED, span, "a declaration without a type");
        let new = idents.iter().find(|name| self.scopes.find(name.symbol).is_none());
        let finding = match new.map(|name| self.name(*name)) {
            Some(name) => finding.here("a type is missing").help(format!("write a type before `{name}`")),
            None => finding.here("only `invariant` may be added to a declared variable"),
        };
        self.report(finding);
        self.enter_broken(idents);
    }

    /// Reports what cannot be added to a variable that is declared: all but `invariant` and `precise`.
    fn check_added(&mut self, record: &Qualifiers) {
        if record.invariant.is_none() && record.precise.is_none() {
            return;
        }
        let storage = record.storage.map(|(_, span)| (span, "a storage qualifier"));
        let layout = record.layout_span.map(|span| (span, "a layout qualifier"));
        for (span, what) in layout.into_iter().chain(storage) {
            self.misplaced(span, format!("{what} cannot be added to a declared variable"), "remove it");
        }
    }

    /// `precise a;` "may be used to qualify a built-in or previously declared user-defined variable" (GLSL 4.00 §4.7), a local one, too. It
    /// changes how `a` is computed, and no value that is exact. All that is computed for `a` is then precise.
    pub(in crate::analysis) fn make_precise(&mut self, idents: &[Ident]) {
        for &name in idents {
            match self.scopes.find(name.symbol) {
                Some(binding) if matches!(binding.entry, Entry::Variable(VarRef::Local(_))) => {
                    self.note_binding(name.span, binding);
                    self.shader.precise.add(self.ast.name(name), binding.span);
                }
                _ => {
                    if let Some((id, _)) = self.global_named(name) {
                        let declared = self.scopes.find(name.symbol).map(|binding| binding.span);
                        let declared = declared.unwrap_or(self.shader.global(id).span);
                        self.shader.precise.add(self.ast.name(name), declared);
                    }
                }
            }
        }
    }

    /// `invariant a;`: `a` must be an output, or an input of a fragment shader, and must not be used before.
    fn make_invariant(&mut self, name: Ident) {
        let spelling = self.name(name);
        let Some((id, member)) = self.global_named(name) else { return };
        let global = self.shader.global(id);
        let (storage, declared) = (global.storage, global.span);
        let crosses = storage == Storage::Out || (storage == Storage::In && self.stage == Stage::Fragment);
        let is_instance = global.block.as_ref().is_some_and(|block| block.instance.is_some());
        // "It is an error to declare gl_FrontFacing as invariant" (GLSL ES 1.00 §4.6.4).
        let is_facing = self.ast.version.is_es() && global.builtin == Some(BuiltinVariable::FrontFacing);
        let candidate = crosses && !is_instance && !is_facing;
        if !candidate {
            self.report(
                Diagnostic::new(&qualifiers::INVARIANT, name.span, format!("`{spelling}` cannot be invariant"))
                    .here(if is_facing {
                        "its variance is that of `gl_Position`"
                    } else {
                        "not an output of the shader"
                    })
                    .label(declared, "declared here"),
            );
            return;
        }
        if storage == Storage::In {
            self.require(Feature::InvariantInputs, name.span);
        }
        let used = match member {
            Some(member) => self.uses.first_of_member(id, member),
            None => self.uses.first(id),
        };
        if let Some(used) = used {
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
        let structure = self.types.get(self.shader.global(id).ty);
        match (member, structure) {
            (Some(member), Type::Struct(structure)) => {
                if let Some(member) = self.types.structure_mut(structure).members.get_mut(member as usize) {
                    member.invariant = true;
                }
            }
            _ => {
                if let Some(global) = self.shader.globals.get_mut(id.index()) {
                    global.invariant = true;
                }
            }
        }
    }

    /// The global that a name denotes, declared or built in, and the member, if it denotes one. Reports any other
    /// name.
    fn global_named(&mut self, name: Ident) -> Option<(GlobalId, Option<u32>)> {
        let spelling = self.name(name);
        match self.scopes.find(name.symbol) {
            Some(binding) => self.note_binding(name.span, binding),
            None => self.note(name.span, Denoted::Builtin, NoteRole::Uses),
        }
        match self.scopes.find(name.symbol).map(|binding| binding.entry) {
            Some(Entry::Variable(VarRef::Global(id))) => Some((id, None)),
            Some(Entry::Member(id, member)) => Some((id, Some(member))),
            Some(Entry::Poison) => None,
            Some(_) => {
                self.report(
                    Diagnostic::new(&names::NOT_A_VARIABLE, name.span, format!("`{spelling}` is not a variable"))
                        .here("a variable is required here"),
                );
                None
            }
            None => {
                if let Some(row) = fixed::named(spelling, self.ast.version, self.stage) {
                    return Some((self.fixed_global(row), None));
                }
                let row = variables::named(spelling, self.ast.version, self.extensions, self.stage);
                if row.is_none() {
                    self.report(
                        Diagnostic::new(&names::UNDECLARED, name.span, format!("`{spelling}` is not declared"))
                            .here("declare it before this line"),
                    );
                }
                row.map(|row| (self.builtin_global(row), None))
            }
        }
    }

    fn default_layout(&mut self, record: &Qualifiers, span: Span) {
        if let Some(invariant) = record.invariant {
            self.report(
                Diagnostic::new(&qualifiers::MISPLACED, invariant, "`invariant` without the name of an output")
                    .here("nothing is made invariant"),
            );
            return;
        }
        match record.storage {
            Some((StorageWord::Uniform, _)) => {
                let layout = self.layout(record, LayoutSubject::UniformDefault);
                self.layouts.block_defaults = BlockDefaults {
                    layout: layout.block.unwrap_or(self.layouts.block_defaults.layout),
                    matrix: layout.matrix.unwrap_or(self.layouts.block_defaults.matrix),
                };
            }
            Some((StorageWord::In, _)) if self.stage == Stage::Geometry => {
                let layout = self.layout(record, LayoutSubject::GeometryIn);
                self.geometry_input_layout(&layout, span);
            }
            Some((StorageWord::Out, _)) if self.stage == Stage::Geometry => {
                let layout = self.layout(record, LayoutSubject::GeometryOut);
                self.geometry_output_layout(&layout);
            }
            Some((StorageWord::In, _)) if self.stage == Stage::Fragment && !record.layout.is_empty() => {
                let layout = self.layout(record, LayoutSubject::FragmentIn);
                self.layouts.early_tests = layout.early_tests.or(self.layouts.early_tests);
            }
            Some((word @ (StorageWord::In | StorageWord::Out), at)) => {
                let blends = |one: &&LayoutId| self.name(one.name).starts_with("blend_support_");
                if let Some(blending) = record.layout.iter().find(blends).filter(|_| self.stage == Stage::Fragment) {
                    // ES 3.20 §4.4.2.4
                    let message = "blending by the equations of ES 3.20 is not supported yet";
                    self.report(Diagnostic::new(&NOT_SUPPORTED_YET, blending.name.span, message));
                    return;
                }
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
