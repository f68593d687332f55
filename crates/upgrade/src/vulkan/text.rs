//! The new text of one file of a tree.
//!
//! *In:* the file, what is known about all declarations, the blocks. *Out:* the text, or the reason why there is none.

use super::super::names::free;
use super::super::rewrite::{Edit, applied, place_of_declarations};
use super::chunks::Chunks;
use super::conditions::{Conditions, Directive, Open, between, without_empty};
use super::coordinates;
use super::declarations::{Line, Moved, Text};
use super::definitions::AllDefinitions;
use super::dialect::{Dialect, HostBlock, Numbering};
use super::facts::{Fact, spelled};
use super::files::{File, Files};
use super::layouts::{Layout, Layouts, block_name};
use super::numbers::Numbers;
use super::output::Note;
use super::qualifiers::Qualifiers;
use super::style::{self, indent_of};
use super::{Compiled, Key};
use glisten_front::builtin::functions;
use glisten_front::hir::{Global, Shader, Stage, Storage};
use glisten_sources::engines::code::without_comments;
use std::collections::{BTreeMap, BTreeSet};

/// OpenGL's extension for includes.
const OPENGL_INCLUDE: &str = "GL_ARB_shading_language_include";

/// The line by which glslang takes includes.
const INCLUDE_LINE: &str = "#extension GL_GOOGLE_include_directive : enable";

/// The plan by which all texts of a tree are rewritten.
pub(super) struct Plan<'a> {
    pub(super) dialect: &'a Dialect,
    pub(super) programs: &'a [Compiled<'a>],
    pub(super) files: &'a Files,
    pub(super) facts: &'a BTreeMap<Key, BTreeMap<usize, Fact>>,
    pub(super) numbers: &'a Numbers,
    pub(super) layouts: &'a Layouts,
    /// The fragment sources that turn `gl_FragCoord`.
    pub(super) turned: &'a BTreeSet<Key>,
    /// The included files that name `gl_FragCoord` and are read by those.
    pub(super) turned_parts: &'a BTreeSet<Key>,
    pub(super) qualifiers: &'a Qualifiers,
    pub(super) definitions: &'a AllDefinitions,
    /// All words of all texts.
    pub(super) names: &'a BTreeSet<String>,
    /// The uniforms that the host has in blocks of its own, by their old names.
    pub(super) known: &'a BTreeSet<String>,
    /// Programs both of whose stages have the same block.
    pub(super) whole: &'a BTreeSet<usize>,
}

/// Whether a stage can have the members that only the other one declares: `None`, if a name means something else here, or a struct is
/// missing; otherwise their lines.
pub(super) fn foreign(
    compiled: &Compiled<'_>,
    stage: Stage,
    chunks: &Chunks<'_>,
    layout: &Layout,
    own: &BTreeSet<&str>,
) -> Option<Vec<(u32, String)>> {
    let mut names: BTreeSet<&str> = chunks.all.iter().map(|token| token.text).collect();
    let shader = compiled.program.stage(stage)?;
    names.extend(shader.globals.iter().map(|global| global.name.as_str()));
    names.extend(shader.functions.iter().map(|function| function.name.as_str()));
    let others = layout.members.iter().filter(|(name, _)| !own.contains(name.as_str()));
    let line = |(name, (offset, plain)): (&String, &(u32, Option<String>))| {
        let is_free = !names.contains(name.as_str()) && functions::named(name).is_empty();
        let ty = plain.as_ref().filter(|_| is_free)?;
        Some((*offset, spelled(ty, name)))
    };
    others.map(line).collect()
}

