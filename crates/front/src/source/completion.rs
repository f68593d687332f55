//! [`Completion`]: what an engine adds to a source before the driver gets it.
//!
//! *In:* texts to read before a source, a version for sources without one, the spelling of the engine's own include directive.
//! *Out:* the order in which the preprocessor reads them. *Holds:* the text of a source is never changed, so its lines and
//! columns stay; each prelude is a text of its own, with its own name.

use super::comments::comment_len;
use std::ops::Range;
use std::sync::Arc;

/// A text that is read before a source: after its `#version` line, or first if there is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prelude {
    /// The name that diagnostics show.
    pub name: String,
    /// The text. Its own `#version` line is the version of sources that have none, and is ignored for the others.
    pub text: Arc<str>,
}

/// A directive that an engine replaces by a file, besides `#include`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ImportDirective {
    /// Its name: `moj_import`.
    pub name: &'static str,
    /// Whether a file is read at its first import only.
    pub once: bool,
    /// The extension by which sources say that they use the directive. No driver has it.
    pub extension: Option<&'static str>,
}

/// The additions of an engine to a source.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Completion {
    /// The version of a source without a `#version` line, as that line would have it: `330`, `150 core`, `300 es`. The
    /// line of a prelude comes first.
    pub assumed_version: Option<String>,
    /// The texts before the source, in order.
    pub preludes: Vec<Prelude>,
    /// The engine's own directive for includes.
    pub directive: Option<ImportDirective>,
    /// Whether the engine replaces `#include` lines, so that no `#extension` line has to allow them.
    pub resolves_includes: bool,
    /// Whether the engine runs a preprocessor in which a macro may be defined again.
    pub redefines: bool,
    /// Whether the engine makes outputs of `gl_FragColor` and `gl_FragData`, so that they may stand next to declared ones.
    pub mixes_outputs: bool,
    /// The names of samplers that the engine replaces where they are no call, so that they hide no built-in function.
    pub replaced_samplers: Vec<String>,
    /// Whether the engine unrolls loops between `#pragma unroll_loop_start` and `#pragma unroll_loop_end`.
    pub unrolls: bool,
}

impl Completion {
    /// The name of the text that contains an assumed version. It is not the name of a file.
    pub const ASSUMED: &'static str = "<assumed version>";

    /// The texts to read for a source, in order: those that bring the version, and the preludes. The second value is
    /// whether the source's own `#version` line comes before them.
    pub(crate) fn texts(&self, source: &str) -> (Vec<Prelude>, bool) {
        if self.preludes.is_empty() && self.assumed_version.is_none() {
            return (Vec::new(), false);
        }
        let has_version = version_line(source).is_some();
        let mut preludes: Vec<(Prelude, Option<Range<usize>>)> =
            self.preludes.iter().map(|prelude| (prelude.clone(), version_line(&prelude.text))).collect();
        if !has_version && let Some(first) = preludes.iter().position(|(_, line)| line.is_some()) {
            let first = preludes.remove(first);
            preludes.insert(0, (first.0, None));
        } else if !has_version && let Some(version) = &self.assumed_version {
            let text = format!("#version {}\n", version.replace(['\n', '\r'], " ")).into();
            preludes.insert(0, (Prelude { name: Self::ASSUMED.to_owned(), text }, None));
        }
        let texts = preludes.into_iter().map(|(prelude, line)| match line {
            Some(line) => Prelude { text: blanked(&prelude.text, &[line]), ..prelude },
            None => prelude,
        });
        (texts.collect(), has_version)
    }
}

/// The text with these ranges filled with spaces. Offsets and lines stay.
pub fn blanked(text: &str, ranges: &[Range<usize>]) -> Arc<str> {
    let mut bytes = text.as_bytes().to_vec();
    for byte in ranges.iter().filter_map(|range| text.get(range.clone()).map(|_| range.clone())).flatten() {
        if let Some(byte) = bytes.get_mut(byte).filter(|byte| !matches!(byte, b'\n' | b'\r')) {
            *byte = b' ';
        }
    }
    // Whole characters were replaced: `get` above takes no other ranges.
    String::from_utf8_lossy(&bytes).into()
}

