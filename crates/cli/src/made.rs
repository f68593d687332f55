//! How this run makes a page: its arguments, and the day.
//!
//! *Holds:* `SOURCE_DATE_EPOCH` takes the place of the clock, so that a page can be made again byte for byte.

use glisten_page::made::Made;
use std::env;
use std::time::{SystemTime, UNIX_EPOCH};

/// The facts of this run.
pub(crate) fn made() -> Made {
    let arguments: Vec<String> = env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()).collect();
    let fixed = env::var("SOURCE_DATE_EPOCH").ok().and_then(|seconds| seconds.parse().ok());
    let now = || SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |passed| passed.as_secs());
    Made::new(&arguments, fixed.unwrap_or_else(now))
}
