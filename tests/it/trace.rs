//! `glisten trace`, end to end: each value of a pixel's fragments and of a vertex, for people and as JSON.

use crate::cli::{Folder, code, err, out};
use crate::support::root;
use serde_json::Value;
use std::path::Path;

fn scene() -> String {
    root().join("fixtures/trace/steps.toml").display().to_string()
}

/// The output for people, without the folder of this checkout.
fn told(arguments: &[&str]) -> String {
    let folder = Folder::new(&[]);
    let scene = scene();
    let run = folder.run(&[&["trace", &scene], arguments].concat());
    assert_eq!(code(&run), 0, "{}", err(&run));
    out(&run).replace(&format!("{}/", root().display()), "")
}

fn json(arguments: &[&str]) -> Value {
    let folder = Folder::new(&[]);
    let scene = scene();
    let run = folder.run(&[&["trace", &scene, "--format", "json"], arguments].concat());
    assert_eq!(code(&run), 0, "{}", err(&run));
    serde_json::from_str(&out(&run)).expect("it is JSON")
}

#[test]
fn lines_for_people_follow_the_text() {
    insta::assert_snapshot!("trace_two_fragments", told(&["--pixel", "30,24"]));
    insta::assert_snapshot!("trace_discarded", told(&["--pixel", "2,24"]));
    insta::assert_snapshot!("trace_vertex", told(&["--vertex", "3", "--all"]));
}

/// A value that the next line happens to have, too, keeps its own.
#[test]
fn equal_values_on_different_lines_are_all_told() {
    let scene = "[framebuffer]\nwidth = 2\nheight = 2\n\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nvertex_count = 3\n\n\
                 [draw.uniforms]\nn = 1\n";
    let vertex =
        "#version 330\nvoid main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }\n";
    let fragment = "#version 330\nuniform int n;\nout vec4 o;\nint g = 0;\nvoid main() {\n    int w = 9;\n    w = n % 3;\n    g++;\n    \
                    w = n + 0;\n    int y = 1;\n    bool b = n > 5 || g > 0;\n    o = vec4(w, g, y, b);\n}\n";
    let files = [("a.toml", scene.as_bytes()), ("a.vert", vertex.as_bytes()), ("a.frag", fragment.as_bytes())];
    let folder = Folder::new(&files);
    let run = folder.run(&["trace", "a.toml", "--pixel", "1,1"]);
    assert_eq!(code(&run), 0, "{}", err(&run));
    let said = out(&run);
    for part in [" 7:5  w = n % 3 ", " 9:5  w = n + 0 ", "g > 0 "] {
        assert!(said.contains(part), "no `{part}` in:\n{said}");
    }
}

#[test]
fn json_has_places_values_and_intervals() {
    let found = json(&["--pixel", "30,24"]);
    let invocations = found["invocations"].as_array().expect("a list");
    let fates: Vec<&str> = invocations.iter().filter_map(|one| one["fate"].as_str()).collect();
    assert_eq!(fates, ["drawn", "failed"]);
    let steps = invocations[0]["steps"].as_array().expect("a list");
    let rim = steps.iter().find(|step| step["kind"] == "local" && step["text"] == "rim").expect("a variable");
    assert_eq!(
        (&rim["type"], &rim["start"]["line"], &rim["start"]["column"]),
        (&"float".into(), &25.into(), &11.into())
    );
    assert_eq!(rim["value"][0], 0.0, "f32 loses all digits");
    let exact = rim["exact"][0].as_f64().expect("a number");
    assert!((exact - 0.027_465_82).abs() < 1e-6, "{exact}");
    let [low, high] = [0, 1].map(|end| rim["interval"][0][end].as_f64().expect("a number"));
    assert!(low <= 0.0 && 0.0 <= high && low <= exact && exact <= high, "{low} {high}");
    let depths: Vec<u64> = steps.iter().filter_map(|step| step["depth"].as_u64()).collect();
    assert_eq!(depths.iter().max(), Some(&1));
    let condition = steps.iter().find(|step| step["kind"] == "if").expect("a condition");
    assert_eq!((&condition["value"][0], &condition["type"]), (&true.into(), &"bool".into()));
    assert_eq!(found["colors"].as_array().map(Vec::len), Some(1));
    // What is drawn is what the fragment gave.
    let output = steps.iter().rev().find(|step| step["kind"] == "output").expect("an output");
    assert_eq!(output["value"], found["colors"][0]["value"]);
}

#[test]
fn the_color_is_that_of_the_picture_of_every_library_scene() {
    let scenes = crate::support::files_with(&root().join("shader_lib/scenes"), "toml");
    let mut compared = 0;
    for scene in scenes.iter().step_by(6) {
        compared += same_colors(scene);
    }
    assert!(compared > 20, "{compared} colors");
}

/// Compares some pixels of a scene with its picture by the reference in f64. Returns how many.
fn same_colors(scene: &Path) -> usize {
    let sources = glisten::scene::load(
        &scene.display().to_string(),
        &glisten::scene::DiskFiles,
        &glisten::Compiler::new(glisten::Options::default()),
    );
    let scene = sources.scene.expect("the scenes of the library can be read");
    let floats = glisten_scene::Framebuffer { format: glisten_scene::Format::Rgba32Float, ..scene.framebuffer };
    let scene = glisten_scene::Scene { framebuffer: floats, ..scene };
    let picture = glisten::render(&scene, &glisten::RenderOptions::default()).expect("it draws");
    let mut compared = 0;
    for [x, y] in [[0.5, 0.5], [0.4, 0.6], [0.61, 0.37]] {
        let at = [(x * f64::from(picture.width)) as u32, (y * f64::from(picture.height)) as u32];
        let found =
            glisten_reference::trace::trace(&scene, glisten_reference::trace::Place::Pixel(at)).expect("it is there");
        let shown = picture.attachments[0][(at[1] * picture.width + at[0]) as usize];
        for (component, shown) in found.colors[0].iter().zip(shown) {
            let glisten_reference::trace::Component::Float { exact, interval: Some(interval), .. } = component else {
                panic!("{component:?}");
            };
            assert!((exact - shown).abs() <= 1e-12 * shown.abs().max(1.0), "{}: {exact} {shown}", scene.draws.len());
            assert!(interval.low <= *exact && *exact <= interval.high, "{component:?}");
            compared += 1;
        }
    }
    compared
}

#[test]
fn wrong_places_are_refused() {
    let folder = Folder::new(&[]);
    let scene = scene();
    for (arguments, exit, part) in [
        (&["--pixel", "64,0"][..], 1, "the picture has 64 by 64"),
        (&["--vertex", "4"], 1, "its last vertex is 3"),
        (&["--vertex", "0", "--draw", "2"], 1, "the scene has 2"),
        (&["--pixel", "1;2"], 2, "is not a column and a row"),
        (&["--pixel", "1,2", "--vertex", "0"], 2, "cannot be used with"),
        (&["--pixel", "1,2", "--draw", "0"], 2, "cannot be used with"),
        (&["--pixel", "1,2", "--instance", "0"], 2, "cannot be used with"),
        (&[], 2, "--pixel <X,Y>|--vertex <N>"),
    ] {
        let run = folder.run(&[&["trace", &scene], arguments].concat());
        assert_eq!(code(&run), exit, "{arguments:?}: {}", err(&run));
        assert!(err(&run).contains(part), "{arguments:?}: {}", err(&run));
    }
    let run = folder.run(&["trace", &scene, "--pixel", "1,63"]);
    assert_eq!(code(&run), 0);
}
