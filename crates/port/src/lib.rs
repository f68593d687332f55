//! Programs ported from OpenGL to other hosts: what each host wants, what else changes in a pack, and the account of it.
//!
//! *In:* the name of a host; old and new texts. *Out:* settings, files of JSON, reports. *Holds:* no I/O here. The texts themselves are
//! rewritten by [`upgrade`](glisten_upgrade).
//!
//! | file | contents |
//! | --- | --- |
//! | `host` | what programs are ported to, as data |
//! | `done` | what was done to a text |
//! | `minecraft` | the files of a pack that describe passes |
//! | `reflection` | the reflection of texts with numbers of their own |
//! | `header` | the reflection as a header of C |
//! | `report` | the account, as JSON and as a page |

mod done;
mod header;
mod host;
mod minecraft;
mod reflection;
mod report;

pub use done::{blocks, done};
pub use header::header;
pub use host::{HOSTS, Host, find_host, host_names};
pub use minecraft::{PostEffect, post_effect};
pub use reflection::{reflection, renumbered};
pub use report::{FileReport, Outcome, ProgramReport, Report, page};
