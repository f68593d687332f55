//! `compile --permutations`: each variant has the bytes that it has alone, equal outputs are one file, and the order of the
//! work does not show.

use crate::cache::files;
use crate::cli::{Folder, code, err};
use crate::support::root;
use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;

fn project(file: &str) -> Folder {
    let text = |name: &str| fs::read(root().join("fixtures/permutations").join(name)).expect("the fixture");
    Folder::new(&[
        ("uber.vert", &text("uber.vert")),
        ("uber.frag", &text("uber.frag")),
        ("lights.glsl", &text("lights.glsl")),
        ("p.toml", file.as_bytes()),
    ])
}

const UBER: &str = "[[program]]\nfiles = [\"uber.vert\", \"uber.frag\"]\nname = \"u\"\npragmas = true\n\
    skip = [\"GGX FOG_EXP\"]\nonly = [\"!INSTANCED !ALPHA_TEST\"]\n[program.values]\nLIGHTS = [0, 2]\nUNREAD = [false, true]\n";

fn index(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.path(name).join("index.json")).expect("an index")).expect("JSON")
}

#[test]
fn each_variant_has_the_bytes_that_it_has_alone() {
    let folder = project(UBER);
    let run = folder.run(&["compile", "--permutations", "p.toml", "-o", "out"]);
    assert_eq!(code(&run), 0, "{}", err(&run));
    let index = index(&folder, "out");
    let program = &index["programs"][0];
    let variants = program["variants"].as_array().expect("a list");
    // (4 models x 3 kinds of fog - GGX with FOG_EXP) x NORMAL_MAP x SKINNED x LIGHTS x UNREAD.
    assert_eq!(variants.len(), 11 * 2 * 2 * 2 * 2);
    for (number, variant) in variants.iter().enumerate().step_by(17) {
        let defines = variant["defines"].as_object().expect("macros");
        let flags: Vec<String> =
            defines.iter().map(|(name, value)| format!("-D{name}={}", value.as_str().expect("a text"))).collect();
        let alone = format!("alone{number}");
        let mut words = vec!["compile", "uber.vert", "uber.frag", "-o", &alone];
        words.extend(flags.iter().map(String::as_str));
        assert_eq!(code(&folder.run(&words)), 0);
        let shader = &program["shaders"][variant["shader"].as_u64().expect("a number") as usize];
        for (stage, end) in [("vertex", "vert"), ("fragment", "frag")] {
            for (target, extension) in [("wgsl", "wgsl"), ("spirv", "spv")] {
                let path = shader["stages"][stage][target].as_str().expect("a path");
                let own = fs::read(folder.path("out").join(path)).expect("written");
                let other = fs::read(folder.path(&alone).join(format!("uber.{end}.{extension}"))).expect("written");
                assert!(own == other, "{path} of {flags:?}");
            }
        }
        let reflection = fs::read(folder.path("out").join(shader["reflection"].as_str().expect("a path")));
        let reflection: Value = serde_json::from_slice(&reflection.expect("written")).expect("JSON");
        let alone: Value =
            serde_json::from_slice(&fs::read(folder.path(&alone).join("uber.json")).expect("written")).expect("JSON");
        assert_eq!(reflection["uniforms"], alone["uniforms"]);
    }
    // A macro that nothing reads makes no difference, and equal outputs are one file.
    assert_eq!(program["shaders"].as_array().expect("a list").len(), variants.len() / 2);
    let written: BTreeSet<String> = files(&folder.path("out")).into_keys().collect();
    let mut named = BTreeSet::from(["index.json".to_owned()]);
    for shader in program["shaders"].as_array().expect("a list") {
        named.insert(shader["reflection"].as_str().expect("a path").to_owned());
        let stages = shader["stages"]
            .as_object()
            .expect("stages")
            .values()
            .flat_map(|stage| stage.as_object().expect("targets").values());
        named.extend(stages.map(|path| path.as_str().expect("a path").to_owned()));
    }
    assert_eq!(written, named);
    // Many variants share a vertex shader.
    let count = |end: &str| written.iter().filter(|name| name.ends_with(end)).count();
    assert!(count(".vert.spv") < count(".frag.spv"), "{} of {}", count(".vert.spv"), count(".frag.spv"));
}

#[test]
fn the_order_of_the_work_does_not_show() {
    let folder = project(UBER);
    let run = |out: &str, more: &[&str]| {
        let run = folder.run(&[&["compile", "--permutations", "p.toml", "-o", out], more].concat());
        assert_eq!(code(&run), 0, "{}", err(&run));
        files(&folder.path(out))
    };
    let one = run("one", &["-j1", "--no-cache", "--depfile", "one.d", "--manifest", "one.json"]);
    assert!(one == run("two", &["-j2", "--cache", "kept"]), "the bytes differ");
    assert!(one == run("three", &["-j2", "--cache", "kept"]), "the bytes differ");
    let rule = fs::read_to_string(folder.path("one.d")).expect("written");
    assert_eq!(rule, "one/index.json: p.toml uber.vert uber.frag lights.glsl\n");
    let manifest: Value = serde_json::from_slice(&fs::read(folder.path("one.json")).expect("written")).expect("JSON");
    assert_eq!(manifest["outputs"].as_array().expect("a list").len(), one.len() - 1, "all but the index");
    assert_eq!(manifest["outputs"][0]["sources"][0]["file"], "p.toml");
}

