//! Declarations in the text: layouts of what stays, and the lines of the loose uniforms, which go into a block.
//!
//! *In:* a text with the facts about its declarations. *Out:* edits; or the reason why a declaration cannot be rewritten.

use super::super::names::free;
use super::super::rewrite::{Edit, comment_above};
use super::super::tokens::closing;
use super::chunks::{Chunk, Chunks};
use super::conditions::{Conditions, Open};
use super::definitions::Definitions;
use super::dialect::{Dialect, Numbering};
use super::facts::{Fact, Loose, Numbered, spelled};
use super::numbers::{Numbers, Space};
use super::place::{Ground, Leaving};
use glisten_sources::engines::code::{is_name, without_comments, words};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Words before the type of a declaration.
static QUALIFIERS: &[&str] = &["uniform", "lowp", "mediump", "highp", "const", "in", "out"];

/// Qualifiers of a varying, which a variable of one stage does not have.
static OF_VARYINGS: &[&str] = &["in", "out", "flat", "smooth", "noperspective", "centroid", "sample", "invariant"];

/// A text that is rewritten, with what is known about it.
pub(super) struct Text<'a> {
    pub(super) name: &'a str,
    pub(super) chunks: &'a Chunks<'a>,
    pub(super) conditions: &'a Conditions,
    pub(super) definitions: &'a Definitions<'a>,
    pub(super) facts: &'a BTreeMap<usize, Fact>,
    /// Macros that stand for qualifiers.
    pub(super) qualifiers: &'a BTreeSet<String>,
    /// The names in all texts.
    pub(super) names: &'a BTreeSet<String>,
    pub(super) dialect: &'a Dialect,
    pub(super) numbers: &'a Numbers,
    /// Whether a variable after the block stands for `gl_FragCoord`.
    pub(super) is_turned: bool,
}

/// A name with its declaration.
struct Declared<'a> {
    place: usize,
    fact: &'a Fact,
    /// The declaration, without uses of macros before it.
    chunk: Chunk,
    /// The token of the name.
    token: usize,
    /// The tokens of the macro use that it is an argument of.
    call: Option<Range<usize>>,
}

/// A loose uniform's lines in its block.
pub(super) struct Line {
    pub(super) place: usize,
    /// The comment above it.
    pub(super) above: Vec<String>,
    /// The type, the name and the sizes of arrays.
    pub(super) code: String,
    /// The comment behind it.
    pub(super) behind: Option<String>,
    /// The value that it begins with in OpenGL.
    pub(super) initializer: Option<String>,
    pub(super) conditions: Vec<Open>,
}

impl Line {
    /// The comment behind it, with the value that it begins with in OpenGL.
    pub(super) fn comment(&self) -> Option<String> {
        match (&self.behind, &self.initializer) {
            (None, None) => None,
            (Some(comment), None) => Some(comment.clone()),
            (None, Some(value)) => Some(format!("// initially {value}")),
            (Some(comment), Some(value)) if comment.starts_with("//") => Some(format!("{comment} (initially {value})")),
            (Some(comment), Some(value)) => Some(format!("{comment} // initially {value}")),
        }
    }
}

/// The loose uniforms of a text, and the edits that take them away.
#[derive(Default)]
pub(super) struct Moved {
    pub(super) lines: Vec<Line>,
    /// The removal of the old declarations.
    pub(super) edits: Vec<Edit>,
    /// The place of the block, and the conditions there; none if the text declares no loose uniform.
    pub(super) place: Option<(usize, Vec<Open>)>,
    /// The blocks of the host that the text needs.
    pub(super) known: BTreeSet<usize>,
}

/// The words of a layout.
enum Words {
    /// The declaration stays as it is.
    Kept,
    /// It has these words.
    Layout(Vec<String>),
    /// It is a variable of its own stage.
    Inside,
}

