//! Pruning: what reaches no output goes, across the stages.
//!
//! *In:* settled stages. *Out:* stages in which everything that is written is wanted by somebody.
//!
//! | file | what goes |
//! | --- | --- |
//! | `apart` | nothing: variables that are declared several times become several |
//! | `uses` | counts who reads what |
//! | `sweep` | stores that nobody reads, stores of what is there, statements without effect |
//! | `once` | loops that run once |
//! | `overwritten` | stores that are overwritten first |
//! | `declare` | declarations apart from their values |
//! | `inline` | functions that are one short expression |
//! | `clamped` | the second of two equal clamps |
//! | `trim` | members of structs, ends of uniform arrays |
//! | `merge` | clones that came out alike |
//! | `compact` | what nothing names: functions, parameters, locals, globals |
//! | `unreached` | what reaches no output whatever the inputs are, in stages that are not evaluated |

mod apart;
mod clamped;
mod compact;
mod declare;
mod inline;
mod merge;
mod once;
mod overwritten;
mod sweep;
mod trim;
mod unreached;
mod uses;

pub(super) use unreached::without_unreached;

use super::settle::Settled;
use glisten_front::hir::{
    ArraySize, ConstructKind, ExprId, ExprKind, FunctionId, GlobalId, Sampling, Scalar, ScalarValue, Shader, Stmt,
    StmtKind, Storage, Type, TypeId, Types,
};
use glisten_front::source::Span;
use std::collections::BTreeMap;
use uses::Uses;

/// Rounds of pruning a stage: each finds what the one before laid bare. A chain of dead stores goes in one.
const ROUNDS: usize = 8;

/// A pruned stage.
pub(super) struct Pruned {
    /// The stage that is left.
    pub(super) shader: Shader,
    /// For each global of it the one of the original.
    pub(super) globals: Vec<GlobalId>,
    /// For each function of it the one of the original.
    pub(super) origins: Vec<FunctionId>,
    /// How many elements of an array open indices may reach, by the name of the global.
    reach: BTreeMap<String, u32>,
}

/// Prunes a stage. `live` says for each global of the original whether somebody reads it when the stage has ended.
pub(super) fn prune(types: &Types, settled: Settled, live: &[bool]) -> Pruned {
    let globals = (0..settled.shader.globals.len()).map(GlobalId::new).collect();
    let mut shader = settled.shader;
    apart::apart(&mut shader);
    let mut pruned = Pruned { shader, globals, origins: settled.origins, reach: settled.reach };
    pruned.again(types, live);
    pruned
}

impl Pruned {
    /// Prunes what was laid bare by others.
    pub(super) fn again(&mut self, types: &Types, live: &[bool]) {
        for _ in 0..ROUNDS {
            let own: Vec<bool> =
                self.globals.iter().map(|global| live.get(global.index()).copied().unwrap_or(true)).collect();
            let uses = Uses::of(types, &self.shader);
            let swept = sweep::sweep(types, &mut self.shader, &own, uses);
            let mut changed = swept.changed | overwritten_in(types, &mut self.shader, &swept.uses);
            changed |= inline::inline(&mut self.shader);
            changed |= clamped::join(&mut self.shader);
            merge::merge(&mut self.shader);
            changed |= self.compact(types, &own);
            if !changed {
                break;
            }
        }
        for index in 0..self.shader.functions.len() {
            let body = self.shader.functions.get_mut(index).and_then(|function| function.body.take());
            if let Some(mut body) = body {
                declare::join(&self.shader, &mut body);
                if let Some(function) = self.shader.functions.get_mut(index) {
                    function.body = Some(body);
                }
            }
        }
    }

    fn compact(&mut self, types: &Types, live: &[bool]) -> bool {
        let before = (self.shader.globals.len(), self.shader.functions.len(), self.parameters());
        let keeps = |id: GlobalId| {
            let global = self.shader.global(id);
            // An output that is never written is undefined where it is read, and stays to be so.
            let output = global.storage == Storage::Out && live.get(id.index()).copied().unwrap_or(true);
            output && global.builtin.is_none()
        };
        let uses = Uses::of(types, &self.shader);
        let (mut shader, chosen) = compact::compact((types, &self.shader), (&uses, live), &keeps, &mut self.origins);
        for (global, old) in shader.globals.iter_mut().zip(&chosen) {
            if global.storage == Storage::Out
                && global.builtin.is_none()
                && global.block.is_none()
                && !live.get(old.index()).copied().unwrap_or(true)
            {
                // Nobody outside reads it any more.
                global.storage = Storage::Private;
                (global.interpolation_written, global.invariant) = (false, false);
                global.sampling = Sampling::Center;
                (global.location, global.index) = (None, None);
            }
        }
        self.globals = chosen.iter().filter_map(|id| self.globals.get(id.index()).copied()).collect();
        self.shader = shader;
        before != (self.shader.globals.len(), self.shader.functions.len(), self.parameters())
    }

