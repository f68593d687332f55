//! Colors of the text by what it means (LSP 3.17, `textDocument/semanticTokens`).
//!
//! *Holds:* every comment, number, keyword and name has a token; what conditions leave out is colored as a comment.

use super::diagnostics::inactive_ranges;
use super::hover::own_place;
use crate::analysis::Analysis;
use crate::state::State;
use crate::text::{Encoding, Text};
use crate::uri;
use glisten_format::scan::{Kind, Lexeme, scan};
use glisten_front::analysis::Denoted;
use glisten_front::builtin::functions;
use glisten_front::hir::{LocalKind, Storage};
use glisten_front::index::{Occurrence, Role, SymbolKind};
use glisten_front::source::comments::comment_len;
use glisten_front::syntax::keywords;
use glisten_front::syntax::token::TokenKind;
use lsp_types::{
    SemanticToken, SemanticTokenModifier, SemanticTokenType, SemanticTokens, SemanticTokensLegend,
    SemanticTokensRangeParams, SemanticTokensRangeResult, SemanticTokensResult, Uri,
};
use std::collections::BTreeMap;
use std::ops::Range;
use std::path::Path;

/// The kind of a token, as an index into the legend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Color {
    Comment,
    Keyword,
    String,
    Number,
    Type,
    Struct,
    Interface,
    Function,
    Macro,
    Variable,
    Parameter,
    Property,
}

const DECLARATION: u32 = 1;
const DEFINITION: u32 = 2;
const READONLY: u32 = 4;
const LIBRARY: u32 = 8;
const MODIFICATION: u32 = 16;

/// The names of the colors and of the bits.
pub(super) fn legend() -> SemanticTokensLegend {
    SemanticTokensLegend {
        token_types: vec![
            SemanticTokenType::COMMENT,
            SemanticTokenType::KEYWORD,
            SemanticTokenType::STRING,
            SemanticTokenType::NUMBER,
            SemanticTokenType::TYPE,
            SemanticTokenType::STRUCT,
            SemanticTokenType::INTERFACE,
            SemanticTokenType::FUNCTION,
            SemanticTokenType::MACRO,
            SemanticTokenType::VARIABLE,
            SemanticTokenType::PARAMETER,
            SemanticTokenType::PROPERTY,
        ],
        token_modifiers: vec![
            SemanticTokenModifier::DECLARATION,
            SemanticTokenModifier::DEFINITION,
            SemanticTokenModifier::READONLY,
            SemanticTokenModifier::DEFAULT_LIBRARY,
            SemanticTokenModifier::MODIFICATION,
        ],
    }
}

/// A token.
struct Token {
    range: Range<usize>,
    color: Color,
    bits: u32,
}

/// The tokens of a document.
pub(super) fn full(state: &mut State<'_>, uri: &Uri) -> Option<SemanticTokensResult> {
    let (text, tokens) = tokens(state, uri)?;
    Some(SemanticTokensResult::Tokens(encoded(&text, &tokens, 0..text.text.len(), state.encoding)))
}

/// The tokens of a range.
pub(super) fn range(state: &mut State<'_>, params: &SemanticTokensRangeParams) -> Option<SemanticTokensRangeResult> {
    let (text, tokens) = tokens(state, &params.text_document.uri)?;
    let start = text.offset(params.range.start, state.encoding);
    let end = text.offset(params.range.end, state.encoding);
    Some(SemanticTokensRangeResult::Tokens(encoded(&text, &tokens, start..end, state.encoding)))
}

/// The tokens in the encoding of the protocol: each by its distance from the one before, and on one line.
fn encoded(text: &Text, tokens: &[Token], within: Range<usize>, encoding: Encoding) -> SemanticTokens {
    let mut data = Vec::new();
    let (mut line, mut column) = (0, 0);
    for token in tokens.iter().filter(|token| token.range.start < within.end && token.range.end > within.start) {
        let (first, last) = (text.line_of(token.range.start), text.line_of(token.range.end));
        for at in first..=last {
            let start = token.range.start.max(text.start_of(at));
            let end = token.range.end.min(text.start_of(at) + text.line(at).len());
            let Some(piece) = text.text.get(start..end).filter(|piece| !piece.trim().is_empty()) else { continue };
            let position = text.position(start, encoding);
            let delta_line = position.line - line;
            let delta_start = if delta_line == 0 { position.character - column } else { position.character };
            (line, column) = (position.line, position.character);
            data.push(SemanticToken {
                delta_line,
                delta_start,
                length: encoding.units(piece) as u32,
                token_type: token.color as u32,
                token_modifiers_bitset: token.bits,
            });
        }
    }
    SemanticTokens { result_id: None, data }
}

