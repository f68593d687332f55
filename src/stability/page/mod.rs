//! The page that shows what an examination found: `stability.html`.
//!
//! ```text
//!  scene, findings, examination ──► model     the values of the template: verdict, pictures, causes
//!                               ──► listing   the texts of the shaders, with the loss of each line
//!  points of a sweep or search  ──► series    pictures of some of them, drawn again
//!                               ──► chart     the largest error over the values, as SVG
//! ```
//!
//! *In:* scenes with what was found in them. *Out:* one HTML page that needs no other file, as text. *Holds:* everything from
//! a scene or a shader is escaped. The page does not depend on the machine, the folder or the time.

mod chart;
mod listing;
mod model;
mod series;
mod words;

pub use series::{Point, Series};

use super::{Examination, Findings};
use crate::account::BASE_STYLE;
use glisten_front::source::SourceMap;
use glisten_scene::Scene;
use minijinja::{Environment, Value, context};

/// The name of the page.
pub const PAGE: &str = "stability.html";

const TEMPLATE: &str = include_str!("page.html");
const SCENE: &str = include_str!("scene.html");
const SERIES: &str = include_str!("series.html");
const LISTING: &str = include_str!("listing.html");
const STYLE: &str = include_str!("page.css");
const SCRIPT: &str = include_str!("page.js");

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
    let render = || -> Result<String, minijinja::Error> {
        let mut environment = Environment::new();
        environment.add_template("listing.html", LISTING)?;
        environment.add_template("series.html", SERIES)?;
        environment.add_template("scene.html", SCENE)?;
        environment.add_template("page.html", TEMPLATE)?;
        environment.get_template("page.html")?.render(context! {
            style => Value::from_safe_string([BASE_STYLE, STYLE].concat()),
            script => Value::from_safe_string(SCRIPT.into()),
            version => env!("CARGO_PKG_VERSION"),
            scenes => models,
            several,
        })
    };
    render().map_err(|error| error.to_string())
}
