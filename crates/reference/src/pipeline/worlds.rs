//! [`Worlds`]: the contents of a pixel while it is open which of several primitives draws it.
//!
//! Exactly one of the *owners* of an interior pixel near an edge draws it ([`edges`](super::edges)), but a conforming GPU
//! decides which. The pixel keeps the hull of the worlds in which one of the owners so far drew it. Apart from that, its
//! contents before the first owner are kept, for the world in which a later one draws.
//!
//! *In:* owners, and other fragments between them, in order. *Out:* the hull of all worlds. *Holds:* if another fragment
//! comes between the owners, the worlds are joined, and the remaining owners may or may not draw.

use crate::domain::{Domain, Number};
use std::collections::BTreeMap;

/// The contents of one place, of one kind: a depth, or a color.
#[derive(Clone, Debug)]
pub(super) enum World<T> {
    /// No owner has drawn.
    Untouched,
    /// The contents if none of the owners so far is the one.
    Apart(T),
    /// The worlds are joined.
    Joined,
}

/// The worlds of a pixel.
#[derive(Clone, Debug)]
pub(super) struct Pixel<D: Domain> {
    pub(super) depth: World<D::Float>,
    /// For each attachment.
    pub(super) colors: Vec<World<[D::Float; 4]>>,
    /// Whether an owner may leave the pixel as it was.
    pub(super) leaves: bool,
}

/// The worlds of the pixels of a bin, by place. Empty unless a draw has interior pixels near edges.
pub(super) type Worlds<D> = BTreeMap<u32, Pixel<D>>;

impl<D: Domain> Pixel<D> {
    pub(super) fn new(attachments: usize) -> Self {
        Self { depth: World::Untouched, colors: vec![World::Untouched; attachments], leaves: false }
    }
}

/// The hull of two colors, with the values of the first.
pub(super) fn joined<F: Number>(a: [F; 4], b: [F; 4]) -> [F; 4] {
    std::array::from_fn(|channel| a[channel].joined(b[channel]))
}
