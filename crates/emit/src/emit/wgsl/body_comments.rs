//! Puts the comments inside of a function next to the statements that they belong to.
//!
//! *In:* the tree of a function, whose statements know their places in the source, and the text. *Out:* the tree with
//! comments. *Holds:* a comment on a line of its own goes above the statement that follows it, or to the end of its block;
//! a comment behind code goes behind the statement of that line. If that statement was left out, so is its comment.

use super::commented::{Braces, Candidate, Candidates};
use super::comments::of_wgsl;
use super::tree::Body;
use glisten_front::source::comments::comment_len;
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
    let candidates = Candidates::of(body, base, &found.braces);
    space(body, text, &candidates);
    for comment in &found.comments {
        put(body, text, comment, &candidates, &found);
    }
}

/// The comments of a body, and its braces.
#[derive(Debug, Default)]
struct Found {
    comments: Vec<Comment>,
    braces: Braces,
}

/// Reads the first block after a position.
fn read(text: &str, from: usize) -> Found {
    let bytes = text.as_bytes();
    let mut found = Found::default();
    let mut open: Vec<usize> = Vec::new();
    let mut last = from;
    let mut at = from;
    while let Some(&byte) = bytes.get(at) {
        // Inside of a character of several bytes there is none.
        let len = text.get(at..).map_or(0, comment_len);
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
                found.braces.list.push((at, at));
            }
            b'}' => {
                open.pop();
                found.braces.list.push((at, open.last().copied().unwrap_or(0)));
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
        if byte == b';' && open.is_empty() && found.braces.list.is_empty() {
            // A prototype has no body.
            return Found::default();
        }
        at += 1;
    }
    found.braces.range = (found.braces.list.first().map_or(from, |(start, _)| *start), at);
    found
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

/// Keeps the empty lines between the paragraphs of the source.
fn space(body: &mut Body<'_>, text: &str, candidates: &Candidates) {
    let mut last = usize::MAX;
    for one in candidates.iter() {
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

fn put(body: &mut Body<'_>, text: &str, comment: &Comment, candidates: &Candidates, found: &Found) {
    match comment.behind {
        Some(token) => put_behind(body, text, comment, token, candidates, found),
        None => put_above(body, text, comment, candidates),
    }
}

/// A comment on a line of its own.
fn put_above(body: &mut Body<'_>, text: &str, comment: &Comment, candidates: &Candidates) {
    let next = text.get(comment.next..).unwrap_or("");
    if next.starts_with('}') {
        let last = candidates.last_in(comment.brace, comment.start);
        if let Some(block) = last.and_then(|last| body.blocks.get_mut(last.block.0)) {
            block.end.extend_from_slice(&comment.lines);
        }
        return;
    }
    let exact = candidates.from(comment.next).filter(|one| one.start == comment.next);
    let around = || {
        let around = candidates.simple(comment.next, comment.next + 1);
        around.max_by_key(|(number, _)| *number).map(|(_, one)| one)
    };
    let begins = ["else", "case", "default", "{", "do"].iter().any(|word| next.starts_with(word));
    let later = || {
        let after = candidates.from(comment.next + 1)?;
        let is_near = || after.brace == comment.brace && is_one_paragraph(text, comment.next, after.start);
        (begins || is_near()).then_some(after)
    };
    let Some(target) = exact.or_else(around).or_else(later) else { return };
    if follows_empty_line(text, comment.start) {
        above(body, *target, &[String::new()]);
    }
    above(body, *target, &comment.lines);
}

/// Whether no line between two places is empty.
fn is_one_paragraph(text: &str, from: usize, to: usize) -> bool {
    let between = text.get(from..to).unwrap_or("");
    // The last line goes on at `to`.
    let whole = between.rfind('\n').map_or("", |end| between.get(..end).unwrap_or(""));
    whole.lines().all(|line| !line.trim().is_empty())
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
    candidates: &Candidates,
    found: &Found,
) {
    let before = text.get(..token).unwrap_or("");
    let single = comment.lines.len() == 1;
    let opens = [")", "else", ":"].iter().any(|end| before.ends_with(end));
    if opens || before.ends_with('{') && token > found.braces.range.0 + 1 {
        // The head of a block.
        let inside = candidates.from(comment.start + 1).filter(|first| {
            let around = candidates.is_around(comment.start, first.end);
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
        if let Some(first) = candidates.from(0) {
            above(body, *first, &comment.lines);
        }
        return;
    }
    let line = before.rfind('\n').map_or(0, |at| at + 1);
    let simple = candidates.simple(token, line).map(|(_, one)| one).filter(|one| one.end <= token);
    let compound = before.ends_with('}').then(|| candidates.that_end(line, token)).into_iter().flatten();
    let ended = simple.chain(compound).max_by_key(|one| (one.end, !one.compound, one.block.0, one.at));
    let within = || {
        let around = candidates.simple(comment.start, comment.start + 1);
        around.min_by_key(|(number, _)| *number).map(|(_, one)| one)
    };
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
