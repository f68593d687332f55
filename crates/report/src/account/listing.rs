//! Both texts of a stage, line by line next to each other: declarations first, then function by function.
//!
//! *In:* a stage of the original, the text of what is left of it with the places that its lines come from, and the account.
//! *Out:* [`Section`]s of [`Row`]s. *Holds:* the lines of the residual are all there, in their order within a section; a line
//! of the original is next to the first line that comes from it, as far as the orders of both agree.

use glisten_front::hir::{Function, Shader, Stage, StructId, Types};
use glisten_front::link::Program;
use glisten_front::source::{FileId, SourceMap, Span};
use glisten_page::highlight::Comments;
use glisten_specialize::LeftOut;
use glisten_verify::specialize::SpecializedDraw;
use std::collections::{BTreeMap, BTreeSet};

/// A part of a listing.
#[derive(Debug)]
pub(super) struct Section {
    /// `declarations`, or the name of a function.
    pub(super) title: String,
    /// The file and line of the original.
    pub(super) place: String,
    /// Why nothing of it is left.
    pub(super) gone: Option<String>,
    pub(super) rows: Vec<Row>,
}

/// A line of the original, a line of the residual, or both.
#[derive(Debug, Default)]
pub(super) struct Row {
    /// `same`, `changed`, `gone`, `plain` or `new`.
    pub(super) class: &'static str,
    /// The number of the line in the original's file.
    pub(super) number: Option<u32>,
    pub(super) left: Option<String>,
    /// Why the line is gone; the first line of several with one reason has it for the keyboard, too.
    pub(super) because: Option<String>,
    pub(super) first: bool,
    pub(super) right: Option<String>,
}

/// The title of the section of structs and globals.
const DECLARATIONS: &str = "declarations";

/// A line of the original.
type Place = (FileId, u32);

/// A line of the residual.
struct Line<'a> {
    text: &'a str,
    from: Option<Place>,
}

/// The listing of a stage.
pub(super) fn listing(program: &Program, stage: Stage, draw: &SpecializedDraw, sources: &SourceMap) -> Vec<Section> {
    let Some(shader) = program.stage(stage) else { return Vec::new() };
    let listing = Listing { types: &program.types, shader, sources, left_out: &draw.left_out };
    let places = draw.places(stage);
    let text = draw.text(stage);
    let lines: Vec<Line<'_>> = text
        .lines()
        .enumerate()
        .map(|(index, text)| Line { text, from: listing.place(places.get(index).copied().unwrap_or_default()) })
        .collect();
    listing.sections(&lines)
}

struct Listing<'a> {
    types: &'a Types,
    shader: &'a Shader,
    sources: &'a SourceMap,
    left_out: &'a [LeftOut],
}

/// The lines of the residual by the function that they are in.
struct Part<'a> {
    /// Where the function's name was in the original.
    header: Option<Place>,
    title: String,
    lines: Vec<&'a Line<'a>>,
}

