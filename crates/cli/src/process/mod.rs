//! The process: what ends it, what limits it, and copies of it for drivers that may crash.
//!
//! *In:* work to do. *Out:* its result, or how it ended: a signal, a limit, a panic. *Not done here:* no command runs.

pub(crate) mod child;
pub(crate) mod guard;
pub(crate) mod interrupt;
pub(crate) mod journal;
pub(crate) mod machine;
pub mod memory;
pub(crate) mod supervisor;
pub(crate) mod watchdog;
