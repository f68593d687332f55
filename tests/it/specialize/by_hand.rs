//! Residuals against programs that a person wrote for the same scenes, and against constants in glslang.
//!
//! `fixtures/specialize/by_hand` has scenes, and for each the vertex and the fragment shader that a person would write for
//! it; its folder `families` has such shaders for scenes of `fixtures/specialize/families`. All are counted alike: instructions in the function bodies of both stages, after `spirv-opt -O`. With
//! `SPECIALIZE_TABLE=1` the figures are printed, for `docs/specialize.md`.

use super::load;
use crate::emit::missing;
use crate::support::root;
use glisten::emit::{Conventions, Emitted, Target, emit, optimize};
use glisten::library::Embedded;
use glisten::scene::Scene;
use glisten::specialize::specialize_scene;
use glisten::{Compiler, Options, Program, Source, Stage};
use glisten_front::hir::{ArraySize, ScalarValue, Type, TypeId, Types, print};
use glisten_variants::body_instructions;
use glisten_verify::scene::Draw;
use glisten_verify::specialize::with_program;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;

/// How much longer than a person's program a residual may be.
const ALLOWED: f64 = 1.1;

/// Scenes in which a value stays in a uniform that a person would have written as a number, why, and how much longer the
/// residual may be for it.
static STAYS: &[(&str, &str, f64)] = &[
    ("fog", "the weight of the `mix` with the fog's color may be NaN, where the eye's distance is", 1.15),
    ("spot", "the base of `pow` may be NaN, where the lamp is in the surface", 1.12),
    ("gltf_window", "the loop over the eight corners is written out, which executes less", 1.2),
];

/// Scenes whose residual is written out, where glslang leaves a loop: longer, and it executes less.
static WRITTEN_OUT: &[&str] = &["noise_three"];

/// The files of a folder with this extension, by their stems, in order.
fn files(folder: &Path, extension: &str) -> Vec<(String, PathBuf)> {
    let files = fs::read_dir(folder).expect("the fixtures").map(|entry| entry.expect("an entry").path());
    let mut files: Vec<(String, PathBuf)> = files
        .filter(|path| path.extension().is_some_and(|known| known == extension))
        .map(|path| (path.file_stem().expect("a name").to_string_lossy().into_owned(), path))
        .collect();
    files.sort();
    files
}

/// The names of the cases, their scenes, and the shaders that a person wrote for them, without their extensions.
fn cases() -> Vec<(String, PathBuf, PathBuf)> {
    let folder = root().join("fixtures/specialize");
    let own = files(&folder.join("by_hand"), "toml").into_iter().map(|(name, path)| (name, path.clone(), path));
    let of_families = files(&folder.join("by_hand/families"), "frag").into_iter().map(|(name, path)| {
        let (family, scene) = name.split_once('.').expect("a family and a scene");
        (name.clone(), folder.join(format!("families/{family}/{scene}.toml")), path)
    });
    own.chain(of_families).collect()
}

/// The program that a person wrote for a scene.
fn written(shaders: &Path) -> Program {
    let sources = [("vert", Stage::Vertex), ("frag", Stage::Fragment)].map(|(extension, stage)| {
        let path = shaders.with_extension(extension);
        let text = fs::read_to_string(&path).expect("a shader next to each scene");
        Source { name: path.display().to_string(), text: text.into(), stage }
    });
    let compiled = Compiler::new(Options::default()).with_includes(Embedded).compile(&sources);
    let messages: Vec<_> = compiled.diagnostics.iter().map(|found| found.message.clone()).collect();
    compiled.program.unwrap_or_else(|| panic!("{}: {messages:?}", shaders.display()))
}

/// Runs a judge. None if the machine lacks it.
fn run(program: &str, package: &str, arguments: &[&str]) -> Option<()> {
    let Ok(output) = Command::new(program).args(arguments).output() else {
        missing(program, &format!("Debian has it in the package {package}"));
        return None;
    };
    let text = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{program} {arguments:?}: {text}");
    Some(())
}

/// Instructions of a module after `spirv-opt -O`.
fn optimized(folder: &Path, module: &[u8]) -> Option<u64> {
    let [before, after] = ["before.spv", "after.spv"].map(|name| folder.join(name));
    fs::write(&before, module).expect("the folder can be written to");
    run("spirv-opt", "spirv-tools", &["-O", &before.to_string_lossy(), "-o", &after.to_string_lossy()])?;
    let bytes = fs::read(after).expect("it wrote a module");
    let words: Vec<u32> =
        bytes.chunks_exact(4).map(|word| u32::from_le_bytes([word[0], word[1], word[2], word[3]])).collect();
    Some(body_instructions(&words))
}

/// Instructions of both stages as glisten emits them.
fn emitted(folder: &Path, program: &Program) -> Option<u64> {
    let program = optimize(program);
    let each = program.stages.iter().map(|shader| {
        let words = emit(&program, shader.stage, Target::Spirv, &Conventions::default()).expect("it is emitted");
        assert!(matches!(words, Emitted::Words(_)));
        optimized(folder, &words.into_bytes())
    });
    each.sum()
}

