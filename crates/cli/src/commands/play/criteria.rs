//! The levels of the command line and of configurations, for what the page shows.

use crate::batch::Batch;
use crate::process::guard;
use crate::session::Session;
use glisten_front::diagnostic::write::Finding;
use glisten_front::diagnostic::{Diagnostic, Levels};
use glisten_front::source::SourceMap;
use glisten_play::Criteria;

impl Criteria for Session<'_> {
    fn levels_of(&mut self, name: &str) -> Levels {
        Session::levels_of(self, name)
    }

    fn findings(&mut self, sources: &SourceMap, found: Vec<Diagnostic>) -> Vec<Finding> {
        let mut batch = Batch { sources: sources.clone(), diagnostics: Vec::new() };
        self.add(&mut batch, found);
        Session::findings(self, &batch)
    }

    fn guarded<R>(&self, job: impl FnOnce() -> R) -> Result<R, String> {
        guard::guarded(job)
    }
}
