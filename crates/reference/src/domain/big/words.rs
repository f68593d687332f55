//! The words of `astro-float`, which are as wide as a pointer of the machine, and those of [`Big`](super::Big), which have 64 bits everywhere.

#![allow(
    clippy::useless_conversion,
    clippy::unnecessary_cast,
    trivial_numeric_casts,
    reason = "the conversions do something where a pointer has 32 bits"
)]

use astro_float_num::{WORD_BIT_SIZE, Word};

/// The words of the machine in one of 64 bits.
const PARTS: usize = 64 / WORD_BIT_SIZE;

/// The words of the machine, the least significant one first.
pub(super) fn of_machine(words: &[u64]) -> Vec<Word> {
    let part = |word: u64, part: usize| (word >> (part * WORD_BIT_SIZE)) as Word;
    words.iter().flat_map(|word| (0..PARTS).map(move |index| part(*word, index))).collect()
}

/// Words of 64 bits, the least significant one first, whose highest bit is that of the given words.
pub(super) fn of_64_bits(given: &[Word]) -> Vec<u64> {
    let joined = |parts: &[Word]| {
        let lacking = PARTS - parts.len();
        let part = |(index, part): (usize, &Word)| u64::from(*part) << ((index + lacking) * WORD_BIT_SIZE);
        parts.iter().enumerate().map(part).sum()
    };
    let mut words: Vec<u64> = given.rchunks(PARTS).map(joined).collect();
    words.reverse();
    words
}

#[cfg(test)]
mod tests {
    use super::{of_64_bits, of_machine};

    #[test]
    fn words_come_back() {
        let words = [1, 0x0123_4567_89ab_cdef, u64::MAX - 5];
        assert_eq!(of_64_bits(&of_machine(&words)), words);
        assert_eq!(of_64_bits(&[]), [0; 0]);
    }
}
