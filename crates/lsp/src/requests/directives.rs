//! Words that fit in a directive (GLSL 1.50 §3.3): its name, files, extensions, versions, macros.

use crate::state::{Point, State};
use glisten_front::language::Extensions;
use lsp_types::{CompletionItem, CompletionItemKind, CompletionTextEdit, TextEdit};

/// The directives.
const NAMES: &[&str] = &[
    "define",
    "undef",
    "if",
    "ifdef",
    "ifndef",
    "elif",
    "else",
    "endif",
    "error",
    "pragma",
    "extension",
    "version",
    "line",
    "include",
];
/// The versions, as a `#version` line has them.
const VERSIONS: &[&str] = &[
    "110",
    "120",
    "130",
    "140",
    "150 core",
    "150 compatibility",
    "330 core",
    "330 compatibility",
    "400 core",
    "410 core",
    "420 core",
    "430 core",
    "440 core",
    "450 core",
    "460 core",
    "100",
    "300 es",
    "310 es",
    "320 es",
];
/// The words of an `#extension` line after the colon.
const BEHAVIORS: &[&str] = &["require", "enable", "warn", "disable"];
/// Pragmas.
const PRAGMAS: &[&str] = &[
    "STDGL invariant(all)",
    "optimize(on)",
    "optimize(off)",
    "debug(on)",
    "debug(off)",
    "once",
    "unroll_loop_start",
    "unroll_loop_end",
];

/// The items for a line that begins with `#`, up to the place.
pub(super) fn complete(state: &mut State<'_>, point: &Point, line: &str) -> Option<Vec<CompletionItem>> {
    let directive = line.trim_start().strip_prefix('#')?;
    let inner = directive.trim_start();
    let (name, rest) = inner
        .split_at(inner.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(inner.len()));
    if rest.is_empty() {
        return Some(list(
            state,
            point,
            name.len(),
            NAMES.iter().map(|name| (*name).to_owned()),
            CompletionItemKind::KEYWORD,
        ));
    }
    if let Some(items) = files(state, point, rest) {
        return Some(items);
    }
    let typed = rest.trim_start();
    let word = typed.rsplit(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').next().unwrap_or("");
    let keyword = CompletionItemKind::KEYWORD;
    let words = |words: &'static [&'static str]| words.iter().map(|word| (*word).to_owned());
    Some(match name {
        "version" => list(state, point, typed.len(), words(VERSIONS), keyword),
        "pragma" => list(state, point, typed.len(), words(PRAGMAS), keyword),
        "extension" if typed.contains(':') => list(state, point, word.len(), words(BEHAVIORS), keyword),
        "extension" => {
            let names = Extensions::implemented().iter().filter_map(|extension| extension.name());
            list(state, point, word.len(), names.map(str::to_owned), CompletionItemKind::MODULE)
        }
        "if" | "ifdef" | "ifndef" | "elif" | "undef" | "define" => {
            let mut names = macros(point);
            if name == "if" || name == "elif" {
                names.push("defined".to_owned());
            }
            list(state, point, word.len(), names.into_iter(), CompletionItemKind::CONSTANT)
        }
        _ => Vec::new(),
    })
}

/// The files that an include could name, if the line has an open quote or angle bracket.
fn files(state: &mut State<'_>, point: &Point, rest: &str) -> Option<Vec<CompletionItem>> {
    let open = rest.find(['"', '<'])?;
    let angled = rest.get(open..)?.starts_with('<');
    let written = rest.get(open + 1..)?;
    if written.contains(['"', '>']) {
        return Some(Vec::new());
    }
    let last = written.rsplit('/').next().unwrap_or("");
    let names = state.project.include_names(&point.path, written, angled);
    let mut items = list(state, point, last.len(), names.into_iter(), CompletionItemKind::FILE);
    for item in items.iter_mut().filter(|item| item.label.ends_with('/')) {
        item.kind = Some(CompletionItemKind::FOLDER);
    }
    Some(items)
}

/// The macros that the texts define, and those that conditions ask for.
fn macros(point: &Point) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for analysis in &point.analyses {
        for view in analysis.views_of(&point.path) {
            let directives = &view.ast.directives;
            names.extend(directives.definitions.iter().map(|definition| definition.name.to_string()));
            names.extend(directives.mentions.iter().map(|mention| analysis.sources().snippet(mention.span).to_owned()));
        }
    }
    names.sort();
    names.dedup();
    names
}

fn list(
    state: &State<'_>,
    point: &Point,
    typed: usize,
    names: impl Iterator<Item = String>,
    kind: CompletionItemKind,
) -> Vec<CompletionItem> {
    let range = point.text.range(point.offset.saturating_sub(typed)..point.offset, state.encoding);
    let item = |name: String| CompletionItem {
        label: name.clone(),
        kind: Some(kind),
        text_edit: Some(CompletionTextEdit::Edit(TextEdit { range, new_text: name })),
        ..CompletionItem::default()
    };
    names.map(item).collect()
}
