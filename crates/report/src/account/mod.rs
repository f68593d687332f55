//! The page that shows what was left out of scenes.
//!
//! ```text
//!  scenes, residuals, accounts ──► listing   both texts of a stage, line by line next to each other
//!                              ──► page      figures, pictures, the template
//! ```
//!
//! *In:* specialized scenes with their accounts and pictures. *Out:* one HTML page that needs no other file, as text.
//! *Holds:* no line of a residual is missing, and each is in the residual's order within its function; whatever was left out
//! says why.

mod listing;
mod page;

pub use page::{SceneOnPage, page};

/// The name of the page.
pub const PAGE: &str = "account.html";
