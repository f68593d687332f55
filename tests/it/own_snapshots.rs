//! `glisten_snapshot`, by which the programs and scenes of the fixtures are asserted: emitted code, reflection, diagnostics,
//! account, pictures; and its workflow: what a picture that no longer fits leaves behind, and what decides about it.

use crate::cli::{Folder, code, err, out};
use crate::support::{compiler, root};
use glisten::emit::Target;
use glisten::scene::{DiskFiles, load};
use glisten::snapshot::Criterion;
use glisten::{Compilation, Picture, RenderOptions, Source, Stage, render};
use glisten_snapshot::pending::find;
use glisten_snapshot::{Place, check_picture};
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

fn compilation(folder: &str, stem: &str) -> Compilation {
    let source = |end: &str, stage| {
        let name = format!("{stem}.{end}");
        let text = fs::read_to_string(root().join("fixtures").join(folder).join(&name)).expect("the fixture");
        Source { name, text: text.into(), stage }
    };
    compiler().compile(&[source("vert", Stage::Vertex), source("frag", Stage::Fragment)])
}

#[test]
fn code_reflection_and_diagnostics() {
    let program = compilation("programs", "flat").program.expect("no errors");
    for target in [Target::Wgsl, Target::Spirv, Target::Msl, Target::Hlsl, Target::Glsl] {
        glisten::assert_emitted!(format!("flat-{}", target.word()), program, target);
    }
    glisten::assert_reflection!("flat-reflection", program);
    glisten::assert_diagnostics!("mismatch", compilation("readme", "mismatch"));
}

#[test]
fn scenes_and_their_accounts() {
    for name in ["triangle", "phong"] {
        // Relative to the package, in whose folder tests run: the account names the file.
        let loaded = load(&format!("fixtures/scenes/{name}.toml"), &DiskFiles, &compiler());
        let scene = loaded.scene.expect("the scene is valid");
        glisten::assert_scene!(name, scene);
        glisten::assert_account!(format!("{name}-account"), scene, loaded.sources);
        let picture = render(&scene, &RenderOptions::default()).expect("it can be drawn");
        glisten::assert_picture!(format!("{name}-flip"), picture, Criterion::Flip(0.01));
    }
}

fn gray(level: f64) -> Picture {
    Picture::of_colors(16, 16, vec![[level, level, level, 1.0]; 256])
}

/// The message of a check that fails; `None` if it holds.
fn check(folder: &Path, picture: &Picture, criterion: Criterion) -> Option<String> {
    let place = Place::new(&folder.to_string_lossy(), "test.rs", "a::b", "gray");
    let failed = catch_unwind(AssertUnwindSafe(|| check_picture(&place, picture, criterion))).err()?;
    Some(failed.downcast_ref::<String>().cloned().unwrap_or_default())
}

#[test]
fn a_picture_waits_for_a_decision() {
    if std::env::var_os("CI").is_some() || std::env::var_os("INSTA_UPDATE").is_some() {
        // There, nothing is left; the messages are the same.
        let folder = tempfile::tempdir().expect("a folder");
        assert!(check(folder.path(), &gray(0.5), Criterion::Exact).is_some());
        return;
    }
    let folder = Folder::new(&[("test.rs", b"")]);
    let stored = folder.path("snapshots/a__b__gray.png");
    let first = check(&folder.path(""), &gray(0.5), Criterion::Exact).expect("nothing is stored");
    assert!(first.contains("no picture is stored yet") && first.contains("accept a__b__gray"), "{first}");
    assert_eq!(out(&folder.run(&["snapshots", "list"])), "a__b__gray  ./snapshots/a__b__gray.new.png\n");
    assert_eq!(code(&folder.run(&["snapshots", "accept", "a__b__grey"])), 2);
    let accepted = folder.run(&["snapshots", "accept", "a__b__gray"]);
    assert_eq!(code(&accepted), 0, "{}", err(&accepted));
    assert_eq!(check(&folder.path(""), &gray(0.5), Criterion::Exact), None);
    assert_eq!(check(&folder.path(""), &gray(0.5001), Criterion::Exact), None, "the same in 8 bits");
    assert_eq!(check(&folder.path(""), &gray(0.51), Criterion::Flip(0.05)), None);
    let told = check(&folder.path(""), &gray(0.51), Criterion::Exact).expect("another gray");
    assert!(told.contains("256 pixels differ, by up to 2 of 255"), "{told}");
    let told = check(&folder.path(""), &gray(0.9), Criterion::Flip(0.05)).expect("another gray");
    assert!(told.contains("the mean FLIP error is 0."), "{told}");
    let review = folder.run(&["snapshots", "review", "-o", "page.html"]);
    assert_eq!(code(&review), 0, "{}", err(&review));
    let page = fs::read_to_string(folder.path("page.html")).expect("written");
    assert_eq!(page.matches("data:image/png;base64,").count(), 3, "stored, new, difference");
    for part in [
        "<title>Pending snapshots</title>",
        "width=device-width",
        "prefers-color-scheme: dark",
        "class=\"viewer\" data-whole",
        "1 snapshot to review",
        "The mean FLIP error is 0.",
        "mean FLIP error at most 0.05",
        "256 of 256 (100.0",
        "102 of 255",
        "<time datetime=\"20",
    ] {
        assert!(page.contains(part), "{part}");
    }
    assert!(err(&review).contains("1 snapshot to review: page.html"), "{}", err(&review));
    // A picture that fits again needs no decision.
    assert_eq!(check(&folder.path(""), &gray(0.5), Criterion::Exact), None);
    assert!(
        find(&folder.path("")).expect("read").is_empty()
            && !folder.path("snapshots/a__b__gray.difference.png").exists()
            && !folder.path("snapshots/a__b__gray.new.json").exists()
    );
    check(&folder.path(""), &Picture::of_colors(8, 8, vec![[0.0; 4]; 64]), Criterion::Exact).expect("another size");
    let before = fs::read(&stored).expect("stored");
    assert_eq!(code(&folder.run(&["snapshots", "reject"])), 0);
    assert_eq!(fs::read(&stored).expect("stored"), before);
    assert!(out(&folder.run(&["snapshots", "list"])).is_empty());
}

