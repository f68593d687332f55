//! Puts the comments inside of a function next to the statements that they belong to.
//!
//! *In:* the tree of a function, whose statements know their places in the source, and the text. *Out:* the tree with
//! comments. *Holds:* a comment on a line of its own goes above the statement that follows it, or to the end of its block;
//! a comment behind code goes behind the statement of that line. If that statement was left out, so is its comment.

use super::comments::of_wgsl;
use super::tree::{BlockId, Body, StmtKind};
use glisten_front::source::{SourceMap, Span};

/// A comment in the body of a function. Positions are offsets in the file.
#[derive(Debug)]
struct Comment {
    start: usize,
    lines: Vec<String>,
    /// The brace that it is in.
    brace: usize,
    /// The end of the token before it, if that is on its line.
    behind: Option<usize>,
    /// The token after it.
    next: usize,
}

/// A statement of the tree with its range in the file.
#[derive(Clone, Copy, Debug)]
struct Candidate {
    start: usize,
    end: usize,
    brace: usize,
    block: BlockId,
    at: usize,
    compound: bool,
}

/// Adds the comments of the function whose head is at `head`.
pub(super) fn add(body: &mut Body<'_>, sources: &SourceMap, head: Span) {
    if !head.is_known() {
        return;
    }
    let Some(id) = sources.file_of(head) else { return };
    let file = sources.file(id);
    let base = file.base() as usize;
    let text: &str = file.text();
    let Some(from) = (head.start as usize).checked_sub(base) else { return };
    let found = read(text, from);
    let mut candidates = Vec::new();
    collect(body, BlockId(0), base, &found, &mut candidates);
    space(body, text, &candidates);
    for comment in &found.comments {
        put(body, text, comment, &candidates, &found);
    }
}

/// The comments of a body, and its braces.
#[derive(Debug, Default)]
struct Found {
    comments: Vec<Comment>,
    /// Where blocks begin and end, in order, with the brace that is innermost from there on.
    braces: Vec<(usize, usize)>,
    /// Where the body begins and ends.
    range: (usize, usize),
}

impl Found {
    /// The innermost brace around a position.
    fn brace_at(&self, at: usize) -> usize {
        let after = self.braces.partition_point(|(start, _)| *start < at);
        after.checked_sub(1).and_then(|index| self.braces.get(index)).map_or(0, |(_, brace)| *brace)
    }
}

/// Reads the first block after a position.
fn read(text: &str, from: usize) -> Found {
    let bytes = text.as_bytes();
    let mut found = Found::default();
    let mut open: Vec<usize> = Vec::new();
    let mut last = from;
    let mut at = from;
    while let Some(&byte) = bytes.get(at) {
        let rest = bytes.get(at..).unwrap_or_default();
        let len = comment_len(rest);
        if len > 0 {
            if let (Some(brace), Some(own)) = (open.last(), text.get(at..at + len)) {
                let newline = text.get(last..at).is_some_and(|between| between.contains('\n'));
                let behind = (!newline).then_some(last);
                let lines = lines_of(text, at, own);
                found.comments.push(Comment { start: at, lines, brace: *brace, behind, next: 0 });
            }
            at += len;
            continue;
        }
        match byte {
            b'{' => {
                open.push(at);
                found.braces.push((at, at));
            }
            b'}' => {
                open.pop();
                found.braces.push((at, open.last().copied().unwrap_or(0)));
            }
            _ => {}
        }
        if !byte.is_ascii_whitespace() {
            last = at + 1;
            for comment in found.comments.iter_mut().rev().take_while(|comment| comment.next == 0) {
                comment.next = at;
            }
        }
        if byte == b'}' && open.is_empty() {
            break;
        }
        if byte == b';' && open.is_empty() && found.braces.is_empty() {
            // A prototype has no body.
            return Found::default();
        }
        at += 1;
    }
    found.range = (found.braces.first().map_or(from, |(start, _)| *start), at);
    found
}

/// The length of the comment at the beginning of a text; 0 if there is none. The end of the line is not a part of it.
fn comment_len(bytes: &[u8]) -> usize {
    if bytes.starts_with(b"//") {
        return bytes.iter().take_while(|byte| **byte != b'\n' && **byte != b'\r').count();
    }
    if bytes.starts_with(b"/*") {
        let end = bytes.get(2..).unwrap_or_default().windows(2).position(|pair| pair == b"*/");
        return end.map_or(bytes.len(), |end| end + 4);
    }
    0
}

/// The lines of a comment without the indentation of the source.
fn lines_of(text: &str, start: usize, comment: &str) -> Vec<String> {
    let before = text.get(..start).unwrap_or("");
    let column = before.len() - before.rfind('\n').map_or(0, |at| at + 1);
    let lines: Vec<String> = comment
        .lines()
        .enumerate()
        .map(|(index, line)| {
            let blanks = line.len() - line.trim_start().len();
            let cut = if index == 0 { 0 } else { blanks.min(column) };
            line.get(cut..).unwrap_or("").trim_end().to_owned()
        })
        .collect();
    of_wgsl(&lines).into_iter().map(|line| line.trim_end().to_owned()).collect()
}

