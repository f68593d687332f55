//! The command `glisten stability` from the outside.

use crate::cli::{Folder, code, err, out};
use serde_json::Value;
use std::fs;

const VERTEX: &str =
    "#version 150\nin vec2 p;\nout vec2 at;\nvoid main() {\n    at = p;\n    gl_Position = vec4(p, 0.0, 1.0);\n}\n";
const SCENE: &str = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \
    \"triangle_strip\"\n[draw.attributes]\np = { size = 2, values = [-1, -1, 1, -1, -1, 1, 1, 1] }\n";
/// The line 6 cancels for small `size`.
const FRAGMENT: &str = "#version 150\nin vec2 at;\nuniform float size;\nout vec4 o;\nvoid main() {\n    float c = 1.0 - cos(size * \
    (at.x + 2.0));\n    o = vec4(c / (size * size), 0.0, 0.0, 1.0);\n}\n";

fn folder(size: f64, more: &str) -> Folder {
    let scene = format!("{SCENE}[draw.uniforms]\nsize = [{size}]\n{more}");
    Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", FRAGMENT.as_bytes()), ("a.toml", scene.as_bytes())])
}

fn json(folder: &Folder, arguments: &[&str]) -> (i32, Value) {
    let output = folder.run(&[&["stability", "a.toml", "--format", "json"], arguments].concat());
    let text = out(&output);
    (code(&output), serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}{}", err(&output))))
}

#[test]
fn the_json_has_the_keys_of_the_contract() {
    let (exit, found) = json(&folder(1e-3, ""), &[]);
    assert_eq!((exit, found["verdict"].as_str()), (1, Some("degraded")));
    for key in ["verdict", "picture", "non_finite", "causes"] {
        assert!(!found[key].is_null(), "{key}: {found}");
    }
    let worst = &found["picture"]["worst"];
    assert!(worst["x"].is_u64() && worst["y"].is_u64(), "{worst}");
    assert_eq!((worst["f32"].as_array().map(Vec::len), worst["exact"].as_array().map(Vec::len)), (Some(4), Some(4)));
    assert_eq!(worst["inputs"]["at"].as_array().map(Vec::len), Some(2), "{worst}");
    let cause = &found["causes"][0];
    assert_eq!((cause["file"].as_str(), cause["line"].as_u64()), (Some("a.frag"), Some(6)), "{cause}");
    assert_eq!((cause["kind"].as_str(), cause["stage"].as_str()), (Some("cancellation"), Some("fragment")));
    for key in [
        "column",
        "end_line",
        "end_column",
        "harm",
        "lost_bits",
        "condition",
        "non_finite",
        "disagreements",
        "where",
        "help",
    ] {
        assert!(!cause[key].is_null(), "{key}: {cause}");
    }
    assert!(cause["harm"].as_f64() >= Some(0.9 * found["picture"]["max_abs"].as_f64().unwrap_or(1.0)));
}

#[test]
fn a_stable_scene_exits_0_and_bounds_come_from_the_command_line_the_scene_or_the_project() {
    let (exit, found) = json(&folder(0.5, ""), &[]);
    assert_eq!(
        (exit, found["verdict"].as_str(), found["causes"].as_array().map(Vec::len)),
        (0, Some("stable"), Some(0))
    );
    let (exit, found) = json(&folder(1e-3, ""), &["--bound", "10"]);
    assert_eq!((exit, found["verdict"].as_str()), (0, Some("stable")));
    let (exit, found) = json(&folder(1e-3, "[stability]\nbound = 10.0\n"), &[]);
    assert_eq!((exit, found["bound"].as_f64()), (0, Some(10.0)));
    let project = folder(1e-3, "");
    fs::write(project.path("glisten.toml"), b"[stability.bounds]\n\"b*.toml\" = 1e-6\n\"*.toml\" = 10.0\n")
        .expect("written");
    let (exit, found) = json(&project, &[]);
    assert_eq!((exit, found["bound"].as_f64()), (0, Some(10.0)));
}

#[test]
fn a_sweep_examines_the_worst_value() {
    let (exit, found) = json(&folder(0.5, ""), &["--sweep", "size=1e-4..1:5"]);
    assert_eq!((exit, found["verdict"].as_str()), (1, Some("degraded")));
    let points = found["sweep"]["points"].as_array().map_or(0, Vec::len);
    assert_eq!((points, found["sweep"]["worst"]["values"]["size"].as_f64()), (5, Some(1e-4)));
    let (_, same) = json(&folder(0.5, "[stability.sweep]\nsize = [1e-4, 1.0, 5]\n"), &[]);
    assert_eq!(same["sweep"], found["sweep"]);
    let unknown = folder(0.5, "").run(&["stability", "a.toml", "--sweep", "siz=0..1"]);
    assert_eq!(code(&unknown), 1);
    assert!(err(&unknown).contains("did you mean `size`"), "{}", err(&unknown));
    let malformed = folder(0.5, "").run(&["stability", "a.toml", "--sweep", "size=0"]);
    assert_eq!(code(&malformed), 2, "{}", err(&malformed));
}

