//! [`optimize`]: a program without what reaches no output, whatever its host sets.
//!
//! *In:* a linked program. *Out:* the same program without functions, statements, varyings, attributes, uniforms and
//! samplers that nothing drawn depends on, as drivers leave them out of what is active (OpenGL 3.2 §2.11.3, §2.11.4); and on
//! request the list of what that was.
//!
//! *Holds:* the interface has the same rows with the same locations, offsets and bindings, in the same order. Only `active`
//! changes, and only from yes to no. Blocks keep their layout. Nothing is evaluated.

use crate::account::{Kind, LeftOut};
use crate::prune;
use glisten_front::Program;
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Stmt, StmtKind, Storage};
use glisten_front::link::Interface;
use glisten_front::source::{SourceMap, Span};
use rustc_hash::FxHashSet;
use std::collections::BTreeSet;

/// Leaves out of a program what reaches no output.
pub fn optimize(program: &Program) -> Program {
    let mut optimized = program.clone();
    // What a geometry stage reads is its own affair: no target has one.
    let linked = program.stage(Stage::Geometry).is_none();
    let fragment = program.stage(Stage::Fragment).map(|shader| {
        let live: Vec<bool> = shader.globals.iter().map(|global| global.storage == Storage::Out).collect();
        prune::without_unreached(&program.types, shader, &live)
    });
    let vertex = program.stage(Stage::Vertex).map(|shader| {
        let reader = fragment.as_ref().filter(|_| linked);
        let live: Vec<bool> =
            shader.globals().map(|(id, global)| is_read(&program.interface, (id, global), reader)).collect();
        prune::without_unreached(&program.types, shader, &live)
    });
    for shader in &mut optimized.stages {
        let pruned = match shader.stage {
            Stage::Vertex => &vertex,
            Stage::Fragment => &fragment,
            Stage::Geometry => &None,
        };
        if let Some(pruned) = pruned {
            shader.clone_from(pruned);
        }
    }
    if linked {
        drop_varyings(&mut optimized.interface, fragment.as_ref());
    }
    mark_active(&mut optimized);
    optimized
}

/// Whether an output of the vertex stage is read behind it. Without a fragment stage anybody may read it.
fn is_read(interface: &Interface, (id, global): (GlobalId, &Global), reader: Option<&Shader>) -> bool {
    let Some(reader) = reader.filter(|_| global.storage == Storage::Out && global.builtin.is_none()) else {
        return global.storage == Storage::Out;
    };
    interface.varyings.iter().any(|varying| {
        varying.from.is_some_and(|from| from.global == id) && varying.to.is_some_and(|to| uses(reader, to.global))
    })
}

fn uses(shader: &Shader, global: GlobalId) -> bool {
    shader.globals.get(global.index()).is_some_and(|global| global.used)
}

/// Varyings that the fragment stage does not read connect nothing. Their locations stay theirs.
fn drop_varyings(interface: &mut Interface, fragment: Option<&Shader>) {
    let Some(fragment) = fragment else { return };
    for varying in &mut interface.varyings {
        if !varying.to.is_some_and(|to| uses(fragment, to.global)) {
            (varying.active, varying.from, varying.to) = (false, None, None);
        }
    }
}

/// What no stage uses any more is not active.
fn mark_active(program: &mut Program) {
    let Program { stages, interface, .. } = program;
    let used = |stage: Stage, id: GlobalId| stages.iter().any(|shader| shader.stage == stage && uses(shader, id));
    for attribute in &mut interface.attributes {
        attribute.active &= used(Stage::Vertex, attribute.global);
    }
    for root in &mut interface.roots {
        root.active &= root.globals.iter().any(|(stage, id)| used(*stage, *id));
    }
    for leaf in &mut interface.uniforms {
        leaf.active &= interface.roots.get(leaf.root.0 as usize).is_some_and(|root| root.active);
    }
    for block in &mut interface.blocks {
        block.active &= interface.roots.get(block.root.0 as usize).is_some_and(|root| root.active);
    }
    for sampler in &mut interface.samplers {
        sampler.active &= sampler.globals.iter().any(|(stage, id)| used(*stage, *id));
    }
}

/// What [`optimize`] left out, in the order of the source.
pub fn left_out(program: &Program, optimized: &Program, sources: Option<&SourceMap>) -> Vec<LeftOut> {
    let mut list = List { sources, list: Vec::new() };
    for shader in &program.stages {
        if let Some(left) = optimized.stage(shader.stage) {
            list.stage(shader, left);
        }
    }
    list.interface(program, optimized);
    list.list.sort_by_key(|one| (one.span.start, one.what));
    list.list
}

struct List<'a> {
    sources: Option<&'a SourceMap>,
    list: Vec<LeftOut>,
}

