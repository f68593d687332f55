//! Variants of an uber-shader: shaders a second, cold and warm, next to glslangValidator.
//!
//! `cargo bench --bench permutations` compiles the 1920 variants of `fixtures/permutations/uber.toml` to SPIR-V in one process
//! of glisten, without a cache, with an empty one, and with a full one, and reads all that the warm run has to read. In the
//! same rounds, glslangValidator (Debian's `glslang-tools`) compiles every 16th of the variants, a process each, as many at
//! once as there are cores. libglslang (`peers/variants.cpp`, Debian's `glslang-dev`) compiles all variants in one process with as many
//! threads: the ratio to it is that of two compilers, and the ratio to glslangValidator is mostly the start of processes. Both
//! get the same text with `#version 330`, since they make no SPIR-V of 150 for OpenGL. A figure is the median over the rounds. A
//! variant has two shaders.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

const ROUNDS: usize = 5;
const EVERY: usize = 16;

fn main() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/permutations");
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    compile(&root, &at("first"), None);
    let variants = variants(&at("first/index.json"));
    let shaders = 2.0 * variants.len() as f64;
    let sample: Vec<Vec<String>> = variants.iter().step_by(EVERY).cloned().collect();
    let has_peer = Command::new("glslangValidator").arg("--version").stdout(Stdio::null()).status().is_ok();
    if !has_peer {
        println!("glslangValidator cannot be compared with: install `glslang-tools` (Debian)");
    }
    let driver = build_driver(&at("variants"));
    if driver.is_none() {
        println!("libglslang cannot be compared with: install `g++` and `glslang-dev` (Debian)");
    }
    let mut times: Vec<[f64; 6]> = Vec::new();
    for round in 0..ROUNDS {
        let cache = at(&format!("cache{round}"));
        let peer = if has_peer { glslang(&root, folder.path(), &sample) } else { f64::NAN };
        let library = driver.as_ref().map_or(f64::NAN, |driver| in_process(driver, &root, folder.path(), &variants));
        let cold = compile(&root, &at(&format!("cold{round}")), None);
        let filling = compile(&root, &at(&format!("filling{round}")), Some(&cache));
        let warm = compile(&root, &at(&format!("warm{round}")), Some(&cache));
        let reading = read_all(&cache) + read_all(&at(&format!("warm{round}")));
        times.push([peer / sample.len() as f64 * variants.len() as f64, library, cold, filling, warm, reading]);
    }
    let median = |of: usize| {
        let mut column: Vec<f64> = times.iter().map(|row| row[of]).collect();
        column.sort_by(f64::total_cmp);
        column[column.len() / 2]
    };
    let (peer, library) = (median(0), median(1));
    println!("{} variants, {ROUNDS} rounds\n", variants.len());
    println!(
        "| way | seconds | shaders a second | times libglslang | times glslangValidator |\n| --- | --- | --- | --- | --- |"
    );
    let rows = [
        "glslangValidator, a process for each variant",
        "libglslang, one process",
        "glisten, without a cache",
        "glisten, with an empty cache",
        "glisten, with a full cache",
        "reading the cache and the outputs, one thread",
    ];
    for (of, name) in rows.iter().enumerate() {
        let time = median(of);
        println!("| {name} | {time:.3} | {:.0} | {:.2} | {:.1} |", shaders / time, library / time, peer / time);
    }
}

/// Seconds of a run of glisten.
fn compile(root: &Path, out: &Path, cache: Option<&Path>) -> f64 {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.args(["compile", "--quiet", "--target", "spirv", "--permutations", "uber.toml", "-o"]).arg(out);
    match cache {
        Some(cache) => command.arg("--cache").arg(cache),
        None => command.arg("--no-cache"),
    };
    let start = Instant::now();
    assert!(command.current_dir(root).status().expect("glisten runs").success());
    start.elapsed().as_secs_f64()
}

