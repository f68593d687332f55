//! Descriptions of targets: [`Target`], the [`Conventions`] of its host, and the texture and sampler that represent a
//! sampler type.
//!
//! *In:* nothing. *Out:* the terms that lowering, emission and reflection share. *Holds:* none of them is known here.

mod capabilities;
mod conventions;
mod language;
mod slots;
mod textures;

pub(crate) use capabilities::Capabilities;
pub use conventions::{ClipZ, Conventions, FloatWidth, GlslVersion, SpirvEnv, TexelWrap, WindowOrigin};
pub use language::Target;
#[cfg_attr(target_family = "wasm", allow(unused_imports, reason = "MSL alone has kinds"))]
pub(crate) use slots::SlotKind;
pub(crate) use slots::Slots;
pub use slots::viewport_slot;
pub use textures::BUFFER_WIDTH;
pub(crate) use textures::Shape;
