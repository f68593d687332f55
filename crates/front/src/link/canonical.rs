//! Gives equal structs of a program one type (GLSL 1.50 §4.2.6: "Structures must have the same name, sequence of type
//! names, and type definitions, and field names to be considered the same type").
//!
//! *In:* shaders whose structs were declared separately. *Out:* the same shaders, in which structs that are equal
//! except for their positions have one handle. Everything after the link can then compare handles.

use crate::hir::{Interpolation, MatrixLayout, MemberPlace, Sampling, Shader, StructId, Type, TypeId, Types, Value};
use rustc_hash::FxHashMap;

/// The identity of a struct.
#[derive(PartialEq, Eq, Hash)]
struct Key {
    name: String,
    is_block: bool,
    members: Vec<MemberKey>,
}

/// The name, type and qualifiers of a member; the flags say which qualifiers it has.
type MemberKey = (String, TypeId, MatrixLayout, (Option<Interpolation>, Sampling), [bool; 2], MemberPlace);

/// Whether other shaders of a stage may still change the size of an array.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Sizes {
    /// They may: an array in a block that takes its size from its uses differs from one that its declaration sizes.
    Tentative,
    /// All sizes are final.
    Final,
}

struct Unifier<'a> {
    types: &'a mut Types,
    sizes: Sizes,
    known: FxHashMap<TypeId, TypeId>,
    structs: FxHashMap<Key, TypeId>,
}

/// Gives equal structs one handle in all shaders.
pub(super) fn unify(types: &mut Types, shaders: &mut [Shader], sizes: Sizes) {
    if shaders.len() < 2 {
        return;
    }
    let ids: Vec<TypeId> = types.ids().collect();
    let mut unifier = Unifier { types, sizes, known: FxHashMap::default(), structs: FxHashMap::default() };
    let changed = ids.into_iter().filter(|&id| unifier.canonical(id) != id).count();
    if changed > 0 {
        let known = unifier.known;
        retype_members(types, &known);
        shaders.iter_mut().for_each(|shader| retype(shader, &known));
    }
}

impl Unifier<'_> {
    fn canonical(&mut self, id: TypeId) -> TypeId {
        if let Some(&known) = self.known.get(&id) {
            return known;
        }
        let canonical = match self.types.get(id) {
            Type::Array(element, size) => {
                let element = self.canonical(element);
                self.types.array(element, size)
            }
            Type::Struct(structure) => {
                let key = self.key(structure);
                *self.structs.entry(key).or_insert(id)
            }
            Type::Error | Type::Void | Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..) | Type::Sampler(_) => id,
        };
        self.known.insert(id, canonical);
        canonical
    }

    fn key(&mut self, id: StructId) -> Key {
        let structure = self.types.structure(id);
        let (name, is_block) = (structure.name.clone(), structure.is_block);
        let members = structure.members.clone();
        let members = members.into_iter().map(|member| {
            let ty = self.canonical(member.ty);
            let implicit = member.implicitly_sized && self.sizes == Sizes::Tentative;
            let flags = [member.invariant, implicit];
            let interpolation = (member.interpolation, member.sampling);
            (member.name, ty, member.matrix_layout, interpolation, flags, member.place)
        });
        Key { name, is_block, members: members.collect() }
    }
}

/// The members of structs and blocks that stay have types that stay, too.
fn retype_members(types: &mut Types, known: &FxHashMap<TypeId, TypeId>) {
    let ids: Vec<TypeId> = types.ids().collect();
    let canonical = |ty: TypeId| known.get(&ty).copied().unwrap_or(ty);
    for id in ids {
        let Type::Struct(structure) = types.get(id) else { continue };
        if types.structure(structure).members.iter().any(|member| canonical(member.ty) != member.ty) {
            types.structure_mut(structure).members.iter_mut().for_each(|member| member.ty = canonical(member.ty));
        }
    }
}

fn retype(shader: &mut Shader, known: &FxHashMap<TypeId, TypeId>) {
    let set = |ty: &mut TypeId| *ty = known.get(ty).copied().unwrap_or(*ty);
    let set_value = |value: &mut Option<Value>| {
        if let Some(value) = value {
            set(&mut value.ty);
        }
    };
    for global in &mut shader.globals {
        set(&mut global.ty);
        set_value(&mut global.value);
    }
    for function in &mut shader.functions {
        set(&mut function.ret);
        for local in &mut function.locals {
            set(&mut local.ty);
            set_value(&mut local.value);
        }
    }
    for expr in &mut shader.exprs {
        set(&mut expr.ty);
    }
}
