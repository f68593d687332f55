//! What a target is: [`Target`], the [`Conventions`] of its host, and the texture and sampler that stand for a sampler type.
//!
//! *In:* nothing. *Out:* words in which lowering, emission and reflection agree. *Holds:* neither of them is known here.

mod conventions;
mod language;
mod textures;

pub use conventions::{ClipZ, Conventions, SpirvEnv, WindowOrigin};
pub use language::Target;
pub use textures::BUFFER_WIDTH;
pub(crate) use textures::Shape;
