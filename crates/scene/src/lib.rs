//! Scenes and pictures of glisten.
//!
//! [`scene`] reads scene files: what to draw, with which programs and which data. [`compare`] contains pictures,
//! intervals of pixel values, and the figures of the difference between two pictures.
//!
//! *Holds:* nothing here draws.

pub mod compare;
pub mod scene;
