//! [`whole_text`] makes a shader self-contained, for a driver that knows neither `#include` nor macros from outside.
//!
//! *In:* a file, the files that its `#include` lines brought in, and macro definitions. *Out:* one text.
//! *Holds:* a text without includes and definitions is returned untouched. Otherwise each line stays as written,
//! except that each `#include` line is replaced by its file, each unrolled loop by its copies, and the `#extension` lines that
//! allow includes are removed.
//! *Not done here:* expanding macros and deciding conditions. That is left to the driver's preprocessor.

use super::{FileId, SourceMap, Span};
use std::sync::Arc;

/// A file that an `#include` brought in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inclusion {
    /// The `#` of the directive.
    pub directive: Span,
    /// The file to insert: none for a file that is included only once and was read before.
    pub file: Option<FileId>,
}

/// A loop that an engine unrolled.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unrolled {
    /// The offset of the `#` of its first pragma.
    pub start: u32,
    /// The offset after its last pragma.
    pub end: u32,
    /// All copies of its body.
    pub text: String,
}

/// Everything that the preprocessor read besides the file, in the order in which it did.
#[derive(Clone, Copy, Debug)]
pub struct Edits<'a> {
    /// The files that were included.
    pub inclusions: &'a [Inclusion],
    /// The loops that were unrolled.
    pub unrolled: &'a [Unrolled],
    /// The texts of an engine.
    pub preludes: &'a [FileId],
}

/// The largest depth of nested includes, the same as the preprocessor's.
const MAX_DEPTH: usize = 64;

/// The text of `file` with its includes inserted, and with `defines` and the preludes added after its `#version` line, which
/// is at `version`. The line may be in one of the preludes; they come first then.
pub fn whole_text(
    sources: &SourceMap,
    file: FileId,
    version: Span,
    edits: Edits<'_>,
    defines: &[(String, String)],
) -> Arc<str> {
    let Edits { inclusions, unrolled, preludes } = edits;
    if inclusions.is_empty() && unrolled.is_empty() && defines.is_empty() && preludes.is_empty() {
        return Arc::clone(sources.file(file).text());
    }
    let place = sources.file_of(version).filter(|found| *found == file || preludes.contains(found));
    let version = place.and_then(|place| Some((place, sources.line(version)?)));
    let mut writer = Writer { sources, inclusions, unrolled, written: 0..0, text: String::new() };
    if version.is_none() {
        writer.define(defines);
    }
    let is_first = place == Some(file);
    let before = preludes.iter().filter(|_| !is_first).chain([&file]);
    for &text in before {
        for line in 1..=sources.file(text).line_count() {
            writer.line(text, line, 0);
            if Some((text, line)) == version {
                writer.define(defines);
                preludes.iter().filter(|_| is_first).for_each(|prelude| writer.whole(*prelude));
            }
        }
        writer.end_line_unless(text == file);
    }
    writer.text.into()
}

struct Writer<'a> {
    sources: &'a SourceMap,
    /// The inclusions that are not written yet.
    inclusions: &'a [Inclusion],
    /// The loops that are not written yet.
    unrolled: &'a [Unrolled],
    /// The offsets of the loop that was written last.
    written: std::ops::Range<u32>,
    text: String,
}

impl Writer<'_> {
    fn define(&mut self, defines: &[(String, String)]) {
        self.end_line();
        for (name, value) in defines {
            self.text.push_str(&format!("#define {name} {value}\n"));
        }
    }

    fn end_line(&mut self) {
        if !self.text.is_empty() && !self.text.ends_with('\n') {
            self.text.push('\n');
        }
    }

    fn end_line_unless(&mut self, last: bool) {
        if !last {
            self.end_line();
        }
    }

    /// Every line of a file.
    fn whole(&mut self, id: FileId) {
        (1..=self.sources.file(id).line_count()).for_each(|line| self.line(id, line, 0));
        self.end_line();
    }

    fn line(&mut self, id: FileId, line: u32, depth: usize) {
        let file = self.sources.file(id);
        let Some(range) = file.line_range(line) else { return };
        let place = |offset: usize| file.base() + offset as u32;
        if self.written.contains(&place(range.start)) {
            return;
        }
        if let Some((next, rest)) = self.unrolled.split_first()
            && (place(range.start)..place(range.end)).contains(&next.start)
        {
            self.unrolled = rest;
            self.written = place(range.start)..next.end;
            self.text.push_str(&next.text);
            self.end_line();
            return;
        }
        if let Some((next, rest)) = self.inclusions.split_first()
            && (place(range.start)..place(range.end)).contains(&next.directive.start)
        {
            self.inclusions = rest;
            match next.file.filter(|_| depth < MAX_DEPTH) {
                Some(inner) => {
                    (1..=self.sources.file(inner).line_count()).for_each(|line| self.line(inner, line, depth + 1));
                    self.end_line();
                }
                None => self.text.push('\n'),
            }
            return;
        }
        // A byte order mark may stand before a text, never inside of one.
        let text = file.text().get(range).unwrap_or("").trim_start_matches('\u{feff}');
        if allows_includes(text) {
            self.text.push('\n');
        } else {
            self.text.push_str(text);
        }
    }
}

