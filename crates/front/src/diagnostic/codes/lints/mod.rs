//! Codes of the lint rules (`L0xxx`), one file for each group; each rule is a file in `src/lint/rules`.
//!
//! *Holds:* numbers are given in the order in which rules were added, over all groups.

pub mod correctness;
pub mod legacy;
pub mod numerics;
pub mod performance;
pub mod port;
pub mod style;

pub use correctness::*;
pub use legacy::*;
pub use numerics::*;
pub use performance::*;
pub use port::*;
pub use style::*;