fn tokens(state: &mut State<'_>, uri: &Uri) -> Option<(Text, Vec<Token>)> {
    let path = uri::path(uri);
    let text = state.documents.get(&path)?.text.clone();
    let inactive = inactive_ranges(state, &path);
    let analyses = state.analyses_of(&path);
    let mut tokens = Vec::new();
    match state.pieces(&path) {
        // It has one source of tokens for a document, which has to be that of the host language; the extension colors the strings.
        Some(_) if state.client.is_code => return None,
        Some(mut pieces) => {
            pieces.sort_by_key(|piece| piece.inside.start);
            for piece in pieces {
                if let Some(analysis) = analyses.iter().find(|analysis| analysis.key.name == piece.program) {
                    add_tokens(analysis, &path, &piece.text, &inactive, &mut tokens);
                }
            }
        }
        None => add_tokens(analyses.first()?, &path, &text.text, &inactive, &mut tokens),
    }
    Some((text, tokens))
}

fn add_tokens(analysis: &Analysis, path: &Path, text: &str, inactive: &[Range<usize>], tokens: &mut Vec<Token>) {
    let names = Names { analysis, path, found: analysis.occurrences(path) };
    // Both lists are in the order of the text: how far what begins up to here is left out.
    let (mut ranges, mut left_out) = (inactive.iter().peekable(), 0);
    for lexeme in scan(text) {
        while let Some(range) = ranges.next_if(|range| range.start <= lexeme.start) {
            left_out = left_out.max(range.end);
        }
        if lexeme.end() <= left_out {
            tokens.push(Token { range: lexeme.start..lexeme.end(), color: Color::Comment, bits: 0 });
            continue;
        }
        match lexeme.kind {
            Kind::LineComment | Kind::BlockComment => {
                tokens.push(Token { range: lexeme.start..lexeme.end(), color: Color::Comment, bits: 0 });
            }
            Kind::Directive => directive(&names, &lexeme, tokens),
            Kind::Word => tokens.extend(word(&names, text, &lexeme)),
            Kind::Sign | Kind::Other => {}
        }
    }
}

/// The tokens of a directive: its name, files, macros and numbers.
fn directive(names: &Names<'_>, lexeme: &Lexeme<'_>, tokens: &mut Vec<Token>) {
    let text = lexeme.text;
    let blank = |text: &str| text.len() - text.trim_start().len();
    let sign = 1 + blank(text.get(1..).unwrap_or(""));
    let rest = text.get(sign..).unwrap_or("");
    let name = rest.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(rest.len());
    let mut at = sign + name;
    tokens.push(Token { range: lexeme.start..lexeme.start + at, color: Color::Macro, bits: 0 });
    let is_include = rest.get(..name).is_some_and(|name| name == "include" || name == "moj_import");
    while let Some(rest) = text.get(at..).filter(|rest| !rest.is_empty()) {
        let start = lexeme.start + at;
        let Some(first) = rest.chars().next() else { break };
        let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
        let comment = comment_len(rest);
        let (length, color) = if comment > 0 {
            (comment, Some((Color::Comment, 0)))
        } else if is_include && matches!(first, '"' | '<') {
            let close = if first == '"' { '"' } else { '>' };
            (
                rest.get(1..).and_then(|rest| rest.find(close)).map_or(rest.len(), |end| end + 2),
                Some((Color::String, 0)),
            )
        } else if first.is_ascii_digit() {
            (
                rest.find(|letter: char| !is_part(letter) && letter != '.').unwrap_or(rest.len()),
                Some((Color::Number, 0)),
            )
        } else if is_part(first) {
            let length = rest.find(|letter: char| !is_part(letter)).unwrap_or(rest.len());
            let word = rest.get(..length).unwrap_or("");
            (length, names.color(start).or_else(|| keyword(word)))
        } else {
            (first.len_utf8(), None)
        };
        if let Some((color, bits)) = color {
            tokens.push(Token { range: start..start + length, color, bits });
        }
        at += length.max(1);
    }
}

