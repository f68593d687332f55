//! Declarations in the text: layouts of what stays, and the block for the loose uniforms.
//!
//! *In:* a text, its stage, its program. *Out:* edits; or the reason why a declaration cannot be rewritten.

use super::super::rewrite::Edit;
use super::super::tokens::closing;
use super::chunks::{Chunk, Chunks};
use glisten_front::hir::{Global, GlobalId, Shader, Stage, Storage, Type, TypeId, Types};
use glisten_front::link::{Program, UniformRoot, Varying};
use glisten_front::source::{SourceMap, Span, comments};

/// Words before the type of a declaration.
static QUALIFIERS: &[&str] = &["uniform", "lowp", "mediump", "highp", "const", "in", "out"];

/// Qualifiers of a varying, which a variable of one stage does not have.
static OF_VARYINGS: &[&str] = &["out", "flat", "smooth", "noperspective", "centroid", "sample", "invariant"];

/// A text that is rewritten, with what is known about it.
pub(super) struct Text<'a> {
    pub(super) chunks: &'a Chunks<'a>,
    pub(super) sources: &'a SourceMap,
    pub(super) program: &'a Program,
    pub(super) shader: &'a Shader,
    /// The offset of the text in the source map.
    pub(super) base: u32,
    pub(super) name: &'a str,
}

/// A global with its declaration.
struct Declared<'a> {
    id: GlobalId,
    global: &'a Global,
    chunk: &'a Chunk,
    /// The token of its name.
    token: usize,
}

/// The members of the loose block, and the edits that remove their old declarations.
#[derive(Default)]
pub(super) struct Loose {
    /// Each line of the block, with its offset.
    pub(super) lines: Vec<(u32, Vec<String>)>,
    pub(super) edits: Vec<Edit>,
    /// The place of the block; none if the stage declares no loose uniform.
    pub(super) place: Option<usize>,
    /// The uniforms that the stage declares.
    pub(super) names: Vec<String>,
}

