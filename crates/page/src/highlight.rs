//! Highlights GLSL and TOML as HTML, with a class for each kind of token: comments, directives, keywords, types,
//! numbers, strings.
//!
//! *Holds:* without its tags, the HTML is the escaped text: nothing is lost, whatever the text.

use crate::escape;
use glisten_front::language::{Profile, Version};
use glisten_front::source::{ExpansionId, Span};
use glisten_front::syntax::keywords::WordClass;

/// The language of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Language {
    /// A shader.
    Glsl,
    /// A scene file or a configuration.
    Toml,
}

/// The version that the library and the programs of the gallery are written in.
const VERSION: Version = Version { number: 150, profile: Profile::Core, span: NOWHERE };
const NOWHERE: Span = Span { start: 0, end: 0, expansion: ExpansionId::NONE };

/// The text with a `<span>` around each token that has a class.
pub fn html(text: &str, language: Language) -> String {
    let mut out = String::with_capacity(text.len() * 2);
    let mut rest = text;
    let mut starts_line = true;
    while let Some(first) = rest.chars().next() {
        let (length, class) = match language {
            Language::Glsl => glsl(rest, first, starts_line),
            Language::Toml => toml(rest, first, starts_line),
        };
        let (token, after) = rest.split_at(length.clamp(first.len_utf8(), rest.len()));
        starts_line = if first.is_whitespace() { starts_line || token.contains('\n') } else { false };
        match class {
            Some(class) => {
                out.push_str("<span class=\"");
                out.push_str(class);
                out.push_str("\">");
                out.push_str(&escape(token));
                out.push_str("</span>");
            }
            None => out.push_str(&escape(token)),
        }
        rest = after;
    }
    out
}

/// Highlights GLSL line by line. It knows whether a line is within a comment that began before it.
#[derive(Default)]
pub struct Comments {
    open: bool,
}

impl Comments {
    /// The next line.
    pub fn html(&mut self, line: &str) -> String {
        if self.passes(line) {
            let mut out = String::from("<span class=\"com\">");
            out.push_str(&escape(line));
            return out + "</span>";
        }
        html(line, Language::Glsl)
    }

    /// Goes past the next line. Tells whether a comment of several lines has a part of it.
    pub fn passes(&mut self, line: &str) -> bool {
        let was_open = self.open;
        let mut rest = line;
        loop {
            let mark = if self.open { "*/" } else { "/*" };
            let Some(place) = rest.find(mark) else { break };
            self.open = !self.open;
            rest = rest.get(place + 2..).unwrap_or("");
        }
        // Markup knows comments of one line only.
        was_open || self.open || line.trim_start().starts_with("/*")
    }
}

type Token = (usize, Option<&'static str>);

fn glsl(rest: &str, first: char, starts_line: bool) -> Token {
    if rest.starts_with("//") || (first == '#' && starts_line) {
        return (line(rest), Some(if first == '#' { "pre" } else { "com" }));
    }
    if first.is_ascii_digit() {
        return (run(rest, |character| character.is_ascii_alphanumeric() || character == '.'), Some("num"));
    }
    if is_word(first) {
        let length = run(rest, is_word);
        let word = rest.get(..length).unwrap_or_default();
        return (length, class_of(word));
    }
    (first.len_utf8(), None)
}

fn class_of(word: &str) -> Option<&'static str> {
    match WordClass::of(word, VERSION)? {
        WordClass::Keyword => Some("key"),
        WordClass::Type => Some("typ"),
        WordClass::Builtin => Some("bui"),
        WordClass::Constant => None,
    }
}

fn toml(rest: &str, first: char, starts_line: bool) -> Token {
    match first {
        '#' => (line(rest), Some("com")),
        '[' if starts_line => (line(rest), Some("pre")),
        '"' | '\'' => {
            let long: String = std::iter::repeat_n(first, 3).collect();
            let quote = if rest.starts_with(&long) { long } else { first.to_string() };
            let end = rest.get(quote.len()..).and_then(|body| body.find(&quote));
            (end.map_or(rest.len(), |end| end + 2 * quote.len()), Some("str"))
        }
        _ if first.is_ascii_digit() => (run(rest, |c| c.is_ascii_alphanumeric() || c == '.'), Some("num")),
        _ if is_word(first) => (run(rest, is_word), None),
        _ => (first.len_utf8(), None),
    }
}

fn is_word(character: char) -> bool {
    character.is_ascii_alphanumeric() || character == '_'
}

fn line(rest: &str) -> usize {
    rest.find('\n').unwrap_or(rest.len())
}

fn run(rest: &str, accept: impl Fn(char) -> bool) -> usize {
    rest.find(|character| !accept(character)).unwrap_or(rest.len())
}

#[cfg(test)]
mod tests {
    use super::{Language, html};

    /// The text that a browser shows.
    fn shown(html: &str) -> String {
        let mut text = String::new();
        let mut in_tag = false;
        for character in html.chars() {
            match character {
                '<' => in_tag = true,
                '>' => in_tag = false,
                _ if !in_tag => text.push(character),
                _ => {}
            }
        }
        text.replace("&lt;", "<").replace("&gt;", ">").replace("&quot;", "\"").replace("&amp;", "&")
    }

    #[test]
    fn nothing_is_lost() {
        for scene in glisten_library::scenes() {
            assert_eq!(shown(&html(scene.text, Language::Toml)), scene.text);
        }
        for file in glisten_library::shader_files() {
            let text = glisten_library::shader(file).expect("it is embedded");
            assert_eq!(shown(&html(text, Language::Glsl)), text);
        }
        for odd in ["\"", "'''", "a < b && c > \"d\"", "é#\n#x", "//", ""] {
            assert_eq!(shown(&html(odd, Language::Toml)), odd);
            assert_eq!(shown(&html(odd, Language::Glsl)), odd);
        }
    }

    #[test]
    fn words_have_their_kinds() {
        assert_eq!(
            html("in vec3 n; // <N>", Language::Glsl),
            "<span class=\"key\">in</span> <span class=\"typ\">vec3</span> n; <span class=\"com\">// &lt;N&gt;</span>"
        );
        assert_eq!(html("  #define A", Language::Glsl), "  <span class=\"pre\">#define A</span>");
        assert_eq!(
            html("[draw]\na = 1", Language::Toml),
            "<span class=\"pre\">[draw]</span>\na = <span class=\"num\">1</span>"
        );
    }
}