fn keyword(word: &str) -> Option<(Color, u32)> {
    let row = keywords::TABLE.iter().find(|row| row.spelling == word)?;
    let is_type = matches!(row.kind, TokenKind::Type | TokenKind::Void);
    Some((if is_type { Color::Type } else { Color::Keyword }, 0))
}

fn word(names: &Names<'_>, text: &str, lexeme: &Lexeme<'_>) -> Option<Token> {
    let range = lexeme.start..lexeme.end();
    let starts = |test: fn(char) -> bool| lexeme.text.starts_with(test);
    if starts(|first| first.is_ascii_digit() || first == '.') {
        return Some(Token { range, color: Color::Number, bits: 0 });
    }
    let is_after_dot = text.get(..lexeme.start).is_some_and(|before| before.trim_end().ends_with('.'));
    let other = || {
        if is_after_dot {
            return Some((Color::Property, 0));
        }
        let is_function = !functions::named(lexeme.text).is_empty();
        keyword(lexeme.text).or_else(|| is_function.then_some((Color::Function, LIBRARY)))
    };
    let (color, bits) = names.color(lexeme.start).or_else(other)?;
    Some(Token { range, color, bits })
}

/// The names of a file.
struct Names<'a> {
    analysis: &'a Analysis,
    path: &'a Path,
    found: BTreeMap<usize, Occurrence>,
}

impl Names<'_> {
    /// The color of a name by what it denotes.
    fn color(&self, offset: usize) -> Option<(Color, u32)> {
        let found = self.found.get(&offset)?;
        let role = match found.role {
            Role::Declaration => DECLARATION,
            Role::Definition => DEFINITION,
            Role::Write => MODIFICATION,
            Role::Read => 0,
        };
        let symbol = self.analysis.symbol(found.symbol);
        let (color, bits) = match symbol.kind {
            SymbolKind::Macro => (Color::Macro, 0),
            SymbolKind::MacroParameter => (Color::Parameter, 0),
            SymbolKind::Builtin if functions::named(&symbol.name).is_empty() => (Color::Variable, LIBRARY),
            SymbolKind::Builtin => (Color::Function, LIBRARY),
            SymbolKind::Declared if symbol.places.len() == 1 => declared(self.analysis, *symbol.places.first()?)?,
            SymbolKind::Declared => declared(self.analysis, own_place(self.analysis, &symbol.places, self.path)?)?,
        };
        Some((color, bits | role))
    }
}

fn declared(analysis: &Analysis, (view, denoted): (usize, Denoted)) -> Option<(Color, u32)> {
    let shader = &analysis.compiled.inspection.view(view)?.shader;
    Some(match denoted {
        Denoted::Global(id) => match shader.globals.get(id.index())?.storage {
            Storage::Const | Storage::Uniform | Storage::In => (Color::Variable, READONLY),
            Storage::Out | Storage::Private => (Color::Variable, 0),
        },
        Denoted::Local(function, local) => {
            match shader.functions.get(function.index())?.locals.get(local.index())?.kind {
                LocalKind::Param(_) => (Color::Parameter, 0),
                LocalKind::Variable => (Color::Variable, 0),
                LocalKind::Const => (Color::Variable, READONLY),
            }
        }
        Denoted::Function(_) => (Color::Function, 0),
        Denoted::Struct(_) => (Color::Struct, 0),
        Denoted::Block(_) => (Color::Interface, 0),
        Denoted::Member(..) | Denoted::Components(_) => (Color::Property, 0),
        Denoted::Length(_) | Denoted::Builtin => (Color::Function, LIBRARY),
        Denoted::Broken(_) => (Color::Variable, 0),
    })
}
