//! Files that contain several stages, and how they are taken apart.
//!
//! *In:* a text. *Out:* the programs in it, each with its stages: for each stage, what of the text is not its own, and the macro
//! that selects it. *Holds:* a stage's text has the length and the lines of the file, so that positions are those of the file.

use super::{conditional, marks, sokol};
use glisten_front::Stage;
use glisten_front::source::blanked;
use std::ops::Range;
use std::sync::Arc;

/// A stage of a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// The stage.
    pub stage: Stage,
    /// The ranges that do not belong to it.
    pub others: Vec<Range<usize>>,
    /// The macros that select it.
    pub defines: Vec<(String, String)>,
}

/// A program in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Member {
    /// Its name, if the file has names for its programs.
    pub name: Option<String>,
    /// Its stages, in the order of the pipeline.
    pub parts: Vec<Part>,
}

impl Part {
    /// The text of this stage: everything else is blank.
    pub fn text(&self, file: &str) -> Arc<str> {
        blanked(file, &self.others)
    }
}

impl Member {
    /// The part for a stage.
    pub fn part(&self, stage: Stage) -> Option<&Part> {
        self.parts.iter().find(|part| part.stage == stage)
    }
}

/// The programs of a file that contains several stages; none for a file that is one shader.
pub fn members(text: &str) -> Vec<Member> {
    // Almost every text is refused by these words.
    if !["#", "@", "--", "["].iter().any(|sign| text.contains(sign)) {
        return Vec::new();
    }
    let found = sokol::members(text);
    if !found.is_empty() {
        return found;
    }
    let parts = marks::parts(text).or_else(|| conditional::parts(text));
    parts.into_iter().map(|parts| Member { name: None, parts: in_order(parts) }).collect()
}

fn in_order(mut parts: Vec<Part>) -> Vec<Part> {
    parts.sort_by_key(|part| part.stage);
    parts
}
