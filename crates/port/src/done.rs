//! [`done`]: what was done to a text, in sentences.
//!
//! *In:* the old and the new text. *Out:* sentences. *Holds:* they are found by comparing the texts, so they say what is there.

use glisten_front::source::version_line;
use std::collections::BTreeSet;

/// Sentences about the changes of a text.
pub fn done(old: &str, new: &str) -> Vec<String> {
    let mut found = Vec::new();
    let version = |text: &str| version_line(text).and_then(|range| text.get(range)).map(|line| line.trim().to_owned());
    match (version(old), version(new)) {
        (Some(before), Some(after)) if before != after => found.push(format!("`{before}` is `{after}`")),
        (None, Some(after)) => found.push(format!("`{after}` was added")),
        _ => {}
    }
    for (name, members) in blocks(new).into_iter().filter(|(name, _)| !blocks(old).iter().any(|(own, _)| own == name)) {
        let list: Vec<String> = members.iter().map(|(_, name)| format!("`{name}`")).collect();
        found.push(format!("the block `{name}` has the uniforms {}", list.join(", ")));
    }
    let includes = |text: &str| -> BTreeSet<String> {
        let lines = text.lines().map(str::trim);
        let is_include = |line: &&str| line.starts_with("#include") || line.starts_with("#moj_import");
        lines.filter(is_include).map(|line| line.split_whitespace().nth(1).unwrap_or("").to_owned()).collect()
    };
    for added in includes(new).difference(&includes(old)) {
        found.push(format!("includes `{added}`"));
    }
    let count =
        |text: &str, word: &str| glisten_sources::engines::code::words(text).filter(|(_, one)| *one == word).count();
    static WORDS: &[(&str, &str)] = &[
        ("attribute", "`attribute` is `in`"),
        ("varying", "`varying` is `in` or `out`"),
        ("texture2D", "`texture2D` is `texture`"),
        ("textureCube", "`textureCube` is `texture`"),
        ("shadow2D", "`shadow2D` is `texture`"),
        ("gl_FragColor", "`gl_FragColor` is a declared output"),
        ("gl_FragData", "`gl_FragData` is a declared output"),
        ("gl_VertexID", "`gl_VertexID` is `gl_VertexIndex`"),
        ("gl_InstanceID", "`gl_InstanceID` is `gl_InstanceIndex`"),
        ("ftransform", "`ftransform()` is a product"),
        ("moj_import", "`#moj_import` is `#include`"),
    ];
    found.extend(
        WORDS.iter().filter(|(word, _)| count(old, word) > count(new, word)).map(|(_, text)| (*text).to_owned()),
    );
    let n_new_blocks = blocks(new).len().saturating_sub(blocks(old).len());
    let n_layouts = layouts(new).saturating_sub(layouts(old) + n_new_blocks);
    if n_layouts > 0 {
        let (plural, have) = if n_layouts == 1 { ("", "has") } else { ("s", "have") };
        found.push(format!("{n_layouts} more declaration{plural} {have} a layout"));
    }
    static ADDED: &[(&str, &str)] = &[
        ("openglMain", "a new `main` converts clip-space z"),
        ("fragCoord", "`gl_FragCoord` is `fragCoord`, which counts from the bottom"),
    ];
    found.extend(
        ADDED.iter().filter(|(word, _)| count(new, word) > count(old, word)).map(|(_, text)| (*text).to_owned()),
    );
    if found.is_empty() && old != new {
        found.push(replaced(old, new));
    }
    found
}

/// The layouts outside of braces.
fn layouts(text: &str) -> usize {
    let code = glisten_sources::engines::code::without_comments(text);
    let (mut depth, mut outside) = (0_usize, String::new());
    for letter in code.chars() {
        match letter {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            _ if depth == 0 => outside.push(letter),
            _ => {}
        }
    }
    glisten_sources::engines::code::words(&outside).filter(|(_, word)| *word == "layout").count()
}

/// How many words a sentence names.
const MOST_WORDS: usize = 6;

/// The words that others replace.
fn replaced(old: &str, new: &str) -> String {
    let [before, after] = [old, new].map(glisten_sources::engines::code::without_comments);
    let [before, after] =
        [&before, &after].map(|text| glisten_sources::engines::code::words(text).map(|(_, word)| word));
    let pairs: BTreeSet<(&str, &str)> = before.zip(after).filter(|(before, after)| before != after).collect();
    if pairs.is_empty() || pairs.len() > MOST_WORDS {
        return "the text changed in other places".to_owned();
    }
    pairs.iter().map(|(before, after)| format!("`{before}` is `{after}`")).collect::<Vec<_>>().join(", ")
}

/// The uniform blocks of a text: the name of each, and its members with their types.
pub fn blocks(text: &str) -> Vec<(String, Vec<(String, String)>)> {
    let code = glisten_sources::engines::code::without_comments(text);
    let mut found = Vec::new();
    let mut rest: &str = &code;
    while let Some(at) = rest.find("uniform ") {
        rest = rest.get(at + "uniform ".len()..).unwrap_or("");
        let Some(open) =
            rest.find(['{', ';', '=']).filter(|open| rest.get(*open..).is_some_and(|rest| rest.starts_with('{')))
        else {
            continue;
        };
        let name = rest.get(..open).unwrap_or("").trim().to_owned();
        let body = rest.get(open + 1..).and_then(|rest| rest.split('}').next()).unwrap_or("");
        let lines: String =
            body.lines().filter(|line| !line.trim_start().starts_with('#')).collect::<Vec<_>>().join(" ");
        let member = |part: &str| {
            let part = part.trim();
            let part =
                part.strip_prefix("layout").map_or(part, |rest| rest.split_once(')').map_or(rest, |(_, rest)| rest));
            let (ty, name) = part.trim().rsplit_once(' ')?;
            Some((ty.trim().to_owned(), name.split('[').next().unwrap_or(name).to_owned()))
        };
        if !name.contains(char::is_whitespace) {
            found.push((name, lines.split(';').filter_map(member).collect()));
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::{blocks, done};

    #[test]
    fn sentences_say_what_changed() {
        let old = "#version 110\nvarying vec2 uv;\nuniform vec4 tint;\nvoid main() { gl_FragColor = tint; }\n";
        let new = "#version 330 core\nout vec4 fragColor;\nlayout(std140) uniform FragmentUniforms {\n    vec4 tint; // a color\n};\nin vec2 uv;\nvoid main() { fragColor = tint; }\n";
        let found = done(old, new);
        for part in [
            "`#version 110` is `#version 330 core`",
            "block `FragmentUniforms` has the uniforms `tint`",
            "`varying`",
            "`gl_FragColor`",
        ] {
            assert!(found.iter().any(|one| one.contains(part)), "{part}: {found:?}");
        }
        assert_eq!(done(old, old), Vec::<String>::new());
        let members = blocks(
            "layout(std140) uniform A {\n#ifdef X\n layout(offset = 0) mat4 m;\n#endif\n float k[2];\n} a;\nuniform sampler2D s;",
        );
        assert_eq!(
            members,
            [("A".to_owned(), vec![("mat4".to_owned(), "m".to_owned()), ("float".to_owned(), "k".to_owned())])]
        );
    }
}
