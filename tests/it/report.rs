//! `glisten report`, end to end: the table, the JSON and the page.

use crate::support::{conforms, root};
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

const ROUNDS: &str = "\n[report]\nrounds = 3\ntessellations = [[8, 4], [16, 8]]\ntruth_tessellation = [32, 16]\n";

/// The sphere scene, small and quick, in a folder of its own.
pub(crate) fn small_scene(folder: &Path) -> std::path::PathBuf {
    let fixtures = root().join("fixtures");
    let text = std::fs::read_to_string(fixtures.join("scenes/sphere.toml")).expect("the sphere scene");
    let (scene, report) = text.split_once("[report]").expect("it has a report table");
    let ways = &report[report.find("[[report.way]]").expect("it has ways")..];
    let text = format!("{scene}{ROUNDS}{ways}")
        .replace("width = 256", "width = 48")
        .replace("height = 256", "height = 48")
        .replace("../programs", &fixtures.join("programs").to_string_lossy());
    let path = folder.join("small.toml");
    std::fs::write(&path, text).expect("written");
    path
}

fn report(scene: &Path, folder: &Path) -> Output {
    report_with(scene, &folder.join("out"), &[])
}

/// Runs the command with further arguments.
pub(crate) fn report_with(scene: &Path, out: &Path, more: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.arg("report").arg(scene).arg("-o").arg(out).args(more).output().expect("the program runs")
}

#[test]
fn error_against_run_time_of_a_sphere() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = report(&small_scene(folder.path()), folder.path());
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
    let table = String::from_utf8_lossy(&run.stdout);
    assert!(table.contains("Phong per vertex, 16x8") && table.contains("A/A control"), "{table}");
    let json = std::fs::read_to_string(folder.path().join("out/report.json")).expect("report.json");
    let report: Value = serde_json::from_str(&json).expect("it is JSON");
    let ways = report["ways"].as_array().expect("ways");
    assert_eq!(ways.len(), 8);
    for way in ways {
        assert_eq!(way["error"]["non_finite"], 0, "{way}");
        assert!(way["ratio"]["median"].as_f64().expect("a ratio") > 0.0, "{way}");
        let interval = way["ratio"]["interval"].as_array().expect("an interval");
        let [low, high] = [0, 1].map(|end| interval[end].as_f64().expect("an end"));
        assert!((low..=high).contains(&way["ratio"]["median"].as_f64().expect("a ratio")), "{way}");
        assert!(way["rounding"]["max_abs"].as_f64().expect("a figure") < 1e-3, "{way}");
    }
    let rmse = |name: &str, segments: u64| {
        let way = ways.iter().find(|way| way["name"] == name && way["tessellation"][0] == segments).expect(name);
        way["error"]["rmse"].as_f64().expect("a figure")
    };
    for model in ["Phong", "Blinn-Phong"] {
        let [vertex, fragment] = ["vertex", "fragment"].map(|stage| format!("{model} per {stage}"));
        assert!(rmse(&fragment, 16) < rmse(&vertex, 16), "{model}: shading each fragment is nearer to the truth");
        assert!(rmse(&fragment, 16) < rmse(&fragment, 8), "{model}: a finer mesh is nearer to the truth");
    }
    assert!(ways.iter().any(|way| way["pareto"] == true));
    let schema = std::fs::read_to_string(root().join("docs/report.schema.json")).expect("the schema is there");
    let schema: Value = serde_json::from_str(&schema).expect("the schema is JSON");
    assert_eq!(conforms(&report, &schema, "report"), [""; 0]);
    assert!(conforms(&serde_json::json!({ "ways": [{}] }), &schema, "broken").len() > 20, "the check finds nothing");
    assert_eq!(report["complete"], true);
}

#[test]
fn a_mistake_in_the_report_table_is_shown_where_it_stands() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = small_scene(folder.path());
    let text = std::fs::read_to_string(&path).expect("the scene").replace("rounds = 3", "round = 3");
    let line = 1 + text.lines().position(|line| line == "round = 3").expect("it is there");
    std::fs::write(&path, text).expect("written");
    let run = report(&path, folder.path());
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(1), "{told}");
    assert!(told.contains("`[report]` has no key `round`") && told.contains(&format!("small.toml:{line}:")), "{told}");
}
