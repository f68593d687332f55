//! The workers of each page. Pages of one server end none of each other's jobs, and a pixel is told of a page's own picture.
//!
//! *In:* the id that a page made for itself. *Out:* its lanes. *Holds:* the number of pages is limited; the workers of one that was not
//! heard of for a while end.

use super::lanes::Lane;
use std::collections::BTreeMap;
use std::process::Command;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The most pages that have workers.
const MAX_PAGES: usize = 8;
/// A page that is open tells so more often than this.
const GONE: Duration = Duration::from_secs(90);

/// The workers of a page by kind of job.
pub(super) struct Lanes {
    /// Answers about texts.
    pub(super) looks: Lane,
    /// Draws.
    pub(super) draws: Lane,
    /// Studies costs and errors.
    pub(super) studies: Lane,
}

/// A page that has workers.
struct Known {
    heard: Instant,
    lanes: Arc<Lanes>,
}

/// The pages of a server.
pub(super) struct Pages {
    command: fn() -> std::io::Result<Command>,
    limit: Duration,
    known: Mutex<BTreeMap<String, Known>>,
}

impl Pages {
    /// No pages yet; `command` makes workers, whose jobs may take as long as `limit`.
    pub(super) fn new(command: fn() -> std::io::Result<Command>, limit: Duration) -> Self {
        Self { command, limit, known: Mutex::default() }
    }

    /// The lanes of a page.
    pub(super) fn of(&self, id: &str) -> Arc<Lanes> {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.retain(|other, page| other == id || page.heard.elapsed() < GONE);
        while known.len() >= MAX_PAGES && !known.contains_key(id) {
            let oldest = known.iter().min_by_key(|(_, page)| page.heard).map(|(id, _)| id.clone());
            oldest.and_then(|id| known.remove(&id));
        }
        let page = known.entry(id.to_owned()).or_insert_with(|| self.begun());
        page.heard = Instant::now();
        Arc::clone(&page.lanes)
    }

    fn begun(&self) -> Known {
        let lane = || Lane::new(self.command, self.limit);
        Known { heard: Instant::now(), lanes: Arc::new(Lanes { looks: lane(), draws: lane(), studies: lane() }) }
    }

    /// Notes that a page is still there.
    pub(super) fn hear(&self, id: &str) {
        if let Some(page) = self.known.lock().unwrap_or_else(PoisonError::into_inner).get_mut(id) {
            page.heard = Instant::now();
        }
    }

    /// Ends the workers of a page that is gone.
    pub(super) fn forget(&self, id: &str) {
        let gone = self.known.lock().unwrap_or_else(PoisonError::into_inner).remove(id);
        gone.iter().for_each(Known::stop);
    }

    /// Ends all workers.
    pub(super) fn stop(&self) {
        let all = std::mem::take(&mut *self.known.lock().unwrap_or_else(PoisonError::into_inner));
        all.values().for_each(Known::stop);
    }
}

impl Known {
    fn stop(&self) {
        let Lanes { looks, draws, studies } = &*self.lanes;
        [looks, draws, studies].into_iter().for_each(Lane::stop);
    }
}

#[cfg(test)]
mod tests {
    use super::{MAX_PAGES, Pages};
    use std::process::Command;
    use std::sync::Arc;
    use std::time::Duration;

    #[test]
    fn each_page_has_its_own_and_the_oldest_goes() {
        let pages = Pages::new(|| Ok(Command::new("true")), Duration::from_secs(1));
        let first = pages.of("a");
        assert!(Arc::ptr_eq(&first, &pages.of("a")) && !Arc::ptr_eq(&first, &pages.of("b")));
        pages.hear("a");
        (0..MAX_PAGES - 1).for_each(|number| drop(pages.of(&number.to_string())));
        assert!(Arc::ptr_eq(&first, &pages.of("a")), "`b` was not heard of for longer");
        (0..MAX_PAGES).for_each(|number| drop(pages.of(&number.to_string())));
        assert!(!Arc::ptr_eq(&first, &pages.of("a")));
        let last = pages.of("a");
        pages.forget("a");
        assert!(!Arc::ptr_eq(&last, &pages.of("a")));
        pages.stop();
    }
}
