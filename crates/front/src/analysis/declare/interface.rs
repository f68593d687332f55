//! Which types a global may have, depending on its storage and the stage (§4.1.7, §4.3.4 to §4.3.6).

use super::super::context::Analyzer;
use super::super::qualifiers::{Qualifiers, StorageWord};
use crate::diagnostic::codes::{qualifiers, types};
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place};
use crate::hir::{ArraySize, Interpolation, Scalar, Stage, Storage, Type, TypeId};
use crate::language::{Extensions, Feature};
use crate::source::Span;

/// An interface of a stage, and the types that cannot cross it.
struct Border {
    stage: Option<Stage>,
    storage: Storage,
    what: &'static str,
    structs: bool,
    matrices: bool,
    interpolation: bool,
}

const fn border(stage: Stage, storage: Storage, what: &'static str) -> Border {
    Border { stage: Some(stage), storage, what, structs: true, matrices: true, interpolation: true }
}

static BORDERS: &[Border] = &[
    Border {
        structs: false,
        interpolation: false,
        ..border(Stage::Vertex, Storage::In, "an input of a vertex shader")
    },
    border(Stage::Vertex, Storage::Out, "an output of a vertex shader"),
    border(Stage::Geometry, Storage::In, "an input of a geometry shader"),
    border(Stage::Geometry, Storage::Out, "an output of a geometry shader"),
    border(Stage::Fragment, Storage::In, "an input of a fragment shader"),
    Border {
        structs: false,
        matrices: false,
        interpolation: false,
        ..border(Stage::Fragment, Storage::Out, "an output of a fragment shader")
    },
];

