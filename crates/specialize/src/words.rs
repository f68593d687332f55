//! Names that are words of the language of the residual: GLSL before 1.50 allows `flat` or `smooth` as a name.
//!
//! *In:* the stages of a program. *Out:* the same stages with other names for these. *Holds:* what a host or another stage knows by its
//! name keeps it.

use crate::text;
use glisten_front::hir::{Global, Shader, Storage, StructId, Types, all_names, fresh_name};
use glisten_front::language::Version;
use glisten_front::syntax::keywords::is_taken;
use std::collections::{BTreeMap, BTreeSet};

/// Renames what cannot have its name in the languages that the stages are written in.
pub(crate) fn free(types: &mut Types, stages: &mut [Shader]) {
    let languages: Vec<Version> = stages.iter().map(text::language).collect();
    let is_taken = |name: &str| languages.iter().any(|language| is_taken(name, *language));
    let mut taken: BTreeSet<String> = stages.iter().flat_map(|shader| all_names(types, shader)).collect();
    let mut renamed: BTreeMap<String, String> = BTreeMap::new();
    let mut rename = |name: &mut String| {
        if !is_taken(name) {
            return;
        }
        let new = renamed.entry(name.clone()).or_insert_with(|| {
            let new = fresh_name(&format!("{name}_"), |name| taken.contains(name) || is_taken(name));
            taken.insert(new.clone());
            new
        });
        name.clone_from(new);
    };
    let mut outside: BTreeSet<StructId> = BTreeSet::new();
    for shader in stages.iter_mut() {
        for global in &mut shader.globals {
            if is_known_outside(global) {
                types.for_each_struct(global.ty, &mut |id| outside.insert(id));
            } else {
                rename(&mut global.name);
            }
        }
        for function in &mut shader.functions {
            rename(&mut function.name);
            function.locals.iter_mut().for_each(|local| rename(&mut local.name));
        }
    }
    types.change_structures(|id, structure| {
        if !structure.is_block {
            rename(&mut structure.name);
        }
        if !outside.contains(&id) && !structure.is_block {
            structure.members.iter_mut().for_each(|member| rename(&mut member.name));
        }
    });
}

fn is_known_outside(global: &Global) -> bool {
    global.builtin.is_some() || !matches!(global.storage, Storage::Private | Storage::Const)
}
