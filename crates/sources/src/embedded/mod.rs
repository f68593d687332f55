//! Shaders in the strings of other languages: JavaScript, TypeScript, Rust, Python, C and C++.
//!
//! *In:* the text of a file. *Out:* [`Program`]s, each with its [`Shader`]s; the text of a shader with everything else blank.
//!
//! ```text
//!  file ──► scan ──────► choose ──────────► pair ──────► programs
//!           literals     which are GLSL,    by place
//!                        their stages       and name
//! ```
//!
//! *Holds:* a shader's text has the length of the file, and each of its bytes is where it is in the file, whatever escapes and
//! interpolations there are: positions need no translation. What an interpolation brings is unknown: [`doubt`] tells which findings
//! depend on it. Host languages are only scanned: a string that a program puts together at run time is none.

mod choose;
pub mod doubt;
mod macros;
mod pair;
mod scan;
mod style;
mod text;

pub use macros::has_unread_macros;
pub use style::styled;
pub use text::Filling;

use glisten_front::Stage;
use std::ops::Range;
use std::path::Path;

/// The languages whose strings are looked at, by what their strings are like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Host {
    /// JavaScript and TypeScript: template strings.
    Script,
    /// Rust: strings of several lines, raw or not.
    Rust,
    /// Python: strings in three quotes.
    Python,
    /// C and C++: raw strings, and strings that follow each other.
    C,
}

/// The extensions of the languages.
static EXTENSIONS: &[(Host, &[&str])] = &[
    (Host::Script, &["js", "mjs", "cjs", "jsx", "ts", "mts", "cts", "tsx", "vue", "svelte"]),
    (Host::Rust, &["rs"]),
    (Host::Python, &["py", "pyw", "pyi"]),
    (Host::C, &["c", "cc", "cpp", "cxx", "h", "hh", "hpp", "hxx", "inl", "ipp", "m", "mm", "cu"]),
];

impl Host {
    /// The language of a file, by its name.
    pub fn of(path: &Path) -> Option<Self> {
        // Such a module is a shader of several stages, with or without this.
        if path.file_name()?.to_string_lossy().ends_with(".glsl.js") {
            return None;
        }
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        EXTENSIONS.iter().find(|(_, all)| all.contains(&extension.as_str())).map(|(host, _)| *host)
    }
}

/// An escape of a string, or a part of it that stands for something else.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Escape {
    range: Range<usize>,
    /// The character, if it is one of ASCII.
    means: Option<u8>,
}

/// An interpolation: a place whose text is known when the program runs.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Hole {
    range: Range<usize>,
    /// Whether nothing else is on its lines, so that it may bring statements or declarations.
    is_alone: bool,
}

/// A shader in a string.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shader {
    /// Its stage.
    pub stage: Stage,
    /// The inside of the string.
    pub inside: Range<usize>,
    /// Whether it has a `main`. Others are pieces, which lack what is put before them.
    pub(crate) is_whole: bool,
    /// Whether the string is made of strings that follow each other, so that a line of it is none of the file.
    is_joined: bool,
    escapes: Vec<Escape>,
    holes: Vec<Hole>,
    /// The bracket of the host that it is in, and its name there without the stage.
    place: (usize, String),
}

/// Shaders that form a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Program {
    /// Its shaders, in the order of the pipeline.
    pub shaders: Vec<Shader>,
    /// The engine that completes them, if the file shows one.
    pub engine: Option<&'static str>,
    /// The version of those without a `#version` line, if the language of the host says more than GLSL does.
    pub version: Option<&'static str>,
}

impl Program {
    /// The shader of a stage.
    pub fn shader(&self, stage: Stage) -> Option<&Shader> {
        self.shaders.iter().find(|shader| shader.stage == stage)
    }

    /// Whether a text of the program is known only when the host runs.
    pub(crate) fn has_holes(&self) -> bool {
        self.shaders.iter().any(|shader| !shader.holes.is_empty())
    }

    /// Whether something has to stand for an interpolation, so that several fillings differ.
    pub fn is_unsure(&self) -> bool {
        self.shaders.iter().flat_map(|shader| &shader.holes).any(|hole| !hole.is_alone)
    }
}

/// The programs in the strings of a file, in the order of their first strings.
pub fn programs(host: Host, text: &str) -> Vec<Program> {
    // Almost every file of a host is refused by these words.
    if !["#version", "void", "glsl", "GLSL"].iter().any(|word| text.contains(word)) {
        return Vec::new();
    }
    let literals = scan::literals(host, text);
    let shaders = literals.iter().filter_map(|literal| choose::shader(text, literal)).collect();
    pair::programs(host, text, shaders)
}

#[cfg(test)]
mod tests;
