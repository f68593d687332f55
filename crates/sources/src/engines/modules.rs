//! Modules of JavaScript whose constants `vertex` and `fragment` are shaders, as those of three.js.
//!
//! *In:* a text. *Out:* a part for each stage: the text between the backquotes. *Holds:* a text with `${` in it is put together
//! when the module runs, and is left alone.

use super::code::tail;
use super::part::Part;
use super::profile::stage_named;
use glisten_front::Stage;
use std::ops::Range;

/// The largest length of what is between a name and its text.
const MAX_LOOK_BACK: usize = 256;

/// The constant that begins at a backquote: the last name before a `=`.
fn name_before(text: &str) -> Option<&str> {
    // A comment such as `/* glsl */` may be between.
    let before = tail(text, MAX_LOOK_BACK).trim_end();
    let comment = before.strip_suffix("*/").and_then(|rest| rest.rfind("/*"));
    let before = comment.and_then(|at| before.get(..at)).unwrap_or(before);
    let before = before.trim_end().strip_suffix('=')?.trim_end();
    before.rsplit(|sign: char| !sign.is_ascii_alphanumeric() && sign != '_').next()
}

/// The texts in backquotes that are shaders.
fn templates(text: &str) -> Vec<(Stage, Range<usize>)> {
    let mut found: Vec<(Stage, Range<usize>)> = Vec::new();
    let mut at = 0;
    while let Some(open) = text.get(at..).and_then(|rest| rest.find('`')).map(|open| at + open) {
        let Some(length) = text.get(open + 1..).and_then(|rest| rest.find('`')) else { break };
        let inside = open + 1..open + 1 + length;
        at = inside.end + 1;
        let name = text.get(..open).and_then(name_before);
        let stage = name.and_then(|name| stage_named(name.trim_end_matches("Shader")));
        let is_whole = text.get(inside.clone()).is_some_and(|inside| !inside.contains("${"));
        if let Some(stage) = stage.filter(|stage| is_whole && found.iter().all(|(other, _)| other != stage)) {
            found.push((stage, inside));
        }
    }
    found
}

/// The parts of a module of JavaScript.
pub(super) fn parts(text: &str) -> Option<Vec<Part>> {
    let found = templates(text);
    let part = |(stage, inside): (Stage, Range<usize>)| {
        let others = vec![0..inside.start, inside.end..text.len()];
        Part { stage, others, defines: Vec::new() }
    };
    (!found.is_empty()).then(|| found.into_iter().map(part).collect())
}

#[cfg(test)]
mod tests {
    use super::parts;

    #[test]
    fn constants_are_stages() {
        let text = "export const vertex = /* glsl */`\nV\n`;\nexport const fragment = `F`; const other = `O`;";
        let texts: Vec<String> =
            parts(text).unwrap_or_default().iter().map(|part| part.text(text).trim().to_owned()).collect();
        assert_eq!(texts, ["V", "F"]);
        assert!(parts("const fragment = `${ a }`;").is_none() && parts("const fragment = `").is_none());
        assert!(parts("`").is_none() && parts("*/`` = ``").is_none());
    }
}
