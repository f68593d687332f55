//! SPIR-V as words (SPIR-V 1.3 §2.3): splits modules into instructions, and changes instructions.
//!
//! *In:* the words of a valid module. *Out:* its [`Instruction`]s; words with some of them replaced. *Not done here:*
//! checking. The result has to be checked with `spirv-val` before a driver gets it.

/// The number of words before the first instruction.
const HEADER: usize = 5;
/// The index of the header word that is one more than the largest identifier.
const BOUND: usize = 3;

/// The opcodes of instructions that the tests refer to by name (§3.32).
pub(crate) mod op {
    pub(crate) const EXT_INST_IMPORT: u16 = 11;
    pub(crate) const EXT_INST: u16 = 12;
    pub(crate) const TYPE_BOOL: u16 = 20;
    pub(crate) const TYPE_INT: u16 = 21;
    pub(crate) const TYPE_FLOAT: u16 = 22;
    pub(crate) const TYPE_VECTOR: u16 = 23;
    pub(crate) const TYPE_MATRIX: u16 = 24;
    pub(crate) const TYPE_ARRAY: u16 = 28;
    pub(crate) const TYPE_STRUCT: u16 = 30;
    pub(crate) const TYPE_POINTER: u16 = 32;
    pub(crate) const CONSTANT_TRUE: u16 = 41;
    pub(crate) const CONSTANT: u16 = 43;
    pub(crate) const CONSTANT_COMPOSITE: u16 = 44;
    pub(crate) const FUNCTION: u16 = 54;
    pub(crate) const FUNCTION_CALL: u16 = 57;
    pub(crate) const VARIABLE: u16 = 59;
    pub(crate) const LOAD: u16 = 61;
    pub(crate) const STORE: u16 = 62;
    pub(crate) const ACCESS_CHAIN: u16 = 65;
    pub(crate) const DECORATE: u16 = 71;
    pub(crate) const MEMBER_DECORATE: u16 = 72;
    pub(crate) const VECTOR_SHUFFLE: u16 = 79;
    pub(crate) const COMPOSITE_CONSTRUCT: u16 = 80;
    pub(crate) const COMPOSITE_EXTRACT: u16 = 81;
    pub(crate) const COMPOSITE_INSERT: u16 = 82;
    pub(crate) const COPY_OBJECT: u16 = 83;
    pub(crate) const CONVERT_F_TO_U: u16 = 109;
    pub(crate) const CONVERT_F_TO_S: u16 = 110;
    pub(crate) const CONVERT_S_TO_F: u16 = 111;
    pub(crate) const CONVERT_U_TO_F: u16 = 112;
    pub(crate) const BITCAST: u16 = 124;
    pub(crate) const F_NEGATE: u16 = 127;
    pub(crate) const I_ADD: u16 = 128;
    pub(crate) const F_ADD: u16 = 129;
    pub(crate) const F_SUB: u16 = 131;
    pub(crate) const I_MUL: u16 = 132;
    pub(crate) const F_MUL: u16 = 133;
    pub(crate) const F_DIV: u16 = 136;
    pub(crate) const VECTOR_TIMES_SCALAR: u16 = 142;
    pub(crate) const DOT: u16 = 148;
    pub(crate) const LOGICAL_NOT: u16 = 168;
    pub(crate) const U_LESS_THAN: u16 = 176;
    pub(crate) const LOOP_MERGE: u16 = 246;
    pub(crate) const SELECTION_MERGE: u16 = 247;
    pub(crate) const LABEL: u16 = 248;
    pub(crate) const BRANCH: u16 = 249;
    pub(crate) const BRANCH_CONDITIONAL: u16 = 250;
    pub(crate) const SWITCH: u16 = 251;
}

/// The numbers of the instructions of GLSL.std.450 that the tests refer to by name.
pub(crate) mod glsl {
    pub(crate) const ROUND_EVEN: u32 = 2;
    pub(crate) const TRUNC: u32 = 3;
    pub(crate) const FLOOR: u32 = 8;
    pub(crate) const CEIL: u32 = 9;
    pub(crate) const POW: u32 = 26;
    pub(crate) const U_MIN: u32 = 38;
    pub(crate) const FMA: u32 = 50;
}

/// One instruction of a module.
#[derive(Clone, Copy)]
pub(crate) struct Instruction<'a> {
    /// The index of its first word in the module.
    pub(crate) at: usize,
    /// All its words; the first contains the opcode and the length.
    pub(crate) words: &'a [u32],
}

impl Instruction<'_> {
    pub(crate) fn opcode(&self) -> u16 {
        self.word(0) as u16
    }

    /// The word at an index; 0 past the end.
    pub(crate) fn word(&self, place: usize) -> u32 {
        self.words.get(place).copied().unwrap_or(0)
    }

    /// The identifier of the result; 0 if there is none.
    pub(crate) fn result(&self) -> u32 {
        if has_result(self.opcode()) { self.word(2) } else { 0 }
    }

    /// Replaces it by other words.
    pub(crate) fn replaced(&self, words: Vec<u32>) -> Splice {
        Splice { at: self.at, len: self.words.len(), words }
    }

    /// Inserts words before it.
    pub(crate) fn preceded(&self, words: Vec<u32>) -> Splice {
        Splice { at: self.at, len: 0, words }
    }

    /// Replaces one of its words.
    pub(crate) fn with(&self, place: usize, word: u32) -> Splice {
        let mut words = self.words.to_vec();
        words[place] = word;
        self.replaced(words)
    }
}

/// Whether an instruction of a function's body, or a constant, has a result type and a result.
fn has_result(opcode: u16) -> bool {
    match opcode {
        12 | 41..=55 | 57 | 59..=61 | 65..=70 | 77..=98 | 100..=107 | 109..=216 | 245 => true,
        _ => opcode == 1,
    }
}

/// The words of an instruction: its opcode, then its operands.
pub(crate) fn encoded(opcode: u16, operands: &[u32]) -> Vec<u32> {
    let first = (operands.len() as u32 + 1) << 16 | u32::from(opcode);
    std::iter::once(first).chain(operands.iter().copied()).collect()
}

/// The instructions of a module, in order.
pub(crate) fn instructions(words: &[u32]) -> Vec<Instruction<'_>> {
    let mut list = Vec::new();
    let mut at = HEADER;
    while let Some(first) = words.get(at) {
        let len = (first >> 16).max(1) as usize;
        list.push(Instruction { at, words: &words[at..(at + len).min(words.len())] });
        at += len;
    }
    list
}

/// The first unused identifier.
pub(crate) fn bound(words: &[u32]) -> u32 {
    words.get(BOUND).copied().unwrap_or(0)
}

/// A replacement of words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Splice {
    pub(crate) at: usize,
    pub(crate) len: usize,
    words: Vec<u32>,
}

/// The module after replacements, which are sorted by position, with room for more identifiers.
pub(crate) fn spliced(words: &[u32], splices: &[Splice], more_ids: u32) -> Vec<u32> {
    let mut out = Vec::with_capacity(words.len() + 64);
    let mut done = 0;
    for splice in splices {
        out.extend_from_slice(&words[done..splice.at]);
        out.extend_from_slice(&splice.words);
        done = splice.at + splice.len;
    }
    out.extend_from_slice(&words[done..]);
    out[BOUND] += more_ids;
    out
}