impl Listing<'_> {
    fn place(&self, span: Span) -> Option<Place> {
        let location = self.sources.location(self.sources.call_site(span)).filter(|_| span.is_known())?;
        Some((location.file, location.line))
    }

    fn sections(&self, lines: &[Line<'_>]) -> Vec<Section> {
        let (declarations, functions) = parts(lines);
        let mut declared = self.declared();
        let found = self.found_by_text(&declarations, &declared);
        declared.extend(found.iter().filter_map(|line| line.from));
        declared.sort_unstable();
        declared.dedup();
        let mut sections = vec![self.section(DECLARATIONS, &declared, &in_order(found.iter().collect()))];
        let mut shown: BTreeSet<Place> = BTreeSet::new();
        for part in &functions {
            let function = part.header.and_then(|header| self.function(header));
            let left = function.map(|function| self.lines_of(function)).unwrap_or_default();
            shown.extend(part.header);
            sections.push(self.section(&part.title, &left, &part.lines));
        }
        for function in self.shader.functions.iter().filter(|function| function.body.is_some()) {
            let Some(place) = self.place(function.span) else { continue };
            if shown.insert(place) {
                let mut section = self.section(&function.name, &self.lines_of(function), &[]);
                let reason = self.reason(place, &function.name);
                section.gone = Some(reason.unwrap_or_else(|| "no call of it is left".into()));
                sections.push(section);
            }
        }
        sections.retain(|section| !section.rows.is_empty());
        sections
    }

    fn function(&self, header: Place) -> Option<&Function> {
        self.shader.functions.iter().find(|function| self.place(function.span) == Some(header))
    }

    /// The lines that declare structs and globals, in the order of the texts.
    fn declared(&self) -> Vec<Place> {
        let mut places: BTreeSet<Place> = BTreeSet::new();
        let mut structs: BTreeSet<StructId> = BTreeSet::new();
        for global in self.shader.globals.iter().filter(|global| global.builtin.is_none()) {
            places.extend(self.place(global.span));
            self.types.for_each_struct(global.ty, &mut |id| structs.insert(id));
        }
        for local in self.shader.functions.iter().flat_map(|function| &function.locals) {
            self.types.for_each_struct(local.ty, &mut |id| structs.insert(id));
        }
        for id in structs {
            let declared = self.types.structure(id);
            let lines = declared.members.iter().map(|member| member.span).chain([declared.span]);
            let lines: Vec<Place> = lines.filter_map(|span| self.place(span)).collect();
            places.extend(&lines);
            // The brace that closes it.
            let last = lines.iter().max().map(|(file, line)| (*file, line + 1));
            places.extend(last.filter(|place| self.text(*place).trim_start().starts_with('}')));
        }
        places.into_iter().collect()
    }

    /// The declarations of a residual, in which comments and directives have the places of the same ones in the original, where
    /// it has them outside of functions: they are kept, and not new. `#version` is that of the original, whatever its number.
    fn found_by_text<'a>(&self, lines: &[&Line<'a>], declared: &[Place]) -> Vec<Line<'a>> {
        let main = self
            .shader
            .functions
            .iter()
            .find_map(|function| self.place(function.span).filter(|_| function.name == "main"));
        let files: BTreeSet<FileId> = declared.iter().chain(&main).map(|(file, _)| *file).collect();
        let inside: BTreeSet<Place> = self
            .shader
            .functions
            .iter()
            .filter(|function| function.body.is_some())
            .flat_map(|function| self.lines_of(function))
            .collect();
        let all = files.iter().flat_map(|file| (1..=self.sources.file(*file).line_count()).map(|line| (*file, line)));
        let mut free: Vec<Place> = all.filter(|place| !inside.contains(place)).collect();
        lines
            .iter()
            .map(|line| {
                let is_searched = line.from.is_none() && (is_comment(line.text) || line.text.starts_with('#'));
                let is_it = |place: &Place| same_heading(self.text(*place), line.text);
                let at = free.iter().position(is_it).filter(|_| is_searched);
                Line { text: line.text, from: at.map(|at| free.remove(at)).or(line.from) }
            })
            .collect()
    }

    /// The lines of a function, with the comment above it.
    fn lines_of(&self, function: &Function) -> Vec<Place> {
        let Some((file, header)) = self.place(function.span) else { return Vec::new() };
        let mut first = header;
        while first > 1 && is_comment(self.text((file, first - 1))) {
            first -= 1;
        }
        let mut last = header;
        let body = function.body.as_deref().unwrap_or(&[]);
        for stmt in body {
            let location = self.sources.location(self.sources.call_site(stmt.span)).filter(|_| stmt.span.is_known());
            last = location.filter(|one| one.file == file).map_or(last, |one| last.max(one.end_line));
        }
        let closes = |line: u32| self.text((file, line)).trim_start().starts_with(['}', '{']);
        while last < header + 2 && self.text((file, last + 1)).trim() == "{" {
            last += 1;
        }
        if !self.text((file, last)).trim_end().ends_with("}") && closes(last + 1) {
            last += 1;
        }
        (first..=last).map(|line| (file, line)).collect()
    }

    fn text(&self, (file, line): Place) -> &str {
        self.sources.file(file).line(line).unwrap_or("")
    }

    /// Why a line is gone: what the smallest thing around it that was left out says.
    fn reason(&self, (file, line): Place, text: &str) -> Option<String> {
        let base = self.sources.file(file).base();
        let range = self.sources.file(file).line_range(line)?;
        let skipped = self.text((file, line));
        let indent = (skipped.len() - skipped.trim_start().len()) as u32;
        let (start, end) = (base + range.start as u32 + indent, base + range.end as u32);
        let covers = |one: &&LeftOut| {
            let extent = self.sources.call_site(one.extent);
            one.span.is_known() && extent.start < end && extent.end > start
        };
        let size = |one: &&LeftOut| one.extent.end - one.extent.start;
        let mut reasons: Vec<&LeftOut> = self.left_out.iter().filter(covers).collect();
        reasons.sort_by_key(size);
        let first = reasons.first()?;
        // Both stages may have the same file.
        let names: BTreeSet<&str> =
            reasons.iter().filter(|one| one.span == first.span).map(|one| one.name.as_str()).collect();
        Some(match names.len() {
            1 if text.contains(&first.name) => first.because.clone(),
            1 => format!("{}: {}", first.name, first.because),
            2 => format!("{}: {}; and another part of it", first.name, first.because),
            n_names => format!("{}: {}; and {} other parts of it", first.name, first.because, n_names - 1),
        })
    }

    /// Both sides of a section next to each other.
    fn section(&self, title: &str, left: &[Place], right: &[&Line<'_>]) -> Section {
        let place = left.first().map_or_else(String::new, |(file, line)| {
            let name = self.sources.file(*file).name();
            format!("{}:{line}", name.rsplit('/').next().unwrap_or(name))
        });
        let indices: BTreeMap<Place, usize> = left.iter().enumerate().map(|(index, place)| (*place, index)).collect();
        let from: Vec<Option<usize>> =
            right.iter().map(|line| line.from.and_then(|from| indices.get(&from).copied())).collect();
        let anchors = longest_run(&from);
        let kept: BTreeSet<usize> = from.iter().flatten().copied().collect();
        let mut rows = Vec::new();
        let (mut next, mut comments) = (0, Comments::default());
        let mut right_comments = Comments::default();
        for (index, (line, anchor)) in right.iter().zip(&anchors).enumerate() {
            let code = right_comments.html(line.text);
            let to = match anchor {
                Some(anchor) => Some(*anchor),
                // Comments, closing braces and their like are kept where the text is the same before the next anchor.
                None if line.from.is_none() => {
                    let until = anchors.iter().skip(index).flatten().next().copied().unwrap_or(left.len());
                    let between = left.get(next..until).unwrap_or_default();
                    let is_it = |place: &Place| self.text(*place).trim() == line.text.trim();
                    between.iter().position(is_it).map(|at| next + at)
                }
                None => None,
            };
            let Some(to) = to.filter(|to| *to >= next) else {
                rows.push(Row { class: "new", right: Some(code), ..Row::default() });
                continue;
            };
            while next < to {
                rows.push(self.alone(title, left, next, &kept, &mut comments));
                next += 1;
            }
            let Some(place) = left.get(to).copied() else { continue };
            let text = self.text(place);
            let class = if alike(text, line.text) { "same" } else { "changed" };
            rows.push(Row {
                class,
                number: Some(place.1),
                left: Some(comments.html(text)),
                right: Some(code),
                ..Row::default()
            });
            next = to + 1;
        }
        while next < left.len() {
            rows.push(self.alone(title, left, next, &kept, &mut comments));
            next += 1;
        }
        once(&mut rows);
        Section { title: title.to_owned(), place, gone: None, rows }
    }

    /// A line of the original that no line of the residual is next to.
    fn alone(&self, title: &str, left: &[Place], index: usize, kept: &BTreeSet<usize>, comments: &mut Comments) -> Row {
        let Some(place) = left.get(index).copied() else { return Row::default() };
        let text = self.text(place);
        let code = comments.html(text);
        let trimmed = text.trim();
        let nothing = trimmed.is_empty() || trimmed.starts_with("//") || trimmed.chars().all(|c| "{}();".contains(c));
        let unnamed = || Some("nothing that is left names it".to_owned()).filter(|_| title == DECLARATIONS);
        let because = if kept.contains(&index) || nothing { None } else { self.reason(place, text).or_else(unnamed) };
        let class = if because.is_some() { "gone" } else { "plain" };
        Row { class, number: Some(place.1), left: Some(code), because, ..Row::default() }
    }
}

