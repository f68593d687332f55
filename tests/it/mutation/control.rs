//! Faults of control flow: branches, comparisons, exits of loops, cases of switches (SPIR-V §2.11, §3.32.17).
//!
//! *In:* a module. *Out:* mutations that keep its blocks structured. *Not done here:* an end for loops that lose theirs
//! ([`guard`](super::guard)).

use super::module::{Builder, Module, Type};
use super::words::{Instruction, encoded, op};
use super::{Kind, Mutation};

/// Comparisons, each with the one that differs only for equal operands.
const STRICTNESS: [(u16, &str, u16, &str); 12] = [
    (172, "UGreaterThan", 174, "UGreaterThanEqual"),
    (174, "UGreaterThanEqual", 172, "UGreaterThan"),
    (173, "SGreaterThan", 175, "SGreaterThanEqual"),
    (175, "SGreaterThanEqual", 173, "SGreaterThan"),
    (176, "ULessThan", 178, "ULessThanEqual"),
    (178, "ULessThanEqual", 176, "ULessThan"),
    (177, "SLessThan", 179, "SLessThanEqual"),
    (179, "SLessThanEqual", 177, "SLessThan"),
    (184, "FOrdLessThan", 188, "FOrdLessThanEqual"),
    (188, "FOrdLessThanEqual", 184, "FOrdLessThan"),
    (186, "FOrdGreaterThan", 190, "FOrdGreaterThanEqual"),
    (190, "FOrdGreaterThanEqual", 186, "FOrdGreaterThan"),
];

/// All faults of control flow.
pub(super) fn faults(module: &Module<'_>) -> Vec<Mutation> {
    let mut found = Vec::new();
    for one in module.code() {
        match one.opcode() {
            op::BRANCH_CONDITIONAL => found.extend(branches(module, one)),
            op::SWITCH => found.extend(cases(one)),
            op::LOGICAL_NOT => {
                let copied = encoded(op::COPY_OBJECT, &one.words[1..4]);
                found.push(fault(format!("%{} LogicalNot is dropped", one.word(2)), one, copied));
            }
            opcode => found.extend(strictness(one, opcode)),
        }
    }
    found.extend(jumps(module));
    found
}

fn fault(name: String, one: &Instruction<'_>, words: Vec<u32>) -> Mutation {
    Mutation::new(Kind::Control, name, one.replaced(words))
}

fn strictness(one: &Instruction<'_>, opcode: u16) -> Option<Mutation> {
    let (_, name, other, becomes) = STRICTNESS.iter().find(|row| row.0 == opcode)?;
    let mut words = one.words.to_vec();
    words[0] = words[0] & !0xffff | u32::from(*other);
    Some(fault(format!("%{} {name} becomes {becomes}", one.word(2)), one, words))
}

/// A branch to the other side, and one that is always taken.
fn branches(module: &Module<'_>, one: &Instruction<'_>) -> Vec<Mutation> {
    let mut words = one.words.to_vec();
    words.swap(2, 3);
    let name = format!("the branch on %{} is inverted", one.word(1));
    let mut found = vec![fault(name, one, words)];
    if let Some(bool) = module.type_id(Type::Bool) {
        let mut builder = Builder::new(module);
        let always = builder.id();
        builder.declare(op::CONSTANT_TRUE, &[bool, always]);
        builder.splices.push(one.with(1, always));
        let name = format!("the branch on %{} is always taken", one.word(1));
        found.push(Mutation { kind: Kind::Control, name, rewrite: builder.finish() });
    }
    found
}

/// A case of another number, and cases in exchange.
fn cases(one: &Instruction<'_>) -> Vec<Mutation> {
    let literals: Vec<usize> = (3..one.words.len()).step_by(2).collect();
    let has = |number: u32| literals.iter().any(|place| one.word(*place) == number);
    let mut found = Vec::new();
    for place in &literals {
        let number = one.word(*place);
        let name = |what: &str| format!("case {} of %{} {what}", number as i32, one.word(1));
        if !has(number.wrapping_add(1)) {
            let mut words = one.words.to_vec();
            words[*place] = number.wrapping_add(1);
            found.push(fault(name("is one more"), one, words));
        }
        // The default's label precedes the cases; the labels of cases follow their numbers.
        let mut words = one.words.to_vec();
        words.swap(place + 1, if *place == 3 { 2 } else { place - 1 });
        if words != one.words {
            found.push(fault(name("goes where the one before goes"), one, words));
        }
    }
    found
}

/// `break` instead of `continue`, and the reverse.
fn jumps(module: &Module<'_>) -> Vec<Mutation> {
    let loops = module.code().iter().filter(|one| one.opcode() == op::LOOP_MERGE);
    let targets: Vec<(u32, u32)> = loops.map(|one| (one.word(1), one.word(2))).collect();
    let mut found = Vec::new();
    for one in module.code().iter().filter(|one| one.opcode() == op::BRANCH) {
        let to = one.word(1);
        let other = targets.iter().find_map(|(end, next)| match to {
            _ if to == *end => Some((*next, "break becomes continue")),
            _ if to == *next => Some((*end, "continue becomes break")),
            _ => None,
        });
        if let Some((label, name)) = other {
            let name = format!("{name}, to %{label}");
            found.push(fault(name, one, encoded(op::BRANCH, &[label])));
        }
    }
    found
}
