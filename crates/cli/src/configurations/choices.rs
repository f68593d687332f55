//! [`Choice`]: a macro that decides conditions and is defined nowhere, with the values that make a difference.
//!
//! *In:* the texts of a program. *Out:* choices, and the branches of the conditions. *Holds:* the texts are only searched for
//! directives: comments and continued lines are understood, macros are not expanded. A macro that a text defines for good is no
//! choice; one that it defines where nothing else did (`#ifndef A`, `#define A 4`) is one. Include guards are none.

use glisten_front::source::comments::comment_len;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The most values of a macro that are tried.
const MAX_VALUES: usize = 8;

/// So many macros of a branch are known at least. No program has as many choices, so nothing is said of what more of them decide.
const MAX_NAMES: usize = 64;

/// In a condition, they belong to what an engine replaces before any compiler reads it (`@normalMap`, `${lights}`, `{{shadows}}`).
const FOREIGN: [char; 4] = ['@', '$', '{', '`'];

/// A macro from outside, and what it may be: `None` is for a macro that is not defined. The first value is that.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Choice {
    pub name: String,
    pub values: Vec<Option<String>>,
}

/// A group of lines that a condition decides.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Branch {
    /// The directive's line, from 0.
    pub(super) directive: usize,
    /// The end of the group: the line of the next directive of the same condition.
    pub(super) end: usize,
    /// The macros that decide it, those of the conditions around it included, as far as they are not too many.
    pub(super) names: Arc<BTreeSet<String>>,
    /// Whether an `#error` is directly in it.
    pub(super) is_error: bool,
}

/// The conditions of a text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Conditions {
    /// The branches, in the order of their directives.
    pub(super) branches: Vec<Branch>,
    /// The questions about each macro.
    asked: BTreeMap<String, Asked>,
    /// The macros in the order of their first mention.
    order: Vec<String>,
    /// The macros that the text defines for good.
    defined: BTreeSet<String>,
    /// The macros of include guards.
    guards: BTreeSet<String>,
}

/// The questions of conditions about a macro.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Asked {
    /// Whether it is defined.
    is_defined: bool,
    /// Its value, as it is.
    bare: bool,
    /// The values around those that it is compared with.
    near: Vec<String>,
}

/// The macros that decide conditions of these texts and come from outside, without those of `given`, the most often asked first
/// to be kept if there are more than `most`.
pub(super) fn choices_of(texts: &[Conditions], given: &BTreeSet<String>, most: usize) -> Vec<Choice> {
    let is_own = |name: &str| texts.iter().any(|text| text.defined.contains(name) || text.guards.contains(name));
    let mut choices: Vec<Choice> = Vec::new();
    for name in texts.iter().flat_map(|text| &text.order) {
        let is_known = name.starts_with("GL_") || name.starts_with("__") || given.contains(name) || is_own(name);
        if is_known || choices.iter().any(|choice| choice.name == *name) || choices.len() >= most {
            continue;
        }
        let mut all = Asked::default();
        for asked in texts.iter().filter_map(|text| text.asked.get(name)) {
            all.is_defined |= asked.is_defined;
            all.bare |= asked.bare;
            all.near.extend(asked.near.iter().cloned());
        }
        choices.push(Choice { name: name.clone(), values: all.values() });
    }
    choices
}

impl Asked {
    fn values(&self) -> Vec<Option<String>> {
        let mut values = vec![None];
        let one = (self.is_defined || self.bare).then(|| "1".to_owned());
        for value in one.into_iter().chain(self.near.iter().cloned()) {
            if !values.contains(&Some(value.clone())) && values.len() < MAX_VALUES {
                values.push(Some(value));
            }
        }
        values
    }
}

/// A condition that is open at a line.
struct Open {
    /// Its directives so far mention these.
    names: BTreeSet<String>,
    /// These, and the macros of the conditions around it.
    all: Arc<BTreeSet<String>>,
    /// The last branch.
    branch: usize,
    /// The macro of `#ifndef NAME`.
    unless: Option<String>,
}

