//! [`Conditions`]: the directives of a text, and the conditions that are open at a place.
//!
//! *In:* a text. *Out:* for a place, the lines `#if`, `#elif`, `#else` that are open there; lines that open the same conditions
//! elsewhere. *Holds:* nothing is evaluated. The guard of a file, `#ifndef A` and `#define A`, is not a condition.

use glisten_sources::engines::code::{is_name, without_comments};
use std::collections::BTreeSet;
use std::ops::Range;

/// A condition that is open: where it begins, and its lines so far: `#if A`, then `#elif B` and `#else`, if the place is behind them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Open {
    pub(super) start: usize,
    pub(super) heads: Vec<String>,
}

/// A directive, with the lines that it continues on.
#[derive(Clone, Debug)]
pub(crate) struct Directive {
    pub(crate) range: Range<usize>,
    /// The line without comments.
    code: String,
}

impl Directive {
    /// Whether it includes a file, in the words of any engine.
    pub(super) fn is_include(&self) -> bool {
        matches!(self.word(), "include" | "moj_import" | "stk_include")
    }

    /// The word after `#`.
    pub(crate) fn word(&self) -> &str {
        let code = self.code.trim_start().trim_start_matches('#').trim_start();
        code.split(|letter: char| !is_name(letter)).next().unwrap_or("")
    }

    /// The text after the word.
    pub(crate) fn rest(&self) -> &str {
        let code = self.code.trim_start().trim_start_matches('#').trim_start();
        code.get(self.word().len()..).unwrap_or("").trim()
    }

    /// The name that it defines, or asks for.
    pub(super) fn name(&self) -> &str {
        self.rest().split(|letter: char| !is_name(letter)).next().unwrap_or("")
    }

    /// The name that has to be undefined: `#ifndef A`, `#if !defined(A)`.
    fn undefined_name(&self) -> Option<&str> {
        match self.word() {
            "ifndef" => Some(self.name()),
            "if" => {
                let rest = self.rest().strip_prefix('!')?.trim_start().strip_prefix("defined")?.trim();
                let inner = rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(rest).trim();
                inner.chars().all(is_name).then_some(inner)
            }
            _ => None,
        }
    }
}

/// The directives of a text.
pub(crate) struct Conditions {
    pub(crate) list: Vec<Directive>,
    /// The starts of the directives that begin a guard.
    guards: BTreeSet<usize>,
}

impl Conditions {
    /// Reads a text.
    pub(crate) fn new(text: &str) -> Self {
        let code = without_comments(text);
        let (mut list, mut at, mut goes_on): (Vec<Directive>, usize, bool) = (Vec::new(), 0, false);
        for line in code.split_inclusive('\n') {
            let range = at..at + line.len();
            at = range.end;
            if goes_on {
                if let Some(last) = list.last_mut() {
                    last.range.end = range.end;
                    last.code.push_str(line);
                }
            } else if line.trim_start().starts_with('#') {
                list.push(Directive { range, code: line.to_owned() });
            } else {
                continue;
            }
            goes_on = line.trim_end().ends_with('\\');
        }
        let guards = guards(&list);
        Self { list, guards }
    }

    /// The conditions that are open at a place, the outermost first.
    pub(super) fn at(&self, offset: usize) -> Vec<Open> {
        let mut open: Vec<Open> = Vec::new();
        for directive in self.list.iter().take_while(|directive| directive.range.start < offset) {
            let head = directive.code.trim().to_owned();
            match directive.word() {
                "if" | "ifdef" | "ifndef" => open.push(Open { start: directive.range.start, heads: vec![head] }),
                "elif" | "else" => open.iter_mut().last().into_iter().for_each(|last| last.heads.push(head.clone())),
                "endif" => drop(open.pop()),
                _ => {}
            }
        }
        // Another branch of a guard is a condition.
        open.retain(|one| one.heads.len() > 1 || !self.guards.contains(&one.start));
        open
    }

