//! Samplers that are members of structs as variables of their own: `material.albedo` is `material_albedo`, and
//! `lights[i].map` is `lights_map[i]`. In Vulkan, a sampler cannot be a member of a block.
//!
//! *In:* a stage whose uniforms are used member by member ([`limits`](super::limits) refuses others). *Out:* for each
//! loose uniform its type without samplers, and new variables for the samplers.

use super::{Layouts, declare, plain, unused};
use glisten_front::hir::{ExprId, ExprKind, GlobalId, Shader, Storage, StructType, Type, TypeId, Types, VarRef};
use glisten_front::link::Program;
use std::collections::BTreeMap;

/// The parts that structs with samplers became.
pub(super) struct Apart<'a> {
    program: &'a Program,
    /// The type without samplers; `None` if nothing is left.
    stripped: BTreeMap<TypeId, Option<TypeId>>,
    /// The variable of a sampler, by the variable and the members that led to it.
    variables: BTreeMap<(GlobalId, Vec<u32>), GlobalId>,
}

/// The way from a variable to a part of it.
#[derive(Clone)]
pub(super) struct Path {
    pub(super) global: GlobalId,
    pub(super) members: Vec<u32>,
    pub(super) indices: Vec<ExprId>,
    /// The declared type of the part.
    pub(super) ty: TypeId,
}

impl<'a> Apart<'a> {
    pub(super) fn new(program: &'a Program) -> Self {
        Self { program, stripped: BTreeMap::new(), variables: BTreeMap::new() }
    }

    /// A type without its samplers.
    pub(super) fn stripped(&mut self, types: &mut Types, ty: TypeId) -> Option<TypeId> {
        if !types.contains_sampler(ty) {
            return Some(ty);
        }
        if let Some(known) = self.stripped.get(&ty) {
            return *known;
        }
        let new = match types.get(ty) {
            Type::Array(element, size) => self.stripped(types, element).map(|element| types.array(element, size)),
            Type::Struct(id) => {
                let old = types.structure(id).clone();
                let mut members = Vec::new();
                for member in &old.members {
                    if let Some(ty) = self.stripped(types, member.ty) {
                        members.push(glisten_front::hir::Member { ty, ..member.clone() });
                    }
                }
                (!members.is_empty()).then(|| types.add_struct(StructType { members, ..old }))
            }
            _ => None,
        };
        self.stripped.insert(ty, new);
        new
    }

    /// The index of a member in the struct without samplers.
    pub(super) fn member(&mut self, types: &mut Types, ty: TypeId, member: u32) -> u32 {
        let Type::Struct(id) = types.get(ty) else { return member };
        let before: Vec<TypeId> =
            types.structure(id).members.iter().take(member as usize).map(|member| member.ty).collect();
        before.into_iter().filter(|ty| self.stripped(types, *ty).is_some()).count() as u32
    }

    /// The sampler at the end of a path, as an expression of its own variable: all of `at` but its kind stays.
    pub(super) fn sampler(
        &mut self,
        types: &mut Types,
        shader: &mut Shader,
        path: &Path,
        layouts: &mut Layouts,
    ) -> ExprKind {
        let global = self.variable(types, shader, path, layouts);
        let mut kind = ExprKind::Var(VarRef::Global(global));
        let mut ty = shader.global(global).ty;
        for index in &path.indices {
            let base = shader.push(kind, ty, Default::default());
            ty = types.element(ty).unwrap_or(ty);
            kind = ExprKind::Index(base, *index);
        }
        kind
    }

    fn variable(&mut self, types: &mut Types, shader: &mut Shader, path: &Path, layouts: &mut Layouts) -> GlobalId {
        let key = (path.global, path.members.clone());
        if let Some(known) = self.variables.get(&key) {
            return *known;
        }
        let root = shader.global(path.global).clone();
        let (mut name, mut first) = (root.name.clone(), root.name.clone());
        let (mut ty, mut sizes) = (root.ty, Vec::new());
        let mut members = path.members.iter();
        loop {
            match types.get(ty) {
                Type::Array(element, size) => {
                    sizes.push(size);
                    first.push_str("[0]");
                    ty = element;
                }
                Type::Struct(id) => {
                    let member = members.next().and_then(|at| types.structure(id).members.get(*at as usize));
                    let Some(member) = member else { break };
                    name = format!("{name}_{}", member.name);
                    first = format!("{first}.{}", member.name);
                    ty = member.ty;
                }
                _ => break,
            }
        }
        let ty = sizes.into_iter().rev().fold(ty, |element, size| types.array(element, size));
        let name = unused(self.program, &name);
        let slot = self.program.interface.samplers.iter().find(|slot| slot.name == first).map(|slot| slot.texture);
        let binding = slot.map(|slot| slot.binding);
        let id = declare(shader, super::Global { binding, span: root.span, ..plain(name, ty, Storage::Uniform) });
        slot.into_iter().for_each(|slot| layouts.set(id, slot));
        self.variables.insert(key, id);
        id
    }
}
