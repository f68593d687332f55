//! [`seeds`]: the inputs that fuzzing starts from.
//!
//! *In:* the folder of fixtures. *Out:* for each fixture of a [`Kind`] an input: the file itself, or the shaders of a program and its
//! scene in one text. *Holds:* what is too long to be changed in useful places is left out.

use crate::sections::mark;
use glisten_front::Stage;
use glisten_scene::picture::{ImageFormat, Picture};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// More bytes are slow, and a change in them rarely meets another one.
const LONGEST: usize = 6000;
/// Models and pictures are longer.
const LONGEST_FILE: usize = 100_000;

/// The fixtures that a target starts from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Programs.
    Shaders,
    /// Scenes with their programs.
    Scenes,
    /// `.shader_test`
    ShaderTests,
    /// Sources with `//! test`.
    UnitTests,
    /// A small picture in each format.
    Pictures,
    /// Files with this ending.
    Files(&'static str),
}

/// An input.
#[derive(Clone, Debug)]
pub struct Seed {
    /// A name for its file.
    pub name: String,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// The inputs of a kind from the files under `folders`. Files that cannot be read are left out.
pub fn seeds(kind: Kind, folders: &[PathBuf]) -> Vec<Seed> {
    let mut files: Vec<PathBuf> = folders.iter().flat_map(|folder| files_under(folder)).collect();
    files.sort();
    match kind {
        Kind::Shaders => programs(&files),
        Kind::Scenes => files.iter().filter(|path| has_ending(path, "toml")).filter_map(|path| scene(path)).collect(),
        Kind::ShaderTests => plain(&files, LONGEST, |path, _| has_ending(path, "shader_test")),
        Kind::UnitTests => plain(&files, LONGEST, |path, text| has_ending(path, "glsl") && text.contains("//! test")),
        Kind::Pictures => pictures(),
        Kind::Files(ending) => plain(&files, LONGEST_FILE, |path, _| has_ending(path, ending)),
    }
}

/// The files under a folder, in no order.
pub(crate) fn files_under(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
            let path = entry.path();
            if path.is_dir() { folders.push(path) } else { found.push(path) }
        }
    }
    found
}

/// A picture of four colors in each format that glisten writes.
fn pictures() -> Vec<Seed> {
    let colors = [[0.0, 0.5, 1.0, 1.0], [1.0, 0.25, 0.0, 0.5], [0.0; 4], [1.0; 4]];
    let picture = Picture::of_colors(2, 2, colors.to_vec());
    let seed = |(name, format): (&str, ImageFormat)| {
        Some(Seed { name: name.to_owned(), bytes: picture.encode(0, format).ok()? })
    };
    [("png", ImageFormat::Png), ("exr", ImageFormat::Exr), ("npy", ImageFormat::Npy)]
        .into_iter()
        .filter_map(seed)
        .collect()
}

fn has_ending(path: &Path, ending: &str) -> bool {
    path.extension().is_some_and(|extension| extension == ending)
}

pub(crate) fn stage_of(path: &Path) -> Option<Stage> {
    Stage::ALL.into_iter().find(|stage| has_ending(path, crate::sections::extension(*stage)))
}

fn name_of(path: &Path) -> String {
    let parts: Vec<String> =
        path.components().rev().take(3).map(|part| part.as_os_str().to_string_lossy().into_owned()).collect();
    parts.into_iter().rev().collect::<Vec<_>>().join("-")
}

fn plain(files: &[PathBuf], longest: usize, wanted: impl Fn(&Path, &str) -> bool) -> Vec<Seed> {
    let seed = |path: &PathBuf| {
        let bytes = std::fs::read(path).ok().filter(|bytes| bytes.len() <= longest)?;
        wanted(path, &String::from_utf8_lossy(&bytes)).then(|| Seed { name: name_of(path), bytes })
    };
    files.iter().filter_map(seed).collect()
}

/// The shaders of one name in one folder are a program.
fn programs(files: &[PathBuf]) -> Vec<Seed> {
    let mut programs: BTreeMap<PathBuf, Vec<(Stage, &PathBuf)>> = BTreeMap::new();
    for path in files {
        if let Some(stage) = stage_of(path) {
            programs.entry(path.with_extension("")).or_default().push((stage, path));
        }
    }
    let seed = |(stem, mut shaders): (PathBuf, Vec<(Stage, &PathBuf)>)| {
        shaders.sort_by_key(|(stage, _)| *stage);
        let text =
            |(stage, path): &(Stage, &PathBuf)| Some(mark(stage.name()) + &std::fs::read_to_string(path).ok()? + "\n");
        let text: String = shaders.iter().map(text).collect::<Option<_>>()?;
        (text.len() <= LONGEST).then(|| Seed { name: name_of(&stem), bytes: text.into_bytes() })
    };
    programs.into_iter().filter_map(seed).collect()
}

/// A scene that names one shader a stage, which become sections.
fn scene(path: &Path) -> Option<Seed> {
    let text = std::fs::read_to_string(path).ok()?;
    let mut input = String::new();
    let mut scene = String::new();
    for line in text.lines() {
        let value = line.split_once('=').map(|(key, value)| (key.trim(), value.trim().trim_matches('"')));
        let stage = value.and_then(|(key, _)| Stage::ALL.into_iter().find(|stage| stage.name() == key));
        match (stage, value) {
            (Some(stage), Some((key, file))) => {
                let shader = path.parent()?.join(file);
                if !input.contains(&mark(key)) {
                    input += &(mark(key) + &std::fs::read_to_string(shader).ok()? + "\n");
                }
                scene += &format!("{key} = \"a.{}\"\n", crate::sections::extension(stage));
            }
            _ => {
                scene += line;
                scene.push('\n');
            }
        }
    }
    input += &(mark("scene") + &scene);
    (input.len() <= LONGEST).then(|| Seed { name: name_of(path), bytes: input.into_bytes() })
}
