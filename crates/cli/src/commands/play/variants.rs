//! [`variants`]: the error of variants of a scene's shading against what they cost, for the page.
//!
//! *In:* a scene, the GPU. *Out:* the report of `glisten report --ways auto` as JSON, with the picture of each variant as a
//! data URI. *Holds:* timing takes a few seconds, so what is not decided in that time is open.

use crate::files::SceneFiles;
use crate::process::machine::machine;
use glisten_front::compiler::Compiler;
use glisten_gpu::{Gpu, Via};
use glisten_play::told;
use glisten_report::{Error, Options, Ways, Weights};
use glisten_scene::picture::color_uri;
use serde_json::{Value, json};
use std::time::Duration;

/// How long variants are timed.
const TIME: Duration = Duration::from_secs(6);

/// The report.
///
/// # Errors
/// The reason why there is none.
pub(super) fn variants(scene: &str, compiler: &Compiler, gpu: &Gpu) -> Result<Value, String> {
    let options = Options {
        via: Via::Spirv,
        specialized: None,
        ways: Ways::Auto,
        weights: Weights::default(),
        rounds: None,
        time: Some(TIME),
        machine: machine(),
    };
    let report = glisten_report::run(scene, &SceneFiles, compiler, gpu, &options, &mut ()).map_err(reason)?;
    let mut answer = serde_json::to_value(&report).map_err(|error| error.to_string())?;
    let rows = answer.get_mut("ways").and_then(Value::as_array_mut).into_iter().flatten();
    for (row, way) in rows.zip(&report.ways).filter_map(|(row, way)| Some((row.as_object_mut()?, way))) {
        row.insert("title".to_owned(), json!(way.title()));
        row.insert("picture".to_owned(), json!(color_uri(&way.picture, report.encode)));
    }
    Ok(answer)
}

/// The reason why there is no report, in words.
fn reason(error: Error) -> String {
    match error {
        Error::Scene { diagnostics, .. } => told(diagnostics.iter().filter(|found| found.is_error()).take(1)),
        Error::Reference { way, diagnostics } => {
            format!("the reference cannot draw `{way}`: {}", told(diagnostics.iter().take(1)))
        }
        Error::Gpu { way, error } => format!("the GPU cannot draw `{way}`: {error}"),
        Error::Stopped => "it was ended".to_owned(),
    }
}
