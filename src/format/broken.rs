//! [`broken`]: the places of a source that do not parse.

use glisten_front::Stage;
use glisten_front::compiler::{Compiler, Options, Source};
use std::ops::Range;

/// The codes of the grammar.
const SYNTAX: &str = "E02";

/// The places that do not parse, of a source that says its version. Without its includes, or without a version, a text cannot be
/// judged.
pub fn broken(text: &str, stage: Stage) -> Vec<Range<usize>> {
    let includes = ["#include", "import", "include"];
    let directives = || text.lines().filter(|line| line.trim_start().starts_with('#'));
    let is_whole = directives().any(|line| line.contains("version"))
        && !directives().any(|line| includes.iter().any(|word| line.contains(word)));
    if !is_whole {
        return Vec::new();
    }
    let source = Source { name: "source".into(), text: text.into(), stage };
    let compilation = Compiler::new(Options::default()).compile(&[source]);
    let base = compilation.sources.files().next().map_or(0, |(_, file)| file.base() as usize);
    let in_text = |range: Range<usize>| {
        (range.start >= base && range.end <= base + text.len()).then(|| range.start - base..range.end - base)
    };
    let errors = compilation.diagnostics.iter().filter(|one| one.is_error() && one.code.id.starts_with(SYNTAX));
    errors.filter_map(|one| in_text(one.primary.span.start as usize..one.primary.span.end as usize)).collect()
}
