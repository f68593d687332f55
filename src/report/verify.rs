//! `glisten verify`: the GPU's pictures of a scene against the reference's, each pixel by its own bound.
//!
//! *In:* a scene, an open GPU. *Out:* [`Verification`]: figures and a verdict for each emitted form, and the worse of
//! them. *Holds:* without a tolerance the reference runs in the bound domain: the ULPs of each operation are propagated
//! to first order, and what a branch leaves open is counted as undecided.

use crate::compare::{Judge, Picture, Verdict, flip};
use crate::cpu::{self, Precision, RenderOptions};
use crate::diagnostic::Diagnostic;
use crate::gpu::{self, Gpu, Via};
use crate::scene::Scene;
use serde::Serialize;
use std::time::Instant;

/// How to judge.
#[derive(Clone, Debug)]
pub struct VerifyOptions {
    /// Which emitted forms run, in this order; at least one.
    pub vias: Vec<Via>,
    /// An absolute tolerance for each channel, instead of the derived bound.
    pub tolerance: Option<f64>,
    /// Whether more than 1 % of undecided pixels are accepted.
    pub allow_undecided: bool,
}

/// Why there is no verdict.
#[derive(Debug)]
pub enum VerifyError {
    /// The GPU did not draw.
    Gpu(gpu::Error),
    /// The reference did not draw.
    Reference(Vec<Diagnostic>),
}

/// The verdict on a scene.
#[derive(Clone, Debug)]
pub struct Verification {
    /// One of each emitted form.
    pub forms: Vec<VerifiedForm>,
    /// The reference's picture.
    pub reference: Picture,
    /// Milliseconds of the reference on the CPU.
    pub cpu_ms: f64,
    /// Whether everything is explained.
    pub holds: bool,
}

/// The verdict on one emitted form.
#[derive(Clone, Debug)]
pub struct VerifiedForm {
    /// The form.
    pub via: Via,
    /// Its figures.
    pub verdict: Verdict,
    /// The mean of FLIP over the picture, 0 for equal ones; `None` if a picture has no place on a screen.
    pub flip: Option<f64>,
    /// Pixels with a channel that is not, bit for bit, the reference's rounded to the framebuffer's f32.
    pub bit_unequal: u64,
    /// Milliseconds of GPU time.
    pub gpu_ms: f64,
    /// What was drawn.
    pub picture: Picture,
}

/// What `--format json` prints: the keys of the contract, then further ones.
#[derive(Serialize)]
struct Output<'a> {
    #[serde(flatten)]
    verdict: &'a Verdict,
    flip: Option<f64>,
    gpu_ms: f64,
    cpu_ms: f64,
    bit_unequal: u64,
    holds: bool,
    forms: Vec<FormOutput<'a>>,
}

#[derive(Serialize)]
struct FormOutput<'a> {
    via: &'static str,
    bit_unequal: u64,
    gpu_ms: f64,
    flip: Option<f64>,
    #[serde(flatten)]
    verdict: &'a Verdict,
}

/// Draws a scene on both sides and compares.
///
/// # Errors
/// [`VerifyError`] if a side does not draw.
pub fn verify(scene: &Scene, gpu: &Gpu, options: &VerifyOptions) -> Result<Verification, VerifyError> {
    let precision = if options.tolerance.is_some() { Precision::F64 } else { Precision::Bound };
    let start = Instant::now();
    let reference = cpu::render(scene, &RenderOptions { precision, lines: cpu::LineRule::Vulkan, ..RenderOptions::default() })
        .map_err(VerifyError::Reference)?;
    let cpu_ms = start.elapsed().as_secs_f64() * 1e3;
    let judge = options.tolerance.map_or(Judge::Bound, Judge::Tolerance);
    let mut forms = Vec::new();
    for &via in &options.vias {
        let rendered = gpu.render(scene, via).map_err(VerifyError::Gpu)?;
        let verdict = Verdict::new(&rendered.picture, &reference, judge);
        forms.push(VerifiedForm {
            via,
            verdict,
            flip: is_float(scene).then(|| flip(&reference, &rendered.picture)),
            bit_unequal: bit_unequal(&rendered.picture, &reference),
            gpu_ms: rendered.milliseconds,
            picture: rendered.picture,
        });
    }
    let holds = forms.iter().all(|form| form.verdict.holds(options.allow_undecided));
    Ok(Verification { forms, reference, cpu_ms, holds })
}

