//! [`with_stack`]: room for a walk that recurses.
//!
//! *In:* how deep a walk goes. *Out:* what the walk gives. *Holds:* a walk of the depth that the parser allows never
//! overflows, however small the caller's stack is.

/// Runs a walk that recurses `depth` levels with enough stack: on the caller's if that is shallow, else on one of its own
/// on the same thread. A walk may use up to 8 KiB a level.
pub fn with_stack<R>(depth: u32, walk: impl FnOnce() -> R) -> R {
    const SHALLOW: u32 = 48;
    const BYTES_A_LEVEL: usize = 8 << 10;
    const LEAST: usize = 4 << 20;
    if depth <= SHALLOW {
        return walk();
    }
    stacker::grow((depth as usize * BYTES_A_LEVEL).max(LEAST), walk)
}
