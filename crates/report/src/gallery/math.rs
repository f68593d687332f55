//! Converts formulas to MathML, which browsers typeset themselves.
//!
//! *In:* a small subset of TeX: letters, numbers, operators, `_` and `^` with a letter or a `{group}`, and the
//! commands of [`SYMBOLS`], [`FUNCTIONS`], `\frac`, `\sqrt`, `\mathbf`, `\mathrm`, `\text`, `\sum`. *Out:* a `<math>` element,
//! escaped. *Holds:* anything outside the subset is an error and is never dropped.

use glisten_page::escape;

/// Commands for one operator or letter: name, element, text.
const SYMBOLS: &[(&str, &str, &str)] = &[
    ("cdot", "mo", "\u{22c5}"),
    ("otimes", "mo", "\u{2297}"),
    ("times", "mo", "\u{d7}"),
    ("lceil", "mo", "\u{2308}"),
    ("rceil", "mo", "\u{2309}"),
    ("{", "mo", "{"),
    ("}", "mo", "}"),
    ("theta", "mi", "\u{3b8}"),
    ("alpha", "mi", "\u{3b1}"),
    ("sigma", "mi", "\u{3c3}"),
    ("rho", "mi", "\u{3c1}"),
    ("pi", "mi", "\u{3c0}"),
    ("infty", "mi", "\u{221e}"),
];

/// Commands that are set upright, as words.
const FUNCTIONS: &[&str] = &["max", "min", "cos", "sin"];

/// Commands for space: name, and width in em.
const SPACES: &[(&str, &str)] = &[(",", "0.17em"), (";", "0.28em"), ("quad", "1em")];

/// The deepest nesting of groups in a formula.
const MAX_DEPTH: u32 = 16;

/// The `<math>` element of a formula.
///
/// # Errors
/// The part of the text that is not in the subset.
pub(super) fn mathml(tex: &str) -> Result<String, String> {
    let mut parser = Parser { rest: tex, depth: 0 };
    let row = parser.row()?;
    if parser.rest.is_empty() {
        Ok(format!("<math display=\"block\"><mrow>{row}</mrow></math>"))
    } else {
        Err(format!("`}}` without `{{` in `{tex}`"))
    }
}

struct Parser<'t> {
    rest: &'t str,
    depth: u32,
}

impl<'t> Parser<'t> {
    fn peek(&mut self) -> Option<char> {
        self.rest = self.rest.trim_start();
        self.rest.chars().next()
    }

