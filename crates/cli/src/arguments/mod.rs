//! Arguments that commands share: flags, files of settings, the tables of `glisten.toml`.
//!
//! *In:* words of a command line, texts of files. *Out:* typed choices, or what is wrong with them. *Not done here:* no command runs.

pub(crate) mod args;
pub(crate) mod bounds;
pub(crate) mod config;
pub(crate) mod engine;
pub(crate) mod profile;
pub(crate) mod responses;
pub(crate) mod rules;
pub(crate) mod settings;
pub(crate) mod sizes;
pub(crate) mod stages;
