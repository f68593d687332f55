//! [`with_stack`]: stack space for a recursive traversal.
//!
//! *In:* the depth of a traversal. *Out:* its result. *Holds:* a traversal within the parser's limit never overflows,
//! however small the caller's stack is.

/// The stack that a level of a traversal may use, in bytes.
pub const BYTES_A_LEVEL: usize = 8 << 10;

/// Runs a traversal that recurses `depth` levels with enough stack: on the caller's stack if as much is left of it, else on
/// a new one on the same thread. A level may use [`BYTES_A_LEVEL`].
pub fn with_stack<R>(depth: u32, walk: impl FnOnce() -> R) -> R {
    /// The levels of a traversal that hardly recurses: what it calls needs stack, too.
    const SHALLOW: u32 = 24;
    const LEAST: usize = 4 << 20;
    let bytes = depth.max(SHALLOW) as usize * BYTES_A_LEVEL;
    stacker::maybe_grow(bytes, bytes.max(LEAST), walk)
}
