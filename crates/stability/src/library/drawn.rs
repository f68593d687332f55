//! [`standard_programs`]: the programs of the library whose functions read uniforms, by the values of scenes.
//!
//! *In:* the library's scenes that draw with a standard program. *Out:* a [`FunctionFound`] for each: every pixel is a call, with
//! the uniforms, the mesh and the textures of the scene as its arguments. *Holds:* as for functions, an error
//! of up to [`EXPLAINED`] times the change that moving the inputs by an ULP makes is none. Figures are the same on every run.

use super::compare::{EXPLAINED, share_left};
use super::{Bound, BoundUnit, Figures, FunctionFound};
use glisten_front::compiler::{Compiler, Options};
use glisten_library::{Embedded, LibraryScene, SceneFiles};
use glisten_reference::stability::{changes_of, inputs_at, pictures_of};
use glisten_verify::evaluate::EvaluateError;
use glisten_verify::scene::{self, Scene};
use serde::Deserialize;
use std::collections::BTreeMap;

/// The module that the programs are made of.
const MODULE: &str = "standard";

/// The error that is allowed beyond what the inputs explain, as a share of the color or of 1: a few lights, with a dozen roundings each.
const PICTURE: f64 = 64.0 / 8_388_608.0;

#[derive(Deserialize)]
struct File {
    #[serde(default)]
    draw: Vec<Draw>,
}

#[derive(Deserialize)]
struct Draw {
    program: Option<String>,
}

/// A scene of the library, with the standard program that it draws with.
pub(super) struct Drawn {
    file: &'static LibraryScene,
    program: String,
}

/// The scenes that draw with a standard program: all, or those of one program, or of the module.
pub(super) fn standard_programs(only: Option<&str>) -> Vec<Drawn> {
    let drawn = glisten_library::scenes().iter().filter_map(|file| {
        let parsed: File = toml::from_str(file.text).ok()?;
        let program = parsed.draw.into_iter().find_map(|draw| draw.program)?;
        let is_asked = only.is_none_or(|only| only == MODULE || only == program);
        (program.starts_with(MODULE) && is_asked).then_some(Drawn { file, program })
    });
    drawn.collect()
}

impl Drawn {
    /// The program and the scene.
    pub(super) fn signature(&self) -> String {
        format!("{} (scene {})", self.program, self.file.name)
    }

    /// Draws it with about as many pixels as there are cases.
    pub(super) fn examine(&self, cases: usize) -> Result<FunctionFound, EvaluateError> {
        let scene = self.scene(cases)?;
        let told = |found: Vec<glisten_front::diagnostic::Diagnostic>| EvaluateError::told(&found);
        let pair = pictures_of(&scene).map_err(told)?;
        let changes = changes_of(&scene).map_err(told)?;
        let bound =
            Bound { error: PICTURE, unit: BoundUnit::Size, reason: "every light adds its roundings".to_owned() };
        let mut figures = Figures::default();
        let mut worst: Option<(usize, f64)> = None;
        let pixels = pair.exact.covered.iter().zip(&pair.errors.errors).zip(&changes).enumerate();
        for (index, ((_, error), change)) in pixels.filter(|(_, ((covered, _), _))| **covered) {
            let color =
                pair.exact.attachments.first().and_then(|colors| colors.get(index)).copied().unwrap_or_default();
            let left = (error - EXPLAINED * change).max(0.0);
            figures.add(*error, left, *change, &color);
            let judged = share_left(left, &color);
            if worst.is_none_or(|(_, most)| judged > most) {
                worst = Some((index, judged));
            }
        }
        let at = match worst {
            Some((index, _)) => arguments(&scene, pair.errors.place(index)).map_err(told)?,
            None => BTreeMap::new(),
        };
        Ok(FunctionFound {
            module: MODULE,
            function: self.program.clone(),
            signature: self.signature(),
            cases: pair.exact.covered.iter().filter(|covered| **covered).count(),
            verdict: figures.verdict(),
            within_bound: figures.unexplained <= bound.error,
            figures,
            bound: Some(bound),
            at,
            naive: None,
            cost: None,
        })
    }

    fn scene(&self, cases: usize) -> Result<Scene, EvaluateError> {
        let path = format!("<glisten>/scenes/{}.toml", self.file.name);
        let compiler = Compiler::new(Options::default()).with_includes(Embedded);
        let loaded = scene::load(&path, &SceneFiles, &compiler);
        let Some(mut scene) = loaded.scene else {
            let all: Vec<_> = loaded.diagnostics.iter().cloned().collect();
            return Err(EvaluateError::told(&all));
        };
        // The library's scenes are square.
        let side = (cases as f64).sqrt().ceil() as u32;
        (scene.framebuffer.width, scene.framebuffer.height) = (side, side);
        Ok(scene)
    }
}

/// The pixel, and its varyings.
fn arguments(
    scene: &Scene,
    pixel: [u32; 2],
) -> Result<BTreeMap<String, Vec<f64>>, Vec<glisten_front::diagnostic::Diagnostic>> {
    let mut named: BTreeMap<String, Vec<f64>> = inputs_at(scene, pixel)?.into_iter().collect();
    named.insert("pixel".to_owned(), pixel.map(f64::from).to_vec());
    Ok(named)
}
