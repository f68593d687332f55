//! The stage of a shader, by the name of its file.

use super::engines::code::{names_function, without_comments, words};
use super::engines::combined;
use glisten_front::hir::Stage;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

/// File extensions, with their stages.
static EXTENSIONS: &[(&str, Stage)] = &[
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vsh", Stage::Vertex),
    ("glslv", Stage::Vertex),
    ("frag", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fsh", Stage::Fragment),
    ("glslf", Stage::Fragment),
    ("geom", Stage::Geometry),
    ("gs", Stage::Geometry),
    ("gsh", Stage::Geometry),
    ("vp", Stage::Vertex),
    ("fp", Stage::Fragment),
    ("gp", Stage::Geometry),
];

/// Words that tell the stage: as an extension (`phong.vertex`), and before or after the name of a `.glsl` file, with a sign
/// between (`phong_vs.glsl`, `vs-phong.glsl`), as a word with a capital (`PhongVert.glsl`), or alone (`vs.glsl`). Those of two letters
/// are other things as extensions.
static WORDS: &[(&str, Stage)] = &[
    ("vertexshader", Stage::Vertex),
    ("vertex", Stage::Vertex),
    ("vert", Stage::Vertex),
    ("vs", Stage::Vertex),
    ("vp", Stage::Vertex),
    ("fragmentshader", Stage::Fragment),
    ("fragment", Stage::Fragment),
    ("frag", Stage::Fragment),
    ("pixel", Stage::Fragment),
    ("fs", Stage::Fragment),
    ("fp", Stage::Fragment),
    ("ps", Stage::Fragment),
    ("geometryshader", Stage::Geometry),
    ("geometry", Stage::Geometry),
    ("geom", Stage::Geometry),
    ("gs", Stage::Geometry),
    ("gp", Stage::Geometry),
];
/// Words of one letter, after the name of an `.sdr` file (`deferred-f.sdr`).
static LETTERS: &[(&str, Stage)] = &[("v", Stage::Vertex), ("f", Stage::Fragment), ("g", Stage::Geometry)];
/// The signs between such a word and the rest of a name.
const SIGNS: [char; 3] = ['_', '-', '.'];
/// The name of a program whose files are named by their stages alone.
const NAMELESS: &str = "program";

/// The stage of a file extension.
fn by_extension(path: &Path) -> Option<Stage> {
    let extension = path.extension()?.to_str()?;
    let long = WORDS.iter().filter(|(word, _)| word.len() > 2);
    EXTENSIONS.iter().chain(long).find(|(known, _)| known.eq_ignore_ascii_case(extension)).map(|(_, stage)| *stage)
}

/// The stage that a file name tells, and the name without the part that tells it.
fn read(path: &Path) -> Option<(Stage, String)> {
    let name = &*path.file_name()?.to_string_lossy();
    if let Some(stage) = by_extension(path) {
        return Some((stage, stem_of(name)));
    }
    let in_sdr = without(name, "sdr");
    let inner = without(name, "glsl").or(in_sdr)?;
    if let Some(stage) = by_extension(Path::new(inner)) {
        return Some((stage, stem_of(inner)));
    }
    let lower = inner.to_ascii_lowercase();
    let letters = LETTERS.iter().filter(|_| in_sdr.is_some());
    WORDS.iter().chain(letters).find_map(|(word, stage)| {
        let rest = match (lower.strip_suffix(word), lower.strip_prefix(word)) {
            (Some(""), _) => NAMELESS,
            (Some(before), _) if before.ends_with(SIGNS) => inner.get(..before.len() - 1)?,
            (Some(before), _) if is_word_of_capital(inner, before.len()) => inner.get(..before.len())?,
            (_, Some(after)) if after.starts_with(SIGNS) => inner.get(word.len() + 1..)?,
            _ => return None,
        };
        (!rest.is_empty()).then(|| (*stage, rest.to_owned()))
    })
}

/// Whether a word with a capital begins here, after a small letter or a digit.
fn is_word_of_capital(name: &str, place: usize) -> bool {
    let (before, after) = (name.get(..place).unwrap_or_default(), name.get(place..).unwrap_or_default());
    let ends_small = before.ends_with(|last: char| last.is_ascii_lowercase() || last.is_ascii_digit());
    ends_small && after.starts_with(|first: char| first.is_ascii_uppercase())
}

/// The stage that the name of a file tells, and the name without the part that tells it, which the other stages of a program share.
///
/// ```
/// use glisten_front::Stage;
/// use glisten_sources::stage_of_name;
///
/// assert_eq!(stage_of_name("shaders/waveFrag.glsl"), Some((Stage::Fragment, "wave".to_owned())));
/// assert_eq!(stage_of_name("wave.glsl"), None);
/// ```
pub fn stage_of_name(name: &str) -> Option<(Stage, String)> {
    read(Path::new(name))
}

/// The stage of a file name.
pub fn by_name(path: &Path) -> Option<Stage> {
    read(path).map(|(stage, _)| stage)
}

/// Whether the name ends in `.glsl`, as those of files do that others include.
pub fn may_be_included(path: &Path) -> bool {
    path.file_name().is_some_and(|name| without(&name.to_string_lossy(), "glsl").is_some())
}

/// The functions that a shader begins with: that of GLSL, and that of Shadertoy.
const ENTRIES: [&str; 2] = ["main", "mainImage"];

/// Whether a file is there to be included: its name ends in `.glsl`, and it has no `main`.
pub fn is_part(path: &Path) -> bool {
    let lacks_main = |bytes: Vec<u8>| {
        let code = without_comments(&String::from_utf8_lossy(&bytes));
        !ENTRIES.iter().any(|name| names_function(&code, name))
    };
    may_be_included(path) && fs::read(path).is_ok_and(lacks_main)
}

/// The name without this extension.
fn without<'n>(name: &'n str, wanted: &str) -> Option<&'n str> {
    let (inner, extension) = name.rsplit_once('.')?;
    extension.eq_ignore_ascii_case(wanted).then_some(inner)
}

