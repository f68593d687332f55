//! The gallery: every scene of the library on one page, next to its equation, its source, and what the document says
//! about it.
//!
//! *In:* the scenes of [`glisten_library::scenes`], each with a `[gallery]` table, and the pictures that a backend
//! drew. *Out:* PNG files, a contact sheet of them, and a page that needs no other files.
//!
//! ```text
//!  library ──► entry     the scene and its [gallery] table
//!          ──► tile      a picture of twice the size, averaged; PNG
//!          ──► difference    of two pictures that should be alike; PNG
//!          ──► figures   the errors of its functions, and the cost of a fragment
//!          ──► page      equations (math), sources, the template
//! ```
//!
//! *Holds:* the same pictures give the same bytes. Nothing here draws, prints or writes files; texts are escaped.

mod difference;
mod entry;
mod figures;
mod math;
mod page;
mod tile;

pub use difference::Difference;
pub use entry::{Entry, entries};
pub use figures::ranges;
pub use page::{Drawing, page};
pub use tile::{Tile, contact_sheet};

/// The file name of the page.
pub const PAGE: &str = "index.html";
/// The file name of the contact sheet.
pub const SHEET: &str = "gallery.png";
