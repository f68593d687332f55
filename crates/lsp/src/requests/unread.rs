//! Text that the compiler does not read, in renames: what conditions leave out, and macros that nothing uses.
//!
//! *Holds:* a name there is taken for the renamed one where that is in sight, from the condition on that chooses between its declarations.
//! A rename after which a name there would denote something else is refused; what is not known for sure, such as which overload is
//! called, is taken for such a name.

use super::calls::function_around;
use crate::analysis::{Analysis, Place};
use glisten_front::analysis::Denoted;
use glisten_front::index::{Occurrence, Symbol, SymbolId, SymbolKind};
use glisten_front::source::{FileId, Span};
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;

/// The places of a name there, and one whose meaning a rename would change.
#[derive(Debug, Default)]
pub(super) struct Unread {
    pub(super) places: BTreeSet<Place>,
    pub(super) captured: Option<Place>,
}

/// The names of a rename.
#[derive(Clone, Copy)]
pub(super) struct Names<'a> {
    pub(super) old: &'a str,
    pub(super) new: &'a str,
}

/// The part of a program in which a symbol is in sight.
enum Reach {
    /// All of it.
    All,
    /// From its declaration to the end of its function.
    Local(Span),
    /// Between its first and its last place.
    Between(Place, Place),
}

/// Looks for the old and the new name of a symbol, which has these places.
pub(super) fn unread(analysis: &Analysis, places: &[(Place, Occurrence)], names: Names<'_>) -> Unread {
    let mut found = Unread::default();
    let Some((_, first)) = places.first() else { return found };
    let symbol = analysis.symbol(first.symbol);
    let is_member = matches!(symbol.places.first(), Some((_, Denoted::Member(..))));
    let body = symbol.declarations.first().filter(|_| is_member).and_then(|declared| braces(analysis, *declared));
    let is_one_of_several = has_namesake(analysis, first.symbol);
    let Some(reach) = reach(analysis, symbol, places) else { return found };
    for (file, range, is_left_out) in texts(analysis) {
        let name = analysis.sources().file(file).name();
        let is_shared = places.iter().any(|(place, _)| place.file == name);
        if name.starts_with('<') || !reach.has(analysis, file, &range) {
            continue;
        }
        let of_word = |word: &str| words(analysis, file, &range, word, is_member);
        let mut own = if is_shared { of_word(names.old) } else { Vec::new() };
        if is_left_out && is_one_of_several {
            found.captured = found.captured.or(own.first().cloned());
        }
        if let Some((_, body)) = body.as_ref().filter(|(declared, _)| *declared == file) {
            // Another declaration of the member.
            let others = words(analysis, file, &range, names.old, false);
            own.extend(others.into_iter().filter(|place| body.contains(&place.start)));
        }
        if is_left_out && !is_member {
            let other = captors(analysis, names.new).into_iter().flat_map(|word| of_word(&word)).next();
            let is_hidden = !own.is_empty() && has_local(analysis, file, &range, names.new);
            let captured = other.or_else(|| own.first().cloned().filter(|_| is_hidden));
            found.captured = found.captured.or(captured);
        }
        found.places.extend(own);
    }
    if matches!(symbol.places.first(), Some((_, Denoted::Global(_)))) {
        let shared: BTreeSet<&str> = places.iter().map(|(place, _)| place.file.as_str()).collect();
        found.places.extend(shared.into_iter().flat_map(|file| parameters(analysis, file, names.old)));
    }
    found
}

/// The places of a name in the pragmas of a file that give a uniform to the user (libretro's `#pragma parameter`).
fn parameters(analysis: &Analysis, file: &str, name: &str) -> Vec<Place> {
    let Some(id) = analysis.files(Path::new(file)).next() else { return Vec::new() };
    let (mut places, mut at) = (Vec::new(), 0);
    for line in analysis.sources().file(id).text().split_inclusive('\n') {
        let rest = line.trim_start().strip_prefix("#pragma parameter").map(str::trim_start);
        if let Some(rest) = rest.filter(|rest| rest.split_whitespace().next() == Some(name)) {
            let start = at + line.len() - rest.len();
            places.push(Place { file: file.to_owned(), start, end: start + name.len() });
        }
        at += line.len();
    }
    places
}

