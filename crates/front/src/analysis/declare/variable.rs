//! Declares variables at global scope (§4.3).

use super::super::context::Analyzer;
use super::super::layout::{Layout, LayoutSubject};
use super::super::qualifiers::{DeclarationContext, Qualifiers, StorageWord};
use super::super::scope::Entry;
use super::super::state::ArrayKey;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{qualifiers, syntax, types};
use crate::hir::{
    ArraySize, ExprId, ExprKind, Global, GlobalId, Interpolation, Stage, Storage, Type, TypeId, Value, VarRef,
};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{Declarator, TypeBase, TypeSpec, VariableDecl};

/// The initial value of a variable: the expression after conversion, and its constant value, if it has one.
pub(in crate::analysis) struct Initial {
    pub(in crate::analysis) expr: ExprId,
    pub(in crate::analysis) value: Option<Value>,
}

impl Analyzer<'_> {
    /// `uniform mat4 m, n;`, `struct S {..} s;`
    pub(in crate::analysis) fn global_variables(&mut self, declaration: &VariableDecl, _: Span) {
        let record = self.qualifiers(&declaration.qualifiers, DeclarationContext::Global);
        if declaration.declarators.is_empty() && self.lacks_type(&declaration.ty) {
            return;
        }
        let base = self.declared_type(declaration);
        self.check_precision(record.precision, base, declaration.ty.span);
        let has_value = declaration.declarators.iter().any(|declarator| declarator.initializer.is_some());
        let storage = self.global_storage(&record, has_value);
        if declaration.declarators.is_empty() {
            self.require_size(base, declaration.ty.span);
            if let (Some(span), Storage::In) = (record.invariant, storage) {
                self.require(Feature::InvariantInputs, span);
            }
            match (storage, self.types.get(base)) {
                (Storage::Private, Type::Struct(_)) => self.layout(&record, LayoutSubject::Struct),
                _ => self.layout(&record, self.layout_subject(storage, base)),
            };
        }
        for declarator in &declaration.declarators {
            let ty = self.arrays(base, &declarator.array, declarator.initializer.is_some());
            self.note_precise(&declaration.qualifiers, declarator.name);
            if self.name(declarator.name).starts_with("gl_") && self.redeclare_builtin(declarator, ty, &record) {
                continue;
            }
            self.global_variable(declarator, ty, storage, &record, declaration.ty.span);
        }
    }

    /// `S;` declares nothing, which is legal if `S` is a struct (§9). Any other name lacks its type, which is
    /// reported.
    fn lacks_type(&mut self, spec: &TypeSpec) -> bool {
        let TypeBase::Named(name) = spec.base else { return false };
        if self.is_probe(name) {
            return true;
        }
        match self.scopes.find(name.symbol).map(|binding| binding.entry) {
            Some(Entry::Struct(_)) => return false,
            Some(Entry::Poison) => return true,
            _ => {}
        }
        let spelling = self.name(name);
        self.report(
            Diagnostic::new(&syntax::MISSING_TYPE, name.span, format!("`{spelling}` is declared without a type"))
                .help(format!("write a type before `{spelling}`")),
        );
        true
    }

    /// The storage that a global's qualifiers mean in this stage.
    fn global_storage(&mut self, record: &Qualifiers, has_value: bool) -> Storage {
        if let (Some(constant), Some((word, span))) = (record.constant, record.storage) {
            self.report(
                Diagnostic::new(
                    &qualifiers::REPEATED,
                    span,
                    format!("a variable is `const` or `{}`, not both", word.spelling()),
                )
                .here("one too many")
                .label(constant, "already `const`"),
            );
            // Without a value, `const` is the one that is too many.
            if has_value {
                return Storage::Const;
            }
        }
        let Some((word, span)) = record.storage else {
            return if record.constant.is_some() { Storage::Const } else { Storage::Private };
        };
        match word {
            StorageWord::In | StorageWord::Out => self.require(Feature::InOut, span),
            StorageWord::Attribute | StorageWord::Varying => self.require(Feature::Attributes, span),
            StorageWord::VaryingOut | StorageWord::Uniform | StorageWord::Inout => {}
        }
        match (word, self.stage) {
            (StorageWord::Uniform, _) => Storage::Uniform,
            (StorageWord::In, _) => Storage::In,
            (StorageWord::Out, _) => Storage::Out,
            (StorageWord::Attribute, Stage::Vertex) => Storage::In,
            (StorageWord::Attribute, stage) => {
                let message = format!("there are no attributes in a {} shader", stage.name());
                let has_in = self.ast.version.has(Feature::InOut);
                self.misplaced(span, message, if has_in { "use `in`" } else { "use `varying`" });
                Storage::In
            }
            (StorageWord::VaryingOut, Stage::Fragment) => Storage::Out,
            (StorageWord::VaryingOut, _) => {
                self.misplaced(span, "`varying out` is an output of a fragment shader", "remove `out`");
                Storage::Out
            }
            (StorageWord::Varying, Stage::Fragment) => Storage::In,
            (StorageWord::Varying, _) => Storage::Out,
            (StorageWord::Inout, _) => {
                self.misplaced(span, "`inout` is for parameters", "declare an `in` and an `out` under two names");
                Storage::Private
            }
        }
    }

    fn global_variable(
        &mut self,
        declarator: &Declarator,
        ty: TypeId,
        storage: Storage,
        record: &Qualifiers,
        ty_span: Span,
    ) {
        let name = declarator.name;
        let named_well = self.check_name(name) && self.check_block_name(name);
        let layout = self.layout(record, self.layout_subject(storage, ty));
        self.check_index_location(&layout);
        self.check_component(&layout, ty);
        let ty = self.check_global_type(ty, storage, record, ty_span, name.span);
        let fits = self.check_global_size(ty, storage, false, name.span);
        let ty = if fits { ty } else { TypeId::ERROR };
        let declared = ty;
        let (ty, initial) = self.global_initializer(declarator, ty, storage);
        // An array that its initializer sizes counts with that size.
        let fits = ty == declared || self.check_global_size(ty, storage, false, name.span);
        let ty = if fits { ty } else { TypeId::ERROR };
        self.check_places(&layout, ty, false);
        let ty = self.sized_by_geometry(ty, storage, name.span);
        self.require_declared_size(declarator, ty);
        self.check_builtin_scope(name);
        if self.resizes(declarator, ty, storage) {
            return;
        }
        if storage == Storage::Uniform && self.ast.version.is_es() {
            self.note_precision(self.name(name).to_owned(), record.precision, ty, name.span);
        }
        let global = self.new_global(name.span, self.name(name), ty, storage, record, &layout, initial);
        let id = self.add_global(global);
        let entry = if named_well { Entry::Variable(VarRef::Global(id)) } else { Entry::Poison };
        self.enter(name, entry);
    }

    /// Reports an array without a size where the language wants one, unless an initializer was to tell it: that is in error, which has
    /// been reported.
    pub(in crate::analysis) fn require_declared_size(&mut self, declarator: &Declarator, ty: TypeId) {
        if declarator.initializer.is_none() {
            self.require_size(ty, declarator.name.span);
        }
    }

    /// Reports an array without a size where the language wants one in each declaration.
    pub(in crate::analysis) fn require_size(&mut self, ty: TypeId, span: Span) {
        if matches!(self.types.get(ty), Type::Array(_, ArraySize::Unsized)) {
            self.require(Feature::UnsizedArrays, span);
        }
    }

    #[expect(clippy::too_many_arguments, reason = "each is one column of the record that it fills")]
    pub(super) fn new_global(
        &self,
        span: Span,
        name: &str,
        ty: TypeId,
        storage: Storage,
        record: &Qualifiers,
        layout: &Layout,
        initial: Option<Initial>,
    ) -> Global {
        let (initializer, value) = initial.map_or((None, None), |initial| (Some(initial.expr), initial.value));
        let invariant_all =
            self.ast.invariant_all.is_some() && storage == Storage::Out && self.stage != Stage::Fragment;
        Global {
            name: name.to_owned(),
            ty,
            storage,
            builtin: None,
            interpolation: record.interpolation.map_or(Interpolation::default(), |(word, _)| word),
            interpolation_written: record.interpolation.is_some(),
            sampling: record.sampling(),
            invariant: record.invariant.is_some() || invariant_all,
            location: layout.location.map(|(value, _)| value),
            host_location: layout.host_location.map(|(value, _)| value),
            component: layout.component.map(|(value, _)| value),
            index: layout.index.map(|(value, _)| value),
            binding: layout.binding.map(|(value, _)| value),
            block: None,
            initializer,
            value,
            implicitly_sized: false,
            used: false,
            written: false,
            span,
        }
    }

    /// Adds a global to the shader.
    pub(super) fn add_global(&mut self, global: Global) -> GlobalId {
        self.shader.globals.push(global);
        GlobalId::new(self.shader.globals.len() - 1)
    }

    /// Reports a component without a location, or one from which the type does not fit into a location (4.40 §4.4.1).
    pub(super) fn check_component(&mut self, layout: &Layout, ty: TypeId) {
        let Some((component, span)) = layout.component else { return };
        let mut element = ty;
        while let Type::Array(inner, _) = self.types.get(element) {
            element = inner;
        }
        let size = match self.types.get(element) {
            Type::Scalar(_) => 1,
            Type::Vector(_, size) => u32::from(size),
            Type::Error => return,
            _ => 5,
        };
        let problem = if layout.location.is_none() {
            "`component` needs a `location`".to_owned()
        } else if component.saturating_add(size) > 4 {
            format!("a `{}` does not fit into a location from component {component} on", self.type_name(ty))
        } else {
            return;
        };
        self.report(
            Diagnostic::new(&qualifiers::LAYOUT_VALUE, span, problem)
                .here("a location has the components 0 to 3, for scalars and vectors"),
        );
    }

    /// Reports an index without a location, which means nothing, and one that is neither 0 nor 1
    /// (ARB_explicit_attrib_location).
    fn check_index_location(&mut self, layout: &Layout) {
        if let Some((index @ 2.., span)) = layout.index {
            self.report(
                Diagnostic::new(&qualifiers::LAYOUT_VALUE, span, format!("there is no `index` {index}"))
                    .here("0 or 1: the first or the second source of blending"),
            );
        }
        let (Some((index, span)), None) = (layout.index, layout.location) else { return };
        self.report(
            Diagnostic::new(&qualifiers::LAYOUT_VALUE, span, "`index` needs a `location`")
                .here("no location given")
                .help(format!("write `location = 0, index = {index}`")),
        );
    }

    fn layout_subject(&self, storage: Storage, ty: TypeId) -> LayoutSubject {
        match (storage, self.stage) {
            (Storage::In, Stage::Vertex) => LayoutSubject::VertexInput,
            (Storage::In, _) => LayoutSubject::Varying,
            (Storage::Out, Stage::Fragment) => LayoutSubject::FragmentOutput,
            (Storage::Out, _) => LayoutSubject::Varying,
            // An unknown type may be one of samplers.
            (Storage::Uniform, _) if ty.is_error() || self.types.contains_sampler(ty) => LayoutSubject::Sampler,
            (Storage::Uniform, _) => LayoutSubject::Uniform,
            (Storage::Const, _) => LayoutSubject::Other("a constant"),
            (Storage::Private, _) => LayoutSubject::Other("a variable without a storage qualifier"),
        }
    }

    /// Analyzes the initializer of a global, which may determine the size of an array.
    fn global_initializer(
        &mut self,
        declarator: &Declarator,
        ty: TypeId,
        storage: Storage,
    ) -> (TypeId, Option<Initial>) {
        let Some(initializer) = declarator.initializer else {
            if storage == Storage::Const && !ty.is_error() {
                self.report_no_value(declarator);
                return (TypeId::ERROR, None);
            }
            return (ty, None);
        };
        let expr = self.initializer(initializer, ty);
        if matches!(storage, Storage::In | Storage::Out) {
            let (span, what) = (self.span(expr), if storage == Storage::In { "an input" } else { "an output" });
            self.report(
                Diagnostic::new(&qualifiers::NO_INITIALIZER, span, format!("{what} cannot have an initializer"))
                    .here("remove it")
                    .label(declarator.name.span, format!("declared as {what}")),
            );
            return (ty, None);
        }
        let (ty, expr) = self.fit_initializer(declarator, ty, expr);
        if self.ty(expr).is_error() {
            return (if storage == Storage::Const { TypeId::ERROR } else { ty }, None);
        }
        self.require_array_value(expr, self.span(expr));
        if storage == Storage::Private {
            self.check_private_initializer(expr);
            return (ty, Some(Initial { expr, value: None }));
        }
        if storage == Storage::Uniform {
            self.require(Feature::UniformInitializers, self.span(expr));
        }
        if self.types.contains_sampler(ty) {
            let span = self.span(expr);
            self.report(
                Diagnostic::new(&qualifiers::NO_INITIALIZER, span, "a sampler cannot have an initializer")
                    .here("the application sets it"),
            );
            return (ty, None);
        }
        let value = self.evaluate(expr);
        if value.is_none() {
            let what = if storage == Storage::Const { "the value of a constant" } else { "a uniform's initializer" };
            self.report(self.not_constant_value(expr, what));
            return (TypeId::ERROR, None);
        }
        (ty, Some(Initial { expr, value }))
    }

    /// "In declarations of global variables .. initializers must be constant expressions" (GLSL ES 1.00 §4.3; ES 3.00 §4.3). For ES
    /// 1.00, WebGL accepts uniforms and other globals with a warning.
    fn check_private_initializer(&mut self, expr: ExprId) {
        let span = self.span(expr);
        if self.is_constant(expr) || self.ast.version.has(Feature::GlobalInitializers) {
            return;
        }
        if self.strict || !self.ast.version.has(Feature::LooseGlobalInitializers) || !self.is_of_globals(expr) {
            self.require(Feature::GlobalInitializers, span);
            return;
        }
        self.report(
            Diagnostic::new(&qualifiers::GLOBAL_INITIALIZER, span, "the initializer of a global is not constant")
                .here("not a constant expression")
                .help("assign the value at the start of `main`"),
        );
    }

    /// Whether an expression reads nothing but uniforms and global variables, and calls no function of the shader.
    fn is_of_globals(&self, expr: ExprId) -> bool {
        let is_one = match &self.shader.expr(expr).kind {
            ExprKind::Var(VarRef::Global(id)) => !matches!(self.shader.global(*id).storage, Storage::In | Storage::Out),
            ExprKind::Call(..) | ExprKind::Assign(..) | ExprKind::IncDec(..) => false,
            _ => true,
        };
        is_one && self.shader.children(expr).into_iter().all(|child| self.is_of_globals(child))
    }

    fn report_no_value(&mut self, declarator: &Declarator) {
        let name = self.name(declarator.name);
        self.report(
            Diagnostic::new(&qualifiers::CONST_WITHOUT_VALUE, declarator.name.span, format!("`{name}` needs a value"))
                .here("declared `const` and never given one")
                .help(format!("write `{name} = ...`")),
        );
    }

    /// Converts an initializer to the variable's type. An array type without a size takes that of its initializer.
    pub(in crate::analysis) fn fit_initializer(
        &mut self,
        declarator: &Declarator,
        ty: TypeId,
        expr: ExprId,
    ) -> (TypeId, ExprId) {
        let from = self.ty(expr);
        if ty.is_error() || from.is_error() || !self.is_whole_value(expr) {
            let span = self.span(expr);
            // The size that a broken initializer would have told is not known.
            let is_sized = !matches!(self.types.get(ty), Type::Array(_, ArraySize::Unsized));
            return (if is_sized { ty } else { TypeId::ERROR }, self.poison(span));
        }
        if self.leaves_sizes_to(ty, from) {
            return (from, expr);
        }
        let what = format!("`{}`", self.name(declarator.name));
        (ty, self.convert_or_report(expr, ty, &what))
    }

    /// Whether this redeclares, with a size, an array that was declared without one (§4.1.9).
    fn resizes(&mut self, declarator: &Declarator, ty: TypeId, storage: Storage) -> bool {
        let Some(binding) = self.scopes.find_here(declarator.name.symbol) else { return false };
        if let Entry::Member(..) = binding.entry {
            return false;
        }
        let Entry::Variable(VarRef::Global(id)) = binding.entry else { return false };
        let earlier = self.shader.global(id);
        let (Type::Array(element, ArraySize::Unsized), Type::Array(other, size)) =
            (self.types.get(earlier.ty), self.types.get(ty))
        else {
            return false;
        };
        if element != other || earlier.storage != storage || earlier.builtin.is_some() {
            return false;
        }
        if let ArraySize::Sized(size) = size {
            self.check_resize(ArrayKey::Global(id), size, declarator.name.span);
        }
        if let Some(global) = self.shader.globals.get_mut(id.index()) {
            global.ty = ty;
        }
        true
    }

    /// Checks that a size covers all elements that were used before.
    pub(in crate::analysis) fn check_resize(&mut self, key: ArrayKey, size: u32, span: Span) {
        let Some((largest, at)) = self.uses.largest_index(key) else { return };
        if largest >= size {
            self.report(
                Diagnostic::new(&types::INDEX_RANGE, at, format!("the array has no element {largest}"))
                    .here("named before the array had a size")
                    .label(span, format!("declared with {size} elements here")),
            );
        }
    }
}
