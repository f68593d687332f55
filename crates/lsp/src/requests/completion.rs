//! Names that fit at a place (LSP 3.17, `textDocument/completion`): members and components after a dot, names in sight, macros,
//! built-in names of this version and stage, keywords, what the other stage passes, and in directives their words and files.
//!
//! *In:* a place in a text that is being typed. *Out:* a list; the editor chooses by what is typed. *Holds:* the text is cut at the
//! place and read up to there, with a name in it about which the analysis tells what is in sight.

use super::{directives, scene};
use crate::analysis::Analysis;
use crate::builtins::{self, ListedKind};
use crate::cut::{cut, is_in_comment, mended, open_brackets};
use crate::describe;
use crate::project::Compiled;
use crate::state::{Point, State};
use glisten_front::analysis::Denoted;
use glisten_front::diagnostic::{Severity, codes};
use glisten_front::hir::{Stage, Storage, Type, TypeId, Types};
use glisten_front::index::View;
use glisten_front::language::Feature;
use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionList, CompletionParams, CompletionResponse, CompletionTextEdit,
    TextEdit,
};
use std::collections::BTreeSet;
use std::ops::Range;
use std::path::PathBuf;

/// The name that is at the place.
pub(super) const PROBE: &str = "glisten_probe";
/// The names of components, in sets (GLSL 1.50 §5.5).
const COMPONENTS: [&str; 3] = ["xyzw", "rgba", "stpq"];
/// The words in a `layout(..)` (GLSL 4.60 §4.4).
const LAYOUTS: &[&str] = &[
    "location",
    "component",
    "index",
    "binding",
    "offset",
    "align",
    "std140",
    "shared",
    "packed",
    "row_major",
    "column_major",
    "points",
    "lines",
    "lines_adjacency",
    "triangles",
    "triangles_adjacency",
    "line_strip",
    "triangle_strip",
    "max_vertices",
    "invocations",
    "origin_upper_left",
    "pixel_center_integer",
    "depth_any",
    "depth_greater",
    "depth_less",
    "depth_unchanged",
];

/// The items of a list.
pub(super) struct Items<'t> {
    point: &'t Point,
    range: lsp_types::Range,
    seen: BTreeSet<String>,
    list: Vec<CompletionItem>,
}

impl<'t> Items<'t> {
    fn new(state: &State<'_>, point: &'t Point, word: Range<usize>) -> Self {
        let range = point.text.range(word, state.encoding);
        Self { point, range, seen: BTreeSet::new(), list: Vec::new() }
    }

    /// Adds a name, unless it is there.
    pub(super) fn add(&mut self, name: &str, kind: CompletionItemKind, detail: &str, order: u8) {
        self.add_text(name, name, kind, detail, order);
    }

    fn add_text(&mut self, label: &str, text: &str, kind: CompletionItemKind, detail: &str, order: u8) {
        if label.is_empty() || !self.seen.insert(label.to_owned()) {
            return;
        }
        self.list.push(CompletionItem {
            label: label.to_owned(),
            kind: Some(kind),
            detail: (!detail.is_empty()).then(|| detail.to_owned()),
            sort_text: Some(format!("{order}{label}")),
            text_edit: Some(CompletionTextEdit::Edit(TextEdit { range: self.range, new_text: text.to_owned() })),
            ..CompletionItem::default()
        });
    }
}

/// Answers the request.
pub(super) fn completion(state: &mut State<'_>, params: &CompletionParams) -> Option<CompletionResponse> {
    let point = state.point(&params.text_document_position)?;
    let text = &*point.text.text;
    if is_in_comment(text, point.offset) {
        return allowed(state, &point);
    }
    let before = text.get(..point.offset)?;
    let start = before.trim_end_matches(|letter: char| letter.is_ascii_alphanumeric() || letter == '_').len();
    let mut items = Items::new(state, &point, start..point.offset);
    let line = before.get(point.text.start_of(point.text.line_of(point.offset))..).unwrap_or("");
    if line.trim_start().starts_with('#') {
        let items = directives::complete(state, &point, line)?;
        return Some(CompletionResponse::List(CompletionList { is_incomplete: false, items }));
    }
    let rest = before.get(..start)?.trim_end();
    if rest.ends_with('.') {
        if ends_with_number(rest) {
            return None;
        }
        members(state, &point, start, &mut items);
    } else if before.get(start..).is_some_and(|word| word.starts_with(|first: char| first.is_ascii_digit())) {
        return None;
    } else if is_layout(rest) {
        LAYOUTS.iter().for_each(|word| items.add(word, CompletionItemKind::PROPERTY, "", 0));
    } else {
        names(state, &point, start, &mut items);
    }
    Some(CompletionResponse::List(CompletionList { is_incomplete: false, items: items.list }))
}

