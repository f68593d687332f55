//! `--max-memory`: the most memory that the program may have.
//!
//! *In:* a number of bytes. *Out:* from then on, an allocation beyond it ends the program with a sentence and the code of a wrong input.
//! *Holds:* the limit is the system's (`RLIMIT_DATA`, setrlimit(2)): what a driver takes counts, and so does each process that is started. The
//! end of the program allocates nothing. On systems other than Linux there is no such limit.
#![cfg_attr(target_os = "linux", expect(unsafe_code, reason = "the system's calls for limits are C"))]

use crate::exit::{Exit, Failure};
use std::sync::atomic::{AtomicU8, Ordering};

/// The code of a copy of this process that had no memory left, which has told it.
pub(crate) const EXHAUSTED: u8 = 86;

/// The code at the end of memory; 0 if there is no limit.
static CODE: AtomicU8 = AtomicU8::new(0);

/// Sets the limit.
///
/// # Errors
/// The system has no such limit, or a smaller one that stays.
#[cfg(target_os = "linux")]
pub(crate) fn limit(bytes: u64) -> Result<(), Failure> {
    let limit = libc::rlimit { rlim_cur: bytes, rlim_max: bytes };
    // SAFETY: the call reads one limit, which lives until it returns.
    if unsafe { libc::setrlimit(libc::RLIMIT_DATA, &limit) } != 0 {
        let why = std::io::Error::last_os_error();
        return Err(Failure::usage(format!("the system takes no such `--max-memory`: {why}")));
    }
    CODE.store(Exit::Content as u8, Ordering::Relaxed);
    Ok(())
}

/// The same, where the system has no such limit.
#[cfg(not(target_os = "linux"))]
pub(crate) fn limit(_: u64) -> Result<(), Failure> {
    Err(Failure::usage("`--max-memory` needs Linux"))
}

/// Lets the end of memory end this process by [`EXHAUSTED`]: it is a copy that another one waits for.
pub(crate) fn in_a_copy() {
    if CODE.load(Ordering::Relaxed) != 0 {
        CODE.store(EXHAUSTED, Ordering::Relaxed);
    }
}

/// Called when the system gives no memory. Ends the program if there is a limit.
pub fn exhausted() {
    let code = CODE.load(Ordering::Relaxed);
    if code != 0 {
        end(code);
    }
}

#[cfg(target_os = "linux")]
fn end(code: u8) {
    const MESSAGE: &[u8] =
        b"error: it would take more memory than `--max-memory` allows\n  = help: give it more, or a smaller input\n";
    // SAFETY: the message lives forever; neither call allocates or waits.
    unsafe {
        libc::write(libc::STDERR_FILENO, MESSAGE.as_ptr().cast(), MESSAGE.len());
        libc::_exit(i32::from(code));
    }
}

#[cfg(not(target_os = "linux"))]
fn end(_: u8) {}
