//! Models, pictures and profiles of lamps.

use glisten::scene::{MemoryFiles, load};
use glisten_scene::picture::Image;
use glisten_scene::profile::Profile;

use super::front::compiler;
use super::no_internal_error;

/// The scene of a model alone. The model may name files; there are none.
fn model(name: &str, input: &[u8]) {
    let mut files = MemoryFiles::default();
    files.0.insert(name.to_owned(), input.to_vec());
    let loaded = load(name, &files, &compiler());
    no_internal_error(&loaded.diagnostics);
    assert!(loaded.scene.is_some() || loaded.diagnostics.has_errors(), "neither a scene nor an error");
}

/// Wavefront OBJ.
pub(super) fn obj(input: &[u8]) {
    model("fuzzed.obj", input);
}

/// glTF as JSON.
pub(super) fn gltf(input: &[u8]) {
    model("fuzzed.gltf", input);
}

/// glTF in one file.
pub(super) fn glb(input: &[u8]) {
    model("fuzzed.glb", input);
}

/// PNG, JPEG, OpenEXR, NumPy, by their first bytes.
pub(super) fn image(input: &[u8]) {
    if let Ok(image) = Image::read(input, 4096, 1 << 20) {
        let pixels = u64::from(image.width) * u64::from(image.height);
        assert!(image.pixels.len() as u64 == pixels && pixels <= 1 << 20, "{} pixels of {pixels}", image.pixels.len());
    }
}

/// IES LM-63.
pub(super) fn ies(input: &[u8]) {
    if let Ok(profile) = Profile::parse(input) {
        let candela = (-10..=190).map(|angle| profile.candela(f64::from(angle)));
        assert!(candela.into_iter().all(|candela| candela.is_finite() && candela >= 0.0), "candela are finite");
        assert!(profile.lumen().is_finite(), "so is all of the light");
    }
}
