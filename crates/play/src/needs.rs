//! [`needs`]: what the picture of a scene does not need, for the page.
//!
//! *In:* a scene. *Out:* the account of `glisten specialize` as JSON. *Holds:* a residual that does not read back is an error.

use super::told;
use glisten_front::source::SourceMap;
use glisten_verify::scene::Scene;
use glisten_verify::specialize::{account, files_of, specialize_scene};
use serde_json::Value;

/// The account of what each draw's programs do without.
///
/// # Errors
/// The reason why there is none.
pub(super) fn needs(name: &str, scene: &Scene, sources: &SourceMap) -> Result<Value, String> {
    let specialized = specialize_scene(scene, sources, &[]);
    if let Some(fault) = specialized.draws.iter().find_map(|draw| draw.fault.as_ref()) {
        return Err(format!("internal error: what is left does not read back: {fault}"));
    }
    let name_of = |draw: &glisten_scene::Draw| {
        let [vertex, fragment] = files_of(&draw.program, sources);
        [vertex, fragment, String::new()]
    };
    let names: Vec<[String; 3]> = scene.draws.iter().map(name_of).collect();
    let account = account(name, scene, &specialized, &names).map_err(|errors| told(errors.iter().take(1)))?;
    serde_json::to_value(account).map_err(|error| error.to_string())
}
