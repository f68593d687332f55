//! Faults of order: operands in exchange, and a load that sees a store it should not see, or does not see one that it
//! should see.
//!
//! *In:* a module. *Out:* mutations in which every value is still computed before it is used.

use super::module::Module;
use super::words::{Instruction, op};
use super::{Kind, Mutation, Rewrite};

/// Operations that do not commute; comparisons are among the operations.
const OPERATIONS: [(u16, &str); 14] = [
    (130, "ISub"),
    (131, "FSub"),
    (134, "UDiv"),
    (135, "SDiv"),
    (136, "FDiv"),
    (137, "UMod"),
    (138, "SRem"),
    (139, "SMod"),
    (140, "FRem"),
    (141, "FMod"),
    (176, "ULessThan"),
    (177, "SLessThan"),
    (184, "FOrdLessThan"),
    (186, "FOrdGreaterThan"),
];

/// Functions of GLSL.std.450 that do not commute and that the table of operations lacks.
const FUNCTIONS: [(u32, &str); 3] = [(43, "FClamp"), (46, "FMix"), (49, "SmoothStep")];

/// How far a load may move, in instructions.
const REACH: usize = 40;

/// All of these faults.
pub(super) fn faults(module: &Module<'_>) -> Vec<Mutation> {
    let mut found = Vec::new();
    for (place, one) in module.instructions.iter().enumerate().skip(module.body) {
        found.extend(swapped(one));
        if one.opcode() == op::STORE {
            found.extend(load_before(module, place));
            found.extend(load_after(module, place));
        }
    }
    found
}

fn swapped(one: &Instruction<'_>) -> Option<Mutation> {
    let (first, second, name) = match one.opcode() {
        op::EXT_INST => {
            let name = FUNCTIONS.iter().find(|(number, _)| *number == one.word(4))?.1;
            // The ends of a mix are swapped among the operations.
            if one.word(4) == 46 { (6, 7, name) } else { (5, 6, name) }
        }
        op::VECTOR_SHUFFLE if one.word(3) != one.word(4) => (3, 4, "VectorShuffle"),
        opcode => (3, 4, OPERATIONS.iter().find(|(code, _)| *code == opcode)?.1),
    };
    let mut words = one.words.to_vec();
    words.swap(first, second);
    let name = format!("%{} {name}: operands {} and {} are exchanged", one.word(2), first - 2, second - 2);
    (words != one.words).then(|| Mutation::new(Kind::Order, name, one.replaced(words)))
}

/// The pointer that a store or a load goes through, with the variable that it points into.
fn base(module: &Module<'_>, pointer: u32) -> u32 {
    match module.definition(pointer) {
        Some((_, chain)) if chain.opcode() == op::ACCESS_CHAIN => chain.word(3),
        _ => pointer,
    }
}

fn moved(name: String, one: &Instruction<'_>, before: &Instruction<'_>) -> Mutation {
    let mut splices = vec![before.preceded(one.words.to_vec()), one.replaced(Vec::new())];
    splices.sort_by_key(|splice| (splice.at, splice.len));
    Mutation { kind: Kind::Order, name, rewrite: Rewrite::Words { splices, more_ids: 0 } }
}

/// The next load of the same pointer in the block is moved before the store.
fn load_before(module: &Module<'_>, place: usize) -> Option<Mutation> {
    let store = module.instructions.get(place)?;
    let rest = module.instructions.iter().skip(place + 1).take(REACH);
    let load = rest
        .take_while(|one| one.opcode() != op::LABEL)
        .find(|one| one.opcode() == op::LOAD && one.word(3) == store.word(1))?;
    Some(moved(format!("%{} is loaded before the store to %{}", load.word(2), store.word(1)), load, store))
}

/// The store is moved before an earlier load of the variable, if its value is there by then.
fn load_after(module: &Module<'_>, place: usize) -> Option<Mutation> {
    let store = module.instructions.get(place)?;
    let is_load =
        |one: &Instruction<'_>| one.opcode() == op::LOAD && base(module, one.word(3)) == base(module, store.word(1));
    let from = place.saturating_sub(REACH).max(module.body);
    let at = (from..place).rev().find(|at| is_load(&module.instructions[*at]))?;
    let is_there = |value: u32| module.definition(value).is_none_or(|(defined, _)| defined < at);
    let movable = is_there(store.word(1)) && is_there(store.word(2)) && module.is_one_block(at, place);
    let load = module.instructions.get(at).filter(|_| movable)?;
    Some(moved(format!("%{} is loaded after the store to %{}", load.word(2), store.word(1)), store, load))
}
