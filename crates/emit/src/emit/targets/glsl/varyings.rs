//! Gives both ends of a varying one name: before GLSL 4.10 texts cannot tell the locations of varyings, so names match them
//! (GLSL 1.50 §4.3.6). In the source they may match by location (GLSL 4.10 §4.3.6.1), and the fragment stage of the compatibility profile reads
//! `gl_FrontColor` as `gl_Color`.
//!
//! *In:* a copy of a stage, and its program. *Out:* the same stage with other names. *Holds:* the names depend on the program alone, so that
//! its stages agree. Both ends have the name of the output, unless something else in either stage has that name.

use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, fresh_name, global_names};
use glisten_front::link::Program;
use std::collections::BTreeSet;

/// An end of a varying.
type End = (Stage, GlobalId);

/// Gives the varyings of a stage the names that match, and before 4.10 no locations.
pub(super) fn match_by_name(shader: &mut Shader, program: &Program) {
    let stage = shader.stage;
    if shader.version.number < 410 {
        let varyings = shader.globals.iter_mut().filter(|global| is_varying(stage, global.storage));
        varyings.for_each(|global| global.location = None);
    }
    for (ends, name) in common_names(program) {
        for (_, id) in ends.into_iter().filter(|end| end.0 == stage) {
            if let Some(global) = shader.globals.get_mut(id.index()) {
                global.name.clone_from(&name);
            }
        }
    }
}

fn is_varying(stage: Stage, storage: Storage) -> bool {
    match storage {
        Storage::In => stage != Stage::Vertex,
        Storage::Out => stage != Stage::Fragment,
        Storage::Const | Storage::Private | Storage::Uniform => false,
    }
}

/// The varyings whose ends have two names, with the common ones.
fn common_names(program: &Program) -> Vec<([End; 2], String)> {
    let renamed = renamed(program);
    let ends: BTreeSet<End> = renamed.iter().flatten().copied().collect();
    let mut taken: Vec<(Stage, BTreeSet<String>)> = program
        .stages
        .iter()
        .map(|shader| (shader.stage, global_names(&program.types, shader, |id| ends.contains(&(shader.stage, id)))))
        .collect();
    let mut names = Vec::new();
    for pair in renamed {
        let Some(wanted) = global(program, pair[0]).map(|global| global.name.clone()) else { continue };
        let is_taken = |name: &str| {
            let of_pair = taken.iter().filter(|(stage, _)| pair.iter().any(|end| end.0 == *stage));
            of_pair.into_iter().any(|(_, names)| names.contains(name))
        };
        let name = fresh_name(&wanted, is_taken);
        for (_, names) in taken.iter_mut().filter(|(stage, _)| pair.iter().any(|end| end.0 == *stage)) {
            names.insert(name.clone());
        }
        names.push((pair, name));
    }
    names
}

/// The varyings whose ends have two names; blocks match by the names of the blocks.
fn renamed(program: &Program) -> Vec<[End; 2]> {
    let before = program.stages.iter().rev().map(|shader| shader.stage).find(|stage| *stage != Stage::Fragment);
    let interface = &program.interface;
    let to_geometry = interface.geometry_inputs.iter();
    let to_geometry = to_geometry.map(|row| [(Stage::Vertex, row.from.global), (Stage::Geometry, row.to.global)]);
    let to_fragment = interface.varyings.iter().filter_map(|row| {
        let (from, to) = (row.from?.global, row.to?.global);
        Some([(before?, from), (Stage::Fragment, to)])
    });
    let mut pairs: Vec<[End; 2]> = Vec::new();
    for pair in to_geometry.chain(to_fragment) {
        let [Some(from), Some(to)] = pair.map(|end| global(program, end)) else { continue };
        let is_renamed =
            from.name != to.name && [from, to].iter().all(|global| global.block.is_none() && global.builtin.is_none());
        // A varying of several columns or elements has a row for each.
        if is_renamed && !pairs.contains(&pair) {
            pairs.push(pair);
        }
    }
    pairs
}

fn global(program: &Program, (stage, id): End) -> Option<&Global> {
    program.stage(stage)?.globals.get(id.index())
}
