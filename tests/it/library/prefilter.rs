//! `glisten lib prefilter`, end to end: a panorama in closed form, read by the module's functions.

use super::command::{err, out, run};
use super::function;
use glisten::scene::{DiskFiles, load};
use glisten_reference::Precision;
use glisten_scene::picture::Image;
use glisten_verify::scene::Texture;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// A panorama of Radiance's HDR: 1 + y / 2, in rows without runs.
fn panorama(width: usize, height: usize) -> Vec<u8> {
    let mut bytes = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
    for row in 0..height {
        let up = (std::f64::consts::PI * (row as f64 + 0.5) / height as f64).cos();
        // Mantissas of the exponent 2: the values are (m + 1/2) / 128.
        let mantissa = ((1.0 + up / 2.0) * 128.0 - 0.5).round() as u8;
        bytes.extend([mantissa, mantissa, mantissa, 129].repeat(width));
    }
    bytes
}

/// A picture as a texture, as scenes load it.
fn texture(folder: &Path) -> Arc<Texture> {
    let vertex = "#version 150\nvoid main() { gl_Position = vec4(0.0); }\n";
    let fragment = "#version 150\nuniform sampler2D a;\nout vec4 c;\nvoid main() { c = texture(a, vec2(0.5)); }\n";
    let scene = "[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\
        textures = { a = { file = \"radiance.exr\", wrap = \"clamp\" } }\n";
    for (name, text) in [("a.vert", vertex), ("a.frag", fragment), ("a.toml", scene)] {
        fs::write(folder.join(name), text).expect("written");
    }
    let path = folder.join("a.toml").display().to_string();
    let loaded = load(&path, &DiskFiles, &crate::support::compiler());
    loaded.scene.expect("it is good").draws[0].textures[0].clone().expect("it has a texture")
}

#[test]
fn maps_are_those_of_the_panorama() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (input, output) = (folder.path().join("sky.hdr"), folder.path().join("maps"));
    fs::write(&input, panorama(64, 32)).expect("written");
    let (input, place) = (input.display().to_string(), output.display().to_string());
    let run =
        run(&["prefilter", &input, "-o", &place, "--size", "17", "--levels", "3", "--rays", "256", "--format", "json"]);
    assert_eq!(run.status.code(), Some(0), "{}", err(&run));
    assert!(err(&run).contains("radiance.exr (17 by 51 texels, 3 roughnesses)"), "{}", err(&run));
    let found: Value = serde_json::from_str(&out(&run)).expect("JSON");
    let all = found.as_array().expect("a list");
    for row in all {
        // The split sum takes the lobe of an eye straight above.
        let most = if row["of"] == "split sum" { 0.4 } else { 0.03 };
        assert!(row["most"].as_f64().expect("a number") < most, "{row}");
    }
    assert_eq!(all.len(), 11);
    let read =
        |name: &str| Image::read(&fs::read(output.join(name)).expect("written"), 4096, 1 << 24).expect("OpenEXR");
    let (maps, split) = (read("radiance.exr"), read("split_sum.exr"));
    assert_eq!((maps.width, maps.height, split.width, split.height), (17, 51, 32, 32));
    // L_00 is 2 sqrt(pi), and L_1-1, which goes with y, half of sqrt(4 pi / 3).
    let text = fs::read_to_string(output.join("irradiance.toml")).expect("written");
    let table: toml::Table = text.parse().expect("TOML");
    let numbers: Vec<f64> =
        table["coefficients"].as_array().expect("a list").iter().filter_map(toml::Value::as_float).collect();
    assert_eq!(numbers.len(), 27);
    for (index, number) in numbers.iter().enumerate() {
        let wanted = match index / 3 {
            0 => 3.544_908,
            1 => 1.023_327,
            _ => 0.0,
        };
        assert!((number - wanted).abs() < 5e-3, "{index}: {number}");
    }
    // The module's lookup: a lobe multiplies the slope by its mean cosine, which is 2 / 3 for the roughness 1.
    let lookup = function("environment", "environmentRadiance(sampler2D,vec3,float)", &[]);
    let maps = [texture(&output)];
    for (roughness, slope) in [(0.0_f32, 0.5), (1.0, 1.0 / 3.0)] {
        for d in [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, -0.8], [-0.48, -0.6, 0.64], [0.36, 0.48, 0.8_f32]] {
            let rows = [d[0], d[1], d[2], roughness];
            let found = lookup.reference(&rows, &maps, Precision::F32).expect("it is called")[0][0];
            let wanted = 1.0 + slope * f64::from(d[1]);
            assert!((found - wanted).abs() < 1e-2, "{roughness} {d:?}: {found} {wanted}");
        }
    }
}

#[test]
fn wrong_panoramas_are_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = |name: &str| folder.path().join(name).display().to_string();
    fs::write(path("square.hdr"), panorama(16, 16)).expect("written");
    fs::write(path("text.hdr"), "no picture").expect("written");
    for (name, code, message) in [
        ("square.hdr", 1, "it is 16 by 16, and a panorama is twice as wide as high"),
        ("text.hdr", 1, "it is none of PNG"),
        ("lost.hdr", 2, "lost.hdr"),
    ] {
        let run = run(&["prefilter", &path(name), "-o", &path("out")]);
        assert_eq!(run.status.code(), Some(code), "{}", err(&run));
        assert!(err(&run).contains(message), "{}", err(&run));
    }
}

#[test]
fn what_is_no_panorama_is_refused_before_it_is_decoded() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let input = folder.path().join("square.hdr");
    // There are no pixels behind the header.
    fs::write(&input, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8192 +X 8192\n").expect("written");
    let output = folder.path().join("maps");
    let refused = run(&["prefilter", &input.display().to_string(), "-o", &output.display().to_string()]);
    assert_eq!(refused.status.code(), Some(1));
    assert!(err(&refused).contains("it is 8192 by 8192, and a panorama is twice as wide as high"), "{}", err(&refused));
    fs::write(&input, "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32768 +X 65536\n").expect("written");
    let refused = run(&["prefilter", &input.display().to_string(), "-o", &output.display().to_string()]);
    assert!(err(&refused).contains("at most 134217728 with sides of 16384 are read"), "{}", err(&refused));
    assert!(!output.exists());
}
