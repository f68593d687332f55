//! A residual stage as GLSL 1.50.
//!
//! *In:* a stage, the texts of the original. *Out:* text with the names of the original, with the comments that were above
//! or next to what is left, and for each line the place in the original that it comes from.

use glisten_front::builtin::BuiltinFunction;
use glisten_front::builtin::functions::Row;
use glisten_front::hir::{ExprId, ExprKind, Notes, Shader, Stage, TypeId, Types, print_with};
use glisten_front::language::{Profile, Version};
use glisten_front::source::comments::{self, AroundBody};
use glisten_front::source::{SourceMap, Span};
use std::cell::RefCell;

/// The beginning of a line that says where the next one comes from. No source has it: control characters are replaced.
const MARK: &str = "//\u{1}";

/// Writes a stage. Lines that come from nowhere, such as closing braces, have an unknown span.
pub(crate) fn write(types: &Types, shader: &Shader, sources: Option<&SourceMap>) -> (String, Vec<Span>) {
    let mut shader = shader.clone();
    shader.version = language(&shader);
    let comments = Comments { sources, marks: RefCell::default() };
    let marked = print_with(types, &shader, Some(&comments));
    let marks = comments.marks.into_inner();
    let (mut text, mut lines) = (String::with_capacity(marked.len()), Vec::new());
    let mut next = Span::default();
    for line in marked.lines() {
        if let Some(number) = line.trim_start().strip_prefix(MARK) {
            next = number.parse().ok().and_then(|number: usize| marks.get(number).copied()).unwrap_or_default();
            continue;
        }
        text.push_str(line);
        text.push('\n');
        lines.push(std::mem::take(&mut next));
    }
    for line in sources.map_or_else(Vec::new, |sources| last_comments(&shader, sources)) {
        text.push_str(&line);
        text.push('\n');
        lines.push(Span::default());
    }
    (text, lines)
}

/// The comments at the end of the file that `main` is in.
fn last_comments(shader: &Shader, sources: &SourceMap) -> Vec<String> {
    let main = shader.main.map(|main| shader.function(main).span).filter(|span| span.is_known());
    let file = main.and_then(|span| sources.file_of(span));
    file.map_or_else(Vec::new, |file| comments::trailing(sources.file(file).text()))
}

/// The first version of OpenGL's language, from 1.50 on, that has all functions that the stage calls. Where no extension brings an overload to
/// earlier versions, which the text would then name, it is one that has the overload.
pub(crate) fn language(shader: &Shader) -> Version {
    let since = |function: BuiltinFunction, arguments: &[ExprId]| {
        let types: Vec<TypeId> = arguments.iter().map(|argument| shader.expr(*argument).ty).collect();
        let takes = |row: &&'static Row| row.signatures(shader.stage).any(|one| one.has_types(&types));
        let rows = || function.operation().prototypes().filter(|row| !row.deprecated);
        let first = |row: &Row| row.availability.since.desktop;
        let overload = rows().filter(takes).min_by_key(|row| first(row));
        let needed = overload.filter(|row| row.availability.extensions.name().is_none()).map(first);
        needed.or_else(|| rows().map(first).min()).unwrap_or(0)
    };
    let called = shader.exprs.iter().filter_map(|expr| match &expr.kind {
        ExprKind::BuiltinCall(function, arguments) => Some(since(*function, arguments)),
        _ => None,
    });
    let number = called.max().unwrap_or(0).max(150);
    Version { number, profile: Profile::Core, span: shader.version.span }
}

/// The extension of a stage's files.
pub(crate) fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// The comments of the original, and marks for what is printed below them.
struct Comments<'a> {
    sources: Option<&'a SourceMap>,
    marks: RefCell<Vec<Span>>,
}

impl Notes for Comments<'_> {
    fn above(&self, span: Span) -> Vec<String> {
        let mut marks = self.marks.borrow_mut();
        let line = |span: Span| {
            let place = self.sources?.location(span)?;
            Some((place.file, place.line))
        };
        // What is above a line is above the first of its declarations or statements.
        let is_told =
            marks.last().is_some_and(|last| *last != span && line(*last).is_some_and(|of| line(span) == Some(of)));
        let sources = self.sources.filter(|_| !is_told);
        let mut lines = sources.map_or_else(Vec::new, |sources| comments::above(sources, span));
        lines.push(format!("{MARK}{}", marks.len()));
        marks.push(span);
        lines
    }

    fn behind(&self, span: Span) -> Option<String> {
        comments::after(self.sources?, span)
    }

    fn around_body(&self, name: Span) -> Option<AroundBody> {
        comments::around_body(self.sources?, name)
    }
}
