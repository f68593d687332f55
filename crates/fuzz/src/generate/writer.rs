//! [`Writer`]: the state while a stage is generated: what is visible, and how much may still be written.
//!
//! *In:* a language and a stage. *Out:* names, variables and their parts. *Holds:* what is chosen here is defined: indices are in bounds, and
//! every variable has a value.

use super::language::Language;
use super::samplers::Sampler;
use super::tree::{Expr, Use, Variable};
use super::types::{INT, Members, Ty};
use crate::chance::Chance;
use glisten_front::hir::{ParamMode, Scalar, Stage};
use glisten_front::language::Feature;
use std::collections::BTreeSet;

/// A call of a function of a family: the pattern, and the types of the arguments in its places.
#[derive(Clone, Debug)]
pub(super) struct FamilyCall {
    pub(super) result: Ty,
    pub(super) pattern: String,
    pub(super) arguments: Vec<Ty>,
}

/// A function that may be called.
#[derive(Clone, Debug)]
pub(super) struct Callable {
    pub(super) name: String,
    pub(super) result: Option<Ty>,
    pub(super) parameters: Vec<(ParamMode, Ty)>,
    /// Whether it needs uniform control flow, for derivatives.
    pub(super) is_uniform: bool,
}

/// A macro with parameters that may be used.
#[derive(Clone, Debug)]
pub(super) struct Macro {
    pub(super) name: String,
    pub(super) result: Ty,
    pub(super) parameters: Vec<Ty>,
    /// A use written out, and which arguments are in its places.
    pub(super) pattern: &'static str,
    pub(super) order: Vec<usize>,
}

/// The state.
pub(super) struct Writer<'l> {
    pub(super) chance: Chance,
    pub(super) language: &'l Language,
    pub(super) stage: Stage,
    pub(super) structs: Vec<Members>,
    pub(super) scopes: Vec<Vec<Variable>>,
    pub(super) functions: Vec<Callable>,
    /// Calls of functions that are in no other call.
    pub(super) families: Vec<FamilyCall>,
    pub(super) macros: Vec<Macro>,
    pub(super) samplers: Vec<&'static Sampler>,
    /// Whether all invocations are here together.
    pub(super) is_uniform: bool,
    /// Whether the expression has to be constant.
    pub(super) is_constant: bool,
    /// Whether `continue` is inside of a loop, and `break` of a loop or a `switch`.
    pub(super) in_loop: bool,
    pub(super) in_switch: bool,
    /// Whether `return` leaves nothing without a value.
    pub(super) may_return: bool,
    /// Whether a local may hide another.
    pub(super) hides: bool,
    /// Whether the function has a sum of its own, which is in its result.
    pub(super) is_alone: bool,
    /// Statements before a `return` of `main`.
    pub(super) early: String,
    /// The result of the function.
    pub(super) result: Option<Ty>,
    pub(super) names: usize,
    /// How many statements and expressions may still be written.
    pub(super) statements_left: usize,
    pub(super) expressions_left: usize,
    /// The constructs so far.
    pub(super) used: BTreeSet<&'static str>,
}

impl<'l> Writer<'l> {
    pub(super) fn new(chance: Chance, language: &'l Language, stage: Stage) -> Self {
        Self {
            chance,
            language,
            stage,
            structs: Vec::new(),
            scopes: vec![Vec::new()],
            functions: Vec::new(),
            families: Vec::new(),
            macros: Vec::new(),
            samplers: Vec::new(),
            is_uniform: false,
            is_constant: false,
            in_loop: false,
            in_switch: false,
            may_return: false,
            hides: true,
            is_alone: false,
            early: String::new(),
            result: None,
            names: 0,
            statements_left: 0,
            expressions_left: 0,
            used: BTreeSet::new(),
        }
    }

    /// Notes a construct.
    pub(super) fn note(&mut self, construct: &'static str) {
        self.used.insert(construct);
    }

    /// A name that nothing else has.
    pub(super) fn name(&mut self, prefix: &str) -> String {
        self.names += 1;
        format!("{prefix}{}", self.names)
    }

    /// Declares a variable in the innermost scope.
    pub(super) fn declare(&mut self, variable: Variable) {
        self.scopes.last_mut().into_iter().for_each(|scope| scope.push(variable.clone()));
    }

    /// A variable of the usual kind.
    pub(super) fn variable(&self, name: &str, ty: &Ty, writable: bool) -> Variable {
        let local = self.scopes.len() > 1;
        Variable { name: name.to_owned(), ty: ty.clone(), writable, constant: false, local, below: None }
    }

    /// All variables that no inner one hides.
    pub(super) fn visible(&self) -> Vec<Variable> {
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        let all = self.scopes.iter().rev().flat_map(|scope| scope.iter().rev());
        all.filter(|variable| seen.insert(&variable.name)).cloned().collect()
    }

    /// A type of values.
    pub(super) fn value_type(&mut self) -> Ty {
        let has_arrays = self.language.has_array_values();
        match self.chance.below(10) {
            0 if has_arrays => self.array_type(),
            1 if !self.structs.is_empty() => {
                let ty = Ty::Struct(self.chance.below(self.structs.len()));
                let is_value = !ty.has_array(&self.structs) || self.language.has(Feature::ArraysInValues);
                if is_value { ty } else { INT }
            }
            _ => self.basic_type(),
        }
    }

