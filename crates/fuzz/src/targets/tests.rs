//! Tests: `.shader_test`, and functions under `//! test`.

use super::front::compiler;
use glisten_reference::{LineRule, Precision, RenderOptions, render};
use glisten_scene::Scene;
use glisten_scene::picture::Picture;
use glisten_verify::shader_test::{TestBackend, TestResult, run};
use glisten_verify::unit_test::tests;

/// More than this takes too long to draw again and again.
const MAX_PIXELS: u32 = 64 * 64;

/// The reference, for small pictures.
struct Small;

impl TestBackend for Small {
    fn draw(&mut self, scene: &Scene) -> Result<Picture, TestResult> {
        let mut scene = scene.clone();
        let framebuffer = &mut scene.framebuffer;
        if framebuffer.width.saturating_mul(framebuffer.height) > MAX_PIXELS {
            (framebuffer.width, framebuffer.height) = (64, 64);
        }
        let options = RenderOptions {
            precision: Precision::F32,
            lines: LineRule::OpenGl,
            mark_edges: false,
            ..RenderOptions::default()
        };
        render(&scene, &options).map_err(|_| TestResult::Skip("it cannot be drawn".to_owned()))
    }
}

/// A file of piglit's form.
pub(super) fn shader_test(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let result = run("fuzzed.shader_test", &text, &compiler(), &mut Small);
    assert!(result == TestResult::Pass || result.reason().is_some_and(|reason| !reason.is_empty()), "no reason");
}

/// A source with tests.
pub(super) fn unit_test(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    for test in tests("fuzzed.glsl", &text, &compiler()).0 {
        let result = test.run(Some(&mut Small));
        assert!(result == TestResult::Pass || result.reason().is_some_and(|reason| !reason.is_empty()), "no reason");
    }
}