/// The texts that are not read, and whether a condition leaves them out.
fn texts(analysis: &Analysis) -> Vec<(FileId, Range<usize>, bool)> {
    let mut texts = Vec::new();
    for (_, view) in analysis.compiled.inspection.views() {
        let directives = &view.ast.directives;
        let bodies = directives.definitions.iter().map(|definition| (definition.body, false));
        let left_out = directives.inactive.iter().map(|span| (*span, true));
        for (span, is_left_out) in left_out.chain(bodies.filter(|(span, _)| span.is_known())) {
            texts.extend(analysis.place(span).map(|(file, range)| (file, range, is_left_out)));
        }
    }
    texts
}

fn reach(analysis: &Analysis, symbol: &Symbol, places: &[(Place, Occurrence)]) -> Option<Reach> {
    if symbol.kind == SymbolKind::MacroParameter {
        return Some(Reach::Between(places.first()?.0.clone(), places.last()?.0.clone()));
    }
    if !matches!(symbol.places.first(), Some((_, Denoted::Local(..)))) {
        return Some(Reach::All);
    }
    let declared = analysis.sources().call_site(*symbol.declarations.first()?);
    let Some((_, whole)) = function_around(analysis, declared) else { return Some(Reach::All) };
    let start = choice_around(analysis, declared, whole).unwrap_or(declared.start);
    Some(Reach::Local(Span::new(start, whole.end)))
}

/// Where the conditions begin that choose between a declaration and others in its place, and end inside of its function.
fn choice_around(analysis: &Analysis, declared: Span, function: Span) -> Option<u32> {
    let (file, place) = analysis.place(declared)?;
    let source = analysis.sources().file(file);
    let end = (function.end.checked_sub(source.base())?) as usize;
    let is_around = |group: &Range<usize>| group.contains(&place.start) && group.end <= end;
    let start = groups(source.text()).into_iter().filter(is_around).map(|group| group.start).min()?;
    Some(source.base() + start as u32)
}

/// The ranges from each `#if` to its `#endif`.
fn groups(text: &str) -> Vec<Range<usize>> {
    let (mut groups, mut open, mut at) = (Vec::new(), Vec::new(), 0);
    for line in text.split_inclusive('\n') {
        let word = line.trim_start().strip_prefix('#').map_or("", str::trim_start);
        if word.starts_with("if") {
            open.push(at);
        }
        at += line.len();
        if word.starts_with("endif") {
            groups.extend(open.pop().map(|start| start..at));
        }
    }
    groups
}

/// The inside of the braces around a declaration.
fn braces(analysis: &Analysis, declared: Span) -> Option<(FileId, Range<usize>)> {
    let (file, place) = analysis.place(declared)?;
    let text = analysis.sources().file(file).text();
    let start = text.get(..place.start)?.rfind('{')?;
    let end = place.end + text.get(place.end..)?.find('}')?;
    Some((file, start..end))
}

/// Whether a text that names a symbol may mean another one of its name: an overload, or the member of another struct.
fn has_namesake(analysis: &Analysis, id: SymbolId) -> bool {
    let is_member = |symbol: &Symbol| match symbol.places.first() {
        Some((_, Denoted::Member(..))) => Some(true),
        Some((_, Denoted::Function(_))) => Some(false),
        _ => None,
    };
    let symbol = analysis.symbol(id);
    let Some(own) = is_member(symbol) else { return false };
    let meets =
        |other: &Symbol| other.places.iter().any(|(view, _)| symbol.places.iter().any(|(known, _)| known == view));
    let is_one = |(other, found): (SymbolId, &Symbol)| {
        other != id && found.name == symbol.name && is_member(found) == Some(own) && meets(found)
    };
    analysis.index().symbols().any(is_one)
}

