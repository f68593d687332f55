//! `gl_SampleMaskIn` in SPIR-V: Vulkan requires an array of integers (VUID-SampleMask-SampleMask-04359), and naga declares one
//! integer.
//!
//! *In:* the words of a module. *Out:* the same with an array, of which each load reads the first element. *Holds:* words that
//! are no module, and modules without that variable, stay as they are.

use super::contraction::instructions;

const OP_TYPE_ARRAY: u32 = 28;
const OP_TYPE_POINTER: u32 = 32;
const OP_CONSTANT: u32 = 43;
const OP_VARIABLE: u32 = 59;
const OP_LOAD: u32 = 61;
const OP_ACCESS_CHAIN: u32 = 65;
const OP_DECORATE: u32 = 71;
const BUILT_IN: u32 = 11;
const SAMPLE_MASK: u32 = 20;
const INPUT: u32 = 1;
/// The place of the bound of all ids in the header.
const BOUND: usize = 3;

/// The variable, its type, and the type that this points to.
#[derive(Clone, Copy)]
struct Mask {
    variable: u32,
    pointer: u32,
    integer: u32,
}

fn found(words: &[u32]) -> Option<Mask> {
    let operands = |code, count: usize| {
        instructions(words).filter(move |one| one.code == code).filter_map(move |one| {
            let start = one.start + 1;
            words.get(start..start + count)
        })
    };
    let decorated = operands(OP_DECORATE, 3).find(|one| one.get(1..) == Some(&[BUILT_IN, SAMPLE_MASK]))?;
    let variable = *decorated.first()?;
    let declared = operands(OP_VARIABLE, 3).find(|one| one.get(1..) == Some(&[variable, INPUT]))?;
    let pointer = *declared.first()?;
    let pointed = operands(OP_TYPE_POINTER, 3).find(|one| one.first() == Some(&pointer))?;
    Some(Mask { variable, pointer, integer: *pointed.get(2)? })
}

/// The module with an array in the place of the integer.
pub(in crate::emit) fn as_array(words: Vec<u32>) -> Vec<u32> {
    let (Some(mask), Some(&bound)) = (found(&words), words.get(BOUND)) else { return words };
    let Mask { variable, pointer, integer } = mask;
    let [one, zero, array, array_pointer] = [0, 1, 2, 3].map(|index| bound + index);
    let mut next = bound + 4;
    let first = instructions(&words).next().map_or(words.len(), |found| found.start);
    let mut repaired = words.get(..first).unwrap_or(&[]).to_vec();
    for found in instructions(&words) {
        let length = words.get(found.start).map_or(0, |first| (first >> 16) as usize);
        let end = (found.start + length).min(words.len());
        let own = words.get(found.start..end).unwrap_or(&[]);
        match (found.code, own) {
            (OP_VARIABLE, [head, _, result, rest @ ..]) if *result == variable => {
                repaired.extend([4 << 16 | OP_CONSTANT, integer, one, 1, 4 << 16 | OP_CONSTANT, integer, zero, 0]);
                repaired.extend([4 << 16 | OP_TYPE_ARRAY, array, integer, one]);
                repaired.extend([4 << 16 | OP_TYPE_POINTER, array_pointer, INPUT, array]);
                repaired.extend([*head, array_pointer, *result]);
                repaired.extend(rest);
            }
            (OP_LOAD, [head, ty, result, from, rest @ ..]) if *from == variable => {
                repaired.extend([5 << 16 | OP_ACCESS_CHAIN, pointer, next, variable, zero]);
                repaired.extend([*head, *ty, *result, next]);
                repaired.extend(rest);
                next += 1;
            }
            _ => repaired.extend(own),
        }
    }
    if let Some(bound) = repaired.get_mut(BOUND) {
        *bound = next;
    }
    repaired
}

#[cfg(test)]
mod tests {
    use super::as_array;

    #[test]
    fn a_load_reads_the_first_element() {
        // OpDecorate %4 BuiltIn SampleMask; OpTypeInt %1; OpTypePointer %2 Input %1; OpVariable %4; OpLoad %5.
        let header = [0x0723_0203, 0x0001_0300, 0];
        let types = [4 << 16 | 71, 4, 11, 20, 4 << 16 | 21, 1, 32, 0, 4 << 16 | 32, 2, 1, 1];
        let words: Vec<u32> = [&header[..], &[6, 0], &types, &[4 << 16 | 59, 2, 4, 1, 4 << 16 | 61, 1, 5, 4]].concat();
        let array = [4 << 16 | 43, 1, 6, 1, 4 << 16 | 43, 1, 7, 0, 4 << 16 | 28, 8, 1, 6, 4 << 16 | 32, 9, 1, 8];
        let uses = [4 << 16 | 59, 9, 4, 1, 5 << 16 | 65, 2, 10, 4, 7, 4 << 16 | 61, 1, 5, 10];
        let expected: Vec<u32> = [&header[..], &[11, 0], &types, &array, &uses].concat();
        assert_eq!(as_array(words), expected);
    }

    #[test]
    fn other_modules_stay() {
        for words in [vec![], vec![1, 2, 3], vec![0, 0, 0, 9, 0, 9 << 16 | 71], vec![0, 0, 0, 9, 0, 2 << 16 | 17, 1]] {
            assert_eq!(as_array(words.clone()), words);
        }
    }
}
