//! Which strings are GLSL, and of which stage.
//!
//! *In:* a string and what is around it. *Out:* a [`Shader`], or nothing. *Holds:* a string counts if a tag or a comment says `glsl`
//! (`/* glsl */`, `` glsl`..` ``, `R"glsl(..)glsl"`, `# glsl`), or if it shows it: a `#version` line, or a `main` and words that only
//! GLSL has. What a shader writes tells its stage, then its name, then the call that takes it.

use super::scan::Literal;
use super::{Hole, Shader};
use crate::engines::code::{count_definitions, tail, without_comments, words};
use glisten_front::Stage;
use glisten_front::source::version_line;
use std::ops::Range;

/// The largest length of what is looked at before a string.
const MAX_BEFORE: usize = 300;

/// Words of tags, comments, names and calls that tell a stage.
static STAGES: &[(&str, Stage)] = &[
    ("vertex", Stage::Vertex),
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vsh", Stage::Vertex),
    ("fragment", Stage::Fragment),
    ("frag", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fsh", Stage::Fragment),
    ("pixel", Stage::Fragment),
    ("ps", Stage::Fragment),
    ("geometry", Stage::Geometry),
    ("geom", Stage::Geometry),
    ("gs", Stage::Geometry),
];
/// Words of names that say nothing.
const FILLERS: &[&str] = &["shader", "source", "src", "glsl", "code", "text", "str", "string", "template"];
/// Words of tags and comments that say that a string is GLSL.
const TAGS: &[&str] = &["glsl", "glslify", "shader", "vert", "frag", "vertex", "fragment"];
/// Names that a stage alone has.
static OWN: &[(&str, Stage)] = &[
    ("EmitVertex", Stage::Geometry),
    ("gl_Position", Stage::Vertex),
    ("gl_PointSize", Stage::Vertex),
    ("gl_FragColor", Stage::Fragment),
    ("gl_FragData", Stage::Fragment),
    ("gl_FragCoord", Stage::Fragment),
    ("gl_FragDepth", Stage::Fragment),
    ("gl_PointCoord", Stage::Fragment),
    ("gl_FrontFacing", Stage::Fragment),
    ("discard", Stage::Fragment),
    ("dFdx", Stage::Fragment),
    ("dFdy", Stage::Fragment),
    ("fwidth", Stage::Fragment),
];
/// Words that C and its like do not have.
const OF_GLSL: &[&str] = &[
    "uniform",
    "varying",
    "attribute",
    "vec2",
    "vec3",
    "vec4",
    "mat3",
    "mat4",
    "sampler2D",
    "precision",
    "texture2D",
    "gl_Position",
    "gl_FragColor",
];
/// Calls on a string that make another one of it.
const MAKERS: &[&str] = &[".replace(", ".replaceAll(", ".split("];
/// Words of shaders that glisten does not read, and of other documents: of pages, and of programs and texts with shaders in them.
const FOREIGN: &[&str] = &[
    "local_size_x",
    "gl_GlobalInvocationID",
    "gl_TessCoord",
    "gl_TessLevelOuter",
    "</script",
    "</html",
    "\"\"\"",
    "'''",
    "```",
];

/// The shader of a string.
pub(super) fn shader(text: &str, literal: &Literal) -> Option<Shader> {
    let inside = text.get(literal.inside.clone())?;
    let has_escapes = !literal.escapes.is_empty();
    let decoded = has_escapes.then(|| super::text::decoded(inside, literal.inside.start, &literal.escapes));
    let inside = decoded.as_deref().unwrap_or(inside);
    let before = tail(text.get(..literal.start)?, MAX_BEFORE);
    let (before, comment) = last_comment(before);
    let tag = parts_of(&literal.tag);
    let said = parts_of(comment);
    let is_told = tag.iter().any(|word| TAGS.contains(&word.as_str())) || said.iter().any(|word| word == "glsl");
    let code = without_comments(inside);
    // The text is made when the program runs.
    let is_made = text.get(literal.inside.end..).is_some_and(|after| {
        let after = after.trim_start_matches(['`', '"', '\'']).trim_start();
        MAKERS.iter().any(|call| after.starts_with(call))
    });
    let is_foreign =
        is_made || FOREIGN.iter().any(|word| code.contains(word)) || said.iter().any(|word| word == "wgsl");
    if is_foreign || !(is_told || !literal.is_tagged && shows(&code)) {
        return None;
    }
    let name = name(before);
    let parts = parts_of(name);
    let own = || OWN.iter().find(|(word, _)| has(&code, word)).map(|(_, stage)| *stage);
    let called = || parts_of(segment(before)).iter().rev().find_map(|word| stage_of(word));
    let is_whole = count_definitions(&code, "main") > 0;
    let told = || [&said, &tag].into_iter().find_map(|words| words.iter().find_map(|word| stage_of(word)));
    // `GEOMETRY_PASS_FS` is of a pass for geometry: the last word counts.
    let stated = told().or_else(|| parts.iter().rev().find_map(|word| stage_of(word)));
    let stage = if is_whole { own().or(stated) } else { stated.or_else(own) };
    let stage = stage.or_else(called).unwrap_or(Stage::Fragment);
    let stem: Vec<String> =
        parts.into_iter().filter(|word| stage_of(word).is_none() && !FILLERS.contains(&word.as_str())).collect();
    Some(Shader {
        stage,
        inside: literal.inside.clone(),
        is_whole,
        is_joined: literal.is_joined,
        escapes: literal.escapes.clone(),
        holes: literal.holes.iter().map(|range| hole(text, literal, range.clone())).collect(),
        place: (literal.owner, stem.join(" ")),
    })
}

fn hole(text: &str, literal: &Literal, range: Range<usize>) -> Hole {
    let before = text.get(literal.inside.start..range.start).unwrap_or("");
    let after = text.get(range.end..literal.inside.end).unwrap_or("");
    let before = before.rsplit('\n').next().unwrap_or("");
    let after = after.split('\n').next().unwrap_or("");
    let is_blank = |text: &str| text.trim().trim_end_matches(';').is_empty();
    Hole { range, is_alone: is_blank(before) && is_blank(after) }
}

fn has(code: &str, word: &str) -> bool {
    words(code).any(|(_, other)| other == word)
}

/// Whether a text without comments shows that it is GLSL.
fn shows(code: &str) -> bool {
    let says_version = version_line(code)
        .and_then(|line| code.get(line))
        .is_some_and(|line| line.contains(|letter: char| letter.is_ascii_digit() || letter == '$' || letter == '{'));
    if says_version && code.trim_start().starts_with('#') {
        return true;
    }
    count_definitions(code, "main") > 0 && words(code).any(|(_, word)| OF_GLSL.contains(&word))
}

fn stage_of(word: &str) -> Option<Stage> {
    STAGES.iter().find(|(known, _)| *known == word).map(|(_, stage)| *stage)
}

/// The text before a comment at its end, and the comment.
fn last_comment(before: &str) -> (&str, &str) {
    let trimmed = before.trim_end().trim_end_matches('(').trim_end();
    if let Some(open) = trimmed.strip_suffix("*/").and_then(|rest| rest.rfind("/*")) {
        return trimmed.split_at(open);
    }
    let line = trimmed.rfind('\n').map_or(0, |end| end + 1);
    let is_only = |sign: &str| trimmed.get(line..).is_some_and(|line| line.trim_start().starts_with(sign));
    if is_only("//") || is_only("#") && !is_only("#[") {
        return trimmed.split_at(line);
    }
    (before, "")
}

/// The part of the text before a string that belongs to it: since the last statement.
fn segment(before: &str) -> &str {
    before.get(before.rfind([';', '}']).map_or(0, |end| end + 1)..).unwrap_or("")
}

/// The name that a string gets: of a constant, a field, a parameter, a variable that is made of it.
fn name(before: &str) -> &str {
    let whole = before.trim_end();
    let inner = whole.get(whole.rfind([';', '{', '}', ',', '(']).map_or(0, |end| end + 1)..).unwrap_or("");
    let is_named = inner.find([':', '=']).filter(|_| !inner.trim_start().starts_with("=>"));
    let named = match is_named {
        Some(end) => inner.get(..end).unwrap_or(""),
        None if inner.trim().is_empty() => whole.trim_end_matches(['(', '{']),
        None => return "",
    };
    let named = named.trim_end().trim_end_matches(['"', '\'', ']', '[', '?']);
    let start = named.trim_end_matches(|letter: char| letter.is_ascii_alphanumeric() || letter == '_').len();
    named.get(start..).unwrap_or("")
}

/// The words of a name, in small letters: `waterVertexShader`, `WATER_VERTEX`, `water-vertex`.
fn parts_of(name: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    let mut was_small = false;
    for letter in name.chars() {
        let begins = letter.is_ascii_uppercase() && was_small || parts.is_empty();
        if !letter.is_ascii_alphanumeric() {
            parts.push(String::new());
        } else {
            if begins {
                parts.push(String::new());
            }
            if let Some(part) = parts.last_mut() {
                part.push(letter.to_ascii_lowercase());
            }
        }
        was_small = letter.is_ascii_lowercase() || letter.is_ascii_digit();
    }
    parts.retain(|part| !part.is_empty());
    parts
}
