//! The style of shaders in strings.
//!
//! *In:* a file, its shaders, and what formats GLSL. *Out:* the file with its shaders formatted. *Holds:* everything outside of them stays
//! as it is; an interpolation keeps its text; the shader keeps the indentation that it has in its file. A string with escapes outside
//! of comments stays as it is, as does one whose interpolation cannot be stood for by a word.

use super::{Program, Shader};
use crate::engines::code::without_comments;

/// The text of a file after all its shaders are formatted.
pub fn styled(text: &str, programs: &[Program], format: &mut dyn FnMut(&str) -> String) -> String {
    let mut shaders: Vec<&Shader> = programs.iter().flat_map(|program| &program.shaders).collect();
    shaders.sort_by_key(|shader| std::cmp::Reverse(shader.inside.start));
    let mut result = text.to_owned();
    for shader in shaders {
        if let Some(new) = shader_in_style(text, shader, format) {
            result.replace_range(shader.inside.clone(), &new);
        }
    }
    result
}

/// The new inside of a string.
fn shader_in_style(text: &str, shader: &Shader, format: &mut dyn FnMut(&str) -> String) -> Option<String> {
    let inside = text.get(shader.inside.clone())?;
    let start = shader.inside.start;
    let code = without_comments(inside);
    let is_in_code = |range: &std::ops::Range<usize>| {
        code.get(range.start - start..range.end - start).is_none_or(|code| !code.trim().is_empty())
    };
    // Where the host joins lines, GLSL joins them, too.
    let joins_lines = |range: &std::ops::Range<usize>| {
        text.get(range.clone()).is_some_and(|escape| escape.starts_with('\\') && escape.ends_with(['\n', '\r']))
    };
    let changes_code = |range: &std::ops::Range<usize>| is_in_code(range) && !joins_lines(range);
    if shader.is_joined || shader.escapes.iter().any(|escape| changes_code(&escape.range)) {
        return None;
    }
    let (filled, words) = filled(inside, shader)?;
    let first = filled.find('\n').map_or("", |end| filled.get(..end).unwrap_or(""));
    if !filled.contains('\n') {
        return None;
    }
    let margin = margin(&filled);
    let begins_below = matches!(first.trim(), "" | "\\");
    let body = if begins_below { filled.get(first.len() + 1..)? } else { &filled };
    // The blanks before the closing quote are the host's.
    let tail = body.rfind('\n').map_or("", |end| body.get(end + 1..).unwrap_or(""));
    let tail = if tail.trim().is_empty() { tail } else { "" };
    let ends_below = body.ends_with('\n') || !tail.is_empty();
    let formatted = format(&without_margin(body, &margin));
    let line_end = if formatted.ends_with("\r\n") { "\r\n" } else { "\n" };
    let formatted = formatted.trim_end_matches(['\n', '\r']);
    let mut new = String::with_capacity(inside.len());
    if begins_below {
        new.push_str(first);
        new.push('\n');
    }
    for (number, line) in formatted.split('\n').enumerate() {
        if number > 0 {
            new.push('\n');
        }
        if !line.trim().is_empty() && (number > 0 || begins_below) {
            new.push_str(&margin);
        }
        new.push_str(line);
    }
    if ends_below {
        new.push_str(line_end);
        new.push_str(tail);
    }
    restored(&new, &words)
}

/// The text with a word for each interpolation, and the words with what they stand for.
fn filled(inside: &str, shader: &Shader) -> Option<(String, Vec<(String, String)>)> {
    let (mut text, mut words, mut at) = (String::new(), Vec::new(), 0);
    for (number, hole) in shader.holes.iter().enumerate() {
        let range = hole.range.start - shader.inside.start..hole.range.end - shader.inside.start;
        let own = inside.get(range.clone())?;
        let mut after = inside.get(range.end..).unwrap_or("").bytes();
        let width = own.lines().next().unwrap_or("").chars().count().saturating_sub(8);
        let word = match (after.next(), after.next()) {
            // `${x}.0` is a number.
            (Some(b'.'), Some(b'0'..=b'9')) => format!("9{number:04}7{}", "8".repeat(width)),
            _ => format!("hole{number}x{}", "o".repeat(width)),
        };
        if inside.contains(&word) {
            return None;
        }
        let word = if hole.is_alone { format!("/*{word}*/") } else { word };
        text.push_str(inside.get(at..range.start)?);
        text.push_str(&word);
        words.push((word, own.to_owned()));
        at = range.end;
    }
    text.push_str(inside.get(at..)?);
    Some((text, words))
}

/// The text with the interpolations again. Nothing if one is not there exactly once.
fn restored(text: &str, words: &[(String, String)]) -> Option<String> {
    let mut text = text.to_owned();
    for (word, own) in words.iter().rev() {
        if text.matches(word.as_str()).count() != 1 {
            return None;
        }
        text = text.replacen(word.as_str(), own, 1);
    }
    Some(text)
}

/// The blanks that all lines after the first begin with. Directives may stand further left.
fn margin(text: &str) -> String {
    let lines = text.lines().skip(1).filter(|line| !line.trim().is_empty());
    let blanks = |line: &str| line.get(..line.len() - line.trim_start().len()).unwrap_or("").to_owned();
    let of_code = lines.clone().filter(|line| !line.trim_start().starts_with('#')).map(blanks);
    let common = |one: String, other: String| {
        let length = one.bytes().zip(other.bytes()).take_while(|(a, b)| a == b).count();
        one.get(..length).unwrap_or("").to_owned()
    };
    of_code.reduce(common).or_else(|| lines.map(blanks).reduce(common)).unwrap_or_default()
}

fn without_margin(text: &str, margin: &str) -> String {
    let own = |line: &str| {
        let length = line.bytes().zip(margin.bytes()).take_while(|(a, b)| a == b).count();
        line.get(length..).unwrap_or("").to_owned()
    };
    text.split('\n').map(own).collect::<Vec<_>>().join("\n")
}
