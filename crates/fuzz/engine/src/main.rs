//! A target of `glisten-fuzz` under libFuzzer: the environment variable `GLISTEN_FUZZ_TARGET` names it.
//!
//! *Holds:* an input that takes too long ends the process from another thread. libFuzzer's own limit stops the thread that works wherever
//! it is, and waits for ever if that is inside of the allocator.
#![no_main]

use glisten_fuzz::{Target, target};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Once, OnceLock};
use std::time::Duration;

/// How long an input may take.
const LIMIT: Duration = Duration::from_secs(30);

static CHOSEN: OnceLock<&'static Target> = OnceLock::new();
/// The number of inputs that were begun and that were ended.
static BEGUN: AtomicU64 = AtomicU64::new(0);
static ENDED: AtomicU64 = AtomicU64::new(0);
static WATCHED: Once = Once::new();

libfuzzer_sys::fuzz_target!(|input: &[u8]| {
    let chosen = CHOSEN.get_or_init(|| {
        let name = std::env::var("GLISTEN_FUZZ_TARGET").unwrap_or_default();
        target(&name).unwrap_or_else(|| panic!("GLISTEN_FUZZ_TARGET: no target `{name}`"))
    });
    WATCHED.call_once(|| drop(std::thread::spawn(watch)));
    BEGUN.fetch_add(1, Ordering::SeqCst);
    (chosen.check)(input);
    ENDED.fetch_add(1, Ordering::SeqCst);
});

/// Ends the process if the same input is under way for too long.
fn watch() {
    loop {
        let (begun, ended) = (BEGUN.load(Ordering::SeqCst), ENDED.load(Ordering::SeqCst));
        std::thread::sleep(LIMIT);
        if begun > ended && BEGUN.load(Ordering::SeqCst) == begun && ENDED.load(Ordering::SeqCst) == ended {
            eprintln!("an input takes more than {} s", LIMIT.as_secs());
            std::process::abort();
        }
    }
}
