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
    assert_eq!(code(&unknown), 2);
    assert!(err(&unknown).contains("did you mean `size`"), "{}", err(&unknown));
    let malformed = folder(0.5, "").run(&["stability", "a.toml", "--sweep", "size=0"]);
    assert_eq!(code(&malformed), 2, "{}", err(&malformed));
}

/// Integers, and a matrix.
const COUNTED: &str = "#version 150\nin vec2 at;\nuniform int n;\nuniform uint u;\nuniform mat2 m;\nout vec4 o;\nvoid main() {\n    o = \
    vec4(m * at, float(n) + float(u), 1.0);\n}\n";

fn counted(more: &str) -> Folder {
    let scene = format!("{SCENE}[draw.uniforms]\nn = 1\nu = 2\nm = [1, 0, 0, 1]\n{more}");
    Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", COUNTED.as_bytes()), ("a.toml", scene.as_bytes())])
}

#[test]
fn a_sweep_of_integers_has_whole_values() {
    let values = |sweep: &str, name: &str| -> Vec<f64> {
        let (_, found) = json(&counted(""), &["--sweep", sweep]);
        let points = found["sweep"]["points"].as_array().cloned().unwrap_or_default();
        points.iter().filter_map(|point| point["values"][name].as_f64()).collect()
    };
    assert_eq!(values("n=0..10:4", "n"), [0.0, 3.0, 7.0, 10.0]);
    assert_eq!(values("u=3..1:16", "u"), [3.0, 2.0, 1.0]);
    assert_eq!(values("m[1].y=0.5..1:2", "m[1].y"), [0.5, 1.0]);
    assert_eq!(values("m[1][0]=0.5..1:2", "m[1][0]"), [0.5, 1.0]);
    for (sweep, told) in [
        ("u=-5..5:3", "`u` is declared uint"),
        ("n=0..1.5:3", "`n` is declared int"),
        ("n=-3e9..3e9:3", "`n` is declared int"),
        ("m[2].x=0..1", "`m[2].x` is not a component"),
        ("m=0..1", "`m[0].x`"),
        ("n=0..1:2 --sweep n=5..6:2", "`n` has two ranges"),
        ("m[1].y=0..1:2 --sweep m[1][1]=0..1:2", "`m[1][1]` has two ranges"),
    ] {
        let arguments: Vec<&str> = ["stability", "a.toml", "--sweep"].into_iter().chain(sweep.split(' ')).collect();
        let output = counted("").run(&arguments);
        assert_eq!(code(&output), 2, "{sweep}");
        assert!(err(&output).contains(told), "{sweep}: {}", err(&output));
    }
}

/// A range of the command line takes the place of the scene's for the same uniform; those of other uniforms stay.
#[test]
fn sweeps_of_the_command_line_and_of_the_scene_are_combined() {
    let stated = "[stability.sweep]\nn = [1, 3, 3]\nu = [2, 4, 3]\n";
    let (_, found) = json(&counted(stated), &["--sweep", "n=5..6:2"]);
    let points = found["sweep"]["points"].as_array().cloned().unwrap_or_default();
    let values: Vec<_> =
        points.iter().map(|point| (point["values"]["n"].as_f64(), point["values"]["u"].as_f64())).collect();
    assert_eq!(values.len(), 6, "{values:?}");
    for value in [(5.0, 2.0), (5.0, 4.0), (6.0, 3.0)] {
        assert!(values.contains(&(Some(value.0), Some(value.1))), "{value:?} in {values:?}");
    }
}

