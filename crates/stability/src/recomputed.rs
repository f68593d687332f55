//! [`ExactFound`]: the figures of pixels that were computed again in 192 bits.
//!
//! *In:* nothing: [`with_exact`](super::with_exact) fills them. *Out:* the keys of the JSON.

use serde::Serialize;

/// The error of the reference, by 192 bits.
#[derive(Clone, Debug, Serialize)]
pub struct ExactFound {
    /// The bits of a number.
    pub bits: usize,
    /// The pixels that were recomputed.
    pub pixels: Vec<ExactPixelFound>,
    /// The largest error of f64 in these pixels; `None` if f64 is not finite in one of them and the exact color is.
    pub f64_max_error: Option<f64>,
    /// The largest error of f32 in these pixels; `None` if f32 is not finite in one of them and the exact color is.
    pub f32_max_error: Option<f64>,
    /// Whether f64 is enough for all of them.
    pub f64_is_enough: bool,
}

/// A pixel that was recomputed. Colors are `None` in channels that are not finite.
#[derive(Clone, Debug, Serialize)]
pub struct ExactPixelFound {
    /// The column from the left.
    pub x: u32,
    /// The row from the top.
    pub y: u32,
    /// Its color in f32.
    pub f32: [Option<f64>; 4],
    /// Its color in f64.
    pub f64: [Option<f64>; 4],
    /// Its color in 192 bits, rounded to f64.
    pub exact: [Option<f64>; 4],
    /// The error of f64; `None` if it is not finite.
    pub error: Option<f64>,
    /// Whether that is below a sixteenth of the bound.
    pub f64_is_enough: bool,
}
