//! [`Chunks`]: the declarations at the global scope of a text, as ranges of tokens.
//!
//! *In:* the tokens of a text. *Out:* one chunk for each declaration, function definition and struct, in order. *Holds:* tokens of
//! directives belong to no chunk; one that has directives inside says so.

use super::super::rewrite::directive;
use super::super::tokens::{Token, tokens};
use std::ops::Range;

/// A declaration or a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Chunk {
    /// Its tokens.
    pub(super) tokens: Range<usize>,
    /// Whether it is the definition of a function.
    pub(super) is_function: bool,
    /// Whether a directive is inside of it.
    pub(super) is_cut: bool,
}

/// A text with its tokens and its chunks.
pub(super) struct Chunks<'t> {
    pub(super) text: &'t str,
    pub(super) all: Vec<Token<'t>>,
    pub(super) list: Vec<Chunk>,
}

impl<'t> Chunks<'t> {
    /// Cuts a text.
    pub(super) fn new(text: &'t str) -> Self {
        let all = tokens(text);
        let directives = directives(text);
        let of_directive = |token: &Token<'_>| {
            let before = directives.partition_point(|line| line.start <= token.range.start);
            before
                .checked_sub(1)
                .and_then(|index| directives.get(index))
                .is_some_and(|line| line.end > token.range.start)
        };
        let mut list = Vec::new();
        let mut open: Option<Chunk> = None;
        let (mut depth, mut last, mut is_function) = (0_usize, "", false);
        for (index, token) in all.iter().enumerate() {
            if of_directive(token) {
                open.iter_mut().for_each(|chunk| chunk.is_cut = true);
                continue;
            }
            let chunk = open.get_or_insert(Chunk { tokens: index..index, is_function: false, is_cut: false });
            chunk.tokens.end = index + 1;
            match token.text {
                "(" | "[" | "{" => {
                    is_function |= depth == 0 && token.text == "{" && last == ")";
                    depth += 1;
                }
                ")" | "]" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            last = token.text;
            if depth == 0 && (token.text == ";" || token.text == "}" && is_function) {
                chunk.is_function = is_function;
                list.extend(open.take());
                is_function = false;
            }
        }
        list.extend(open);
        Self { text, all, list }
    }

    /// The chunk that has a token at an offset, and the token.
    pub(super) fn at(&self, offset: usize) -> Option<(&Chunk, usize)> {
        let token = self.all.binary_search_by_key(&offset, |token| token.range.start).ok()?;
        Some((self.list.iter().find(|chunk| chunk.tokens.contains(&token))?, token))
    }

    /// The tokens of a chunk.
    pub(super) fn of(&self, chunk: &Chunk) -> &[Token<'t>] {
        self.all.get(chunk.tokens.clone()).unwrap_or(&[])
    }

    /// The text of a token.
    pub(super) fn word(&self, index: usize) -> &str {
        self.all.get(index).map_or("", |token| token.text)
    }

    /// The place of a token.
    pub(super) fn place(&self, index: usize) -> Range<usize> {
        self.all.get(index).map_or(0..0, |token| token.range.clone())
    }

    /// The place of a chunk.
    pub(super) fn range(&self, chunk: &Chunk) -> Range<usize> {
        let last = chunk.tokens.end.saturating_sub(1);
        self.place(chunk.tokens.start).start..self.place(last).end
    }

    /// The start of the line that has a place.
    pub(super) fn line_start(&self, offset: usize) -> usize {
        self.text.get(..offset).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1)
    }
}

/// The lines of directives, with those that they continue on.
fn directives(text: &str) -> Vec<Range<usize>> {
    let code = glisten_sources::engines::code::without_comments(text);
    let (mut found, mut at, mut goes_on): (Vec<Range<usize>>, usize, bool) = (Vec::new(), 0, false);
    for line in code.split_inclusive('\n') {
        let range = at..at + line.len();
        at = range.end;
        if goes_on || directive(line).is_some() {
            goes_on = line.trim_end().ends_with('\\');
            found.push(range);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::Chunks;

    #[test]
    fn declarations_and_functions_are_apart() {
        let text = "#version 150 // a;\nuniform struct S { vec4 a; } s[2];\n#define F(x) \\\n  x;\nvoid f() { if (true) { } }\nin vec4\n#if 1\n p,\n#endif\n q;\n";
        let chunks = Chunks::new(text);
        let texts: Vec<&str> = chunks.list.iter().filter_map(|chunk| text.get(chunks.range(chunk))).collect();
        assert_eq!(texts[0], "uniform struct S { vec4 a; } s[2];");
        assert_eq!(texts[1], "void f() { if (true) { } }");
        assert!(texts[2].starts_with("in vec4") && chunks.list[2].is_cut && chunks.list[1].is_function);
        assert_eq!(chunks.list.len(), 3);
    }
}