/// The first `#version` directive of a text, outside of comments, up to the end of its line. A line with a name instead of a
/// number, which some build replaces, is none.
pub fn version_line(text: &str) -> Option<Range<usize>> {
    let bytes = text.as_bytes();
    let mark = '\u{feff}';
    let (mut at, mut first_on_line) = (if text.starts_with(mark) { mark.len_utf8() } else { 0 }, true);
    while let Some(&byte) = bytes.get(at) {
        let rest = text.get(at..).unwrap_or("");
        let comment = comment_len(rest);
        if comment > 0 {
            at += comment;
        } else if byte == b'#' && first_on_line && is_version(rest) {
            return Some(at..at + rest.find(['\n', '\r']).unwrap_or(rest.len()));
        } else {
            first_on_line = matches!(byte, b'\n' | b'\r') || first_on_line && byte.is_ascii_whitespace();
            at += 1;
            while !text.is_char_boundary(at) {
                at += 1;
            }
        }
    }
    None
}

/// Whether the text begins with a `#version` directive.
fn is_version(text: &str) -> bool {
    let words = text.trim_start_matches('#').trim_start_matches([' ', '\t']);
    let rest =
        words.strip_prefix("version").filter(|rest| rest.starts_with([' ', '\t', '\n', '\r']) || rest.is_empty());
    rest.is_some_and(|rest| !is_replaced(rest.trim_start_matches([' ', '\t'])))
}

/// Whether what follows `#version` is a name or a template: `ogre_glsl_ver_330`, `__CONTEXT__`, `%(version)s`, `${V}`.
pub(crate) fn is_replaced(rest: &str) -> bool {
    rest.starts_with(|first: char| first.is_ascii_alphabetic() || ['_', '%', '$', '@', '{'].contains(&first))
}

#[cfg(test)]
mod tests {
    use super::{Completion, Prelude, blanked, version_line};
    use std::ops::Range;

    #[test]
    fn the_version_line_is_found_outside_of_comments() {
        for (text, line) in [
            ("/*/ no\n#version 330\n*/\n#version 150", Some("#version 150")),
            ("#version 150\nvoid", Some("#version 150")),
            ("// #version 110\n/* #version 120\n */ # version 330 core // é", Some("# version 330 core // é")),
            ("\u{feff}void main() {} // #version 150", None),
            ("#versions 3", None),
            ("#version ogre_glsl_ver_330", None),
            ("#version %(version)s", None),
            ("x #version 150", None),
            ("#ifdef A\n  #version 150\r\n#endif", Some("#version 150")),
        ] {
            assert_eq!(version_line(text).and_then(|range| text.get(range)), line, "{text}");
        }
    }

    #[test]
    fn one_version_is_left() {
        let prelude = |text: &str| Prelude { name: "p".into(), text: text.into() };
        let preludes = vec![prelude("#define A"), prelude("#version 330\nint a;")];
        let completion = Completion { assumed_version: Some("150".into()), preludes, ..Completion::default() };
        let texts = |source| {
            let (texts, after) = completion.texts(source);
            (texts.iter().map(|prelude| prelude.text.to_string()).collect::<Vec<_>>(), after)
        };
        assert_eq!(texts("void"), (vec!["#version 330\nint a;".into(), "#define A".into()], false));
        assert_eq!(texts("#version 110"), (vec!["#define A".into(), "            \nint a;".into()], true));
        let assumed = Completion { preludes: vec![prelude("int a;")], ..completion.clone() };
        assert_eq!(assumed.texts("").0[0].text.as_ref(), "#version 150\n");
    }

    #[test]
    fn blanking_keeps_lines_and_offsets() {
        let one = |text, range: Range<usize>| blanked(text, std::slice::from_ref(&range)).to_string();
        assert_eq!(one("a\r\né b\n", 0..5), " \r\n   b\n");
        assert_eq!(one("é", 1..2), "é", "half a character is none");
    }
}
