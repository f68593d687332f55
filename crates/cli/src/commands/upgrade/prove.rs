//! `glisten upgrade --scene`: the picture of a scene stays the same to the bit.
//!
//! *In:* a scene, the new texts of its program. *Out:* the proof, or how many values change.

use super::Upgraded;
use crate::console::Console;
use crate::exit::{Exit, Failure};
use glisten_front::compiler::Compiler;
use glisten_reference::{Precision, RenderOptions};
use glisten_scene::{FileError, FileSource};
use glisten_sources::engines;
use glisten_upgrade::Plan;
use glisten_verify::scene::{self, DiskFiles, Scene};
use std::collections::BTreeMap;
use std::fs;
use std::path::PathBuf;

/// Draws a scene with the old and with the new texts.
pub(super) fn prove(
    path: &str,
    texts: &[Upgraded],
    plan: &Plan,
    old: &Compiler,
    new: &Compiler,
    console: &Console,
) -> Result<(), Failure> {
    let before = load(path, &DiskFiles, old)?;
    let files: BTreeMap<PathBuf, &str> = texts
        .iter()
        .filter_map(|upgraded| Some((fs::canonicalize(upgraded.input.path.as_ref()?).ok()?, upgraded.text.as_str())))
        .collect();
    let renamed = |word: &str| plan.renamed(word).filter(|_| word.starts_with("gl_")).map(str::to_owned);
    let after = load(path, &NewFiles { scene: path, files, renamed: &renamed, sources: Vec::new() }, new)?;
    let options = RenderOptions { precision: Precision::F32, mark_edges: false, ..RenderOptions::default() };
    let failed = |_| Failure::new(Exit::Content, format!("`{path}` cannot be drawn"));
    let before = glisten_reference::render(&before, &options).map_err(failed)?;
    let after = glisten_reference::render(&after, &options).map_err(failed)?;
    match before.bit_unequal(&after) {
        0 => {
            console.remark(&format!("{path}: the picture is the same to the bit"));
            Ok(())
        }
        n => Err(Failure::new(
            Exit::Content,
            format!("{path}: {n} values of the picture change, and nothing was written"),
        )),
    }
}

fn load(path: &str, files: &dyn FileSource, compiler: &Compiler) -> Result<Scene, Failure> {
    let loaded = scene::load(path, files, compiler);
    loaded.scene.ok_or_else(|| {
        let first = loaded.diagnostics.iter().find(|found| found.is_error());
        let why = first.map_or(String::new(), |error| format!(": {}", error.message));
        let exit = if loaded.io_error { Exit::Usage } else { Exit::Content };
        Failure::new(exit, format!("the scene `{path}` does not load{why}"))
    })
}

/// The files of the disk, with the new texts in place of the old ones, and new names in the scene.
pub(crate) struct NewFiles<'a> {
    /// The path of the scene.
    pub(crate) scene: &'a str,
    /// The new texts.
    pub(crate) files: BTreeMap<PathBuf, &'a str>,
    /// The new name of a word in the scene.
    pub(crate) renamed: &'a dyn Fn(&str) -> Option<String>,
    /// The stages that the scene has in other files now: the key, and the file.
    pub(crate) sources: Vec<(&'static str, String)>,
}

impl NewFiles<'_> {
    /// The key of a path in the texts.
    pub(crate) fn key(path: &str) -> PathBuf {
        fs::canonicalize(path).unwrap_or_else(|_| PathBuf::from(path))
    }

    /// The scene with the files that its stages are in now.
    fn with_sources(&self, scene: &str) -> String {
        let line = |line: &str| {
            let key = line.split('=').next().unwrap_or("").trim();
            let new = self.sources.iter().find(|(stage, _)| *stage == key);
            new.map_or_else(|| line.to_owned(), |(_, file)| format!("{key} = {}", toml::Value::from(file.as_str())))
        };
        scene.lines().map(|one| line(one) + "\n").collect()
    }
}

impl FileSource for NewFiles<'_> {
    fn read(&self, path: &str) -> Result<Vec<u8>, FileError> {
        if let Some(text) = self.files.get(&Self::key(path)) {
            return Ok(text.as_bytes().to_vec());
        }
        let bytes = DiskFiles.read(path)?;
        if path != self.scene {
            return Ok(bytes);
        }
        let text = self.with_sources(&String::from_utf8_lossy(&bytes));
        let mut new = String::new();
        let mut at = 0;
        for (start, word) in engines::code::words(&text) {
            let Some(name) = (self.renamed)(word) else { continue };
            new.push_str(text.get(at..start).unwrap_or(""));
            new.push_str(&name);
            at = start + word.len();
        }
        new.push_str(text.get(at..).unwrap_or(""));
        Ok(new.into_bytes())
    }
}
