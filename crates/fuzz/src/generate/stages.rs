//! Whole stages: what is declared, functions, `main`, and the scene that gives values to all of it.
//!
//! *In:* a seed and a language. *Out:* [`Program`]. *Holds:* both stages declare the same uniforms and varyings; the scene has
//! a value for each.

use super::Program;
use super::interface::{Interface, PASSED, Varying};
use super::language::Language;
use super::sink::SUM;
use super::tree::{Role, Stmt, Variable};
use super::types::{BOOL, FLOAT, INT, Members, Ty};
use super::writer::{Macro, Writer};
use crate::chance::Chance;
use glisten_front::hir::{Scalar, Stage};
use glisten_front::language::Feature;

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
    let vertex = stage(Stage::Vertex);
    let geometry = if interface.has_geometry { stage(Stage::Geometry) } else { Vec::new() };
    let fragment = stage(Stage::Fragment);
    Program { seed, language, vertex, geometry, fragment, scene: interface.scene(), constructs: used, macros }
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
        all.push(Stmt::text_only(format!("vec4 {SUM} = vec4(0.0);")));
        self.globals(&mut all);
        for _ in 0..self.chance.below(4) {
            self.function(&mut all);
        }
        self.family(&mut all);
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
            let name = self.name(match self.stage {
                Stage::Vertex => "MV",
                Stage::Geometry => "MG",
                Stage::Fragment => "M",
            });
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

    /// Gives a varying the value of a local whose members are stored to one after the other.
    fn by_members(&mut self, varying: &str, number: usize, body: &mut Vec<Stmt>) {
        self.note("struct as a varying, by its members");
        let (ty, local) = (Ty::Struct(number), self.name("v"));
        body.push(Stmt::text_only(format!("{};", ty.declared(&local))).with(Role::Declaration));
        for (member, ty) in self.structs.get(number).cloned().unwrap_or_default() {
            self.expressions_left = 6;
            let value = self.expr(&ty, 2);
            body.push(Stmt::new(&format!("{local}.{member} = @;"), vec![value], Vec::new()).with(Role::Output));
        }
        body.push(Stmt::text_only(format!("{varying} = {local};")).with(Role::Output));
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
        self.calls(&mut body);
        self.family_calls(&mut body);
        self.lookups(&mut body);
        if self.stage == Stage::Fragment {
            let pattern = format!("{SUM} += {};", interface.passed());
            body.push(Stmt::text_only(pattern));
            self.early = outputs.first().map_or(String::new(), |one| format!("{one} = {SUM}; "));
        }
        // A vertex stage that returns early leaves its outputs without values.
        self.may_return = self.stage == Stage::Fragment;
        self.statements_left =
            if self.stage == Stage::Fragment { 4 + self.chance.below(12) } else { 2 + self.chance.below(4) };
        while self.statements_left > 0 {
            body.extend(self.statements(3));
        }
        self.early = String::new();
        self.sink(&mut body);
        if self.stage == Stage::Geometry {
            body.push(emitted(interface));
            body.push(Stmt::text_only("EndPrimitive();").with(Role::Output));
        } else if self.stage == Stage::Vertex {
            self.expressions_left = 0;
            for Varying { name, parts, .. } in &interface.varyings {
                if name == PASSED {
                    body.push(Stmt::text_only(format!("{name} = {SUM};")).with(Role::Output));
                    continue;
                }
                for (member, ty) in parts {
                    if let (Ty::Struct(number), true) = (ty, self.chance.once_in(2)) {
                        self.by_members(name, *number, &mut body);
                        continue;
                    }
                    let place = if member.is_empty() { name.clone() } else { format!("{name}.{member}") };
                    self.expressions_left = 6;
                    let value = self.expr(ty, 2);
                    body.push(Stmt::new(&format!("{place} = @;"), vec![value], Vec::new()).with(Role::Output));
                }
            }
            if interface.has_clips() {
                self.expressions_left = 3;
                let value = self.expr(&FLOAT, 2);
                body.push(Stmt::new("gl_ClipDistance[0] = @;", vec![value], Vec::new()).with(Role::Output));
                body.push(Stmt::text_only("gl_ClipDistance[1] = place.x + 1.5;").with(Role::Output));
            }
            body.push(Stmt::text_only("gl_Position = vec4(place * pw, 0.0, pw);").with(Role::Output));
        } else {
            let numbers = self.numbers(outputs.len() * 4);
            for (output, four) in outputs.iter().zip(numbers.chunks(4)) {
                let sum = if outputs.first() == Some(output) { format!("{SUM} + ") } else { String::new() };
                let pattern = format!("{output} = {sum}vec4(@, @, @, @);");
                body.push(Stmt::new(&pattern, four.to_vec(), Vec::new()));
            }
        }
        self.scopes.pop();
        Stmt::new("void main() {$}", Vec::new(), vec![body])
    }
}

/// The loop of a geometry stage that emits the triangle with the sum added.
fn emitted(interface: &Interface) -> Stmt {
    let mut body = Vec::new();
    for (from, to) in interface.varyings.iter().zip(interface.written(Stage::Geometry)) {
        for (from, to) in from.places("[corner]").iter().zip(to.places("")) {
            let sum = if to == interface.passed() { format!(" + {SUM}") } else { String::new() };
            body.push(Stmt::text_only(format!("{to} = {from}{sum};")).with(Role::Output));
        }
    }
    body.push(Stmt::text_only("gl_Position = gl_in[corner].gl_Position;").with(Role::Output));
    body.push(Stmt::text_only("EmitVertex();").with(Role::Output));
    Stmt::new("for (int corner = 0; corner < 3; corner++) {$}", Vec::new(), vec![body]).with(Role::Output)
}
