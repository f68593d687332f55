//! Variants of an uber-shader: shaders a second, cold and warm, next to glslangValidator.
//!
//! `cargo bench --bench permutations` compiles the 1920 variants of `fixtures/permutations/uber.toml` to SPIR-V in one process
//! of glisten, without a cache, with an empty one, and with a full one, and reads all that the warm run has to read. In the
//! same rounds, glslangValidator (Debian's `glslang-tools`) compiles every 16th of the variants, a process each, as many at
//! once as there are cores. libglslang (`peers/variants.cpp`, Debian's `glslang-dev`) compiles all variants in one process with as many
//! threads: the ratio to it is that of two compilers, and the ratio to glslangValidator is mostly the start of processes. Both
//! get the same text with `#version 330`, since they make no SPIR-V of 150 for OpenGL. A figure is the median over the rounds. A
//! variant has two shaders. Ratios are those of CPU time, of all threads and of the system, which other work on the machine disturbs
//! less than seconds.
//!
//! The last rows have 200 variants of the same program as programs of their own, a process of glisten for each: without a cache, with an
//! empty one, and with a full one.

#![expect(clippy::print_stdout, reason = "a benchmark prints its figures")]

mod spent;

use spent::{Spent, median, spent};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};

const ROUNDS: usize = 5;
const EVERY: usize = 16;
/// How many processes compile a program each.
const ALONE: usize = 200;

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
    let mut rounds: Vec<[Spent; 6]> = Vec::new();
    let mut alone: Vec<[Spent; 3]> = Vec::new();
    let few: Vec<Vec<String>> = variants.iter().step_by((variants.len() / ALONE).max(1)).take(ALONE).cloned().collect();
    for round in 0..ROUNDS {
        let cache = at(&format!("cache{round}"));
        let scale = variants.len() as f64 / sample.len() as f64;
        let peer = if has_peer { glslang(&root, folder.path(), &sample).times(scale) } else { Spent::UNKNOWN };
        let library =
            driver.as_ref().map_or(Spent::UNKNOWN, |driver| in_process(driver, &root, folder.path(), &variants));
        let cold = compile(&root, &at(&format!("cold{round}")), None);
        let filling = compile(&root, &at(&format!("filling{round}")), Some(&cache));
        let warm = compile(&root, &at(&format!("warm{round}")), Some(&cache));
        let reading = spent(|| read_all(&cache) + read_all(&at(&format!("warm{round}"))));
        rounds.push([peer, library, cold, filling, warm, reading]);
        let cache = at(&format!("alone{round}"));
        let cache = Some(cache.as_path());
        alone.push([None, cache, cache].map(|cache| one_by_one(&root, &at("one"), &few, cache)));
    }
    let rows = [
        "glslangValidator, a process for each variant",
        "libglslang, one process",
        "glisten, without a cache",
        "glisten, with an empty cache",
        "glisten, with a full cache",
        "reading the cache and the outputs, one thread",
    ];
    let all: Vec<Spent> = (0..rows.len()).map(|of| median(rounds.iter().map(|round| round[of]))).collect();
    println!("{} variants, {ROUNDS} rounds\n", variants.len());
    println!("| method | seconds | CPU seconds | shaders a CPU second | times libglslang | times glslangValidator |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for (name, Spent { seconds, cpu }) in rows.iter().zip(&all) {
        let (each, library, peer) = (shaders / cpu, all[1].cpu / cpu, all[0].cpu / cpu);
        println!("| {name} | {seconds:.2} | {cpu:.2} | {each:.0} | {library:.1} | {peer:.0} |");
    }
    println!("\n| {} programs, a process each | seconds | CPU seconds |\n| --- | --- | --- |", few.len());
    for (of, name) in ["without a cache", "with an empty cache", "with a full cache"].iter().enumerate() {
        let Spent { seconds, cpu } = median(alone.iter().map(|round| round[of]));
        println!("| {name} | {seconds:.2} | {cpu:.2} |");
    }
}

/// Compiles programs with these flags, a process each, one after the other.
fn one_by_one(root: &Path, out: &Path, programs: &[Vec<String>], cache: Option<&Path>) -> Spent {
    spent(|| {
        for flags in programs {
            let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
            command.args(["compile", "--quiet", "--target", "spirv", "uber.vert", "uber.frag", "-o"]).arg(out);
            match cache {
                Some(cache) => command.arg("--cache").arg(cache),
                None => command.arg("--no-cache"),
            };
            assert!(command.args(flags).current_dir(root).status().expect("glisten runs").success());
        }
    })
}

/// The time of a run of glisten.
fn compile(root: &Path, out: &Path, cache: Option<&Path>) -> Spent {
    let mut command = Command::new(env!("CARGO_BIN_EXE_glisten"));
    command.args(["compile", "--quiet", "--target", "spirv", "--permutations", "uber.toml", "-o"]).arg(out);
    match cache {
        Some(cache) => command.arg("--cache").arg(cache),
        None => command.arg("--no-cache"),
    };
    spent(|| assert!(command.current_dir(root).status().expect("glisten runs").success()))
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

/// The time of libglslang for these variants, in one process.
fn in_process(driver: &Path, root: &Path, folder: &Path, variants: &[Vec<String>]) -> Spent {
    write_sources(root, folder);
    let output = folder.join("library");
    let _ = fs::remove_dir_all(&output);
    fs::create_dir_all(&output).expect("a folder");
    let line =
        |flags: &Vec<String>| flags.iter().map(|flag| flag.trim_start_matches("-D")).collect::<Vec<_>>().join(" ");
    let lines: String = variants.iter().map(|flags| line(flags) + "\n").collect();
    spent(|| {
        let mut command = Command::new(driver);
        command.arg(cores().to_string()).arg(&output).args(["uber.vert", "uber.frag"]).current_dir(folder);
        let mut child = command.stdin(Stdio::piped()).spawn().expect("the driver was built");
        child.stdin.take().expect("a pipe").write_all(lines.as_bytes()).expect("the driver reads");
        assert!(child.wait().expect("the driver runs").success());
    })
}

/// The time of glslangValidator for these variants.
fn glslang(root: &Path, folder: &Path, variants: &[Vec<String>]) -> Spent {
    write_sources(root, folder);
    let next = AtomicUsize::new(0);
    let work = |place: PathBuf| {
        fs::create_dir_all(&place).expect("a folder");
        while let Some(flags) = variants.get(next.fetch_add(1, Ordering::Relaxed)) {
            let mut command = Command::new("glslangValidator");
            command.args(["-G100", "--aml", "--amb"]).args(flags);
            let files = ["uber.vert", "uber.frag"].map(|name| folder.join(name));
            let run = command.args(files).current_dir(&place).output().expect("it runs");
            assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stdout));
        }
    };
    spent(|| {
        std::thread::scope(|scope| {
            for number in 0..cores() {
                let (work, place) = (&work, folder.join(format!("peer{number}")));
                scope.spawn(move || work(place));
            }
        });
    })
}

/// Reads all files below a folder. Returns how many bytes there are.
fn read_all(folder: &Path) -> usize {
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
    bytes
}