impl<'a> Text<'a> {
    fn declared(&self) -> Result<Vec<Declared<'a>>, String> {
        let mut found = Vec::new();
        for (id, global) in self.shader.globals() {
            let crosses = matches!(global.storage, Storage::Uniform | Storage::In | Storage::Out);
            if global.builtin.is_some() || !crosses {
                continue;
            }
            let offset = global.span.start.checked_sub(self.base).map(|offset| offset as usize);
            let place = offset.filter(|_| !global.span.expansion.is_some()).and_then(|offset| self.chunks.at(offset));
            let Some((chunk, token)) = place.filter(|(_, token)| self.is_name(*token, global)) else {
                let what = "is declared by a macro or in another file, which `--to vulkan` does not rewrite";
                return Err(format!("`{}` {what}", global.name));
            };
            if chunk.is_cut {
                return Err(format!("the declaration of `{}` has a directive inside", global.name));
            }
            found.push(Declared { id, global, chunk, token });
        }
        found.sort_by_key(|one| one.token);
        Ok(found)
    }

    fn is_name(&self, token: usize, global: &Global) -> bool {
        let word = self.chunks.word(token);
        word == global.name
            || global.block.as_ref().is_some_and(|block| word == block.name || block.instance.as_deref() == Some(word))
    }

    /// The layouts of everything but loose uniforms.
    pub(super) fn layouts(&self) -> Result<Vec<Edit>, String> {
        let mut edits = Vec::new();
        let declared = self.declared()?;
        for (index, one) in declared.iter().enumerate() {
            let is_first = index == 0 || declared.get(index - 1).is_none_or(|before| before.chunk != one.chunk);
            let Some(words) = self.words(one)? else { continue };
            if words.is_empty() {
                edits.extend(self.kept_inside(one, is_first));
            } else if is_first {
                edits.push(self.with_layout(one.chunk, &words));
            } else {
                edits.extend(self.split(one, &words));
            }
        }
        Ok(edits)
    }

    /// The words of a layout; `None` for a loose uniform, and none of them for an output that no stage reads.
    fn words(&self, one: &Declared<'_>) -> Result<Option<Vec<String>>, String> {
        let interface = &self.program.interface;
        let own = |globals: &[(Stage, GlobalId)]| globals.contains(&(self.shader.stage, one.id));
        if one.global.storage == Storage::Uniform {
            if let Some(block) = interface
                .blocks
                .iter()
                .find(|block| interface.roots.get(block.root.0 as usize).is_some_and(|root| own(&root.globals)))
            {
                let slot = block.slot;
                let place = [format!("set = {}", slot.group), format!("binding = {}", slot.binding)];
                return Ok(Some(["std140".to_owned()].into_iter().chain(place).collect()));
            }
            if let Some(slot) = interface.samplers.iter().find(|slot| own(&slot.globals)) {
                if slot.name.contains('.') {
                    return Err(format!(
                        "`{}` is a struct with a sampler, which Vulkan does not have",
                        one.global.name
                    ));
                }
                let slot = slot.texture;
                return Ok(Some(vec![format!("set = {}", slot.group), format!("binding = {}", slot.binding)]));
            }
            return Ok(None);
        }
        let location = |location: u32, component: u32| {
            let component = (component > 0).then(|| format!("component = {component}"));
            [Some(format!("location = {location}")), component].into_iter().flatten().collect::<Vec<_>>()
        };
        let (stage, storage) = (self.shader.stage, one.global.storage);
        if stage == Stage::Vertex && storage == Storage::In {
            let row = interface.attributes.iter().find(|row| row.global == one.id);
            return Ok(Some(row.map_or_else(Vec::new, |row| location(row.location, 0))));
        }
        if stage == Stage::Fragment && storage == Storage::Out {
            let dual = interface.outputs.iter().any(|row| row.index == 1);
            let row = interface.outputs.iter().find(|row| row.global == one.id);
            let words = row.map(|row| {
                let index = dual.then(|| format!("index = {}", row.index));
                location(row.location, 0).into_iter().chain(index).collect()
            });
            return Ok(Some(words.unwrap_or_default()));
        }
        let end = |row: &&Varying| if storage == Storage::In { row.to } else { row.from };
        let rows = interface.varyings.iter().filter(|row| end(row).is_some_and(|end| end.global == one.id));
        let first = rows.min_by_key(|row| end(row).map(|end| end.flat_offset));
        Ok(Some(first.map_or_else(Vec::new, |row| location(row.location, row.component))))
    }

    /// The first declaration of a chunk with a layout: merged into the one that is there, or before it.
    fn with_layout(&self, chunk: &Chunk, words: &[String]) -> Edit {
        let tokens = self.chunks.of(chunk);
        let brace = tokens.iter().position(|token| token.text == "{").unwrap_or(tokens.len());
        let start = self.chunks.range(chunk).start;
        let found = tokens.iter().take(brace).position(|token| token.text == "layout");
        let end = found.and_then(|at| closing(&self.chunks.all, chunk.tokens.start + at + 1));
        let (Some(at), Some(end)) = (found, end) else {
            return (start..start, format!("layout({}) ", words.join(", ")));
        };
        let inner = self.chunks.place(chunk.tokens.start + at + 1).end..self.chunks.place(end).start;
        let replaced = ["std140", "shared", "packed", "std430", "binding", "set", "location", "component", "index"];
        let old = self.chunks.text.get(inner.clone()).unwrap_or("");
        let kept = old.split(',').map(str::trim).filter(|id| {
            let word = id.split(['=', ' ']).next().unwrap_or("").to_ascii_lowercase();
            !id.is_empty() && !replaced.contains(&word.as_str())
        });
        let all: Vec<&str> = words.iter().map(String::as_str).chain(kept).collect();
        (inner, all.join(", "))
    }

    /// A later name of a declaration: `in vec4 a, b;` becomes two declarations.
    fn split(&self, one: &Declared<'_>, words: &[String]) -> Option<Edit> {
        let comma = one.token.checked_sub(1).filter(|at| self.chunks.word(*at) == ",")?;
        let head = self.head(one.chunk)?;
        Some((self.chunks.place(comma), format!("; layout({}) {head}", words.join(", "))))
    }

    /// The words of a declaration before its first name, without its layout.
    fn head(&self, chunk: &Chunk) -> Option<String> {
        let tokens = self.chunks.of(chunk);
        let mut head = String::new();
        let mut index = 0;
        let first = self.first_name(chunk)?;
        while chunk.tokens.start + index < first {
            let token = tokens.get(index)?;
            if token.text == "layout" {
                index = closing(&self.chunks.all, chunk.tokens.start + index + 1)? + 1 - chunk.tokens.start;
                continue;
            }
            let glued = matches!(token.text, "[" | "]") || head.ends_with('[') || head.is_empty();
            head.push_str(if glued { "" } else { " " });
            head.push_str(token.text);
            index += 1;
        }
        Some(head)
    }

    /// The first name that a chunk declares.
    fn first_name(&self, chunk: &Chunk) -> Option<usize> {
        let names = self.shader.globals().filter_map(|(_, global)| {
            let offset = global.span.start.checked_sub(self.base)? as usize;
            self.chunks.at(offset).filter(|(of, _)| *of == chunk).map(|(_, token)| token)
        });
        names.min()
    }

    /// An output that no stage declares as its input is a variable of its own stage.
    fn kept_inside(&self, one: &Declared<'_>, is_first: bool) -> Vec<Edit> {
        if !is_first || one.global.block.is_some() {
            return Vec::new();
        }
        let until = one.token;
        let tokens = (one.chunk.tokens.start..until).filter(|index| OF_VARYINGS.contains(&self.chunks.word(*index)));
        tokens
            .map(|index| {
                let place = self.chunks.place(index);
                let next = self.chunks.place(index + 1).start;
                (place.start..next.max(place.end), String::new())
            })
            .collect()
    }

    /// The loose uniforms of the stage.
    pub(super) fn loose(&self) -> Result<Loose, String> {
        let mut loose = Loose::default();
        let interface = &self.program.interface;
        let (mut first, mut last, mut later_struct): (Option<&Chunk>, Option<&Chunk>, bool) = (None, None, false);
        for one in self.declared()? {
            let own = |root: &&UniformRoot| root.block.is_none() && root.globals.contains(&(self.shader.stage, one.id));
            let Some(root) = interface.roots.iter().find(own) else { continue };
            if self.program.types.contains_sampler(root.ty) {
                continue;
            }
            let is_new = last != Some(one.chunk);
            later_struct |= first.is_some_and(|first| self.declares_struct_after(first, root.ty));
            first = first.or(Some(one.chunk));
            last = Some(one.chunk);
            let (ty, rest) = self.ty(one.chunk)?;
            let declarator = self.declarator(one.token);
            let span = one.global.span;
            let mut lines = if is_new { comments::above_but_not_leading(self.sources, span) } else { Vec::new() };
            lines.retain(|line| line.starts_with("//"));
            let behind = if is_new { comments::behind(self.sources, self.end_of(one.chunk, span)) } else { None };
            let behind = behind.map_or_else(String::new, |text| format!("  {text}"));
            let n_above = lines.len();
            lines.push(format!("layout(offset = {}) {ty} {declarator};{behind}", root.offset));
            loose.lines.push((root.offset, lines));
            loose.names.push(root.name.clone());
            if is_new {
                let range = self.whole_lines(one.chunk, n_above);
                loose.edits.push((range, rest));
            }
        }
        let between = |first: &Chunk, last: &Chunk| {
            let functions = self.chunks.list.iter().filter(|chunk| chunk.is_function);
            functions.into_iter().any(|one| first.tokens.end <= one.tokens.start && one.tokens.end <= last.tokens.start)
        };
        if let (Some(first), Some(last)) = (first, last) {
            if later_struct && between(first, last) {
                let what = "a struct of a uniform comes after a function that may use other uniforms";
                return Err(format!("{what}; move the struct to the beginning of `{}`", self.name));
            }
            let at = if later_struct { last } else { first };
            loose.place = Some(self.line_start(self.chunks.range(at).start));
        }
        Ok(loose)
    }

    /// A span that ends where a chunk does.
    fn end_of(&self, chunk: &Chunk, span: Span) -> Span {
        let end = self.base.saturating_add(self.chunks.range(chunk).end as u32);
        Span { end, ..span }
    }

    /// Whether a struct of a type is defined in this text, after a chunk.
    fn declares_struct_after(&self, chunk: &Chunk, ty: TypeId) -> bool {
        let types: &Types = &self.program.types;
        let mut after = false;
        types.for_each_struct(ty, &mut |id| {
            let offset = types.structure(id).span.start.checked_sub(self.base).map(|offset| offset as usize);
            after |=
                offset.is_some_and(|offset| offset > self.chunks.range(chunk).end && offset < self.chunks.text.len());
            true
        });
        after
    }

    /// The type of a declaration as it is written, and what has to stay of the declaration: the struct that it defines.
    fn ty(&self, chunk: &Chunk) -> Result<(String, String), String> {
        let tokens = self.chunks.of(chunk);
        if let Some(at) = tokens.iter().position(|token| token.text == "struct") {
            let index = chunk.tokens.start + at;
            let end = self.braces_end(index).unwrap_or(index);
            let (start, end) = (self.chunks.place(index).start, self.chunks.place(end).end);
            let name = self.chunks.word(index + 1);
            if name == "{" {
                return Err("a uniform has a struct without a name; name it".to_owned());
            }
            let text = self.chunks.text.get(start..end).unwrap_or("");
            return Ok((name.to_owned(), format!("{text};\n")));
        }
        let head = self.head(chunk).unwrap_or_default();
        let words = head.split(' ').filter(|word| !QUALIFIERS.contains(word));
        Ok((words.collect::<Vec<_>>().join(" "), String::new()))
    }

    /// The token that closes the braces after a token.
    fn braces_end(&self, from: usize) -> Option<usize> {
        let mut depth = 0_usize;
        for (index, token) in self.chunks.all.iter().enumerate().skip(from) {
            match token.text {
                "{" => depth += 1,
                "}" => {
                    depth = depth.checked_sub(1)?;
                    if depth == 0 {
                        return Some(index);
                    }
                }
                _ => {}
            }
        }
        None
    }

    /// A name with the sizes of its arrays, as they are written, and without its initializer.
    fn declarator(&self, name: usize) -> String {
        let mut depth = 0_usize;
        let mut end = self.chunks.place(name).end;
        for index in name + 1..self.chunks.all.len() {
            match self.chunks.word(index) {
                "[" | "(" => depth += 1,
                "]" | ")" => depth = depth.saturating_sub(1),
                "," | ";" | "=" if depth == 0 => break,
                _ => {}
            }
            end = self.chunks.place(index).end;
        }
        self.chunks.text.get(self.chunks.place(name).start..end).unwrap_or("").to_owned()
    }

    /// The lines of a chunk and of the comment above it, if nothing else is on them; otherwise the chunk alone.
    fn whole_lines(&self, chunk: &Chunk, n_above: usize) -> std::ops::Range<usize> {
        let text = self.chunks.text;
        let range = self.chunks.range(chunk);
        let start = self.line_start(range.start);
        let end = text.get(range.end..).and_then(|rest| rest.find('\n')).map_or(text.len(), |at| range.end + at + 1);
        let before = text.get(start..range.start).unwrap_or("").trim();
        let after = text.get(range.end..end).unwrap_or("").trim();
        if !before.is_empty() || !(after.is_empty() || after.starts_with("//")) {
            return range;
        }
        let above = (0..n_above).fold(start, |at, _| self.line_start(at.saturating_sub(1)));
        above..end
    }

    fn line_start(&self, offset: usize) -> usize {
        self.chunks.text.get(..offset).and_then(|before| before.rfind('\n')).map_or(0, |at| at + 1)
    }
}

/// A type as it is written before a name, if it needs no struct.
pub(super) fn plain_type(types: &Types, ty: TypeId) -> Option<String> {
    let mut inner = ty;
    while let Type::Array(element, _) = types.get(inner) {
        inner = element;
    }
    (!matches!(types.get(inner), Type::Struct(_) | Type::Sampler(_))).then(|| types.name(ty))
}
