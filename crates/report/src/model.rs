//! [`Report`]: every figure of a report, in the form of `report.json`.
//!
//! *Units:* errors are absolute, in units of a color channel (1 is full intensity of an 8-bit screen), over the RGB
//! of the first attachment and the pixels that both pictures cover. Times are milliseconds of GPU time per frame.
//! Ratios are to the baseline of the same run and have no unit. A figure that there is not, because a report was ended before
//! it was measured, is NaN, and null in JSON.

use glisten_emit::FloatWidth;
use glisten_front::hir::Stage;
use glisten_scene::picture::{Encoding, Picture};
use glisten_verify::scene::Scene;
use serde::{Serialize, Serializer};
use std::sync::Arc;

/// The error against run time of each variant to shade a scene.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// The scene's name.
    pub scene: String,
    /// The title of the page, if it is not the scene's name.
    #[serde(skip)]
    pub title: Option<String>,
    /// The width and height in pixels.
    pub size: [u32; 2],
    /// How pictures on the page are encoded.
    #[serde(skip)]
    pub encode: Encoding,
    /// Whether all variants were drawn, and timed as long as was asked for.
    pub complete: bool,
    /// The version of glisten.
    pub version: &'static str,
    /// The GPU.
    pub adapter: Adapter,
    /// The rest of the machine.
    pub machine: Machine,
    /// `spirv` or `wgsl`.
    pub via: &'static str,
    /// The name of the weights by which operations were counted.
    pub weights: String,
    /// The references, one per model.
    pub truths: Vec<Truth>,
    /// How times were measured.
    pub timing: Timing,
    /// The variants, in the order of the scene, coarse to fine, then those that were found.
    pub ways: Vec<Way>,
    /// The variants that were found and could not be drawn.
    pub skipped: Vec<Skipped>,
}

/// The machine, as far as it is known. No figure but those of time depends on it.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Machine {
    /// The name of the CPU.
    pub cpu: Option<String>,
    /// The number of threads that may run at the same time.
    pub threads: usize,
    /// The mean number of runnable threads in the minute before the report.
    pub load: Option<f64>,
}

/// A variant that was found and could not be drawn.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Skipped {
    /// The name.
    pub name: String,
    /// The model.
    pub model: String,
    /// The reason.
    pub because: String,
}

/// The GPU that drew.
#[derive(Clone, Debug, Serialize)]
pub struct Adapter {
    /// The name in Vulkan.
    pub name: String,
    /// The driver's version text.
    pub driver: String,
}

/// The picture with which the variants of a model are compared.
#[derive(Clone, Debug, Serialize)]
pub struct Truth {
    /// The model.
    pub model: String,
    /// The variant that draws it.
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
    /// The variant whose time is 1.
    pub baseline: String,
    /// Its median time in milliseconds per frame.
    pub baseline_ms: f64,
    /// The median time of a frame that only clears: a part of every variant's time.
    pub empty_ms: f64,
    /// How often all variants were drawn, each round in an order by chance.
    pub rounds: u32,
    /// The seed of the orders.
    pub seed: u64,
    /// Why there were no more rounds.
    pub ended: Ended,
    /// The ratio of a second copy of the baseline to the first in the same run: its distance from 1 is noise.
    pub same_again: Spread,
    /// By how much one variant must be faster than another to beat it, after the noise of the same again: 0.1 is 10 %.
    pub margin: f64,
}

/// Why there were no more rounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Ended {
    /// Every interval is narrow enough.
    Narrow,
    /// The limit of rounds.
    Rounds,
    /// The limit of seconds.
    Seconds,
    /// The user ended it.
    Stopped,
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
    /// The interval that holds the median with a confidence of 95 %.
    pub interval: [f64; 2],
}

/// A variant to shade the scene.
#[derive(Clone, Debug, Serialize)]
pub struct Way {
    /// The name in the scene, or that of a variant that was found.
    pub name: String,
    /// The kind of variant in a word: `declared` in the scene, or that of a variant that was found.
    pub kind: &'static str,
    /// A sentence on what is done, if there is more to say than the name.
    pub about: String,
    /// The model, which selects the reference.
    pub model: String,
    /// The segments and rings of its mesh, if that was tessellated for the report.
    pub tessellation: Option<[u32; 2]>,
    /// The number of vertices drawn, counting repeated ones each time.
    pub vertices: u64,
    /// How often the fragment stage ran in a frame; null if the adapter does not count.
    pub fragments: Option<u64>,
    /// The work of the reference for the picture.
    pub work: Work,
    /// The GPU's picture compared with the reference.
    pub error: Figures,
    /// The GPU's picture compared with the same variant in f64: the effect of rounding alone.
    pub rounding: Figures,
    /// The median GPU time in milliseconds per frame.
    pub milliseconds: f64,
    /// The time relative to the baseline's.
    pub ratio: Spread,
    /// Whether no other variant of the model takes less work and is closer to the reference.
    pub pareto: bool,
    /// Whether no other variant of the model is faster and closer to the reference.
    pub pareto_time: OnFront,
    /// The form of the code that the GPU ran.
    pub via: &'static str,
    /// The width of floats on the GPU.
    #[serde(serialize_with = "ty")]
    pub floats: FloatWidth,
    /// The time of each round, in milliseconds per frame.
    #[serde(skip)]
    pub times: Vec<f64>,
    /// The scene.
    #[serde(skip)]
    pub scene: Arc<Scene>,
    /// The GLSL texts of each draw, if they are at hand.
    #[serde(skip)]
    pub programs: Option<Vec<Vec<(Stage, String)>>>,
    /// The picture.
    #[serde(skip)]
    pub picture: Picture,
    /// For each pixel, the largest difference of its channels from the reference; `None` where only one picture covers
    /// it.
    #[serde(skip)]
    pub difference: Vec<Option<f64>>,
}

/// The work of the reference for a picture: the same on every machine.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Work {
    /// Invocations of the vertex stage, one for each distinct vertex of an instance.
    pub vertices: u64,
    /// Invocations of the fragment stage, without helper invocations.
    pub fragments: u64,
    /// The sum of all steps by their weights.
    pub operations: u64,
    /// Texture lookups.
    pub texture_lookups: u64,
}

/// Whether a variant is on the front of error against time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum OnFront {
    /// Every variant that is as close to the reference is clearly slower.
    Yes,
    /// A variant that is as close to the reference is clearly faster.
    No,
    /// The measured times do not tell.
    Open,
}

impl OnFront {
    /// `yes`, `no` or `open`
    pub fn name(self) -> &'static str {
        match self {
            Self::Yes => "yes",
            Self::No => "no",
            Self::Open => "open",
        }
    }
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
    /// The largest difference in units in the last place (ULP) of the reference as an f32.
    pub max_ulp: f64,
    /// The mean FLIP error of the whole pictures, if it was computed: 0 (the same) to 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flip: Option<f64>,
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
/// `f16`, `f32`, `f64`
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
fn ty<S: Serializer>(floats: &FloatWidth, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(floats.ty())
}
