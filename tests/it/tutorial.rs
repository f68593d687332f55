//! `docs/tutorial.md`: its code is that of `examples/tutorial.rs`, whose picture is the reference's.

#[path = "../../examples/tutorial.rs"]
#[expect(dead_code, unreachable_pub, reason = "the example is a program of its own")]
mod example;

use crate::support::root;
use glisten::scene::{MemoryFiles, load};
use glisten_front::{Compiler, Options};
use glisten_reference::{RenderOptions, render};
use std::fmt::Write;

/// The lines of the example between two marks, without their common indentation.
fn region(name: &str) -> Option<String> {
    let text = std::fs::read_to_string(root().join("examples/tutorial.rs")).expect("the example is there");
    let mark = format!("// [{name}]");
    let mut lines = text.lines().skip_while(|line| line.trim() != mark).skip(1).peekable();
    lines.peek()?;
    let lines: Vec<&str> = lines.take_while(|line| line.trim() != mark).collect();
    let indent = lines.iter().filter(|line| !line.is_empty()).map(|line| line.len() - line.trim_start().len()).min()?;
    Some(lines.iter().map(|line| line.get(indent..).unwrap_or("").to_owned() + "\n").collect())
}

#[test]
fn the_page_shows_the_code_of_the_example() {
    let page = std::fs::read_to_string(root().join("docs/tutorial.md")).expect("the page is there");
    let mut shown = 0;
    for (index, _) in page.match_indices("<!-- code: ") {
        let rest = &page[index + "<!-- code: ".len()..];
        let name = rest.split(" -->").next().expect("the mark ends");
        let code = region(name).unwrap_or_else(|| panic!("the example has no region `{name}`"));
        let expected = format!("{name} -->\n\n```rust\n{code}```\n");
        if std::env::var_os("UPDATE_TUTORIAL").is_none() {
            assert!(rest.starts_with(&expected), "the block `{name}` is not the code; run with UPDATE_TUTORIAL=1");
        }
        shown += 1;
    }
    assert!(shown >= 4, "{shown} blocks");
    if std::env::var_os("UPDATE_TUTORIAL").is_some() {
        std::fs::write(root().join("docs/tutorial.md"), updated(&page)).expect("the page can be written");
    }
}

/// The page with the present code after each mark.
fn updated(page: &str) -> String {
    let mut parts = page.split("<!-- code: ");
    let mut out = parts.next().unwrap_or("").to_owned();
    for part in parts {
        let (name, rest) = part.split_once(" -->").expect("the mark ends");
        let code = region(name).expect("the example has the region");
        let rest = rest.trim_start();
        let rest = rest.strip_prefix("```rust\n").map_or(rest, |old| old.split_once("```\n").expect("it ends").1);
        let _ = write!(out, "<!-- code: {name} -->\n\n```rust\n{code}```\n\n{}", rest.trim_start());
    }
    out
}

#[test]
fn the_example_draws_what_the_reference_draws() {
    let globe = example::globe();
    let drawn = example::draw(&example::translate(), &globe);
    let list = |values: &[f32]| format!("{values:?}");
    let mut text = String::from(
        "[framebuffer]\nwidth = 256\nheight = 256\nformat = \"rgba8unorm\"\n[[draw]]\nvertex = \"a.vert\"\nfragment = \"a.frag\"\n\
         primitive = \"triangles\"\ncull = \"back\"\n",
    );
    let _ = writeln!(text, "indices = {:?}\n[draw.attributes]", globe.indices);
    for (name, size, values) in &globe.attributes {
        let _ = writeln!(text, "{name} = {{ size = {size}, values = {} }}", list(values));
    }
    text += "[draw.uniforms]\n";
    for (name, values) in &globe.uniforms {
        let _ = writeln!(text, "{name} = {}", list(values));
    }
    let (width, height, texels) = &globe.surface;
    let _ = writeln!(
        text,
        "[draw.textures]\nsurface = {{ width = {width}, height = {height}, values = {} }}",
        list(texels)
    );
    let shader = |name: &str| std::fs::read_to_string(root().join("fixtures/tutorial").join(name)).expect("the shader");
    let (vertex, fragment) = (shader("globe.vert"), shader("globe.frag"));
    let files = MemoryFiles::new([("a.toml", text.as_str()), ("a.vert", &vertex), ("a.frag", &fragment)]);
    let loaded = load("a.toml", &files, &Compiler::new(Options::default()));
    let told: Vec<&str> = loaded.diagnostics.iter().map(|finding| finding.message.as_str()).collect();
    let scene = loaded.scene.unwrap_or_else(|| panic!("{told:?}"));
    let reference = render(&scene, &RenderOptions::default()).unwrap_or_else(|found| panic!("{found:?}"));
    let (mut off, mut compared) = (0, 0);
    for index in (0..reference.covered.len()).filter(|index| !reference.near_edge[*index]) {
        let channels = drawn.attachments[0][index].iter().zip(&reference.attachments[0][index]);
        off += u32::from(channels.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) > 1.5 / 255.0);
        compared += 1;
    }
    let lit = reference.covered.iter().filter(|covered| **covered).count();
    assert!(compared > 60_000 && lit > 20_000, "{compared} compared, {lit} covered");
    // At the border of two texels either is right.
    assert!(off < 200, "{off} of {compared} pixels differ");
}