/// Whether a line is the `#extension` line that allows includes.
fn allows_includes(line: &str) -> bool {
    let words = line.trim_start().strip_prefix('#').and_then(|line| line.trim_start().strip_prefix("extension"));
    words.is_some_and(|words| {
        let name = words.trim_start().split([' ', '\t', ':']).next();
        // The last one is Minecraft's, for its own directive.
        matches!(name, Some("GL_ARB_shading_language_include" | "GL_GOOGLE_include_directive" | "GL_MC_moj_import"))
    })
}

#[cfg(test)]
mod tests {
    use crate::hir::Stage;
    use crate::source::{Completion, IncludeForm, IncludeResolver, Included, Prelude};
    use crate::{Compiler, Options, Source};

    struct Two;

    impl IncludeResolver for Two {
        fn resolve(&self, path: &str, _: IncludeForm, _: &str) -> Result<Included, String> {
            let text = match path {
                "outer.glsl" => "#ifndef OUTER\n#define OUTER\n#include \"once.glsl\"\n#endif\n",
                _ => "#pragma once\nconst float K = SCALE;",
            };
            Ok(Included { name: path.into(), text: text.into() })
        }
    }

    fn text(source: &str, defines: &[(String, String)]) -> String {
        let options = Options { defines: defines.to_vec(), ..Options::default() };
        let source = Source { name: "a.frag".into(), text: source.into(), stage: Stage::Fragment };
        let compilation = Compiler::new(options).with_includes(Two).compile(&[source]);
        let found: Vec<_> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
        let program = compilation.program.unwrap_or_else(|| panic!("{found:?}"));
        program.stages[0].texts.iter().map(|text| text.to_string()).collect()
    }

    #[test]
    fn a_text_without_includes_is_untouched() {
        let source = "// first\n#version 150\r\nout vec4 c; void main() { c = vec4(1.0); } // \u{e9}";
        assert_eq!(text(source, &[]), source);
    }

    #[test]
    fn what_was_included_stands_in_its_place_as_often_as_it_was_read() {
        let source = "#version 150\n#extension GL_ARB_shading_language_include : require\n#if 0\n#include \"no.glsl\"\n\
                      #endif\n#include \"outer.glsl\"\n#include \"outer.glsl\"\n#include \"once.glsl\"\n\
                      out vec4 c;\nvoid main() { c = vec4(K); }\n";
        let once = "#pragma once\nconst float K = SCALE;\n";
        let whole = format!(
            "#version 150\n#define SCALE 2.0\n\n#if 0\n#include \"no.glsl\"\n#endif\n#ifndef OUTER\n#define OUTER\n\
             {once}#endif\n#ifndef OUTER\n#define OUTER\n#include \"once.glsl\"\n#endif\n\nout vec4 c;\nvoid main() \
             {{ c = vec4(K); }}\n"
        );
        let found = text(source, &[("SCALE".into(), "2.0".into())]);
        assert_eq!(found, whole);
        for name in ["GL_GOOGLE_include_directive", "GL_MC_moj_import"] {
            assert!(super::allows_includes(&format!("#extension {name} : require\n")), "{name}");
        }
    }

    #[test]
    fn preludes_are_where_they_were_read() {
        let whole = |source: &str, prelude: &str, version: Option<&str>| {
            let preludes = vec![Prelude { name: "p".into(), text: prelude.into() }];
            let assumed_version = version.map(str::to_owned);
            let completion = Completion { assumed_version, preludes, ..Completion::default() };
            let options = Options { defines: vec![("SCALE".into(), "2.0".into())], completion, ..Options::default() };
            let source = Source { name: "a.frag".into(), text: source.into(), stage: Stage::Fragment };
            let compilation = Compiler::new(options).with_includes(Two).compile(&[source]);
            let found: Vec<_> = compilation.diagnostics.iter().map(|found| found.message.clone()).collect();
            let program = compilation.program.unwrap_or_else(|| panic!("{found:?}"));
            program.stages[0].texts.iter().map(|text| text.to_string()).collect::<String>()
        };
        let body = "out vec4 c; void main() { c = vec4(A); }\n";
        let define = "#define A SCALE";
        let expected = format!("#version 150\n#define SCALE 2.0\n{define}\n{body}");
        assert_eq!(whole(&format!("#version 150\n{body}"), define, None), expected);
        assert_eq!(whole(body, &format!("#version 150\n{define}"), None), expected);
        assert_eq!(whole(body, define, Some("150")), expected);
        let ignored = whole(&format!("#version 150\n{body}"), &format!("#version 110\n{define}"), None);
        assert_eq!(ignored, format!("#version 150\n#define SCALE 2.0\n            \n{define}\n{body}"));
    }
}
