//! How much `verify` judges, end to end: classes that add up, edges, verdicts that are inconclusive, modules of other
//! translators. These tests need a Vulkan software adapter.

use crate::cli::{Folder, code, err, out};
use crate::drawing::{gpu, strict};
use crate::scenes;
use crate::support::compiler;
use glisten::scene::{DiskFiles, load};
use glisten::verify::{Conclusion, Expected};
use glisten_gpu::Via;
use serde_json::Value;
use std::fs;

const VERTEX: &str = "#version 150\nin vec2 p;\nout vec2 q;\nvoid main() {\n    q = p * 0.5 + 0.5;\n    gl_Position = \
                      vec4(p, 0.0, 1.0);\n}\n";
const GRADIENT: &str = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() { c = vec4(q, 0.5 * q.x, 1.0); }\n";

/// A quad of `squares` by `squares` squares over a window of 64 by 64 pixels. With 64 squares, each pixel's center is on a
/// diagonal.
fn quad(squares: usize, fragment: &str) -> Folder {
    let line = |i: usize| -1.0 + 2.0 * i as f64 / squares as f64;
    let points: Vec<String> =
        (0..=squares).flat_map(|y| (0..=squares).map(move |x| format!("{}, {}", line(x), line(y)))).collect();
    let squares_of = |y: usize| (0..squares).map(move |x| y * (squares + 1) + x);
    let corners = |a: usize| [a, a + 1, a + squares + 1, a + 1, a + squares + 2, a + squares + 1];
    let indices: Vec<usize> = (0..squares).flat_map(squares_of).flat_map(corners).collect();
    let text = format!(
        "[framebuffer]\nwidth = 64\nheight = 64\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\nprimitive = \
         \"triangles\"\nindices = {indices:?}\nvertex_count = {}\n[draw.attributes]\np = {{ size = 2, values = [{}] }}\n",
        (squares + 1) * (squares + 1),
        points.join(", ")
    );
    Folder::new(&[("a.vert", VERTEX.as_bytes()), ("a.frag", fragment.as_bytes()), ("a.toml", text.as_bytes())])
}

#[track_caller]
fn verify(folder: &Folder, arguments: &[&str]) -> (i32, Value) {
    let output = folder.run(&[&["verify", "a.toml", "--format", "json"], arguments].concat());
    (code(&output), serde_json::from_str(&out(&output)).unwrap_or_else(|error| panic!("{error}: {}", err(&output))))
}

fn count(json: &Value, class: &str) -> u64 {
    json["evidence"][class].as_u64().unwrap_or_else(|| panic!("{json}"))
}

/// The translations of the gradient that glisten emits.
fn compiled(folder: &Folder) {
    assert_eq!(code(&folder.run(&["compile", "a.vert", "a.frag", "-o", "out", "-q"])), 0);
}

#[test]
fn a_pixel_on_an_inner_edge_is_judged_by_its_owners() {
    let folder = quad(64, GRADIENT);
    let (exit, json) = verify(&folder, &[]);
    assert_eq!((exit, &json["verdict"], count(&json, "edge")), (0, &"holds".into(), 4096), "{json}");
    compiled(&folder);
    let right = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("compiled");
    for (name, wrong) in
        [("darker", "return c * 0.9;"), ("another hue", "return c.yxzw;"), ("a bit", "return c + 1e-4;")]
    {
        let text = right.replace("return c;", wrong);
        assert_ne!(text, right, "{name}");
        fs::write(folder.path("w.wgsl"), text).expect("written");
        let (exit, json) = verify(&folder, &["--with", "fragment=w.wgsl"]);
        assert_eq!((exit, &json["verdict"]), (1, &"fails".into()), "{name}: {json}");
        assert!(json["outside"].as_u64().is_some_and(|outside| outside > 4000), "{name}: {json}");
        assert_eq!(json["coverage_mismatch"], 0, "{name}");
    }
}

