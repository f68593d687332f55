//! [`Picture`]: what a draw leaves in the framebuffer.

/// What was drawn, top row first, x fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Pixels from left to right.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// RGBA of every pixel of every color attachment, as stored in the framebuffer's format (integers as they are).
    pub attachments: Vec<Vec<[f64; 4]>>,
    /// Whether a fragment was written to the pixel, after discard and depth test.
    pub covered: Vec<bool>,
    /// For a bounded reference: how far a conforming GPU may be off, for each channel of each attachment.
    pub bounds: Option<Vec<Vec<[f64; 4]>>>,
    /// For a bounded reference: pixels where a branch, a discard or a depth test may go either way.
    pub undecided: Vec<bool>,
    /// Pixels whose center lies within 1/128 pixel of an edge of a primitive that was drawn.
    pub near_edge: Vec<bool>,
}
