//! [`to_vulkan`]: texts of GLSL 4.50 for OpenGL as texts for Vulkan (GL_KHR_vulkan_glsl), by edits: sets, bindings and locations,
//! the loose uniforms as members of a block, coordinates by the defaults of `glisten compile`.
//!
//! *In:* a compiler, and the sources of a program that compile. *Out:* their new texts. *Holds:* comments, macros and layout stay. The
//! new texts, read as OpenGL's, compile, too, and have the same interface. *Not done here:* declarations in included files and in
//! macros, and those that conditions leave out.
//!
//! | file | contents |
//! | --- | --- |
//! | `chunks` | a text cut into its declarations |
//! | `declarations` | layouts, and the loose uniforms |
//! | `coordinates` | `gl_Position`, `gl_FragCoord`, `dFdy`, indices |

mod chunks;
mod coordinates;
mod declarations;

use super::rewrite::{Edit, applied, first_code_of};
use super::tokens::tokens;
use chunks::Chunks;
use declarations::{Loose, Text, plain_type};
use glisten_front::builtin::{BuiltinVariable, functions};
use glisten_front::compiler::{Compilation, Compiler, Source};
use glisten_front::hir::{ExprKind, Shader, Stage, Storage};
use glisten_front::link::{Program, UniformRoot};
use glisten_front::source::SourceMap;
use std::collections::BTreeSet;

/// The new texts of the sources of a program, in their order.
///
/// # Errors
/// The reason why a source cannot be rewritten.
pub fn to_vulkan(compiler: &Compiler, sources: &[Source]) -> Result<Vec<String>, String> {
    let compilation = compiler.compile(sources);
    let Some(program) = compilation.program.as_ref().filter(|_| !compilation.diagnostics.has_errors()) else {
        return Err("the sources have errors".to_owned());
    };
    if program.stage(Stage::Geometry).is_some() {
        return Err("a geometry stage is not rewritten for Vulkan".to_owned());
    }
    if sources.iter().any(|one| sources.iter().filter(|other| other.stage == one.stage).count() > 1) {
        return Err("several sources of one stage are not rewritten for Vulkan".to_owned());
    }
    program.stages.iter().try_for_each(refuse)?;
    let names = used_names(sources);
    let parts: Vec<Part<'_>> =
        sources.iter().map(|source| part(&compilation, program, source)).collect::<Result<_, _>>()?;
    // Either every stage has all loose uniforms, or each has its own: blocks of one name are equal.
    let mut foreign = Vec::new();
    for part in &parts {
        foreign.push(foreign_lines(program, part)?);
    }
    let is_whole = foreign.iter().all(Option::is_some);
    let mut texts = Vec::new();
    for (part, foreign) in parts.iter().zip(foreign) {
        texts.push(rewritten(program, part, foreign.filter(|_| is_whole), &names)?);
    }
    check(compiler, sources, &texts, program)?;
    Ok(texts)
}

/// Refuses what no edit says in Vulkan's terms.
fn refuse(shader: &Shader) -> Result<(), String> {
    let known = shader.functions.iter().find(|one| functions::is_known_for_vulkan(&one.name));
    if let Some(function) = known {
        return Err(format!("the function `{}` has the name of a built-in one; rename it", function.name));
    }
    let called = shader.exprs.iter().filter_map(|expr| match expr.kind {
        ExprKind::BuiltinCall(function, _) => Some(function.name()),
        _ => None,
    });
    if let Some(name) = called.into_iter().find(|name| name.starts_with("noise")) {
        return Err(format!("Vulkan has no `{name}`"));
    }
    let depth_range = Some(BuiltinVariable::DepthRange);
    if shader.globals.iter().any(|global| global.builtin == depth_range && global.used) {
        return Err("Vulkan has no `gl_DepthRange`".to_owned());
    }
    Ok(())
}

fn used_names(sources: &[Source]) -> BTreeSet<String> {
    sources.iter().flat_map(|source| tokens(&source.text)).map(|token| token.text.to_owned()).collect()
}

