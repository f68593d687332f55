//! Scenes without what their pictures do not need.
//!
//! *In:* a `Scene`. *Out:* a scene that draws the same picture with residual programs and only the data that they read; its
//! text in the explicit core; the account of what went and what that saves.
//!
//! *Holds:* what a scene fixes is what each of its draws fixes: uniforms that are not `dynamic`, textures, attributes that
//! are the same at all vertices, fixed state. [`glisten_specialize`] does the rest and knows no scenes.

mod account;
mod error;
mod known;
mod residual;
mod suggest;

#[cfg(feature = "stability")]
pub use account::files_of;
pub use account::{Account, DrawAccount, Entry, Figures, MovedEntry, Moves, Times, account};
pub use error::{Distance, PictureError, Pictures, picture_error, pictures};
pub use glisten_specialize::Math;
pub use known::known;
pub use residual::{
    Contract, SpecializedDraw, SpecializedScene, specialize_scene, specialize_scene_by, unspecialized_scene,
    with_program,
};
pub use suggest::{Point, Ranked, Suggestion, suggest};
