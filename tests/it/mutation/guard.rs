//! An end for every loop of a mutant, so that one that lost its exit ends as well.
//!
//! *In:* code. *Out:* the code with a counter in every loop, which leaves the loop after [`MOST`] steps of all loops of
//! the function together. *Holds:* what does not get there computes the same.

use super::module::{Builder, Module, Type};
use super::words::{encoded, instructions, op};
use super::{Code, Rewrite, tokens};

/// The number of steps. No scene of the fixtures takes a tenth of that.
const MOST: u32 = 20_000;

/// The code with an end for every loop; unchanged if it has none.
pub(super) fn bounded(code: &Code) -> Code {
    match code {
        Code::Words(words) => words_bounded(words).map_or_else(|| code.clone(), |rewrite| rewrite.apply(code)),
        Code::Text(text) => Code::Text(text_bounded(text)),
    }
}

fn words_bounded(words: &[u32]) -> Option<Rewrite> {
    let list = instructions(words);
    let module = Module::of(words, &list);
    let has_loop = module.code().iter().any(|one| one.opcode() == op::LOOP_MERGE);
    let (uint, bool) = (module.type_id(Type::Int { signed: false })?, module.type_id(Type::Bool)?);
    if !has_loop {
        return None;
    }
    let mut builder = Builder::new(&module);
    let [most, one, zero] = [MOST, 1, 0].map(|number| builder.constant(uint, number));
    let (pointer, counter) = (builder.id(), builder.id());
    // Pointer types may be declared twice only if they are aggregates; a private one of this type is a new one or known.
    const PRIVATE: u32 = 6;
    let known = module.pointers.iter().find(|(_, of)| **of == (PRIVATE, uint)).map(|(id, _)| *id);
    if known.is_none() {
        builder.declare(op::TYPE_POINTER, &[pointer, PRIVATE, uint]);
    }
    builder.declare(op::VARIABLE, &[known.unwrap_or(pointer), counter, PRIVATE, zero]);
    for (place, merge) in list.iter().enumerate().filter(|(_, one)| one.opcode() == op::LOOP_MERGE) {
        // Only a header that goes on without a condition gets one.
        let Some(next) = list.get(place + 1).filter(|next| next.opcode() == op::BRANCH) else { continue };
        let [old, new, goes_on] = [builder.id(), builder.id(), builder.id()];
        let count = [
            encoded(op::LOAD, &[uint, old, counter]),
            encoded(op::I_ADD, &[uint, new, old, one]),
            encoded(op::STORE, &[counter, new]),
            encoded(op::U_LESS_THAN, &[bool, goes_on, new, most]),
        ];
        builder.splices.push(merge.preceded(count.concat()));
        builder.replace(next, vec![encoded(op::BRANCH_CONDITIONAL, &[goes_on, next.word(1), merge.word(1)])]);
    }
    Some(builder.finish())
}

/// The text with a counter at the beginning of the body of each `for`, `while` and `loop`.
fn text_bounded(text: &str) -> String {
    let list = tokens::tokens(text);
    let mut edits = Vec::new();
    for (place, token) in list.iter().enumerate() {
        if ["for", "while", "loop"].contains(&token.text)
            && let Some(body) = tokens::body(&list, place)
        {
            let at = list[body].at + 1;
            let count = format!(" guard_steps++; if guard_steps >= {MOST}u {{ break; }}");
            edits.push((at..at, count));
        }
    }
    if edits.is_empty() {
        return text.to_owned();
    }
    tokens::edited(text, &edits) + "\nvar<private> guard_steps: u32 = 0u;\n"
}
