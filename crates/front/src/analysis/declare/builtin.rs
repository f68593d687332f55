//! Declares built-in variables (§7.1, §7.2): at their first use, or when they are redeclared, where 1.50 allows that.

use super::super::context::Analyzer;
use super::super::layout::{Layout, LayoutSubject};
use super::super::qualifiers::{Qualifiers, StorageWord};
use super::super::state::ArrayKey;
use super::super::state::{Denoted, NoteRole};
use crate::builtin::variables::{self, Redeclaration, Row, VARIABLES};
use crate::builtin::{BuiltinVariable, constants};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{names, qualifiers, types};
use crate::hir::{ArraySize, BlockInfo, BlockLayout, FragCoordLayout, GlobalId, Stage, Storage, Type, TypeId};
use crate::language::{Extensions, Feature};
use crate::source::Span;
use crate::syntax::ast::{Declarator, Ident};

impl Analyzer<'_> {
    /// The global of a built-in variable, which its first use creates.
    pub(in crate::analysis) fn builtin_global(&mut self, row: &Row) -> GlobalId {
        if let Some(id) = self.declared.builtin(row.variable) {
            return id;
        }
        let mut ty = row.make_type(self.types, self.ast.version);
        let mut global = self.new_global(
            Span::default(),
            row.name,
            ty,
            row.storage,
            &Qualifiers::default(),
            &Layout::default(),
            None,
        );
        if row.variable == BuiltinVariable::In {
            ty = self.sized_by_geometry(ty, Storage::In, Span::default());
            global.block = Some(BlockInfo {
                name: "gl_PerVertex".into(),
                instance: Some(row.name.into()),
                layout: BlockLayout::default(),
                binding: None,
            });
        }
        global.ty = ty;
        global.builtin = Some(row.variable);
        let id = self.add_global(global);
        self.declared.add_builtin(row.variable, id);
        id
    }

    /// A struct that the language declares: `gl_DepthRangeParameters`, the type of `gl_DepthRange` (§7.5), or one of the fixed-function
    /// pipeline.
    pub(in crate::analysis) fn builtin_struct(&mut self, name: &str) -> Option<TypeId> {
        if !name.starts_with("gl_") {
            return None;
        }
        if name != variables::DEPTH_RANGE_STRUCT {
            return self.fixed_struct(name);
        }
        let row = VARIABLES.iter().find(|row| row.variable == BuiltinVariable::DepthRange)?;
        let id = self.builtin_global(row);
        Some(self.shader.global(id).ty)
    }

    /// Handles `in vec4 gl_FragCoord;`. Returns whether the name is built in, so that the declaration is complete.
    pub(super) fn redeclare_builtin(&mut self, declarator: &Declarator, ty: TypeId, record: &Qualifiers) -> bool {
        let name = self.name(declarator.name);
        let span = declarator.name.span;
        let Some(row) = variables::named(name, self.ast.version, self.extensions, self.stage) else {
            if self.redeclare_fixed(declarator, ty, record) {
                self.note(span, Denoted::Builtin, NoteRole::Uses);
                return true;
            }
            let stages: Vec<&str> = variables::stages_with(name).map(Stage::name).collect();
            if stages.is_empty() {
                return false;
            }
            let stage = self.stage.name();
            self.report(
                Diagnostic::new(
                    &names::BUILTIN_UNAVAILABLE,
                    span,
                    format!("`{name}` does not exist in a {stage} shader"),
                )
                .here(format!("only in {} shaders", stages.join(" and "))),
            );
            return true;
        };
        self.note(span, Denoted::Builtin, NoteRole::Uses);
        if ty.is_error() || self.is_in_per_vertex(row, span) {
            return true;
        }
        if row.redeclaration != Redeclaration::No {
            self.check_own_qualifiers(declarator.name, record);
        }
        match row.redeclaration {
            Redeclaration::No if self.declares_interface(row) => self.redeclare_output(row, declarator, ty, record),
            Redeclaration::No => self.report(
                Diagnostic::new(&names::BUILTIN_REDECLARED, span, format!("`{name}` cannot be declared again"))
                    .here("it is built in")
                    .help("remove the declaration"),
            ),
            Redeclaration::Size => self.resize_builtin(row, declarator, ty, record),
            Redeclaration::Layout => self.redeclare_frag_coord(row, declarator, ty, record),
            Redeclaration::Depth => self.redeclare_frag_depth(row, declarator, ty, record),
        }
        true
    }

    /// Checks that a redeclaration repeats the storage and the type. Returns `None` if it does not, which is
    /// reported.
    fn same_storage(&mut self, row: &Row, span: Span, record: &Qualifiers) -> Option<()> {
        let wanted = if row.storage == Storage::In { StorageWord::In } else { StorageWord::Out };
        if matches!(record.storage, Some((word, _)) if word == wanted) {
            return Some(());
        }
        let (name, word) = (row.name, wanted.spelling());
        self.report(
            Diagnostic::new(
                &names::BUILTIN_REDECLARED,
                span,
                format!("`{name}` can only be declared again as `{word}`"),
            )
            .here(format!("it is an `{word}` variable of a {} shader", self.stage.name())),
        );
        None
    }

    /// Checks that a redeclaration adds no qualifier of varyings: the language lets a built-in variable be redeclared "only for these
    /// specific purposes" (§3.7), which are a size, a layout of its own, `invariant` and `precise`.
    pub(super) fn check_own_qualifiers(&mut self, name: Ident, record: &Qualifiers) {
        let place = record.layout.iter().find(|id| matches!(self.name(id.name), "location" | "component"));
        if let Some(span) = place.map(|id| id.name.span) {
            let message = format!("`{}` has no location", self.name(name));
            self.report(Diagnostic::new(&names::BUILTIN_REDECLARED, span, message).here("it is built in"));
        }
        let interpolation = record.interpolation.map(|(word, span)| (word.name(), span));
        let sampling = record.sampling.and_then(|(sampling, span)| Some((sampling.word()?, span)));
        if let Some((word, span)) = interpolation.or(sampling) {
            let message = format!("`{}` cannot be `{word}`", self.name(name));
            self.report(Diagnostic::new(&names::BUILTIN_REDECLARED, span, message).here("it is built in"));
        }
    }

    /// Whether a declaration of an output states the interface to a separate program (ARB_separate_shader_objects).
    fn declares_interface(&self, row: &Row) -> bool {
        self.extensions.contains(Extensions::SEPARATE_SHADER_OBJECTS) && row.per_vertex && row.storage == Storage::Out
    }

    /// `out vec4 gl_Position;`, which changes nothing.
    fn redeclare_output(&mut self, row: &Row, declarator: &Declarator, ty: TypeId, record: &Qualifiers) {
        let span = declarator.name.span;
        let known = row.make_type(self.types, self.ast.version);
        if self.same_storage(row, span, record).is_some() && ty != known {
            let message = format!("`{}` is a `{}`", row.name, self.types.name(known));
            self.report(Diagnostic::new(&names::BUILTIN_REDECLARED, span, message).here("declared as something else"));
        }
    }

    /// `out float gl_ClipDistance[4];`
    fn resize_builtin(&mut self, row: &Row, declarator: &Declarator, ty: TypeId, record: &Qualifiers) {
        let span = declarator.name.span;
        if self.same_storage(row, span, record).is_none() {
            return;
        }
        let name = row.name;
        let Type::Array(TypeId::FLOAT, size) = self.types.get(ty) else {
            self.report(
                Diagnostic::new(&names::BUILTIN_REDECLARED, span, format!("`{name}` is an array of `float`"))
                    .here("declared as something else"),
            );
            return;
        };
        let id = self.builtin_global(row);
        if let Type::Array(_, ArraySize::Sized(_)) = self.types.get(self.shader.global(id).ty) {
            let earlier = self.shader.global(id).span;
            self.report(
                Diagnostic::new(&names::REDEFINED, span, format!("`{name}` is given a size twice"))
                    .here("again here")
                    .label(earlier, "first here"),
            );
            return;
        }
        if let ArraySize::Sized(size) = size {
            if !self.check_clip_distances(size, span) {
                return;
            }
            self.check_resize(ArrayKey::Global(id), size, span);
        }
        if let Some(global) = self.shader.globals.get_mut(id.index()) {
            global.ty = ty;
            global.span = span;
        }
    }

    /// Checks that there are at most `gl_MaxClipDistances` (§7.1).
    pub(in crate::analysis) fn check_clip_distances(&mut self, size: u32, span: Span) -> bool {
        let max = constants::MAX_CLIP_DISTANCES;
        if size <= max {
            return true;
        }
        self.report(
            Diagnostic::new(&types::ARRAY_SIZE, span, format!("`gl_ClipDistance` cannot have {size} elements"))
                .here(format!("at most gl_MaxClipDistances, which is {max}")),
        );
        false
    }

    /// `layout(depth_greater) out float gl_FragDepth;` (GLSL 4.20 §4.4.2.4, ARB_conservative_depth). What it promises
    /// lets a driver test earlier, and changes no value. "A redeclaration that changes nothing is allowed", too.
    fn redeclare_frag_depth(&mut self, row: &Row, declarator: &Declarator, ty: TypeId, record: &Qualifiers) {
        let span = declarator.name.span;
        if !self.allows(Feature::DepthLayouts, span) {
            self.report(
                Diagnostic::new(&names::BUILTIN_REDECLARED, span, "`gl_FragDepth` cannot be declared again")
                    .here("it is built in")
                    .help("remove the declaration"),
            );
            return;
        }
        self.layout(record, LayoutSubject::FragDepth);
        if self.same_storage(row, span, record).is_some() && ty != TypeId::FLOAT {
            self.report(
                Diagnostic::new(&names::BUILTIN_REDECLARED, span, "`gl_FragDepth` is a `float`")
                    .here("declared as something else"),
            );
        }
        self.compare_frag_depth(row, span, record);
    }

    /// "All redeclarations of gl_FragDepth .. must have the same set of qualifiers. Within any shader, the first
    /// redeclarations of gl_FragDepth must appear before any use of gl_FragDepth." (GLSL 4.20 §4.4.2)
    fn compare_frag_depth(&mut self, row: &Row, span: Span, record: &Qualifiers) {
        let mut words: Vec<String> = record.layout.iter().map(|id| self.name(id.name).to_owned()).collect();
        words.sort_unstable();
        let used = self.declared.builtin(row.variable).and_then(|id| self.uses.first(id));
        let (code, message, here, other, label) = match (&self.layouts.frag_depth, used) {
            (Some((known, first)), _) if *known != words => (
                &names::BUILTIN_REDECLARED,
                "two declarations of `gl_FragDepth` have different layouts",
                "another layout here",
                *first,
                "first declared here",
            ),
            (None, Some(used)) => (
                &names::REDECLARED_AFTER_USE,
                "`gl_FragDepth` is declared again after it was used",
                "too late",
                used,
                "used here",
            ),
            _ => {
                self.layouts.frag_depth.get_or_insert((words, span));
                return;
            }
        };
        self.report(Diagnostic::new(code, span, message).here(here).label(other, label));
    }

    /// `layout(origin_upper_left) in vec4 gl_FragCoord;` (§4.3.8.1)
    fn redeclare_frag_coord(&mut self, row: &Row, declarator: &Declarator, ty: TypeId, record: &Qualifiers) {
        let span = declarator.name.span;
        let layout = self.layout(record, LayoutSubject::FragCoord);
        if self.ast.version.is_es() {
            // ES has no layout for it, which is reported.
            if record.layout.is_empty() {
                let message = "`gl_FragCoord` cannot be declared again in ES";
                let finding = Diagnostic::new(&names::BUILTIN_REDECLARED, span, message);
                self.report(finding.here("it is built in").help("remove the declaration"));
            }
            return;
        }
        if self.same_storage(row, span, record).is_none() {
            return;
        }
        if ty != TypeId::VEC4 {
            self.report(
                Diagnostic::new(&names::BUILTIN_REDECLARED, span, "`gl_FragCoord` is a `vec4`")
                    .here("declared as something else"),
            );
            return;
        }
        let said = FragCoordLayout {
            origin_upper_left: layout.origin_upper_left,
            pixel_center_integer: layout.pixel_center_integer,
        };
        let id = self.builtin_global(row);
        match self.layouts.frag_coord {
            Some(first) if said != self.shader.frag_coord => {
                self.report(
                    Diagnostic::new(
                        &qualifiers::FRAG_COORD,
                        span,
                        "two declarations of `gl_FragCoord` have different layouts",
                    )
                    .here("another layout here")
                    .label(first, "first declared here"),
                );
            }
            Some(_) => {}
            None => {
                if let Some(used) = self.uses.first(id) {
                    self.report(
                        Diagnostic::new(
                            &names::REDECLARED_AFTER_USE,
                            span,
                            "`gl_FragCoord` is declared again after it was used",
                        )
                        .here("too late")
                        .label(used, "used here"),
                    );
                }
                self.layouts.frag_coord = Some(span);
                self.shader.frag_coord = said;
                if let Some(global) = self.shader.globals.get_mut(id.index()) {
                    global.span = span;
                }
            }
        }
    }
}
