//! The sources that mutants are made of.

use crate::sections::extension;
use crate::seeds::{files_under, stage_of};
use glisten_front::Stage;
use std::path::{Path, PathBuf};

/// Longer sources are slow to change and rarely tell more.
const LONGEST: usize = 20_000;

/// Versions that glslang reads, too, without a profile of their own.
const VERSIONS: &[&str] = &["130", "140", "150", "330", "400", "410", "420", "430", "440", "450", "460"];

/// A source that is whole: it includes nothing.
#[derive(Clone, Debug)]
pub struct Whole {
    /// Its stage.
    pub stage: Stage,
    /// Its text.
    pub text: String,
}

impl Whole {
    /// The ending for a file of its stage: `frag`.
    pub fn ending(&self) -> &'static str {
        extension(self.stage)
    }
}

/// The whole sources under some folders, in the order of their paths.
pub fn sources(folders: &[PathBuf]) -> Vec<Whole> {
    let mut files: Vec<PathBuf> = folders.iter().flat_map(|folder| files_under(folder)).collect();
    files.sort();
    files.iter().filter_map(|file| whole(file)).collect()
}

fn whole(file: &Path) -> Option<Whole> {
    let stage = stage_of(file)?;
    let text = std::fs::read_to_string(file).ok()?;
    let version = text.lines().find_map(|line| line.trim_start().strip_prefix("#version"))?;
    let mut words = version.split_whitespace();
    let is_read = VERSIONS.contains(&words.next()?) && words.next() != Some("es");
    (is_read && text.len() <= LONGEST && !text.contains("#include")).then_some(Whole { stage, text })
}
