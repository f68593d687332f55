//! [`Part`]: a stage of a file that contains several.
//!
//! *In:* the ranges of the file that belong to other stages. *Out:* the text of the stage. *Holds:* it has the length and the
//! lines of the file.

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
