//! Blocks between stages, in the form that naga's reader knows.
//!
//! *In:* the words of a module. *Out:* the same module; its blocks of inputs and outputs have a location at each member.
//!
//! SPIR-V may give a location to the variable of a block alone. The members then have this location and the ones that
//! follow (Vulkan 1.3 §15.1.4, "Location and Component Assignment"). naga reads the locations of members only.

use std::collections::HashMap;

/// Opcodes (SPIR-V 1.6 §3.49).
mod op {
    pub(super) const TYPE_VECTOR: u32 = 23;
    pub(super) const TYPE_MATRIX: u32 = 24;
    pub(super) const TYPE_ARRAY: u32 = 28;
    pub(super) const TYPE_STRUCT: u32 = 30;
    pub(super) const TYPE_POINTER: u32 = 32;
    pub(super) const CONSTANT: u32 = 43;
    pub(super) const VARIABLE: u32 = 59;
    pub(super) const DECORATE: u32 = 71;
    pub(super) const MEMBER_DECORATE: u32 = 72;
}

/// The decoration `Location`.
const LOCATION: u32 = 30;

/// The storage classes `Input` and `Output`.
const INTERFACE: [u32; 2] = [1, 3];

/// More members than any block between stages has.
const MAX_MEMBERS: usize = 256;

/// An identifier of the module.
type Id = u32;

/// The parts of a module that say where the members of its blocks are.
#[derive(Default)]
struct Blocks {
    /// The locations that a value of a type takes, where that is not one.
    sizes: HashMap<Id, u32>,
    structs: HashMap<Id, Vec<Id>>,
    pointers: HashMap<Id, Id>,
    constants: HashMap<Id, u32>,
    locations: HashMap<Id, u32>,
    /// Variables between stages, with the types of their pointers.
    variables: Vec<(Id, Id)>,
}

impl Blocks {
    fn size(&self, ty: Id) -> u32 {
        self.sizes.get(&ty).copied().unwrap_or(1)
    }

    /// Notes an instruction. SPIR-V defines a type before it is used, so that sizes are known here.
    fn note(&mut self, opcode: u32, operands: &[u32]) {
        match (opcode, operands) {
            (op::TYPE_MATRIX, &[id, _, columns]) => _ = self.sizes.insert(id, columns),
            (op::TYPE_ARRAY, &[id, element, count]) => {
                let count = self.constants.get(&count).copied().unwrap_or(1);
                self.sizes.insert(id, self.size(element).saturating_mul(count));
            }
            (op::TYPE_VECTOR, &[id, ..]) => _ = self.sizes.insert(id, 1),
            (op::TYPE_STRUCT, [id, members @ ..]) if members.len() <= MAX_MEMBERS => {
                let size = members.iter().fold(0_u32, |sum, member| sum.saturating_add(self.size(*member)));
                self.sizes.insert(*id, size);
                self.structs.insert(*id, members.to_vec());
            }
            (op::TYPE_POINTER, &[id, _, to]) => _ = self.pointers.insert(id, to),
            (op::CONSTANT, &[_, id, value, ..]) => _ = self.constants.insert(id, value),
            (op::DECORATE, &[id, LOCATION, location]) => _ = self.locations.insert(id, location),
            (op::VARIABLE, &[pointer, id, class, ..]) if INTERFACE.contains(&class) => {
                self.variables.push((id, pointer));
            }
            _ => {}
        }
    }

    /// The blocks whose variables have the location, by variable.
    fn located(&self) -> HashMap<Id, Id> {
        let block = |(id, pointer): &(Id, Id)| {
            let ty = *self.pointers.get(pointer)?;
            (self.structs.contains_key(&ty) && self.locations.contains_key(id)).then_some((*id, ty))
        };
        self.variables.iter().filter_map(block).collect()
    }

    /// Writes the decorations of a block's members, of which the first has the location.
    fn decorate(&self, block: Id, mut location: u32, to: &mut Vec<u32>) {
        for (member, ty) in self.structs.get(&block).into_iter().flatten().enumerate() {
            to.extend([5 << 16 | op::MEMBER_DECORATE, block, member as u32, LOCATION, location]);
            location = location.saturating_add(self.size(*ty));
        }
    }
}

/// The instructions of a module: the opcode, the operands, and all words. The module has passed `spirv::words`.
fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32], &[u32])> {
    let mut rest = words.get(5..).unwrap_or_default();
    std::iter::from_fn(move || {
        let (first, _) = rest.split_first()?;
        let (all, after) = rest.split_at_checked((*first >> 16) as usize)?;
        rest = after;
        Some((first & 0xffff, all.get(1..)?, all))
    })
}

/// The module with a location at each member of the blocks that its stages pass.
pub(super) fn with_locations(words: &[u32]) -> Vec<u32> {
    let mut blocks = Blocks::default();
    instructions(words).for_each(|(opcode, operands, _)| blocks.note(opcode, operands));
    let located = blocks.located();
    let mut out: Vec<u32> = words.get(..5).unwrap_or_default().to_vec();
    for (opcode, operands, all) in instructions(words) {
        match (opcode, operands) {
            (op::DECORATE, &[id, LOCATION, location]) if located.contains_key(&id) => {
                located.get(&id).into_iter().for_each(|block| blocks.decorate(*block, location, &mut out));
            }
            _ => out.extend(all),
        }
    }
    out
}
