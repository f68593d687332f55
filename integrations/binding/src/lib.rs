//! What the bindings of glisten to C and to Python share.
//!
//! *In:* options as words ([`Settings`]), texts of shaders ([`compile`]), the path of a scene ([`Scenery`]). *Out:* code,
//! reflections and diagnostics as texts; pictures as numbers.
//!
//! *Holds:* what a host can get wrong is an [`Error`]. What a shader's author can get wrong is a diagnostic.

mod error;
mod includes;
mod paths;
mod program;
#[cfg(feature = "render")]
mod scene;
mod settings;
mod sources;
mod upgrade;

pub use error::{Error, Kind, Unreadable, guarded};
pub use includes::{Answer, Includes};
pub use paths::joined;
pub use program::{Compiled, Format, compile, target_of_word, targets};
#[cfg(feature = "render")]
pub use scene::{Drawn, Files, Scenery};
pub use settings::{OPTIONS, Settings};
pub use sources::{sources_of, stage_of_name, stage_of_word};
pub use upgrade::{Upgraded, upgrade};

#[cfg(feature = "render")]
pub use glisten::Precision;
pub use glisten::diagnostic::Severity as FoundSeverity;
pub use glisten::emit::Target;
#[cfg(feature = "render")]
pub use glisten::scene::FileError;
pub use glisten::{Source, Stage};
pub use glisten_front::diagnostic::write::Finding;

/// The version of glisten.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