#[test]
fn noise_is_inconclusive_with_the_line_that_makes_it_so() {
    let noise = "#version 150\nin vec2 q;\nout vec4 c;\nvoid main() {\n    float x = 40.0 * q.x + 90.0 * q.y;\n    float n = \
                 fract(sin(x) * 43758.5);\n    c = vec4(n, n, n, 1.0);\n}\n";
    for squares in [1, 64] {
        let folder = quad(squares, noise);
        let (exit, json) = verify(&folder, &["--no-likely"]);
        assert_eq!((exit, &json["verdict"]), (1, &"inconclusive".into()), "{json}");
        let causes = json["weakness"]["contributions"].as_array().expect("they are named");
        // Several expressions of the line suffice alone; it depends on the pixel which of them is named.
        assert!(causes.iter().any(|one| one["line"] == 6), "{json}");
        let told = out(&folder.run(&["verify", "a.toml", "--no-likely"]));
        assert!(told.contains("inconclusive: only ") && told.contains("a.frag:6:"), "{told}");
        let (exit, json) = verify(&folder, &["--no-likely", "--allow-inconclusive"]);
        assert_eq!((exit, &json["verdict"]), (0, &"inconclusive".into()));
        let (exit, _) = verify(&folder, &["--no-likely", "--evidence-share", "0"]);
        assert_eq!(exit, 0, "who asks for no evidence gets a verdict without");
    }
}

/// GLSL 1.50 §5.9 and §5.4.1: what the language leaves undefined is anything, so no GPU is wrong, and the operation is named.
#[test]
fn what_the_language_leaves_undefined_of_integers_is_anything() {
    let cases = [
        ("x / (x - x)", "/", false),
        ("x % (x - x)", "%", false),
        ("(-2 - x) % 3", "%", false),
        ("x << 32 + x", "<<", false),
        ("x >> -1 - x", ">>", false),
        ("int(uint(x) / uint(x - x))", "/", false),
        ("int(gl_FragCoord.x * 1e20)", "int", false),
        ("int(uint(-1.0 - gl_FragCoord.x))", "uint", false),
        ("x / (x + 1) + x % (x + 1) + (x << 3) + (x >> 31)", "", true),
    ];
    for (expression, operation, is_defined) in cases {
        let fragment = format!(
            "#version 150\nout vec4 color;\nvoid main() {{\n    int x = int(gl_FragCoord.x);\n    int y = {expression};\n    \
             color = vec4(y, 0, 0, 1);\n}}\n"
        );
        let folder = quad(1, &fragment);
        let (code, json) = verify(&folder, &[]);
        let expected = if is_defined { ("holds", 0) } else { ("inconclusive", 1) };
        assert_eq!((json["verdict"].as_str().unwrap_or_default(), code), expected, "{expression}: {json}");
        if !is_defined {
            let first = &json["weakness"]["contributions"][0];
            assert_eq!((&first["operation"], &first["line"]), (&operation.into(), &5.into()), "{expression}: {json}");
        }
    }
}

#[test]
fn three_lines_are_enough_where_all_is_well() {
    let folder = quad(1, GRADIENT);
    let output = folder.run(&["verify", "a.toml", "--evidence", "e.png"]);
    assert_eq!(code(&output), 0, "{}", out(&output));
    assert_eq!(out(&output).lines().count(), 3, "{}", out(&output));
    assert!(out(&output).contains("holds: 4096 of 4096 covered pixels judged (100.0 %)"), "{}", out(&output));
    assert!(err(&output).contains("green: judged"), "{}", err(&output));
    assert!(fs::read(folder.path("e.png")).expect("written").starts_with(b"\x89PNG"));
}

#[test]
fn a_width_of_the_users_is_the_goal() {
    let folder = quad(1, GRADIENT);
    let (exit, json) = verify(&folder, &["--width", "0"]);
    assert_eq!((exit, &json["verdict"]), (1, &"inconclusive".into()), "{json}");
    assert!(count(&json, "weak") > 3900, "{json}");
    let (_, json) = verify(&folder, &["--width", "1"]);
    assert_eq!((json["width"].as_f64(), count(&json, "weak")), (Some(1.0), 0));
}

