//! `glisten specialize` end to end: exit codes, files, the account.

use crate::support::root;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

const VERTEX: &str = "#version 150\nin vec4 place;\nin vec4 tint;\nout vec4 shade;\nuniform vec4 move;\nuniform bool moves;\n\
    void main() { shade = tint; gl_Position = moves ? place + move : place; }\n";
const FRAGMENT: &str = "#version 150\nin vec4 shade;\nuniform int mode;\nuniform sampler2D plain;\nuniform vec4 paint;\nout vec4 color;\n\
    // Not called with these values\nvec4 other() { return texture(plain, shade.xy); }\n\
    void main() { color = mode == 1 ? other() : paint * shade; }\n";
const SCENE: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n[draw.attributes]\n\
    place = { size = 2, values = [-1, -1, 1, -1, 0, 1] }\ntint = { size = 3, values = [1, 0, 0, 0, 1, 0, 0, 0, 1] }\n\
    [draw.uniforms]\nmoves = false\nmove = [1, 2, 3, 4]\nmode = 0\npaint = [0.5, 0.25, 0.125, 1]\n\
    [draw.textures]\nplain = { width = 1, height = 1, values = [1, 1, 1, 1] }\n";

/// A folder with a program and a scene of it.
struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().expect("a temporary folder"));
        for (name, text) in [("a.vert", VERTEX), ("a.frag", FRAGMENT), ("a.toml", SCENE)] {
            place.write(name, text);
        }
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("written");
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).expect("JSON")
    }

    fn run(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.args(arguments).current_dir(self.0.path()).env("NO_COLOR", "1").stdin(Stdio::null());
        command.output().expect("the program runs")
    }

    /// Runs it and expects this exit code. Gives what it printed, results first.
    #[track_caller]
    fn expect(&self, code: i32, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {text}");
        text
    }

    fn names(&self, folder: &str) -> BTreeSet<String> {
        let entries = fs::read_dir(self.path(folder));
        entries.map_or_else(
            |_| BTreeSet::new(),
            |entries| {
                entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect()
            },
        )
    }
}

fn keys(value: &Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value.as_object().map_or_else(Vec::new, |map| map.keys().map(String::as_str).collect());
    keys.sort_unstable();
    keys
}

#[test]
fn it_writes_programs_scenes_targets_and_an_account() {
    let place = Folder::new();
    let text = place.expect(0, &["specialize", "a.toml", "-o", "out"]);
    assert!(text.contains("removed "), "{text}");
    let expected = [
        "a.account.json",
        "a.frag",
        "a.frag.spv",
        "a.frag.wgsl",
        "a.json",
        "a.toml",
        "a.vert",
        "a.vert.spv",
        "a.vert.wgsl",
        "programs.json",
    ];
    let names = place.names("out");
    assert!(expected.iter().all(|name| names.contains(*name)), "{names:?}");
    assert_eq!(place.json("out/programs.json"), serde_json::json!({"a": ["a"]}));
    let (vertex, fragment) = (place.read("out/a.vert"), place.read("out/a.frag"));
    for gone in ["move", "mode", "plain", "paint", "other", "Not called"] {
        assert!(!vertex.contains(gone) && !fragment.contains(gone), "{gone}:\n{vertex}{fragment}");
    }
    let account = place.json("out/a.account.json");
    assert!(["draws", "scene"].iter().all(|key| keys(&account).contains(key)), "{account}");
    let draw = &account["draws"][0];
    for key in ["after", "before", "fragment", "left_out", "residual", "vertex"] {
        assert!(keys(draw).contains(&key), "{draw}");
    }
    assert_eq!(
        (&draw["vertex"], &draw["fragment"], &draw["residual"]),
        (&"a.vert".into(), &"a.frag".into(), &"a".into())
    );
    let figures = [
        "attribute_bytes",
        "attributes",
        "fragment_operations",
        "spirv_instructions",
        "textures",
        "uniform_bytes",
        "varyings",
        "vertex_operations",
    ];
    for figure in figures {
        let [before, after] = ["before", "after"].map(|side| draw[side][figure].as_u64().expect("a number"));
        assert!(after <= before, "{figure}: {before} to {after}");
    }
    assert_eq!((draw["before"]["textures"].as_u64(), draw["after"]["textures"].as_u64()), (Some(1), Some(0)));
    let kinds =
        ["branch", "loop", "function", "statement", "varying", "attribute", "uniform", "block", "texture", "output"];
    let left_out = draw["left_out"].as_array().expect("a list");
    for one in left_out {
        assert!(["because", "file", "line", "name", "what"].iter().all(|key| keys(one).contains(key)), "{one}");
        assert!(kinds.iter().any(|kind| one["what"] == *kind), "{one}");
        assert!(one["line"].as_u64().is_some_and(|line| line > 0) && one["because"] != "", "{one}");
    }
    let told = |what: &str, name: &str| {
        let found = left_out.iter().find(|one| one["what"] == what && one["name"] == name);
        found.unwrap_or_else(|| panic!("{what} {name}: {left_out:#?}")).clone()
    };
    assert_eq!(told("function", "other")["line"], 8);
    assert_eq!((&told("uniform", "mode")["file"], &told("uniform", "mode")["line"]), (&"a.frag".into(), &3.into()));
    assert!(told("uniform", "mode")["because"].as_str().is_some_and(|because| because.contains('0')));
    told("texture", "plain");
}

