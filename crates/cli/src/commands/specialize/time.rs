//! `--time`: a residual that draws slower than its original gives way to it.
//!
//! *In:* a scene and its residual. *Out:* the times of both, drawn in turns, and the scene to keep. *Holds:* the original stays only
//! where the residual is slower beyond the noise of the run.

use crate::exit::Failure;
use crate::scenes::{DrawError, MachineArgs};
use glisten_front::source::SourceMap;
use glisten_gpu::{Gpu, Via};
use glisten_report::{Limits, Paired, paired};
use glisten_scene::Scene;
use glisten_verify::specialize::{SpecializedScene, Times, unspecialized_scene};
use std::time::Duration;

/// The rounds of a scene: some twenty decide, and a narrow interval ends them.
const LIMITS: Limits = Limits { rounds: 60, time: Duration::from_secs(10) };

/// Draws scenes on the GPU in turns.
pub(super) struct Clock {
    gpu: Gpu,
}

impl Clock {
    /// The GPU that the arguments name.
    pub(super) fn new(machine: &MachineArgs) -> Result<Self, Failure> {
        machine.gpu().map(|gpu| Self { gpu }).map_err(failed)
    }

    /// The times, and the residual unless it is slower.
    pub(super) fn choose(
        &self,
        original: &Scene,
        sources: &SourceMap,
        residual: SpecializedScene,
        dynamic: &[String],
    ) -> Result<(SpecializedScene, Times), Failure> {
        let times = paired(&self.gpu, [original, &residual.scene], Via::Spirv, LIMITS, &mut ());
        let times = figures(&times.map_err(|error| failed(error.into()))?);
        let chosen = if times.slower { unspecialized_scene(original, sources, dynamic) } else { residual };
        Ok((chosen, times))
    }
}

fn failed(error: DrawError) -> Failure {
    match error {
        DrawError::Failure(failure) => failure,
        DrawError::Diagnostics(found) => {
            let message = found.first().map_or_else(String::new, |found| found.message.clone());
            Failure::new(crate::exit::Exit::Content, format!("the scene cannot be timed: {message}"))
        }
    }
}

fn figures(paired: &Paired) -> Times {
    Times {
        before_ms: paired.first_ms,
        after_ms: paired.second_ms,
        ratio: paired.ratio.median,
        interval: paired.ratio.interval,
        noise: paired.same_again.interval,
        rounds: paired.rounds,
        slower: paired.slower,
    }
}

/// A line of the times.
pub(super) fn line(scene: &str, times: &Times) -> String {
    let ([low, high], [again_low, again_high]) = (times.interval, times.noise);
    let verdict = if times.slower { "; the original stays, since the residual is slower" } else { "" };
    format!(
        "{scene}: draws in {:.3} ms, {:.3} ms before: {:.3} of the time [{low:.3}, {high:.3}], noise [{again_low:.3}, {again_high:.3}], \
         {} rounds{verdict}\n",
        times.after_ms, times.before_ms, times.ratio, times.rounds,
    )
}
