//! Refuses draws that need features which WebGPU or drivers do not have.
//!
//! *In:* a draw. *Out:* an error that names the feature. *Holds:* a driver never gets a program that makes it run out of memory.

use crate::Error;
use glisten_front::link::Program;
use glisten_scene::Draw;

/// The longest stage that a driver gets, in expressions with all calls written out: drivers have no calls.
const LONGEST: u64 = 1 << 20;

/// Refuses what the adapter lacks.
pub fn refuse(draw: &Draw) -> Result<(), Error> {
    refuse_length(&draw.program)?;
    let biased = draw.textures.iter().flatten().any(|texture| texture.sampling.lod_bias != 0.0);
    if biased {
        let lacks = "a bias of the level of detail in a sampler: WebGPU has none, `bias` in the shader does the same";
        return Err(Error::Unsupported(lacks.into()));
    }
    Ok(())
}

fn refuse_length(program: &Program) -> Result<(), Error> {
    match program.stages.iter().find(|shader| shader.main_written_out() > LONGEST) {
        Some(shader) => {
            let lacks = "calls: drivers write all of them out, and";
            let length = format!("{lacks} the {} stage of `{}` is then too long", shader.stage.name(), program.name);
            Err(Error::Unsupported(length))
        }
        None => Ok(()),
    }
}