/// The residual scene is a scene of the explicit core, and draws the same bytes; so does the residual of the residual.
#[test]
fn what_it_writes_draws_the_same_bytes() {
    let place = Folder::new();
    place.expect(0, &["specialize", "a.toml", "-o", "once"]);
    place.expect(0, &["specialize", "once/a.toml", "-o", "twice"]);
    let draw = |scene: &str, more: &[&str]| {
        let arguments = ["render", scene, "-o", "a.npy", "--backend", "cpu", "--precision", "f32"];
        place.expect(0, &[&arguments[..], more].concat());
        fs::read(place.path("a.npy")).expect("a picture")
    };
    let original = draw("a.toml", &[]);
    for (scene, more) in [("once/a.toml", &[][..]), ("twice/a.toml", &[]), ("a.toml", &["--specialize"])] {
        assert!(original == draw(scene, more), "{scene} {more:?}");
    }
    place.expect(0, &["verify", "a.toml", "--specialize"]);
    assert_eq!(place.read("once/a.frag"), place.read("twice/a.frag"));
    let text = place.expect(0, &["specialize", "once/a.toml", "--check"]);
    assert!(text.contains("nothing can be left out"), "{text}");
    // The same input gives the same bytes.
    place.expect(0, &["specialize", "a.toml", "-o", "again"]);
    for name in place.names("once") {
        assert!(
            fs::read(place.path(&format!("once/{name}"))).ok() == fs::read(place.path(&format!("again/{name}"))).ok(),
            "{name}"
        );
    }
}

#[test]
fn what_is_dynamic_stays() {
    let place = Folder::new();
    let residual = |arguments: &[&str]| {
        place.expect(0, &[&["specialize", "a.toml", "-o", "out"], arguments].concat());
        place.read("out/a.vert") + &place.read("out/a.frag")
    };
    let text = residual(&["--dynamic", "mode"]);
    assert!(text.contains("uniform int mode;") && !text.contains("uniform vec4 paint"), "{text}");
    assert!(place.read("out/a.toml").contains("dynamic = [\"mode\"]"));
    let text = residual(&["--dynamic", "mode", "--dynamic", "paint", "--dynamic", "moves", "--dynamic", "plain"]);
    assert!(["mode", "paint", "moves", "move", "plain"].iter().all(|name| text.contains(name)), "{text}");
    place.write("a.toml", &SCENE.replace("[draw.attributes]", "dynamic = [\"paint\"]\n[draw.attributes]"));
    assert!(residual(&[]).contains("uniform vec4 paint;"));
    // A name that is left of nothing is not in the scene any more.
    residual(&["--dynamic", "move"]);
    assert!(!place.read("out/a.toml").contains("\"move\""), "{}", place.read("out/a.toml"));
}

