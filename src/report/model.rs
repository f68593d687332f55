//! [`Report`]: every figure of a report, in the form of `report.json`.
//!
//! *Units:* errors are absolute, in units of a color channel (1 is full intensity of an 8-bit screen), over the RGB
//! of the first attachment and the pixels that both pictures cover. Times are milliseconds of GPU time per frame.
//! Ratios are to the baseline of the same run and have no unit.

use glisten_scene::picture::{Picture, Transfer};
use serde::Serialize;

/// The error against run time of each way to shade a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// How pictures on the page are encoded.
    #[serde(skip)]
    pub encode: Transfer,
    /// The GPU.
    pub adapter: Adapter,
    /// `spirv` or `wgsl`.
    pub via: &'static str,
    /// The truths, one per model.
    pub truths: Vec<Truth>,
    /// How times were measured.
    pub timing: Timing,
    /// The ways, in the order of the scene, coarse to fine.
    pub ways: Vec<Way>,
}

/// The GPU that drew.
#[derive(Clone, Debug, Serialize)]
pub struct Adapter {
    /// The name in Vulkan.
    pub name: String,
    /// The driver's version text.
    pub driver: String,
}

/// The picture with which the ways of a model are compared.
#[derive(Clone, Debug, Serialize)]
pub struct Truth {
    /// The model.
    pub model: String,
    /// The way that draws it.
    pub way: String,
    /// The segments and rings of its mesh, if that was tessellated for the report.
    pub tessellation: Option<[u32; 2]>,
    /// Always `f64`: the CPU reference.
    pub precision: &'static str,
    /// The picture.
    #[serde(skip)]
    pub picture: Picture,
}

/// How times were measured.
#[derive(Clone, Debug, Serialize)]
pub struct Timing {
    /// The way whose time is 1.
    pub baseline: String,
    /// Its median time in milliseconds per frame.
    pub baseline_ms: f64,
    /// How often all ways were drawn, in turns.
    pub rounds: u32,
    /// The ratio of a second copy of the baseline to the first in the same run: its distance from 1 is noise.
    pub same_again: Spread,
}

/// A ratio over the rounds of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// The median.
    pub median: f64,
    /// The lower quartile.
    pub low: f64,
    /// The upper quartile.
    pub high: f64,
}

/// A way to shade the scene.
#[derive(Clone, Debug, Serialize)]
pub struct Way {
    /// The name in the scene, or that of a way that was found.
    pub name: String,
    /// The kind of way in a word: `declared` in the scene, or that of a way that was found.
    pub kind: &'static str,
    /// What is done in a sentence, if there is more to say than the name.
    pub about: String,
    /// The model, which selects the truth.
    pub model: String,
    /// The segments and rings of its mesh, if that was tessellated for the report.
    pub tessellation: Option<[u32; 2]>,
    /// The number of vertices drawn, counting repeated ones each time.
    pub vertices: u64,
    /// How often the fragment stage ran in a frame; null if the adapter does not count.
    pub fragments: Option<u64>,
    /// The GPU's picture compared with the truth.
    pub error: Figures,
    /// The GPU's picture compared with the same way in f64: the effect of rounding alone.
    pub rounding: Figures,
    /// The median GPU time in milliseconds per frame.
    pub milliseconds: f64,
    /// The time relative to the baseline's.
    pub ratio: Spread,
    /// Whether no other way of the model is both faster and closer to the truth.
    pub pareto: bool,
    /// The picture.
    #[serde(skip)]
    pub picture: Picture,
    /// For each pixel, the largest difference of its channels from the truth; `None` where only one picture covers
    /// it.
    #[serde(skip)]
    pub difference: Vec<Option<f64>>,
}

/// The difference between two pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// The largest difference of a channel.
    pub max_abs: f64,
    /// The root mean square difference.
    pub rmse: f64,
    /// Decibels against a peak of 1; null for equal pictures.
    pub psnr: Option<f64>,
    /// The number of pixels that both cover.
    pub covered: u64,
    /// The number of pixels that only one covers.
    pub coverage_mismatch: u64,
    /// The number of pixels that both cover and that have a NaN or infinity on either side; they count nowhere else.
    pub non_finite: u64,
}

impl Way {
    /// The name with the tessellation: `Phong per vertex, 32x16`.
    pub fn title(&self) -> String {
        match self.tessellation {
            Some([segments, rings]) => format!("{}, {segments}x{rings}", self.name),
            None => self.name.clone(),
        }
    }
}
