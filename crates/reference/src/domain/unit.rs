//! The vector unit for which loops over blocks are compiled besides the machine's least one.
//!
//! *In:* a loop. *Out:* its result. *Holds:* code for the vector unit must be inlined into the loop: closures that ask for
//! it can be, a function passed by name cannot.

use pulp::Arch;
use std::sync::LazyLock;

/// The vector unit of this machine.
static UNIT: LazyLock<Arch> = LazyLock::new(Arch::new);

/// Runs a loop on a wide vector unit; `None` if an x86 machine has none.
#[inline(always)]
pub(super) fn if_wide<R>(work: impl FnOnce() -> R) -> Option<R> {
    match *UNIT {
        #[cfg(target_arch = "x86_64")]
        Arch::V3(unit) => Some(unit.vectorize(work)),
        #[cfg(target_arch = "x86_64")]
        _ => None,
        #[cfg(not(target_arch = "x86_64"))]
        _ => Some(work()),
    }
}

/// Runs a loop on the widest vector unit.
#[inline(always)]
pub(super) fn widest<R>(work: impl FnOnce() -> R) -> R {
    UNIT.dispatch(work)
}
