//! Source lines in SPIR-V (`-g`), including those of included files.
//!
//! naga counts lines in one text with one name. It gets all files concatenated, at their global offsets. Afterwards,
//! every `OpLine` is mapped back to its file, and each file gets its own `OpString` and `OpSource`. Superfluous once
//! naga's `spv::DebugInfo` holds several files.
//!
//! *In:* the texts, and the SPIR-V words that naga wrote. *Out:* the words with the lines of the files on disk.

use glisten_front::source::{SourceMap, Span};
use std::sync::Arc;

const OP_SOURCE_CONTINUED: u32 = 2;
const OP_SOURCE: u32 = 3;
const OP_STRING: u32 = 7;
const OP_LINE: u32 = 8;
/// SPIR-V's number for the language GLSL, and its version.
const GLSL: u32 = 2;
const VERSION: u32 = 150;
/// The number of words in the header; the fourth is the bound of the ids.
const HEADER: usize = 5;
const BOUND: usize = 3;
/// The largest number of bytes of text in one instruction, whose length has 16 bits.
const CHUNK: usize = 200_000;

/// A file within the text in which naga counts lines.
struct LineFile {
    name: String,
    text: Arc<str>,
    /// The line of the whole text at which the file begins, counted from 0.
    first_line: u32,
    id: u32,
}

/// All files as one text.
pub(in crate::emit) struct SourceLines {
    files: Vec<LineFile>,
    /// The file of the entry point; naga writes its name.
    main: usize,
    pub(in crate::emit) text: String,
}

impl SourceLines {
    /// The texts that a module comes from; `None` if nothing in it has a position.
    pub(in crate::emit) fn of(module: &naga::Module, sources: &SourceMap) -> Option<Self> {
        let entry = module.entry_points.first()?;
        let (_, span) = entry.function.body.span_iter().find(|(_, span)| span.is_defined())?;
        let range = span.to_range()?;
        let of_entry = sources.file_of(Span::new(range.start as u32, range.end as u32))?;
        let (mut text, mut files, mut main) = (String::new(), Vec::new(), 0);
        for (id, file) in sources.files() {
            // Between two files there is one byte.
            while text.len() < file.base() as usize {
                text.push('\n');
            }
            let first_line = text.bytes().filter(|byte| *byte == b'\n').count() as u32;
            if id == of_entry {
                main = files.len();
            }
            files.push(LineFile { name: file.name().to_owned(), text: file.text().clone(), first_line, id: 0 });
            text.push_str(file.text());
        }
        text.push_str("\n\n");
        Some(Self { files, main, text })
    }

    /// The name that naga is to write.
    pub(in crate::emit) fn name(&self) -> &str {
        self.files.get(self.main).map_or("", |file| file.name.as_str())
    }

    /// Maps every line back to its file.
    pub(in crate::emit) fn restored(mut self, words: &[u32]) -> Vec<u32> {
        let Some(own) = instructions(words).find(|found| found[0] & 0xffff == OP_STRING).map(|found| found[1]) else {
            return words.to_vec();
        };
        let used: Vec<usize> = instructions(words).filter_map(|found| Some(self.place(found)?.0)).collect();
        let mut result = words[..HEADER].to_vec();
        for (index, file) in self.files.iter_mut().enumerate() {
            if index == self.main {
                file.id = own;
            } else if used.contains(&index) {
                file.id = result[BOUND];
                result[BOUND] += 1;
            }
        }
        for found in instructions(words) {
            match found[0] & 0xffff {
                OP_STRING if found[1] == own => self.strings(&mut result),
                OP_SOURCE | OP_SOURCE_CONTINUED => {}
                OP_LINE => match self.place(found) {
                    Some((file, line)) => result.extend([found[0], self.files[file].id, line, found[3]]),
                    None => result.extend(found),
                },
                _ => result.extend(found),
            }
        }
        result
    }

    /// The file of an `OpLine`, and the line in it, counted from 1.
    fn place(&self, instruction: &[u32]) -> Option<(usize, u32)> {
        let [first, _, line, _] = *instruction else { return None };
        let line = line.checked_sub(1).filter(|_| first & 0xffff == OP_LINE)?;
        let index = self.files.partition_point(|file| file.first_line <= line).checked_sub(1)?;
        Some((index, line - self.files.get(index)?.first_line + 1))
    }

    /// Writes the name and the text of every file in use, the names first, as SPIR-V's section order requires.
    fn strings(&self, words: &mut Vec<u32>) {
        let used = || self.files.iter().filter(|file| file.id != 0);
        for file in used() {
            push(words, OP_STRING, &[file.id], file.name.as_bytes());
        }
        for file in used() {
            let (first, mut rest) = cut(&file.text);
            push(words, OP_SOURCE, &[GLSL, VERSION, file.id], first.as_bytes());
            while !rest.is_empty() {
                let (chunk, behind) = cut(rest);
                push(words, OP_SOURCE_CONTINUED, &[], chunk.as_bytes());
                rest = behind;
            }
        }
    }
}

/// Splits off as much text as one instruction can hold.
fn cut(text: &str) -> (&str, &str) {
    let mut end = text.len().min(CHUNK);
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    text.split_at(end)
}

/// Adds an instruction that ends in a string.
fn push(words: &mut Vec<u32>, op: u32, operands: &[u32], text: &[u8]) {
    let mut bytes = text.to_vec();
    bytes.push(0);
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let len = 1 + operands.len() + bytes.len() / 4;
    words.push((len as u32) << 16 | op);
    words.extend(operands);
    words.extend(bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])));
}

/// The instructions after the header, each with its first word.
fn instructions(words: &[u32]) -> impl Iterator<Item = &[u32]> {
    let mut rest = words.get(HEADER..).unwrap_or_default();
    std::iter::from_fn(move || {
        let len = (*rest.first()? >> 16) as usize;
        let (instruction, behind) = rest.split_at_checked(len.max(1))?;
        rest = behind;
        Some(instruction)
    })
}