impl Plan<'_> {
    /// The new text of a file, and what to say of it.
    pub(super) fn rewritten(&self, key: &Key, file: &File) -> Result<(String, Vec<Note>), String> {
        let none = BTreeMap::new();
        let (chunks, conditions) = (Chunks::new(&file.text), Conditions::new(&file.text));
        let definitions = self.definitions.of(&key.0, (&chunks, &conditions), self.files);
        let text = Text {
            name: &key.0,
            chunks: &chunks,
            conditions: &conditions,
            definitions: &definitions,
            facts: self.facts.get(key).unwrap_or(&none),
            qualifiers: self.qualifiers.of(key),
            names: self.names,
            dialect: self.dialect,
            numbers: self.numbers,
            is_turned: self.turned.contains(key),
        };
        let moved = text.moved()?;
        let mut edits: Vec<Edit> = Vec::new();
        edits.extend(self.block(key, file, &chunks, &moved));
        edits.extend(self.host_blocks(&file.text, &moved));
        edits.extend(text.layouts()?);
        let has_moved = !moved.edits.is_empty();
        let notes = self.notes(key, file, &moved);
        edits.extend(moved.edits);
        edits.extend(self.renamed(&chunks));
        edits.extend(self.directives(&file.text, &conditions));
        edits.extend(self.include_extensions(&file.text, &conditions));
        if self.dialect.coordinates {
            edits.extend(self.coordinates(key, file, &chunks)?);
        }
        let new = applied(&file.text, edits);
        let new = if has_moved && without_empty(&file.text) == *file.text { without_empty(&new) } else { new };
        Ok((self.with_extension(key, file, new), notes))
    }

    /// The values that uniforms begin with in OpenGL alone.
    fn notes(&self, key: &Key, file: &File, moved: &Moved) -> Vec<Note> {
        let with_value = moved.lines.iter().filter_map(|line| Some((line, line.initializer.as_deref()?)));
        let note = |(line, value): (&Line, &str)| {
            let name = self.name_at(key, line.place).unwrap_or("");
            let number = file.text.get(..line.place).map_or(0, |before| before.matches('\n').count()) as u32 + 1;
            let text = format!(
                "`{name}` begins with `{value}` in OpenGL; a member of a block has the value that the host sets"
            );
            Note { file: key.0.clone(), line: number, text }
        };
        with_value.map(note).collect()
    }

    fn coordinates(&self, key: &Key, file: &File, chunks: &Chunks<'_>) -> Result<Vec<Edit>, String> {
        let is_turned = self.turned.contains(key) || self.turned_parts.contains(key);
        let name = is_turned.then(|| free(self.names, "fragCoord"));
        let mut edits = coordinates::words(chunks, file.is_read_by(Stage::Fragment), name.as_deref());
        if self.has_integer_centers(file) && coordinates::names_frag_coord(chunks) {
            if !is_turned {
                let what = "`pixel_center_integer` puts the centers of pixels at integers, which Vulkan does not";
                return Err(format!("{what}; subtract 0.5 from `gl_FragCoord.xy` instead"));
            }
            edits.extend(coordinates::redeclared(chunks).map(|range| (range, String::new())));
        }
        if file.is_read_by(Stage::Geometry) {
            let name = free(self.names, "emitVulkanVertex");
            edits.extend(coordinates::emissions(chunks, &name, !file.source_of.is_empty())?);
        }
        let before_geometry = |unit: &usize| {
            let program = self.programs.iter().find(|one| one.index == *unit);
            program.is_some_and(|one| one.program.stage(Stage::Geometry).is_some())
        };
        let vertex_units = || file.readers.iter().filter(|(_, stage)| *stage == Stage::Vertex).map(|(unit, _)| unit);
        let n_before = vertex_units().filter(|unit| before_geometry(unit)).count();
        if n_before > 0 {
            let what = "is before a geometry stage in one program and not in another, and only the last stage converts the depth";
            let is_mixed = n_before < vertex_units().count() && coordinates::main_of(chunks).is_some();
            return if is_mixed { Err(format!("`{}` {what}", key.0)) } else { Ok(edits) };
        }
        let vertex = file.readers.iter().find(|(_, stage)| *stage == Stage::Vertex);
        let has_main = coordinates::main_of(chunks).is_some();
        let is_source = !file.source_of.is_empty();
        let Some((unit, _)) = vertex.filter(|_| has_main || is_source) else { return Ok(edits) };
        if !has_main {
            let defines = |key: &Key, other: &File| {
                let reads = other.readers.contains(&(*unit, Stage::Vertex));
                reads && key.0 != *other.text && coordinates::main_of(&Chunks::new(&other.text)).is_some()
            };
            let is_elsewhere = self.files.all.iter().any(|(key, other)| defines(key, other));
            return if is_elsewhere { Ok(edits) } else { Err(format!("`main` is not defined in `{}` itself", key.0)) };
        }
        if file.readers.iter().any(|(_, stage)| *stage != Stage::Vertex) {
            return Err(format!("`main` of the vertex stage is in `{}`, which other stages read", key.0));
        }
        let shader =
            self.programs.iter().find(|one| one.index == *unit).and_then(|one| one.program.stage(Stage::Vertex));
        let name = free(self.names, "openglMain");
        edits.extend(shader.and_then(|shader| coordinates::main(chunks, shader, &name)).unwrap_or_default());
        Ok(edits)
    }

    /// Whether a program whose fragment source this is has the centers of pixels at integers.
    fn has_integer_centers(&self, file: &File) -> bool {
        let own = self.programs.iter().filter(|one| file.readers.contains(&(one.index, Stage::Fragment)));
        own.filter_map(|one| one.program.stage(Stage::Fragment)).any(coordinates::has_integer_centers)
    }

    /// The block of the loose uniforms of a file.
    fn block(&self, key: &Key, file: &File, chunks: &Chunks<'_>, moved: &Moved) -> Option<Edit> {
        let owner = file.owner();
        let layout = match owner {
            Some(unit) => self.layouts.of_units.get(&unit)?,
            None => self.layouts.of_files.get(key)?,
        };
        let is_turned = self.turned.contains(key);
        if moved.lines.is_empty() && !is_turned {
            return None;
        }
        let is_whole = owner.is_some_and(|unit| self.whole.contains(&unit));
        let stage = file.readers.first().map(|(_, stage)| *stage);
        let wanted = match owner {
            Some(_) if is_whole => "Uniforms".to_owned(),
            Some(_) => block_name(key, stage),
            None => block_name(key, None),
        };
        let outer = moved.place.as_ref().map(|(_, open)| open.len()).unwrap_or(0);
        let offset = |place: usize| layout.offsets.get(&(key.clone(), place)).copied().unwrap_or(0);
        let is_even = owner.is_none() && self.can_be_even(key, moved);
        let mut members: Vec<(u32, Vec<String>, Vec<Open>)> = Vec::new();
        for line in &moved.lines {
            let at = offset(line.place);
            let open = if self.dialect.offsets && !is_even {
                line.conditions.get(outer..).unwrap_or_default().to_vec()
            } else {
                Vec::new()
            };
            members.push((at, self.lines(line, at), open));
        }
        style::align_comments(&file.text, &moved.lines, &mut members);
        if let (true, Some(unit), Some(stage)) = (is_whole, owner, stage) {
            let compiled = self.programs.iter().find(|one| one.index == unit)?;
            let own: BTreeSet<&str> = moved.lines.iter().filter_map(|line| self.name_at(key, line.place)).collect();
            for (at, code) in foreign(compiled, stage, chunks, layout, &own).unwrap_or_default() {
                members.push((at, vec![self.member(at, &code)], Vec::new()));
            }
        }
        let height =
            layout.height.filter(|_| is_whole || is_turned).map(|at| (at, free(self.names, "framebufferHeight")));
        if let Some((at, name)) = &height {
            members.push((*at, vec![self.member(*at, &format!("float {name}"))], Vec::new()));
        }
        if owner.is_some() || !self.dialect.offsets {
            members.sort_by_key(|(at, _, _)| *at);
        }
        let (mut body, indent) = (String::new(), indent_of(&file.text));
        let mut open: Vec<Open> = Vec::new();
        for (_, lines, conditions) in &members {
            between(&open, conditions).iter().for_each(|line| body.push_str(&format!("{line}\n")));
            lines.iter().for_each(|line| body.push_str(&format!("{indent}{line}\n")));
            open.clone_from(conditions);
        }
        between(&open, &[]).iter().for_each(|line| body.push_str(&format!("{line}\n")));
        let turned = height.filter(|_| is_turned).map_or_else(String::new, |(_, height)| {
            let name = free(self.names, "fragCoord");
            format!("vec4 {name} = {};\n", coordinates::turned(&height, self.has_integer_centers(file)))
        });
        let first = || place_of_declarations(&file.text);
        let (place, below) = moved.place.as_ref().map_or_else(first, |(place, _)| (*place, ""));
        let include = self.first_turned_include(&file.text);
        let (place, below) = if is_turned && include < place { (include, "") } else { (place, below) };
        let after = coordinates::redeclared(chunks).filter(|_| is_turned).map_or(0, |range| range.end);
        let (place, below) = if after > place { (after, "") } else { (place, below) };
        let begins_a_line = file.text.get(..place).is_none_or(|before| before.is_empty() || before.ends_with('\n'));
        let gap = if begins_a_line { "" } else { "\n" };
        let layout = match self.dialect.numbering {
            Numbering::All => format!("layout(std140, set = 0, binding = {})", self.numbers.of(layout.node)),
            _ => "layout(std140)".to_owned(),
        };
        let name = free(self.names, &wanted);
        Some((place..place, format!("{gap}{layout} uniform {name} {{\n{body}}};\n{turned}{below}")))
    }

    /// Whether the block of a file with its own can have all members without their conditions, and so be the same for all stages: no
    /// name stands for anything else, and no type is a struct.
    fn can_be_even(&self, key: &Key, moved: &Moved) -> bool {
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        moved.lines.iter().all(|line| {
            let fact = self.facts.get(key).and_then(|facts| facts.get(&line.place));
            let Some(Fact::Loose(loose)) = fact else { return false };
            loose.plain.is_some() && seen.insert(&loose.name) && self.is_only_uniform(&loose.name)
        })
    }

    /// Whether a name is that of uniforms alone.
    fn is_only_uniform(&self, name: &str) -> bool {
        let in_stage = |shader: &Shader| {
            let is_other = |global: &Global| global.name == name && global.storage != Storage::Uniform;
            shader.globals.iter().any(is_other) || shader.functions.iter().any(|function| function.name == name)
        };
        let is_macro = |file: &File| {
            let conditions = Conditions::new(&file.text);
            conditions.list.iter().any(|one| one.word() == "define" && one.name() == name)
        };
        !self.programs.iter().flat_map(|one| &one.program.stages).any(in_stage)
            && !self.files.all.values().any(is_macro)
    }

    /// The place of the first include that may name the turned coordinates, or the end.
    fn first_turned_include(&self, text: &str) -> usize {
        if self.turned_parts.is_empty() {
            return text.len();
        }
        let conditions = Conditions::new(text);
        let first = conditions.list.iter().find(|one| one.is_include());
        first.map_or(text.len(), |one| one.range.start)
    }

    fn name_at(&self, key: &Key, place: usize) -> Option<&str> {
        match self.facts.get(key)?.get(&place)? {
            Fact::Loose(loose) => Some(&loose.name),
            _ => None,
        }
    }

    fn member(&self, at: u32, code: &str) -> String {
        if self.dialect.offsets { format!("layout(offset = {at}) {code};") } else { format!("{code};") }
    }

    /// The lines of a member, the comment above it first.
    fn lines(&self, line: &Line, at: u32) -> Vec<String> {
        let behind = line.comment().map_or_else(String::new, |comment| format!("  {comment}"));
        let code = format!("{}{behind}", self.member(at, &line.code));
        line.above.iter().cloned().chain([code]).collect()
    }

    /// The lines that bring the blocks of the host.
    fn host_blocks(&self, text: &str, moved: &Moved) -> Option<Edit> {
        let (place, _) = moved.place.as_ref().filter(|_| !moved.known.is_empty())?;
        let blocks = moved.known.iter().filter_map(|index| self.dialect.blocks.get(*index));
        let conditions = Conditions::new(text);
        let code = without_comments(text);
        let has = |block: &HostBlock| match &block.include {
            Some(include) => {
                let file = include.rsplit(':').next().unwrap_or(include);
                let is_include = |one: &Directive| one.is_include();
                conditions.list.iter().any(|one| is_include(one) && one.rest().contains(file))
            }
            None => code.contains(&format!("uniform {} {{", block.name)),
        };
        let lines: Vec<String> = blocks.filter(|block| !has(block)).map(|block| format!("{}\n", block.line)).collect();
        (!lines.is_empty()).then(|| (*place..*place, lines.concat()))
    }

    /// The directives that include, in the word of the host.
    fn directives(&self, text: &str, conditions: &Conditions) -> Vec<Edit> {
        let Some(wanted) = &self.dialect.directive else { return Vec::new() };
        let mut edits = Vec::new();
        for one in &conditions.list {
            let word = one.word();
            if !matches!(word, "include" | "moj_import") || word == wanted {
                continue;
            }
            let line = text.get(one.range.clone()).unwrap_or("");
            if let Some(at) = line.find(word) {
                let start = one.range.start + at;
                edits.push((start..start + word.len(), wanted.clone()));
            }
        }
        edits
    }

    /// OpenGL's extension for includes, which glslang does not take for Vulkan, in the name that it takes there.
    fn include_extensions(&self, text: &str, conditions: &Conditions) -> Vec<Edit> {
        if self.dialect.numbering != Numbering::All {
            return Vec::new();
        }
        let wanted = extension_of(self.dialect.extension.as_deref().unwrap_or(INCLUDE_LINE));
        let place = |one: &Directive| {
            let line = text.get(one.range.clone())?;
            let at = one.range.start + line.find(OPENGL_INCLUDE)?;
            Some((at..at + OPENGL_INCLUDE.len(), wanted.to_owned()))
        };
        conditions.list.iter().filter(|one| one.word() == "extension").filter_map(place).collect()
    }

    /// Names that the host has changed.
    fn renamed(&self, chunks: &Chunks<'_>) -> Vec<Edit> {
        let mut edits = Vec::new();
        for (index, token) in chunks.all.iter().enumerate() {
            let is_member = index.checked_sub(1).is_some_and(|before| chunks.word(before) == ".");
            let new = self.dialect.renamed.get(token.text).filter(|_| self.known.contains(token.text));
            if let Some(new) = new.filter(|_| !is_member) {
                edits.push((token.range.clone(), new.clone()));
            }
        }
        edits
    }

    /// The text with the lines after `#version` that the host wants, or glslang for includes and for lines that go on.
    fn with_extension(&self, key: &Key, file: &File, text: String) -> String {
        let is_source = !file.source_of.is_empty();
        let includes = || Conditions::new(&text).list.iter().any(|one| one.word() == "include");
        let for_includes =
            (self.dialect.numbering == Numbering::All && is_source && includes()).then_some(INCLUDE_LINE);
        let wanted = self.dialect.extension.as_deref().filter(|_| is_source).or(for_includes);
        // glslang takes a backslash at the end of a line from 4.20 on (GLSL 4.20 §3.1).
        let needs_joining = self.dialect.numbering != Numbering::All && is_source && self.continues_lines(key);
        let for_lines = needs_joining.then_some("#extension GL_ARB_shading_language_420pack : enable");
        // Components of a location are in the language from 4.40 on.
        let has_components = self.dialect.numbering == Numbering::Locations && text.contains("component = ");
        let for_components = has_components.then_some("#extension GL_ARB_enhanced_layouts : require");
        let lines = wanted.into_iter().chain(for_lines).chain(for_components);
        lines.fold(text, with_line)
    }

    /// Whether a source, or a file that it includes, has a line that goes on in the next one.
    fn continues_lines(&self, key: &Key) -> bool {
        let goes_on = |text: &str| text.contains("\\\n") || text.contains("\\\r\n");
        let (mut seen, mut open) = (BTreeSet::new(), vec![key.0.as_str()]);
        while let Some(name) = open.pop() {
            if !seen.insert(name) {
                continue;
            }
            let mut texts = self.files.all.range((name.to_owned(), None)..).take_while(|((file, _), _)| file == name);
            if texts.any(|(_, file)| goes_on(&without_comments(&file.text))) {
                return true;
            }
            open.extend(self.files.included_by(name));
        }
        false
    }
}

/// The name in an `#extension` line.
fn extension_of(line: &str) -> &str {
    line.split_whitespace().nth(1).unwrap_or(line)
}

/// A text with a line after `#version`, if it has none of that name.
fn with_line(text: String, line: &str) -> String {
    if text.contains(extension_of(line)) {
        return text;
    }
    let Some(version) = glisten_front::source::version_line(&text) else { return text };
    let rest = text.get(version.start..);
    let end = rest.and_then(|rest| rest.find('\n')).map_or(text.len(), |at| version.start + at + 1);
    let (before, after) = text.split_at(end);
    let gap = if before.ends_with('\n') { "" } else { "\n" };
    format!("{before}{gap}{line}\n{after}")
}
