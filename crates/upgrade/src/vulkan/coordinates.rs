//! Coordinates in the text: clip-space z, `gl_FragCoord` with its origin at the lower left, `dFdy`, the names of indices.
//!
//! *In:* a text, and the stages that read it. *Out:* edits. *Holds:* the conventions are the defaults of `glisten compile`: z in
//! [0, w], the window's origin at the upper left without a flip, y up.

use super::super::rewrite::{Edit, comment_above};
use super::super::tokens::closing;
use super::chunks::Chunks;
use super::style::{has_braces_below, indent_of};
use glisten_front::builtin::BuiltinVariable;
use glisten_front::hir::{Shader, Stage};
use glisten_sources::engines::code::without_comments;
use std::ops::Range;

/// Names that Vulkan has for others, which are the same if the host draws from 0.
static NAMES: &[(&str, &str)] = &[("gl_VertexID", "gl_VertexIndex"), ("gl_InstanceID", "gl_InstanceIndex")];

/// The old name of a name of Vulkan.
pub(super) fn old_name(name: &str) -> Option<&'static str> {
    NAMES.iter().find(|row| row.1 == name).map(|row| row.0)
}

/// The beginning of the comment above a `main` that converts the depth.
const MARK: &str = "// Vulkan's depth";

/// Whether a text converts the depth itself: it is for Vulkan already.
pub fn converts_depth(text: &str) -> bool {
    text.contains(MARK)
}

/// Functions along y.
static ALONG_Y: &[&str] = &["dFdy", "dFdyFine", "dFdyCoarse"];

/// Whether a stage needs the height of the framebuffer.
pub(super) fn needs_height(shader: &Shader) -> bool {
    let reads = shader.globals.iter().any(|one| one.builtin == Some(BuiltinVariable::FragCoord) && one.used);
    shader.stage == Stage::Fragment && reads && !shader.frag_coord.origin_upper_left && shader.reads_row_of_frag_coord()
}

/// Whether a text names the coordinates of the fragment.
pub(super) fn names_frag_coord(chunks: &Chunks<'_>) -> bool {
    chunks.all.iter().any(|token| token.text == "gl_FragCoord")
}

/// The place of a redeclaration of the coordinates, which comes before any use.
pub(super) fn redeclared(chunks: &Chunks<'_>) -> Option<Range<usize>> {
    let is_it = |index: &usize| chunks.word(*index) == "vec4" && chunks.word(*index + 1) == "gl_FragCoord";
    let name = (0..chunks.all.len()).find(is_it)? + 1;
    let chunk = chunks.list.iter().find(|chunk| chunk.tokens.contains(&name))?;
    (chunks.word(name + 1) == ";").then(|| chunks.range(chunk).start..chunks.place(name + 1).end)
}

/// Whether the centers of pixels are at integers, which Vulkan does not have.
pub(super) fn has_integer_centers(shader: &Shader) -> bool {
    shader.stage == Stage::Fragment && shader.frag_coord.pixel_center_integer
}

/// The coordinates as OpenGL has them, from those of Vulkan.
pub(super) fn turned(height: &str, has_integer_centers: bool) -> String {
    let shift = if has_integer_centers { " - 0.5" } else { "" };
    format!("vec4(gl_FragCoord.x{shift}, {height} - gl_FragCoord.y{shift}, gl_FragCoord.zw)")
}

/// The edits of words and calls. The new name of `gl_FragCoord` is given if it changes.
pub(super) fn words(chunks: &Chunks<'_>, is_fragment: bool, frag_coord: Option<&str>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (index, token) in chunks.all.iter().enumerate() {
        let range = token.range.clone();
        if let Some((_, new)) = NAMES.iter().find(|row| row.0 == token.text) {
            edits.push((range, (*new).to_owned()));
        } else if let (Some(name), "gl_FragCoord") = (frag_coord, token.text)
            // A redeclaration stays one: `in vec4 gl_FragCoord;`.
            && index.checked_sub(1).is_none_or(|before| chunks.word(before) != "vec4")
        {
            edits.push((range, name.to_owned()));
        } else if ALONG_Y.contains(&token.text)
            && is_fragment
            && chunks.word(index + 1) == "("
            && let Some(end) = closing(&chunks.all, index + 1)
        {
            let end = chunks.place(end).end;
            edits.push((range.start..range.start, "(-".to_owned()));
            edits.push((end..end, ")".to_owned()));
        }
    }
    edits
}