impl Analyzer<'_> {
    /// Checks the type and qualifiers of a global against its storage. Returns the type, or poison.
    pub(super) fn check_global_type(
        &mut self,
        ty: TypeId,
        storage: Storage,
        record: &Qualifiers,
        ty_span: Span,
        name: Span,
    ) -> TypeId {
        if ty.is_error() {
            return ty;
        }
        if ty == TypeId::VOID {
            self.report(
                Diagnostic::new(&types::VOID_VALUE, ty_span, "a variable cannot be `void`").here("not a value"),
            );
            return TypeId::ERROR;
        }
        if self.types.contains_sampler(ty) && storage != Storage::Uniform {
            let help = match storage {
                Storage::Private => {
                    Advice::new(Applicability::Safe, "write `uniform` before it", Place::Before, "uniform ")
                }
                _ => "declare it `uniform`, with no other storage qualifier".into(),
            };
            self.report_sampler(ty, ty_span, name, help);
            return TypeId::ERROR;
        }
        match storage {
            Storage::In | Storage::Out => self.check_border(ty, storage, record, ty_span, name),
            Storage::Const | Storage::Private | Storage::Uniform => {
                self.no_interpolation(record, "a variable that does not pass between stages");
                ty
            }
        }
    }

    /// Reports a sampler that is neither a uniform nor a parameter.
    pub(in crate::analysis) fn report_sampler(&mut self, ty: TypeId, span: Span, name: Span, help: impl Into<Advice>) {
        let type_name = self.type_name(ty);
        self.report(
            Diagnostic::new(&types::SAMPLER, span, format!("a `{type_name}` must be a uniform or a parameter"))
                .here("holds a sampler")
                .label(name, "declared here")
                .help(help),
        );
    }

    fn check_border(&mut self, ty: TypeId, storage: Storage, record: &Qualifiers, ty_span: Span, name: Span) -> TypeId {
        let Some(border) = BORDERS.iter().find(|row| row.stage == Some(self.stage) && row.storage == storage) else {
            return ty;
        };
        if !border.interpolation {
            self.no_interpolation(record, border.what);
        } else if let (Some((_, span)), Some((StorageWord::Varying | StorageWord::Attribute, _))) =
            (record.interpolation, record.storage)
            && !self.extensions.contains(Extensions::GPU_SHADER4)
        {
            self.misplaced(span, "`varying` takes no interpolation qualifier", "use `in` or `out`");
        }
        if let (Some(span), Storage::In) = (record.invariant, storage) {
            self.require(Feature::InvariantInputs, span);
        }
        self.require_crossing(ty, border, ty_span);
        if let Some(why) = self.cannot_cross(ty, border) {
            let type_name = self.type_name(ty);
            self.report(
                Diagnostic::new(
                    &qualifiers::INTERFACE_TYPE,
                    ty_span,
                    format!("{} cannot be a `{type_name}`", border.what),
                )
                .here(why)
                .label(name, "declared here"),
            );
            return TypeId::ERROR;
        }
        let is_array = matches!(self.types.get(ty), Type::Array(..));
        if self.stage == Stage::Geometry && storage == Storage::In && !is_array {
            self.report(
                Diagnostic::new(&qualifiers::GEOMETRY_INPUT, name, "an input of a geometry shader must be an array")
                    .here("one element for each vertex of the primitive")
                    .help(Advice::new(Applicability::Safe, "write `[]` after the name", Place::After, "[]")),
            );
            return TypeId::ERROR;
        }
        self.check_flat(ty, storage, record, ty_span, name);
        ty
    }

    /// Checks that integer inputs of a fragment shader are `flat` (§4.3.4), and in 1.30, 1.40 and ES 3.00 the outputs of a vertex
    /// shader, too (1.30 §4.3.6; ES 3.00 §4.3.6).
    fn check_flat(&mut self, ty: TypeId, storage: Storage, record: &Qualifiers, ty_span: Span, name: Span) {
        let Some(what) = self.not_flat(ty, storage, record) else { return };
        self.report(
            Diagnostic::new(&qualifiers::INTEGER_NOT_FLAT, ty_span, what)
                .here("integers are not interpolated")
                .label(name, "declared here")
                .help(format!(
                    "write `flat` before `{}`, on both sides",
                    if storage == Storage::In { "in" } else { "out" }
                )),
        );
    }

    /// Whether integers cross the interface of a stage at all.
    fn has_integers(&self) -> bool {
        self.ast.version.has_with(Feature::IntegerInterfaces, self.extensions)
    }

    /// The message about an input or output with integers that must be `flat` and is not.
    pub(super) fn not_flat(&self, ty: TypeId, storage: Storage, record: &Qualifiers) -> Option<String> {
        let direction = match (self.stage, storage) {
            (Stage::Fragment, Storage::In) => "input of a fragment shader",
            (Stage::Vertex, Storage::Out) if !self.ast.version.has(Feature::IntegerOutputs) && self.has_integers() => {
                "output of a vertex shader"
            }
            _ => return None,
        };
        let is_flat = matches!(record.interpolation, Some((Interpolation::Flat, _)));
        let has_integers = self.types.summary(ty).holds(&[Scalar::Int, Scalar::Uint]);
        (!is_flat && has_integers).then(|| format!("a `{}` {direction} must be `flat`", self.type_name(ty)))
    }

    /// Reports types that cross interfaces only in later versions.
    fn require_crossing(&mut self, ty: TypeId, border: &Border, span: Span) {
        let inner = self.types.get(self.element_of(ty));
        if border.structs && matches!(inner, Type::Struct(_)) {
            self.require(Feature::StructInterfaces, span);
        }
        if self.types.summary(ty).holds(&[Scalar::Int, Scalar::Uint]) {
            self.require(Feature::IntegerInterfaces, span);
        }
        let attribute = self.stage == Stage::Vertex && border.storage == Storage::In;
        if attribute && matches!(self.types.get(ty), Type::Array(..)) {
            self.require(Feature::ArrayAttributes, span);
        }
    }

    fn cannot_cross(&self, ty: TypeId, border: &Border) -> Option<&'static str> {
        let inner = self.element_of(ty);
        if self.types.summary(ty).holds(&[Scalar::Bool]) {
            return Some("booleans cannot pass between stages; use an integer");
        }
        if let Some(why) = self.cannot_cross_in_es(ty, border) {
            return Some(why);
        }
        match self.types.get(inner) {
            Type::Struct(_) if !border.structs => Some("a struct is not allowed here; declare its members one by one"),
            Type::Matrix(..) if !border.matrices => Some("a matrix is not allowed here; declare its columns"),
            _ if border.storage == Storage::Out
                && self.stage == Stage::Fragment
                && matches!(self.types.get(ty), Type::Array(_, ArraySize::Unsized)) =>
            {
                None
            }
            _ => None,
        }
    }

    /// Nested types that GLSL ES does not pass from the vertex stage to the fragment stage (ES 3.00 §4.3.4, §4.3.6).
    fn cannot_cross_in_es(&self, ty: TypeId, border: &Border) -> Option<&'static str> {
        let is_between =
            matches!((self.stage, border.storage), (Stage::Vertex, Storage::Out) | (Stage::Fragment, Storage::In));
        if !self.ast.version.is_es() || !is_between {
            return None;
        }
        match self.types.get(ty) {
            Type::Array(element, _) => match self.types.get(element) {
                Type::Array(..) => Some("GLSL ES passes no array of arrays; declare one array"),
                Type::Struct(_) => Some("GLSL ES passes no array of structs; declare an array for each member"),
                _ => None,
            },
            Type::Struct(id) => {
                self.types.structure(id).members.iter().find_map(|member| match self.types.get(member.ty) {
                    Type::Array(..) => Some("GLSL ES passes no struct with an array; declare the array by itself"),
                    Type::Struct(_) => Some("GLSL ES passes no struct in a struct; declare the inner one by itself"),
                    _ => None,
                })
            }
            _ => None,
        }
    }

    /// The type without its array dimensions.
    pub(in crate::analysis) fn element_of(&self, mut ty: TypeId) -> TypeId {
        while let Type::Array(element, _) = self.types.get(ty) {
            ty = element;
        }
        ty
    }

    /// Reports `smooth`, `flat`, `noperspective`, `centroid`, `sample` and `invariant` where nothing is interpolated.
    pub(super) fn no_interpolation(&mut self, record: &Qualifiers, what: &str) {
        let interpolation = record.interpolation.map(|(word, span)| (word.name(), span));
        let sampling = record.sampling.and_then(|(sampling, span)| Some((sampling.word()?, span)));
        let is_output = matches!(record.storage, Some((StorageWord::Out, _)));
        let invariant = record.invariant.filter(|_| !is_output).map(|span| ("invariant", span));
        for (word, span) in interpolation.into_iter().chain(sampling).chain(invariant) {
            self.misplaced(span, format!("`{word}` is not allowed before {what}"), "remove it");
        }
    }
}
