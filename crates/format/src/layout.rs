//! Lines of lexemes: where a line ends, how far it is indented, where blanks are.
//!
//! *In:* lexemes. *Out:* text. *Holds:* the lexemes are in it as they were, in their order; a line that a person has broken inside
//! of a statement stays broken.

use super::Options;
use super::branches::Branches;
use super::scan::{Kind, Lexeme};
use super::state::{Frame, State, brace_frame};
use std::collections::BTreeSet;

/// The space between two lexemes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Gap {
    None,
    Space,
    /// Before a comment behind code.
    Wide,
    Line {
        blank: bool,
    },
}

/// A lexeme with its place.
#[derive(Clone, Copy, Debug)]
struct Piece<'t> {
    lexeme: Lexeme<'t>,
    gap: Gap,
    /// The indentation of a line that begins with it.
    level: usize,
    /// The number of brackets around it.
    depth: usize,
    /// How good a place for the end of a line is before it; none if there may be none.
    cut: Option<u8>,
    /// Whether it opens statements on one line.
    is_one_line: bool,
    /// Whether it begins the body of a control, without braces and on the line of the control.
    is_body: bool,
}

/// The text of the lexemes.
pub(super) fn layout(lexemes: &[Lexeme<'_>], options: &Options) -> String {
    let mut expanded = BTreeSet::new();
    loop {
        let mut pieces = places(lexemes, options, &expanded);
        let before = expanded.len();
        for line in lines(&mut pieces) {
            if is_too_wide(line, options) {
                let opens = |piece: &&Piece<'_>| piece.is_one_line || piece.is_body;
                expanded.extend(line.iter().filter(opens).map(|piece| piece.lexeme.start));
            }
        }
        if expanded.len() == before {
            lines(&mut pieces).for_each(|line| cut(line, options));
            return print(&pieces, options);
        }
    }
}

/// The lines of pieces.
fn lines<'p, 't>(pieces: &'p mut [Piece<'t>]) -> impl Iterator<Item = &'p mut [Piece<'t>]> {
    pieces.chunk_by_mut(|_, next| !matches!(next.gap, Gap::Line { .. }))
}

fn places<'t>(lexemes: &[Lexeme<'t>], options: &Options, expanded: &BTreeSet<usize>) -> Vec<Piece<'t>> {
    let mut state = State::default();
    let mut branches: Branches<State> = Branches::default();
    let mut pieces: Vec<Piece<'t>> = Vec::with_capacity(lexemes.len());
    let mut code: Option<Lexeme<'t>> = None;
    let mut prefix = false;
    for (at, lexeme) in lexemes.iter().enumerate() {
        let before = at.checked_sub(1).and_then(|at| lexemes.get(at));
        let following = lexemes.get(at + 1);
        let next_code = lexemes.iter().skip(at).take(64).find(|one| !one.is_comment() && one.kind != Kind::Directive);
        if let Some(next) = next_code {
            state.settle(next);
        }
        if state.is_macro() && lexeme.lines > 0 && lexeme.kind == Kind::Word {
            state.end_of_statement();
        }
        let mut frame = brace_frame(code.as_ref(), &state);
        let opens = lexeme.is("{");
        if opens
            && matches!(frame, Frame::Code { .. })
            && !expanded.contains(&lexeme.start)
            && fits_on_one_line(lexemes, at)
        {
            frame = Frame::OneLine;
        }
        let is_prefix = is_prefix(lexeme, code.as_ref(), &state);
        let mut gap = gap(before, lexeme, following, &state, (opens.then_some(frame), prefix, is_prefix), options);
        let is_code = !lexeme.is_comment() && lexeme.kind != Kind::Directive;
        let goes_on = lexeme.is("if") && before.is_some_and(|before| before.is("else"));
        let is_body = is_code && state.body_next && !opens && !goes_on && gap == Gap::Space;
        if is_body && expanded.contains(&lexeme.start) {
            gap = Gap::Line { blank: false };
        }
        if is_code && state.body_next && !opens && matches!(gap, Gap::Line { .. }) {
            state.body_below();
        }
        let level = if lexeme.kind == Kind::Directive { 0 } else { state.level(lexeme) };
        let cut = rank(before, lexeme, is_prefix, &state);
        pieces.push(Piece {
            lexeme: *lexeme,
            gap,
            level,
            depth: state.frames.len(),
            cut,
            is_one_line: frame == Frame::OneLine && opens,
            is_body,
        });
        if lexeme.kind == Kind::Directive {
            branches.pass(lexeme.text, &mut state, true);
        }
        let hangs = following.is_some_and(|following| following.lines > 0 || following.kind == Kind::LineComment);
        state.step(lexeme, frame, hangs);
        if is_code {
            code = Some(*lexeme);
            prefix = is_prefix;
        }
    }
    pieces
}