impl<'a> Text<'a> {
    fn declared(&self) -> Result<Vec<Declared<'a>>, String> {
        let mut found = Vec::new();
        for (place, fact) in self.facts {
            let Some((chunk, token)) = self.chunks.at(*place) else {
                let word: String = self
                    .chunks
                    .text
                    .get(*place..)
                    .unwrap_or("")
                    .chars()
                    .take_while(|letter| letter.is_alphanumeric() || *letter == '_')
                    .collect();
                return Err(format!("`{word}` is declared inside of a macro of `{}`; declare it outside", self.name));
            };
            let call = self.call(chunk, token);
            let mut chunk = chunk.clone();
            // A use of a macro that declares something ends without a semicolon.
            let used = found.last().and_then(|before: &Declared<'_>| before.call.clone());
            if let Some(used) = used.filter(|used| chunk.tokens.contains(&used.start) && used.end <= token) {
                chunk.tokens.start = used.end;
            }
            if chunk.is_cut && call.is_none() {
                let word = self.chunks.word(token);
                return Err(format!("the declaration of `{word}` in `{}` has a directive inside", self.name));
            }
            found.push(Declared { place: *place, fact, chunk, token, call });
        }
        Ok(found)
    }

    /// The use of a macro that has a token among its arguments.
    fn call(&self, chunk: &Chunk, token: usize) -> Option<Range<usize>> {
        let mut depth = 0_usize;
        for index in (chunk.tokens.start..token).rev() {
            match self.chunks.word(index) {
                ")" | "]" => depth += 1,
                "(" if depth == 0 => {
                    let name = index.checked_sub(1).filter(|name| *name >= chunk.tokens.start)?;
                    if matches!(self.chunks.word(name), "layout" | "]") {
                        return None;
                    }
                    let close = closing(&self.chunks.all, index)?;
                    let end = close + 1 + usize::from(self.chunks.word(close + 1) == ";");
                    return Some(name..end);
                }
                "(" | "[" => depth = depth.checked_sub(1)?,
                _ => {}
            }
        }
        None
    }

    /// The layouts of everything but loose uniforms.
    pub(super) fn layouts(&self) -> Result<Vec<Edit>, String> {
        let mut edits = Vec::new();
        let declared = self.declared()?;
        for (index, one) in declared.iter().enumerate() {
            let is_first = index == 0 || declared.get(index - 1).is_none_or(|before| before.chunk != one.chunk);
            match self.words(one.fact) {
                Words::Kept => {}
                Words::Inside => edits.extend(self.kept_inside(one, is_first)),
                Words::Layout(words) => {
                    if let Some(call) = &one.call {
                        let start = self.chunks.place(call.start).start;
                        edits.push((start..start, format!("layout({}) ", words.join(", "))));
                    } else if is_first {
                        edits.extend(self.with_layout(&one.chunk, &words));
                    } else {
                        edits.extend(self.split(one, &words));
                    }
                }
            }
        }
        Ok(edits)
    }

    fn words(&self, fact: &Fact) -> Words {
        let numbered = match fact {
            Fact::Loose(_) | Fact::Known(_) => return Words::Kept,
            Fact::Inside if self.dialect.numbering == Numbering::None => return Words::Kept,
            Fact::Inside => return Words::Inside,
            Fact::Numbered(numbered) => numbered,
        };
        let Numbered { space, plus, component, index, is_block, .. } = *numbered;
        let number = self.numbers.of(numbered.node).saturating_add(plus);
        let group = match space {
            Space::Buffer => Some(0),
            Space::Texture => Some(1),
            _ => None,
        };
        let mut words = Vec::new();
        if is_block {
            words.push("std140".to_owned());
        }
        match (group, self.dialect.numbering) {
            (Some(group), Numbering::All) => {
                words.extend([format!("set = {group}"), format!("binding = {number}")]);
            }
            (None, Numbering::All | Numbering::Locations) => {
                words.push(format!("location = {number}"));
                words.extend((component > 0).then(|| format!("component = {component}")));
                words.extend(index.map(|index| format!("index = {index}")));
            }
            _ => {}
        }
        if words.is_empty() { Words::Kept } else { Words::Layout(words) }
    }

