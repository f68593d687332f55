//! Facts that the compiler knows and the text does not say (LSP 3.17, `textDocument/inlayHint`): locations, std140 offsets, bindings, and
//! implicit conversions (GLSL 1.50 §4.1.10), the operations of each function, and the configuration that is shown.

use super::shown;
use crate::analysis::Analysis;
use crate::describe;
use crate::state::State;
use crate::text::Text;
use crate::uri;
use glisten_front::analysis::{Denoted, NoteRole};
use glisten_front::hir::{ExprKind, Stage, Storage};
use glisten_front::index::View;
use glisten_front::link::Program;
use glisten_front::source::Span;
use lsp_types::{InlayHint, InlayHintKind, InlayHintLabel, InlayHintParams, InlayHintTooltip};
use std::ops::Range;
use std::path::Path;

/// The largest length of a function's head.
const MAX_HEAD: usize = 4096;

/// A hint at an offset.
struct Hint {
    offset: usize,
    label: String,
    tooltip: String,
}

/// Answers the request.
pub(super) fn hints(state: &mut State<'_>, params: &InlayHintParams) -> Option<Vec<InlayHint>> {
    let path = uri::path(&params.text_document.uri);
    let text = state.documents.get(&path)?.text.clone();
    let within = text.offset(params.range.start, state.encoding)..text.offset(params.range.end, state.encoding);
    let analyses = state.analyses_of(&path);
    let n_shown = if state.pieces(&path).is_some() { analyses.len() } else { 1 };
    let mut hints: Vec<Hint> = Vec::new();
    for analysis in analyses.iter().take(n_shown) {
        for view in analysis.views_of(&path) {
            let maker = Maker { analysis, view, path: &path, within: &within };
            if let Some(program) = &analysis.good {
                maker.places(program, &mut hints);
            }
            maker.conversions(&mut hints);
            maker.operations(&mut hints);
        }
    }
    hints.extend(configuration(state, &path, &text, &within));
    hints.sort_by(|a, b| (a.offset, &a.label).cmp(&(b.offset, &b.label)));
    hints.dedup_by(|a, b| a.offset == b.offset && a.label == b.label);
    let hint = |hint: Hint| InlayHint {
        position: text.position(hint.offset, state.encoding),
        label: InlayHintLabel::String(hint.label),
        kind: Some(InlayHintKind::TYPE),
        text_edits: None,
        tooltip: Some(InlayHintTooltip::String(hint.tooltip)),
        padding_left: Some(true),
        padding_right: Some(false),
        data: None,
    };
    Some(hints.into_iter().map(hint).collect())
}

/// The configuration of the document, at the end of its first line.
fn configuration(state: &mut State<'_>, path: &Path, text: &Text, within: &Range<usize>) -> Option<Hint> {
    let offset = text.line(0).len();
    if within.start > offset || state.pieces(path).is_some() {
        return None;
    }
    let mut told: Vec<String> = Vec::new();
    let asked = shown::asked(state, path).into_iter();
    let chosen = asked.filter_map(|choice| Some(format!("{} = {}", choice.name, choice.chosen?)));
    let chosen: Vec<String> = chosen.collect();
    if !chosen.is_empty() {
        told.push(format!("with {}", chosen.join(", ")));
    }
    if let Some(shown) = state.shown_in(path) {
        let name = shown.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        told.push(format!("as {name} includes it"));
    }
    let label = told.join("; ");
    let tooltip = "the configuration that is shown".to_owned();
    (!label.is_empty()).then_some(Hint { offset, label, tooltip })
}

struct Maker<'a> {
    analysis: &'a Analysis,
    view: &'a View,
    path: &'a Path,
    within: &'a Range<usize>,
}

