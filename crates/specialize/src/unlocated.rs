//! Varyings without locations, so that GLSL 1.50 can declare them (GLSL 4.10 §4.4.1 brought the locations).
//!
//! *In:* the stages of a program, in order. *Out:* the same stages, in which an input and the output that feeds it have one name and
//! no location. *Holds:* the name is the input's, as in the interface of the original; where the stage before uses it for something
//! else, both get a new one.

use glisten_front::hir::{Global, GlobalId, Shader, Storage, Types, fresh_name, global_names};
use glisten_front::link::partners;
use std::collections::BTreeSet;

/// A varying with a new name.
pub(crate) struct Renamed {
    /// The name in the original.
    pub(crate) old: String,
    /// The name in the residual.
    pub(crate) new: String,
}

/// Matches the varyings of neighboring stages by their names alone.
pub(crate) fn by_name(types: &Types, stages: &mut [Shader]) -> Vec<Renamed> {
    let mut renamed = Vec::new();
    for at in 1..stages.len() {
        let (before, after) = stages.split_at_mut(at);
        if let (Some(producer), Some(consumer)) = (before.last_mut(), after.first_mut()) {
            pair(types, producer, consumer, &mut renamed);
        }
    }
    renamed
}

/// Matches the varyings from one stage to the next.
fn pair(types: &Types, producer: &mut Shader, consumer: &mut Shader, renamed: &mut Vec<Renamed>) {
    let crosses =
        |global: &Global, storage| global.storage == storage && global.builtin.is_none() && !global.is_fixed();
    let is_located = |shader: &Shader, storage| {
        shader.globals.iter().any(|global| crosses(global, storage) && global.location.is_some())
    };
    if !is_located(producer, Storage::Out) && !is_located(consumer, Storage::In) {
        return;
    }
    let pairs = partners(producer, consumer);
    let known: BTreeSet<GlobalId> = pairs.iter().map(|(from, _)| *from).collect();
    let mut taken = global_names(types, producer, |id| known.contains(&id));
    let of_consumer = global_names(types, consumer, |_| false);
    for (from, to) in pairs {
        let old = own_name(consumer.global(to)).to_owned();
        let new = fresh_name(&old, |name| taken.contains(name) || name != old && of_consumer.contains(name));
        taken.insert(new.clone());
        for (shader, id) in [(&mut *producer, from), (&mut *consumer, to)] {
            if let Some(global) = shader.globals.get_mut(id.index()) {
                rename(global, &new);
            }
        }
        if new != old {
            renamed.push(Renamed { old, new });
        }
    }
    for (shader, storage) in [(producer, Storage::Out), (consumer, Storage::In)] {
        for global in shader.globals.iter_mut().filter(|global| crosses(global, storage)) {
            (global.location, global.component) = (None, None);
        }
    }
}

/// The name by which stages know a global.
fn own_name(global: &Global) -> &str {
    global.block.as_ref().map_or(&global.name, |block| &block.name)
}

fn rename(global: &mut Global, new: &str) {
    match &mut global.block {
        Some(block) => {
            if global.name == block.name {
                new.clone_into(&mut global.name);
            }
            new.clone_into(&mut block.name);
        }
        None => new.clone_into(&mut global.name),
    }
}
