//! Scenes without what their pictures do not need.
//!
//! *In:* a [`Scene`]. *Out:* a scene that draws the same picture with residual programs and only the data that they read; its
//! text in the explicit core; the account of what went and what that saves.
//!
//! *Holds:* what a scene fixes is what each of its draws fixes: uniforms that are not `dynamic`, textures, attributes that
//! are the same at all vertices, fixed state. [`glisten_specialize`] does the rest and knows no scenes.

mod account;
mod known;
mod residual;

pub use account::{Account, DrawAccount, Entry, Figures, account, spirv_instructions};
pub use glisten_specialize::{Input, Kind, Known, KnownState, KnownTexture, LeftOut, Residual, specialize};
pub use known::known;
pub use residual::{SpecializedDraw, SpecializedScene, specialize_scene};