/// State of the fixed-function pipeline frees what is derived from it, as `[draw.uniforms]` sets it.
#[test]
fn dynamic_state_frees_what_follows_from_it() {
    let place = Folder::new();
    place.write(
        "a.vert",
        "#version 120\nvarying vec3 n;\nvarying vec4 c;\nvoid main() {\n    n = gl_Normal;\n    c = vec4(1.0);\n\
         \x20   if (gl_NormalMatrix[0][0] > 10.0) n = vec3(0.0);\n    if (gl_ModelViewProjectionMatrix[0][0] > 100.0) n += vec3(1.0);\n\
         \x20   if (gl_FrontLightProduct[0].diffuse.x > 100.0) c = vec4(0.5);\n    gl_Position = vec4(gl_Vertex.xyz * 0.5, 1.0);\n}\n",
    );
    place.write(
        "a.frag",
        "#version 120\nvarying vec3 n;\nvarying vec4 c;\nvoid main() { gl_FragColor = vec4(n, 1.0) * c; }\n",
    );
    let scene = |dynamic: &str| {
        format!(
            "[framebuffer]\nwidth = 8\nheight = 8\n[camera]\neye = [0, 0, 3]\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n{dynamic}\
             mesh = {{ shape = \"sphere\", segments = 8, rings = 4 }}\n"
        )
    };
    let uniforms = ["gl_NormalMatrix", "gl_ModelViewProjectionMatrix", "gl_FrontLightProduct"];
    place.write("a.toml", &scene(""));
    place.expect(0, &["render", "a.toml", "-o", "a.npy", "--backend", "cpu", "--precision", "f32"]);
    for (name, stay) in [
        ("gl_ModelViewMatrix", &["gl_NormalMatrix", "gl_ModelViewProjectionMatrix"][..]),
        ("gl_ProjectionMatrix", &["gl_ModelViewProjectionMatrix"]),
        ("gl_NormalMatrix", &["gl_NormalMatrix"]),
        ("gl_LightSource[0]", &["gl_FrontLightProduct"]),
        ("gl_LightSource[0].diffuse", &["gl_FrontLightProduct"]),
        ("gl_FrontMaterial", &["gl_FrontLightProduct"]),
        // The program reads nothing of them.
        ("gl_LightSource[1]", &[]),
        ("gl_Fog.density", &[]),
    ] {
        for by_scene in [true, false] {
            place.write("b.toml", &scene(&if by_scene { format!("dynamic = [\"{name}\"]\n") } else { String::new() }));
            let flags: &[&str] = if by_scene { &[] } else { &["--dynamic", name] };
            place.expect(0, &[&["specialize", "b.toml", "-o", "out"], flags].concat());
            let text = place.read("out/a.vert");
            for uniform in uniforms {
                assert_eq!(text.contains(uniform), stay.contains(&uniform), "{name}: {uniform}:\n{text}");
            }
            assert_eq!(place.read("out/b.toml").contains("dynamic = "), !stay.is_empty(), "{name}");
            place.expect(0, &["render", "out/b.toml", "-o", "b.npy", "--backend", "cpu", "--precision", "f32"]);
            assert!(fs::read(place.path("a.npy")).ok() == fs::read(place.path("b.npy")).ok(), "{name}");
        }
    }
    for name in ["gl_Nope", "gl_LightSource[9]", "gl_Fog.speed", "light"] {
        place.write("b.toml", &scene(&format!("dynamic = [\"{name}\"]\n")));
        let told = place.expect(1, &["specialize", "b.toml", "-o", "out"]);
        assert!(told.contains("E0907") && told.matches("`gl_NormalMatrix`").count() <= 1, "{told}");
        place.expect(2, &["specialize", "a.toml", "-o", "out", "--dynamic", name]);
    }
}

