//! Shading at the vertices: the fragment stage's computation moves to the vertex stage, and its color is interpolated.
//!
//! *In:* a scene and one of its draws. *Out:* the scene whose draw computes its colors at the vertices (the textbook's
//! section 10.2.1, "Gouraud shading"). *Holds:* the fragment stage may read only varyings and uniforms: a draw whose
//! fragments look up textures, take derivatives, are discarded, or depend on anything of the rasterizer is left alone.

use super::edit::{Edited, rebuilt, with_draw};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{
    ExprKind, FunctionId, Global, GlobalId, Interpolation, Sampling, Scalar, Shader, StmtKind, Storage, Types, VarRef,
    all_names, fresh_name,
};
use glisten_front::link::{Program, Remap};
use glisten_scene::Scene;
use std::fmt::Write;

/// The scene whose draw shades its vertices.
pub(super) fn at_vertices(scene: &Scene, index: usize) -> Option<Scene> {
    let draw = scene.draws.get(index)?;
    let mut edited = Edited::of(draw)?;
    let fragment = edited.fragment.shader.clone();
    if !depends_on_varyings_alone(&edited.types, &fragment, &draw.program) || !computes(&fragment) {
        return None;
    }
    let types = edited.types.clone();
    let place = edited.vertex.renamed_main(&types, "place_vertex")?;
    let interpolation = interpolation(&draw.program);
    let vertex = &mut edited.vertex.shader;
    let mut moved = Move { program: &draw.program, fragment: &fragment, vertex, outputs: Vec::new(), interpolation };
    let shade = moved.apply()?;
    let outputs = moved.outputs;
    let _ = write!(edited.vertex.appended, "\nvoid main() {{\n    {place}();\n    {shade}();\n}}\n");
    let vertex = edited.vertex.text(&types);
    let fragment = passing(&types, &outputs, interpolation);
    with_draw(scene, index, rebuilt(draw, &[vertex, fragment])?)
}

/// The interpolation of the colors: that of the varyings they are computed from, or with perspective if these differ.
fn interpolation(program: &Program) -> Interpolation {
    let mut read =
        program.interface.varyings.iter().filter(|varying| varying.active && varying.to.is_some()).peekable();
    let some = read.peek().is_some();
    let screen = read.all(|varying| varying.interpolation == Interpolation::Noperspective);
    if some && screen { Interpolation::Noperspective } else { Interpolation::Smooth }
}

/// An output of the fragment stage, and the varying that carries it.
struct Carried {
    output: Global,
    varying: String,
}

/// The fragment stage that is left: each output is its varying.
fn passing(types: &Types, outputs: &[Carried], interpolation: Interpolation) -> String {
    let mut text = String::from("#version 150\n\n");
    let word = if interpolation == Interpolation::Noperspective { "noperspective " } else { "" };
    for Carried { output, varying } in outputs {
        let ty = types.name(output.ty);
        let _ = writeln!(text, "{word}in {ty} {varying};");
        if output.builtin.is_none() {
            let _ = writeln!(text, "out {ty} {};", output.name);
        }
    }
    text.push_str("\nvoid main() {\n");
    for Carried { output, varying } in outputs {
        let _ = writeln!(text, "    {} = {varying};", output.name);
    }
    text + "}\n"
}

/// The parts of a stage that `main` reaches.
fn reached(shader: &Shader) -> Vec<FunctionId> {
    shader.main.map(|main| shader.callees_first(main)).unwrap_or_default()
}

/// Whether the stage can run at a vertex with the same result there.
fn depends_on_varyings_alone(types: &Types, shader: &Shader, program: &Program) -> bool {
    let inputs = program.interface.varyings.iter().filter(|varying| varying.active && varying.to.is_some());
    let interpolated = inputs.clone().all(|varying| {
        varying.interpolation != Interpolation::Flat
            && varying.sampling == Sampling::Center
            && varying.from.is_some()
            && types.scalar_of(varying.ty) == Some(Scalar::Float)
    });
    let mut plain = interpolated && program.interface.outputs.iter().all(|output| output.index == 0);
    for id in reached(shader) {
        let body = shader.function(id).body.as_deref().unwrap_or(&[]);
        shader.visit_statements(body, &mut |stmt| plain &= !matches!(stmt.kind, StmtKind::Discard));
        shader.visit_body(body, &mut |expr| {
            plain &= match &shader.expr(expr).kind {
                ExprKind::Var(VarRef::Global(global)) => is_movable(types, shader.global(*global)),
                ExprKind::BuiltinCall(function, _) => {
                    function.follows_from_arguments() || function.written_argument().is_some()
                }
                _ => true,
            };
        });
    }
    plain
}

fn is_movable(types: &Types, global: &Global) -> bool {
    let floats = types.scalar_of(global.ty) == Some(Scalar::Float);
    match (global.storage, global.builtin) {
        (Storage::In, None) => global.block.is_none(),
        (Storage::In, Some(_)) => false,
        (Storage::Out, None) => global.block.is_none() && floats,
        (Storage::Out, Some(builtin)) => builtin == BuiltinVariable::FragColor,
        (Storage::Uniform, Some(_)) => false,
        (Storage::Uniform, None) => !types.contains_sampler(global.ty),
        _ => true,
    }
}

