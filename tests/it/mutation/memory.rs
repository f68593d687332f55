//! Faults of layout, and of what is missing: offsets, strides, bindings and locations; stores and decorations.
//!
//! *In:* a module. *Out:* mutations.

use super::module::{Module, class, decoration};
use super::words::{Instruction, encoded, op};
use super::{Kind, Mutation, Rewrite};
use std::collections::BTreeSet;

/// Decorations whose absence is no other fault of this study.
const DROPPED: [(u32, &str); 5] = [
    (decoration::FLAT, "Flat"),
    (decoration::NO_PERSPECTIVE, "NoPerspective"),
    (decoration::CENTROID, "Centroid"),
    (decoration::INVARIANT, "Invariant"),
    (decoration::NON_WRITABLE, "NonWritable"),
];

/// All of these faults.
pub(super) fn faults(module: &Module<'_>) -> Vec<Mutation> {
    let structs = uniform_types(module);
    let mut found = Vec::new();
    for one in module.instructions {
        match one.opcode() {
            op::MEMBER_DECORATE if structs.contains(&one.word(1)) => {
                found.extend(member(one));
                found.extend(shifted(module, one));
            }
            op::DECORATE => found.extend(decorated(one, &structs)),
            op::STORE => {
                let name = format!("the store to %{} is dropped", one.word(1));
                found.push(Mutation::new(Kind::Dropped, name, one.replaced(Vec::new())));
            }
            _ => {}
        }
    }
    found.extend(exchanged(module, decoration::BINDING, "the bindings"));
    found.extend(exchanged(module, decoration::LOCATION, "the locations"));
    found
}

/// The types in uniform buffers.
fn uniform_types(module: &Module<'_>) -> BTreeSet<u32> {
    let uniform = module.pointers.values().filter(|(of, _)| *of == class::UNIFORM);
    let mut found: BTreeSet<u32> = uniform.map(|(_, pointee)| *pointee).collect();
    // Types are declared before those that contain them.
    for one in module.instructions.iter().rev() {
        match one.opcode() {
            _ if !found.contains(&one.word(1)) => {}
            op::TYPE_STRUCT => found.extend(&one.words[2..]),
            op::TYPE_ARRAY | op::TYPE_MATRIX | op::TYPE_VECTOR => {
                found.insert(one.word(2));
            }
            _ => {}
        }
    }
    found
}

/// The layout of a member of a block.
fn member(one: &Instruction<'_>) -> Vec<Mutation> {
    let [ty, member, what, value] = [1, 2, 3, 4].map(|place| one.word(place));
    let fault = |name: &str, words: Vec<u32>| {
        let name = format!("member {member} of %{ty}: {name}");
        Mutation::new(Kind::Memory, name, one.replaced(words))
    };
    let valued = |more: u32| encoded(op::MEMBER_DECORATE, &[ty, member, what, more]);
    match what {
        decoration::OFFSET if value >= 16 => vec![fault("the offset is 16 less", valued(value - 16))],
        decoration::MATRIX_STRIDE => vec![
            fault("the stride of columns is doubled", valued(value * 2)),
            fault("the stride of columns is halved", valued(value / 2)),
        ],
        decoration::COL_MAJOR | decoration::ROW_MAJOR => {
            let other = decoration::ROW_MAJOR + decoration::COL_MAJOR - what;
            vec![fault("rows and columns are exchanged", encoded(op::MEMBER_DECORATE, &[ty, member, other]))]
        }
        _ => Vec::new(),
    }
}

/// A member and all that follow it are 16 bytes further.
fn shifted(module: &Module<'_>, one: &Instruction<'_>) -> Option<Mutation> {
    let [ty, member, what, value] = [1, 2, 3, 4].map(|place| one.word(place));
    if what != decoration::OFFSET {
        return None;
    }
    let follows = |other: &&Instruction<'_>| {
        let [of, number, decorates, at] = [1, 2, 3, 4].map(|place| other.word(place));
        other.opcode() == op::MEMBER_DECORATE && (of, decorates) == (ty, what) && (number == member || at > value)
    };
    let all = module.instructions.iter().filter(follows);
    let splices = all.map(|other| other.with(4, other.word(4) + 16)).collect();
    let name = format!("member {member} of %{ty} and those after it: the offset is 16 more");
    let rewrite = Rewrite::Words { splices, more_ids: 0 };
    Some(Mutation { kind: Kind::Memory, name, rewrite })
}

/// The stride of an array; a decoration that is missing.
fn decorated(one: &Instruction<'_>, structs: &BTreeSet<u32>) -> Option<Mutation> {
    let [target, what, value] = [1, 2, 3].map(|place| one.word(place));
    if what == decoration::ARRAY_STRIDE && structs.contains(&target) {
        let name = format!("%{target} the stride of the array is 16 more");
        return Some(Mutation::new(Kind::Memory, name, one.with(3, value + 16)));
    }
    let (_, name) = DROPPED.iter().find(|(number, _)| *number == what)?;
    let name = format!("%{target} loses {name}");
    Some(Mutation::new(Kind::Dropped, name, one.replaced(Vec::new())))
}

/// Two variables of one type and storage class with each other's binding or location.
fn exchanged(module: &Module<'_>, what: u32, name: &str) -> Vec<Mutation> {
    let mut found = Vec::new();
    let all: Vec<(u32, (u32, u32), &Instruction<'_>)> = (module.variables.iter())
        .filter_map(|(variable, ty)| Some((*variable, *ty, module.decoration(*variable, what)?)))
        .collect();
    let set = |variable: u32| module.decoration(variable, decoration::DESCRIPTOR_SET).map(|one| one.word(3));
    for (place, (first, ty, one)) in all.iter().enumerate() {
        let other = all[place + 1..].iter().find(|(second, of, _)| of == ty && set(*second) == set(*first));
        if let Some((second, _, other)) = other {
            let mut splices = vec![one.with(3, other.word(3)), other.with(3, one.word(3))];
            splices.sort_by_key(|splice| splice.at);
            let name = format!("{name} of %{first} and %{second} are exchanged");
            let rewrite = Rewrite::Words { splices, more_ids: 0 };
            found.push(Mutation { kind: Kind::Memory, name, rewrite });
        }
    }
    found
}