impl List<'_> {
    fn tell(&mut self, what: Kind, name: String, span: Span, because: &str) {
        let place = self.sources.and_then(|sources| {
            let place = sources.location(span)?;
            Some((sources.file(place.file).name().to_owned(), place.line))
        });
        let (file, line) = place.unwrap_or_default();
        self.list.push(LeftOut { what, name, file, line, because: because.to_owned(), span, extent: span });
    }

    /// The first line of the text of a span.
    fn text(&self, span: Span) -> String {
        let text = self.sources.map_or("", |sources| sources.snippet(span));
        text.lines().next().unwrap_or("").trim().to_owned()
    }

    fn stage(&mut self, shader: &Shader, left: &Shader) {
        let kept: FxHashSet<Span> = left.functions.iter().map(|function| function.span).collect();
        let mut statements: FxHashSet<Span> = FxHashSet::default();
        for function in &left.functions {
            let body = function.body.as_deref().unwrap_or(&[]);
            left.visit_statements(body, &mut |stmt| {
                statements.insert(stmt.span);
            });
        }
        for function in shader.functions.iter().filter(|function| function.body.is_some()) {
            if kept.contains(&function.span) {
                self.body(shader, function.body.as_deref().unwrap_or(&[]), &statements);
            } else {
                let because = if function.reachable { "no call of it is left" } else { "`main` never calls it" };
                self.tell(Kind::Function, function.name.clone(), function.span, because);
            }
        }
    }

    fn body(&mut self, shader: &Shader, body: &[Stmt], kept: &FxHashSet<Span>) {
        for stmt in body {
            let bodies = stmt.kind.bodies();
            let mut inside = false;
            for body in &bodies {
                shader.visit_statements(body, &mut |stmt| inside |= kept.contains(&stmt.span));
            }
            // Of a declaration the type may be on the line above: its name is what is told.
            let declares = matches!(stmt.kind, StmtKind::Local(_, None));
            let jumps = matches!(stmt.kind, StmtKind::Break | StmtKind::Continue | StmtKind::Return(None));
            if inside || kept.contains(&stmt.span) {
                bodies.into_iter().for_each(|body| self.body(shader, body, kept));
            } else if !declares && !jumps {
                let what = match stmt.kind {
                    StmtKind::Loop { .. } => Kind::Loop,
                    StmtKind::If { .. } | StmtKind::Switch { .. } => Kind::Branch,
                    _ => Kind::Statement,
                };
                self.tell(what, self.text(stmt.span), stmt.span, "nothing reads what it computes");
            }
        }
    }

    fn interface(&mut self, program: &Program, optimized: &Program) {
        let (old, new) = (&program.interface, &optimized.interface);
        let place = |stage: Stage, id: GlobalId| {
            let global = program.stage(stage).and_then(|shader| shader.globals.get(id.index()));
            global.map_or_else(Span::default, |global| global.span)
        };
        let first = |globals: &[(Stage, GlobalId)]| {
            globals.first().map_or_else(Span::default, |(stage, id)| place(*stage, *id))
        };
        for (old, new) in old.attributes.iter().zip(&new.attributes).filter(|(_, new)| !new.active) {
            let because = because(old.active, "the vertex stage never reads it");
            self.tell(Kind::Attribute, new.name.clone(), place(Stage::Vertex, old.global), because);
        }
        let mut told: BTreeSet<(Stage, GlobalId)> = BTreeSet::new();
        for (old, _) in old.varyings.iter().zip(&new.varyings).filter(|(_, new)| !new.active) {
            let end = old.to.map(|to| (Stage::Fragment, to.global));
            let end = end.or(old.from.map(|from| (Stage::Vertex, from.global)));
            let Some((stage, id)) = end.filter(|end| told.insert(*end)) else { continue };
            let because = because(old.active, "the fragment stage never reads it");
            self.tell(Kind::Varying, old.name.clone(), place(stage, id), because);
        }
        for (old, new) in old.roots.iter().zip(&new.roots).filter(|(_, new)| !new.active) {
            let what = if old.block.is_some() { Kind::Block } else { Kind::Uniform };
            self.tell(what, new.name.clone(), first(&old.globals), because(old.active, "no stage reads it"));
        }
        for (old, new) in old.samplers.iter().zip(&new.samplers).filter(|(_, new)| !new.active) {
            self.tell(Kind::Texture, new.name.clone(), first(&old.globals), because(old.active, "no stage reads it"));
        }
        self.unread_outputs(program, old);
    }

    /// Outputs of the vertex stage that the fragment stage does not declare: no varying stands for them.
    fn unread_outputs(&mut self, program: &Program, interface: &Interface) {
        let (Some(vertex), Some(_)) = (program.stage(Stage::Vertex), program.stage(Stage::Fragment)) else { return };
        let linked = program.stage(Stage::Geometry).is_none();
        for (id, global) in vertex.globals().filter(|(_, global)| linked && is_plain_output(global)) {
            if !interface.varyings.iter().any(|varying| varying.from.is_some_and(|from| from.global == id)) {
                let because = "the fragment stage does not declare it";
                self.tell(Kind::Varying, global.name.clone(), global.span, because);
            }
        }
    }
}

fn is_plain_output(global: &Global) -> bool {
    global.storage == Storage::Out && global.builtin.is_none()
}

fn because(was_active: bool, never: &'static str) -> &'static str {
    if was_active { "it reaches no output" } else { never }
}