#[test]
fn an_error_names_its_variant_and_nothing_is_written() {
    let folder = project(
        "[[program]]\nfiles = [\"uber.vert\", \"uber.frag\"]\nvalues = { LIGHTS = [1, \"1.5\"], GGX = [false, true] }\n",
    );
    let run = folder.run(&["compile", "--permutations", "p.toml", "-o", "out"]);
    assert_eq!(code(&run), 1, "{}", err(&run));
    assert!(err(&run).contains("in the variant `LIGHTS=1.5`"), "{}", err(&run));
    assert!(!folder.path("out").exists());
    for (file, exit) in [("[[program]]\nfiles = [\"none.vert\"]\n", 2), ("[[program]]\nfiles = [3]\n", 1), ("x", 1)] {
        let run = project(file).run(&["compile", "--permutations", "p.toml", "-o", "out"]);
        assert_eq!(code(&run), exit, "{file}: {}", err(&run));
        assert!(!err(&run).is_empty());
    }
    let run = project(UBER).run(&["compile", "--permutations", "missing.toml", "-o", "out"]);
    assert_eq!(code(&run), 2);
    let run = project(UBER).run(&["compile", "--permutations", "p.toml", "-o", "-"]);
    assert_eq!(code(&run), 2);
}

#[test]
fn warnings_are_told_once_and_obey_levels() {
    let folder = project("[[program]]\nfiles = [\"w.frag\"]\nvalues = { A = [0, 1, 2, 3] }\n");
    let text = "#version 150\nout vec4 c;\nuniform float x;\nvoid main() { c = vec4(x == 0.5 ? A : 1); }\n";
    fs::write(folder.path("w.frag"), text).expect("written");
    let run = |more: &[&str]| folder.run(&[&["compile", "--permutations", "p.toml", "--cache", "kept"], more].concat());
    for _ in 0..2 {
        let told = run(&["-o", "out"]);
        assert_eq!(code(&told), 0, "{}", err(&told));
        assert_eq!(err(&told).matches("is compiled without its partner").count(), 1, "{}", err(&told));
    }
    let denied = run(&["-o", "x", "--deny", "warnings"]);
    assert_eq!(code(&denied), 1, "{}", err(&denied));
    assert!(!folder.path("x").exists());
}

#[test]
fn draws_of_scenes_are_variants() {
    let scene = root().join("fixtures/scenes/phong.toml");
    let folder = project(&format!("[[scene]]\nfile = {:?}\n", scene.display().to_string()));
    let run = folder.run(&["compile", "--permutations", "p.toml", "-o", "out", "--target", "spirv", "-O0"]);
    assert_eq!(code(&run), 0, "{}", err(&run));
    let index = index(&folder, "out");
    let program = &index["programs"][0];
    assert_eq!((&program["name"], &program["variants"][0]["draw"]), (&Value::from("phong"), &Value::from(0)));
    let path = program["shaders"][0]["stages"]["fragment"]["spirv"].as_str().expect("a path");
    let special = fs::read(folder.path("out").join(path)).expect("written");
    let words = ["specialize", scene.to_str().expect("a path"), "-o", "other", "--target", "spirv", "-q"];
    assert_eq!(code(&folder.run(&words)), 0);
    let other = files(&folder.path("other"));
    assert!(other.values().any(|bytes| *bytes == special), "the residual is that of `specialize`");
}

/// A scene with a mesh of its own and a texture from a file.
const ROOM: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"r.vert\"\nfragment = \"r.frag\"\n\
    mesh = { file = \"m.obj\", position = \"position\" }\n[draw.textures]\nt = { file = \"t.png\" }\n[draw.uniforms]\nk = 0.0\n";

/// Two PNG pictures of 2 x 2 pixels, of the values 9 and 10.
const GRAY: &str = "89504e470d0a1a0a0000000d494844520000000200000002080600000072b60d240000000e4944415478da63e084020618030005220091e3952ebe\
    0000000049454e44ae426082";
const LIGHTER: &str = "89504e470d0a1a0a0000000d494844520000000200000002080600000072b60d240000000e4944415478da63e082020618030005b200a13541d6a5\
    0000000049454e44ae426082";

fn bytes(digits: &str) -> Vec<u8> {
    let byte = |place| u8::from_str_radix(&digits[place..place + 2], 16).expect("digits");
    (0..digits.len()).step_by(2).map(byte).collect()
}

