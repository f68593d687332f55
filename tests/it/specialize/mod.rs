//! Specialized scenes draw the same pictures, byte for byte on the reference in f32.

#[cfg(feature = "cli")]
mod account;
mod agreement;
mod by_hand;
#[cfg(feature = "cli")]
mod command;
#[cfg(feature = "gpu")]
mod drawn;
mod library;
#[cfg(feature = "gpu")]
mod qualifiers;
#[cfg(feature = "gpu")]
mod random;
mod reach;
mod rules;
mod small;

#[cfg(feature = "gpu")]
pub(crate) use drawn::share;

use crate::optimize::places;
use glisten::Compiler;
use glisten::scene::{DiskFiles, Scene};
use glisten::source::SourceMap;
use glisten::specialize::specialize_scene;
use glisten_reference::{LineRule, Precision, RenderOptions, render};
use glisten_verify::scene;
use glisten_verify::specialize::SpecializedScene;
use std::path::{Path, PathBuf};

/// The folders of scenes. Each of `families` has an uber-shader and scenes that fix different options of it.
const FOLDERS: [&str; 8] = [
    "fixtures/scenes",
    "fixtures/scenes/core",
    "shader_lib/scenes",
    "fixtures/specialize/families/decals",
    "fixtures/specialize/families/particles",
    "fixtures/specialize/families/skinning",
    "fixtures/specialize/families/terrain",
    "fixtures/specialize/families/tiled_lights",
];

/// All scenes of these folders.
pub(crate) fn scene_files() -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in FOLDERS {
        let folder = crate::support::root().join(folder);
        for entry in std::fs::read_dir(folder).expect("a folder of scenes").filter_map(Result::ok) {
            if entry.path().extension().is_some_and(|extension| extension == "toml") {
                files.push(entry.path());
            }
        }
    }
    files.sort();
    files
}

/// A scene with its texts.
pub(crate) fn load(path: &Path) -> Option<(Scene, SourceMap)> {
    let loaded = scene::load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(glisten::Options::default()));
    loaded.scene.map(|scene| (scene, loaded.sources))
}

/// The bits of a scene's picture in f32.
pub(crate) fn bits(scene: &Scene) -> Result<Vec<u64>, String> {
    let options = RenderOptions {
        precision: Precision::F32,
        lines: LineRule::OpenGl,
        mark_edges: false,
        ..RenderOptions::default()
    };
    let picture = render(scene, &options).map_err(|found| format!("{:?}", found.first().map(|one| &one.message)))?;
    Ok(picture.attachments.iter().flatten().flatten().map(|value| value.to_bits()).collect())
}

/// How a specialized scene's picture differs.
pub(crate) fn difference(scene: &Scene, specialized: &SpecializedScene) -> Option<String> {
    difference_to(bits(scene), specialized)
}

fn difference_to(before: Result<Vec<u64>, String>, specialized: &SpecializedScene) -> Option<String> {
    let (before, after) = match (before, bits(&specialized.scene)) {
        (Ok(before), Ok(after)) => (before, after),
        (Err(_), Err(_)) => return None,
        (before, after) => return Some(format!("{:?} and {:?}", before.err(), after.err())),
    };
    let differing = before.iter().zip(&after).filter(|(a, b)| a != b).count();
    (differing > 0 || before.len() != after.len()).then(|| {
        let texts: Vec<String> = specialized
            .draws
            .iter()
            .flat_map(|draw| draw.texts.iter().map(|(stage, text)| format!("// {}\n{text}", stage.name())))
            .collect();
        format!("{differing} of {} numbers differ\n{}", before.len(), texts.join("\n"))
    })
}

#[test]
fn scenes_draw_the_same_bytes() {
    let only = std::env::var("SPECIALIZE_SCENE").ok();
    let (mut wrong, mut n_checked) = (Vec::new(), 0);
    for path in scene_files() {
        if only.as_ref().is_some_and(|only| !path.ends_with(only)) {
            continue;
        }
        let Some((scene, sources)) = load(&path) else { continue };
        let specialized = specialize_scene(&scene, &sources, &[]);
        n_checked += 1;
        let faults = specialized.draws.iter().filter_map(|draw| draw.fault.as_ref());
        wrong.extend(faults.map(|fault| format!("{}: {fault}", path.display())));
        let before = bits(&scene);
        // `compile -O` leaves out less, and must change as little.
        let optimized = crate::optimize::optimized_scene(&scene);
        let same = scene.draws.iter().zip(&optimized.draws);
        let moved = same.filter(|(a, b)| places(&a.program) != places(&b.program)).count();
        if moved > 0 || before != bits(&optimized) {
            wrong.push(format!("{}: optimized, it is another picture, or has other places", path.display()));
        }
        wrong.extend(difference_to(before, &specialized).map(|what| format!("{}: {what}", path.display())));
    }
    assert!(wrong.is_empty(), "{} of {n_checked} scenes:\n{}", wrong.len(), wrong.join("\n"));
    assert!(only.is_some() || n_checked > 100, "only {n_checked} scenes were checked");
}
