//! Numbers that bound the work of an envelope, or a GPU's freedom where no specification does.
//!
//! *In:* nothing. *Out:* constants, for the code that is bounded. *Holds:* each has a row in [`fitted`](super::fitted).

/// How far a driver's point size may be from the requested size, in pixels: half of its granularity (OpenGL 3.2 §3.4.1), here
/// 1/256 pixel, as for window positions.
pub const POINT_SIZE_ERROR: f64 = 0.5 / 256.0;

/// The undecided conditions that a way of a fragment may meet, if one of its numbers is wider than [`WIDEST`]. A fragment with
/// a way that meets more is given up: where the bounds of a loop's variables have grown until every step is undecided,
/// following it finds no bound.
pub const MOST_OPEN: u8 = 24;

/// The width of an envelope that is hardly a bound, in sizes of the value.
pub const WIDEST: f64 = 1024.0;

/// The texels of a lookup with filtering that are joined; if it may touch more, anything is possible.
pub const MOST_TEXELS: i64 = 4096;

/// The texels of `texelFetch` that are joined; if it may read more, anything is possible.
pub const MOST_FETCHED: i64 = 64;

/// The error of a level of detail that a shader computes from derivatives: of `log2`, a length and a product.
pub const LEVEL_QUERY: f64 = 1e-4;