/// Pixels where the GPU's f32 is another than the reference's value rounded to f32; equal NaNs count as equal.
fn bit_unequal(gpu: &Picture, reference: &Picture) -> u64 {
    let differs = |(gpu, cpu): (&[f64; 4], &[f64; 4])| {
        gpu.iter().zip(cpu).any(|(gpu, cpu)| {
            let (gpu, cpu) = (*gpu as f32, *cpu as f32);
            gpu.to_bits() != cpu.to_bits() && !(gpu.is_nan() && cpu.is_nan())
        })
    };
    let pixels = gpu.covered.len();
    let attachments = || gpu.attachments.iter().zip(&reference.attachments);
    (0..pixels)
        .filter(|&pixel| {
            attachments().any(|(gpu, cpu)| gpu.get(pixel).zip(cpu.get(pixel)).is_some_and(differs))
        })
        .count() as u64
}

impl Verification {
    /// The worse of all forms in every figure.
    fn worst(&self) -> Verdict {
        let mut verdicts = self.forms.iter().map(|form| form.verdict.clone());
        let first = verdicts.next().unwrap_or_default();
        verdicts.fold(first, |worst, verdict| worst.worse(&verdict))
    }

    /// What `--format json` prints: the worse of all forms by key, each form under `forms`.
    pub fn json(&self) -> String {
        let worst = self.worst();
        let most = |value: fn(&VerifiedForm) -> f64| self.forms.iter().map(value).fold(0.0, f64::max);
        let output = Output {
            verdict: &worst,
            flip: self.forms.iter().filter_map(|form| form.flip).reduce(f64::max),
            gpu_ms: most(|form| form.gpu_ms),
            cpu_ms: self.cpu_ms,
            bit_unequal: self.forms.iter().map(|form| form.bit_unequal).max().unwrap_or(0),
            holds: self.holds,
            forms: self
                .forms
                .iter()
                .map(|form| FormOutput {
                    via: form.via.name(),
                    bit_unequal: form.bit_unequal,
                    gpu_ms: form.gpu_ms,
                    flip: form.flip,
                    verdict: &form.verdict,
                })
                .collect(),
        };
        // Numbers, strings and lists alone: there is nothing that serialization could refuse.
        serde_json::to_string_pretty(&output).unwrap_or_default() + "\n"
    }

    /// The figures for a terminal: a column a form.
    pub fn table(&self) -> String {
        let rows: [Row; 14] = [
            ("covered pixels", |form| form.verdict.covered.to_string()),
            ("coverage mismatch", |form| form.verdict.coverage_mismatch.to_string()),
            ("edge pixels", |form| form.verdict.edge_pixels.to_string()),
            ("outside the bound", |form| form.verdict.outside.to_string()),
            ("undecided", |form| form.verdict.undecided.to_string()),
            ("not finite, GPU", |form| form.verdict.non_finite_gpu.to_string()),
            ("not finite, CPU", |form| form.verdict.non_finite_cpu.to_string()),
            ("not bit-equal", |form| form.bit_unequal.to_string()),
            ("max error", |form| format!("{:.2e}", form.verdict.max_abs)),
            ("RMSE", |form| format!("{:.2e}", form.verdict.rmse)),
            ("PSNR, dB", |form| form.verdict.psnr.map_or_else(|| "inf".into(), |psnr| format!("{psnr:.1}"))),
            ("max ULP", |form| format!("{:.1}", form.verdict.max_ulp)),
            ("FLIP", |form| form.flip.map_or_else(|| "-".into(), |flip| format!("{flip:.2e}"))),
            ("GPU ms", |form| format!("{:.2}", form.gpu_ms)),
        ];
        let mut text = format!("{:<20}", format!("judged by {}", self.worst().judged_by));
        for form in &self.forms {
            text.push_str(&format!("{:>12}", form.via.name()));
        }
        text.push('\n');
        for (name, value) in rows {
            text.push_str(&format!("{name:<20}"));
            for form in &self.forms {
                text.push_str(&format!("{:>12}", value(form)));
            }
            text.push('\n');
        }
        for form in &self.forms {
            if let Some(worst) = &form.verdict.worst {
                text.push_str(&format!(
                    "worst of {}: pixel ({}, {}): GPU {:?}, CPU {:?}, bound {:?}\n",
                    form.via.name(),
                    worst.x,
                    worst.y,
                    worst.gpu,
                    worst.cpu,
                    worst.bound
                ));
            }
        }
        text.push_str(if self.holds { "every difference is explained\n" } else { "NOT every difference is explained\n" });
        text
    }
}

/// A line of the table: its name and how to write the figure of a form.
type Row = (&'static str, fn(&VerifiedForm) -> String);

/// Whether the picture is one of colors rather than of numbers.
fn is_float(scene: &Scene) -> bool {
    use crate::scene::Format;
    matches!(scene.framebuffer.format, Format::Rgba32Float | Format::Rgba16Float | Format::Rgba8Unorm)
}