/// Whether a text ends with a number and a dot.
fn ends_with_number(text: &str) -> bool {
    let word = text.trim_end_matches('.');
    let start = word.trim_end_matches(|letter: char| letter.is_ascii_alphanumeric() || letter == '_').len();
    word.get(start..).is_some_and(|word| word.starts_with(|first: char| first.is_ascii_digit()))
}

/// Whether the innermost open bracket is that of a `layout`.
fn is_layout(text: &str) -> bool {
    let open = open_brackets(text).pop();
    open.is_some_and(|(at, sign)| sign == '(' && text.get(..at).is_some_and(|text| text.trim_end().ends_with("layout")))
}

/// Reads the text up to a place, with the probe there.
fn probed(state: &mut State<'_>, point: &Point, start: usize) -> Option<Compiled> {
    let key = &point.analyses.first()?.key;
    let text = cut(point.text.text.get(..start)?, start, PROBE);
    let compiled = state.project.probe(key, &point.path, text.into(), Some(PROBE))?;
    if compiled.inspection.views().any(|(_, view)| view.notes.probe.is_some()) {
        return Some(compiled);
    }
    // A statement before may lack its end.
    let line = point.text.start_of(point.text.line_of(start));
    let (before, own) = (point.text.text.get(..line)?, point.text.text.get(line..start)?);
    let patched = format!("{};\n{own}", before.trim_end());
    let text = cut(&patched, patched.len(), PROBE);
    let mut texts = vec![text];
    for text in mended(&point.text.text, start) {
        texts.push(cut(text.get(..start).unwrap_or(""), start, PROBE));
    }
    for text in texts {
        let again = state.project.probe(key, &point.path, text.into(), Some(PROBE));
        let is_hit = |again: &Compiled| again.inspection.views().any(|(_, view)| view.notes.probe.is_some());
        if let Some(again) = again.filter(is_hit) {
            return Some(again);
        }
    }
    Some(compiled)
}

fn members(state: &mut State<'_>, point: &Point, start: usize, items: &mut Items<'_>) {
    let Some(compiled) = probed(state, point, start) else { return };
    let types = &compiled.inspection.types;
    let mut probes =
        compiled.inspection.views().filter_map(|(_, view)| Some((view, view.notes.probe.as_ref()?.member_of?)));
    let Some((view, ty)) = probes.next() else { return };
    match types.get(ty) {
        Type::Struct(id) => {
            for member in &types.structure(id).members {
                items.add(&member.name, CompletionItemKind::FIELD, &types.name(member.ty), 0);
            }
        }
        Type::Vector(_, size) => components(types, ty, usize::from(size), items),
        // Components of a scalar are not in GLSL 1.50 (§5.5).
        Type::Scalar(_) if view.ast.version.has_with(Feature::ScalarSwizzles, builtins::extensions(view)) => {
            components(types, ty, 1, items);
        }
        Type::Array(..) => items.add_text("length", "length()", CompletionItemKind::METHOD, "int length()", 0),
        _ => {}
    }
}

/// The components of a vector, one by one and from the first on.
fn components(types: &Types, ty: TypeId, size: usize, items: &mut Items<'_>) {
    let result = |count: usize| {
        let count = u8::try_from(count).unwrap_or(1);
        types.scalar_of(ty).map_or(String::new(), |scalar| types.name(TypeId::vector(scalar, count)))
    };
    for (order, set) in COMPONENTS.iter().enumerate() {
        let Some(letters) = set.get(..size) else { continue };
        for letter in letters.split("").filter(|letter| !letter.is_empty()) {
            items.add(letter, CompletionItemKind::FIELD, &result(1), order as u8);
        }
        for count in 2..=size {
            items.add(letters.get(..count).unwrap_or(""), CompletionItemKind::FIELD, &result(count), order as u8 + 3);
        }
    }
}

