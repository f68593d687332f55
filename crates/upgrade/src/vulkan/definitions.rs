//! [`Definitions`]: where a text defines the names that a declaration may need: macros, constants, structs, in itself and in what it
//! includes.
//!
//! *In:* a text, and the files that its includes name. *Out:* whether a name changes between two places. *Holds:* nothing is evaluated:
//! a definition in a conditional group counts. A file counts where it is included first.

use super::chunks::{Chunk, Chunks};
use super::conditions::Conditions;
use super::files::Files;
use glisten_sources::engines::code::{is_name, words};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// The definitions of one text, without those of its includes.
#[derive(Debug, Default)]
pub(super) struct Own {
    /// The places where each name begins to mean something, or, for a macro, ends to.
    places: BTreeMap<String, Vec<usize>>,
    /// The words that macros stand for.
    bodies: BTreeMap<String, BTreeSet<String>>,
    /// All words of the text.
    words: BTreeSet<String>,
}

impl Own {
    fn new(chunks: &Chunks<'_>, conditions: &Conditions) -> Self {
        let mut own = Self { words: chunks.all.iter().map(|token| token.text.to_owned()).collect(), ..Self::default() };
        for one in conditions.list.iter().filter(|one| matches!(one.word(), "define" | "undef")) {
            let name = one.name();
            own.places.entry(name.to_owned()).or_default().push(one.range.start);
            let body = one.rest().get(name.len()..).unwrap_or("");
            own.bodies.entry(name.to_owned()).or_default().extend(words(body).map(|(_, word)| word.to_owned()));
        }
        let structs = (1..chunks.all.len()).filter(|at| chunks.word(at - 1) == "struct");
        let constants =
            chunks.list.iter().filter(|chunk| !chunk.is_function).flat_map(|chunk| constants(chunks, chunk));
        for at in structs.chain(constants) {
            own.places.entry(chunks.word(at).to_owned()).or_default().push(chunks.place(at).start);
        }
        own
    }

    fn of_text(text: &str) -> Self {
        Self::new(&Chunks::new(text), &Conditions::new(text))
    }
}

/// The names of constants in a declaration: `const int N = 4, M = 5;`.
fn constants(chunks: &Chunks<'_>, chunk: &Chunk) -> Vec<usize> {
    /// The most words before `const`: a precision is after it, and nothing of a constant is before it.
    const MOST_BEFORE: usize = 1;
    let start = chunk.tokens.start;
    if !(start..=start + MOST_BEFORE).any(|at| chunks.word(at) == "const") {
        return Vec::new();
    }
    let (mut depth, mut found) = (0_usize, Vec::new());
    for at in chunk.tokens.clone() {
        match chunks.word(at) {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            // A size may follow the name: `N[2] =`.
            word if depth == 0 && word.starts_with(is_name) && matches!(chunks.word(at + 1), "=" | "[") => {
                found.push(at)
            }
            _ => {}
        }
    }
    found
}

/// The definitions of the files of a tree that others include.
#[derive(Debug, Default)]
pub(super) struct AllDefinitions {
    of_files: BTreeMap<String, Own>,
}

impl AllDefinitions {
    pub(super) fn new(files: &Files) -> Self {
        let names: BTreeSet<&String> = files.includes.values().collect();
        let own = |name: &String| Some((name.clone(), Own::of_text(files.any(name)?)));
        Self { of_files: names.into_iter().filter_map(own).collect() }
    }

    /// The definitions of a text, with those of its includes.
    pub(super) fn of<'a>(
        &'a self,
        name: &str,
        (chunks, conditions): (&Chunks<'_>, &Conditions),
        files: &Files,
    ) -> Definitions<'a> {
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        let mut includes = Vec::new();
        for one in conditions.list.iter().filter(|one| one.is_include()) {
            let mut open: Vec<&str> = files.included(name, one).into_iter().collect();
            while let Some(next) = open.pop() {
                let Some((next, own)) = self.of_files.get_key_value(next).filter(|(next, _)| seen.insert(next)) else {
                    continue;
                };
                includes.push((one.range.start, own));
                open.extend(files.included_by(next));
            }
        }
        Definitions { own: Own::new(chunks, conditions), includes }
    }
}

/// The definitions of a text and of the files that it includes.
#[derive(Debug)]
pub(super) struct Definitions<'a> {
    own: Own,
    /// The files that are included, with the places of the directives.
    includes: Vec<(usize, &'a Own)>,
}

impl Definitions<'_> {
    fn all(&self) -> impl Iterator<Item = &Own> {
        std::iter::once(&self.own).chain(self.includes.iter().map(|(_, own)| *own))
    }

    /// Some words, and those that the macros among them stand for.
    pub(super) fn with_bodies<'w>(&self, words: impl IntoIterator<Item = &'w str>) -> BTreeSet<String> {
        let mut open: Vec<String> = words.into_iter().map(str::to_owned).collect();
        let mut found = BTreeSet::new();
        while let Some(word) = open.pop() {
            let bodies = self.all().filter_map(|own| own.bodies.get(&word)).flatten();
            let new: Vec<String> = bodies.filter(|body| !found.contains(*body)).cloned().collect();
            if found.insert(word) {
                open.extend(new);
            }
        }
        found
    }

    /// Whether one of the names changes its meaning between two places.
    pub(super) fn changes(&self, names: &BTreeSet<String>, between: &Range<usize>) -> bool {
        let is_own = |name: &String| {
            self.own.places.get(name).is_some_and(|places| places.iter().any(|place| between.contains(place)))
        };
        names.iter().any(is_own)
            || self.includes_between(between).any(|own| names.iter().any(|name| own.places.contains_key(name)))
    }

    /// Whether a file that is included between two places has one of the words.
    pub(super) fn has_words(&self, names: &BTreeSet<&str>, between: &Range<usize>) -> bool {
        self.includes_between(between).any(|own| names.iter().any(|name| own.words.contains(*name)))
    }

    fn includes_between(&self, between: &Range<usize>) -> impl Iterator<Item = &Own> {
        self.includes.iter().filter(|(place, _)| between.contains(place)).map(|(_, own)| *own)
    }
}

#[cfg(test)]
mod tests {
    use super::{Definitions, Own};

    #[test]
    fn names_change_where_they_are_defined() {
        let text =
            "#define N M\nuniform float k;\n#define M 4\nconst int C = 2, D = M;\nstruct S { vec4 a; };\n#undef M\n";
        let definitions = Definitions { own: Own::of_text(text), includes: Vec::new() };
        let changes = |name: &str, from: &str, to: &str| {
            let place = |word: &str| text.find(word).expect("there");
            definitions.changes(&definitions.with_bodies([name]), &(place(from)..place(to)))
        };
        assert!(
            changes("N", "uniform", "const") && changes("D", "uniform", "struct") && changes("S", "const", "#undef")
        );
        assert!(
            !changes("N", "const", "#undef") && !changes("C", "struct", "#undef") && !changes("vec4", "#", "#undef")
        );
    }

    #[test]
    fn included_files_define_where_they_are_included() {
        let part = Own::of_text("#define T vec4\nvec4 f() { return tint; }\n");
        let definitions = Definitions { own: Own::default(), includes: vec![(10, &part)] };
        let names = definitions.with_bodies(["T"]);
        assert!(
            names.contains("vec4") && definitions.changes(&names, &(0..20)) && !definitions.changes(&names, &(11..20))
        );
        assert!(
            definitions.has_words(&["tint"].into(), &(0..20)) && !definitions.has_words(&["other"].into(), &(0..20))
        );
    }
}