/// Whether the stage does more than pass on what it is given.
fn computes(shader: &Shader) -> bool {
    let mut operations = 0;
    for id in reached(shader) {
        shader.visit_body(shader.function(id).body.as_deref().unwrap_or(&[]), &mut |expr| {
            operations += usize::from(matches!(
                shader.expr(expr).kind,
                ExprKind::Binary(..) | ExprKind::BuiltinCall(..) | ExprKind::Unary(..)
            ));
        });
    }
    operations > 0
}

/// The move of a fragment stage to a vertex stage.
struct Move<'a> {
    program: &'a Program,
    fragment: &'a Shader,
    vertex: &'a mut Shader,
    outputs: Vec<Carried>,
    interpolation: Interpolation,
}

impl Move<'_> {
    /// Appends the fragment stage to the vertex stage, whose varyings become variables; the name of the function that was
    /// its `main`.
    fn apply(&mut self) -> Option<String> {
        let exprs = self.vertex.exprs.len() as u32;
        let mut remap = Remap { exprs, globals: Vec::new(), functions: self.functions() };
        for (id, global) in self.fragment.globals() {
            let to = self.global(id, global, &remap)?;
            remap.globals.push(to);
        }
        self.hide_varyings()?;
        self.vertex.exprs.extend(self.fragment.exprs.iter().map(|expr| remap.expr(expr.clone())));
        let main = self.fragment.main?;
        let mut renamed: Vec<(String, String)> = Vec::new();
        for id in reached(self.fragment) {
            let mut function = self.fragment.function(id).clone();
            function.body.as_mut().into_iter().for_each(|body| remap.body(body));
            let wanted = if id == main { "shade" } else { function.name.as_str() };
            let known = renamed.iter().find(|(old, _)| *old == function.name).map(|(_, new)| new.clone());
            let name = known.unwrap_or_else(|| self.fresh(wanted));
            renamed.push((std::mem::replace(&mut function.name, name.clone()), name));
            self.vertex.functions.push(function);
        }
        renamed.pop().map(|(_, name)| name)
    }

    /// The new handles of the functions that are appended.
    fn functions(&self) -> Vec<FunctionId> {
        let mut list: Vec<FunctionId> = self.fragment.functions().map(|(id, _)| id).collect();
        for (place, id) in (self.vertex.functions.len()..).zip(reached(self.fragment)) {
            if let Some(slot) = list.get_mut(id.index()) {
                *slot = FunctionId::new(place);
            }
        }
        list
    }

    /// The vertex stage's counterpart of a global.
    fn global(&mut self, id: GlobalId, global: &Global, remap: &Remap) -> Option<GlobalId> {
        let initializer = global.initializer.map(|id| remap.expr_id(id));
        let varyings = &self.program.interface.varyings;
        match (global.storage, global.builtin) {
            (Storage::In, None) => {
                let linked = varyings.iter().find(|one| one.to.is_some_and(|to| to.global == id));
                match linked.and_then(|varying| varying.from) {
                    Some(from) => (self.vertex.global(from.global).ty == global.ty).then_some(from.global),
                    // Nobody reads it.
                    None => Some(self.added(variable(global, global.name.clone(), Storage::Private))),
                }
            }
            (Storage::Out, _) => {
                let varying = self.fresh("shaded");
                self.outputs.push(Carried { output: global.clone(), varying: varying.clone() });
                let carried = Global {
                    interpolation: self.interpolation,
                    interpolation_written: self.interpolation != Interpolation::Smooth,
                    ..variable(global, varying, Storage::Out)
                };
                Some(self.added(carried))
            }
            (Storage::Uniform, _) => {
                let name = global.match_name();
                let same = self.vertex.globals().find(|(_, one)| one.match_name() == name);
                match same {
                    Some((id, one)) => (one.storage == Storage::Uniform && one.ty == global.ty).then_some(id),
                    None if self.vertex.functions.iter().any(|function| function.name == name) => None,
                    None => Some(self.added(Global { initializer, ..global.clone() })),
                }
            }
            _ => Some(self.added(Global { initializer, ..global.clone() })),
        }
    }

    /// Leaves no varyings but the colors.
    fn hide_varyings(&mut self) -> Option<()> {
        for global in &mut self.vertex.globals {
            let kept = self.outputs.iter().any(|carried| carried.varying == global.name);
            if global.storage != Storage::Out || global.builtin.is_some() || kept {
                continue;
            }
            global.block.is_none().then_some(())?;
            *global = variable(global, global.name.clone(), Storage::Private);
        }
        Some(())
    }

    fn added(&mut self, global: Global) -> GlobalId {
        self.vertex.globals.push(global);
        GlobalId::new(self.vertex.globals.len() - 1)
    }

    /// A name that neither stage has.
    fn fresh(&self, wanted: &str) -> String {
        let types = &self.program.types;
        let taken = [&*self.vertex, self.fragment].map(|shader| all_names(types, shader));
        fresh_name(wanted, |name| taken.iter().any(|names| names.contains(name)))
    }
}

/// A variable like a global, without what only an interface has.
fn variable(global: &Global, name: String, storage: Storage) -> Global {
    Global {
        name,
        storage,
        builtin: None,
        interpolation: Interpolation::Smooth,
        interpolation_written: false,
        sampling: Sampling::Center,
        invariant: false,
        location: None,
        host_location: None,
        component: None,
        index: None,
        initializer: None,
        value: None,
        ..global.clone()
    }
}
