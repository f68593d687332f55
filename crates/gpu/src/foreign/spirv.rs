//! SPIR-V of others: its words, the limits on them, and `spirv-val`.
//!
//! *In:* bytes. *Out:* words in the order of this machine. *Holds:* [`validate`] is passed before a module reaches a
//! driver, because a driver may do anything with one that is not valid.

use crate::Error;
use std::io::Write;
use std::process::{Command, Stdio};

/// The first word of a module (SPIR-V 2.3).
const MAGIC: u32 = 0x0723_0203;

/// The largest bound of identifiers (SPIR-V 2.17, "Universal Limits").
const MAX_BOUND: u32 = 0x003f_ffff;

/// The number of structured constructs up to which naga's reader, which recurses over them, keeps within its stack.
const MAX_CONSTRUCTS: usize = 4096;

/// OpLoopMerge and OpSelectionMerge.
const MERGES: [u32; 2] = [246, 247];

/// The program that validates SPIR-V.
const VALIDATOR: &str = "spirv-val";

/// The words of a module whose instructions follow each other to its end.
pub(super) fn words(bytes: &[u8]) -> Result<Vec<u32>, String> {
    let no = |why: &str| Err(format!("it is no SPIR-V: {why}"));
    let (chunks, rest) = bytes.as_chunks::<4>();
    let mut words: Vec<u32> = chunks.iter().map(|chunk| u32::from_le_bytes(*chunk)).collect();
    if words.first().is_some_and(|first| first.swap_bytes() == MAGIC) {
        words.iter_mut().for_each(|word| *word = word.swap_bytes());
    }
    if words.first() != Some(&MAGIC) {
        return no("it does not begin with the magic number");
    }
    if !rest.is_empty() || words.len() < 5 {
        return no("it ends in the middle of a word or of its header");
    }
    if words.get(3).is_some_and(|bound| *bound > MAX_BOUND) {
        return no("it has more identifiers than SPIR-V allows");
    }
    let (mut at, mut constructs) = (5, 0);
    while let Some(word) = words.get(at) {
        let (length, opcode) = ((word >> 16) as usize, word & 0xffff);
        if length == 0 || at + length > words.len() {
            return no(&format!("the instruction at word {at} does not end"));
        }
        constructs += usize::from(MERGES.contains(&opcode));
        at += length;
    }
    if constructs > MAX_CONSTRUCTS {
        return Err(format!("it has {constructs} loops and branches; at most {MAX_CONSTRUCTS} are read"));
    }
    Ok(words)
}

/// Checks a module with `spirv-val`.
pub(super) fn validate(name: &str, words: &[u32]) -> Result<(), Error> {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
    let child = Command::new(VALIDATOR)
        .args(["--target-env", "vulkan1.1", "-"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = child.map_err(|_| Error::Lacks(lacks(name)))?;
    if let Some(mut input) = child.stdin.take() {
        // It may have rejected the module before it read all of it.
        let _ = input.write_all(&bytes);
    }
    let output = child.wait_with_output().map_err(|error| Error::Lacks(format!("{VALIDATOR} did not run: {error}")))?;
    if output.status.success() {
        return Ok(());
    }
    let told = [output.stderr, output.stdout].map(|bytes| String::from_utf8_lossy(&bytes).trim().to_owned());
    let first =
        told.iter().flat_map(|text| text.lines()).find(|line| !line.is_empty()).unwrap_or("it does not say why");
    let first: String = first.trim_start_matches("error: ").chars().take(300).collect();
    Err(Error::Foreign(format!("`{name}`: it is no valid SPIR-V: {VALIDATOR}: {first}")))
}

fn lacks(name: &str) -> String {
    format!(
        "`{name}` cannot be checked: `{VALIDATOR}` is not on the path, and a driver may do anything with SPIR-V that is not \
         valid\nhelp: install it (Debian, Ubuntu: `apt-get install spirv-tools`), or judge the module as WGSL (`naga A.spv \
         A.wgsl`)"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bytes(words: &[u32]) -> Vec<u8> {
        words.iter().flat_map(|word| word.to_le_bytes()).collect()
    }

    #[test]
    fn what_is_no_module_is_told() {
        let header = [MAGIC, 0x0001_0300, 0, 5, 0];
        let with = |more: &[u32]| bytes(&[&header[..], more].concat());
        let cases = [
            (b"hello world!".to_vec(), "magic"),
            (bytes(&header[..3]), "header"),
            ([with(&[]), vec![1]].concat(), "middle of a word"),
            (with(&[0x0000_0011]), "does not end"),
            (with(&[0x0004_0011, 1]), "does not end"),
            (bytes(&[MAGIC, 0x0001_0300, 0, u32::MAX, 0]), "identifiers"),
            (with(&vec![0x0001_00f7; MAX_CONSTRUCTS + 1]), "at most"),
        ];
        for (bytes, part) in cases {
            let told = words(&bytes).expect_err(part);
            assert!(told.contains(part), "{told}");
        }
        assert_eq!(words(&with(&[0x0002_0011, 1])).map(|words| words.len()), Ok(7));
    }

    #[test]
    fn either_byte_order_is_read() {
        let words_of = [MAGIC, 0x0001_0300, 0, 5, 0];
        let swapped: Vec<u8> = words_of.iter().flat_map(|word| word.to_be_bytes()).collect();
        assert_eq!(words(&swapped), Ok(words_of.to_vec()));
    }
}
