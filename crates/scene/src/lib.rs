//! Scenes and pictures of glisten.
//!
//! [`scene`] reads scene files: what is drawn, with which programs and which data. [`compare`] holds pictures, intervals of
//! what a pixel may be, and figures of how far two pictures are apart.
//!
//! *Holds:* nothing here draws.

pub mod compare;
pub mod scene;