#[test]
fn texts_are_listed_and_shown() {
    let head = "---\nsource: a.rs\n---\n";
    let stored = format!("{head}one\ntwo\n");
    let new = format!("{head}one\n<b> & two\n");
    let folder =
        Folder::new(&[("snapshots/a__code.snap", stored.as_bytes()), ("snapshots/a__code.snap.new", new.as_bytes())]);
    let list = folder.run(&["snapshots", "list"]);
    assert_eq!(out(&list), "a__code  ./snapshots/a__code.snap.new\n");
    assert!(err(&list).contains("1 snapshot to review"), "{}", err(&list));
    assert_eq!(code(&folder.run(&["snapshots", "review", "-o", "page.html"])), 0);
    let page = fs::read_to_string(folder.path("page.html")).expect("written");
    assert!(
        page.contains("cargo insta review") && page.contains("&lt;b&gt; &amp; two") && !page.contains("<b> &"),
        "{page}"
    );
    // Texts are insta's.
    let accepted = folder.run(&["snapshots", "accept", "a__code"]);
    assert!(code(&accepted) == 2 && err(&accepted).contains("cargo insta review"), "{}", err(&accepted));
    assert!(folder.path("snapshots/a__code.snap.new").exists());
}

#[test]
fn a_scene_that_changed_is_noticed() {
    let text = |factor: &str| {
        format!(
            "#version 150\nout vec4 color;\nvoid main() {{ color = vec4(vec3(fract(gl_FragCoord.x * {factor})), 1.0); }}\n"
        )
    };
    let vertex =
        "#version 150\nvoid main() { gl_Position = vec4(gl_VertexID % 2 * 4 - 1, gl_VertexID / 2 * 4 - 1, 0, 1); }\n";
    let file = "[framebuffer]\nwidth = 16\nheight = 16\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
        primitive = \"triangles\"\nvertex_count = 3\n";
    let scene = |factor: &str| {
        let fragment = text(factor);
        let files =
            glisten::scene::MemoryFiles::new([("a.toml", file), ("a.vert", vertex), ("a.frag", fragment.as_str())]);
        load("a.toml", &files, &compiler()).scene.expect("the scene is valid")
    };
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("test.rs"), "").expect("written");
    let place = Place::new(&folder.path().to_string_lossy(), "test.rs", "a", "scene");
    let picture = render(&scene("0.0625"), &RenderOptions::default()).expect("drawn");
    let stored = picture.encode(0, glisten_scene::picture::ImageFormat::Png).expect("encoded");
    fs::create_dir_all(folder.path().join("snapshots")).expect("made");
    fs::write(folder.path().join("snapshots/a__scene.png"), stored).expect("written");
    glisten_snapshot::check_scene(&place, &scene("0.0625"));
    let changed = scene("0.125");
    let failed = catch_unwind(AssertUnwindSafe(|| glisten_snapshot::check_scene(&place, &changed)));
    let told = failed.expect_err("another picture").downcast_ref::<String>().cloned().unwrap_or_default();
    assert!(told.contains("outside of the envelope"), "{told}");
}
