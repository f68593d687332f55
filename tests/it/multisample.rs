//! Multisample textures in scenes: the order of their values, their errors, and which backends draw them.

use crate::scenes::told;
use crate::support::compiler;
use glisten::scene::{Loaded, MemoryFiles, load};
use glisten_gpu::{Error, Via};
use glisten_reference::{RenderOptions, render};

const VERTEX: &str = "#version 150\n\
    void main() { gl_Position = vec4(4.0 * float(gl_VertexID & 1) - 1.0, 2.0 * float(gl_VertexID & 2) - 1.0, 0.0, 1.0); }";

/// A scene of 4 by 4 pixels that reads `tex` at `place`, given in terms of the pixel `p`.
fn scene(sampler: &str, place: &str, texture: &str) -> Loaded {
    let fragment = format!(
        "#version 150\nuniform {sampler} tex;\nout vec4 c;\n\
         void main() {{ ivec2 p = ivec2(gl_FragCoord.xy); c = vec4(texelFetch(tex, {place})); }}"
    );
    let text = format!(
        "[framebuffer]\nwidth = 4\nheight = 4\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
         [draw.textures]\ntex = {{ {texture} }}\n"
    );
    let files = MemoryFiles::new([("a.toml", text.as_str()), ("a.vert", VERTEX), ("a.frag", fragment.as_str())]);
    load("a.toml", &files, &compiler())
}

/// Numbers from 0 on.
fn counted(count: usize) -> String {
    let numbers: Vec<String> = (0..count).map(|number| number.to_string()).collect();
    format!("values = [{}]", numbers.join(", "))
}

/// The red of each pixel, bottom row first.
fn reds(pixels: &[[f64; 4]]) -> Vec<f64> {
    pixels.chunks(4).rev().flatten().map(|pixel| pixel[0]).collect()
}

#[test]
fn values_are_sample_by_sample_within_a_texel() {
    // Texel x is the column, the sample is the row.
    let loaded = scene("sampler2DMS", "ivec2(p.x, 0), p.y", &format!("width = 4, height = 1, {}", counted(64)));
    let scene = loaded.scene.as_ref().unwrap_or_else(|| panic!("{:?}", told(&loaded)));
    let picture = render(scene, &RenderOptions::default()).expect("it draws");
    let wanted: Vec<f64> = (0..16).map(|pixel| f64::from(4 * (4 * (pixel % 4) + pixel / 4))).collect();
    assert_eq!(reds(&picture.attachments[0]), wanted);
    let gpu = crate::drawing::gpu();
    for via in [Via::Spirv, Via::Wgsl] {
        let drawn = gpu.render(scene, via).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(reds(&drawn.picture.attachments[0]), wanted, "{via:?}");
    }
}

#[test]
fn arrays_and_many_samples_are_for_the_reference_alone() {
    let gpu = crate::drawing::gpu();
    // Layer y, sample x.
    let array = "width = 1, height = 1, layers = 4, samples = 4";
    let loaded = scene("isampler2DMSArray", "ivec3(0, 0, p.y), p.x", &format!("{array}, {}", counted(64)));
    let scene_of_array = loaded.scene.as_ref().unwrap_or_else(|| panic!("{:?}", told(&loaded)));
    let picture = render(scene_of_array, &RenderOptions::default()).expect("it draws");
    assert_eq!(reds(&picture.attachments[0]), (0..16).map(|pixel| f64::from(4 * pixel)).collect::<Vec<_>>());
    let refused = gpu.render(scene_of_array, Via::Spirv);
    assert!(matches!(&refused, Err(Error::Unsupported(what)) if what.contains("no multisample arrays")), "{refused:?}");
    let loaded = scene("usampler2DMS", "ivec2(0), p.x + 4", &format!("width = 1, height = 1, {}", counted(32)));
    let eight = loaded.scene.as_ref().unwrap_or_else(|| panic!("{:?}", told(&loaded)));
    let picture = render(eight, &RenderOptions::default()).expect("it draws");
    assert_eq!(reds(&picture.attachments[0])[..4], [16.0, 20.0, 24.0, 28.0]);
    let refused = gpu.render(eight, Via::Spirv);
    assert!(matches!(&refused, Err(Error::Unsupported(what)) if what.contains("8 samples")), "{refused:?}");
}

#[test]
fn mistakes_are_told() {
    let ms = |texture: &str| scene("sampler2DMS", "p, 0", texture);
    for (loaded, id, words) in [
        (
            ms("width = 2, height = 1, samples = 4, values = [1, 1, 1, 1]"),
            "E0908",
            "2 texels of 4 samples of RGBA, which takes 32 numbers, not 4",
        ),
        (ms("width = 1, height = 1, samples = 33, values = [1, 1, 1, 1]"), "E0905", "`samples`"),
        (ms("width = 1, height = 1, filter = \"linear\", values = [1, 1, 1, 1]"), "E0905", "cannot be filtered"),
        (ms("width = 1, height = 1, mipmaps = true, values = [1, 1, 1, 1]"), "E0905", "no mipmaps"),
        (ms("width = 1, height = 1, layers = 2, values = [1, 1, 1, 1]"), "E0905", "which has no `layers`"),
        (ms("kind = \"2d\", width = 1, height = 1, values = [1, 1, 1, 1]"), "E0910", "of kind `2d_multisample`"),
        (ms("pattern = \"checker\""), "E0910", ""),
        (ms("width = 1, values = [1, 1, 1, 1]"), "E0906", "no `height`"),
        (
            scene("sampler2D", "p, 0", "width = 1, height = 1, samples = 4, values = [1, 1, 1, 1]"),
            "E0905",
            "which has no `samples`",
        ),
        (
            scene("sampler2DRect", "ivec2(p)", "width = 1, height = 1, filter = \"trilinear\", values = [1, 1, 1, 1]"),
            "E0905",
            "its filter is `nearest` or `linear`",
        ),
        (
            scene("samplerBuffer", "p.x", "width = 1, filter = \"linear\", values = [1, 1, 1, 1]"),
            "E0905",
            "which cannot be filtered",
        ),
        (scene("isampler2DMS", "p, 0", "width = 1, height = 1, values = [1.5, 1, 1, 1]"), "E0910", "not a texel of it"),
    ] {
        let found = told(&loaded);
        assert!(loaded.scene.is_none() && found.iter().any(|found| found.contains(words)), "{words}: {found:?}");
        assert!(loaded.diagnostics.iter().any(|found| found.code.id == id), "{id}: {found:?}");
    }
    // Without a texture every sample is that of an incomplete one.
    let text = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n";
    let fragment =
        "#version 150\nuniform sampler2DMS tex;\nout vec4 c;\nvoid main() { c = texelFetch(tex, ivec2(0), 3); }";
    let files = MemoryFiles::new([("a.toml", text), ("a.vert", VERTEX), ("a.frag", fragment)]);
    let loaded = load("a.toml", &files, &compiler());
    let scene = loaded.scene.expect("a warning is no error");
    let picture = render(&scene, &RenderOptions::default()).expect("it draws");
    assert_eq!(picture.attachments[0][0], [0.0, 0.0, 0.0, 1.0]);
    let drawn = crate::drawing::gpu().render(&scene, Via::Spirv).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(drawn.picture.attachments[0][0], [0.0, 0.0, 0.0, 1.0]);
}