    /// A scalar, a vector or a matrix.
    pub(super) fn basic_type(&mut self) -> Ty {
        let language = self.language;
        self.chance.one(&language.basics).cloned().unwrap_or(INT)
    }

    /// An array, or an array of arrays where there are such.
    pub(super) fn array_type(&mut self) -> Ty {
        let element = self.basic_type();
        let size = 2 + self.chance.below(2) as u32;
        let array = Ty::Array(Box::new(element), size);
        if self.language.has(Feature::ArraysOfArrays) && self.chance.once_in(2) {
            self.note("array of arrays");
            return Ty::Array(Box::new(array), 2);
        }
        array
    }

    /// Whether a type is a value that can be assigned and returned in this version.
    pub(super) fn is_value(&self, ty: &Ty) -> bool {
        match ty {
            Ty::Array(..) => self.language.has_array_values(),
            Ty::Struct(_) => !ty.has_array(&self.structs) || self.language.has(Feature::ArraysInValues),
            _ => true,
        }
    }

    /// A part of a variable with this type, if there is one.
    pub(super) fn part(&mut self, wanted: &Ty, written: bool) -> Option<Expr> {
        let is_constant = self.is_constant;
        let mut found = Vec::new();
        for variable in self.visible() {
            if (written && !variable.writable) || (is_constant && !variable.constant) {
                continue;
            }
            let whole = Expr::leaf(variable.ty.clone(), variable.name);
            self.parts(whole, wanted, written, &mut found);
        }
        // What is nearest is as likely as all others together.
        let index =
            if self.chance.once_in(2) { self.chance.below(found.len().min(3)) } else { self.chance.below(found.len()) };
        (index < found.len()).then(|| found.swap_remove(index))
    }

    /// Adds the parts of an expression that have a type.
    fn parts(&mut self, whole: Expr, wanted: &Ty, written: bool, found: &mut Vec<Expr>) {
        if whole.ty == *wanted {
            found.push(whole);
            return;
        }
        match (&whole.ty.clone(), wanted) {
            (Ty::Vector(scalar, size), Ty::Vector(other, count)) if scalar == other && *size > 1 => {
                if let Some(swizzle) = self.swizzle(*size, *count, written) {
                    found.push(Expr::new(wanted.clone(), &format!("@.{swizzle}"), vec![whole]));
                }
            }
            (Ty::Matrix(columns, rows), Ty::Vector(Scalar::Float, size)) if *size == 1 || size == rows => {
                let column = self.index(u32::from(*columns), written);
                let column = Expr::new(Ty::Vector(Scalar::Float, *rows), "@[@]", vec![whole, column]);
                self.parts(column, wanted, written, found);
            }
            (Ty::Array(element, size), _) => {
                let index = self.index(*size, written);
                let element = Expr::new((**element).clone(), "@[@]", vec![whole, index]);
                self.parts(element, wanted, written, found);
            }
            (Ty::Struct(number), _) => {
                for (name, ty) in self.structs.get(*number).cloned().unwrap_or_default() {
                    let member = Expr::new(ty, &format!("@.{name}"), vec![whole.clone()]);
                    self.parts(member, wanted, written, found);
                }
            }
            _ => {}
        }
    }

    /// Components of a vector; of what is written, each once.
    fn swizzle(&mut self, size: u8, count: u8, written: bool) -> Option<String> {
        if written && count > size {
            return None;
        }
        let letters = self.chance.word(&["xyzw", "rgba", "stpq"]);
        let mut left: Vec<char> = letters.chars().take(usize::from(size)).collect();
        let mut text = String::new();
        for _ in 0..count {
            let index = self.chance.below(left.len());
            let letter = if written { left.remove(index) } else { *left.get(index)? };
            text.push(letter);
        }
        self.note(if written { "swizzle as l-value" } else { "swizzle" });
        Some(text)
    }

    /// An index in bounds. It changes nothing.
    pub(super) fn index(&mut self, size: u32, written: bool) -> Expr {
        let counters: Vec<Variable> =
            self.visible().into_iter().filter(|one| one.below.is_some_and(|below| below <= size)).collect();
        match self.chance.below(4) {
            0 | 1 if !counters.is_empty() && !self.is_constant => {
                let name = self.chance.one(&counters).map(|one| one.name.clone()).unwrap_or_default();
                self.note("index by a counter");
                Expr::leaf(INT, name).used(Use::Fixed)
            }
            2 if !written && !self.is_constant && self.language.since(130, 300) && self.expressions_left > 0 => {
                self.expressions_left -= 1;
                self.note("index by an expression");
                match self.visible().into_iter().find(|one| one.ty == INT) {
                    Some(one) if size == 2 || size == 4 => {
                        Expr::new(INT, &format!("(@ & {})", size - 1), vec![Expr::leaf(INT, one.name)])
                    }
                    Some(one) => Expr::new(INT, &format!("clamp(@, 0, {})", size - 1), vec![Expr::leaf(INT, one.name)]),
                    None => Expr::leaf(INT, "1").used(Use::Fixed),
                }
                .used(Use::Fixed)
            }
            _ => Expr::leaf(INT, self.chance.below(size as usize).to_string()).used(Use::Fixed),
        }
    }
}