/// The name without the part that tells the stage: `phong` for `phong.vert`, `phong.vert.glsl` and `phong_vs.glsl`.
pub fn stem(path: &Path) -> String {
    let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
    // `phong.glsl.js` is a module of three.js.
    let inner = without(&name, "js").and_then(|name| without(name, "glsl")).map(str::to_owned);
    read(path).map(|(_, stem)| stem).or(inner).unwrap_or_else(|| stem_of(&name))
}

fn stem_of(name: &str) -> String {
    Path::new(name).file_stem().map_or(name.to_owned(), |stem| stem.to_string_lossy().into_owned())
}

/// Whether the name is one of files that contain several stages.
pub fn may_be_combined(path: &Path) -> bool {
    let is_one = |extension: &str| ["glsl", "shader"].iter().any(|known| known.eq_ignore_ascii_case(extension));
    let is_module = path.file_name().is_some_and(|name| name.to_string_lossy().ends_with(".glsl.js"));
    is_module || path.extension().and_then(|extension| extension.to_str()).is_some_and(is_one)
}

/// The largest number of bytes before the first word that are looked at.
const MAX_BLANK: u64 = 256;

/// Whether a file is a program in the assembly language of ARB_vertex_program: its first line begins with `!!ARBvp1.0` or its like.
pub fn is_assembly(path: &Path) -> bool {
    let mut start = Vec::new();
    let read = fs::File::open(path).and_then(|file| file.take(MAX_BLANK).read_to_end(&mut start));
    read.is_ok() && start.trim_ascii_start().starts_with(b"!!")
}

/// Stages that glisten does not read, by the extensions of their files, before `.glsl` as well.
static UNREAD: &[(&str, &str)] = &[
    ("tesc", "tessellation"),
    ("tese", "tessellation"),
    ("tcs", "tessellation"),
    ("tes", "tessellation"),
    ("comp", "compute"),
];

/// The stage of a file that glisten does not read.
pub fn unread(path: &Path) -> Option<&'static str> {
    let name = &*path.file_name()?.to_string_lossy();
    let inner = without(name, "glsl").unwrap_or(name);
    UNREAD.iter().find(|(extension, _)| without(inner, extension).is_some()).map(|(_, stage)| *stage)
}

/// Whether a program has tessellation stages, which are files with its stem next to the others.
pub fn is_tessellated(folder: &Path, stem: &str) -> bool {
    const TESSELLATION: [&str; 4] = ["tesc", "tese", "tcs", "tes"];
    let names = |word: &str| [format!("{stem}.{word}"), format!("{stem}.{word}.glsl"), format!("{stem}_{word}.glsl")];
    TESSELLATION.iter().flat_map(|word| names(word)).any(|name| folder.join(name).is_file())
}

/// Names that stages between the vertex and the fragment stage alone have.
const OF_INNER_STAGES: [&str; 4] = ["EmitVertex", "gl_TessCoord", "gl_TessLevelOuter", "gl_TessLevelInner"];

/// The files of a folder that are stages between the vertex and the fragment stage by their texts, and of no stage by their names.
pub fn inner_stages(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_one = |path: &PathBuf| {
        let is_unnamed = may_be_included(path) && by_name(path).is_none() && unread(path).is_none();
        let text = || fs::read(path).map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).unwrap_or_default();
        is_unnamed && path.is_file() && is_inner(&text())
    };
    entries.filter(is_one).collect()
}

fn is_inner(text: &str) -> bool {
    let code = without_comments(text);
    words(&code).any(|(_, word)| OF_INNER_STAGES.contains(&word)) && combined::members(text).is_empty()
}

/// Whether a file whose name tells no stage may be of the program with a stem.
pub fn may_be_of(file: &Path, stem: &str) -> bool {
    let own = |name: &str| name.to_lowercase();
    stem == NAMELESS || file.file_name().is_some_and(|name| own(&name.to_string_lossy()).starts_with(&own(stem)))
}

/// The extension for a stage.
pub fn extension(stage: Stage) -> &'static str {
    match stage {
        Stage::Vertex => "vert",
        Stage::Geometry => "geom",
        Stage::Fragment => "frag",
    }
}

/// All extensions with their dots, for messages.
pub fn all_extensions() -> String {
    EXTENSIONS.iter().map(|(extension, _)| format!(".{extension}")).collect::<Vec<_>>().join(" ")
}
