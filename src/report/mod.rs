//! Error against run time, as tables, plots and pages.
//!
//! *In:* a scene file, perhaps with a `[report]` table that names the ways to shade it (see `docs/scenes.md`).
//! *Out:* a [`Report`]: for each way how far its picture is from the f64 truth of its model, and its GPU time as a ratio
//! to the first way's, from one run in which all ways take turns.
//!
//! *Holds:* nothing here prints or writes files; [`Report::table`], [`Report::json`] and [`Report::html`] give texts.
//! *Not done here:* the pass or fail verdict of `glisten verify`.

mod figures;
mod model;
mod page;
mod plan;
mod plot;
mod raster;
mod run;
mod table;

pub use model::{Adapter, Figures, Report, Spread, Timing, Truth, Way};
pub use run::{Error, Watcher, run};

impl Report {
    /// The figures for a terminal.
    pub fn table(&self) -> String {
        table::table(self)
    }

    /// `report.json`.
    pub fn json(&self) -> String {
        // Numbers, strings and lists alone: there is nothing that serialization could refuse.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// `report.html`, which needs no other file.
    ///
    /// # Errors
    /// The template engine's message, which only a broken template gives.
    pub fn html(&self) -> Result<String, String> {
        page::page(self).map_err(|error| error.to_string())
    }
}
