//! `glisten report --ways auto`, end to end, for a scene that is not of the library.

use super::report::report_with;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

const VERTEX: &str = "#version 150
in vec3 p;
uniform mat4 mvp;
out vec3 n;
void main() { n = p; gl_Position = mvp * vec4(p, 1.0); }
";

/// Rim light and a highlight, as programs of engines have them.
const FRAGMENT: &str = "#version 150
in vec3 n;
uniform vec3 sun;
uniform vec3 tint;
uniform float gloss;
out vec4 color;
float rim(float facing, float width) { return exp(-facing * facing / width); }
void main() {
    vec3 N = normalize(n);
    float facing = max(N.z, 0.0);
    float lit = max(dot(N, sun), 0.0);
    color = vec4(tint * lit + pow(lit, gloss) + rim(facing, 0.2) * vec3(0.1, 0.2, 0.3), 1.0);
}
";

const SCENE: &str = r#"
[framebuffer]
width = 48
height = 48
[camera]
eye = [0.0, 0.0, 3.0]
[[draw]]
vertex = "rim.vert"
fragment = "rim.frag"
cull = "back"
mesh = { shape = "sphere", position = "p", segments = 16, rings = 8 }
matrices = { mvp = "model_view_projection" }
uniforms = { sun = [0.6, 0.64, 0.48], tint = [0.5, 0.3, 0.2], gloss = 16.0 }
"#;

fn report(folder: &Path, out: &str) -> Value {
    for (name, text) in [("rim.vert", VERTEX), ("rim.frag", FRAGMENT), ("rim.toml", SCENE)] {
        fs::write(folder.join(name), text).expect("the folder can be written to");
    }
    let more = ["--ways", "auto", "--rounds", "6", "--seconds", "1"];
    let run = report_with(&folder.join("rim.toml"), &folder.join(out), &more);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let json = fs::read_to_string(folder.join(out).join("report.json")).expect("report.json");
    serde_json::from_str(&json).expect("it is JSON")
}

/// The figures of a way that are the same on every run.
fn fixed(report: &Value) -> Vec<String> {
    let ways = report["ways"].as_array().expect("ways");
    ways.iter().map(|way| format!("{} {} {} {}", way["name"], way["work"], way["error"], way["pareto"])).collect()
}

#[test]
fn ways_are_found_for_a_scene_that_is_not_of_the_library() {
    let folder = tempfile::tempdir().expect("a folder");
    let first = report(folder.path(), "a");
    let ways = first["ways"].as_array().expect("ways");
    let kinds: BTreeSet<&str> = ways.iter().filter_map(|way| way["kind"].as_str()).collect();
    for kind in
        ["as written", "specialized", "pow", "schlick", "inversesqrt", "vertex", "table", "tessellation", "f16", "f64"]
    {
        assert!(kinds.contains(kind), "{kind} is not among {kinds:?}");
    }
    assert!((12..=28).contains(&ways.len()), "{} ways", ways.len());
    let of = |name: &str| ways.iter().find(|way| way["name"] == name).unwrap_or_else(|| panic!("no way `{name}`"));
    let figure = |name: &str, group: &str, key: &str| of(name)[group][key].as_f64().expect("a number");
    // Squaring is the power; a table is not, and a finer one is nearer.
    assert!(figure("powers by squaring", "error", "max_abs") < 1e-4);
    let coarse = figure("table of 16 texels, linear", "error", "rmse");
    assert!(coarse > 4.0 * figure("table of 64 texels, linear", "error", "rmse"));
    assert!(figure("table of 64 texels, linear", "work", "texture_lookups") > 0.0);
    assert!(figure("powers by squaring", "work", "operations") < figure("specialized", "work", "operations"));
    let [half, single] = ["f16", "specialized"].map(|name| figure(name, "error", "rmse"));
    assert!(half > 50.0 * single && half < 0.01, "{half} against {single}");
    assert_eq!((&of("f16")["floats"], &of("f64")["via"]), (&Value::from("f16"), &Value::from("spirv")));
    assert!(figure("per vertex", "work", "operations") < figure("specialized", "work", "operations"));
    assert_eq!(fixed(&first), fixed(&report(folder.path(), "b")));
}
