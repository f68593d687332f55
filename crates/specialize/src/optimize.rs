//! [`optimize`]: a program without what reaches no output, whatever its host sets.
//!
//! *In:* a linked program. *Out:* the same program without functions, statements, varyings, attributes, uniforms and
//! samplers that nothing drawn depends on, as drivers leave them out of what is active (OpenGL 3.2 §2.11.3, §2.11.4); and on
//! request the list of what that was.
//!
//! *Holds:* the interface has the same rows with the same locations, offsets and bindings, in the same order. Only `active`
//! changes, and only from yes to no. Blocks keep their layout. Nothing is evaluated.

use crate::account::{self, How, LeftOut};
use crate::known::Known;
use crate::left::Left;
use crate::prune;
use glisten_front::Program;
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, Types};
use glisten_front::link::Interface;
use glisten_front::source::SourceMap;

/// Leaves out of a program what reaches no output.
pub fn optimize(program: &Program) -> Program {
    optimize_by(program, &without_unreached)
}

/// A stage without what reaches none of its outputs that are `live`, by their globals.
pub fn without_unreached(types: &Types, shader: &Shader, live: &[bool]) -> Shader {
    shader.on_stack(|| prune::without_unreached(types, shader, live))
}

/// Optimizes like [`optimize`], by a function that does what [`without_unreached`] does: one that remembers stages, say.
pub fn optimize_by(program: &Program, prune: &dyn Fn(&Types, &Shader, &[bool]) -> Shader) -> Program {
    // What a geometry stage reads is its own affair: no target has one.
    let linked = program.stage(Stage::Geometry).is_none();
    let fragment = program.stage(Stage::Fragment).map(|shader| {
        let live: Vec<bool> = shader.globals.iter().map(|global| global.storage == Storage::Out).collect();
        prune(&program.types, shader, &live)
    });
    let vertex = program.stage(Stage::Vertex).map(|shader| {
        let reader = fragment.as_ref().filter(|_| linked);
        let live: Vec<bool> =
            shader.globals().map(|(id, global)| is_read(&program.interface, (id, global), reader)).collect();
        prune(&program.types, shader, &live)
    });
    let mut interface = program.interface.clone();
    if linked {
        drop_varyings(&mut interface, fragment.as_ref());
    }
    let (mut vertex, mut fragment) = (vertex, fragment);
    let stages = program.stages.iter().map(|shader| {
        let pruned = match shader.stage {
            Stage::Vertex => vertex.take(),
            Stage::Fragment => fragment.take(),
            Stage::Geometry => None,
        };
        pruned.unwrap_or_else(|| shader.clone())
    });
    let (name, types, stages) = (program.name.clone(), program.types.clone(), stages.collect());
    let mut optimized = Program { name, types, stages, interface };
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

/// What [`optimize`] left out, in the order of the source, told as it is of a residual.
pub fn left_out(program: &Program, optimized: &Program, sources: Option<&SourceMap>) -> Vec<LeftOut> {
    let how = How { known: &Known::default(), reasons: &[], moved: &[] };
    let left = Left::active(&optimized.stages, &optimized.interface);
    let mut list = account::left_out(program, sources, &how, &left);
    list.sort_by_key(|one| (one.span.start, one.what));
    list
}
