//! Helpers of the tests that draw: scenes from files and texts, the reference, the device, and `verify` with pictures
//! of failures.

pub(crate) use crate::support::compiler;
use crate::support::root;
use glisten::scene::{DiskFiles, Loaded, MemoryFiles, Scene, load};
use glisten_reference::domain::faults::Faults;
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::picture::Picture;
use std::path::Path;

#[cfg(feature = "gpu")]
use glisten::verify::{OnGpu, Runner, Verification, verify};
#[cfg(feature = "gpu")]
use glisten_gpu::Gpu;

/// The scene of a loaded file.
#[track_caller]
pub(crate) fn loaded(name: &str, loaded: Loaded) -> Scene {
    let messages: Vec<&str> = loaded.diagnostics.iter().map(|found| found.message.as_str()).collect();
    loaded.scene.unwrap_or_else(|| panic!("{name}: {}", messages.join("; ")))
}

/// A scene of the package by its path in it, or of any folder.
#[track_caller]
pub(crate) fn from_disk(path: impl AsRef<Path>) -> Scene {
    let path = root().join(path);
    let name = path.to_string_lossy();
    loaded(&name, load(&name, &DiskFiles, &compiler()))
}

/// A scene from texts by name, the scene file first.
#[track_caller]
pub(crate) fn from_texts<const N: usize>(files: [(&str, &str); N]) -> Scene {
    let name = files.first().map_or("", |file| file.0);
    loaded(name, load(name, &MemoryFiles::new(files), &compiler()))
}

/// Options of the reference with Vulkan's rule for lines, as on a GPU.
pub(crate) fn as_on_vulkan(precision: Precision, faults: Faults) -> RenderOptions {
    RenderOptions { precision, lines: LineRule::Vulkan, faults, ..RenderOptions::default() }
}

/// The reference's picture, with Vulkan's rule for lines.
#[track_caller]
pub(crate) fn reference(scene: &Scene, precision: Precision) -> Picture {
    let drawn = glisten_reference::render(scene, &as_on_vulkan(precision, Faults::NONE));
    drawn.unwrap_or_else(|found| panic!("the reference cannot draw it: {found:?}"))
}

/// The first software adapter.
#[cfg(feature = "gpu")]
pub(crate) fn gpu() -> Gpu {
    Gpu::new(Some("software")).expect("these tests need Mesa's Vulkan driver: apt-get install mesa-vulkan-drivers")
}

/// Options of `verify` that excuse nothing.
#[cfg(feature = "gpu")]
pub(crate) fn strict() -> glisten::verify::Options<'static> {
    glisten::verify::Options { excuse_known_faults: false, ..glisten::verify::Options::default() }
}

/// Verifies a scene in both forms of the emitted code. The pictures of a failure are written to
/// `target/failures/NAME`, which the message names.
#[cfg(feature = "gpu")]
#[track_caller]
pub(crate) fn verified(name: &str, gpu: &Gpu, scene: &Scene, options: &glisten::verify::Options<'_>) -> Verification {
    let folder = root().join("target/failures").join(name);
    let options = glisten::verify::Options { failures: Some(&folder), ..*options };
    let runners = OnGpu::both(gpu);
    let runners = [&runners[0] as &dyn Runner, &runners[1]];
    verify(scene, &runners, &options).unwrap_or_else(|failure| panic!("{name}: {failure}"))
}

/// The message if [`verified`] fails for a scene; `None` if every difference is explained, however little is judged.
#[cfg(feature = "gpu")]
#[track_caller]
pub(crate) fn complaint(
    name: &str,
    gpu: &Gpu,
    scene: &Scene,
    options: &glisten::verify::Options<'_>,
) -> Option<String> {
    let verification = verified(name, gpu, scene, options);
    assert!(verification.reference.covered.contains(&true), "{name}: nothing is drawn");
    verification.fails().then(|| format!("{name}\n{verification}"))
}