#[test]
fn modules_of_others_are_judged_or_refused() {
    let folder = quad(1, GRADIENT);
    compiled(&folder);
    let text = fs::read_to_string(folder.path("out/a.frag.wgsl")).expect("compiled");
    fs::write(folder.path("l.wgsl"), text.replace("@location(0) q", "@location(2) q")).expect("written");
    fs::write(folder.path("g.spv"), b"no module at all, but some text").expect("written");
    fs::write(folder.path("g.wgsl"), b"\xff\x00").expect("written");
    let right: [(&[&str], &[&str]); 3] = [
        (&["fragment=out/a.frag.wgsl"], &["wgsl"]),
        (&["0:fragment=out/a.frag.spv", "vertex=out/a.vert.spv"], &["spirv"]),
        (&["fragment=out/a.frag.spv", "vertex=out/a.vert.wgsl"], &["spirv", "wgsl"]),
    ];
    for (modules, forms) in right {
        let arguments: Vec<&str> = modules.iter().flat_map(|module| ["--with", *module]).collect();
        let (exit, json) = verify(&folder, &arguments);
        let runs: Vec<&str> =
            json["runs"].as_array().into_iter().flatten().filter_map(|run| run["via"].as_str()).collect();
        assert_eq!((exit, &runs[..]), (0, forms), "{json}");
    }
    let refused = [
        ("fragment=l.wgsl", 1, "varying at location 2: vec2<f32>, where the program has nothing"),
        ("fragment=g.spv", 1, "`g.spv`: it is no SPIR-V"),
        ("fragment=g.wgsl", 1, "`g.wgsl`: it is no WGSL"),
        ("fragment=out/a.vert.spv", 1, "no entry point for the fragment stage"),
        ("fragment=missing.spv", 2, "missing.spv"),
        ("1:fragment=out/a.frag.spv", 2, "there is no draw 1"),
        ("fragment=a.frag", 2, "ends neither in .wgsl nor in .spv"),
        ("fragmen=out/a.frag.spv", 2, "did you mean `fragment`?"),
    ];
    for (module, exit, part) in refused {
        for command in [&["verify", "a.toml"][..], &["render", "a.toml", "-o", "a.npy"]] {
            let output = folder.run(&[command, &["--with", module]].concat());
            assert_eq!(code(&output), exit, "{module}: {}", err(&output));
            assert!(err(&output).contains(part), "{module}: {}", err(&output));
        }
    }
    assert_eq!(code(&folder.run(&["render", "a.toml", "-o", "a.npy", "--with", "fragment=out/a.frag.wgsl"])), 0);
}

/// Scenes of which too little can be judged, each with the reason.
const INCONCLUSIVE: &[(&str, &str)] = &[
    ("cull_back_ccw", NOTHING),
    ("cull_front_cw", NOTHING),
    ("depth_equal", NOTHING),
    ("depth_gequal", NOTHING),
    ("depth_greater", NOTHING),
    ("depth_never", NOTHING),
    ("gamma_8_bits", "a gamma curve is steep, and blending in 8 bits rounds each factor and product"),
    ("lower_always_discard", NOTHING),
    ("lower_builtins", "it calls functions where they are undefined or not precise"),
    ("lower_constants", "it divides by numbers beyond those for which Vulkan has a rule"),
    ("lower_samplers", FILTERED),
    ("lower_textures", FILTERED),
    ("mipmaps_implicit", FILTERED),
    ("normal_map", "derivatives choose the level of detail, and the texels differ"),
    ("root_of_negative", "GLSL leaves the root and the power of a negative number undefined"),
    ("screen_lines", "the lines are as thin as derivatives are uncertain"),
    ("sphere_trace", "the march may end a step sooner or later, and the normal is a difference"),
    ("texture_1d", FILTERED),
    ("texture_3d", FILTERED),
    ("texture_cube", FILTERED),
    ("texture_emulated", FILTERED),
    ("texture_linear", FILTERED),
    ("texture_trilinear", FILTERED),
];

/// The scene tests that nothing is drawn.
const NOTHING: &str = "nothing is covered";

/// A weight of 1/256 between texels far apart is more than 1/255 of the range.
const FILTERED: &str = "linear filtering between hard contrasts";

#[test]
fn the_classes_of_every_scene_add_up() {
    let gpu = gpu();
    let mut inconclusive = Vec::new();
    for path in scenes::paths() {
        let loaded = load(&path, &DiskFiles, &compiler());
        let mut scene = loaded.scene.expect("another test loads it");
        scene.framebuffer.width = scene.framebuffer.width.min(64);
        scene.framebuffer.height = scene.framebuffer.height.min(64);
        let options = strict();
        let mut expected = Expected::new(&scene, &options).expect("the reference draws it");
        let picture = gpu.render(&scene, Via::Spirv).expect("it draws").picture;
        let verdict = expected.compare(&picture).expect("the reference draws it");
        assert_eq!(verdict.evidence.total(), verdict.covered, "{path}");
        assert_eq!(verdict.widths.iter().map(|row| row.pixels).sum::<u64>(), verdict.covered, "{path}");
        if verdict.conclusion(&options.demands) == Conclusion::Inconclusive {
            let name = path.rsplit('/').next().unwrap_or_default().trim_end_matches(".toml").to_owned();
            inconclusive.push(name);
        }
    }
    inconclusive.sort_unstable();
    let known: Vec<&str> = INCONCLUSIVE.iter().map(|(name, _)| *name).collect();
    assert_eq!(inconclusive, known);
}
