//! Functions of a program: parameters, bodies, overloads, and functions that differ in one place.
//!
//! *In:* a language and what is visible. *Out:* functions, and statements that call each of them. *Holds:* a function calls only those before
//! it; one half sum up what they compute in a variable of their own and return it, the others in that of the stage.

use super::sink::SUM;
use super::tree::{Expr, Role, Stmt, StmtPart, Use};
use super::types::Ty;
use super::writer::{Callable, Writer};
use glisten_front::hir::{ParamMode, Scalar, Stage};
use glisten_front::language::Feature;

impl Writer<'_> {
    /// Adds a function, and sometimes another that differs from it in one place.
    pub(super) fn function(&mut self, all: &mut Vec<Stmt>) {
        let result = if self.chance.once_in(4) { None } else { Some(self.value_type()) };
        let result =
            result.filter(|ty| self.is_value(ty) && (self.language.since(120, 300) || !ty.has_array(&self.structs)));
        let (mut parameters, mut heads, mut first) = (Vec::new(), Vec::new(), Vec::new());
        self.scopes.push(Vec::new());
        let model = self.model();
        let count = model.as_ref().map_or_else(|| self.chance.below(4), |(_, parameters)| parameters.len());
        for index in 0..count {
            let given = model.as_ref().and_then(|(_, parameters)| parameters.get(index)).cloned();
            let (mode, ty) = given.unwrap_or_else(|| {
                let ty = self.value_type();
                let modes = [ParamMode::Out, ParamMode::Inout, ParamMode::ConstIn, ParamMode::In, ParamMode::In];
                (self.chance.one(&modes).copied().unwrap_or(ParamMode::In), ty)
            });
            let word = match mode {
                ParamMode::Out => "out ",
                ParamMode::Inout => "inout ",
                ParamMode::ConstIn => "const in ",
                ParamMode::In => self.chance.word(&["in ", "", ""]),
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
        let like = model.map(|(name, _)| name).filter(|name| overloaded.contains(name));
        let chosen = like.or_else(|| self.chance.one(&overloaded).cloned().filter(|_| self.chance.once_in(2)));
        let name = match chosen {
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
        self.is_alone = self.chance.once_in(2);
        if self.is_alone {
            self.note("function without effects on the sum");
            body.push(Stmt::text_only(format!("vec4 {SUM} = vec4(0.0);")).with(Role::Declaration));
        }
        body.extend(self.statements(2));
        self.sink(&mut body);
        if let Some(ty) = &result {
            let value = self.returned(ty);
            body.push(Stmt::new("return @;", vec![value], Vec::new()));
        }
        self.scopes.pop();
        self.result = None;
        self.is_alone = false;
        self.note("function");
        let word = result.as_ref().map_or("void".to_owned(), Ty::name);
        let made =
            |name: &str, body| Stmt::new(&format!("{word} {name}({}) {{$}}", heads.join(", ")), Vec::new(), vec![body]);
        if self.chance.once_in(3)
            && let Some(body) = self.varied_body(&body)
        {
            self.note("function that differs in one place");
            let other = self.name("f");
            all.push(made(&other, body));
            let (result, parameters) = (result.clone(), parameters.clone());
            self.functions.push(Callable { name: other, result, parameters, is_uniform });
        }
        all.push(made(&name, body));
        self.functions.push(Callable { name, result, parameters, is_uniform });
    }

    /// The name and the parameters of an overload to which a function's arguments convert: integers are floats there, or the other way
    /// around.
    fn model(&mut self) -> Option<(String, Vec<(ParamMode, Ty)>)> {
        if !self.language.has(Feature::ImplicitToFloat) || self.chance.once_in(2) {
            return None;
        }
        let Callable { name, mut parameters, .. } = self.chance.one(&self.functions)?.clone();
        let fitting: Vec<usize> = (0..parameters.len())
            .filter(|index| {
                let is_fitting = |(mode, ty): &(ParamMode, Ty)| {
                    let is_number = ty.is_vector_of(Scalar::Int) || ty.is_vector_of(Scalar::Float);
                    is_number && matches!(mode, ParamMode::In | ParamMode::ConstIn)
                };
                parameters.get(*index).is_some_and(is_fitting)
            })
            .collect();
        let index = *self.chance.one(&fitting)?;
        let (_, ty) = parameters.get_mut(index)?;
        if let Ty::Vector(scalar, _) = ty {
            *scalar = if *scalar == Scalar::Int { Scalar::Float } else { Scalar::Int };
        }
        let known = self.language.basics.contains(ty);
        self.note("overload with a conversion");
        known.then(|| (name.trim_end().to_owned(), parameters))
    }

    /// A body with another operator or another number in one place; none if there is no such place.
    fn varied_body(&mut self, body: &[Stmt]) -> Option<Vec<Stmt>> {
        let mut other = body.to_vec();
        let mut count = 0;
        expressions(&mut other, &mut |expr| count += usize::from(variation(expr).is_some()));
        if count == 0 {
            return None;
        }
        let mut left = self.chance.below(count) + 1;
        expressions(&mut other, &mut |expr| {
            if let Some(varied) = variation(expr) {
                left = left.wrapping_sub(1);
                if left == 0 {
                    *expr = varied;
                }
            }
        });
        Some(other)
    }

    /// A lookup of each texture, as statements.
    pub(super) fn lookups(&mut self, body: &mut Vec<Stmt>) {
        for sampler in self.samplers.clone() {
            let types = [Scalar::Float, Scalar::Int, Scalar::Uint];
            let types = types.into_iter().flat_map(|scalar| [4, 1].map(|size| Ty::Vector(scalar, size)));
            for ty in types {
                self.expressions_left = 3;
                if let Some(value) = self.lookup(&ty, sampler, 1) {
                    let name = self.name("v");
                    let variable = self.variable(&name, &ty, true);
                    self.declare(variable);
                    let declared = Stmt::new(&format!("{} = @;", ty.declared(&name)), vec![value], Vec::new());
                    body.push(declared.with(Role::Declaration));
                }
            }
        }
    }

    /// Calls of all functions, as statements.
    pub(super) fn calls(&mut self, body: &mut Vec<Stmt>) {
        for one in self.functions.clone() {
            self.expressions_left = 4;
            let Some((text, arguments)) = self.call_to(&one, 2) else { continue };
            match one.result.filter(|ty| self.is_value(ty)) {
                Some(ty) => {
                    let name = self.name("v");
                    let variable = self.variable(&name, &ty, true);
                    self.declare(variable);
                    let call = Expr::new(ty.clone(), &text, arguments);
                    let declared = Stmt::new(&format!("{} = @;", ty.declared(&name)), vec![call], Vec::new());
                    body.push(declared.with(Role::Declaration));
                }
                None => body.push(Stmt::new(&format!("{text};"), arguments, Vec::new())),
            }
        }
    }
}

/// Calls `f` with every expression of statements, outer ones first.
fn expressions(statements: &mut [Stmt], f: &mut dyn FnMut(&mut Expr)) {
    fn within(expr: &mut Expr, f: &mut dyn FnMut(&mut Expr)) {
        f(expr);
        expr.operands.iter_mut().for_each(|operand| within(operand, f));
    }
    for part in statements.iter_mut().flat_map(|statement| &mut statement.parts) {
        match part {
            StmtPart::Expr(expr) => within(expr, f),
            StmtPart::Body(body) => expressions(body, f),
        }
    }
}

/// The same expression with another operator, or another number.
fn variation(expr: &Expr) -> Option<Expr> {
    if expr.usage == Use::Literal {
        let other = match expr.ty {
            Ty::Vector(Scalar::Float, 1) => "1.125",
            Ty::Vector(Scalar::Int, 1) => "6",
            Ty::Vector(Scalar::Uint, 1) => "6u",
            _ => return None,
        };
        return Some(Expr::leaf(expr.ty.clone(), other).used(Use::Literal));
    }
    let other = match expr.operator()? {
        "+" => "-",
        "-" => "+",
        "<" => ">=",
        ">" => "<=",
        "<=" => "<",
        ">=" => ">",
        "==" => "!=",
        "!=" => "==",
        "&" => "|",
        "|" => "^",
        "&&" => "||",
        "||" => "^^",
        _ => return None,
    };
    Some(Expr::new(expr.ty.clone(), &format!("(@ {other} @)"), expr.operands.clone()).used(expr.usage))
}

/// Whether two lists of parameters differ in their types: a call has the very types of one of them.
fn differs(left: &[(ParamMode, Ty)], right: &[(ParamMode, Ty)]) -> bool {
    left.len() != right.len() || left.iter().zip(right).any(|((_, left), (_, right))| left != right)
}
