//! Type specifiers (§4.1) and array sizes (§4.1.9), resolved to types.

use super::context::Analyzer;
use super::keywords;
use super::scope::Entry;
use crate::diagnostic::codes::{names, qualifiers, types};
use crate::diagnostic::{Advice, Diagnostic, did_you_mean};
use crate::hir::{ArraySize, Member, Scalar, ScalarValue, Type, TypeId};
use crate::language::{Feature, Precision};
use crate::source::Span;
use crate::syntax::ast::{
    ArrayDim, ExprId as AstExprId, Ident, ParamDecl, Qualifier, QualifierKind, TypeBase, TypeSpec, VariableDecl,
};
use crate::syntax::of_later_word;
use crate::syntax::token::Symbol;

/// The largest size of an array. No target could bind a larger one, which would only cost memory.
const MAX_ARRAY_SIZE: u32 = 1 << 16;

/// How many members of one uniform are compared with those of the other stage.
const MOST_PRECISIONS: usize = 4096;

impl Analyzer<'_> {
    /// The type that a specifier denotes, with the arrays after it. Enters a struct that the specifier declares.
    pub(super) fn type_spec(&mut self, spec: &TypeSpec) -> TypeId {
        self.type_spec_of(spec, false)
    }

    /// The type of variables. If each has an initializer, inner arrays may lack their sizes (4.30 §4.1.9).
    pub(super) fn declared_type(&mut self, declaration: &VariableDecl) -> TypeId {
        let infers = declaration.declarators.iter().all(|declarator| declarator.initializer.is_some());
        self.type_spec_of(&declaration.ty, infers && !declaration.declarators.is_empty())
    }

    fn type_spec_of(&mut self, spec: &TypeSpec, infers: bool) -> TypeId {
        let base = match &spec.base {
            TypeBase::Error => TypeId::ERROR,
            TypeBase::Void => TypeId::VOID,
            TypeBase::Keyword(symbol) => self.keyword_type(*symbol, spec.span),
            TypeBase::Named(name) => self.named_type(*name),
            TypeBase::Struct(declaration) => self.structure(declaration, spec.span),
        };
        if !spec.array.is_empty() {
            self.require_array_type(spec);
        }
        self.arrays(base, &spec.array, infers)
    }

    /// Reports the size of an array before its name, where the version has it behind the name alone.
    fn require_array_type(&mut self, spec: &TypeSpec) {
        let text = self.sources.snippet(spec.span);
        let help = text
            .split_once('[')
            .map(|(base, size)| format!("write the size behind the name: `{} a[{size}`", base.trim_end()));
        self.require_with(Feature::ArrayTypes, spec.span, help.map(Advice::from));
    }

    /// The type of a constructor, whose arguments tell every size that the brackets leave out (4.30 §5.4.4).
    pub(super) fn constructor_type(&mut self, spec: &TypeSpec) -> TypeId {
        let base = self.type_spec(&TypeSpec { array: Vec::new(), ..spec.clone() });
        self.arrays(base, &spec.array, true)
    }

    /// An array of `base` for each pair of brackets; before 4.30 there are only one-dimensional arrays.
    pub(super) fn with_array(&mut self, base: TypeId, dims: &[ArrayDim]) -> TypeId {
        self.arrays(base, dims, false)
    }

    fn array_of_arrays(&self, element: TypeId, dim: Span) -> Diagnostic {
        let message = format!("an array of `{}` is an array of arrays", self.type_name(element));
        Diagnostic::new(&types::ARRAY_OF_ARRAYS, dim, message)
            .here("a second dimension")
            .help("put the inner array into a struct, or compute one index from two")
    }

    /// The arrays of [`with_array`](Self::with_array). If `infers`, inner ones may lack sizes, too: a value tells them.
    pub(super) fn arrays(&mut self, base: TypeId, dims: &[ArrayDim], infers: bool) -> TypeId {
        let (mut ty, mut inner_dim) = (base, None);
        for dim in dims.iter().rev() {
            let size = self.array_size(dim);
            if ty == TypeId::VOID {
                self.report(Diagnostic::new(&types::VOID_VALUE, dim.span, "an array of `void` holds nothing"));
                return TypeId::ERROR;
            }
            if let Type::Array(_, inner) = self.types.get(ty)
                && (!infers && inner == ArraySize::Unsized || !self.allows(Feature::ArraysOfArrays, dim.span))
            {
                let finding =
                    match inner_dim.filter(|_| self.ast.version.has_with(Feature::ArraysOfArrays, self.extensions)) {
                        Some(inner) => unsized_element(inner),
                        None => self.array_of_arrays(ty, dim.span),
                    };
                self.report(finding);
                return TypeId::ERROR;
            }
            inner_dim = Some(dim.span);
            ty = match size {
                Some(size) if !ty.is_error() => self.types.array(ty, size),
                _ => TypeId::ERROR,
            };
        }
        ty
    }

    /// Whether a type is `given`, but for sizes of arrays that it leaves to the value.
    pub(super) fn leaves_sizes_to(&self, ty: TypeId, given: TypeId) -> bool {
        match (self.types.get(ty), self.types.get(given)) {
            (Type::Array(element, size), Type::Array(other, known)) => {
                (size == known || size == ArraySize::Unsized) && self.leaves_sizes_to(element, other)
            }
            _ => ty == given,
        }
    }

    /// The size in brackets; `None` if it is in error.
    fn array_size(&mut self, dim: &ArrayDim) -> Option<ArraySize> {
        match dim.size {
            Some(size) => self.constant_size(size).map(ArraySize::Sized),
            None => Some(ArraySize::Unsized),
        }
    }

    /// The value of a constant integral expression greater than zero.
    fn constant_size(&mut self, size: AstExprId) -> Option<u32> {
        let id = self.expr(size);
        let (ty, span) = (self.ty(id), self.span(id));
        if ty.is_error() {
            return None;
        }
        if ty != TypeId::INT && ty != TypeId::UINT {
            let name = self.type_name(ty);
            self.report(
                Diagnostic::new(&types::ARRAY_SIZE, span, format!("an array's size is an integer, not a `{name}`"))
                    .here(format!("this is a `{name}`")),
            );
            return None;
        }
        let Some(value) = self.evaluate(id) else {
            self.report(self.not_constant(id, "an array's size"));
            return None;
        };
        let size = match value.scalars.first() {
            Some(&ScalarValue::Int(size)) => i64::from(size),
            Some(&ScalarValue::Uint(size)) => i64::from(size),
            _ => 0,
        };
        if size == 0 && is_too_large(self.sources.snippet(span)) {
            return None;
        }
        if size <= 0 {
            self.report(
                Diagnostic::new(&types::ARRAY_SIZE, span, format!("an array of {size} elements is none"))
                    .here("the size must be greater than zero"),
            );
            return None;
        }
        if size > i64::from(MAX_ARRAY_SIZE) {
            self.report(
                Diagnostic::new(&types::ARRAY_SIZE, span, format!("an array of {size} elements is too large"))
                    .here(format!("at most {MAX_ARRAY_SIZE} can be bound anywhere")),
            );
            return None;
        }
        u32::try_from(size).ok()
    }

    /// `precision highp float;` (§4.5.3), which has no effect.
    pub(super) fn precision(&mut self, qualifier: &Qualifier, spec: &TypeSpec) {
        let ty = self.type_spec(spec);
        let word = match qualifier.kind {
            QualifierKind::Lowp => Precision::Low,
            QualifierKind::Mediump => Precision::Medium,
            _ => Precision::High,
        };
        match self.types.get(ty) {
            Type::Scalar(scalar) => self.precisions.set_scalar(scalar, word),
            Type::Sampler(sampler) => self.precisions.set_sampler(sampler, word),
            // The type that is meant is not known.
            Type::Error => self.precisions.forgive(),
            _ => {}
        }
        // Every driver accepts samplers here in every version, also without effect.
        let takes_samplers = !self.strict || self.ast.version.has(Feature::SamplerPrecision);
        let is_sampler = matches!(self.types.get(ty), Type::Sampler(_));
        if ty.is_error() || ty == TypeId::INT || ty == TypeId::FLOAT || takes_samplers && is_sampler {
            return;
        }
        let name = self.type_name(ty);
        self.report(
            Diagnostic::new(&types::PRECISION_TYPE, spec.span, format!("`{name}` has no default precision"))
                .here("only `int` and `float` have one")
                .label(qualifier.span, "the precision is set here"),
        );
    }

    /// Reports a precision qualifier on a type that cannot have one (§4.5.2), and in ES a type at `at` without a
    /// precision (GLSL ES 3.00 §4.5.4).
    pub(super) fn check_precision(&mut self, precision: Option<(Precision, Span)>, ty: TypeId, at: Span) {
        if precision.is_none() {
            return self.check_default_precision(ty, at);
        }
        let Some((_, span)) = precision.filter(|_| !ty.is_error()) else { return };
        let element = self.element_of(ty);
        let takes = match self.types.get(element) {
            Type::Sampler(_) => true,
            _ => self.types.scalar_of(element).is_some_and(|scalar| scalar != Scalar::Bool),
        };
        if !takes {
            let name = self.type_name(ty);
            self.report(
                Diagnostic::new(&types::PRECISION_TYPE, span, format!("a `{name}` has no precision"))
                    .here("only integers and floats have one"),
            );
        }
    }

    /// The precision of a variable in ES, stated or by default; none for what has none, such as booleans and structs.
    pub(super) fn precision_of(&self, stated: Option<(Precision, Span)>, ty: TypeId) -> Option<Precision> {
        let element = self.element_of(ty);
        let default = match self.types.get(element) {
            Type::Sampler(sampler) => self.precisions.of_sampler(sampler),
            _ => self.types.scalar_of(element).and_then(|scalar| self.precisions.of_scalar(scalar)),
        };
        if self.ast.version.is_es() { stated.map(|(word, _)| word).or(default) } else { None }
    }

    /// Notes the precision of a uniform or of a member of a uniform block, for the linker; of a struct, those of its members.
    pub(super) fn note_precision(&mut self, name: String, stated: Option<(Precision, Span)>, ty: TypeId, span: Span) {
        let mut pending = vec![(name, self.precision_of(stated, ty), ty, span)];
        for _ in 0..MOST_PRECISIONS {
            let Some((name, precision, ty, span)) = pending.pop() else { return };
            if let Some(precision) = precision {
                self.shader.precisions.push((name, precision, span));
                continue;
            }
            let Type::Struct(id) = self.types.get(self.element_of(ty)) else { continue };
            let members = self.types.structure(id).members.iter().zip(self.declared.precisions(id));
            let members = members.take(MOST_PRECISIONS.saturating_sub(pending.len()));
            let named = |member: &Member| format!("{name}.{}", member.name);
            pending.extend(members.map(|(member, word)| (named(member), *word, member.ty, member.span)).rev());
        }
    }

    fn check_default_precision(&mut self, ty: TypeId, at: Span) {
        let element = self.element_of(ty);
        let lacks = match self.types.get(element) {
            Type::Sampler(sampler) => self.precisions.lacks_sampler(sampler),
            _ => self.types.scalar_of(element).is_some_and(|scalar| self.precisions.lacks(scalar)),
        };
        if lacks {
            let is_float = self.types.scalar_of(element).is_some();
            let name = if is_float { "float".to_owned() } else { self.type_name(element) };
            let message = format!("`{name}` has no default precision in a {} shader of ES", self.stage.name());
            self.report(
                Diagnostic::new(&qualifiers::MISSING_PRECISION, at, message)
                    .here("no precision here")
                    .help(format!("begin the shader with `precision highp {name};`")),
            );
        }
    }

    fn keyword_type(&mut self, symbol: Symbol, span: Span) -> TypeId {
        let known = match self.declared.keyword_type(symbol) {
            Some(known) => Some(known),
            None => {
                let name = self.ast.names.spelling(symbol);
                let ty = keywords::type_of(name);
                let known = ty.map(|ty| self.types.intern(ty));
                // A name that is unknown here may be known after an `#extension` line.
                if let Some(known) = known {
                    self.declared.add_keyword_type(symbol, known);
                }
                known
            }
        };
        known.unwrap_or_else(|| {
            let name = self.ast.names.spelling(symbol);
            self.report(Diagnostic::new(
                &names::UNKNOWN_TYPE,
                span,
                format!("`{name}` is not a type of this language version"),
            ));
            TypeId::ERROR
        })
    }

    fn named_type(&mut self, name: Ident) -> TypeId {
        let spelling = self.name(name);
        if self.is_probe(name) {
            return TypeId::ERROR;
        }
        let found = self.scopes.find(name.symbol);
        if let Some(binding) = found {
            self.note_binding(name.span, binding);
        }
        match found.map(|binding| binding.entry) {
            Some(Entry::Struct(ty)) => ty,
            Some(Entry::Poison) => TypeId::ERROR,
            Some(entry) => {
                let what = if matches!(entry, Entry::Functions(_)) { "a function" } else { "a variable" };
                let declared = found.map_or(Span::default(), |binding| binding.span);
                self.report(
                    Diagnostic::new(&names::UNKNOWN_TYPE, name.span, format!("`{spelling}` is {what}, not a type"))
                        .here("a type is expected here")
                        .label(declared, format!("declared as {what} here")),
                );
                TypeId::ERROR
            }
            None => {
                if let Some(ty) = self.builtin_struct(spelling) {
                    return ty;
                }
                let near = |this: &mut Self| Some(Advice::meant(this.nearest_type(spelling)?));
                let help = super::expr::foreign::type_name(spelling).or_else(|| near(self));
                let finding =
                    Diagnostic::new(&names::UNKNOWN_TYPE, name.span, format!("there is no type `{spelling}`"))
                        .here("not declared before this")
                        .maybe_help(help);
                self.report(of_later_word(finding, spelling, self.ast.version));
                TypeId::ERROR
            }
        }
    }

    /// Reports a parameter that is a name without a type: `float f(x)`.
    pub(super) fn report_untyped(&mut self, param: &ParamDecl) -> bool {
        let (TypeBase::Named(name), None) = (&param.ty.base, param.name) else { return false };
        let name = *name;
        let spelling = self.name(name);
        let is_known =
            self.scopes.find(name.symbol).is_some() || self.is_probe(name) || self.builtin_struct(spelling).is_some();
        if is_known || super::expr::foreign::type_name(spelling).is_some() || self.nearest_type(spelling).is_some() {
            return false;
        }
        let finding =
            Diagnostic::new(&names::UNKNOWN_TYPE, name.span, format!("the parameter `{spelling}` has no type"))
                .here("a type is expected here")
                .help(format!("write the type before the name, such as `float {spelling}`"));
        self.report(of_later_word(finding, spelling, self.ast.version));
        true
    }

    fn nearest_type(&mut self, spelling: &str) -> Option<String> {
        self.may_suggest()?;
        let structs = self.scopes.names().filter(|(_, binding)| matches!(binding.entry, Entry::Struct(_)));
        let mut known: Vec<&str> = structs.map(|(symbol, _)| self.ast.names.spelling(symbol)).collect();
        for name in keywords::names(self.ast.version, self.extensions) {
            known.push(name);
        }
        known.push("return");
        let meant = did_you_mean(spelling, known).map(str::to_owned)?;
        self.note_meant(&meant);
        Some(meant)
    }
}

/// The finding for `float a[2][]`: only the outermost dimension may be without a size (4.30 §4.1.9).
fn unsized_element(dim: Span) -> Diagnostic {
    Diagnostic::new(&types::UNSIZED_ARRAY, dim, "the elements of an array of arrays need a size")
        .here("no size here")
        .help("only the first pair of brackets may be empty")
}

/// Whether a text is a number of more than 32 bits, which is reported where it is read.
fn is_too_large(text: &str) -> bool {
    text.bytes().all(|byte| byte.is_ascii_digit()) && text.trim_start_matches('0').len() > 9
}
