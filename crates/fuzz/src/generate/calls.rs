//! Calls: of built-in functions, of functions of the program, and uses of macros.
//!
//! *In:* the type of a result. *Out:* a call, if there is one. *Holds:* what needs uniform control flow is called in it alone; built-in
//! functions are those of the version's table.

use super::guards::{Guard, guard, lookup_guard};
use super::language::Overload;
use super::samplers::Sampler;
use super::tree::{Expr, Stmt, Use};
use super::types::Ty;
use super::writer::{Callable, Writer};
use glisten_front::builtin::functions::Effect;
use glisten_front::builtin::operations::Class;
use glisten_front::hir::{ParamMode, TypeId};
use glisten_front::language::Feature;

impl Writer<'_> {
    /// A call of a built-in function.
    pub(super) fn builtin(&mut self, ty: &Ty, depth: usize) -> Option<Expr> {
        let language = self.language;
        let named = language.functions(self.stage, Some(ty));
        for _ in 0..3 {
            let same = self.chance.one(named)?;
            let overload = *self.chance.one(same)?;
            if self.may_call(overload)
                && let Some((text, arguments)) = self.arguments(overload, depth)
            {
                self.note(overload.row.name);
                return Some(Expr::new(ty.clone(), &text, arguments));
            }
        }
        None
    }

    /// A lookup of a texture with a result of this type.
    pub(super) fn lookup(&mut self, ty: &Ty, sampler: &Sampler, depth: usize) -> Option<Expr> {
        let (language, wanted) = (self.language, sampler.ty()?);
        let takes = |one: &Overload| one.signature.params().iter().any(|(id, _)| *id == wanted);
        let named = language.functions(self.stage, Some(ty)).iter().flatten().filter(|one| takes(one));
        let fitting: Vec<Overload> = named.copied().filter(|one| self.may_call(*one)).collect();
        let overload = *self.chance.one(&fitting)?;
        let (text, arguments) = self.arguments(overload, depth)?;
        self.note(overload.row.name);
        Some(Expr::new(ty.clone(), &text, arguments))
    }

    /// A call of a built-in function without a result.
    pub(super) fn void_builtin(&mut self, depth: usize) -> Option<Stmt> {
        let language = self.language;
        let named = language.functions(self.stage, None);
        let same = self.chance.one(named)?;
        let overload = *self.chance.one(same)?;
        let (text, arguments) = self.arguments(overload, depth)?;
        self.note(overload.row.name);
        Some(Stmt::new(&format!("{text};"), arguments, Vec::new()))
    }

    fn may_call(&self, overload: Overload) -> bool {
        let Overload { row, .. } = overload;
        let needs_all = row.effect == Effect::Derivative || row.function.implicit_derivatives();
        let is_constant = row.constant && self.language.has(Feature::ConstantFunctions);
        // Noise has any value.
        let is_noise = matches!(row.function.class(), Class::Noise(_));
        (!needs_all || self.is_uniform) && (!self.is_constant || is_constant) && !is_noise
    }

    /// The pattern of a call and its arguments.
    fn arguments(&mut self, overload: Overload, depth: usize) -> Option<(String, Vec<Expr>)> {
        let Overload { row, signature } = overload;
        let count = signature.params().len();
        let (mut places, mut arguments) = (Vec::new(), Vec::new());
        for (index, (id, mode)) in signature.params().iter().enumerate() {
            let parameter = row.params.get(index).map_or("", |one| one.name);
            if *id == TypeId::FOUR_OFFSETS {
                places.push("ivec2[4](ivec2(0), ivec2(1, 0), ivec2(0, -1), ivec2(1))".to_owned());
                continue;
            }
            let Some(ty) = Ty::of(*id) else {
                let fitting: Vec<&str> =
                    self.samplers.iter().filter(|one| one.ty() == Some(*id)).map(|one| one.name).collect();
                places.push((*self.chance.one(&fitting)?).to_owned());
                continue;
            };
            if *mode == ParamMode::Out {
                if self.is_constant {
                    return None;
                }
                places.push("@".to_owned());
                arguments.push(self.part(&ty, true)?.used(Use::Fixed));
                continue;
            }
            let guard = match row.effect {
                Effect::Texture => lookup_guard(row.name, parameter, &ty),
                _ => guard(row.name, index, count, &ty),
            };
            let has_functions = !self.is_constant || self.language.has(Feature::ConstantFunctions);
            match guard {
                Guard::Constant(text) if matches!(ty, Ty::Vector(_, 1)) => places.push(text.to_owned()),
                Guard::Constant(text) => places.push(format!("{}({text})", ty.name())),
                Guard::Pattern(pattern) if has_functions => {
                    places.push(pattern.to_owned());
                    arguments.push(self.expr(&ty, depth));
                }
                Guard::Pattern(_) => return None,
                Guard::None => {
                    places.push("@".to_owned());
                    arguments.push(self.expr(&ty, depth));
                }
            }
        }
        Some((format!("{}({})", row.name, places.join(", ")), arguments))
    }

    /// A call of a function of the program.
    pub(super) fn call(&mut self, ty: &Ty, depth: usize) -> Option<Expr> {
        if self.is_constant {
            return None;
        }
        let (text, arguments) = self.call_of(Some(ty), depth)?;
        Some(Expr::new(ty.clone(), &text, arguments))
    }

    /// A call of a function without a result.
    pub(super) fn void_call(&mut self, depth: usize) -> Option<Stmt> {
        let (text, arguments) = self.call_of(None, depth)?;
        self.note("call of a function without a result");
        Some(Stmt::new(&format!("{text};"), arguments, Vec::new()))
    }

    /// A call of a function of the program that takes a place and gives a value of its type.
    pub(super) fn call_on(&mut self, place: &Expr) -> Option<Expr> {
        let takes =
            |(mode, ty): &(ParamMode, Ty)| matches!(mode, ParamMode::In | ParamMode::ConstIn) && *ty == place.ty;
        let gives = |one: &Callable| one.result.as_ref() == Some(&place.ty) && (self.is_uniform || !one.is_uniform);
        let fitting: Vec<Callable> =
            self.functions.iter().filter(|one| gives(one) && one.parameters.iter().any(takes)).cloned().collect();
        let chosen = self.chance.one(&fitting)?.clone();
        let (text, mut arguments) = self.call_to(&chosen, 2)?;
        let index = chosen.parameters.iter().position(takes)?;
        *arguments.get_mut(index)? = place.clone();
        Some(Expr::new(place.ty.clone(), &text, arguments))
    }

    fn call_of(&mut self, result: Option<&Ty>, depth: usize) -> Option<(String, Vec<Expr>)> {
        let is_fitting = |one: &&Callable| one.result.as_ref() == result && (self.is_uniform || !one.is_uniform);
        let fitting: Vec<Callable> = self.functions.iter().filter(is_fitting).cloned().collect();
        let chosen = self.chance.one(&fitting)?.clone();
        self.call_to(&chosen, depth)
    }

    /// The pattern of a call to a function, and its arguments.
    pub(super) fn call_to(&mut self, chosen: &Callable, depth: usize) -> Option<(String, Vec<Expr>)> {
        let Callable { name, parameters, .. } = chosen;
        let mut arguments = Vec::with_capacity(parameters.len());
        for (mode, ty) in parameters {
            arguments.push(match mode {
                ParamMode::Out | ParamMode::Inout => self.part(ty, true)?.used(Use::Fixed),
                ParamMode::In | ParamMode::ConstIn => self.expr(ty, depth),
            });
        }
        self.note("call");
        Some((format!("{name}({})", vec!["@"; parameters.len()].join(", ")), arguments))
    }

    /// A use of a macro with parameters.
    pub(super) fn macro_use(&mut self, ty: &Ty, depth: usize) -> Option<Expr> {
        let fitting: Vec<_> = self.macros.iter().filter(|one| one.result == *ty).cloned().collect();
        let one = self.chance.one(&fitting)?.clone();
        self.note("macro");
        let arguments = one.parameters.iter().map(|ty| self.expr(ty, depth)).collect();
        let places = vec!["@"; one.parameters.len()].join(", ");
        Some(Expr::new(ty.clone(), &format!("{}({places})", one.name), arguments))
    }
}