/// Names that are parts of something: what is left of them decides, and the scene reads back.
#[test]
fn parts_of_blocks_structs_and_arrays_may_be_dynamic() {
    let place = Folder::new();
    let fragment = "#version 150\nstruct Light { vec4 color; vec4 unused; };\nuniform Block { vec4 tint; vec4 gone; };\n\
        uniform Named { vec4 shade; vec4 lost; } named;\nuniform Light light[2];\nuniform float weights[4];\n\
        in vec4 shade;\nout vec4 color;\n\
        void main() { color = shade * tint + named.shade * light[1].color + weights[1]; if (gl_FragCoord.x < 0.0) color = gone; }\n";
    place.write("a.frag", fragment);
    let uniforms = "moves = false\nmove = [1, 2, 3, 4]\ntint = [1, 1, 1, 1]\ngone = [0, 0, 0, 1]\n\
        \"Named.shade\" = [0.5, 0.5, 0.5, 1]\n\"Named.lost\" = [0, 0, 0, 0]\n\"light[0].color\" = [1, 0, 0, 1]\n\
        \"light[1].color\" = [0, 1, 0, 1]\n\"light[0].unused\" = [1, 0, 0, 1]\n\"light[1].unused\" = [0, 1, 0, 1]\n\
        weights = [0.25, 0.5, 0.75, 1]\n";
    let head = SCENE.split("[draw.uniforms]").next().expect("the attributes");
    place.write("a.toml", &format!("{head}[draw.uniforms]\n{uniforms}"));
    let cases: &[(&str, bool)] = &[
        ("tint", true),
        ("gone", false),
        ("Block", true),
        ("Named.shade", true),
        ("Named.lost", false),
        ("Named", true),
        ("light[1]", true),
        ("light[0]", false),
        ("light[1].unused", false),
        ("light", true),
        ("weights[1]", true),
        ("weights[3]", true),
        ("weights", true),
    ];
    place.expect(0, &["render", "a.toml", "-o", "a.npy", "--backend", "cpu", "--precision", "f32"]);
    for (name, stays) in cases {
        place.expect(0, &["specialize", "a.toml", "-o", "out", "--dynamic", name]);
        let text = place.read("out/a.toml");
        assert_eq!(text.contains("dynamic = "), *stays, "{name}:\n{text}");
        place.expect(0, &["render", "out/a.toml", "-o", "b.npy", "--backend", "cpu", "--precision", "f32"]);
        assert!(fs::read(place.path("a.npy")).ok() == fs::read(place.path("b.npy")).ok(), "{name}");
        // The scene itself may name it, too.
        place.write(
            "b.toml",
            &place.read("a.toml").replace("[draw.attributes]", &format!("dynamic = [\"{name}\"]\n[draw.attributes]")),
        );
        place.expect(0, &["specialize", "b.toml", "-o", "out"]);
    }
    for name in ["tin", "Named.shad", "light[2]", "weights[4]"] {
        let text = place.expect(2, &["specialize", "a.toml", "-o", "out", "--dynamic", name]);
        assert!(text.contains("no program has a uniform"), "{name}: {text}");
    }
}

#[test]
fn a_scene_of_a_multisample_texture_comes_back() {
    let place = Folder::new();
    let fragment = "#version 150\nuniform sampler2DMS plain;\nuniform int mode;\nin vec4 shade;\nout vec4 color;\n\
        void main() { color = mode == 1 ? shade : texelFetch(plain, ivec2(gl_FragCoord.xy) % 2, int(gl_FragCoord.x) % 3); }\n";
    place.write("a.frag", fragment);
    let values: Vec<String> = (0..48).map(|n| format!("{}", f64::from(n) / 48.0)).collect();
    let head = SCENE.split("[draw.uniforms]").next().expect("the attributes");
    let texture = format!(
        "{{ kind = \"2d_multisample\", width = 2, height = 2, samples = 3, values = [{}] }}",
        values.join(", ")
    );
    place.write(
        "a.toml",
        &format!("{head}[draw.uniforms]\nmoves = false\nmode = 0\n[draw.textures]\nplain = {texture}\n"),
    );
    place.expect(0, &["specialize", "a.toml", "-o", "out"]);
    let draw = |scene: &str| {
        place.expect(0, &["render", scene, "-o", "a.npy", "--backend", "cpu", "--precision", "f32"]);
        fs::read(place.path("a.npy")).expect("a picture")
    };
    let text = place.read("out/a.toml");
    assert!(text.contains("samples = 3") && !text.contains("mipmaps"), "{text}");
    assert!(draw("a.toml") == draw("out/a.toml"), "{text}");
}