/// Why the residual has another version than the original, if it has.
pub(super) fn version_note(
    program: &Program,
    stage: Stage,
    draw: &SpecializedDraw,
    sources: &SourceMap,
) -> Option<String> {
    let shader = program.stage(stage)?;
    let main = shader.functions.iter().find(|function| function.name == "main" && function.body.is_some())?;
    let file = sources.file(sources.file_of(sources.call_site(main.span))?);
    let original = (1..=file.line_count()).filter_map(|line| file.line(line)).find_map(version)?;
    let residual = draw.text(stage).lines().find_map(version)?;
    let extensions = draw.text(stage).lines().any(|line| line.starts_with("#extension"));
    let by =
        if extensions { "; what it needs of later versions comes by extensions that such compilers have" } else { "" };
    let note = format!(
        "The residual is written as GLSL {residual}, which every OpenGL 3.2 compiler takes, whatever the version of the original ({original}){by}."
    );
    let number = |version: &str| version.split_whitespace().next().unwrap_or_default().to_owned();
    (number(original) != number(residual)).then_some(note)
}

/// The version and profile of a `#version` line.
fn version(line: &str) -> Option<&str> {
    line.trim_start().strip_prefix('#')?.trim_start().strip_prefix("version").map(str::trim)
}

/// Whether a line is a comment, or a part of one.
fn is_comment(line: &str) -> bool {
    let text = line.trim();
    text.starts_with("//") || text.starts_with("/*") || text.starts_with('*') || text.ends_with("*/")
}

/// Whether a comment or directive of the residual is that of the original.
fn same_heading(original: &str, residual: &str) -> bool {
    original.trim() == residual.trim() || (version(original).is_some() && version(residual).is_some())
}

