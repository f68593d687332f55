//! The lines of an engine's prelude that a source needs: engines declare what a source does not declare itself.
//!
//! *In:* a prelude with one declaration, macro or function a line, and a source. *Out:* the prelude, with blank lines for what
//! the source declares. *Holds:* lines stay where they are. A line that ends in `// with f` is for sources that define `f`.

use super::code::{count_definitions, is_name, tail, without_comments, words};
use glisten_front::source::blanked;
use std::collections::BTreeSet;
use std::ops::Range;
use std::sync::Arc;

/// The first words of declarations at global scope.
const QUALIFIERS: &[&str] =
    &["uniform", "in", "out", "attribute", "varying", "const", "flat", "smooth", "layout", "highp", "mediump", "lowp"];

/// The number of uses of a name among which its declaration is: it comes before the others.
const MAX_USES: usize = 256;
/// The largest length of a declaration up to the name.
const MAX_STATEMENT: usize = 512;

/// A declaration of a prelude's line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Line<'a> {
    Macro(&'a str),
    Function(&'a str),
    Variable(&'a str),
}

/// The declaration of a line.
fn declaration(line: &str) -> Option<Line<'_>> {
    if let Some(rest) = line.trim_start().strip_prefix("#define") {
        return words(rest).next().map(|(_, name)| Line::Macro(name));
    }
    let mut all = words(line);
    let (_, first) = all.next()?;
    if QUALIFIERS.contains(&first) {
        let end = line.find([';', '=', '[']).unwrap_or(line.len());
        return words(line.get(..end)?).last().map(|(_, name)| Line::Variable(name));
    }
    let before = line.get(..line.find('(')?)?;
    line.contains('{').then(|| words(before).last().map(|(_, name)| Line::Function(name))).flatten()
}

/// Whether a text without comments declares a name at global scope, by a declaration with a qualifier. A parameter only hides
/// the name in its function (GLSL 1.50, section 4.2).
fn declares(code: &str, name: &str) -> bool {
    words(code).filter(|(_, word)| *word == name).take(MAX_USES).any(|(at, _)| {
        let before = tail(code.get(..at).unwrap_or(""), MAX_STATEMENT);
        let start = before.rfind([';', '{', '}']).map_or(0, |end| end + 1);
        // Directives end with their lines, and belong to no declaration.
        let statement = before.get(start..).unwrap_or("").lines().filter(|line| !line.trim_start().starts_with('#'));
        let is_qualified = statement.clone().flat_map(words).any(|(_, word)| QUALIFIERS.contains(&word));
        let sides = |side: char| statement.clone().map(|line| line.matches(side).count()).sum::<usize>();
        let is_parameter = sides('(') > sides(')');
        is_qualified && !is_parameter
    })
}

fn defines(code: &str, name: &str) -> bool {
    let define = |line: &str| {
        let rest = line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("define")?.trim_start();
        Some(rest.split(|character: char| !is_name(character)).next() == Some(name))
    };
    code.lines().any(|line| define(line).unwrap_or(false))
}

/// The prelude, with blank lines for what the source declares itself.
pub fn needed(prelude: &str, source: &str) -> Arc<str> {
    let code = without_comments(source);
    let used: BTreeSet<&str> = words(&code).map(|(_, word)| word).collect();
    let mut at = 0;
    let mut unneeded: Vec<Range<usize>> = Vec::new();
    for line in prelude.split_inclusive('\n') {
        let declared = match declaration(line) {
            Some(Line::Macro(name) | Line::Function(name) | Line::Variable(name)) if !used.contains(name) => false,
            Some(Line::Macro(name)) => defines(&code, name) || count_definitions(&code, name) > 0,
            Some(Line::Function(name)) => count_definitions(&code, name) > 0,
            Some(Line::Variable(name)) => declares(&code, name),
            None => false,
        };
        let user = line.trim_end().rsplit_once("// with ").map(|(_, name)| name);
        if declared || user.is_some_and(|name| count_definitions(&code, name) == 0) {
            unneeded.push(at..at + line.len());
        }
        at += line.len();
    }
    blanked(prelude, &unneeded)
}

#[cfg(test)]
mod tests {
    use super::{Line, declaration, needed};

    #[test]
    fn lines_declare() {
        assert_eq!(declaration("uniform vec3 a[4];"), Some(Line::Variable("a")));
        assert_eq!(declaration("#define B(x) x"), Some(Line::Macro("B")));
        assert_eq!(declaration("void main() { f(); }"), Some(Line::Function("main")));
        assert_eq!(declaration("void f(vec2 p);"), None);
    }

    #[test]
    fn only_what_is_missing_is_declared() {
        let prelude = "uniform float time;\nuniform vec2 size;\n#define PI 3.0\nvoid main() { f(); }\n";
        let source = "// uniform float time;\n#define PI 3.14\n#ifdef X\n#endif\nuniform\n  vec2 size;\nvoid g() { time; size; }";
        let text = needed(prelude, source);
        assert_eq!(
            text.lines().map(str::trim).collect::<Vec<_>>(),
            ["uniform float time;", "", "", "void main() { f(); }"]
        );
        assert!(!needed(prelude, "void main()\n{}").contains("main"));
        let hidden =
            "float f(in float time) { return time; } float g(const in vec2 size, in float time) { return time; }";
        assert_eq!(needed(prelude, hidden).as_ref(), prelude);
        let placed = "layout(location = 0) uniform float time; float f() { return time; }";
        assert!(!needed(prelude, placed).contains("time"));
        let shadowed = needed("#define F() 1\n", "void F() {}");
        assert!(shadowed.trim().is_empty());
        let line = "void main() { f(); } // with f\n";
        assert!(needed(line, "void f() {}").contains("main") && !needed(line, "void f();").contains("main"));
    }
}
