//! [`Threads`]: work that a command does on several threads.
//!
//! *In:* items, and the work on one. *Out:* the results, in the order of the items.
//!
//! *Holds:* one item, or one job, starts no thread: the thread of the command does the work, and its stack is as large.

use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};
use std::sync::OnceLock;

/// The stack size of a command, and of the threads that compile for it. The phases limit their recursion themselves, relying on this size.
pub(crate) const STACK_BYTES: usize = 16 << 20;

/// The threads of a command. They start when there is work for two of them.
#[derive(Debug)]
pub(crate) struct Threads {
    /// How many (0: one per core).
    jobs: usize,
    /// The threads; none where the system gives none, so that the command does all of the work itself.
    pool: OnceLock<Option<ThreadPool>>,
}

impl Threads {
    /// As many threads as `-j` says (0: one per core).
    pub(crate) fn new(jobs: usize) -> Self {
        Self { jobs, pool: OnceLock::new() }
    }

    /// The results of `work` on each item.
    pub(crate) fn map<T: Send, R: Send>(&self, items: Vec<T>, work: impl Fn(T) -> R + Send + Sync) -> Vec<R> {
        let pool = if items.len() > 1 && self.jobs != 1 { self.started() } else { None };
        match pool {
            Some(pool) => pool.install(|| items.into_par_iter().map(work).collect()),
            None => items.into_iter().map(work).collect(),
        }
    }

    fn started(&self) -> Option<&ThreadPool> {
        let start = || ThreadPoolBuilder::new().num_threads(self.jobs).stack_size(STACK_BYTES).build().ok();
        self.pool.get_or_init(start).as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::Threads;
    use std::collections::BTreeSet;
    use std::thread;
    use std::time::Duration;

    fn threads_of(jobs: usize, items: usize) -> BTreeSet<String> {
        let work = |_| {
            thread::sleep(Duration::from_millis(20));
            format!("{:?}", thread::current().id())
        };
        Threads::new(jobs).map((0..items).collect(), work).into_iter().collect()
    }

    #[test]
    fn one_item_or_one_job_stays_on_the_thread() {
        let own = BTreeSet::from([format!("{:?}", thread::current().id())]);
        assert_eq!(threads_of(4, 1), own);
        assert_eq!(threads_of(1, 4), own);
        assert!(threads_of(4, 4).is_disjoint(&own));
    }

    #[test]
    fn results_are_in_the_order_of_the_items() {
        let items: Vec<usize> = (0..500).collect();
        assert_eq!(Threads::new(4).map(items.clone(), |item| item), items);
    }
}
