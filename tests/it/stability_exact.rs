//! `glisten stability --exact`, from outside: f64's own error, in numbers of 192 bits.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

const VERTEX: &str = "#version 150\nin vec2 p;\nuniform float big;\nout vec2 at;\nout float kept;\n\
    void main() { at = p; kept = (0.25 + p.x * 0.125 + big) - big; gl_Position = vec4(p, 0.0, 1.0); }\n";

/// A scene of 16x16 pixels with this body of the fragment stage, in a folder.
fn scene(folder: &Path, body: &str) -> String {
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).expect("the folder can be written");
    write("a.vert", VERTEX);
    write("a.frag", &format!("#version 150\nin vec2 at;\nin float kept;\nout vec4 o;\nvoid main() {{ {body} }}\n"));
    let scene = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        primitive = \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n\
        [draw.uniforms]\nbig = 1e19\n";
    write("a.toml", scene);
    folder.join("a.toml").to_string_lossy().into_owned()
}

fn examined(body: &str) -> (Option<i32>, Value) {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = scene(folder.path(), body);
    let output = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["stability", &scene, "--exact", "--format", "json"])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    let value = serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    (output.status.code(), value)
}

#[test]
fn f64_is_enough_for_a_sound_program() {
    let (code, found) = examined("o = vec4(sin(at.x), sqrt(abs(at.y)), 0.5, 1.0);");
    assert_eq!((code, &found["verdict"]), (Some(0), &Value::from("stable")));
    let exact = &found["exact"];
    assert!(exact["bits"].as_u64().is_some_and(|bits| bits >= 113), "{exact}");
    assert!(exact["f64_max_error"].as_f64().is_some_and(|error| error < 1e-12), "{exact}");
    assert_eq!(exact["f64_is_enough"], true);
    let pixel = &exact["pixels"][0];
    for key in ["x", "y", "f64", "exact", "error", "f64_is_enough"] {
        assert!(!pixel[key].is_null(), "{key}: {pixel}");
    }
}

#[test]
fn what_f64_cannot_compute_is_told_with_its_cause() {
    // The angle is beyond the digits of f64.
    let (code, found) = examined("float a = (at.x + 2.0) * 1e18; o = vec4(0.5 + 0.5 * sin(a * a));");
    assert_eq!(code, Some(1));
    assert_eq!(found["exact"]["f64_is_enough"], false, "{found}");
    let causes = found["causes"].as_array().expect("a list");
    assert!(causes.iter().any(|cause| cause["f64_enough"] == false), "{found}");
}

#[test]
fn the_vertex_stage_runs_in_192_bits_too() {
    // In f32 and f64 the vertices lose all digits alike, and no difference shows.
    let (code, found) = examined("o = vec4(kept, kept, kept, 1.0);");
    assert_eq!(code, Some(1), "{found}");
    assert_ne!(found["verdict"], "stable");
    for pixel in found["exact"]["pixels"].as_array().expect("a list") {
        let x = (pixel["x"].as_f64().unwrap_or_default() + 0.5) / 8.0 - 1.0;
        let exact = pixel["exact"][0].as_f64().expect("a number");
        assert!((exact - (0.25 + 0.125 * x)).abs() < 1e-9, "{pixel}");
    }
}
