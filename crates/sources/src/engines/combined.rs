//! Files that contain several stages, and how they are taken apart.
//!
//! *In:* a text. *Out:* the programs in it, each with its stages: for each stage, what of the text is not its own, and the macro
//! that selects it. *Holds:* a stage's text has the length and the lines of the file, so that positions are those of the file.

use super::part::{Member, Part};
use super::{conditional, marks, modules, sokol};

/// The programs of a file that contains several stages; none for a file that is one shader.
pub fn members(text: &str) -> Vec<Member> {
    // Almost every text is refused by these words.
    if !["#", "@", "--", "[", "`"].iter().any(|sign| text.contains(sign)) {
        return Vec::new();
    }
    let found = sokol::members(text);
    if !found.is_empty() {
        return found;
    }
    // GLSL has no backquotes outside of comments.
    let parts = if text.contains('`') { modules::parts(text) } else { None };
    let parts = parts.or_else(|| marks::parts(text)).or_else(|| conditional::parts(text));
    parts.into_iter().map(|parts| Member { name: None, parts: in_order(parts) }).collect()
}

fn in_order(mut parts: Vec<Part>) -> Vec<Part> {
    parts.sort_by_key(|part| part.stage);
    parts
}