    /// The first declaration of a chunk with a layout: merged into the one that is there, or before it.
    fn with_layout(&self, chunk: &Chunk, words: &[String]) -> Option<Edit> {
        let tokens = self.chunks.of(chunk);
        let brace = tokens.iter().position(|token| token.text == "{").unwrap_or(tokens.len());
        let start = self.chunks.range(chunk).start;
        let found = tokens.iter().take(brace).position(|token| token.text == "layout");
        let end = found.and_then(|at| closing(&self.chunks.all, chunk.tokens.start + at + 1));
        let (Some(at), Some(end)) = (found, end) else {
            return Some((start..start, format!("layout({}) ", words.join(", "))));
        };
        let inner = self.chunks.place(chunk.tokens.start + at + 1).end..self.chunks.place(end).start;
        let mut replaced = vec!["std140", "shared", "packed", "std430"];
        let has = |word: &str| words.iter().any(|one| one.starts_with(word));
        if has("binding") {
            replaced.extend(["binding", "set"]);
        }
        if has("location") {
            replaced.extend(["location", "component", "index"]);
        }
        let old = self.chunks.text.get(inner.clone()).unwrap_or("");
        let kept = old.split(',').map(str::trim).filter(|id| {
            let word = id.split(['=', ' ']).next().unwrap_or("").to_ascii_lowercase();
            !id.is_empty() && !replaced.contains(&word.as_str())
        });
        let all: Vec<&str> = words.iter().map(String::as_str).chain(kept).collect();
        let plain = |text: &str| text.split_whitespace().collect::<String>();
        let is_same = plain(old) == plain(&all.join(","));
        (!is_same).then(|| (inner, all.join(", ")))
    }

    /// A later name of a declaration: `in vec4 a, b;` becomes two declarations.
    fn split(&self, one: &Declared<'_>, words: &[String]) -> Option<Edit> {
        if matches!(one.fact, Fact::Numbered(Numbered { is_block: true, .. })) {
            return None;
        }
        let comma = one.token.checked_sub(1).filter(|at| self.chunks.word(*at) == ",")?;
        let head = self.head(&one.chunk)?;
        Some(self.begun_at(comma, format!("; layout({}) {head}", words.join(", "))))
    }

    /// A declaration that begins in place of a comma. A blank follows its words: `in vec4 a,b;` has none.
    fn begun_at(&self, comma: usize, mut words: String) -> Edit {
        let place = self.chunks.place(comma);
        let next = self.chunks.text.get(place.end..).and_then(|rest| rest.chars().next());
        if !next.is_some_and(char::is_whitespace) {
            words.push(' ');
        }
        (place, words)
    }

    /// The words of a declaration before its first name, without its layout.
    fn head(&self, chunk: &Chunk) -> Option<String> {
        let tokens = self.chunks.of(chunk);
        let mut head = String::new();
        let mut index = 0;
        let first = self.first_name(chunk)?;
        while chunk.tokens.start + index < first {
            let token = tokens.get(index)?;
            if token.text == "layout" {
                index = closing(&self.chunks.all, chunk.tokens.start + index + 1)? + 1 - chunk.tokens.start;
                continue;
            }
            let glued = matches!(token.text, "[" | "]") || head.ends_with('[') || head.is_empty();
            head.push_str(if glued { "" } else { " " });
            head.push_str(token.text);
            index += 1;
        }
        Some(head)
    }

    /// The first name that a chunk declares.
    fn first_name(&self, chunk: &Chunk) -> Option<usize> {
        let range = self.chunks.range(chunk);
        let (place, _) = self.facts.range(range).next()?;
        self.chunks.at(*place).map(|(_, token)| token)
    }

    /// A variable between stages that the other stage does not have is a variable of its own stage: without its qualifiers, and in a
    /// declaration of its own.
    fn kept_inside(&self, one: &Declared<'_>, is_first: bool) -> Vec<Edit> {
        if self.chunks.of(&one.chunk).iter().any(|token| token.text == "{") {
            return Vec::new();
        }
        if !is_first {
            let comma = one.token.checked_sub(1).filter(|at| self.chunks.word(*at) == ",");
            let words = self.head(&one.chunk).unwrap_or_default();
            let plain: Vec<&str> = words.split(' ').filter(|word| !self.is_of_varyings(word)).collect();
            return comma.map(|comma| self.begun_at(comma, format!("; {}", plain.join(" ")))).into_iter().collect();
        }
        let mut edits: Vec<Edit> = Vec::new();
        let mut index = one.chunk.tokens.start;
        while index < one.token {
            let is_layout = self.chunks.word(index) == "layout";
            let last = if is_layout { closing(&self.chunks.all, index + 1).unwrap_or(index) } else { index };
            if is_layout || self.is_of_varyings(self.chunks.word(index)) {
                let (start, end) = (self.chunks.place(index).start, self.chunks.place(last).end);
                edits.push((start..self.chunks.place(last + 1).start.max(end), String::new()));
            }
            index = last + 1;
        }
        edits
    }

    /// Whether a word, or the macro of that name, says how a varying leaves its stage.
    fn is_of_varyings(&self, word: &str) -> bool {
        OF_VARYINGS.contains(&word) || self.qualifiers.contains(word)
    }

