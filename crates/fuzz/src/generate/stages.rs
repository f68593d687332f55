//! Whole stages: what is declared, functions, `main`, and the scene that gives values to all of it.
//!
//! *In:* a seed and a language. *Out:* [`Program`]. *Holds:* both stages declare the same uniforms and varyings; the scene has
//! a value for each.

use super::Program;
use super::interface::{Interface, Varying};
use super::language::Language;
use super::tree::{Expr, Role, Stmt, Variable};
use super::types::{BOOL, FLOAT, INT, Members, Ty};
use super::writer::{Callable, Macro, Writer};
use crate::chance::Chance;
use glisten_front::hir::{ParamMode, Scalar, Stage};
use glisten_front::language::Feature;

/// The most numbers that a stage's outputs have together.
const NUMBERS: usize = 16;

/// The program of a seed.
pub(super) fn program(seed: u64, language: &'static Language) -> Program {
    let mut chance = Chance::new(seed);
    let structs = structs(&mut chance, language);
    let interface = Interface::new(&mut chance, language, &structs);
    let mut used = std::collections::BTreeSet::new();
    let mut macros = Vec::new();
    let mut stage = |stage| {
        let mut writer = Writer::new(Chance::new(chance.below(usize::MAX) as u64), language, stage);
        writer.structs.clone_from(&structs);
        writer.samplers.clone_from(&interface.samplers);
        let statements = writer.stage(&interface);
        used.append(&mut writer.used);
        macros.append(&mut writer.macros);
        statements
    };
    let (vertex, fragment) = (stage(Stage::Vertex), stage(Stage::Fragment));
    Program { seed, language, vertex, fragment, scene: interface.scene(), constructs: used, macros }
}

fn structs(chance: &mut Chance, language: &Language) -> Vec<Members> {
    let mut structs: Vec<Members> = Vec::new();
    for number in 0..chance.below(3) {
        let mut members = Members::new();
        for index in 0..1 + chance.below(3) {
            let basic = chance.one(&language.basics).cloned().unwrap_or(FLOAT);
            let ty = match chance.below(5) {
                0 if number > 0 => Ty::Struct(number - 1),
                1 if language.has_array_values() => Ty::Array(Box::new(basic), 2),
                _ => basic,
            };
            members.push((format!("m{index}"), ty));
        }
        structs.push(members);
    }
    structs
}