/// A name that occurs in no text.
fn free(names: &BTreeSet<String>, wanted: &str) -> String {
    let mut name = wanted.to_owned();
    while names.contains(&name) {
        name.push('0');
    }
    name
}

/// A source that is rewritten.
struct Part<'a> {
    source: &'a Source,
    chunks: Chunks<'a>,
    sources: &'a SourceMap,
    shader: &'a Shader,
    base: u32,
}

impl Part<'_> {
    fn text<'t>(&'t self, program: &'t Program) -> Text<'t> {
        let (chunks, sources, shader) = (&self.chunks, self.sources, self.shader);
        Text { chunks, sources, program, shader, base: self.base, name: &self.source.name }
    }
}

fn part<'a>(compilation: &'a Compilation, program: &'a Program, source: &'a Source) -> Result<Part<'a>, String> {
    let Some(shader) = program.stage(source.stage) else { return Err("a stage is missing".to_owned()) };
    let own = compilation.sources.files().find(|(_, file)| file.name() == source.name && **file.text() == *source.text);
    let Some((_, file)) = own else { return Err(format!("the text of `{}` was not read", source.name)) };
    Ok(Part { source, chunks: Chunks::new(&source.text), sources: &compilation.sources, shader, base: file.base() })
}

fn rewritten(
    program: &Program,
    part: &Part<'_>,
    foreign: Option<Lines>,
    names: &BTreeSet<String>,
) -> Result<String, String> {
    let (source, shader, text) = (part.source, part.shader, part.text(program));
    let loose = text.loose()?;
    let height = program.interface.framebuffer_height.map(|_| free(names, "framebufferHeight"));
    let frag_coord = coordinates::needs_height(shader).then(|| free(names, "fragCoord"));
    // Of several insertions at one place, the first comes first.
    let heights = (height.as_deref(), frag_coord.as_deref());
    let mut edits: Vec<Edit> = block(program, part, &loose, (foreign, names), heights).into_iter().collect();
    edits.extend(text.layouts()?);
    edits.extend(loose.edits);
    edits.extend(coordinates::words(&part.chunks, shader, frag_coord.as_deref()));
    if source.stage == Stage::Vertex {
        let name = free(names, "openglMain");
        let Some(main) = coordinates::main(&part.chunks, shader, &name) else {
            return Err(format!("`main` is not defined in `{}` itself", source.name));
        };
        edits.extend(main);
    }
    Ok(applied(&source.text, edits))
}

/// Lines of the block with their offsets.
type Lines = Vec<(u32, Vec<String>)>;

/// The members that only the other stage declares; `None` if a name means something else here, or a struct is missing. A stage
/// without a block needs none.
fn foreign_lines(program: &Program, part: &Part<'_>) -> Result<Option<Lines>, String> {
    let loose = part.text(program).loose()?;
    if loose.lines.is_empty() && !coordinates::needs_height(part.shader) {
        return Ok(Some(Lines::new()));
    }
    let mut own: BTreeSet<&str> = part.chunks.all.iter().map(|token| token.text).collect();
    own.extend(part.shader.globals.iter().map(|global| global.name.as_str()));
    own.extend(part.shader.functions.iter().map(|function| function.name.as_str()));
    let roots = program.interface.roots.iter();
    let others = roots.filter(|root| root.block.is_none() && !loose.names.contains(&root.name));
    let line = |root: &UniformRoot| {
        let is_free = !own.contains(root.name.as_str()) && functions::named(&root.name).is_empty();
        let ty = plain_type(&program.types, root.ty).filter(|_| is_free)?;
        Some((root.offset, vec![format!("layout(offset = {}) {ty} {};", root.offset, root.name)]))
    };
    Ok(others.map(line).collect())
}