/// The conditions of a text.
pub(super) fn conditions(text: &str) -> Conditions {
    let mut found = Conditions::default();
    let mut open: Vec<Open> = Vec::new();
    for (line, directive) in directives(text) {
        let directive = directive.trim();
        let length = directive.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(directive.len());
        let (word, rest) = directive.split_at(length);
        match word {
            "if" | "ifdef" | "ifndef" => {
                let names = found.ask(word, rest);
                let unless = unless(word, rest);
                let all = together(&names, open.last());
                let branch = found.begin(line, &names, &all);
                open.push(Open { names, all, branch, unless });
            }
            "elif" | "else" => {
                let Some(mut last) = open.pop() else { continue };
                found.end(last.branch, line);
                let names = found.ask(word, rest);
                if last.names.len() < MAX_NAMES {
                    last.names.extend(names);
                }
                last.unless = None;
                last.all = together(&last.names, open.last());
                last.branch = found.begin(line, &last.names, &last.all);
                open.push(last);
            }
            "endif" => {
                if let Some(last) = open.pop() {
                    found.end(last.branch, line);
                }
            }
            "error" => {
                let innermost = open.last().and_then(|open| found.branches.get_mut(open.branch));
                innermost.into_iter().for_each(|branch| branch.is_error = true);
            }
            "define" => {
                let mut words = rest.split_whitespace();
                let name = words.next().unwrap_or_default();
                let (name, is_function) = name.split_once('(').map_or((name, false), |(name, _)| (name, true));
                match open.last().and_then(|open| open.unless.as_deref()) {
                    Some(unless) if unless == name && !is_function => {
                        // Without a value it is the guard of a header.
                        if words.next().is_none() {
                            found.guards.insert(name.to_owned());
                        }
                    }
                    _ => {
                        found.defined.insert(name.to_owned());
                    }
                }
            }
            _ => {}
        }
    }
    let last = text.lines().count();
    open.iter().for_each(|open| found.end(open.branch, last));
    found
}

/// The macros of a condition and of those around it. Most conditions in others ask nothing new, or have few around them.
fn together(own: &BTreeSet<String>, around: Option<&Open>) -> Arc<BTreeSet<String>> {
    let Some(around) = around else { return Arc::new(own.clone()) };
    if own.is_subset(&around.all) || around.all.len() >= MAX_NAMES {
        return Arc::clone(&around.all);
    }
    Arc::new(own.union(&around.all).cloned().collect())
}

impl Conditions {
    fn begin(&mut self, line: usize, own: &BTreeSet<String>, all: &Arc<BTreeSet<String>>) -> usize {
        // No macro decides `#if 0`.
        let names = if own.is_empty() { Arc::default() } else { Arc::clone(all) };
        self.branches.push(Branch { directive: line, end: line, names, is_error: false });
        self.branches.len() - 1
    }

    fn end(&mut self, branch: usize, line: usize) {
        if let Some(branch) = self.branches.get_mut(branch) {
            branch.end = line;
        }
    }

    /// Notes what a condition asks. Its macros.
    fn ask(&mut self, word: &str, rest: &str) -> BTreeSet<String> {
        if rest.contains(FOREIGN) {
            // No choice has such a name, so nothing is said of what it decides.
            return BTreeSet::from([rest.trim().to_owned()]);
        }
        let mut names = BTreeSet::new();
        let tokens = tokens(rest);
        let mut at = 0;
        while let Some(token) = tokens.get(at) {
            at += 1;
            let is_name = token.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
            if !is_name || *token == "defined" {
                continue;
            }
            let before = |back: usize| at.checked_sub(back + 1).and_then(|at| tokens.get(at)).copied().unwrap_or("");
            let is_defined = matches!(word, "ifdef" | "ifndef")
                || before(1) == "defined"
                || before(1) == "(" && before(2) == "defined";
            if !self.asked.contains_key(*token) {
                self.order.push((*token).to_owned());
            }
            names.insert((*token).to_owned());
            let asked = self.asked.entry((*token).to_owned()).or_default();
            if is_defined {
                asked.is_defined = true;
                continue;
            }
            let (next, after) = (tokens.get(at).copied().unwrap_or(""), tokens.get(at + 1).copied().unwrap_or(""));
            let near = match (compared(next, after), mirrored(before(1)).and_then(|by| compared(by, before(2)))) {
                (Some(near), _) | (None, Some(near)) => near,
                (None, None) => {
                    asked.bare = true;
                    continue;
                }
            };
            asked.near.extend(near);
        }
        names
    }
}

