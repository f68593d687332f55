//! The keys of a draw that say how its sources are completed: `engine`, `assume_version`, `includes`, `preludes`, `defines`.

use crate::cli::{Folder, code, err};
use glisten::scene::DiskFiles;
use glisten::{Compiler, Options, RenderOptions, render};
use glisten_verify::scene;
use std::fs;

const FULL: &str = "#version 300 es\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }\n";
const TOY: &str = "#include \"level.glsl\"\nvoid mainImage(out vec4 c, in vec2 p) { c = vec4(iResolution.x / 64.0, LEVEL, MORE, 1.0) * SCALE; }\n";
const SCENE: &str = "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"../full.vert\"\nfragment = \"../toy.glsl\"\n\
    vertex_count = 3\nengine = \"shadertoy\"\nincludes = [\"../lib\"]\npreludes = \"../before.glsl\"\n\
    defines = { SCALE = 0.5 }\n[draw.uniforms]\niResolution = [16, 16, 1]\n";

fn folder(scene: &str) -> Folder {
    let lib = "#define LEVEL 0.5\n";
    Folder::new(&[
        ("full.vert", FULL.as_bytes()),
        ("toy.glsl", TOY.as_bytes()),
        ("lib/level.glsl", lib.as_bytes()),
        ("before.glsl", b"#define MORE 1.0\n"),
        ("scenes/a.toml", scene.as_bytes()),
    ])
}

/// The color of the first pixel of a picture of floats.
fn color(folder: &Folder, arguments: &[&str]) -> Result<[f32; 4], String> {
    let all = [&["render", "scenes/a.toml", "-o", "a.npy", "--backend", "cpu", "--allow", "W0108"], arguments].concat();
    let output = folder.run(&all);
    if code(&output) != 0 {
        return Err(err(&output));
    }
    let bytes = fs::read(folder.path("a.npy")).expect("written");
    let texels = &bytes[bytes.len() - 8 * 8 * 16..];
    let number = |index: usize| f32::from_le_bytes(texels[index * 4..index * 4 + 4].try_into().expect("four bytes"));
    Ok([0, 1, 2, 3].map(number))
}

#[test]
fn the_keys_complete_sources_and_flags_take_precedence() {
    let folder = folder(SCENE);
    assert_eq!(color(&folder, &[]), Ok([0.125, 0.25, 0.5, 0.5]));
    assert_eq!(color(&folder, &["-D", "SCALE=1.0"]), Ok([0.25, 0.5, 1.0, 1.0]), "a flag replaces a macro");
    fs::create_dir(folder.path("first")).expect("a folder");
    fs::write(folder.path("first/level.glsl"), "#define LEVEL 1.0\n").expect("written");
    assert_eq!(color(&folder, &["-I", "first"]), Ok([0.125, 0.5, 0.5, 0.5]), "folders of flags are searched first");
    let output = folder.run(&["verify", "scenes/a.toml", "--allow", "W0108"]);
    assert_eq!(code(&output), 0, "{}", err(&output));
}

#[test]
fn the_library_obeys_them_without_a_command() {
    let folder = folder(SCENE);
    let path = folder.path("scenes/a.toml");
    let loaded = scene::load(&path.to_string_lossy(), &DiskFiles, &Compiler::new(Options::default()));
    let picture = render(&loaded.scene.expect("it loads"), &RenderOptions::default()).expect("it draws");
    assert_eq!(picture.attachments[0][0], [0.125, 0.25, 0.5, 0.5]);
}

#[test]
fn a_version_is_assumed_for_both_stages() {
    let folder = folder(
        "[framebuffer]\nwidth = 8\nheight = 8\n[[draw]]\nvertex = \"../a.vert\"\nfragment = \"../a.frag\"\n\
        assume_version = 330\nvertex_count = 3\n",
    );
    fs::write(folder.path("a.vert"), FULL.replace("#version 300 es", "")).expect("written");
    fs::write(folder.path("a.frag"), "layout(location = 0) out vec4 c;\nvoid main() { c = vec4(0.5); }\n")
        .expect("written");
    assert_eq!(color(&folder, &[]), Ok([0.5; 4]));
    assert!(color(&folder, &["--assume-version", "110"]).is_err(), "the flag takes precedence");
}

#[test]
fn wrong_settings_are_told_before_anything_follows_from_them() {
    for (key, wrong, help) in [
        ("engine = \"shadertoy\"", "engine = \"shadrtoy\"", "did you mean `shadertoy`?"),
        ("engine = \"shadertoy\"", "engine = 3", "`engine` must be a string"),
        ("engine = \"shadertoy\"", "assume_version = \"33x\"", "`33x` is no version"),
        ("includes = [\"../lib\"]", "includes = [3]", "`includes` must be a string"),
        ("engine = \"shadertoy\"", "include_style = \"mojj\"", "did you mean `moj`?"),
        ("../before.glsl", "../after.glsl", "after.glsl"),
    ] {
        let folder = folder(&SCENE.replace(key, wrong));
        let told = color(&folder, &[]).expect_err("it does not load");
        assert!(told.contains(help) && told.contains("1 error\n"), "{wrong}: {told}");
    }
}