#[test]
fn a_mistake_in_a_stated_sweep_has_its_place() {
    for (more, code_of, told) in [
        ("[stability.sweep]\nzz = [0, 1]\n", "E0907", "the programs have `m`, `n`, `u`"),
        ("[stability.range]\n\n\"m[0].w\" = [0, 1]\n", "E0910", "`m[0].w` is not a component"),
        ("[stability.sweep]\nu = [-1, 1]\n", "E0910", "whole numbers from 0 to 4294967295"),
    ] {
        let output = counted(more).run(&["stability", "a.toml"]);
        let told_all = err(&output);
        assert_eq!(code(&output), 1, "{told_all}");
        assert!(told_all.contains(code_of) && told_all.contains(told) && told_all.contains("a.toml:1"), "{told_all}");
    }
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

/// Where an argument has lost its digits before, the line where it did is among the first two causes, as a rounding.
#[test]
fn the_place_where_an_argument_lost_its_digits_is_named() {
    let cases = [
        // A counter times a constant, an angle, a far coordinate, a count of frames; the lines from `main` on are 6, 7, 8.
        (1_234_567.0, "float turns = k * 0.618034;", "float x = turns + at.x;", "float f = fract(x);", [6, 7]),
        (86_400.25, "float angle = k * 277.0885;", "float s = sin(angle + at.x);", "float f = 0.5 + 0.5 * s;", [6, 6]),
        (
            2_097_152.7,
            "vec2 far = at * 3.3 + k;",
            "vec2 tile = far * 4.0;",
            "float f = mod(floor(tile.x), 2.0);",
            [6, 6],
        ),
        // A fraction that is written out.
        (1_234_567.0, "float turns = k * 0.618034;", "float x = turns + at.x;", "float f = x - floor(x);", [6, 7]),
        (9_000_001.0, "float t = k * 0.2055;", "int n = int(t + 3.0 * at.x);", "float f = float(n % 5) / 4.0;", [6, 7]),
    ];
    for (k, first, second, third, lines) in cases {
        let fragment = format!(
            "#version 150\nin vec2 at;\nuniform float k;\nout vec4 o;\nvoid main() {{\n    {first}\n    {second}\n    {third}\n    \
             o = vec4(f, 0.0, 0.0, 1.0);\n}}\n"
        );
        let scene = format!("{}[draw.uniforms]\nk = {k:?}\n", SCENE.replace("16", "32"));
        let folder = Folder::new(&[
            ("a.vert", VERTEX.as_bytes()),
            ("a.frag", fragment.as_bytes()),
            ("a.toml", scene.as_bytes()),
        ]);
        let (exit, found) = json(&folder, &[]);
        let causes: Vec<&Value> =
            found["causes"].as_array().map_or(Vec::new(), |causes| causes.iter().take(2).collect());
        let is_origin = |cause: &&&Value| {
            cause["kind"] == "rounding" && cause["line"].as_u64().is_some_and(|line| lines.contains(&line))
        };
        assert_eq!((exit, causes.iter().filter(is_origin).count()), (1, 1), "{first}: {}", found["causes"]);
    }
}

/// Far from its axis a lobe is 0, to no harm.
#[test]
fn an_underflow_that_harms_nothing_is_no_cause() {
    let fragment = "#version 150\nin vec2 at;\nout vec4 o;\nvoid main() {\n    float c = normalize(vec3(at * 0.5, 20.0)).z;\n    \
                    float s = (1.0 - c * c) * 1e5;\n    o = vec4(exp(-s * s * 40.0), 0.0, 0.0, 1.0);\n}\n";
    let scene = SCENE.replace("16", "24");
    let folder =
        Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", scene.as_bytes())]);
    let (exit, found) = json(&folder, &[]);
    let kinds: Vec<&str> =
        found["causes"].as_array().into_iter().flatten().filter_map(|cause| cause["kind"].as_str()).collect();
    assert_eq!((exit, kinds.first()), (1, Some(&"cancellation")), "{found}");
    assert!(!kinds.contains(&"underflow"), "{found}");
}

/// The worst pixel is told of the attachment that has the error.
#[test]
fn the_worst_pixel_is_of_an_attachment() {
    let fragment = "#version 150\nin vec2 at;\nout vec4 o[2];\nvoid main() {\n    o[0] = vec4(at, 0.0, 1.0);\n    \
                    o[1] = vec4((at.x + 1e7) - 1e7, 0.0, 0.0, 1.0);\n}\n";
    let scene = SCENE.replace("height = 16\n", "height = 16\nattachments = 2\n");
    let folder =
        Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", scene.as_bytes())]);
    let worst = &json(&folder, &[]).1["picture"]["worst"];
    assert_eq!(worst["attachment"], 1, "{worst}");
    assert_ne!(worst["f32"][0], worst["exact"][0], "{worst}");
    assert!(out(&folder.run(&["stability", "a.toml"])).contains(" of attachment 1\n"));
}

#[test]
fn a_bound_can_be_relative_to_the_color() {
    // One ULP of 30,000 is 0.002.
    let fragment = "#version 150\nin vec2 at;\nuniform float size;\nout vec4 o;\nvoid main() {\n    \
                    o = vec4(30000.0 * size * (1.7 + at.x * 0.3), 0.0, 0.0, 1.0);\n}\n";
    let folder = folder(0.9, "");
    fs::write(folder.path("a.frag"), fragment).expect("written");
    let (exit, found) = json(&folder, &[]);
    assert_eq!((exit, found["verdict"].as_str()), (1, Some("degraded")), "{found}");
    let (exit, relative) = json(&folder, &["--bound-relative", "1e-6"]);
    assert_eq!(
        (exit, relative["verdict"].as_str(), relative["bound_relative"].as_f64()),
        (0, Some("stable"), Some(1e-6))
    );
    assert_eq!(relative["picture"]["max_abs"], found["picture"]["max_abs"], "the figures are of all errors");
    assert!(
        relative["picture"]["max_relative"].as_f64().is_some_and(|most| (1e-9..1e-6).contains(&most)),
        "{relative}"
    );
    let (exit, found) = json(&folder, &["--bound-relative", "1e-9"]);
    assert_eq!((exit, found["verdict"].as_str()), (1, Some("degraded")));
    let scene = format!("{SCENE}[draw.uniforms]\nsize = 0.9\n[stability]\nbound_relative = 1e-6\n");
    fs::write(folder.path("a.toml"), scene).expect("written");
    let (exit, found) = json(&folder, &[]);
    assert_eq!((exit, found["bound_relative"].as_f64()), (0, Some(1e-6)));
    assert_eq!(code(&folder.run(&["stability", "a.toml", "--bound-relative", "0"])), 2);
}

#[test]
fn a_search_varies_matrices_integers_and_data_of_instances() {
    let vertex = "#version 150\nin vec2 p;\nin vec2 place;\nuniform mat4 model;\nuniform int frame;\nout vec2 at;\nvoid main() {\n    \
                  at = (model * vec4(p + place, 0.0, 1.0)).xy + fract(float(frame) * 0.37);\n    gl_Position = vec4(p, 0.0, 1.0);\n}\n";
    let fragment = "#version 150\nin vec2 at;\nout vec4 o;\nvoid main() { o = vec4(fract(at), 0.0, 1.0); }\n";
    let with = |frame: &str, model: &str, place: &str| {
        let scene = format!(
            "{}place = {{ size = 2, divisor = 1, values = [0.1, 0.2] }}\n[draw.uniforms]\nframe = 3\n\
             model = [0.4, 0, 0, 0, 0, 0.4, 0, 0, 0, 0, 0.4, 0, 0.3, 0.2, 0, 1]\n",
            SCENE.replace("primitive", "instances = 1\nprimitive")
        );
        let vertex = vertex
            .replace("float(frame)", frame)
            .replace("(model * vec4(p + place, 0.0, 1.0)).xy", &format!("({model} * vec4(p + {place}, 0.0, 1.0)).xy"));
        Folder::new(&[("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", scene.as_bytes())])
    };
    for (name, folder) in [
        ("frame", with("float(frame)", "mat4(0.4)", "vec2(0.3)")),
        ("model", with("3.0", "model", "vec2(0.3)")),
        ("place", with("3.0", "mat4(0.4)", "place")),
    ] {
        let (exit, found) = json(&folder, &["--stiff", "--worst", "worst.toml"]);
        assert_eq!(exit, 1, "{name}: {found}");
        assert_eq!(found["stiff"]["changed"][0]["name"], name, "{found}");
        let again = folder.run(&["stability", "worst.toml", "--format", "json"]);
        let again: Value = serde_json::from_str(&out(&again)).unwrap_or(Value::Null);
        assert_eq!(again["picture"]["max_abs"], found["picture"]["max_abs"], "{name}: the scene shows what was found");
    }
}

#[test]
fn the_time_ends_a_sweep_with_what_it_has() {
    let folder = folder(0.5, "");
    let large = SCENE.replace("16", "256") + "[draw.uniforms]\nsize = [0.5]\n";
    fs::write(folder.path("a.toml"), large).expect("written");
    let arguments = ["stability", "a.toml", "--sweep", "size=1e-3..1:4096", "--timeout", "1", "--format", "json"];
    let output = folder.run(&arguments);
    let found: Value = serde_json::from_str(&out(&output)).unwrap_or(Value::Null);
    let drawn = found["sweep"]["points"].as_array().map_or(0, Vec::len);
    assert!((1..4096).contains(&drawn), "{drawn} drawn");
    assert_eq!((code(&output), found["sweep"]["combinations"].as_u64()), (1, Some(4096)));
    // The ends come first, so the worst value is among what was drawn.
    assert_eq!(found["sweep"]["worst"]["values"]["size"].as_f64(), Some(1e-3));
    assert!(err(&output).contains(&format!("the sweep ended after {drawn} of 4096 values")), "{}", err(&output));
}