/// Instructions of both stages as glslang makes them of GLSL.
fn by_glslang(folder: &Path, texts: &[(Stage, String)]) -> Option<u64> {
    let each = texts.iter().map(|(stage, text)| {
        // glslang makes SPIR-V for OpenGL from this version on.
        let text = text.replacen("#version 150", "#version 330", 1);
        let path = folder.join(if *stage == Stage::Vertex { "a.vert" } else { "a.frag" });
        let module = folder.join("a.spv");
        fs::write(&path, text).expect("the folder can be written to");
        let (path, place) = (path.to_string_lossy(), module.to_string_lossy());
        run("glslangValidator", "glslang-tools", &["-G", "--aml", "--amb", &path, "-o", &place])?;
        optimized(folder, &fs::read(&module).expect("it wrote a module"))
    });
    each.sum()
}

/// A value as GLSL.
fn constant(types: &Types, ty: TypeId, values: &mut dyn Iterator<Item = ScalarValue>) -> String {
    let mut list = |parts: Vec<TypeId>| {
        let parts: Vec<String> = parts.into_iter().map(|part| constant(types, part, values)).collect();
        format!("{}({})", types.name(ty), parts.join(", "))
    };
    match types.get(ty) {
        Type::Struct(id) => list(types.structure(id).members.iter().map(|member| member.ty).collect()),
        Type::Array(element, ArraySize::Sized(size)) => list(vec![element; size as usize]),
        Type::Vector(scalar, size) => list(vec![TypeId::vector(scalar, 1); usize::from(size)]),
        Type::Matrix(columns, rows) => list(vec![TypeId::FLOAT; usize::from(columns) * usize::from(rows)]),
        _ => match values.next() {
            Some(ScalarValue::Float(value)) => format!("{value:?}"),
            Some(ScalarValue::Int(value)) => value.to_string(),
            Some(ScalarValue::Uint(value)) => format!("{value}u"),
            Some(ScalarValue::Bool(value)) => value.to_string(),
            None => panic!("a uniform has a value for each of its scalars"),
        },
    }
}

/// The texts of a draw's program with constants in the place of the uniforms that do not change.
fn with_constants(draw: &Draw) -> Vec<(Stage, String)> {
    let program = &draw.program;
    let stages = program.stages.iter().map(|shader| {
        let mut text = print(&program.types, shader);
        for (root, values) in program.interface.roots.iter().zip(&draw.uniforms) {
            if root.block.is_some() || draw.dynamic.contains(&root.name) {
                continue;
            }
            let value = constant(&program.types, root.ty, &mut values.iter().copied());
            let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
            for line in &mut lines {
                let declared = line.strip_prefix("uniform ").and_then(|rest| rest.split(['=', ';']).next());
                if declared.and_then(|declared| declared.split_whitespace().nth(1)) == Some(root.name.as_str()) {
                    *line = format!("const {} {} = {value};", program.types.name(root.ty), root.name);
                }
            }
            text = lines.join("\n") + "\n";
        }
        (shader.stage, text)
    });
    stages.collect()
}

/// The largest difference between two pictures by the reference in f32.
fn distance(a: &Scene, b: &Scene) -> f64 {
    let pictures = [a, b].map(|scene| super::bits(scene).expect("it draws"));
    let pairs = pictures[0].iter().zip(&pictures[1]);
    let far = |(a, b): (&u64, &u64)| if a == b { 0.0 } else { (f64::from_bits(*a) - f64::from_bits(*b)).abs() };
    // A NaN on one side is no small difference.
    pairs.map(far).fold(0.0, |worst, far| if far > worst || far.is_nan() { far } else { worst })
}

#[test]
fn residuals_are_as_short_as_a_persons() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let (mut wrong, mut n_within) = (Vec::new(), 0);
    let mut table = "| scene | residual | by hand | ratio | residual by glslang | constants by glslang |\n".to_owned();
    table += "| --- | --- | --- | --- | --- | --- |\n";
    for (name, path, shaders) in cases() {
        let (scene, sources) = load(&path).unwrap_or_else(|| panic!("{name} does not load"));
        let hand = Arc::new(written(&shaders));
        let by_hand = Scene { draws: vec![with_program(&scene.draws[0], Arc::clone(&hand), &[])], ..scene.clone() };
        let far = distance(&scene, &by_hand);
        // What is folded by hand may be rounded otherwise.
        assert!(far < 1e-6, "{name}: the program that was written by hand draws another picture: {far}");
        let specialized = specialize_scene(&scene, &sources, &[]);
        let left = &specialized.scene.draws[0].program;
        let Some((ours, theirs)) = emitted(folder.path(), left).zip(emitted(folder.path(), &hand)) else { return };
        let Some(residual) = by_glslang(folder.path(), &specialized.draws[0].texts) else { return };
        let Some(constants) = by_glslang(folder.path(), &with_constants(&scene.draws[0])) else { return };
        let ratio = ours as f64 / theirs as f64;
        table += &format!("| `{name}` | {ours} | {theirs} | {ratio:.2} | {residual} | {constants} |\n");
        let allowed = STAYS.iter().find(|(stays, ..)| *stays == name).map_or(ALLOWED, |(_, _, allowed)| *allowed);
        n_within += u32::from(ratio <= ALLOWED);
        if ratio > allowed || (residual > constants && !WRITTEN_OUT.contains(&name.as_str())) {
            wrong.push(format!("{name}\n{:?}", specialized.draws[0].texts));
        }
    }
    if std::env::var_os("SPECIALIZE_TABLE").is_some() {
        writeln!(std::io::stderr(), "{table}").expect("standard error can be written to");
    }
    assert!(wrong.is_empty() && n_within >= 10, "{table}{}", wrong.join("\n"));
}