impl Reach {
    fn has(&self, analysis: &Analysis, file: FileId, range: &Range<usize>) -> bool {
        let file = analysis.sources().file(file);
        let (start, end) = (file.base() + range.start as u32, file.base() + range.end as u32);
        match self {
            Self::All => true,
            Self::Local(span) => span.start <= start && end <= span.end,
            Self::Between(first, last) => {
                file.name() == first.file && first.start <= range.start && range.end <= last.end
            }
        }
    }
}

/// The words of a text that would use a new name: it, and macros in whose text it is.
fn captors(analysis: &Analysis, new: &str) -> BTreeSet<String> {
    let mut words = BTreeSet::from([new.to_owned()]);
    let views = analysis.compiled.inspection.views();
    let definitions: Vec<_> = views.flat_map(|(_, view)| &view.ast.directives.definitions).collect();
    loop {
        let uses = |body: Span| {
            let place = analysis.place(body).filter(|_| body.is_known());
            place.is_some_and(|(file, range)| {
                words.iter().any(|word| !whole_words(analysis, file, &range, word).is_empty())
            })
        };
        let more = definitions.iter().filter(|one| !words.contains(&*one.name) && uses(one.body));
        let more: Vec<String> = more.map(|one| one.name.to_string()).collect();
        if more.is_empty() {
            return words;
        }
        words.extend(more);
    }
}

/// Whether the function around a text has a local or a parameter of this name.
fn has_local(analysis: &Analysis, file: FileId, range: &Range<usize>, name: &str) -> bool {
    let base = analysis.sources().file(file).base();
    let span = Span::new(base + range.start as u32, base + range.end as u32);
    let Some((_, whole)) = function_around(analysis, span) else { return false };
    let is_local = |symbol: &Symbol| matches!(symbol.places.first(), Some((_, Denoted::Local(..))));
    let is_here = |declared: &Span| {
        let declared = analysis.sources().call_site(*declared);
        whole.start <= declared.start && declared.end <= whole.end
    };
    let mut all = analysis.index().symbols();
    all.any(|(_, symbol)| symbol.name == name && is_local(symbol) && symbol.declarations.iter().any(is_here))
}

/// The places of a word in a range that the index does not have; for a member, those after a dot.
fn words(analysis: &Analysis, file: FileId, range: &Range<usize>, word: &str, is_member: bool) -> Vec<Place> {
    let source = analysis.sources().file(file);
    let text = source.text().get(range.clone()).unwrap_or("");
    let is_own = |at: &usize| {
        let is_after_dot = text.get(..*at).unwrap_or("").trim_end().ends_with('.');
        let is_known = analysis.index().at(source.base() + (range.start + at) as u32).is_some();
        is_after_dot == is_member && !is_known
    };
    let found = whole_words(analysis, file, range, word).into_iter().filter(is_own);
    let place = |at: usize| {
        let start = range.start + at;
        Place { file: source.name().to_owned(), start, end: start + word.len() }
    };
    found.map(place).collect()
}

/// The offsets of a word in a range, outside of comments.
fn whole_words(analysis: &Analysis, file: FileId, range: &Range<usize>, word: &str) -> Vec<usize> {
    let text = analysis.sources().file(file).text().get(range.clone()).unwrap_or("");
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '_';
    let is_whole = |at: &usize| {
        let (before, after) = (text.get(..*at).unwrap_or(""), text.get(at + word.len()..).unwrap_or(""));
        !before.ends_with(is_part) && !after.starts_with(is_part) && !crate::cut::is_in_comment(text, *at)
    };
    text.match_indices(word).map(|(at, _)| at).filter(is_whole).collect()
}
