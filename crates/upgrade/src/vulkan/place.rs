//! The place of the block that the loose uniforms of a text go into.
//!
//! *In:* the declarations that go. *Out:* the place, the conditions there, and the members whose types are spelled out, because a
//! macro or a constant means something else there. *Holds:* the block is before all code that uses its members, and what decides whether
//! a member is there has not changed. The first place where every declaration keeps its words is taken.

use super::chunks::{Chunk, Chunks};
use super::conditions::{Conditions, Open};
use super::definitions::Definitions;
use glisten_sources::engines::code::without_comments;
use std::collections::BTreeSet;
use std::ops::Range;

/// The coordinates of the fragment, which a variable after the block stands for.
const FRAG_COORD: &str = "gl_FragCoord";

/// A declaration that goes into the block.
pub(super) struct Leaving<'a> {
    /// The place of its name.
    pub(super) place: usize,
    pub(super) name: &'a str,
    pub(super) range: Range<usize>,
    pub(super) tokens: Range<usize>,
    pub(super) conditions: Vec<Open>,
    /// The names in its type and in the sizes of its arrays, with those of macros among them.
    pub(super) needs: BTreeSet<String>,
    /// Whether its type can be written without names of the text.
    pub(super) can_be_spelled: bool,
    /// Whether it defines a struct, which stays.
    pub(super) defines_struct: bool,
}

/// Where the block is.
#[derive(Debug)]
pub(super) struct BlockPlace {
    pub(super) place: usize,
    /// The conditions that are open there.
    pub(super) conditions: Vec<Open>,
    /// The places of the names whose types are spelled out.
    pub(super) spelled: BTreeSet<usize>,
}

/// A text in which the place is looked for.
pub(super) struct Ground<'a> {
    pub(super) name: &'a str,
    pub(super) chunks: &'a Chunks<'a>,
    pub(super) conditions: &'a Conditions,
    pub(super) definitions: &'a Definitions<'a>,
    /// Whether a variable after the block stands for `gl_FragCoord`.
    pub(super) is_turned: bool,
}

impl Ground<'_> {
    /// Where the block is; none if there is no declaration for it.
    pub(super) fn block_place(&self, all: &[Leaving<'_>]) -> Result<Option<BlockPlace>, String> {
        let code = without_comments(self.chunks.text);
        let is_apart = |index: &usize| {
            let before = index.checked_sub(1).and_then(|before| all.get(before));
            let (Some(before), Some(one)) = (before, all.get(*index)) else { return true };
            let between = code.get(before.range.end..one.range.start);
            one.defines_struct || between.is_some_and(|between| !between.trim().is_empty())
        };
        let mut last_error = None;
        // A word in an included file may be another name. If nothing else helps, the new text tells.
        for is_strict in [true, false] {
            let mut with_spelled = None;
            for index in (0..all.len()).filter(is_apart) {
                match self.block_at(all, index, &code, is_strict) {
                    Ok(found) if found.spelled.is_empty() => return Ok(Some(found)),
                    Ok(found) => with_spelled = with_spelled.or(Some(found)),
                    Err(error) => last_error = Some(error),
                }
            }
            if with_spelled.is_some() {
                return Ok(with_spelled);
            }
        }
        last_error.map_or(Ok(None), Err)
    }

    /// The block at one of the declarations.
    fn block_at(&self, all: &[Leaving<'_>], index: usize, code: &str, is_strict: bool) -> Result<BlockPlace, String> {
        let (Some(first), Some(at)) = (all.first(), all.get(index)) else { return Err(String::new()) };
        let turned = self.is_turned.then_some(FRAG_COORD);
        let names: BTreeSet<&str> = all.iter().take(index).map(|one| one.name).chain(turned).collect();
        let uses_one = self.chunks.list.iter().any(|chunk| {
            let is_between = first.tokens.end <= chunk.tokens.start && chunk.tokens.end <= at.tokens.start;
            is_between && self.uses(chunk, all, &names)
        });
        if uses_one || is_strict && self.definitions.has_words(&names, &(first.range.end..at.range.start)) {
            let what = "a struct of a uniform comes after a function that uses other uniforms";
            return Err(format!("{what}; move the struct to the beginning of `{}`", self.name));
        }
        let n_same =
            |other: &Leaving<'_>| at.conditions.iter().zip(&other.conditions).take_while(|(a, b)| a == b).count();
        let common = all.iter().map(n_same).min().unwrap_or(0);
        let line = self.chunks.line_start(at.range.start);
        // Behind what is before it on its line, which may be the struct of the uniform.
        let is_alone = code.get(line..at.range.start).is_none_or(|before| before.trim().is_empty());
        let start = if is_alone { line } else { at.range.start };
        let place = at.conditions.get(common).map_or(start, |open| open.start);
        let seen_from = if at.defines_struct { at.range.end } else { place };
        let mut spelled = BTreeSet::new();
        for (other, one) in all.iter().enumerate() {
            let between = seen_from.min(one.range.start)..seen_from.max(one.range.start);
            let inner = one.conditions.get(common..).unwrap_or_default();
            if let Some(name) = self.conditions.changed(inner, between.clone()) {
                let what = "decides whether a uniform is there, and changes between the uniforms";
                return Err(format!("the macro `{name}` of `{}` {what}", self.name));
            }
            if one.defines_struct && other > index || self.definitions.changes(&one.needs, &between) {
                if !one.can_be_spelled || one.defines_struct {
                    let what = "needs a struct, which is defined after other uniforms";
                    return Err(format!("`{}` {what}; move the struct to the beginning of `{}`", one.name, self.name));
                }
                spelled.insert(one.place);
            }
        }
        Ok(BlockPlace { place, conditions: at.conditions.iter().take(common).cloned().collect(), spelled })
    }

    /// Whether a function, or the value of a variable, has one of the names, by itself or by a macro.
    fn uses(&self, chunk: &Chunk, all: &[Leaving<'_>], names: &BTreeSet<&str>) -> bool {
        let tokens = self.chunks.of(chunk);
        let code = match tokens.iter().position(|token| token.text == "=") {
            _ if chunk.is_function => tokens,
            Some(equals) if all.iter().all(|one| one.tokens != chunk.tokens) => {
                tokens.get(equals..).unwrap_or_default()
            }
            _ => return false,
        };
        let words = code.iter().filter(|token| token.is_word()).map(|token| token.text);
        self.definitions.with_bodies(words).iter().any(|word| names.contains(word.as_str()))
    }
}
