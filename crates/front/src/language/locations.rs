//! How many locations a type takes, as a varying and as a uniform.

use super::types::{ArraySize, StructId, Type, TypeId, Types};
use rustc_hash::FxHashMap;

impl Types {
    /// The number of locations of a varying (GLSL 4.50 §4.4.1): one for a scalar or a vector, one for each column. An array without a
    /// size counts as one element. The number saturates where a type has more scalars than any interface.
    pub fn locations(&self, id: TypeId) -> u32 {
        const MOST_SCALARS: u32 = 1 << 16;
        if self.flat_len(id) > MOST_SCALARS {
            return u32::MAX;
        }
        match self.get(id) {
            Type::Matrix(columns, _) => u32::from(columns),
            Type::Array(element, ArraySize::Sized(size)) => size.saturating_mul(self.locations(element)),
            Type::Array(element, ArraySize::Unsized) => self.locations(element),
            Type::Struct(id) => {
                let members = self.structure(id).members.iter();
                members.fold(0, |sum: u32, member| sum.saturating_add(self.locations(member.ty)))
            }
            Type::Scalar(_) | Type::Vector(..) | Type::Sampler(_) | Type::Void | Type::Error => 1,
        }
    }

    /// The number of scalars, vectors, matrices and samplers of a type, each of which takes a location as a uniform (GLSL 4.30 §4.4.3). An
    /// array without a size counts as one element, and the number saturates.
    pub fn leaves(&self, id: TypeId) -> u32 {
        self.leaves_known(id, &mut FxHashMap::default())
    }

    /// Each struct is counted once, however many members have it.
    fn leaves_known(&self, id: TypeId, known: &mut FxHashMap<StructId, u32>) -> u32 {
        match self.get(id) {
            Type::Array(element, ArraySize::Sized(size)) => size.saturating_mul(self.leaves_known(element, known)),
            Type::Array(element, ArraySize::Unsized) => self.leaves_known(element, known),
            Type::Struct(id) => {
                if let Some(count) = known.get(&id) {
                    return *count;
                }
                let members = self.structure(id).members.iter();
                let count = members.fold(0, |sum: u32, member| sum.saturating_add(self.leaves_known(member.ty, known)));
                known.insert(id, count);
                count
            }
            Type::Scalar(_) | Type::Vector(..) | Type::Matrix(..) | Type::Sampler(_) | Type::Void | Type::Error => 1,
        }
    }
}