    /// The loose uniforms of the text.
    pub(super) fn moved(&self) -> Result<Moved, String> {
        let mut moved = Moved::default();
        let code = without_comments(self.chunks.text);
        let mut removed: BTreeSet<usize> = BTreeSet::new();
        let declared = self.declared()?;
        let goes = |one: &&Declared<'_>| matches!(one.fact, Fact::Loose(_) | Fact::Known(_));
        let all: Vec<Leaving<'_>> = declared.iter().filter(goes).map(|one| self.leaving(one)).collect();
        let Self { name, chunks, conditions, definitions, is_turned, .. } = *self;
        let block = Ground { name, chunks, conditions, definitions, is_turned }.block_place(&all)?;
        let mut after = None;
        for one in declared.iter().filter(goes) {
            let loose = match one.fact {
                Fact::Loose(loose) => Some(loose),
                Fact::Known(index) => {
                    moved.known.insert(*index);
                    None
                }
                _ => continue,
            };
            let (range, is_call) = (self.range(one), one.call.is_some());
            let is_new = removed.insert(range.start);
            let above = if is_new && !is_call { self.above(&code, range.start) } else { Vec::new() };
            let is_spelled = block.as_ref().is_some_and(|block| block.spelled.contains(&one.place));
            let (code, rest) = self.member(one, loose, is_spelled)?;
            let n_above = above.len();
            if loose.is_some() {
                let conditions = self.conditions.at(range.start);
                let behind = if is_call { None } else { self.behind(one, is_new) };
                let initializer = if is_call { None } else { self.initializer(one.token) };
                moved.lines.push(Line { place: one.place, above, code, behind, initializer, conditions });
            }
            if is_new {
                let range = self.whole_lines(range, n_above);
                if !rest.is_empty() {
                    // The block follows the struct that stays.
                    after = Some(range.end);
                }
                moved.edits.push((range, rest));
            }
        }
        moved.place = block.map(|block| (block.place, block.conditions));
        if let (Some((place, _)), Some(after)) = (&mut moved.place, after) {
            *place = after.max(*place);
        }
        // The comment above the first declaration goes with it.
        if let Some((place, _)) = &mut moved.place
            && let Some((range, _)) = moved.edits.iter().find(|(range, _)| range.start < *place && *place < range.end)
        {
            *place = range.start;
        }
        let place = moved.place.as_ref().map(|(place, _)| *place);
        self.close_gaps(&mut moved.edits, place);
        Ok(moved)
    }

    /// The place of a declaration, or of the use of the macro that declares.
    fn range(&self, one: &Declared<'_>) -> Range<usize> {
        match &one.call {
            Some(call) => self.chunks.place(call.start).start..self.chunks.place(call.end.saturating_sub(1)).end,
            None => self.chunks.range(&one.chunk),
        }
    }

