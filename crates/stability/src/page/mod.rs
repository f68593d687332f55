//! The page that shows what an examination found: `stability.html`.
//!
//! ```text
//!  scene, findings, examination ──► model     the values of the template: verdict, pictures, causes
//!                               ──► listing   the texts of the shaders, with the loss of each line
//!  functions of the library     ──► library   a table of its own page
//!  points of a sweep or search  ──► series    pictures of some of them, drawn again
//!                               ──► chart     the largest error over the values, as SVG
//! ```
//!
//! *In:* scenes with what was found in them. *Out:* one HTML page that needs no other file, as text. *Holds:* everything from
//! a scene or a shader is escaped. The page does not depend on the machine, the folder or the time.

mod chart;
mod library;
mod listing;
mod model;
mod series;
mod words;

pub use library::library_page;
pub use series::{Point, Series};

use super::{Examination, Findings};
use glisten_front::source::SourceMap;
use glisten_page::Page;
use glisten_scene::Scene;
use minijinja::{Value, context};

/// The name of the page.
pub const PAGE: &str = "stability.html";

const SCENES: Page = Page {
    templates: &[
        ("stability.html", include_str!("page.html")),
        ("scene.html", include_str!("scene.html")),
        ("series.html", include_str!("series.html")),
        ("listing.html", include_str!("listing.html")),
    ],
    styles: &[include_str!("page.css")],
    scripts: &[include_str!("page.js")],
};

/// A scene on the page.
pub struct SceneOnPage<'a> {
    /// Its name.
    pub name: &'a str,
    /// The command that finds the same again.
    pub command: String,
    /// The scene as it was examined.
    pub scene: &'a Scene,
    /// The texts that it was read from.
    pub sources: &'a SourceMap,
    /// The findings.
    pub findings: &'a Findings,
    /// The pictures and figures.
    pub examined: &'a Examination,
    /// The accepted error.
    pub bound: f64,
    /// The drawings with other inputs, of which the examined scene is the worst.
    pub series: Option<Series>,
}

/// The page of these scenes.
///
/// # Errors
/// The message of the template engine, which only a broken template causes.
pub fn page(scenes: &[SceneOnPage<'_>]) -> Result<String, String> {
    let several = scenes.len() > 1;
    let models: Vec<Value> = scenes.iter().enumerate().map(|(index, scene)| model::scene(index + 1, scene)).collect();
    let values = context! { version => env!("CARGO_PKG_VERSION"), scenes => models, several };
    SCENES.render(values).map_err(|error| error.to_string())
}
