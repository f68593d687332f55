//! Compares the emitted SPIR-V with the output of glslang and `spirv-opt -O` for the same program, drawn by lavapipe
//! in one run.
//!
//! `cargo bench --bench draw` runs the lighting programs of the fixtures at the size of their scenes. glslang gets
//! the same text with the version, locations and uniform block that Vulkan requires, and one more line that maps z to
//! [0, w]; any other difference is due to the compilers. Each round draws ours, the peer's, and ours again. A figure
//! is the median over the rounds of the ratio to the first of the round, so the last one shows the noise.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use glisten::scene::{DiskFiles, Scene, load};
use glisten_emit::{Conventions, Reflection, reflect};
use glisten_front::hir::Stage;
use glisten_front::{Compiler, Options};
use glisten_gpu::{Gpu, Prepared, Via};
use std::path::Path;
use std::process::Command;

const ROUNDS: usize = 15;
const PROGRAMS: [&str; 4] = ["phong", "blinn_phong", "phong_vertex", "blinn_phong_vertex"];

fn main() {
    let gpu = Gpu::new(None).expect("a Vulkan adapter: apt-get install mesa-vulkan-drivers");
    println!("median over {ROUNDS} rounds of the time of a frame, as a ratio to ours (least to greatest)");
    for name in PROGRAMS {
        let path = format!("{}/fixtures/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let scene = load(&path, &DiskFiles, &Compiler::new(Options::default())).scene.expect("the scene is valid");
        let ours = gpu.prepare(&scene, Via::Spirv).expect("it can be drawn");
        let Some(peer) = peers(&gpu, &scene, name) else {
            println!("glslang cannot be compared with: install `glslang-tools` and `spirv-tools` (Debian)");
            return;
        };
        let pictures = [&ours, &peer].map(|prepared| gpu.draw(prepared).expect("it draws").picture);
        let unequal = pictures[0].bit_unequal(&pictures[1]);
        let frames = gpu.frames_for_a_stretch(&ours).expect("it draws");
        let time = |prepared: &Prepared| gpu.measure(prepared, frames).expect("it draws");
        let (mut theirs, mut again) = (Vec::new(), Vec::new());
        for round in 0..ROUNDS {
            let first = time(&ours);
            // The order of the two alternates from round to round.
            if round % 2 == 0 {
                theirs.push(time(&peer) / first);
                again.push(time(&ours) / first);
            } else {
                again.push(time(&ours) / first);
                theirs.push(time(&peer) / first);
            }
        }
        println!(
            "{name:20} glslang + spirv-opt -O {}   ours again {}   {unequal} pixels differ in a bit",
            spread(&mut theirs),
            spread(&mut again)
        );
    }
}

fn spread(ratios: &mut [f64]) -> String {
    ratios.sort_by(f64::total_cmp);
    let at = |index: usize| ratios.get(index).copied().unwrap_or(f64::NAN);
    format!("{:.3} ({:.3} to {:.3})", at(ratios.len() / 2), at(0), at(ratios.len() - 1))
}

/// The scene with the peer's modules; `None` if a tool is missing.
fn peers(gpu: &Gpu, scene: &Scene, name: &str) -> Option<Prepared> {
    let program = &scene.draws.first()?.program;
    let reflection = reflect(program, &Conventions::default());
    let vertex = compiled(name, Stage::Vertex, &reflection)?;
    let fragment = compiled(name, Stage::Fragment, &reflection)?;
    let edit = |stage: Stage, _: Vec<u32>| if stage == Stage::Vertex { vertex.clone() } else { fragment.clone() };
    // SAFETY: `spirv-val` has accepted the words.
    #[expect(unsafe_code, reason = "the peer's words are to run as they are")]
    Some(unsafe { gpu.prepare_edited(scene, &edit) }.expect("the peer's modules can be drawn"))
}

/// The output of glslang and `spirv-opt -O` for the adapted text.
fn compiled(name: &str, stage: Stage, reflection: &Reflection) -> Option<Vec<u32>> {
    let extension = if stage == Stage::Vertex { "vert" } else { "frag" };
    let source = format!("{}/fixtures/programs/{name}.{extension}", env!("CARGO_MANIFEST_DIR"));
    let text = adapted(&std::fs::read_to_string(source).expect("the fixture is there"), stage, reflection);
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = |name: &str| folder.path().join(name);
    let (input, output, best) = (file(&format!("a.{extension}")), file("a.spv"), file("b.spv"));
    std::fs::write(&input, &text).expect("written");
    run("glslangValidator", &["-V".as_ref(), input.as_ref(), "-o".as_ref(), output.as_ref()])?;
    run("spirv-opt", &["-O".as_ref(), output.as_ref(), "-o".as_ref(), best.as_ref()])?;
    run("spirv-val", &["--target-env".as_ref(), "vulkan1.1".as_ref(), best.as_ref()])?;
    let bytes = std::fs::read(best).expect("spirv-opt has written it");
    Some(bytes.chunks(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect())
}

/// Runs a tool; `None` if there is none.
fn run(tool: &str, arguments: &[&Path]) -> Option<()> {
    let output = Command::new(tool).args(arguments).output().ok()?;
    assert!(output.status.success(), "{tool} says {}", String::from_utf8_lossy(&output.stdout));
    Some(())
}

/// The text for Vulkan: locations for attributes, varyings and colors, and a uniform block in place of the last
/// uniform.
fn adapted(text: &str, stage: Stage, reflection: &Reflection) -> String {
    let declaration = |line: &str, word: &str| {
        let rest = line.strip_prefix(word)?.split_once(';')?.0.trim();
        let name = rest.split_whitespace().last()?.split('[').next()?;
        Some((rest.to_owned(), name.to_owned()))
    };
    let offset = |name: &str| {
        let is_part =
            |path: &str| path == name || path.starts_with(&format!("{name}[")) || path.starts_with(&format!("{name}."));
        reflection.uniforms.iter().filter(|uniform| is_part(&uniform.name)).map(|uniform| uniform.offset).min()
    };
    let location = |name: &str, is_input: bool| match (stage, is_input) {
        (Stage::Vertex, true) => reflection.attributes.iter().find(|row| row.name == name).map(|row| row.location),
        (Stage::Fragment, false) => reflection.outputs.iter().find(|row| row.name == name).map(|row| row.location),
        _ => reflection.varyings.iter().find(|row| row.name == name).map(|row| row.location),
    };
    let last = text.lines().rfind(|line| line.starts_with("uniform ")).unwrap_or_default();
    let mut members = String::new();
    let mut adapted = String::new();
    for line in text.lines() {
        let line = if line.starts_with("#version") { "#version 450".to_owned() } else { line.to_owned() };
        if let Some((member, name)) = declaration(&line, "uniform ") {
            let offset = offset(&name).expect("the uniform is reflected");
            members += &format!("    layout(offset = {offset}) {member};\n");
            if line == last {
                adapted += &format!("layout(set = 0, binding = 0, std140) uniform Uniforms\n{{\n{members}}};\n");
            }
            continue;
        }
        let (input, output) = (declaration(&line, "in "), declaration(&line, "out "));
        match input.as_ref().or(output.as_ref()) {
            Some((_, name)) => {
                let location = location(name, input.is_some()).expect("it is reflected");
                adapted += &format!("layout(location = {location}) {line}\n");
            }
            None => adapted += &format!("{line}\n"),
        }
    }
    if stage == Stage::Vertex {
        let end = adapted.rfind('}').expect("the end of `main`, which stands last");
        adapted.insert_str(end, "    gl_Position.z = (gl_Position.z + gl_Position.w) * 0.5;\n");
    }
    adapted
}