#[test]
fn several_scenes_share_residuals() {
    let place = Folder::new();
    place.write(
        "b.toml",
        &SCENE.replace("values = [1, 0, 0, 0, 1, 0, 0, 0, 1]", "values = [0, 0, 1, 0, 1, 0, 1, 0, 0]"),
    );
    place.write("c.toml", &SCENE.replace("mode = 0", "mode = 1"));
    place.write("d.toml", &(SCENE.to_owned() + &SCENE[SCENE.find("[[draw]]").expect("a draw")..]));
    place.expect(0, &["specialize", "a.toml", "b.toml", "c.toml", "d.toml", "-o", "out"]);
    let expected = serde_json::json!({"a": ["a"], "b": ["a"], "c": ["a_2"], "d": ["a", "a"]});
    assert_eq!(place.json("out/programs.json"), expected);
    assert!(
        place.names("out").contains("a_2.frag") && !place.names("out").contains("a_3.frag"),
        "{:?}",
        place.names("out")
    );
    for scene in ["a", "b", "c", "d"] {
        place.expect(0, &["render", &format!("out/{scene}.toml"), "-o", "a.png", "--backend", "cpu"]);
    }
}

#[test]
fn reflections_have_names_of_their_own() {
    for (program, residual) in [("programs", "programs_2"), ("a.account", "a.account_2")] {
        let place = Folder::new();
        place.write(&format!("{program}.vert"), VERTEX);
        place.write(&format!("{program}.frag"), FRAGMENT);
        place.write(
            "a.toml",
            &SCENE.replace("a.vert", &format!("{program}.vert")).replace("a.frag", &format!("{program}.frag")),
        );
        place.expect(0, &["specialize", "a.toml", "-o", "out"]);
        assert_eq!(place.json("out/programs.json"), serde_json::json!({"a": [residual]}));
        assert!(place.json(&format!("out/{residual}.json"))["entry_points"].is_object(), "{program}");
        assert_eq!(place.json("out/a.account.json")["scene"], "a");
        place.expect(0, &["render", "out/a.toml", "-o", "a.png", "--backend", "cpu"]);
    }
}

#[test]
fn targets_are_those_that_were_asked_for() {
    let place = Folder::new();
    let targets = ["--target", "hlsl", "--target", "msl", "--target", "glsl"];
    place.expect(0, &[&["specialize", "a.toml", "-o", "out"], &targets[..]].concat());
    let names = place.names("out");
    for extension in ["hlsl", "metal", "glsl"] {
        assert!(names.contains(&format!("a.frag.{extension}")), "{names:?}");
    }
    assert!(!names.contains("a.frag.wgsl"), "{names:?}");
}

#[test]
fn suggestions_are_text_or_json() {
    let place = Folder::new();
    place.write("b.toml", &SCENE.replace("mode = 0", "mode = 1"));
    let text = place.expect(0, &["specialize", "a.toml", "b.toml", "--suggest"]);
    for word in ["2 scenes", "mode", "paint", "fixed so far", "+ mode"] {
        assert!(text.contains(word), "{word}:\n{text}");
    }
    let output = place.run(&["specialize", "a.toml", "b.toml", "--suggest", "--format", "json", "--dynamic", "paint"]);
    let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(keys(&json), ["curve", "operations_all", "operations_none", "scenes", "uniforms"]);
    let names: Vec<&str> =
        json["uniforms"].as_array().expect("a list").iter().filter_map(|one| one["name"].as_str()).collect();
    assert!(names.contains(&"mode") && !names.contains(&"paint"), "{names:?}");
    assert_eq!((&json["curve"][0]["fixed"], &json["curve"][0]["variants"]), (&Value::Null, &1.into()));
    assert!(place.names("out").is_empty());
    place.expect(2, &["specialize", "a.toml", "--suggest", "--check"]);
    place.expect(2, &["specialize", "a.toml", "-o", "out", "--format", "json"]);
    place.expect(2, &["specialize", "a.toml", "--suggest", "--dynamic", "pain"]);
}

#[test]
fn checking_writes_nothing() {
    let place = Folder::new();
    let before = place.names(".");
    let text = place.expect(0, &["specialize", "a.toml", "--check"]);
    assert!(text.contains("things can be left out"), "{text}");
    place.expect(0, &["specialize", "a.toml", "--check", "-o", "out"]);
    assert_eq!(before, place.names("."));
}

