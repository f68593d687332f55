//! Analyzes access to parts of values: `a.b`, `a.xyz`, `a[i]`, `a.length()` (§5.5 to §5.7).

use super::super::context::Analyzer;
use super::super::state::ArrayKey;
use super::super::state::{Denoted, NoteRole};
use super::swizzle::{self, Fault};
use crate::builtin::fixed::TEX_COORD;
use crate::diagnostic::codes::{names, types};
use crate::diagnostic::{Advice, Diagnostic, did_you_mean};
use crate::hir::{
    ArraySize, ExprId, ExprKind, Scalar, ScalarValue, Stage, Storage, StructId, Type, TypeId, VarRef, is_pure,
};
use crate::language::{Extensions, Feature, NEVER, Since};
use crate::source::Span;
use crate::syntax::ast::{self, Ident};

impl Analyzer<'_> {
    /// `a.b`: a member, or components of a vector.
    pub(super) fn field(&mut self, base: ExprId, field: Ident, span: Span) -> ExprId {
        let spelling = self.name(field);
        let ty = self.ty(base);
        if self.is_probe_of_member(field, ty) {
            return self.poison(span);
        }
        match self.types.get(self.ty(base)) {
            Type::Error => self.poison(span),
            Type::Struct(id) => {
                if let Some(index) = self.member_index(id, field) {
                    self.note_member(field.span, id, index, NoteRole::Uses);
                    return self.member(base, index, span);
                }
                let structure = self.types.structure(id);
                let members = structure.members.iter().map(|member| member.name.as_str());
                let may_suggest = self.budget.may_suggest(members.len());
                let near = may_suggest.then(|| did_you_mean(spelling, members)).flatten();
                let help = near.map(Advice::meant);
                let name = self.type_name(self.ty(base));
                self.report(
                    Diagnostic::new(&names::NO_MEMBER, field.span, format!("`{name}` has no member `{spelling}`"))
                        .here("no such member")
                        .maybe_help(help),
                );
                self.poison(span)
            }
            Type::Vector(scalar, size) => {
                self.note(field.span, Denoted::Components(ty), NoteRole::Uses);
                self.swizzle(base, field, (scalar, size), span)
            }
            Type::Scalar(scalar) if self.allows(Feature::ScalarSwizzles, field.span) => {
                self.scalar_swizzle(base, field, scalar, span)
            }
            _ => {
                let name = self.type_name(self.ty(base));
                let at = self.span(base);
                self.report(
                    Diagnostic::new(&names::NO_MEMBER, field.span, format!("a `{name}` has no member `{spelling}`"))
                        .here("nothing to select")
                        .label(at, format!("this is a `{name}`")),
                );
                self.poison(span)
            }
        }
    }

    /// The index of a member; structs with many members have a table.
    pub(in crate::analysis) fn member_index(&self, id: StructId, field: Ident) -> Option<u32> {
        if let Some(indices) = self.declared.members(id) {
            return indices.get(&field.symbol).copied();
        }
        let name = self.name(field);
        let index = self.types.structure(id).members.iter().position(|member| member.name == name)?;
        u32::try_from(index).ok()
    }

    fn swizzle(&mut self, base: ExprId, field: Ident, (scalar, size): (Scalar, u8), span: Span) -> ExprId {
        match swizzle::parse(self.name(field), size) {
            Ok(swizzle) => self.push(ExprKind::Swizzle(base, swizzle), TypeId::vector(scalar, swizzle.len), span),
            Err(fault) => {
                self.report_swizzle(base, field, fault);
                self.poison(span)
            }
        }
    }

    /// Swizzles of scalars (ARB_shading_language_420pack): `f.xxx` is `vec3(f)`.
    fn scalar_swizzle(&mut self, base: ExprId, field: Ident, scalar: Scalar, span: Span) -> ExprId {
        match swizzle::parse(self.name(field), 1) {
            Ok(swizzle) if swizzle.len == 1 => base,
            Ok(swizzle) => {
                let kind = ExprKind::Construct(crate::hir::ConstructKind::Splat, vec![base]);
                self.push(kind, TypeId::vector(scalar, swizzle.len), span)
            }
            Err(fault) => {
                self.report_swizzle(base, field, fault);
                self.poison(span)
            }
        }
    }

    fn report_swizzle(&mut self, base: ExprId, field: Ident, fault: Fault) {
        let (spelling, name) = (self.name(field), self.type_name(self.ty(base)));
        let at = self.span(base);
        let message = match fault {
            Fault::NoComponent(letter) => format!("`{spelling}` selects nothing: `{letter}` names no component"),
            Fault::Mixed => format!("`{spelling}` mixes names of different sets"),
            Fault::TooLong => format!("`{spelling}` selects more than four components"),
            Fault::Missing(letter) => format!("a `{name}` has no component `{letter}`"),
        };
        self.report(
            Diagnostic::new(&types::SWIZZLE, field.span, message)
                .here("not a selection of components")
                .label(at, format!("this is a `{name}`"))
                .help("components are named `xyzw`, `rgba` or `stpq`"),
        );
    }

    /// `a[i]`
    pub(super) fn index(&mut self, base: ExprId, index: Option<ExprId>, span: Span) -> ExprId {
        let Some(index) = index else {
            self.report(
                Diagnostic::new(&types::INDEX, span, "an index is missing between the brackets").here("write an index"),
            );
            return self.poison(span);
        };
        let (ty, index_ty) = (self.ty(base), self.ty(index));
        if ty.is_error() || index_ty.is_error() {
            return self.poison(span);
        }
        let (element, size) = match self.types.get(ty) {
            Type::Vector(scalar, size) => (TypeId::vector(scalar, 1), Some(u32::from(size))),
            Type::Matrix(columns, rows) => (TypeId::vector(Scalar::Float, rows), Some(u32::from(columns))),
            Type::Array(element, ArraySize::Sized(size)) => (element, Some(self.stated_size(base).unwrap_or(size))),
            Type::Array(element, ArraySize::Unsized) => (element, None),
            _ => {
                let (name, at) = (self.type_name(ty), self.span(base));
                self.report(
                    Diagnostic::new(&types::INDEX, at, format!("a `{name}` cannot be indexed"))
                        .here(format!("this is a `{name}`")),
                );
                return self.poison(span);
            }
        };
        if index_ty != TypeId::INT && index_ty != TypeId::UINT {
            let (name, at) = (self.type_name(index_ty), self.span(index));
            let help = self.conversion_help(index_ty, TypeId::INT, at);
            self.report(
                Diagnostic::new(&types::INDEX, at, format!("an index is an `int` or a `uint`, not a `{name}`"))
                    .here(format!("this is a `{name}`"))
                    .maybe_help(help),
            );
            return self.poison(span);
        }
        if !self.check_index(base, index, size) {
            return self.poison(span);
        }
        self.push(ExprKind::Index(base, index), element, span)
    }

    /// The size that the shader declares `gl_TexCoord` with; its type has all elements, until the stages are linked.
    fn stated_size(&self, base: ExprId) -> Option<u32> {
        let ExprKind::Var(VarRef::Global(id)) = self.expr_at(base).kind else { return None };
        let global = self.shader.global(id);
        self.shader.tex_coords.filter(|_| global.is_fixed() && global.name == TEX_COORD)
    }

    /// Checks an index by the rules of §4.1.7, §4.1.9 and §4.3.7.
    fn check_index(&mut self, base: ExprId, index: ExprId, size: Option<u32>) -> bool {
        let ty = self.ty(base);
        if let Some(value) = self.evaluate_integer(index) {
            return self.check_constant_index(base, index, value, size);
        }
        let at = self.span(index);
        if let Type::Array(element, _) = self.types.get(ty) {
            let constant =
                self.ast.version.has(Feature::ConstantSamplers) && !self.extensions.contains(Extensions::GPU_SHADER5);
            if self.types.contains_sampler(element) && constant {
                self.report_choice(index, "the index of an array of samplers");
                return false;
            }
            if self.is_uniform_block_array(base) && constant {
                self.report_choice(index, "the index of an array of uniform blocks");
                return false;
            }
        }
        if self.is_fragment_output(base) {
            self.require(Feature::DynamicOutputs, at);
        }
        if size.is_none() {
            // A geometry shader's inputs have their size from the layout, which comes "before any use .. requiring its size be known"
            // (1.50 §4.3.8.1).
            let help = self.how_to_size(base);
            self.report(
                Diagnostic::new(&types::UNSIZED_ARRAY, at, "an array without a size takes constant indices only")
                    .here("not a constant expression")
                    .help(help),
            );
            return false;
        }
        true
    }

    /// Reports an index that chooses a sampler or a block and must be constant.
    fn report_choice(&mut self, index: ExprId, what: &str) {
        let version = self.ast.version;
        let row = Feature::ConstantSamplers.row();
        let extensions = if version.is_es() { Extensions::empty() } else { Extensions::GPU_SHADER5 };
        let help = version.remedy(row.gone, Since::new(NEVER, NEVER), extensions);
        let finding = self.not_constant(index, what);
        self.report(Diagnostic { code: &types::SAMPLER_INDEX, ..finding }.maybe_help(help));
    }

    /// Whether an expression is an output of a fragment shader as a whole.
    fn is_fragment_output(&self, base: ExprId) -> bool {
        let ExprKind::Var(VarRef::Global(id)) = self.shader.expr(base).kind else { return false };
        let global = self.shader.global(id);
        self.stage == Stage::Fragment && global.storage == Storage::Out && global.builtin.is_none()
    }

    fn check_constant_index(&mut self, base: ExprId, index: ExprId, value: i64, size: Option<u32>) -> bool {
        let at = self.span(index);
        let too_large = size.is_some_and(|size| value >= i64::from(size));
        if value < 0 || too_large {
            let ty = match (self.types.get(self.ty(base)), size) {
                (Type::Array(element, ArraySize::Sized(_)), Some(size)) => {
                    self.types.array(element, ArraySize::Sized(size))
                }
                _ => self.ty(base),
            };
            let name = self.type_name(ty);
            let last = size.map_or(String::new(), |size| format!(": the last is {}", size.saturating_sub(1)));
            self.report(
                Diagnostic::new(&types::INDEX_RANGE, at, format!("a `{name}` has no element {value}"))
                    .here(format!("out of range{last}")),
            );
            return false;
        }
        if size.is_none() {
            self.note_array_index(base, u32::try_from(value).unwrap_or(u32::MAX), at);
        }
        true
    }

    fn is_uniform_block_array(&self, base: ExprId) -> bool {
        match self.expr_at(base).kind {
            ExprKind::Var(VarRef::Global(id)) => {
                let global = self.shader.global(id);
                global.block.is_some() && global.storage == Storage::Uniform
            }
            _ => false,
        }
    }

    /// Whether an expression is an input of a geometry shader, whose size is that of the input primitive, which may
    /// be declared later.
    /// The remedy for an array that has no size yet.
    fn how_to_size(&self, base: ExprId) -> &'static str {
        if self.is_geometry_input(base) {
            "put `layout(triangles) in;` or another input primitive before this"
        } else {
            "declare the array with a size before this"
        }
    }

    fn is_geometry_input(&self, base: ExprId) -> bool {
        match self.expr_at(base).kind {
            ExprKind::Var(VarRef::Global(id)) => {
                self.stage == Stage::Geometry && self.shader.global(id).storage == Storage::In
            }
            _ => false,
        }
    }

    /// Records the largest constant index of an array that has no size yet; it determines the size (§4.1.9).
    pub(super) fn note_array_index(&mut self, base: ExprId, index: u32, at: Span) {
        if let Some(key) = self.array_key(base) {
            self.uses.note_element(key, index, at);
        }
    }

    /// The array that an expression names, if it may lack a size.
    pub(super) fn array_key(&self, base: ExprId) -> Option<ArrayKey> {
        match self.expr_at(base).kind {
            ExprKind::Var(VarRef::Global(id)) => Some(ArrayKey::Global(id)),
            ExprKind::Var(VarRef::Local(id)) => Some(ArrayKey::Local(id)),
            ExprKind::Member(inner, member) => match self.shader.root_variable(inner) {
                Some(VarRef::Global(id)) => Some(ArrayKey::Member(id, member)),
                _ => None,
            },
            _ => None,
        }
    }

    /// `a.length()`
    pub(super) fn method(&mut self, base: ExprId, name: Ident, arguments: &[ast::ExprId], span: Span) -> ExprId {
        let spelling = self.name(name);
        let ty = self.ty(base);
        if self.is_probe_of_member(name, ty) {
            return self.poison(span);
        }
        self.note(name.span, Denoted::Length(ty), NoteRole::Uses);
        if spelling != "length" {
            self.report(
                Diagnostic::new(&types::METHOD, name.span, format!("there is no method `{spelling}`"))
                    .here("the only method is `length`")
                    .maybe_help(super::foreign::method(spelling).map(str::to_owned)),
            );
            return self.poison(span);
        }
        if !arguments.is_empty() {
            self.report(Diagnostic::new(&types::METHOD, span, "`length` takes no arguments").here("arguments given"));
            return self.poison(span);
        }
        if matches!(self.types.get(ty), Type::Array(..)) {
            self.require(Feature::ArrayObjects, name.span);
        }
        let length = match self.types.get(ty) {
            Type::Error => return self.poison(span),
            Type::Array(_, ArraySize::Sized(size)) => size,
            Type::Vector(_, size) if self.allows(Feature::VectorLength, name.span) => u32::from(size),
            Type::Matrix(columns, _) if self.allows(Feature::VectorLength, name.span) => u32::from(columns),
            Type::Array(_, ArraySize::Unsized) => {
                let at = self.span(base);
                let help = self.how_to_size(base);
                self.report(
                    Diagnostic::new(&types::UNSIZED_ARRAY, at, "the length of an array without a size is not known")
                        .here("no size yet")
                        .help(help),
                );
                return self.poison(span);
            }
            _ => {
                let (name, at) = (self.type_name(ty), self.span(base));
                self.report(
                    Diagnostic::new(&types::METHOD, at, format!("a `{name}` has no `length()`"))
                        .here(format!("this is a `{name}`, not an array"))
                        .maybe_help(
                            matches!(self.types.get(ty), Type::Vector(..))
                                .then(|| "the function `length(...)` gives a vector's length".to_owned()),
                        ),
                );
                return self.poison(span);
            }
        };
        let effects = self.effects_before_length(base);
        let mut value = self.literal(ScalarValue::Int(i32::try_from(length).unwrap_or(i32::MAX)), span);
        for effect in effects {
            value = self.push(ExprKind::Comma(effect, value), TypeId::INT, span);
        }
        value
    }

    /// The parts of an expression before `.length()` that run, the last first: calls and changes of variables. "The expression in
    /// brackets will be evaluated .., but the array will not be dereferenced" (GLSL ES 3.10 §4.1.9).
    fn effects_before_length(&self, base: ExprId) -> Vec<ExprId> {
        let mut effects = Vec::new();
        let mut at = base;
        loop {
            let (part, rest) = match self.expr_at(at).kind {
                ExprKind::Index(inner, index) => (index, Some(inner)),
                ExprKind::Member(inner, _) | ExprKind::Swizzle(inner, _) => (at, Some(inner)),
                _ => (at, None),
            };
            if (part != at || rest.is_none()) && !is_pure(&self.shader, part) {
                effects.push(part);
            }
            match rest {
                Some(inner) => at = inner,
                None => return effects,
            }
        }
    }
}
