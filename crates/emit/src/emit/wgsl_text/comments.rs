//! Carries comments over: those at the beginning of the file (titles, licenses), those above functions and structs, those
//! next to members, uniforms and globals.
//!
//! *In:* tidied text, and the source. *Out:* the text with comments. *Holds:* a comment of GLSL is a comment of WGSL:
//! blocks nest there (WGSL §3.5), and more characters end a line (§3.4).

use glisten_front::hir::{Shader, Storage, Type, Types};
use glisten_front::source::{FileId, SourceMap, Span, comments};
use std::collections::{BTreeMap, BTreeSet};

/// A comment above something, and one behind it.
#[derive(Default)]
struct Beside {
    above: Vec<String>,
    behind: Option<String>,
}

/// The comments by what they belong to: `function f`, `struct S`, `S.member`, `variable v`.
type Notes = BTreeMap<String, Beside>;

/// The first lines of an emitted text: where it comes from, and the comments at the beginning of the source.
pub(in crate::emit) fn header(shader: &Shader, sources: &SourceMap) -> Option<String> {
    let entry = sources.file_of(shader.anchor())?;
    let file = sources.file(entry);
    let names: Vec<String> = files_of(shader, entry, sources).iter().map(|name| plain_name(name)).collect();
    let (names, version) = (names.join(", "), env!("CARGO_PKG_VERSION"));
    let mut lines = vec![format!("// {names}, translated by glisten {version} (source {:016x})", hash(shader))];
    let leading = comments::leading(file.text());
    if !leading.is_empty() {
        lines.push("//".to_owned());
        lines.extend(of_wgsl(&leading));
    }
    Some(lines.iter().map(|line| format!("{}\n", line.trim_end())).collect::<String>() + "\n")
}

/// The names of the files that a stage has something from, its own first.
fn files_of<'s>(shader: &Shader, entry: FileId, sources: &'s SourceMap) -> Vec<&'s str> {
    let functions = shader.functions.iter().map(|function| function.span);
    let spans = functions.chain(shader.globals.iter().map(|global| global.span));
    let found: BTreeSet<FileId> =
        spans.filter(|span| span.is_known()).filter_map(|span| sources.file_of(span)).collect();
    let own = sources
        .files()
        .filter(|(id, file)| *id != entry && found.contains(id) && file.name() != SourceMap::COMMAND_LINE);
    [sources.file(entry).name()].into_iter().chain(own.map(|(_, file)| file.name())).collect()
}

/// The name of a file without its folder.
fn plain_name(path: &str) -> String {
    let name = path.rsplit(['/', '\\']).next().unwrap_or("");
    name.chars().map(|character| if ends_line(character) { ' ' } else { character }).collect()
}

/// Whether a character ends a line in WGSL, or has no place in a text.
fn ends_line(character: char) -> bool {
    character.is_control() || matches!(character, '\u{2028}' | '\u{2029}')
}