fn names(state: &mut State<'_>, point: &Point, start: usize, items: &mut Items<'_>) {
    let before = point.text.text.get(..start).unwrap_or("");
    let is_global = open_brackets(before).is_empty();
    if let Some(compiled) = probed(state, point, start) {
        let analysis =
            Analysis::new(point.analyses.first().map(|first| first.key.clone()).unwrap_or_else(no_key), compiled, None);
        for (number, view) in analysis.compiled.inspection.views() {
            let is_hit = view.notes.probe.is_some();
            let is_only = analysis.compiled.inspection.views().all(|(_, other)| other.notes.probe.is_none());
            if is_hit || is_only {
                in_sight(&analysis, number, view, items);
                of_language(view, items);
            }
        }
    }
    if is_global {
        let line = before.get(items.point.text.start_of(items.point.text.line_of(start))..).unwrap_or("");
        of_other_stages(state, point, line, items);
    }
}

fn no_key() -> crate::project::ProgramKey {
    crate::project::ProgramKey { name: String::new(), files: Vec::new() }
}

/// The names in sight, the innermost first.
fn in_sight(analysis: &Analysis, number: usize, view: &View, items: &mut Items<'_>) {
    let names = view.notes.probe.as_ref().map_or(&view.notes.at_end, |probe| &probe.names);
    for (symbol, denoted) in names.iter().rev() {
        let name = view.ast.names.spelling(*symbol);
        let (kind, order) = match denoted {
            Denoted::Local(..) => (CompletionItemKind::VARIABLE, 0),
            Denoted::Global(id) => match view.shader.globals.get(id.index()).map(|global| global.storage) {
                Some(Storage::Const) => (CompletionItemKind::CONSTANT, 1),
                _ => (CompletionItemKind::VARIABLE, 1),
            },
            Denoted::Member(..) => (CompletionItemKind::FIELD, 1),
            Denoted::Function(_) => (CompletionItemKind::FUNCTION, 1),
            Denoted::Struct(_) | Denoted::Block(_) => (CompletionItemKind::STRUCT, 1),
            Denoted::Builtin | Denoted::Components(_) | Denoted::Length(_) => continue,
            Denoted::Broken(_) => (CompletionItemKind::VARIABLE, 1),
        };
        let detail = describe::declaration(analysis, number, *denoted).unwrap_or_default();
        let detail = detail.lines().next().unwrap_or("").trim_end_matches(" {").to_owned();
        if !name.starts_with("gl_") && name != PROBE {
            items.add(name, kind, &detail, order);
        }
    }
    let directives = &view.ast.directives;
    for definition in directives.definitions.iter().filter(|definition| directives.defined.contains(&definition.span)) {
        let params = definition.params.as_ref().map_or(String::new(), |params| format!("({})", params.join(", ")));
        let detail = format!("#define {}{params} {}", definition.name, analysis.sources().snippet(definition.body));
        items.add(&definition.name, CompletionItemKind::CONSTANT, &detail, 2);
    }
}

/// The names of the language.
fn of_language(view: &View, items: &mut Items<'_>) {
    for name in builtins::list(view.shader.version, builtins::extensions(view), view.shader.stage) {
        let (kind, order) = match name.kind {
            ListedKind::Function => (CompletionItemKind::FUNCTION, 3),
            ListedKind::Variable => (CompletionItemKind::VARIABLE, 3),
            ListedKind::Constant => (CompletionItemKind::CONSTANT, 5),
            ListedKind::Type => (CompletionItemKind::KEYWORD, 4),
            ListedKind::Keyword => (CompletionItemKind::KEYWORD, 4),
        };
        items.add(name.name, kind, &name.detail, order);
    }
}

