//! Reports on error against run time, as tables, plots and pages.
//!
//! *In:* a scene file, which may have a `[report]` table that names the variants to shade it (see `docs/scenes.md`).
//! *Out:* a [`Report`]: for each variant the difference between its picture and the f64 reference of its model, and its GPU
//! time as a ratio to the first variant's, from one run in which all variants take turns.
//!
//! *Holds:* nothing here prints or writes files; [`Report::table`], [`Report::json`] and [`Report::html`] return
//! texts. *Not done here:* the pass or fail verdict of `glisten verify`.

pub mod account;
mod budget;
mod clock;
mod compare;
mod draw;
mod figures;
mod front;
pub mod gallery;
mod interval;
mod model;
mod options;
mod page;
mod pair;
mod past;
mod plan;
mod plot;
mod random;
mod run;
mod table;
mod ways;
mod weights;
mod work;

pub use budget::{Budget, Choice, WayFiles};
pub use clock::{Limits, TIMING};
pub use compare::Comparison;
pub use model::{Adapter, Ended, Figures, Machine, OnFront, Report, Skipped, Spread, Timing, Truth, Way, Work};
pub use options::{Error, Options, Watcher, Ways};
pub use pair::{Paired, paired};
pub use past::Past;
pub use run::run;
pub use ways::{LIBRARY_SCENE, LibraryFiles};
pub use weights::Weights;
pub use work::{steps, work};

impl Report {
    /// The table for a terminal.
    pub fn table(&self) -> String {
        table::table(self)
    }

    /// The contents of `report.json`.
    pub fn json(&self) -> String {
        // Numbers, strings and lists only: serialization has nothing to reject.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }

    /// The contents of `report.html`, which needs no other file.
    ///
    /// # Errors
    /// The message of the template engine, which only a broken template causes.
    pub fn html(&self, made: &glisten_page::made::Made) -> Result<String, String> {
        page::page(self, made).map_err(|error| error.to_string())
    }
}