/// The macro of `#ifndef NAME` and `#if !defined(NAME)`.
fn unless(word: &str, rest: &str) -> Option<String> {
    let tokens = tokens(rest);
    let name = match (word, tokens.as_slice()) {
        ("ifndef", [name]) | ("if", ["!", "defined", "(", name, ")"] | ["!", "defined", name]) => name,
        _ => return None,
    };
    Some((*name).to_owned())
}

/// The values that make a difference where a macro is compared with another text: that, and those next to it.
fn compared(operator: &str, with: &str) -> Option<Vec<String>> {
    let number = number(with);
    let is_name = with.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_') && with != "defined";
    let near: &[i64] = match operator {
        "==" | "!=" => &[0, 1],
        "<" | ">=" => &[-1, 0],
        ">" | "<=" => &[0, 1],
        _ => return None,
    };
    match number {
        Some(number) => {
            Some(near.iter().filter_map(|by| number.checked_add(*by)).map(|near| near.to_string()).collect())
        }
        None => is_name.then(|| vec![with.to_owned()]),
    }
}

/// The value of an integer of any base, with or without a sign.
fn number(text: &str) -> Option<i64> {
    let (sign, digits) = text.strip_prefix('-').map_or((1, text), |digits| (-1, digits.trim_start()));
    let digits = digits.trim_end_matches(['u', 'U']);
    let (digits, base) = match digits.strip_prefix("0x").or(digits.strip_prefix("0X")) {
        Some(digits) => (digits, 16),
        None if digits.len() > 1 && digits.starts_with('0') => (digits, 8),
        None => (digits, 10),
    };
    i64::from_str_radix(digits, base).ok().map(|value| sign * value)
}

/// The operator with its sides changed.
fn mirrored(operator: &str) -> Option<&str> {
    Some(match operator {
        "<" => ">",
        ">" => "<",
        "<=" => ">=",
        ">=" => "<=",
        "==" | "!=" => operator,
        _ => return None,
    })
}

/// The names, numbers and operators of a condition. A number has its sign, and what is alone in parentheses has none of them.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens: Vec<&str> = Vec::new();
    let (mut rest, mut minus) = (text.trim_start(), None);
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        let length = if is_word(first) {
            rest.find(|c: char| !is_word(c)).unwrap_or(rest.len())
        } else if ["==", "!=", "<=", ">=", "&&", "||", "<<", ">>"].iter().any(|two| rest.starts_with(two)) {
            2
        } else {
            first.len_utf8()
        };
        let at = text.len() - rest.len();
        let (mut token, after) = rest.split_at(length);
        let before = tokens.len().checked_sub(2).and_then(|at| tokens.get(at)).copied().unwrap_or("(");
        if let Some(start) =
            minus.take().filter(|_| first.is_ascii_digit() && !before.ends_with(|c| is_word(c) || c == ')'))
        {
            tokens.pop();
            token = text.get(start..at + length).unwrap_or(token);
        }
        minus = (token == "-").then_some(at);
        tokens.push(token);
        if let [.., "(", _, ")"] = tokens.as_slice()
            && !is_call(tokens.len().checked_sub(4).and_then(|at| tokens.get(at)))
        {
            let inner = tokens.len() - 2;
            tokens.swap(inner - 1, inner);
            tokens.truncate(inner);
        }
        rest = after.trim_start();
    }
    tokens
}

/// Whether a parenthesis after this token belongs to it: `defined(A)`, `F(1)`.
fn is_call(before: Option<&&str>) -> bool {
    before.is_some_and(|before| before.ends_with(|c: char| c.is_ascii_alphanumeric() || c == '_'))
}

/// The directives of a text without `#`, each with the number of its line, from 0. Comments are blanks, and continued lines are one.
fn directives(text: &str) -> Vec<(usize, String)> {
    let plain = without_comments(text);
    let mut found = Vec::new();
    let mut lines = plain.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let Some(directive) = line.trim_start().strip_prefix('#') else { continue };
        let mut directive = directive.trim_end().to_owned();
        while directive.ends_with('\\') {
            directive.pop();
            let Some((_, next)) = lines.next() else { break };
            directive.push_str(next.trim_end());
        }
        found.push((number, directive));
    }
    found
}

fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(at) = rest.find('/') {
        let (before, from) = rest.split_at(at);
        out.push_str(before);
        let length = comment_len(from).max(1);
        if length == 1 {
            out.push('/');
        }
        let (gone, after) = from.split_at(length);
        if length > 1 {
            out.push(' ');
        }
        out.extend(gone.chars().filter(|c| *c == '\n'));
        rest = after;
    }
    out + rest
}