/// Declarations in the order of the original. The lines of a struct stay together.
fn in_order<'a>(lines: Vec<&'a Line<'a>>) -> Vec<&'a Line<'a>> {
    let mut units: Vec<Vec<&Line<'_>>> = Vec::new();
    let mut inside = false;
    for line in lines {
        let comment = line.text.trim_start().starts_with("//") || line.text.starts_with("/*");
        match units.last_mut().filter(|_| inside) {
            Some(unit) => unit.push(line),
            None => units.push(vec![line]),
        }
        inside = comment || line.text.ends_with('{') || (inside && line.text.starts_with("    "));
    }
    units.sort_by_key(|unit| unit.iter().find_map(|line| line.from));
    units.into_iter().flatten().collect()
}

/// The declarations of a residual, and its functions.
fn parts<'a>(lines: &'a [Line<'a>]) -> (Vec<&'a Line<'a>>, Vec<Part<'a>>) {
    let (mut declarations, mut functions): (Vec<&Line<'_>>, Vec<Part<'_>>) = (Vec::new(), Vec::new());
    let mut comments: Vec<&Line<'_>> = Vec::new();
    let mut inside = false;
    for line in lines {
        if inside {
            if let Some(part) = functions.last_mut() {
                part.lines.push(line);
            }
            inside = line.text != "}";
            continue;
        }
        let header = !line.text.starts_with(' ') && line.text.contains('(') && line.text.ends_with('{');
        if header {
            let before = line.text.split('(').next().unwrap_or("");
            let title = before.rsplit(' ').next().unwrap_or(before).to_owned();
            let mut lines = std::mem::take(&mut comments);
            lines.push(line);
            functions.push(Part { header: line.from, title, lines });
            inside = true;
        } else if line.text.starts_with("//") || line.text.starts_with("/*") || line.text.starts_with(" *") {
            comments.push(line);
        } else if !line.text.is_empty() {
            declarations.append(&mut comments);
            declarations.push(line);
        }
    }
    declarations.append(&mut comments);
    (declarations, functions)
}

/// Of places in two orders, the longest choice that is in both: the others become `None`.
fn longest_run(places: &[Option<usize>]) -> Vec<Option<usize>> {
    // The last item of the shortest end of a run of each length, by patience sorting.
    let mut ends: Vec<usize> = Vec::new();
    let mut before: Vec<Option<usize>> = vec![None; places.len()];
    let value = |index: usize| places.get(index).copied().flatten().unwrap_or(0);
    for (index, place) in places.iter().enumerate() {
        let Some(place) = place else { continue };
        let length = ends.partition_point(|end| value(*end) < *place);
        if let Some(slot) = before.get_mut(index) {
            *slot = length.checked_sub(1).and_then(|last| ends.get(last).copied());
        }
        match ends.get_mut(length) {
            // Of copies the first is the one.
            Some(end) if value(*end) > *place => *end = index,
            Some(_) => {}
            None => ends.push(index),
        }
    }
    let mut chosen = vec![None; places.len()];
    let mut at = ends.last().copied();
    while let Some(index) = at {
        if let Some(slot) = chosen.get_mut(index) {
            *slot = places.get(index).copied().flatten();
        }
        at = before.get(index).copied().flatten();
    }
    chosen
}

/// Whether two lines say the same, however they are spaced and commented.
fn alike(a: &str, b: &str) -> bool {
    let bare = |text: &str| -> String {
        text.split("//").next().unwrap_or("").chars().filter(|character| !character.is_whitespace()).collect()
    };
    bare(a) == bare(b)
}

/// Of lines in sequence with one reason, the first has it for the keyboard.
fn once(rows: &mut [Row]) {
    let mut known: Option<String> = None;
    for row in rows {
        row.first = row.because.is_some() && row.because != known;
        known.clone_from(&row.because);
    }
}

#[cfg(test)]
mod tests {
    use super::{alike, longest_run, same_heading};

    #[test]
    fn a_kept_heading_is_found_by_its_text() {
        assert!(same_heading("  // Phong shading, 2012 ", "// Phong shading, 2012"));
        assert!(
            same_heading("# version 330 core", "#version 150")
                && !same_heading("#version 330", "#extension a : enable")
        );
        assert!(!same_heading("// a", "// b"));
    }

    #[test]
    fn the_longest_run_in_both_orders_is_next_to_each_other() {
        let places = [Some(4), Some(1), Some(2), None, Some(2), Some(3), Some(0)];
        assert_eq!(longest_run(&places), [None, Some(1), Some(2), None, None, Some(3), None]);
        assert_eq!(longest_run(&[]), []);
    }

    #[test]
    fn spaces_and_comments_are_no_change() {
        assert!(alike("  a = b;  // c", "a  =b;"));
        assert!(!alike("a = b;", "a = 2.0;"));
    }
}
