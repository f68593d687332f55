//! Declares variables of the fixed-function pipeline (§7.1.1, §7.2, §7.6) at their first use, or when they are
//! redeclared: as ordinary inputs, outputs and uniforms.

use super::super::context::Analyzer;
use super::super::layout::Layout;
use super::super::qualifiers::{Qualifiers, StorageWord};
use crate::builtin::fixed::{self, FixedRow};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::names;
use crate::hir::{ArraySize, GlobalId, Interpolation, ScalarValue, Storage, Type, TypeId, Types, Value};
use crate::source::Span;
use crate::syntax::ast::Declarator;

impl Analyzer<'_> {
    /// The global of a variable of the fixed-function pipeline, which its first use creates.
    pub(in crate::analysis) fn fixed_global(&mut self, row: &'static FixedRow) -> GlobalId {
        if let Some(id) = self.declared.fixed(row.name) {
            return id;
        }
        let version = self.ast.version;
        let declared = &mut self.declared;
        let ty = row.make_type(self.types, &mut |types: &mut Types, name| {
            declared.fixed_struct(name, || fixed::structure(types, name, version).unwrap_or(TypeId::ERROR))
        });
        let (record, layout) = (Qualifiers::default(), Layout::default());
        let mut global = self.new_global(Span::default(), row.name, ty, row.storage, &record, &layout, None);
        if row.storage == Storage::Uniform {
            let scalars = row.initial().into_iter().map(ScalarValue::Float).collect();
            global.value = Some(Value { ty, scalars });
        }
        let id = self.add_global(global);
        self.declared.add_fixed(row.name, id);
        id
    }

    /// A struct of the fixed-function pipeline, such as `gl_LightSourceParameters`.
    pub(in crate::analysis) fn fixed_struct(&mut self, name: &str) -> Option<TypeId> {
        let (version, types) = (self.ast.version, &mut *self.types);
        let row = fixed::STRUCTS.iter().find(|row| row.0 == name)?;
        let ty = self.declared.fixed_struct(row.0, || fixed::structure(types, name, version).unwrap_or(TypeId::ERROR));
        (!ty.is_error()).then_some(ty)
    }

    /// Handles `varying vec4 gl_TexCoord[2];` and `flat in vec4 gl_Color;`. Returns whether the name is such a variable.
    pub(super) fn redeclare_fixed(&mut self, declarator: &Declarator, ty: TypeId, record: &Qualifiers) -> bool {
        let Some(row) = fixed::named(self.name(declarator.name), self.ast.version, self.stage) else { return false };
        let span = declarator.name.span;
        let id = self.fixed_global(row);
        let known = self.shader.global(id).ty;
        if !row.is_redeclarable() {
            let message = format!("`{}` cannot be declared again", row.name);
            self.report(Diagnostic::new(&names::BUILTIN_REDECLARED, span, message).here("it is built in"));
            return true;
        }
        if let Some(earlier) = self.declared.resized_fixed(row.name) {
            let message = format!("`{}` is given a size twice", row.name);
            self.report(
                Diagnostic::new(&names::REDEFINED, span, message).here("again here").label(earlier, "first here"),
            );
            return true;
        }
        let is_sized = match (self.types.get(known), self.types.get(ty)) {
            (Type::Array(known, ArraySize::Sized(most)), Type::Array(element, ArraySize::Sized(size))) => {
                known == element && size <= most
            }
            (Type::Array(known, _), Type::Array(element, ArraySize::Unsized)) => known == element,
            _ => false,
        };
        let stores = match record.storage {
            Some((StorageWord::In | StorageWord::Attribute, _)) => row.storage == Storage::In,
            Some((StorageWord::Out, _)) => row.storage == Storage::Out,
            Some((StorageWord::Varying, _)) => row.storage != Storage::Uniform,
            Some((StorageWord::Uniform, _)) => row.storage == Storage::Uniform,
            Some((StorageWord::VaryingOut | StorageWord::Inout, _)) | None => false,
        };
        if !(ty == known || is_sized || ty.is_error()) || !stores {
            let name = row.name;
            let message = format!("`{name}` can only be declared again with its own type and storage");
            self.report(Diagnostic::new(&names::BUILTIN_REDECLARED, span, message).here("it is built in"));
            return true;
        }
        if let Type::Array(_, ArraySize::Sized(size)) = self.types.get(ty) {
            self.declared.resize_fixed(row.name, span);
            self.shader.tex_coords = Some(size);
        }
        if let Some(global) = self.shader.globals.get_mut(id.index()) {
            global.interpolation = record.interpolation.map_or(Interpolation::default(), |(word, _)| word);
            global.interpolation_written = record.interpolation.is_some();
            global.sampling = record.sampling();
            global.invariant |= record.invariant.is_some();
        }
        true
    }
}