    /// A declaration, as far as it matters for the place of the block.
    fn leaving(&self, one: &Declared<'a>) -> Leaving<'_> {
        let loose = match one.fact {
            Fact::Loose(loose) => Some(loose),
            _ => None,
        };
        let range = self.range(one);
        let written = loose.filter(|_| one.call.is_none());
        let defines_struct = written.is_some() && self.struct_word(&one.chunk).is_some();
        let head = written.filter(|_| !defines_struct).and_then(|_| self.head(&one.chunk)).unwrap_or_default();
        let sizes = written.map(|_| self.sizes(one.token)).into_iter().flatten();
        let structs = loose.iter().flat_map(|loose| &loose.structs).map(String::as_str);
        let words = words(&head).map(|(_, word)| word).chain(sizes).chain(structs.filter(|_| !defines_struct));
        Leaving {
            place: one.place,
            name: self.chunks.word(one.token),
            conditions: self.conditions.at(range.start),
            range,
            tokens: one.call.clone().unwrap_or(one.chunk.tokens.clone()),
            needs: self.definitions.with_bodies(words.filter(|word| !self.is_qualifier(word))),
            can_be_spelled: loose.is_none_or(|loose| loose.plain.is_some()),
            defines_struct,
        }
    }

    fn is_qualifier(&self, word: &str) -> bool {
        QUALIFIERS.contains(&word) || self.qualifiers.contains(word)
    }

    /// Takes away a blank line after lines that are taken away below another blank line, except at the block's place.
    fn close_gaps(&self, edits: &mut [Edit], block: Option<usize>) {
        let text = self.chunks.text;
        let is_blank_before = |at: usize| {
            let line = text.get(..at).and_then(|before| before.strip_suffix('\n'));
            line.is_none_or(|before| before.rsplit('\n').next().is_some_and(|line| line.trim().is_empty()))
        };
        edits.sort_by_key(|(range, _)| range.start);
        let mut group = 0;
        for index in 0..edits.len() {
            let [start, end] = [group, index].map(|at| edits.get(at).map_or(0..0, |(range, _)| range.clone()));
            let next = edits.get(index + 1).map(|(range, _)| range.start);
            if next == Some(end.end) {
                continue;
            }
            group = index + 1;
            let has_block = block.is_some_and(|place| (start.start..=end.end).contains(&place));
            let line = text.get(end.end..).and_then(|rest| rest.split_inclusive('\n').next()).unwrap_or("x");
            let is_whole = text.get(..end.end).is_some_and(|before| before.ends_with('\n'));
            let is_gap = is_whole && line.trim().is_empty() && is_blank_before(start.start);
            if let Some((range, rest)) = edits.get_mut(index).filter(|_| is_gap && !has_block)
                && rest.is_empty()
            {
                range.end += line.len();
            }
        }
    }

    /// The lines of the comment that explains a declaration, without the declaration's indentation.
    fn above(&self, code: &str, start: usize) -> Vec<String> {
        let text = self.chunks.text;
        let line = self.chunks.line_start(start);
        let indent = text.get(line..start).unwrap_or("");
        if !indent.trim().is_empty() {
            return Vec::new();
        }
        let comment = text.get(comment_above(text, code, line)..line).unwrap_or("");
        let line = |line: &str| line.strip_prefix(indent).unwrap_or(line.trim_start()).trim_end().to_owned();
        comment.lines().map(line).collect()
    }

    /// The comment behind a declarator, to the end of its line. Several declarators on one line have one comment, which is the first's.
    fn behind(&self, one: &Declared<'_>, is_first: bool) -> Option<String> {
        let whole = self.chunks.range(&one.chunk);
        let is_on_one_line = self.chunks.text.get(whole.clone()).is_some_and(|text| !text.contains('\n'));
        let end = if is_on_one_line { whole.end } else { self.declarator_end(one.token) };
        if is_on_one_line && !is_first {
            return None;
        }
        let comment = self.chunks.text.get(end..)?.lines().next()?.trim();
        is_line_comment(comment).then(|| comment.to_owned())
    }

    /// The tokens after the name of a declarator, outside of parentheses, up to its comma or semicolon.
    fn after_name(&self, name: usize) -> impl Iterator<Item = (usize, bool)> {
        let mut depth = 0_usize;
        let all = (name + 1..self.chunks.all.len()).map(move |index| {
            match self.chunks.word(index) {
                "[" | "(" | "{" => depth += 1,
                "]" | ")" | "}" => depth = depth.saturating_sub(1),
                _ => {}
            }
            (index, depth == 0)
        });
        all.take_while(|(index, is_outside)| !(*is_outside && matches!(self.chunks.word(*index), "," | ";")))
    }

    /// The end of the comma or semicolon after a declarator.
    fn declarator_end(&self, name: usize) -> usize {
        let last = self.after_name(name).last().map_or(name, |(index, _)| index);
        self.chunks.place(last + 1).end
    }

    /// The value that a declarator gives, on one line and without comments.
    fn initializer(&self, name: usize) -> Option<String> {
        let equals =
            self.after_name(name).find(|(index, is_outside)| *is_outside && self.chunks.word(*index) == "=")?;
        let last = self.after_name(name).last()?.0;
        let range = self.chunks.place(equals.0).end..self.chunks.place(last).end;
        let value = without_comments(self.chunks.text.get(range)?);
        Some(value.split_whitespace().collect::<Vec<_>>().join(" "))
    }

    /// The words in the sizes after the name of a declarator.
    fn sizes(&self, name: usize) -> impl Iterator<Item = &str> {
        let before_value =
            self.after_name(name).take_while(|(index, is_outside)| !(*is_outside && self.chunks.word(*index) == "="));
        before_value.map(|(index, _)| self.chunks.word(index)).filter(|word| word.starts_with(is_name))
    }

    /// The code of a member, and what has to stay of the declaration: the struct that it defines.
    fn member(&self, one: &Declared<'_>, loose: Option<&Loose>, is_spelled: bool) -> Result<(String, String), String> {
        if one.call.is_some() || is_spelled {
            let name = self.chunks.word(one.token);
            let Some(ty) = loose.map(|loose| loose.plain.as_deref()) else { return Ok(Default::default()) };
            let ty = ty.ok_or_else(|| format!("a macro declares `{name}`, whose type is a struct"))?;
            return Ok((spelled(ty, name), String::new()));
        }
        let (ty, rest) = self.ty(&one.chunk)?;
        Ok((format!("{ty} {}", self.declarator(one.token)), rest))
    }

    /// The type of a declaration as it is written, and what has to stay of the declaration: the struct that it defines.
    fn ty(&self, chunk: &Chunk) -> Result<(String, String), String> {
        if let Some(index) = self.struct_word(chunk) {
            let end = self.braces_end(index).unwrap_or(index);
            let (word, end) = (self.chunks.place(index), self.chunks.place(end).end);
            let text = |from: usize| self.chunks.text.get(from..end).unwrap_or("");
            let name = self.chunks.word(index + 1);
            if name == "{" {
                let name = self.struct_name(chunk);
                return Ok((name.clone(), format!("struct {name}{};\n", text(word.end))));
            }
            return Ok((name.to_owned(), format!("{};\n", text(word.start))));
        }
        let head = self.head(chunk).unwrap_or_default();
        let words = head.split(' ').filter(|word| !self.is_qualifier(word));
        Ok((words.collect::<Vec<_>>().join(" "), String::new()))
    }

    /// The word `struct` of a declaration that defines one.
    fn struct_word(&self, chunk: &Chunk) -> Option<usize> {
        chunk.tokens.clone().find(|index| self.chunks.word(*index) == "struct")
    }

    /// A name for the struct of a declaration that has none: that of its variable, as structs are written.
    fn struct_name(&self, chunk: &Chunk) -> String {
        let (place, _) = self.facts.range(self.chunks.range(chunk)).next().unzip();
        let rest = place.and_then(|place| self.chunks.text.get(*place..)).unwrap_or("");
        let variable = rest.split(|c: char| !c.is_alphanumeric() && c != '_').next().unwrap_or("");
        let mut letters = variable.chars();
        let first = letters.next().map_or('S', |first| first.to_ascii_uppercase());
        let wanted: String = std::iter::once(first).chain(letters).collect();
        // `Light` for `light`, but `LightStruct` for `Light`.
        free(self.names, &if wanted == variable { format!("{wanted}Struct") } else { wanted })
    }

    /// The token that closes the braces after a token.
    fn braces_end(&self, from: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for (index, token) in self.chunks.all.iter().enumerate().skip(from) {
            match token.text {
                "{" => depth += 1,
                "}" => {
                    depth = depth.checked_sub(1)?;
                    if depth == 0 {
                        return Some(index);
                    }
                }
                _ => {}
            }
        }
        None
    }

    /// A name with the sizes of its arrays, as they are written, and without its initializer.
    fn declarator(&self, name: usize) -> String {
        let start = self.chunks.place(name);
        let sizes =
            self.after_name(name).take_while(|(index, is_outside)| !(*is_outside && self.chunks.word(*index) == "="));
        let end = sizes.last().map_or(start.end, |(index, _)| self.chunks.place(index).end);
        self.chunks.text.get(start.start..end).unwrap_or("").to_owned()
    }

    /// The lines of a declaration and of the comment above it, if nothing else is on them; otherwise the declaration alone.
    fn whole_lines(&self, range: Range<usize>, n_above: usize) -> Range<usize> {
        let text = self.chunks.text;
        let start = self.chunks.line_start(range.start);
        let end = text.get(range.end..).and_then(|rest| rest.find('\n')).map_or(text.len(), |at| range.end + at + 1);
        let before = text.get(start..range.start).unwrap_or("").trim();
        let after = text.get(range.end..end).unwrap_or("").trim();
        if !before.is_empty() || !(after.is_empty() || is_line_comment(after)) {
            return range;
        }
        let above = (0..n_above).fold(start, |at, _| self.chunks.line_start(at.saturating_sub(1)));
        above..end
    }
}

/// Whether a text is one comment that ends with its line.
pub(super) fn is_line_comment(text: &str) -> bool {
    let is_block = text.starts_with("/*") && text.find("*/").is_some_and(|end| end + 2 == text.len());
    (text.starts_with("//") || is_block) && !text.ends_with('\\')
}