/// The block of the loose uniforms, with those of the other stage where nothing speaks against it, and the framebuffer's height.
fn block(
    program: &Program,
    part: &Part<'_>,
    loose: &Loose,
    (foreign, names): (Option<Lines>, &BTreeSet<String>),
    (height, frag_coord): (Option<&str>, Option<&str>),
) -> Option<Edit> {
    let (slot, _) = program.interface.loose?;
    if loose.lines.is_empty() && frag_coord.is_none() {
        return None;
    }
    let wanted = match part.shader.stage {
        _ if foreign.is_some() => "Uniforms",
        Stage::Vertex => "VertexUniforms",
        _ => "FragmentUniforms",
    };
    let is_whole = foreign.is_some();
    let mut lines: Lines = loose.lines.iter().cloned().chain(foreign.into_iter().flatten()).collect();
    if let (Some(height), Some(offset)) =
        (height.filter(|_| is_whole || frag_coord.is_some()), program.interface.framebuffer_height)
    {
        lines.push((offset, vec![format!("layout(offset = {offset}) float {height};")]));
    }
    lines.sort_by_key(|(offset, _)| *offset);
    let body: String = lines.iter().flat_map(|(_, lines)| lines).map(|line| format!("    {line}\n")).collect();
    let head =
        format!("layout(std140, set = {}, binding = {}) uniform {}", slot.group, slot.binding, free(names, wanted));
    let turned = frag_coord.zip(height).map_or_else(String::new, |(name, height)| {
        format!("vec4 {name} = vec4(gl_FragCoord.x, {height} - gl_FragCoord.y, gl_FragCoord.zw);\n")
    });
    let place = loose.place.unwrap_or_else(|| first_code_of(&part.source.text));
    Some((place..place, format!("{head} {{\n{body}}};\n{turned}")))
}

/// Compiles the new texts as OpenGL's, without their sets, and compares the interfaces.
fn check(compiler: &Compiler, sources: &[Source], texts: &[String], old: &Program) -> Result<(), String> {
    let plain = |(source, text): (&Source, &String)| Source { text: without_sets(text).into(), ..source.clone() };
    let compilation = compiler.compile(&sources.iter().zip(texts).map(plain).collect::<Vec<_>>());
    if let Some(error) = compilation.diagnostics.iter().find(|found| found.is_error()) {
        return Err(format!("the new text is not valid: {}", error.message));
    }
    let Some(new) = &compilation.program else { return Err("the new text is not valid".to_owned()) };
    let loose = new.interface.roots.iter().find(|root| root.block.is_none());
    if let Some(root) = loose {
        return Err(format!("the uniform `{}` is still outside of blocks", root.name));
    }
    let lacks = new.stages.iter().flat_map(|shader| &shader.globals).find(|global| {
        let crosses = matches!(global.storage, Storage::In | Storage::Out) && global.builtin.is_none();
        crosses && global.block.is_none() && global.location.is_none()
    });
    if let Some(global) = lacks {
        return Err(format!("`{}` has no location", global.name));
    }
    let moved = old.interface.uniforms.iter().filter(|leaf| leaf.active).find(|leaf| {
        let same = |other: &&glisten_front::link::UniformLeaf| other.name == leaf.name;
        new.interface.uniforms.iter().find(same).is_none_or(|other| other.offset != leaf.offset)
    });
    moved.map_or(Ok(()), |leaf| Err(format!("the uniform `{}` is at another offset", leaf.name)))
}

/// A text for Vulkan as OpenGL reads it: without sets, and with the names of indices.
fn without_sets(text: &str) -> String {
    let all = tokens(text);
    let mut edits: Vec<Edit> = Vec::new();
    for (index, token) in all.iter().enumerate() {
        let at = |offset: usize| all.get(index + offset).map_or("", |token| token.text);
        if token.text == "set" && at(1) == "=" && at(3) == "," {
            let end = all.get(index + 3).map_or(token.range.end, |comma| comma.range.end);
            edits.push((token.range.start..end, String::new()));
        } else if let Some(old) = coordinates::old_name(token.text) {
            edits.push((token.range.clone(), old.to_owned()));
        }
    }
    applied(text, edits)
}
