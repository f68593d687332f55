//! The text of a source as its tests see it: without its version line and without `main`, and with plain variables in place of inputs and
//! outputs, so that functions can be called alone.
//!
//! *In:* a text. *Out:* the same text with blanks. *Holds:* every line stays where it is. Comments and what is behind conditions of the
//! preprocessor count as they are written.

use glisten_front::compiler::{Compilation, Compiler, Source};
use glisten_front::hir::Stage;
use glisten_front::index::Inspection;
use glisten_front::source::{blanked, version_line};
use std::ops::Range;

/// A source without `#version` and `main`.
pub(super) struct Bare {
    pub(super) version: String,
    pub(super) text: String,
    /// The text of the `#version` line that it had.
    line: Option<Range<usize>>,
}

/// The end that makes a shader of a text: an output and `main`.
const END: &str = "\nout vec4 glisten_result;\nvoid main() { glisten_result = vec4(0.0); }\n";

/// The oldest version of which functions can be called as they are; older ones are read as this one.
const OLDEST: u32 = 130;
/// The version in place of older ones.
const COMPATIBLE: &str = "150 compatibility";

impl Bare {
    pub(super) fn new(text: &str) -> Self {
        let line = version_line(text);
        let told = line.clone().and_then(|line| text.get(line)).unwrap_or("");
        let version = told.trim_start_matches(['#', ' ', '\t']).trim_start_matches("version").trim();
        let number = version.split_whitespace().next().and_then(|number| number.parse::<u32>().ok());
        let version = match number {
            None => "150".to_owned(),
            Some(number) if number < OLDEST => COMPATIBLE.to_owned(),
            Some(_) => version.to_owned(),
        };
        let code = without_comments(text);
        let mut ranges: Vec<Range<usize>> = line.clone().into_iter().collect();
        ranges.extend(mains(&code));
        ranges.extend(interfaces(&code));
        ranges.sort_by_key(|range| range.start);
        Self { version, text: blanked(text, &ranges).to_string(), line }
    }

    /// Compiles the text as a shader of its version called `name`. Lines are those of the source.
    pub(super) fn compile(&self, name: &str, compiler: &Compiler) -> (Compilation, Inspection) {
        let mut text = self.text.clone() + END;
        if let Some(line) = self.line.clone() {
            text.replace_range(line, &format!("#version {}", self.version));
        }
        let assumed = self.line.is_none().then(|| self.version.clone());
        let compiler = compiler.clone().with_change(move |_, mut prepared| {
            let completion = &mut prepared.completion;
            completion.resolves_includes = true;
            if let Some(version) = &assumed {
                completion.assumed_version = Some(version.clone());
                for prelude in &mut completion.preludes {
                    let line = version_line(&prelude.text);
                    prelude.text = blanked(&prelude.text, line.as_slice());
                }
            }
            prepared
        });
        let source = Source { name: name.into(), text: text.into(), stage: Stage::Fragment };
        compiler.inspect(&[source], None)
    }
}

/// The words that make a global an input or an output, which it is not where its functions are called alone.
const INTERFACE: &[&str] =
    &["in", "out", "attribute", "varying", "flat", "smooth", "noperspective", "centroid", "sample"];