#[test]
fn a_scene_comes_from_the_cache_until_a_file_of_it_changes() {
    let folder = project("[[scene]]\nfile = \"room.toml\"\n");
    let write = |name: &str, text: &[u8]| fs::write(folder.path(name), text).expect("written");
    let picture = |digits: &str| write("t.png", &bytes(digits));
    write("room.toml", ROOM.as_bytes());
    write("r.vert", b"#version 150\nin vec3 position;\nvoid main() { gl_Position = vec4(position, 1.0); }\n");
    let fragment = "#version 150\n#include \"r.glsl\"\nuniform sampler2D t;\nuniform float k;\nout vec4 c;\n\
        void main() { c = k == 0.0 ? texture(t, vec2(0.5)) : other(); }\n";
    write("r.frag", fragment.as_bytes());
    write("r.glsl", b"vec4 other() { return vec4(1.0); }\n");
    write("m.obj", b"v -1 -1 0\nv 3 -1 0\nv -1 3 0\nf 1 2 3\n");
    picture(GRAY);
    let run = |what: &str, out: &str, is_hit: bool| {
        let words =
            ["compile", "--permutations", "p.toml", "--cache", "kept", "-o", out, "--depfile", "d", "--manifest", "m"];
        let run = folder.run(&words);
        assert_eq!(code(&run), 0, "{}", err(&run));
        let told = if is_hit { "1 of 1 from the cache" } else { "0 of 1 from the cache" };
        assert!(err(&run).contains(told), "{what}: {}", err(&run));
        let accounts = ["d", "m"].map(|name| fs::read_to_string(folder.path(name)).expect("written").replace(out, ""));
        (files(&folder.path(out)), accounts)
    };
    let first = run("nothing before", "one", false);
    for name in ["p.toml", "room.toml", "r.vert", "r.frag", "r.glsl", "m.obj", "t.png"] {
        assert!(first.1[0].contains(name), "{name} in {}", first.1[0]);
    }
    assert!(first == run("the same", "two", true), "a result of the cache is another");
    let changes: [(&str, &dyn Fn()); 5] = [
        ("the scene", &|| write("room.toml", ROOM.replace("0.0", "1.0").as_bytes())),
        ("an include", &|| write("r.glsl", b"vec4 other() { return vec4(0.5); }\n")),
        ("the mesh", &|| write("m.obj", b"v -1 -1 0\nv 2 -1 0\nv -1 2 0\nf 1 2 3\n")),
        ("the texture", &|| picture(LIGHTER)),
        ("a shader", &|| write("r.frag", fragment.replace("vec2(0.5)", "vec2(0.25)").as_bytes())),
    ];
    for (number, (what, change)) in changes.iter().enumerate() {
        change();
        run(what, &format!("miss{number}"), false);
        run(what, &format!("hit{number}"), true);
    }
}

#[test]
fn a_scene_that_is_not_there_is_told() {
    assert_eq!(
        code(&project("[[scene]]\nfile = \"none.toml\"\n").run(&["compile", "--permutations", "p.toml", "-o", "x"])),
        2
    );
}

#[test]
fn outputs_of_variants_that_left_the_list_are_pruned() {
    let both =
        "[[program]]\nfiles = [\"uber.vert\", \"uber.frag\"]\nname = \"u\"\nkeywords = [\"multi_compile PHONG GGX\"]\n";
    let gone = both.replace("\"u\"", "\"v\"");
    let folder = project(&format!("{both}{gone}"));
    let run = |words: &[&str]| {
        let run = folder.run(&[&["compile", "--permutations", "p.toml", "-o", "out"], words].concat());
        assert_eq!(code(&run), 0, "{}", err(&run));
        files(&folder.path("out"))
    };
    let all = run(&["--manifest", "all.json", "-j1"]);
    let keeps = ["out/u/notes.txt", "out/u/0123456789abcdef0123.frag.wgsl", "out/v/kept.txt"];
    keeps.iter().for_each(|name| fs::write(folder.path(name), "mine").expect("written"));
    fs::write(folder.path("p.toml"), both.replace("PHONG GGX", "PHONG")).expect("written");
    assert!(run(&[]).len() >= all.len(), "without the flag, everything remains");
    let left = run(&["--prune"]);
    let mut names: BTreeSet<String> = left.into_keys().collect();
    for name in keeps {
        assert!(names.remove(name.trim_start_matches("out/")), "`{name}` is nobody's output");
    }
    // Two stages for two targets, the reflection, the index.
    assert_eq!(names.len(), 6, "{names:?}");
    assert!(names.iter().all(|name| name == "index.json" || name.starts_with("u/")), "{names:?}");
    let alone = folder.run(&["compile", "uber.vert", "uber.frag", "-o", "x", "--prune"]);
    assert_eq!(code(&alone), 2, "{}", err(&alone));
}

#[test]
fn the_manifest_does_not_tell_the_number_of_threads() {
    let folder = project(UBER);
    let manifest = |jobs: &str| {
        let words = ["compile", "--permutations", "p.toml", "-o", "out", "--manifest", "m.json", jobs];
        assert_eq!(code(&folder.run(&words)), 0);
        fs::read_to_string(folder.path("m.json")).expect("written")
    };
    assert_eq!(manifest("-j1"), manifest("--jobs=2"));
}
