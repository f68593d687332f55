//! [`scene_values_read`]: which of the values that a scene's lights and materials set a program reads.
//!
//! *In:* a linked program. *Out:* the names of `<glisten/scene.glsl>`, without the light's index: `light.exponent`,
//! `material.emission`, `finish.threshold`, `global_ambient`, and the samplers of a material. *Holds:* a name that is
//! not there cannot change the picture.

use glisten_front::hir::{MembersRead, Type, Types};
use glisten_front::link::{Program, UniformLeaf, UniformRoot};
use std::collections::BTreeSet;

/// The uniforms of the module `scene` that a scene fills.
const ROOTS: &[&str] = &["light", "material", "finish", "global_ambient"];

/// The values of a scene's lights and materials that the program reads, by name.
pub fn scene_values_read(program: &Program) -> BTreeSet<String> {
    let interface = &program.interface;
    let mut names: BTreeSet<String> =
        interface.samplers.iter().filter(|sampler| sampler.active).map(|sampler| sampler.name.clone()).collect();
    for root in interface.roots.iter().filter(|root| root.active && ROOTS.contains(&root.name.as_str())) {
        let Some(members) = members(&program.types, root) else {
            names.insert(root.name.clone());
            continue;
        };
        let read = reads(program, root);
        let named =
            members.iter().enumerate().filter(|(index, _)| read.iter().any(|read| read.contains(*index as u32)));
        names.extend(named.map(|(_, member)| format!("{}.{member}", root.name)));
    }
    names
}

/// Whether a stage reads the member of its root that a leaf belongs to.
pub fn is_leaf_read(program: &Program, leaf: &UniformLeaf) -> bool {
    let Some(root) = program.interface.roots.get(leaf.root.0 as usize) else { return true };
    let Some(members) = members(&program.types, root).filter(|_| root.block.is_none()) else { return true };
    let path = leaf.name.strip_prefix(root.name.as_str()).unwrap_or(&leaf.name);
    let path = if path.starts_with('[') { path.split_once(']').map_or("", |(_, rest)| rest) } else { path };
    let member = path.trim_start_matches('.').split(['.', '[']).next().unwrap_or_default();
    let index = members.iter().position(|known| known == member);
    index.is_none_or(|index| reads(program, root).iter().any(|read| read.contains(index as u32)))
}

/// The members of a struct or of an array of structs.
fn members(types: &Types, root: &UniformRoot) -> Option<Vec<String>> {
    let mut ty = types.get(root.ty);
    if let Type::Array(element, _) = ty {
        ty = types.get(element);
    }
    let Type::Struct(id) = ty else { return None };
    Some(types.structure(id).members.iter().map(|member| member.name.clone()).collect())
}

/// The members of a root that each stage reads.
fn reads(program: &Program, root: &UniformRoot) -> Vec<MembersRead> {
    let stages = root.globals.iter().filter_map(|&(stage, global)| Some((program.stage(stage)?, global)));
    stages.map(|(shader, global)| shader.members_read(global)).collect()
}
