//! [`selected`]: the text of one stage of a file whose conditions choose among stages.
//!
//! *In:* a text, the macros that are defined and those that are not. *Out:* the text with the branches that these macros choose.
//! *Holds:* what goes is blank, so lines keep their places. A condition that asks anything else stays, with all its branches.

use super::tokens::{Token, tokens};
use super::vulkan::Conditions;
use glisten_front::source::blanked;
use std::ops::Range;

/// The macros whose state is known.
#[derive(Clone, Copy, Debug)]
pub struct Macros<'m> {
    /// Those that are defined, as 1.
    pub set: &'m [String],
    /// Those that are not defined.
    pub unset: &'m [String],
}

impl Macros<'_> {
    fn is_defined(self, name: &str) -> Option<bool> {
        let is_in = |list: &[String]| list.iter().any(|one| one == name);
        if is_in(self.set) { Some(true) } else { is_in(self.unset).then_some(false) }
    }
}

/// A branch of a condition.
struct Branch {
    /// The directive that opens it.
    line: Range<usize>,
    is_elif: bool,
    /// Whether it is taken, if that is known.
    is_taken: Option<bool>,
}

/// The text with the branches that are taken.
pub fn selected(text: &str, macros: Macros<'_>) -> String {
    let conditions = Conditions::new(text);
    let mut open: Vec<Vec<Branch>> = Vec::new();
    let (mut gone, mut elifs) = (Vec::new(), Vec::new());
    for one in &conditions.list {
        let (word, line) = (one.word(), one.range.clone());
        let is_taken = match word {
            "ifdef" => named(one.rest()).and_then(|name| macros.is_defined(name)),
            "ifndef" => named(one.rest()).and_then(|name| macros.is_defined(name)).map(|is| !is),
            "if" | "elif" => value(one.rest(), macros),
            _ => Some(true),
        };
        let branch = Branch { line: line.clone(), is_elif: word == "elif", is_taken };
        match word {
            "if" | "ifdef" | "ifndef" => open.push(vec![branch]),
            "elif" | "else" => {
                if let Some(last) = open.last_mut() {
                    last.push(branch);
                }
            }
            "endif" => {
                if let Some(branches) = open.pop() {
                    decide(&branches, line, &mut gone, &mut elifs);
                }
            }
            _ => {}
        }
    }
    let mut new = blanked(text, &gone).to_string();
    for line in elifs {
        // A condition that follows only branches that went begins with an `if`.
        if let Some(at) = new.get(line.clone()).and_then(|line| line.find("elif")) {
            new.replace_range(line.start + at..line.start + at + 4, "if  ");
        }
    }
    new
}

/// Finds what goes of a condition that ends.
fn decide(branches: &[Branch], end: Range<usize>, gone: &mut Vec<Range<usize>>, elifs: &mut Vec<Range<usize>>) {
    let Some(first) = branches.first().map(|branch| branch.line.start) else { return };
    let n_left = branches.iter().take_while(|branch| branch.is_taken == Some(false)).count();
    match branches.get(n_left) {
        None => gone.push(first..end.end),
        Some(Branch { line, is_taken: Some(true), .. }) => {
            let next = branches.get(n_left + 1).map_or(end.start, |branch| branch.line.start);
            gone.extend([first..line.end, next..end.end]);
        }
        Some(Branch { line, is_elif, .. }) => {
            gone.push(first..line.start);
            elifs.extend(is_elif.then(|| line.clone()));
        }
    }
}

/// The name that `#ifdef` asks for.
fn named(rest: &str) -> Option<&str> {
    rest.split_whitespace().next()
}

/// The value of a condition (GLSL 1.50 §3.3), if the macros say it.
fn value(condition: &str, macros: Macros<'_>) -> Option<bool> {
    let condition = condition.replace("\\\n", " ").replace("\\\r\n", " ");
    let tokens = tokens(&condition);
    let mut reader = Reader { tokens: &tokens, at: 0, depth: 0, macros, is_odd: false };
    let value = reader.any_of();
    if reader.is_odd || reader.at < tokens.len() { None } else { value }
}

/// How deep parentheses and negations may be nested.
const MOST_NESTED: usize = 64;

/// A condition that is read: macros with `defined`, `!`, `&&`, `||` and parentheses. Everything else is odd.
struct Reader<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    depth: usize,
    macros: Macros<'a>,
    is_odd: bool,
}

