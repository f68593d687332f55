//! [`Report`]: every figure of a report, as `report.json` has them.
//!
//! *Units:* errors are absolute, in units of a color channel (1 is full intensity of an 8-bit screen), over the RGB of
//! the first attachment and the pixels that both pictures cover; times are milliseconds of GPU time a frame; ratios are
//! to the baseline of the same run and have none.

use glisten_scene::picture::Picture;
use serde::Serialize;

/// Error against run time of the ways to shade a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// What drew.
    pub adapter: Adapter,
    /// `spirv` or `wgsl`.
    pub via: &'static str,
    /// What the ways are judged by, one a model.
    pub truths: Vec<Truth>,
    /// How times were taken.
    pub timing: Timing,
    /// The ways, in the order of the scene, coarse to fine.
    pub ways: Vec<Way>,
}

/// What drew.
#[derive(Clone, Debug, Serialize)]
pub struct Adapter {
    /// As Vulkan names it.
    pub name: String,
    /// The driver's version text.
    pub driver: String,
}

/// The picture that the ways of a model are judged by.
#[derive(Clone, Debug, Serialize)]
pub struct Truth {
    /// The model.
    pub model: String,
    /// The way that is drawn.
    pub way: String,
    /// Segments and rings of its mesh, if that was tessellated for the report.
    pub tessellation: Option<[u32; 2]>,
    /// Always `f64`: the CPU reference.
    pub precision: &'static str,
    /// The picture.
    #[serde(skip)]
    pub picture: Picture,
}

/// How times were taken.
#[derive(Clone, Debug, Serialize)]
pub struct Timing {
    /// The way whose time is 1.
    pub baseline: String,
    /// Its time in milliseconds a frame, at the median.
    pub baseline_ms: f64,
    /// How often all ways were drawn in turns.
    pub rounds: u32,
    /// The baseline against a second copy of itself in the same run: what this says of 1 is noise.
    pub same_again: Spread,
}

/// A ratio over the rounds of a run.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Spread {
    /// At the median.
    pub median: f64,
    /// The lower quartile.
    pub low: f64,
    /// The upper quartile.
    pub high: f64,
}

/// A way to shade the scene.
#[derive(Clone, Debug, Serialize)]
pub struct Way {
    /// As the scene names it.
    pub name: String,
    /// Which truth judges it.
    pub model: String,
    /// Segments and rings of its mesh, if that was tessellated for the report.
    pub tessellation: Option<[u32; 2]>,
    /// Vertices drawn, repeated ones counted each time.
    pub vertices: u64,
    /// How often the fragment stage ran in a frame; null if the adapter does not count.
    pub fragments: Option<u64>,
    /// The picture of the GPU against the truth.
    pub error: Figures,
    /// The picture of the GPU against the same way in f64: what rounding alone does.
    pub rounding: Figures,
    /// Milliseconds of GPU time a frame, at the median.
    pub milliseconds: f64,
    /// Time against the baseline's.
    pub ratio: Spread,
    /// Whether no other way of the model is both faster and nearer to the truth.
    pub pareto: bool,
    /// The picture.
    #[serde(skip)]
    pub picture: Picture,
    /// For each pixel the largest difference of its channels from the truth; `None` where only one covers.
    #[serde(skip)]
    pub difference: Vec<Option<f64>>,
}

/// How far a picture is from another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Figures {
    /// The largest difference of a channel.
    pub max_abs: f64,
    /// The root of the mean square.
    pub rmse: f64,
    /// Decibels against a peak of 1; null for equal pictures.
    pub psnr: Option<f64>,
    /// Pixels that both cover.
    pub covered: u64,
    /// Pixels that only one covers.
    pub coverage_mismatch: u64,
    /// Pixels that both cover with a NaN or infinity on either side; they count nowhere else.
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
