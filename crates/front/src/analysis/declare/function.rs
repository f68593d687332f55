//! Declares functions (§6.1): prototypes and definitions.

use super::super::context::{Analyzer, Body};
use super::super::qualifiers::{DeclarationContext, StorageWord};
use super::super::scope::Entry;
use super::super::state::Signature;
use super::super::state::{Denoted, NoteRole};
use crate::builtin::functions;
use crate::diagnostic::Diagnostic;
use crate::diagnostic::codes::{names, statements, types};
use crate::hir::{
    ArraySize, Function, FunctionId, Local, LocalId, LocalKind, ParamMode, StmtKind, Type, TypeId, VarRef,
};
use crate::language::Feature;
use crate::syntax::ast::{FunctionHeader, Ident, ParamDecl, Stmt, TypeBase};

/// The largest number of overloads of one name: each call that needs a conversion considers all of them.
const MAX_OVERLOADS: usize = 1024;

impl Analyzer<'_> {
    /// `float f(float x);`
    pub(in crate::analysis) fn prototype(&mut self, header: &FunctionHeader) {
        let Some(id) = self.declare_function(header) else { return };
        self.note_function(id, header, NoteRole::Declares);
        if !self.declared.prototype(id) {
            self.require(Feature::RepeatedPrototypes, header.name.span);
        }
    }

    /// `float f(float x) { .. }`
    pub(in crate::analysis) fn function(&mut self, header: &FunctionHeader, body: &[Stmt]) {
        let Some(id) = self.declare_function(header) else {
            // The body is still analyzed for its own errors, as that of a function that cannot be called.
            let function = self.header(header);
            self.shader.functions.push(function);
            let id = FunctionId::new(self.shader.functions.len() - 1);
            self.note_function(id, header, NoteRole::Defines);
            self.function_body(id, header, body);
            return;
        };
        self.note_function(id, header, NoteRole::Defines);
        if self.shader.function(id).body.is_some() {
            let (name, earlier) = (self.name(header.name), self.shader.function(id).span);
            self.report(
                Diagnostic::new(&statements::FUNCTION_REDEFINED, header.name.span, format!("`{name}` has two bodies"))
                    .here("defined again here")
                    .label(earlier, "first defined here"),
            );
            return;
        }
        // The definition names the parameters, whatever the prototype called them.
        let function = self.header_again(header, id);
        if let Some(slot) = self.shader.functions.get_mut(id.index()) {
            *slot = function;
        }
        self.function_body(id, header, body);
    }

    /// Notes the names of a header: that of the function, and of a prototype those of its parameters.
    fn note_function(&mut self, id: FunctionId, header: &FunctionHeader, role: NoteRole) {
        self.note(header.name.span, Denoted::Function(id), role);
        if role == NoteRole::Declares {
            for (index, name) in
                header.params.iter().enumerate().filter_map(|(index, param)| Some((index, param.name?)))
            {
                self.note(name.span, Denoted::Local(id, LocalId::new(index)), role);
            }
        }
    }

    fn function_body(&mut self, id: FunctionId, header: &FunctionHeader, body: &[Stmt]) {
        let first = self.shader.exprs.len();
        self.budget.begin_function();
        self.body = Some(Body { function: id, loops: 0, switches: 0, returns: false, parts: Vec::new() });
        self.scopes.open();
        for (index, param) in header.params.iter().enumerate() {
            let is_broken = self.shader.function(id).locals.get(index).is_some_and(|local| local.ty.is_error());
            match (param.name, &param.ty.base) {
                (Some(name), _) => self.enter(name, Entry::Variable(VarRef::Local(LocalId::new(index)))),
                (None, TypeBase::Named(name)) if is_broken && self.scopes.find(name.symbol).is_none() => {
                    self.enter(*name, Entry::Poison);
                }
                (None, _) => {}
            }
        }
        // In older versions the body is a scope nested inside that of the parameters (1.50 §4.2, 4.30 §4.2.2).
        let is_nested = !self.ast.version.has(Feature::ParameterScope);
        if is_nested {
            self.scopes.open();
        }
        let mut body = self.with_precisions(|this| this.statements(body));
        let parts = self.body.as_mut().map_or_else(Vec::new, |body| std::mem::take(&mut body.parts));
        let declared = |part| crate::hir::Stmt { kind: StmtKind::Local(part, None), span: header.name.span };
        body.splice(0..0, parts.into_iter().map(declared));
        self.scopes.close();
        if is_nested {
            self.scopes.close();
        }
        self.size_locals(first);
        self.check_returns(id);
        self.body = None;
        if self.name(header.name) == "main" && (header.params.is_empty() || !header.is_whole) {
            self.shader.main = Some(id);
        }
        if let Some(function) = self.shader.functions.get_mut(id.index()) {
            function.body = Some(body);
        }
    }

    /// "Functions that do not return a value must be declared as void" (§4.1.1). It is not an error if only some
    /// paths through a body end in a `return`: the value is then undefined.
    fn check_returns(&mut self, id: FunctionId) {
        let function = self.shader.function(id);
        let (ret, name, span) = (function.ret, function.name.clone(), function.span);
        let returns = self.body.as_ref().is_none_or(|body| body.returns);
        if returns || ret == TypeId::VOID || ret.is_error() || name == "main" {
            return;
        }
        let type_name = self.type_name(ret);
        self.report(
            Diagnostic::new(&statements::NO_RETURN, span, format!("`{name}` returns no `{type_name}`"))
                .here("there is no `return` in its body")
                .help(format!("write `return` and a value, or declare it `void {name}(..)`")),
        );
    }

    /// Adds a function, or finds the one that it redeclares. `None` if the name is taken by something else.
    fn declare_function(&mut self, header: &FunctionHeader) -> Option<FunctionId> {
        let function = self.header(header);
        let name = header.name;
        let good_name = self.check_name(name) && self.check_block_name(name);
        let (version, extensions) = (self.ast.version, self.extensions);
        if functions::named(&function.name).iter().any(|row| row.availability.in_language(version, extensions)) {
            let redefines = self.is_builtin(&function);
            let rule = if redefines { Feature::BuiltinsHidden } else { Feature::BuiltinOverloads };
            self.require(rule, name.span);
        }
        if function.name == "main" && header.is_whole {
            self.check_main(header, &function);
        }
        let span = name.span;
        match self.scopes.find_function_here(name.symbol).map(|binding| (binding.entry, binding.span)) {
            Some((Entry::Functions(set), _)) => {
                let params = types_of(&function);
                let same = self.declared.function(name.symbol, params);
                if let Some(id) = same.filter(|_| header.is_whole) {
                    return self.is_same(id, &function).then_some(id);
                }
                if self.scopes.functions(set).len() >= MAX_OVERLOADS {
                    self.report_too_many(name);
                    return None;
                }
                let id = self.add_function(function, header);
                self.scopes.add_overload(set, id);
                Some(id)
            }
            Some((Entry::Poison, _)) => None,
            Some((_, earlier)) => {
                let spelling = self.name(name);
                self.report(
                    Diagnostic::new(&names::REDEFINED, span, format!("`{spelling}` is declared twice in one scope"))
                        .here("declared as a function here")
                        .label(earlier, "first declared here"),
                );
                None
            }
            None => {
                let id = self.add_function(function, header);
                let set = self.scopes.overload_set(id);
                let entry = if good_name { Entry::Functions(set) } else { Entry::Poison };
                self.scopes.enter_function(name.symbol, entry, span);
                Some(id)
            }
        }
    }

    fn report_too_many(&mut self, name: Ident) {
        let spelling = self.name(name);
        self.report(
            Diagnostic::new(
                &statements::TOO_MANY_OVERLOADS,
                name.span,
                format!("`{spelling}` has more than {MAX_OVERLOADS} overloads"),
            )
            .here("one too many"),
        );
    }

    fn add_function(&mut self, function: Function, header: &FunctionHeader) -> FunctionId {
        let id = FunctionId::new(self.shader.functions.len());
        if header.is_whole {
            self.declared.add_function(header.name.symbol, types_of(&function), id);
        } else {
            self.declared.add_partial(id);
        }
        self.shader.functions.push(function);
        id
    }

    fn header(&mut self, header: &FunctionHeader) -> Function {
        let record = self.qualifiers(&header.qualifiers, DeclarationContext::Return);
        self.note_precise_header(header);
        let ret = self.return_type(header);
        self.check_precision(record.precision, ret, header.ty.span);
        let locals: Vec<Local> = header.params.iter().map(|param| self.parameter(param)).collect();
        Function {
            name: self.name(header.name).to_owned(),
            ret,
            param_count: locals.len(),
            locals,
            body: None,
            reachable: false,
            span: header.name.span,
        }
    }

    /// The header of a definition whose types are already known from a prototype: only the names of the parameters
    /// are new.
    fn header_again(&mut self, header: &FunctionHeader, id: FunctionId) -> Function {
        self.note_precise_header(header);
        let known = self.shader.function(id).clone();
        let mut locals = known.locals;
        for (local, param) in locals.iter_mut().zip(&header.params) {
            local.name = param.name.map_or(String::new(), |name| self.ast.name(name).to_owned());
            local.span = param.name.map_or(param.span, |name| name.span);
        }
        Function { locals, span: header.name.span, ..known }
    }

    /// Notes which of a function's result and parameters are `precise`.
    fn note_precise_header(&mut self, header: &FunctionHeader) {
        self.note_precise(&header.qualifiers, header.name);
        for param in &header.params {
            param.name.into_iter().for_each(|name| self.note_precise(&param.qualifiers, name));
        }
    }

    fn return_type(&mut self, header: &FunctionHeader) -> TypeId {
        let ty = self.type_spec(&header.ty);
        if matches!(self.types.get(ty), Type::Array(..)) {
            self.require(Feature::ArrayObjects, header.ty.span);
        }
        if self.types.is_struct_with_array(ty) {
            self.require(Feature::ArraysInValues, header.ty.span);
        }
        if let Type::Array(_, ArraySize::Unsized) = self.types.get(ty) {
            self.report(
                Diagnostic::new(&types::UNSIZED_ARRAY, header.ty.span, "a function must return an array with a size")
                    .here("no size given"),
            );
            return TypeId::ERROR;
        }
        if self.types.contains_sampler(ty) {
            let name = self.type_name(ty);
            self.report(
                Diagnostic::new(&types::SAMPLER, header.ty.span, format!("a function cannot return a `{name}`"))
                    .here("holds a sampler"),
            );
            return TypeId::ERROR;
        }
        ty
    }

    fn parameter(&mut self, param: &ParamDecl) -> Local {
        let record = self.qualifiers(&param.qualifiers, DeclarationContext::Parameter);
        let mode = match (record.storage, record.constant) {
            (None | Some((StorageWord::In, _)), None) => ParamMode::In,
            (None | Some((StorageWord::In, _)), Some(_)) => ParamMode::ConstIn,
            (Some((word @ (StorageWord::Out | StorageWord::Inout), _)), constant) => {
                if let Some(span) = constant {
                    let message = format!("a parameter cannot be `const` and `{}`", word.spelling());
                    self.misplaced(span, message, "remove `const`");
                }
                if word == StorageWord::Out { ParamMode::Out } else { ParamMode::Inout }
            }
            (Some((word, span)), _) => {
                let message = format!("`{}` is not allowed before a parameter", word.spelling());
                self.misplaced(span, message, "parameters are `in`, `out` or `inout`");
                ParamMode::In
            }
        };
        let ty = self.parameter_type(param, mode);
        self.check_precision(record.precision, ty, param.ty.span);
        let ty = if self.check_size(ty, param.span) { ty } else { TypeId::ERROR };
        let name = param.name.map_or(String::new(), |name| {
            self.check_name(name);
            self.ast.name(name).to_owned()
        });
        let span = param.name.map_or(param.span, |name| name.span);
        Local { name, ty, kind: LocalKind::Param(mode), value: None, span }
    }

    fn parameter_type(&mut self, param: &ParamDecl, mode: ParamMode) -> TypeId {
        if let TypeBase::Struct(_) = param.ty.base {
            self.report(
                Diagnostic::new(&types::STRUCT, param.ty.span, "a struct cannot be declared in a parameter")
                    .here("declare it before the function"),
            );
        }
        if self.report_untyped(param) {
            return TypeId::ERROR;
        }
        let base = self.type_spec(&param.ty);
        let ty = self.with_array(base, &param.array);
        if ty == TypeId::VOID {
            self.report(
                Diagnostic::new(&types::VOID_VALUE, param.ty.span, "a parameter cannot be `void`").here("not a value"),
            );
            return TypeId::ERROR;
        }
        if let Type::Array(_, ArraySize::Unsized) = self.types.get(ty) {
            self.report(
                Diagnostic::new(&types::UNSIZED_ARRAY, param.span, "a parameter that is an array must have a size")
                    .here("no size given"),
            );
            return TypeId::ERROR;
        }
        if matches!(self.types.get(ty), Type::Array(..)) && matches!(mode, ParamMode::Out | ParamMode::Inout) {
            self.require(Feature::ArrayArguments, param.span);
        }
        if self.types.contains_sampler(ty) && matches!(mode, ParamMode::Out | ParamMode::Inout) {
            let name = self.type_name(ty);
            self.report(
                Diagnostic::new(&types::SAMPLER, param.span, format!("a `{name}` can only be passed in"))
                    .here("holds a sampler"),
            );
            return TypeId::ERROR;
        }
        ty
    }

    /// Checks that `main` is declared as `void main()`.
    fn check_main(&mut self, header: &FunctionHeader, function: &Function) {
        if function.param_count == 0 && (function.ret == TypeId::VOID || function.ret.is_error()) {
            return;
        }
        let message = if function.param_count > 0 { "`main` takes no parameters" } else { "`main` returns nothing" };
        let returns = function.ret != TypeId::VOID && !function.ret.is_error();
        let help = if returns { "write `void main()`, and `return;` without a value" } else { "write `void main()`" };
        self.report(
            Diagnostic::new(&statements::MAIN_SIGNATURE, header.span, message).here("not the entry point").help(help),
        );
    }

    /// Checks that a redeclared function is the same except for the names of its parameters.
    fn is_same(&mut self, id: FunctionId, again: &Function) -> bool {
        let first = self.shader.function(id);
        let (name, earlier) = (first.name.clone(), first.span);
        let what = if first.ret != again.ret && !first.ret.is_error() && !again.ret.is_error() {
            "return type"
        } else if (0..first.param_count).any(|index| first.param_mode(index) != again.param_mode(index)) {
            "parameters' qualifiers"
        } else {
            return true;
        };
        self.report(
            Diagnostic::new(
                &statements::OVERLOAD_DIFFERS,
                again.span,
                format!("two declarations of `{name}` differ only in the {what}"),
            )
            .here("declared again here")
            .label(earlier, "first declared here"),
        );
        false
    }
}

/// The types of the parameters, which tell overloads apart.
fn types_of(function: &Function) -> Signature {
    function.params().iter().map(|param| param.ty).collect()
}