#[cfg(test)]
mod tests {
    use super::{Conditions, MAX_NAMES, choices_of, conditions};
    use std::collections::{BTreeMap, BTreeSet};
    use std::sync::Arc;

    fn told(text: &str) -> Vec<String> {
        let all = choices_of(&[conditions(text)], &BTreeSet::from(["GIVEN".to_owned()]), 8);
        let value = |value: &Option<String>| value.clone().unwrap_or_else(|| "-".into());
        all.iter()
            .map(|choice| format!("{}: {}", choice.name, choice.values.iter().map(value).collect::<Vec<_>>().join(" ")))
            .collect()
    }

    #[test]
    fn values_come_from_the_conditions() {
        for (text, expected) in [
            ("#ifdef A\n#endif", "A: - 1"),
            ("#if defined(A) && A > 2\n#endif", "A: - 1 2 3"),
            ("#if 3 <= A\n#endif", "A: - 2 3"),
            ("#if A\n#elif B == HIGH\n#endif", "A: - 1|B: - HIGH|HIGH: - B"),
            ("# if ! defined A /* B */ // C\n#endif", "A: - 1"),
            ("#if A \\\n == 7\n#endif", "A: - 7 8"),
            ("#if A == 0x10 || B == 010 || C == -1\n#endif", "A: - 16 17|B: - 8 9|C: - -1 0"),
            ("#if (A) == 3 || B == (3) || ((C)) > ( - 2u )\n#endif", "A: - 3 4|B: - 3 4|C: - -2 -1"),
            ("#if A - 1 == 2\n#endif", "A: - 1"),
            ("#ifdef GIVEN\n#endif\n#if GL_ES || __VERSION__ > 130\n#endif", ""),
            ("#define A 1\n#if A\n#endif", ""),
            ("#ifndef A\n#define A 4\n#endif\n#if A == 2\n#endif", "A: - 1 2 3"),
            ("#ifndef HEADER_H\n#define HEADER_H\n#endif", ""),
            ("/*\n#ifdef A\n#endif\n*/", ""),
            ("#if @normalMap && A\n#endif\n#ifdef ${B}\n#endif", ""),
            ("#ifdef A\n#ifndef A\n1\n#endif\n#elif defined(B)\n2\n#endif", "A: - 1|B: - 1"),
        ] {
            assert_eq!(told(text).join("|"), expected, "{text}");
        }
    }

    #[test]
    fn conditions_in_conditions_share_their_macros() {
        let names = |found: &Conditions| -> usize {
            let shared: BTreeMap<_, _> =
                found.branches.iter().map(|one| (Arc::as_ptr(&one.names), &one.names)).collect();
            shared.values().map(|names| names.len()).sum()
        };
        let many = 1000;
        let nested =
            |open: &dyn Fn(usize) -> String| (0..many).map(open).collect::<String>() + &"#endif\n".repeat(many);
        assert_eq!(names(&conditions(&nested(&|_| "#ifdef A\n".to_owned()))), 1);
        assert!(names(&conditions(&nested(&|at| format!("#ifdef A{at}\n")))) <= MAX_NAMES * MAX_NAMES);
        let other: String = (0..many).map(|at| format!("#elif B{at}\n")).collect();
        assert!(names(&conditions(&format!("#if A\n{other}#endif\n"))) <= MAX_NAMES * many);
    }

    #[test]
    fn branches_know_their_lines_and_macros() {
        let found = conditions("#ifdef A\n#elif defined(B)\n1\n#endif\n");
        assert_eq!(found.branches.iter().map(|one| one.end).collect::<Vec<_>>(), [1, 3]);
        let found = conditions("#ifdef A\n#if 0\n1\n#endif\n#endif\n");
        assert_eq!(found.branches.iter().map(|one| one.names.len()).collect::<Vec<_>>(), [1, 0]);
        let found = conditions("#ifdef A\n1\n#if B\n2\n#endif\n#else\n3\n#endif\n#ifdef C\n");
        let told: Vec<_> = found
            .branches
            .iter()
            .map(|one| (one.directive, one.end, one.names.iter().map(String::as_str).collect::<String>()))
            .collect();
        assert_eq!(told, [(0, 5, "A".into()), (2, 4, "AB".into()), (5, 7, "A".into()), (8, 9, "C".into())]);
    }
}