/// The new `main` of a vertex shader, which calls the old one, and the edits that rename that: one in each branch of a condition.
pub(super) fn main(chunks: &Chunks<'_>, shader: &Shader, name: &str) -> Option<Vec<Edit>> {
    main_of(chunks)?;
    let has_size = shader.globals.iter().any(|one| one.builtin == Some(BuiltinVariable::PointSize) && one.written);
    let indent = indent_of(chunks.text);
    let size = if has_size { String::new() } else { format!("{indent}gl_PointSize = 1.0;\n") };
    let what = if has_size { "" } else { "; a size for points" };
    // A text without a line's end after its last brace stays one.
    let (gap, tail) = if chunks.text.ends_with('\n') { ("", "\n") } else { ("\n", "") };
    let open = if has_braces_below(chunks.text) { "\n{" } else { " {" };
    let end = chunks.text.len();
    let text = format!(
        "{gap}\n{MARK}: [0, w] in clip space{what}.\nvoid main(){open}\n{indent}{name}();\n{indent}\
         gl_Position.z = (gl_Position.z + gl_Position.w) * 0.5;\n{size}}}{tail}"
    );
    let mut edits: Vec<Edit> = mains(chunks).map(|index| (chunks.place(index), name.to_owned())).collect();
    edits.push((end..end, text));
    if !has_size {
        edits.extend(point_size(chunks));
    }
    Some(edits)
}

/// The edits of a geometry shader: each vertex is emitted by a function that converts the depth. Parts of several sources cannot have
/// one each.
pub(super) fn emissions(chunks: &Chunks<'_>, name: &str, is_source: bool) -> Result<Vec<Edit>, String> {
    let words = || chunks.all.iter().filter(|token| token.text.starts_with("Emit"));
    if words().any(|token| token.text == "EmitStreamVertex") {
        return Err("`EmitStreamVertex` is not rewritten for Vulkan".to_owned());
    }
    let calls: Vec<Edit> = words()
        .filter(|token| token.text == "EmitVertex")
        .map(|token| (token.range.clone(), name.to_owned()))
        .collect();
    let Some(first) = chunks.list.iter().find(|chunk| chunk.is_function) else { return Ok(Vec::new()) };
    if calls.is_empty() {
        return Ok(Vec::new());
    }
    if !is_source {
        return Err("`EmitVertex` is called in an included file; call it in the source".to_owned());
    }
    let at = chunks.range(first).start;
    let line = chunks.text.get(..at).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
    let place = comment_above(chunks.text, &without_comments(chunks.text), line);
    let (indent, open) = (indent_of(chunks.text), if has_braces_below(chunks.text) { "\n{" } else { " {" });
    let text = format!(
        "{MARK}: [0, w] in clip space.\nvoid {name}(){open}\n{indent}gl_Position.z = (gl_Position.z + gl_Position.w) * \
         0.5;\n{indent}EmitVertex();\n}}\n\n"
    );
    Ok(std::iter::once((place..place, text)).chain(calls).collect())
}

/// The member that a redeclared `gl_PerVertex` lacks.
fn point_size(chunks: &Chunks<'_>) -> Option<Edit> {
    let is_block = |index: &usize| chunks.word(*index) == "gl_PerVertex" && chunks.word(*index + 1) == "{";
    let open = (0..chunks.all.len()).find(is_block)? + 1;
    let close = (open..chunks.all.len()).find(|index| chunks.word(*index) == "}")?;
    let has_it = (open..close).any(|index| chunks.word(index) == "gl_PointSize");
    let place = chunks.place(close).start;
    (!has_it).then(|| (place..place, "    float gl_PointSize;\n".to_owned()))
}

/// The name in the first definition of `main`.
pub(super) fn main_of(chunks: &Chunks<'_>) -> Option<usize> {
    mains(chunks).next()
}

/// The names in the definitions of `main`.
fn mains(chunks: &Chunks<'_>) -> impl Iterator<Item = usize> {
    let heads = chunks
        .list
        .iter()
        .filter(|chunk| chunk.is_function)
        .flat_map(|chunk| chunk.tokens.clone().take_while(|index| chunks.word(*index) != "{"));
    heads.filter(|index| chunks.word(*index) == "main" && chunks.word(*index + 1) == "(")
}