/// The flags of each variant.
fn variants(index: &Path) -> Vec<Vec<String>> {
    let index: serde_json::Value = serde_json::from_slice(&fs::read(index).expect("an index")).expect("JSON");
    let variants = index["programs"][0]["variants"].as_array().expect("a list");
    let flags = |variant: &serde_json::Value| {
        let defines = variant["defines"].as_object().expect("macros");
        defines.iter().map(|(name, value)| format!("-D{name}={}", value.as_str().expect("a text"))).collect()
    };
    variants.iter().map(flags).collect()
}

/// Writes the sources as glslang takes them.
fn write_sources(root: &Path, folder: &Path) {
    for name in ["uber.vert", "uber.frag", "lights.glsl"] {
        let text = fs::read_to_string(root.join(name)).expect("a source");
        let text = text.replace("#version 150", "#version 330");
        let text = text.replace("GL_ARB_shading_language_include", "GL_GOOGLE_include_directive");
        fs::write(folder.join(name), text).expect("written");
    }
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

/// Builds libglslang's side; `None` where its library or a compiler of C++ is missing.
fn build_driver(driver: &Path) -> Option<PathBuf> {
    let libraries = "glslang MachineIndependent GenericCodeGen OSDependent OGLCompiler HLSL glslang-default-resource-limits SPIRV \
                     SPIRV-Tools-opt SPIRV-Tools pthread";
    let built = Command::new("c++")
        .args(["-O2", "-std=c++17"])
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/variants.cpp"))
        .arg("-o")
        .arg(driver)
        .args(libraries.split_whitespace().map(|library| format!("-l{library}")))
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success());
    built.then(|| driver.to_owned())
}

/// Seconds of libglslang for these variants, in one process.
fn in_process(driver: &Path, root: &Path, folder: &Path, variants: &[Vec<String>]) -> f64 {
    write_sources(root, folder);
    let output = folder.join("library");
    let _ = fs::remove_dir_all(&output);
    fs::create_dir_all(&output).expect("a folder");
    let line =
        |flags: &Vec<String>| flags.iter().map(|flag| flag.trim_start_matches("-D")).collect::<Vec<_>>().join(" ");
    let lines: String = variants.iter().map(|flags| line(flags) + "\n").collect();
    let start = Instant::now();
    let mut command = Command::new(driver);
    command.arg(cores().to_string()).arg(&output).args(["uber.vert", "uber.frag"]).current_dir(folder);
    let mut child = command.stdin(Stdio::piped()).spawn().expect("the driver was built");
    child.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("the driver reads");
    assert!(child.wait().expect("the driver runs").success());
    start.elapsed().as_secs_f64()
}

/// Seconds of glslangValidator for these variants.
fn glslang(root: &Path, folder: &Path, variants: &[Vec<String>]) -> f64 {
    write_sources(root, folder);
    let next = AtomicUsize::new(0);
    let start = Instant::now();
    std::thread::scope(|scope| {
        for number in 0..cores() {
            let (next, place) = (&next, folder.join(format!("peer{number}")));
            scope.spawn(move || {
                fs::create_dir_all(&place).expect("a folder");
                while let Some(flags) = variants.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let mut command = Command::new("glslangValidator");
                    command.args(["-G100", "--aml", "--amb"]).args(flags);
                    let files = ["uber.vert", "uber.frag"].map(|name| folder.join(name));
                    let run = command.args(files).current_dir(&place).output().expect("it runs");
                    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
                }
            });
        }
    });
    start.elapsed().as_secs_f64()
}

/// Seconds for reading all files below a folder.
fn read_all(folder: &Path) -> f64 {
    let start = Instant::now();
    let mut folders = vec![PathBuf::from(folder)];
    let mut bytes = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).expect("a folder").filter_map(Result::ok) {
            match entry.file_type().expect("a type").is_dir() {
                true => folders.push(entry.path()),
                false => bytes += fs::read(entry.path()).expect("a file").len(),
            }
        }
    }
    assert!(bytes > 0);
    start.elapsed().as_secs_f64()
}
