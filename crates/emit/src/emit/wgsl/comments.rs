//! Comments in WGSL's form, and the header of a text with the comments at the beginning of the file (titles, licenses).
//!
//! *Holds:* a comment of GLSL is a comment of WGSL: blocks nest there (WGSL §3.5), and more characters end a line (§3.4).

use glisten_front::hir::Shader;
use glisten_front::source::{FileId, SourceMap, comments};
use std::collections::BTreeSet;

/// The first lines of an emitted text: where it comes from, and the comments at the beginning of the sources.
pub(in crate::emit) fn header(shaders: &[&Shader], sources: &SourceMap) -> Option<String> {
    let mut names: Vec<String> = Vec::new();
    let mut leading: Vec<Vec<String>> = Vec::new();
    for shader in shaders {
        let entry = sources.file_of(shader.anchor())?;
        for name in files_of(shader, entry, sources).iter().map(|name| plain_name(name)) {
            if !names.contains(&name) {
                names.push(name);
            }
        }
        let own = comments::leading(sources.file(entry).text());
        // Both stages of a program often begin with the same license.
        if !own.is_empty() && !leading.contains(&own) {
            leading.push(own);
        }
    }
    let (names, version) = (names.join(", "), env!("CARGO_PKG_VERSION"));
    let mut lines = vec![format!("// {names}, translated by glisten {version} (source {:016x})", hash(shaders))];
    for leading in leading {
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

/// The FNV-1a hash of the text of stages, with all that it includes.
fn hash(shaders: &[&Shader]) -> u64 {
    let bytes = shaders.iter().flat_map(|shader| &shader.texts).flat_map(|text| text.bytes());
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Comments as WGSL reads them: without characters that end a line there, and blocks only if they end where they do in
/// GLSL, where they do not nest.
pub(super) fn of_wgsl(lines: &[String]) -> Vec<String> {
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
