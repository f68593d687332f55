//! The gallery: every scene of the library on one page, beside its equation, its source and what the document says of it.
//!
//! *In:* the scenes of [`crate::library::scenes`], each with a `[gallery]` table, and the pictures that a backend drew of them.
//! *Out:* PNG files, a contact sheet of them, and a page that needs nothing else.
//!
//! ```text
//!  library ──► entry     the scene and its [gallery] table
//!          ──► tile      a picture of twice the size, averaged; PNG
//!          ──► page      equations (math), sources (highlight), the template
//! ```
//!
//! *Holds:* the same pictures give the same bytes. Nothing here draws, prints or writes files; texts are escaped.

mod entry;
mod highlight;
mod math;
mod page;
mod tile;

pub use entry::{Entry, entries};
pub use page::page;
pub use tile::{Tile, contact_sheet};

/// The page's file name.
pub const PAGE: &str = "index.html";
/// The contact sheet's file name.
pub const SHEET: &str = "gallery.png";
