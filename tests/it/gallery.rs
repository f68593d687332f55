//! The library's programs and scenes, and `glisten gallery` end to end.

use crate::drawing::{complaint, from_texts, strict};
use crate::support::{compiler, root};
use glisten::library::{programs, scenes};
use glisten::scene::{DiskFiles, Scene, load};
use glisten_gpu::Gpu;
use glisten_report::gallery::{Entry, entries};
use glisten_scene::picture::Image;
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn all() -> Vec<Entry> {
    entries().expect("the library's scenes are good")
}

#[test]
fn scenes_load_from_disk_without_a_finding() {
    for scene in scenes() {
        let path = format!("{}/shader_lib/scenes/{}.toml", env!("CARGO_MANIFEST_DIR"), scene.name);
        let loaded = load(&path, &DiskFiles, &compiler());
        let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
        assert!(loaded.scene.is_some() && told.is_empty(), "{path}: {told:?}");
    }
}

#[test]
fn every_program_has_a_scene() {
    let drawn: BTreeSet<&str> = scenes()
        .iter()
        .flat_map(|scene| scene.text.lines().filter_map(|line| line.strip_prefix("program = \"")?.strip_suffix('"')))
        .collect();
    let without: Vec<&str> =
        programs().iter().map(|program| program.name).filter(|name| !drawn.contains(name)).collect();
    // The omitted programs: those of the textbook per vertex (one of them is drawn), and those with another
    // interpolation.
    let siblings = [
        "lambert_vertex",
        "phong_vertex",
        "schlick_vertex",
        "standard_vertex",
        "threshold_vertex",
        "vertex_color_noperspective",
    ];
    assert_eq!(without, siblings);
}

#[test]
fn programs_have_no_findings() {
    let folder = root().join("shader_lib/programs");
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.args(["lint", "--deny", "warnings"]).current_dir(folder);
    for program in programs() {
        command.arg("--program").arg(format!("{},{}", program.vertex, program.fragment));
    }
    let run = command.output().expect("the program runs");
    assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stdout));
}

/// Compares the pictures of the GPU and of the reference for a scene, at a size that is fast enough for a test.
/// Returns what is wrong.
fn compare(gpu: &Gpu, name: &str, scene: &Scene) -> Option<String> {
    let mut scene = scene.clone();
    (scene.framebuffer.width, scene.framebuffer.height) = (64, 64);
    complaint(&format!("gallery_{name}"), gpu, &scene, &strict())
}

#[test]
fn every_scene_is_the_same_picture_on_both_sides() {
    let gpu = crate::drawing::gpu();
    let wrong: Vec<String> = all().iter().filter_map(|entry| compare(&gpu, entry.name, entry.scene())).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn programs_that_shade_each_vertex_are_the_same_picture_on_both_sides() {
    let gpu = crate::drawing::gpu();
    let mut wrong = Vec::new();
    for (scene, model) in [
        ("lambert", "lambert"),
        ("phong", "phong"),
        ("blinn_phong", "blinn_phong"),
        ("schlick", "schlick"),
        ("threshold", "threshold"),
        ("lights", "standard"),
        ("schlick_phong", "standard"),
        ("hemi_knot", "standard"),
    ] {
        let text = scenes().iter().find(|known| known.name == scene).expect("it is there").text;
        let program = format!("program = \"{model}\"");
        assert!(text.contains(&program), "{scene}");
        let text = text.replace(&program, &format!("program = \"{model}_vertex\""));
        let drawn = from_texts([("a.toml", text.as_str())]);
        wrong.extend(compare(&gpu, &format!("{scene}_at_each_vertex"), &drawn));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

fn gallery(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_glisten"))
        .args(["gallery", "-o"])
        .arg(folder)
        .args(arguments)
        .output()
        .expect("the program runs")
}

/// A PNG file.
fn image(path: &Path) -> Image {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    Image::read(&bytes, 4096, 1 << 24).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

#[test]
fn both_backends_draw_the_whole_gallery() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (gpu, cpu) = (folder.path().join("gpu"), folder.path().join("cpu"));
    for (out, arguments) in [(&gpu, &["--size", "32"][..]), (&cpu, &["--size", "32", "--backend", "cpu"])] {
        let run = gallery(out, arguments);
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        assert!(run.stdout.is_empty());
        let mut files: Vec<String> = fs::read_dir(out)
            .expect("the folder is there")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        files.sort();
        let mut wanted: Vec<String> = scenes().iter().map(|scene| format!("{}.png", scene.name)).collect();
        wanted.extend(["index.html", "gallery.png", "hemisphere_table-difference.png"].map(str::to_owned));
        wanted.sort();
        assert_eq!(files, wanted, "nothing is missing and nothing is left over");
        let page = fs::read_to_string(out.join("index.html")).expect("the page");
        for attribute in ["src=\"", "href=\""] {
            for target in page.split(attribute).skip(1).filter_map(|rest| rest.split('"').next()) {
                let there = match target.strip_prefix('#') {
                    Some(id) => page.contains(&format!("id=\"{id}\"")),
                    None => out.join(target).is_file(),
                };
                assert!(there, "{target}");
            }
        }
        assert!(page.len() < 5 << 18, "{} bytes", page.len());
    }
    for scene in scenes() {
        let name = format!("{}.png", scene.name);
        let (gpu, cpu) = (image(&gpu.join(&name)), image(&cpu.join(&name)));
        let text: toml::Table = scene.text.parse().expect("the scenes are TOML");
        let side = |key: &str| text["framebuffer"][key].as_integer().expect("a number") as u32;
        let height = (32 * side("height")).div_ceil(side("width"));
        assert_eq!([gpu.width, gpu.height, cpu.width, cpu.height], [32, height, 32, height], "{name}");
        let differs = |(a, b): &(&[f32; 4], &[f32; 4])| a.iter().zip(*b).any(|(a, b)| (a - b).abs() > 1.5 / 255.0);
        let off = gpu.pixels.iter().zip(&cpu.pixels).filter(differs).count();
        assert!(off <= 5, "{name}: {off} of 1024 pixels differ by more than a level");
        assert!(gpu.pixels.iter().any(|pixel| *pixel != gpu.pixels[0]), "{name} is empty");
    }
}

#[test]
fn the_same_call_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let outs = ["a", "b"].map(|name| folder.path().join(name));
    for out in &outs {
        fs::create_dir(out).expect("a folder");
        let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
        command.args(["gallery", "-o", ".", "--size", "16", "-q"]).current_dir(out).env("SOURCE_DATE_EPOCH", "86400");
        assert_eq!(command.status().expect("the program runs").code(), Some(0));
    }
    let page = fs::read_to_string(outs[0].join("index.html")).expect("the page");
    assert!(page.contains("on 1970-01-02: <code>glisten gallery -o . --size 16 -q</code>"));
    for entry in fs::read_dir(&outs[0]).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        let other = outs[1].join(path.file_name().expect("a name"));
        assert_eq!(fs::read(&path).expect("readable"), fs::read(&other).expect("readable"), "{}", path.display());
    }
}

#[test]
fn wrong_usage_is_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("file");
    fs::write(&file, "text").expect("written");
    let run = gallery(&file, &[]);
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(2), "{told}");
    assert!(told.contains("is a file, not a folder"), "{told}");
    assert_eq!(gallery(folder.path(), &["--size", "0"]).status.code(), Some(2));
    let run = gallery(folder.path(), &["--adapter", "no such adapter"]);
    assert_eq!(run.status.code(), Some(3), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(!folder.path().join("index.html").exists());
}