/// The places of such words, and of layouts before them, outside of all brackets.
fn interfaces(code: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let (mut depth, mut at, mut first_on_line) = (0_usize, 0, true);
    let mut layout: Option<Range<usize>> = None;
    while let Some(letter) = code.get(at..).and_then(|rest| rest.chars().next()) {
        let rest = code.get(at..).unwrap_or("");
        let is_word = letter.is_ascii_alphabetic() || letter == '_';
        if letter == '#' && first_on_line {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        if !is_word {
            first_on_line = letter == '\n' || first_on_line && letter.is_whitespace();
            depth = match letter {
                '{' | '(' | '[' => depth + 1,
                '}' | ')' | ']' => depth.saturating_sub(1),
                _ => depth,
            };
            if !letter.is_whitespace() {
                layout = None;
            }
            at += letter.len_utf8();
            continue;
        }
        first_on_line = false;
        let size = rest.find(|next: char| !next.is_ascii_alphanumeric() && next != '_').unwrap_or(rest.len());
        let word = rest.get(..size).unwrap_or("");
        let end = at + size;
        if depth == 0 && word == "layout" {
            let close = rest.find(')').map_or(end, |close| at + close + 1);
            layout = Some(at..close);
            at = close;
            continue;
        }
        if depth == 0 && INTERFACE.contains(&word) {
            found.extend(layout.take());
            // `layout(..) in;` declares no variable.
            let behind = code.get(end..).unwrap_or("");
            let semicolon = behind.len() - behind.trim_start().len();
            let ends = behind.trim_start().starts_with(';');
            found.push(at..if ends { end + semicolon + 1 } else { end });
        }
        layout = None;
        at = end;
    }
    found
}

/// The definitions of `main` in a text.
fn mains(code: &str) -> Vec<Range<usize>> {
    let mut found = Vec::new();
    let mut at = 0;
    while let Some(place) = code.get(at..).and_then(|rest| rest.find("main")) {
        let name = at + place;
        at = name + "main".len();
        let before = code.get(..name).unwrap_or("");
        let Some(head) = before.trim_end().strip_suffix("void").filter(|_| before.ends_with(char::is_whitespace))
        else {
            continue;
        };
        let rest = code.get(at..).unwrap_or("");
        if !rest.trim_start().starts_with('(') {
            continue;
        }
        let Some(open) = rest.find('{').filter(|open| !rest.get(..*open).unwrap_or("").contains(';')) else { continue };
        let mut depth = 0_usize;
        let end = rest.char_indices().skip_while(|(index, _)| *index < open).find_map(|(index, letter)| {
            match letter {
                '{' => depth += 1,
                '}' => depth = depth.saturating_sub(1),
                _ => {}
            }
            (depth == 0).then_some(index + 1)
        });
        if let Some(end) = end {
            found.push(head.len()..at + end);
            at += end;
        }
    }
    found
}

/// The places of the comments of a text.
pub(super) fn comments(text: &str) -> Vec<Range<usize>> {
    let mut ranges = Vec::new();
    let mut at = 0;
    while let Some(place) = text.get(at..).and_then(|rest| rest.find('/')) {
        let start = at + place;
        let rest = text.get(start..).unwrap_or("");
        let end = if rest.starts_with("//") {
            start + rest.find(['\n', '\r']).unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            start + rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else {
            at = start + 1;
            continue;
        };
        ranges.push(start..end);
        at = end;
    }
    ranges
}

/// The text with blanks in place of comments: each byte of them is a space, line ends stay.
fn without_comments(text: &str) -> String {
    let mut bytes = text.as_bytes().to_vec();
    for byte in comments(text).into_iter().flatten() {
        if let Some(byte) = bytes.get_mut(byte).filter(|byte| !matches!(byte, b'\n' | b'\r')) {
            *byte = b' ';
        }
    }
    String::from_utf8(bytes).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::Bare;

    #[test]
    fn the_version_and_main_are_taken_out_and_lines_stay() {
        let text = "// main\n#version 330 core\nfloat f() { return 1.0; }\nvoid main() {\n  if (true) { f(); }\n}\nfloat g() { return 2.0; }\n";
        let bare = Bare::new(text);
        assert_eq!(bare.version, "330 core");
        assert_eq!(bare.text.lines().count(), text.lines().count());
        assert!(!bare.text.contains("void main") && bare.text.contains("float g()") && bare.text.contains("float f()"));
        assert_eq!(bare.text.lines().nth(6), Some("float g() { return 2.0; }"));
    }

    #[test]
    fn old_versions_are_read_as_one_that_fetches_texels() {
        assert_eq!(Bare::new("#version 120\n").version, "150 compatibility");
        assert_eq!(Bare::new("float f() { return 1.0; }\n").version, "150");
        assert_eq!(Bare::new("#version 300 es\n").version, "300 es");
    }

    #[test]
    fn inputs_and_outputs_are_plain_variables() {
        let text = "layout(location = 0) in vec4 p;\nflat out ivec2 q;\nuniform mat4 m; // in\nlayout(std140) uniform B { vec4 x; };\n\
            layout(early_fragment_tests) in;\nvarying vec3 n;\nfloat f(in float a, out float b) { b = a; return a; }\n#define in2 in\n";
        let bare = Bare::new(text).text;
        let lines: Vec<&str> = bare.lines().map(str::trim).collect();
        assert_eq!(lines[..3], ["vec4 p;", "ivec2 q;", "uniform mat4 m; // in"]);
        assert_eq!(lines[3], "layout(std140) uniform B { vec4 x; };");
        assert_eq!(lines[4..6], ["", "vec3 n;"]);
        assert_eq!(lines[6], "float f(in float a, out float b) { b = a; return a; }");
        assert_eq!(lines[7], "#define in2 in");
    }
}
