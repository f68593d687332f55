//! Ranges of interpolated values: known where no triangle is so thin that fragments lie far outside of it.

use super::difference;
use glisten::Compiler;
use glisten::scene::MemoryFiles;
use glisten::source::SourceMap;
use glisten::specialize::specialize_scene;
use glisten_front::hir::Stage;
use glisten_verify::scene;

const VERTEX: &str = "#version 150\nin vec4 p;\nin vec2 q;\nuniform mat2 turn;\nout vec2 v;\n\
    void main() { v = q; gl_Position = vec4(turn * p.xy, p.zw); }\n";
const FRAGMENT: &str = "#version 150\nin vec2 v;\nuniform float none;\nout vec4 color;\n\
    void main() { color = vec4(v.x * none, max(v.y + 8.0, 0.0), 0.5, 1.0); }\n";

/// What is left of the fragment stage of a triangle with these corners (x, y, z, w).
fn left(corners: &str, primitive: &str, dynamic: &str) -> String {
    let text = format!(
        "[framebuffer]\nwidth = 64\nheight = 64\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
         primitive = \"{primitive}\"\ndynamic = [{dynamic}]\n[draw.attributes]\np = {{ size = 4, values = [{corners}] }}\n\
         q = {{ size = 2, values = [0.0, 0.5, 1.0, -2.0, 3.0, 4.0] }}\n[draw.uniforms]\nturn = [1, 0, 0, 1]\nnone = 0.0\n"
    );
    let files = MemoryFiles::new([("a.toml", text.as_str()), ("a.vert", VERTEX), ("a.frag", FRAGMENT)]);
    let loaded = scene::load("a.toml", &files, &Compiler::new(glisten::Options::default()));
    let messages: Vec<_> = loaded.diagnostics.iter().map(|found| found.message.clone()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{messages:?}"));
    let specialized = specialize_scene(&scene, &SourceMap::default(), &[]);
    assert_eq!(difference(&scene, &specialized), None);
    specialized.draws.first().expect("a draw").text(Stage::Fragment).to_owned()
}

#[test]
fn what_is_interpolated_within_bounds_frees_its_factors() {
    let cases = [
        ("a triangle", "-1, -1, 0, 1,  1, -1, 0, 1,  0, 1, 0, 1", "triangles"),
        ("one with perspective", "-1, -1, 0, 1,  4, -4, 0, 4,  0, 2, 0, 2", "triangles"),
        ("one that is clipped", "-3, -1, 0, 1,  3, -1, 0, 1,  0, 5, 0, 1", "triangles"),
        ("points", "-0.5, -0.5, 0, 1,  0.5, -0.5, 0, 1,  0, 0.5, 0, 1", "points"),
        ("a thin one without fragments", "-0.5, 0.0, 0, 1,  0.5, 0.0, 0, 1,  0.5, 0.0001, 0, 1", "triangles"),
    ];
    for (what, corners, primitive) in cases {
        let text = left(corners, primitive, "");
        assert!(!text.contains("none") && !text.contains("max("), "{what}:\n{text}");
    }
}

#[test]
fn what_may_be_interpolated_beyond_its_vertices_does_not() {
    let row = -1.0 + 2.0 * 20.5 / 64.0;
    let thin = format!("-0.9, {row}, 0, 1,  0.9, {row}, 0, 1,  0.9, {}, 0, 1", row + 1e-4);
    let cases = [
        ("a thin triangle along a row of pixels", thin.as_str(), "triangles", ""),
        (
            "positions that change from frame to frame",
            "-1, -1, 0, 1,  1, -1, 0, 1,  0, 1, 0, 1",
            "triangles",
            "\"turn\"",
        ),
        ("a line", "-1, -1, 0, 1,  1, -1, 0, 1,  0, 1, 0, 1", "line_strip", ""),
        ("steep perspective", "-1, -1, 0, 1,  900, -900, 0, 900,  0, 2, 0, 2", "triangles", ""),
        ("a position that is not finite", "-1, -1, 0, 1,  1, -1, 0, 1,  0, nan, 0, 1", "triangles", ""),
    ];
    for (what, corners, primitive, dynamic) in cases {
        let text = left(corners, primitive, dynamic);
        assert!(text.contains("none") && text.contains("max("), "{what}:\n{text}");
    }
}