impl Writer<'_> {
    fn stage(&mut self, interface: &Interface) -> Vec<Stmt> {
        let mut all = vec![Stmt::text_only(self.language.line()).with(Role::Directive)];
        if self.language.version.is_es() {
            all.push(Stmt::text_only("precision highp float;"));
            all.push(Stmt::text_only("precision highp int;"));
            for one in self.samplers.clone().iter().filter(|one| one.lacks_precision()) {
                all.push(Stmt::text_only(format!("precision highp {};", one.word)));
            }
        }
        self.macros(&mut all);
        for (number, members) in self.structs.clone().iter().enumerate() {
            self.note(if number > 0 { "nested struct" } else { "struct" });
            let members: Vec<String> = members.iter().map(|(name, ty)| format!("{};", ty.declared(name))).collect();
            all.push(Stmt::text_only(format!("struct S{number} {{ {} }};", members.join(" "))));
        }
        for (declaration, variables) in interface.declarations(self.stage, self.language) {
            all.push(Stmt::text_only(declaration));
            variables.into_iter().for_each(|variable| self.declare(variable));
        }
        for construct in interface.constructs() {
            self.note(construct);
        }
        self.globals(&mut all);
        for _ in 0..self.chance.below(4) {
            self.function(&mut all);
        }
        all.push(self.main(interface));
        all
    }

    fn macros(&mut self, all: &mut Vec<Stmt>) {
        if self.chance.once_in(2) {
            return;
        }
        let pair = Ty::Vector(Scalar::Float, 2);
        let forms = [
            ("(x, y)", "((x) * (y) + (x))", vec![FLOAT, FLOAT], FLOAT, "((@) * (@) + (@))", vec![0, 1, 0]),
            ("(x)", "(x) - \\\n    (x)", vec![INT], INT, "((@) - (@))", vec![0, 0]),
            ("(a, b, c)", "((a) ? (b) : (c))", vec![BOOL, FLOAT, FLOAT], FLOAT, "((@) ? (@) : (@))", vec![0, 1, 2]),
            ("(v)", "(v).yx", vec![pair.clone()], pair, "(@).yx", vec![0]),
        ];
        for _ in 0..1 + self.chance.below(2) {
            let index = self.chance.below(forms.len());
            let Some((head, text, parameters, result, pattern, order)) = forms.get(index).cloned() else { continue };
            let text = if self.language.has(Feature::LineContinuation) {
                text.to_owned()
            } else {
                text.replace("\\\n   ", "")
            };
            let name = self.name(if self.stage == Stage::Vertex { "MV" } else { "M" });
            // A body that ends in an operator's operand is in parentheses.
            all.push(Stmt::text_only(format!("#define {name}{head} ({text})")).with(Role::Directive));
            self.macros.push(Macro { name, result, parameters, pattern, order });
        }
        self.note("#define");
    }

    fn globals(&mut self, all: &mut Vec<Stmt>) {
        for _ in 0..self.chance.below(3) {
            let ty = self.value_type();
            self.is_constant = true;
            self.expressions_left = 5;
            let value = self.expr(&ty, 2);
            self.is_constant = false;
            let is_constant = self.chance.once_in(2);
            self.note(if is_constant { "const global" } else { "global" });
            let name = self.name("g");
            let head = if is_constant { "const " } else { "" };
            let pattern = format!("{head}{} = @;", ty.declared(&name));
            all.push(Stmt::new(&pattern, vec![value], Vec::new()));
            let variable = Variable { constant: is_constant, ..self.variable(&name, &ty, !is_constant) };
            self.declare(variable);
        }
    }

    fn function(&mut self, all: &mut Vec<Stmt>) {
        let result = if self.chance.once_in(4) { None } else { Some(self.value_type()) };
        let result =
            result.filter(|ty| self.is_value(ty) && (self.language.since(120, 300) || !ty.has_array(&self.structs)));
        let (mut parameters, mut heads, mut first) = (Vec::new(), Vec::new(), Vec::new());
        self.scopes.push(Vec::new());
        for _ in 0..self.chance.below(4) {
            let ty = self.value_type();
            let (word, mode) = match self.chance.below(6) {
                0 => ("out ", ParamMode::Out),
                1 => ("inout ", ParamMode::Inout),
                2 => ("const in ", ParamMode::ConstIn),
                3 => ("in ", ParamMode::In),
                _ => ("", ParamMode::In),
            };
            self.note(if word.is_empty() { "parameter" } else { word.trim() });
            let name = self.name("p");
            heads.push(format!("{word}{}", ty.declared(&name)));
            if mode == ParamMode::Out {
                let value = self.literal(&ty);
                first.push(Stmt::new(&format!("{name} = @;"), vec![value], Vec::new()));
            }
            let variable = self.variable(&name, &ty, mode != ParamMode::ConstIn);
            self.declare(variable);
            parameters.push((mode, ty));
        }
        // Overloads have one name, with blanks behind it, so that they can be told apart.
        let is_other = |name: &str| {
            let same = self.functions.iter().filter(|one| one.name.trim_end() == name);
            same.clone().count() > 0 && same.into_iter().all(|one| differs(&one.parameters, &parameters))
        };
        let names: std::collections::BTreeSet<&str> = self.functions.iter().map(|one| one.name.trim_end()).collect();
        let overloaded: Vec<String> = names.into_iter().filter(|name| is_other(name)).map(str::to_owned).collect();
        let name = match self.chance.one(&overloaded).cloned().filter(|_| self.chance.once_in(2)) {
            Some(name) => {
                self.note("overload");
                let others = self.functions.iter().filter(|one| one.name.trim_end() == name).count();
                name + &" ".repeat(others)
            }
            None => self.name("f"),
        };
        self.is_uniform = self.stage == Stage::Fragment && self.chance.once_in(4);
        let is_uniform = self.is_uniform;
        self.result.clone_from(&result);
        self.statements_left = 2 + self.chance.below(5);
        self.may_return = true;
        // The body's own scope is that of the parameters.
        let mut body = first;
        body.extend(self.statements(2));
        if let Some(ty) = &result {
            let value = self.returned(ty);
            body.push(Stmt::new("return @;", vec![value], Vec::new()));
        }
        self.scopes.pop();
        self.result = None;
        self.note("function");
        let word = result.as_ref().map_or("void".to_owned(), Ty::name);
        all.push(Stmt::new(&format!("{word} {name}({}) {{$}}", heads.join(", ")), Vec::new(), vec![body]));
        self.functions.push(Callable { name, result, parameters, is_uniform });
    }

    fn main(&mut self, interface: &Interface) -> Stmt {
        self.scopes.push(Vec::new());
        let mut body = Vec::new();
        let outputs = interface.outputs(self.language);
        if self.stage == Stage::Fragment {
            body.extend(outputs.iter().map(|one| Stmt::text_only(format!("{one} = vec4(0.25);")).with(Role::Output)));
            self.note("main");
        }
        self.is_uniform = self.stage == Stage::Fragment;
        // What statements write to, and the outputs read.
        let mut types = vec![FLOAT, INT, Ty::Vector(Scalar::Float, 4)];
        types.extend((0..self.chance.below(3)).map(|_| self.value_type()));
        for ty in types {
            self.expressions_left = 3;
            let value = self.expr(&ty, 1);
            let name = self.name("v");
            let variable = self.variable(&name, &ty, true);
            self.declare(variable);
            let declared = Stmt::new(&format!("{} = @;", ty.declared(&name)), vec![value], Vec::new());
            body.push(declared.with(Role::Declaration));
        }
        // A vertex stage that returns early leaves its outputs without values.
        self.may_return = self.stage == Stage::Fragment;
        self.statements_left =
            if self.stage == Stage::Fragment { 4 + self.chance.below(12) } else { 2 + self.chance.below(4) };
        while self.statements_left > 0 {
            body.extend(self.statements(3));
        }
        if self.stage == Stage::Vertex {
            self.expressions_left = 0;
            for Varying { name, parts, .. } in &interface.varyings {
                for (member, ty) in parts {
                    let place = if member.is_empty() { name.clone() } else { format!("{name}.{member}") };
                    self.expressions_left = 6;
                    let value = self.expr(ty, 2);
                    body.push(Stmt::new(&format!("{place} = @;"), vec![value], Vec::new()).with(Role::Output));
                }
            }
            body.push(Stmt::text_only("gl_Position = vec4(place * pw, 0.0, pw);").with(Role::Output));
        } else {
            let numbers = self.numbers(outputs.len() * 4);
            for (output, four) in outputs.iter().zip(numbers.chunks(4)) {
                let pattern = format!("{output} = vec4(@, @, @, @);");
                body.push(Stmt::new(&pattern, four.to_vec(), Vec::new()));
            }
        }
        self.scopes.pop();
        Stmt::new("void main() {$}", Vec::new(), vec![body])
    }

    /// Numbers from everything that is visible, for the outputs: so many.
    fn numbers(&mut self, count: usize) -> Vec<Expr> {
        let mut all = Vec::new();
        let is_own = |one: &Variable| (one.local || one.writable) && !one.constant;
        for variable in self.visible().into_iter().filter(is_own) {
            let whole = Expr::leaf(variable.ty.clone(), variable.name);
            self.scalars(whole, &mut all);
        }
        let mut chosen = Vec::new();
        while chosen.len() < count.min(NUMBERS) {
            if all.is_empty() {
                chosen.push(Expr::leaf(FLOAT, "uf"));
            } else {
                chosen.push(all.swap_remove(self.chance.below(all.len())));
            }
        }
        chosen
    }

    fn scalars(&mut self, whole: Expr, all: &mut Vec<Expr>) {
        match whole.ty.clone() {
            Ty::Vector(Scalar::Float, 1) => all.push(whole),
            Ty::Vector(Scalar::Int, 1) if self.language.has(Feature::IntegerOperators) => {
                all.push(Expr::new(FLOAT, "float(@ & 0xffff)", vec![whole.clone()]));
                all.push(Expr::new(FLOAT, "float((@ >> 16) & 0xffff)", vec![whole]));
            }
            Ty::Vector(Scalar::Uint, 1) => {
                all.push(Expr::new(FLOAT, "float(@ & 0xffffu)", vec![whole.clone()]));
                all.push(Expr::new(FLOAT, "float(@ >> 16u)", vec![whole]));
            }
            Ty::Vector(_, 1) => all.push(Expr::new(FLOAT, "float(@)", vec![whole])),
            Ty::Vector(scalar, size) => {
                for letter in "xyzw".chars().take(usize::from(size)) {
                    self.scalars(Expr::new(Ty::Vector(scalar, 1), &format!("@.{letter}"), vec![whole.clone()]), all);
                }
            }
            Ty::Matrix(columns, rows) => {
                for column in 0..columns {
                    let pattern = format!("@[{column}]");
                    self.scalars(Expr::new(Ty::Vector(Scalar::Float, rows), &pattern, vec![whole.clone()]), all);
                }
            }
            Ty::Array(element, size) => {
                for index in 0..size {
                    self.scalars(Expr::new((*element).clone(), &format!("@[{index}]"), vec![whole.clone()]), all);
                }
            }
            Ty::Struct(number) => {
                for (name, ty) in self.structs.get(number).cloned().unwrap_or_default() {
                    self.scalars(Expr::new(ty, &format!("@.{name}"), vec![whole.clone()]), all);
                }
            }
        }
    }
}

/// Whether two lists of parameters differ in their types: a call has the very types of one of them.
fn differs(left: &[(ParamMode, Ty)], right: &[(ParamMode, Ty)]) -> bool {
    left.len() != right.len() || left.iter().zip(right).any(|((_, left), (_, right))| left != right)
}
