//! `glisten report`, end to end: what repeats on every run, `--compare`, `--budget`, `--weights`, and Ctrl-C.

use crate::report::{report_with, small_scene};
use crate::support::{conforms, root};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn json(path: &Path) -> Value {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    serde_json::from_str(&text).expect("it is JSON")
}

fn code(run: &Output) -> Option<i32> {
    run.status.code()
}

fn told(run: &Output) -> String {
    [&run.stdout, &run.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned()).concat()
}

/// A folder with the small scene, and a report of it.
fn reported() -> (tempfile::TempDir, PathBuf, PathBuf) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = small_scene(folder.path());
    let out = folder.path().join("first");
    let run = report_with(&scene, &out, &["-q"]);
    assert_eq!(code(&run), Some(0), "{}", told(&run));
    (folder, scene, out.join("report.json"))
}

#[test]
fn what_is_exact_repeats_and_is_no_worse_than_itself() {
    let (folder, scene, first) = reported();
    let out = folder.path().join("second");
    let run = report_with(&scene, &out, &["-q", "--compare", first.to_str().expect("a name")]);
    // Other tests load the machine: times may part.
    let worse = |line: &&str| line.contains(" -> ") && !line.contains(": time ");
    let (all, nothing) = (told(&run), told(&run).contains("nothing got worse"));
    assert_eq!(all.lines().filter(worse).collect::<Vec<_>>(), [""; 0], "{all}");
    assert_eq!(code(&run), Some(i32::from(!nothing)), "{all}");
    let [first, second] = [json(&first), json(&out.join("report.json"))];
    let ways = |report: &Value| report["ways"].as_array().expect("ways").clone();
    for (first, second) in ways(&first).iter().zip(&ways(&second)) {
        for exact in ["name", "tessellation", "work", "error", "rounding", "pareto"] {
            assert_eq!(first[exact], second[exact], "{exact}");
        }
        let marks = [first, second].map(|way| way["pareto_time"].as_str().expect("a mark").to_owned());
        assert!(!(marks.contains(&"yes".to_owned()) && marks.contains(&"no".to_owned())), "{first}");
    }
}

#[test]
fn warnings_of_the_scene_are_told_and_can_be_denied() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let files = [
        ("a.vert", "#version 150\nin vec2 p;\nvoid main() { gl_Position = vec4(p, 0.0, 1.0); }\n"),
        ("a.frag", "#version 150\nuniform float level;\nout vec4 color;\nvoid main() { color = vec4(level); }\n"),
        (
            "a.toml",
            "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
             [draw.attributes]\np = { size = 2, values = [-1, -1, 3, -1, -1, 3] }\n",
        ),
    ];
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("written");
    }
    let (scene, out) = (folder.path().join("a.toml"), folder.path().join("out"));
    let run = report_with(&scene, &out, &["-q", "--seconds", "0", "--deny", "warnings"]);
    assert!(code(&run) == Some(1) && told(&run).contains("error[W0901]"), "{}", told(&run));
    let run = report_with(&scene, &out, &["-q", "--seconds", "0", "--diagnostics", "json"]);
    let found: Value = serde_json::from_slice(&run.stderr).expect("one document");
    assert_eq!((code(&run), found[0]["code"].as_str()), (Some(0), Some("W0901")), "{}", told(&run));
    // Nothing is covered: the triangle has no area.
    let flat = files[2].1.replace("3, -1, -1, 3", "-1, -1, -1, -1");
    std::fs::write(&scene, flat).expect("written");
    let run = report_with(&scene, &out, &["-q", "--seconds", "0"]);
    assert!(code(&run) == Some(0) && told(&run).contains("warning[W0909]"), "{}", told(&run));
}

