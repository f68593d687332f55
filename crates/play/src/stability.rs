//! [`stability`]: what f32 arithmetic does to the picture of a scene, for the page.
//!
//! *In:* a scene. *Out:* the findings of `glisten stability` as JSON, and the map of the errors as a data URI. *Holds:* the bounds are
//! those of the scene's `[stability]` table; its sweeps are not drawn.

use super::told;
use glisten_front::source::SourceMap;
use glisten_scene::picture::{Encoding, color_uri};
use glisten_stability::settings::Settings;
use glisten_stability::{BOUND, ExamineOptions, find, heat};
use glisten_verify::scene::Scene;
use serde_json::{Value, json};

/// The findings, with the map of the errors.
///
/// # Errors
/// The reason why there are none.
pub(super) fn stability(scene: &Scene, sources: &SourceMap) -> Result<Value, String> {
    let text = sources.files().next().map(|(_, file)| (file.text(), file.base()));
    let settings = text.map_or_else(|| Ok(Settings::default()), |(text, base)| Settings::read(text, base));
    let settings = settings.map_err(|error| error.message)?;
    let bound = settings.bound.unwrap_or(BOUND);
    let mut options = ExamineOptions {
        bound,
        bound_relative: settings.bound_relative.unwrap_or(0.0),
        all: false,
        figures: false,
        progress: &mut |_, _| true,
    };
    let (findings, examined) =
        find(scene, sources, &mut options, None).map_err(|errors| told(errors.iter().take(1)))?;
    let map = heat(&examined, bound);
    let mut answer = serde_json::to_value(findings).map_err(|error| error.to_string())?;
    if let Some(answer) = answer.as_object_mut() {
        answer.insert("bound".to_owned(), json!(bound));
        answer.insert("map".to_owned(), json!(color_uri(&map, Encoding::default())));
        answer.insert("width".to_owned(), json!(map.width));
        answer.insert("height".to_owned(), json!(map.height));
    }
    Ok(answer)
}
