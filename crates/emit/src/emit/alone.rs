//! [`interface_of`]: the facts that the code of one stage depends on, so that programs whose other stages differ may share it.
//!
//! *In:* a linked program, a stage, a target. *Out:* the part of its [`Interface`] that the stage is written from. *Holds:* a program of
//! this stage alone, with that interface and the same types, is written as the same bytes.

use crate::target::Target;
use glisten_front::hir::{GlobalId, Stage};
use glisten_front::link::{Interface, Program, Varying, VaryingEnd};

/// The interface that a stage of a program is written from; none if other stages matter besides, as they do in GLSL.
///
/// Without the facts that [`reflect`](crate::reflect) alone tells.
pub fn interface_of(program: &Program, stage: Stage, target: Target) -> Option<Interface> {
    if !target.capabilities().is_written_by_stage || program.stage(Stage::Geometry).is_some() {
        return None;
    }
    let (is_vertex, whole) = (stage == Stage::Vertex, &program.interface);
    let own = |globals: &[(Stage, GlobalId)]| globals.iter().copied().filter(|(of, _)| *of == stage).collect();
    let seen = |varying: &Varying| seen_by(varying.clone(), is_vertex);
    let mut part = Interface {
        attributes: if is_vertex { whole.attributes.clone() } else { Vec::new() },
        geometry_inputs: Vec::new(),
        varyings: whole.varyings.iter().map(seen).collect(),
        clip_distances: whole.clip_distances.iter().map(seen).collect(),
        outputs: if is_vertex { Vec::new() } else { whole.outputs.clone() },
        blocks: whole.blocks.clone(),
        loose: whole.loose,
        framebuffer_height: whole.framebuffer_height,
        roots: whole.roots.clone(),
        uniforms: Vec::new(),
        samplers: whole.samplers.clone(),
    };
    part.attributes.iter_mut().for_each(|attribute| attribute.active = false);
    for block in &mut part.blocks {
        (block.unit, block.active) = (None, false);
    }
    for root in &mut part.roots {
        (root.globals, root.default, root.active) = (own(&root.globals), None, false);
    }
    for sampler in &mut part.samplers {
        (sampler.globals, sampler.unit, sampler.active) = (own(&sampler.globals), None, false);
    }
    Some(part)
}

/// A varying as the stage at one of its ends has it. Of the other end, only whether there is one matters.
fn seen_by(mut varying: Varying, is_vertex: bool) -> Varying {
    let other = if is_vertex { &mut varying.to } else { &mut varying.from };
    *other = other.map(|_| VaryingEnd { global: GlobalId::new(0), flat_offset: 0 });
    varying.active = false;
    varying
}

#[cfg(test)]
mod tests {
    use super::interface_of;
    use crate::{Conventions, Target, emit_traced};
    use glisten_front::{Compiler, Options, Program, Source, Stage};
    use std::fs;
    use std::path::Path;

    /// The programs of the fixtures that have a vertex and a fragment shader and no includes.
    fn programs() -> Vec<(glisten_front::Compilation, Program)> {
        let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures");
        let entries = |folder: &str| fs::read_dir(fixtures.join(folder)).expect("a folder");
        let folders = ["programs", "lower", "build", "readme", "tutorial"].into_iter().flat_map(entries);
        let mut paths: Vec<_> = folders.map(|entry| entry.expect("one").path()).collect();
        paths.sort();
        let vertices = paths.into_iter().filter(|path| path.extension().is_some_and(|end| end == "vert"));
        let compiled = vertices.filter_map(|path| {
            let source = |path: &Path, stage| {
                let text = fs::read_to_string(path).ok()?;
                Some(Source { name: path.display().to_string(), text: text.into(), stage })
            };
            let fragment = source(&path.with_extension("frag"), Stage::Fragment)?;
            let sources = [source(&path, Stage::Vertex)?, fragment];
            let compilation = Compiler::new(Options::default()).compile(&sources);
            let program = compilation.program.clone()?;
            Some((compilation, program))
        });
        compiled.collect()
    }

    #[test]
    fn a_stage_alone_is_written_as_in_its_program() {
        let programs = programs();
        assert!(programs.len() > 8, "{} programs", programs.len());
        for (compilation, program) in &programs {
            for (stage, target) in [Stage::Vertex, Stage::Fragment].into_iter().flat_map(|stage| {
                [Target::Spirv, Target::Wgsl, Target::Msl, Target::Hlsl].map(|target| (stage, target))
            }) {
                let Some(interface) = interface_of(program, stage, target) else { continue };
                let stages = program.stages.iter().filter(|shader| shader.stage == stage).cloned().collect();
                let alone = Program { stages, interface, ..program.clone() };
                let emitted = |program: &Program| {
                    let conventions = Conventions::default();
                    emit_traced(program, stage, target, &conventions, Some(&compilation.sources))
                        .ok()
                        .map(|traced| traced.emitted)
                };
                assert!(emitted(program) == emitted(&alone), "{} {stage:?} {target:?}", program.name);
            }
        }
    }
}
