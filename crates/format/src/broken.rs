//! [`formatted`]: a source whose errors are found and kept.

use super::{Formatted, MOST_PASSES, Options, format, with_line_feeds};
use glisten_front::Stage;
use glisten_front::compiler::{self, Compiler, Source};
use glisten_front::diagnostic::Area;
use std::ops::Range;

/// A text in the style of the options. Formatting the result changes nothing: which places of a wrong text do not parse depends on its
/// lines, so it is formatted until it stays the same, and kept if it never does.
pub fn formatted(text: &str, stage: Stage, options: &Options) -> Formatted {
    let pass = |text: &str| {
        let broken = broken(text, stage);
        (format(text, &broken, options), !broken.is_empty())
    };
    let (mut done, is_broken) = pass(text);
    if !is_broken {
        return done;
    }
    let lines = done.lines;
    for _ in 0..MOST_PASSES {
        let (again, _) = pass(&done.text);
        if again.text == done.text {
            return Formatted { lines, ..again };
        }
        done = again;
    }
    Formatted { text: text.to_owned(), lines, kept: lines }
}

/// The places that do not parse, of a source that says its version. Without its includes, or without a version, a text cannot be
/// judged.
fn broken(text: &str, stage: Stage) -> Vec<Range<usize>> {
    let text = &with_line_feeds(text);
    let includes = ["#include", "import", "include"];
    let directives = || text.lines().filter(|line| line.trim_start().starts_with('#'));
    let is_whole = directives().any(|line| line.contains("version"))
        && !directives().any(|line| includes.iter().any(|word| line.contains(word)));
    if !is_whole {
        return Vec::new();
    }
    let source = Source { name: "source".into(), text: text.as_str().into(), stage };
    let compilation = Compiler::new(compiler::Options::default()).compile(&[source]);
    let base = compilation.sources.files().next().map_or(0, |(_, file)| file.base() as usize);
    let in_text = |range: Range<usize>| {
        (range.start >= base && range.end <= base + text.len()).then(|| range.start - base..range.end - base)
    };
    let errors = compilation.diagnostics.iter().filter(|one| one.is_error() && one.code.area() == Area::Syntax);
    errors.filter_map(|one| in_text(one.primary.span.start as usize..one.primary.span.end as usize)).collect()
}
