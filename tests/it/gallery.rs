//! The library's programs and scenes, and `glisten gallery` end to end.

use glisten::gallery::{Entry, entries};
use glisten::library::{programs, scenes};
use glisten::scene::{DiskFiles, MemoryFiles, Scene, load};
use glisten_front::{Compiler, Options};
use glisten_gpu::{Gpu, Via};
use glisten_reference::{LineRule, Precision, RenderOptions};
use glisten_scene::compare::{Judge, Verdict};
use std::collections::BTreeSet;
use std::path::Path;
use std::process::{Command, Output};

fn all() -> Vec<Entry> {
    entries().expect("the library's scenes are good")
}

#[test]
fn scenes_load_from_disk_without_a_finding() {
    for scene in scenes() {
        let path = format!("{}/shader_lib/scenes/{}.toml", env!("CARGO_MANIFEST_DIR"), scene.name);
        let loaded = load(&path, &DiskFiles, &Compiler::new(Options::default()));
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
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("shader_lib/programs");
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
fn compare(gpu: &Gpu, name: &str, scene: &Scene) -> Vec<String> {
    let mut scene = scene.clone();
    (scene.framebuffer.width, scene.framebuffer.height) = (64, 64);
    let options = RenderOptions { precision: Precision::Envelope, lines: LineRule::Vulkan, ..RenderOptions::default() };
    let reference = glisten_reference::render(&scene, &options).expect("the reference draws the library's scenes");
    assert!(reference.covered.contains(&true), "{name}: nothing is drawn");
    let mut wrong = Vec::new();
    for via in [Via::Spirv, Via::Wgsl] {
        let picture = gpu.render(&scene, via).unwrap_or_else(|error| panic!("{name}: {error}")).picture;
        let verdict = Verdict::new(&picture, &reference, Judge::Envelope);
        if !verdict.holds(false) {
            wrong.push(format!("{name} via {}: {verdict:#?}", via.name()));
        }
    }
    wrong
}

#[test]
fn every_scene_is_the_same_picture_on_both_sides() {
    let gpu = crate::gpu::gpu();
    let wrong: Vec<String> = all().iter().flat_map(|entry| compare(&gpu, entry.name, entry.scene())).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn programs_that_shade_each_vertex_are_the_same_picture_on_both_sides() {
    let gpu = crate::gpu::gpu();
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
        let files = MemoryFiles::new([("a.toml", text.as_str())]);
        let loaded = load("a.toml", &files, &Compiler::new(Options::default()));
        let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
        let drawn = loaded.scene.unwrap_or_else(|| panic!("{scene}: {told:?}"));
        wrong.extend(compare(&gpu, &format!("{scene} at each vertex"), &drawn));
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

/// The pixels of a PNG file, as RGB.
fn pixels(path: &Path) -> image::RgbImage {
    image::open(path).unwrap_or_else(|error| panic!("{}: {error}", path.display())).to_rgb8()
}

#[test]
fn both_backends_draw_the_whole_gallery() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (gpu, cpu) = (folder.path().join("gpu"), folder.path().join("cpu"));
    for (out, arguments) in [(&gpu, &["--size", "32"][..]), (&cpu, &["--size", "32", "--backend", "cpu"])] {
        let run = gallery(out, arguments);
        assert_eq!(run.status.code(), Some(0), "{}", String::from_utf8_lossy(&run.stderr));
        assert!(run.stdout.is_empty());
        let mut files: Vec<String> = std::fs::read_dir(out)
            .expect("the folder is there")
            .map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned())
            .collect();
        files.sort();
        let mut wanted: Vec<String> = scenes().iter().map(|scene| format!("{}.png", scene.name)).collect();
        wanted.extend(["index.html".to_owned(), "gallery.png".to_owned()]);
        wanted.sort();
        assert_eq!(files, wanted, "nothing is missing and nothing is left over");
        let page = std::fs::read_to_string(out.join("index.html")).expect("the page");
        for attribute in ["src=\"", "href=\""] {
            for target in page.split(attribute).skip(1).filter_map(|rest| rest.split('"').next()) {
                let there = match target.strip_prefix('#') {
                    Some(id) => page.contains(&format!("id=\"{id}\"")),
                    None => out.join(target).is_file(),
                };
                assert!(there, "{target}");
            }
        }
        assert!(page.len() < 1 << 20, "{} bytes", page.len());
    }
    for scene in scenes() {
        let name = format!("{}.png", scene.name);
        let (gpu, cpu) = (pixels(&gpu.join(&name)), pixels(&cpu.join(&name)));
        assert_eq!((gpu.dimensions(), cpu.dimensions()), ((32, 32), (32, 32)), "{name}");
        let off =
            gpu.pixels().zip(cpu.pixels()).filter(|(a, b)| a.0.iter().zip(b.0).any(|(a, b)| a.abs_diff(b) > 1)).count();
        assert!(off <= 5, "{name}: {off} of 1024 pixels differ by more than a level");
        let first = gpu.get_pixel(0, 0);
        assert!(gpu.pixels().any(|pixel| pixel != first), "{name} is empty");
    }
}

#[test]
fn the_same_call_gives_the_same_bytes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let outs = ["a", "b"].map(|name| folder.path().join(name));
    for out in &outs {
        assert_eq!(gallery(out, &["--size", "16", "-q"]).status.code(), Some(0));
    }
    for entry in std::fs::read_dir(&outs[0]).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        let other = outs[1].join(path.file_name().expect("a name"));
        assert_eq!(
            std::fs::read(&path).expect("readable"),
            std::fs::read(&other).expect("readable"),
            "{}",
            path.display()
        );
    }
}

#[test]
fn wrong_usage_is_told() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("file");
    std::fs::write(&file, "text").expect("written");
    let run = gallery(&file, &[]);
    let told = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(2), "{told}");
    assert!(told.contains("is a file, not a folder"), "{told}");
    assert_eq!(gallery(folder.path(), &["--size", "0"]).status.code(), Some(2));
    let run = gallery(folder.path(), &["--adapter", "no such adapter"]);
    assert_eq!(run.status.code(), Some(3), "{}", String::from_utf8_lossy(&run.stderr));
    assert!(!folder.path().join("index.html").exists());
}
