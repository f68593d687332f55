//! [`Driver`]: draws scenes for the page by the driver of this machine, and judges what it draws.
//!
//! *In:* scenes. *Out:* pictures as data URIs, the verdict on the driver's picture with what was judged. *Holds:* the pictures are kept
//! for questions about single pixels ([`glisten_play::Pictures`]).

use crate::scenes::{MachineArgs, open_gpu};
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Via};
use glisten_play::{Pictures, drawn, judged};
use glisten_verify::scene::Scene;
use glisten_verify::verify::{self, OnGpu, Options, Runner};
use serde_json::Value;
use std::time::Instant;

/// The driver, opened when it is needed first.
#[derive(Default)]
pub(super) struct Driver(Option<Gpu>);

impl Driver {
    /// Draws from SPIR-V.
    ///
    /// # Errors
    /// The reason why it cannot be drawn.
    pub(super) fn draw(
        &mut self,
        scene: &Scene,
        machine: &MachineArgs,
        pictures: &mut Pictures,
    ) -> Result<Value, String> {
        let gpu = self.gpu(machine)?;
        let name = gpu.adapter().to_string();
        let picture = OnGpu::new(gpu, Via::Spirv).draw(scene).map_err(|failure| failure.to_string())?.picture;
        let drawn = drawn(&picture, scene, &name);
        pictures.take_driver(picture);
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
        pictures: &mut Pictures,
    ) -> Result<Value, String> {
        let gpu = self.gpu(machine)?;
        let name = gpu.adapter().to_string();
        let runners = OnGpu::both(gpu);
        let runners: Vec<&dyn Runner> = runners.iter().map(|runner| runner as &dyn Runner).collect();
        let options = Options { sources: Some(sources), ..Options::default() };
        let verification = verify::verify(scene, &runners, &options).map_err(|failure| failure.to_string())?;
        let answer = judged(&verification, scene, &name);
        let driver = verification.runs.first().map(|run| run.picture.clone());
        pictures.take_judged(verification.reference, driver, verification.shares);
        Ok(answer)
    }

    /// The GPU.
    ///
    /// # Errors
    /// The reason why there is none.
    pub(super) fn gpu(&mut self, machine: &MachineArgs) -> Result<&Gpu, String> {
        if self.0.is_none() {
            let gpu = open_gpu(machine.adapter()).map_err(|error| error.to_string())?;
            self.0 = Some(gpu.with_timeout(machine.time_limit()));
        }
        self.0.as_ref().ok_or_else(|| "there is no GPU".to_owned())
    }
}

/// A picture with the time that drawing it took.
///
/// # Errors
/// Those of drawing.
pub(super) fn timed(draw: impl FnOnce() -> Result<Value, String>) -> Result<Value, String> {
    let start = Instant::now();
    let mut drawn = draw()?;
    if let Some(drawn) = drawn.as_object_mut() {
        drawn.insert("milliseconds".to_owned(), (start.elapsed().as_secs_f64() * 1e3).into());
    }
    Ok(drawn)
}
