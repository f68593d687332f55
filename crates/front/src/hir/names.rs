//! The names that a stage has, and new ones.
//!
//! *In:* a stage. *Out:* its names; a name that is free. *Holds:* who adds a variable or a function asks here, so that the new name is that of
//! no struct, no member of a block and no local either.

use super::{GlobalId, Shader, Type, TypeId, Types};
use std::collections::BTreeSet;

/// The names that are declared at the global scope of a stage: functions, structs, variables, and blocks with their instances, or with their
/// members where they have none (GLSL 1.50 §4.3.7). Some variables may be left out.
pub fn global_names(types: &Types, shader: &Shader, is_left_out: impl Fn(GlobalId) -> bool) -> BTreeSet<String> {
    let mut names: BTreeSet<String> = shader.functions.iter().map(|function| function.name.clone()).collect();
    for (_, global) in shader.globals().filter(|(id, _)| !is_left_out(*id)) {
        match &global.block {
            Some(block) => {
                names.insert(block.name.clone());
                match &block.instance {
                    Some(instance) => drop(names.insert(instance.clone())),
                    None => names.extend(members(types, global.ty)),
                }
            }
            None => drop(names.insert(global.name.clone())),
        }
    }
    names.extend(types.structures().filter(|structure| !structure.is_block).map(|structure| structure.name.clone()));
    names
}

/// All names of a stage: the global ones, and those of parameters and locals.
pub fn all_names(types: &Types, shader: &Shader) -> BTreeSet<String> {
    let mut names = global_names(types, shader, |_| false);
    names.extend(shader.functions.iter().flat_map(|function| &function.locals).map(|local| local.name.clone()));
    names
}

/// The wanted name, if it is free, or else the first free one with a number: `wanted_2`. No name gets two underscores in a row, which the language
/// reserves (GLSL 1.50 §3.6).
pub fn fresh_name(wanted: &str, is_taken: impl Fn(&str) -> bool) -> String {
    let mut name = wanted.to_owned();
    let mut number = 1_u32;
    while is_taken(&name) {
        number += 1;
        name = format!("{}_{number}", wanted.trim_end_matches('_'));
    }
    name
}

fn members(types: &Types, ty: TypeId) -> Vec<String> {
    match types.get(ty) {
        Type::Struct(id) => types.structure(id).members.iter().map(|member| member.name.clone()).collect(),
        _ => Vec::new(),
    }
}
