//! Repairs of what naga writes, and of what it would not survive.
//!
//! *In:* modules before naga writes them, and its output. *Out:* the same with what naga lacks. Each file says what naga
//! does, and what would make the file superfluous.
//!
//! | file | superfluous once |
//! | --- | --- |
//! | `inline` | naga's text writers name only the loads that need a name |
//! | `names` | naga's namer follows the scopes of WGSL |
//! | `nesting` | naga's validator and writers limit how deep they recurse |
//! | `lines` | naga's SPIR-V writer accepts several source files |

pub(super) mod inline;
pub(super) mod lines;
pub(super) mod names;
pub(super) mod nesting;