/// Declarations of what other stages declare and this one does not: what passes between them, and uniforms.
fn of_other_stages(state: &mut State<'_>, point: &Point, line: &str, items: &mut Items<'_>) {
    of_scenes(state, point, line, items);
    for analysis in &point.analyses {
        let inspection = &analysis.compiled.inspection;
        let own: Vec<&View> = analysis.views_of(&point.path);
        let Some(first) = own.first() else { continue };
        let is_declared = |name: &str| first.shader.globals.iter().any(|global| global.name == name);
        for (_, view) in inspection.views().filter(|(_, view)| view.shader.stage != first.shader.stage) {
            for global in view.shader.globals.iter().filter(|global| global.builtin.is_none() && !global.is_fixed()) {
                let Some(word) = wanted(global.storage, view.shader.stage, first.shader.stage) else { continue };
                if global.block.is_some() || global.span.start == 0 || is_declared(&global.name) {
                    continue;
                }
                let declaration = format!("{} {}", inspection.types.name(global.ty), global.name);
                let interpolation = if global.interpolation_written { global.interpolation.name() } else { "" };
                let whole = format!("{interpolation} {word} {declaration};");
                let (text, detail) = (whole.trim().to_owned(), format!("{} stage", view.shader.stage.name()));
                // What is typed already is not typed again.
                let typed = line.trim();
                if typed.is_empty() {
                    items.add_text(&text, &text, CompletionItemKind::SNIPPET, &detail, 0);
                } else if typed.split_whitespace().next_back() == Some(word) {
                    items.add_text(&declaration, &format!("{declaration};"), CompletionItemKind::SNIPPET, &detail, 0);
                }
            }
        }
    }
}

/// Declarations of what the scenes that draw the program give to it and it does not declare.
fn of_scenes(state: &mut State<'_>, point: &Point, line: &str, items: &mut Items<'_>) {
    let files: Vec<PathBuf> = point.analyses.iter().flat_map(|analysis| analysis.key.files.clone()).collect();
    let folders = scene::folders(state, &files);
    let is_declared = |name: &str| {
        let views = point.analyses.iter().flat_map(|analysis| analysis.compiled.inspection.views());
        views.flat_map(|(_, view)| &view.shader.globals).any(|global| global.name == name)
    };
    let is_vertex = point
        .analyses
        .iter()
        .any(|analysis| analysis.views_of(&point.path).iter().any(|view| view.shader.stage == Stage::Vertex));
    for (path, text) in state.project.scenes(&folders, false) {
        let detail = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        scene::each_draw(&path, &text, &files, |draw| {
            for (word, ty, name) in scene::declarations(draw) {
                if is_declared(&name) || word == "in" && !is_vertex {
                    continue;
                }
                let (typed, declaration) = (line.trim(), format!("{ty} {name}"));
                if typed.is_empty() {
                    let text = format!("{word} {declaration};");
                    items.add_text(&text, &text, CompletionItemKind::SNIPPET, &detail, 1);
                } else if typed.split_whitespace().next_back() == Some(word) {
                    items.add_text(&declaration, &format!("{declaration};"), CompletionItemKind::SNIPPET, &detail, 1);
                }
            }
        });
    }
}

/// The codes and groups in a comment that allows findings.
fn allowed(state: &State<'_>, point: &Point) -> Option<CompletionResponse> {
    let before = point.text.text.get(..point.offset)?;
    let line = before.rsplit('\n').next()?;
    let list = line.get(line.rfind("glisten: allow(")? + "glisten: allow(".len()..)?;
    if list.contains(')') {
        return None;
    }
    let is_part = |letter: char| letter.is_ascii_alphanumeric() || letter == '-';
    let start = before.trim_end_matches(is_part).len();
    let mut items = Items::new(state, point, start..point.offset);
    for code in codes::all().filter(|code| code.severity != Severity::Error) {
        items.add(code.name, CompletionItemKind::ENUM_MEMBER, code.id, 0);
        items.add(code.id, CompletionItemKind::ENUM_MEMBER, code.name, 1);
    }
    Some(CompletionResponse::List(CompletionList { is_incomplete: false, items: items.list }))
}

/// The word with which a stage declares what another one has.
fn wanted(storage: Storage, of: Stage, here: Stage) -> Option<&'static str> {
    match storage {
        Storage::Uniform => Some("uniform"),
        Storage::Out if of < here => Some("in"),
        Storage::In if here < of => Some("out"),
        _ => None,
    }
}
