//! Scenes: what draws, what the envelope says of it, and what is left of it.

use super::front::compiler;
use super::{no_internal_error, no_internal_errors};
use crate::Sections;
use glisten::scene::{Loaded, MemoryFiles, Scene, load};
use glisten::specialize::specialize_scene;
use glisten::verify::{Options, Runner, verify};
use glisten_reference::{Precision, RenderOptions, render};
use glisten_scene::picture::Picture;
use glisten_verify::scene::Format;
use glisten_verify::verify::{Cpu, Failure};

/// A picture for fuzzing is so wide at most.
const SIDE: u32 = 12;

/// The scene of an input: the section `scene`, which names the shaders `a.vert`, `a.geom` and `a.frag`.
fn loaded(input: &[u8]) -> Loaded {
    let text = String::from_utf8_lossy(input);
    let sections = Sections::of(&text);
    let names = [("a.toml", "scene"), ("a.vert", "vertex"), ("a.geom", "geometry"), ("a.frag", "fragment")];
    let files = names.iter().filter_map(|(file, section)| Some((*file, sections.text(section)?)));
    let loaded = load("a.toml", &MemoryFiles::new(files), &compiler());
    no_internal_error(&loaded.diagnostics);
    assert!(loaded.scene.is_some() || loaded.diagnostics.has_errors(), "neither a scene nor an error");
    loaded
}

/// The scene with a small picture.
fn small(loaded: &Loaded) -> Option<Scene> {
    let mut scene = loaded.scene.clone()?;
    let framebuffer = &mut scene.framebuffer;
    (framebuffer.width, framebuffer.height) = (framebuffer.width.min(SIDE), framebuffer.height.min(SIDE));
    Some(scene)
}

fn drawn(scene: &Scene, precision: Precision) -> Option<Picture> {
    match render(scene, &RenderOptions { precision, ..RenderOptions::default() }) {
        Ok(picture) => Some(picture),
        Err(diagnostics) => {
            assert!(!diagnostics.is_empty(), "a refusal without a reason");
            no_internal_errors(&diagnostics);
            None
        }
    }
}

/// Every precision takes what one of them takes.
pub(super) fn check(input: &[u8]) {
    let Some(scene) = small(&loaded(input)) else { return };
    let [single, exact, envelope] =
        [Precision::F32, Precision::F64, Precision::Envelope].map(|precision| drawn(&scene, precision));
    assert!(single.is_some() == exact.is_some(), "one precision draws, the other does not");
    if let Some(envelope) = envelope {
        let pixels = envelope.covered.len();
        assert!(envelope.attachments.iter().all(|one| one.len() == pixels), "pictures of different sizes");
    }
}

/// f32 without any freedom is what a conforming GPU may draw.
pub(super) fn compare(input: &[u8]) {
    let loaded = loaded(input);
    let Some(scene) = small(&loaded) else { return };
    // The reference holds whole numbers in its floats; those of f32 have fewer digits.
    if matches!(scene.framebuffer.format, Format::Rgba32Sint | Format::Rgba32Uint) {
        return;
    }
    let runner = Cpu::new(Precision::F32);
    let options = Options { sources: Some(&loaded.sources), allow_inconclusive: true, ..Options::default() };
    match verify(&scene, &[&runner as &dyn Runner], &options) {
        Ok(verification) => {
            let outside: u64 = verification.runs.iter().map(|run| run.verdict.outside).sum();
            assert!(outside == 0, "f32 is outside of the envelope:\n{verification}");
        }
        Err(Failure::Diagnostics(diagnostics)) => no_internal_errors(&diagnostics),
        Err(_) => {}
    }
}

/// Leaving out moves no bit.
pub(super) fn specialize(input: &[u8]) {
    let loaded = loaded(input);
    let Some(scene) = small(&loaded) else { return };
    let Some(before) = drawn(&scene, Precision::F32) else { return };
    let left = specialize_scene(&scene, &loaded.sources, &[]);
    let texts = || left.draws.iter().flat_map(|draw| &draw.texts).map(|(_, text)| text.as_str()).collect::<String>();
    let Some(after) = drawn(&left.scene, Precision::F32) else { panic!("what is left does not draw:\n{}", texts()) };
    let bits = |picture: &Picture| -> Vec<u64> {
        picture.attachments.iter().flatten().flatten().map(|value| value.to_bits()).collect()
    };
    assert!(bits(&before) == bits(&after), "what is left draws something else:\n{}", texts());
}
