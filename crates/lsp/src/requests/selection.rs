//! The ranges that a selection grows to (LSP 3.17, `textDocument/selectionRange`): the word, then expressions, statements and declarations of
//! the tree, then the text.

use crate::analysis::Analysis;
use crate::cut::open_brackets;
use crate::state::State;
use crate::uri;
use glisten_front::index::View;
use glisten_front::source::Span;
use glisten_front::syntax::ast::{DeclarationKind, Stmt, StmtKind, SwitchItem};
use lsp_types::{SelectionRange, SelectionRangeParams};
use std::ops::Range;
use std::path::Path;

/// The most ranges of an answer: the innermost ones, and the whole text.
const DEEPEST: usize = 64;

/// Answers the request.
pub(super) fn ranges(state: &mut State<'_>, params: &SelectionRangeParams) -> Option<Vec<SelectionRange>> {
    let path = uri::path(&params.text_document.uri);
    if state.pieces(&path).is_some() {
        // The host language has its own.
        return None;
    }
    let text = state.documents.get(&path)?.text.clone();
    let analyses = state.analyses_of(&path);
    let mut answers = Vec::new();
    for position in &params.positions {
        let offset = text.offset(*position, state.encoding);
        let mut ranges: Vec<Range<usize>> = text.word_at(offset).into_iter().collect();
        ranges.push(0..text.text.len());
        ranges.extend(brackets(&text.text, offset));
        if let Some(analysis) = analyses.first() {
            for view in analysis.views_of(&path) {
                ranges.extend(of_tree(analysis, view, &path, offset));
            }
        }
        ranges.sort_by_key(|range| (range.end - range.start, range.start));
        ranges.dedup();
        // Each contains the one before.
        let mut chain: Vec<Range<usize>> = Vec::new();
        for range in ranges {
            if chain.last().is_none_or(|inner| range.start <= inner.start && inner.end <= range.end) {
                chain.push(range);
            }
        }
        // The answer nests; nobody grows a selection so often.
        if chain.len() > DEEPEST {
            chain.drain(DEEPEST - 1..chain.len() - 1);
        }
        let mut answer: Option<SelectionRange> = None;
        for range in chain.into_iter().rev() {
            let range = text.range(range, state.encoding);
            answer = Some(SelectionRange { range, parent: answer.map(Box::new) });
        }
        answers.extend(answer);
    }
    Some(answers)
}

/// The text between the brackets around a place.
fn brackets(text: &str, offset: usize) -> Vec<Range<usize>> {
    let Some(before) = text.get(..offset) else { return Vec::new() };
    let mut open = open_brackets(before);
    // The brackets that open after the place.
    let mut inner: Vec<char> = Vec::new();
    let mut ranges = Vec::new();
    for (at, letter) in text.get(offset..).unwrap_or("").char_indices() {
        let sign = match letter {
            '(' | '[' | '{' => {
                inner.push(letter);
                continue;
            }
            ')' => '(',
            ']' => '[',
            '}' => '{',
            _ => continue,
        };
        if inner.last() == Some(&sign) {
            inner.pop();
        } else if let Some(place) = open.iter().rposition(|(_, other)| *other == sign) {
            let start = open.get(place).map_or(0, |(start, _)| *start);
            open.truncate(place);
            ranges.push(start + 1..offset + at);
            ranges.push(start..offset + at + 1);
        }
        if open.is_empty() || ranges.len() > DEEPEST * 2 {
            break;
        }
    }
    ranges
}

fn of_tree(analysis: &Analysis, view: &View, path: &Path, offset: usize) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut add = |span: Span| {
        if let Some(place) = analysis.named_place(span)
            && !span.expansion.is_some()
            && path.as_os_str() == place.file.as_str()
            && place.start <= offset
            && offset <= place.end
        {
            ranges.push(place.start..place.end);
        }
    };
    view.ast.exprs.iter().for_each(|expr| add(expr.span));
    for declaration in &view.ast.declarations {
        add(declaration.span);
        if let DeclarationKind::Function(_, body) = &declaration.kind {
            let mut pending: Vec<&Stmt> = body.iter().collect();
            while let Some(statement) = pending.pop() {
                add(statement.span);
                pending.extend(inner(&statement.kind));
            }
        }
    }
    ranges
}

/// The statements in a statement.
fn inner(kind: &StmtKind) -> Vec<&Stmt> {
    match kind {
        StmtKind::Block(body) => body.iter().collect(),
        StmtKind::If { arms, otherwise } => arms.iter().map(|(_, arm)| arm).chain(otherwise.as_deref()).collect(),
        StmtKind::Switch { body, .. } => body
            .iter()
            .filter_map(|item| if let SwitchItem::Stmt(statement) = item { Some(statement) } else { None })
            .collect(),
        StmtKind::For { init, body, .. } => vec![init, body],
        StmtKind::While { body, .. } | StmtKind::DoWhile { body, .. } => vec![body],
        _ => Vec::new(),
    }
}