#[test]
fn mistakes_have_their_exit_codes() {
    let place = Folder::new();
    place.write("plain", "");
    place.write("broken.toml", "[[draw]\n");
    place.write("other.toml", &SCENE.replace("a.frag", "none.frag"));
    place.write("bad.toml", &SCENE.replace("a.frag", "bad.frag"));
    place.write("bad.frag", "#version 150\nout vec4 color;\nvoid main() { color = nothing; }\n");
    fs::create_dir(place.path("sub")).expect("a folder");
    place.write("sub/a.toml", SCENE);
    let cases: [(i32, &[&str], &str); 10] = [
        (2, &["a.toml"], "--output"),
        (2, &[], "SCENE"),
        (2, &["none.toml", "-o", "out"], "none.toml"),
        (2, &["other.toml", "-o", "out"], "none.frag"),
        (2, &["a.toml", "-o", "out", "--dynamic", "pain"], "did you mean `paint`"),
        (2, &["a.toml", "-o", "out", "--target", "cg"], "cg"),
        (2, &["a.toml", "-o", "plain"], "plain"),
        (2, &["a.toml", "sub/a.toml", "-o", "out"], "two scenes are named `a`"),
        (1, &["broken.toml", "-o", "out"], "broken.toml"),
        (1, &["bad.toml", "-o", "out"], "`nothing` is not declared"),
    ];
    for (code, arguments, word) in cases {
        let text = place.expect(code, &[&["specialize"], arguments].concat());
        assert!(text.contains(word), "{arguments:?}: {text}");
    }
    // Nothing is written if there is nothing to write.
    let text = place.expect(1, &["specialize", "bad.toml", "-o", "nothing"]);
    assert!(!text.contains("wrote") && !place.path("nothing").exists(), "{text}");
    // Of several scenes the good one is written, and the bad one is told.
    place.expect(1, &["specialize", "a.toml", "bad.toml", "-o", "out"]);
    assert!(place.names("out").contains("a.frag"));
}

#[test]
fn odd_scenes_come_back() {
    let place = Folder::new();
    let changes: &[(&str, &str)] = &[
        // Nothing is drawn, or nearly nothing.
        ("[draw.attributes]", "instances = 0\n[draw.attributes]"),
        ("[draw.attributes]", "indices = []\n[draw.attributes]"),
        ("values = [-1, -1, 1, -1, 0, 1]", "values = [0, 0, 0, 0, 0, 0]"),
        // Values at the ends of what numbers can be.
        ("paint = [0.5, 0.25, 0.125, 1]", "paint = [3.4e38, -3.4e38, 1e-45, -0.0]"),
        ("paint = [0.5, 0.25, 0.125, 1]", "paint = [inf, -inf, nan, 0]"),
        ("mode = 0", "mode = -2147483648"),
        // A texture that differs from texel to texel, by a mode that reads it.
        ("width = 1, height = 1, values = [1, 1, 1, 1]", "width = 2, height = 1, values = [1, nan, 1, 1, 0, 0, 0, 0]"),
        ("[draw.attributes]", "primitive = \"points\"\nprogram_point_size = true\n[draw.attributes]"),
        ("[draw.attributes]", "blend = \"add\"\ncull = \"front\"\n[draw.attributes]"),
    ];
    for (from, to) in changes {
        assert!(SCENE.contains(from), "{from}");
        place.write("odd.toml", &SCENE.replacen(from, to, 1));
        let arguments = ["odd.toml", "-o", "a.npy", "--backend", "cpu", "--precision", "f32"];
        let drawn = place.run(&[&["render"], &arguments[..]].concat());
        let original = fs::read(place.path("a.npy")).ok();
        let done = place.run(&["specialize", "odd.toml", "-o", "out"]);
        assert_eq!(drawn.status.code(), done.status.code(), "{to}: {}", String::from_utf8_lossy(&done.stderr));
        if done.status.success() {
            place.expect(0, &["render", "out/odd.toml", "-o", "b.npy", "--backend", "cpu", "--precision", "f32"]);
            assert!(original == fs::read(place.path("b.npy")).ok(), "{to}");
        }
    }
}