/// The FNV-1a hash of a stage's text, with all that it includes.
fn hash(shader: &Shader) -> u64 {
    let bytes = shader.texts.iter().flat_map(|text| text.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Comments as WGSL reads them: without characters that end a line there, and blocks only if they end where they do in
/// GLSL, where they do not nest.
fn of_wgsl(lines: &[String]) -> Vec<String> {
    let clean = |line: &String| -> String {
        line.chars().map(|character| if ends_line(character) { ' ' } else { character }).collect()
    };
    let lines: Vec<String> = lines.iter().map(clean).collect();
    let all = lines.join("\n");
    let nests = all.matches("/*").count() != all.matches("*/").count() || all.contains("/*/");
    let mixes =
        lines.iter().any(|line| line.trim_start().starts_with("//") && (line.contains("/*") || line.contains("*/")));
    if !nests && !mixes {
        return lines;
    }
    let plain = |line: &String| {
        let text = line.replace("/*", " ").replace("*/", " ");
        format!("// {}", text.trim().trim_start_matches('/').trim())
    };
    lines.iter().map(plain).collect()
}

/// The text with the comments of the source.
pub(in crate::emit) fn commented(text: &str, types: &Types, shader: &Shader, sources: &SourceMap) -> String {
    let notes = notes(types, shader, sources);
    let mut result = String::with_capacity(text.len());
    let mut structure: Option<String> = None;
    for line in text.lines() {
        let key = key_of(line, structure.as_deref(), shader);
        if let Some(name) = line.strip_prefix("struct ").and_then(|rest| rest.strip_suffix(" {")) {
            structure = Some(name.to_owned());
        } else if line == "}" {
            structure = None;
        }
        let Some(beside) = key.and_then(|key| notes.get(&key)) else {
            result.push_str(line);
            result.push('\n');
            continue;
        };
        let indent = &line[..line.len() - line.trim_start().len()];
        // An attribute of the function precedes it.
        let at = ["@fragment\n", "@vertex\n"].iter().find(|attribute| result.ends_with(*attribute));
        let at = result.len() - at.map_or(0, |attribute| attribute.len());
        let above: String = of_wgsl(&beside.above).iter().map(|comment| format!("{indent}{comment}\n")).collect();
        result.insert_str(at, &above);
        result.push_str(line);
        if let Some(behind) = &beside.behind {
            let behind = of_wgsl(std::slice::from_ref(behind)).concat();
            result.push_str("  ");
            result.push_str(behind.trim_end());
        }
        result.push('\n');
    }
    result
}

/// The name of what a line declares.
fn key_of(line: &str, structure: Option<&str>, shader: &Shader) -> Option<String> {
    if let Some(rest) = line.strip_prefix("fn ") {
        let name = rest.split_once('(')?.0;
        return Some(format!("function {name}"));
    }
    if let Some(rest) = line.strip_prefix("struct ") {
        return Some(format!("struct {}", rest.strip_suffix(" {")?));
    }
    let name_of = |text: &str| text.split_once(':').map(|(name, _)| name.trim().to_owned());
    if let Some(structure) = structure {
        let name = name_of(line.trim_start())?;
        // Loose uniforms are members of one struct, which the source does not have.
        let loose = structure == "Uniforms" && line.starts_with("    ");
        let is_global = |name: &str| shader.globals.iter().any(|global| global.name == name && global.block.is_none());
        return Some(match loose && is_global(&name) {
            true => format!("variable {name}"),
            false => format!("{structure}.{name}"),
        });
    }
    if line.starts_with("var") || line.starts_with("@group(") {
        let declaration = line.split_once("var")?.1;
        let declaration =
            declaration.split_once('>').filter(|_| declaration.starts_with('<')).map_or(declaration, |d| d.1);
        return Some(format!("variable {}", name_of(declaration)?));
    }
    if line.starts_with("const ") {
        return Some(format!("variable {}", name_of(line.strip_prefix("const ")?)?));
    }
    // A parameter of the entry point, on a line of its own.
    let parameter = line.strip_prefix("    @location(")?;
    let name = name_of(parameter.rsplit_once(") ").map_or(parameter, |(_, name)| name))?;
    Some(format!("variable {name}"))
}

/// The comments of a stage.
fn notes(types: &Types, shader: &Shader, sources: &SourceMap) -> Notes {
    let mut notes = Notes::new();
    let mut add = |key: String, span: Span, behind: bool| {
        let beside = Beside {
            above: comments::above_but_not_leading(sources, span),
            behind: behind.then(|| comments::behind(sources, span)).flatten(),
        };
        if !beside.above.is_empty() || beside.behind.is_some() {
            notes.entry(key).or_insert(beside);
        }
    };
    for function in &shader.functions {
        add(format!("function {}", function.name), function.span, false);
    }
    for global in shader.globals.iter().filter(|global| global.builtin.is_none()) {
        let key = match &global.block {
            Some(block) => format!("struct {}", block.name),
            None => format!("variable {}", global.name),
        };
        let declares = matches!(global.storage, Storage::Uniform | Storage::Private | Storage::Const | Storage::In);
        add(key, global.span, global.block.is_none() && declares);
    }
    for id in types.ids() {
        let Type::Struct(id) = types.get(id) else { continue };
        let structure = types.structure(id);
        if !structure.is_block {
            add(format!("struct {}", structure.name), structure.span, false);
        }
        for member in &structure.members {
            add(format!("{}.{}", structure.name, member.name), member.span, true);
        }
    }
    notes
}
