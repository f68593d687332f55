//! [`Past`]: an earlier report, read from its JSON.
//!
//! *In:* the text of a `report.json`. *Out:* the figures that are compared. *Holds:* keys that are not known are left, and those
//! that older versions did not write may lack, so that reports of other versions can be read.

use super::model::Report;
use serde::Deserialize;

/// A report of an earlier run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub struct Past {
    pub(super) scene: String,
    pub(super) size: [u32; 2],
    pub(super) adapter: PastAdapter,
    pub(super) via: String,
    #[serde(default)]
    pub(super) weights: Option<String>,
    pub(super) timing: PastTiming,
    pub(super) ways: Vec<PastWay>,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct PastAdapter {
    pub(super) name: String,
    pub(super) driver: String,
}

#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct PastTiming {
    pub(super) baseline: String,
    #[serde(default)]
    pub(super) margin: Option<f64>,
}

/// A variant of an earlier run.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(super) struct PastWay {
    pub(super) name: String,
    pub(super) model: String,
    pub(super) tessellation: Option<[u32; 2]>,
    pub(super) error: PastFigures,
    #[serde(default)]
    pub(super) work: Option<PastWork>,
    pub(super) ratio: PastRatio,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub(super) struct PastFigures {
    pub(super) max_abs: Option<f64>,
    pub(super) rmse: Option<f64>,
    #[serde(default)]
    pub(super) max_ulp: Option<f64>,
    #[serde(default)]
    pub(super) flip: Option<f64>,
    #[serde(default)]
    pub(super) coverage_mismatch: Option<f64>,
    #[serde(default)]
    pub(super) non_finite: Option<f64>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub(super) struct PastWork {
    pub(super) vertices: u64,
    pub(super) fragments: u64,
    pub(super) operations: u64,
    pub(super) texture_lookups: u64,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
pub(super) struct PastRatio {
    #[serde(default)]
    pub(super) interval: Option<[Option<f64>; 2]>,
}

impl Past {
    /// Reads a report.
    ///
    /// # Errors
    /// A sentence that says why it is none.
    pub fn parse(text: &str) -> Result<Self, String> {
        serde_json::from_str(text).map_err(|error| error.to_string())
    }

    /// A report as a later run will read it, so that its figures have the same digits.
    pub(super) fn of(report: &Report) -> Result<Self, String> {
        Self::parse(&report.json())
    }
}

impl PastWay {
    /// The name with the tessellation.
    pub(super) fn title(&self) -> String {
        match self.tessellation {
            Some([segments, rings]) => format!("{}, {segments}x{rings}", self.name),
            None => self.name.clone(),
        }
    }

    /// The part that tells it from others.
    pub(super) fn key(&self) -> (&str, &str, Option<[u32; 2]>) {
        (&self.model, &self.name, self.tessellation)
    }
}
