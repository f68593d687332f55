//! Sources on disk: which stage a file is, what it includes, and how its engine completes it.
//!
//! *In:* paths of files, and [`Settings`]: flags, the tables of `glisten.toml`, or the methods of a build. *Out:* the stage that a
//! name tells ([`stages`]), the resolver of includes ([`DiskIncludes`]), and what a compiler asks for
//! ([`Settings::complete`]). *Holds:* the program and build scripts read sources alike; only [`Disk`] knows who reads, so each of
//! them can remember what it has read.

mod disk;
pub mod embedded;
pub mod engines;
mod host;
mod includes;
mod programs;
mod settings;
pub mod stages;

pub use disk::{Disk, read_bounded, with_line_feeds};
pub use host::{Search, completing};
pub use includes::{DiskIncludes, normal};
pub use programs::ProgramFiles;
pub use settings::{Settings, members, parse_version};
pub use stages::stage_of_name;
