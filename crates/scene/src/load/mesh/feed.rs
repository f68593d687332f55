//! Hands the data of a mesh to the attributes of a program.
//!
//! *In:* a [`Mesh`], the attributes, and which of them have data already. *Out:* the role of each attribute that the mesh feeds. *Holds:*
//! the scene's own names come first; each role is handed out once.

use super::{Mesh, Named};
use crate::roles::{AttributeRole, attribute_role, likely_attribute_role};
use glisten_front::hir::{Scalar, Type};
use glisten_front::link::{Attribute, Program};

impl Mesh {
    /// The name of the mesh in messages.
    pub(in super::super) fn source(&self) -> &str {
        &self.source
    }

    /// The roles that the scene hands to no attribute, and that the mesh has data for.
    fn free_roles(&self) -> impl Iterator<Item = AttributeRole> + '_ {
        let named = |role: AttributeRole| self.named.iter().any(|named: &Named| named.role == role);
        AttributeRole::ALL.into_iter().filter(move |role| !named(*role) && self.has(*role))
    }

    /// Whether the mesh has data for a role.
    pub(in super::super) fn has(&self, role: AttributeRole) -> bool {
        match role {
            AttributeRole::Color => !self.geometry.colors.is_empty(),
            AttributeRole::Texcoord2 => !self.geometry.texcoords2.is_empty(),
            _ => !self.geometry.positions.is_empty(),
        }
    }

    /// Finds the mesh's tangents if the program gets them, or bitangents, from it. `is_given` says which attributes have other data.
    pub(in super::super) fn complete_tangents(&mut self, program: &Program, is_given: &dyn Fn(&str) -> bool) {
        let names_it = |attribute: &Attribute| self.named.iter().any(|named| named.attribute == attribute.name);
        let given: Vec<bool> = program
            .interface
            .attributes
            .iter()
            .map(|attribute| is_given(&attribute.name) || names_it(attribute))
            .collect();
        let implied = self.implied(program, &given).into_iter().map(|(_, role)| role);
        let mut fed = implied.chain(self.named.iter().map(|named| named.role));
        if fed.any(|role| matches!(role, AttributeRole::Tangent | AttributeRole::Bitangent)) {
            self.geometry.complete_tangents();
        }
    }

    /// The attributes whose names say their role, by their place in the program. `given` says which have data.
    pub(in super::super) fn implied(&self, program: &Program, given: &[bool]) -> Vec<(usize, AttributeRole)> {
        let attributes = &program.interface.attributes;
        let ty = |attribute: &Attribute| program.types.get(attribute.ty);
        let mut fed: Vec<(usize, AttributeRole)> = Vec::new();
        for role in self.free_roles() {
            let free = |index: usize| given.get(index) == Some(&false) && fed.iter().all(|(taken, _)| *taken != index);
            let says = |attribute: &Attribute| {
                Some(attribute.name.as_str()) == role.fixed_attribute()
                    || self.conventional && attribute.name == role.name()
                    || attribute_role(&attribute.name, ty(attribute)) == Some(role)
            };
            let candidates: Vec<(usize, &Attribute)> =
                attributes.iter().enumerate().filter(|(index, attribute)| free(*index) && says(attribute)).collect();
            fed.extend(one_of(role, &candidates).map(|index| (index, role)));
        }
        fed
    }

    /// The roles that attributes without data are likely to have, in the order of the attributes; each role once.
    pub(in super::super) fn likely(
        &self,
        program: &Program,
        handed_out: &[AttributeRole],
        missing: &[&Attribute],
    ) -> Vec<Option<AttributeRole>> {
        let free: Vec<AttributeRole> = self.free_roles().filter(|role| !handed_out.contains(role)).collect();
        likely_roles(&free, program, missing)
    }
}

/// The only candidate, or the one with the role's own name, or the only one that the program reads.
fn one_of(role: AttributeRole, candidates: &[(usize, &Attribute)]) -> Option<usize> {
    let only = |list: Vec<usize>| match list[..] {
        [one] => Some(one),
        _ => None,
    };
    let own = |attribute: &Attribute| {
        attribute.name == role.name() || Some(attribute.name.as_str()) == role.fixed_attribute()
    };
    let all = only(candidates.iter().map(|(index, _)| *index).collect());
    let exact = || only(candidates.iter().filter(|(_, attribute)| own(attribute)).map(|(index, _)| *index).collect());
    let active =
        || only(candidates.iter().filter(|(_, attribute)| attribute.active).map(|(index, _)| *index).collect());
    all.or_else(exact).or_else(active)
}

/// The role of each attribute without data that its name suggests, among those that are free. A program reads positions: if no name
/// suggests them, the first vector gets them.
pub(in super::super) fn likely_roles(
    free: &[AttributeRole],
    program: &Program,
    missing: &[&Attribute],
) -> Vec<Option<AttributeRole>> {
    let mut free = free.to_vec();
    let mut take = |role: Option<AttributeRole>| {
        let place = free.iter().position(|free| Some(*free) == role)?;
        Some(free.remove(place))
    };
    let ty = |attribute: &Attribute| program.types.get(attribute.ty);
    let mut roles: Vec<Option<AttributeRole>> =
        missing.iter().map(|attribute| take(likely_attribute_role(&attribute.name, ty(attribute)))).collect();
    let is_vector =
        |attribute: &Attribute, least: u8| matches!(ty(attribute), Type::Vector(Scalar::Float, size) if size >= least);
    for least in [3, 2] {
        let first =
            missing.iter().zip(&mut roles).find(|(attribute, role)| role.is_none() && is_vector(attribute, least));
        if let Some((_, role)) = first {
            *role = take(Some(AttributeRole::Position));
        }
    }
    roles
}
