//! `glisten new-scene MODEL`: writes the scene of a model from the disk.
//!
//! *In:* an OBJ or glTF file. *Out:* the scene that `glisten render MODEL` draws, as TOML.

use crate::console::Console;
use crate::exit::{Exit, Failure, Outcome};
use crate::files::{self, SceneFiles};
use glisten_verify::scene::{PortraitError, portrait};
use std::path::Path;

/// Writes the scene of the model at `path`, which the scene names as `name`.
pub(crate) fn run(path: &str, name: &str, output: Option<&Path>, console: &Console) -> Outcome {
    let made = portrait(path, name, &SceneFiles).map_err(|error| match error {
        PortraitError::File(error) => Failure::usage(format!("cannot read `{path}`: {error}")),
        PortraitError::Model(error) => Failure::new(Exit::Content, format!("`{path}`: {error}")),
        PortraitError::Part(error) => Failure::usage(format!("`{path}`: {error}")),
    })?;
    for remark in &made.remarks {
        console.remark(&format!("note: `{path}`: {remark}"));
    }
    match output {
        Some(output) => {
            files::write(output, made.text.as_bytes())?;
            console.remark(&format!("wrote {}", output.display()));
        }
        None => console.output(&made.text)?,
    }
    Ok(Exit::Ok)
}