impl Reader<'_> {
    fn takes(&mut self, word: &str) -> bool {
        let is_next = self.tokens.get(self.at).is_some_and(|token| token.text == word);
        self.at += usize::from(is_next);
        is_next
    }

    fn takes_twice(&mut self, sign: &str) -> bool {
        let are_next = (0..2).all(|offset| self.tokens.get(self.at + offset).is_some_and(|token| token.text == sign));
        self.at += if are_next { 2 } else { 0 };
        are_next
    }

    fn any_of(&mut self) -> Option<bool> {
        let mut value = self.all_of();
        while self.takes_twice("|") {
            value = match (value, self.all_of()) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (Some(false), Some(false)) => Some(false),
                _ => None,
            };
        }
        value
    }

    fn all_of(&mut self) -> Option<bool> {
        let mut value = self.one();
        while self.takes_twice("&") {
            value = match (value, self.one()) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (Some(true), Some(true)) => Some(true),
                _ => None,
            };
        }
        value
    }

    fn one(&mut self) -> Option<bool> {
        self.depth += 1;
        let value = if self.depth > MOST_NESTED { self.odd() } else { self.operand() };
        self.depth -= 1;
        value
    }

    fn operand(&mut self) -> Option<bool> {
        if self.takes("!") {
            return self.one().map(|value| !value);
        }
        if self.takes("(") {
            let value = self.any_of();
            return if self.takes(")") { value } else { self.odd() };
        }
        if self.takes("defined") {
            let is_open = self.takes("(");
            let value = self.name();
            return if is_open && !self.takes(")") { self.odd() } else { value };
        }
        self.name()
    }

    fn name(&mut self) -> Option<bool> {
        match self.tokens.get(self.at).filter(|token| token.is_word()) {
            Some(token) => {
                self.at += 1;
                self.macros.is_defined(token.text)
            }
            None => self.odd(),
        }
    }

    fn odd(&mut self) -> Option<bool> {
        self.is_odd = true;
        None
    }
}

#[cfg(test)]
mod tests {
    use super::{Macros, selected};

    fn for_vertex(text: &str) -> String {
        let (set, unset) = (["VERTEX".to_owned()], ["FRAGMENT".to_owned()]);
        let new = selected(text, Macros { set: &set, unset: &unset });
        assert_eq!(new.matches('\n').count(), text.matches('\n').count(), "lines keep their places");
        new.lines().filter(|line| !line.trim().is_empty()).map(|line| format!("{line};")).collect()
    }

    #[test]
    fn branches_of_the_stage_stay() {
        assert_eq!(for_vertex("#if defined(VERTEX)\na\n#elif defined(FRAGMENT)\nb\n#endif\nc\n"), "a;c;");
        assert_eq!(for_vertex("#ifdef FRAGMENT\na\n#else\nb\n#endif\n"), "b;");
        assert_eq!(for_vertex("#ifndef VERTEX\na\n#endif\nb\n"), "b;");
        assert_eq!(for_vertex("#if !defined VERTEX || (FRAGMENT && OTHER)\na\n#endif\nb\n"), "b;");
        assert_eq!(for_vertex("#if VERTEX && OTHER\na\n#endif\n"), "#if VERTEX && OTHER;a;#endif;");
        let nested = "#if FRAGMENT\n#ifdef A\na\n#endif\n#elif VERTEX\n#ifdef A\nb\n#else\nc\n#endif\n#endif\n";
        assert_eq!(for_vertex(nested), "#ifdef A;b;#else;c;#endif;");
    }

    #[test]
    fn other_conditions_stay() {
        let text = "#if __VERSION__ >= 130\na\n#else\nb\n#endif\n#ifdef GL_ES\nc\n#endif\n";
        assert_eq!(for_vertex(text).matches('#').count(), 5);
        assert_eq!(for_vertex("#if FRAGMENT\na\n#elif A\nb\n#else\nc\n#endif\n"), "#if   A;b;#else;c;#endif;");
        assert_eq!(for_vertex("#if A\na\n#elif VERTEX\nb\n#endif\n"), "#if A;a;#elif VERTEX;b;#endif;");
        let deep = format!("#if {}VERTEX{}\na\n#endif\n", "(".repeat(200_000), ")".repeat(200_000));
        assert!(for_vertex(&deep).starts_with("#if (((("), "what is nested too deep stays");
    }
}
