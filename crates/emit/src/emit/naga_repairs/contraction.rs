//! Decorations that forbid contraction: the `precise` of GLSL 4.00 §4.7 in SPIR-V.
//!
//! naga has no word for it. A stage that declares anything `precise` gets `NoContraction` on each of its operations on floats
//! that a driver could contract or reassociate: more than the language asks for, and never less.
//!
//! *In:* the words of a module. *Out:* the same with decorations. *Holds:* words that are no module stay as they are.

/// The words before the first instruction.
const HEADER: usize = 5;
const OP_DECORATE: u32 = 71;
const NO_CONTRACTION: u32 = 42;

/// `OpFNegate`, `OpFAdd`, `OpFSub`, `OpFMul`, `OpFDiv`, `OpFRem`, `OpFMod`, products of vectors and matrices, `OpDot`.
const ARITHMETIC: [u32; 14] = [127, 129, 131, 133, 136, 140, 141, 142, 143, 144, 145, 146, 147, 148];

/// Instructions that come before all decorations or are such: capabilities, extensions, modes, names, decorations.
const BEFORE_TYPES: [u32; 15] = [3, 4, 5, 6, 7, 8, 10, 11, 14, 15, 16, 17, 71, 72, 332];

/// An instruction: its place, its code and its number of words.
#[derive(Clone, Copy)]
pub(super) struct Instruction {
    pub(super) start: usize,
    pub(super) code: u32,
}

/// The instructions of a module, in order.
pub(super) fn instructions(words: &[u32]) -> impl Iterator<Item = Instruction> {
    let mut start = HEADER;
    std::iter::from_fn(move || {
        let first = *words.get(start)?;
        let found = Instruction { start, code: first & 0xffff };
        // An instruction without words is none, and would not end.
        start += usize::try_from(first >> 16).ok().filter(|length| *length > 0)?;
        Some(found)
    })
}

/// The module with `NoContraction` on all arithmetic of floats.
pub(in crate::emit) fn forbidden(words: Vec<u32>) -> Vec<u32> {
    let Some(types) = instructions(&words).find(|found| !BEFORE_TYPES.contains(&found.code)) else { return words };
    let results = instructions(&words).filter(|found| ARITHMETIC.contains(&found.code));
    let decorations: Vec<u32> = results
        .filter_map(|found| words.get(found.start + 2))
        .flat_map(|result| [3 << 16 | OP_DECORATE, *result, NO_CONTRACTION])
        .collect();
    let mut words = words;
    words.splice(types.start..types.start, decorations);
    words
}

#[cfg(test)]
mod tests {
    use super::forbidden;

    #[test]
    fn arithmetic_is_decorated_before_the_types() {
        // OpCapability Shader; OpTypeVoid %1; OpFMul %2 = %5 of type %3; OpIAdd.
        let capability = [2 << 16 | 17, 1];
        let rest = [2 << 16 | 19, 1, 5 << 16 | 133, 3, 5, 6, 7, 5 << 16 | 128, 8, 9, 6, 7];
        let header = [0x0723_0203, 0x0001_0300, 0, 20, 0];
        let words: Vec<u32> = header.iter().chain(&capability).chain(&rest).copied().collect();
        let expected: Vec<u32> =
            header.iter().chain(&capability).chain(&[3 << 16 | 71, 5, 42]).chain(&rest).copied().collect();
        assert_eq!(forbidden(words), expected);
    }

    #[test]
    fn words_that_are_no_module_stay() {
        for words in [vec![], vec![1, 2, 3], vec![0, 0, 0, 0, 0, 0, 7], vec![0, 0, 0, 0, 0, 9 << 16 | 17]] {
            assert_eq!(forbidden(words.clone()), words);
        }
    }
}
