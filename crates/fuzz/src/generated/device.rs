//! Generated programs on a GPU: what it draws lies in the envelope, of whole programs for even seeds.
//!
//! *In:* a program that the reference has drawn. *Out:* a sentence where a picture differs. *Holds:* what a device lacks is no fault.

use glisten::Gpu;
use glisten::verify::{OnGpu, Options, Runner, verify};
use glisten_fuzz::checks::Drawn;
use glisten_verify::verify::Failure;

/// A check on a device.
type Check = Box<dyn Fn(&Drawn<'_>) -> Result<(), String>>;

/// The check on the device that the environment names, or on the first one.
pub(super) fn new() -> Result<Check, String> {
    let adapter = std::env::var("GLISTEN_ADAPTER").ok();
    let gpu = Gpu::new(adapter.as_deref()).map_err(|error| error.to_string())?;
    Ok(Box::new(move |drawn| {
        let whole = drawn.program.is_some_and(|program| program.seed.is_multiple_of(2));
        let runners = OnGpu::both(&gpu).map(|runner| runner.whole(whole));
        let options = Options { sources: Some(&drawn.loaded.sources), allow_inconclusive: true, ..Options::default() };
        match verify(&drawn.scene, &[&runners[0] as &dyn Runner, &runners[1]], &options) {
            Ok(verification) if !verification.holds() => Err(format!("another picture\n{verification}")),
            Err(Failure::Machine(message)) => Err(format!("the machine: {message}")),
            _ => Ok(()),
        }
    }))
}
