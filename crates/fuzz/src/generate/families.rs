//! Families of functions that are alike but for one thing: an operator, the type of a parameter.
//!
//! *In:* a language. *Out:* functions, and statements that call each of them. *Holds:* a call names one function by the rules of the version;
//! nothing else is added to a family, so that it stays so.

use super::tree::{Expr, Role, Stmt};
use super::types::{BOOL, FLOAT, INT, Ty};
use super::writer::{FamilyCall, Writer};
use glisten_front::hir::Scalar;
use glisten_front::language::Feature;

/// Pairs of operators.
const OPERATORS: &[(&str, &str)] = &[("+", "-"), ("-", "+"), ("*", "-"), ("+", "*")];

impl Writer<'_> {
    /// Adds a family of functions, sometimes.
    pub(super) fn family(&mut self, all: &mut Vec<Stmt>) {
        if !self.chance.once_in(2) {
            return;
        }
        let has_best = self.language.has(Feature::BestOverload);
        match self.chance.below(3) {
            0 if has_best => self.converting(all),
            1 => self.left_out(all),
            _ => self.selected(all),
        }
    }

    /// Calls of the families, as statements.
    pub(super) fn family_calls(&mut self, body: &mut Vec<Stmt>) {
        for FamilyCall { result, pattern, arguments } in self.families.clone() {
            self.expressions_left = 4;
            let arguments = arguments.iter().map(|ty| self.expr(ty, 2)).collect();
            let name = self.name("v");
            let variable = self.variable(&name, &result, true);
            self.declare(variable);
            let call = Expr::new(result.clone(), &pattern, arguments);
            let declared = Stmt::new(&format!("{} = @;", result.declared(&name)), vec![call], Vec::new());
            body.push(declared.with(Role::Declaration));
        }
    }

    /// Overloads none of which fits exactly: the first converts two arguments, the second one of them (GLSL 4.00 §6.1).
    fn converting(&mut self, all: &mut Vec<Stmt>) {
        self.note("overload that converts less than an earlier one");
        let size = 1 + self.chance.below(4) as u8;
        let (float, int) = (Ty::Vector(Scalar::Float, size), Ty::Vector(Scalar::Int, size));
        let name = self.name("f");
        let (first, second) = (self.name("p"), self.name("p"));
        let converted =
            Expr::new(float.clone(), &format!("{}(@)", float.name()), vec![Expr::leaf(int.clone(), &second)]);
        let of = |right: Expr, operator: &str| {
            let left = Expr::leaf(float.clone(), &first);
            Expr::new(float.clone(), &format!("(@ {operator} @)"), vec![left, right])
        };
        let (one, other) = self.chance.one(OPERATORS).copied().unwrap_or(("+", "-"));
        let heads = [(first.as_str(), &float), (second.as_str(), &float)];
        all.push(returning(&name, &float, &heads, of(Expr::leaf(float.clone(), &second), one)));
        let heads = [(first.as_str(), &float), (second.as_str(), &int)];
        // The blank makes it a name of its own, where overloads are renamed.
        all.push(returning(&format!("{name} "), &float, &heads, of(converted, other)));
        self.call_of_family(float, format!("{name} (@, @)"), vec![int.clone(), int]);
    }

    /// Overloads that are equal but for an operator once the parameter is gone that they do not use.
    fn left_out(&mut self, all: &mut Vec<Stmt>) {
        self.note("overloads that differ in an operator");
        let size = 1 + self.chance.below(4) as u8;
        let float = Ty::Vector(Scalar::Float, size);
        let name = self.name("f");
        let (first, second) = (self.name("p"), self.name("p"));
        let (one, other) = self.chance.one(OPERATORS).copied().unwrap_or(("+", "-"));
        for (name, ty, operator) in [(name.clone(), INT, one), (format!("{name} "), BOOL, other)] {
            let parts = vec![Expr::leaf(float.clone(), &first), Expr::leaf(FLOAT, "0.75")];
            let value = Expr::new(float.clone(), &format!("(@ {operator} @)"), parts);
            let heads = [(first.as_str(), &float), (second.as_str(), &ty)];
            all.push(function(&name, &float, &heads, sometimes(&float, &first, value)));
            self.call_of_family(float.clone(), format!("{name}(@, @)"), vec![float.clone(), ty]);
        }
    }

    /// A function whose argument selects the operator, called with both constants: what is left for each differs in the operator.
    fn selected(&mut self, all: &mut Vec<Stmt>) {
        self.note("function whose argument selects an operator");
        let size = 1 + self.chance.below(4) as u8;
        let float = Ty::Vector(Scalar::Float, size);
        let name = self.name("f");
        let names = [self.name("p"), self.name("p"), self.name("p")];
        let [first, second, third] = &names;
        let (one, other) = self.chance.one(OPERATORS).copied().unwrap_or(("+", "-"));
        let of = |operator: &str| {
            let operands = vec![Expr::leaf(float.clone(), first), Expr::leaf(float.clone(), second)];
            Expr::new(float.clone(), &format!("(@ {operator} @)"), operands)
        };
        let heads = [(first.as_str(), &float), (second.as_str(), &float), (third.as_str(), &BOOL)];
        let parts = vec![Expr::leaf(BOOL, third), of(one), of(other)];
        let value = Expr::new(float.clone(), "(@ ? @ : @)", parts);
        all.push(function(&name, &float, &heads, sometimes(&float, first, value)));
        for value in ["true", "false"] {
            self.call_of_family(float.clone(), format!("{name}(@, @, {value})"), vec![float.clone(), float.clone()]);
        }
    }

    fn call_of_family(&mut self, result: Ty, pattern: String, arguments: Vec<Ty>) {
        self.families.push(FamilyCall { result, pattern, arguments });
    }
}

/// A function that returns a value.
fn returning(name: &str, result: &Ty, parameters: &[(&str, &Ty)], value: Expr) -> Stmt {
    function(name, result, parameters, vec![Stmt::new("return @;", vec![value], Vec::new())])
}

/// A body that returns a value if the first parameter is large, and else that parameter. It is more than an expression, so that nobody writes
/// it out where it is called.
fn sometimes(result: &Ty, parameter: &str, value: Expr) -> Vec<Stmt> {
    let first = if *result == FLOAT { parameter.to_owned() } else { format!("{parameter}.x") };
    let own = format!("{parameter}_own");
    let start = Expr::leaf(result.clone(), parameter);
    vec![
        Stmt::new(&format!("{} = @;", result.declared(&own)), vec![start], Vec::new()).with(Role::Declaration),
        Stmt::new(
            "if (@) {$}",
            vec![Expr::leaf(BOOL, format!("{first} > -0.5"))],
            vec![vec![Stmt::new(&format!("{own} = @;"), vec![value], Vec::new())]],
        ),
        Stmt::text_only(format!("return {own};")),
    ]
}

fn function(name: &str, result: &Ty, parameters: &[(&str, &Ty)], body: Vec<Stmt>) -> Stmt {
    let heads: Vec<String> = parameters.iter().map(|(name, ty)| ty.declared(name)).collect();
    Stmt::new(&format!("{} {name}({}) {{$}}", result.name(), heads.join(", ")), Vec::new(), vec![body])
}