#[test]
fn the_gallery_is_one_set_of_residuals() {
    let place = Folder::new();
    let scenes = ["directional", "point", "spot"].map(|name| root().join(format!("shader_lib/scenes/{name}.toml")));
    let scenes = scenes.each_ref().map(|path| path.to_str().expect("a path of this machine"));
    place.expect(0, &[&["specialize", "-o", "out"], &scenes[..]].concat());
    let programs = place.json("out/programs.json");
    assert_eq!(keys(&programs), ["directional", "point", "spot"]);
    for stem in programs.as_object().expect("a map").values().flat_map(|list| list.as_array().expect("a list")) {
        let stem = stem.as_str().expect("a name");
        assert!(place.names("out").contains(&format!("{stem}.frag.spv")), "{stem}");
    }
}

/// Residuals are GLSL 1.50, in which varyings have no locations: names take their place, wherever both stages have their own.
#[test]
fn varyings_with_locations_are_matched_by_name() {
    let place = Folder::new();
    place.write(
        "l.vert",
        "#version 440\nlayout(location = 0) in vec4 place;\nlayout(location = 1) in vec4 tint;\nuniform vec4 scale;\n\
         layout(location = 0) out vec4 first;\nlayout(location = 1) out vec4 second;\nlayout(location = 2) out Lit { vec4 glow; } lit;\n\
         layout(location = 4) out vec4 color;\n\
         void main() { first = tint; second = tint * scale; lit.glow = tint.zyxw; color = tint.yxzw; gl_Position = place; }\n",
    );
    place.write(
        "l.frag",
        "#version 440\nlayout(location = 1) in vec4 first;\nlayout(location = 0) in vec4 second;\n\
         layout(location = 2) in Glowing { vec4 glow; } lit;\nlayout(location = 4) in vec4 tint;\nuniform float unread;\n\
         layout(location = 0) out vec4 color;\n\
         void main() { vec4 third = tint; color = first * 0.5 + second * 0.25 + lit.glow * 0.125 + third; }\n",
    );
    place.write(
        "l.toml",
        "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"l.vert\"\nfragment = \"l.frag\"\n[draw.attributes]\n\
         place = { size = 2, values = [-1, -1, 1, -1, 0, 1] }\ntint = { size = 3, values = [1, 0, 0, 0, 1, 0, 0, 0, 1] }\n\
         [draw.uniforms]\nscale = [1, 2, 3, 4]\nunread = 1.0\n",
    );
    place.expect(0, &["specialize", "l.toml", "-o", "out"]);
    for name in ["out/l.vert", "out/l.frag"] {
        let text = place.read(name);
        let crosses = |line: &&str| line.contains("out ") || line.contains("in ");
        let located = text.lines().filter(crosses).filter(|line| line.contains("location")).count();
        assert_eq!(located, if name.ends_with("vert") { 2 } else { 1 }, "attributes and colors alone: {text}");
    }
    let render = |scene: &str, out: &str| place.expect(0, &["render", scene, "--backend", "cpu", "-o", out]);
    render("l.toml", "a.npy");
    render("out/l.toml", "b.npy");
    assert_eq!(fs::read(place.path("a.npy")).expect("drawn"), fs::read(place.path("b.npy")).expect("drawn"));
    let account = place.json("out/l.account.json");
    let gone = account["draws"][0]["left_out"].as_array().expect("entries");
    assert!(gone.iter().all(|entry| entry["what"] != "varying"), "{gone:?}");
    place.expect(0, &["verify", "out/l.toml"]);
}

/// The times of original and residual stand in the account; the original stays where the residual is slower, which it is not here.
#[test]
fn times_are_measured_in_turns() {
    let place = Folder::new();
    let text = place.expect(0, &["specialize", "a.toml", "-o", "out", "--time", "--adapter", "software"]);
    assert!(text.contains(" of the time ["), "{text}");
    let account = place.json("out/a.account.json");
    let time = &account["time"];
    let expected = ["after_ms", "before_ms", "interval", "noise", "ratio", "rounds", "slower"];
    assert_eq!(keys(time), expected, "{account}");
    let number = |key: &str| time[key].as_f64().expect("a number");
    assert!(number("rounds") >= 6.0 && number("ratio") > 0.0, "{time}");
    let kept = account["draws"][0]["kept"] == "program";
    assert_eq!(time["slower"].as_bool(), Some(kept), "{account}");
}