#[test]
fn what_got_worse_is_told() {
    let (folder, scene, first) = reported();
    let mut old = json(&first);
    let way = &mut old["ways"][0];
    way["error"]["rmse"] = (way["error"]["rmse"].as_f64().expect("a figure") * 0.999).into();
    way["work"]["operations"] = (way["work"]["operations"].as_u64().expect("a figure") - 1).into();
    old["ways"][1]["name"] = "of yore".into();
    let out = folder.path().join("out");
    let old_path = folder.path().join("old.json");
    std::fs::write(&old_path, old.to_string()).expect("written");
    let compare = |path: &Path| report_with(&scene, &out, &["-q", "--compare", path.to_str().expect("a name")]);
    let run = compare(&old_path);
    assert_eq!(code(&run), Some(1), "{}", told(&run));
    for line in [
        "worse: Phong per vertex, 8x4: rmse",
        "8x4: operations",
        "of yore, 16x8: the variant is no longer there",
        "a new variant",
    ] {
        assert!(told(&run).contains(line), "{line} in {}", told(&run));
    }
    old["scene"] = "another".into();
    std::fs::write(&old_path, old.to_string()).expect("written");
    let run = compare(&old_path);
    assert!(code(&run) == Some(1) && told(&run).contains("`another`"), "{}", told(&run));
    std::fs::write(&old_path, "{\"ways\": 3").expect("written");
    let run = compare(&old_path);
    assert!(code(&run) == Some(1) && told(&run).contains("is not a report"), "{}", told(&run));
    assert_eq!(code(&compare(&folder.path().join("none.json"))), Some(2));
}

#[test]
fn a_budget_names_the_cheapest_way_and_writes_a_program_that_draws_it() {
    let (folder, scene, first) = reported();
    let out = folder.path().join("out");
    let run = report_with(&scene, &out, &["-q", "--budget", "rmse=5e-2"]);
    assert_eq!(code(&run), Some(0), "{}", told(&run));
    let ways = json(&first)["ways"].as_array().expect("ways").clone();
    let within = ways.iter().filter(|way| way["model"] == "Phong" && way["error"]["rmse"].as_f64() <= Some(5e-2));
    let cheapest = within.min_by_key(|way| way["work"]["operations"].as_u64()).expect("there is one");
    let [segments, rings] = [0, 1].map(|index| cheapest["tessellation"][index].clone());
    let title = format!("`{}, {segments}x{rings}`", cheapest["name"].as_str().expect("a name"));
    assert!(told(&run).contains(&title), "{title} in {}", told(&run));
    // What was written is drawn alone, by a compiler of GLSL 1.50.
    let picture = folder.path().join("picture.npy");
    let drawn = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["render", "--backend", "cpu", "--precision", "f32"])
        .arg(out.join("budget.toml"))
        .arg("-o")
        .arg(&picture)
        .output()
        .expect("the program runs");
    assert_eq!(code(&drawn), Some(0), "{}", told(&drawn));
    let bytes = std::fs::read(&picture).expect("a picture");
    assert!(bytes[128..].chunks_exact(16).any(|pixel| pixel[..12].iter().any(|byte| *byte != 0)), "it is not empty");
    let run = report_with(&scene, &out, &["-q", "--budget", "rmse=1e-12"]);
    assert!(code(&run) == Some(1) && told(&run).contains("the closest is"), "{}", told(&run));
    let run = report_with(&scene, &out, &["-q", "--budget", "rsme=1"]);
    assert!(code(&run) == Some(2) && told(&run).contains("did you mean `rmse`?"), "{}", told(&run));
}

#[test]
fn weights_are_named_and_mistakes_in_them_are_told() {
    let (folder, scene, first) = reported();
    let file = folder.path().join("mine.toml");
    let out = folder.path().join("out");
    std::fs::write(&file, "name = \"mine\"\n[weights]\nfragment = { fixed = 1000000 }\n").expect("written");
    let with = |weights: &str| report_with(&scene, &out, &["-q", "--weights", weights]);
    let name = file.to_str().expect("a name");
    let run = with(name);
    assert_eq!(code(&run), Some(0), "{}", told(&run));
    let report = json(&out.join("report.json"));
    assert_eq!(report["weights"], "mine");
    let operations = |report: &Value| report["ways"][0]["work"]["operations"].as_u64().expect("a figure");
    let fragments = report["ways"][0]["work"]["fragments"].as_u64().expect("a figure");
    let more = operations(&report) - operations(&json(&first));
    assert!((999_900 * fragments..1_000_000 * fragments).contains(&more), "{more} for {fragments} fragments");
    std::fs::write(&file, "name = \"mine\"\n[weights]\ninversqrt = 2\n").expect("written");
    let run = with(name);
    assert!(code(&run) == Some(1) && told(&run).contains("did you mean `inversesqrt`?"), "{}", told(&run));
    let run = with("none");
    assert!(code(&run) == Some(2) && told(&run).contains("`llvmpipe`"), "{}", told(&run));
}