    fn parameters(&self) -> usize {
        self.shader.functions.iter().map(|function| function.param_count).sum()
    }
}

/// Removes stores that are overwritten first from functions.
fn overwritten_in(types: &Types, shader: &mut Shader, uses: &Uses) -> bool {
    let mut changed = false;
    let of_main = overwritten::globals_of_main(shader);
    for id in &uses.functions {
        let Some(body) = shader.functions.get_mut(id.index()).and_then(|function| function.body.take()) else {
            continue;
        };
        let globals = if Some(*id) == shader.main { &of_main[..] } else { &[] };
        let (body, removed) = overwritten::remove(types, (shader, &uses.effects), *id, globals, body);
        changed |= removed;
        if let Some(function) = shader.functions.get_mut(id.index()) {
            function.body = Some(body);
        }
    }
    changed
}

/// Trims the types that the stages share, if it `trims` any, then gives functions their names.
pub(super) fn finish(types: &mut Types, stages: &mut [(Pruned, Vec<bool>)], trims: bool) {
    let mut reach: BTreeMap<String, u32> = BTreeMap::new();
    for (name, elements) in stages.iter().flat_map(|(pruned, _)| &pruned.reach) {
        let known = reach.entry(name.clone()).or_default();
        *known = (*known).max(*elements);
    }
    let rounds = if trims { 3 } else { 0 };
    for _ in 0..rounds {
        let mut shaders: Vec<Shader> = stages.iter().map(|(pruned, _)| pruned.shader.clone()).collect();
        let changed = trim::trim(types, &mut shaders, &reach);
        for ((pruned, live), shader) in stages.iter_mut().zip(shaders) {
            pruned.shader = shader;
            if changed {
                pruned.again(types, live);
            }
        }
        if !changed {
            break;
        }
    }
    for (pruned, _) in stages.iter_mut() {
        merge::name(types, &mut pruned.shader);
        give_results(types, &mut pruned.shader);
    }
}

/// A function whose `return`s are all gone gave nothing that is defined (GLSL 1.50 §6.1); it must still give something.
fn give_results(types: &Types, shader: &mut Shader) {
    for index in 0..shader.functions.len() {
        let Some(function) = shader.functions.get(index) else { continue };
        let (ret, span) = (function.ret, function.span);
        let mut gives = ret == TypeId::VOID;
        shader.visit_statements(function.body.as_deref().unwrap_or(&[]), &mut |stmt| {
            gives |= matches!(stmt.kind, StmtKind::Return(_));
        });
        if gives {
            continue;
        }
        let zero = zero(types, shader, ret, span);
        if let Some(body) = shader.functions.get_mut(index).and_then(|function| function.body.as_mut()) {
            body.push(Stmt { kind: StmtKind::Return(Some(zero)), span });
        }
    }
}

/// 0 of a type.
fn zero(types: &Types, shader: &mut Shader, ty: TypeId, span: Span) -> ExprId {
    let (kind, parts): (ConstructKind, Vec<TypeId>) = match types.get(ty) {
        Type::Struct(id) => {
            (ConstructKind::Struct, types.structure(id).members.iter().map(|member| member.ty).collect())
        }
        Type::Array(element, ArraySize::Sized(size)) => (ConstructKind::Array, vec![element; size as usize]),
        Type::Vector(scalar, _) => (ConstructKind::Splat, vec![TypeId::vector(scalar, 1)]),
        Type::Matrix(..) => (ConstructKind::Diagonal, vec![TypeId::FLOAT]),
        other => {
            let value = match other {
                Type::Scalar(Scalar::Bool) => ScalarValue::Bool(false),
                Type::Scalar(Scalar::Int) => ScalarValue::Int(0),
                Type::Scalar(Scalar::Uint) => ScalarValue::Uint(0),
                _ => ScalarValue::Float(0.0),
            };
            return shader.push(ExprKind::Literal(value), ty, span);
        }
    };
    let parts = parts.into_iter().map(|part| zero(types, shader, part, span)).collect();
    shader.push(ExprKind::Construct(kind, parts), ty, span)
}
