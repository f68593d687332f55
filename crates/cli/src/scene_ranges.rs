//! Ranges of inputs from scenes: what their uniforms and attributes are.
//!
//! *In:* scene files. *Out:* for the files that a scene draws, the least and the greatest number of each uniform and attribute, by name.
//! *Holds:* the numbers of several scenes and draws are joined. A matrix has no range: its elements do not vary by themselves.

use crate::arguments::bounds::Bounds;
use crate::exit::{Exit, Failure};
use crate::inputs::identity;
use glisten_front::compiler::Compiler;
use glisten_front::hir::ScalarValue;
use glisten_scene::values::{LeafShape, of_leaf};
use glisten_verify::scene::{self, AttributeValues, DiskFiles, Draw};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The ranges of the files that scenes draw.
#[derive(Debug, Default)]
pub(crate) struct SceneRanges(BTreeMap<PathBuf, BTreeMap<String, [f64; 2]>>);

impl SceneRanges {
    /// The ranges of these scenes.
    ///
    /// # Errors
    /// A scene that cannot be loaded.
    pub(crate) fn read(scenes: &[PathBuf], compiler: &Compiler) -> Result<Self, Failure> {
        let mut ranges = Self::default();
        for path in scenes {
            let name = path.to_string_lossy();
            let loaded = scene::load(&name, &DiskFiles, compiler);
            let Some(scene) = loaded.scene else {
                let first = loaded.diagnostics.iter().find(|found| found.is_error()).map(|found| found.message.clone());
                let exit = if loaded.io_error { Exit::Usage } else { Exit::Content };
                return Err(Failure::new(exit, format!("`{name}`: {}", first.unwrap_or_default())));
            };
            let mut found = BTreeMap::new();
            scene.draws.iter().for_each(|draw| add(draw, &mut found));
            for (_, file) in loaded.sources.files() {
                let own = ranges.0.entry(identity(Path::new(file.name()))).or_default();
                found.iter().for_each(|(name, range)| widen(own, name, *range));
            }
        }
        Ok(ranges)
    }

    /// The ranges of a file.
    pub(crate) fn of(&self, file: &Path) -> Vec<(String, Bounds)> {
        if self.0.is_empty() {
            return Vec::new();
        }
        let own = self.0.get(&identity(file)).into_iter().flatten();
        own.map(|(name, range)| (name.clone(), Bounds::Within(*range))).collect()
    }
}

fn widen(ranges: &mut BTreeMap<String, [f64; 2]>, name: &str, [low, high]: [f64; 2]) {
    if low.is_finite() && high.is_finite() {
        let known = ranges.entry(name.to_owned()).or_insert([low, high]);
        *known = [known[0].min(low), known[1].max(high)];
    }
}

/// Adds what a draw has.
fn add(draw: &Draw, ranges: &mut BTreeMap<String, [f64; 2]>) {
    let interface = &draw.program.interface;
    for leaf in &interface.uniforms {
        let Some(shape) = LeafShape::of(&draw.program.types, leaf).filter(|shape| shape.columns == 1) else { continue };
        for value in of_leaf(&draw.uniforms, leaf, shape) {
            let number = match *value {
                ScalarValue::Bool(value) => f64::from(u8::from(value)),
                ScalarValue::Int(value) => f64::from(value),
                ScalarValue::Uint(value) => f64::from(value),
                ScalarValue::Float(value) => f64::from(value),
            };
            widen(ranges, &leaf.name, [number, number]);
        }
    }
    for (attribute, data) in interface.attributes.iter().zip(&draw.attributes) {
        let Some(data) = data else { continue };
        let mut all: Box<dyn Iterator<Item = f64>> = match &data.values {
            AttributeValues::Float(values) => Box::new(values.iter().map(|value| f64::from(*value))),
            AttributeValues::Int(values) => Box::new(values.iter().map(|value| f64::from(*value))),
            AttributeValues::Uint(values) => Box::new(values.iter().map(|value| f64::from(*value))),
        };
        all.by_ref().for_each(|number| widen(ranges, &attribute.name, [number, number]));
    }
}