    fn take(&mut self, count: usize) -> &'t str {
        let (taken, rest) = self.rest.split_at(count);
        self.rest = rest;
        taken
    }

    /// The length in bytes of the leading characters that `accept` allows.
    fn length(&self, accept: impl Fn(char) -> bool) -> usize {
        self.rest.find(|character| !accept(character)).unwrap_or(self.rest.len())
    }

    /// The elements up to a `}` or the end.
    fn row(&mut self) -> Result<String, String> {
        let mut row = String::new();
        while let Some(next) = self.peek() {
            if next == '}' {
                break;
            }
            row.push_str(&self.scripted()?);
        }
        Ok(row)
    }

    /// An element with its subscript and superscript.
    fn scripted(&mut self) -> Result<String, String> {
        let is_sum = self.rest.starts_with("\\sum");
        let base = self.atom()?;
        let (mut below, mut above) = (None, None);
        while let Some(mark @ ('_' | '^')) = self.peek() {
            self.take(1);
            let script = self.script()?;
            let slot = if mark == '_' { &mut below } else { &mut above };
            if slot.replace(script).is_some() {
                return Err(format!("two `{mark}` at one place"));
            }
        }
        Ok(match (below, above, is_sum) {
            (None, None, _) => base,
            (Some(below), None, _) => format!("<msub>{base}{below}</msub>"),
            (None, Some(above), _) => format!("<msup>{base}{above}</msup>"),
            (Some(below), Some(above), false) => format!("<msubsup>{base}{below}{above}</msubsup>"),
            (Some(below), Some(above), true) => format!("<munderover>{base}{below}{above}</munderover>"),
        })
    }

    /// A group or one element. A group of letters alone is a word.
    fn script(&mut self) -> Result<String, String> {
        if self.peek() == Some('{') {
            let body = self.rest.get(1..).unwrap_or_default();
            let letters = body.find(|character: char| !character.is_ascii_alphabetic()).unwrap_or(body.len());
            if letters > 1 && body.get(letters..).is_some_and(|rest| rest.starts_with('}')) {
                let taken = self.take(letters + 2);
                return Ok(format!("<mi>{}</mi>", taken.trim_matches(['{', '}'])));
            }
        }
        self.atom()
    }

    fn group(&mut self) -> Result<String, String> {
        if self.peek() != Some('{') {
            return Err("a `{group}` is missing".into());
        }
        if self.depth == MAX_DEPTH {
            return Err(format!("more than {MAX_DEPTH} groups within each other"));
        }
        self.take(1);
        self.depth += 1;
        let row = self.row()?;
        self.depth -= 1;
        if self.peek() != Some('}') {
            return Err("`{` without `}`".into());
        }
        self.take(1);
        Ok(format!("<mrow>{row}</mrow>"))
    }

    /// The text of a group, uninterpreted.
    fn words(&mut self) -> Result<&'t str, String> {
        let end = self.rest.find('}').filter(|_| self.rest.starts_with('{'));
        let end = end.ok_or("a `{text}` is missing")?;
        Ok(self.take(end + 1).trim_matches(['{', '}']))
    }

    fn atom(&mut self) -> Result<String, String> {
        let Some(next) = self.peek() else { return Err("something is missing at the end".into()) };
        match next {
            '\\' => self.command(),
            '{' => self.group(),
            _ if next.is_ascii_digit() => {
                let length = self.length(|character| character.is_ascii_digit() || character == '.');
                Ok(format!("<mn>{}</mn>", self.take(length)))
            }
            _ if next.is_ascii_alphabetic() => Ok(format!("<mi>{}</mi>", self.take(1))),
            '-' => {
                self.take(1);
                Ok("<mo>\u{2212}</mo>".into())
            }
            '<' | '>' => {
                let sign = if self.take(1) == "<" { "&lt;" } else { "&gt;" };
                Ok(format!("<mo>{sign}</mo>"))
            }
            '(' | ')' | '|' | '[' | ']' => Ok(format!("<mo stretchy=\"false\">{}</mo>", self.take(1))),
            '+' | '=' | ',' | '/' => Ok(format!("<mo>{}</mo>", self.take(1))),
            other => Err(format!("`{other}` is not of the formulas' language")),
        }
    }

    fn command(&mut self) -> Result<String, String> {
        self.take(1);
        let length = self.length(|character| character.is_ascii_alphabetic());
        let first = self.rest.chars().next().map_or(0, char::len_utf8);
        let name = self.take(if length > 0 { length } else { first });
        if let Some((_, element, text)) = SYMBOLS.iter().find(|(symbol, ..)| *symbol == name) {
            let stretchy = if *element == "mo" { " stretchy=\"false\"" } else { "" };
            return Ok(format!("<{element}{stretchy}>{text}</{element}>"));
        }
        if let Some((_, width)) = SPACES.iter().find(|(space, _)| *space == name) {
            return Ok(format!("<mspace width=\"{width}\"/>"));
        }
        if FUNCTIONS.contains(&name) {
            return Ok(format!("<mi>{name}</mi>"));
        }
        match name {
            "frac" => Ok(format!("<mfrac>{}{}</mfrac>", self.group()?, self.group()?)),
            "sqrt" => Ok(format!("<msqrt>{}</msqrt>", self.group()?)),
            "sum" => Ok("<mo>\u{2211}</mo>".into()),
            "mathbf" => Ok(format!("<mi class=\"vector\">{}</mi>", escape(self.words()?))),
            "mathrm" => Ok(format!("<mi mathvariant=\"normal\">{}</mi>", escape(self.words()?))),
            "text" => Ok(format!("<mtext>\u{a0}{}\u{a0}</mtext>", escape(self.words()?.trim()))),
            _ => Err(format!("`\\{name}` is not of the formulas' language")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::mathml;

    fn inner(tex: &str) -> String {
        let math = mathml(tex).unwrap_or_else(|error| panic!("{tex}: {error}"));
        math.trim_start_matches("<math display=\"block\"><mrow>").trim_end_matches("</mrow></math>").to_owned()
    }

    #[test]
    fn equation_86() {
        assert_eq!(
            inner(r"I_{spec} = \max(\mathbf{R} \cdot \mathbf{V}, 0)^{K_{shi}}"),
            "<msub><mi>I</mi><mi>spec</mi></msub><mo>=</mo><mi>max</mi><mo stretchy=\"false\">(</mo>\
             <mi class=\"vector\">R</mi><mo stretchy=\"false\">\u{22c5}</mo><mi class=\"vector\">V</mi><mo>,</mo><mn>0</mn>\
             <msup><mo stretchy=\"false\">)</mo><mrow><msub><mi>K</mi><mi>shi</mi></msub></mrow></msup>"
        );
    }

    #[test]
    fn fractions_and_sums() {
        assert_eq!(
            inner(r"\frac{1}{r^2}"),
            "<mfrac><mrow><mn>1</mn></mrow><mrow><msup><mi>r</mi><mn>2</mn></msup></mrow></mfrac>"
        );
        assert!(inner(r"\sum_{k=1}^n d^k").starts_with("<munderover><mo>\u{2211}</mo><mrow>"));
    }

    #[test]
    fn what_is_not_understood_is_an_error() {
        for (tex, message) in [
            (r"\integral x", "`\\integral`"),
            ("a_b_c", "two `_`"),
            (r"\frac{1}", "missing"),
            ("{a", "without `}`"),
            ("a}", "without `{`"),
            ("a & b", "`&`"),
            ("a^", "missing"),
            (r"\mathbf N", "missing"),
            ("\\", "`\\`"),
        ] {
            let error = mathml(tex).expect_err(tex);
            assert!(error.contains(message), "{tex}: {error}");
        }
        assert!(mathml(&"{".repeat(100_000)).is_err());
    }

    #[test]
    fn text_is_escaped() {
        assert!(inner(r"\text{<b>}").contains("&lt;b&gt;"));
        assert_eq!(inner("a < b"), "<mi>a</mi><mo>&lt;</mo><mi>b</mi>");
    }
}
