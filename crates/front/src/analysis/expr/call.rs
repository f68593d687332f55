//! Analyzes calls (§5.3, §6.1) of functions of the shader and of constructors of structs. Calls of built-in functions
//! are in `builtin`.

use super::super::context::Analyzer;
use super::super::decisive::UNKNOWN_VALUE;
use super::super::keywords;
use super::super::scope::{Entry, OverloadSet};
use super::super::state::Signature;
use super::super::state::{Denoted, NoteRole};
use super::Purpose;
use super::convert::Conversions;
use super::overload::{Resolution, Rules, leading, resolve};
use crate::builtin::functions;
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::{names, types};
use crate::diagnostic::{Advice, Diagnostic, did_you_mean};
use crate::hir::{ExprId, ExprKind, FunctionId, ParamMode, Type, TypeId, VarRef};
use crate::language::Feature;
use crate::source::Span;
use crate::syntax::ast::{self, Ident};
use crate::syntax::keywords::is_taken;
use crate::syntax::of_later_word;
use smallvec::SmallVec;
use std::cmp::Reverse;

/// The parameters of a candidate.
pub(super) type Params = SmallVec<[(TypeId, ParamMode); 4]>;

impl Analyzer<'_> {
    /// `f(a, b)`, `S(a)`
    pub(super) fn call(&mut self, name: Ident, arguments: &[ast::ExprId], span: Span) -> ExprId {
        if self.is_probe(name) {
            self.arguments(arguments);
            return self.poison(span);
        }
        let binding = self.scopes.find_called(name.symbol).filter(|found| !self.is_replaced(name, found.entry));
        if let Some(binding) = binding {
            self.note_binding(name.span, binding);
        } else if !functions::named(self.name(name)).is_empty() {
            self.note(name.span, Denoted::Builtin, NoteRole::Uses);
        }
        if binding.is_none()
            && let Some(ty) = self.builtin_struct(self.name(name))
        {
            return self.construct(ty, arguments, name.span, span);
        }
        match binding.map(|binding| binding.entry) {
            Some(Entry::Struct(ty)) => self.construct(ty, arguments, name.span, span),
            Some(Entry::Functions(set)) => {
                let Some(arguments) = self.arguments(arguments) else { return self.poison(span) };
                if self.is_builtin_overload(name, &arguments) {
                    self.note(name.span, Denoted::Builtin, NoteRole::Uses);
                    return self.builtin_call(name, arguments, span);
                }
                self.user_call(name, set, arguments, span)
            }
            None => {
                let arguments = self.arguments(arguments);
                let is_known = self.is_known_builtin(name, arguments.is_some());
                match arguments.filter(|_| is_known) {
                    Some(arguments) => self.builtin_call(name, arguments, span),
                    None => {
                        if is_known {
                            self.require_builtin(name);
                        }
                        self.poison(span)
                    }
                }
            }
            Some(entry) => {
                self.arguments(arguments);
                if entry != Entry::Poison {
                    let (spelling, declared) = (self.name(name), binding.map_or(Span::default(), |found| found.span));
                    self.report(
                        Diagnostic::new(&names::NOT_A_FUNCTION, name.span, format!("`{spelling}` is not a function"))
                            .here("called here")
                            .label(declared, "a variable is declared here, and hides any function of that name"),
                    );
                }
                self.poison(span)
            }
        }
    }

    /// Whether an engine gives another name to a sampler, so that a call is one of the built-in function.
    fn is_replaced(&self, name: Ident, entry: Entry) -> bool {
        let Entry::Variable(VarRef::Global(id)) = entry else { return false };
        self.ast.replaced_samplers.iter().any(|one| one == self.name(name))
            && matches!(self.types.get(self.shader.global(id).ty), Type::Sampler(_))
    }

    /// Whether a call of a function of the shader is one of the built-in function that it overloads (GLSL ES 1.00 §8).
    fn is_builtin_overload(&self, name: Ident, arguments: &[ExprId]) -> bool {
        if self.ast.version.has(Feature::BuiltinsHidden) || functions::named(self.name(name)).is_empty() {
            return false;
        }
        let given: Signature = arguments.iter().map(|&argument| self.ty(argument)).collect();
        self.declared.function(name.symbol, given).is_none()
    }

    /// The arguments of a call; `None` if one of them is in error.
    fn arguments(&mut self, arguments: &[ast::ExprId]) -> Option<Vec<ExprId>> {
        let arguments: Vec<ExprId> = arguments.iter().map(|&argument| self.expr(argument)).collect();
        if arguments.iter().any(|&argument| self.ty(argument).is_error()) {
            return None;
        }
        let mut whole = true;
        for &argument in &arguments {
            whole &= self.is_whole_value(argument);
        }
        whole.then_some(arguments)
    }

    /// Whether a name is that of a built-in function; otherwise it is reported. What its arguments lack explains an unsupported one:
    /// there is no `imageStore` without an image.
    fn is_known_builtin(&mut self, name: Ident, are_whole: bool) -> bool {
        let spelling = self.name(name);
        if !functions::named(spelling).is_empty() {
            return true;
        }
        if super::foreign::is_unsupported(spelling, self.ast.version, self.extensions) {
            if !are_whole {
                return false;
            }
            let message = format!("the function `{spelling}` is not supported yet");
            let mut finding = Diagnostic::new(&NOT_SUPPORTED_YET, name.span, message).here(UNKNOWN_VALUE);
            if let Some((why, instead)) = super::foreign::reason(spelling) {
                finding = finding.note(why).help(instead);
            }
            self.report(finding);
            return false;
        }
        let foreign = super::foreign::function(spelling, self.ast.version);
        if foreign.is_none() && is_taken(spelling, self.ast.version) {
            // The parser has reported a keyword as a name.
            return false;
        }
        let near = |this: &mut Self| Some(Advice::meant(this.nearest_function(spelling)?));
        let help = foreign.or_else(|| near(self));
        let finding =
            Diagnostic::new(&names::UNKNOWN_FUNCTION, name.span, format!("there is no function `{spelling}`"))
                .here("not declared before this")
                .maybe_help(help);
        // The constructor of a type of later versions.
        self.report(of_later_word(finding, spelling, self.ast.version));
        false
    }

    fn nearest_function(&mut self, spelling: &str) -> Option<String> {
        self.may_suggest()?;
        let declared = self
            .scopes
            .names()
            .filter(|(_, binding)| matches!(binding.entry, Entry::Functions(_) | Entry::Struct(_)))
            .map(|(symbol, _)| self.ast.names.spelling(symbol));
        let mut known: Vec<&str> = declared.collect();
        for name in functions::names() {
            known.push(name);
        }
        for name in keywords::constructors(self.ast.version, self.extensions) {
            known.push(name);
        }
        if let Some(meant) = did_you_mean(spelling, known) {
            return Some(meant.to_owned());
        }
        // `retrun (x);`
        let meant = did_you_mean(spelling, ["return"])?;
        self.note_meant(meant);
        Some(meant.to_owned())
    }

    fn user_call(&mut self, name: Ident, set: OverloadSet, arguments: Vec<ExprId>, span: Span) -> ExprId {
        let given: Signature = arguments.iter().map(|&argument| self.ty(argument)).collect();
        let exact = self.declared.function(name.symbol, given.clone());
        if exact.is_none()
            && let Some(function) = self.unclear(set)
        {
            self.note(name.span, Denoted::Function(function), NoteRole::Uses);
            return self.poison(span);
        }
        let found = exact.or_else(|| self.by_conversion(name, set, &given));
        let Some(function) = found else { return self.poison(span) };
        self.note(name.span, Denoted::Function(function), NoteRole::Uses);
        let params = self.params_of(function);
        let Some(arguments) = self.pass(arguments, &params) else { return self.poison(span) };
        let ret = self.shader.function(function).ret;
        if ret.is_error() {
            return self.poison(span);
        }
        self.push(ExprKind::Call(function, arguments), ret, span)
    }

    /// An overload whose header has an error, so that nothing can be said about the arguments that it takes.
    fn unclear(&self, set: OverloadSet) -> Option<FunctionId> {
        let has_error = |id: FunctionId| self.shader.function(id).param_types().any(|(ty, _)| ty.is_error());
        let mut overloads = self.scopes.functions(set).iter().copied();
        overloads.find(|&id| self.declared.is_partial(id) || has_error(id))
    }

    /// The overload that takes the arguments after implicit conversions, if there is exactly one.
    fn by_conversion(&mut self, name: Ident, set: OverloadSet, given: &[TypeId]) -> Option<FunctionId> {
        let candidates: Vec<FunctionId> = self.scopes.functions(set).to_vec();
        let resolution = resolve(
            self.types,
            self.rules(),
            given,
            candidates.iter().map(|&id| self.shader.function(id).param_types()),
        );
        match resolution {
            Resolution::Found(index) => candidates.get(index).copied(),
            Resolution::Ambiguous(first, second) => {
                let mut finding = self.ambiguous(name, given);
                for index in [first, second] {
                    if let Some(&id) = candidates.get(index) {
                        finding = finding.label(self.shader.function(id).span, "matches by conversion");
                    }
                }
                self.report(finding);
                None
            }
            Resolution::Missing => {
                let mut finding = self.no_overload(name, given);
                if !functions::named(self.name(name)).is_empty() {
                    finding =
                        finding.help("a function of the shader hides all built-in ones of its name; give it another");
                }
                let conversions = self.rules().conversions;
                let params = |id| self.shader.function(id).param_types();
                let mut candidates = candidates;
                candidates.sort_by_key(|&id| Reverse(leading(self.types, conversions, given, params(id))));
                for &id in candidates.iter().take(4) {
                    finding = finding.label(self.shader.function(id).span, self.describe(id));
                }
                self.report(finding);
                None
            }
        }
    }

    /// Converts the arguments for `in` parameters, and checks that those for `out` and `inout` parameters are
    /// l-values.
    pub(super) fn pass(&mut self, arguments: Vec<ExprId>, params: &[(TypeId, ParamMode)]) -> Option<Vec<ExprId>> {
        let mut passed = Vec::with_capacity(arguments.len());
        let mut good = true;
        for (argument, &(ty, mode)) in arguments.into_iter().zip(params) {
            passed.push(match mode {
                ParamMode::In | ParamMode::ConstIn => self.convert(argument, ty).unwrap_or(argument),
                ParamMode::Out | ParamMode::Inout => {
                    good &= self.require_lvalue(argument, Purpose::Argument) && self.require_written(argument, ty);
                    argument
                }
            });
        }
        good.then_some(passed)
    }

    /// Reports an argument that an `out` parameter cannot be converted to when the function returns (§6.1.1). Overloads are
    /// found as in a language that has the conversion.
    fn require_written(&mut self, argument: ExprId, param: TypeId) -> bool {
        let ty = self.ty(argument);
        if ty == param || ty.is_error() || param.is_error() || self.conversions().convert(self.types, param, ty) {
            return true;
        }
        let (ty, param) = (self.type_name(ty), self.type_name(param));
        let message = format!("{} is a `{ty}`, and the function writes a `{param}`", self.quote(argument));
        let finding = Diagnostic::new(&types::MISMATCH, self.span(argument), message)
            .here(format!("this is a `{ty}`"))
            .help(format!("pass a variable of the type `{param}`"));
        self.report(finding);
        false
    }

    /// The rules of overloads at the current declaration.
    pub(super) fn rules(&self) -> Rules {
        let best = self.ast.version.has_with(Feature::BestOverload, self.extensions);
        // A conversion that only a later version has is reported where it happens.
        let conversions = Conversions { to_float: true, ..self.conversions() };
        Rules { conversions, best }
    }

    pub(in crate::analysis) fn params_of(&self, id: FunctionId) -> Params {
        self.shader.function(id).param_types().collect()
    }

    /// A function's prototype, for messages.
    pub(in crate::analysis) fn describe(&self, id: FunctionId) -> String {
        let function = self.shader.function(id);
        let params: Vec<String> = self
            .params_of(id)
            .into_iter()
            .map(|(ty, mode)| {
                let mode = match mode {
                    ParamMode::In => "",
                    ParamMode::ConstIn => "const ",
                    ParamMode::Out => "out ",
                    ParamMode::Inout => "inout ",
                };
                format!("{mode}{}", self.type_name(ty))
            })
            .collect();
        format!("{} {}({})", self.type_name(function.ret), function.name, params.join(", "))
    }

    pub(super) fn ambiguous(&self, name: Ident, given: &[TypeId]) -> Diagnostic {
        let call = self.call_text(name, given);
        Diagnostic::new(&types::AMBIGUOUS_CALL, name.span, format!("`{call}` fits more than one overload"))
            .here("which one is meant?")
            .help("convert the arguments so that one overload matches exactly")
    }

    pub(super) fn no_overload(&self, name: Ident, given: &[TypeId]) -> Diagnostic {
        let call = self.call_text(name, given);
        Diagnostic::new(&types::NO_OVERLOAD, name.span, format!("no overload takes `{call}`")).here("no such overload")
    }

    fn call_text(&self, name: Ident, given: &[TypeId]) -> String {
        let given: Vec<String> = given.iter().map(|&ty| self.type_name(ty)).collect();
        format!("{}({})", self.name(name), given.join(", "))
    }
}
