//! The parts that can be folded (LSP 3.17, `textDocument/foldingRange`): brackets, comments, runs of includes, and the groups of `#if`.

use crate::state::State;
use crate::uri;
use glisten_format::scan::{Kind, Lexeme, scan};
use lsp_types::{FoldingRange, FoldingRangeKind, Uri};

/// The lines that are folded into the first of them.
struct Fold {
    first: usize,
    last: usize,
    kind: Option<FoldingRangeKind>,
}

/// Answers the request.
pub(super) fn ranges(state: &mut State<'_>, uri: &Uri) -> Option<Vec<FoldingRange>> {
    let path = uri::path(uri);
    if state.pieces(&path).is_some() {
        // The host language has its own.
        return None;
    }
    let text = &state.documents.get(&path)?.text;
    let lexemes = scan(&text.text);
    let line = |offset: usize| text.line_of(offset);
    let mut folds = Vec::new();
    brackets(&lexemes, &line, &mut folds);
    comments(&lexemes, &line, &mut folds);
    directives(&lexemes, &line, &mut folds);
    folds.retain(|fold| fold.first < fold.last);
    folds.sort_by_key(|fold| (fold.first, std::cmp::Reverse(fold.last)));
    let range = |fold: Fold| FoldingRange {
        start_line: fold.first as u32,
        end_line: fold.last as u32,
        kind: fold.kind,
        ..FoldingRange::default()
    };
    Some(folds.into_iter().map(range).collect())
}

fn brackets(lexemes: &[Lexeme<'_>], line: &dyn Fn(usize) -> usize, folds: &mut Vec<Fold>) {
    let mut open: Vec<(&str, usize)> = Vec::new();
    for lexeme in lexemes.iter().filter(|lexeme| lexeme.kind == Kind::Sign) {
        match lexeme.text {
            "{" | "(" | "[" => open.push((lexeme.text, line(lexeme.start))),
            "}" | ")" | "]" => {
                let opening = match lexeme.text {
                    "}" => "{",
                    ")" => "(",
                    _ => "[",
                };
                let Some(place) = open.iter().rposition(|(sign, _)| *sign == opening) else { continue };
                let first = open.get(place).map_or(0, |(_, line)| *line);
                open.truncate(place);
                // The line of the closing bracket stays.
                folds.push(Fold { first, last: line(lexeme.start).saturating_sub(1), kind: None });
            }
            _ => {}
        }
    }
}

fn comments(lexemes: &[Lexeme<'_>], line: &dyn Fn(usize) -> usize, folds: &mut Vec<Fold>) {
    let mut run: Option<(usize, usize)> = None;
    let mut end = |run: &mut Option<(usize, usize)>| {
        if let Some((first, last)) = run.take() {
            folds.push(Fold { first, last, kind: Some(FoldingRangeKind::Comment) });
        }
    };
    for lexeme in lexemes {
        let (first, last) = (line(lexeme.start), line(lexeme.end()));
        match (lexeme.kind, &mut run) {
            (Kind::LineComment, Some((_, before))) if first == *before + 1 => *before = first,
            (Kind::LineComment, _) => {
                end(&mut run);
                run = Some((first, first));
            }
            (Kind::BlockComment, _) => {
                end(&mut run);
                run = Some((first, last));
                end(&mut run);
            }
            _ => end(&mut run),
        }
    }
    end(&mut run);
}

fn directives(lexemes: &[Lexeme<'_>], line: &dyn Fn(usize) -> usize, folds: &mut Vec<Fold>) {
    let mut groups: Vec<usize> = Vec::new();
    let mut includes: Option<(usize, usize)> = None;
    for lexeme in lexemes.iter().filter(|lexeme| lexeme.kind == Kind::Directive) {
        let here = line(lexeme.start);
        let name = lexeme.text.trim_start_matches('#').trim_start();
        let name = name.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').next().unwrap_or("");
        if matches!(name, "elif" | "else" | "endif")
            && let Some(first) = groups.pop()
        {
            folds.push(Fold { first, last: here.saturating_sub(1), kind: Some(FoldingRangeKind::Region) });
        }
        if matches!(name, "if" | "ifdef" | "ifndef" | "elif" | "else") {
            groups.push(here);
        }
        match (name, &mut includes) {
            ("include", Some((_, last))) if here == *last + 1 => *last = here,
            ("include", _) => {
                let before = includes.replace((here, here));
                folds.extend(before.map(imports));
            }
            _ => {}
        }
    }
    folds.extend(includes.map(imports));
}

fn imports((first, last): (usize, usize)) -> Fold {
    Fold { first, last, kind: Some(FoldingRangeKind::Imports) }
}
