//! Draws scenes for the page, and keeps the last pictures for questions about single pixels.
//!
//! *In:* scenes. *Out:* pictures as PNG data URIs, the verdict on the driver's picture with what was judged, the numbers of a
//! pixel. *Holds:* colors are encoded as `glisten render` does.

use super::super::scenes::{MachineArgs, open_gpu};
use super::super::verify::Headline;
use crate::page::raster;
use crate::play::told;
use crate::scene::Scene;
use crate::verify::{self, Conclusion, OnGpu, Options, Runner, Verification};
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::picture::{Encoding, Picture};
use serde_json::{Value, json};
use std::time::Instant;

/// The pictures that were drawn last.
#[derive(Default)]
pub(super) struct Pictures {
    gpu: Option<Gpu>,
    reference: Option<Picture>,
    driver: Option<Picture>,
    /// For each pixel the difference as a share of its bound.
    shares: Vec<f64>,
}

impl Pictures {
    /// Draws by the reference, in f64.
    ///
    /// # Errors
    /// The reason why it cannot be drawn.
    pub(super) fn reference(&mut self, scene: &Scene) -> Result<Value, String> {
        let start = Instant::now();
        let options = RenderOptions {
            precision: Precision::F64,
            lines: LineRule::OpenGl,
            mark_edges: false,
            ..RenderOptions::default()
        };
        let picture = glisten_reference::render(scene, &options).map_err(|errors| told(&errors))?;
        let drawn = drawn(&picture, scene, start, "the reference, in f64");
        (self.reference, self.driver, self.shares) = (Some(picture), None, Vec::new());
        Ok(drawn)
    }

    /// Draws by a driver, from SPIR-V.
    ///
    /// # Errors
    /// The reason why it cannot be drawn.
    pub(super) fn driver(&mut self, scene: &Scene, machine: &MachineArgs) -> Result<Value, String> {
        let gpu = self.gpu(machine)?;
        let name = gpu.adapter().to_string();
        let start = Instant::now();
        let picture = OnGpu::new(gpu, Via::Spirv).draw(scene).map_err(|failure| failure.to_string())?.picture;
        let drawn = drawn(&picture, scene, start, &name);
        self.driver = Some(picture);
        Ok(drawn)
    }

    /// Draws by reference and driver and judges the latter, by SPIR-V and WGSL.
    ///
    /// # Errors
    /// The reason why it cannot be drawn.
    pub(super) fn compare(
        &mut self,
        scene: &Scene,
        sources: &SourceMap,
        machine: &MachineArgs,
    ) -> Result<Value, String> {
        let gpu = self.gpu(machine)?;
        let name = gpu.adapter().to_string();
        let runners = OnGpu::both(gpu);
        let runners: Vec<&dyn Runner> = runners.iter().map(|runner| runner as &dyn Runner).collect();
        let options = Options { sources: Some(sources), ..Options::default() };
        let verification = verify::verify(scene, &runners, &options).map_err(|failure| failure.to_string())?;
        let answer = judged(&verification, scene, &name);
        self.driver = verification.runs.first().map(|run| run.picture.clone());
        self.shares = verification.shares;
        self.reference = Some(verification.reference);
        Ok(answer)
    }

    /// The numbers of a pixel.
    pub(super) fn pixel(&self, x: u32, y: u32) -> Value {
        let value = |picture: &Option<Picture>| picture.as_ref().and_then(|picture| pixel(picture, x, y));
        let share = self.reference.as_ref().and_then(|picture| {
            let index = index(picture, x, y)?;
            self.shares.get(index).copied().filter(|share| share.is_finite())
        });
        json!({ "x": x, "y": y, "reference": value(&self.reference), "driver": value(&self.driver), "share": share })
    }

    fn gpu(&mut self, machine: &MachineArgs) -> Result<&Gpu, String> {
        if self.gpu.is_none() {
            let gpu = open_gpu(machine.adapter()).map_err(|error| error.to_string())?;
            self.gpu = Some(gpu.with_timeout(machine.time_limit()));
        }
        self.gpu.as_ref().ok_or_else(|| "there is no GPU".to_owned())
    }
}

fn index(picture: &Picture, x: u32, y: u32) -> Option<usize> {
    (x < picture.width && y < picture.height).then(|| y as usize * picture.width as usize + x as usize)
}

/// The numbers of a covered pixel, as text, so that those that are not finite can be told.
fn pixel(picture: &Picture, x: u32, y: u32) -> Option<Value> {
    let index = index(picture, x, y)?;
    let values = picture.attachments.first()?.get(index)?;
    let texts: Vec<String> = values.iter().map(|value| format!("{value:.7}")).collect();
    Some(json!({ "values": texts, "is_covered": picture.covered.get(index) }))
}

fn drawn(picture: &Picture, scene: &Scene, start: Instant, by: &str) -> Value {
    let milliseconds = start.elapsed().as_secs_f64() * 1e3;
    json!({
        "picture": raster::color_uri(picture, scene.framebuffer.encode),
        "width": picture.width,
        "height": picture.height,
        "milliseconds": milliseconds,
        "by": by,
        "is_empty": !picture.covered.contains(&true),
    })
}

fn judged(verification: &Verification, scene: &Scene, by: &str) -> Value {
    let encode = scene.framebuffer.encode;
    let uri = |picture: &Picture, by: Encoding| raster::color_uri(picture, by);
    let word = match verification.conclusion() {
        Conclusion::Holds => "holds",
        Conclusion::Inconclusive => "inconclusive",
        Conclusion::Fails => "fails",
    };
    json!({
        "verdict": word,
        "says": says(verification),
        "by": by,
        "width": verification.reference.width,
        "height": verification.reference.height,
        "reference": uri(&verification.reference, encode),
        "driver": verification.runs.first().map(|run| uri(&run.picture, encode)),
        "difference": uri(&verification.difference(), Encoding::default()),
        "difference_legend": verify::DIFFERENCE_LEGEND,
        "evidence": uri(&verification.evidence(), Encoding::default()),
        "evidence_legend": verify::EVIDENCE_LEGEND,
    })
}

/// The verdict in words: what to do next, and the figures of each form of the code.
fn says(verification: &Verification) -> String {
    let worst = verification.runs.iter().map(|run| run.verdict.clone()).reduce(|worse, other| worse.worse(&other));
    let next = worst.as_ref().and_then(|worst| Headline::of(verification, worst));
    let next = next.map(|headline| match headline.place {
        Some((file, line, column)) => format!("{file}:{line}:{column}: {}", headline.text),
        None => headline.text,
    });
    let figures = verification.runs.iter().map(|run| {
        let verdict = &run.verdict;
        let largest = verdict.worst.as_ref().map(|worst| {
            let from = worst.contributions.first();
            let from = from.map(|one| format!(", most of it from `{}` in {}:{}", one.operation, one.file, one.line));
            format!("; nearest to its bound at pixel {}, {}{}", worst.x, worst.y, from.unwrap_or_default())
        });
        format!(
            "{}: {}, {} of {} pixels covered, {:.1} % of them judged, {} outside; largest error {:.2e}{}",
            run.runner,
            verify::mark(verdict.conclusion(&verification.demands)),
            verdict.covered,
            verdict.pixels,
            100.0 * verdict.share_judged(&verification.demands),
            verdict.outside,
            verdict.max_abs,
            largest.unwrap_or_default(),
        )
    });
    next.into_iter().chain(figures).collect::<Vec<_>>().join("\n")
}
