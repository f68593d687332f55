//! Writes what moves: a varying in both stages, its computation at the end of the vertex stage, and its uses.
//!
//! *In:* chosen candidates. *Out:* both stages, changed. *Holds:* the new names are those of the locals that had the values,
//! or of a varying in them; no global of either stage has them.

use super::Move;
use super::affine::Kind;
use super::candidates::{Candidate, Candidates};
use crate::prune::Pruned;
use crate::settle::Settled;
use glisten_front::Program;
use glisten_front::hir::{
    Expr, ExprId, ExprKind, FunctionId, Global, GlobalId, LocalId, Shader, Stmt, StmtKind, Storage, Types, VarRef,
    fresh_name, global_names,
};
use glisten_front::source::Span;
use rustc_hash::FxHashMap;

/// A varying in both stages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) kind: Kind,
    vertex: GlobalId,
}

/// The vertex stage's counterparts of the fragment stage's globals.
pub(super) struct Links {
    varyings: FxHashMap<GlobalId, Link>,
    /// Uniforms and constants that the vertex stage has or may have; `None` if it is still to be declared.
    shared: FxHashMap<GlobalId, Option<GlobalId>>,
}

impl Links {
    /// Those of a program. Varyings in blocks and in arrays are left alone.
    pub(super) fn of(program: &Program, fragment: &Pruned, vertex: &Shader) -> Self {
        let mut links = Self { varyings: FxHashMap::default(), shared: FxHashMap::default() };
        for (id, global) in fragment.shader.globals() {
            let plain = global.builtin.is_none() && global.block.is_none();
            match global.storage {
                Storage::In if plain && program.types.scalar_of(global.ty).is_some() => {
                    if let Some(to) = links.output(program, fragment, vertex, id) {
                        let kind = Kind { interpolation: global.interpolation, sampling: global.sampling };
                        links.varyings.insert(id, Link { kind, vertex: to });
                    }
                }
                Storage::Uniform | Storage::Const if plain && !program.types.contains_sampler(global.ty) => {
                    let known = vertex.globals().find(|(_, other)| other.name == global.name);
                    let same = known.is_none_or(|(_, other)| {
                        other.ty == global.ty && matches!(other.storage, Storage::Uniform | Storage::Const)
                    });
                    if same {
                        links.shared.insert(id, known.map(|(id, _)| id));
                    }
                }
                _ => {}
            }
        }
        links
    }

    /// The output of the vertex stage that a varying of the fragment stage comes from.
    fn output(&self, program: &Program, fragment: &Pruned, vertex: &Shader, id: GlobalId) -> Option<GlobalId> {
        let global = fragment.shader.global(id);
        let original = *fragment.globals.get(id.index())?;
        let declared = program.interface.varyings.iter().find(|one| one.to.is_some_and(|to| to.global == original));
        match declared {
            Some(varying) => Some(varying.from?.global),
            // It was added when something else moved.
            None => {
                let out = vertex.globals().find(|(_, one)| one.storage == Storage::Out && one.name == global.name);
                out.map(|(id, _)| id)
            }
        }
        .filter(|from| vertex.globals.get(from.index()).is_some_and(|one| one.ty == global.ty && one.block.is_none()))
    }

    pub(super) fn varying(&self, id: GlobalId) -> Option<Link> {
        self.varyings.get(&id).copied()
    }

    pub(super) fn is_shared(&self, id: GlobalId) -> bool {
        self.shared.contains_key(&id)
    }
}

/// Whether what is written at the end of `main` is computed for every vertex.
pub(super) fn can_extend(vertex: &Shader) -> bool {
    let Some(main) = vertex.main else { return false };
    let mut returns = false;
    vertex.visit_statements(vertex.function(main).body.as_deref().unwrap_or(&[]), &mut |stmt| {
        returns |= matches!(stmt.kind, StmtKind::Return(_));
    });
    !returns
}

/// Moves the chosen candidates.
pub(super) fn apply(
    types: &Types,
    candidates: &Candidates,
    chosen: &[usize],
    links: &Links,
    fragment: &mut Pruned,
    vertex: &mut Settled,
) -> Vec<Move> {
    let mut moved = Vec::new();
    // All computations are copied before any of them is replaced by its varying.
    let mut work = Vec::new();
    for candidate in chosen.iter().filter_map(|index| candidates.list.get(*index)) {
        let Some((function, id, _)) = candidate.places.first().copied() else { continue };
        let mut copy = Copy { candidates, links, from: &fragment.shader, to: &mut vertex.shader, function };
        let value = copy.expr(id);
        let Some(model) = model(candidate, links, fragment) else { continue };
        let name = name(types, candidate, &fragment.shader, &vertex.shader, &moved);
        moved.push(Move { name: name.clone(), span: fragment.shader.expr(id).span });
        work.push((candidate, value, model, name));
    }
    for (candidate, value, model, name) in work {
        let Some((_, id, _)) = candidate.places.first().copied() else { continue };
        let ty = fragment.shader.expr(id).ty;
        let global = Global { name, ty, span: Span::default(), location: None, invariant: false, ..model };
        store(&mut vertex.shader, Global { storage: Storage::Out, ..global.clone() }, value);
        let input = GlobalId::new(fragment.shader.globals.len());
        fragment.shader.globals.push(Global { storage: Storage::In, ..global });
        // No global of the original is behind it.
        fragment.globals.push(GlobalId::new(u32::MAX as usize));
        for (_, id, local) in &candidate.places {
            replace(&mut fragment.shader, *id, input);
            if let Some((function, local)) = local {
                replace_local(&mut fragment.shader, *function, *local, input);
            }
        }
    }
    moved
}

