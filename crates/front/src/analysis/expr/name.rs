//! Analyzes names in expressions: variables, members of blocks without an instance name, built-in variables and
//! constants.

use super::super::context::Analyzer;
use super::super::decisive::UNKNOWN_VALUE;
use super::super::scope::Entry;
use super::super::state::{Denoted, NoteRole};
use crate::builtin::{Availability, constants, fixed, functions, variables};
use crate::diagnostic::codes::general::NOT_SUPPORTED_YET;
use crate::diagnostic::codes::names;
use crate::diagnostic::{Advice, Applicability, Diagnostic, Place, did_you_mean};
use crate::hir::{ExprId, ExprKind, FunctionId, ScalarValue, Stage, Storage, Type, TypeId, VarRef};
use crate::language::Since;
use crate::source::Span;
use crate::syntax::ast::Ident;
use crate::syntax::of_version;

/// The keywords that make an expression or a statement alone.
const STATEMENTS: &[&str] = &["break", "continue", "discard", "false", "return", "true"];

impl Analyzer<'_> {
    /// The variable that a name denotes.
    pub(super) fn name_expr(&mut self, name: Ident) -> ExprId {
        let span = name.span;
        if self.is_probe(name) {
            return self.poison(span);
        }
        let Some(binding) = self.scopes.find(name.symbol) else { return self.builtin_name(name) };
        self.note_binding(span, binding);
        match binding.entry {
            Entry::Variable(var) => self.variable(var, span),
            Entry::Member(block, member) => {
                if self.shader.global(block).storage != Storage::Uniform {
                    self.uses.note_member(block, member, span);
                }
                let base = self.variable(VarRef::Global(block), span);
                self.member(base, member, span)
            }
            Entry::Poison => self.poison(span),
            Entry::Struct(_) => self.not_a_variable(name, "a type", binding.span, None),
            Entry::Functions(set) => {
                let takes_none = |&id: &FunctionId| self.params_of(id).is_empty();
                let call = self.call_of(name, self.scopes.functions(set).iter().all(takes_none));
                self.not_a_variable(name, "a function", binding.span, Some(call))
            }
        }
    }

    /// A variable as an expression.
    pub(in crate::analysis) fn variable(&mut self, var: VarRef, span: Span) -> ExprId {
        let ty = match var {
            VarRef::Global(id) => {
                self.note_use(id, span);
                self.shader.global(id).ty
            }
            VarRef::Local(id) => self.local(id).map_or(TypeId::ERROR, |local| local.ty),
        };
        if ty.is_error() { self.poison(span) } else { self.push(ExprKind::Var(var), ty, span) }
    }

    /// A member of a struct or block, by its index.
    pub(in crate::analysis) fn member(&mut self, base: ExprId, member: u32, span: Span) -> ExprId {
        let ty = match self.types.get(self.ty(base)) {
            Type::Struct(id) => self.types.structure(id).members.get(member as usize).map(|member| member.ty),
            _ => None,
        };
        match ty {
            Some(ty) if !ty.is_error() => self.push(ExprKind::Member(base, member), ty, span),
            _ => self.poison(span),
        }
    }

    /// A name that the shader does not declare: a built-in one, or an error.
    fn builtin_name(&mut self, name: Ident) -> ExprId {
        let spelling = self.name(name);
        let version = self.ast.version;
        let is_known = constants::named(spelling, version, self.extensions).is_some()
            || variables::stages_with(spelling).next().is_some()
            || fixed::is_fixed(spelling);
        if is_known {
            self.note(name.span, Denoted::Builtin, NoteRole::Uses);
        }
        if let Some(constant) = constants::named(spelling, version, self.extensions) {
            return self.literal(ScalarValue::Int(constant.value), name.span);
        }
        if let Some(row) = variables::named(spelling, version, self.extensions, self.stage) {
            if self.is_left_out(row, name.span) {
                return self.poison(name.span);
            }
            self.note_builtin(row.availability, name.span);
            let id = self.builtin_global(row);
            return self.variable(VarRef::Global(id), name.span);
        }
        if let Some(row) = fixed::named(spelling, version, self.stage) {
            let id = self.fixed_global(row);
            return self.variable(VarRef::Global(id), name.span);
        }
        if self.is_quiet || self.is_uncalled_builtin(name) {
            return self.poison(name.span);
        }
        self.report_unknown(name);
        // From here on the name is poison, so that it is reported once.
        self.scopes.enter(name.symbol, Entry::Poison, name.span);
        self.poison(name.span)
    }

    fn report_unknown(&mut self, name: Ident) {
        let spelling = self.name(name);
        if spelling == "gl_Layer" && self.stage == Stage::Fragment && self.ast.version.reaches(Since::new(430, 320)) {
            let message = "`gl_Layer` in a fragment shader is not supported yet";
            self.report(Diagnostic::new(&NOT_SUPPORTED_YET, name.span, message).here(UNKNOWN_VALUE));
            return;
        }
        let stages: Vec<&str> = variables::stages_with(spelling).map(Stage::name).collect();
        if !stages.is_empty() {
            let stage = self.stage.name();
            let known_here = stages.contains(&stage);
            let finding = if known_here {
                let finding = Diagnostic::new(
                    &names::BUILTIN_UNAVAILABLE,
                    name.span,
                    format!("`{spelling}` is not in {}", self.ast.version.name()),
                );
                let remedies = variables::VARIABLES
                    .iter()
                    .filter(|row| row.name == spelling && row.availability.stages.has(self.stage));
                let remedy = remedies
                    .map(|row| row.availability)
                    .find_map(|row| self.ast.version.remedy(row.since, row.gone, row.extensions));
                let remedy = remedy.map(|remedy| match spelling {
                    "gl_FragColor" | "gl_FragData" => format!("declare `out vec4 color;` and write to that; {remedy}"),
                    _ => remedy,
                });
                let finding = finding.here("not in this version of the language").maybe_help(remedy);
                of_version(finding, self.ast.version)
            } else {
                let message = format!("`{spelling}` does not exist in a {stage} shader");
                Diagnostic::new(&names::BUILTIN_UNAVAILABLE, name.span, message)
                    .here(format!("only in {} shaders", stages.join(" and ")))
            };
            self.report(finding);
            return;
        }
        if let Some(row) = constants::CONSTANTS.iter().find(|row| row.name == spelling) {
            let message = format!("`{spelling}` is not in {}", self.ast.version.name());
            let Availability { since, gone, extensions, .. } = row.availability;
            let finding = Diagnostic::new(&names::BUILTIN_UNAVAILABLE, name.span, message)
                .here("not in this version of the language")
                .maybe_help(self.ast.version.remedy(since, gone, extensions));
            self.report(of_version(finding, self.ast.version));
            return;
        }
        if fixed::is_fixed(spelling) {
            let finding = match fixed::stages_with(spelling, self.ast.version).map(Stage::name).collect::<Vec<_>>() {
                stages if stages.is_empty() => Diagnostic::new(
                    &names::BUILTIN_UNAVAILABLE,
                    name.span,
                    format!("`{spelling}` is not in the core profile of this version"),
                )
                .here("only in the compatibility profile")
                .help("declare an `in`, `out` or `uniform` of your own and let the application set it"),
                stages => {
                    let message = format!("`{spelling}` does not exist in a {} shader", self.stage.name());
                    Diagnostic::new(&names::BUILTIN_UNAVAILABLE, name.span, message)
                        .here(format!("only in {} shaders", stages.join(" and ")))
                }
            };
            self.report(finding);
            return;
        }
        if super::foreign::is_unsupported_variable(spelling, self.ast.version, self.extensions) {
            let message = format!("the variable `{spelling}` is not supported yet");
            self.report(Diagnostic::new(&NOT_SUPPORTED_YET, name.span, message).here(UNKNOWN_VALUE));
            return;
        }
        if self.body.as_ref().is_some_and(|body| self.declared.is_partial(body.function)) {
            // It may be a parameter that could not be read.
            return;
        }
        let help = self.is_uncalled_macro(spelling).then(|| {
            Advice::from(format!("`{spelling}` is a macro with parameters: write `{spelling}(..)` with its arguments"))
        });
        let help = help.or_else(|| super::foreign::variable(spelling).map(Advice::from));
        let help = help.or_else(|| super::foreign::of_vulkan(spelling));
        let help = help.or_else(|| self.nearest_variable(spelling).map(Advice::meant));
        let spelling = spelling.to_owned();
        let statement = || did_you_mean(&spelling, STATEMENTS.iter().copied());
        let statement = if help.is_none() { statement() } else { None };
        statement.into_iter().for_each(|word| self.note_meant(word));
        let help = help.or_else(|| statement.map(Advice::meant));
        let help = help.or_else(|| self.missing_macro(&spelling).map(Advice::from));
        self.report(
            Diagnostic::new(&names::UNDECLARED, name.span, format!("`{spelling}` is not declared"))
                .here("not known here")
                .maybe_help(help),
        );
    }

    /// Notes the word that a misspelled one is taken for. With a `return`, the function returns.
    pub(in crate::analysis) fn note_meant(&mut self, word: &str) {
        if let Some(body) = self.body.as_mut().filter(|_| word == "return") {
            body.returns = true;
        }
    }

    /// Whether a name is that of a macro that is used without its arguments.
    fn is_uncalled_macro(&self, spelling: &str) -> bool {
        self.ast.macros_with_parameters.iter().any(|name| **name == *spelling)
    }

    /// The help for a name in capitals, which is most likely a macro that the application defines.
    fn missing_macro(&self, spelling: &str) -> Option<String> {
        let in_capitals = spelling.len() > 2
            && spelling.starts_with(|first: char| first.is_ascii_uppercase())
            && spelling.chars().all(|letter| letter.is_ascii_uppercase() || letter.is_ascii_digit() || letter == '_');
        in_capitals.then(|| format!("if the application defines it as a macro, add `-D {spelling}=VALUE`"))
    }

    fn nearest_variable(&mut self, spelling: &str) -> Option<String> {
        self.may_suggest()?;
        let declared = self
            .scopes
            .names()
            .filter(|(_, binding)| matches!(binding.entry, Entry::Variable(_) | Entry::Member(..)))
            .map(|(symbol, _)| self.ast.names.spelling(symbol));
        let (version, extensions) = (self.ast.version, self.extensions);
        let built_in = variables::in_stage(version, extensions, self.stage).map(|row| row.name);
        let constants = constants::CONSTANTS
            .iter()
            .filter(|row| row.availability.in_language(version, extensions))
            .map(|row| row.name);
        let mut known: Vec<&str> = declared.collect();
        for name in built_in.chain(constants) {
            known.push(name);
        }
        // Two short names are similar by chance.
        known.extend(self.ast.macros.iter().filter(|name| name.len() > 2).map(|name| &**name));
        did_you_mean(spelling, known).map(str::to_owned)
    }

    fn not_a_variable(&mut self, name: Ident, what: &str, declared: Span, help: Option<Advice>) -> ExprId {
        let finding = self.finding_of_no_variable(name, what).label(declared, "declared here");
        self.report(finding.maybe_help(help));
        self.poison(name.span)
    }

    fn finding_of_no_variable(&self, name: Ident, what: &str) -> Diagnostic {
        let spelling = self.name(name);
        Diagnostic::new(&names::NOT_A_VARIABLE, name.span, format!("`{spelling}` is {what}, not a variable"))
            .here("a value is required here")
    }

    /// Reports the name of a built-in function of this stage that is not called.
    fn is_uncalled_builtin(&mut self, name: Ident) -> bool {
        let (version, extensions, stage) = (self.ast.version, self.extensions, self.stage);
        let rows = functions::named(self.name(name)).iter();
        let rows: Vec<_> = rows.filter(|row| row.availability.holds(version, extensions, stage)).collect();
        if rows.is_empty() {
            return false;
        }
        self.note(name.span, Denoted::Builtin, NoteRole::Uses);
        let call = self.call_of(name, rows.iter().all(|row| row.params.is_empty()));
        let finding = self.finding_of_no_variable(name, "a function").help(call);
        self.report(finding);
        true
    }

    /// The help to call a function instead of naming it.
    fn call_of(&self, name: Ident, takes_none: bool) -> Advice {
        let spelling = self.name(name);
        match takes_none {
            true => Advice::new(Applicability::Unsafe, format!("call it: `{spelling}()`"), Place::After, "()"),
            false => Advice::from(format!("call it: `{spelling}(..)`")),
        }
    }
}