#[test]
fn a_search_finds_the_stiff_value_and_writes_a_scene_that_shows_it() {
    let folder = folder(0.5, "");
    let (exit, found) = json(&folder, &["--stiff", "--worst", "worst.toml"]);
    assert_eq!(exit, 1, "{found}");
    let changed = &found["stiff"]["changed"];
    assert!(changed.to_string().contains("size"), "{changed}");
    let again = folder.run(&["stability", "worst.toml", "--format", "json"]);
    let again: Value = serde_json::from_str(&out(&again)).unwrap_or(Value::Null);
    assert_eq!(again["verdict"], found["verdict"], "the scene shows what was found");
    assert_eq!(again["picture"]["max_abs"], found["picture"]["max_abs"]);
}

#[test]
fn a_stated_range_limits_the_search() {
    let folder = folder(0.5, "[stability.range]\nsize = [0.4, 1.0]\n");
    let (exit, found) = json(&folder, &["--stiff"]);
    assert_eq!((exit, found["verdict"].as_str()), (0, Some("stable")), "{found}");
}

#[test]
fn all_tells_causes_below_the_bound() {
    let (exit, found) = json(&folder(0.05, ""), &["--all", "--bound", "0.01"]);
    assert_eq!((exit, found["verdict"].as_str()), (0, Some("stable")));
    assert_eq!(found["causes"][0]["line"].as_u64(), Some(6), "{found}");
}

#[test]
fn people_sarif_and_github_see_the_line() {
    let folder = folder(1e-3, "");
    let human = out(&folder.run(&["stability", "a.toml"]));
    assert!(human.contains("a.frag:6:") && human.contains("cancellation") && human.contains("help:"), "{human}");
    let github = out(&folder.run(&["stability", "a.toml", "--format", "github"]));
    assert!(github.starts_with("::warning file=a.frag,line=6"), "{github}");
    let sarif = out(&folder.run(&["stability", "a.toml", "--format", "sarif"]));
    let sarif: Value = serde_json::from_str(&sarif).unwrap_or(Value::Null);
    assert_eq!(sarif["runs"][0]["results"][0]["ruleId"].as_str(), Some("W0920"), "{sarif}");
}

#[test]
fn a_folder_of_scenes_is_guarded_by_one_command() {
    let folder = folder(1e-3, "");
    fs::write(folder.path("b.toml"), SCENE.as_bytes()).expect("written");
    let output = folder.run(&["stability", ".", "--format", "json"]);
    let found: Value = serde_json::from_str(&out(&output)).unwrap_or(Value::Null);
    let verdicts: Vec<&str> =
        found.as_array().into_iter().flatten().filter_map(|scene| scene["verdict"].as_str()).collect();
    // With size 0 the second divides by 0.
    assert_eq!((code(&output), verdicts), (1, vec!["degraded", "broken"]), "{}", err(&output));
}

#[test]
fn the_heat_map_is_a_picture_of_the_same_size() {
    let folder = folder(1e-3, "");
    let output = folder.run(&["stability", "a.toml", "--heat", "heat.png"]);
    assert_eq!(code(&output), 1, "{}", err(&output));
    let png = fs::read(folder.path("heat.png")).expect("it was written");
    assert_eq!((&png[1..4], &png[16..24]), (&b"PNG"[..], &[0, 0, 0, 16, 0, 0, 0, 16][..]));
}

#[test]
fn figures_are_the_same_on_every_run_and_with_any_number_of_threads() {
    let folder = folder(1e-3, "");
    let run = |threads: &str| {
        let mut command = folder.command(&["stability", "a.toml", "--format", "json", "--all"]);
        out(&command.env("RAYON_NUM_THREADS", threads).output().expect("the program runs"))
    };
    let first = run("1");
    assert!(first.contains("\"verdict\""), "{first}");
    assert_eq!(first, run("1"));
    assert_eq!(first, run("4"));
}

#[test]
fn wrong_settings_are_told_at_their_place() {
    for (more, told) in [
        ("[stability]\nbound = -1.0\n", "`bound` is a positive number"),
        ("[stability]\nbond = 1.0\n", "`[stability]` has no key `bond`"),
        ("[stability.sweep]\nsize = \"0\"\n", "LOW..HIGH"),
        ("[stability.sweep]\nsize = [1]\n", "[low, high]"),
    ] {
        let output = folder(0.5, more).run(&["stability", "a.toml"]);
        assert_eq!(code(&output), 1, "{more}: {}", err(&output));
        assert!(err(&output).contains(told), "{more}: {}", err(&output));
    }
}
