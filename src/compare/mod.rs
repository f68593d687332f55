//! Pictures and how far they are apart.
//!
//! *In:* two [`Picture`]s. *Out:* error figures.

mod picture;

pub use picture::Picture;
