//! The places that are kept as they are: declarations whose brackets do not match, which have a character that no token has, or
//! which do not parse.
//!
//! *In:* lexemes, and places of errors. *Out:* lexemes, with one of [`Kind::Other`] for each place.

use super::BYTE_ORDER_MARK;
use super::branches::Branches;
use super::scan::{Kind, Lexeme};
use std::ops::Range;

/// The deepest nesting of brackets, and of `#if`s, that is laid out.
const MAX_DEPTH: usize = 200;

/// A run of declarations.
struct Chunk {
    range: Range<usize>,
    sound: bool,
}

/// The lexemes, with those of what cannot be laid out as one.
pub(super) fn keep<'t>(text: &'t str, lexemes: Vec<Lexeme<'t>>, broken: &[Range<usize>]) -> Vec<Lexeme<'t>> {
    let chunks = chunks(text, &lexemes);
    // Where the first line begins.
    let begin = if text.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len_utf8() } else { 0 };
    let mut out: Vec<Lexeme<'t>> = Vec::with_capacity(lexemes.len());
    for chunk in chunks {
        let Some(inside) = lexemes.get(chunk.range) else { continue };
        let (Some(first), Some(last)) = (inside.first(), inside.last()) else { continue };
        let place = first.start..last.end();
        let is_broken = broken.iter().any(|error| error.start < place.end && place.start <= error.end);
        if chunk.sound && !is_broken {
            out.extend_from_slice(inside);
            continue;
        }
        let line = text.get(..place.start).and_then(|before| before.rfind('\n')).map_or(begin, |at| at + 1);
        let is_blank = text.get(line..place.start).is_some_and(|blank| blank.trim().is_empty());
        let start = if is_blank && (first.lines > 0 || line == begin) { line } else { place.start };
        let kept = text.get(start..place.end).unwrap_or("");
        match out.last_mut() {
            Some(before) if before.kind == Kind::Other => {
                before.text = text.get(before.start..place.end).unwrap_or(before.text);
            }
            _ => out.push(Lexeme { kind: Kind::Other, text: kept, start, ..*first }),
        }
    }
    out
}

fn chunks(text: &str, lexemes: &[Lexeme<'_>]) -> Vec<Chunk> {
    let mut chunks = Vec::new();
    let mut stack: Vec<&str> = Vec::new();
    let mut branches: Branches<Vec<&str>> = Branches::default();
    let (mut start, mut sound) = (0, true);
    for (at, lexeme) in lexemes.iter().enumerate() {
        let at_margin = lexeme.lines > 0
            && (lexeme.start == 0 || text.as_bytes().get(lexeme.start - 1) == Some(&b'\n'))
            && (lexeme.kind == Kind::Word || lexeme.is_comment());
        if !sound && at_margin {
            chunks.push(Chunk { range: start..at, sound: false });
            (start, sound) = (at, true);
            stack.clear();
        }
        match lexeme.kind {
            Kind::Other => sound = false,
            Kind::Directive => {
                let is_deeper = lexeme.text.get(1..).is_some_and(|name| name.trim_start().starts_with("if"));
                sound &= !is_deeper || branches.depth() < MAX_DEPTH;
                branches.pass(lexeme.text, &mut stack, sound);
            }
            Kind::Sign => {
                match lexeme.text {
                    "(" | "[" | "{" => {
                        sound &= stack.len() < MAX_DEPTH;
                        stack.push(lexeme.text);
                    }
                    ")" | "]" | "}" => {
                        let open = stack.pop();
                        sound &= matches!((open, lexeme.text), (Some("("), ")") | (Some("["), "]") | (Some("{"), "}"));
                    }
                    _ => {}
                }
                let ends = stack.is_empty() && (lexeme.text == ";" || lexeme.text == "}");
                let follows = lexemes.get(at + 1).is_none_or(|next| !next.is(";") && !next.is_comment());
                if sound && ends && follows && branches.depth() == 0 {
                    chunks.push(Chunk { range: start..at + 1, sound: true });
                    start = at + 1;
                }
            }
            _ => {}
        }
    }
    let sound = sound && stack.is_empty();
    chunks.push(Chunk { range: start..lexemes.len(), sound });
    chunks
}
