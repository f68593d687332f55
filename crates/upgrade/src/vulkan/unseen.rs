//! Declarations that no program sees, because a condition around them is false for all: what they are, by their text.
//!
//! *In:* a file with its facts. *Out:* facts for declarations of plain types, and a note for each other one. *Holds:* a declaration
//! that a program sees is left alone.

use super::chunks::{Chunk, Chunks};
use super::facts::{Fact, Loose, Numbered};
use super::files::File;
use super::numbers::{Numbers, Space};
use crate::tokens::closing;
use glisten_front::hir::Stage;
use std::collections::{BTreeMap, BTreeSet};

/// Words before a storage qualifier, and between it and the type.
static BESIDE: &[&str] =
    &["flat", "smooth", "noperspective", "centroid", "sample", "invariant", "lowp", "mediump", "highp", "const"];

/// Whether a word is a type of the language that a block may have.
pub(super) fn is_plain(word: &str) -> bool {
    extent(word).is_some()
}

/// The alignment and the size of a type of the language in std140.
fn extent(ty: &str) -> Option<(u32, u32)> {
    let vector = |n: u32| match n {
        2 => (8, 8),
        3 => (16, 12),
        _ => (16, 16),
    };
    let digit = |text: &str| text.parse::<u32>().ok().filter(|n| (2..=4).contains(n));
    match ty {
        "float" | "int" | "uint" | "bool" => return Some((4, 4)),
        _ => {}
    }
    if let Some(columns) = ty.strip_prefix("mat") {
        let columns = columns.split_once('x').map_or(Some(columns), |(columns, rows)| digit(rows).map(|_| columns))?;
        return digit(columns).map(|columns| (16, columns * 16));
    }
    let size = ["vec", "ivec", "uvec", "bvec"].iter().find_map(|prefix| ty.strip_prefix(prefix))?;
    digit(size).map(vector)
}

/// The facts of declarations that no program sees, and the places of those that are not understood.
pub(super) fn unseen(
    chunks: &Chunks<'_>,
    file: &File,
    facts: &BTreeMap<usize, Fact>,
    qualifiers: &BTreeSet<String>,
    numbers: &mut Numbers,
) -> (Vec<(usize, Fact)>, Vec<usize>) {
    let (mut found, mut left) = (Vec::new(), Vec::new());
    for chunk in chunks.list.iter().filter(|chunk| !chunk.is_function) {
        let range = chunks.range(chunk);
        if facts.range(range.clone()).next().is_some() {
            continue;
        }
        let Some((storage, at)) = storage(chunks, chunk, qualifiers) else { continue };
        match declared(chunks, chunk, (storage, at), file, numbers) {
            Some(list) => found.extend(list),
            None => left.push(range.start),
        }
    }
    (found, left)
}

/// The storage qualifier of a declaration, and the token after it.
fn storage<'t>(chunks: &'t Chunks<'_>, chunk: &Chunk, qualifiers: &BTreeSet<String>) -> Option<(&'t str, usize)> {
    let mut at = chunk.tokens.start;
    while at < chunk.tokens.end {
        let word = chunks.word(at);
        match word {
            "layout" => at = closing(&chunks.all, at + 1)? + 1,
            "uniform" | "in" | "out" => return Some((word, at + 1)),
            _ if BESIDE.contains(&word) || qualifiers.contains(word) => at += 1,
            _ => return None,
        }
    }
    None
}

/// The facts of a declaration; none if its type or the size of an array has to be computed.
fn declared(
    chunks: &Chunks<'_>,
    chunk: &Chunk,
    (storage, mut at): (&str, usize),
    file: &File,
    numbers: &mut Numbers,
) -> Option<Vec<(usize, Fact)>> {
    while BESIDE.contains(&chunks.word(at)) {
        at += 1;
    }
    let ty = chunks.word(at);
    // `layout(..) in;` declares nothing, and what is built in has its place.
    if ty == ";" || (at..chunk.tokens.end).any(|token| chunks.word(token).starts_with("gl_")) {
        return Some(Vec::new());
    }
    let is_block = chunks.word(at + 1) == "{";
    let stages: BTreeSet<Stage> = file.readers.iter().map(|(_, stage)| *stage).collect();
    let space = match (storage, stages.first()) {
        // A sampler of one stage or of several is the same.
        ("uniform", _) if is_block => Space::Buffer,
        ("uniform", _) => Space::Texture,
        (_, Some(_)) if stages.len() > 1 => return None,
        ("in", Some(Stage::Vertex)) => Space::Attribute,
        ("in", Some(Stage::Geometry)) => Space::GeometryInput,
        ("out", Some(Stage::Fragment)) => return None,
        _ => Space::Varying,
    };
    let mut node = |name: &str, size: u32| {
        let units: BTreeSet<usize> = file.readers.iter().map(|(unit, _)| *unit).collect();
        let nodes: Vec<usize> = units.iter().map(|unit| numbers.node(*unit, space, name, size, None)).collect();
        nodes.windows(2).for_each(|two| {
            if let [one, other] = two {
                numbers.join(*one, *other);
            }
        });
        nodes.first().copied()
    };
    let numbered = |node| Fact::Numbered(Numbered { space, node, plus: 0, component: 0, index: None, is_block });
    if is_block {
        return (storage == "uniform").then(|| Some(vec![(chunks.place(at).start, numbered(node(ty, 1)?))]))?;
    }
    let is_sampler = ty.trim_start_matches(['i', 'u']).starts_with("sampler");
    let one = extent(ty);
    if !is_sampler && one.is_none() {
        return None;
    }
    let mut found = Vec::new();
    loop {
        at += 1;
        let (name, place) = (chunks.word(at), chunks.place(at).start);
        let mut size = None;
        if chunks.word(at + 1) == "[" {
            let literal: u32 = chunks.word(at + 2).parse().ok().filter(|size| *size > 0)?;
            if chunks.word(at + 3) != "]" {
                return None;
            }
            size = Some(literal);
            at += 3;
        }
        let fact = if storage == "uniform" && !is_sampler {
            let (align, bytes) = one?;
            let of_array = |n: u32| (16, bytes.next_multiple_of(16).saturating_mul(n));
            let plain = size.map_or_else(|| ty.to_owned(), |n| format!("{ty}[{n}]"));
            let extent = size.map_or((align, bytes), of_array);
            let structs = BTreeSet::new();
            Fact::Loose(Loose { name: name.to_owned(), extent, plain: Some(plain), structs, offset: u32::MAX })
        } else {
            let columns = one.map_or(1, |(_, bytes)| bytes.div_ceil(16)).max(1) * if is_sampler { 2 } else { 1 };
            numbered(node(name, columns.saturating_mul(size.unwrap_or(1)))?)
        };
        found.push((place, fact));
        at += 1;
        // An initializer is the host's.
        let mut depth = 0_usize;
        while at < chunk.tokens.end && !(depth == 0 && matches!(chunks.word(at), "," | ";")) {
            match chunks.word(at) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            at += 1;
        }
        if chunks.word(at) != "," {
            return (chunks.word(at) == ";").then_some(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::extent;

    #[test]
    fn sizes_of_types() {
        let all = ["float", "vec3", "mat4", "mat2x3", "ivec2", "Light", "sampler2D", "mat5"].map(extent);
        let known = [Some((4, 4)), Some((16, 12)), Some((16, 64)), Some((16, 32)), Some((8, 8)), None, None, None];
        assert_eq!(all, known);
    }
}
