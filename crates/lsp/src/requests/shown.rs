//! The things that an editor can choose to see for a document: macros, includers, scenes.
//!
//! *In:* a document. *Out:* lists, in a fixed order.

use super::scene;
use crate::project::Choice;
use crate::state::State;
use std::path::{Path, PathBuf};

/// The macros that the conditions of a document's programs ask for.
pub(super) fn asked(state: &mut State<'_>, path: &Path) -> Vec<Choice> {
    let mut texts = Vec::new();
    for analysis in state.analyses_of(path) {
        texts.extend(analysis.sources().files().map(|(_, file)| (file.name().to_owned(), file.text().clone())));
    }
    texts.sort();
    texts.dedup();
    state.project.asked(&texts)
}

/// The files that a header is seen in, in a fixed order.
pub(super) fn contexts(state: &mut State<'_>, path: &Path) -> Vec<PathBuf> {
    let mut files = state.includers(path);
    files.sort();
    files.dedup();
    files
}

/// The scenes that draw a program with a document among its sources.
pub(super) fn scenes(state: &mut State<'_>, path: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = state.analyses_of(path).iter().flat_map(|one| one.key.files.clone()).collect();
    files.push(path.to_owned());
    let folders = scene::folders(state, &files);
    let scenes = state.project.scenes(&folders, false);
    let names = |(scene, text): &(PathBuf, std::sync::Arc<str>)| scene::draws_one_of(scene, text, &files);
    scenes.iter().filter(|one| names(one)).map(|(scene, _)| scene.clone()).collect()
}