    /// A macro that decides conditions and is defined, or no more, between two places.
    pub(super) fn changed(&self, conditions: &[Open], between: Range<usize>) -> Option<String> {
        let changes = self.list.iter().filter(|one| between.contains(&one.range.start));
        let names = changes.filter(|one| matches!(one.word(), "define" | "undef"));
        let is_named = |name: &&str| {
            let heads = conditions.iter().flat_map(|open| &open.heads);
            heads.into_iter().any(|head| head.split(|letter: char| !is_name(letter)).any(|word| word == *name))
        };
        names.map(Directive::name).find(is_named).map(str::to_owned)
    }
}

/// The starts of the directives that ask whether a macro is there, which no line above defines, and that the next directive defines.
fn guards(list: &[Directive]) -> BTreeSet<usize> {
    let mut defined: BTreeSet<&str> = BTreeSet::new();
    let mut found = BTreeSet::new();
    for (one, next) in list.iter().zip(list.iter().skip(1)) {
        match one.word() {
            "define" => drop(defined.insert(one.name())),
            "undef" => drop(defined.remove(one.name())),
            _ => {
                let name = one.undefined_name().filter(|name| !defined.contains(name));
                found.extend(
                    name.filter(|name| next.word() == "define" && next.name() == *name).map(|_| one.range.start),
                );
            }
        }
    }
    found
}

/// The lines that lead from some open conditions to others: `#endif`, then `#if`.
pub(super) fn between(from: &[Open], to: &[Open]) -> Vec<String> {
    let same = from.iter().zip(to).take_while(|(a, b)| a == b).count();
    let mut lines = Vec::new();
    // A later branch of the same condition follows the earlier one.
    if let (Some(old), Some(new)) = (from.get(same), to.get(same))
        && old.start == new.start
        && new.heads.starts_with(&old.heads)
    {
        lines.extend(from.iter().skip(same + 1).map(|_| "#endif".to_owned()));
        lines.extend(new.heads.iter().skip(old.heads.len()).cloned());
        lines.extend(to.iter().skip(same + 1).flat_map(|open| open.heads.iter().cloned()));
        return lines;
    }
    lines.extend(from.iter().skip(same).map(|_| "#endif".to_owned()));
    for open in to.iter().skip(same) {
        match negated(&open.heads) {
            Some(head) => lines.push(head),
            None => lines.extend(open.heads.iter().cloned()),
        }
    }
    lines
}

/// `#ifndef A` in place of `#ifdef A`, nothing, and `#else`.
fn negated(heads: &[String]) -> Option<String> {
    let [first, last] = heads else { return None };
    let (first, last) = (first.trim(), last.trim());
    if !last.strip_prefix('#')?.trim_start().starts_with("else") || first.contains("//") || first.contains("/*") {
        return None;
    }
    let (word, rest) = first.strip_prefix('#')?.trim_start().split_once(char::is_whitespace)?;
    match word {
        "ifdef" => Some(format!("#ifndef {}", rest.trim())),
        "ifndef" => Some(format!("#ifdef {}", rest.trim())),
        _ => None,
    }
}

/// Takes away conditions around nothing, which a text has only because declarations left it.
pub(super) fn without_empty(text: &str) -> String {
    let mut lines: Vec<&str> = text.split_inclusive('\n').collect();
    let is = |line: &str, words: &[&str]| {
        let rest = line.trim_start().strip_prefix('#').map(str::trim_start);
        rest.is_some_and(|rest| {
            words.iter().any(|word| rest.strip_prefix(word).is_some_and(|rest| !rest.starts_with(is_name)))
        })
    };
    // The start of a condition that has been empty so far.
    let mut open: Vec<Option<usize>> = Vec::new();
    let mut at = 0;
    while let Some(line) = lines.get(at).copied() {
        if is(line, &["if", "ifdef", "ifndef"]) {
            open.push(Some(at));
        } else if is(line, &["endif"]) {
            if let Some(Some(start)) = open.pop() {
                lines.drain(start..=at);
                let is_blank = |line: Option<&&str>| line.is_some_and(|line| line.trim().is_empty());
                let before = start.checked_sub(1);
                if before.is_none_or(|before| is_blank(lines.get(before))) && is_blank(lines.get(start)) {
                    lines.remove(start);
                }
                at = start;
                continue;
            }
            open.iter_mut().for_each(|one| *one = None);
        } else if !line.trim().is_empty() && !is(line, &["else", "elif"]) {
            open.iter_mut().for_each(|one| *one = None);
        }
        at += 1;
    }
    without_empty_first(&lines)
}