/// The statements of the tree in their order.
fn collect(body: &Body<'_>, id: BlockId, base: usize, found: &Found, candidates: &mut Vec<Candidate>) {
    let Some(block) = body.blocks.get(id.0) else { return };
    for (at, stmt) in block.statements.iter().enumerate() {
        for span in [stmt.span, stmt.declared] {
            let Some(range) = span.to_range().filter(|_| !matches!(stmt.kind, StmtKind::Empty)) else { continue };
            let (Some(start), Some(end)) = (range.start.checked_sub(base), range.end.checked_sub(base)) else {
                continue;
            };
            if start > found.range.0 && end <= found.range.1 {
                let mut compound = false;
                stmt.kind.for_each_block(&mut |_| compound = true);
                let brace = found.brace_at(start);
                candidates.push(Candidate { start, end, brace, block: id, at, compound });
            }
        }
        stmt.kind.for_each_block(&mut |inner| collect(body, inner, base, found, candidates));
    }
}

/// Keeps the empty lines between the paragraphs of the source.
fn space(body: &mut Body<'_>, text: &str, candidates: &[Candidate]) {
    let mut last = usize::MAX;
    for one in candidates {
        // Several statements may come from one.
        let is_first = std::mem::replace(&mut last, one.start) != one.start;
        if is_first && follows_empty_line(text, one.start) {
            above(body, *one, &[String::new()]);
        }
    }
}

/// Whether there is an empty line in front of something, or in front of its line.
fn follows_empty_line(text: &str, at: usize) -> bool {
    let before = text.get(..at).unwrap_or("");
    let between = before.len() - before.trim_end().len();
    before.get(before.len() - between..).is_some_and(|blank| blank.matches('\n').count() > 1)
}

fn put(body: &mut Body<'_>, text: &str, comment: &Comment, candidates: &[Candidate], found: &Found) {
    match comment.behind {
        Some(token) => put_behind(body, text, comment, token, candidates, found),
        None => put_above(body, text, comment, candidates),
    }
}

/// A comment on a line of its own.
fn put_above(body: &mut Body<'_>, text: &str, comment: &Comment, candidates: &[Candidate]) {
    let next = text.get(comment.next..).unwrap_or("");
    if next.starts_with('}') {
        let last = candidates.iter().rev().find(|one| one.brace == comment.brace && one.start < comment.start);
        if let Some(block) = last.and_then(|last| body.blocks.get_mut(last.block.0)) {
            block.end.extend_from_slice(&comment.lines);
        }
        return;
    }
    let exact = candidates.iter().find(|one| one.start == comment.next);
    let around =
        || candidates.iter().rev().find(|one| !one.compound && one.start < comment.next && comment.next < one.end);
    let begins = ["else", "case", "default", "{", "do"].iter().any(|word| next.starts_with(word));
    // The same paragraph goes up to an empty line.
    let paragraph = paragraph_end(next) + comment.next;
    let later = || {
        let after = candidates.iter().filter(|one| one.start > comment.next);
        after.min_by_key(|one| one.start).filter(|one| begins || (one.brace == comment.brace && one.start < paragraph))
    };
    let Some(target) = exact.or_else(around).or_else(later) else { return };
    if follows_empty_line(text, comment.start) {
        above(body, *target, &[String::new()]);
    }
    above(body, *target, &comment.lines);
}

/// The length of a text up to its first empty line.
fn paragraph_end(text: &str) -> usize {
    let mut end = 0;
    for line in text.split_inclusive('\n') {
        if line.trim().is_empty() {
            break;
        }
        end += line.len();
    }
    end
}

fn above(body: &mut Body<'_>, target: Candidate, lines: &[String]) {
    let stmt = body.blocks.get_mut(target.block.0).and_then(|block| block.statements.get_mut(target.at));
    if let Some(stmt) = stmt {
        stmt.above.extend_from_slice(lines);
    }
}

/// A comment behind code.
fn put_behind(
    body: &mut Body<'_>,
    text: &str,
    comment: &Comment,
    token: usize,
    candidates: &[Candidate],
    found: &Found,
) {
    let before = text.get(..token).unwrap_or("");
    let single = comment.lines.len() == 1;
    let opens = [")", "else", ":"].iter().any(|end| before.ends_with(end));
    if opens || before.ends_with('{') && token > found.range.0 + 1 {
        // The head of a block.
        let first = candidates.iter().filter(|one| one.start > comment.start).min_by_key(|one| one.start);
        let inside = first.filter(|first| {
            let around = candidates.iter().any(|one| one.compound && one.start < comment.start && first.end <= one.end);
            around && (single || before.ends_with('{')) && (!before.ends_with('{') || first.brace + 1 == token)
        });
        let Some(first) = inside else { return };
        if !single {
            above(body, *first, &comment.lines);
        } else if let Some(block) = body.blocks.get_mut(first.block.0) {
            block.head.extend_from_slice(&comment.lines);
        }
        return;
    }
    if before.ends_with('{') {
        if let Some(first) = candidates.iter().min_by_key(|one| one.start) {
            above(body, *first, &comment.lines);
        }
        return;
    }
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    let on_line = |one: &&Candidate| one.end <= token && one.end >= line && (!one.compound || before.ends_with('}'));
    let ended = candidates.iter().filter(on_line).max_by_key(|one| (one.end, !one.compound, one.block.0, one.at));
    let within = || candidates.iter().find(|one| one.start < comment.start && comment.start < one.end && !one.compound);
    match ended {
        Some(ended) if single => {
            let stmt = body.blocks.get_mut(ended.block.0).and_then(|block| block.statements.get_mut(ended.at));
            if let Some(stmt) = stmt {
                stmt.behind.extend_from_slice(&comment.lines);
            }
        }
        Some(ended) => above(body, *ended, &comment.lines),
        None => {
            if let Some(within) = within() {
                above(body, *within, &comment.lines);
            }
        }
    }
}