/// A varying of the same interpolation.
fn model(candidate: &Candidate, links: &Links, fragment: &Pruned) -> Option<Global> {
    let first = candidate.base.filter(|id| links.varying(*id).is_some())?;
    fragment.shader.globals.get(first.index()).cloned()
}

fn store(vertex: &mut Shader, global: Global, value: ExprId) {
    let (ty, span) = (global.ty, Span::default());
    let id = GlobalId::new(vertex.globals.len());
    vertex.globals.push(global);
    let target = vertex.push(ExprKind::Var(VarRef::Global(id)), ty, span);
    let assign = vertex.push(ExprKind::Assign(None, target, value), ty, span);
    let Some(main) = vertex.main else { return };
    if let Some(body) = vertex.functions.get_mut(main.index()).and_then(|function| function.body.as_mut()) {
        body.push(Stmt { kind: StmtKind::Expr(assign), span });
    }
}

fn replace(shader: &mut Shader, id: ExprId, input: GlobalId) {
    if let Some(expr) = shader.exprs.get_mut(id.index()) {
        expr.kind = ExprKind::Var(VarRef::Global(input));
    }
}

/// The varying in the place of a local that had its value.
fn replace_local(shader: &mut Shader, function: FunctionId, local: LocalId, input: GlobalId) {
    let mut uses = Vec::new();
    shader.visit_body(shader.function(function).body.as_deref().unwrap_or(&[]), &mut |id| {
        if matches!(shader.expr(id).kind, ExprKind::Var(VarRef::Local(named)) if named == local) {
            uses.push(id);
        }
    });
    for id in uses {
        replace(shader, id, input);
    }
}

/// A name that says where the value comes from.
fn name(types: &Types, candidate: &Candidate, fragment: &Shader, vertex: &Shader, moved: &[Move]) -> String {
    let local = candidate
        .places
        .iter()
        .find_map(|(_, _, local)| local.map(|(function, local)| fragment.function(function).local(local).name.clone()));
    let varying = candidate.base.map(|id| fragment.global(id).name.clone());
    let wanted = local.or_else(|| varying.map(|name| format!("{name}_affine"))).unwrap_or_else(|| "affine".into());
    let taken: Vec<_> = [fragment, vertex].into_iter().map(|shader| global_names(types, shader, |_| false)).collect();
    fresh_name(&wanted, |name| {
        taken.iter().any(|names| names.contains(name))
            || moved.iter().any(|one| one.name == name)
            || types.ids().any(|ty| types.name(ty) == name)
    })
}

/// Copies an expression into the vertex stage.
struct Copy<'a> {
    candidates: &'a Candidates,
    links: &'a Links,
    from: &'a Shader,
    to: &'a mut Shader,
    function: FunctionId,
}

impl Copy<'_> {
    fn expr(&mut self, id: ExprId) -> ExprId {
        let Expr { mut kind, ty, span } = self.from.expr(id).clone();
        match &mut kind {
            ExprKind::Var(VarRef::Local(local)) => {
                if let Some((function, value)) = self.candidates.names.get(&(self.function, *local)) {
                    let here = std::mem::replace(&mut self.function, *function);
                    let copy = self.expr(*value);
                    self.function = here;
                    return copy;
                }
            }
            ExprKind::Var(VarRef::Global(global)) => *global = self.global(*global),
            _ => kind.for_each_operand(&mut |child| *child = self.expr(*child)),
        }
        self.to.push(kind, ty, span)
    }

    /// The vertex stage's global; a uniform that it lacks is declared.
    fn global(&mut self, id: GlobalId) -> GlobalId {
        if let Some(link) = self.links.varying(id) {
            return link.vertex;
        }
        let global = self.from.global(id);
        let shared = self.links.shared.get(&id).copied().flatten();
        let known = shared.or_else(|| Some(self.to.globals().find(|(_, other)| other.name == global.name)?.0));
        if let Some(known) = known {
            self.settle(known, global);
            return known;
        }
        self.to.globals.push(Global { initializer: None, ..global.clone() });
        GlobalId::new(self.to.globals.len() - 1)
    }

    /// A uniform that is a constant in the fragment stage is one in the vertex stage, too, if nothing there reads it.
    fn settle(&mut self, known: GlobalId, constant: &Global) {
        let names = |expr: &Expr| matches!(expr.kind, ExprKind::Var(VarRef::Global(named)) if named == known);
        if constant.storage != Storage::Const || self.to.exprs.iter().any(names) {
            return;
        }
        if let Some(global) = self.to.globals.get_mut(known.index()).filter(|one| one.storage == Storage::Uniform) {
            *global = Global { initializer: None, ..constant.clone() };
        }
    }
}