/// A condition whose first branch is empty asks the opposite: `#ifdef A`, `#else` becomes `#ifndef A`.
fn without_empty_first(lines: &[&str]) -> String {
    let mut new = String::new();
    let mut at = 0;
    while let Some(line) = lines.get(at).copied() {
        let next = lines.get(at + 1).copied().unwrap_or("");
        match negated(&[line.to_owned(), next.to_owned()]) {
            Some(head) => {
                let indentation = line.len() - line.trim_start().len();
                new.push_str(line.get(..indentation).unwrap_or(""));
                new.push_str(&head);
                new.push_str(next.get(next.trim_end().len()..).unwrap_or("\n"));
                at += 2;
            }
            None => {
                new.push_str(line);
                at += 1;
            }
        }
    }
    new
}

#[cfg(test)]
mod tests {
    use super::{Conditions, between, without_empty};

    #[test]
    fn places_know_their_conditions() {
        let text = "#ifdef A // a\nx\n#elif defined(B) \\\n && C\ny\n#else\n#if 1\nz\n#endif\n#endif\nw\n";
        let conditions = Conditions::new(text);
        let at = |word: &str| conditions.at(text.find(word).expect("there"));
        assert_eq!(at("x\n")[0].heads, ["#ifdef A"]);
        assert_eq!(at("y\n")[0].heads.len(), 2);
        assert_eq!(at("z\n").len(), 2);
        assert_eq!(at("w\n"), []);
        assert_eq!(between(&at("x\n"), &at("z\n"))[1..], ["#else", "#if 1"]);
        assert_eq!(between(&at("z\n"), &[]), ["#endif", "#endif"]);
        let text = "#ifdef A\nx\n#else\ny\n#endif\n";
        let conditions = Conditions::new(text);
        let y = conditions.at(text.find('y').expect("there"));
        assert_eq!(between(&[], &y), ["#ifndef A"]);
    }

    #[test]
    fn guards_are_no_conditions() {
        let text = "#ifndef G\n#define G\nx\n#if !defined(H)\n# define H 1\ny\n#else\nz\n#endif\n#endif\n\
                    #ifndef G\n#define G\nw\n#endif\n";
        let conditions = Conditions::new(text);
        let at = |word: &str| conditions.at(text.find(word).expect("there"));
        assert_eq!((at("x\n").len(), at("y\n").len(), at("z\n").len(), at("w\n").len()), (0, 0, 1, 1));
    }

    #[test]
    fn macros_that_change_are_found() {
        let text = "u\n#define A 1\n#define B\n#if A\nx\n#endif\n";
        let conditions = Conditions::new(text);
        let stack = conditions.at(text.find('x').expect("there"));
        assert_eq!(conditions.changed(&stack, 0..text.len()).as_deref(), Some("A"));
        assert_eq!(conditions.changed(&stack, 14..text.len()), None);
    }

    #[test]
    fn empty_conditions_go() {
        let text = "a\n#if A\n\n#else\n#ifdef B\n#endif\n#endif\nb\n#if C\n#include \"x\"\n#endif\n";
        assert_eq!(without_empty(text), "a\nb\n#if C\n#include \"x\"\n#endif\n");
        let first = "#ifdef A\n\n#else\nb\n#endif\n\t#ifndef C\r\n#else\r\nd\r\n#endif\r\n";
        assert_eq!(without_empty(first), "#ifdef A\n\n#else\nb\n#endif\n\t#ifdef C\r\nd\r\n#endif\r\n");
    }
}
