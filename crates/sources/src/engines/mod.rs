//! The conventions of engines: how a source that is no complete shader becomes one.
//!
//! *In:* the text of a source, and the name of an engine. *Out:* the version, macros and texts that the engine puts before the
//! source ([`Profile`]), the spelling of its includes ([`Style`]), and the stages of a file that contains several
//! ([`combined`]). *Holds:* no I/O here; an engine is a file of settings in `profiles`, not code, except for the headers of
//! [`isf`].

pub mod code;
pub mod combined;
mod conditional;
mod game;
pub mod isf;
mod marks;
mod modules;
pub mod needed;
mod part;
mod profile;
mod sokol;
mod style;

pub use game::GameProgram;
pub use part::{Member, Part};
pub use profile::{Addition, PROFILES, Profile, SHOWN, find, names, stage_named};
pub use style::{Lookup, STYLES, Style};
