//! [`Kept`]: what is kept of a program: its outputs and its diagnostics.
//!
//! *In:* the outputs, the diagnostics and their texts. Findings of `lint` are notes without outputs. *Out:* an [`ActionResult`] and back. *Holds:* the diagnostics are those
//! before any level: levels of the command line and of `glisten.toml` apply to what is taken from a cache, too.

use super::action::{ActionResult, OutputFile};
use crate::digest::{Content, Digest};
use crate::outputs::Output;
use glisten_front::diagnostic::{Diagnostic, Saved};
use glisten_front::source::{FileId, SourceMap};
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// The result of a program without errors.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kept {
    /// The outputs in their order.
    pub(crate) outputs: Vec<Output>,
    /// The texts of the diagnostics.
    pub(crate) sources: SourceMap,
    /// The compiler's diagnostics.
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// Notes on the outputs.
    pub(crate) notes: Vec<Diagnostic>,
    /// How many diagnostics past the compiler's limit there were.
    pub(crate) dropped: usize,
    /// The watched macros that the result depends on.
    pub(crate) asked: BTreeSet<String>,
    /// The files of each input.
    pub(crate) read: Vec<Vec<FileId>>,
}

/// The text of a result.
#[derive(Deserialize, Serialize)]
struct Text {
    saved: Saved,
    /// How many of the diagnostics, at the end, are notes.
    notes: usize,
    dropped: usize,
    asked: BTreeSet<String>,
    /// The files of each input, by their places among those of `saved`.
    read: Vec<Vec<usize>>,
}

impl Kept {
    /// The result as a cache holds it.
    pub(super) fn written(&self) -> ActionResult {
        let files = self.outputs.iter().map(|(name, content)| OutputFile::new(name, content));
        let saved = Saved::new(&self.sources, self.diagnostics.iter().chain(&self.notes));
        let ids: Vec<FileId> = self.sources.files().map(|(id, _)| id).collect();
        let place = |id: &FileId| ids.iter().position(|other| other == id);
        let read = self.read.iter().map(|files| files.iter().filter_map(place).collect()).collect();
        let (notes, asked) = (self.notes.len(), self.asked.clone());
        let text = Text { saved, notes, dropped: self.dropped, asked, read };
        // Only a map whose keys are no texts could fail.
        let stdout_raw = serde_json::to_vec(&text).unwrap_or_default();
        ActionResult { output_files: files.collect(), stdout_raw }
    }

    /// The result that a cache held; `output` gives the bytes of a digest, of which it says how many there are. `None` if an output is missing, or the text is not one of this version.
    pub(super) fn read(result: &ActionResult, output: impl Fn(Digest, usize) -> Option<Content>) -> Option<Self> {
        let text: Text = serde_json::from_slice(&result.stdout_raw).ok()?;
        let (sources, mut diagnostics) = text.saved.restore()?;
        let notes = diagnostics.split_off(diagnostics.len().checked_sub(text.notes)?);
        let ids: Vec<FileId> = sources.files().map(|(id, _)| id).collect();
        let files = |places: &Vec<usize>| places.iter().map(|place| ids.get(*place).copied()).collect();
        let read: Option<Vec<Vec<FileId>>> = text.read.iter().map(files).collect();
        let mut outputs = Vec::new();
        for file in &result.output_files {
            let (digest, bytes) = file.digest()?;
            outputs.push((file.path.clone(), output(digest, bytes)?));
        }
        let (dropped, asked) = (text.dropped, text.asked);
        Some(Self { outputs, sources, diagnostics, notes, dropped, asked, read: read? })
    }
}