#[test]
fn of_three_identical_ways_none_beats_another() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = small_scene(folder.path());
    let text = std::fs::read_to_string(&path).expect("the scene");
    let (scene, _) = text.split_once("[report]").expect("it has a report table");
    let way = |name: &str| format!("[[report.way]]\nname = \"{name}\"\nmodel = \"m\"\ntruth = {}\n", name == "a");
    let ways = ["a", "b", "c"].map(way).concat();
    std::fs::write(&path, format!("{scene}[report]\nrounds = 25\ntessellations = [[16, 8]]\n{ways}")).expect("written");
    let out = folder.path().join("out");
    let run = report_with(&path, &out, &["-q"]);
    assert_eq!(code(&run), Some(0), "{}", told(&run));
    for way in json(&out.join("report.json"))["ways"].as_array().expect("ways") {
        assert_eq!((&way["pareto"], &way["pareto_time"]), (&true.into(), &"open".into()), "{way}");
    }
}

/// Each variant has a text of its own; a mistake in it is told where the file of the scene has it.
#[test]
fn mistakes_of_a_way_are_told_on_their_lines() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = small_scene(folder.path());
    let text = std::fs::read_to_string(&path).expect("the scene");
    let (scene, _) = text.split_once("[report]").expect("it has a report table");
    for (set, word) in [
        ("{ uniforms = { tnt = [0, 1, 0] } }", "tnt"),
        ("{ uniforms = { n = 1.0 } }", "n ="),
        ("{ fragment = \"nope.frag\" }", "nope"),
    ] {
        let text =
            format!("# a comment\n\n{scene}[report]\n[[report.way]]\nname = \"mine\"\ntruth = true\nset = {set}\n");
        std::fs::write(&path, &text).expect("written");
        let run = report_with(&path, &folder.path().join("out"), &["-q", "--diagnostics", "json"]);
        assert_ne!(code(&run), Some(0), "{}", told(&run));
        let line = text.lines().position(|line| line.contains(set)).expect("it is there") + 1;
        let column = format!("set = {set}").find(word).expect("it is there") + 1;
        let told = told(&run);
        let places = [format!("\"line\": {line},"), format!("\"column\": {column},")];
        let is_there = places.iter().all(|place| told.contains(place));
        assert!(is_there && told.contains("of the way `mine`"), "{places:?}: {told}");
    }
}

#[test]
fn ways_are_found_for_a_scene_that_declares_none() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = small_scene(folder.path());
    let text = std::fs::read_to_string(&path).expect("the scene");
    let (scene, _) = text.split_once("[report]").expect("it has a report table");
    std::fs::write(&path, scene).expect("written");
    let out = folder.path().join("out");
    let run = report_with(&path, &out, &["-q", "--ways", "auto", "--rounds", "6"]);
    assert_eq!(code(&run), Some(0), "{}", told(&run));
    let report = json(&out.join("report.json"));
    assert_eq!(report["ways"][0]["kind"], "as written");
    assert!(report["ways"][0]["error"]["max_abs"].as_f64().expect("a figure") < 1e-4, "it is its own truth");
}

#[cfg(unix)]
/// How long a report may take until there is something to leave: as long as it takes, on a slow machine longer.
const PATIENCE: [u64; 5] = [1, 4, 12, 40, 120];

/// Starts a report that would take minutes, and interrupts it after some seconds.
fn interrupted(scene: &Path, out: &Path, seconds: u64) -> Output {
    let child = Command::new(env!("CARGO_BIN_EXE_glisten"))
        .arg("report")
        .arg(scene)
        .arg("-o")
        .arg(out)
        .args(["--rounds", "1000", "--seconds", "500"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    std::thread::sleep(std::time::Duration::from_secs(seconds));
    let pressed = Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill runs");
    assert!(pressed.success());
    child.wait_with_output().expect("it ends")
}

#[test]
fn ctrl_c_leaves_what_is_done() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = small_scene(folder.path());
    let out = folder.path().join("out");
    for seconds in PATIENCE {
        let run = interrupted(&scene, &out, seconds);
        assert_eq!(code(&run), Some(130), "{}", told(&run));
        if out.join("report.json").exists() {
            break;
        }
        assert!(told(&run).contains("interrupted before a variant was drawn: no report was written"), "{}", told(&run));
    }
    let report = json(&out.join("report.json"));
    assert_eq!(report["complete"], false);
    assert_ne!(report["ways"].as_array().map(Vec::len), Some(0), "there is something in it");
    let schema = json(&root().join("docs/report.schema.json"));
    assert_eq!(conforms(&report, &schema, "report"), [""; 0]);
    let page = std::fs::read_to_string(out.join("report.html")).expect("the page");
    assert!(page.contains("was interrupted before all variants were drawn"));
}