impl Maker<'_> {
    /// Where a span ends in the file, if it does in the range.
    fn end_of(&self, span: Span) -> Option<usize> {
        let place = self.analysis.named_place(span)?;
        let is_here = self.path.as_os_str() == place.file.as_str() && !span.expansion.is_some();
        (is_here && self.within.start <= place.end && place.end <= self.within.end).then_some(place.end)
    }

    /// Locations, offsets and bindings at declarations.
    fn places(&self, program: &Program, hints: &mut Vec<Hint>) {
        for note in self.view.notes.names.iter().filter(|note| note.role == NoteRole::Declares) {
            let Some(offset) = self.end_of(note.span) else { continue };
            let label = match note.denoted {
                Denoted::Global(id) => self.view.shader.globals.get(id.index()).and_then(|global| {
                    let is_told = global.location.is_some() || global.binding.is_some();
                    let facts = describe::of_global(program, self.view, global);
                    let first = facts.first().filter(|_| !is_told)?.clone();
                    let short = short(&first, global.storage, self.view.shader.stage);
                    Some((short, facts.join("\n")))
                }),
                Denoted::Member(id, _) => {
                    let structure = self.analysis.compiled.inspection.types.structure(id);
                    let name = self.analysis.sources().snippet(note.span);
                    let found = describe::member_offset(program, &structure.name, name).filter(|_| structure.is_block);
                    found.map(|(_, n_bytes)| {
                        let facts = describe::of_member(program, &structure.name, name);
                        (format!("@{n_bytes}"), facts.join("\n"))
                    })
                }
                _ => None,
            };
            if let Some((label, tooltip)) = label {
                hints.push(Hint { offset, label, tooltip });
            }
        }
    }

    /// The end of a function's head, whose name ends at an offset.
    fn end_of_head(&self, name: usize) -> Option<usize> {
        let file = self.analysis.files(self.path).next()?;
        let rest = self.analysis.sources().file(file).text().get(name..)?;
        let mut depth = 0usize;
        for (at, letter) in rest.char_indices().take(MAX_HEAD) {
            match letter {
                '(' => depth += 1,
                ')' if depth == 1 => return Some(name + at + 1),
                ')' => depth = depth.checked_sub(1)?,
                '{' | ';' => return None,
                _ => {}
            }
        }
        None
    }

    /// The operations of each function.
    fn operations(&self, hints: &mut Vec<Hint>) {
        let types = &self.analysis.compiled.inspection.types;
        let costs = glisten_library::costs(types, &self.view.shader);
        for (function, cost) in self.view.shader.functions.iter().zip(costs) {
            let Some(name) = self.end_of(function.span).filter(|_| function.body.is_some()) else { continue };
            let operations = cost.arithmetic.saturating_add(cost.special);
            let Some(offset) = self.end_of_head(name).filter(|_| cost.weight() > 0) else { continue };
            let mut label = format!("{operations} operation{}", if operations == 1 { "" } else { "s" });
            if cost.texture > 0 {
                label.push_str(&format!(", {} lookup{}", cost.texture, if cost.texture == 1 { "" } else { "s" }));
            }
            hints.push(Hint { offset, label, tooltip: format!("{cost}, on the path that takes most") });
        }
    }

    /// Conversions that no constructor writes.
    fn conversions(&self, hints: &mut Vec<Hint>) {
        let (shader, types) = (&self.view.shader, &self.analysis.compiled.inspection.types);
        for expr in &shader.exprs {
            let ExprKind::Convert(inner) = expr.kind else { continue };
            let Some(inner) = shader.exprs.get(inner.index()) else { continue };
            // A constructor's span has its name and its brackets, too.
            if inner.span != expr.span {
                continue;
            }
            if let Some(offset) = self.end_of(expr.span) {
                let (from, to) = (types.name(inner.ty), types.name(expr.ty));
                let tooltip = format!("converted from `{from}` to `{to}` (GLSL 1.50 §4.1.10)");
                hints.push(Hint { offset, label: format!("→ {to}"), tooltip });
            }
        }
    }
}

/// The first fact in a word or two.
fn short(fact: &str, storage: Storage, stage: Stage) -> String {
    let number = fact.split(|letter: char| !letter.is_ascii_digit()).find(|part| !part.is_empty()).unwrap_or("");
    match (storage, stage) {
        (Storage::Uniform, _) if fact.starts_with("offset") => format!("@{number}"),
        (Storage::Uniform, _) => fact.to_owned(),
        (Storage::Out, Stage::Fragment) => format!("color {number}"),
        _ => format!("location {number}"),
    }
}