/// Whether the statements of the `{` at an index are one, on its line.
fn fits_on_one_line(lexemes: &[Lexeme<'_>], open: usize) -> bool {
    if open
        .checked_sub(1)
        .and_then(|before| lexemes.get(before))
        .is_some_and(|before| before.is("else") || before.is("do"))
    {
        return false;
    }
    let mut ends = 0;
    for (at, lexeme) in lexemes.iter().enumerate().skip(open + 1).take(200) {
        if lexeme.lines > 0 || lexeme.is("{") || lexeme.kind == Kind::LineComment || lexeme.kind == Kind::Other {
            return false;
        }
        if lexeme.is("}") {
            let goes_on = lexemes.get(at + 1).is_some_and(|next| next.is("else") || next.is("while"));
            return ends == 1 && !goes_on;
        }
        ends += usize::from(lexeme.is(";"));
        if ends > 1 || matches!(lexeme.text, "if" | "for" | "while" | "do" | "switch" | "case" | "default") {
            return false;
        }
    }
    false
}

/// Whether a sign is a prefix operator (§5.1).
fn is_prefix(lexeme: &Lexeme<'_>, before: Option<&Lexeme<'_>>, state: &State) -> bool {
    if lexeme.kind != Kind::Sign {
        return false;
    }
    match lexeme.text {
        "!" | "~" => true,
        "+" | "-" | "++" | "--" => !state.mid || state.body_next || !before.is_some_and(is_operand),
        _ => false,
    }
}

/// Whether an operand may end with a lexeme.
fn is_operand(lexeme: &Lexeme<'_>) -> bool {
    match lexeme.kind {
        Kind::Word => !matches!(lexeme.text, "return" | "case" | "else" | "do" | "in" | "out" | "inout" | "const"),
        Kind::Sign => matches!(lexeme.text, ")" | "]" | "}" | "++" | "--"),
        _ => false,
    }
}

type Facts = (Option<Frame>, bool, bool);

/// The space between two lexemes: `opened` is the frame of a `{`; then whether the sign before is a prefix, and whether this one is.
fn gap(
    before: Option<&Lexeme<'_>>,
    lexeme: &Lexeme<'_>,
    following: Option<&Lexeme<'_>>,
    state: &State,
    (opened, prefix, is_prefix): Facts,
    options: &Options,
) -> Gap {
    let Some(before) = before else { return Gap::Line { blank: false } };
    let opens_block = before.is("{") && matches!(state.frames.last(), Some(Frame::Code { .. } | Frame::Members));
    let closes_block = lexeme.is("}");
    let blank = lexeme.lines > 1
        && !opens_block
        && !closes_block
        && (!state.mid || lexeme.kind == Kind::Directive || before.kind == Kind::Directive || lexeme.is_comment());
    let line = Gap::Line { blank };
    let as_written = |otherwise: Gap| if lexeme.lines > 0 { line } else { otherwise };
    let by_blank = if lexeme.spaced { Gap::Space } else { Gap::None };
    let ends_line = |kind: Kind| matches!(kind, Kind::LineComment | Kind::Directive | Kind::Other);
    if ends_line(before.kind) || matches!(lexeme.kind, Kind::Directive | Kind::Other) {
        return line;
    }
    if lexeme.is_comment() {
        let is_last = lexeme.kind == Kind::LineComment || following.is_none_or(|following| following.lines > 0);
        return as_written(if is_last { Gap::Wide } else { by_blank });
    }
    if before.kind == Kind::BlockComment {
        return as_written(if state.mid { by_blank } else { Gap::Space });
    }
    let innermost = state.frames.last();
    if closes_block {
        return match innermost {
            Some(Frame::OneLine) => Gap::Space,
            Some(Frame::List { .. }) => as_written(Gap::None),
            _ if before.is("{") => Gap::None,
            _ => line,
        };
    }
    if before.is("{") {
        return match innermost {
            Some(Frame::OneLine) => Gap::Space,
            Some(Frame::List { .. }) => as_written(Gap::None),
            _ => line,
        };
    }
    if let Some(frame) = opened {
        let is_inner = matches!(before.text, "(" | "{" | "[");
        return match frame {
            Frame::List { .. } => as_written(if is_inner || before.is("]") { Gap::None } else { Gap::Space }),
            _ if !state.mid && !state.body_next && !before.is(":") => line,
            Frame::Code { .. } | Frame::Members if options.braces_below => line,
            _ => Gap::Space,
        };
    }
    if lexeme.is(";") || lexeme.is(",") {
        return if state.mid || before.is(")") || before.is("}") { Gap::None } else { as_written(Gap::Space) };
    }
    if before.is("}") && !state.mid {
        let goes_on = lexeme.is("else") || state.waits_for(lexeme);
        return if goes_on && !options.braces_below { Gap::Space } else { line };
    }
    if state.body_next {
        return if before.is("else") && lexeme.is("if") { Gap::Space } else { as_written(Gap::Space) };
    }
    if !state.mid {
        return if innermost == Some(&Frame::OneLine) { Gap::Space } else { line };
    }
    // The parentheses of a call are where its name is.
    let is_call = lexeme.is("(") && before.kind == Kind::Word;
    let spacing = spacing(before, lexeme, state, prefix, is_prefix);
    if is_call { spacing } else { as_written(spacing) }
}

/// Whether there is a blank between two lexemes of a line.
fn spacing(before: &Lexeme<'_>, lexeme: &Lexeme<'_>, state: &State, prefix: bool, is_prefix: bool) -> Gap {
    let (left, right) = (before.text, lexeme.text);
    let is_none = match (left, right) {
        (_, ")" | "]") | ("(" | "[", _) | (_, "." | "::") | ("." | "::", _) => true,
        (_, ":") if state.label => true,
        (_, "++" | "--") if !is_prefix => true,
        (_, "(") => match before.kind {
            Kind::Word => !is_keyword_with_head(left),
            _ => prefix || matches!(left, ")" | "]" | "}"),
        },
        (_, "[") => before.kind == Kind::Word && left != "return" || matches!(left, ")" | "]" | "}"),
        // `- -a` is not `--a`.
        _ => prefix && !(is_prefix && left.ends_with(['+', '-']) && right.starts_with(['+', '-'])),
    };
    if is_none { Gap::None } else { Gap::Space }
}

fn is_keyword_with_head(word: &str) -> bool {
    matches!(
        word,
        "if" | "for" | "while" | "switch" | "return" | "case" | "else" | "do" | "in" | "out" | "inout" | "const"
    )
}

/// How good a place for the end of a line is before a lexeme, in a statement: the less, the better.
fn rank(before: Option<&Lexeme<'_>>, lexeme: &Lexeme<'_>, is_prefix: bool, state: &State) -> Option<u8> {
    let before = before.filter(|before| matches!(before.kind, Kind::Word | Kind::Sign))?;
    if !state.mid || state.body_next || !matches!(lexeme.kind, Kind::Word | Kind::Sign) || lexeme.is("{") {
        return None;
    }
    match (before.text, lexeme.text) {
        (";", ")" | ";") => None,
        ("," | ";", _) => Some(0),
        (_, "?") => Some(1),
        (_, ":") if !state.label => Some(1),
        (_, "||" | "^^") => Some(2),
        (_, "&&") => Some(3),
        (_, "==" | "!=" | "<" | ">" | "<=" | ">=") => Some(4),
        (_, "+" | "-") if !is_prefix => Some(5),
        (_, "*" | "/" | "%" | "|" | "&" | "^" | "<<" | ">>") => Some(6),
        ("=" | "+=" | "-=" | "*=" | "/=", _) => Some(9),
        _ => None,
    }
}

/// Whether a line without a comment behind it is too wide. Of a very long line, no more than its begin is looked at.
fn is_too_wide(line: &[Piece<'_>], options: &Options) -> bool {
    let Some(first) = line.first() else { return false };
    let end = line.iter().rposition(|piece| piece.gap != Gap::Wide).map_or(0, |last| last + 1);
    let mut width = first.level * options.columns();
    line.iter().take(end).enumerate().any(|(at, piece)| {
        width += columns(piece.lexeme.text) + usize::from(at > 0 && piece.gap == Gap::Space);
        width > options.width
    })
}

/// The columns of a text; of several lines those of the last.
fn columns(text: &str) -> usize {
    text.rsplit('\n').next().unwrap_or(text).chars().count()
}

/// Ends lines inside of a line that is too wide.
fn cut(mut line: &mut [Piece<'_>], options: &Options) {
    while is_too_wide(line, options) {
        let mut column = line.first().map_or(0, |first| first.level * options.columns());
        let mut best: Option<(usize, u8, usize)> = None;
        let mut beyond = None;
        for (at, piece) in line.iter().enumerate() {
            if at > 0 {
                column += usize::from(piece.gap == Gap::Space);
            }
            if let Some(rank) = piece.cut.filter(|_| at > 0) {
                let key = (piece.depth + usize::from(rank == 9) * 1000, rank, at);
                if column <= options.width + 1 {
                    let is_better = best.is_none_or(|(depth, least, _)| (key.0, key.1) <= (depth, least));
                    best = if is_better { Some(key) } else { best };
                } else {
                    beyond = beyond.or(Some(at));
                }
            }
            column += columns(piece.lexeme.text);
            // Nothing behind is better.
            if column > options.width + 1 && (best.is_some() || beyond.is_some()) {
                break;
            }
        }
        let Some(at) = best.map(|(_, _, at)| at).or(beyond) else { return };
        let Some((_, rest)) = line.split_at_mut_checked(at) else { return };
        if let Some(piece) = rest.first_mut() {
            piece.gap = Gap::Line { blank: false };
            piece.cut = None;
        }
        line = rest;
    }
}

fn print(pieces: &[Piece<'_>], options: &Options) -> String {
    let mut text = String::new();
    for piece in pieces {
        match piece.gap {
            Gap::None => {}
            Gap::Space => text.push(' '),
            Gap::Wide => text.push_str("  "),
            Gap::Line { blank } => {
                if !text.is_empty() {
                    text.push_str(if blank { "\n\n" } else { "\n" });
                }
                if piece.lexeme.kind != Kind::Other {
                    options.indent(&mut text, piece.level);
                }
            }
        }
        text.push_str(piece.lexeme.text);
    }
    if !text.is_empty() {
        text.push('\n');
    }
    text
}
