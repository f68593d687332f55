//! Legal changes of a module: what a translator or a driver may do with it. No verdict may fail for one of them.
//!
//! *In:* a module, a seed. *Out:* for each rule of the table, the module with the rule applied wherever it applies; and
//! modules in which a part of all places, chosen by the seed, is changed, and instructions are reordered.
//!
//! *Holds:* without `NoContraction`, sums and products may be contracted and reassociated (SPIR-V §3.20, WGSL §15.7.4);
//! everything else here computes the same in every conforming implementation, up to the rounding of an equal number of
//! operations.

use super::module::{Builder, Module, decoration};
use super::words::{Instruction, Splice, encoded, glsl, instructions, op, spliced};
use super::{Random, Rewrite};

/// A rule: its name, and the code for an instruction that it applies to.
struct Rule {
    name: &'static str,
    code: fn(&mut Builder<'_, '_>, &Instruction<'_>) -> Option<Vec<Vec<u32>>>,
}

const RULES: [Rule; 9] = [
    Rule { name: "a + b to b + a", code: commuted },
    Rule { name: "a b + c to fma(a, b, c)", code: contracted },
    Rule { name: "(a + b) + c to a + (b + c)", code: reassociated },
    Rule { name: "(a b) c to a (b c)", code: reassociated_product },
    Rule { name: "2 x to x + x", code: doubled },
    Rule { name: "a - b to a + (-b)", code: negated },
    Rule { name: "x / 2^n to 2^-n x", code: reciprocal },
    Rule { name: "pow(x, 2) to x x", code: squared },
    Rule { name: "dot(a, b) to dot(b, a)", code: commuted_dot },
];

/// How many modules of random changes there are.
const MIXTURES: u64 = 3;

/// Changed words, by the name of the change. What changes nothing is left out.
pub(super) fn legal(words: &[u32], seed: u64) -> Vec<(String, Vec<u32>)> {
    let mut found = Vec::new();
    for (number, rule) in RULES.iter().enumerate() {
        let everywhere = applied(words, &mut |of| of == number);
        found.extend(everywhere.map(|words| (format!("{} everywhere", rule.name), words)));
    }
    let mut random = Random::new(seed, "order");
    found.push(("instructions reordered".to_owned(), reordered(words, &mut random)));
    for mixture in 0..MIXTURES {
        let mut random = Random::new(seed ^ mixture, "mixture");
        let mut changed = words.to_vec();
        for _ in 0..2 {
            changed = applied(&changed, &mut |_| random.next().is_multiple_of(2)).unwrap_or(changed);
            changed = reordered(&changed, &mut random);
        }
        found.push((format!("mixture {mixture}"), changed));
    }
    found.retain(|(_, changed)| changed != words);
    found
}

/// The words after the chosen rules; each instruction is changed at most once.
fn applied(words: &[u32], chosen: &mut dyn FnMut(usize) -> bool) -> Option<Vec<u32>> {
    let list = instructions(words);
    let module = Module::of(words, &list);
    let mut builder = Builder::new(&module);
    for one in module.code() {
        if module.decoration(one.result(), decoration::NO_CONTRACTION).is_some() {
            continue;
        }
        let rules = RULES.iter().enumerate().filter(|(number, _)| chosen(*number));
        let code = rules.map(|(_, rule)| rule.code).find_map(|code| code(&mut builder, one));
        if let Some(code) = code {
            builder.replace(one, code);
        }
    }
    let is_changed = !builder.splices.is_empty();
    match builder.finish() {
        Rewrite::Words { splices, more_ids } if is_changed => Some(spliced(words, &splices, more_ids)),
        _ => None,
    }
}

fn head(one: &Instruction<'_>) -> [u32; 4] {
    [1, 2, 3, 4].map(|place| one.word(place))
}

fn commuted(_: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let commutes = [op::I_ADD, op::F_ADD, op::I_MUL, op::F_MUL].contains(&one.opcode());
    let [ty, result, a, b] = head(one);
    (commutes && a != b).then(|| vec![encoded(one.opcode(), &[ty, result, b, a])])
}

fn commuted_dot(_: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let [ty, result, a, b] = head(one);
    (one.opcode() == op::DOT && a != b).then(|| vec![encoded(op::DOT, &[ty, result, b, a])])
}

/// The operands of the instruction that computes a value for this instruction alone, in the same block.
fn only_for(module: &Module<'_>, one: &Instruction<'_>, value: u32, opcode: u16) -> Option<[u32; 2]> {
    let (place, definition) = module.definition(value)?;
    let (here, _) = module.definition(one.result())?;
    let is_exact = module.decoration(value, decoration::NO_CONTRACTION).is_some();
    let fits = definition.opcode() == opcode && !is_exact && module.uses(value) == 1;
    (fits && place < here && module.is_one_block(place, here)).then(|| [definition.word(3), definition.word(4)])
}

/// A product that is used once, in a sum or a difference.
fn contracted(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let [ty, result, left, right] = head(one);
    let is_sum = one.opcode() == op::F_ADD;
    if !is_sum && one.opcode() != op::F_SUB {
        return None;
    }
    let module = builder.module;
    if let Some([a, b]) = only_for(module, one, left, op::F_MUL) {
        if is_sum {
            return Some(vec![builder.extended(ty, result, glsl::FMA, &[a, b, right])]);
        }
        let minus = builder.id();
        let negated = encoded(op::F_NEGATE, &[ty, minus, right]);
        return Some(vec![negated, builder.extended(ty, result, glsl::FMA, &[a, b, minus])]);
    }
    let [a, b] = only_for(module, one, right, op::F_MUL)?;
    if is_sum {
        return Some(vec![builder.extended(ty, result, glsl::FMA, &[a, b, left])]);
    }
    let minus = builder.id();
    let negated = encoded(op::F_NEGATE, &[ty, minus, a]);
    Some(vec![negated, builder.extended(ty, result, glsl::FMA, &[minus, b, left])])
}

fn associated(builder: &mut Builder<'_, '_>, one: &Instruction<'_>, opcode: u16) -> Option<Vec<Vec<u32>>> {
    let [ty, result, left, right] = head(one);
    let [a, b] = (one.opcode() == opcode).then(|| only_for(builder.module, one, left, opcode))??;
    let inner = builder.id();
    Some(vec![encoded(opcode, &[ty, inner, b, right]), encoded(opcode, &[ty, result, a, inner])])
}

fn reassociated(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    associated(builder, one, op::F_ADD)
}

fn reassociated_product(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    associated(builder, one, op::F_MUL)
}

fn doubled(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let [ty, result, a, b] = head(one);
    let is_two = |value: u32| builder.module.float_constant(value) == Some(2.0);
    let x = match one.opcode() {
        op::F_MUL if is_two(b) => a,
        op::F_MUL if is_two(a) => b,
        op::VECTOR_TIMES_SCALAR if is_two(b) => a,
        _ => return None,
    };
    Some(vec![encoded(op::F_ADD, &[ty, result, x, x])])
}

fn negated(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let [ty, result, a, b] = head(one);
    if one.opcode() != op::F_SUB {
        return None;
    }
    let minus = builder.id();
    Some(vec![encoded(op::F_NEGATE, &[ty, minus, b]), encoded(op::F_ADD, &[ty, result, a, minus])])
}

fn reciprocal(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let [ty, result, a, b] = head(one);
    let by = (one.opcode() == op::F_DIV).then(|| builder.module.float_constant(b))??;
    // A power of two has no fraction.
    let is_power = by.is_normal() && by.to_bits() & 0x007f_ffff == 0 && by.recip().is_normal();
    let factor = is_power.then(|| builder.float(ty, by.recip()))?;
    Some(vec![encoded(op::F_MUL, &[ty, result, a, factor])])
}

fn squared(builder: &mut Builder<'_, '_>, one: &Instruction<'_>) -> Option<Vec<Vec<u32>>> {
    let is_square = one.opcode() == op::EXT_INST
        && one.word(4) == glsl::POW
        && builder.module.float_constant(one.word(6)) == Some(2.0);
    let x = one.word(5);
    is_square.then(|| vec![encoded(op::F_MUL, &[one.word(1), one.word(2), x, x])])
}

/// Whether an instruction may change places with a neighbor that does not use it.
fn is_pure(one: &Instruction<'_>) -> bool {
    matches!(one.opcode(), op::EXT_INST | 79..=84 | 109..=206)
}

/// The words with neighbors exchanged that do not depend on each other.
fn reordered(words: &[u32], random: &mut Random) -> Vec<u32> {
    let mut words = words.to_vec();
    for _ in 0..4 {
        let list = instructions(&words);
        let module = Module::of(&words, &list);
        let mut splices: Vec<Splice> = Vec::new();
        let mut place = module.body;
        while let Some([first, second]) = list.get(place..place + 2) {
            let free = is_pure(first) && is_pure(second) && !second.words[1..].contains(&first.result());
            let exchanged = free && random.next().is_multiple_of(2);
            if exchanged {
                splices.extend([first.replaced(second.words.to_vec()), second.replaced(first.words.to_vec())]);
            }
            place += if exchanged { 2 } else { 1 };
        }
        words = spliced(&words, &splices, 0);
    }
    words
}
